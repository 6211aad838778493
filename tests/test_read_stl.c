#include "read_check.h"

static void put_float(dem_buffer *out, double value)
{
    float single = (float)value;
    uint32_t bits;
    memcpy(&bits, &single, sizeof bits);
    for (int k = 0; k < 4; k++)
        dem_buffer_bytes(out, (char[]){(char)(bits >> 8 * k)}, 1);
}

// the cube with a header of 80 bytes and a count of its own choice
static dem_buffer binary_cube(const char *header, uint32_t count)
{
    dem_buffer out = {0};
    char start[84] = {0};
    snprintf(start, 80, "%s", header);
    for (int k = 0; k < 4; k++)
        start[80 + k] = (char)(count >> 8 * k);
    dem_buffer_bytes(&out, start, sizeof start);
    for (int i = 0; i < 12; i++) {
        for (int k = 0; k < 3; k++)
            put_float(&out, NAN);  // normals do not matter
        for (int k = 0; k < 3; k++) {
            dem_vec3 p = cube_corners[cube_sides[i / 2][quad_halves[i % 2][k]]];
            put_float(&out, p.x);
            put_float(&out, p.y);
            put_float(&out, p.z);
        }
        dem_buffer_bytes(&out, "\x12\x34", 2);
    }
    return out;
}

// the facets of the cube as text
static dem_buffer text_facets(void)
{
    dem_buffer out = {0};
    for (int i = 0; i < 12; i++) {
        dem_buffer_text(&out, "facet normal 0 0 nan\n outer loop\n");
        for (int k = 0; k < 3; k++) {
            dem_vec3 p = cube_corners[cube_sides[i / 2][quad_halves[i % 2][k]]];
            dem_buffer_print(&out, "  vertex %d.0 %de-0 +%d\n", (int)p.x, (int)p.y, (int)p.z);
        }
        dem_buffer_text(&out, " endloop\nendfacet\n");
    }
    return out;
}

static void a_binary_stl_is_known_by_its_size(void **state)
{
    (void)state;
    dem_buffer plain = binary_cube("made by hand", 12), solid = binary_cube("solid cube\nfacet normal", 12);
    check_cube("cube.stl", plain.data, plain.size, 0);
    check_cube("cube.stl", solid.data, solid.size, 0);
    check_cube("no suffix", solid.data, solid.size, 0);
    check_cube("cube.obj", plain.data, plain.size, 1);
    dem_mesh mesh;
    dem_error error;
    heard all;
    check_ok(parse("cube.stl", plain.data, plain.size, &all, &mesh, &error), error);
    check(mesh.vertex_count == 36 && mesh.single_precision);
    dem_mesh_free(&mesh);
    dem_buffer_release(&plain);
    dem_buffer_release(&solid);
}

static void a_count_that_does_not_fit_is_refused(void **state)
{
    (void)state;
    static const uint32_t counts[] = {0, 6, 11, 13, 1000, 0x7fffffff, 0xffffffff};
    for (size_t i = 0; i < sizeof counts / sizeof *counts; i++) {
        char words[96];
        snprintf(words, sizeof words, "header says %u triangles, file has room for 12", counts[i]);
        dem_buffer wrong = binary_cube("solid or not", counts[i]);
        check_refused("bad.stl", wrong.data, wrong.size, 0, words);
        snprintf(words, sizeof words, "header would say %u triangles", counts[i]);
        check_refused("standard input", wrong.data, wrong.size, 0, words);
        dem_buffer_release(&wrong);
    }
    dem_buffer cut = binary_cube("x", 12);
    for (size_t size = 1; size < cut.size; size++) {
        dem_mesh mesh;
        dem_error error;
        heard all;
        check(parse("bad.stl", cut.data, size, &all, &mesh, &error) == DEM_BAD_INPUT);
    }
    check_refused("bad.stl", cut.data, 200, 0, "header says 12 triangles, file has room for 2");
    check_refused("bad.stl", cut.data, 50, 0, "50 bytes are too few for a binary STL");
    dem_buffer_bytes(&cut, "trailing", 8);
    check_refused("bad.stl", cut.data, cut.size, 0, "header says 12 triangles, file has room for 12");
    dem_buffer_release(&cut);
    char none[84] = "nothing in it";
    check_refused("bad.stl", none, sizeof none, 0, "no vertices and no faces");
}

static void a_corner_that_is_not_finite_is_refused_with_its_byte(void **state)
{
    (void)state;
    dem_buffer bad = binary_cube("x", 12);
    memcpy(bad.data + 84 + 50 * 4 + 12 + 12 + 4, (char[]){0, 0, (char)0xc0, 0x7f}, 4);
    check_refused("bad.stl", bad.data, bad.size, 0, "triangle 5 (byte 308) has a corner that is not finite");
    dem_buffer_release(&bad);
}

static void thirty_two_bits_far_from_the_origin_are_warned_of(void **state)
{
    (void)state;
    for (int far = 0; far < 2; far++) {
        dem_buffer out = binary_cube("x", 12);
        out.size = 84;
        for (int i = 0; i < 12; i++) {
            for (int k = 0; k < 12; k++)
                put_float(&out, k < 3 ? 0 : (far ? -1e6 : -1e3) + (k * k + i) % 3);
            dem_buffer_bytes(&out, "\0", 2);
        }
        dem_mesh mesh;
        dem_error error;
        heard all;
        check_ok(parse("far.stl", out.data, out.size, &all, &mesh, &error), error);
        check(all.warnings == far);
        if (far)  // the spacing of floats between 2^19 and 2^20
            assert_non_null(strstr(all.last,
                                   "3.46 across at coordinates of 1e+06, where the 32-bit numbers of the file lie "
                                   "0.062 apart"));
        dem_mesh_free(&mesh);
        dem_buffer_release(&out);
    }
}

static void the_forms_of_a_text_stl_all_give_the_cube(void **state)
{
    (void)state;
    dem_buffer facets = text_facets();
    static const char *const frames[][2] = {
        {"solid cube\n", "endsolid cube\n"},
        {"solid\n", "endsolid"},
        {"  SOLID a facet of \xc3\xa4\n", "EndSolid a facet\n\n\n"},
        {"\xef\xbb\xbfsolid\n\n", "endsolid\n"},
        {"solid one\nendsolid one\nsolid two\n", "endsolid two\nsolid three\nendsolid\n"},
    };
    static const char *const changes[][2] = {{"\n", "\n"}, {"\n", "\r\n"},     {"\n", "\r"}, {"\n", "\n\n"},
                                             {" ", "\n"},  {"facet", "FACET"}, {"e", "E"},   {"\n", "\n\t "}};
    for (size_t i = 0; i < sizeof frames / sizeof *frames; i++) {
        dem_buffer whole = {0};
        dem_buffer_text(&whole, frames[i][0]);
        for (size_t k = 0; k < sizeof changes / sizeof *changes; k++) {
            char *text = replaced(facets.data, changes[k][0], changes[k][1]);
            whole.size = strlen(frames[i][0]);
            dem_buffer_text(&whole, text);
            dem_buffer_text(&whole, frames[i][1]);
            check_cube_text("cube.stl", whole.data);
            free(text);
        }
        check_cube("cube.ply", whole.data, whole.size, 1);
        dem_buffer_release(&whole);
    }
    char *one_line = replaced(facets.data, "\n", " ");
    dem_buffer whole = {0};
    dem_buffer_print(&whole, "solid facet facet of stone ");
    dem_buffer_text(&whole, one_line);
    dem_buffer_text(&whole, "endsolid");
    check_cube_text("cube.stl", whole.data);
    free(one_line);
    dem_buffer_release(&whole);
    dem_buffer_release(&facets);
}

static void a_text_stl_cut_anywhere_is_refused_or_warned_of(void **state)
{
    (void)state;
    dem_buffer text = {0}, facets = text_facets();
    dem_buffer_text(&text, "solid cube\n");
    dem_buffer_text(&text, facets.data);
    for (size_t size = 1; size <= text.size; size++) {
        dem_mesh mesh;
        dem_error error;
        heard all;
        dem_status status = parse("cut.stl", text.data, size, &all, &mesh, &error);
        if (status == DEM_OK) {  // between two facets
            check(all.warnings == 1 && strstr(all.last, "without 'endsolid'"));
            dem_mesh_free(&mesh);
        } else {
            check(status == DEM_BAD_INPUT && (size < 12 || error.line > 0 || strstr(error.text, "no vertices")));
        }
    }
    check_refused("cut.stl", text.data, 300, 19, "unexpected end of file after 'verte', where 'vertex' or");
    dem_buffer_release(&text);
    dem_buffer_release(&facets);
}

static void what_is_wrong_is_said_with_its_line(void **state)
{
    (void)state;
#define FACET(corners) "solid x\nfacet normal 0 0 1\nouter loop\n" corners "endloop\nendfacet\nendsolid\n"
    static const struct {
        const char *text;
        long line;
        const char *words;
    } cases[] = {
        {"solid x\nendsolid x\n", 0, "no vertices and no faces"},
        {FACET("vertex 0 0 0\nvertex 1 0 0\n"), 7, "face 1 has 2 corners, 3 are needed"},
        {FACET("vertex 0 0 0\nvertex 1,5 0 0\n"), 5, "'1,5' has a comma"},
        {FACET("vertex 0 0 0\nvertex 1 inf 0\n"), 5, "vertex 2 is not finite"},
        {FACET("vertex 0 0 0\nvertex 1 x 0\n"), 5, "'x' where a number should stand"},
        {FACET("vertex 0 0 0\nvertex 1 0\nvertex 0 0 0\n"), 6, "'vertex' where a number"},
        {FACET("vertex 0 0 0\nvortex 1 0 0\n"), 5, "'vortex' where 'vertex' or 'endloop' should stand"},
        {"solid x\nfacet normal 0 0 1\nvertex 0 0 0\n", 3, "'vertex' where 'outer loop'"},
        {"solid x\nfacet normal 0 0 1\nouter lop\n", 3, "'lop' where 'loop'"},
        {"solid x\nfacets\n", 2, "'facets' where 'facet' or 'endsolid' should stand"},
        {"solid gold\nis heavy\n", 2, "'is' where 'facet'"},
        {FACET("vertex 0 0 0\nvertex 1 0 0\nvertex 1 1 0\n") "facet normal 0 0 1\nouter loop\nvertex 1 2\n\n", 13,
         "unexpected end of file where a number should stand"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
        check_refused_text("bad.stl", cases[i].text, cases[i].line, cases[i].words);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_binary_stl_is_known_by_its_size),
        cmocka_unit_test(a_count_that_does_not_fit_is_refused),
        cmocka_unit_test(a_corner_that_is_not_finite_is_refused_with_its_byte),
        cmocka_unit_test(thirty_two_bits_far_from_the_origin_are_warned_of),
        cmocka_unit_test(the_forms_of_a_text_stl_all_give_the_cube),
        cmocka_unit_test(a_text_stl_cut_anywhere_is_refused_or_warned_of),
        cmocka_unit_test(what_is_wrong_is_said_with_its_line),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
