// What must not matter: where a scene stands and how it moves, which way it is turned, which way time runs, and how a
// sphere is told; and the step beyond which it does matter. PHYSICS 2.1, 6.3 to 6.5.
#include "study/trial.h"
#include "study/verify.h"

static const double RADIUS = 0.01, G = 9.81;

// ---- two clumps that meet, in another frame

typedef struct frame {
    dem_quat turn;
    dem_vec3 boost;
} frame;

// of both clumps, brought back
typedef struct outcome {
    dem_motion bodies[2];
} outcome;

static void odd_pair(model *m, const frame *f)
{
    uint32_t shape = model_cloud(m, 6, 0.03, 3);
    for (int i = 0; i < 2; i++) {
        dem_body_def *b = model_body(m, shape, quat_rotate(f->turn, v3(0.021 * i - 0.01, 0.004 * i, 0.018 * i)));
        b->orientation = quat_multiply(f->turn, quat_unit((dem_quat){1, 0.3 * i, 0.2, -0.4}));
        b->velocity = v3_add(quat_rotate(f->turn, v3(0.3 - 0.6 * i, 0.2, 0.3 - 0.7 * i)), f->boost);
        b->spin = quat_rotate(f->turn, v3(5, -8, 20 * i));
    }
}

static outcome meet(dem_trial *t, bool hertz, const frame *f, uint64_t steps)
{
    model *m = dem_trial_model(t);
    dem_pair_law *law = &m->laws[0];
    law->damping = DEM_DAMPING_RESTITUTION;
    law->restitution = 0.6;
    law->friction = hertz ? DEM_FRICTION_MINDLIN : DEM_FRICTION_LINEAR;
    law->friction_coefficient = 0.4;
    law->normal = hertz ? DEM_NORMAL_HERTZ : DEM_NORMAL_LINEAR;
    m->materials[0].young = 1e7;
    odd_pair(m, f);
    dem_trial_start(t);
    dem_trial_step(t, steps);
    outcome o = {{dem_trial_body(t, 0), dem_trial_body(t, 1)}};
    for (int i = 0; i < 2; i++) {
        dem_motion *b = &o.bodies[i];
        b->position = quat_unrotate(f->turn, v3_along(b->position, -dem_trial_time(t), f->boost));
        b->velocity = quat_unrotate(f->turn, v3_sub(b->velocity, f->boost));
        b->spin = quat_unrotate(f->turn, b->spin);
        b->orientation = quat_multiply(quat_conjugate(f->turn), b->orientation);
    }
    return o;
}

static void expect_same(dem_trial *t, const outcome *a, const outcome *b, double tolerance, const char *name)
{
    double off[3] = {0};
    for (int i = 0; i < 2; i++) {
        off[0] = fmax(off[0], v3_distance(a->bodies[i].position, b->bodies[i].position));
        off[1] = fmax(off[1], v3_distance(a->bodies[i].velocity, b->bodies[i].velocity));
        off[2] = fmax(off[2], angle_between(a->bodies[i].orientation, b->bodies[i].orientation));
    }
    dem_expect_most(t, off[0], tolerance, "m", "%s: positions off by", name);
    dem_expect_most(t, off[1], tolerance, "m/s", "%s: velocities off by", name);
    dem_expect_most(t, off[2], 100 * tolerance, "rad", "%s: orientations off by", name);
}

static const frame AS_TOLD = {{1, 0, 0, 0}, {0, 0, 0}};

static void other_frame(dem_trial *t, frame f, double tolerance)
{
    f.turn = quat_unit(f.turn);
    for (int hertz = 0; hertz < 2; hertz++) {
        outcome a = meet(t, hertz, &AS_TOLD, 3000), b = meet(t, hertz, &f, 3000);
        dem_expect_least(t, v3_distance(a.bodies[0].velocity, v3(0.3, 0.2, 0.3)), 0.01, "m/s",
                         "%s: velocity is changed by", hertz ? "hertz" : "linear");
        expect_same(t, &a, &b, tolerance, hertz ? "hertz" : "linear");
    }
}
static void boosted(dem_trial *t)
{
    other_frame(t, (frame){{1, 0, 0, 0}, {30, -20, 10}}, 1e-10);
}
static void turned(dem_trial *t)
{
    other_frame(t, (frame){{0.7, 0.5, -0.3, 0.2}, {0, 0, 0}}, 1e-9);
}

// elastic and smooth: with all velocities the other way round everything comes back
static void backwards(dem_trial *t)
{
    frame f = AS_TOLD;
    model *m = dem_trial_model(t);
    odd_pair(m, &f);
    dem_body_def start[2] = {m->bodies[0], m->bodies[1]};
    dem_trial_start(t);
    dem_trial_step(t, 3000);
    dem_motion turn[2] = {dem_trial_body(t, 0), dem_trial_body(t, 1)};
    m = dem_trial_model(t);
    odd_pair(m, &f);
    for (int i = 0; i < 2; i++) {
        m->bodies[i].position = turn[i].position;
        m->bodies[i].orientation = turn[i].orientation;
        m->bodies[i].velocity = v3_scale(turn[i].velocity, -1);
        m->bodies[i].spin = v3_scale(turn[i].spin, -1);
    }
    dem_trial_start(t);
    dem_trial_step(t, 3000);
    double off[3] = {0};
    for (int i = 0; i < 2; i++) {
        dem_motion b = dem_trial_body(t, (size_t)i);
        off[0] = fmax(off[0], v3_distance(b.position, start[i].position));
        off[1] = fmax(off[1], v3_norm(v3_add(b.velocity, start[i].velocity)));
        off[2] = fmax(off[2], angle_between(b.orientation, start[i].orientation));
    }
    dem_expect_least(t, v3_distance(turn[0].velocity, start[0].velocity), 0.01, "m/s", "velocity is changed by");
    dem_expect_most(t, off[0], 1e-9, "m", "positions, off by");
    dem_expect_most(t, off[1], 1e-9, "m/s", "velocities, off by");
    dem_expect_most(t, off[2], 1e-9, "rad", "orientations, off by");
}

// ---- a clump of one sphere

// a box of spheres with friction and gravity, told as spheres or as clumps; a hash of its state
static uint64_t hash_of(dem_trial *t, bool clumps)
{
    model *m = dem_trial_model(t);
    double mass = model_ball_mass(RADIUS), inertia = 0.4 * mass * RADIUS * RADIUS;
    if (clumps)
        model_clump(m, (dem_ball[]){{{0, 0, 0}, RADIUS}}, 1, mass, (double[]){inertia, inertia, inertia});
    else
        model_sphere(m, RADIUS);
    m->laws[0].damping = DEM_DAMPING_RESTITUTION;
    m->laws[0].restitution = 0.5;
    m->laws[0].friction = DEM_FRICTION_LINEAR;
    m->laws[0].friction_coefficient = 0.5;
    m->scene.gravity = v3(1, 0, -G);
    model_lattice(m, 64, 0.025, 1, 5);
    model_box(m, v3(0, 0, 0), v3(0.1, 0.1, 0.2));
    dem_trial_start(t);
    dem_trial_step(t, 20000);
    dem_expect_least(t, (double)dem_trial_figures(t)->contacts, 20, "", "%s: contacts", clumps ? "clumps" : "spheres");
    return t->world ? dem_world_hash(t->world) : 0;
}

static void one_sphere_clump(dem_trial *t)
{
    uint64_t sphere = hash_of(t, false), clump = hash_of(t, true);
    dem_expect(t, sphere == clump, 1, 0, "", "the same bits after 20000 steps");
}

// ---- the limit of the step

// a sphere pressed by two planes, beside its place by a part of the overlap; z = w h. How far it is off after the
// steps, over how far at first
static double pressed(dem_trial *t, double z, uint64_t steps)
{
    model *m = dem_trial_model(t);
    const double k = 1e4, deep = 1e-4;
    m->scene.time.step = z / sqrt(2 * k / model_ball_mass(RADIUS));
    model_plane(m, v3(0, 0, deep - RADIUS), v3(0, 0, 1));
    model_plane(m, v3(0, 0, RADIUS - deep), v3(0, 0, -1));
    model_body(m, model_sphere(m, RADIUS), v3(0, 0, 1e-9 * deep));
    dem_trial_start(t);
    double most = 0;
    for (uint64_t i = 0; i < steps && dem_trial_step(t, 1); i++)
        most = fmax(most, fabs(dem_trial_body(t, 0).position.z));
    return most / (1e-9 * deep);
}

// below z = 2 the leapfrog of an oscillator from rest is cos(n theta), beyond it cosh(n lambda). Rounding, 1e-18 m of
// the force, is 1e-5 of the amplitude
static void step_limit(dem_trial *t)
{
    static const double zs[] = {1, 1.9, 1.99};
    for (int i = 0; i < 3; i++)
        dem_expect_most(t, pressed(t, zs[i], 2000), 1 + 1e-2, "", "z = %g: largest amplitude in 2000 steps", zs[i]);
    for (int i = 0; i < 2; i++) {
        double z = i ? 2.1 : 2.01, half = z * z / 2 - 1, growth = half + sqrt(half * half - 1);
        int steps = i ? 22 : 40;
        double want = 0.5 * (pow(growth, steps) + pow(growth, -steps));
        dem_expect(t, pressed(t, z, (uint64_t)steps), want, 1e-3 * want, "", "z = %g: amplitude after %d steps", z,
                   steps);
    }
}

const dem_case dem_verify_whole[] = {
    {"galilei", "a pair that meets while all moves on", "Galilean invariance", false, boosted},
    {"turned", "a pair that meets, turned as a whole", "invariance under rotation", false, turned},
    {"backwards", "an elastic collision of clumps runs backwards", "reversible in time", false, backwards},
    {"one-sphere-clump", "a clump of one sphere is a sphere, bit for bit", "the same scene", false, one_sphere_clump},
    {"step-limit", "a sphere between two planes blows up beyond z = 2", "central differences", false, step_limit},
    {0},
};
