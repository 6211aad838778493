#include "study/jam.h"

#include <math.h>
#include <stdlib.h>

#include "base/clock.h"
#include "base/memory.h"
#include "base/status.h"
#include "math/vec.h"

enum { MOST_STAGES = 4000, UNLOADING = 5 };
static const double MOST_SOLID = 0.95;
static const double FINE_FROM = 0.05;  // of the pressure at the end, from which on stages are finer

typedef struct growing {
    const dem_ctx *ctx;
    const dem_jam_def *def;
    dem_jam *jam;
    dem_material material;
    dem_pair_law law;
    dem_shape_def shape;
    dem_measure_def measure;
    dem_scene scene;
    dem_world *world;
    dem_body_def *bodies;
    size_t count;
    double side, volume, stiffness, diameter;  // of the box [m], of a grain at scale 1
} growing;

dem_jam_def dem_jam_defaults(void)
{
    return (dem_jam_def){.bodies = 500, .begin = 0.3, .growth = 0.002, .steps = 2000, .pressure = 1e-3, .seed = 1};
}

static void set_scene(growing *g)
{
    const dem_jam_def *def = g->def;
    dem_clump_def c = dem_clump_view(def->clump);
    g->volume = c.volume;
    g->diameter = cbrt(c.volume * 6 / DEM_PI);
    // in the last state grains have their own size
    g->side = cbrt((double)def->bodies * c.volume / 0.64);
    g->stiffness = 1;
    g->material = (dem_material){"grain", NAN, NAN, NAN};
    g->law = dem_pair_law_defaults();
    g->law.stiffness = g->stiffness;
    g->law.damping = DEM_DAMPING_RESTITUTION;
    g->law.restitution = 0.5;
    if (def->friction > 0) {
        g->law.friction = DEM_FRICTION_LINEAR;
        g->law.friction_coefficient = def->friction;
    }
    g->shape = (dem_shape_def){.name = "grain", .clump = def->clump};
    g->measure = (dem_measure_def){.name = "box", .region = DEM_REGION_WHOLE};
    g->scene = dem_scene_defaults();
    g->scene.materials = &g->material;
    g->scene.material_count = 1;
    g->scene.laws = &g->law;
    g->scene.law_count = 1;
    g->scene.shapes = &g->shape;
    g->scene.shape_count = 1;
    g->scene.measures = &g->measure;
    g->scene.measure_count = 1;
    g->scene.domain.high = v3(g->side, g->side, g->side);
    g->scene.domain.low = v3(0, 0, 0);
    for (int k = 0; k < 3; k++)
        g->scene.domain.periodic[k] = true;
    g->scene.damping.local = 0.5;
    g->scene.output.energy = false;
}

static void leave_world(growing *g)
{
    if (g->world)
        g->jam->steps += dem_world_steps(g->world);
    dem_world_destroy(g->world);
    g->world = NULL;
}

// the bodies as they are, at rest, for a world with grains of another size
static dem_status keep_bodies(growing *g, dem_error *error)
{
    dem_body_view v = dem_world_bodies(g->world);
    if (!g->bodies && !(g->bodies = dem_alloc(v.count, sizeof *g->bodies)))
        return dem_fail_memory(error);
    g->count = v.count;
    for (size_t i = 0; i < v.count; i++)
        g->bodies[i] = (dem_body_def){.shape = 0,
                                      .scale = v.scale[i],
                                      .position = v.position[i],
                                      .orientation = v.orientation[i],
                                      .velocity = v.velocity[i],
                                      .spin = v.spin[i]};
    g->scene.bodies = (dem_bodies_def){.bodies = g->bodies, .count = g->count};
    return DEM_OK;
}

// places the grains at random, small
static dem_status begin(growing *g, dem_error *error)
{
    const dem_jam_def *def = g->def;
    double size = g->diameter * cbrt(def->begin / 0.64);
    dem_mix_def mix = {.shape = 0, .share = 1, .size = {.law = DEM_SIZE_FIXED, .a = size, .largest = INFINITY}};
    dem_fill_def fill = {.mix = &mix,
                         .mix_count = 1,
                         .low = g->scene.domain.low,
                         .high = g->scene.domain.high,
                         .count = def->bodies,
                         .seed = def->seed};
    g->scene.bodies = (dem_bodies_def){.fills = &fill, .fill_count = 1};
    dem_status status = dem_world_create(g->ctx, &g->scene, &g->world, error);
    if (status == DEM_OK)
        status = dem_world_measure(g->world, error);
    if (status == DEM_OK)
        status = keep_bodies(g, error);
    leave_world(g);
    return status;
}

// one stage: all grains of the size of this solid fraction, brought to rest; their pressure
static dem_status stage(growing *g, double solid, double *pressure, dem_error *error)
{
    double scale = cbrt(solid / 0.64);
    size_t count;
    leave_world(g);
    for (size_t i = 0; i < g->count; i++)
        g->bodies[i].scale = scale;
    DEM_TRY(dem_world_create(g->ctx, &g->scene, &g->world, error));
    DEM_TRY(dem_world_step(g->world, g->def->steps, error));
    DEM_TRY(dem_world_measure(g->world, error));
    DEM_TRY(keep_bodies(g, error));
    *pressure = dem_world_measures(g->world, &count)->mean_stress * g->diameter * scale / g->stiffness;
    g->jam->stages++;
    return DEM_OK;
}

// Under the pressure the packing has given way all along; where it begins is seen on the way back, on which nothing
// gives way: the grains shrink in stages to a quarter of it, and a straight line through these ends at zero.
static dem_status unload(growing *g, dem_error *error)
{
    dem_jam *jam = g->jam;
    double sp = 0, ss = 0, pp = 0, ps = 0, p;
    // what a stiff packing of n contacts a grain gives way by is 3 overlaps of a diameter
    double whole = 9.42 * jam->pressure / jam->contacts;
    for (int i = 0; i < UNLOADING; i++) {
        double s = -0.15 * whole * i;
        DEM_TRY(stage(g, jam->last + s, &p, error));
        sp += p;
        ss += s;
        pp += p * p;
        ps += p * s;
    }
    double spread = UNLOADING * pp - sp * sp;
    jam->solid_fraction = jam->last + (spread > 0 ? (ss * pp - sp * ps) / spread : -whole);
    return DEM_OK;
}

// grains with fewer than four contacts bear no load; without them others may have too few
static dem_status count_contacts(growing *g, dem_error *error)
{
    size_t count;
    const dem_contact *all = dem_world_contacts(g->world, &count);
    uint32_t *touched = dem_alloc_zero(2 * g->count, sizeof *touched), *gone = touched ? touched + g->count : NULL;
    if (!touched)
        return dem_fail_memory(error);
    size_t bearing = g->count, pairs = 0;
    for (bool changed = true; changed;) {
        changed = false;
        pairs = 0;
        for (size_t i = 0; i < g->count; i++)
            touched[i] = 0;
        for (size_t i = 0; i < count; i++)
            if (all[i].other != UINT32_MAX && !gone[all[i].body] && !gone[all[i].other]) {
                touched[all[i].body]++;
                touched[all[i].other]++;
                pairs++;
            }
        for (size_t i = 0; i < g->count; i++)
            if (!gone[i] && touched[i] < 4) {
                gone[i] = changed = true;
                bearing--;
            }
    }
    free(touched);
    g->jam->contacts = bearing ? 2 * (double)pairs / (double)bearing : 0;
    g->jam->loose = 1 - (double)bearing / (double)g->count;
    return DEM_OK;
}

static dem_status grow(growing *g, dem_error *error)
{
    const dem_jam_def *def = g->def;
    dem_jam *jam = g->jam;
    double solid = def->begin, by = def->growth;
    for (size_t i = 0; i < MOST_STAGES && solid < MOST_SOLID; i++) {
        if (dem_progress(g->ctx, "growing", fmin(solid / 0.75, 1)))
            return dem_fail(error, DEM_INTERRUPTED, "interrupted");
        DEM_TRY(stage(g, solid, &jam->pressure, error));
        jam->last = solid;
        if (jam->pressure > def->pressure) {
            DEM_TRY(count_contacts(g, error));
            return unload(g, error);
        }
        // coarse steps far from the end
        by = jam->pressure > FINE_FROM * def->pressure ? def->growth / 10 : solid < 0.5 ? 3 * def->growth : def->growth;
        solid += by;
    }
    return dem_fail(error, DEM_FAILED, "no pressure builds up until a solid fraction of %g; ask for less of it", solid);
}

dem_status dem_jam_run(const dem_ctx *ctx, const dem_jam_def *def, dem_jam *jam, dem_error *error)
{
    double start = dem_clock();
    growing *g = dem_alloc_zero(1, sizeof *g);
    if (!g)
        return dem_fail_memory(error);
    *jam = (dem_jam){.solid_fraction = NAN};
    g->ctx = ctx;
    g->def = def;
    g->jam = jam;
    set_scene(g);
    dem_status status = begin(g, error);
    if (status == DEM_OK)
        status = grow(g, error);
    leave_world(g);
    free(g->bodies);
    free(g);
    jam->seconds = dem_clock() - start;
    return status;
}
