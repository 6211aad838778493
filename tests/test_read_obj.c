#include "read_check.h"

static void the_forms_of_an_obj_all_give_the_cube(void **state)
{
    (void)state;
    static const char *const forms[] = {
        CUBE_OBJ,
        CUBE_FACES CUBE_VERTICES,  // faces before their vertices
        "\xef\xbb\xbf" CUBE_OBJ,
        "# a comment with a \\\n\n   \n\to cube\ng sides\ns 1\nusemtl C:\\stone\\\nmtllib a b.mtl\n" CUBE_OBJ,
        "vt 0 0\nvt 1 0\nvn 0 0 1\n" CUBE_VERTICES
        "f 4/1 3/2 2/1 1/1\nf 5//1 6//1 7//1 8//1\nf 1/1/1 2/2/1 6/1/1 5/2/1\n"
        "f 2/ 3/ 7/ 6/\nf 3 4 8 7\nf 4 1 5 8 # the last one\n",
        CUBE_VERTICES "f 4 3 \\\n2 1\nf 5 6 7 8\nf 1 2\\\n  6 5 \nf \\\n2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\\\n",
        "v 0 0 \\\n0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1 0.5 \\\n0.5 0.5\nv 0 1 1\n" CUBE_FACES,
        CUBE_VERTICES "f -5 -6 -7 -8\nf -4 -3 -2 -1\nf 1 2 6 5\nf -7 -6 7 6\nf 3 4 8 7\nf 4 1 5 8\n",
        "v 1e3 1e3 1e3\n" CUBE_VERTICES "f 5 4 3 2\nf 6 7 8 9\nf 2 3 7 6\nf 3 4 8 7\nf 4 5 9 8\nf 5 2 6 9\n",
        "v 0 0 0 1 0 0\nv 1. 0. -0. 1\nv 1e0 1.0E+00 0e5\nv 0 1 0\nv .0 +0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1 1 1 1 "
        "1\n" CUBE_FACES,
        CUBE_VERTICES "f 4 4 3 2 1 4\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n",  // repeated corners
    };
    for (size_t i = 0; i < sizeof forms / sizeof *forms; i++)
        check_cube_text("cube.obj", forms[i]);
}

static void line_ends_blanks_and_a_missing_last_newline_do_not_matter(void **state)
{
    (void)state;
    static const char *const changes[][2] = {{"\n", "\r\n"}, {"\n", "\r"},   {"\n", " \t\n"},    {" ", "\t"},
                                             {" ", "   "},   {"\n", "\n\n"}, {"\n", "\n# x\r\n"}};
    for (size_t i = 0; i < sizeof changes / sizeof *changes; i++) {
        char *text = replaced(CUBE_OBJ, changes[i][0], changes[i][1]);
        check_cube_text("cube.obj", text);
        check_cube("cube.obj", text, strlen(text) - strlen(changes[i][1]) * (*changes[i][0] == '\n'), 0);
        free(text);
    }
}

static void lines_of_any_length_are_read(void **state)
{
    (void)state;
    size_t length = 3000000;
    char *text = malloc(length + sizeof CUBE_OBJ + 2);
    assert_non_null(text);
    memset(text, 'x', length);
    text[0] = '#';
    strcpy(text + length, "\n" CUBE_OBJ);
    check_cube_text("cube.obj", text);
    memset(text, ' ', length);
    strcpy(text + length, CUBE_OBJ);
    check_cube_text("cube.obj", text);
    free(text);
}

static void concave_faces_are_filled(void **state)
{
    (void)state;
    // the base is a comb whose fan would leave it: a prism of area 5 over the height 2
    const char *comb =
        "v 0 0 0\nv 5 0 0\nv 5 2 0\nv 4 2 0\nv 4 0.5 0\nv 1 0.5 0\nv 1 2 0\nv 0 2 0\n"
        "v 0 0 2\nv 5 0 2\nv 5 2 2\nv 4 2 2\nv 4 0.5 2\nv 1 0.5 2\nv 1 2 2\nv 0 2 2\n"
        "f 8 7 6 5 4 3 2 1\nf 9 10 11 12 13 14 15 16\n"
        "f 1 2 10 9\nf 2 3 11 10\nf 3 4 12 11\nf 4 5 13 12\nf 5 6 14 13\nf 6 7 15 14\nf 7 8 16 15\nf 8 1 9 16\n";
    dem_mesh mesh;
    dem_error error;
    heard all;
    check_ok(parse("comb.obj", comb, strlen(comb), &all, &mesh, &error), error);
    dem_solid solid = dem_mesh_solid(&mesh);
    check_close(solid.volume, 11, 1e-14);              // (5 x 0.5 + 2 x 1.5) x 2
    check_close(solid.area, 2 * 5.5 + 2 * 17, 1e-14);  // triangles outside the face would add to it
    dem_mesh_free(&mesh);
}

static void what_is_left_out_is_said(void **state)
{
    (void)state;
    dem_mesh mesh;
    dem_error error;
    heard all;
    const char *text = "l 1 2 \\\n3\np 4\n" CUBE_OBJ "vertx 1 2 3\nhello\n";
    check_ok(parse("cube.obj", text, strlen(text), &all, &mesh, &error), error);
    check(all.warnings == 2);
    assert_non_null(strstr(all.last, "line 18 starts with 'vertx'"));
    assert_non_null(strstr(all.last, "2 such lines"));
    dem_mesh_free(&mesh);
}

static void what_is_wrong_is_said_with_its_line(void **state)
{
    (void)state;
    static const struct {
        const char *text;
        long line;
        const char *words;
    } cases[] = {
        {"v 0 0 0\nv 1 0 0\nv 1 1 0\n", 0, "3 vertices but no faces"},
        {"v 0 0 0\nv 1 0 0\nl 1 2\n", 0, "2 vertices but no faces"},
        {CUBE_OBJ "f 1 2 2000000000\n", 15, "face 7 refers to vertex 2000000000 of 8"},
        {CUBE_OBJ "f 1 2 9\n", 15, "face 7 refers to vertex 9 of 8"},
        {CUBE_OBJ "f 1 2 99999999999999999999999\n", 15, "'99999999999999999999999' is no corner"},
        {CUBE_OBJ "f 1 2 -9\n", 15, "vertex -9, counted back from the last, but only 8 came before"},
        {"v 0 0 0\nf -1 -2 -3\n" CUBE_OBJ, 2, "vertex -2, counted back from the last, but only 1 came before"},
        {CUBE_OBJ "f 0 1 2\n", 15, "OBJ counts from 1"},
        {CUBE_OBJ "f 1 2\n", 15, "face 7 has 2 corners, 3 are needed"},
        {CUBE_OBJ "f\n", 15, "face 7 has 0 corners, 3 are needed"},
        {CUBE_OBJ "f 1 2 x\n", 15, "'x' is no corner of a face"},
        {CUBE_OBJ "f 1 2 3.5\n", 15, "'3.5' is no corner of a face"},
        {CUBE_OBJ "f 1 2 3/1/1/1\n", 15, "'3/1/1/1' is no corner of a face"},
        {CUBE_OBJ "f 1,2,3\n", 15, "blanks instead of commas"},
        {"v nan 0 0\n" CUBE_OBJ, 1, "vertex 1 is not finite"},
        {CUBE_OBJ "v 0 -inf 0\n", 15, "vertex 9 is not finite"},
        {CUBE_OBJ "v 0 0 -1e100\n", 15, "vertex 9 is not finite (nan, inf or beyond 1e60)"},
        {"# x\r\n" CUBE_VERTICES "v 1e400 0 0\n" CUBE_FACES, 10, "vertex 9 is not finite"},
        {"v 3,14 2,5 1,0\n" CUBE_OBJ, 1, "'3,14' has a comma; write numbers with a decimal point"},
        {"v 1 2\n" CUBE_OBJ, 1, "the line ends where a number should stand"},
        {CUBE_OBJ "v 1 2\n", 15, "unexpected end of file where a number should stand"},
        {CUBE_OBJ "v 1 2 3x\n", 15, "'3x' where a number should stand"},
        {CUBE_OBJ "v 1 2 -", 15, "unexpected end of file after '-', where a number should stand"},
        {CUBE_OBJ "v 1 2 \x01\xffzzzzzzzzzzzzzzzzzzzzzzzzzzzzzzzzz ", 15, "'??zzzzzzzzzzzzzzzzzzzzzz...' where"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        check_refused_text("bad.obj", cases[i].text, cases[i].line, cases[i].words);
        char *crlf = replaced(cases[i].text, "\n", "\r");
        if (!strchr(cases[i].text, '\r'))
            check_refused_text("bad.obj", crlf, cases[i].line, cases[i].words);
        free(crlf);
    }
}

// a million vertices that any quadratic step would turn into hours
static void many_lines_and_many_corners_take_linear_time(void **state)
{
    (void)state;
    dem_buffer text = {0};
    dem_buffer_text(&text, CUBE_VERTICES);
    for (int i = 0; i < 300000; i++)
        dem_buffer_text(&text, "v 1 2 3\\\n\r");
    for (int i = 0; i < 300; i++) {
        dem_buffer_text(&text, "\nf");
        for (int k = 0; k < 500; k++)
            dem_buffer_print(&text, " %d", 1 + (k * k + i) % 8);
    }
    dem_mesh mesh;
    dem_error error;
    heard all;
    check_ok(parse("many.obj", text.data, text.size, &all, &mesh, &error), error);
    check(mesh.vertex_count == 300008 && mesh.triangle_count > 300 * 300);
    dem_mesh_free(&mesh);
    dem_buffer_release(&text);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_forms_of_an_obj_all_give_the_cube),
        cmocka_unit_test(line_ends_blanks_and_a_missing_last_newline_do_not_matter),
        cmocka_unit_test(lines_of_any_length_are_read),
        cmocka_unit_test(concave_faces_are_filled),
        cmocka_unit_test(what_is_left_out_is_said),
        cmocka_unit_test(what_is_wrong_is_said_with_its_line),
        cmocka_unit_test(many_lines_and_many_corners_take_linear_time),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
