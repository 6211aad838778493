#include "clumps.h"

#include "base/random.h"
#include "out/mass_shares.h"

enum { MANY = 60 };

static dem_shares_meet shared(const dem_clump_def *def, double *masses)
{
    dem_shares_meet meet;
    dem_error error;
    check_ok(dem_mass_shares(def, masses, &meet, &error), error);
    return meet;
}

// mass, centre, tensor of inertia of solid balls: xx yy zz xy xz yz
static void sum_up(const dem_clump_def *def, const double *masses, double *mass, dem_vec3 *centre, double tensor[6])
{
    *mass = 0;
    *centre = v3(0, 0, 0);
    memset(tensor, 0, 6 * sizeof *tensor);
    for (size_t i = 0; i < def->ball_count; i++) {
        double m = masses[i], r = def->balls[i].radius;
        dem_vec3 c = def->balls[i].centre;
        check(m > 0);
        *mass += m;
        *centre = v3_along(*centre, m, c);
        const double part[6] = {
            c.y * c.y + c.z * c.z, c.x * c.x + c.z * c.z, c.x * c.x + c.y * c.y, -c.x * c.y, -c.x * c.z, -c.y * c.z};
        for (int k = 0; k < 6; k++)
            tensor[k] += m * (part[k] + (k < 3 ? 0.4 * r * r : 0));
    }
    *centre = v3_scale(*centre, 1 / *mass);
}

// balls at random in a box of half sides 3, 2, 1
static void scatter(dem_ball *balls, size_t count)
{
    dem_random random = random_stream(7, 0);
    for (size_t i = 0; i < count; i++) {
        double x = random_uniform(&random), y = random_uniform(&random), z = random_uniform(&random);
        balls[i] = (dem_ball){{6 * x - 3.2, 4 * y - 2.1, 2 * z - 0.9}, 0.1 + 0.2 * random_uniform(&random)};
    }
}

static void many_spheres_take_the_whole_tensor(void **state)
{
    (void)state;
    static dem_ball balls[MANY];
    double masses[MANY], mass, tensor[6];
    dem_vec3 centre;
    scatter(balls, MANY);
    dem_clump_def def = sample_clump();
    def.balls = balls;
    def.ball_count = MANY;
    def.mass = 5;
    def.inertia[0] = 5 * 1.9;  // of a box of half sides a, b, c: m (b^2 + c^2) / 3, I3 = m (a^2 + b^2) / 3
    def.inertia[1] = 5 * 3.4;
    def.inertia[2] = 5 * 4.2;
    check(shared(&def, masses) == DEM_SHARES_INERTIA);
    sum_up(&def, masses, &mass, &centre, tensor);
    check_close(mass, def.mass, 1e-12);
    check_vec(centre, v3(0, 0, 0), 1e-12);
    for (int k = 0; k < 6; k++)
        check_near(tensor[k], k < 3 ? def.inertia[k] : 0, 1e-12 * def.inertia[2]);
}

static void shares_stay_near_the_volumes_where_these_are_right_already(void **state)
{
    (void)state;
    static const dem_ball balls[2] = {{{-1, 0, 0}, 0.5}, {{1, 0, 0}, 0.5}};
    double masses[2];
    dem_clump_def def = sample_clump();
    def.balls = balls;
    def.ball_count = 2;
    def.mass = 2;
    def.inertia[0] = 0.2;  // 2/5 m r^2 each, and m d^2
    def.inertia[1] = def.inertia[2] = 2.2;
    check(shared(&def, masses) == DEM_SHARES_INERTIA);
    check_close(masses[0], 1, 1e-12);
    check_close(masses[1], 1, 1e-12);
}

static void more_inertia_than_the_spheres_can_have_leaves_mass_and_centre(void **state)
{
    (void)state;
    static dem_ball balls[MANY];
    double masses[MANY], mass, tensor[6];
    dem_vec3 centre;
    scatter(balls, MANY);
    dem_clump_def def = sample_clump();
    def.balls = balls;
    def.ball_count = MANY;
    def.mass = 5;
    for (int k = 0; k < 3; k++)
        def.inertia[k] = 5 * (90 + k);
    check(shared(&def, masses) == DEM_SHARES_CENTRE);
    sum_up(&def, masses, &mass, &centre, tensor);
    check_close(mass, def.mass, 1e-12);
    check_vec(centre, v3(0, 0, 0), 1e-11);
}

static void a_centre_beside_all_spheres_leaves_the_mass(void **state)
{
    (void)state;
    static const dem_ball balls[2] = {{{1, 0, 0}, 1}, {{2, 0, 0}, 2}};
    double masses[2];
    dem_clump_def def = sample_clump();
    def.balls = balls;
    def.ball_count = 2;
    def.mass = 9;
    check(shared(&def, masses) == DEM_SHARES_MASS);
    check_close(masses[0], 1, 1e-14);  // by volume
    check_close(masses[1], 8, 1e-14);
}

static void the_result_does_not_depend_on_units(void **state)
{
    (void)state;
    static dem_ball balls[MANY], small[MANY];
    double masses[MANY], micro[MANY];
    scatter(balls, MANY);
    for (size_t i = 0; i < MANY; i++)
        small[i] = (dem_ball){v3_scale(balls[i].centre, 1e-6), 1e-6 * balls[i].radius};
    dem_clump_def def = sample_clump(), tiny;
    def.balls = balls;
    def.ball_count = MANY;
    def.mass = 5;
    def.inertia[0] = 9;
    def.inertia[1] = 16;
    def.inertia[2] = 21;
    tiny = def;
    tiny.balls = small;
    tiny.mass *= 1e-18;
    for (int k = 0; k < 3; k++)
        tiny.inertia[k] *= 1e-30;
    check(shared(&def, masses) == shared(&tiny, micro));
    for (size_t i = 0; i < MANY; i++)
        check_close(micro[i], 1e-18 * masses[i], 1e-9);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(many_spheres_take_the_whole_tensor),
        cmocka_unit_test(shares_stay_near_the_volumes_where_these_are_right_already),
        cmocka_unit_test(more_inertia_than_the_spheres_can_have_leaves_mass_and_centre),
        cmocka_unit_test(a_centre_beside_all_spheres_leaves_the_mass),
        cmocka_unit_test(the_result_does_not_depend_on_units),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
