#include "mesh/grain.h"

#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/text.h"
#include "math/sum.h"
#include "math/vec.h"

// a new kind is a file with its record, and its line here
static const dem_grain_kind *const kinds[] = {
    &dem_grain_harmonics,
    &dem_grain_facets,
    &dem_grain_ellipsoid,
};
enum { KIND_COUNT = sizeof kinds / sizeof *kinds, DENT_STREAM = 1000, CANDIDATES = 20 };

static const double OWN_SIZE = 1e-3;  // [m]

const dem_grain_kind *dem_grain_kind_at(size_t index)
{
    return index < KIND_COUNT ? kinds[index] : NULL;
}

const dem_grain_kind *dem_grain_kind_find(const char *name)
{
    for (size_t i = 0; i < KIND_COUNT; i++)
        if (strcmp(kinds[i]->name, name) == 0)
            return kinds[i];
    return NULL;
}

bool dem_grain_kind_has_size(const dem_grain_kind *kind)
{
    for (size_t i = 0; i < kind->param_count; i++)
        if (strcmp(kind->params[i].unit, "m") == 0)
            return true;
    return false;
}

dem_grain_options dem_grain_defaults(void)
{
    return (dem_grain_options){.kind = "harmonics",
                               .seed = 1,
                               .triangles = 3000,
                               .elongation = 1,
                               .flatness = 1,
                               .dent_depth = 0.4,
                               .dent_width_deg = 45};
}

static dem_status check_range(const char *name, double value, double low, double high, bool whole, dem_error *error)
{
    if (value >= low && value <= high && !(whole && value != floor(value)))
        return DEM_OK;
    char text[3][32];
    return dem_fail(error, DEM_USAGE, "%s must be a %s from %s to %s, not %s", name, whole ? "whole number" : "number",
                    dem_format_double(text[0], 32, low, 6), dem_format_double(text[1], 32, high, 6),
                    dem_format_double(text[2], 32, value, 6));
}

static dem_status check_options(const dem_grain_options *o, dem_error *error)
{
    DEM_TRY(
        check_range("triangles", (double)o->triangles, DEM_GRAIN_MIN_TRIANGLES, DEM_GRAIN_MAX_TRIANGLES, true, error));
    DEM_TRY(check_range("elongation", o->elongation, DEM_GRAIN_MIN_STRETCH, 1, false, error));
    DEM_TRY(check_range("flatness", o->flatness, DEM_GRAIN_MIN_STRETCH, 1, false, error));
    DEM_TRY(check_range("dents", (double)o->dents, 0, DEM_GRAIN_MAX_DENTS, true, error));
    DEM_TRY(check_range("dent-depth", o->dent_depth, 0, DEM_GRAIN_MAX_DEPTH, false, error));
    DEM_TRY(check_range("dent-width", o->dent_width_deg, DEM_GRAIN_MIN_WIDTH, 90, false, error));
    return o->size ? check_range("size", o->size, 1e-9, 1e9, false, error) : DEM_OK;
}

static dem_status fill_values(const dem_grain_kind *kind, const double *given, double *values, dem_error *error)
{
    DEM_ASSERT(kind->param_count <= DEM_GRAIN_PARAMS);
    for (size_t i = 0; i < kind->param_count; i++) {
        const dem_grain_param *p = &kind->params[i];
        values[i] = given && !isnan(given[i]) ? given[i] : p->standard;
        if (!isnan(values[i]))
            DEM_TRY(check_range(p->name, values[i], p->low, p->high, strcmp(p->unit, "count") == 0, error));
    }
    return DEM_OK;
}

void dem_grain_directions(dem_random *random, dem_vec3 *directions, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        double best = INFINITY;
        for (int k = 0; k < CANDIDATES; k++) {
            double z = 2 * random_uniform(random) - 1, angle = 2 * DEM_PI * random_uniform(random);
            double s = sqrt(1 - z * z), nearest = -INFINITY;
            dem_vec3 u = v3(s * cos(angle), s * sin(angle), z);
            for (size_t j = 0; j < i; j++)
                nearest = fmax(nearest, v3_dot(u, directions[j]));
            if (nearest < best || k == 0) {
                best = nearest;
                directions[i] = u;
            }
        }
    }
}

// a dent pulls the surface towards the origin by a smooth bump in the angle from its middle; r(u) stays one positive
// number per direction, so the grain stays star-shaped
static void press_dents(dem_mesh *mesh, const dem_grain_options *o)
{
    dem_vec3 middles[DEM_GRAIN_MAX_DENTS];
    dem_random random = random_stream(o->seed, DENT_STREAM);
    dem_grain_directions(&random, middles, o->dents);
    double width = o->dent_width_deg * DEM_PI / 180;
    for (size_t i = 0; i < mesh->vertex_count; i++) {
        dem_vec3 u = v3_unit(mesh->vertices[i]);
        double left = 1;
        for (size_t k = 0; k < o->dents; k++) {
            double angle = acos(fmin(fmax(v3_dot(u, middles[k]), -1), 1)) / width;
            double bump = angle < 1 ? (1 - angle * angle) * (1 - angle * angle) : 0;
            left *= 1 - o->dent_depth * bump;
        }
        mesh->vertices[i] = v3_scale(mesh->vertices[i], left);
    }
}

static void stretch(dem_mesh *mesh, dem_vec3 by)
{
    for (size_t i = 0; i < mesh->vertex_count; i++) {
        dem_vec3 *v = &mesh->vertices[i];
        *v = v3(v->x * by.x, v->y * by.y, v->z * by.z);
    }
}

// a closed surface that covers the sphere once is star-shaped, thus free of self-intersections, if each of its
// triangles spans a tetrahedron of positive volume with the origin
static dem_status star_volume(const dem_mesh *mesh, const char *kind, double *volume, dem_error *error)
{
    dem_sum sum = {0};
    for (size_t t = 0; t < mesh->triangle_count; t++) {
        const uint32_t *v = &mesh->triangles[3 * t];
        double six = v3_dot(mesh->vertices[v[0]], v3_cross(mesh->vertices[v[1]], mesh->vertices[v[2]]));
        if (!(six > 0) || !isfinite(six))
            return dem_fail(error, DEM_FAILED,
                            "%s: the surface folds over itself; use milder parameters or another seed", kind);
        sum_add(&sum, six / 6);
    }
    *volume = sum_value(sum);
    return DEM_OK;
}

dem_status dem_grain_make(const dem_ctx *ctx, const dem_grain_options *options, dem_mesh *mesh, dem_error *error)
{
    *mesh = (dem_mesh){0};
    const dem_grain_kind *kind = dem_grain_kind_find(options->kind);
    if (!kind)
        return dem_fail(error, DEM_USAGE, "there is no kind of grain named '%s'; see dem-grain --list", options->kind);
    double values[DEM_GRAIN_PARAMS], volume = 0;
    DEM_TRY(check_options(options, error));
    DEM_TRY(fill_values(kind, options->values, values, error));
    dem_grain_request request = {values, options->seed, options->triangles};
    dem_status status = kind->make(ctx, &request, mesh, error);
    if (status != DEM_OK)
        goto done;
    double e = options->elongation;
    if (e < 1 || options->flatness < 1)
        stretch(mesh, v3(1, e, e * options->flatness));
    if (options->dents)
        press_dents(mesh, options);
    if ((status = star_volume(mesh, kind->name, &volume, error)) != DEM_OK)
        goto done;
    double size = options->size > 0 || dem_grain_kind_has_size(kind) ? options->size : OWN_SIZE;
    if (size > 0) {
        double factor = size / cbrt(6 * volume / DEM_PI);
        stretch(mesh, v3(factor, factor, factor));
    }
done:
    if (status != DEM_OK)
        dem_mesh_free(mesh);
    return status;
}
