// What is at rest stays at rest: high stacks, flat faces, heavy on light, for a day. PHYSICS 6.4.
#include <math.h>
#include <stdio.h>

#include "study/stability.h"

static const double RADIUS = 0.01, WEIGHT = 9.81;

static void rough(model *m, double stiffness)
{
    m->scene.gravity = v3(0, 0, -WEIGHT);
    m->scene.time.step = 0;
    m->laws[0].stiffness = stiffness;
    m->laws[0].damping = DEM_DAMPING_RESTITUTION;
    m->laws[0].restitution = 0.3;
    m->laws[0].friction = DEM_FRICTION_LINEAR;
    m->laws[0].friction_coefficient = 0.5;
}

// what bodies were moved by since, and turned by times the radius, at most [m]
static double moved(dem_trial *t, const dem_motion *since, size_t count)
{
    double most = 0;
    for (size_t i = 0; i < count; i++) {
        dem_motion b = dem_trial_body(t, i);
        double off =
            v3_distance(b.position, since[i].position) + RADIUS * angle_between(b.orientation, since[i].orientation);
        most = off <= most ? most : off;  // NAN is the most
    }
    return most;
}

static void look(dem_trial *t, dem_motion *at, size_t count)
{
    for (size_t i = 0; i < count; i++)
        at[i] = dem_trial_body(t, i);
}

// ---- a million times heavier

// stays on a light sphere that stands on a plane, both held in the line
static void heavy(dem_trial *t)
{
    static const double ratios[] = {1e3, 1e6};
    for (size_t i = 0; i < 2; i++) {
        model *m = dem_trial_model(t);
        double r = ratios[i], mass = model_ball_mass(RADIUS), k = r * mass * WEIGHT / (1e-3 * RADIUS);
        rough(m, k);
        m->laws[0].damping = DEM_DAMPING_NONE;
        m->materials[1] = (dem_material){"heavy", 2500 * r, 1e9, 0.25};
        m->laws[1] = m->laws[2] = m->laws[0];
        m->laws[1].materials[1] = m->laws[2].materials[0] = m->laws[2].materials[1] = 1;
        m->scene.material_count = 2;
        m->scene.law_count = 3;
        uint32_t light = model_sphere(m, RADIUS), above = model_sphere(m, RADIUS);
        m->shapes[above].material = 1;
        double low = (1 + r) * mass * WEIGHT / k, high = r * mass * WEIGHT / k;
        model_plane(m, v3(0, 0, 0), v3(0, 0, 1));
        model_body(m, light, v3(0, 0, RADIUS - low))->hold = DEM_LOCK_X | DEM_LOCK_Y;
        model_body(m, above, v3(0, 0, 3 * RADIUS - low - high))->hold = DEM_LOCK_X | DEM_LOCK_Y;
        dem_motion begin[2];
        dem_trial_start(t);
        look(t, begin, 2);
        dem_trial_step(t, 60000);
        dem_expect_most(t, moved(t, begin, 2) / RADIUS, 1e-9, "", "%g : 1: moved in 60000 steps, over the radius", r);
        dem_expect(t, dem_trial_wall(t, 0).force.z / (-(1 + r) * mass * WEIGHT), 1, 1e-9, "",
                   "%g : 1: the floor bears, of the weight", r);
    }
}

// ---- stacks

enum { HIGH = 50 };

// corners of a block: spheres at +-2 radii; contacts above each other alone
static uint32_t block(model *m)
{
    dem_ball balls[8];
    for (int i = 0; i < 8; i++) {
        dem_vec3 c = v3(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1);
        balls[i] = (dem_ball){v3_scale(c, 2 * RADIUS), RADIUS};
    }
    double side = 6 * RADIUS, mass = 2500 * side * side * side, moment = mass * side * side / 6;
    return model_clump(m, balls, 8, mass, (double[]){moment, moment, moment});
}

static void stack(dem_trial *t)
{
    model *m = dem_trial_model(t);
    double mass = 2500 * pow(6 * RADIUS, 3), soft = 1e-5 * RADIUS, z = 3 * RADIUS, want[HIGH];
    dem_random r = random_stream(9, 1);
    rough(m, mass * WEIGHT / (4 * soft));
    uint32_t shape = block(m);
    model_plane(m, v3(0, 0, 0), v3(0, 0, 1));
    for (int i = 0; i < HIGH; i++) {
        z -= (HIGH - i) * soft;
        want[i] = z;
        dem_body_def *b = model_body(m, shape, v3(0, 0, z));
        b->velocity = v3_scale(random_in(&r, v3(-1, -1, -1), v3(1, 1, 1)), 1e-4);
        z += 6 * RADIUS;
    }
    dem_trial_start(t);
    dem_trial_step(t, 60000);
    double off = 0, aside = 0;
    for (int i = 0; i < HIGH; i++) {
        dem_vec3 x = dem_trial_body(t, (size_t)i).position;
        off = fmax(off, fabs(x.z - want[i]));
        aside = fmax(aside, hypot(x.x, x.y));
    }
    if (t->status != DEM_OK)
        off = aside = NAN;
    dem_expect_most(t, off / (HIGH * HIGH / 2 * soft), 0.02, "", "height off by, over how much it is pressed");
    dem_expect_most(t, aside / RADIUS, 1e-2, "", "top aside by, over the radius");
    dem_expect(t, -dem_trial_wall(t, 0).force.z / (HIGH * mass * WEIGHT), 1, 1e-2, "",
               "the floor bears, of the weight");
    dem_expect_most(t, dem_trial_figures(t)->fastest, 1e-3, "m/s", "fastest");
    dem_expect_most(t, fabs(dem_trial_figures(t)->energy.error), 1e-2, "", "energy off by");
}

// ---- flat on flat

// 5 x 5 spheres in a plane; two such plates on a floor: 25 contacts where 3 would do
static void flat(dem_trial *t)
{
    model *m = dem_trial_model(t);
    dem_ball balls[25];
    double side = 10 * RADIUS, mass = 2500 * side * side * 2 * RADIUS, across = mass * side * side / 12;
    rough(m, 1e5);
    for (int i = 0; i < 25; i++)
        balls[i] = (dem_ball){v3((i % 5 - 2) * 2 * RADIUS, (i / 5 - 2) * 2 * RADIUS, 0), RADIUS};
    uint32_t plate = model_clump(m, balls, 25, mass, (double[]){across, across, 2 * across});
    model_plane(m, v3(0, 0, 0), v3(0, 0, 1));
    double soft = mass * WEIGHT / (25 * 1e5);
    for (int i = 0; i < 2; i++)
        model_body(m, plate, v3(0, 0, RADIUS + i * 2 * RADIUS + 1e-4));
    dem_motion settled[2];
    dem_trial_start(t);
    dem_trial_step(t, 40000);
    look(t, settled, 2);
    dem_expect(t, settled[0].position.z, RADIUS - 2 * soft, 1e-9, "m", "height of the lower plate");
    dem_expect(t, settled[1].position.z, 3 * RADIUS - 3 * soft, 1e-9, "m", "height of the upper plate");
    size_t count;
    const dem_contact *c = dem_trial_contacts(t, &count);
    double most = 0, least = INFINITY;
    for (size_t i = 0; i < count; i++) {
        double part = c[i].normal_force / (mass * WEIGHT / 25) / (c[i].wall == UINT32_MAX ? 1 : 2);
        most = fmax(most, part);
        least = fmin(least, part);
    }
    dem_expect(t, (double)count, 50, 0, "", "contacts");
    dem_expect(t, most, 1, 1e-6, "", "largest part of the weight in a contact, times 25");
    dem_expect(t, least, 1, 1e-6, "", "smallest part of the weight in a contact, times 25");
    dem_trial_step(t, 100000);
    dem_expect_most(t, moved(t, settled, 2) / RADIUS, 1e-9, "", "moved in 100000 more steps, over the radius");
}

// ---- for long

enum { BOULDERS = 8 };

static const double BOULDER = 1;  // radius [m]

// boulders of 1 m, so soft that a step is some hundredths of a second, in a box
static void long_rest(dem_trial *t, double seconds, double settle)
{
    model *m = dem_trial_model(t);
    dem_motion settled[BOULDERS];
    rough(m, 2e6);
    // none that is round, or it would roll on and on
    model_cloud(m, 20, 4 * BOULDER, 2);
    model_cloud(m, 10, 3.5 * BOULDER, 3);
    model_box(m, v3(0, 0, 0), v3(9, 9, 40));
    model_lattice(m, BOULDERS, 4, 0, 3);
    dem_trial_start(t);
    uint64_t chunk = 1000;
    while (dem_trial_step(t, chunk) && dem_trial_time(t) < settle) {
    }
    look(t, settled, BOULDERS);
    double begin = dem_trial_time(t), next = 0, least = INFINITY, most = 0;
    dem_trial_plot(
        t, (dem_plot_axis){.title = "time [s]"},
        (dem_plot_axis){.title = "moved since it was settled, over the radius", .log = true, .floor = 1e-16});
    uint64_t steps = t->status == DEM_OK ? dem_world_steps(t->world) : 0;
    while (dem_trial_step(t, chunk) && dem_trial_time(t) < seconds) {
        double h = dem_world_step_size(t->world);
        least = fmin(least, h);
        most = fmax(most, h);
        if (dem_trial_time(t) < begin + next)
            continue;
        dem_trial_point(t, "moved", dem_trial_time(t), moved(t, settled, BOULDERS) / BOULDER);
        next += seconds / 30;
    }
    const dem_figures *f = dem_trial_figures(t);
    steps = t->status == DEM_OK ? dem_world_steps(t->world) - steps : 0;
    dem_expect_least(t, dem_trial_time(t), seconds, "s", "time at the end");
    dem_expect_least(t, (double)steps, seconds / 0.1, "", "steps at rest");
    dem_expect_most(t, moved(t, settled, BOULDERS) / BOULDER, 1e-6, "", "moved since %g s, over the radius", settle);
    dem_expect_most(t, f->fastest, 1e-9, "m/s", "fastest at the end");
    dem_expect_most(t, fabs(f->energy.error), 1e-2, "", "energy off by, all in all");
    dem_expect_least(t, least / most, 1 - 1e-12, "", "smallest over largest step while at rest");
}

static void hour(dem_trial *t)
{
    long_rest(t, 3600, 600);
}

static void day(dem_trial *t)
{
    long_rest(t, 86400, 600);
}

const dem_case dem_stability_rest[] = {
    {"rest-heavy", "a sphere on one of a millionth of its mass", "PHYSICS 6.4: no drift", false, heavy},
    {"rest-stack", "50 blocks on each other, pushed a little", "weight; stiffness of 4 contacts", false, stack},
    {"rest-flat", "two plates of 25 spheres flat on a floor", "weight / 25 in each contact", false, flat},
    {"rest-hour", "eight boulders in a box, an hour", "no drift", true, hour},
    {"rest-day", "the same for a day", "no drift", true, day},
    {0},
};
