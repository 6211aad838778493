#include "check.h"

#include "base/file.h"
#include "mesh/write.h"

// a tetrahedron with coordinates that are not exact in decimals
static dem_vec3 vertices[] = {{0.1, -0.0, 1e-9}, {1.0 / 3, 0, 0}, {0, 2.0 / 3, 1e-3}, {0, 0, 1e6 / 7}};
static uint32_t triangles[] = {0, 2, 1, 0, 1, 3, 1, 2, 3, 0, 3, 2};
static const dem_mesh tetrahedron = {vertices, triangles, 4, 4, false};

static dem_buffer written(dem_mesh_format format, const char *comment, int digits)
{
    dem_buffer out = {0};
    dem_mesh_put(&tetrahedron, format, comment, digits, &out);
    check(!out.failed);
    return out;
}

static void the_suffix_decides_the_format(void **state)
{
    (void)state;
    dem_mesh_format format;
    check(dem_mesh_format_of("a.b/c.obj", &format) && format == DEM_MESH_OBJ);
    check(dem_mesh_format_of("X.STL", &format) && format == DEM_MESH_STL);
    check(dem_mesh_format_of("x.ply", &format) && format == DEM_MESH_PLY);
    check(dem_mesh_format_of("x.off", &format) && format == DEM_MESH_OFF);
    check(!dem_mesh_format_of("x.obj/y", &format));
    check(!dem_mesh_format_of("obj", &format));
    check(!dem_mesh_format_of("x.objx", &format));
}

// reads "lead a b c" lines with plain sscanf
static void check_lines(const char *text, const char *vertex_format, const char *face_format, uint32_t first)
{
    size_t vertex = 0, face = 0;
    for (const char *line = text; line && *line; line = strchr(line, '\n') ? strchr(line, '\n') + 1 : NULL) {
        dem_vec3 v;
        unsigned a, b, c;
        int used = 0;
        if (sscanf(line, face_format, &a, &b, &c, &used) == 3 && used) {
            check(face < 4);
            check(a == triangles[3 * face] + first && b == triangles[3 * face + 1] + first &&
                  c == triangles[3 * face + 2] + first);
            face++;
        } else if (sscanf(line, vertex_format, &v.x, &v.y, &v.z, &used) == 3) {
            check(vertex < 4);
            check(v.x == vertices[vertex].x && v.y == vertices[vertex].y && v.z == vertices[vertex].z);
            vertex++;
        }
    }
    check(vertex == 4 && face == 4);
}

static void obj_keeps_every_bit_and_counts_from_one(void **state)
{
    (void)state;
    dem_buffer out = written(DEM_MESH_OBJ, "made so", 17);
    check(strncmp(out.data, "# made so\nv ", 12) == 0);
    check(!strstr(out.data, " -0 "));
    check_lines(out.data, "v %lf %lf %lf%n", "f %u %u %u%n", 1);
    dem_buffer_release(&out);
}

static void off_keeps_every_bit(void **state)
{
    (void)state;
    dem_buffer out = written(DEM_MESH_OFF, "made so", 17);
    check(strncmp(out.data, "OFF\n# made so\n4 4 0\n", 20) == 0);
    check_lines(out.data + 20, "%lf %lf %lf%n", "3 %u %u %u%n", 0);
    dem_buffer_release(&out);
}

static void digits_are_those_asked_for(void **state)
{
    (void)state;
    dem_buffer out = written(DEM_MESH_OBJ, NULL, 7);
    check(strncmp(out.data, "v 0.1 0 1e-09\nv 0.3333333 0 0\n", 30) == 0);
    dem_buffer_release(&out);
}

static void stl_holds_a_normal_and_three_corners_per_triangle(void **state)
{
    (void)state;
    dem_buffer out = written(DEM_MESH_STL,
                             "a comment longer than the eighty bytes of the header, which has to be cut "
                             "somewhere near its end",
                             17);
    check(out.size == 84 + 50 * 4);
    check(strncmp(out.data, "solid", 5) != 0 && strstr(out.data, "a comment"));
    check(memcmp(out.data + 80, "\4\0\0\0", 4) == 0);
    for (size_t t = 0; t < 4; t++) {
        float row[12];  // the machine of this test is little-endian
        memcpy(row, out.data + 84 + 50 * t, sizeof row);
        check_near(row[0] * row[0] + row[1] * row[1] + row[2] * row[2], 1, 1e-6);
        for (size_t k = 0; k < 3; k++) {
            dem_vec3 v = vertices[triangles[3 * t + k]];
            check(row[3 + 3 * k] == (float)v.x && row[4 + 3 * k] == (float)v.y && row[5 + 3 * k] == (float)v.z);
            // the corners lie in the plane of the normal
            double in_plane = 0, size = 0;
            for (int i = 0; i < 3; i++) {
                in_plane += (double)row[i] * ((double)row[3 + 3 * k + (size_t)i] - (double)row[3 + i]);
                size = fmax(size, fabs((double)row[3 + 3 * k + (size_t)i]));
            }
            check_near(in_plane, 0, 1e-6 * size);
        }
        check(out.data[84 + 50 * t + 48] == 0 && out.data[84 + 50 * t + 49] == 0);
    }
    dem_buffer_release(&out);
}

static void ply_keeps_every_bit(void **state)
{
    (void)state;
    dem_buffer out = written(DEM_MESH_PLY, "made so", 7);
    const char *body = strstr(out.data, "end_header\n");
    check(body && strstr(out.data, "comment made so\n") && strstr(out.data, "element vertex 4\n"));
    body += strlen("end_header\n");
    check((size_t)(out.data + out.size - body) == 4 * 24 + 4 * 13);
    check(memcmp(body, vertices, sizeof vertices) == 0);
    for (size_t t = 0; t < 4; t++) {
        const char *face = body + sizeof vertices + 13 * t;
        check(face[0] == 3 && memcmp(face + 1, &triangles[3 * t], 12) == 0);
    }
    dem_buffer_release(&out);
}

static void our_reader_gets_the_same_mesh_back(void **state)
{
    (void)state;
    const char *const names[] = {"write_test.obj", "write_test.stl", "write_test.ply", "write_test.off"};
    for (size_t i = 0; i < 4; i++) {
        dem_mesh_format format;
        dem_mesh mesh;
        dem_error error;
        check(dem_mesh_format_of(names[i], &format));
        dem_buffer out = written(format, "made so", 17);
        check_ok(dem_file_write_buffer(names[i], &out, &error), error);
        check_ok(dem_mesh_read(NULL, names[i], &mesh, &error), error);
        remove(names[i]);
        check(mesh.triangle_count == 4);
        for (size_t k = 0; k < 12; k++) {
            dem_vec3 got = mesh.vertices[mesh.triangles[k]], want = vertices[triangles[k]];
            double tolerance = format == DEM_MESH_STL ? 1e-7 * fabs(want.z) + 1e-7 : 0;
            check_vec(got, want, tolerance);
        }
        dem_mesh_free(&mesh);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_suffix_decides_the_format),
        cmocka_unit_test(obj_keeps_every_bit_and_counts_from_one),
        cmocka_unit_test(off_keeps_every_bit),
        cmocka_unit_test(digits_are_those_asked_for),
        cmocka_unit_test(stl_holds_a_normal_and_three_corners_per_triangle),
        cmocka_unit_test(ply_keeps_every_bit),
        cmocka_unit_test(our_reader_gets_the_same_mesh_back),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
