#include "clump/file.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "base/json.h"
#include "base/memory.h"
#include "clump/figures.h"
#include "math/vec.h"

#define SCHEMA "dem-clump/"
#define VERSION "1"

static const char *const mass_sources[] = {
    [DEM_MASS_FROM_MESH] = "mesh", [DEM_MASS_FROM_UNION] = "union", [DEM_MASS_GIVEN] = "given"};
enum { MASS_SOURCES = sizeof mass_sources / sizeof *mass_sources };

// ---- writing

static void put_figures(dem_json_writer *w, const void *values, const dem_figure *figures, int count)
{
    for (int i = 0; i < count; i++)
        dem_json_put_number(w, figures[i].name, *(const double *)((const char *)values + figures[i].at));
}

static void put_vec(dem_json_writer *w, const char *key, dem_vec3 v)
{
    dem_json_put_numbers(w, key, (double[]){v.x, v.y, v.z}, 3);
}

static void put_mass(dem_json_writer *w, const dem_clump_def *def)
{
    dem_json_put_string(w, "name", def->name);
    dem_json_open_object(w, "source");
    dem_json_put_string(w, "mesh", def->source_mesh);
    dem_json_put_string(w, "sha256", def->source_sha256);
    dem_json_put_string(w, "unit", def->source_unit);
    dem_json_close(w, '}');
    dem_json_put_number(w, "density", def->density);
    dem_json_put_number(w, "mass", def->mass);
    dem_json_put_number(w, "volume", def->volume);
    dem_json_put_numbers(w, "inertia", def->inertia, 3);
    dem_json_put_string(w, "mass_from", mass_sources[def->mass_from]);
    dem_json_open_object(w, "to_mesh");
    put_vec(w, "position", def->position);
    dem_quat q = def->orientation;
    dem_json_put_numbers(w, "orientation", (double[]){q.w, q.x, q.y, q.z}, 4);
    dem_json_close(w, '}');
    dem_json_open_object(w, "union");
    dem_json_put_number(w, "volume", def->union_volume);
    put_vec(w, "centre", def->union_centre);
    dem_json_put_numbers(w, "inertia", def->union_inertia, 3);
    dem_json_close(w, '}');
}

static void put_surface(dem_json_writer *w, const dem_mesh *surface)
{
    dem_json_open_object(w, "surface");
    dem_json_open_array(w, "vertices", true);
    for (size_t i = 0; i < surface->vertex_count; i++)
        put_vec(w, NULL, surface->vertices[i]);
    dem_json_close(w, ']');
    dem_json_open_array(w, "triangles", true);
    for (size_t i = 0; i < surface->triangle_count; i++) {
        dem_json_open_array(w, NULL, false);
        for (size_t k = 0; k < 3; k++)
            dem_json_put_whole(w, NULL, surface->triangles[3 * i + k]);
        dem_json_close(w, ']');
    }
    dem_json_close(w, ']');
    dem_json_close(w, '}');
}

void dem_clump_put_figures(dem_json_writer *w, const dem_clump_def *def)
{
    put_mass(w, def);
    dem_json_open_object(w, "fidelity");
    put_figures(w, &def->fidelity, dem_fidelity_figures, DEM_FIDELITY_FIGURES);
    dem_json_put_whole(w, "pieces", (int64_t)def->fidelity.pieces);
    dem_json_close(w, '}');
    dem_json_open_object(w, "shape");
    put_figures(w, &def->shape, dem_shape_figures, DEM_SHAPE_FIGURES);
    dem_json_close(w, '}');
    dem_json_open_object(w, "made");
    dem_json_put_string(w, "method", def->method);
    dem_json_put_raw(w, "parameters", def->parameters);
    dem_json_put_whole(w, "seed", (int64_t)def->seed); // JSON whole numbers are signed: seeds from 2^63 wrap
    dem_json_put_number(w, "seconds", def->seconds);
    dem_json_put_string(w, "version", def->version);
    dem_json_close(w, '}');
}

dem_status dem_clump_encode(const dem_clump *clump, dem_buffer *out, dem_error *error)
{
    dem_clump_def def = dem_clump_view(clump);
    dem_json_writer writer = dem_json_begin(out), *w = &writer;
    dem_json_open_object(w, NULL);
    dem_json_put_string(w, "schema", SCHEMA VERSION);
    dem_clump_put_figures(w, &def);
    dem_json_open_array(w, "spheres", true);
    for (size_t i = 0; i < def.ball_count; i++) {
        dem_vec3 c = def.balls[i].centre;
        dem_json_put_numbers(w, NULL, (double[]){c.x, c.y, c.z, def.balls[i].radius}, 4);
    }
    dem_json_close(w, ']');
    if (def.surface.triangle_count)
        put_surface(w, &def.surface);
    dem_json_close(w, '}');
    return out->failed ? dem_fail_memory(error) : DEM_OK;
}

dem_status dem_clump_write(const dem_clump *clump, const char *path, dem_error *error)
{
    dem_buffer out = {0};
    dem_status status = dem_clump_encode(clump, &out, error);
    if (status == DEM_OK)
        return dem_file_write_buffer(path, &out, error);
    dem_buffer_release(&out);
    return status;
}

// ---- reading

typedef enum need { NEEDED, OPTIONAL } need;

typedef struct reader {
    const char *file;
    dem_error *error;
    const char *section; // where `object` stands in the file, "" for the outermost
    const dem_json *object;
} reader;

static dem_status refuse(const reader *r, const char *key, const char *what)
{
    return dem_fail_at(r->error, DEM_BAD_INPUT, r->file, 0, "%s%s%s: %s", r->section, *r->section ? "." : "", key,
                       what);
}

// the object that a section's values stand in; a section that is absent is an empty one
static dem_status open_section(const reader *r, const char *name, reader *section)
{
    *section = (reader){r->file, r->error, name, dem_json_member(r->object, name)};
    if (section->object && !dem_json_is_object(section->object))
        return refuse(r, name, "needs an object { ... }");
    return DEM_OK;
}

// null stands for what is not known
static bool to_figure(const dem_json *value, double *number)
{
    if (!dem_json_is_null(value))
        return dem_json_number(value, number);
    *number = NAN;
    return true;
}

// `count` numbers, one of them plain, more in an array; the optional may be null
static dem_status read_numbers(const reader *r, const char *key, need n, const char *what, size_t count,
                               double *numbers)
{
    const dem_json *value = dem_json_member(r->object, key);
    if (!value)
        return n == OPTIONAL ? DEM_OK : refuse(r, key, what);
    bool fits = count == 1 || dem_json_length(value) == count;
    for (size_t i = 0; fits && i < count; i++) {
        const dem_json *one = count == 1 ? value : dem_json_item(value, i);
        fits = n == OPTIONAL ? to_figure(one, &numbers[i]) : dem_json_number(one, &numbers[i]);
    }
    return fits ? DEM_OK : refuse(r, key, what);
}

static dem_status read_figures(const reader *r, const dem_figure *figures, int count, void *values)
{
    for (int i = 0; i < count; i++)
        DEM_TRY(read_numbers(r, figures[i].name, OPTIONAL, "needs a number, or null where it is not known", 1,
                             figure_of(values, &figures[i])));
    return DEM_OK;
}

static dem_status read_text(const reader *r, const char *key, const char **text)
{
    const dem_json *value = dem_json_member(r->object, key);
    if (!value)
        return DEM_OK;
    *text = dem_json_string(value);
    return *text ? DEM_OK : refuse(r, key, "needs a text in quotes");
}

static dem_status read_whole(const reader *r, const char *key, int64_t *number)
{
    const dem_json *value = dem_json_member(r->object, key);
    return !value || dem_json_whole(value, number) ? DEM_OK : refuse(r, key, "needs a whole number");
}

static dem_status read_vec(const reader *r, const char *key, dem_vec3 *v)
{
    double xyz[3] = {v->x, v->y, v->z};
    DEM_TRY(read_numbers(r, key, OPTIONAL, "needs 3 finite numbers [x, y, z]", 3, xyz));
    *v = v3(xyz[0], xyz[1], xyz[2]);
    return DEM_OK;
}

static dem_status read_schema(const reader *r)
{
    const char *schema = dem_json_string(dem_json_member(r->object, "schema"));
    if (!schema || strncmp(schema, SCHEMA, strlen(SCHEMA)) != 0)
        return dem_fail_at(r->error, DEM_BAD_INPUT, r->file, 0,
                           "is not a clump file; one starts with {\"schema\": \"" SCHEMA VERSION "\", ...");
    if (strcmp(schema + strlen(SCHEMA), VERSION) != 0)
        return dem_fail_at(r->error, DEM_BAD_INPUT, r->file, 0,
                           "schema: %.40s is not known, only " SCHEMA VERSION " is; use a newer program", schema);
    return DEM_OK;
}

static dem_status read_mass(const reader *r, dem_clump_def *def)
{
    DEM_TRY(read_numbers(r, "density", NEEDED, "needs a finite number [kg/m^3]", 1, &def->density));
    DEM_TRY(read_numbers(r, "mass", NEEDED, "needs a finite number [kg]", 1, &def->mass));
    DEM_TRY(read_numbers(r, "inertia", NEEDED, "needs 3 finite numbers I1 <= I2 <= I3 [kg m^2]", 3, def->inertia));
    def->volume = def->mass / def->density;
    DEM_TRY(read_numbers(r, "volume", OPTIONAL, "needs a finite number [m^3]", 1, &def->volume));
    const char *from = mass_sources[DEM_MASS_FROM_MESH];
    DEM_TRY(read_text(r, "mass_from", &from));
    int source = 0;
    while (source < MASS_SOURCES && strcmp(from, mass_sources[source]) != 0)
        source++;
    if (source == MASS_SOURCES)
        return refuse(r, "mass_from", "must be \"mesh\", \"union\" or \"given\"");
    def->mass_from = (dem_mass_source)source;
    return DEM_OK;
}

static dem_status read_sections(const reader *r, dem_clump_def *def)
{
    reader s;
    DEM_TRY(open_section(r, "source", &s));
    DEM_TRY(read_text(&s, "mesh", &def->source_mesh));
    DEM_TRY(read_text(&s, "sha256", &def->source_sha256));
    DEM_TRY(read_text(&s, "unit", &def->source_unit));
    DEM_TRY(open_section(r, "to_mesh", &s));
    DEM_TRY(read_vec(&s, "position", &def->position));
    double q[4] = {1, 0, 0, 0};
    DEM_TRY(read_numbers(&s, "orientation", OPTIONAL, "needs 4 finite numbers [w, x, y, z]", 4, q));
    def->orientation = (dem_quat){q[0], q[1], q[2], q[3]};
    DEM_TRY(open_section(r, "union", &s));
    DEM_TRY(read_numbers(&s, "volume", OPTIONAL, "needs a finite number [m^3]", 1, &def->union_volume));
    DEM_TRY(read_vec(&s, "centre", &def->union_centre));
    DEM_TRY(read_numbers(&s, "inertia", OPTIONAL, "needs 3 finite numbers [kg m^2]", 3, def->union_inertia));
    DEM_TRY(open_section(r, "fidelity", &s));
    DEM_TRY(read_figures(&s, dem_fidelity_figures, DEM_FIDELITY_FIGURES, &def->fidelity));
    int64_t whole = 0;
    DEM_TRY(read_whole(&s, "pieces", &whole));
    if (whole < 0)
        return refuse(&s, "pieces", "must not be negative");
    def->fidelity.pieces = (size_t)whole;
    DEM_TRY(open_section(r, "shape", &s));
    DEM_TRY(read_figures(&s, dem_shape_figures, DEM_SHAPE_FIGURES, &def->shape));
    DEM_TRY(open_section(r, "made", &s));
    DEM_TRY(read_text(&s, "method", &def->method));
    DEM_TRY(read_text(&s, "version", &def->version));
    whole = 0;
    DEM_TRY(read_whole(&s, "seed", &whole));
    def->seed = (uint64_t)whole;
    return read_numbers(&s, "seconds", OPTIONAL, "needs a number [s]", 1, &def->seconds);
}

static dem_status refuse_item(const reader *r, const char *key, size_t index, const char *what)
{
    char name[64];
    snprintf(name, sizeof name, "%s[%zu]", key, index);
    return refuse(r, name, what);
}

static dem_status read_balls(const reader *r, dem_ball **balls, size_t *count)
{
    const dem_json *spheres = dem_json_member(r->object, "spheres");
    if (!dem_json_is_array(spheres))
        return refuse(r, "spheres", "needs an array of spheres [x, y, z, r]");
    *count = dem_json_length(spheres);
    *balls = dem_alloc(*count, sizeof **balls);
    if (!*balls)
        return dem_fail_memory(r->error);
    for (size_t i = 0; i < *count; i++) {
        const dem_json *item = dem_json_item(spheres, i);
        dem_ball *b = &(*balls)[i];
        double *parts[4] = {&b->centre.x, &b->centre.y, &b->centre.z, &b->radius};
        bool fits = dem_json_length(item) == 4;
        for (size_t k = 0; fits && k < 4; k++)
            fits = dem_json_number(dem_json_item(item, k), parts[k]);
        if (!fits)
            return refuse_item(r, "spheres", i, "needs 4 finite numbers x, y, z, r; correct or remove it");
    }
    return DEM_OK;
}

static dem_status read_vertices(const reader *r, dem_mesh *surface)
{
    const dem_json *list = dem_json_member(r->object, "vertices");
    surface->vertex_count = dem_json_length(list);
    surface->vertices = dem_alloc(surface->vertex_count, sizeof *surface->vertices);
    if (!surface->vertices)
        return dem_fail_memory(r->error);
    for (size_t i = 0; i < surface->vertex_count; i++) {
        const dem_json *item = dem_json_item(list, i);
        dem_vec3 *v = &surface->vertices[i];
        if (dem_json_length(item) != 3 || !dem_json_number(dem_json_item(item, 0), &v->x) ||
            !dem_json_number(dem_json_item(item, 1), &v->y) || !dem_json_number(dem_json_item(item, 2), &v->z))
            return refuse_item(r, "vertices", i, "needs 3 finite numbers x, y, z; correct it or leave the surface out");
    }
    return DEM_OK;
}

static dem_status read_triangles(const reader *r, dem_mesh *surface)
{
    const dem_json *list = dem_json_member(r->object, "triangles");
    surface->triangle_count = dem_json_length(list);
    surface->triangles = dem_alloc(surface->triangle_count, 3 * sizeof *surface->triangles);
    if (!surface->triangles)
        return dem_fail_memory(r->error);
    for (size_t i = 0; i < surface->triangle_count; i++) {
        const dem_json *item = dem_json_item(list, i);
        bool fits = dem_json_length(item) == 3;
        for (size_t k = 0; fits && k < 3; k++) {
            int64_t vertex;
            fits = dem_json_whole(dem_json_item(item, k), &vertex) && vertex >= 0 && vertex < UINT32_MAX;
            surface->triangles[3 * i + k] = fits ? (uint32_t)vertex : 0;
        }
        if (!fits)
            return refuse_item(r, "triangles", i,
                               "needs 3 vertices, counted from 0; correct it or leave the surface out");
    }
    return DEM_OK;
}

static dem_status read_surface(const reader *r, dem_mesh *surface)
{
    reader s;
    DEM_TRY(open_section(r, "surface", &s));
    if (!s.object)
        return DEM_OK;
    if (!dem_json_is_array(dem_json_member(s.object, "vertices")))
        return refuse(&s, "vertices", "needs an array of vertices [x, y, z]");
    if (!dem_json_is_array(dem_json_member(s.object, "triangles")))
        return refuse(&s, "triangles", "needs an array of triangles [a, b, c]");
    DEM_TRY(read_vertices(&s, surface));
    return read_triangles(&s, surface);
}

// everything is unknown until it is read
static dem_clump_def nothing(void)
{
    dem_clump_def def = {.orientation = {1, 0, 0, 0},
                         .union_volume = NAN,
                         .union_centre = {NAN, NAN, NAN},
                         .union_inertia = {NAN, NAN, NAN},
                         .seconds = NAN};
    for (int i = 0; i < DEM_FIDELITY_FIGURES; i++)
        *figure_of(&def.fidelity, &dem_fidelity_figures[i]) = NAN;
    for (int i = 0; i < DEM_SHAPE_FIGURES; i++)
        *figure_of(&def.shape, &dem_shape_figures[i]) = NAN;
    return def;
}

// spheres in plain text, a mesh: not even broken JSON
static bool is_other_text(const char *text, size_t size)
{
    size_t i = 0;
    while (i < size && strchr(" \t\r\n", text[i]))
        i++;
    return i < size && !strchr("{[\xef", text[i]);
}

dem_status dem_clump_decode(const char *text, size_t size, const char *file, dem_clump **clump, dem_error *error)
{
    *clump = NULL;
    dem_json *root;
    if (is_other_text(text, size))
        return dem_fail_at(error, DEM_BAD_INPUT, file, 1,
                           "is not a clump file; make one of it: dem-clump convert FILE -o NAME.json, or of a mesh "
                           "dem-clump FILE -o NAME.json");
    DEM_TRY(dem_json_parse(text, size, file, &root, error));
    reader r = {file, error, "", root};
    dem_clump_def def = nothing();
    dem_ball *balls = NULL;
    char *parameters = dem_json_text(dem_json_member(dem_json_member(root, "made"), "parameters"));
    char name[256];
    snprintf(name, sizeof name, "%s", dem_file_name(file));
    char *dot = strrchr(name, '.');
    if (dot && dot > name)
        *dot = 0;
    def.name = name;

    dem_status status = read_schema(&r);
    if (status == DEM_OK)
        status = read_text(&r, "name", &def.name);
    if (status == DEM_OK)
        status = read_mass(&r, &def);
    if (status == DEM_OK)
        status = read_sections(&r, &def);
    if (status == DEM_OK)
        status = read_balls(&r, &balls, &def.ball_count);
    if (status == DEM_OK)
        status = read_surface(&r, &def.surface);
    if (status == DEM_OK) {
        def.balls = balls;
        def.parameters = parameters;
        status = dem_clump_create(&def, clump, error);
        if (status == DEM_BAD_INPUT && error) // its message names the key; add the file
            snprintf(error->file, sizeof error->file, "%s", file);
    }
    free(parameters);
    free(balls);
    dem_mesh_free(&def.surface);
    dem_json_release(root);
    return status;
}

dem_status dem_clump_read(const char *path, dem_clump **clump, dem_error *error)
{
    *clump = NULL;
    dem_buffer text;
    DEM_TRY(dem_file_read(path, &text, error));
    dem_status status =
        dem_clump_decode(text.data, text.size, strcmp(path, "-") == 0 ? "standard input" : path, clump, error);
    dem_buffer_release(&text);
    return status;
}
