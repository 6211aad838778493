#include "sim/template.h"

#include <stdlib.h>

#include "base/memory.h"
#include "math/mat3.h"
#include "sim/scene.h"

// sizes with finite squares and cubes in the float columns, and well inside of the padding [m]
static const double SMALLEST = 1e-18, LARGEST = 1e12;
// how near to one sphere about its centre a clump must come to be one, relative to the radius and to the moments
static const double CENTRED = 1e-12, ROUND = 1e-9;
// a box so many times as long as it is thick is looked at: below, its look costs more than the pairs it saves
static const double SLIM = 2;
// moments that differ by rounding only
static const double EQUAL = 1e-12;

// what a shape is before its axes are renamed
typedef struct form {
    const dem_ball *balls;
    size_t count;
    double mass, inertia[3], volume;  // [kg], [kg m^2], [m^3]
    double diameter;                  // of the sphere with that volume, or of a disc [m]
} form;

static const char *name_of(const char *name)
{
    return name ? name : "(without a name)";
}

static dem_status check_shape(const dem_scene *scene, const dem_shape_def *shape, dem_error *error)
{
    const char *name = name_of(shape->name);
    if (!shape->clump == !(shape->sphere_radius > 0))
        return dem_fail(error, DEM_USAGE, "shape %s: is %s; give either a clump or a radius", name,
                        shape->clump ? "both a clump and a sphere" : "neither a clump nor a sphere");
    if (shape->material >= scene->material_count)
        return dem_fail(error, DEM_USAGE, "shape %s: material %lu does not exist, there are %zu (counted from 0)", name,
                        (unsigned long)shape->material, scene->material_count);
    if (shape->disc_thickness != 0 && (shape->clump || scene->dimension != 2 || !(shape->disc_thickness > 0)))
        return dem_fail(error, DEM_USAGE, "shape %s: discs are spheres with a thickness in two dimensions; %s", name,
                        scene->dimension != 2 ? "set the scene's dimension to 2" : "give a radius and a thickness");
    const dem_material *material = &scene->materials[shape->material];
    if (isnan(material->density) && !shape->clump)
        return dem_fail(error, DEM_USAGE,
                        "shape %s: a sphere has the density of its material, and %s has none; give it in kg/m^3", name,
                        name_of(material->name));
    if (!isnan(material->density) && !(material->density > 0 && isfinite(material->density)))
        return dem_fail(error, DEM_USAGE, "material %s: its density must be positive; give it in kg/m^3",
                        name_of(material->name));
    return DEM_OK;
}

static form form_of(const dem_scene *scene, const dem_shape_def *shape, dem_ball *single)
{
    double density = scene->materials[shape->material].density;
    if (!shape->clump) {
        double r = shape->sphere_radius, volume = dem_ball_volume(shape), mass = density * volume;
        double moment = (shape->disc_thickness > 0 ? 0.5 : 0.4) * mass * r * r;
        *single = (dem_ball){{0, 0, 0}, r};
        double diameter = shape->disc_thickness > 0 ? 2 * r : cbrt(6 * volume / DEM_PI);
        return (form){single, 1, mass, {moment, moment, moment}, volume, diameter};
    }
    dem_clump_def def = dem_clump_view(shape->clump);
    double factor = isnan(density) ? 1 : density / def.density;
    return (form){def.balls,
                  def.ball_count,
                  def.mass * factor,
                  {def.inertia[0] * factor, def.inertia[1] * factor, def.inertia[2] * factor},
                  def.volume,
                  cbrt(6 * def.volume / DEM_PI)};
}

static dem_status check_sizes(const dem_template *t, const char *name, dem_error *error)
{
    if (t->radius_min < SMALLEST || t->radius_out > LARGEST)
        return dem_fail(error, DEM_BAD_INPUT,
                        "shape %s: spheres of radius %g m in a grain of radius %g m; 1e-18 to 1e12 m can be run, check "
                        "the unit of length",
                        name_of(name), t->radius_min, t->radius_out);
    return DEM_OK;
}

// whether the first axis becomes z and not the last: it leaves the two most alike to the symmetric top. The middle one
// never is the best, for moments ascend
static bool first_is_best(const double inertia[3])
{
    return 1 / inertia[1] - 1 / inertia[2] < 1 / inertia[0] - 1 / inertia[1];
}

// the largest (c x n).I^-1 (c x n) over unit vectors n [1/kg]
static double turning(dem_vec3 c, const double inverse[3])
{
    dem_vec3 by[3] = {{0, c.z, -c.y}, {-c.z, 0, c.x}, {c.y, -c.x, 0}};  // c x n for the three axes n
    double a[3][3];
    for (int i = 0; i < 3; i++)
        for (int j = 0; j <= i; j++)
            a[i][j] = inverse[0] * by[i].x * by[j].x + inverse[1] * by[i].y * by[j].y + inverse[2] * by[i].z * by[j].z;
    double values[3];
    dem_vec3 vectors[3];
    dem_sym3_eigen((dem_sym3){a[0][0], a[1][1], a[2][2], a[1][0], a[2][0], a[2][1]}, values, vectors);
    return values[2] > 0 ? values[2] : 0;
}

static bool alike(const double inertia[3], double tolerance)
{
    return inertia[2] - inertia[0] <= tolerance * inertia[1];
}

static void set_mass(dem_template *t, const form *f)
{
    t->centred = f->count == 1 && v3_norm(f->balls[0].centre) <= CENTRED * f->balls[0].radius;
    t->isotropic = alike(f->inertia, t->centred ? ROUND : EQUAL);
    bool rename = !t->isotropic && first_is_best(f->inertia);
    // the axes x, y, z become z, x, y by a third of a turn about (1, 1, 1)
    t->to_run = rename ? (dem_quat){0.5, -0.5, -0.5, -0.5} : (dem_quat){1, 0, 0, 0};
    t->mass = f->mass;
    t->inverse_mass = 1 / f->mass;
    for (int k = 0; k < 3; k++) {
        t->inertia[k] = t->isotropic ? f->inertia[1] : f->inertia[(k + rename) % 3];
        t->inverse_inertia[k] = 1 / t->inertia[k];
    }
    t->volume = f->volume;
    t->equivalent_diameter = f->diameter;
}

static dem_ball sphere_of(const dem_template *t, const dem_ball *ball)
{
    dem_vec3 c = t->centred ? v3(0, 0, 0) : ball->centre;
    return (dem_ball){t->to_run.w == 1 ? c : v3(c.y, c.z, c.x), ball->radius};
}

static void set_box(dem_template *t, const double (*rows)[4])
{
    double low[3], high[3];
    for (int k = 0; k < 3; k++) {
        low[k] = INFINITY, high[k] = -INFINITY;
        for (size_t i = 0; i < t->count; i++) {
            low[k] = fmin(low[k], rows[i][k] - rows[i][3]);
            high[k] = fmax(high[k], rows[i][k] + rows[i][3]);
        }
    }
    t->box_centre = v3((low[0] + high[0]) / 2, (low[1] + high[1]) / 2, (low[2] + high[2]) / 2);
    t->box_half = v3((high[0] - low[0]) / 2, (high[1] - low[1]) / 2, (high[2] - low[2]) / 2);
    double least = fmin(t->box_half.x, fmin(t->box_half.y, t->box_half.z));
    t->slim = SLIM * least <= fmax(t->box_half.x, fmax(t->box_half.y, t->box_half.z));
}

static void set_spheres(dem_template *t, const form *f, double (*rows)[4])
{
    double most = 0;
    t->radius_min = INFINITY;
    t->radius_out = t->radius_max = 0;
    for (size_t i = 0; i < f->count; i++) {
        dem_ball b = sphere_of(t, &f->balls[i]);
        rows[i][0] = b.centre.x;
        rows[i][1] = b.centre.y;
        rows[i][2] = b.centre.z;
        rows[i][3] = b.radius;
        t->radius_out = fmax(t->radius_out, v3_norm(b.centre) + b.radius);
        t->radius_min = fmin(t->radius_min, b.radius);
        t->radius_max = fmax(t->radius_max, b.radius);
        most = fmax(most, turning(b.centre, t->inverse_inertia));
    }
    set_box(t, (const double(*)[4])rows);
    t->least_mass = most > 0 ? 1 / (t->inverse_mass + most) : t->mass;
}

// the radius of a float ball about the rounded centre that contains the ball
static float radius_around(const double row[4], float x, float y, float z)
{
    double wanted = row[3] + v3_distance(v3(row[0], row[1], row[2]), v3((double)x, (double)y, (double)z));
    float r = (float)wanted;
    return (double)r < wanted ? nextafterf(r, INFINITY) : r;
}

static void set_columns(const dem_template *t, dem_templates *all)
{
    size_t at = t->float_first;
    for (size_t i = 0; i < t->float_padded; i++, at++) {
        if (i >= t->count) {
            all->x[at] = all->y[at] = all->z[at] = 0;
            all->r[at] = DEM_TEMPLATE_NEVER;
            continue;
        }
        const double *row = all->spheres[t->first + i];
        all->x[at] = (float)row[0];
        all->y[at] = (float)row[1];
        all->z[at] = (float)row[2];
        all->r[at] = radius_around(row, all->x[at], all->y[at], all->z[at]);
    }
}

static size_t balls_of(const dem_shape_def *shape)
{
    return shape->clump ? dem_clump_view(shape->clump).ball_count : 1;
}

static size_t padded(size_t count)
{
    return (count + DEM_TEMPLATE_PAD - 1) / DEM_TEMPLATE_PAD * DEM_TEMPLATE_PAD;
}

// `count` is a whole number of cache lines
static void *aligned(size_t count, size_t size)
{
    return aligned_alloc(64, padded(count ? count : 1) * size);
}

static dem_status allocate(const dem_scene *scene, dem_templates *t, dem_error *error)
{
    for (size_t i = 0; i < scene->shape_count; i++) {
        DEM_TRY(check_shape(scene, &scene->shapes[i], error));
        size_t count = balls_of(&scene->shapes[i]);
        t->sphere_count += count;
        t->float_count += padded(count);
        if (t->float_count > UINT32_MAX)
            return dem_fail(error, DEM_USAGE, "shapes: more than 4294967295 spheres in all; use coarser clumps");
    }
    t->count = scene->shape_count;
    t->items = dem_alloc_zero(t->count, sizeof *t->items);
    t->spheres = aligned(t->sphere_count, sizeof *t->spheres);
    float **columns[] = {&t->x, &t->y, &t->z, &t->r};
    bool failed = !t->items || !t->spheres;
    for (int i = 0; i < 4; i++) {
        *columns[i] = aligned(t->float_count, sizeof(float));
        failed |= !*columns[i];
    }
    return failed ? dem_fail_memory(error) : DEM_OK;
}

static dem_status fill_in(const dem_scene *scene, dem_templates *all, dem_error *error)
{
    size_t first = 0, float_first = 0;
    for (size_t i = 0; i < all->count; i++) {
        const dem_shape_def *shape = &scene->shapes[i];
        dem_template *t = &all->items[i];
        dem_ball single;
        form f = form_of(scene, shape, &single);
        set_mass(t, &f);
        t->flat = shape->disc_thickness > 0;
        t->material = shape->material;
        t->first = (uint32_t)first;
        t->count = (uint32_t)f.count;
        t->float_first = (uint32_t)float_first;
        t->float_padded = (uint32_t)padded(f.count);
        set_spheres(t, &f, all->spheres + first);
        DEM_TRY(check_sizes(t, shape->name, error));
        set_columns(t, all);
        first += t->count;
        float_first += t->float_padded;
    }
    return DEM_OK;
}

dem_status dem_templates_create(const dem_scene *scene, dem_templates *templates, dem_error *error)
{
    *templates = (dem_templates){0};
    dem_status status = allocate(scene, templates, error);
    if (status == DEM_OK)
        status = fill_in(scene, templates, error);
    if (status != DEM_OK)
        dem_templates_release(templates);
    return status;
}

void dem_templates_release(dem_templates *t)
{
    free(t->items);
    free(t->spheres);
    free(t->x);
    free(t->y);
    free(t->z);
    free(t->r);
    *t = (dem_templates){0};
}
