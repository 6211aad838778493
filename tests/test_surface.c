// Cones, spheres, discs and rectangles as walls: the closest point is the closest, forces are those of the planes and
// cylinders they come near to, and nothing is missed while balls fly about among them.
#include "scenes.h"
#include "worlds.h"

#include "sim/surface.h"

static dem_wall_def form(int which)
{
    dem_vec3 axis = v3_unit(v3(0.3, -0.5, 0.8)), point = v3(0.1, 0.2, -0.1);
    switch (which) {
    case 0:
        return (dem_wall_def){
            .kind = DEM_WALL_CONE, .point = point, .normal = axis, .radius = 0.2, .end_radius = 0.7, .length = 0.6};
    case 1:
        return (dem_wall_def){
            .kind = DEM_WALL_CONE, .point = point, .normal = axis, .radius = 0.5, .end_radius = 0.5, .length = 0.4};
    case 2:
        return (dem_wall_def){.kind = DEM_WALL_CONE, .point = point, .normal = axis, .radius = 0.6, .end_radius = 0.2};
    case 3:
        return (dem_wall_def){.kind = DEM_WALL_DISC, .point = point, .normal = axis, .radius = 0.6};
    case 4:
        return (dem_wall_def){.kind = DEM_WALL_SPHERE, .point = point, .radius = 0.6, .outside = true};
    case 5:
        return (dem_wall_def){
            .kind = DEM_WALL_RECTANGLE, .point = point, .normal = axis, .along = {1, 0, 0}, .size = {1, 0.5}};
    case 6:
        return (dem_wall_def){
            .kind = DEM_WALL_CONE, .point = point, .normal = axis, .length = INFINITY, .angle = 0.5, .outside = true};
    default:
        return (dem_wall_def){.kind = DEM_WALL_CONE, .point = point, .normal = axis, .length = INFINITY, .angle = 0.5};
    }
}
enum { FORMS = 8 };

// a point of the surface for two numbers from 0 to 1
static dem_vec3 sample(const dem_surface *s, double a, double b)
{
    dem_vec3 u = v3_normal_to(s->axis), v = v3_cross(s->axis, u);
    dem_vec3 out = v3_add(v3_scale(u, cos(2 * DEM_PI * b)), v3_scale(v, sin(2 * DEM_PI * b)));
    if (s->kind == DEM_SURFACE_RECTANGLE)
        return v3_along(v3_along(s->point, (2 * a - 1) * s->half[0], s->along), (2 * b - 1) * s->half[1],
                        v3_cross(s->axis, s->along));
    if (s->kind == DEM_SURFACE_SPHERE)
        return v3_along(v3_along(s->point, s->begin * cos(DEM_PI * a), s->axis), s->begin * sin(DEM_PI * a), out);
    double t = s->endless ? 3 * a : a;
    return v3_along(v3_along(s->point, t * s->run[1], s->axis), s->begin + t * s->run[0], out);
}

static void no_point_of_a_surface_is_nearer_than_the_closest(void **state)
{
    (void)state;
    enum { GRID = 150 };
    dem_random r = random_stream(3, 1);
    for (int which = 0; which < FORMS; which++) {
        dem_wall_def wall = form(which);
        dem_surface s = dem_surface_of(&wall);
        for (int k = 0; k < 40; k++) {
            dem_vec3 x = random_in(&r, v3(-1, -1, -1), v3(1, 1, 1));
            double least = INFINITY;
            for (int i = 0; i <= GRID; i++)
                for (int j = 0; j <= GRID; j++)
                    least = fmin(least, v3_distance(x, sample(&s, (double)i / GRID, (double)j / GRID)));
            dem_mesh_contact c[DEM_SURFACE_CONTACTS];
            check(dem_surface_contacts(&s, x, INFINITY, c) >= 1);
            double distance = fabs(c[0].distance), spacing = 5.0 / GRID;
            // samples are half a spacing off at most, which counts in second order but at the very surface
            check(distance <= least + 1e-12 && least <= sqrt(distance * distance + spacing * spacing));
            check_near(v3_norm(c[0].offset), distance, 1e-14);
            check_vec(c[0].point, v3_add(x, c[0].offset), 1e-15);
            check_vec(v3_scale(c[0].normal, -c[0].distance), c[0].offset, 1e-14);
            check_near(dem_surface_distance(&s, x), c[0].distance, 0);
        }
    }
}

// on the wrong side of a cone without an end and of a sphere it is negative, and the normal leads back
static void one_sided_surfaces_drive_back(void **state)
{
    (void)state;
    dem_wall_def wall = {.kind = DEM_WALL_CONE, .normal = {0, 0, 1}, .length = INFINITY, .angle = DEM_PI / 4};
    dem_surface s = dem_surface_of(&wall);
    check_near(dem_surface_distance(&s, v3(0.5, 0, 1)), 0.5 * sqrt(0.5), 1e-15);
    check_near(dem_surface_distance(&s, v3(0, 1.1, 1)), -0.1 * sqrt(0.5), 1e-15);
    check_near(dem_surface_distance(&s, v3(0, 0, -0.2)), -0.2, 1e-15);
    dem_mesh_contact c[2];
    check(dem_surface_contacts(&s, v3(0, 1.1, 1), 0.3, c) == 1);
    check_vec(c[0].normal, v3(0, -sqrt(0.5), sqrt(0.5)), 1e-14);
    wall.outside = true;
    s = dem_surface_of(&wall);
    check_near(dem_surface_distance(&s, v3(0.5, 0, 1)), -0.5 * sqrt(0.5), 1e-15);
    check_near(dem_surface_distance(&s, v3(0, 0, -0.2)), 0.2, 1e-15);
    wall = (dem_wall_def){.kind = DEM_WALL_SPHERE, .normal = {0, 0, 1}, .radius = 2};
    s = dem_surface_of(&wall);
    check_near(dem_surface_distance(&s, v3(0, 0, 2.5)), -0.5, 1e-15);
    check(dem_surface_contacts(&s, v3(0, 0, 2.5), 1, c) == 1);
    check_vec(c[0].normal, v3(0, 0, -1), 1e-15);
}

// a ball in a funnel touches on two sides, on a rim too, outside of it once
static void a_ball_in_a_funnel_touches_twice(void **state)
{
    (void)state;
    dem_wall_def wall = {.kind = DEM_WALL_CONE, .normal = {0, 0, 1}, .radius = 0.1, .end_radius = 1.1, .length = 1};
    dem_surface s = dem_surface_of(&wall);
    dem_mesh_contact c[2];
    dem_vec3 x = v3(0.01, 0, 0.5);
    check(dem_surface_contacts(&s, x, 0.5, c) == 2);
    check_near(c[0].distance, (0.6 - 0.01) * sqrt(0.5), 1e-15);
    check_near(c[1].distance, (0.6 + 0.01) * sqrt(0.5), 1e-15);
    check_vec(c[1].normal, v3(sqrt(0.5), 0, sqrt(0.5)), 1e-15);
    check(dem_surface_contacts(&s, v3(0.8, 0, 0.2), 2, c) == 1);
    check(dem_surface_contacts(&s, v3(0, 0, -0.1), 0.2, c) == 2);
    check_near(c[0].distance, 0.1 * sqrt(2), 1e-15);
    check(dem_surface_contacts(&s, v3(0, 0, -0.1), 0.14, c) == 0);
}

// ---- motion on them

static model *rolling(void)
{
    model *m = model_new();
    m->laws[0].friction = DEM_FRICTION_LINEAR;
    m->laws[0].friction_coefficient = 0.4;
    m->laws[0].stiffness_ratio = 0.5;
    m->laws[0].damping = DEM_DAMPING_RESTITUTION;
    m->laws[0].restitution = 0.5;
    m->scene.gravity = v3(0, 0, -9.81);
    model_body(m, model_sphere(m, 0.01), v3(-0.05, 0.01, 0.0105))->velocity = v3(0.5, 0.1, 0);
    return m;
}

static dem_vec3 end_of(const model *m, uint64_t steps)
{
    dem_world *w = model_world(m, 1);
    double most = 0;
    for (int i = 0; i < 10; i++) {
        run_steps(w, steps / 10);
        most = largest(most, measured(w)->energy.error);
    }
    check(most < 1e-3);
    dem_vec3 x = position_now(w, 0);
    dem_world_destroy(w);
    return x;
}

// a disc and a rectangle are planes, a straight cone is a cylinder, a sphere of a kilometre is a plane
static void surfaces_come_near_to_planes_and_cylinders(void **state)
{
    (void)state;
    const dem_wall_def plane = {.kind = DEM_WALL_PLANE, .normal = {0, 0, 1}};
    const dem_wall_def flat[] = {
        {.kind = DEM_WALL_DISC, .normal = {0, 0, 1}, .radius = 1},
        {.kind = DEM_WALL_RECTANGLE, .normal = {0, 0, 1}, .along = {1, 1, 0}, .size = {1, 1}},
        {.kind = DEM_WALL_CONE, .normal = {0, 0, 1}, .radius = 0, .end_radius = 1},
        {.kind = DEM_WALL_SPHERE, .point = {0, 0, 1e5}, .radius = 1e5},
        {.kind = DEM_WALL_SPHERE, .point = {0, 0, -1e5}, .radius = 1e5, .outside = true},
    };
    model *m = rolling();
    m->scene.wall_count = 1;
    m->walls[0] = plane;
    dem_vec3 want = end_of(m, 20000);
    check(want.x > 0.02);
    for (int i = 0; i < 5; i++) {
        m->walls[0] = flat[i];
        check_vec(end_of(m, 20000), want, i < 3 ? 1e-10 : 1e-7);
    }
    m->walls[0] = (dem_wall_def){.kind = DEM_WALL_CYLINDER, .normal = {1, 0, 0}, .point = {0, 0, 0.1}, .radius = 0.1};
    m->bodies[0].position = v3(-0.05, 0.02, 0.013);
    want = end_of(m, 20000);
    m->walls[0] = (dem_wall_def){.kind = DEM_WALL_CONE,
                                 .normal = {1, 0, 0},
                                 .point = {-1, 0, 0.1},
                                 .radius = 0.1,
                                 .end_radius = 0.1,
                                 .length = 2};
    check_vec(end_of(m, 20000), want, 1e-9);
    model_free(m);
}

// balls and clumps among all forms, some of which turn and shake: what is listed is what touches
static void nothing_is_missed_among_surfaces(void **state)
{
    (void)state;
    model *m = model_new();
    m->laws[0].friction = DEM_FRICTION_LINEAR;
    m->laws[0].friction_coefficient = 0.3;
    m->laws[0].stiffness_ratio = 0.3;
    m->laws[0].stiffness = 1e5;
    model_sphere(m, 0.05);
    model_cloud(m, 6, 0.15, 3);
    model_lattice(m, 125, 0.4, 3, 7);
    for (size_t i = 0; i < 125; i++)
        m->bodies[i].position = v3_sub(m->bodies[i].position, v3(1, 1, 1));
    for (int i = 0; i < 6; i++)
        m->walls[i] = form(i);
    m->walls[6] = (dem_wall_def){.kind = DEM_WALL_SPHERE, .radius = 2, .normal = {0, 0, 1}};
    m->scene.wall_count = 7;
    m->walls[0].spin = v3(3, 0, 0);
    m->walls[5].oscillations = (dem_oscillation[]){{.shift = {0.1, 0, 0.1}, .frequency = 20}};
    m->walls[5].oscillation_count = 1;
    m->scene.time.step = 2e-5;
    dem_world *w = model_world(m, 1);
    size_t touches = 0;
    for (int i = 0; i < 40; i++) {
        run_steps(w, 100);
        measured(w);
        size_t listed = 0, true_ones = 0, count;
        const dem_contact *c = dem_world_contacts(w, &count);
        for (size_t k = 0; k < count; k++)
            listed += c[k].wall != UINT32_MAX;
        for (size_t row = 0; row < w->bodies.count; row++) {
            const dem_template *t = &w->templates.items[w->bodies.shape[row]];
            for (size_t k = t->first; k < t->first + t->count; k++)
                for (size_t wall = 0; wall < 7; wall++) {
                    const double *s = w->templates.spheres[k];
                    dem_vec3 x = v3_add(body_position(&w->bodies, row),
                                        quat_rotate(body_orientation(&w->bodies, row), v3(s[0], s[1], s[2])));
                    dem_mesh_contact found[2];
                    true_ones += (size_t)dem_surface_contacts(&w->walls.items[wall].surface,
                                                              wall_from_space(&w->walls.items[wall], x), s[3], found);
                }
        }
        check(listed == true_ones);
        touches += listed;
    }
    check(touches > 500);
    dem_world_destroy(w);
    model_free(m);
}

// a hopper in which a turning cone drum stands: the same bits when it is taken up again
static void a_run_goes_on_bit_for_bit(void **state)
{
    (void)state;
    model *m = rolling();
    m->scene.wall_count = 1;
    m->walls[0] = (dem_wall_def){.kind = DEM_WALL_CONE,
                                 .normal = {0, 0, 1},
                                 .point = {0, 0, -0.05},
                                 .radius = 0.005,
                                 .end_radius = 0.3,
                                 .length = 0.2,
                                 .spin = {0, 0, 5}};
    dem_world *w = model_world(m, 1);
    check(!w->walls.sweep && w->walls.move);
    run_steps(w, 20000);
    dem_world *other = model_resumed(m, w, 1);
    run_steps(w, 5000);
    run_steps(other, 5000);
    check(dem_world_hash(w) == dem_world_hash(other));
    check(measured(w)->wall_contacts > 0);
    dem_world_destroy(w);
    dem_world_destroy(other);
    model_free(m);
}

static void surfaces_are_read_and_written(void **state)
{
    (void)state;
    dem_scene s = scene_of(
        "{" SCENE_HEAD ",\n 'walls': {'a': {'material': 'rock', 'cone': {'apex': [1, 2, 3], 'axis': [0, 0, 2],"
        "'angle': '30 deg', 'side': 'outside'}}, 'b': {'material': 'rock', 'cone': {'point': [1, 2, 3],"
        "'axis': [0, 0, 2], 'radii': [1, 0], 'length': 3}}, 'c': {'material': 'rock', 'sphere': {'centre': [1, 2, 3],"
        "'radius': 4}}, 'd': {'material': 'rock', 'plane': {'point': [1, 2, 3], 'normal': [0, 0, 1], 'radius': 2}},"
        "'e': {'material': 'rock', 'plane': {'point': [1, 2, 3], 'normal': [0, 0, 1], 'size': [2, 3]}}}}");
    for (int again = 0; again < 2; again++) {
        const dem_wall_def *w = s.walls;
        check(w[0].kind == DEM_WALL_CONE && isinf(w[0].length) && w[0].outside && w[0].point.y == 2);
        check_near(w[0].angle, DEM_PI / 6, 1e-16);
        check(w[1].kind == DEM_WALL_CONE && w[1].radius == 1 && w[1].end_radius == 0 && w[1].length == 3);
        check(w[2].kind == DEM_WALL_SPHERE && w[2].radius == 4 && !w[2].outside);
        check(w[3].kind == DEM_WALL_DISC && w[3].radius == 2);
        check(w[4].kind == DEM_WALL_RECTANGLE && w[4].size[0] == 2 && w[4].size[1] == 3 && v3_norm(w[4].along) == 1);
        char *text;
        dem_error error;
        check_ok(dem_scene_resolved(&s, &text, &error), error);
        dem_scene_release(&s);
        check_ok(dem_scene_read_text(NULL, text, strlen(text), "again", NULL, NULL, &s, &error), error);
        free(text);
    }
    dem_scene_release(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(no_point_of_a_surface_is_nearer_than_the_closest),
        cmocka_unit_test(one_sided_surfaces_drive_back),
        cmocka_unit_test(a_ball_in_a_funnel_touches_twice),
        cmocka_unit_test(surfaces_come_near_to_planes_and_cylinders),
        cmocka_unit_test(nothing_is_missed_among_surfaces),
        cmocka_unit_test(a_run_goes_on_bit_for_bit),
        cmocka_unit_test(surfaces_are_read_and_written),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
