#include "shapes.h"

#include "out/creases.h"

// the same triangles with corners of their own
static dem_mesh apart(const dem_mesh *mesh)
{
    size_t corners = 3 * mesh->triangle_count;
    dem_vec3 *points = malloc(corners * sizeof *points);
    uint32_t *list = malloc(corners * sizeof *list);
    check(points && list);
    for (size_t i = 0; i < corners; i++) {
        points[i] = mesh->vertices[mesh->triangles[i]];
        list[i] = (uint32_t)i;
    }
    dem_mesh soup = shape_copy(points, corners, list, mesh->triangle_count);
    free(points);
    free(list);
    return soup;
}

static void the_edges_of_a_box_are_creases_and_its_diagonals_are_not(void **state)
{
    (void)state;
    dem_mesh box = shape_box(1, 2, 3), soup = apart(&box);
    const dem_mesh *meshes[] = {&box, &soup};
    for (int i = 0; i < 2; i++) {
        const dem_mesh *m = meshes[i];
        unsigned char *creases = dem_mesh_creases(m);
        for (size_t t = 0; t < 12; t++)
            for (size_t k = 0; k < 3; k++) {
                dem_vec3 along = v3_sub(m->vertices[m->triangles[3 * t + (k + 1) % 3]],
                                        m->vertices[m->triangles[3 * t + (k + 2) % 3]]);
                int axes = (along.x != 0) + (along.y != 0) + (along.z != 0);
                check((creases[t] >> k & 1) == (axes == 1));
            }
        free(creases);
    }
    dem_mesh_free(&box);
    dem_mesh_free(&soup);
}

static void smooth_surfaces_have_none_and_borders_are(void **state)
{
    (void)state;
    dem_mesh sphere = shape_sphere(8), soup = apart(&sphere);  // facets of 11 degrees
    unsigned char *creases = dem_mesh_creases(&soup);
    for (size_t t = 0; t < soup.triangle_count; t++)
        check(creases[t] == 0);
    free(creases);
    // without one triangle, its three edges are at the border
    soup.triangle_count--;
    creases = dem_mesh_creases(&soup);
    int count = 0;
    for (size_t t = 0; t < soup.triangle_count; t++)
        for (int k = 0; k < 3; k++)
            count += creases[t] >> k & 1;
    check(count == 3);
    free(creases);
    dem_mesh_free(&sphere);
    dem_mesh_free(&soup);
    dem_mesh nothing = {0};
    creases = dem_mesh_creases(&nothing);
    check(creases != NULL);
    free(creases);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_edges_of_a_box_are_creases_and_its_diagonals_are_not),
        cmocka_unit_test(smooth_surfaces_have_none_and_borders_are),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
