#include "check.h"

#include "base/memory.h"
#include "base/random.h"
#include "mesh/crossings.h"
#include "mesh/edges.h"
#include "mesh/labels.h"
#include "mesh/mass.h"

typedef uint32_t label_at(dem_vec3 p, const double *shape);

// labels of the voxel centres 0, 1, 2, ... along each axis
static dem_volume image_of(size_t nx, size_t ny, size_t nz, label_at *at, const double *shape)
{
    dem_volume v = {.size = {nx, ny, nz}, .width = 2, .axes = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    uint16_t *labels = v.labels = dem_alloc(nx * ny * nz, sizeof *labels);
    assert_non_null(labels);
    for (size_t i = 0; i < nx * ny * nz; i++)
        labels[i] = (uint16_t)at((dem_vec3){(double)(i % nx), (double)(i / nx % ny), (double)(i / nx / ny)}, shape);
    return v;
}

static void set(dem_volume *v, size_t x, size_t y, size_t z, uint16_t label)
{
    ((uint16_t *)v->labels)[(z * v->size[1] + y) * v->size[0] + x] = label;
}

static uint32_t nothing(dem_vec3 p, const double *shape)
{
    (void)p, (void)shape;
    return 0;
}

// {centre, half axes}
static double ellipsoid_level(dem_vec3 p, const double *e)
{
    dem_vec3 q = {(p.x - e[0]) / e[3], (p.y - e[1]) / e[4], (p.z - e[2]) / e[5]};
    return v3_norm(q);
}

static uint32_t in_ellipsoid(dem_vec3 p, const double *shape)
{
    return ellipsoid_level(p, shape) <= 1 ? 7 : 0;
}

static dem_label only_label(const dem_volume *v)
{
    dem_label *labels, label;
    size_t count;
    dem_error error;
    check_ok(dem_labels_find(NULL, v, &labels, &count, &error), error);
    assert_int_equal(count, 1);
    label = labels[0];
    free(labels);
    return label;
}

// closed, every edge of two triangles that run against each other, one fan about every vertex
static void check_manifold(const dem_mesh *mesh)
{
    dem_edges edges = {0};
    dem_error error;
    check_ok(dem_edges_build(&edges, mesh, &error), error);
    assert_int_equal(edges.border, 0);
    assert_int_equal(edges.many, 0);
    assert_int_equal(edges.duplicates, 0);
    uint32_t *half = dem_alloc(mesh->vertex_count, sizeof *half),
             *about = dem_alloc_zero(mesh->vertex_count, sizeof *about);
    for (uint32_t h = 0; h < 3 * mesh->triangle_count; h++) {
        check(half_start(mesh, h) == half_end(mesh, edges.twin[h]));
        half[half_start(mesh, h)] = h;
        about[half_start(mesh, h)]++;
    }
    for (size_t v = 0; v < mesh->vertex_count; v++) {
        check(about[v] >= 3);
        uint32_t h = half[v], fan = 0;
        do {
            fan++;
            h = edges.twin[half_before(h)];
        } while (h != half[v]);
        check(fan == about[v]);
    }
    free(half);
    free(about);
    dem_edges_release(&edges);
}

static size_t crossings(const dem_mesh *mesh)
{
    dem_tree tree;
    dem_error error;
    dem_crossings found;
    check_ok(dem_tree_build(&tree, mesh->vertices, mesh->triangles, mesh->triangle_count, &error), error);
    check_ok(dem_mesh_crossings(NULL, mesh, &tree, SIZE_MAX, &found, &error), error);
    size_t count = found.count;
    free(found.pairs);
    dem_tree_release(&tree);
    return count;
}

static dem_mesh surface_of(const dem_volume *v, dem_label label, dem_keep keep)
{
    dem_mesh mesh;
    dem_error error;
    check_ok(dem_label_surface(NULL, v, &label, keep, &mesh, &error), error);
    check_manifold(&mesh);
    return mesh;
}

// closest distance of a point to an ellipsoid, to first order, which at these distances is good to a few percent
static double off_ellipsoid(dem_vec3 p, const double *e)
{
    dem_vec3 q = {(p.x - e[0]) / e[3], (p.y - e[1]) / e[4], (p.z - e[2]) / e[5]};
    dem_vec3 slope = {q.x / e[3], q.y / e[4], q.z / e[5]};
    return fabs(v3_norm2(q) - 1) / (2 * v3_norm(slope));
}

static void voxels_of_ellipsoids_give_ellipsoids(void **state)
{
    (void)state;
    // the last ones are flat and long
    static const double shapes[][6] = {{5, 5, 5, 5, 5, 5},           {5.3, 5.4, 5.7, 5.2, 5.2, 5.2},
                                       {10.2, 10.4, 10, 10, 10, 10}, {30, 30, 30, 30, 30, 30},
                                       {30.3, 15, 12, 30, 15, 9},    {22, 12, 8, 21, 10, 7}};
    for (size_t i = 0; i < sizeof shapes / sizeof *shapes; i++) {
        const double *e = shapes[i];
        dem_volume v =
            image_of((size_t)(2 * e[0]) + 2, (size_t)(2 * e[1]) + 2, (size_t)(2 * e[2]) + 2, in_ellipsoid, e);
        dem_label label = only_label(&v);
        dem_mesh mesh = surface_of(&v, label, DEM_KEEP_ONE);
        dem_solid solid = dem_mesh_solid(&mesh);
        check_close(solid.volume, (double)label.voxels, 1e-4);
        assert_int_equal(crossings(&mesh), 0);
        double off = 0, mean = 0;
        for (size_t k = 0; k < mesh.vertex_count; k++) {
            double d = off_ellipsoid(mesh.vertices[k], e);
            off = fmax(off, d);
            mean += d / (double)mesh.vertex_count;
        }
        check(off < 0.6);
        check(mean < 0.12);
        if (e[3] == e[5])  // a ball: no stairs are left
            check_close(solid.area, 4 * 3.14159265358979 * e[3] * e[3], 0.015);
        dem_mesh_free(&mesh);
        dem_volume_free(&v);
    }
}

static uint32_t two_balls(dem_vec3 p, const double *shape)
{
    (void)shape;
    return v3_distance(p, (dem_vec3){9, 10, 10}) <= 8 ? 3 : v3_distance(p, (dem_vec3){25, 10, 10}) <= 8.5 ? 9 : 0;
}

static void touching_grains_have_surfaces_of_their_own(void **state)
{
    (void)state;
    dem_volume v = image_of(36, 21, 21, two_balls, NULL);
    dem_label *labels;
    size_t count;
    dem_error error;
    check_ok(dem_labels_find(NULL, &v, &labels, &count, &error), error);
    assert_int_equal(count, 2);
    assert_int_equal(labels[0].value, 3);
    assert_int_equal(labels[1].value, 9);
    for (size_t i = 0; i < 2; i++) {
        dem_mesh mesh = surface_of(&v, labels[i], DEM_KEEP_ONE);
        dem_solid solid = dem_mesh_solid(&mesh);
        check_close(solid.volume, (double)labels[i].voxels, 1e-4);
        check_vec(solid.centre, ((dem_vec3){i ? 25 : 9, 10, 10}), 0.1);
        assert_int_equal(crossings(&mesh), 0);
        dem_mesh_free(&mesh);
    }
    free(labels);
    dem_volume_free(&v);
}

static void grains_at_the_border_are_closed_and_told(void **state)
{
    (void)state;
    static const double e[6] = {2, 10, 10, 9, 9, 9};
    dem_volume v = image_of(20, 20, 20, in_ellipsoid, e);
    dem_label label = only_label(&v);
    check(label.border);
    dem_mesh mesh = surface_of(&v, label, DEM_KEEP_ONE);
    check_close(dem_mesh_solid(&mesh).volume, (double)label.voxels, 1e-4);
    dem_mesh_free(&mesh);
    dem_volume_free(&v);
    // one label fills the image
    static const double all[6] = {0, 0, 0, 1e9, 1e9, 1e9};
    v = image_of(12, 7, 9, in_ellipsoid, all);
    label = only_label(&v);
    assert_int_equal(label.voxels, 12 * 7 * 9);
    mesh = surface_of(&v, label, DEM_KEEP_ONE);
    check_close(dem_mesh_solid(&mesh).volume, 12 * 7 * 9, 1e-4);
    check_vec(dem_mesh_solid(&mesh).centre, ((dem_vec3){5.5, 3, 4}), 1e-2);
    dem_mesh_free(&mesh);
    dem_volume_free(&v);
}

static void cube(dem_volume *v, size_t low, size_t high, size_t y, size_t z)
{
    for (size_t i = low; i < high; i++)
        for (size_t j = low; j < high; j++)
            for (size_t k = low; k < high; k++)
                set(v, i, j + y, k + z, 7);
}

static void diagonal_contacts_are_no_joints(void **state)
{
    (void)state;
    for (int corner = 0; corner < 2; corner++) {
        // two cubes that share an edge, or a corner
        dem_volume v = image_of(16, 16, 16, nothing, NULL);
        cube(&v, 1, 5, 0, 0);
        for (size_t i = 5; i < 9; i++)
            for (size_t j = 5; j < 9; j++)
                for (size_t k = 1; k < 5; k++)
                    set(&v, i, j, corner ? k + 4 : k, 7);
        dem_label label = only_label(&v);
        dem_mesh mesh, *bodies;
        size_t count;
        dem_error error;
        check(dem_label_surface(NULL, &v, &label, DEM_KEEP_ONE, &mesh, &error) == DEM_BAD_INPUT);
        check(strstr(error.text, "--keep") != NULL && mesh.vertices == NULL);
        mesh = surface_of(&v, label, DEM_KEEP_ALL);
        check_close(dem_mesh_solid(&mesh).volume, 128, 1e-4);
        assert_int_equal(crossings(&mesh), 0);
        check_ok(dem_mesh_split(&mesh, &bodies, &count, &error), error);
        assert_int_equal(count, 2);
        for (size_t i = 0; i < count; i++)
            dem_mesh_free(&bodies[i]);
        free(bodies);
        dem_mesh_free(&mesh);
        dem_volume_free(&v);
    }
    // two towers on one plate that touch along an edge: the ring about both ends of the edge is one and the same
    dem_volume v = image_of(12, 12, 12, nothing, NULL);
    for (size_t i = 1; i < 11; i++)
        for (size_t j = 1; j < 11; j++)
            for (size_t k = 1; k < 11; k++)
                if (k < 4 || k > 4 || (i < 6) == (j < 6))
                    set(&v, i, j, k, 7);
    dem_mesh mesh = surface_of(&v, only_label(&v), DEM_KEEP_ONE);
    dem_mesh_free(&mesh);
    dem_volume_free(&v);
}

static void crumbs_are_dropped_and_larger_pieces_asked_about(void **state)
{
    (void)state;
    static const double e[6] = {10, 10, 10, 8, 8, 8};
    dem_volume v = image_of(30, 21, 21, in_ellipsoid, e);
    size_t whole = only_label(&v).voxels;
    set(&v, 25, 10, 10, 7);
    set(&v, 26, 11, 10, 7);
    dem_label label = only_label(&v);
    assert_int_equal(label.voxels, whole + 2);
    dem_mesh mesh;
    dem_error error;
    check_ok(dem_label_surface(NULL, &v, &label, DEM_KEEP_ONE, &mesh, &error), error);
    assert_int_equal(label.voxels, whole);
    check_close(dem_mesh_solid(&mesh).volume, (double)whole, 1e-4);
    dem_mesh_free(&mesh);
    dem_volume_free(&v);
}

// the surface of any voxels at all is two-manifold and has their volume: dice of every density
static void any_voxels_give_a_manifold(void **state)
{
    (void)state;
    for (uint64_t round = 0; round < (SLOW_BUILD ? 10 : 60); round++) {
        dem_volume v = image_of(9, 8, 7, nothing, NULL);
        dem_random random = random_stream(5, round);
        double density = 0.05 + 0.9 * random_uniform(&random);
        size_t inside = 1;
        for (size_t i = 0; i < 9 * 8 * 7; i++) {
            ((uint16_t *)v.labels)[i] = random_uniform(&random) < density ? 7 : 0;
            inside += ((uint16_t *)v.labels)[i] != 0;
        }
        inside -= ((uint16_t *)v.labels)[0] != 0;
        set(&v, 0, 0, 0, 7);
        dem_mesh mesh = surface_of(&v, only_label(&v), DEM_KEEP_ALL);
        check_close(dem_mesh_solid(&mesh).volume, (double)inside, 2e-4);
        dem_mesh_free(&mesh);
        dem_volume_free(&v);
    }
}

static void surfaces_lie_where_the_axes_say(void **state)
{
    (void)state;
    static const double e[6] = {8, 9, 10, 6, 6, 6};
    dem_volume v = image_of(20, 20, 20, in_ellipsoid, e);
    // voxels of 1 x 1 x 2, axes mirrored
    v.axes[0] = (dem_vec3){0, 1, 0};
    v.axes[1] = (dem_vec3){1, 0, 0};
    v.axes[2] = (dem_vec3){0, 0, 2};
    v.origin = (dem_vec3){100, 200, 300};
    dem_label label = only_label(&v);
    dem_mesh mesh = surface_of(&v, label, DEM_KEEP_ONE);
    dem_solid solid = dem_mesh_solid(&mesh);
    check_close(solid.volume, 2 * (double)label.voxels, 1e-4);
    check_vec(solid.centre, ((dem_vec3){109, 208, 320}), 1e-3);
    dem_mesh_free(&mesh);
    dem_volume_free(&v);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(voxels_of_ellipsoids_give_ellipsoids),
        cmocka_unit_test(touching_grains_have_surfaces_of_their_own),
        cmocka_unit_test(grains_at_the_border_are_closed_and_told),
        cmocka_unit_test(diagonal_contacts_are_no_joints),
        cmocka_unit_test(crumbs_are_dropped_and_larger_pieces_asked_about),
        cmocka_unit_test(any_voxels_give_a_manifold),
        cmocka_unit_test(surfaces_lie_where_the_axes_say),
    };
    return cmocka_run_group_tests_name("labels", tests, NULL, NULL);
}
