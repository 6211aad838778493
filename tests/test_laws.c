// The laws of contacts, one contact at a time: the plain kernel is handed positions and velocities.
#include "bench_contact.h"
#include "sim/restitution.h"

static const double EXACT = 1e-13;  // a dozen roundings of quantities of one size

// overlaps are differences of positions: their rounding by the overlap
static double rounding(double size, double overlap)
{
    return EXACT + 4e-16 * size / overlap;
}

// ---- normal forces

static void a_linear_spring_pushes_in_proportion(void **state)
{
    (void)state;
    bench b = bench_spheres(model_new(), 0.01, 0.02, 1e-4);
    for (double d = 1e-9; d < 1e-2; d *= 3) {
        set_pair(&b, 0.01, 0.02, d, v3(0.3, 1, 2));  // speeds do not matter
        bench_step(&b, 1e-5);
        wrench left = bench_wrench(&b, 0), right = bench_wrench(&b, 1);
        check_close(left.force.x, -1e4 * d, rounding(0.03, d));
        check_vec(right.force, v3_scale(left.force, -1), 0);
        check_vec(left.moment, v3(0, 0, 0), 1e-18);
    }
    set_pair(&b, 0.01, 0.02, -1e-12, v3(0, 0, 0));
    check_vec(bench_force(&b, 0, 1e-5), v3(0, 0, 0), 0);
    bench_close(&b);
}

static void a_stiffness_from_young_is_that_of_two_bars(void **state)
{
    (void)state;
    for (int wall = 0; wall < 2; wall++) {
        model *m = model_new();
        m->materials[1] = (dem_material){"soft", 1000, 1e8, 0.4};
        m->scene.material_count = 2;
        m->scene.law_count = 3;
        for (uint32_t i = 0; i < 3; i++) {
            m->laws[i] = dem_pair_law_defaults();
            m->laws[i].materials[0] = i / 2;
            m->laws[i].materials[1] = (i + 1) / 2;
        }
        double d = 1e-4, both = 2 / (1 / 1e9 + 1 / 1e8);
        if (!wall) {
            bench b = bench_spheres(m, 0.01, 0.02, d);
            check_close(bench_force(&b, 1, 0).x, DEM_PI * both * 0.01 * 0.01 / 0.03 * d, rounding(0.03, d));
            bench_close(&b);
            continue;
        }
        // against a wall the length is that of the sphere alone
        model_body(m, model_sphere(m, 0.01), v3(0, 0, 0.01 - d));
        model_plane(m, v3(0, 0, 0), v3(0, 0, 1))->material = 1;
        bench b = bench_open(m);
        check_close(bench_force(&b, 0, 0).z, DEM_PI * both * 0.01 * d, rounding(0.01, d));
        bench_close(&b);
    }
}

static double hertz_modulus(void)
{
    return 1 / ((1 - 0.25 * 0.25) / 1e9 + (1 - 0.4 * 0.4) / 3e7);
}

static void hertz_pushes_with_the_power_of_three_halves(void **state)
{
    (void)state;
    bench b = bench_spheres(hertz_model(), 0.01, 0.02, 1e-4);
    double reduced = 0.01 * 0.02 / 0.03;
    for (double d = 1e-9; d < 1e-2; d *= 3) {
        set_pair(&b, 0.01, 0.02, d, v3(0, 0, 0));
        check_close(bench_force(&b, 1, 0).x, 4.0 / 3 * hertz_modulus() * sqrt(reduced) * pow(d, 1.5),
                    2 * rounding(0.03, d));
    }
    bench_close(&b);
    model *m = hertz_model();
    model_body(m, model_sphere(m, 0.01), v3(0, 0, 0.0099));
    model_plane(m, v3(0, 0, 0), v3(0, 0, 1))->material = 1;
    b = bench_open(m);
    check_close(bench_force(&b, 0, 0).z, 4.0 / 3 * hertz_modulus() * sqrt(0.01) * pow(1e-4, 1.5), 1e-10);
    bench_close(&b);
}

// ---- dashpots

static double sphere_mass(double r)
{
    return 2500 * 4 * DEM_PI / 3 * r * r * r;
}

static double pair_mass(double a, double b)
{
    return 1 / (1 / sphere_mass(a) + 1 / sphere_mass(b));
}

static void a_rate_damps_with_the_mass_of_the_pair(void **state)
{
    (void)state;
    for (int local = 0; local < 2; local++) {
        model *m = model_new();
        m->laws[0].damping = DEM_DAMPING_RATE;
        m->laws[0].damping_rate = 700;
        m->laws[0].tail = DEM_TAIL_TENSION;
        m->laws[0].effective_mass = local ? DEM_MASS_LOCAL : DEM_MASS_BODY;  // for spheres the same
        bench b = bench_spheres(m, 0.01, 0.02, 1e-4);
        for (double v = -2; v <= 2; v += 0.7) {
            set_pair(&b, 0.01, 0.02, 1e-4, v3(v, 3, 0));  // v > 0: they part
            check_near(bench_force(&b, 1, 0).x, 1 - 700 * pair_mass(0.01, 0.02) * v, 1e-11);
        }
        bench_close(&b);
    }
}

// a dumbbell whose end is hit across its axis by a sphere of mass m: 1/m_loc = 1/m + 1/M + d^2/I
static void the_local_mass_is_that_of_the_surfaces_at_the_contact(void **state)
{
    (void)state;
    for (int local = 0; local < 2; local++) {
        model *m = model_new();
        m->laws[0].damping = DEM_DAMPING_RATE;
        m->laws[0].damping_rate = 700;
        m->laws[0].tail = DEM_TAIL_TENSION;
        m->laws[0].effective_mass = local ? DEM_MASS_LOCAL : DEM_MASS_BODY;
        uint32_t dumbbell = model_dumbbell(m, 0.01, 0.03), sphere = model_sphere(m, 0.005);
        model_body(m, dumbbell, v3(0, 0, 0));
        model_body(m, sphere, v3(0.015, 0, 0.0149));
        bench b = bench_open(m);
        bench_put(&b, 0, v3(0, 0, 0), v3(0, 0, 0), v3(0, 0, 0));
        bench_put(&b, 1, v3(0.015, 0, 0.0149), v3(0, 0, -1), v3(0, 0, 0));
        double ball = sphere_mass(0.01), i = 2 * 0.4 * ball * 1e-4 + 2 * ball * 0.015 * 0.015;
        double inverse = 1 / sphere_mass(0.005) + 1 / (2 * ball) + (local ? 0.015 * 0.015 / i : 0);
        check_close(bench_force(&b, 1, 0).z, 1 + 700 / inverse, 1e-11);
        bench_close(&b);
    }
}

static void a_restitution_sets_the_damping_ratio_of_either_law(void **state)
{
    (void)state;
    for (int hertz = 0; hertz < 2; hertz++)
        for (int cut = 0; cut < 2; cut++) {
            model *m = model_new();
            dem_pair_law *law = &m->laws[0];
            law->damping = DEM_DAMPING_RESTITUTION;
            law->restitution = 0.4;
            law->tail = cut ? DEM_TAIL_CUT : DEM_TAIL_TENSION;
            law->normal = hertz ? DEM_NORMAL_HERTZ : DEM_NORMAL_LINEAR;
            bench b = bench_spheres(m, 0.01, 0.02, 1e-4);
            double zeta = cut ? dem_damping_ratio_cut(0.4) : dem_damping_ratio(0.4), d = 1e-4;
            double modulus = 1e9 / 2 / (1 - 0.25 * 0.25), a = sqrt(0.01 * 0.02 / 0.03 * d);
            double k = hertz ? 2 * modulus * a : 1e4, spring = hertz ? k * d * 2 / 3 : 1;
            double c = 2 * zeta * sqrt(k * pair_mass(0.01, 0.02)) * (hertz ? sqrt(5.0 / 6) : 1);
            for (double v = -2; v < 3; v += 0.5) {
                set_pair(&b, 0.01, 0.02, d, v3(v, 0, 0));
                double want = spring - c * v;
                check_near(bench_force(&b, 1, 0).x, cut ? fmax(want, 0) : want, 1e-10 * (spring + c));
            }
            // where nothing touches nothing pulls
            set_pair(&b, 0.01, 0.02, -1e-9, v3(-5, 0, 0));
            check_vec(bench_force(&b, 1, 0), v3(0, 0, 0), 0);
            bench_close(&b);
        }
}

// ---- friction

static model *friction_model(double coefficient)
{
    model *m = model_new();
    m->laws[0].friction = DEM_FRICTION_LINEAR;
    m->laws[0].friction_coefficient = coefficient;
    m->laws[0].stiffness_ratio = 0.4;
    return m;
}

static void the_spring_of_friction_is_the_way_slipped(void **state)
{
    (void)state;
    for (int given = 0; given < 2; given++) {
        model *m = friction_model(100);
        if (given)
            m->laws[0].tangential_stiffness = 7e3;
        double kt = given ? 7e3 : 4e3;
        bench b = bench_spheres(m, 0.01, 0.02, 1e-4);
        dem_vec3 slip = v3(0, 0, 0);
        for (int i = 0; i < 50; i++) {
            dem_vec3 v = v3(0, sin(i), cos(2 * i));
            set_pair(&b, 0.01, 0.02, 1e-4, v);
            bench_step(&b, 1e-6);
            slip = v3_along(slip, 1e-6, v);
            wrench left = bench_wrench(&b, 0), right = bench_wrench(&b, 1);
            check_vec(bench_spring(&b), slip, 1e-19);
            check_vec(left.force, v3(-1, kt * slip.y, kt * slip.z), 1e-11);
            // at the middle of the overlap, for both
            double x = 0.01 - 0.5e-4;
            check_vec(left.moment, v3_cross(v3(x, 0, 0), left.force), 1e-16);
            check_vec(right.moment, v3_cross(v3(x - 0.03 + 1e-4, 0, 0), right.force), 1e-16);
        }
        // parting forgets the spring
        set_pair(&b, 0.01, 0.02, -1e-9, v3(0, 0, 0));
        bench_step(&b, 1e-6);
        check_vec(bench_spring(&b), v3(0, 0, 0), 0);
        bench_close(&b);
    }
}

static void friction_never_exceeds_the_cap_and_keeps_the_capped_spring(void **state)
{
    (void)state;
    bench b = bench_spheres(friction_model(0.3), 0.01, 0.02, 1e-4);
    dem_random r = random_stream(1, 1);
    double cap = 0.3, kt = 4e3;  // 1 N of normal force
    for (int i = 0; i < 1000; i++) {
        dem_vec3 before = bench_spring(&b), v = v3(0, random_normal(&r), random_normal(&r));
        set_pair(&b, 0.01, 0.02, 1e-4, v);
        bench_step(&b, 4e-5);
        dem_vec3 f = bench_wrench(&b, 0).force, free = v3_along(before, 4e-5, v);
        f.x = 0;
        double size = kt * v3_norm(free);
        check_vec(f, v3_scale(free, size > cap ? cap / v3_norm(free) : kt), 1e-12);
        check(v3_norm(f) <= cap * (1 + 1e-12));
        check_vec(v3_scale(bench_spring(&b), kt), f, 1e-12);
    }
    bench_close(&b);
}

// the dashpot's force is capped together with the spring's
static void tangential_dashpots_are_capped_with_the_spring(void **state)
{
    (void)state;
    for (int rate = 0; rate < 2; rate++) {
        model *m = friction_model(0.3);
        dem_pair_law *law = &m->laws[0];
        law->tail = DEM_TAIL_TENSION;
        law->damping = rate ? DEM_DAMPING_RATE : DEM_DAMPING_RESTITUTION;
        law->damping_rate = 500;
        law->restitution = 0.5;
        if (rate)
            law->tangential_rate = 300;
        bench b = bench_spheres(m, 0.01, 0.02, 1e-4);
        double kt = 4e3, mass = pair_mass(0.01, 0.02);
        double c = rate ? 300 * mass : 2 * dem_damping_ratio(0.5) * sqrt(kt * mass);
        dem_random r = random_stream(1, 2);
        int slid = 0;
        for (int i = 0; i < 1000; i++) {
            dem_vec3 before = bench_spring(&b), v = v3(0, 0.2 * random_normal(&r), 0.2 * random_normal(&r));
            set_pair(&b, 0.01, 0.02, 1e-4, v);
            bench_step(&b, 4e-5);
            dem_vec3 spring = v3_scale(v3_along(before, 4e-5, v), kt), f = v3_along(spring, c, v);
            if (v3_norm(f) > 0.3) {
                slid++;
                f = v3_scale(f, 0.3 / v3_norm(f));
                // a rate's spring takes what the dashpot leaves, a restitution's stays as it is; above the cap both
                // become the capped force
                spring = rate ? v3_along(f, -c, v) : spring;
                if (v3_norm(spring) > 0.3)
                    spring = f;
            }
            dem_vec3 got = bench_wrench(&b, 0).force;
            check_vec(v3(0, got.y, got.z), f, 1e-12);
            check_vec(v3_scale(bench_spring(&b), kt), spring, 1e-12);
        }
        check(slid > 50 && slid < 950);
        bench_close(&b);
    }
}

// no tangential rate was asked for: a rate damps along the normal alone
static void a_rate_without_a_tangential_one_leaves_the_slip_alone(void **state)
{
    (void)state;
    model *m = friction_model(0.3);
    m->laws[0].damping = DEM_DAMPING_RATE;
    m->laws[0].damping_rate = 500;
    bench b = bench_spheres(m, 0.01, 0.02, 1e-4);
    check(!b.w->features.slide_damping);
    set_pair(&b, 0.01, 0.02, 1e-4, v3(0, 1, 0));
    check_close(bench_force(&b, 0, 1e-6).y, 4e3 * 1e-6, 1e-12);
    bench_close(&b);
}

// ---- the spring turns with the contact

// the pair is turned as one rigid body: in its own frame the force stays
static void the_spring_follows_the_pair_wherever_it_turns(void **state)
{
    (void)state;
    bench b = bench_spheres(friction_model(100), 0.01, 0.02, 1e-4);
    set_pair(&b, 0.01, 0.02, 1e-4, v3(0, 2, 1));
    bench_step(&b, 1e-3);
    dem_vec3 spin = v3(30, -70, 45), start = bench_spring(&b), f0 = bench_wrench(&b, 0).force;
    double h = 1e-5, angle = 0;
    int steps = 2000;
    for (int i = 1; i <= steps; i++) {
        // positions now, velocities half a step before
        dem_vec3 axis = v3_unit(spin);
        double turned = i * h * v3_norm(spin), between = turned - h * v3_norm(spin) / 2;
        dem_vec3 e = v3_scale(axis, sin(turned / 2)), g = v3_scale(axis, sin(between / 2));
        dem_vec3 arm = v3(0.0299, 0, 0), x = quat_rotate((dem_quat){cos(turned / 2), e.x, e.y, e.z}, arm);
        dem_vec3 v = v3_cross(spin, quat_rotate((dem_quat){cos(between / 2), g.x, g.y, g.z}, arm));
        bench_put(&b, 0, v3(0, 0, 0), v3(0, 0, 0), spin);
        bench_put(&b, 1, x, v, spin);
        bench_step(&b, h);
        angle = turned;
    }
    dem_vec3 e = v3_scale(v3_unit(spin), sin(angle / 2));
    dem_quat q = {cos(angle / 2), e.x, e.y, e.z};
    // the arms are taken at the end of the step, the velocity in its middle: a slip of the second order a step adds up
    // to one of the first, 2000 * 0.03 (spin h)^2 / 2
    double tolerance = steps * 0.03 * h * h * v3_norm2(spin);
    check(tolerance < 0.03 * v3_norm(start));
    check_vec(bench_spring(&b), quat_rotate(q, start), tolerance);
    check_vec(bench_wrench(&b, 0).force, quat_rotate(q, f0), 4e3 * tolerance);
    bench_close(&b);
}

// the part along the new normal is lost, the length is not
static void the_spring_keeps_its_length_however_far_the_normal_turns(void **state)
{
    (void)state;
    bench b = bench_spheres(friction_model(100), 0.01, 0.02, 1e-4);
    set_pair(&b, 0.01, 0.02, 1e-4, v3(0, 2, 1));
    bench_step(&b, 1e-4);
    dem_vec3 start = bench_spring(&b), n = v3(cos(0.5), sin(0.5), 0);
    bench_put(&b, 1, v3_scale(n, 0.0299), v3(0, 0, 0), v3(0, 0, 0));
    bench_step(&b, 0);
    dem_vec3 across = v3_along(start, -v3_dot(start, n), n);
    check_vec(bench_spring(&b), v3_scale(v3_unit(across), v3_norm(start)), 1e-18);
    bench_close(&b);
}

// spins about the normal turn the spring by their mean
static void the_spring_twists_with_the_mean_spin_about_the_normal(void **state)
{
    (void)state;
    static const double spins[][2] = {{40, 40}, {80, 0}, {0, 80}, {60, -60}};
    for (int k = 0; k < 4; k++) {
        bench b = bench_spheres(friction_model(100), 0.01, 0.02, 1e-4);
        set_pair(&b, 0.01, 0.02, 1e-4, v3(0, 2, 1));
        bench_step(&b, 1e-5);
        dem_vec3 start = bench_spring(&b);
        double mean = (spins[k][0] + spins[k][1]) / 2, h = 1e-5;
        int steps = 5000;
        for (int i = 0; i < steps; i++) {
            bench_put(&b, 0, v3(0, 0, 0), v3(0, 0, 0), v3(spins[k][0], 0, 0));
            bench_put(&b, 1, v3(0.0299, 0, 0), v3(0, 0, 0), v3(spins[k][1], 0, 0));
            bench_step(&b, h);
        }
        double angle = mean * h * steps, s = sin(angle / 2);
        // a turn to the first order lengthens by (mean h)^2 / 2 a step
        check_vec(bench_spring(&b), quat_rotate((dem_quat){cos(angle / 2), s, 0, 0}, start),
                  v3_norm(start) * (1e-13 * steps + steps * mean * mean * h * h));
        bench_close(&b);
    }
}

// ---- Mindlin

// Cattaneo & Mindlin: the slope at first, 8 G* a, and the cap; in between their partial slip is softer
static void mindlin_has_the_slope_and_the_limit_of_partial_slip(void **state)
{
    (void)state;
    model *m = hertz_model();
    for (int i = 0; i < 3; i++) {
        m->laws[i].friction = DEM_FRICTION_MINDLIN;
        m->laws[i].friction_coefficient = 0.25;
    }
    bench b = bench_spheres(m, 0.01, 0.02, 1e-5);
    double ga = 1e9 / 2 / 1.25, gb = 3e7 / 2 / 1.4, shear = 1 / ((2 - 0.25) / ga + (2 - 0.4) / gb), d = 1e-5;
    double a = sqrt(0.01 * 0.02 / 0.03 * d), normal = 4.0 / 3 * hertz_modulus() * a * d, cap = 0.25 * normal;
    double most = 3 * cap / (16 * shear * a), s = 0;
    check_close(most, 0.25 * d * hertz_modulus() / (4 * shear), 1e-13);
    for (int i = 0; i < 300; i++) {
        set_pair(&b, 0.01, 0.02, d, v3(0, 1, 0));
        double step = i == 0 ? 1e-6 * most : most / 200, f = bench_force(&b, 0, step).y;
        s += step;
        double partial = s < most ? cap * (1 - pow(1 - s / most, 1.5)) : cap;
        check_close(f, fmin(8 * shear * a * s, cap), 1e-10);
        if (i == 0)
            check_close(f, partial, 1e-6);
        check(f >= partial * (1 - 1e-10));  // never slips before the whole contact does
        // the two are farthest apart where ours reaches the cap, at 2/3 of the way: by (1/3)^1.5
        check(f - partial <= cap * (pow(1.0 / 3, 1.5) + 1e-6));
    }
    bench_close(&b);
}

// Loaded, sheared, unloaded at that displacement and sheared back: nothing may come out of it.
static void the_unloading_correction_creates_no_energy(void **state)
{
    (void)state;
    for (int rescale = 0; rescale < 2; rescale++) {
        model *m = hertz_model();
        for (int i = 0; i < 3; i++) {
            m->laws[i].friction = DEM_FRICTION_MINDLIN;
            m->laws[i].friction_coefficient = 1e6;
            m->laws[i].rescale = rescale;
        }
        bench b = bench_spheres(m, 0.01, 0.02, 1e-5);
        double low = 1e-5, high = 4e-5, s = 1e-6, work = 0;
        double ga = 1e9 / 2 / 1.25, gb = 3e7 / 2 / 1.4, shear = 1 / ((2 - 0.25) / ga + (2 - 0.4) / gb);
        double soft = 8 * shear * sqrt(0.01 * 0.02 / 0.03 * low), stiff = 2 * soft;
        bench_put(&b, 0, v3(0, 0, 0), v3(0, 0, 0), v3(0, 0, 0));
        bench_put(&b, 1, v3(0.03 - low, 0, 0), v3(0, 0, 0), v3(0, 0, 0));
        bench_step(&b, 0);
        work += leg(&b, low, high, 0, 0, 2000);
        work += leg(&b, high, high, 0, s, 2000);
        double force = bench_wrench(&b, 0).force.y;
        check_close(force, stiff * s, 1e-9);
        work += leg(&b, high, low, s, s, 2000);
        // first order in the change of a step
        check_close(bench_wrench(&b, 0).force.y, rescale ? soft * s : stiff * s, 2e-3);
        work += leg(&b, low, low, s, 0, 2000);
        // per cycle: what went in at the stiff contact less what came back at the soft one
        double want = rescale ? (stiff - soft) * s * s / 2 : -(stiff - soft) * s * s / 2;
        check_close(work, want, 1e-2);
        check(rescale ? work > 0 : work < 0);
        // again and again: the springs do not wander off
        for (int i = 0; i < 5; i++) {
            double again = leg(&b, low, high, 0, 0, 500) + leg(&b, high, high, 0, s, 500);
            again += leg(&b, high, low, s, s, 500) + leg(&b, low, low, s, 0, 500);
            check(rescale ? again >= 0 : again <= 0);
        }
        bench_close(&b);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_linear_spring_pushes_in_proportion),
        cmocka_unit_test(a_stiffness_from_young_is_that_of_two_bars),
        cmocka_unit_test(hertz_pushes_with_the_power_of_three_halves),
        cmocka_unit_test(a_rate_damps_with_the_mass_of_the_pair),
        cmocka_unit_test(the_local_mass_is_that_of_the_surfaces_at_the_contact),
        cmocka_unit_test(a_restitution_sets_the_damping_ratio_of_either_law),
        cmocka_unit_test(the_spring_of_friction_is_the_way_slipped),
        cmocka_unit_test(friction_never_exceeds_the_cap_and_keeps_the_capped_spring),
        cmocka_unit_test(tangential_dashpots_are_capped_with_the_spring),
        cmocka_unit_test(a_rate_without_a_tangential_one_leaves_the_slip_alone),
        cmocka_unit_test(the_spring_follows_the_pair_wherever_it_turns),
        cmocka_unit_test(the_spring_keeps_its_length_however_far_the_normal_turns),
        cmocka_unit_test(the_spring_twists_with_the_mean_spin_about_the_normal),
        cmocka_unit_test(mindlin_has_the_slope_and_the_limit_of_partial_slip),
        cmocka_unit_test(the_unloading_correction_creates_no_energy),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
