// Walls that press: a servo reaches its force without swinging about it, and what it presses has that stress.
// PHYSICS 1.11 and 5.
#include "study/trial.h"
#include "study/verify.h"

static const double RADIUS = 0.01;

static dem_servo_def servo(dem_vec3 direction, double target, double fastest)
{
    return (dem_servo_def){.on = true, .direction = direction, .target = target, .gain = 0.5, .max_velocity = fastest};
}

static void damp(model *m, double friction)
{
    m->laws[0].damping = DEM_DAMPING_RESTITUTION;
    m->laws[0].restitution = 0.5;
    m->laws[0].friction = friction > 0 ? DEM_FRICTION_LINEAR : DEM_FRICTION_NONE;
    m->laws[0].friction_coefficient = friction;
}

// a ball of 1 cm on the floor, under a plane that presses with 20 N: two springs of 1e4 N/m in series
static void press(dem_trial *t)
{
    model *m = dem_trial_model(t);
    damp(m, 0);
    model_body(m, model_sphere(m, RADIUS), v3(0, 0, RADIUS));
    model_plane(m, v3(0, 0, 0), v3(0, 0, 1));
    model_plane(m, v3(0, 0, 0.0205), v3(0, 0, -1))->servo = servo(v3(0, 0, -1), 20, 0.05);
    double largest = 0, off = 0;
    dem_trial_start(t);
    for (int i = 0; i < 400 && dem_trial_step(t, 50); i++) {
        double force = dem_trial_wall(t, 1).force.z;
        largest = fmax(largest, force);
        off = i > 300 ? fmax(off, fabs(force / 20 - 1)) : 0;
    }
    dem_expect_most(t, off, 0.005, "", "force in the last quarter, off by");
    dem_expect_most(t, largest / 20, 1.005, "", "largest force over the target");
    dem_expect(t, dem_trial_body(t, 0).position.z, RADIUS - 0.002, 1e-8, "m", "height of the ball");
}

// 64 rough grains between six smooth planes that press by 2, 4 and 6 kPa, two and two
static void triaxial(dem_trial *t)
{
    const double cell = 0.022, half = 2 * cell + 0.002;
    model *m = dem_trial_model(t);
    damp(m, 0.3);
    m->laws[0].stiffness = 1e5;
    // smooth walls: friction on one would be stress along another
    m->materials[1] = m->materials[0];
    m->laws[1] = m->laws[0];
    m->laws[1].materials[1] = 1;
    m->laws[1].friction = DEM_FRICTION_NONE;
    m->scene.material_count = m->scene.law_count = 2;
    model_sphere(m, RADIUS);
    model_lattice(m, 64, cell, 0, 3);
    for (size_t i = 0; i < m->scene.bodies.count; i++)
        m->bodies[i].position = v3_sub(m->bodies[i].position, v3(2 * cell, 2 * cell, 2 * cell));
    for (int i = 0; i < 6; i++) {
        uint32_t axis = (uint32_t)i / 2;
        dem_vec3 n = v3(axis == 0, axis == 1, axis == 2), normal = v3_scale(n, i % 2 ? -1 : 1);
        dem_wall_def *wall = model_plane(m, v3_scale(normal, -half), normal);
        wall->material = 1;
        wall->servo = servo(normal, 2e3 * (axis + 1), 0.05);
        wall->servo.stress = true;
        for (uint32_t k = 0; k < 2; k++) {
            uint32_t other = 2 * ((axis + 1 + k) % 3);
            wall->servo.extent[k] = (dem_servo_extent){0, {other, other + 1}};
        }
        wall->servo.partner = ((uint32_t)i ^ 1) + 1;
    }
    m->scene.damping.viscous = 20;
    m->scene.time.step = 4e-5;
    const dem_measure_def whole = {.name = "all", .region = DEM_REGION_WHOLE};
    m->scene.measures = &whole;
    m->scene.measure_count = 1;
    dem_trial_start(t);
    dem_trial_step(t, 100000);
    dem_trial_figures(t);
    dem_trial_figures(t);
    // the region is the box about all grains, which is larger than that of the walls by overlaps
    size_t count = 0, walls = 0;
    const dem_measure_view *v = t->world ? dem_world_measures(t->world, &count) : NULL;
    const dem_wall_view *wall = t->world ? dem_world_walls(t->world, &walls) : NULL;
    double scale = v ? v->volume : NAN;
    for (int k = 0; k < 3 && wall; k++)
        scale /= 2 * half + v3_get(wall[2 * k + 1].position, k) - v3_get(wall[2 * k].position, k);
    const double stress[3] = {v ? v->stress.xx : NAN, v ? v->stress.yy : NAN, v ? v->stress.zz : NAN};
    // servos keep 0.5 %, at rest better
    for (int k = 0; k < 3; k++)
        dem_expect(t, scale * stress[k], 2e3 * (k + 1), 1e-3 * 2e3 * (k + 1), "Pa", "stress along %c", "xyz"[k]);
    dem_expect(t, scale * (v ? v->mean_stress : NAN), 4e3, 4, "Pa", "mean stress");
    dem_expect_least(t, scale * (v ? v->deviatoric_stress : NAN), 2e3 * sqrt(3) * 0.999, "Pa", "deviatoric stress");
}

// volume that one impact takes off, by its angle from the surface: K = 2, psi = 2, corrected for roughness
static void finnie(dem_trial *t)
{
    static const double table[][2] = {{10, 0.0314448843}, {30, 0.03125}, {60, 0.0104166667}};  // angle, Q p / (m V^2)
    const double speed = 2, pressure = 1e9, mass = 2500 * 4 * DEM_PI / 3 * RADIUS * RADIUS * RADIUS;
    for (size_t i = 0; i < sizeof table / sizeof *table; i++) {
        double angle = table[i][0] * DEM_PI / 180;
        model *m = dem_trial_model(t);
        model_body(m, model_sphere(m, RADIUS), v3(0, 0, 1.05 * RADIUS))->velocity =
            v3(speed * cos(angle), 0, -speed * sin(angle));
        m->walls[0] = (dem_wall_def){.kind = DEM_WALL_RECTANGLE,
                                     .normal = {0, 0, 1},
                                     .along = {1, 0, 0},
                                     .size = {2, 2},
                                     .wear = {DEM_WEAR_FINNIE,
                                              .constant = 2,
                                              .pressure = pressure,
                                              .psi = 2,
                                              .roughness = 0.5}};
        m->scene.wall_count = 1;
        m->scene.time.step = 1e-6;
        dem_trial_start(t);
        dem_trial_step(t, 20000);
        dem_expect(t, dem_trial_wall(t, 0).worn * pressure / (mass * speed * speed), table[i][1], 1e-9, "",
                   "volume p / (m V^2) at %g degrees", table[i][0]);
    }
}

const dem_case dem_verify_walls[] = {
    {"servo-press", "a servo wall presses a ball", "springs in series", false, press},
    {"servo-triaxial", "grains between servo walls have their stresses", "sum of F l / V", false, triaxial},
    {"wear-finnie", "one impact wears a wall", "Finnie 1960, the table of the reference", false, finnie},
    {0},
};
