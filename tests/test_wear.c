// Wear: Finnie's table, once for each impact of a body, whatever the triangles and spheres; Archard's path and force.
#include "walls.h"
#include "worlds.h"

#include "sim/wear.h"

static const dem_wear_def sand = {DEM_WEAR_FINNIE, .constant = 2, .pressure = 1e9, .psi = 2, .roughness = 0.5};

// Q p / (m V^2) by angle: K 2 as it is and corrected, K 5 (8 digits of the table)
static void finnie_gives_the_numbers_of_the_table(void **state)
{
    (void)state;
    static const double table[][4] = {
        {5, 0.0377149518, 0.0188574759, 0.0164532829},  {10, 0.0628897686, 0.0314448843, 0.0305835716},
        {15, 0.0747595264, 0.0373797632, 0.0419615242}, {16.8450338, 0.0756939094, 0.0378469547, 0.0453930377},
        {20, 0.0735851851, 0.0367925926, 0.0502414276}, {30, 0.0625, 0.03125, 0.0566025404},
        {45, 0.0416666667, 0.0208333333, 0.0416666667}, {75, 0.00558227484, 0.00279113742, 0.00558227484}};
    for (size_t i = 0; i < sizeof table / sizeof *table; i++) {
        double angle = table[i][0] * DEM_PI / 180, scale = 3e-6 * 25 / 1e9;
        dem_wear_def law = sand;
        check_close(dem_wear_finnie(&law, 3e-6, 5, angle), table[i][2] * scale, 1e-8);
        law.roughness = 1;
        check_close(dem_wear_finnie(&law, 3e-6, 5, angle), table[i][1] * scale, 1e-8);
        law.constant = 5;
        check_close(dem_wear_finnie(&law, 3e-6, 5, angle), table[i][3] * scale, 1e-8);
    }
    check(dem_wear_finnie(&sand, 1, 1, 0) == 0 && dem_wear_finnie(&sand, 1, 1, -0.1) == 0);
    check(dem_wear_finnie(&sand, 1, 1, DEM_PI / 2) < 1e-30);
    // continuous where the two forms meet
    double meet = atan(2.0 / 6);
    check_close(dem_wear_finnie(&sand, 1, 1, meet * (1 - 1e-9)), dem_wear_finnie(&sand, 1, 1, meet * (1 + 1e-9)), 1e-8);
}

// a rectangle of 2 x 2 in `n` x `n` cells at z = 0
static dem_mesh sheet(uint32_t n, int pattern)
{
    double x[200];
    for (uint32_t i = 0; i <= n; i++)
        x[i] = -1 + 2.0 * i / n;
    return wall_sheet(x, n + 1, x, n + 1, pattern);
}

static double worn_by(model *m, uint64_t steps, size_t *triangles)
{
    dem_world *w = model_world(m, 1);
    run_steps(w, steps);
    size_t count;
    measured(w);
    const dem_wall_view *v = dem_world_walls(w, &count);
    double sum = 0;
    *triangles = 0;
    for (size_t i = 0; i < v->wear_count; i++) {
        sum += v->wear[i];
        *triangles += v->wear[i] > 0;
    }
    check_close(v->worn, sum, 1e-14);
    dem_world_destroy(w);
    return sum;
}

// a body that strikes at 30 degrees with 2 m/s and bounces off
static model *impact(bool clump)
{
    model *m = model_new();
    uint32_t shape = clump
                         ? model_clump(m, (dem_ball[]){{{0, 0, 0}, 0.01}, {{0.001, 0, 0}, 0.01}, {{0, 0.001, 0}, 0.01}},
                                       3, 0.01, (double[]){4e-7, 4e-7, 4e-7})
                         : model_sphere(m, 0.01);
    double a = DEM_PI / 6;
    model_body(m, shape, v3(0.0123, 0.0077, 0.0105))->velocity = v3(2 * cos(a), 0, -2 * sin(a));
    m->scene.time.step = 1e-6;
    return m;
}

static void an_impact_wears_once(void **state)
{
    (void)state;
    for (int clump = 0; clump < 2; clump++) {
        model *m = impact(clump);
        m->walls[0] = (dem_wall_def){
            .kind = DEM_WALL_RECTANGLE, .normal = {0, 0, 1}, .along = {1, 0, 0}, .size = {2, 2}, .wear = sand};
        m->scene.wall_count = 1;
        size_t triangles;
        double mass = clump ? 0.01 : 2500 * 4 * DEM_PI / 3 * 1e-6, want = 0.03125 * mass * 4 / 1e9;
        check_close(worn_by(m, 20000, &triangles), want, 1e-9);
        // a wall that runs along below as fast as the body is worn by its fall only, which cuts nothing
        m->walls[0].velocity = v3(2 * cos(DEM_PI / 6), 0, 0);
        check(worn_by(m, 20000, &triangles) < 1e-6 * want);
        model_free(m);
    }
}

static void the_wear_of_one_event_does_not_depend_on_the_triangles(void **state)
{
    (void)state;
    if (!DEM_EMBREE)
        skip();
    const uint32_t parts[] = {1, 3, 50, 199};
    double want = 0.03125 * (2500 * 4 * DEM_PI / 3 * 1e-6) * 4 / 1e9;
    for (int i = 0; i < 4; i++) {
        model *m = impact(false);
        m->walls[0] = (dem_wall_def){.kind = DEM_WALL_MESH, .mesh = sheet(parts[i], i % 3), .wear = sand};
        m->scene.wall_count = 1;
        size_t triangles;
        check_close(worn_by(m, 20000, &triangles), want, 1e-9);
        check(triangles == 1);
        model_free(m);
    }
}

// grains that rain on a sheet, with friction
static model *rain(uint32_t parts, size_t count, dem_wear_def wear)
{
    model *m = model_new();
    m->laws[0].friction = DEM_FRICTION_LINEAR;
    m->laws[0].friction_coefficient = 0.3;
    m->laws[0].stiffness_ratio = 0.3;
    m->laws[0].damping = DEM_DAMPING_RESTITUTION;
    m->laws[0].restitution = 0.6;
    m->scene.gravity = v3(3, 1, -9.81);
    model_sphere(m, 0.01);
    model_cloud(m, 5, 0.02, 2);
    model_lattice(m, count, 0.06, 1, 9);
    for (size_t i = 0; i < count; i++)
        m->bodies[i].position = v3_add(m->bodies[i].position, v3(-0.5, -0.5, 0));
    m->walls[0] = (dem_wall_def){.kind = DEM_WALL_MESH, .mesh = sheet(parts, 2), .wear = wear};
    m->scene.wall_count = 1;
    m->scene.time.step = 2e-5;
    return m;
}

// by the two triangles as by the 20000: 0.1 % (each run is another after some bounces, by rounding)
static void a_rain_wears_all_triangulations_alike(void **state)
{
    (void)state;
    if (!DEM_EMBREE)
        skip();
    const dem_wear_def laws[] = {sand, {DEM_WEAR_ARCHARD, .coefficient = 1e-3, .hardness = 1e9}};
    for (int law = 0; law < 2; law++) {
        double worn[2];
        size_t triangles;
        for (int i = 0; i < 2; i++) {
            model *m = rain(i ? 100 : 1, 125, laws[law]);
            worn[i] = worn_by(m, 8000, &triangles);
            check(i == 0 ? triangles <= 2 : triangles > 20);
            model_free(m);
        }
        check(worn[0] > 0);
        check_close(worn[1], worn[0], 1e-3);
    }
}

// a block of weight N that slides by s: k N s / H
static void archard_counts_force_and_path(void **state)
{
    (void)state;
    model *m = model_new();
    m->laws[0].friction = DEM_FRICTION_LINEAR;
    m->laws[0].friction_coefficient = 0.2;
    m->laws[0].stiffness_ratio = 0.3;
    m->laws[0].damping = DEM_DAMPING_RESTITUTION;
    m->laws[0].restitution = 0.3;
    m->scene.gravity = v3(0, 0, -9.81);
    double mass = 2500 * 4 * DEM_PI / 3 * 1e-6;
    dem_body_def *b = model_body(m, model_sphere(m, 0.01), v3(-0.3, 0, 0.01 - mass * 9.81 / 1e4));
    b->hold = DEM_LOCK_RX | DEM_LOCK_RY | DEM_LOCK_RZ;
    b->velocity = v3(1, 0, 0);
    m->walls[0] = (dem_wall_def){.kind = DEM_WALL_DISC,
                                 .normal = {0, 0, 1},
                                 .radius = 2,
                                 .wear = {DEM_WEAR_ARCHARD, .coefficient = 2e-3, .hardness = 3e9}};
    m->scene.wall_count = 1;
    size_t triangles;
    // 0.2 s: v falls by mu g t
    double path = 0.2 - 0.2 * 9.81 * 0.04 / 2;
    check_close(worn_by(m, 20000, &triangles), 2e-3 * mass * 9.81 * path / 3e9, 2e-4);
    model_free(m);
}

static void wear_is_part_of_the_state(void **state)
{
    (void)state;
    if (!DEM_EMBREE)
        skip();
    for (int law = 0; law < 2; law++) {
        dem_wear_def archard = {DEM_WEAR_ARCHARD, .coefficient = 1e-3, .hardness = 1e9};
        model *m = rain(40, 600, law ? archard : sand);
        dem_world *w = model_world(m, 1);
        size_t count;
        run_steps(w, 1500);
        dem_world *other = model_resumed(m, w, 2);
        run_steps(w, 1000);
        measured(other);
        double then = dem_world_walls(other, &count)->worn;
        run_steps(other, 1000);
        measured(other);
        measured(w);
        check(dem_world_walls(w, &count)->worn > then);
        check(dem_world_walls(other, &count)->worn == dem_world_walls(w, &count)->worn);
        check(dem_world_hash(w) == dem_world_hash(other));
        dem_world_destroy(w);
        dem_world_destroy(other);
        model_free(m);
    }
}

static void a_plane_without_an_end_does_not_wear(void **state)
{
    (void)state;
    model *m = impact(false);
    model_plane(m, v3(0, 0, 0), v3(0, 0, 1))->wear = sand;
    dem_world *w;
    dem_error error;
    check(dem_world_create(NULL, &m->scene, &w, &error) == DEM_BAD_INPUT && strstr(error.text, "no end"));
    model_free(m);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(finnie_gives_the_numbers_of_the_table),
        cmocka_unit_test(an_impact_wears_once),
        cmocka_unit_test(the_wear_of_one_event_does_not_depend_on_the_triangles),
        cmocka_unit_test(a_rain_wears_all_triangulations_alike),
        cmocka_unit_test(archard_counts_force_and_path),
        cmocka_unit_test(wear_is_part_of_the_state),
        cmocka_unit_test(a_plane_without_an_end_does_not_wear),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
