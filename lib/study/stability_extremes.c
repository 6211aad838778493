// Bodies that are far from spheres, spin fast, weigh much, or are made of a thousand spheres. PHYSICS 2.2, 2.3, 6.4.
#include <math.h>
#include <stdio.h>

#include "study/stability.h"

static const double RADIUS = 0.01;

static double quaternion_off(const dem_motion *b)
{
    dem_quat q = b->orientation;
    return fabs(sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z) - 1);
}

// ---- free rotors

typedef struct rotor {
    const char *name;
    double inertia[3];
    dem_vec3 spin;  // in the body
    double step;
    double energy;  // may be off by this
} rotor;

// 20000 steps; angular momentum and energy of rotation, relative
static void turn(dem_trial *t, const rotor *r)
{
    model *m = dem_trial_model(t);
    m->scene.time.step = r->step;
    model_body(m, model_clump(m, (dem_ball[]){{{0, 0, 0}, 1e-3}}, 1, 1, r->inertia), v3(0, 0, 0))->spin = r->spin;
    dem_trial_start(t);
    double first = dem_trial_figures(t)->energy.rotational, off = 0, turned = 0, norm = 0;
    dem_vec3 momentum = v3(r->inertia[0] * r->spin.x, r->inertia[1] * r->spin.y, r->inertia[2] * r->spin.z);
    for (int i = 0; i < 200 && dem_trial_step(t, 100); i++) {
        dem_motion b = dem_trial_body(t, 0);
        dem_vec3 own = dem_motion_own_spin(&b);
        dem_vec3 now =
            quat_rotate(b.orientation, v3(r->inertia[0] * own.x, r->inertia[1] * own.y, r->inertia[2] * own.z));
        off = fmax(off, fabs(dem_trial_figures(t)->energy.rotational / first - 1));
        turned = fmax(turned, v3_distance(now, momentum) / v3_norm(momentum));
        norm = fmax(norm, quaternion_off(&b));
    }
    off = t->status == DEM_OK ? off : NAN;
    dem_expect_most(t, norm, 1e-13, "", "%s: norm of the quaternion, off by", r->name);
    dem_expect_most(t, turned, 1e-12, "", "%s: angular momentum in space, off by", r->name);
    dem_expect_most(t, off, r->energy, "", "%s: energy, off by", r->name);
}

// 20000 steps of |w| h = 0.3 and 3, the last in ten parts each; bounded and of order 2: a tenth of (w h)^2 in a part
static void inertia(dem_trial *t)
{
    static const rotor rotors[] = {
        {"needle, w h = 0.3", {1e-4, 1, 1.00005}, {200, 1, 0.5}, 1.5e-3, 1e-2},
        {"needle across, w h = 0.3", {1e-4, 1, 1.00005}, {0.1, 1, 0.5}, 0.27, 1e-2},
        {"plate, w h = 0.3", {1, 1.05, 1.95}, {0.3, 0.5, 0.8}, 0.3, 1e-2},
        {"plate, w h = 3", {1, 1.05, 1.95}, {0.3, 0.5, 0.8}, 3, 1e-2},
        {"needle, w h = 3", {1e-4, 1, 1.00005}, {200, 1, 0.5}, 1.5e-2, 1e-2},
        {"top, w h = 3", {1, 2, 3}, {0.01, 1, 0.01}, 3, 1e-2},
    };
    for (size_t i = 0; i < sizeof rotors / sizeof *rotors; i++)
        turn(t, &rotors[i]);
}

// ---- 1e5 rad/s of bodies of 1 mm

static void spin_free(dem_trial *t)
{
    double unit = 1e-6;  // kg m^2 of the mass of 1 kg
    static const double speed = 1e5;
    const rotor rotors[] = {
        {"sphere", {unit, unit, unit}, {0.6 * speed, 0, 0.8 * speed}, 1e-5, 1e-12},
        {"axisymmetric", {0.5 * unit, unit, unit}, {0.6 * speed, 0, 0.8 * speed}, 1e-5, 1e-12},
        {"three moments", {unit, 2 * unit, 3 * unit}, {0.1 * speed, 0.99 * speed, 0.1 * speed}, 1e-5, 1e-2},
    };
    for (size_t i = 0; i < sizeof rotors / sizeof *rotors; i++)
        turn(t, &rotors[i]);
}

// its surface passes a plane at 100 m/s
static void spin_landing(dem_trial *t)
{
    const double r = 1e-3, speed = 1e5;
    for (int clump = 0; clump < 2; clump++) {
        const char *name = clump ? "clump" : "sphere";
        model *m = dem_trial_model(t);
        m->scene.gravity = v3(0, 0, -9.81);
        m->scene.time.step = 0;
        m->laws[0].stiffness = 1e4;
        m->laws[0].damping = DEM_DAMPING_RESTITUTION;
        m->laws[0].restitution = 0.3;
        m->laws[0].friction = DEM_FRICTION_LINEAR;
        m->laws[0].friction_coefficient = 0.5;
        model_plane(m, v3(0, 0, 0), v3(0, 0, 1));
        uint32_t shape = clump ? model_dumbbell(m, r, 0.5 * r) : model_sphere(m, r);
        // a dumbbell turns about its long axis
        dem_body_def *b = model_body(m, shape, v3(0, 0, 1.001 * r));
        b->spin = clump ? v3(speed, 0, 0) : v3(0, speed, 0);
        dem_trial_start(t);
        dem_trial_step(t, 60000);
        dem_motion end = dem_trial_body(t, 0);
        dem_expect(t, isfinite(v3_norm(end.velocity)) && isfinite(v3_norm(end.spin)), 1, 0, "", "%s: finite", name);
        dem_expect_most(t, quaternion_off(&end), 1e-12, "", "%s: norm of the quaternion, off by", name);
        dem_expect_most(t, fabs(dem_trial_figures(t)->energy.error), 1e-2, "", "%s: energy off by", name);
        dem_expect_most(t, dem_trial_figures(t)->largest_overlap_ratio, 0.1, "", "%s: largest overlap over radius",
                        name);
        // 0.5 g t of speed, far from the 100 m/s of the surface
        double v = 0.5 * 9.81 * dem_trial_time(t);
        if (!clump)
            dem_expect(t, end.velocity.x / v, 1, 0.02, "", "sphere: speed over mu g t, it still slides");
    }
}

// ---- weight

static void gravity(dem_trial *t)
{
    static const double factors[] = {1, 1000};
    for (size_t i = 0; i < 2; i++) {
        model *m = dem_trial_model(t);
        double g = 9.81 * factors[i];
        m->scene.gravity = v3(0, 0, -g);
        m->scene.time.step = 0;
        // so that 4 layers overlap alike
        m->laws[0].stiffness = 4e4 * factors[i];
        m->laws[0].damping = DEM_DAMPING_RESTITUTION;
        m->laws[0].restitution = 0.3;
        m->laws[0].friction = DEM_FRICTION_LINEAR;
        m->laws[0].friction_coefficient = 0.4;
        model_dumbbell(m, RADIUS, 0.8 * RADIUS);
        model_sphere(m, RADIUS);
        model_box(m, v3(0, 0, 0), v3(0.14, 0.14, 0.6));
        model_lattice(m, 64, 0.035, 0, 3);
        dem_trial_start(t);
        dem_trial_step(t, 60000);
        const dem_figures *f = dem_trial_figures(t);
        double weight = 0, borne = 0;
        for (size_t k = 0; k < 6; k++)
            borne -= dem_trial_wall(t, k).force.z;
        dem_body_view v = t->status == DEM_OK ? dem_world_bodies(t->world) : (dem_body_view){0};
        for (size_t k = 0; k < v.count; k++)
            weight += v.mass[k] * g;
        dem_expect(t, borne / weight, 1, 1e-3, "", "g x %g: walls bear, of the weight", factors[i]);
        dem_expect_most(t, f->fastest / sqrt(g * RADIUS), 1e-3, "", "g x %g: fastest over sqrt(g r)", factors[i]);
        dem_expect_most(t, fabs(f->energy.error), 1e-2, "", "g x %g: energy off by", factors[i]);
        dem_expect_most(t, f->largest_overlap_ratio, 0.05, "", "g x %g: largest overlap over radius", factors[i]);
    }
}

// ---- one and a thousand spheres

// an ellipsoid thrown at a plane without weight
static void thousand(dem_trial *t)
{
    static const size_t counts[] = {1, 10, 100, 1000};
    dem_trial_plot(t, (dem_plot_axis){.title = "spheres of the clump", .log = true},
                   (dem_plot_axis){.title = "energy off by, of 10 steps in a contact", .log = true});
    for (size_t i = 0; i < 4; i++) {
        model *m = dem_trial_model(t);
        dem_random r = random_stream(1, i);
        m->scene.time.step = 0;
        m->laws[0].stiffness = 1e8;
        m->laws[0].friction = DEM_FRICTION_LINEAR;
        m->laws[0].friction_coefficient = 0.3;
        uint32_t shape = counts[i] == 1 ? model_sphere(m, 0.5) : model_ellipsoid(m, counts[i]);
        model_box(m, v3(-1, -1, -1), v3(1, 1, 1));
        dem_body_def *b = model_body(m, shape, v3(0, 0, 0));
        b->velocity = random_in(&r, v3(-9, -9, -9), v3(9, 9, 9));
        b->spin = random_in(&r, v3(-9, -9, -9), v3(9, 9, 9));
        dem_trial_start(t);
        dem_trial_step(t, 3000);
        const dem_figures *f = dem_trial_figures(t);
        dem_trial_point(t, "in a box", (double)counts[i], fabs(f->energy.error));
        dem_expect_most(t, fabs(f->energy.error), 1e-2, "", "%zu spheres: energy off by", counts[i]);
        dem_expect_most(t, (f->energy.kinetic + f->energy.rotational) / f->energy.start, 1.01, "",
                        "%zu spheres: energy of motion over that at first", counts[i]);
    }
}

const dem_case dem_stability_extremes[] = {
    {"extreme-inertia", "needles and plates, moments up to 1 : 10000", "PHYSICS 2.3: conserved quantities", false,
     inertia},
    {"extreme-spin", "1e5 rad/s, free", "PHYSICS 6.4: conserved quantities", false, spin_free},
    {"extreme-landing", "1e5 rad/s, on a rough plane", "energy; mu g t", false, spin_landing},
    {"extreme-gravity", "a heap under 1000 times its weight", "weight; energy", true, gravity},
    {"extreme-spheres", "clumps of 1 to 1000 spheres thrown about in a box", "energy", false, thousand},
    {0},
};
