/// dem-clump: turns meshes of grains into clumps of spheres and measures them.
#define _GNU_SOURCE
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "base/memory.h"
#include "base/units.h"
#include "cli.h"
#include "cli_registry.h"
#include "clump/pack.h"
#include "clump_batch.h"
#include "clump_inputs.h"
#include "clump_convert.h"
#include "clump_job.h"
#include "clump_labels.h"
#include "clump_outputs.h"
#include "clump_report.h"
#include "clump_sweep.h"
#include "clump_verify.h"
#include "out/export.h"

// what the option table fills
typedef struct arguments {
    cli_common common;
    long spheres, max_spheres;
    double gap, size, density, wrap_detail;
    int effort, moments, mass_from, frame, repair, keep;
    bool inscribed, outer, split;
    const char *method, *methods, *unit, *exports, *sweep;
    cli_texts outputs, formats, targets;
    cli_registry known;  // the packing methods
    dem_pack_value values[DEM_PACK_VALUES];
    size_t value_count;
    // of many grains
    const char *list, *sheet, *raw, *voxel_size, *labels;
    bool recursive, resume, drop_border;
    long min_voxels;
} arguments;

static const char about[] =
    "Packs spheres into closed triangle meshes of grains (STL, OBJ, PLY, OFF; glTF, 3MF and others through assimp), "
    "repairs the mesh where needed, and gives each clump the grain's mass properties and its error. '-' reads "
    "standard input. Several meshes are a batch, also as the meshes of a folder or of a list, and so are the labels of "
    "a segmented image (NRRD, MetaImage, raw voxels): one clump for each.";

static const char epilogue[] = "Examples:\n"
                               "  dem-clump grain.stl                          50 spheres -> grain.json\n"
                               "  dem-clump grain.stl --unit mm -n 100 -o grain.json -o grain.png\n"
                               "  dem-clump grain.obj -e 3                     as many spheres as a 3 % gap needs\n"
                               "  dem-clump grain.obj --target hausdorff=3% --target normal=10deg\n"
                               "  dem-clump grain.obj --sweep 10,20,50,100,200 --methods all -o report.html\n"
                               "  dem-clump grain.obj -o - --format xyzr       spheres on standard output\n"
                               "  dem-clump scans/ -o clumps/ -o all.csv -o all.png      a folder; the table, a picture of all\n"
                               "  dem-clump scan.nrrd --unit mm -o clumps/     each label of a CT image\n"
                               "  dem-clump grain.obj --exports all -o out     for every program it knows\n"
                               "  dem-clump verify grain.json                  what mass these programs really use\n"
                               "  dem-clump convert rock.mol -o rock.json      a clump of another program\n"
                               "Exit status: 0 done, 1 failed, 2 wrong usage, 3 bad input, 4 cannot write, 130 interrupted.";

// the choices as the library counts them
static const char effort_names[] = "fast|default|best", moments_names[] = "free|volume|exact";
static const char repair_names[] = "auto|strict|wrap|none", keep_names[] = "one|largest|all";
static const char frame_names[] = "principal|mesh", mass_names[] = "mesh|union";

static arguments default_arguments(void)
{
    dem_make_options make = dem_make_defaults();
    return (arguments){.common = CLI_COMMON_DEFAULTS,
                       .max_spheres = (long)make.pack.max_spheres,
                       .density = make.density,
                       .effort = make.pack.effort,
                       .moments = -1,  // not given
                       .mass_from = make.mass_from,
                       .min_voxels = 500,
                       .method = make.pack.method,
                       .known = {.what = "method", .unset = "found for the number of spheres"}};
}

static void add_methods(cli_registry *methods)
{
    size_t count;
    const dem_packer *const *packers = dem_packers(&count);
    for (size_t i = 0; i < count && i < CLI_ENTRIES; i++)
        methods->entries[methods->count++] = (cli_entry){packers[i]->name, packers[i]->about, packers[i]->paper,
                                                         packers[i]->parameters, packers[i]->parameter_count};
}

// `--methods`: what the registry knows
static int list_methods(const cli_tool *tool, const arguments *a)
{
    dem_buffer text = {0};
    (a->common.json ? cli_registry_list_json : cli_registry_list)(&a->known, &text);
    return cli_print(tool, &text);
}

// the parameters given for the method; `values` has room for DEM_PACK_VALUES
static size_t given_values(const cli_registry *methods, const char *method, dem_pack_value *values)
{
    size_t at = cli_registry_find(methods, method), count = 0;
    for (size_t i = 0; i < methods->entries[at].parameter_count; i++)
        if (!isnan(methods->values[at][i]))
            values[count++] = (dem_pack_value){methods->entries[at].parameters[i].name, methods->values[at][i]};
    return count;
}

static job_options job_options_from(const arguments *a)
{
    job_options o = {.make = dem_make_defaults(), .split = a->split, .size = a->size, .unit = 1,
                     .unit_name = a->unit ? a->unit : "m", .unit_given = a->unit != NULL, .frame = (dem_frame)a->frame, .outputs = a->outputs,
                     .formats = a->formats};
    o.make.density = a->density;
    o.make.mass_from = (dem_mass_source)a->mass_from;
    o.make.pack.method = a->method;
    if (a->spheres)
        o.make.pack.spheres = (size_t)a->spheres;
    o.make.pack.max_spheres = (size_t)a->max_spheres;
    o.make.pack.gap = a->gap;
    o.make.pack.effort = (dem_effort)a->effort;
    if (a->moments >= 0)
        o.make.pack.moments = (dem_moments_kept)a->moments;
    o.make.pack.side = a->inscribed ? DEM_SIDE_INSCRIBED : a->outer ? DEM_SIDE_OUTER : DEM_SIDE_BOTH;
    o.make.pack.seed = (uint64_t)a->common.seed;
    o.make.pack.values = a->values;
    o.make.pack.value_count = a->value_count;
    o.moments_asked = a->moments >= 0;
    o.repair = (dem_repair_options){.repair = (dem_repair)a->repair, .keep = (dem_keep)a->keep,
                                    .wrap_detail = a->wrap_detail};
    if (a->split)
        o.repair.keep = DEM_KEEP_ALL;
    return o;
}

// the screen or the JSON object at the end
static int write_report(const cli_tool *tool, const arguments *a, const job_options *options,
                        const job_results *results, bool several)
{
    dem_buffer text = {0};
    bool to_stdout = false;
    for (size_t i = 0; i < options->outputs.count; i++)
        to_stdout |= strcmp(options->outputs.items[i], "-") == 0;
    if (a->common.json)
        report_json(&text, results, options, several || a->split);
    else if (!to_stdout && !a->common.quiet && !several && !a->split)
        for (size_t i = 0; i < results->count; i++)
            report_text(&text, &results->items[i], options);
    return text.size ? cli_print(tool, &text) : 0;
}

static int read_targets(const cli_tool *tool, const cli_texts *texts, dem_target **targets)
{
    dem_error error;
    *targets = calloc(texts->count + 1, sizeof **targets);
    for (size_t i = 0; *targets && i < texts->count; i++)
        if (dem_target_read(texts->items[i], &(*targets)[i], &error) != DEM_OK)
            return cli_wrong_usage(tool, "--target: %s", error.text);
    return *targets ? 0 : cli_error(tool, &(dem_error){.code = DEM_NO_MEMORY, .text = "out of memory"});
}

// ---- --sweep

// the command as it was given, without folders
static void put_command(dem_buffer *out, int argc, char **argv)
{
    dem_buffer_text(out, "dem-clump");
    for (int i = 1; i < argc; i++) {
        const char *equals = argv[i][0] == '-' ? strchr(argv[i], '=') : NULL;
        size_t head = equals ? (size_t)(equals + 1 - argv[i]) : 0;
        const char *tail = argv[i] + head, *name = dem_file_name(tail);
        tail = *name ? name : tail;
        bool quoted = tail[strcspn(tail, " \t'\"\\$&|;<>()*?")] != 0;
        dem_buffer_text(out, " ");
        dem_buffer_bytes(out, argv[i], head);
        dem_buffer_print(out, quoted ? "'%s'" : "%s", tail);
    }
}

static int sort_sweep_outputs(const cli_tool *tool, job_options *job, bool several)
{
    for (size_t i = 0; i < job->outputs.count; i++) {
        const char *path = job->outputs.items[i];
        if (dem_folder_is_meant(path))
            job->folder = path;
        else if (several)
            return cli_wrong_usage(tool, "several grains cannot all go to '%s'; name a folder with -o DIR/", path);
        else if (!dem_file_has_suffix(path, "csv") && !dem_file_has_suffix(path, "svg") &&
                 !dem_file_has_suffix(path, "html"))
            return cli_wrong_usage(tool, "a sweep writes .csv, .svg and .html, not '%s'; -o DIR/ for all three", path);
    }
    if (job->folder && job->outputs.count > 1)
        return cli_wrong_usage(tool, "give -o either a folder or files, not both");
    dem_error error;
    if (job->folder && dem_folder_create(job->folder, &error) != DEM_OK)
        return cli_error(tool, &error);
    if (job->folder)
        job->outputs = (cli_texts){0};
    return 0;
}

// every series has the parameters given for its method; one that no series has is a mistake
static int share_values(const cli_tool *tool, const cli_registry *known, dem_sweep *plan)
{
    const char *used[DEM_SWEEP_SERIES * DEM_PACK_VALUES];
    size_t used_count = 0;
    for (size_t s = 0; s < plan->series_count; s++) {
        dem_sweep_series *series = &plan->series[s];
        series->value_count = given_values(known, series->packer->name, series->values);
        dem_pack_options packing = {.method = series->packer->name, .values = series->values,
                                    .value_count = series->value_count};
        dem_error error;
        if (dem_pack_complete(&packing, &error) != DEM_OK)
            return cli_wrong_usage(tool, "%s", error.text);
        for (size_t i = 0; i < series->value_count; i++)
            used[used_count++] = series->values[i].name;
    }
    for (size_t k = 0; k < known->count; k++)
        for (size_t i = 0; i < known->entries[k].parameter_count; i++) {
            const char *name = known->entries[k].parameters[i].name;
            bool given = !isnan(known->values[k][i]), found = false;
            for (size_t u = 0; given && u < used_count; u++)
                found |= strcmp(used[u], name) == 0;
            if (given && !found)
                return cli_wrong_usage(tool, "--%s belongs to method %s, which is not in this sweep", name,
                                       known->entries[k].name);
        }
    return 0;
}

static int read_plan(const cli_tool *tool, const arguments *a, dem_sweep *plan)
{
    dem_error error;
    const char *methods = a->methods && *a->methods ? a->methods : a->method;
    if (a->spheres || a->gap > 0 || a->targets.count)
        return cli_wrong_usage(tool, "--sweep names the numbers of spheres itself; leave out -n, -e and --target");
    if (a->split || a->formats.count || a->exports || a->sheet || a->resume)
        return cli_wrong_usage(tool, "--sweep goes with none of --split, --format, --exports, --sheet and --resume");
    if (dem_sweep_read_counts(plan, a->sweep, &error) != DEM_OK)
        return cli_wrong_usage(tool, "--sweep: %s", error.text);
    if (dem_sweep_read_series(plan, methods, (dem_effort)a->effort, &error) != DEM_OK)
        return cli_wrong_usage(tool, "--methods: %s", error.text);
    return share_values(tool, &a->known, plan);
}

static int run_sweep(const cli_tool *tool, const arguments *a, job_options *job, const clump_inputs *inputs,
                     const char *command)
{
    sweep_options options = {.job = job, .json = a->common.json, .quiet = a->common.quiet, .command = command,
                             .threads = dem_threads(&(dem_ctx){.threads = (int)a->common.threads})};
    int status = read_plan(tool, a, &options.plan);
    for (size_t i = 0; status == 0 && i < inputs->count; i++)
        if (inputs->items[i].labels)
            return cli_wrong_usage(tool, "--sweep takes meshes, not volumes of labels as %s", inputs->items[i].path);
    if (status == 0)
        status = sort_sweep_outputs(tool, job, inputs->several);
    return status ? status : sweep_run(tool, &a->common, inputs, &options);
}

// ---- one grain or a batch

// "5 um" or "5um,5um,10um"
static dem_status parse_spacing(const char *text, dem_vec3 *spacing, dem_error *error)
{
    double x[3];
    char word[64];
    int count = 0;
    for (const char *at = text; at; count++) {
        size_t length = strcspn(at, ",");
        if (count == 3 || length >= sizeof word)
            return dem_fail(error, DEM_USAGE, "'%.60s' is no length or three as in 5um,5um,10um", text);
        snprintf(word, sizeof word, "%.*s", (int)length, at);
        DEM_TRY(dem_quantity(word, DEM_DIMENSION_LENGTH, &x[count], error));
        if (!(x[count] > 0 && x[count] < 1e20))
            return dem_fail(error, DEM_USAGE, "'%.60s' is not positive", word);
        at = at[length] ? at + length + 1 : NULL;
    }
    if (count == 2)
        return dem_fail(error, DEM_USAGE, "'%.60s' is no length or three as in 5um,5um,10um", text);
    *spacing = count == 1 ? (dem_vec3){x[0], x[0], x[0]} : (dem_vec3){x[0], x[1], x[2]};
    return DEM_OK;
}

// what is asked of many grains; says what does not go together
static int batch_options_from(const cli_tool *tool, const arguments *a, batch_options *batch)
{
    dem_error error;
    *batch = (batch_options){.sheet = a->sheet, .resume = a->resume, .labels = a->labels, .min_voxels = a->min_voxels,
                             .drop_border = a->drop_border};
    if (a->raw && dem_volume_raw_parse(a->raw, &batch->raw, &error) != DEM_OK)
        return cli_wrong_usage(tool, "--raw: %s", error.text);
    if (a->voxel_size && parse_spacing(a->voxel_size, &batch->spacing, &error) != DEM_OK)
        return cli_wrong_usage(tool, "--voxel-size: %s", error.text);
    if (a->labels && labels_parse(a->labels, &error) != DEM_OK)
        return cli_wrong_usage(tool, "--labels: %s", error.text);
    if (a->resume && a->split)
        return cli_wrong_usage(tool, "--resume cannot tell what --split has written; leave one out");
    return 0;
}

static int run_batch(const cli_tool *tool, arguments *a, job_options *options, const clump_inputs *inputs)
{
    bool several = inputs->several;
    batch_options batch;
    dem_error error;
    dem_pack_options packing = options->make.pack;  // the job completes its own
    if (dem_pack_complete(&packing, &error) != DEM_OK)
        return cli_wrong_usage(tool, "%s", error.text);
    int status = batch_options_from(tool, a, &batch);
    if (status == 0 && a->exports)
        status = outputs_exports(tool, a->exports, options, &a->formats);
    if (status != 0)
        return status;
    cli_texts files = {.items = calloc(a->outputs.count + 1, sizeof *files.items)};
    status = files.items ? outputs_sort(tool, options, several, &files, &batch.table, &batch.sheet)
                         : cli_error(tool, &(dem_error){.code = DEM_NO_MEMORY, .text = "out of memory"});
    if (status == 0) {
        job_results results = {0};
        if (!batch.table && (several || a->split) && !a->common.json && !a->common.quiet)
            batch.table = "-";
        batch.keep_results = a->common.json || !several;
        options->picture = batch.sheet != NULL;
        status = batch_run(tool, &a->common, inputs, options, &batch, &results);
        int printed = write_report(tool, a, options, &results, several);
        status = status ? status : printed;
        job_results_release(&results);
    }
    free(files.items);
    return status;
}

static int run(const cli_tool *tool, arguments *a, const clump_inputs *inputs, const char *command)
{
    int status = a->sweep ? 0 : cli_registry_check(tool, &a->known, a->method, "methods");
    if (status)
        return status;
    if (!a->sweep)
        a->value_count = given_values(&a->known, a->method, a->values);
    job_options options = job_options_from(a);
    dem_error error;
    if (a->unit && dem_unit(a->unit, DEM_DIMENSION_LENGTH, &options.unit, &error) != DEM_OK)
        return cli_wrong_usage(tool, "--unit: %s", error.text);
    if (a->inscribed && a->outer)
        return cli_wrong_usage(tool, "--inscribed and --outer exclude each other");
    if (!a->sweep && a->methods)
        return cli_wrong_usage(tool, "--methods with a list goes with --sweep, as in --sweep 10,50,200 --methods %s",
                               a->methods);
    dem_target *targets = NULL;
    status = read_targets(tool, &a->targets, &targets);
    options.make.pack.targets = targets;
    options.make.pack.target_count = a->targets.count;
    if (status == 0)
        status = a->sweep ? run_sweep(tool, a, &options, inputs, command) : run_batch(tool, a, &options, inputs);
    free(targets);
    return status;
}

// operands, folders and the list are made one
static int run_operands(const cli_tool *tool, arguments *a, const cli_texts *operands, const char *command)
{
    clump_inputs inputs;
    dem_error error;
    const clump_input_options options = {.list = a->list, .recursive = a->recursive, .raw = a->raw != NULL};
    int status = clump_inputs_collect(operands, &options, &inputs, &error) == DEM_OK
                     ? run(tool, a, &inputs, command)
                     : cli_error(tool, &error);
    clump_inputs_release(&inputs);
    return status;
}

// what stands before the options and has options of its own
typedef struct subcommand {
    const char *name;
    int (*run)(int argc, char **argv);
} subcommand;
static const subcommand subcommands[] = {{"convert", clump_convert}, {"verify", clump_verify}};

int main(int argc, char **argv)
{
    for (size_t i = 0; argc > 1 && i < sizeof subcommands / sizeof *subcommands; i++)
        if (strcmp(argv[1], subcommands[i].name) == 0)
            return subcommands[i].run(argc - 1, argv + 1);
    arguments a = default_arguments();
    const cli_option options[] = {
        {.help = "Spheres"},
        {"spheres", 'n', CLI_WHOLE, "N", "at most N spheres (default 50)", &a.spheres, 1, 100000},
        {"gap", 'e', CLI_PERCENT, "PCT", "instead: the fewest spheres whose IoU gap is at most PCT %", &a.gap, 1e-3, 99},
        {"target", 0, CLI_TEXTS, "MEASURE=VALUE",
         "instead: the fewest spheres for which all targets hold: gap=3%, distance=1%, hausdorff=5%, protrusion=2%, "
         "volume=1%, centre=1%, inertia=0.5%, normal=8deg, overlap=1.8, pieces=1; repeatable",
         &a.targets, 0, 0},
        {"max-spheres", 0, CLI_WHOLE, "N", "bound of -e and --target (default 2000)", &a.max_spheres, 1, 100000},
        {"effort", 0, CLI_CHOICE, effort_names, "how hard to search (default: default)", &a.effort, 0, 0},
        {"moments", 0, CLI_CHOICE, moments_names,
         "what the union of the spheres shall have exactly of the grain (default exact: volume, centre, inertia)",
         &a.moments, 0, 0},
        {"inscribed", 0, CLI_FLAG, NULL, "no sphere reaches outside the mesh", &a.inscribed, 0, 0},
        {"outer", 0, CLI_FLAG, NULL, "no part of the mesh is left uncovered", &a.outer, 0, 0},
        {"method", 0, CLI_TEXT, "NAME", "packing method (default optimal)", &a.method, 0, 0},
        {"methods", 0, CLI_WORDS, "[A,B]",
         "list the methods and leave; with --sweep those to compare, as in optimal,optimal:fast or all", &a.methods, 0,
         0},
        {"sweep", 0, CLI_TEXT, "N,N", "pack each of these numbers of spheres: errors against spheres and seconds; -o "
         "report.html, .csv, .svg, or DIR/", &a.sweep, 0, 0},
        {.help = "Mesh"},
        {"unit", 0, CLI_TEXT, "UNIT", "length unit of the file (default m)", &a.unit, 0, 0},
        {"size", 0, CLI_LENGTH, "D", "rescale to this equivalent-volume diameter, as in 2mm", &a.size, CLI_POSITIVE,
         INFINITY},
        {"density", 0, CLI_DENSITY, "RHO", "density, kg/m3 or with unit (default 2650)", &a.density, CLI_POSITIVE,
         INFINITY},
        {"mass-from", 0, CLI_CHOICE, mass_names, "whose mass, centre and inertia the clump gets (default mesh)",
         &a.mass_from, 0, 0},
        {"repair", 0, CLI_CHOICE, repair_names, "what to do with a faulty mesh (default auto)", &a.repair, 0, 0},
        {"wrap-detail", 0, CLI_PERCENT, "PCT", "smallest feature --repair wrap follows, % of the size (default 1)",
         &a.wrap_detail, 0.01, 50},
        {"keep", 0, CLI_CHOICE, keep_names, "what to do with several separate bodies (default one: refuse)", &a.keep, 0,
         0},
        {"split", 0, CLI_FLAG, NULL, "one clump per body", &a.split, 0, 0},
        {.help = "Many grains"},
        {"list", 0, CLI_TEXT, "FILE", "also the files it names, one path per line (from its folder); '-': standard input",
         &a.list, 0, 0},
        {"recursive", 0, CLI_FLAG, NULL, "of a folder also the folders in it", &a.recursive, 0, 0},
        {"sheet", 0, CLI_TEXT, "FILE", "one picture of all grains beside their clumps, PNG (with several, -o FILE.png is "
         "the same)", &a.sheet, 0, 0},
        {"resume", 0, CLI_FLAG, NULL, "leave out the grains whose files are there, whatever options made them", &a.resume, 0,
         0},
        {.help = "Images of labels"},
        {"labels", 0, CLI_TEXT, "LIST", "only these, as 3,7,10-20 (default: all but 0, the background)", &a.labels, 0, 0},
        {"min-voxels", 0, CLI_WHOLE, "N", "leave out labels of fewer voxels (default 500)", &a.min_voxels, 1, 0x1p53},
        {"drop-border", 0, CLI_FLAG, NULL, "leave out labels that the border of the image cuts", &a.drop_border, 0, 0},
        {"voxel-size", 0, CLI_TEXT, "D", "size of a voxel, as 5um or 5um,5um,10um (default: as the file says)", &a.voxel_size, 0,
         0},
        {"raw", 0, CLI_TEXT, "SIZES", "the files have no header but are as '512x512x300 uint16 little skip 0'", &a.raw, 0,
         0},
        {.help = "Output"},
        {"output", 'o', CLI_TEXTS, "FILE", "where to; the format follows the name; repeatable (default NAME.json)",
         &a.outputs, 0, 0},
        {"format", 0, CLI_TEXTS, "NAME", "format where the name does not tell: json, xyzr, vtp, stl, png, lammps, ...",
         &a.formats, 0, 0},
        {"exports", 0, CLI_TEXT, "LIST",
         "these formats, as in pfc,liggghts, into the folder of -o; engines: those of other programs; all: every one",
         &a.exports, 0, 0},
        {"frame", 0, CLI_CHOICE, frame_names,
         "frame of xyzr, vtp, stl (default principal; mesh: the file's own, in metres)", &a.frame, 0, 0},
        CLI_COMMON_OPTIONS(a.common),
    };
    static cli_option all[sizeof options / sizeof *options + CLI_REGISTRY_OPTIONS];
    memcpy(all, options, sizeof options);
    add_methods(&a.known);
    size_t count = cli_registry_options(&a.known, all, sizeof options / sizeof *options);
    const cli_tool tool = {"dem-clump", "MESH|FOLDER|IMAGE... [options]", about, all, count, epilogue};
    cli_texts inputs = {0};
    int status;
    if (cli_parse(&tool, argc, argv, &inputs, &status) == CLI_GO) {
        dem_buffer command = {0};
        put_command(&command, argc, argv);
        if (a.methods && !*a.methods && !a.sweep)
            status = list_methods(&tool, &a);
        else if (inputs.count == 0 && !a.list)
            status = cli_wrong_usage(&tool, "no mesh given");
        else
            status = run_operands(&tool, &a, &inputs, command.failed ? "dem-clump" : command.data);
        dem_buffer_release(&command);
    }
    cli_texts_release(&inputs);
    cli_texts_release(&a.outputs);
    cli_texts_release(&a.formats);
    cli_texts_release(&a.targets);
    return status;
}
