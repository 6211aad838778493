// Soft contacts: what a pair of clumps does must not depend on how many spheres describe them.
#include "soft_cases.h"

static const double K = 1e5, OVERLAP = 0.005;  // grains are of about 1 m

// an ellipsoid of diameters 1.26, 1, .79 m covered by n spheres that touch its surface from inside
static uint32_t ellipsoid(model *m, size_t n)
{
    static const dem_vec3 AXES = {0.63, 0.5, 0.397};
    dem_ball *balls = calloc(n, sizeof *balls);
    check(balls);
    for (size_t i = 0; i < n; i++) {
        double z = 1 - (2 * (double)i + 1) / (double)n, s = sqrt(1 - z * z), a = 2.39996322972865332 * (double)i;
        dem_vec3 u = v3(s * cos(a), s * sin(a), z), p = v3(AXES.x * u.x, AXES.y * u.y, AXES.z * u.z);
        dem_vec3 out = v3_unit(v3(u.x / AXES.x, u.y / AXES.y, u.z / AXES.z));
        balls[i] = (dem_ball){v3_along(p, -0.24, out), 0.24};
    }
    double mass = 2500 * 4 * DEM_PI / 3 * AXES.x * AXES.y * AXES.z, xx = AXES.x * AXES.x, yy = AXES.y * AXES.y,
           zz = AXES.z * AXES.z;
    uint32_t shape =
        model_clump(m, balls, n, mass, (double[]){mass * (yy + zz) / 5, mass * (xx + zz) / 5, mass * (xx + yy) / 5});
    free(balls);
    return shape;
}

static model *soft_model(void)
{
    model *m = model_new();
    m->scene.multiple = DEM_MULTIPLE_SOFT;
    m->scene.soft.tau = 0.0012;
    m->scene.domain.leaving = DEM_LEAVING_IGNORE;
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

static void run_spheres(dem_multiple multiple, dem_normal_law normal, dem_vec3 out[8], double *error)
{
    model *m = soft_model();
    m->scene.multiple = multiple;
    damp(&m->laws[0], 0.5, 0.5);
    m->laws[0].normal = normal;
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
    run_steps(w, 5000);
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
    for (dem_normal_law normal = DEM_NORMAL_LINEAR; normal <= DEM_NORMAL_HERTZ; normal++) {
        dem_vec3 soft[8], sum[8];
        double error_soft, error_sum;
        run_spheres(DEM_MULTIPLE_SOFT, normal, soft, &error_soft);
        run_spheres(DEM_MULTIPLE_SUM, normal, sum, &error_sum);
        for (int i = 0; i < 8; i++)
            check_vec(soft[i], sum[i], i % 4 == 3 ? 1e-6 : 1e-9);
        check_near(error_soft, error_sum, 1e-9);
        check(fabs(error_sum) < 1e-2 && v3_norm(sum[3]) > 1);
    }
}

// ---- stiffness and restitution by the number of spheres

typedef struct stiffness {
    double tangent, secant;  // over that of one contact
} stiffness;

static stiffness stiffness_of(dem_multiple multiple, size_t spheres, bool twin)
{
    model *m = soft_model();
    m->scene.multiple = multiple;
    uint32_t shape = ellipsoid(m, spheres);
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
    model *m = soft_model();
    m->scene.multiple = multiple;
    damp(&m->laws[0], 0.8, 0);
    uint32_t shape = ellipsoid(m, n);
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

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(single_spheres_are_as_with_the_sum),
        cmocka_unit_test(stiffness_does_not_depend_on_the_number_of_spheres),
        cmocka_unit_test(restitution_is_as_asked_at_every_number_of_spheres),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
