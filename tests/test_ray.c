#include "shapes.h"

#include "base/random.h"
#include "geom/tree.h"
#include "ray/ray.h"

static const dem_ray_pose PLAIN = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {0, 0, 0}};

static dem_ray_scene *new_scene(void)
{
    dem_ray_scene *scene;
    dem_error error;
    if (!DEM_EMBREE)
        skip();
    check_ok(dem_ray_create(&scene, &error), error);
    return scene;
}

static void without_embree_there_are_no_rays(void **state)
{
    (void)state;
    dem_ray_scene *scene;
    dem_error error = {0};
    if (DEM_EMBREE)
        skip();
    check(dem_ray_create(&scene, &error) == DEM_UNAVAILABLE);
    check(!scene && strstr(error.text, "Embree"));
    dem_ray_destroy(scene);
}

static void a_ray_meets_the_nearer_ball(void **state)
{
    (void)state;
    dem_ray_scene *scene = new_scene();
    const dem_ball balls[] = {{{0, 0, 0}, 1}, {{0, 0, 3}, 0.5}};
    dem_error error;
    check_ok(dem_ray_add_balls(scene, balls, 2, v3(0, 0, 0), 1, &error), error);
    check_ok(dem_ray_add_instance(scene, 0, &PLAIN, &error), error);
    check_ok(dem_ray_commit(scene, &error), error);
    dem_ray_hit hit;
    dem_ray down = {{0, 0, 10}, 0, {0, 0, -1}, INFINITY}, past = {{1.5f, 0, 10}, 0, {0, 0, -1}, INFINITY};
    check(dem_ray_closest(scene, &down, &hit));
    check(hit.primitive == 1 && hit.instance == 0);
    check_near((double)hit.distance, 6.5, 1e-6);
    check(dem_ray_occluded(scene, &down));
    check(!dem_ray_closest(scene, &past, &hit) && !dem_ray_occluded(scene, &past));
    down.far = 6;
    check(!dem_ray_occluded(scene, &down));
    dem_ray_destroy(scene);
}

// the tree's rays count crossings in double: a hit exists where the count of one side differs from none
static void rays_meet_a_mesh_where_the_tree_says(void **state)
{
    (void)state;
    dem_ray_scene *scene = new_scene();
    dem_mesh mesh = shape_grain(12);
    dem_tree tree;
    dem_error error;
    check_ok(dem_tree_build(&tree, mesh.vertices, mesh.triangles, mesh.triangle_count, &error), error);
    check_ok(dem_ray_add_mesh(scene, mesh.vertices, mesh.vertex_count, mesh.triangles, mesh.triangle_count, v3(0, 0, 0),
                              1, &error),
             error);
    check_ok(dem_ray_add_instance(scene, 0, &PLAIN, &error), error);
    check_ok(dem_ray_commit(scene, &error), error);
    dem_random r = random_stream(5, 0);
    for (int i = 0; i < 2000; i++) {
        double x = random_normal(&r), y = random_normal(&r), z = random_normal(&r);
        dem_vec3 d = v3_unit(v3(x, y, z));
        dem_ray ray = {{0, 0, 0}, 0, {(float)d.x, (float)d.y, (float)d.z}, INFINITY};
        dem_ray_hit hit;
        check(dem_ray_closest(scene, &ray, &hit));  // from the inside there is always a wall
        dem_vec3 p = v3_scale(d, (double)hit.distance), q;
        check_near(dem_tree_closest(&tree, p, INFINITY, &q, NULL), 0, 1e-6);
        // u and v are the weights of the second and third corner
        const uint32_t *t = &mesh.triangles[3 * (size_t)hit.primitive];
        dem_vec3 at = v3_scale(mesh.vertices[t[0]], 1 - (double)hit.u - (double)hit.v);
        at = v3_along(v3_along(at, (double)hit.u, mesh.vertices[t[1]]), (double)hit.v, mesh.vertices[t[2]]);
        check_vec(at, p, 2e-6);
    }
    dem_tree_release(&tree);
    dem_mesh_free(&mesh);
    dem_ray_destroy(scene);
}

static void instances_stand_where_their_pose_puts_them(void **state)
{
    (void)state;
    dem_ray_scene *scene = new_scene();
    // a ball of 1e-9 m, far away from its own origin, becomes a unit ball; then placed at (5, 0, 0) in double size
    const dem_ball ball = {{1e6, 2e6, 3e6}, 1e-3};
    const dem_mesh box = shape_box(1, 1, 1);
    dem_ray_pose pose = {{{0, 2, 0}, {-2, 0, 0}, {0, 0, 2}}, {5, 0, 0}};  // a quarter turn about z
    dem_error error;
    check_ok(dem_ray_add_balls(scene, &ball, 1, ball.centre, 1e3, &error), error);
    check_ok(dem_ray_add_mesh(scene, box.vertices, box.vertex_count, box.triangles, box.triangle_count, v3(0, 0, 0), 1,
                              &error),
             error);
    check_ok(dem_ray_add_instance(scene, 0, &pose, &error), error);
    pose.position[0] = -5;
    check_ok(dem_ray_add_instance(scene, 1, &pose, &error), error);
    check_ok(dem_ray_commit(scene, &error), error);
    dem_ray right = {{0, 0, 0}, 0, {1, 0, 0}, INFINITY}, down = {{-5.5f, 0.5f, 10}, 0, {0, 0, -1}, INFINITY};
    dem_ray_hit hit;
    check(dem_ray_closest(scene, &right, &hit) && hit.instance == 0);
    check_near((double)hit.distance, 3, 1e-5);
    // the box reaches from (-7, 0, 0) to (-5, 2, 2)
    check(dem_ray_closest(scene, &down, &hit) && hit.instance == 1);
    check_near((double)hit.distance, 8, 1e-5);
    down.origin[0] = -4.5f;
    check(!dem_ray_closest(scene, &down, &hit));
    dem_mesh_free((dem_mesh *)&box);
    dem_ray_destroy(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(without_embree_there_are_no_rays),
        cmocka_unit_test(a_ray_meets_the_nearer_ball),
        cmocka_unit_test(rays_meet_a_mesh_where_the_tree_says),
        cmocka_unit_test(instances_stand_where_their_pose_puts_them),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
