#include "folder.h"
#include "views.h"

#include "out/final.h"
#include "out/frames.h"
#include "out/results.h"

static const char SCENE[] =
    "{\"title\": \"t\", \"time\": %s, \"scene\": {\"schema\": \"dem-scene/1\", \"materials\": {\"a\": {\"density\": "
    "2500}},"
    " \"contacts\": [{\"between\": [\"a\", \"a\"], \"normal\": {\"law\": \"linear\", \"stiffness\": 10}}],"
    " \"shapes\": {\"ball\": {\"sphere\": {\"radius\": 0.5}, \"material\": \"a\"},"
    " \"two\": {\"spheres\": [[0, 0, -0.3, 0.5], [0, 0, 0.3, 0.5]], \"material\": \"a\"},"
    " \"big\": {\"sphere\": {\"radius\": 2}, \"material\": \"a\"}},"
    " \"walls\": {\"floor\": {\"plane\": {\"point\": [0, 0, -2], \"normal\": [0, 0, 1]}, \"material\": \"a\"},"
    " \"wheel\": {\"plane\": {\"point\": [1, 0, 0], \"normal\": [1, 0, 0]}, \"material\": \"a\", \"motion\": {"
    "\"translate\": {\"velocity\": [0, 0, 3]}, \"rotate\": {\"axis\": [0, 0, 1], \"through\": [1, 0, 0],"
    " \"rate\": 0.5}}}}}}";


static void put_text(const char *path, const char *text)
{
    dem_error error;
    check_ok(dem_file_write(path, text, strlen(text), &error), error);
}

// a run of three frames at 0, 0.1 and 0.2 s, of the views of seeds 1, 2, 3; its last state is that of seed 4
static char *made_run(const char *name, const char *end, made_view *last)
{
    char *directory = strdup(in_folder(name)), text[2048], *path;
    dem_error error;
    dem_frames *frames;
    const dem_frames_def def = {.directory = directory,
                                .shapes = VIEW_SHAPE_DEFS,
                                .clumps = (const dem_clump *const *)clumps,
                                .shape_count = VIEW_SHAPES,
                                .resume = NAN};
    check_ok(dem_frames_open(&def, &frames, &error), error);
    for (uint64_t i = 0; i < 3; i++) {
        dem_body_view view = view_bodies(last, i + 1);
        check_ok(dem_frames_write(frames, 0.1 * (double)i, &view, NULL, &error), error);
    }
    dem_frames_close(frames);
    dem_body_view view = view_bodies(last, 4);
    static const dem_shape_def shapes[] = {{.name = "ball"}, {.name = "two"}, {.name = "big"}};
    check_ok(dem_final_write(NULL, directory, shapes, 3, &view, &error), error);
    snprintf(text, sizeof text, SCENE, end);
    path = dem_path_join(directory, "run.json");
    put_text(path, text);
    free(path);
    return directory;
}

static dem_results opened(const char *directory)
{
    dem_results r;
    dem_error error;
    check_ok(dem_results_open(NULL, directory, &r, &error), error);
    return r;
}

static void frames_come_back_as_they_were_written(void **state)
{
    (void)state;
    made_view v;
    char *directory = made_run("run", "0.3", &v);
    dem_results r = opened(directory);
    dem_error error;
    check(r.index.count == 3 && r.scene.shape_count == 3 && r.end == 0.3);
    check_close(r.diameters[2], 4, 1e-12);
    for (size_t i = 3; i-- > 0;) {  // also backwards
        dem_body_view want = view_bodies(&v, i + 1);
        check_ok(dem_results_frame(&r, i, &error), error);
        const dem_body_view *b = &r.bodies;
        check(r.time == r.index.entries[i].time && b->count == VIEW_BODIES);
        size_t n = VIEW_BODIES;
        assert_memory_equal(b->position, want.position, n * sizeof *b->position);
        assert_memory_equal(b->velocity, want.velocity, n * sizeof *b->velocity);
        assert_memory_equal(b->spin, want.spin, n * sizeof *b->spin);
        assert_memory_equal(b->scale, want.scale, n * sizeof *b->scale);
        assert_memory_equal(b->mass, want.mass, n * sizeof *b->mass);
        assert_memory_equal(b->shape, want.shape, n * sizeof *b->shape);
        assert_memory_equal(b->coordination, want.coordination, n * sizeof *b->coordination);
        for (size_t k = 0; k < n; k++)  // stored with 24 bits
            check_vec(quat_rotate(b->orientation[k], v3(1, 2, 3)), quat_rotate(want.orientation[k], v3(1, 2, 3)), 2e-6);
    }
    check(dem_results_frame(&r, 3, &error) == DEM_USAGE && strstr(error.text, "it has 3"));
    dem_results_release(&r);
    free(directory);
}

static void walls_stand_where_they_were(void **state)
{
    (void)state;
    made_view v;
    char *directory = made_run("run", "0.3", &v);
    dem_results r = opened(directory);
    dem_error error;
    check(r.scene.wall_count == 2);
    check_ok(dem_results_frame(&r, 2, &error), error);
    double t = r.time, angle = 0.5 * t;
    check_vec(r.walls[0].position, v3(0, 0, 0), 0);
    check_vec(v3_add(r.walls[1].position, quat_rotate(r.walls[1].orientation, v3(1, 0, 0))), v3(1, 0, 3 * t), 1e-15);
    check_vec(quat_rotate(r.walls[1].orientation, v3(1, 0, 0)), v3(cos(angle), sin(angle), 0), 1e-15);
    check_ok(dem_results_frame(&r, 0, &error), error);
    check_vec(r.walls[1].position, v3(0, 0, 0), 1e-15);
    dem_results_release(&r);
    free(directory);
}

static void the_last_state_is_the_last_frame_or_the_final_table(void **state)
{
    (void)state;
    made_view v;
    dem_error error;
    char *directory = made_run("run", "0.3", &v);
    dem_results r;
    check_ok(dem_results_read(NULL, directory, &r, &error), error);
    dem_body_view want = view_bodies(&v, 4);
    check(r.time == 0.3 && !r.bodies.coordination);
    assert_memory_equal(r.bodies.position, want.position, VIEW_BODIES * sizeof *want.position);
    dem_results_release(&r);
    free(directory);
    // a frame of that time tells more
    directory = made_run("again", "0.2", &v);
    check_ok(dem_results_read(NULL, directory, &r, &error), error);
    want = view_bodies(&v, 3);
    check(r.bodies.coordination != NULL && r.time == 0.2);
    assert_memory_equal(r.bodies.position, want.position, VIEW_BODIES * sizeof *want.position);
    dem_results_release(&r);
    // and a run that was stopped has nothing else
    char *final = dem_path_join(directory, "final.csv");
    remove(final);
    free(final);
    check_ok(dem_results_read(NULL, directory, &r, &error), error);
    check(r.bodies.count == VIEW_BODIES);
    dem_results_release(&r);
    free(directory);
}

static void the_frame_of_a_time_is_the_nearest_one(void **state)
{
    (void)state;
    made_view v;
    dem_error error;
    char *directory = made_run("run", "0.3", &v);
    dem_results r = opened(directory);
    size_t index;
    static const struct {
        double time;
        size_t frame;
    } cases[] = {{0, 0}, {0.04, 0}, {0.06, 1}, {0.149, 1}, {0.2, 2}, {0.249, 2}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        check_ok(dem_results_at(&r, cases[i].time, &index, &error), error);
        check(index == cases[i].frame);
    }
    check(dem_results_at(&r, 0.26, &index, &error) == DEM_USAGE && strstr(error.text, "from 0 s to 0.2 s"));
    dem_results_release(&r);
    free(directory);
}

// changes an array of frame 0 by name
static void refused_with(const char *name, const dem_vtp_array *instead, const char *words)
{
    made_view v;
    dem_error error;
    dem_vtp_file file;
    char *directory = made_run("broken", "0.3", &v), *path = dem_path_join(directory, "frames/000000.vtp");
    check_ok(dem_vtp_read(path, &file, &error), error);
    dem_vtp changed = file.vtp;
    dem_vtp_array arrays[16];
    memcpy(arrays, changed.point_arrays, changed.point_array_count * sizeof *arrays);
    for (size_t i = 0; i < changed.point_array_count; i++)
        if (strcmp(arrays[i].name, name) == 0)
            arrays[i] = *instead;
    changed.point_arrays = arrays;
    check_ok(dem_vtp_write(path, &changed, &error), error);
    dem_results r = opened(directory);
    check(dem_results_frame(&r, 0, &error) == DEM_BAD_INPUT);
    if (!strstr(error.text, words))
        print_error("no '%s' in '%s'\n", words, error.text);
    check(strstr(error.text, words) && strchr(error.text, ';') && strstr(error.file, "000000.vtp"));
    dem_results_release(&r);
    dem_vtp_file_release(&file);
    free(path);
    free(directory);
}

static void frames_that_do_not_fit_are_refused(void **state)
{
    (void)state;
    static const int32_t templates[VIEW_BODIES] = {0, 1, 3}, negative[VIEW_BODIES] = {-1};
    static const float turns[4 * VIEW_BODIES] = {1, 0, 0, 0, 0.1f};
    static const double scales[VIEW_BODIES] = {1, 1, 1, 0}, none[VIEW_BODIES] = {NAN};
    refused_with("template", &(dem_vtp_array){"template", DEM_VTP_INT32, 1, templates}, "template of body 2");
    refused_with("template", &(dem_vtp_array){"template", DEM_VTP_INT32, 1, negative}, "template of body 0");
    refused_with("orientation", &(dem_vtp_array){"orientation", DEM_VTP_FLOAT32, 4, turns}, "orientation of body 1");
    refused_with("scale", &(dem_vtp_array){"scale", DEM_VTP_FLOAT64, 1, scales}, "scale of body 3");
    refused_with("scale", &(dem_vtp_array){"scale", DEM_VTP_FLOAT64, 1, none}, "scale of body 0");
    refused_with("mass", &(dem_vtp_array){"weight", DEM_VTP_FLOAT64, 1, scales}, "holds no mass");
    refused_with("mass", &(dem_vtp_array){"mass", DEM_VTP_INT32, 1, templates}, "holds no mass");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(frames_come_back_as_they_were_written),
        cmocka_unit_test(walls_stand_where_they_were),
        cmocka_unit_test(the_last_state_is_the_last_frame_or_the_final_table),
        cmocka_unit_test(the_frame_of_a_time_is_the_nearest_one),
        cmocka_unit_test(frames_that_do_not_fit_are_refused),
    };
    return cmocka_run_group_tests(tests, begin_views, end_views);
}
