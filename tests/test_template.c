#include "clumps.h"

#include "base/random.h"
#include "math/mat3.h"
#include "sim/template.h"

static dem_vec3 random_vec(dem_random *r)
{
    double x = random_normal(r), y = random_normal(r);
    return v3(x, y, random_normal(r));
}

static dem_quat random_turn(dem_random *r)
{
    double w = random_normal(r), x = random_normal(r), y = random_normal(r);
    return quat_unit((dem_quat){w, x, y, random_normal(r)});
}

// a scene of one clump and one sphere
typedef struct pair {
    dem_material material;
    dem_shape_def shapes[2];
    dem_scene scene;
    dem_clump *clump;
} pair;

static void make_pair(pair *p, const dem_clump_def *def, double density, double radius)
{
    *p = (pair){.material = {"quartz", density, 7e10, 0.2}};
    p->clump = made_clump(def);
    p->shapes[0] = (dem_shape_def){.name = "grain", .clump = p->clump};
    p->shapes[1] = (dem_shape_def){.name = "ball", .sphere_radius = radius};
    p->scene = (dem_scene){.materials = &p->material, .material_count = 1, .shapes = p->shapes, .shape_count = 2};
}

static void made(const pair *p, dem_templates *t)
{
    dem_error error;
    check_ok(dem_templates_create(&p->scene, t, &error), error);
}

static void release(pair *p, dem_templates *t)
{
    dem_templates_release(t);
    dem_clump_destroy(p->clump);
}

static void spheres_have_the_mass_of_their_material(void **state)
{
    (void)state;
    dem_clump_def def = sample_clump();
    pair p;
    dem_templates t;
    make_pair(&p, &def, 2500, 0.002);
    made(&p, &t);
    const dem_template *s = &t.items[1];
    double mass = 2500 * 4 * DEM_PI / 3 * 8e-9;
    // three roundings or so
    check_close(s->mass, mass, 1e-15);
    for (int k = 0; k < 3; k++) {
        check_close(s->inertia[k], 0.4 * mass * 4e-6, 1e-15);
        check_close(s->inverse_inertia[k], 1 / s->inertia[k], 1e-15);
    }
    check(s->isotropic && s->centred && s->count == 1 && s->least_mass == s->mass && s->to_run.w == 1);
    check(s->radius_out == 0.002 && s->radius_min == 0.002 && s->radius_max == 0.002);
    check_close(s->equivalent_diameter, 0.004, 1e-15);
    check_close(s->inverse_mass, 1 / mass, 1e-15);
    release(&p, &t);
}

static void a_clump_takes_the_density_of_its_material_where_that_has_one(void **state)
{
    (void)state;
    dem_clump_def def = sample_clump();
    const double densities[2] = {NAN, 1325};  // half of the clump's own
    for (int i = 0; i < 2; i++) {
        pair p;
        dem_templates t;
        make_pair(&p, &def, densities[i], 0.1);
        p.scene.shape_count = 1;
        made(&p, &t);
        double factor = i ? 0.5 : 1;
        check(t.items[0].mass == factor * def.mass);
        double sum = t.items[0].inertia[0] + t.items[0].inertia[1] + t.items[0].inertia[2];
        check_close(sum, factor * (def.inertia[0] + def.inertia[1] + def.inertia[2]), 1e-15);
        check_close(t.items[0].equivalent_diameter, cbrt(6 * 0.7 / DEM_PI), 1e-15);
        release(&p, &t);
    }
}

static void points_stay_where_they_are_in_space(void **state)
{
    (void)state;
    dem_random r = random_stream(5, 0);
    const double moments[][3] = {
        {0.1, 0.2, 0.21}, {0.1, 0.101, 0.2}, {0.1, 0.1, 0.2}, {0.05, 0.2, 0.2}, {0.1, 0.15, 0.2}};
    // which principal axis becomes z: that the other two are most alike about
    const int axes[] = {0, 2, 2, 0, 0};
    for (int i = 0; i < 5; i++) {
        dem_clump_def def = sample_clump();
        memcpy(def.inertia, moments[i], sizeof def.inertia);
        pair p;
        dem_templates t;
        make_pair(&p, &def, NAN, 1);
        p.scene.shape_count = 1;
        made(&p, &t);
        const dem_template *a = &t.items[0];
        check(a->inertia[2] == moments[i][axes[i]]);
        for (int n = 0; n < 100; n++) {
            dem_quat q = random_turn(&r), run = template_run_orientation(a, q);
            for (size_t k = 0; k < def.ball_count; k++) {
                const double *row = t.spheres[a->first + k];
                // rotations of vectors of length 1 twice over
                check_vec(quat_rotate(run, v3(row[0], row[1], row[2])), quat_rotate(q, def.balls[k].centre), 2e-15);
                check_vec(v3(row[0], row[1], row[2]), quat_rotate(a->to_run, def.balls[k].centre), 1e-15);
                check(row[3] == def.balls[k].radius);
            }
            // and so does the angular momentum of a spin
            dem_vec3 w = random_vec(&r), u = quat_unrotate(q, w), v = quat_unrotate(run, w);
            dem_vec3 l = quat_rotate(q, v3(u.x * moments[i][0], u.y * moments[i][1], u.z * moments[i][2]));
            check_vec(quat_rotate(run, v3(v.x * a->inertia[0], v.y * a->inertia[1], v.z * a->inertia[2])), l, 1e-14);
            dem_quat back = template_principal_orientation(a, run);
            check_near(fabs(back.w * q.w + back.x * q.x + back.y * q.y + back.z * q.z), 1, 1e-15);
        }
        release(&p, &t);
    }
}

static void the_splitting_axis_is_the_best_one(void **state)
{
    (void)state;
    dem_random r = random_stream(6, 0);
    for (int n = 0; n < 200; n++) {
        dem_clump_def def = sample_clump();
        double a = 0.1 + random_uniform(&r), b = a * (1 + random_uniform(&r)), c = b + (a - 1e-3) * random_uniform(&r);
        memcpy(def.inertia, (double[3]){a, b, c}, sizeof def.inertia);
        pair p;
        dem_templates t;
        make_pair(&p, &def, NAN, 1);
        p.scene.shape_count = 1;
        made(&p, &t);
        const double *i = t.items[0].inertia;
        double got = fabs(1 / i[0] - 1 / i[1]);
        check(got <= fabs(1 / i[1] - 1 / i[2]) && got <= fabs(1 / i[2] - 1 / i[0]));
        release(&p, &t);
    }
}

static void a_clump_of_one_sphere_is_a_sphere_bit_for_bit(void **state)
{
    (void)state;
    double r = 0.00123, density = 2650, volume = 4.0 / 3 * DEM_PI * r * r * r;
    double mass = density * volume, moment = 0.4 * mass * r * r;
    // a centre and moments as a packer leaves them
    dem_ball ball = {{3e-16, -5e-16, 1e-16}, r};
    dem_clump_def def = sample_clump();
    def.balls = &ball;
    def.ball_count = 1;
    def.volume = volume;
    def.mass = mass;
    memcpy(def.inertia, (double[3]){moment * (1 - 3e-10), moment, moment * (1 + 4e-10)}, sizeof def.inertia);
    pair p;
    dem_templates t;
    make_pair(&p, &def, density, r);
    made(&p, &t);
    dem_template *a = &t.items[0], *b = &t.items[1];
    assert_memory_equal(t.spheres[a->first], t.spheres[b->first], sizeof t.spheres[0]);
    a->first = b->first;
    a->float_first = b->float_first;
    assert_memory_equal(a, b, sizeof *a);
    for (int i = 0; i < DEM_TEMPLATE_PAD; i++)
        check(t.x[i] == t.x[i + DEM_TEMPLATE_PAD] && t.r[i] == t.r[i + DEM_TEMPLATE_PAD]);
    release(&p, &t);
}

static void one_sphere_with_other_moments_keeps_them(void **state)
{
    (void)state;
    dem_ball ball = {{0, 0, 0}, 1};
    dem_clump_def def = sample_clump();
    def.balls = &ball;
    def.ball_count = 1;
    pair p;
    dem_templates t;
    make_pair(&p, &def, NAN, 1);
    p.scene.shape_count = 1;
    made(&p, &t);
    check(t.items[0].centred && !t.items[0].isotropic);
    check_close(t.items[0].inertia[0] * t.items[0].inertia[1] * t.items[0].inertia[2], 0.1 * 0.2 * 0.3, 1e-15);
    release(&p, &t);
    // and off the centre it is a clump, isotropic or not
    ball.centre.x = 1e-6;
    memcpy(def.inertia, (double[3]){0.1, 0.1, 0.1}, sizeof def.inertia);
    make_pair(&p, &def, NAN, 1);
    p.scene.shape_count = 1;
    made(&p, &t);
    check(!t.items[0].centred && t.items[0].isotropic && t.items[0].least_mass < t.items[0].mass);
    check(t.spheres[0][0] == 1e-6);
    release(&p, &t);
}

static void sizes_are_those_of_the_spheres(void **state)
{
    (void)state;
    dem_clump_def def = sample_clump();
    pair p;
    dem_templates t;
    make_pair(&p, &def, NAN, 1);
    p.scene.shape_count = 1;
    made(&p, &t);
    double out = 0;
    for (size_t i = 0; i < def.ball_count; i++)
        out = fmax(out, v3_norm(def.balls[i].centre) + def.balls[i].radius);
    check_close(t.items[0].radius_out, out, 1e-15);
    check(t.items[0].radius_min == 1.0 / 7 && t.items[0].radius_max == 0.5);
    release(&p, &t);
}

// PHYSICS 6.3, off-centre impact of a dumbbell: m_loc / m at 0 is .540816327, the least of all contacts
static void the_least_mass_of_a_dumbbell_is_that_of_the_reference(void **state)
{
    (void)state;
    const dem_ball balls[2] = {{{0.015, 0, 0}, 0.01}, {{-0.015, 0, 0}, 0.01}};
    dem_clump_def def = sample_clump();
    def.balls = balls;
    def.ball_count = 2;
    def.mass = 0.020943951;
    memcpy(def.inertia, (double[3]){0.8e-6, 5.55014702e-6, 5.55014702e-6}, sizeof def.inertia);
    pair p;
    dem_templates t;
    make_pair(&p, &def, NAN, 1);
    p.scene.shape_count = 1;
    made(&p, &t);
    check_close(t.items[0].least_mass / def.mass, 0.540816327, 2e-9);
    release(&p, &t);
}

static void no_contact_sees_less_than_the_least_mass(void **state)
{
    (void)state;
    dem_random r = random_stream(7, 0);
    dem_clump_def def = sample_clump();
    pair p;
    dem_templates t;
    make_pair(&p, &def, NAN, 1);
    p.scene.shape_count = 1;
    made(&p, &t);
    const dem_template *a = &t.items[0];
    double least = INFINITY;
    for (int n = 0; n < 20000; n++) {
        const double *row = t.spheres[a->first + random_below(&r, a->count)];
        dem_vec3 normal = v3_unit(random_vec(&r)), arm = v3_along(v3(row[0], row[1], row[2]), row[3], normal);
        dem_vec3 turn = v3_cross(arm, normal);
        turn = v3(turn.x * a->inverse_inertia[0], turn.y * a->inverse_inertia[1], turn.z * a->inverse_inertia[2]);
        double mass = 1 / (a->inverse_mass + v3_dot(normal, v3_cross(turn, arm)));
        check(mass >= a->least_mass * (1 - 1e-14));
        least = fmin(least, mass);
    }
    // 7000 directions per sphere: the nearest to the worst is off by about 0.02
    check_close(least, a->least_mass, 1e-3);
    release(&p, &t);
}

static void columns_contain_the_spheres_and_padding_is_never_near(void **state)
{
    (void)state;
    dem_random r = random_stream(8, 0);
    dem_ball balls[37];
    for (int i = 0; i < 37; i++)
        balls[i] = (dem_ball){v3_scale(random_vec(&r), 1e-3), 1e-4 * (1 + random_uniform(&r))};
    dem_clump_def def = sample_clump();
    def.balls = balls;
    def.ball_count = 37;
    pair p;
    dem_templates t;
    make_pair(&p, &def, 2000, 1e-3);
    made(&p, &t);
    check((uintptr_t)t.spheres % 64 == 0 && (uintptr_t)t.x % 64 == 0 && (uintptr_t)t.r % 64 == 0);
    check(t.items[0].float_padded == 48 && t.items[1].float_first == 48 && t.float_count == 64 && t.sphere_count == 38);
    for (size_t s = 0; s < 2; s++) {
        const dem_template *a = &t.items[s];
        for (uint32_t i = 0; i < a->float_padded; i++) {
            uint32_t at = a->float_first + i;
            if (i >= a->count) {
                float lower = 0 - t.r[at], upper = 0 + t.r[at];
                check(upper < -1e17f && lower > 1e17f && isfinite(4 * t.r[at] * t.r[at]));
                continue;
            }
            const double *row = t.spheres[a->first + i];
            double off = v3_distance(v3(row[0], row[1], row[2]), v3((double)t.x[at], (double)t.y[at], (double)t.z[at]));
            check((double)t.r[at] >= off + row[3]);
            // half a unit of the last place of each coordinate, and one of the radius
            check_near((double)t.r[at], row[3], 4e-3 * 0x1p-24 + row[3] * 0x1p-23);
        }
    }
    release(&p, &t);
}

static void unusable_shapes_are_refused_by_name(void **state)
{
    (void)state;
    dem_clump_def def = sample_clump();
    pair p;
    dem_templates t;
    dem_error error;
    make_pair(&p, &def, NAN, 1);
    check(dem_templates_create(&p.scene, &t, &error) == DEM_USAGE && !t.items);
    assert_string_equal(error.text,
                        "shape ball: a sphere has the density of its material, and quartz has none; give it in kg/m^3");
    p.material.density = -1;
    check(dem_templates_create(&p.scene, &t, &error) == DEM_USAGE);
    check(strstr(error.text, "material quartz: its density must be positive"));
    p.material.density = 2650;
    p.shapes[0].sphere_radius = 1;
    check(dem_templates_create(&p.scene, &t, &error) == DEM_USAGE);
    check(strstr(error.text, "shape grain: is both a clump and a sphere"));
    p.shapes[0].sphere_radius = 0;
    p.shapes[1].sphere_radius = NAN;
    check(dem_templates_create(&p.scene, &t, &error) == DEM_USAGE);
    check(strstr(error.text, "shape ball: is neither a clump nor a sphere"));
    p.shapes[1].sphere_radius = 1e13;
    check(dem_templates_create(&p.scene, &t, &error) == DEM_BAD_INPUT);
    check(strstr(error.text, "check the unit of length"));
    p.shapes[1] = (dem_shape_def){.name = "ball", .sphere_radius = 1, .material = 1};
    check(dem_templates_create(&p.scene, &t, &error) == DEM_USAGE);
    check(strstr(error.text, "shape ball: material 1 does not exist"));
    dem_clump_destroy(p.clump);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(spheres_have_the_mass_of_their_material),
        cmocka_unit_test(a_clump_takes_the_density_of_its_material_where_that_has_one),
        cmocka_unit_test(points_stay_where_they_are_in_space),
        cmocka_unit_test(the_splitting_axis_is_the_best_one),
        cmocka_unit_test(a_clump_of_one_sphere_is_a_sphere_bit_for_bit),
        cmocka_unit_test(one_sphere_with_other_moments_keeps_them),
        cmocka_unit_test(sizes_are_those_of_the_spheres),
        cmocka_unit_test(the_least_mass_of_a_dumbbell_is_that_of_the_reference),
        cmocka_unit_test(no_contact_sees_less_than_the_least_mass),
        cmocka_unit_test(columns_contain_the_spheres_and_padding_is_never_near),
        cmocka_unit_test(unusable_shapes_are_refused_by_name),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
