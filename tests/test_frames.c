#include "folder.h"
#include "views.h"
#include "vtp.h"

#include "out/frames.h"
#include "out/glyph.h"


static dem_frames_def frames_def(const char *directory, double resume, size_t walls)
{
    return (dem_frames_def){.directory = directory,
                            .shapes = VIEW_SHAPE_DEFS,
                            .clumps = (const dem_clump *const *)clumps,
                            .shape_count = VIEW_SHAPES,
                            .walls = VIEW_WALL_DEFS,
                            .wall_count = walls,
                            .domain = {.low = {-INFINITY, -5, -INFINITY}, .high = {INFINITY, 5, INFINITY}},
                            .resume = resume};
}

static dem_frames *opened(const char *directory, double resume, size_t walls)
{
    dem_frames_def def = frames_def(directory, resume, walls);
    dem_frames *frames;
    dem_error error;
    check_ok(dem_frames_open(&def, &frames, &error), error);
    return frames;
}

// frame i of a run with a frame every 0.01 s
static void write_frames(dem_frames *frames, int first, int last)
{
    for (int i = first; i < last; i++) {
        made_view arrays;
        dem_wall_view walls[VIEW_WALLS];
        dem_body_view bodies = view_bodies(&arrays, (uint64_t)i);
        dem_error error;
        view_walls(walls, i * 0.01);
        check_ok(dem_frames_write(frames, i * 0.01, &bodies, walls, &error), error);
    }
}

static void a_frame_holds_a_point_per_body(void **state)
{
    (void)state;
    char *directory = in_folder("bodies/run");
    dem_frames *frames = opened(directory, NAN, 0);
    write_frames(frames, 3, 4);
    check(dem_frames_count(frames) == 1);
    dem_frames_close(frames);
    made_view want;
    dem_body_view view = view_bodies(&want, 3);
    dem_buffer file = content(in_folder("bodies/run/frames/000000.vtp"));
    vtp_check_blocks(&file);
    check(vtp_count(&file, "NumberOfPoints") == VIEW_BODIES && vtp_count(&file, "NumberOfVerts") == VIEW_BODIES);
#define SAME(section, name, type, width, field)                                                                        \
    assert_memory_equal(vtp_array(&file, section, name, type, width, sizeof want.field), want.field, sizeof want.field)
    SAME("Points", "Points", "Float64", 3, position);
    SAME("PointData", "scale", "Float64", 1, scale);
    SAME("PointData", "template", "Int32", 1, shape);
    SAME("PointData", "velocity", "Float64", 3, velocity);
    SAME("PointData", "angular_velocity", "Float64", 3, spin);
    SAME("PointData", "mass", "Float64", 1, mass);
    SAME("PointData", "coordination", "UInt32", 1, coordination);
#undef SAME
    float turn[4];
    uint32_t id[VIEW_BODIES];
    const char *turns = vtp_array(&file, "PointData", "orientation", "Float32", 4, VIEW_BODIES * sizeof turn);
    memcpy(id, vtp_array(&file, "PointData", "id", "UInt32", 1, sizeof id), sizeof id);
    for (uint32_t i = 0; i < VIEW_BODIES; i++) {
        dem_quat q = view.orientation[i];
        memcpy(turn, turns + i * sizeof turn, sizeof turn);
        check(turn[0] == (float)q.w && turn[1] == (float)q.x && turn[2] == (float)q.y && turn[3] == (float)q.z);
        check(id[i] == i);
    }
    double time;
    memcpy(&time, vtp_array(&file, "FieldData", "TimeValue", "Float64", 1, sizeof time), sizeof time);
    check(time == 3 * 0.01);
    dem_buffer_release(&file);
    file = content(in_folder("bodies/run/run.pvd"));
    check(strstr(file.data, "<DataSet timestep=\"0.03\" part=\"0\" file=\"frames/000000.vtp\"/>") != NULL);
    dem_buffer_release(&file);
    check(!exists(in_folder("bodies/run/walls.pvd")));
}

static double surface_volume(const dem_buffer *file)
{
    size_t points = (size_t)vtp_count(file, "NumberOfPoints"), count = (size_t)vtp_count(file, "NumberOfPolys");
    const char *xyz = vtp_array(file, "Points", "Points", "Float64", 3, points * sizeof(dem_vec3));
    const char *list = vtp_array(file, "Polys", "connectivity", "Int64", 1, 3 * count * sizeof(int64_t));
    double volume = 0;
    for (size_t t = 0; t < count; t++) {
        dem_vec3 c[3];
        for (size_t k = 0; k < 3; k++) {
            int64_t v;
            memcpy(&v, list + (3 * t + k) * sizeof v, sizeof v);
            check(v >= 0 && v < (int64_t)points);
            memcpy(&c[k], xyz + (size_t)v * sizeof *c, sizeof *c);
        }
        volume += v3_dot(c[0], v3_cross(c[1], c[2])) / 6;
    }
    return volume;
}

static void shapes_are_surfaces_in_the_principal_frame(void **state)
{
    (void)state;
    dem_frames_close(opened(in_folder("glyphs"), NAN, 0));
    dem_buffer ball = content(in_folder("glyphs/shapes/ball.vtp")),
               two = content(in_folder("glyphs/shapes/two_balls.vtp")),
               grain = content(in_folder("glyphs/shapes/two_balls-2.vtp"));
    vtp_check_blocks(&ball);
    // 320 facets of a ball: 3.4 % low by the sag of their edges (16 degrees)
    check_close(surface_volume(&ball), DEM_PI / 6, 0.035);
    // two balls of radius r, 0.6 apart: each lacks a cap of height h = 0.2
    check_close(surface_volume(&two), 2 * (DEM_PI / 6 - DEM_PI * 0.04 * (3 * 0.5 - 0.2) / 3), 0.035);
    dem_clump_def def = sample_clump();
    assert_memory_equal(vtp_array(&grain, "Points", "Points", "Float64", 3, 4 * sizeof(dem_vec3)), def.surface.vertices,
                        4 * sizeof(dem_vec3));
    check_close(surface_volume(&grain), 0.1 * 2 / 3 / 6, 1e-14);
    // the normals are those of the balls
    size_t points = (size_t)vtp_count(&two, "NumberOfPoints");
    const char *at = vtp_array(&two, "Points", "Points", "Float64", 3, points * sizeof(dem_vec3));
    const char *normals = vtp_array(&two, "PointData", "Normals", "Float32", 3, points * 3 * sizeof(float));
    for (size_t i = 0; i < points; i++) {
        dem_vec3 x;
        float n[3];
        memcpy(&x, at + i * sizeof x, sizeof x);
        memcpy(n, normals + i * sizeof n, sizeof n);
        double z = fabs(x.z - 0.3 - 0.5 * (double)n[2]) < fabs(x.z + 0.3 - 0.5 * (double)n[2]) ? 0.3 : -0.3;
        check_vec(x, v3(0.5 * (double)n[0], 0.5 * (double)n[1], z + 0.5 * (double)n[2]), 1e-7);
    }
    dem_buffer_release(&ball);
    dem_buffer_release(&two);
    dem_buffer_release(&grain);
}

static void walls_that_stay_are_written_once(void **state)
{
    (void)state;
    dem_frames *frames = opened(in_folder("walls"), NAN, VIEW_WALLS);
    write_frames(frames, 0, 3);
    dem_frames_close(frames);
    dem_buffer still = content(in_folder("walls/walls_static.vtp")),
               moving = content(in_folder("walls/walls/000002.vtp")), index = content(in_folder("walls/walls.pvd"));
    // the floor as two triangles, then the drum
    size_t count = (size_t)vtp_count(&still, "NumberOfPolys");
    check(count == 2 + 128);
    const char *numbers = vtp_array(&still, "CellData", "wall", "Int32", 1, count * sizeof(int32_t));
    for (size_t i = 0; i < count; i++) {
        int32_t number;
        memcpy(&number, numbers + i * sizeof number, sizeof number);
        check(number == (i < 2 ? 0 : 1));
    }
    size_t corners = (size_t)vtp_count(&still, "NumberOfPoints");
    const char *xyz = vtp_array(&still, "Points", "Points", "Float64", 3, corners * sizeof(dem_vec3));
    const char *list = vtp_array(&still, "Polys", "connectivity", "Int64", 1, 3 * count * sizeof(int64_t));
    for (size_t i = 0; i < 3 * count; i++) {
        int64_t v;
        dem_vec3 x;
        memcpy(&v, list + i * sizeof v, sizeof v);
        check(v >= 0 && v < (int64_t)corners);
        memcpy(&x, xyz + (size_t)v * sizeof x, sizeof x);
        check_near(i < 6 ? x.z : hypot(x.x, x.y), i < 6 ? -2 : 3, 1e-14);
    }
    vtp_check_blocks(&still);
    check(!vtp_tag(&still, "FieldData", "TimeValue"));
    // the lid has moved up by 0.02 and is cut at the domain
    check(vtp_count(&moving, "NumberOfPolys") == 2);
    size_t points = (size_t)vtp_count(&moving, "NumberOfPoints");
    const char *at = vtp_array(&moving, "Points", "Points", "Float64", 3, points * sizeof(dem_vec3));
    for (size_t i = 0; i < points; i++) {
        dem_vec3 x;
        memcpy(&x, at + i * sizeof x, sizeof x);
        check_near(x.z, 2.02, 1e-14);
        check_near(fabs(x.y), 5, 1e-6);
    }
    check(strstr(index.data, "<DataSet timestep=\"0.02\" part=\"0\" file=\"walls_static.vtp\"/>\n"
                             "<DataSet timestep=\"0.02\" part=\"1\" file=\"walls/000002.vtp\"/>\n") != NULL);
    dem_buffer_release(&still);
    dem_buffer_release(&moving);
    dem_buffer_release(&index);
    // without moving ones the index holds them once
    frames = opened(in_folder("still"), NAN, 2);
    write_frames(frames, 0, 3);
    dem_frames_close(frames);
    index = content(in_folder("still/walls.pvd"));
    check(strstr(index.data, "timestep=\"0\"") && !strstr(index.data, "timestep=\"0.01\""));
    check(!exists(in_folder("still/walls")));
    dem_buffer_release(&index);
}

static void a_resumed_run_leaves_the_files_of_a_straight_one(void **state)
{
    (void)state;
    dem_frames *frames = opened(in_folder("straight"), NAN, VIEW_WALLS);
    write_frames(frames, 0, 6);
    dem_frames_close(frames);
    frames = opened(in_folder("resumed"), NAN, VIEW_WALLS);
    write_frames(frames, 0, 5);
    dem_frames_close(frames);
    frames = opened(in_folder("resumed"), 2 * 0.01, VIEW_WALLS);
    check(dem_frames_count(frames) == 3);
    check(!exists(in_folder("resumed/frames/000003.vtp")) && !exists(in_folder("resumed/walls/000004.vtp")));
    check(exists(in_folder("resumed/frames/000002.vtp")) && exists(in_folder("resumed/walls/000002.vtp")));
    write_frames(frames, 3, 6);
    dem_frames_close(frames);
    char command[300];
    snprintf(command, sizeof command, "diff -r '%s' '%s'", in_folder("straight"), in_folder("resumed"));
    check(system(command) == 0);
}

static void a_new_run_leaves_no_frame_of_an_earlier_one(void **state)
{
    (void)state;
    dem_error error;
    dem_frames *frames = opened(in_folder("again"), NAN, VIEW_WALLS);
    write_frames(frames, 0, 4);
    dem_frames_close(frames);
    check_ok(dem_file_write(in_folder("again/frames/notes.txt"), "x", 1, &error), error);
    check_ok(dem_file_write(in_folder("again/frames/000001.vtp.old"), "x", 1, &error), error);
    dem_frames_close(opened(in_folder("again"), NAN, 0));
    check(!exists(in_folder("again/run.pvd")) && !exists(in_folder("again/walls.pvd")));
    check(!exists(in_folder("again/frames/000000.vtp")) && !exists(in_folder("again/walls/000003.vtp")));
    check(exists(in_folder("again/frames/notes.txt")) && exists(in_folder("again/frames/000001.vtp.old")));
}

static void what_cannot_be_written_is_said(void **state)
{
    (void)state;
    dem_error error;
    dem_frames *frames;
    check_ok(dem_file_write(in_folder("file"), "x", 1, &error), error);
    dem_frames_def def = frames_def(in_folder("file"), NAN, 0);
    check(dem_frames_open(&def, &frames, &error) == DEM_CANNOT_WRITE && !frames && strchr(error.text, ';'));
    check_ok(dem_folder_create(in_folder("alien"), &error), error);
    check_ok(dem_file_write(in_folder("alien/run.pvd"), "x", 1, &error), error);
    def = frames_def(in_folder("alien"), 0, 0);
    check(dem_frames_open(&def, &frames, &error) == DEM_BAD_INPUT && !frames && strstr(error.file, "run.pvd"));
    dem_frames_close(NULL);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_frame_holds_a_point_per_body),
        cmocka_unit_test(shapes_are_surfaces_in_the_principal_frame),
        cmocka_unit_test(walls_that_stay_are_written_once),
        cmocka_unit_test(a_resumed_run_leaves_the_files_of_a_straight_one),
        cmocka_unit_test(a_new_run_leaves_no_frame_of_an_earlier_one),
        cmocka_unit_test(what_cannot_be_written_is_said),
    };
    return cmocka_run_group_tests(tests, begin_views, end_views);
}
