#include "read_check.h"

#define VERTICES "0 0 0\n1 0 0\n1 1 0\n0 1 0\n0 0 1\n1 0 1\n1 1 1\n0 1 1\n"
#define FACES "4 3 2 1 0\n4 4 5 6 7\n4 0 1 5 4\n4 1 2 6 5\n4 2 3 7 6\n4 3 0 4 7\n"

static void the_forms_of_an_off_all_give_the_cube(void **state)
{
    (void)state;
    static const char *const forms[] = {
        "OFF\n8 6 12\n" VERTICES FACES,
        "OFF 8 6 12\n" VERTICES FACES,
        "OFF 8 6\n" VERTICES FACES,
        "\xef\xbb\xbf# made by hand\n\nOFF # a cube\n  # counts\n8\t6 0\n\n" VERTICES "# sides\n" FACES "# end\n\n",
        "8 6 12\n" VERTICES FACES,  // the header may be left out
        "COFF\n8 6 12\n0 0 0 255 0 0 1\n1 0 0 .5 .5 .5 1\n1 1 0\n0 1 0\n0 0 1\n1 0 1\n1 1 1\n0 1 1\n"
        "4 3 2 1 0 255 0 0\n4 4 5 6 7 0.1 0.2 0.3 0.4\n4 0 1 5 4 # red\n4 1 2 6 5\n4 2 3 7 6\n4 3 0 4 7\n",
        "STCNOFF 8 6 12\n" VERTICES FACES,
        "NOFF\n8 6 12\n0 0 0 0 0 1\n1 0 0 0 0 1\n1 1 0 0 0 1\n0 1 0 0 0 1\n0 0 1 0 0 1\n1 0 1 0 0 1\n1 1 1 0 0 1\n0 1 "
        "1 0 0 1\n" FACES,
    };
    static const char *const ends[] = {"\n", "\r\n", "\r", "\n\n"};
    for (size_t i = 0; i < sizeof forms / sizeof *forms; i++)
        for (size_t k = 0; k < sizeof ends / sizeof *ends; k++) {
            char *text = replaced(forms[i], "\n", ends[k]);
            check_cube_text("cube.off", text);
            check_cube("cube.off", text, strlen(text) - strlen(ends[k]), 0);
            free(text);
        }
}

static void a_file_cut_anywhere_is_refused(void **state)
{
    (void)state;
    const char *text = "OFF\n8 6 12\n" VERTICES FACES;
    for (size_t size = 0; size < strlen(text) - 1; size++) {
        dem_mesh mesh;
        dem_error error;
        heard all;
        check(parse("cut.off", text, size, &all, &mesh, &error) == DEM_BAD_INPUT);
    }
}

static void what_is_wrong_is_said_with_its_line(void **state)
{
    (void)state;
    static const struct {
        const char *text;
        long line;
        const char *words;
    } cases[] = {
        {"OFF\n400000000 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n", 2,
         "header says 400000000 vertices, file has room for 5"},
        {"OFF 3 400000000 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n", 1, "header says 400000000 faces, file has room for 1"},
        {"OFF 3 -1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n", 1, "negative counts"},
        {"OFF 3\n0 0 0\n", 1, "the line ends where a whole number should stand"},
        {"OFF\n\n# no more\n", 3, "unexpected end of file where the counts should stand"},
        {"OFF BINARY\n\0\0\0\10", 1, "binary OFF cannot be read"},
        {"4OFF 3 1 0\n", 1, "'4OFF' has vertices of other than 3 dimensions"},
        {"nOFF 4 3 1 0\n", 1, "'nOFF' has vertices of other than 3 dimensions"},
        {"OFF 3 0 0\n0 0 0\n1 0 0\n0 1 0\n", 0, "3 vertices but no faces"},
        {"OFF 3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n", 5, "face 1 refers to vertex 3 of 3 (counted from 0)"},
        {"OFF 3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 -1\n", 5, "face 1 refers to vertex -1 of 3"},
        {"OFF 3 1 0\n0 0 0\n1 0 0\n0 1 0\n2 0 1  0 \n", 5, "face 1 has 2 corners, 3 are needed"},
        {"OFF 3 1 0\n0 0 0\n1 0 0\n0 1 0\n-3 0 1\n", 5, "face 1 has -3 corners"},
        {"OFF 3 1 0\n0 0 0\n1 0 0\n0 1 0\n4 0 1 2\n", 5, "unexpected end of file where a whole number should stand"},
        {"OFF 3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2.5\n", 5, "'2.5' where a whole number should stand"},
        {"OFF 3 1 0\n0 0 0\n1 nan 0\n0 1 0\n3 0 1 2\n", 3, "vertex 2 is not finite"},
        {"OFF 3 1 0\n0 0 0\n1 0,5 0\n0 1 0\n3 0 1 2\n", 3, "'0,5' has a comma"},
        {"OFF 3 1 0\n0 0 0\n1 0\n0 1 0\n3 0 1 2\n", 3, "the line ends where a number should stand"},
        {"OFF 3 2 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n\n#     \n", 7, "header says 2 faces, 1 are there"},
        {"OFF 3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n3 2 1 0\n", 6, "data behind the 3 vertices and 1 faces"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
        check_refused_text("bad.off", cases[i].text, cases[i].line, cases[i].words);
    check_refused("no suffix", "OFF BINARY\n\0\0\0\10\0\0\0\6", 18, 1, "binary OFF cannot be read");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_forms_of_an_off_all_give_the_cube),
        cmocka_unit_test(a_file_cut_anywhere_is_refused),
        cmocka_unit_test(what_is_wrong_is_said_with_its_line),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
