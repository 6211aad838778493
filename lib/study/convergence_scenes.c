// Scenes on which schemes of integration can be told apart. The first five are those of the table of PHYSICS 2.3.
#include "sim/state.h"
#include "study/convergence.h"
#include "study/model.h"

// ---- bodies that nothing touches

static void lone(model *m, const double inertia[3], dem_vec3 spin, double end, double steps)
{
    model_body(m, model_clump(m, (dem_ball[]){{{0, 0, 0}, 1}}, 1, 1, inertia), v3(0, 0, 0))->spin = spin;
    m->scene.time.end = end;
    m->scene.time.step = end / steps;
}

static void free_top(model *m)
{
    lone(m, (double[]){1, 2, 3}, v3(1, 0.5, 0.8), 100, 1400);
}

static void dzhanibekov(model *m)
{
    lone(m, (double[]){1, 2, 3}, v3(1e-3, 1, 0), 100, 1200);
}

static void needle(model *m)
{
    // that of the table, 1e-4, 1, 1.02, is no body's
    lone(m, (double[]){1e-4, 1, 1.00009}, v3(50, 0.3, 0.2), 20, 10200);
}

static void plate(model *m)
{
    lone(m, (double[]){1, 1.05, 1.95}, v3(3, 0.5, 20), 20, 4200);
}

// slow steady precession of a top on its pivot: I1 W^2 cos(tilt) - I3 w W + m g l = 0
static const double WEIGHT = 2;  // m g l [N m]

static void heavy_top(model *m)
{
    const double tilt = DEM_PI / 6, a = 0.2 * cos(tilt), b = 0.3 * 20;
    double rate = (b - sqrt(b * b - 4 * a * WEIGHT)) / (2 * a);
    dem_vec3 axis = v3(0, -sin(tilt), cos(tilt)), up = v3(0, 0, 1);
    lone(m, (double[]){0.2, 0.2, 0.3}, v3_along(v3_scale(axis, 20), rate, v3_along(up, -cos(tilt), axis)), 20, 4200);
    m->bodies[0].orientation = quat_about(v3(tilt, 0, 0));
}

static void heavy_top_push(dem_world *w)
{
    dem_vec3 axis = quat_rotate(body_orientation(&w->bodies, w->bodies.place[0]), v3(0, 0, 1));
    dem_world_push(w, 0, v3(0, 0, 0), v3_scale(v3_cross(axis, v3(0, 0, -1)), WEIGHT));
}

// ---- bodies that touch

static void stone(model *m, double restitution, double friction)
{
    m->scene.gravity = v3(0, 0, -9.81);
    m->laws[0].damping = restitution < 1 ? DEM_DAMPING_RESTITUTION : DEM_DAMPING_NONE;
    m->laws[0].restitution = restitution;
    m->laws[0].friction = friction > 0 ? DEM_FRICTION_LINEAR : DEM_FRICTION_NONE;
    m->laws[0].friction_coefficient = friction;
    m->laws[0].stiffness_ratio = 2.0 / 7;
    m->scene.time.step = 0;
}

// 20 turns of a dumbbell between two planes that hold it; always in touch, without friction
static void held_clump(model *m)
{
    stone(m, 1, 0);
    m->scene.gravity = v3(0, 0, 0);
    model_plane(m, v3(0, 0, -0.0098), v3(0, 0, 1));
    model_plane(m, v3(0, 0, 0.0098), v3(0, 0, -1));
    dem_body_def *b = model_body(m, model_dumbbell(m, 0.01, 0.01), v3(0, 0, 2e-5));
    b->orientation = quat_about(v3(0, 0.004, 0));
    b->spin = v3(3, 0, 5);
    m->scene.time.end = 0.05;
}

static void bouncing_clump(model *m)
{
    stone(m, 0.8, 0.3);
    model_plane(m, v3(0, 0, 0), v3(0, 0, 1));
    dem_body_def *b = model_body(m, model_dumbbell(m, 0.01, 0.015), v3(0, 0, 0.05));
    b->orientation = quat_about(v3(0.3, 0.7, 0.2));
    b->velocity = v3(0.3, 0.1, 0);
    b->spin = v3(2, 5, 1);
    m->scene.time.end = 0.15;
}

static void sliding_block(model *m)
{
    stone(m, 0.5, 0.3);
    const double r = 0.005, edge = 0.02, mass = 2500 * edge * edge * edge;
    dem_ball balls[8];
    for (int i = 0; i < 8; i++)
        balls[i] = (dem_ball){v3((i & 1 ? 1 : -1) * r, (i & 2 ? 1 : -1) * r, (i & 4 ? 1 : -1) * r), r};
    double moment = mass * edge * edge / 6;
    model_plane(m, v3(0, 0, 0), v3(0, 0, 1));
    dem_body_def *b = model_body(m, model_clump(m, balls, 8, mass, (double[]){moment, moment, moment}),
                                 v3(0, 0, 2 * r - mass * 9.81 / 4 / m->laws[0].stiffness));
    b->velocity = v3(0.5, 0, 0);
    b->spin = v3(0, 0, 3);
    m->scene.time.end = 0.1;
}

static void small_pile(model *m)
{
    stone(m, 0.5, 0.5);
    uint32_t shape = model_dumbbell(m, 0.005, 0.005);
    dem_random r = random_stream(1, 5);
    for (int i = 0; i < 48; i++) {
        dem_body_def *b =
            model_body(m, shape, v3(0.02 * (i % 4 - 1.5), 0.02 * (i / 4 % 3 - 1), 0.012 + 0.02 * (double)(i / 12)));
        b->orientation = random_quat(&r);
        b->velocity = random_in(&r, v3(-0.1, -0.1, -0.1), v3(0.1, 0.1, 0.1));
    }
    model_plane(m, v3(0, 0, 0), v3(0, 0, 1));
    m->scene.time.end = 0.4;
}

static const dem_convergence_scene scenes[] = {
    {"free-top", "an asymmetric top, moments 1, 2, 3, turns freely for 100 s", free_top, NULL, "orientation"},
    {"dzhanibekov", "a top that turns about its middle axis and tumbles, for 100 s", dzhanibekov, NULL, "orientation"},
    {"heavy-top", "a top on its pivot precesses slowly, for 20 s", heavy_top, heavy_top_push, "orientation"},
    {"needle", "a body a hundred times as long as wide at 50 rad/s about its axis, for 20 s", needle, NULL,
     "orientation"},
    {"plate", "a nearly flat and nearly round body at 20 rad/s, for 20 s", plate, NULL, "orientation"},
    {"held-clump", "two joined spheres that rock between two elastic planes", held_clump, NULL, NULL},
    {"bouncing-clump", "two joined spheres fall on a rough plane and bounce", bouncing_clump, NULL, NULL},
    {"sliding-block", "eight joined spheres slide and turn on a rough plane until they rest", sliding_block, NULL,
     NULL},
    {"small-pile", "48 pairs of joined spheres fall and come to rest in a heap", small_pile, NULL, NULL},
};

const dem_convergence_scene *dem_convergence_scene_at(size_t index)
{
    return index < sizeof scenes / sizeof *scenes ? &scenes[index] : NULL;
}
