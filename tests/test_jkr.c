// Adhesion of soft spheres: against the landmarks of Johnson, Kendall & Roberts, the curve between them, the work of a
// cycle, and what becomes of spheres that meet.
#include "bench_contact.h"
#include "same_bits.h"

static const double W = 0.05, R = 1e-4, MODULUS = 1e7;  // w [J/m^2], R* [m], E* [Pa]

// half of it: the spheres of two give R*
static model *soft_model(double density)
{
    model *m = model_new();
    m->materials[0] = (dem_material){"soft", density, 2 * MODULUS * (1 - 0.3 * 0.3), 0.3};
    m->laws[0] = dem_pair_law_defaults();
    m->laws[0].normal = DEM_NORMAL_JKR;
    m->laws[0].work_of_adhesion = W;
    return m;
}

static double pull_off(void)
{
    return 1.5 * DEM_PI * W * R;
}
static double parting(void)
{
    return -0.75 * cbrt(DEM_PI * DEM_PI * W * W * R / (MODULUS * MODULUS));
}
// a [m] -> overlap and force
static double overlap_of(double a)
{
    return a * a / R - sqrt(2 * DEM_PI * W * a / MODULUS);
}
static double force_of(double a)
{
    return 4 * MODULUS * a * a * a / (3 * R) - sqrt(8 * DEM_PI * W * MODULUS * a * a * a);
}

static double force_at(bench *b, double overlap)
{
    set_pair(b, 2 * R, 2 * R, overlap, v3(0, 0, 0));
    return bench_force(b, 1, 1e-9).x;
}

static void the_force_follows_the_curve_down_to_where_the_surfaces_part(void **state)
{
    (void)state;
    bench b = bench_spheres(soft_model(2500), 2 * R, 2 * R, 1e-8);
    double first = cbrt(DEM_PI * W * R * R / (8 * MODULUS));  // where they part
    check_close(overlap_of(first), parting(), 1e-12);
    for (double a = 4e-5; a > 1.0005 * first; a *= 0.99)
        check_near(force_at(&b, overlap_of(a)), force_of(a), 1e-7 * pull_off());
    check_close(force_of(first), -5.0 / 9 * pull_off(), 1e-12);
    // the least force under a weight, and the force of the first touch
    double least = cbrt(9 * DEM_PI * W * R * R / (8 * MODULUS)), touch = cbrt(2 * DEM_PI * W * R * R / MODULUS);
    force_at(&b, 1e-7);
    check_close(force_at(&b, overlap_of(least)), -pull_off(), 1e-9);
    check_near(force_at(&b, 0), -8.0 / 9 * pull_off(), 1e-9 * pull_off());
    check_close(force_of(touch), -8.0 / 9 * pull_off(), 1e-12);
    check_near(force_at(&b, 2.6450487e-7), 0, 1e-6 * pull_off());  // refdata
    bench_close(&b);
}

static void surfaces_hold_on_only_after_they_have_touched(void **state)
{
    (void)state;
    bench b = bench_spheres(soft_model(2500), 2 * R, 2 * R, -0.5 * -parting());
    check(force_at(&b, 0.5 * parting()) == 0 && force_at(&b, -1e-12) == 0);
    check(force_at(&b, 1e-12) < -0.88 * pull_off());
    check(force_at(&b, 0.999 * parting()) < -0.55 * pull_off());
    check(force_at(&b, 1.001 * parting()) == 0);
    check(force_at(&b, 0.5 * parting()) == 0);
    bench_close(&b);
}

// without adhesion it is Hertz
static void without_adhesion_the_law_is_that_of_hertz(void **state)
{
    (void)state;
    model *m = soft_model(2500);
    m->laws[0].work_of_adhesion = 0;
    bench b = bench_spheres(m, 2 * R, 2 * R, 1e-8);
    for (double d = 1e-9; d < 1e-5; d *= 3)
        check_close(force_at(&b, d), 4.0 / 3 * MODULUS * sqrt(R) * pow(d, 1.5), 1e-9 + 1e-15 * R / d);
    check(force_at(&b, -1e-12) == 0);
    bench_close(&b);
}

static void friction_holds_by_the_force_and_twice_the_pull_off(void **state)
{
    (void)state;
    model *m = soft_model(2500);
    m->laws[0].friction = DEM_FRICTION_MINDLIN;
    m->laws[0].friction_coefficient = 0.3;
    bench b = bench_spheres(m, 2 * R, 2 * R, 1e-8);
    for (int i = 0; i < 2; i++) {
        set_pair(&b, 2 * R, 2 * R, 1e-8, v3(0, 1, 0));
        bench_step(&b, 1e-3);
    }
    wrench on = bench_wrench(&b, 0);
    check(on.force.x > 0);  // it pulls
    check_close(on.force.y, 0.3 * (2 * pull_off() - on.force.x), 1e-9);
    bench_close(&b);
}

// two spheres that come together: slower than this they stick
static double sticking_speed(double mass)
{
    return sqrt(2 * 7.09219597 * cbrt(pow(W, 5) * pow(R, 4) / (MODULUS * MODULUS)) / (mass / 2));
}

static void slow_spheres_stick_and_fast_ones_lose_the_work_of_the_cycle(void **state)
{
    (void)state;
    double mass = 2500 * 4 * DEM_PI / 3 * 8 * R * R * R, critical = sticking_speed(mass);
    for (int fast = 0; fast < 2; fast++) {
        double v = critical * (fast ? 1.5 : 0.9);
        model *m = soft_model(2500);
        uint32_t ball = model_sphere(m, 2 * R);
        m->scene.time.step = 2e-8;
        model_body(m, ball, v3(0, 0, 0))->velocity = v3(v / 2, 0, 0);
        model_body(m, ball, v3(4 * R + 1e-8, 0, 0))->velocity = v3(-v / 2, 0, 0);
        dem_world *w = model_world(m, 1);
        double worst = 0;
        for (int i = 0; i < 300; i++) {
            run_steps(w, 40);
            worst = largest(worst, measured(w)->energy.error);
        }
        check(worst < 0.02);  // forces jump where surfaces meet and part: of the first order
        double apart = velocity_before(w, 1).x - velocity_before(w, 0).x;
        if (fast)
            check_close(apart, sqrt(v * v - critical * critical), 0.01);
        else
            check(dem_world_figures(w)->contacts == 1);
        dem_world_destroy(w);
        model_free(m);
    }
}

static void a_sphere_hangs_from_a_ceiling_of_any_kind(void **state)
{
    (void)state;
    // light enough for 3/2 pi w R*, R* = 2 R
    for (int mesh = 0; mesh < DEM_EMBREE + 1; mesh++) {
        model *m = soft_model(2500);
        model_body(m, model_sphere(m, 2 * R), v3(0, 0, -2 * R + 1e-9));
        dem_wall_def *wall = model_plane(m, v3(0, 0, 0), v3(0, 0, -1));
        if (mesh) {
            wall->kind = DEM_WALL_MESH;
            wall->mesh = (dem_mesh){.vertices = calloc(3, sizeof(dem_vec3)),
                                    .triangles = calloc(3, sizeof(uint32_t)),
                                    .vertex_count = 3,
                                    .triangle_count = 1};
            memcpy(wall->mesh.vertices, (dem_vec3[]){{-0.1, -0.1, 0}, {0, 0.2, 0}, {0.1, -0.1, 0}},
                   3 * sizeof(dem_vec3));
            memcpy(wall->mesh.triangles, (uint32_t[]){0, 1, 2}, 3 * sizeof(uint32_t));
        }
        m->laws[0].damping = DEM_DAMPING_RATE;
        m->laws[0].damping_rate = 2e4;
        m->scene.gravity = v3(0, 0, -9.81);
        m->scene.time.step = 1e-7;
        dem_world *w = model_world(m, 1);
        run_steps(w, 20000);
        double d = 2 * R + position_now(w, 0).z, weight = 2500 * 4 * DEM_PI / 3 * 8 * R * R * R * 9.81;
        // the force at d, by bisection for a
        double low = 1e-6, high = 1e-4, reduced = 2 * R;
        for (int i = 0; i < 100; i++) {
            double a = (low + high) / 2;
            *(a * a / reduced - sqrt(2 * DEM_PI * W * a / MODULUS) < d ? &low : &high) = a;
        }
        double f = 4 * MODULUS * pow(low, 3) / (3 * reduced) - sqrt(8 * DEM_PI * W * MODULUS * pow(low, 3));
        check_close(f, -weight, 1e-4);
        check(measured(w)->wall_contacts == 1);
        dem_world_destroy(w);
        model_free(m);
    }
}

static model *sticky_gas(void)
{
    model *m = soft_model(2500);
    m->laws[0].damping = DEM_DAMPING_RESTITUTION;
    m->laws[0].restitution = 0.5;
    m->laws[0].friction = DEM_FRICTION_MINDLIN;
    m->laws[0].friction_coefficient = 0.3;
    m->laws[0].rolling = DEM_ROLLING_EPSD;
    m->laws[0].rolling_coefficient = 0.1;
    m->laws[0].twisting = DEM_TWISTING_MARSHALL;
    m->scene.time.step = 4e-6;
    model_sphere(m, 2 * R);
    model_dumbbell(m, 1.5 * R, 2 * R);
    model_lattice(m, 600, 4.8 * R, 0.1, 1);
    return m;
}

static void it_sticks(dem_world *w)
{
    check(dem_world_figures(w)->contacts > 100);
    check(fabs(dem_world_figures(w)->energy.error) < 0.1);  // ten steps a contact; and it is a number
}

static void clusters_are_the_same_bits_everywhere(void **state)
{
    (void)state;
    check_same_bits(sticky_gas, 500, it_sticks);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_force_follows_the_curve_down_to_where_the_surfaces_part),
        cmocka_unit_test(surfaces_hold_on_only_after_they_have_touched),
        cmocka_unit_test(without_adhesion_the_law_is_that_of_hertz),
        cmocka_unit_test(friction_holds_by_the_force_and_twice_the_pull_off),
        cmocka_unit_test(slow_spheres_stick_and_fast_ones_lose_the_work_of_the_cycle),
        cmocka_unit_test(a_sphere_hangs_from_a_ceiling_of_any_kind),
        cmocka_unit_test(clusters_are_the_same_bits_everywhere),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
