#include "shapes.h"

#include "base/random.h"
#include "geom/tree.h"
#include "geom/triangle.h"
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

// ---- what is near

static dem_vec3 random_point(dem_random *r)
{
    double x = random_uniform(r), y = random_uniform(r), z = random_uniform(r);
    return v3(2 * x - 1, 2 * y - 1, 2 * z - 1);
}

// loose triangles in a cube of edge 2, longest edges up to `length`, squeezed to `width` of it
static dem_mesh loose_triangles(size_t count, double length, double width, uint64_t seed)
{
    dem_mesh mesh = {.vertex_count = 3 * count, .triangle_count = count};
    mesh.vertices = malloc(mesh.vertex_count * sizeof *mesh.vertices);
    mesh.triangles = malloc(3 * count * sizeof *mesh.triangles);
    check(mesh.vertices && mesh.triangles);
    dem_random r = random_stream(seed, 0);
    for (size_t i = 0; i < count; i++) {
        dem_vec3 *v = &mesh.vertices[3 * i], along = v3_scale(random_point(&r), 0.5 * length);
        v[0] = random_point(&r);
        v[1] = v3_add(v[0], along);
        v[2] = v3_along(v3_along(v[0], random_uniform(&r), along), width * length, random_point(&r));
        for (size_t k = 0; k < 3; k++)
            mesh.triangles[3 * i + k] = (uint32_t)(3 * i + k);
    }
    return mesh;
}

static double distance_to(const dem_mesh *mesh, size_t triangle, dem_vec3 p)
{
    const dem_vec3 *v = mesh->vertices;
    const uint32_t *c = &mesh->triangles[3 * triangle];
    dem_triangle t;
    check(triangle_prepare(v[c[0]], v[c[1]], v[c[2]], &t));
    return sqrt(triangle_closest(&t, p).distance2);
}

static dem_box box_around(const dem_mesh *mesh)
{
    dem_box box = box_empty();
    for (size_t i = 0; i < mesh->vertex_count; i++)
        box = box_with(box, mesh->vertices[i]);
    return box;
}

static int compare_numbers(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

// Asks around and about the mesh with radii that just reach one of the 20 nearest triangles, or any. None may be
// missing; of those beyond the radius there may be some, for the tracer looks at boxes. Returns how many, on average.
static double ask_what_is_near(const dem_mesh *mesh, dem_vec3 origin, double scale, int questions, double spread)
{
    dem_ray_scene *scene = new_scene();
    dem_error error;
    check_ok(dem_ray_add_mesh(scene, mesh->vertices, mesh->vertex_count, mesh->triangles, mesh->triangle_count, origin,
                              scale, &error),
             error);
    dem_box box = box_around(mesh);
    dem_vec3 middle = v3_scale(v3_add(box.low, box.high), 0.5);
    dem_ray_list list = {0};
    dem_random r = random_stream(3, 1);
    size_t n = mesh->triangle_count, extra = 0;
    double *distances = malloc(n * sizeof *distances), *sorted = malloc(n * sizeof *sorted);
    unsigned char *listed = malloc(n);
    check(distances && sorted && listed);
    for (int q = 0; q < questions; q++) {
        dem_vec3 p = v3_along(middle, spread * box_diagonal(box), random_point(&r));
        for (size_t i = 0; i < n; i++)
            distances[i] = distance_to(mesh, i, p);
        memcpy(sorted, distances, n * sizeof *sorted);
        qsort(sorted, n, sizeof *sorted, compare_numbers);
        double radius = sorted[random_below(&r, q % 4 ? 20 : n)];
        check(dem_ray_near(scene, 0, p, radius, &list));
        memset(listed, 0, n);
        for (size_t i = 0; i < list.count; i++) {
            check(list.items[i] < n && !listed[list.items[i]]);
            listed[list.items[i]] = 1;
        }
        for (size_t i = 0; i < n; i++) {
            check(listed[i] || !(distances[i] <= radius));
            extra += listed[i] && distances[i] > radius;
        }
    }
    free(list.items);
    free(distances);
    free(sorted);
    free(listed);
    dem_ray_destroy(scene);
    return (double)extra / questions;
}

static double ask_in_its_frame(const dem_mesh *mesh, int questions, double spread)
{
    dem_box box = box_around(mesh);
    return ask_what_is_near(mesh, v3_scale(v3_add(box.low, box.high), 0.5), 1 / box_diagonal(box), questions, spread);
}

// brute force judges; how many may be listed beyond need is what was seen and half as many again
static void no_triangle_near_a_point_is_missed(void **state)
{
    (void)state;
    dem_mesh grain = shape_grain(12), soup = loose_triangles(1000, 0.3, 1, 1),
             slivers = loose_triangles(1000, 2, 1e-6, 2);
    check(ask_in_its_frame(&grain, 400, 0.5) < 150);
    check(ask_in_its_frame(&soup, 400, 0.5) < 150);
    check(ask_in_its_frame(&slivers, 400, 0.5) < 260);
    // from far away, where the point has no digits left beside the mesh
    for (double spread = 10; spread < 1e13; spread *= 100)
        ask_in_its_frame(&soup, 50, spread);
    dem_mesh_free(&grain);
    dem_mesh_free(&soup);
    dem_mesh_free(&slivers);
}

static void no_triangle_is_missed_whatever_size_and_place_a_mesh_has(void **state)
{
    (void)state;
    static const double sizes[] = {1e-12, 1e-6, 1, 1e6};
    for (int i = 0; i < 4; i++) {
        dem_mesh mesh = loose_triangles(500, 0.3, 1, 5), flat = loose_triangles(500, 0.3, 1, 6);
        shape_scale(&mesh, sizes[i], sizes[i], sizes[i]);
        shape_scale(&flat, sizes[i], sizes[i], 0);
        check(ask_in_its_frame(&mesh, 100, 0.5) < 100);
        check(ask_in_its_frame(&flat, 100, 0.5) < 100);
        dem_mesh_free(&mesh);
        dem_mesh_free(&flat);
    }
    // a thousand kilometres away: a frame at the mesh keeps it sharp, one at 0 lists more, but all
    dem_mesh far = loose_triangles(500, 0.3, 1, 7);
    shape_move(&far, (dem_quat){1, 0, 0, 0}, v3(1e6, -2e6, 3e6));
    check(ask_in_its_frame(&far, 100, 0.5) < 100);
    ask_what_is_near(&far, v3(0, 0, 0), 1, 100, 0.5);
    ask_what_is_near(&far, v3(0, 0, 0), 1e-7, 100, 0.5);
    dem_mesh_free(&far);
}

// one triangle square to an axis, and a point above it: no box is larger than it has to be, so nothing forgives
// rounding
static void a_radius_that_just_reaches_is_enough(void **state)
{
    (void)state;
    dem_ray_list list = {0};
    dem_random r = random_stream(8, 0);
    dem_ray_scene *scene = new_scene();
    for (uint32_t i = 0; i < 3000; i++) {
        dem_vec3 origin = random_point(&r), v[3] = {random_point(&r), random_point(&r), random_point(&r)};
        int axis = (int)(i % 3);
        double size = pow(10, 12 * random_uniform(&r) - 6), height = pow(10, 16 * random_uniform(&r) - 3);
        v3_set(&v[1], axis, v3_get(v[0], axis));
        v3_set(&v[2], axis, v3_get(v[0], axis));
        for (int k = 0; k < 3; k++)
            v[k] = v3_scale(v[k], size);
        dem_vec3 p = v3_scale(v3_add(v3_add(v[0], v[1]), v[2]), 1.0 / 3);
        v3_set(&p, axis, v3_get(v[0], axis) + (i % 2 ? -height : height) * size);
        double radius = nextafter(fabs(v3_get(p, axis) - v3_get(v[0], axis)), INFINITY);
        dem_error error;
        check_ok(dem_ray_add_mesh(scene, v, 3, (uint32_t[]){0, 1, 2}, 1, v3_scale(origin, size), 0.3 / size, &error),
                 error);
        check(dem_ray_near(scene, i, p, radius, &list) && list.count == 1);
        // and what is clearly beyond the radius of so sharp a box is not listed
        check(dem_ray_near(scene, i, p, radius * (1 - 1e-6) - 1e-6 * size, &list) && list.count == 0);
    }
    free(list.items);
    dem_ray_destroy(scene);
}

static void strange_questions_have_answers(void **state)
{
    (void)state;
    dem_ray_scene *scene = new_scene();
    dem_mesh box = shape_box(1, 1, 1);
    dem_ray_list list = {0};
    dem_error error;
    check_ok(dem_ray_add_mesh(scene, box.vertices, box.vertex_count, box.triangles, box.triangle_count,
                              v3(0.5, 0.5, 0.5), 0.5, &error),
             error);
    check(dem_ray_near(scene, 0, v3(0.5, 0.5, 0.5), INFINITY, &list) && list.count == 12);
    check(dem_ray_near(scene, 0, v3(1e30, 0, 0), 1e31, &list) && list.count == 12);
    check(dem_ray_near(scene, 0, v3(1e30, 0, 0), 1e29, &list) && list.count == 0);
    check(dem_ray_near(scene, 0, v3(NAN, 0, 0), 1, &list) && list.count == 0);
    check(dem_ray_near(scene, 0, v3(0, 0, 0), NAN, &list) && list.count == 0);
    check(dem_ray_near(scene, 0, v3(2, 0, 0), -1, &list) && list.count == 0);
    check(dem_ray_near(scene, 0, v3(1, 0.3, 0.4), 0, &list) && list.count >= 1);
    free(list.items);
    dem_mesh_free(&box);
    dem_ray_destroy(scene);
}

// of the numbers, whatever their order
static uint64_t digest(const dem_ray_list *list)
{
    uint64_t sum = list->count;
    for (size_t i = 0; i < list->count; i++)
        sum += random_mix(list->items[i]);
    return sum;
}

static void threads_may_ask_at_once(void **state)
{
    (void)state;
    enum { QUESTIONS = 20000 };
    static uint64_t alone[QUESTIONS], together[QUESTIONS];
    dem_ray_scene *scene = new_scene();
    dem_mesh grain = shape_grain(12);
    dem_error error;
    int failed = 0;
    check_ok(dem_ray_add_mesh(scene, grain.vertices, grain.vertex_count, grain.triangles, grain.triangle_count,
                              v3(0, 0, 0), 0.5, &error),
             error);
    for (int threads = 1; threads <= 4; threads += 3) {
        uint64_t *digests = threads == 1 ? alone : together;
#pragma omp parallel num_threads(threads) reduction(+ : failed)
        {
            dem_ray_list list = {0};
#pragma omp for
            for (int q = 0; q < QUESTIONS; q++) {
                dem_random r = random_stream(9, (uint64_t)q);
                failed += !dem_ray_near(scene, 0, random_point(&r), 0.3, &list);
                digests[q] = digest(&list);
            }
            free(list.items);
        }
    }
    check(failed == 0 && memcmp(alone, together, sizeof alone) == 0);
    dem_mesh_free(&grain);
    dem_ray_destroy(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(without_embree_there_are_no_rays),
        cmocka_unit_test(a_ray_meets_the_nearer_ball),
        cmocka_unit_test(rays_meet_a_mesh_where_the_tree_says),
        cmocka_unit_test(instances_stand_where_their_pose_puts_them),
        cmocka_unit_test(no_triangle_near_a_point_is_missed),
        cmocka_unit_test(no_triangle_is_missed_whatever_size_and_place_a_mesh_has),
        cmocka_unit_test(a_radius_that_just_reaches_is_enough),
        cmocka_unit_test(strange_questions_have_answers),
        cmocka_unit_test(threads_may_ask_at_once),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
