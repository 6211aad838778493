/// Makes irregular grain meshes on demand.
#include <string.h>
#include <unistd.h>

#include "base/file.h"
#include "base/units.h"
#include "grain_settings.h"
#include "mesh/harmonics.h"

enum { MOST_GRAINS = 100000 };
_Static_assert((int)CLI_PARAMETERS >= (int)DEM_GRAIN_PARAMS, "room for the parameters of a kind");

static void add_kinds(cli_registry *kinds)
{
    const dem_grain_kind *kind;
    while (kinds->count < CLI_ENTRIES && (kind = dem_grain_kind_at(kinds->count)))
        kinds->entries[kinds->count++] =
            (cli_entry){kind->name, kind->about, kind->paper, kind->params, kind->param_count};
}

// "40mm,20mm,10mm", or one length for a cube
static int read_block(const cli_tool *tool, settings *s)
{
    const char *at = s->block;
    for (int k = 0; k < 3; k++) {
        size_t length = strcspn(at, ",");
        char one[64];
        dem_error error;
        snprintf(one, sizeof one, "%.*s", (int)(length < 63 ? length : 63), at);
        if (dem_quantity(one, DEM_DIMENSION_LENGTH, &s->block_edges[k], &error) != DEM_OK)
            return cli_wrong_usage(tool, "--block: %s", error.text);
        if (!(s->block_edges[k] >= 1e-9 && s->block_edges[k] <= 1e9))
            return cli_wrong_usage(tool, "--block must be lengths from 1e-9 to 1e9 m, not '%s'", one);
        bool last = at[length] == 0;
        if (last && k == 0)
            s->block_edges[1] = s->block_edges[2] = s->block_edges[0];
        if (last && k != 1)
            return DEM_OK;
        if (last)
            break;
        at += length + 1;
    }
    return cli_wrong_usage(tool, "--block must be one length or three with commas, as in 40mm,20mm,10mm, not '%s'",
                           s->block);
}

// the first of the options given that do not go with what is made; NULL: none
static const char *stray_option(const settings *s)
{
    const dem_grain_options *o = &s->grain;
    const struct {
        const char *name;
        bool given, with_cells, with_fit;
    } options[] = {{"--count", s->count > 0, false, false},           {"--cells", s->cells > 0, true, false},
                   {"--block", s->block != NULL, true, false},        {"--siblings", s->siblings > 0, false, true},
                   {"--same-volume", s->same_volume, false, true},    {"--size", o->size > 0, false, true},
                   {"--elongation", o->elongation < 1, false, false}, {"--flatness", o->flatness < 1, false, false},
                   {"--dents", s->dents > 0, false, false},           {"--roughness", o->roughness > 0, false, false}};
    for (size_t i = 0; i < sizeof options / sizeof *options; i++)
        if (options[i].given && !(s->fit ? options[i].with_fit : options[i].with_cells))
            return options[i].name;
    return NULL;
}

// options that only mean something together
static int check_together(const cli_tool *tool, const settings *s, const dem_grain_kind *kind)
{
    const char *stray = s->fit || s->cells ? stray_option(s) : NULL;
    if (s->cells && kind != &dem_grain_rock)
        return cli_wrong_usage(tool, "--cells breaks a block of kind rock; add --kind rock");
    if (stray)
        return cli_wrong_usage(tool, "%s does not go together with %s", stray, s->fit ? "--fit" : "--cells");
    if (s->fit && kind != &dem_grain_harmonics)
        return cli_wrong_usage(tool, "--fit makes harmonics; leave --kind out");
    for (size_t i = 0; s->fit && i < kind->param_count; i++)
        if (!isnan(s->own_values[i]) && strcmp(kind->params[i].name, "degree") != 0)
            return cli_wrong_usage(tool, "--%s is what --fit finds out; leave it out", kind->params[i].name);
    if (!s->fit && (s->siblings || s->same_volume))
        return cli_wrong_usage(tool, "--siblings are those of a scan; name it with --fit");
    if (s->same_volume && s->grain.size > 0)
        return cli_wrong_usage(tool, "--same-volume and --size are two sizes; give one of them");
    if (s->siblings && (double)s->kept >= grain_degree(s))
        return cli_wrong_usage(tool, "--kept-degrees %ld leaves nothing to draw; take less than --degree, %.0f",
                               s->kept, grain_degree(s));
    if (s->block && !s->cells)
        return cli_wrong_usage(tool, "--block is broken into --cells; say how many");
    if ((s->grain.roughness > 0) != (s->grain.roughness_scale > 0))
        return cli_wrong_usage(tool, "--roughness and --roughness-scale need each other");
    return DEM_OK;
}

static int check_output(const cli_tool *tool, settings *s, dem_mesh_format *format)
{
    if (!s->output && (s->count || s->cells || s->siblings))
        return cli_wrong_usage(tool, "name the folder to write to, as in -o grains/");
    if (!s->output && isatty(STDOUT_FILENO))
        return cli_wrong_usage(tool, "name the file to write, as in -o grain.obj");
    s->output = s->output ? s->output : "-";
    s->folder = s->count || s->cells || s->siblings || dem_folder_is_meant(s->output);
    *format = (dem_mesh_format)s->format;
    if (s->folder) {
        if (strcmp(s->output, "-") == 0)
            return cli_wrong_usage(tool, "several grains do not fit on standard output; name a folder with -o");
        dem_mesh_format named;
        if (dem_mesh_format_of(s->output, &named))
            return cli_wrong_usage(tool, "'%s' names a file, but there is to be a folder of grains; end it in /",
                                   s->output);
        return DEM_OK;
    }
    if (strcmp(s->output, "-") == 0 && s->common.json)
        return cli_wrong_usage(tool, "--json and the mesh cannot both go to standard output; name a file with -o");
    if (strcmp(s->output, "-") != 0 && !dem_mesh_format_of(s->output, format))
        return cli_wrong_usage(tool, "'%s' names no known format; end it in .obj, .stl, .ply or .off", s->output);
    return DEM_OK;
}

// checks what the table cannot, then makes the grain
static int run(const cli_tool *tool, settings *s, const cli_texts *operands)
{
    if (operands->count)
        return cli_wrong_usage(tool, "unexpected '%s'; name the file to write with -o", operands->items[0]);
    if (s->list) {
        dem_buffer text = {0};
        (s->common.json ? cli_registry_list_json : cli_registry_list)(&s->kinds, &text);
        return cli_print(tool, &text);
    }
    int status = cli_registry_check(tool, &s->kinds, s->kind, "list");
    if (status != DEM_OK)
        return status;
    const dem_grain_kind *kind = dem_grain_kind_find(s->kind);
    s->own_values = s->kinds.values[cli_registry_find(&s->kinds, s->kind)];
    status = check_together(tool, s, kind);
    if (status == DEM_OK && s->block)
        status = read_block(tool, s);
    dem_error error;
    if (status == DEM_OK && dem_unit(s->unit, DEM_DIMENSION_LENGTH, &s->length_unit, &error) != DEM_OK)
        status = cli_wrong_usage(tool, "--unit: %s", error.text);
    dem_mesh_format format;
    if (status == DEM_OK)
        status = check_output(tool, s, &format);
    if (status != DEM_OK)
        return status;
    s->grain.kind = kind->name;
    s->grain.seed = (uint64_t)s->common.seed;
    s->grain.triangles = (size_t)s->triangles;
    s->grain.dents = (size_t)s->dents;
    s->grain.values = s->own_values;
    return (s->fit ? grain_make_fit : s->cells ? grain_make_cells : grain_make_kinds)(tool, s, format);
}

int main(int argc, char **argv)
{
    static settings s = {.common = CLI_COMMON_DEFAULTS,
                         .kind = "harmonics",
                         .unit = "m",
                         .triangles = 3000,
                         .kept = 2,
                         .block_edges = {0.01, 0.01, 0.01},
                         .kinds = {.what = "kind", .unset = "by the seed"}};
    s.grain = dem_grain_defaults();
    add_kinds(&s.kinds);
    const cli_option own[] = {
        {"kind", 'k', CLI_TEXT, "NAME", "what to make (default harmonics)", &s.kind, 0, 0},
        {"list", 0, CLI_FLAG, NULL, "list the kinds with their parameters", &s.list, 0, 0},
        {"output", 'o', CLI_TEXT, "FILE",
         "file to write: .obj, .stl, .ply or .off; - is standard output (OBJ); a folder where there are several",
         &s.output, 0, 0},
        {"count", 'n', CLI_WHOLE, "N", "a folder of so many grains, with the seeds from --seed on", &s.count, 1,
         MOST_GRAINS},
        {"format", 0, CLI_CHOICE, "obj|stl|ply|off", "of the files in a folder (default obj)", &s.format, 0, 0},
        {"size", 0, CLI_LENGTH, "D",
         "diameter of the sphere of equal volume (default 1 mm; ellipsoids and superquadrics "
         "are as their axes give them)",
         &s.grain.size, 1e-9, 1e9},
        {"triangles", 0, CLI_WHOLE, "N", "about so many (default 3000)", &s.triangles, DEM_GRAIN_MIN_TRIANGLES,
         DEM_GRAIN_MAX_TRIANGLES},
        {"elongation", 0, CLI_NUMBER, "X", "multiply y and z by this, 0.02 to 1 (default 1)", &s.grain.elongation,
         DEM_GRAIN_MIN_STRETCH, 1},
        {"flatness", 0, CLI_NUMBER, "X", "multiply z by this, 0.02 to 1 (default 1)", &s.grain.flatness,
         DEM_GRAIN_MIN_STRETCH, 1},
        {"dents", 0, CLI_WHOLE, "N", "hollows pressed into the surface (default 0)", &s.dents, 0, DEM_GRAIN_MAX_DENTS},
        {"dent-depth", 0, CLI_NUMBER, "X", "their depth over the radius, 0 to 0.8 (default 0.4)", &s.grain.dent_depth,
         0, DEM_GRAIN_MAX_DEPTH},
        {"dent-width", 0, CLI_NUMBER, "DEG", "angle from their middle to their rim, 5 to 90 degrees (default 45)",
         &s.grain.dent_width_deg, DEM_GRAIN_MIN_WIDTH, 90},
        {"roughness", 0, CLI_LENGTH, "D", "waves on the finished surface: their root mean square, along its normals",
         &s.grain.roughness, 1e-12, 1e9},
        {"roughness-scale", 0, CLI_LENGTH, "D", "and their wavelength; triangles become fine enough for it",
         &s.grain.roughness_scale, 1e-9, 1e9},
        {.help = "Whole blocks of kind rock"},
        {"cells", 0, CLI_WHOLE, "N", "all cells of one block, which they fill, as a folder", &s.cells, 1,
         DEM_FRACTURE_MAX_CELLS},
        {"block", 0, CLI_TEXT, "X,Y,Z", "its edges, or one length for a cube (default 10mm)", &s.block, 0, 0},
        {.help = "From a scan"},
        {"fit", 0, CLI_TEXT, "SCAN", "harmonics of a given mesh up to --degree, where it lies", &s.fit, 0, 0},
        {"unit", 0, CLI_TEXT, "NAME", "length unit of its coordinates (default m)", &s.unit, 0, 0},
        {"repair", 0, CLI_CHOICE, "auto|strict|wrap", "as in dem-clump, should it need any (default auto)", &s.repair,
         0, 0},
        {"siblings", 0, CLI_WHOLE, "N", "a folder of other grains with the spectrum of the scan", &s.siblings, 1,
         MOST_GRAINS},
        {"kept-degrees", 0, CLI_WHOLE, "N",
         "siblings keep the coefficients up to this degree: 2 the form, 0 nothing but the spectrum (default 2)",
         &s.kept, 0, DEM_HARMONICS_DEGREE},
        {"same-volume", 0, CLI_FLAG, NULL, "twin and siblings have exactly the volume of the scan", &s.same_volume, 0,
         0},
    };
    const cli_option common[] = {CLI_COMMON_OPTIONS(s.common)};
    cli_option options[MAX_OPTIONS];
    memcpy(options, own, sizeof own);
    size_t count = cli_registry_options(&s.kinds, options, sizeof own / sizeof *own);
    memcpy(options + count, common, sizeof common);
    count += sizeof common / sizeof *common;
    const cli_tool tool = {
        .name = "dem-grain",
        .usage = "[--kind NAME] [options] -o FILE",
        .about =
            "Makes irregular grain meshes: closed, free of self-intersections, the same for the same options and seed.",
        .options = options,
        .option_count = count,
        .epilogue = "Examples:\n"
                    "  dem-grain --seed 7 -o grain.obj\n"
                    "  dem-grain --kind facets --elongation 0.6 --size '20 mm' -o ballast.stl\n"
                    "  dem-grain --kind ellipsoid --dents 1 | dem-clump -\n"
                    "  dem-grain --kind rock --wear 0.2 --count 50 --size 30mm -o ballast/\n"
                    "  dem-grain --kind rock --cells 200 --block 40mm,20mm,20mm -o block/\n"
                    "  dem-grain --fit scan.stl --unit mm --siblings 20 -o sand/",
    };
    cli_texts operands = {0};
    int status;
    if (cli_parse(&tool, argc, argv, &operands, &status) == CLI_GO)
        status = run(&tool, &s, &operands);
    cli_texts_release(&operands);
    return status;
}
