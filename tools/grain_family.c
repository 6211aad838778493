#include "grain_family.h"

#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "base/memory.h"
#include "base/units.h"
#include "math/vec.h"
#include "mesh/mass.h"

enum { DIGITS = 7, ENOUGH_DIGITS = 17 };

// so many that the shortest side still has three of them
static int digits_for(const dem_mesh *mesh)
{
    double shortest = INFINITY, far = 0;
    for (size_t i = 0; i < 3 * mesh->triangle_count; i++) {
        dem_vec3 a = mesh->vertices[mesh->triangles[i]];
        dem_vec3 b = mesh->vertices[mesh->triangles[i % 3 == 2 ? i - 2 : i + 1]];
        shortest = fmin(shortest, v3_distance(a, b));
        far = fmax(far, v3_norm(a));
    }
    double digits = ceil(log10(far / shortest)) + 3;
    return digits <= DIGITS ? DIGITS : digits <= ENOUGH_DIGITS ? (int)digits : ENOUGH_DIGITS;
}

static const char *suffix_of(dem_mesh_format format)
{
    static const char *const suffixes[] = {
        [DEM_MESH_OBJ] = "obj", [DEM_MESH_STL] = "stl", [DEM_MESH_PLY] = "ply", [DEM_MESH_OFF] = "off"};
    return suffixes[format];
}

int grain_family_begin(grain_family *f, const cli_tool *tool, const settings *s, dem_mesh_format format, size_t wanted,
                       const char *kind)
{
    *f = (grain_family){.s = s, .format = format, .wanted = wanted, .kind = kind};
    cli_begin(&f->session, tool, &s->common);
    f->session.jobs = wanted;
    dem_error error;
    if (s->folder && dem_folder_create(s->output, &error) != DEM_OK)
        return cli_session_error(&f->session, &error);
    return DEM_OK;
}

dem_status grain_family_add(grain_family *f, const dem_mesh *mesh, const char *name, long seed, const char *origin,
                            dem_error *error)
{
    dem_buffer file = {0};
    dem_mesh_put(mesh, f->format, origin, f->digits ? f->digits : digits_for(mesh), &file);
    if (cli_interrupted()) {
        dem_buffer_release(&file);
        return dem_fail(error, DEM_INTERRUPTED, "interrupted; nothing more was written");
    }
    char *path = f->s->folder ? dem_path_join(f->s->output, "%s.%s", name, suffix_of(f->format)) : NULL;
    if (f->s->folder && !path) {
        dem_buffer_release(&file);
        return dem_fail_memory(error);
    }
    dem_status status = dem_file_write_buffer(path ? path : f->s->output, &file, error);
    free(path);
    if (status != DEM_OK)
        return status;
    if (!dem_grow(&f->rows, &f->room, f->made, sizeof *f->rows))
        return dem_fail_memory(error);
    dem_box box = dem_mesh_box(mesh);
    grain_row *row = &f->rows[f->made++];
    *row = (grain_row){.seed = seed, .vertices = mesh->vertex_count, .triangles = mesh->triangle_count};
    snprintf(row->file, sizeof row->file, "%s.%s", name, suffix_of(f->format));
    row->extent = v3_sub(box.high, box.low);
    row->volume = dem_mesh_solid(mesh).volume;
    row->diameter = cbrt(6 * row->volume / DEM_PI);
    if (f->wanted > 1)
        cli_job_done(&f->session);
    return DEM_OK;
}

static void put_lengths(dem_buffer *out, const double *lengths, size_t count, const char *between)
{
    double factor, longest = 0;
    for (size_t i = 0; i < count; i++)
        longest = fmax(longest, lengths[i]);
    const char *unit = dem_length_unit(longest * (1 + 1e-6), &factor);  // 0.9999999 mm is not 1000 um
    for (size_t i = 0; i < count; i++) {
        dem_buffer_text(out, i ? between : "");
        dem_buffer_number(out, lengths[i] * factor, 5);
    }
    dem_buffer_print(out, " %s", unit);
}

static void put_percent(dem_buffer *out, const char *what, double part)
{
    dem_buffer_text(out, what);
    dem_buffer_number(out, 100 * part, 3);
    dem_buffer_text(out, " %");
}

static void put_fit(dem_buffer *out, const grain_scan *scan)
{
    double diameter = scan->fit.equivalent_diameter;
    dem_buffer_text(out, "  scan                 equivalent diameter ");
    put_lengths(out, &diameter, 1, "");
    put_percent(out, "\n  twin off the scan    ", scan->distance.rms / diameter);
    put_percent(out, " of it RMS, ", scan->distance.largest / diameter);
    dem_buffer_text(out, " at most\n  spectrum D_1 ...    ");
    for (int n = 1; n <= scan->of.degree; n++) {
        dem_buffer_text(out, n > 1 && n % 6 == 1 ? "\n                       " : " ");
        dem_buffer_number(out, dem_harmonics_power(&scan->of, n), 4);
    }
    dem_buffer_text(out, "\n");
}

static void put_summary(dem_buffer *out, const grain_family *f)
{
    const grain_row *first = f->rows;
    double diameters[] = {INFINITY, 0}, extent[] = {first->extent.x, first->extent.y, first->extent.z}, volume = 0;
    for (size_t i = 0; i < f->made; i++) {
        diameters[0] = fmin(diameters[0], f->rows[i].diameter);
        diameters[1] = fmax(diameters[1], f->rows[i].diameter);
        volume += f->rows[i].volume;
    }
    if (f->s->folder)
        dem_buffer_print(out, "%s: %zu of %s, family.csv lists them\n", f->s->output, f->made, f->kind);
    else
        dem_buffer_print(out, "%s: %s, seed %ld\n  triangles            %zu, %zu vertices, closed\n", f->s->output,
                         f->kind, first->seed, first->triangles, first->vertices);
    if (f->scan)
        put_fit(out, f->scan);
    dem_buffer_text(out, "  equivalent diameter  ");
    put_lengths(out, diameters, diameters[1] > diameters[0] * (1 + 1e-9) ? 2 : 1, " to ");
    if (!f->s->folder) {
        dem_buffer_text(out, "\n  extent x, y, z       ");
        put_lengths(out, extent, 3, " x ");
    }
    dem_buffer_text(out, "\n  volume               ");
    dem_buffer_number(out, volume, 5);
    dem_buffer_text(out, f->made > 1 ? " m3 in all\n" : " m3\n");
}

static void put_row(dem_json_writer *json, const grain_row *row)
{
    dem_json_put_whole(json, "vertices", (int64_t)row->vertices);
    dem_json_put_whole(json, "triangles", (int64_t)row->triangles);
    dem_json_put_number(json, "volume", row->volume);
    dem_json_put_number(json, "equivalent_diameter", row->diameter);
    dem_json_put_numbers(json, "extent", (double[]){row->extent.x, row->extent.y, row->extent.z}, 3);
}

static void put_scan(dem_json_writer *json, const grain_scan *scan, const char *file)
{
    const dem_harmonics_fit *fit = &scan->fit;
    dem_json_open_object(json, "fit");
    dem_json_put_string(json, "scan", file);
    dem_json_put_whole(json, "degree", scan->of.degree);
    dem_json_put_numbers(json, "centre", (double[]){fit->centre.x, fit->centre.y, fit->centre.z}, 3);
    dem_json_put_number(json, "volume", fit->volume);
    dem_json_put_number(json, "equivalent_diameter", fit->equivalent_diameter);
    dem_json_put_number(json, "distance_rms", scan->distance.rms / fit->equivalent_diameter);
    dem_json_put_number(json, "distance_max", scan->distance.largest / fit->equivalent_diameter);
    dem_json_put_number(json, "hidden", fit->hidden);
    dem_json_put_number(json, "hidden_depth", fit->hidden_depth / fit->equivalent_diameter);
    dem_json_close(json, '}');
    double spectrum[DEM_HARMONICS_DEGREE];
    for (int n = 1; n <= scan->of.degree; n++)
        spectrum[n - 1] = dem_harmonics_power(&scan->of, n);
    dem_json_put_numbers(json, "spectrum", spectrum, (size_t)scan->of.degree);
}

static void put_json(dem_buffer *out, grain_family *f, const char *command)
{
    dem_json_writer json = dem_json_begin(out);
    dem_json_open_object(&json, NULL);
    dem_json_put_string(&json, f->s->folder ? "folder" : "file", f->s->output);
    dem_json_put_string(&json, "kind", f->kind);
    dem_json_put_whole(&json, "seed", f->s->common.seed);
    dem_json_put_string(&json, "command", command);
    if (f->s->folder) {
        dem_json_put_whole(&json, "count", (int64_t)f->made);
        dem_json_open_array(&json, "grains", true);
        for (size_t i = 0; i < f->made; i++) {
            dem_json_open_object(&json, NULL);
            dem_json_put_string(&json, "file", f->rows[i].file);
            dem_json_put_whole(&json, "seed", f->rows[i].seed);
            put_row(&json, &f->rows[i]);
            dem_json_close(&json, '}');
        }
        dem_json_close(&json, ']');
    } else {
        put_row(&json, &f->rows[0]);
    }
    if (f->scan)
        put_scan(&json, f->scan, f->s->fit);
    cli_put_warnings(&f->session, &json);
    dem_json_put_string(&json, "version", dem_version());
    dem_json_close(&json, '}');
}

static int write_table(grain_family *f)
{
    dem_error error;
    dem_buffer table = {0};
    dem_buffer_text(&table, "file,seed,triangles,volume,equivalent_diameter,extent_x,extent_y,extent_z\n");
    for (size_t i = 0; i < f->made; i++) {
        const grain_row *r = &f->rows[i];
        const double numbers[] = {r->volume, r->diameter, r->extent.x, r->extent.y, r->extent.z};
        dem_buffer_print(&table, "%s,%ld,%zu", r->file, r->seed, r->triangles);
        for (size_t k = 0; k < 5; k++) {
            dem_buffer_text(&table, ",");
            dem_buffer_shortest(&table, numbers[k]);
        }
        dem_buffer_text(&table, "\n");
    }
    char *path = dem_path_join(f->s->output, "family.csv");
    dem_status status = path ? dem_file_write_buffer(path, &table, &error) : dem_fail_memory(&error);
    free(path);
    return status == DEM_OK ? DEM_OK : cli_session_error(&f->session, &error);
}

int grain_family_end(grain_family *f, const char *command, int status)
{
    const settings *s = f->s;
    if (s->folder && f->made && status == DEM_OK)
        status = write_table(f);
    bool shown = strcmp(s->output, "-") != 0 && (s->common.json || !s->common.quiet);
    if (f->made && shown && status == DEM_OK) {
        dem_buffer report = {0};
        if (s->common.json)
            put_json(&report, f, command);
        else
            put_summary(&report, f);
        status = cli_print(f->session.tool, &report);
    }
    if (status == DEM_OK && f->made < f->wanted)
        status = DEM_FAILED;  // each missing one has been named
    free(f->rows);
    cli_end(&f->session);
    return status;
}
