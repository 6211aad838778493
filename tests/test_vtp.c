#include "vtp.h"

#include <unistd.h>

#include "base/file.h"
#include "out/vtp.h"

static const dem_vec3 POINTS[4] = {{-0.0, 1.0 / 3, 1e-300}, {1, 0, 0}, {0, 1e300, 0}, {0, 0, 2}};
static const double SPEED[12] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11.1};
static const float TURN[16] = {1, 0, 0, 0, 0.6f, 0.8f};
static const int32_t KIND[4] = {0, -1, 2, INT32_MIN};
static const uint32_t ID[4] = {0, 1, 2, UINT32_MAX};
static const int64_t WALL[7] = {10, 11, 12, 13, 14, 15, 16};
static const double MASS = 2.5;

static const dem_vtp_array ARRAYS[] = {{"velocity", DEM_VTP_FLOAT64, 3, SPEED},
                                       {"orientation", DEM_VTP_FLOAT32, 4, TURN},
                                       {"template", DEM_VTP_INT32, 1, KIND},
                                       {"id", DEM_VTP_UINT32, 1, ID}};

static dem_buffer put(dem_vtp vtp)
{
    dem_buffer out = {0};
    dem_vtp_put(&out, &vtp);
    check(!out.failed);
    vtp_check_blocks(&out);
    return out;
}

static void points_and_their_arrays_come_back_bit_for_bit(void **state)
{
    (void)state;
    dem_buffer out =
        put((dem_vtp){.time = 0.1, .points = POINTS, .point_count = 4, .point_arrays = ARRAYS, .point_array_count = 4});
    assert_memory_equal(vtp_array(&out, "Points", "Points", "Float64", 3, sizeof POINTS), POINTS, sizeof POINTS);
    assert_memory_equal(vtp_array(&out, "PointData", "velocity", "Float64", 3, sizeof SPEED), SPEED, sizeof SPEED);
    assert_memory_equal(vtp_array(&out, "PointData", "orientation", "Float32", 4, sizeof TURN), TURN, sizeof TURN);
    assert_memory_equal(vtp_array(&out, "PointData", "template", "Int32", 1, sizeof KIND), KIND, sizeof KIND);
    assert_memory_equal(vtp_array(&out, "PointData", "id", "UInt32", 1, sizeof ID), ID, sizeof ID);
    double time;
    memcpy(&time, vtp_array(&out, "FieldData", "TimeValue", "Float64", 1, sizeof time), sizeof time);
    check(time == 0.1);
    check(vtp_attribute(vtp_tag(&out, "FieldData", "TimeValue"), "NumberOfTuples") == 1);
    check(vtp_count(&out, "NumberOfPoints") == 4 && vtp_count(&out, "NumberOfVerts") == 0);
    dem_buffer_release(&out);
}

static void cells_are_numbered_as_vtk_wants_them(void **state)
{
    (void)state;
    const uint32_t lines[4] = {0, 3, 3, 1}, triangles[3] = {2, 1, 0};
    const dem_vtp_array wall = {"wall", DEM_VTP_INT64, 1, WALL};
    dem_buffer out = put((dem_vtp){.time = NAN,
                                   .points = POINTS,
                                   .point_count = 4,
                                   .vertices = true,
                                   .lines = lines,
                                   .line_count = 2,
                                   .triangles = triangles,
                                   .triangle_count = 1,
                                   .cell_arrays = &wall,
                                   .cell_array_count = 1});
    check(vtp_count(&out, "NumberOfVerts") == 4 && vtp_count(&out, "NumberOfLines") == 2);
    check(vtp_count(&out, "NumberOfStrips") == 0 && vtp_count(&out, "NumberOfPolys") == 1);
    static const int64_t verts[] = {0, 1, 2, 3}, vert_ends[] = {1, 2, 3, 4}, line_points[] = {0, 3, 3, 1},
                         line_ends[] = {2, 4}, corners[] = {2, 1, 0}, ends[] = {3};
#define SAME(section, name, want)                                                                                      \
    assert_memory_equal(vtp_array(&out, section, name, "Int64", 1, sizeof want), want, sizeof want)
    SAME("Verts", "connectivity", verts);
    SAME("Verts", "offsets", vert_ends);
    SAME("Lines", "connectivity", line_points);
    SAME("Lines", "offsets", line_ends);
    SAME("Polys", "connectivity", corners);
    SAME("Polys", "offsets", ends);
    SAME("CellData", "wall", WALL);  // 4 vertices, 2 lines, a triangle
#undef SAME
    check(!vtp_tag(&out, "FieldData", "TimeValue"));
    dem_buffer_release(&out);
}

static void long_lists_of_cells_are_whole(void **state)
{
    (void)state;
    enum { COUNT = 5000 };  // several of the writer's chunks, the last one not full
    dem_vec3 *points = calloc(COUNT, sizeof *points);
    uint32_t *lines = calloc(COUNT, sizeof *lines);
    int64_t *numbers = malloc(COUNT * sizeof *numbers);
    check(points && lines && numbers);
    for (uint32_t i = 0; i < COUNT; i++)
        lines[i] = COUNT - 1 - i;
    dem_buffer out = put((dem_vtp){.time = NAN,
                                   .points = points,
                                   .point_count = COUNT,
                                   .vertices = true,
                                   .lines = lines,
                                   .line_count = COUNT / 2});
    memcpy(numbers, vtp_array(&out, "Lines", "connectivity", "Int64", 1, COUNT * sizeof *numbers),
           COUNT * sizeof *numbers);
    for (int i = 0; i < COUNT; i++)
        check(numbers[i] == COUNT - 1 - i);
    for (int shift = 0; shift < 2; shift++) {
        const char *name = shift ? "offsets" : "connectivity";
        memcpy(numbers, vtp_array(&out, "Verts", name, "Int64", 1, COUNT * sizeof *numbers), COUNT * sizeof *numbers);
        for (int i = 0; i < COUNT; i++)
            check(numbers[i] == i + shift);
    }
    free(numbers);
    free(lines);
    free(points);
    dem_buffer_release(&out);
}

static void nothing_is_a_file_too(void **state)
{
    (void)state;
    dem_buffer out = put((dem_vtp){.time = NAN});
    check(vtp_count(&out, "NumberOfPoints") == 0);
    vtp_array(&out, "Points", "Points", "Float64", 3, 0);
    dem_buffer_release(&out);
}

static void fields_and_the_array_shown_first_are_named(void **state)
{
    (void)state;
    const dem_vtp_array mass = {"mass", DEM_VTP_FLOAT64, 1, &MASS};
    dem_buffer out = put((dem_vtp){.time = 2,
                                   .fields = &mass,
                                   .field_count = 1,
                                   .points = POINTS,
                                   .point_count = 4,
                                   .point_arrays = ARRAYS,
                                   .point_array_count = 4,
                                   .scalars = "id"});
    assert_memory_equal(vtp_array(&out, "FieldData", "mass", "Float64", 1, sizeof MASS), &MASS, sizeof MASS);
    check(strstr(out.data, "<PointData Scalars=\"id\">") != NULL);
    const uint16_t probe = 1;
    char order[64];
    snprintf(order, sizeof order, "byte_order=\"%sEndian\" header_type=\"UInt64\"",
             *(const char *)&probe ? "Little" : "Big");
    check(strstr(out.data, order) != NULL);
    dem_buffer_release(&out);
}

static void the_file_is_what_was_put(void **state)
{
    (void)state;
    dem_vtp vtp = {.time = 1, .points = POINTS, .point_count = 4};
    dem_error error;
    dem_buffer want = put(vtp), got;
    char path[] = "vtp-XXXXXX";
    close(mkstemp(path));
    check_ok(dem_vtp_write(path, &vtp, &error), error);
    check_ok(dem_file_read(path, &got, &error), error);
    check(got.size == want.size);
    assert_memory_equal(got.data, want.data, want.size);
    unlink(path);
    check(dem_vtp_write("no such folder/a.vtp", &vtp, &error) == DEM_CANNOT_WRITE);
    dem_buffer_release(&want);
    dem_buffer_release(&got);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(points_and_their_arrays_come_back_bit_for_bit),
        cmocka_unit_test(cells_are_numbered_as_vtk_wants_them),
        cmocka_unit_test(long_lists_of_cells_are_whole),
        cmocka_unit_test(nothing_is_a_file_too),
        cmocka_unit_test(fields_and_the_array_shown_first_are_named),
        cmocka_unit_test(the_file_is_what_was_put),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
