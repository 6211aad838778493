#include "sim/region.h"

#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "math/mat3.h"
#include "math/quat.h"

enum { POINTS = 4096 };  // over a grain: its share in a region is known to half a percent

// points spread evenly over a grain, and the ball about its centre of mass that holds it; principal frame, scale 1
typedef struct grain {
    const dem_ball *balls;
    size_t ball_count;
    double volume, reach;
    bool flat;  // a disc of two dimensions
    dem_vec3 *points;
} grain;

struct dem_regions {
    dem_measure_def *items;
    dem_measure_view *views;
    size_t count;
    dem_domain_def domain;
    double thickness;  // of discs: regions are areas of this height along z; 0: there are none
    grain *grains;
    size_t grain_count;
};

// ---- making

const char *dem_measure_fault(const dem_scene *scene, const dem_measure_def *m)
{
    dem_vec3 low = m->low, high = m->high, reach = v3(m->radius, m->radius, m->radius);
    if (m->region == DEM_REGION_WHOLE)
        return NULL;
    if (m->region == DEM_REGION_BALL) {
        if (!(m->radius > 0 && isfinite(m->radius)))
            return "its radius must be above 0; correct it";
        low = v3_sub(m->centre, reach);
        high = v3_add(m->centre, reach);
    }
    for (int k = 0; k < 3; k++) {
        double a = v3_get(low, k), b = v3_get(high, k);
        if (!(a < b && isfinite(a) && isfinite(b)))
            return "its first corner must be below the second; exchange or correct them";
        if (scene->domain.periodic[k] && !(a >= v3_get(scene->domain.low, k) && b <= v3_get(scene->domain.high, k)))
            return "it reaches beyond a periodic side of the domain; move it inside";
    }
    return NULL;
}

// the i-th number of van der Corput's sequence
static double spread(size_t i, size_t base)
{
    double part = 1, x = 0;
    for (; i; i /= base) {
        part /= (double)base;
        x += part * (double)(i % base);
    }
    return x;
}

static bool in_grain(const grain *g, dem_vec3 p)
{
    for (size_t i = 0; i < g->ball_count; i++)
        if (v3_norm2(v3_sub(p, g->balls[i].centre)) <= g->balls[i].radius * g->balls[i].radius)
            return true;
    return false;
}

static dem_status make_grain(grain *g, const dem_clump *clump, bool flat, dem_error *error)
{
    dem_clump_def def = dem_clump_view(clump);
    dem_box box = box_empty();
    *g = (grain){def.balls, def.ball_count, def.volume, 0, flat, dem_alloc(POINTS, sizeof *g->points)};
    if (!g->points)
        return dem_fail_memory(error);
    for (size_t i = 0; i < g->ball_count; i++) {
        double r = g->balls[i].radius;
        g->reach = larger(g->reach, v3_norm(g->balls[i].centre) + r);
        box = box_with(box, v3_sub(g->balls[i].centre, v3(r, r, r)));
        box = box_with(box, v3_add(g->balls[i].centre, v3(r, r, r)));
    }
    dem_vec3 side = v3_sub(box.high, box.low);
    for (size_t i = 0, found = 0; found < POINTS; i++) {
        dem_vec3 p = v3(box.low.x + side.x * spread(i + 1, 2), box.low.y + side.y * spread(i + 1, 3),
                        flat ? 0 : box.low.z + side.z * spread(i + 1, 5));
        // very thin and scattered balls: their centres will do
        if (i > 1000 * POINTS)
            p = g->balls[found % g->ball_count].centre;
        if (i > 1000 * POINTS || in_grain(g, p))
            g->points[found++] = p;
    }
    return DEM_OK;
}

static dem_status fill_in(dem_regions *r, const dem_scene *scene, dem_clump *const *clumps, dem_error *error)
{
    r->items = dem_alloc(scene->measure_count, sizeof *r->items);
    r->views = dem_alloc_zero(scene->measure_count, sizeof *r->views);
    r->grains = dem_alloc_zero(scene->shape_count, sizeof *r->grains);
    if (!r->items || !r->views || !r->grains)
        return dem_fail_memory(error);
    r->domain = scene->domain;
    for (size_t i = 0; i < scene->measure_count; i++) {
        const char *fault = dem_measure_fault(scene, &scene->measures[i]);
        if (fault)
            return dem_fail(error, DEM_USAGE, "measure \"%.60s\": %s", scene->measures[i].name, fault);
        r->items[r->count++] = scene->measures[i];
        r->items[i].name = NULL;  // the scene's
    }
    for (size_t i = 0; i < scene->shape_count; i++) {
        r->thickness = larger(r->thickness, scene->shapes[i].disc_thickness);
        DEM_TRY(make_grain(&r->grains[i], clumps[i], scene->shapes[i].disc_thickness > 0, error));
        r->grain_count++;
    }
    for (size_t i = 0; i < r->count && r->thickness > 0; i++) {
        r->items[i].low.z = -INFINITY;
        r->items[i].high.z = INFINITY;
    }
    return DEM_OK;
}

dem_status dem_regions_create(const dem_scene *scene, dem_clump *const *clumps, dem_regions **regions, dem_error *error)
{
    *regions = NULL;
    if (!scene->measure_count)
        return DEM_OK;
    *regions = dem_alloc_zero(1, sizeof **regions);
    if (!*regions)
        return dem_fail_memory(error);
    dem_status status = fill_in(*regions, scene, clumps, error);
    if (status != DEM_OK) {
        dem_regions_release(*regions);
        *regions = NULL;
    }
    return status;
}

void dem_regions_release(dem_regions *r)
{
    if (!r)
        return;
    for (size_t i = 0; i < r->grain_count; i++)
        free(r->grains[i].points);
    free(r->items);
    free(r->views);
    free(r->grains);
    free(r);
}

// ---- where things are

static dem_vec3 to_domain(const dem_domain_def *d, dem_vec3 x)
{
    for (int k = 0; k < 3; k++)
        if (d->periodic[k]) {
            double low = v3_get(d->low, k), side = v3_get(d->high, k) - low;
            v3_set(&x, k, v3_get(x, k) - floor((v3_get(x, k) - low) / side) * side);
        }
    return x;
}

// from a centre to a point near it, across the nearest side
static dem_vec3 to_nearest(const dem_domain_def *d, dem_vec3 x)
{
    for (int k = 0; k < 3; k++)
        if (d->periodic[k]) {
            double side = v3_get(d->high, k) - v3_get(d->low, k);
            v3_set(&x, k, v3_get(x, k) - round(v3_get(x, k) / side) * side);
        }
    return x;
}

static bool holds(const dem_measure_def *m, dem_vec3 x)
{
    if (m->region == DEM_REGION_BALL)
        return v3_norm2(v3_sub(x, m->centre)) <= m->radius * m->radius;
    bool inside = true;
    for (int k = 0; k < 3 && m->region == DEM_REGION_BOX; k++)
        inside = inside && v3_get(x, k) >= v3_get(m->low, k) && v3_get(x, k) < v3_get(m->high, k);
    return inside;
}

// the share of the line from x to x + l that lies in a box
static double share_in_box(const dem_measure_def *m, dem_vec3 x, dem_vec3 l)
{
    double from = 0, to = 1;
    for (int k = 0; k < 3; k++) {
        double a = v3_get(m->low, k) - v3_get(x, k), b = v3_get(m->high, k) - v3_get(x, k), d = v3_get(l, k);
        if (d == 0) {
            if (a > 0 || b < 0)
                return 0;
            continue;
        }
        from = larger(from, d > 0 ? a / d : b / d);
        to = smaller(to, d > 0 ? b / d : a / d);
    }
    return larger(0, to - from);
}

static double share_in_ball(const dem_measure_def *m, dem_vec3 x, dem_vec3 l)
{
    dem_vec3 d = v3_sub(x, m->centre);
    double a = v3_norm2(l), b = v3_dot(d, l), c = v3_norm2(d) - m->radius * m->radius, root = b * b - a * c;
    if (!(a > 0))
        return c <= 0;
    if (root <= 0)
        return 0;
    root = sqrt(root);
    return larger(0, smaller(1, (-b + root) / a) - larger(0, (-b - root) / a));
}

// the same with the line's images across periodic sides
static double share_of(const dem_regions *r, const dem_measure_def *m, dem_vec3 x, dem_vec3 l)
{
    if (m->region == DEM_REGION_WHOLE)
        return 1;
    int aside[3];
    dem_vec3 side = v3(0, 0, 0), low = v3_min(x, v3_add(x, l)), high = v3_max(x, v3_add(x, l));
    for (int k = 0; k < 3; k++) {
        bool across = r->domain.periodic[k] &&
                      (v3_get(low, k) < v3_get(r->domain.low, k) || v3_get(high, k) > v3_get(r->domain.high, k));
        aside[k] = across;
        if (across)
            v3_set(&side, k, v3_get(r->domain.high, k) - v3_get(r->domain.low, k));
    }
    double share = 0;
    for (int i = -aside[0]; i <= aside[0]; i++)
        for (int j = -aside[1]; j <= aside[1]; j++)
            for (int k = -aside[2]; k <= aside[2]; k++) {
                dem_vec3 at = v3_add(x, v3(i * side.x, j * side.y, k * side.z));
                share += m->region == DEM_REGION_BOX ? share_in_box(m, at, l) : share_in_ball(m, at, l);
            }
    return share;
}

// ---- solids

// distance from the border, inwards
static double depth_of(const dem_measure_def *m, dem_vec3 x)
{
    if (m->region == DEM_REGION_BALL)
        return m->radius - v3_distance(x, m->centre);
    double depth = INFINITY;
    for (int k = 0; k < 3; k++)
        depth = smaller(depth, smaller(v3_get(x, k) - v3_get(m->low, k), v3_get(m->high, k) - v3_get(x, k)));
    return depth;
}

static bool crosses_domain(const dem_domain_def *d, dem_vec3 x, double reach)
{
    bool crosses = false;
    for (int k = 0; k < 3; k++)
        crosses = crosses || (d->periodic[k] &&
                              (v3_get(x, k) - reach < v3_get(d->low, k) || v3_get(x, k) + reach > v3_get(d->high, k)));
    return crosses;
}

static double solid_in(const dem_regions *r, const dem_measure_def *m, const dem_body_view *b, size_t i)
{
    const grain *g = &r->grains[b->shape[i]];
    double scale = b->scale[i], volume = g->volume * scale * scale * (g->flat ? 1 : scale), reach = g->reach * scale;
    double depth = m->region == DEM_REGION_WHOLE ? INFINITY : depth_of(m, b->position[i]);
    if (depth >= reach)
        return volume;
    if (depth <= -reach && !crosses_domain(&r->domain, b->position[i], reach))
        return 0;
    size_t inside = 0;
    for (size_t k = 0; k < POINTS; k++) {
        dem_vec3 p = v3_along(b->position[i], scale, quat_rotate(b->orientation[i], g->points[k]));
        inside += holds(m, to_domain(&r->domain, p));
    }
    return volume * (double)inside / POINTS;
}

// of the whole: the domain, and where it is open what holds all spheres
static double whole_volume(const dem_regions *r, const dem_body_view *b)
{
    dem_box box = box_empty();
    for (size_t i = 0; i < b->count; i++) {
        const grain *g = &r->grains[b->shape[i]];
        for (size_t k = 0; k < g->ball_count; k++) {
            double radius = g->balls[k].radius * b->scale[i];
            dem_vec3 c = v3_along(b->position[i], b->scale[i], quat_rotate(b->orientation[i], g->balls[k].centre));
            box = box_with(box, v3_sub(c, v3(radius, radius, radius)));
            box = box_with(box, v3_add(c, v3(radius, radius, radius)));
        }
    }
    double volume = r->thickness > 0 ? r->thickness : 1;
    for (int k = 0; k < (r->thickness > 0 ? 2 : 3); k++) {
        double low = v3_get(r->domain.low, k), high = v3_get(r->domain.high, k);
        bool closed = isfinite(low) && isfinite(high);
        double side = closed ? high - low : v3_get(box.high, k) - v3_get(box.low, k);
        volume *= b->count || closed ? side : 0;
    }
    return volume;
}

// ---- measuring

static double volume_of(const dem_regions *r, const dem_measure_def *m, const dem_body_view *b)
{
    dem_vec3 side = v3_sub(m->high, m->low);
    if (r->thickness > 0 && m->region != DEM_REGION_WHOLE)
        return r->thickness * (m->region == DEM_REGION_BALL ? DEM_PI * m->radius * m->radius : side.x * side.y);
    return m->region == DEM_REGION_WHOLE  ? whole_volume(r, b)
           : m->region == DEM_REGION_BALL ? 4 * DEM_PI / 3 * m->radius * m->radius * m->radius
                                          : side.x * side.y * side.z;
}

static void measure_bodies(const dem_regions *r, const dem_measure_def *m, const dem_body_view *b, dem_measure_view *v)
{
    double touches = 0, mass = 0;
    dem_vec3 momentum = v3(0, 0, 0);
    for (size_t i = 0; i < b->count; i++) {
        v->solid_volume += solid_in(r, m, b, i);
        if (!holds(m, b->position[i]))
            continue;
        v->bodies++;
        touches += b->coordination[i];
        mass += b->mass[i];
        momentum = v3_along(momentum, b->mass[i], b->velocity[i]);
    }
    v->coordination = v->bodies ? touches / (double)v->bodies : 0;
    v->void_ratio = v->volume / v->solid_volume - 1;
    for (size_t i = 0; m->kinetic && mass > 0 && i < b->count; i++)
        if (holds(m, b->position[i])) {
            dem_vec3 own = v3_along(b->velocity[i], -1 / mass, momentum);
            v->stress = sym3_add(v->stress, sym3_scale(sym3_outer(own), b->mass[i]));
        }
}

static void measure_contacts(const dem_regions *r, const dem_measure_def *m, const dem_body_view *b,
                             const dem_contact *contacts, size_t count, dem_measure_view *v)
{
    for (size_t i = 0; i < count; i++) {
        const dem_contact *c = &contacts[i];
        bool wall = c->other == UINT32_MAX;
        dem_vec3 x = b->position[c->body], arm = to_nearest(&r->domain, v3_sub(c->point, x)), l = arm;
        if (!wall)
            l = v3_sub(arm, to_nearest(&r->domain, v3_sub(c->point, b->position[c->other])));
        dem_vec3 on_other = v3_sub(v3_scale(c->normal, c->normal_force), c->friction_force);
        double share = share_of(r, m, x, l);
        if (share > 0)
            v->stress = sym3_add(v->stress, sym3_scale(sym3_pair(on_other, l), share));
        if (!wall && holds(m, to_domain(&r->domain, c->point))) {
            v->contacts++;
            v->fabric = sym3_add(v->fabric, sym3_outer(c->normal));
        }
    }
}

static void measure_bonds(const dem_regions *r, const dem_measure_def *m, const dem_region_views *views,
                          dem_measure_view *v)
{
    for (size_t i = 0; i < views->bond_count; i++) {
        const dem_bond_view *b = &views->bonds[i];
        if (b->state != DEM_BOND_INTACT)
            continue;
        dem_vec3 x = views->bodies.position[b->body], arm = to_nearest(&r->domain, v3_sub(b->point, x));
        dem_vec3 l = v3_sub(arm, to_nearest(&r->domain, v3_sub(b->point, views->bodies.position[b->other])));
        double share = share_of(r, m, x, l);
        if (share > 0)
            v->stress = sym3_add(v->stress, sym3_scale(sym3_pair(b->force, l), -share));
    }
}

void dem_regions_measure(dem_regions *r, const dem_region_views *views)
{
    const dem_body_view *bodies = &views->bodies;
    for (size_t i = 0; i < r->count; i++) {
        const dem_measure_def *m = &r->items[i];
        dem_measure_view *v = &r->views[i];
        *v = (dem_measure_view){.volume = volume_of(r, m, bodies)};
        measure_bodies(r, m, bodies, v);
        measure_contacts(r, m, bodies, views->contacts, views->contact_count, v);
        measure_bonds(r, m, views, v);
        v->stress = sym3_scale(v->stress, v->volume > 0 ? 1 / v->volume : 0);
        v->fabric = sym3_scale(v->fabric, v->contacts ? 1 / (double)v->contacts : 0);
        const dem_sym3 s = v->stress;
        double mean = v->mean_stress = (s.xx + s.yy + s.zz) / 3;
        double square = (s.xx - mean) * (s.xx - mean) + (s.yy - mean) * (s.yy - mean) + (s.zz - mean) * (s.zz - mean) +
                        2 * (s.xy * s.xy + s.xz * s.xz + s.yz * s.yz);
        v->deviatoric_stress = sqrt(1.5 * square);
    }
}

const dem_measure_view *dem_regions_views(const dem_regions *r, size_t *count)
{
    *count = r ? r->count : 0;
    return r ? r->views : NULL;
}
