// Walls that oscillate or follow a table: they are where they should be, as fast as they are there, and their work is
// in the ledger.
#include "scenes.h"
#include "worlds.h"

#include "sim/wall_motion.h"

static const dem_oscillation swings[] = {{.shift = {0.01, 0, 0.02}, .frequency = 7, .phase = 0.4},
                                         {.shift = {0, 0.03, 0}, .turn = 0.3, .frequency = 11, .phase = -1}};
static const double times[] = {0, 0.1, 0.15, 0.4, 0.5};
static const dem_vec3 shifts[] = {{0, 0, 0}, {0.1, 0, 0.02}, {0.1, 0.05, 0}, {-0.1, 0.02, 0.01}, {0, 0.01, 0.03}};
static const double turns[] = {0, 0.5, 0.4, 0.4, -0.2};

static dem_wall_def mover(int which)
{
    dem_wall_def wall = {.kind = DEM_WALL_MESH, .through = {0.2, 0.1, 0}, .axis = {0, 0.6, 0.8}};
    if (which % 2) {
        wall.oscillations = swings;
        wall.oscillation_count = 2;
        wall.start = 0.05;
        wall.stop = 0.41;
        wall.velocity = v3(0.3, 0, 0);
        wall.spin = v3(0, 3, 4);
    }
    if (which >= 2)
        wall.table = (dem_wall_table){.cubic = which >= 4, .count = 5, .time = times, .shift = shifts, .turn = turns};
    return wall;
}

// a point of the wall, and its velocity by its rows
static dem_vec3 point_at(const dem_wall_motion *m, double t, dem_vec3 x)
{
    dem_quat q;
    dem_wall_moment now = dem_wall_motion_at(m, t);
    dem_vec3 origin = dem_wall_pose(m, &now, v3(0, 0, 0), &q);
    return v3_add(origin, quat_rotate(q, x));
}

static dem_vec3 velocity_at(const dem_wall_motion *m, double t, dem_vec3 x)
{
    dem_wall_moment now = dem_wall_motion_at(m, t);
    dem_vec3 arm = v3_sub(point_at(m, t, x), v3_add(m->through, now.shift));
    return v3_add(now.velocity, v3_cross(now.spin, arm));
}

static bool near_a_kink(double t, int which)
{
    bool kink = which % 2 && (fabs(t - 0.05) < 1e-5 || fabs(t - 0.41) < 1e-5);
    for (int i = 0; i < 5; i++)
        kink |= which >= 2 && fabs(t - times[i]) < 1e-5;
    return kink;
}

// by central differences: d^2/6 |x'''| ~ 1e-12 * 4e4 * .03, and rounding of 1e-16 / d
static void a_wall_is_as_fast_as_it_moves(void **state)
{
    (void)state;
    const double d = 1e-6;
    for (int which = 1; which < 6; which++) {
        dem_wall_def wall = mover(which);
        dem_wall_motion m = dem_wall_motion_of(&wall);
        for (double t = 0.00123; t < 0.6; t += 0.00271) {
            dem_vec3 x = v3(0.3, -0.2, 0.5);
            dem_vec3 v = v3_scale(v3_sub(point_at(&m, t + d, x), point_at(&m, t - d, x)), 1 / (2 * d));
            if (!near_a_kink(t, which))
                check_vec(velocity_at(&m, t, x), v, 1e-7);
            dem_wall_moment now = dem_wall_motion_at(&m, t);
            check(v3_norm(now.velocity) <= m.speed_most * (1 + 1e-12) &&
                  v3_norm(now.spin) <= m.rate_most * (1 + 1e-12));
        }
        check_vec(point_at(&m, 0, v3(1, 2, 3)), v3(1, 2, 3), 1e-15);
    }
}

static void a_wall_is_where_its_table_says(void **state)
{
    (void)state;
    for (int which = 2; which < 6; which += 2) {
        dem_wall_def wall = mover(which);
        dem_wall_motion m = dem_wall_motion_of(&wall);
        for (int i = 0; i < 5; i++) {
            dem_wall_moment now = dem_wall_motion_at(&m, times[i]);
            check_vec(now.shift, shifts[i], 1e-16);
            check_near(now.angle, turns[i], 1e-16);
        }
        check_vec(dem_wall_motion_at(&m, 9).shift, shifts[4], 0);
        check_vec(dem_wall_motion_at(&m, 9).velocity, v3(0, 0, 0), 0);
        double middle = which == 2 ? 0.05 : 0.05 - 0.1 * (0.1 / 0.15) / 8;  // slope 0 and .1/.15 at the ends
        check_near(dem_wall_motion_at(&m, 0.05).shift.x, middle, 1e-15);
    }
    dem_wall_def wall = mover(1);
    dem_wall_motion m = dem_wall_motion_of(&wall);
    // stopped: as it was at 0.41 s
    double phase = 2 * DEM_PI * 7 * 0.36 + 0.4;
    check_near(dem_wall_motion_at(&m, 3).shift.z, 0.02 * (sin(phase) - sin(0.4)), 1e-15);
    check_near(dem_wall_motion_at(&m, 0.03).shift.x, 0, 0);
    check(!m.steady && dem_wall_def_moves(&wall));
}

// grains in a box whose floor shakes and whose side is driven by a table: nothing is missed, the ledger closes
static void shaken_grains_keep_their_ledger(void **state)
{
    (void)state;
    double off[2];
    for (int fine = 0; fine < 2; fine++) {
        model *m = model_new();
        m->laws[0].friction = DEM_FRICTION_LINEAR;
        m->laws[0].friction_coefficient = 0.3;
        m->laws[0].stiffness_ratio = 0.5;
        m->laws[0].damping = DEM_DAMPING_RESTITUTION;
        m->laws[0].restitution = 0.8;
        m->scene.gravity = v3(0, 0, -9.81);
        m->scene.time.step = fine ? 5e-6 : 1e-5;
        model_sphere(m, 0.004);
        model_lattice(m, 64, 0.01, 0.2, 3);
        model_box(m, v3(0, 0, 0), v3(0.04, 0.04, 0.06));
        dem_oscillation shake[] = {{.shift = {0, 0, 0.001}, .frequency = 60, .phase = 0.5},
                                   {.shift = {0.002, 0, 0}, .frequency = 35}};
        double when[] = {0, 0.03, 0.1}, angle[] = {0, 0.1, 0.05};
        dem_vec3 where[] = {{0, 0, 0}, {0.002, 0, 0}, {-0.002, 0.005, 0}};
        m->walls[4].oscillations = shake;
        m->walls[4].oscillation_count = 2;
        m->walls[0].table = (dem_wall_table){.cubic = true, .count = 3, .time = when, .shift = where, .turn = angle};
        m->walls[0].axis = v3(0, 1, 0);
        dem_world *w = model_world(m, 1);
        off[fine] = 0;
        for (int i = 0; i < 20; i++) {
            run_steps(w, fine ? 1000 : 500);
            off[fine] = largest(off[fine], measured(w)->energy.error);
        }
        check(measured(w)->energy.work > 1e-3);
        size_t count;
        double t = measured(w)->time, z = 0.001 * (sin(2 * DEM_PI * 60 * t + 0.5) - sin(0.5));
        check_near(dem_world_walls(w, &count)[4].position.z, z, 1e-14);
        dem_world_destroy(w);
        model_free(m);
    }
    // the springs of dashpots and friction at kicks make it first order
    check(off[0] < 2e-3 && off[1] < 0.7 * off[0]);
}

static void a_shaken_run_goes_on_bit_for_bit(void **state)
{
    (void)state;
    model *m = model_new();
    m->scene.gravity = v3(0, 0, -9.81);
    model_sphere(m, 0.004);
    model_lattice(m, 27, 0.01, 0.2, 3);
    model_box(m, v3(0, 0, 0), v3(0.03, 0.03, 0.06));
    m->walls[4].oscillations = (dem_oscillation[]){{.shift = {0, 0, 0.001}, .frequency = 60, .phase = 0.5}};
    m->walls[4].oscillation_count = 1;
    dem_world *w = model_world(m, 1), *other = model_world(m, 1);
    void *bytes;
    size_t size;
    dem_error error;
    run_steps(w, 3000);
    check_ok(dem_world_save(w, &bytes, &size, &error), error);
    run_steps(w, 2000);
    check_ok(dem_world_restore(other, bytes, size, &error), error);
    run_steps(other, 2000);
    check(dem_world_hash(w) == dem_world_hash(other));
    dem_world_destroy(other);
    m->walls[4].oscillations = (dem_oscillation[]){{.shift = {0, 0, 0.001}, .frequency = 61, .phase = 0.5}};
    other = model_world(m, 1);
    check(dem_world_restore(other, bytes, size, &error) == DEM_BAD_INPUT);
    free(bytes);
    dem_world_destroy(w);
    dem_world_destroy(other);
    model_free(m);
}

// ---- scenes

#define HEAD "{" SCENE_HEAD ",\n"
#define PLATE "'material': 'rock', 'plane': {'point': [0, 0, 0], 'normal': [0, 0, 1]}, 'motion': "

static void motions_are_read(void **state)
{
    (void)state;
    dem_scene s =
        scene_of(HEAD "'walls': {'a': {" PLATE "{'oscillate': {'direction': [0, 0, 2], 'amplitude': '2 mm',"
                      "'frequency': '50 Hz', 'phase': '90 deg'}, 'start': '1 s', 'stop': '2 s'}},"
                      "'b': {" PLATE "{'rotate': {'axis': [0, 1, 0], 'through': [1, 2, 3], 'rate': 2},"
                      "'oscillate': [{'amplitude': [1, 2, 3], 'frequency': 2}, {'angle': '180 deg', 'frequency': 3,"
                      "'axis': [0, 5, 0]}]}}}}");
    const dem_wall_def *a = &s.walls[0], *b = &s.walls[1];
    check(a->oscillation_count == 1 && a->oscillations[0].shift.z == 0.002 && a->oscillations[0].frequency == 50);
    check(a->start == 1 && a->stop == 2);
    check_near(a->oscillations[0].phase, DEM_PI / 2, 1e-15);
    check(b->oscillation_count == 2 && b->oscillations[0].shift.y == 2 && b->through.y == 2 && b->axis.y == 1);
    check_near(b->oscillations[1].turn, DEM_PI, 1e-15);
    dem_scene_release(&s);
}

static void wrong_motions_are_refused(void **state)
{
    (void)state;
    static const char *const cases[][2] = {
        {"{'oscillate': {'amplitude': 1, 'direction': [1, 0, 0]}}", "'frequency' is missing"},
        {"{'oscillate': {'frequency': 1}}", "needs 'amplitude' or 'angle'"},
        {"{'oscillate': {'amplitude': 1, 'frequency': 1}}", "'direction' is missing"},
        {"{'oscillate': {'amplitude': [0, 0, 1], 'direction': [0, 0, 1], 'frequency': 1}}", "has a direction already"},
        {"{'oscillate': {'angle': 1, 'frequency': 1}}", "'axis' of the angle is missing"},
        {"{'oscillate': {'angle': 1, 'frequency': 0, 'axis': [1, 0, 0]}}", "must be above 0"},
        {"{'rotate': {'axis': [0, 1, 0], 'rate': 1}, 'oscillate': {'angle': 1, 'frequency': 1, 'axis': [1, 0, 0]}}",
         "about another axis"},
        {"{'rotate': {'axis': [0, 1, 0], 'rate': 1}, 'oscillate': {'angle': 1, 'frequency': 1, 'axis': [0, 1, 0],"
         "'through': [1, 0, 0]}}",
         "about another axis"},
        {"{'start': 2, 'stop': 1}", "must be after"},
        {"{'table': 'x.csv'}", "files are not read here"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char text[1200];
        dem_scene s;
        dem_error error;
        snprintf(text, sizeof text, HEAD "'walls': {'w': {" PLATE "%s}}}", cases[i][0]);
        check(scene_read(text, NULL, NULL, &s, &error) == DEM_BAD_INPUT);
        char *want = quoted(cases[i][1]);
        if (!strstr(error.text, want))
            print_error("%s: %s\n", text, error.text);
        check(strstr(error.text, want) && error.line == 7 && strchr(error.text, ';'));
        free(want);
    }
}

static void a_table_is_read_from_its_file(void **state)
{
    (void)state;
    static const struct {
        const char *csv, *refused;
    } cases[] = {
        {"# by hand\ntime, z ,angle\n0,0,0\n 0.5, 2e-3 ,1\n1,-1,2\r\n", NULL},
        {"z,time\n0,0\n1,2\n", NULL},
        {"time,z\n0,1\n1,2\n", "shifts the wall at time 0, "},
        {"time,w\n0,0\n", "unknown column;"},
        {"time,z,z\n0,0,0\n", "stands twice;"},
        {"z\n0\n", "needs the column time"},
        {"time,z\n0,0\n0,1\n", "times must rise;"},
        {"time,z\n0,0,0\n", "another number of columns"},
        {"time,z\n0\n", "another number of columns"},
        {"time,z\n0,nan\n", "no number;"},
        {"time,z\n", "has no rows;"},
        {"\n\n", "is empty;"},
    };
    char folder[] = "/tmp/dem-motion-XXXXXX", path[64];
    check(mkdtemp(folder));
    snprintf(path, sizeof path, "%s/m.csv", folder);
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        dem_scene s;
        dem_error error;
        check_ok(dem_file_write(path, cases[i].csv, strlen(cases[i].csv), &error), error);
        dem_status status = scene_read(HEAD "'walls': {'w': {" PLATE "{'table': {'file': 'm.csv',"
                                            "'interpolation': 'cubic', 'axis': [0, 0, 1]}}}}}",
                                       folder, NULL, &s, &error);
        if (cases[i].refused) {
            if (status != DEM_BAD_INPUT || !strstr(error.text, cases[i].refused))
                print_error("%s: %s\n", cases[i].csv, error.text);
            check(status == DEM_BAD_INPUT && strstr(error.text, cases[i].refused));
            continue;
        }
        check_ok(status, error);
        const dem_wall_table *t = &s.walls[0].table;
        check(t->cubic && t->count == (i ? 2 : 3) && t->shift[1].z == (i ? 1 : 2e-3) && t->time[1] == (i ? 2 : 0.5));
        check(i ? !t->turn : t->turn && t->turn[2] == 2);
        // written out and read again, it is the same
        char *text;
        check_ok(dem_scene_resolved(&s, &text, &error), error);
        dem_scene again;
        check_ok(dem_scene_read_text(NULL, text, strlen(text), "again", "/", NULL, &again, &error), error);
        check(again.walls[0].table.count == t->count && again.walls[0].table.cubic);
        free(text);
        dem_scene_release(&again);
        dem_scene_release(&s);
    }
    unlink(path);
    rmdir(folder);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_wall_is_as_fast_as_it_moves),
        cmocka_unit_test(a_wall_is_where_its_table_says),
        cmocka_unit_test(shaken_grains_keep_their_ledger),
        cmocka_unit_test(a_shaken_run_goes_on_bit_for_bit),
        cmocka_unit_test(motions_are_read),
        cmocka_unit_test(wrong_motions_are_refused),
        cmocka_unit_test(a_table_is_read_from_its_file),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
