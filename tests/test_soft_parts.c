// Soft contacts of concave grains: convex parts that bear side by side.
#include "soft_cases.h"
#include "walls.h"

static const double K = 1e5, OVERLAP = 0.005;  // grains are of about 1 m

static model *soft_grain_model(void)
{
    model *m = soft_model(0.0012);
    m->laws[0].stiffness = K;
    return m;
}

// ---- grains

enum { MANY = 500 };

// a ring of `n` balls, of the size given across their centres
static uint32_t ring(model *m, size_t n, double size)
{
    dem_ball balls[MANY];
    double across = 0.5 * size, tube = 0.125 * size;
    for (size_t i = 0; i < n; i++) {
        double a = 2 * DEM_PI * (double)i / (double)n;
        balls[i] = (dem_ball){v3(across * cos(a), across * sin(a), 0), tube};
    }
    double mass = 2500 * 2 * DEM_PI * DEM_PI * across * tube * tube, r2 = across * across, t2 = tube * tube;
    double flat = mass * (r2 + 0.75 * t2), other = mass * (0.5 * r2 + 0.625 * t2);
    return model_clump(m, balls, n, mass, (double[]){other, other, flat});
}

static const double LOBE = 0.3, APART = 0.7;
static uint32_t dumbbell(model *m)
{
    return model_dumbbell(m, LOBE, APART);
}

// a box lined by n x n balls on each face, hollow
static uint32_t hollow_box(model *m, size_t n)
{
    dem_ball balls[MANY];
    size_t count = 0;
    for (size_t i = 0; i < n * n * n; i++) {
        size_t at[3] = {i % n, i / n % n, i / n / n};
        bool outer = false;
        for (int k = 0; k < 3; k++)
            outer |= at[k] == 0 || at[k] == n - 1;
        double step = 0.8 / (double)(n - 1);
        if (outer)
            balls[count++] =
                (dem_ball){v3((double)at[0] * step - 0.4, (double)at[1] * step - 0.4, (double)at[2] * step - 0.4), 0.1};
    }
    return model_clump(m, balls, count, 2500, (double[]){417, 417, 417});
}

static int parts_of(uint32_t (*grain)(model *, size_t), size_t n)
{
    model *m = soft_grain_model();
    model_body(m, grain(m, n), v3(0, 0, 0));
    dem_world *w = model_world(m, 1);
    int parts = w->soft.parts ? w->soft.parts[0] : 1;
    dem_world_destroy(w);
    model_free(m);
    return parts;
}

static uint32_t unit_ring(model *m, size_t n)
{
    return ring(m, n, 1.2);
}

static uint32_t some_dumbbell(model *m, size_t n)
{
    return n ? dumbbell(m) : 0;
}

static void only_concave_grains_are_cut(void **state)
{
    (void)state;
    for (size_t n = 10; n <= 160; n *= 4)
        check(parts_of(model_ellipsoid, n) == 1);
    check(parts_of(hollow_box, 4) == 1 && parts_of(hollow_box, 8) == 1);
    check(parts_of(some_dumbbell, 2) == 2);
    for (size_t n = 24; n <= 384; n *= 2)
        check(abs(parts_of(unit_ring, n) - 6) <= 1);
}

// ---- stiffness

static double lying_stiffness(model *m, double height)
{
    model_plane(m, v3(0, 0, 0), v3(0, 0, 1));
    dem_world *w = model_world(m, 1);
    double force[2];
    for (int k = 0; k < 2; k++) {
        soft_place(w, 0, v3(0, 0, height - OVERLAP * (1 + 0.02 * (k - 0.5))), m->bodies[0].orientation);
        soft_placed(w);
        force[k] = dem_world_bodies(w).force[0].z;
    }
    dem_world_destroy(w);
    return (force[1] - force[0]) / (0.02 * OVERLAP * K);
}

// 1/K summed over six parts at distances of 0.57 to 1.15 m is 3.06, as the prototype had it
static void a_ring_that_lies_flat_has_one_stiffness(void **state)
{
    (void)state;
    for (size_t n = 25; n <= 400; n *= 2) {
        model *m = soft_grain_model();
        model_body(m, ring(m, n, 1.2), v3(0, 0, 0));
        check_near(lying_stiffness(m, 0.15), 3.06, 0.06);
        model_free(m);
    }
}

// of a pair of lobes K = [1 q; q 1]: both bear 2 / (1 + q), and rock as k d^2 / 2 / (1 - q)
static void a_dumbbell_lies_on_both_lobes(void **state)
{
    (void)state;
    model *m = soft_grain_model();
    model_body(m, dumbbell(m), v3(0, 0, 0));
    dem_world *w = model_world(m, 1);
    double q = w->soft.couplings[0].near[0][1], size = w->templates.items[0].equivalent_diameter;
    dem_world_destroy(w);
    check_near(q, exp(-APART / (0.6 * size)), 1e-12);
    check_near(lying_stiffness(m, LOBE), 2 / (1 + q), 1e-6);
    w = model_world(m, 1);
    double moment[2];
    for (int k = 0; k < 2; k++) {
        soft_place(w, 0, v3(0, 0, LOBE - OVERLAP), quat_about(v3(0, 2e-4 * (k - 0.5), 0)));
        soft_placed(w);
        moment[k] = dem_world_bodies(w).moment[0].y;
    }
    // less what the weight's arm takes, of the order of the overlap
    check_close((moment[0] - moment[1]) / 2e-4, K * APART * APART / 2 / (1 - q), 0.02);
    // one lobe alone is one contact
    soft_place(w, 0, v3(0, 0, 0), quat_about(v3(0, 0.5, 0)));
    soft_place(w, 0, v3(0, 0, soft_support(w, 0, v3(0, 0, -1)) - OVERLAP), quat_about(v3(0, 0.5, 0)));
    soft_placed(w);
    check_near(dem_world_bodies(w).force[0].z, K * OVERLAP, 1e-3 * K * OVERLAP);
    dem_world_destroy(w);
    model_free(m);
}

// ---- a potential

// leads a grain up and down, and tilts it, on a plane; by trapezoids of a thousandth of the path
static void forces_have_a_potential(void **state)
{
    (void)state;
    enum { STEPS = 1000 };
    for (int i = 0; i < 4; i++) {
        model *m = soft_grain_model();
        if (i >= 2) {
            m->laws[0].normal = DEM_NORMAL_HERTZ;
            m->materials[0].young = 1e7;
        }
        model_body(m, i % 2 ? dumbbell(m) : ring(m, 60, 1.2), v3(0, 0, 0));
        model_plane(m, v3(0, 0, 0), v3(0, 0, 1));
        dem_world *w = model_world(m, 1);
        double height = i % 2 ? LOBE : 0.15, work = 0, first = 0, worst = 0, most = 0;
        dem_vec3 force = v3(0, 0, 0), moment = force;
        double last_z = 0;
        dem_quat last = {1, 0, 0, 0};
        for (int k = 0; k <= STEPS; k++) {
            double a = 2 * DEM_PI * k / STEPS, z = height - OVERLAP * (0.6 - 0.5 * cos(a));
            dem_quat q = quat_about(v3(0.004 * sin(2 * a), 0.009 * sin(a), 0));
            soft_place(w, 0, v3(0, 0, z), q);
            soft_placed(w);
            dem_vec3 f = dem_world_bodies(w).force[0], t = dem_world_bodies(w).moment[0];
            dem_quat d = quat_multiply(q, quat_conjugate(last));
            double energy = measured(w)->energy.elastic;
            if (k == 0)
                first = energy;
            else
                work += 0.5 * (f.z + force.z) * (z - last_z) +
                        v3_dot(v3_add(t, moment), v3_scale(v3(d.x, d.y, d.z), d.w < 0 ? -1 : 1));
            most = largest(most, energy);
            worst = largest(worst, work + energy - first);
            force = f;
            moment = t;
            last = q;
            last_z = z;
        }
        check(worst < 1e-3 * most && most > 0.1 * K * OVERLAP * OVERLAP * (i < 2));
        dem_world_destroy(w);
        model_free(m);
    }
}

// ---- whole scenes, of grains of about a centimetre

static model *shaken(size_t count)
{
    model *m = soft_lossy_model();
    m->laws[0].stiffness = K;
    ring(m, 30, 0.01);
    model_cloud(m, 40, 0.01, 2);
    model_dumbbell(m, 0.003, 0.0065);
    const double cell = 0.0135;
    model_lattice(m, count, cell, 1.0, 3);
    double edge = cell * ceil(cbrt((double)count) - 1e-9);
    model_box(m, v3(0, 0, 0), v3(edge, edge, edge));
    m->scene.gravity = v3(0, 0, -9.81);
    m->scene.time.step = 8e-6;
    return m;
}

static void has_parts_and_rubs(dem_world *w)
{
    check(w->soft.parts[0] > 4 && w->soft.parts[1] == 1 && w->soft.parts[2] == 2);
    check(measured(w)->energy.friction > 0 && measured(w)->largest_soft_overlap > 0);
}

static void bits_do_not_depend_on_threads_or_instructions(void **state)
{
    (void)state;
    model *m = shaken(700);
    check_soft_bits(m, 2000, has_parts_and_rubs);
    model_free(m);
}

static void a_run_goes_on_bit_for_bit(void **state)
{
    (void)state;
    model *m = shaken(100);
    m->scene.time.step = 0;
    dem_world_destroy(check_soft_resumed(m));
    model_free(m);
}

static void the_ledger_closes(void **state)
{
    (void)state;
    for (int i = 0; i < 2; i++) {
        model *m = shaken(64);
        m->scene.time.step = 4e-6;
        if (i == 1) {
            m->laws[0].normal = DEM_NORMAL_HERTZ;
            m->laws[0].friction = DEM_FRICTION_MINDLIN;
            m->materials[0].young = 1e7;
        }
        dem_world *w = model_world(m, 1);
        double worst = 0;
        for (int k = 0; k < 10; k++) {
            run_steps(w, 500);
            worst = largest(worst, measured(w)->energy.error);
        }
        check(measured(w)->energy.friction > 0.05 * measured(w)->energy.start);
        // as of convex grains; of second order
        check_near(worst, 0, 3e-3);
        dem_world_destroy(w);
        model_free(m);
    }
}

// by stability alone, few steps are taken in a contact
static void automatic_steps_keep_the_energy(void **state)
{
    (void)state;
    for (int i = 0; i < 2; i++) {
        model *m = shaken(64);
        m->laws[0].damping = DEM_DAMPING_NONE;
        m->laws[0].friction = DEM_FRICTION_NONE;
        m->scene.time.step = 0;
        m->scene.time.contact_steps = i == 0 ? 10 : 0;
        dem_world *w = model_world(m, 1);
        run_steps(w, 4000);
        check(fabs(measured(w)->energy.error) < (i == 0 ? 0.01 : 0.15));
        check(measured(w)->largest_overlap_ratio > 0.1);
        dem_world_destroy(w);
        model_free(m);
    }
}

static void drop(bool mesh, dem_vec3 out[3])
{
    model *m = shaken(0);
    m->scene.wall_count = 0;
    m->laws[0].stiffness = 100;
    m->scene.time.step = 4e-5;
    dem_body_def *b = model_body(m, ring(m, 40, 0.01), v3(0.001, 0.0007, 0.0025));
    b->velocity = v3(0.1, 0.1, -0.3);
    b->spin = v3(10, 20, -5);
    if (mesh) {
        dem_mesh sheet = wall_quad(v3(-0.1, -0.1, 0), v3(0.1, -0.1, 0), v3(0.1, 0.1, 0), v3(-0.1, 0.1, 0));
        m->walls[0] = (dem_wall_def){.name = "sheet", .kind = DEM_WALL_MESH, .mesh = sheet};
        m->scene.wall_count = 1;
    } else
        model_plane(m, v3(0, 0, 0), v3(0, 0, 1));
    dem_world *w = model_world(m, 1);
    size_t touched = 0;
    for (int i = 0; i < 100; i++) {
        run_steps(w, 60);
        touched = measured(w)->wall_contacts > touched ? measured(w)->wall_contacts : touched;
    }
    check(touched >= 3);
    out[0] = dem_world_bodies(w).position[0];
    out[1] = dem_world_bodies(w).velocity[0];
    out[2] = dem_world_bodies(w).spin[0];
    check(fabs(measured(w)->energy.error) < 3e-3);
    dem_world_destroy(w);
    model_free(m);
}

static void meshes_are_as_the_planes_they_stand_for(void **state)
{
    (void)state;
#if !DEM_EMBREE
    skip();
#endif
    dem_vec3 plane[3], mesh[3];
    drop(false, plane);
    drop(true, mesh);
    for (int i = 0; i < 3; i++)
        check_vec(mesh[i], plane[i], i == 2 ? 1e-5 : 1e-8);
}

static void explain_tells_the_parts(void **state)
{
    (void)state;
    model *m = shaken(8);
    dem_world *w = model_world(m, 1);
    char *text;
    dem_error error;
    check_ok(dem_world_explain(w, &text, &error), error);
    check(strstr(text, "is concave: 2 convex parts") && !strstr(text, ": 1 convex part"));
    free(text);
    dem_world_destroy(w);
    model_free(m);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(only_concave_grains_are_cut),
        cmocka_unit_test(a_ring_that_lies_flat_has_one_stiffness),
        cmocka_unit_test(a_dumbbell_lies_on_both_lobes),
        cmocka_unit_test(forces_have_a_potential),
        cmocka_unit_test(bits_do_not_depend_on_threads_or_instructions),
        cmocka_unit_test(a_run_goes_on_bit_for_bit),
        cmocka_unit_test(the_ledger_closes),
        cmocka_unit_test(automatic_steps_keep_the_energy),
        cmocka_unit_test(meshes_are_as_the_planes_they_stand_for),
        cmocka_unit_test(explain_tells_the_parts),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
