/// Makes irregular grain meshes on demand.
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/file.h"
#include "base/memory.h"
#include "base/units.h"
#include "cli.h"
#include "cli_registry.h"
#include "math/vec.h"
#include "mesh/grain.h"
#include "mesh/mass.h"
#include "mesh/write.h"

enum { MAX_OPTIONS = 32 + CLI_REGISTRY_OPTIONS, DIGITS = 7 };
_Static_assert((int)CLI_PARAMETERS >= (int)DEM_GRAIN_PARAMS, "room for the parameters of a kind");

typedef struct settings {
    cli_common common;
    const char *kind, *output;
    bool list;
    long triangles, dents;
    dem_grain_options grain;
    cli_registry kinds;
} settings;

static void add_kinds(cli_registry *kinds)
{
    const dem_grain_kind *kind;
    while (kinds->count < CLI_ENTRIES && (kind = dem_grain_kind_at(kinds->count)))
        kinds->entries[kinds->count++] =
            (cli_entry){kind->name, kind->about, kind->paper, kind->params, kind->param_count};
}

// the line that made the grain, kept in the file
static void put_origin(dem_buffer *out, const settings *s, const dem_grain_kind *kind, const double *values)
{
    dem_grain_options standard = dem_grain_defaults();
    const dem_grain_options *o = &s->grain;
    dem_buffer_print(out, "dem-grain --kind %s --seed %ld --triangles %zu", kind->name, s->common.seed, o->triangles);
    for (size_t i = 0; i < kind->param_count; i++)
        if (!isnan(values[i])) {
            dem_buffer_print(out, " --%s ", kind->params[i].name);
            dem_buffer_number(out, values[i], 15);
        }
    const struct {
        const char *name;
        double value, standard;
    } rest[] = {{"elongation", o->elongation, standard.elongation},
                {"flatness", o->flatness, standard.flatness},
                {"dents", (double)o->dents, 0},
                {"dent-depth", o->dent_depth, standard.dent_depth},
                {"dent-width", o->dent_width_deg, standard.dent_width_deg},
                {"size", o->size, 0}};
    for (size_t i = 0; i < sizeof rest / sizeof *rest; i++)
        if (rest[i].value != rest[i].standard) {
            dem_buffer_print(out, " --%s ", rest[i].name);
            dem_buffer_number(out, rest[i].value, 15);
        }
}

typedef struct measures {
    double volume, diameter;
    dem_vec3 extent;
} measures;

static measures measure(const dem_mesh *mesh)
{
    measures m = {0};
    dem_box box = dem_mesh_box(mesh);
    m.extent = v3_sub(box.high, box.low);
    m.volume = dem_mesh_solid(mesh).volume;
    m.diameter = cbrt(6 * m.volume / DEM_PI);
    return m;
}

static void put_summary(dem_buffer *out, const settings *s, const dem_mesh *mesh, const measures *m)
{
    double factor;
    const char *unit = dem_length_unit(fmax(m->extent.x, fmax(m->extent.y, m->extent.z)), &factor);
    dem_buffer_print(out, "%s: %s, seed %ld\n", s->output, s->grain.kind, s->common.seed);
    dem_buffer_print(out, "  triangles            %zu, %zu vertices, closed\n", mesh->triangle_count,
                     mesh->vertex_count);
    dem_buffer_text(out, "  equivalent diameter  ");
    dem_buffer_number(out, m->diameter * factor, 5);
    dem_buffer_print(out, " %s\n  extent x, y, z       ", unit);
    for (int k = 0; k < 3; k++) {
        dem_buffer_number(out, v3_get(m->extent, k) * factor, 5);
        dem_buffer_text(out, k < 2 ? " x " : " ");
    }
    dem_buffer_print(out, "%s\n  volume               ", unit);
    dem_buffer_number(out, m->volume, 5);
    dem_buffer_text(out, " m3\n");
}

static void put_json(dem_buffer *out, const settings *s, const dem_mesh *mesh, const measures *m, const char *origin,
                     cli_session *session)
{
    dem_json_writer json = dem_json_begin(out);
    dem_json_open_object(&json, NULL);
    dem_json_put_string(&json, "file", s->output);
    dem_json_put_string(&json, "kind", s->grain.kind);
    dem_json_put_whole(&json, "seed", s->common.seed);
    dem_json_put_string(&json, "command", origin);
    dem_json_put_whole(&json, "vertices", (int64_t)mesh->vertex_count);
    dem_json_put_whole(&json, "triangles", (int64_t)mesh->triangle_count);
    dem_json_put_number(&json, "volume", m->volume);
    dem_json_put_number(&json, "equivalent_diameter", m->diameter);
    dem_json_put_numbers(&json, "extent", (double[]){m->extent.x, m->extent.y, m->extent.z}, 3);
    cli_put_warnings(session, &json);
    dem_json_put_string(&json, "version", dem_version());
    dem_json_close(&json, '}');
}

static int make(const cli_tool *tool, const settings *s, dem_mesh_format format, const double *values)
{
    cli_session session;
    cli_begin(&session, tool, &s->common);
    dem_ctx ctx = cli_ctx(&session, NULL);
    dem_error error;
    dem_mesh mesh = {0};
    dem_buffer origin = {0}, file = {0}, report = {0};
    int status = DEM_OK;
    if (dem_grain_make(&ctx, &s->grain, &mesh, &error) != DEM_OK) {
        status = cli_session_error(&session, &error);
        goto done;
    }
    put_origin(&origin, s, dem_grain_kind_find(s->grain.kind), values);
    dem_mesh_put(&mesh, format, origin.data, DIGITS, &file);
    if (cli_interrupted())
        status = dem_fail(&error, DEM_INTERRUPTED, "interrupted; nothing was written");
    else
        status = dem_file_write_buffer(s->output, &file, &error);
    if (status != DEM_OK) {
        status = cli_session_error(&session, &error);
        goto done;
    }
    if (strcmp(s->output, "-") != 0 && (s->common.json || !s->common.quiet)) {
        measures m = measure(&mesh);
        if (s->common.json)
            put_json(&report, s, &mesh, &m, origin.data, &session);
        else
            put_summary(&report, s, &mesh, &m);
        status = cli_print(tool, &report);
    }
done:
    dem_buffer_release(&origin);
    dem_buffer_release(&file);
    dem_mesh_free(&mesh);
    cli_end(&session);
    return status;
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
    int wrong = cli_registry_check(tool, &s->kinds, s->kind, "list");
    if (wrong)
        return wrong;
    const double *values = s->kinds.values[cli_registry_find(&s->kinds, s->kind)];
    if (!s->output && isatty(STDOUT_FILENO))
        return cli_wrong_usage(tool, "name the file to write, as in -o grain.obj");
    s->output = s->output ? s->output : "-";
    dem_mesh_format format = DEM_MESH_OBJ;
    if (strcmp(s->output, "-") == 0 && s->common.json)
        return cli_wrong_usage(tool, "--json and the mesh cannot both go to standard output; name a file with -o");
    if (strcmp(s->output, "-") != 0 && !dem_mesh_format_of(s->output, &format))
        return cli_wrong_usage(tool, "'%s' names no known format; end it in .obj, .stl, .ply or .off", s->output);
    s->grain.kind = s->kind;
    s->grain.seed = (uint64_t)s->common.seed;
    s->grain.triangles = (size_t)s->triangles;
    s->grain.dents = (size_t)s->dents;
    s->grain.values = values;
    return make(tool, s, format, values);
}

int main(int argc, char **argv)
{
    static settings s = {.common = CLI_COMMON_DEFAULTS, .kind = "harmonics", .triangles = 3000,
                         .kinds = {.what = "kind", .unset = "by the seed"}};
    s.grain = dem_grain_defaults();
    add_kinds(&s.kinds);
    const cli_option own[] = {
        {"kind", 'k', CLI_TEXT, "NAME", "what to make (default harmonics)", &s.kind, 0, 0},
        {"list", 0, CLI_FLAG, NULL, "list the kinds with their parameters", &s.list, 0, 0},
        {"output", 'o', CLI_TEXT, "FILE", "file to write: .obj, .stl, .ply or .off; - is standard output (OBJ)",
         &s.output, 0, 0},
        {"size", 0, CLI_LENGTH, "D",
         "diameter of the sphere of equal volume (default 1 mm; an ellipsoid's is as its axes "
         "give it)",
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
                    "  dem-grain --kind ellipsoid --dents 1 | dem-clump -",
    };
    cli_texts operands = {0};
    int status;
    if (cli_parse(&tool, argc, argv, &operands, &status) == CLI_GO)
        status = run(&tool, &s, &operands);
    cli_texts_release(&operands);
    return status;
}
