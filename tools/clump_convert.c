#include "clump_convert.h"

#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "base/file.h"
#include "base/hash.h"
#include "base/units.h"
#include "clump/file.h"
#include "clump/import.h"
#include "clump_inputs.h"
#include "clump_outputs.h"
#include "clump_report.h"

// what the option table fills
typedef struct arguments {
    cli_common common;
    cli_texts outputs, formats;
    const char *exports, *from, *unit, *mass_unit, *mesh, *mesh_unit, *mass, *name;
    double density, size;
    int mass_from, frame;
} arguments;

// one run: what is asked, what every file needs, what came of each
typedef struct conversion {
    const arguments *arguments;
    job_options job;
    dem_import_options options;
    const dem_importer *importer;  // NULL: as the content says
    const char *mesh_file;
    dem_mesh mesh;
    double mesh_unit;  ///< [m]
    char mesh_sha256[65];
    job_results results;
    dem_import_report *reports;  // of each result
    const char **kinds;
} conversion;

static const char about[] =
    "Reads clumps of other programs and writes them as clumps of ours or in the format of any engine. What a file "
    "tells of "
    "mass, centre and inertia is kept and compared with the union of its spheres; what it does not tell is that of the "
    "union, exactly. '-' reads standard input. Several files are a batch.";

static const char frame_names[] = "principal|mesh", mass_names[] = "file|union|mesh";

// ---- one file

static dem_status read_mesh(const dem_ctx *ctx, conversion *c, const char *path, dem_error *error)
{
    dem_repair_options repair = {.repair = DEM_REPAIR_AUTO, .keep = DEM_KEEP_ALL};
    dem_mesh_report report;
    c->mesh_file = path;
    DEM_TRY(dem_mesh_import(ctx, path, &c->mesh, error));
    DEM_TRY(dem_sha256_file(path, c->mesh_sha256, error));
    dem_mesh_scale(&c->mesh, c->mesh_unit);
    DEM_TRY(dem_mesh_repair(ctx, &c->mesh, &repair, &report, error));
    c->options.mesh = &c->mesh;
    return DEM_OK;
}

// where the name of the output is not typed it must not be that of the input
static dem_status refuse_itself(const job_options *o, const char *input, const char *name, dem_error *error)
{
    struct stat in, out;
    if ((o->outputs.count && !o->folder) || strcmp(input, "-") == 0 || stat(input, &in) != 0)
        return DEM_OK;
    size_t count = o->formats.count ? o->formats.count : 1;
    for (size_t i = 0; i < count; i++) {
        const dem_exporter *exporter = dem_exporter_find(o->formats.count ? o->formats.items[i] : "json");
        char *path = dem_path_join(o->folder ? o->folder : ".", "%s.%s", name, exporter->suffix);
        bool same = path && stat(path, &out) == 0 && in.st_dev == out.st_dev && in.st_ino == out.st_ino;
        free(path);
        if (same)
            return dem_fail_at(error, DEM_USAGE, input, 0, "would be overwritten; choose another folder with -o DIR/");
    }
    return DEM_OK;
}

static dem_status convert(const dem_ctx *ctx, conversion *c, const char *input, job_result *r, dem_import *import,
                          dem_import_report *report, dem_error *error)
{
    dem_import_options options = c->options;
    char sha256[65] = "";
    const dem_importer *used;
    DEM_TRY(refuse_itself(&c->job, input, r->name, error));
    DEM_TRY(dem_import_read(ctx, input, c->importer, import, &used, error));
    if (strcmp(input, "-") != 0)
        DEM_TRY(dem_sha256_file(input, sha256, error));
    options.source_mesh = dem_file_name(c->mesh_file ? c->mesh_file : import->file);
    options.source_sha256 = c->mesh_file ? c->mesh_sha256 : sha256;
    if (!*import->name && !options.name && !import->clump)
        options.name = r->name;
    DEM_TRY(dem_import_clump(import, &options, &r->clump, report, error));
    return job_write(ctx, &c->job, r, options.mesh, error);
}

static void convert_file(const dem_ctx *ctx, conversion *c, const clump_input *asked)
{
    size_t at = c->results.count++;
    job_result *r = &c->results.items[at];
    const char *input = asked->path;
    dem_import import = {0};
    *r = (job_result){.input = input};
    snprintf(r->name, sizeof r->name, "%s", asked->name);
    r->status = convert(ctx, c, input, r, &import, &c->reports[at], &r->error);
    c->kinds[at] = import.format ? import.format : "";
    if (r->status != DEM_OK && !r->error.file[0])
        snprintf(r->error.file, sizeof r->error.file, "%s", strcmp(input, "-") ? input : "standard input");
    dem_import_release(&import);
}

// ---- what is told

static void text_report(dem_buffer *out, const conversion *c, size_t at)
{
    const job_result *r = &c->results.items[at];
    const dem_import_report *found = &c->reports[at];
    dem_clump_def def = dem_clump_view(r->clump);
    double factor, union_mass = def.union_volume * found->density;
    const char *unit = dem_length_unit(cbrt(def.volume), &factor);
    double cube = factor * factor * factor;
    char name[32];
    dem_buffer_print(out, "%s: %zu spheres from %s\n\n  %-18s %15s %18s    difference\n", def.name, def.ball_count,
                     c->kinds[at], "", "file", "union of spheres");
    snprintf(name, sizeof name, "volume [%s^3]", unit);
    report_compare(out, name, found->volume * cube, def.union_volume * cube);
    report_compare(out, "mass   [kg]", found->mass, union_mass);
    for (int i = 0; i < 3; i++) {
        snprintf(name, sizeof name, "I%d     [kg m^2]", i + 1);
        report_compare(out, name, found->inertia[i], def.union_inertia[i]);
    }
    if (!isnan(found->centre_offset)) {
        dem_buffer_text(out, "  the centres are ");
        dem_buffer_number(out, found->centre_offset * factor, 3);
        dem_buffer_print(out, " %s apart\n", unit);
    }
    static const char *const sources[] = {"the mesh", "the union", "the file, and of the union where it is silent"};
    dem_buffer_print(out, "  the clump has the mass, centre and inertia of %s; density ", sources[def.mass_from]);
    dem_buffer_number(out, def.density, 6);
    dem_buffer_print(out, " kg/m^3\n\n  %zu of the spheres show, in %zu %s; overlap ratio %.3f\n",
                     def.ball_count - found->redundant, found->pieces, found->pieces == 1 ? "piece" : "pieces",
                     def.fidelity.overlap_ratio);
    if (!isnan(def.fidelity.iou_gap))
        dem_buffer_print(out, "  against the mesh: IoU gap %.3f %%, largest surface distance %.2f %% of d_eq\n",
                         100 * def.fidelity.iou_gap, 100 * def.fidelity.distance_max);
    for (size_t i = 0; i < r->output_count; i++)
        if (strcmp(r->outputs[i], "-"))
            dem_buffer_print(out, "%s  wrote %s\n", i ? "" : "\n", r->outputs[i]);
}

static void json_one(dem_json_writer *w, const conversion *c, size_t at)
{
    const job_result *r = &c->results.items[at];
    const dem_import_report *found = &c->reports[at];
    dem_json_put_string(w, "input", r->input);
    dem_json_put_string(w, "format", c->kinds[at]);
    dem_json_put_string(w, "status", r->status == DEM_OK ? "done" : "failed");
    if (r->status != DEM_OK)
        report_put_error(w, &r->error);
    if (r->clump) {
        dem_clump_def def = dem_clump_view(r->clump);
        dem_json_put_whole(w, "spheres", (int64_t)def.ball_count);
        dem_json_put_whole(w, "duplicates", (int64_t)found->duplicates);
        dem_json_put_whole(w, "redundant", (int64_t)found->redundant);
        dem_clump_put_figures(w, &def);
        dem_json_open_object(w, "file");
        dem_json_put_number(w, "mass", found->mass);
        dem_json_put_number(w, "volume", found->volume);
        dem_json_put_numbers(w, "inertia", found->inertia, 3);
        dem_json_put_number(w, "centre_offset", found->centre_offset);
        dem_json_put_number(w, "moment_residual", found->moment_residual);
        dem_json_close(w, '}');
    }
    report_put_texts(w, "outputs", r->outputs, r->output_count);
}

static void json_report(dem_buffer *out, const conversion *c, cli_session *session, bool several)
{
    dem_json_writer w = dem_json_begin(out);
    size_t failed = 0;
    dem_json_open_object(&w, NULL);
    if (several)
        dem_json_open_array(&w, "clumps", true);
    for (size_t i = 0; i < c->results.count; i++) {
        failed += c->results.items[i].status != DEM_OK;
        if (several)
            dem_json_open_object(&w, NULL);
        json_one(&w, c, i);
        if (several)
            dem_json_close(&w, '}');
    }
    if (several) {
        dem_json_close(&w, ']');
        dem_json_put_whole(&w, "failed", (int64_t)failed);
    }
    cli_put_warnings(session, &w);
    dem_json_close(&w, '}');
}

static void csv_report(dem_buffer *out, const conversion *c)
{
    dem_buffer_text(out, "input,name,status,format,spheres,pieces,duplicates,mass_kg,volume_m3,density_kgm3,"
                         "inertia1_kgm2,inertia2_kgm2,inertia3_kgm2,union_volume_m3,moment_residual,iou_gap,message\n");
    for (size_t i = 0; i < c->results.count; i++) {
        const job_result *r = &c->results.items[i];
        const dem_import_report *found = &c->reports[i];
        dem_clump_def d = {0};
        if (r->clump)
            d = dem_clump_view(r->clump);
        report_csv_text(out, r->input);
        dem_buffer_text(out, ",");
        report_csv_text(out, r->name);
        dem_buffer_print(out, ",%s,%s,%zu,%zu,%zu", r->status == DEM_OK ? "done" : "failed", c->kinds[i], d.ball_count,
                         found->pieces, found->duplicates);
        const double values[] = {d.mass,
                                 d.volume,
                                 d.density,
                                 d.inertia[0],
                                 d.inertia[1],
                                 d.inertia[2],
                                 d.union_volume,
                                 found->moment_residual,
                                 d.fidelity.iou_gap};
        for (size_t k = 0; k < sizeof values / sizeof *values; k++) {
            dem_buffer_text(out, ",");
            if (r->clump && isfinite(values[k]))
                dem_buffer_number(out, values[k], 10);
        }
        dem_buffer_text(out, ",");
        report_csv_text(out, r->status == DEM_OK ? "" : r->error.text);
        dem_buffer_text(out, "\n");
    }
}

static int tell(const cli_tool *tool, conversion *c, cli_session *session, bool several, const char *table)
{
    const arguments *a = c->arguments;
    dem_buffer text = {0};
    dem_error error;
    bool to_stdout = false;
    for (size_t i = 0; i < c->job.outputs.count; i++)
        to_stdout |= strcmp(c->job.outputs.items[i], "-") == 0;
    if (table) {
        csv_report(&text, c);
        if (dem_file_write_buffer(table, &text, &error) != DEM_OK)
            return cli_error(tool, &error);
    }
    if (a->common.json && !to_stdout)
        json_report(&text, c, session, several);
    else if (!a->common.quiet && !to_stdout && several && !table)
        csv_report(&text, c);
    else if (!a->common.quiet && !to_stdout && !several && c->results.items[0].status == DEM_OK)
        text_report(&text, c, 0);
    return text.size ? cli_print(tool, &text) : 0;
}

// ---- all files

static int convert_files(const cli_tool *tool, conversion *c, const clump_inputs *inputs, const char *table)
{
    cli_session session;
    dem_error error;
    dem_status worst = DEM_OK;
    int status = 0;
    cli_begin(&session, tool, &c->arguments->common);
    session.jobs = inputs->count;
    if (c->arguments->mesh) {
        dem_ctx ctx = cli_ctx(&session, c->arguments->mesh);
        if (read_mesh(&ctx, c, c->arguments->mesh, &error) != DEM_OK) {
            if (!error.file[0])
                snprintf(error.file, sizeof error.file, "%s", c->arguments->mesh);
            status = cli_session_error(&session, &error);
        }
    }
    for (size_t i = 0; status == 0 && i < inputs->count && !cli_interrupted(); i++) {
        const char *path = inputs->items[i].path;
        dem_ctx ctx = cli_ctx(&session, strcmp(path, "-") ? path : "standard input");
        convert_file(&ctx, c, &inputs->items[i]);
        if (c->results.items[i].status != DEM_OK) {
            worst = c->results.items[i].status;
            cli_session_error(&session, &c->results.items[i].error);
        }
        cli_job_done(&session);
    }
    cli_end(&session);
    if (status == 0 && c->results.count)
        status = tell(tool, c, &session, inputs->several, table);
    return status == 0 ? outputs_status(worst, worst != DEM_OK && inputs->several) : status;
}

static int check(const cli_tool *tool, const arguments *a, const cli_texts *inputs, conversion *c)
{
    dem_error error;
    if (inputs->count == 0)
        return cli_wrong_usage(tool, "no clump given");
    if (a->outputs.count == 0 && a->formats.count == 0 && !a->exports)
        return cli_wrong_usage(tool, "say where to with -o FILE");
    if (inputs->count > 1 && (a->mesh || a->name))
        return cli_wrong_usage(tool, "--mesh and --name are for one file");
    if (a->mass_from == DEM_IMPORT_MESH && !a->mesh)
        return cli_wrong_usage(tool, "--mass-from mesh needs --mesh FILE");
    if (a->from && !(c->importer = dem_importer_find(a->from))) {
        char known[128] = "";
        for (const dem_importer *const *i = dem_importers(); *i; i++)
            snprintf(known + strlen(known), sizeof known - strlen(known), " %s", (*i)->name);
        return cli_wrong_usage(tool, "--from: unknown format '%s'; use one of:%s", a->from, known);
    }
    if (a->unit && dem_unit(a->unit, DEM_DIMENSION_LENGTH, &c->options.unit, &error) != DEM_OK)
        return cli_wrong_usage(tool, "--unit: %s", error.text);
    c->mesh_unit = c->options.unit;
    if (a->mesh_unit && dem_unit(a->mesh_unit, DEM_DIMENSION_LENGTH, &c->mesh_unit, &error) != DEM_OK)
        return cli_wrong_usage(tool, "--mesh-unit: %s", error.text);
    if (a->mass_unit && dem_unit(a->mass_unit, DEM_DIMENSION_MASS, &c->options.mass_unit, &error) != DEM_OK)
        return cli_wrong_usage(tool, "--mass-unit: %s", error.text);
    if (a->mass && dem_quantity(a->mass, DEM_DIMENSION_MASS, &c->options.mass, &error) != DEM_OK)
        return cli_wrong_usage(tool, "--mass: %s", error.text);
    if (a->mass && !(c->options.mass > 0))
        return cli_wrong_usage(tool, "--mass must be a mass above 0 kg, not '%s'", a->mass);
    return 0;
}

static int run(const cli_tool *tool, arguments *a, const cli_texts *operands)
{
    conversion c = {.arguments = a, .options = dem_import_defaults()};
    const char *table = NULL;
    int status = check(tool, a, operands, &c);
    if (status)
        return status;
    c.options.unit_name = a->mesh_unit ? a->mesh_unit : a->unit ? a->unit : "m";
    c.options.density = a->density;
    c.options.size = a->size;
    c.options.mass_from = (dem_import_mass)a->mass_from;
    c.options.name = a->name;
    c.job = (job_options){.frame = (dem_frame)a->frame, .outputs = a->outputs, .formats = a->formats};
    status = a->exports ? outputs_exports(tool, a->exports, &c.job, &a->formats) : 0;
    if (status)
        return status;
    cli_texts files = {.items = calloc(a->outputs.count + 1, sizeof *files.items)};
    c.results.items = calloc(operands->count, sizeof *c.results.items);
    c.reports = calloc(operands->count, sizeof *c.reports);
    c.kinds = calloc(operands->count, sizeof *c.kinds);
    clump_inputs inputs;
    dem_error error;
    bool named = clump_inputs_files(operands, &inputs, &error) == DEM_OK;
    if (!named || !files.items || !c.results.items || !c.reports || !c.kinds)
        status = cli_error(tool, &(dem_error){.code = DEM_NO_MEMORY, .text = "out of memory; convert fewer files"});
    else
        status = outputs_sort(tool, &c.job, inputs.several, &files, &table, NULL);
    if (status == 0)
        status = convert_files(tool, &c, &inputs, table);
    job_results_release(&c.results);
    dem_mesh_free(&c.mesh);
    clump_inputs_release(&inputs);
    free(files.items);
    free(c.reports);
    free(c.kinds);
    return status;
}

int clump_convert(int argc, char **argv)
{
    arguments a = {.common = CLI_COMMON_DEFAULTS};
    dem_buffer epilogue = {0};
    dem_buffer_text(&epilogue, "Formats read:\n");
    for (const dem_importer *const *i = dem_importers(); *i; i++)
        dem_buffer_print(&epilogue, "  %-9s %s\n", (*i)->name, (*i)->about);
    dem_buffer_text(&epilogue,
                    "Examples:\n"
                    "  dem-clump convert rock.mol -o rock.json -o rock.png     a LAMMPS molecule\n"
                    "  dem-clump convert rock.txt --unit mm --mesh rock.stl -o rock.json\n"
                    "  dem-clump convert rock.json --size 2mm -o rock.xyzr     ours, rescaled\n"
                    "Exit status: 0 done, 1 failed, 2 wrong usage, 3 bad input, 4 cannot write, 130 interrupted.");
    const cli_option options[] = {
        {.help = "Input"},
        {"from", 0, CLI_TEXT, "NAME", "format of the files (default: as the content says, then the name)", &a.from, 0,
         0},
        {"unit", 0, CLI_TEXT, "UNIT", "length unit of the files (default m)", &a.unit, 0, 0},
        {"mass-unit", 0, CLI_TEXT, "UNIT", "mass unit of the files (default kg)", &a.mass_unit, 0, 0},
        {"mesh", 0, CLI_TEXT, "FILE", "the grain's mesh in the frame of the file: measures fidelity and shape", &a.mesh,
         0, 0},
        {"mesh-unit", 0, CLI_TEXT, "UNIT", "length unit of the mesh (default: that of --unit)", &a.mesh_unit, 0, 0},
        {.help = "Clump"},
        {"name", 0, CLI_TEXT, "NAME", "name of the clump (default: the file's)", &a.name, 0, 0},
        {"density", 0, CLI_DENSITY, "RHO", "density, kg/m3 or with unit (default: the file's, else 2650)", &a.density,
         CLI_POSITIVE, INFINITY},
        {"mass", 0, CLI_TEXT, "M", "mass, kg or with unit (default: the file's, else density x volume)", &a.mass, 0, 0},
        {"size", 0, CLI_LENGTH, "D", "rescale to this equivalent-volume diameter, as in 2mm", &a.size, CLI_POSITIVE,
         INFINITY},
        {"mass-from", 0, CLI_CHOICE, mass_names,
         "whose mass, centre and inertia the clump gets (default file; what it lacks is the union's)", &a.mass_from, 0,
         0},
        {.help = "Output"},
        {"output", 'o', CLI_TEXTS, "FILE", "where to; the format follows the name; a folder for several; repeatable",
         &a.outputs, 0, 0},
        {"format", 0, CLI_TEXTS, "NAME", "format to write where the name does not tell", &a.formats, 0, 0},
        {"exports", 0, CLI_TEXT, "LIST",
         "these formats, as in pfc,liggghts, into the folder of -o; engines: those of other programs; all: every one",
         &a.exports, 0, 0},
        {"frame", 0, CLI_CHOICE, frame_names,
         "frame of the formats that have only spheres (default principal; mesh: the source's own, in metres)", &a.frame,
         0, 0},
        CLI_COMMON_OPTIONS(a.common),
    };
    const cli_tool tool = {
        "dem-clump convert", "FILE... -o OUT [options]", about, options, sizeof options / sizeof *options,
        epilogue.data};
    cli_texts inputs = {0};
    int status;
    if (cli_parse(&tool, argc, argv, &inputs, &status) == CLI_GO)
        status = run(&tool, &a, &inputs);
    cli_texts_release(&inputs);
    cli_texts_release(&a.outputs);
    cli_texts_release(&a.formats);
    dem_buffer_release(&epilogue);
    return status;
}
