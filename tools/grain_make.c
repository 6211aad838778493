// What dem-grain makes: kinds by seeds, blocks of cells, twins and siblings of scans.
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "base/memory.h"
#include "grain_family.h"
#include "math/vec.h"

enum { CELL_DIGITS = 17, TWIN_DIGITS = 9, HOPELESS = 3 };

// options that differ from what they are without being given
static void put_rest(dem_buffer *out, const dem_grain_options *o)
{
    dem_grain_options standard = dem_grain_defaults();
    const struct {
        const char *name;
        double value, standard;
    } rest[] = {{"elongation", o->elongation, standard.elongation},
                {"flatness", o->flatness, standard.flatness},
                {"dents", (double)o->dents, 0},
                {"dent-depth", o->dent_depth, standard.dent_depth},
                {"dent-width", o->dent_width_deg, standard.dent_width_deg},
                {"size", o->size, 0},
                {"roughness", o->roughness, 0},
                {"roughness-scale", o->roughness_scale, 0}};
    for (size_t i = 0; i < sizeof rest / sizeof *rest; i++)
        if (rest[i].value != rest[i].standard) {
            dem_buffer_print(out, " --%s ", rest[i].name);
            dem_buffer_number(out, rest[i].value, 15);
        }
}

// the line that makes a grain, or `count` of them, kept in the file
static void put_origin(dem_buffer *out, const settings *s, long seed, long count)
{
    const dem_grain_kind *kind = dem_grain_kind_find(s->grain.kind);
    dem_buffer_print(out, "dem-grain --kind %s --seed %ld --triangles %zu", kind->name, seed, s->grain.triangles);
    for (size_t i = 0; i < kind->param_count; i++)
        if (!isnan(s->own_values[i])) {
            dem_buffer_print(out, " --%s ", kind->params[i].name);
            dem_buffer_number(out, s->own_values[i], 15);
        }
    put_rest(out, &s->grain);
    if (count)
        dem_buffer_print(out, " --count %ld", count);
}

// "rock-0042", wide enough for the last one
static void put_name(char *name, size_t size, const char *what, long number, long last)
{
    snprintf(name, size, "%s-%0*ld", what, snprintf(NULL, 0, "%ld", last), number);
}

// a seed that could not be made: warns and goes on, or ends it. `failures` are those before the first success
static int take_failure(grain_family *f, const dem_error *error, long seed, long failures)
{
    bool others_too = error->code != DEM_USAGE || f->wanted == 1 || (f->made == 0 && failures >= HOPELESS);
    if (others_too)
        return cli_session_error(&f->session, error);
    dem_ctx ctx = cli_ctx(&f->session, NULL);
    dem_log(&ctx, DEM_LOG_WARNING, "seed %ld left out: %s", seed, error->text);
    return DEM_OK;
}

static dem_status make_seed(grain_family *f, const dem_ctx *ctx, long seed, long last, dem_error *error)
{
    dem_grain_options options = f->s->grain;
    options.seed = (uint64_t)seed;
    dem_mesh mesh;
    DEM_TRY(dem_grain_make(ctx, &options, &mesh, error));
    dem_buffer origin = {0};
    char name[48];
    put_origin(&origin, f->s, seed, 0);
    put_name(name, sizeof name, options.kind, seed, last);
    dem_status status = grain_family_add(f, &mesh, name, seed, origin.data, error);
    dem_buffer_release(&origin);
    dem_mesh_free(&mesh);
    return status;
}

int grain_make_kinds(const cli_tool *tool, const settings *s, dem_mesh_format format)
{
    long count = s->count ? s->count : 1, last = s->common.seed + count - 1, failures = 0;
    grain_family f;
    int status = grain_family_begin(&f, tool, s, format, (size_t)count, s->grain.kind);
    dem_ctx ctx = cli_ctx(&f.session, NULL);
    dem_error error;
    for (long seed = s->common.seed; seed <= last && status == DEM_OK; seed++)
        if (make_seed(&f, &ctx, seed, last, &error) != DEM_OK)
            status = take_failure(&f, &error, seed, ++failures);
    dem_buffer command = {0};
    put_origin(&command, s, s->common.seed, s->count);
    status = grain_family_end(&f, command.data, status);
    dem_buffer_release(&command);
    return status;
}

static void put_cells_command(dem_buffer *out, const settings *s)
{
    put_origin(out, s, s->common.seed, 0);
    dem_buffer_print(out, " --cells %ld --block ", s->cells);
    for (int k = 0; k < 3; k++) {
        dem_buffer_text(out, k ? "," : "");
        dem_buffer_number(out, s->block_edges[k], 15);
    }
}

static dem_status make_cells(grain_family *f, const dem_ctx *ctx, const char *command, dem_error *error)
{
    const settings *s = f->s;
    double values[DEM_GRAIN_PARAMS];
    DEM_TRY(dem_grain_values(&dem_grain_rock, s->own_values, values, error));
    dem_grain_request request = {values, s->grain.seed, s->grain.triangles};
    dem_vec3 block = v3(s->block_edges[0], s->block_edges[1], s->block_edges[2]);
    dem_fracture fracture;
    DEM_TRY(dem_grain_break(ctx, &request, block, (size_t)s->cells, &fracture, error));
    dem_status status = DEM_OK;
    for (long i = 0; i < s->cells && status == DEM_OK; i++) {
        dem_mesh mesh = {0};
        char name[48];
        dem_buffer origin = {0};
        dem_buffer_print(&origin, "%s, cell %ld", command, i + 1);
        put_name(name, sizeof name, "cell", i + 1, s->cells);
        status = dem_grain_cell(&request, &fracture, (size_t)i, &mesh, error);
        if (status == DEM_OK)
            status = grain_family_add(f, &mesh, name, s->common.seed, origin.data, error);
        dem_buffer_release(&origin);
        dem_mesh_free(&mesh);
    }
    dem_fracture_release(&fracture);
    return status;
}

int grain_make_cells(const cli_tool *tool, const settings *s, dem_mesh_format format)
{
    grain_family f;
    dem_error error = {0};
    dem_buffer command = {0};
    put_cells_command(&command, s);
    int status = grain_family_begin(&f, tool, s, format, (size_t)s->cells, "rock");
    f.digits = CELL_DIGITS;  // so that what is read back fills the block too
    dem_ctx ctx = cli_ctx(&f.session, NULL);
    if (status == DEM_OK && make_cells(&f, &ctx, command.data, &error) != DEM_OK)
        status = cli_session_error(&f.session, &error);
    status = grain_family_end(&f, command.data, status);
    dem_buffer_release(&command);
    return status;
}

double grain_degree(const settings *s)
{
    const dem_grain_kind *kind = &dem_grain_harmonics;
    size_t i = 0;
    while (strcmp(kind->params[i].name, "degree") != 0)
        i++;
    return isnan(s->own_values[i]) ? kind->params[i].standard : s->own_values[i];
}

static void put_fit_command(dem_buffer *out, const settings *s, long seed, long siblings)
{
    dem_buffer_print(out, "dem-grain --fit %s --unit %s --degree %.0f --triangles %zu", s->fit, s->unit,
                     grain_degree(s), s->grain.triangles);
    put_rest(out, &s->grain);
    dem_buffer_text(out, s->repair == DEM_REPAIR_WRAP ? " --repair wrap" : s->repair ? " --repair strict" : "");
    dem_buffer_text(out, s->same_volume ? " --same-volume" : "");
    if (siblings)
        dem_buffer_print(out, " --siblings %ld --seed %ld --kept-degrees %ld", siblings, seed, s->kept);
}

static dem_status read_scan(const dem_ctx *ctx, const settings *s, dem_mesh *scan, dem_error *error)
{
    dem_mesh_report report;
    dem_repair_options options = {.repair = (dem_repair)s->repair, .keep = DEM_KEEP_LARGEST};
    DEM_TRY(dem_mesh_import(ctx, s->fit, scan, error));
    dem_mesh_scale(scan, s->length_unit);
    dem_status status = dem_mesh_repair(ctx, scan, &options, &report, error);
    if (status != DEM_OK) {
        snprintf(error->file, sizeof error->file, "%s", s->fit);
        dem_mesh_free(scan);
    }
    return status;
}

static void move(dem_mesh *mesh, dem_vec3 by)
{
    for (size_t i = 0; i < mesh->vertex_count; i++)
        mesh->vertices[i] = v3_add(mesh->vertices[i], by);
}

// reads and fits the scan; the twin lies where the scan does
static dem_status fit_scan(const dem_ctx *ctx, const settings *s, grain_scan *scan, dem_mesh *twin, dem_error *error)
{
    dem_mesh mesh;
    DEM_TRY(read_scan(ctx, s, &mesh, error));
    dem_status status = dem_harmonics_fit_mesh(ctx, &mesh, (int)grain_degree(s), &scan->of, &scan->fit, error);
    if (status == DEM_OK)
        status = dem_harmonics_mesh(ctx, &scan->of, s->grain.triangles, twin, error);
    if (status == DEM_OK) {
        move(twin, scan->fit.centre);
        status = dem_mesh_distance(&mesh, twin, &scan->distance, error);
    }
    dem_mesh_free(&mesh);
    if (status != DEM_OK) {
        if (status == DEM_USAGE)
            dem_fail(error, DEM_BAD_INPUT, "harmonics of that degree are hollowed out to the centre; lower --degree");
        snprintf(error->file, sizeof error->file, "%s", s->fit);
        dem_mesh_free(twin);
    } else if (scan->fit.hidden > 0) {
        char text[2][32];
        dem_log(ctx, DEM_LOG_WARNING,
                "not star-shaped: in %s %% of all directions the surface is met more than once, up to %s d_eq below; "
                "only the outermost is fitted",
                dem_format_double(text[0], 32, 100 * scan->fit.hidden, 3),
                dem_format_double(text[1], 32, scan->fit.hidden_depth / scan->fit.equivalent_diameter, 3));
    }
    return status;
}

// the size asked for, where one was
static void set_size(const settings *s, const grain_scan *scan, dem_mesh *mesh)
{
    double volume = dem_mesh_solid(mesh).volume, wanted = 0;
    if (s->grain.size > 0)
        wanted = DEM_PI / 6 * pow(s->grain.size, 3);
    else if (s->same_volume)
        wanted = scan->fit.volume;
    if (wanted > 0)
        dem_mesh_scale(mesh, cbrt(wanted / volume));
}

static dem_status make_siblings(grain_family *f, const dem_ctx *ctx, const grain_scan *scan, dem_error *error)
{
    const settings *s = f->s;
    long last = s->common.seed + s->siblings - 1;
    dem_harmonics *sibling = dem_alloc(1, sizeof *sibling);
    if (!sibling)
        return dem_fail_memory(error);
    dem_status status = DEM_OK;
    for (long seed = s->common.seed; seed <= last && status == DEM_OK; seed++) {
        dem_mesh mesh = {0};
        dem_buffer origin = {0};
        char name[48];
        put_fit_command(&origin, s, seed, 1);
        put_name(name, sizeof name, "sibling", seed, last);
        status = dem_harmonics_sibling(ctx, &scan->of, (int)s->kept, (uint64_t)seed, s->grain.triangles, sibling, &mesh,
                                       error);
        if (status == DEM_OK) {
            set_size(s, scan, &mesh);
            status = grain_family_add(f, &mesh, name, seed, origin.data, error);
        }
        dem_buffer_release(&origin);
        dem_mesh_free(&mesh);
    }
    free(sibling);
    return status;
}

static dem_status make_fit(grain_family *f, grain_scan *scan, const char *command, dem_error *error)
{
    const settings *s = f->s;
    double values[DEM_GRAIN_PARAMS];
    DEM_TRY(dem_grain_values(&dem_grain_harmonics, s->own_values, values, error));
    dem_ctx ctx = cli_ctx(&f->session, s->fit), own = cli_ctx(&f->session, NULL);
    dem_mesh twin = {0};
    DEM_TRY(fit_scan(&ctx, s, scan, &twin, error));
    f->scan = scan;
    dem_status status = DEM_OK;
    if (s->siblings) {
        status = make_siblings(f, &own, scan, error);
    } else {
        move(&twin, v3_scale(scan->fit.centre, -1));
        set_size(s, scan, &twin);
        if (s->grain.size == 0)
            move(&twin, scan->fit.centre);
        f->digits = TWIN_DIGITS;
        status = grain_family_add(f, &twin, "twin", s->common.seed, command, error);
    }
    dem_mesh_free(&twin);
    return status;
}

int grain_make_fit(const cli_tool *tool, const settings *s, dem_mesh_format format)
{
    grain_family f;
    dem_error error = {0};
    dem_buffer command = {0};
    grain_scan *scan = dem_alloc_zero(1, sizeof *scan);
    int status = grain_family_begin(&f, tool, s, format, s->siblings ? (size_t)s->siblings : 1,
                                    s->siblings ? "siblings" : "twin");
    dem_status made = scan ? DEM_OK : dem_fail_memory(&error);
    put_fit_command(&command, s, s->common.seed, s->siblings);
    if (status == DEM_OK && made == DEM_OK)
        made = make_fit(&f, scan, command.data, &error);
    if (made != DEM_OK)
        status = cli_session_error(&f.session, &error);
    status = grain_family_end(&f, command.data, status);
    dem_buffer_release(&command);
    free(scan);
    return status;
}
