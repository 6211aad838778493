// The same scenes elsewhere and of other sizes: far from the origin, of grains of a micrometre and of a thousand
// kilometres. What single precision or a number with a hidden unit would spoil.
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "sim/validate.h"
#include "study/stability.h"

static const double RADIUS = 0.0078125;  // 2^-7 m

// Lengths times `size` and times of as many: speeds, densities and stresses are the same. A power of two changes
// nothing but exponents.
typedef struct place {
    const char *name;
    double size;
    dem_vec3 from;  // the origin [m]
} place;

// what has numbers of its own that might have a hidden unit
typedef enum physics { LINEAR, HERTZ, JKR, ROLLING, SOFT, MESH, PERIODIC, PHYSICS } physics;
static const char *const physics_names[] = {"linear", "Hertz", "JKR", "rolling", "soft", "mesh", "periodic"};

static void choose_law(model *m, const place *p, physics kind)
{
    dem_pair_law *l = &m->laws[0];
    bool hertz = kind == HERTZ || kind == JKR;
    l->normal = kind == HERTZ ? DEM_NORMAL_HERTZ : kind == JKR ? DEM_NORMAL_JKR : DEM_NORMAL_LINEAR;
    l->stiffness = 2e4 * p->size;
    m->materials[0].young = 1e7;
    l->work_of_adhesion = 0.1 * p->size;
    l->damping = DEM_DAMPING_RESTITUTION;
    l->restitution = 0.5;
    l->friction = hertz ? DEM_FRICTION_MINDLIN : DEM_FRICTION_LINEAR;
    l->friction_coefficient = 0.5;
    if (kind == ROLLING) {
        l->rolling = DEM_ROLLING_EPSD;
        l->rolling_coefficient = 0.1;
        l->twisting = DEM_TWISTING_MARSHALL;
    }
    if (kind == SOFT) {
        m->scene.multiple = DEM_MULTIPLE_SOFT;
        m->scene.soft.tau = 0x1p-14 * p->size;
    }
}

// a square floor of two triangles
static void put_floor(dem_trial *t, double side)
{
    model *m = t->model;
    static const uint32_t corners[6] = {0, 1, 2, 0, 2, 3};
    dem_mesh *mesh = dem_trial_mesh(t, 4, 2);
    for (int i = 0; mesh && i < 4; i++)
        mesh->vertices[i] = v3(i == 1 || i == 2 ? side : 0, i >= 2 ? side : 0, 0);
    if (mesh)
        memcpy(mesh->triangles, corners, sizeof corners);
    // instead of the plane below
    m->walls[4] = m->walls[--m->scene.wall_count];
    m->walls[m->scene.wall_count] = (dem_wall_def){0};
}

// mixed grains that fall into a box
static void make_fall(dem_trial *t, const place *p, physics kind)
{
    model *m = dem_trial_model(t);
    double r = RADIUS * p->size, side = 0.125 * p->size;
    m->scene.gravity = v3(0, 0, -8 / p->size);
    // 1 / 30 of the shortest contact; a law of Hertz' own step is not the same to the last digit
    m->scene.time.step = 0x1p-16 * p->size;
    choose_law(m, p, kind);
    model_sphere(m, r);
    model_dumbbell(m, r, r);
    model_cloud(m, 12, 3 * r, 4);
    model_box(m, v3(0, 0, 0), v3(side, side, 8 * side));
    model_lattice(m, 48, 0.03125 * p->size, 0.5, 3);
    if (kind == MESH)
        put_floor(t, side);
    if (kind == PERIODIC) {
        m->scene.domain.low = p->from;
        m->scene.domain.high = v3_add(p->from, v3(side, side, 16 * side));
        m->scene.domain.periodic[0] = m->scene.domain.periodic[1] = true;
        for (int k = 0; k < 2; k++)  // floor and lid alone
            m->walls[k] = m->walls[4 + k];
        m->scene.wall_count = 2;
    }
    for (size_t i = 0; i < m->scene.wall_count; i++) {
        m->walls[i].point = v3_add(m->walls[i].point, p->from);
        for (size_t k = 0; k < m->walls[i].mesh.vertex_count; k++)
            m->walls[i].mesh.vertices[k] = v3_add(m->walls[i].mesh.vertices[k], p->from);
    }
    for (size_t i = 0; i < m->scene.bodies.count; i++)
        m->bodies[i].position = v3_add(m->bodies[i].position, p->from);
}

typedef struct fall {
    size_t missed, contacts;
    double energy, borne, deepest;
    dem_vec3 mean;
} fall;

static dem_vec3 walls_force(dem_trial *t)
{
    dem_vec3 sum = v3(0, 0, 0);
    for (size_t i = 0; i < t->model->scene.wall_count; i++)
        sum = v3_add(sum, dem_trial_wall(t, i).force);
    return sum;
}

// What walls have borne, of the weight, while all steps are looked at: by the impulse that the bodies have not kept.
static double borne_in(dem_trial *t, int steps, double gravity)
{
    double impulse = 0, weight = 0, force = walls_force(t).z, h = t->model->scene.time.step;
    dem_body_view v = t->status == DEM_OK ? dem_world_bodies(t->world) : (dem_body_view){0};
    for (size_t i = 0; i < v.count; i++) {
        weight += v.mass[i] * gravity;
        impulse += v.mass[i] * v.velocity[i].z;
    }
    for (int i = 0; i < steps && dem_trial_step(t, 1); i++) {
        impulse -= 0.5 * h * force;
        force = walls_force(t).z;
        impulse -= 0.5 * h * force;
    }
    v = t->status == DEM_OK ? dem_world_bodies(t->world) : (dem_body_view){0};
    for (size_t i = 0; i < v.count; i++)
        impulse -= v.mass[i] * v.velocity[i].z;
    return impulse / (weight * h * steps);
}

static fall run(dem_trial *t, const place *p, physics kind, int looks)
{
    fall f = {0};
    make_fall(t, p, kind);
    if (!dem_trial_start(t))
        return f;
    for (int i = 0; i < looks && dem_trial_step(t, 500); i++) {
        dem_truth truth;
        t->status = dem_world_validate(t->world, &truth, &t->error);
        f.missed += truth.missed + truth.doubled + truth.unsound;
        f.contacts += truth.contacts;
    }
    f.borne = borne_in(t, 500, 8 / p->size);
    const dem_figures *g = dem_trial_figures(t);
    f.energy = fabs(g->energy.error);
    f.deepest = g->largest_overlap_ratio;
    f.mean = v3_sub(g->centre, p->from);
    return f;
}

static void try_far(dem_trial *t, const physics *kinds, size_t count, int looks)
{
    static const place places[] = {
        {"at the origin", 1, {0, 0, 0}},
        {"1 km away", 1, {1024, -1024, 1024}},
        {"1000 km away", 1, {1048576, 1048576, -1048576}},
    };
    for (size_t k = 0; k < count && !t->skipped; k++) {
        fall near = {0};
        for (size_t i = 0; i < 3; i++) {
            const place *p = &places[i];
            fall f = run(t, p, kinds[k], looks);
            const char *kind = physics_names[kinds[k]];
            near = i ? near : f;
            dem_expect_most(t, (double)f.missed, 0, "", "%s, %s: contacts missed or doubled", kind, p->name);
            dem_expect_most(t, f.energy, 1e-2, "", "%s, %s: energy off by", kind, p->name);
            dem_expect_most(t, f.deepest, 0.1, "", "%s, %s: largest overlap over radius", kind, p->name);
            // to rounding, wherever it is: what is felt is what is reported
            dem_expect(t, f.borne, 1, 1e-9, "", "%s, %s: walls bear, of the weight", kind, p->name);
            // another way to the same heap
            dem_expect(t, f.mean.z / near.mean.z, 1, 0.1, "", "%s, %s: height of the heap, of that at the origin", kind,
                       p->name);
        }
    }
}

static void far(dem_trial *t)
{
    try_far(t, (physics[]){LINEAR}, 1, 60);
}

static void far_others(dem_trial *t)
{
    try_far(t, (physics[]){PERIODIC, SOFT, MESH}, 3, 150);
}

// a ball that bounces on a plane, to all digits there are
static void far_bounce(dem_trial *t)
{
    static const double distances[] = {0, 1024, 1048576};
    dem_motion first = {0};
    for (size_t i = 0; i < 3; i++) {
        model *m = dem_trial_model(t);
        double d = distances[i];
        m->scene.gravity = v3(0, 0, -8);
        m->laws[0].friction = DEM_FRICTION_LINEAR;
        m->laws[0].friction_coefficient = 0.5;
        model_plane(m, v3(d, d, d), v3(0, 0, 1));
        model_plane(m, v3(d + 0.25, d, d), v3(-1, 0, 0));
        dem_body_def *b = model_body(m, model_dumbbell(m, RADIUS, RADIUS), v3(d, d, d + 0.0625));
        b->velocity = v3(0.5, 0.25, 0);
        b->spin = v3(10, 0, 5);
        dem_trial_start(t);
        dem_trial_step(t, 50000);
        dem_motion end = dem_trial_body(t, 0);
        end.position = v3_sub(end.position, v3(d, d, d));
        first = i ? first : end;
        // each of 5e4 steps rounds by half of 2.3e-10 m, and each of some bounces of a dumbbell triples what is off
        if (i)
            dem_expect_most(t, v3_distance(end.position, first.position) / RADIUS, d > 1e4 ? 1e-2 : 1e-5, "",
                            "%g m away: off after some bounces, over the radius", d);
        dem_expect_most(t, fabs(dem_trial_figures(t)->energy.error), 1e-3, "", "%g m away: energy off by", d);
    }
}

static void sizes(dem_trial *t)
{
    // even powers: their square roots are powers of two
    static const place places[] = {
        {"8 mm", 1, {0, 0, 0}},
        {"0.5 um", 0x1p-14, {0, 0, 0}},
        {"0.5 nm", 0x1p-24, {0, 0, 0}},
        {"8 km", 0x1p20, {0, 0, 0}},
    };
    for (int kind = 0; kind < PHYSICS; kind++) {
        fall first = {0};
        t->skipped = NULL;
        for (size_t i = 0; i < 4 && !t->skipped; i++) {
            const place *p = &places[i];
            fall f = run(t, p, (physics)kind, 15);
            const char *law = physics_names[kind];
            first = i ? first : f;
            dem_expect_most(t, (double)f.missed, 0, "", "%s, %s: contacts missed or doubled", law, p->name);
            dem_expect_most(t, f.energy, 1e-2, "", "%s, %s: energy off by", law, p->name);
            // soft contacts differ by a last bit in kilometres; where is not known
            if (i)
                dem_expect_most(t, v3_distance(v3_scale(f.mean, 1 / p->size), first.mean) / RADIUS,
                                kind == SOFT ? 1e-11 : 1e-12, "", "%s, %s: mean place, over the radius off by", law,
                                p->name);
        }
    }
    t->skipped = NULL;
}

const dem_case dem_stability_places[] = {
    {"place-far", "grains fall into a box far from the origin", "brute force; energy; weight", false, far},
    {"place-far-others", "the same with a periodic domain, soft contacts and a mesh", "brute force; energy; weight",
     true, far_others},
    {"place-bounce", "a dumbbell bounces far from the origin", "the same at the origin", false, far_bounce},
    {"place-sizes", "grains from 1 nm to 8 km fall into a box", "similarity: the same numbers", false, sizes},
    {0},
};
