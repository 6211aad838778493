#include "check.h"

#include "base/text.h"
#include "mesh/read.h"

static const char *const cube =
    "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n"
    "f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";

static dem_status read_as(const char *name, const void *bytes, size_t size, dem_mesh *mesh, dem_error *error)
{
    dem_buffer buffer = {0};
    dem_buffer_bytes(&buffer, bytes, size);
    dem_mesh_format format = dem_mesh_sniff(name, buffer.data, buffer.size);
    if (format != DEM_FORMAT_UNKNOWN)
        return dem_mesh_read_bytes(NULL, name, format, &buffer, mesh, error);
    dem_status status = dem_mesh_refuse(name, buffer.data, buffer.size, "STL", error);
    dem_buffer_release(&buffer);
    return status;
}

static void a_cube_is_read_from_obj(void **state)
{
    (void)state;
    dem_mesh mesh;
    dem_error error;
    check_ok(read_as("cube.obj", cube, strlen(cube), &mesh, &error), error);
    check(mesh.vertex_count == 8 && mesh.triangle_count == 12);
    dem_mesh_free(&mesh);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_cube_is_read_from_obj),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
