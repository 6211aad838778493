#include "read_check.h"

#include <locale.h>
#include <sys/stat.h>
#include <unistd.h>

#define CUBE_OFF                                                                                                       \
    "OFF\n8 6 12\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n0 0 1\n1 0 1\n1 1 1\n0 1 1\n"                                            \
    "4 3 2 1 0\n4 4 5 6 7\n4 0 1 5 4\n4 1 2 6 5\n4 2 3 7 6\n4 3 0 4 7\n"

static void content_decides_and_a_wrong_name_is_one_warning(void **state)
{
    (void)state;
    check_cube("cube.stl", CUBE_OBJ, strlen(CUBE_OBJ), 1);
    check_cube("cube.OFF", CUBE_OBJ, strlen(CUBE_OBJ), 1);
    check_cube("cube.obj", CUBE_OFF, strlen(CUBE_OFF), 1);
    check_cube_text("cube.OBJ", CUBE_OBJ);
    check_cube_text("cube", CUBE_OBJ);
    check_cube_text("stl/cube.txt", CUBE_OFF);
    dem_mesh mesh;
    dem_error error;
    heard all;
    check_ok(parse("cube.stl", CUBE_OBJ, strlen(CUBE_OBJ), &all, &mesh, &error), error);
    assert_string_equal(all.last, "content is OBJ although the name ends in .stl; read as OBJ");
    dem_mesh_free(&mesh);
}

static void what_is_no_mesh_is_refused_by_what_it_is(void **state)
{
    (void)state;
    static const struct {
        const char *name, *bytes;
        size_t size;
        const char *words;
    } cases[] = {
        {"letter.obj", "Dear colleague,\nplease find the grain attached.\n", 0,
         "not a mesh; supported: STL, OBJ, PLY, OFF"},
        {"picture.stl", "\x89PNG\r\n\x1a\n\0\0\0\15IHDR", 16, "is a PNG picture, not a mesh; supported: STL"},
        {"picture.obj", "\xff\xd8\xff\xe0", 4, "is a JPEG picture"},
        {"grain.stl.gz", "\x1f\x8b\x08\0", 4, "is compressed; unpack it"},
        {"grain.obj",
         "\xff\xfev\0 \0"
         "1\0",
         8, "is UTF-16 text; save it as UTF-8"},
        {"cloud.xyz", "# x y z\n0 0 1\n0.5 0 1e-3\n", 0, "not a mesh but a cloud of points"},
        {"cloud.txt", "0,5 0,1 0,2\n", 0, "not a mesh but a cloud of points"},
        {"blank.obj", " \n\n\t", 0, "not a mesh; supported"},
        {"comments.obj", "# nothing\n", 0, "not a mesh; supported"},
        {"zero", "\0", 1, "not a mesh; supported"},
        {"faces.obj", "f 1 2 3\n", 0, "not a mesh; supported"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        size_t size = cases[i].size ? cases[i].size : strlen(cases[i].bytes);
        check_refused(cases[i].name, cases[i].bytes, size, 0, cases[i].words);
    }
}

// a file of its own for one test, removed at its end
typedef struct place {
    char folder[64], path[96];
} place;

static void put_file(place *at, const char *name, const char *text)
{
    strcpy(at->folder, "/tmp/test_read.XXXXXX");
    assert_non_null(mkdtemp(at->folder));
    snprintf(at->path, sizeof at->path, "%s/%s", at->folder, name);
    FILE *file = fopen(at->path, "wb");
    assert_non_null(file);
    fputs(text, file);
    fclose(file);
}

static void remove_file(place *at)
{
    unlink(at->path);
    rmdir(at->folder);
}

static void a_file_and_standard_input_give_the_same_mesh(void **state)
{
    (void)state;
    place at;
    put_file(&at, "cube.obj", CUBE_OBJ);
    dem_mesh mesh, piped;
    dem_error error;
    check_ok(dem_mesh_read(NULL, at.path, &mesh, &error), error);
    int keep = dup(STDIN_FILENO);
    assert_non_null(freopen(at.path, "rb", stdin));
    dem_status status = dem_mesh_read(NULL, "-", &piped, &error);
    dup2(keep, STDIN_FILENO);
    close(keep);
    check_ok(status, error);
    check(mesh.vertex_count == 8 && piped.vertex_count == 8 && piped.triangle_count == 12);
    assert_memory_equal(mesh.vertices, piped.vertices, 8 * sizeof *mesh.vertices);
    assert_memory_equal(mesh.triangles, piped.triangles, 36 * sizeof *mesh.triangles);
    dem_mesh_free(&mesh);
    dem_mesh_free(&piped);
    remove_file(&at);
}

static void what_cannot_be_opened_is_refused(void **state)
{
    (void)state;
    place at;
    put_file(&at, "empty.obj", "");
    dem_mesh mesh;
    dem_error error;
    static const char *const words[] = {"file is empty", "is a directory", "no such file",
                                        "link to a file that does not"};
    char path[128];
    for (int i = 0; i < 4; i++) {
        snprintf(path, sizeof path, "%s", i == 0 ? at.path : at.folder);
        if (i >= 2)
            snprintf(path, sizeof path, "%s/missing.obj", at.folder);
        if (i == 3)
            check(symlink("nowhere", path) == 0);
        memset(&mesh, 0xab, sizeof mesh);
        check(dem_mesh_read(NULL, path, &mesh, &error) == DEM_BAD_INPUT);
        assert_non_null(strstr(error.text, words[i]));
        assert_string_equal(error.file, path);
        check(!mesh.vertices && !mesh.triangles);
    }
    unlink(path);
    chmod(at.path, 0);
    if (geteuid() != 0) {
        check(dem_mesh_read(NULL, at.path, &mesh, &error) == DEM_BAD_INPUT);
        assert_non_null(strstr(error.text, "permission denied"));
    }
    remove_file(&at);
}

typedef struct steps {
    int calls, stop_at;
    double last;
} steps;

static bool step(void *user, const char *what, double fraction)
{
    steps *s = user;
    check(what && fraction >= s->last && fraction <= 1);
    s->last = fraction;
    return ++s->calls == s->stop_at;
}

static void reading_tells_its_progress_and_can_be_interrupted(void **state)
{
    (void)state;
    dem_buffer text = {0};
    for (int i = 0; i < 400000; i++)
        dem_buffer_text(&text, "v 1 2 3\n");
    for (int i = 0; i < 400000; i++)
        dem_buffer_text(&text, "f 1 2 3\n");
    steps all = {0}, some = {.stop_at = 3};
    dem_ctx ctx = {.progress = step, .user = &all};
    dem_mesh mesh;
    dem_error error;
    check_ok(dem_read_obj(&ctx, "long.obj", text.data, text.size, &mesh, &error), error);
    check(all.calls == 12 && all.last > 0.9);  // every 65536 vertices and triangles
    dem_mesh_free(&mesh);
    ctx.user = &some;
    check(dem_read_obj(&ctx, "long.obj", text.data, text.size, &mesh, &error) == DEM_INTERRUPTED);
    check(error.code == DEM_INTERRUPTED && some.calls == 3 && !mesh.vertices);
    dem_buffer_release(&text);
}

// a locale with a decimal comma, compiled for this test where the tools for that are there
static void a_german_locale_changes_nothing(void **state)
{
    (void)state;
    char folder[] = "/tmp/test_read.XXXXXX", command[256];
    assert_non_null(mkdtemp(folder));
    snprintf(command, sizeof command, "localedef -i de_DE -f UTF-8 %s/de_DE.UTF-8 >/dev/null 2>&1", folder);
    bool made = system(command) == 0;
    setenv("LOCPATH", folder, 1);
    bool german = made && setlocale(LC_ALL, "de_DE.UTF-8");
    double comma = strtod("0,5", NULL);
    dem_mesh mesh;
    dem_error error;
    heard all;
    // more digits than the short way of reading a number takes, and the exact cube beside
    static const char *const text = CUBE_OBJ "v 0.1234567890123456789 2.5e-3 1e30\nv 1,5 0 0\n";
    dem_status status = parse("cube.obj", text, strlen(text) - strlen("v 1,5 0 0\n"), &all, &mesh, &error);
    double read = mesh.vertices ? mesh.vertices[8].x : 0;
    dem_mesh_free(&mesh);
    dem_status refused = parse("cube.obj", text, strlen(text), &all, &mesh, &error);
    setlocale(LC_ALL, "C");
    unsetenv("LOCPATH");
    snprintf(command, sizeof command, "rm -r %s", folder);
    check(system(command) == 0);
    if (!german)
        skip();
    check(comma == 0.5);
    check(status == DEM_OK && read == 0.1234567890123456789);
    check(refused == DEM_BAD_INPUT && error.line == 16);
    assert_non_null(strstr(error.text, "'1,5' has a comma"));
}

static void a_copy_is_equal_and_its_own(void **state)
{
    (void)state;
    dem_mesh mesh, copy;
    dem_error error;
    heard all;
    check_ok(parse("cube.obj", CUBE_OBJ, strlen(CUBE_OBJ), &all, &mesh, &error), error);
    check_ok(dem_mesh_copy(&mesh, &copy, &error), error);
    dem_mesh_scale(&copy, 2e-3);
    check_close(dem_mesh_solid(&copy).volume, 8e-9, 1e-12);
    check_close(dem_mesh_solid(&mesh).volume, 1, 1e-12);
    assert_memory_equal(mesh.triangles, copy.triangles, 36 * sizeof *mesh.triangles);
    dem_mesh_free(&mesh);
    dem_mesh_free(&copy);
    check_ok(dem_mesh_copy(&mesh, &copy, &error), error);  // of nothing
    check(copy.vertex_count == 0 && copy.triangle_count == 0);
    dem_mesh_free(&copy);
}

static void real_grains_are_read(void **state)
{
    (void)state;
    static const struct {
        const char *path;
        size_t vertices, triangles;
        double volume;  // of the list beside them
    } grains[] = {
        {SHARED_MESH("castalia.obj"), 2048, 4092, 0.6678},     {SHARED_MESH("human_femur.stl"), 41256, 13752, 1.256e5},
        {SHARED_MESH("offroad_rock2.obj"), 360, 716, 7.568},   {SHARED_MESH("regolith_1.obj"), 242, 480, 8.322e-8},
        {SHARED_MESH("shpsg_sand_030.stl"), 960, 320, 0.5008},
    };
    for (size_t i = 0; i < sizeof grains / sizeof *grains; i++) {
        check_shared(grains[i].path);
        dem_mesh mesh;
        dem_error error;
        check_ok(dem_mesh_read(NULL, grains[i].path, &mesh, &error), error);
        check(mesh.vertex_count == grains[i].vertices && mesh.triangle_count == grains[i].triangles);
        check_close(dem_mesh_solid(&mesh).volume, grains[i].volume, 5e-4);  // the list has four digits
        dem_mesh_free(&mesh);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(content_decides_and_a_wrong_name_is_one_warning),
        cmocka_unit_test(what_is_no_mesh_is_refused_by_what_it_is),
        cmocka_unit_test(a_file_and_standard_input_give_the_same_mesh),
        cmocka_unit_test(what_cannot_be_opened_is_refused),
        cmocka_unit_test(reading_tells_its_progress_and_can_be_interrupted),
        cmocka_unit_test(a_german_locale_changes_nothing),
        cmocka_unit_test(a_copy_is_equal_and_its_own),
        cmocka_unit_test(real_grains_are_read),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
