// Soft contacts: what a pair of clumps does must not depend on how many spheres describe them.
#include "soft_cases.h"

static const double K = 1e5, OVERLAP = 0.005;  // grains are of about 1 m

static model *soft_grain_model(void)
{
    model *m = soft_model(0.0012);
    m->laws[0].stiffness = K;
    return m;
}

static void damp(dem_pair_law *law, double restitution, double friction)
{
    law->damping = DEM_DAMPING_RESTITUTION;
    law->restitution = restitution;
    if (friction > 0) {
        law->friction = DEM_FRICTION_LINEAR;
        law->friction_coefficient = friction;
    }
}

// ---- one sphere

// moments against turning, by `which`: none, and each of the laws
enum { TURNINGS = 6 };
static void resist(dem_pair_law *law, int which)
{
    static const dem_rolling_law rolling[TURNINGS] = {DEM_ROLLING_NONE, DEM_ROLLING_EPSD, DEM_ROLLING_CONSTANT,
                                                      DEM_ROLLING_BOUNDED, DEM_ROLLING_NONE, DEM_ROLLING_EPSD};
    static const dem_twisting_law twisting[TURNINGS] = {DEM_TWISTING_NONE, DEM_TWISTING_NONE, DEM_TWISTING_CONSTANT,
                                                        DEM_TWISTING_NONE, DEM_TWISTING_MARSHALL,
                                                        DEM_TWISTING_MARSHALL};
    law->rolling = rolling[which];
    law->rolling_coefficient = 0.1;
    law->rolling_damping = 0.3;
    law->twisting = twisting[which];
    law->twisting_coefficient = 0.05;
}

static void run_spheres(dem_multiple multiple, dem_normal_law normal, int turning, dem_vec3 out[8], double *error)
{
    model *m = soft_grain_model();
    m->scene.multiple = multiple;
    damp(&m->laws[0], 0.5, 0.5);
    m->laws[0].normal = normal;
    resist(&m->laws[0], turning);
    if (normal == DEM_NORMAL_HERTZ) {
        m->laws[0].friction = DEM_FRICTION_MINDLIN;
        m->materials[0].young = 1e7;
    }
    m->scene.gravity = v3(0, 0, -9.81);
    m->scene.time.step = 2e-4;
    m->scene.output.energy = true;
    uint32_t shape = model_sphere(m, 0.5);
    dem_body_def *first = model_body(m, shape, v3(0, 0, 0.501));
    first->velocity = v3(0.3, 0, -0.5);
    first->spin = v3(1, 4, 2);
    model_body(m, shape, v3(0.15, 0.1, 1.5))->velocity = v3(0, 0, -0.8);
    model_plane(m, v3(0, 0, 0), v3(0, 0, 1));
    dem_world *w = model_world(m, 1);
    // constant moments tremble at rest, by the last bit
    run_steps(w, turning == 2 ? 1200 : 5000);
    *error = measured(w)->energy.error;
    dem_body_view v = dem_world_bodies(w);
    for (int i = 0; i < 2; i++) {
        out[4 * i] = v.position[i];
        out[4 * i + 1] = v.velocity[i];
        out[4 * i + 2] = v.spin[i];
        out[4 * i + 3] = v.force[i];
    }
    dem_world_destroy(w);
    model_free(m);
}

// the soft maximum of one overlap is that overlap; what is left is rounding over 5000 steps
static void single_spheres_are_as_with_the_sum(void **state)
{
    (void)state;
    for (int k = 0; k < 2 * TURNINGS; k++) {
        dem_normal_law normal = k % 2 ? DEM_NORMAL_HERTZ : DEM_NORMAL_LINEAR;
        dem_vec3 soft[8], sum[8];
        double error_soft, error_sum;
        // patches remember the stiffness of a step ago, where single contacts reckon it from the overlap's speed
        bool marshall = k / 2 >= 4;
        run_spheres(DEM_MULTIPLE_SOFT, normal, k / 2, soft, &error_soft);
        run_spheres(DEM_MULTIPLE_SUM, normal, k / 2, sum, &error_sum);
        for (int i = 0; i < 8; i++)
            check_vec(soft[i], sum[i], i % 4 == 3 ? (marshall ? 0.1 : 1e-6) : marshall ? 2e-4 : 1e-9);
        check_near(error_soft, error_sum, marshall ? 1e-4 : 1e-9);
        check(fabs(error_sum) < 1e-2 && v3_norm(sum[3]) > 1);
    }
}

// ---- stiffness and restitution by the number of spheres

typedef struct stiffness {
    double tangent, secant;  // over that of one contact
} stiffness;

static stiffness stiffness_of(dem_multiple multiple, size_t spheres, bool twin)
{
    model *m = soft_grain_model();
    m->scene.multiple = multiple;
    uint32_t shape = model_ellipsoid(m, spheres);
    for (int i = 0; i < 1 + twin; i++)
        model_body(m, shape, v3(10 * i, 0, 10));
    if (!twin)
        model_plane(m, v3(0, 0, 0), v3(0, 0, 1));
    dem_world *w = model_world(m, 1);
    dem_random r = random_stream(1, 1);
    stiffness mean = {0, 0};
    enum { TURNS = 6 };
    for (int i = 0; i < TURNS; i++) {
        dem_quat q[2] = {random_quat(&r), random_quat(&r)};
        dem_vec3 n = v3(0, 0, 1);
        double x = twin ? soft_twin_place(w, q[0], q[1], OVERLAP, &n) : 0, force[2];
        for (int k = 0; k < 2; k++) {
            double more = 0.02 * OVERLAP * (k - 0.5);
            if (twin)
                soft_place(w, 1, v3_along(v3(x, 0, 0), -more, n), q[1]);
            else {
                soft_place(w, 0, v3(0, 0, 0), q[0]);
                soft_place(w, 0, v3(0, 0, soft_support(w, 0, v3(0, 0, -1)) - OVERLAP - more), q[0]);
            }
            soft_placed(w);
            force[k] = v3_dot(dem_world_bodies(w).force[twin], n);
        }
        mean.tangent += (force[1] - force[0]) / (0.02 * OVERLAP * K) / TURNS;
        mean.secant += (force[0] + force[1]) / (2 * OVERLAP * K) / TURNS;
    }
    dem_world_destroy(w);
    model_free(m);
    return mean;
}

static void stiffness_does_not_depend_on_the_number_of_spheres(void **state)
{
    (void)state;
    static const size_t counts[] = {10, 50, 200, 1000};
    for (int twin = 0; twin < 2; twin++)
        for (int i = 0; i < (twin ? 3 : 4); i++) {
            stiffness s = stiffness_of(DEM_MULTIPLE_SOFT, counts[i], twin);
            check_near(s.tangent, 1, 0.05);
            // the surface of the soft maximum lies within a part of tau = .24 of the overlap from that of the spheres
            check_near(s.secant, 1, 0.12);
        }
    // what it is without
    check(stiffness_of(DEM_MULTIPLE_SUM, 1000, false).tangent > 10);
}

// at which the surfaces move apart where they touch
static double parting(dem_body_view v, const dem_contact *c)
{
    dem_vec3 speed = v3(0, 0, 0);
    for (int k = 0; k < (c->other == UINT32_MAX ? 1 : 2); k++) {
        size_t i = k == 0 ? c->body : c->other;
        dem_vec3 own = v3_add(v.velocity[i], v3_cross(v.spin[i], v3_sub(c->point, v.position[i])));
        speed = v3_along(speed, k == 0 ? -1 : 1, own);
    }
    return v3_dot(speed, c->normal);
}

// ... at the end of a contact over that of meeting at its start, of two grains, or of a grain and a wall
static double one_bounce(dem_world *w, bool twin, dem_random *r)
{
    dem_quat q[2] = {random_quat(r), random_quat(r)};
    dem_vec3 normal = v3(0, 0, -1);
    double mass = dem_world_bodies(w).mass[0] / (1 + twin), speed = OVERLAP * sqrt(K / mass);
    if (twin) {
        soft_throw(w, 1, v3(0, 0, 0));
        soft_twin_place(w, q[0], q[1], -1e-6, &normal);
    } else {
        soft_place(w, 0, v3(0, 0, 0), q[0]);
        soft_place(w, 0, v3(0, 0, soft_support(w, 0, normal) + 1e-6), q[0]);
    }
    soft_throw(w, 0, v3_scale(normal, speed));
    soft_placed(w);
    bool touched = false;
    double before = 0, after = 0;
    for (int step = 0; step < 900; step++) {
        run_steps(w, 1);
        measured(w);
        size_t count;
        const dem_contact *c = dem_world_contacts(w, &count);
        if (count) {
            after = parting(dem_world_bodies(w), c);
            before = touched ? before : -after;
        } else if (touched)
            break;
        touched |= count > 0;
    }
    check(touched);
    return after / before;
}

// mean over some impacts at random attitudes
static double restitution_of(dem_multiple multiple, size_t n, bool twin, int impacts)
{
    model *m = soft_grain_model();
    m->scene.multiple = multiple;
    damp(&m->laws[0], 0.8, 0);
    uint32_t shape = model_ellipsoid(m, n);
    for (int i = 0; i < 1 + twin; i++)
        model_body(m, shape, v3(10 * i, 0, 10));
    if (!twin)
        model_plane(m, v3(0, 0, 0), v3(0, 0, 1));
    m->scene.time.step = DEM_PI * sqrt(1300 / K) / 300;
    dem_world *w = model_world(m, 1);
    dem_random r = random_stream(n, 2);
    double mean = 0;
    for (int i = 0; i < impacts; i++)
        mean += one_bounce(w, twin, &r) / impacts;
    dem_world_destroy(w);
    model_free(m);
    return mean;
}

static void restitution_is_as_asked_at_every_number_of_spheres(void **state)
{
    (void)state;
    static const size_t counts[] = {10, 50, 200, 1000};
    for (int twin = 0; twin < 2; twin++)
        for (int i = 0; i < (twin ? 3 : 4); i++)
            check_near(restitution_of(DEM_MULTIPLE_SOFT, counts[i], twin, 24), 0.8, 0.016);
    check(restitution_of(DEM_MULTIPLE_SUM, 1000, false, 2) < 0.72);
}

// ---- Hertz

static void hertz_has_the_radius_of_the_grain(void **state)
{
    (void)state;
    for (int i = 0; i < 2; i++) {
        model *m = soft_grain_model();
        m->laws[0].normal = DEM_NORMAL_HERTZ;
        m->materials[0].young = 1e8;
        model_body(m, model_ellipsoid(m, i == 0 ? 10 : 200), v3(0, 0, 0))->orientation = (dem_quat){0.9, 0.3, -0.2, 0.1};
        model_plane(m, v3(0, 0, 0), v3(0, 0, 1));
        dem_world *w = model_world(m, 1);
        soft_place(w, 0, v3(0, 0, soft_support(w, 0, v3(0, 0, -1)) - OVERLAP), m->bodies[0].orientation);
        soft_placed(w);
        size_t count;
        const dem_contact *c = dem_world_contacts(w, &count);
        double radius = cbrt(0.63 * 0.5 * 0.397), modulus = 1e8 / (2 * (1 - 0.25 * 0.25));
        check(count == 1);
        check_near(c[0].overlap, OVERLAP, 0.12 * OVERLAP);
        // the shares of the spheres add up to 1 but for those that are hardly seen
        check_close(c[0].normal_force, 4.0 / 3 * modulus * sqrt(radius) * pow(c[0].overlap, 1.5), 1e-3);
        dem_world_destroy(w);
        model_free(m);
    }
}

// ---- paths

static path_figures closed_path(dem_multiple multiple, size_t n, uint64_t seed)
{
    enum { STEPS = 1200 };
    model *m = soft_grain_model();
    m->scene.multiple = multiple;
    uint32_t shape = model_ellipsoid(m, n);
    model_body(m, shape, v3(0, 0, 0));
    model_body(m, shape, v3(10, 0, 0));
    dem_world *w = model_world(m, 1);
    dem_random r = random_stream(seed, 3);
    dem_quat q[2] = {random_quat(&r), random_quat(&r)};
    path_figures p = soft_closed_path(w, q[0], q[1], OVERLAP, STEPS);
    dem_world_destroy(w);
    model_free(m);
    return p;
}

// the step of the trapezoids is 1/600 of the path, whose forces have bends
static void a_closed_path_takes_no_work_and_forces_do_not_jump(void **state)
{
    (void)state;
    for (uint64_t seed = 1; seed <= 3; seed++) {
        path_figures p = closed_path(DEM_MULTIPLE_SOFT, 200, seed);
        check(p.stored > 0.5 * 0.5 * K * OVERLAP * OVERLAP);
        check(fabs(p.work) < 1e-3 * p.stored);
        check(p.jump < 0.02 * p.force);
    }
    // what the path shows of the mean of all
    path_figures mean = closed_path(DEM_MULTIPLE_MEAN, 200, 1);
    check(fabs(mean.work) > 1e-2 * mean.stored || mean.jump > 0.05 * mean.force);
}

// ---- duplicates

static void run_with_copies(size_t copies, dem_vec3 out[4])
{
    model *m = soft_grain_model();
    damp(&m->laws[0], 0.6, 0.4);
    uint32_t shape = model_ellipsoid(m, 60);
    dem_clump_def def = dem_clump_view(m->clumps[shape]);
    dem_ball balls[120];
    memcpy(balls, def.balls, 60 * sizeof *balls);
    for (size_t i = 0; i < copies; i++)
        balls[60 + i] = balls[(7 * i) % 60];
    shape = model_clump(m, balls, 60 + copies, def.mass, def.inertia);
    m->scene.gravity = v3(0, 0, -9.81);
    m->scene.time.step = 1e-4;
    model_plane(m, v3(0, 0, 0), v3(0, 0, 1));
    model_body(m, shape, v3(0, 0, 0.6))->velocity = v3(0.2, 0, -1);
    model_body(m, shape, v3(0.1, 0, 1.7))->orientation = (dem_quat){0.7, 0.5, 0.5, 0.1};
    dem_world *w = model_world(m, 1);
    run_steps(w, 4000);
    measured(w);
    for (int i = 0; i < 2; i++) {
        out[2 * i] = dem_world_bodies(w).velocity[i];
        out[2 * i + 1] = dem_world_bodies(w).spin[i];
    }
    dem_world_destroy(w);
    model_free(m);
}

static void copies_of_spheres_change_nothing(void **state)
{
    (void)state;
    dem_vec3 plain[4], doubled[4];
    run_with_copies(0, plain);
    run_with_copies(25, doubled);
    for (int i = 0; i < 4; i++)
        check_vec(doubled[i], plain[i], 1e-9);
    check(v3_norm(plain[1]) > 0.01);
}

// ---- flat faces

// a cube whose faces are of n x n balls; their centres span `SPAN`
static const double SPAN = 0.8;
static uint32_t cube(model *m, int n)
{
    dem_ball *balls = calloc((size_t)(n * n * n), sizeof *balls);
    check(balls);
    size_t count = 0;
    for (int x = 0; x < n; x++)
        for (int y = 0; y < n; y++)
            for (int z = 0; z < n; z++) {
                bool inside = x > 0 && x < n - 1 && y > 0 && y < n - 1 && z > 0 && z < n - 1;
                if (!inside)
                    balls[count++] = (dem_ball){
                        v3_scale(v3(x / (n - 1.0) - 0.5, y / (n - 1.0) - 0.5, z / (n - 1.0) - 0.5), SPAN), 0.1};
            }
    uint32_t shape = model_clump(m, balls, count, 2500, (double[]){2500.0 / 6, 2500.0 / 6, 2500.0 / 6});
    free(balls);
    return shape;
}

// under a load of K OVERLAP, with D = 1.6 tau, that is (D / tau) times the spread of the face's points; k L^2 / 12 is
// that of an even face
static void a_cube_keeps_its_rocking_stiffness(void **state)
{
    (void)state;
    for (int n = 3; n <= 9; n += 2) {
        model *m = soft_grain_model();
        m->scene.soft.tau = OVERLAP / 1.6;
        model_body(m, cube(m, n), v3(0, 0, 0));
        model_plane(m, v3(0, 0, 0), v3(0, 0, 1));
        dem_world *w = model_world(m, 1);
        double low = 0.45, high = 0.6;
        for (int i = 0; i < 40; i++) {
            double z = 0.5 * (low + high);
            soft_place(w, 0, v3(0, 0, z), (dem_quat){1, 0, 0, 0});
            soft_placed(w);
            *(dem_world_bodies(w).force[0].z > K * OVERLAP ? &low : &high) = z;
        }
        double moment[2];
        for (int k = 0; k < 2; k++) {
            soft_place(w, 0, v3(0, 0, low), quat_about(v3(0, 2e-4 * (k - 0.5), 0)));
            soft_placed(w);
            moment[k] = dem_world_bodies(w).moment[0].y;
        }
        // about the lower face's middle, which moves aside under the load
        double rocking = (moment[0] - moment[1]) / 2e-4 / (K * SPAN * SPAN / 12);
        check(rocking > 1 && rocking < 3.5);
        dem_world_destroy(w);
        model_free(m);
    }
}

static void a_cube_rests_flat_and_does_not_creep(void **state)
{
    (void)state;
    model *m = soft_grain_model();
    damp(&m->laws[0], 0.3, 0.3);
    double sink = 2500 * 9.81 / 1e6;
    m->laws[0].stiffness = 1e6;
    m->scene.soft.tau = sink / 1.6;
    m->scene.gravity = v3(9.81 * sin(0.2), 0, -9.81 * cos(0.2));  // within the cone of friction, tan(.29) = .3
    m->scene.time.step = 5e-4;
    dem_body_def *b = model_body(m, cube(m, 5), v3(0, 0, 0.5 - 0.5 * sink));
    b->spin = v3(0.002, 0.003, 0.001);
    model_plane(m, v3(0, 0, 0), v3(0, 0, 1));
    dem_world *w = model_world(m, 1);
    run_steps(w, 60000);
    dem_vec3 x = position_now(w, 0);
    dem_quat q = orientation_now(w, 0);
    run_steps(w, 60000);
    check_vec(position_now(w, 0), x, 1e-12);
    check(angle_between(orientation_now(w, 0), q) < 1e-11);
    check(v3_norm(velocity_before(w, 0)) < 1e-12 && v3_norm(spin_before(w, 0)) < 1e-12);
    // it leans by the moment of its weight over the rocking stiffness, about .1 k D / (1.5 k L^2 / 8 / tau) with D =
    // tau 1.6
    check(fabs(x.x) < 0.04 && v3_dot(quat_rotate(q, v3(0, 0, 1)), v3(0, 0, 1)) > 1 - 3e-4);
    dem_world_destroy(w);
    model_free(m);
}

// lanes without a patch stand for a mass without end, whose dashpot must stay a number
static void contacts_of_any_stiffness_keep_a_ledger(void **state)
{
    (void)state;
    static const double stiff[] = {1, 1e9, 1e20};
    for (int i = 0; i < 3; i++) {
        model *m = soft_grain_model();
        m->scene.output.energy = true;
        m->scene.time.step = 0;
        m->laws[0].stiffness = stiff[i];
        damp(&m->laws[0], 0.5, 0.5);
        uint32_t shape = model_cloud(m, 8, 1, 2);
        model_plane(m, v3(0, 0, 0), v3(0, 0, 1));
        model_body(m, shape, v3(0, 0, 0.3))->velocity.z = -1e-3;
        model_body(m, shape, v3(0.1, 0, 0.8))->velocity.z = -2e-3;
        dem_world *w = model_world(m, 1);
        run_steps(w, 200);
        const dem_energy *e = &measured(w)->energy;
        check(isfinite(e->viscous) && isfinite(e->error));
        dem_world_destroy(w);
        model_free(m);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(single_spheres_are_as_with_the_sum),
        cmocka_unit_test(stiffness_does_not_depend_on_the_number_of_spheres),
        cmocka_unit_test(restitution_is_as_asked_at_every_number_of_spheres),
        cmocka_unit_test(hertz_has_the_radius_of_the_grain),
        cmocka_unit_test(a_closed_path_takes_no_work_and_forces_do_not_jump),
        cmocka_unit_test(copies_of_spheres_change_nothing),
        cmocka_unit_test(a_cube_keeps_its_rocking_stiffness),
        cmocka_unit_test(a_cube_rests_flat_and_does_not_creep),
        cmocka_unit_test(contacts_of_any_stiffness_keep_a_ledger),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
