#include "read_check.h"

enum { TEXT, LITTLE, BIG };
static const char *const forms[] = {"ascii", "binary_little_endian", "binary_big_endian"};

// one number in one of the eight types, as text or bytes
static void put(dem_buffer *out, int form, const char *type, double value)
{
    if (form == TEXT) {
        dem_buffer_number(out, value, 17);
        dem_buffer_text(out, " ");
        return;
    }
    static const char *const names[] = {"char", "uint8", "int16", "ushort", "int32", "uint", "float", "double"};
    static const size_t sizes[] = {1, 1, 2, 2, 4, 4, 4, 8};
    size_t k = 0;
    while (strcmp(names[k], type) != 0)
        k++;
    float single = k == 6 ? (float)value : 0;
    uint32_t single_bits;
    uint64_t bits;
    memcpy(&single_bits, &single, 4);
    memcpy(&bits, &value, 8);
    if (k == 6)
        bits = single_bits;
    if (k < 6)
        bits = (uint64_t)(int64_t)value;
    for (size_t i = 0; i < sizes[k]; i++)
        dem_buffer_bytes(out, (char[]){(char)(bits >> 8 * (form == LITTLE ? i : sizes[k] - 1 - i))}, 1);
}

static void end_line(dem_buffer *out, int form)
{
    if (form == TEXT)
        dem_buffer_text(out, "\n");
}

static void put_corners(dem_buffer *out, int form, const char *coordinate)
{
    for (int i = 0; i < 8; i++) {
        put(out, form, coordinate, cube_corners[i].x);
        put(out, form, coordinate, cube_corners[i].y);
        put(out, form, coordinate, cube_corners[i].z);
        end_line(out, form);
    }
}

static void put_sides(dem_buffer *out, int form, const char *length, const char *index)
{
    for (int i = 0; i < 6; i++) {
        put(out, form, length, 4);
        for (int k = 0; k < 4; k++)
            put(out, form, index, cube_sides[i][k]);
        end_line(out, form);
    }
}

// a plain cube
static dem_buffer cube(int form, const char *coordinate, const char *length, const char *index)
{
    dem_buffer out = {0};
    dem_buffer_print(&out, "ply\nformat %s 1.0\ncomment made by hand\nelement vertex 8\n", forms[form]);
    dem_buffer_print(&out, "property %s x\nproperty %s y\nproperty %s z\n", coordinate, coordinate, coordinate);
    dem_buffer_print(&out, "element face 6\nproperty list %s %s vertex_indices\nend_header\n", length, index);
    put_corners(&out, form, coordinate);
    put_sides(&out, form, length, index);
    return out;
}

static void all_types_and_byte_orders_give_the_cube(void **state)
{
    (void)state;
    static const char *const coordinates[] = {"char", "uint8", "int16", "ushort", "int32", "uint", "float", "double"};
    for (int form = TEXT; form <= BIG; form++)
        for (int c = 0; c < 8; c++)
            for (int length = 0; length < 6; length++) {
                dem_buffer file = cube(form, coordinates[c], coordinates[length], coordinates[7 - length]);
                check_cube("cube.ply", file.data, file.size, 0);
                dem_mesh mesh;
                dem_error error;
                heard all;
                check_ok(parse("cube.ply", file.data, file.size, &all, &mesh, &error), error);
                check(mesh.single_precision == (form != TEXT && c == 6));
                dem_mesh_free(&mesh);
                dem_buffer_release(&file);
            }
}

// faces before vertices, further elements and properties everywhere, lists in vertices, elements of nothing
static void what_is_not_needed_is_skipped(void **state)
{
    (void)state;
    for (int form = TEXT; form <= BIG; form++) {
        dem_buffer out = {0};
        dem_buffer_print(&out,
                         "ply\nformat %s 1.0\nobj_info x\nelement camera 2\nproperty uint8 a\nproperty double b\n"
                         "element face 6\nproperty float quality\nproperty list uint8 int32 vertex_index\n"
                         "property list uint8 float texcoord\nelement nothing 400000000\n",
                         forms[form]);
        dem_buffer_text(&out,
                        "element vertex 8\nproperty double nx\nproperty double x\nproperty list uint8 int16 near\n"
                        "property double z\nproperty double y\nelement edge 1\nproperty list uint8 int16 ends\n"
                        "property int32 a\nend_header\n");
        for (int i = 0; i < 2; i++) {
            put(&out, form, "uint8", 7);
            put(&out, form, "double", 1e300);
            end_line(&out, form);
        }
        for (int i = 0; i < 6; i++) {
            put(&out, form, "float", 0.5);
            put(&out, form, "uint8", 4);
            for (int k = 0; k < 4; k++)
                put(&out, form, "int32", cube_sides[i][k]);
            put(&out, form, "uint8", i);
            for (int k = 0; k < i; k++)
                put(&out, form, "float", 0.25);
            end_line(&out, form);
        }
        for (int i = 0; i < 8; i++) {
            put(&out, form, "double", NAN);
            put(&out, form, "double", cube_corners[i].x);
            put(&out, form, "uint8", i % 3);
            for (int k = 0; k < i % 3; k++)
                put(&out, form, "int16", -1);
            put(&out, form, "double", cube_corners[i].z);
            put(&out, form, "double", cube_corners[i].y);
            end_line(&out, form);
        }
        put(&out, form, "uint8", 2);
        put(&out, form, "int16", 0);
        put(&out, form, "int16", 1);
        put(&out, form, "int32", 9);
        end_line(&out, form);
        check_cube("cube.ply", out.data, out.size, 0);
        dem_buffer_text(&out, "\n");
        check_cube("cube.ply", out.data, out.size, 0);
        dem_buffer_text(&out, "1 2 3\n");
        check_refused("cube.ply", out.data, out.size, form == TEXT ? 38 : 0, "behind the last element of the header");
        dem_buffer_release(&out);
    }
}

static void a_header_may_end_its_lines_in_any_way(void **state)
{
    (void)state;
    static const char *const ends[] = {"\n", "\r\n", "\r"};
    for (int form = TEXT; form <= BIG; form++)
        for (int k = 0; k < 3; k++) {
            // the first byte of the data is a line feed: 10 vertices of one byte
            dem_buffer file = {0}, header = {0};
            dem_buffer_print(&header,
                             "ply\nformat %s 1.0\nelement odd 1\nproperty uint8 a\nelement vertex 8\nproperty float x\n"
                             "property float y\nproperty float z\nelement face 6\n"
                             "property list uint8 uint8 vertex_indices\nend_header\n",
                             forms[form]);
            char *text = replaced(header.data, "\n", ends[k]);
            dem_buffer_text(&file, text);
            put(&file, form, "uint8", 10);
            end_line(&file, form);
            put_corners(&file, form, "float");
            put_sides(&file, form, "uint8", "uint8");
            check_cube("cube.ply", file.data, file.size, 0);
            free(text);
            dem_buffer_release(&header);
            dem_buffer_release(&file);
        }
}

static void a_file_cut_anywhere_is_refused(void **state)
{
    (void)state;
    for (int form = TEXT; form <= BIG; form++) {
        dem_buffer file = cube(form, "float", "uint8", "int32");
        size_t least = file.size - (form == TEXT ? 3 : 1);  // without the last blank and newline it is still whole
        for (size_t size = 0; size <= least; size++) {
            dem_mesh mesh;
            dem_error error;
            heard all;
            if (parse("cut.ply", file.data, size, &all, &mesh, &error) != DEM_BAD_INPUT)
                fail_msg("%s is read with %zu of %zu bytes", forms[form], size, file.size);
        }
        dem_buffer_release(&file);
    }
}

#define HEAD "ply\nformat ascii 1.0\n"
#define XYZ "property float x\nproperty float y\nproperty float z\n"
#define FACES(n) "element face " #n "\nproperty list uchar int vertex_indices\nend_header\n"
#define THREE HEAD "element vertex 3\n" XYZ

static void what_is_wrong_is_said_with_its_line(void **state)
{
    (void)state;
    static const struct {
        const char *text;
        long line;
        const char *words;
    } cases[] = {
        {HEAD "element vertex 400000000\n" XYZ FACES(1) "0 0 0\n3 0 0 0\n", 9,
         "header says 400000000 of element 'vertex', file has room for 2"},
        {THREE FACES(1000) "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n", 12,
         "header says 1000 of element 'face', file has room for 4"},
        {THREE "end_header\n0 0 0\n1 0 0\n0 1 0\n", 0, "3 vertices but no faces"},
        {THREE FACES(0) "0 0 0\n1 0 0\n0 1 0\n", 0, "3 vertices but no faces"},
        {THREE FACES(1) "0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n", 13, "face 1 refers to vertex 3 of 3 (counted from 0)"},
        {THREE FACES(1) "0 0 0\n1 0 0\n0 1 0\n3 0 1 -1\n", 13, "face 1 refers to vertex -1 of 3"},
        {THREE FACES(1) "0 0 0\n1 0 0\n0 1 0\n3 0 1 1e300\n", 13, "a vertex whose number is not whole"},
        {THREE FACES(1) "0 0 0\n1 0 0\n0 1 0\n3 0 1 nan\n", 13, "a vertex whose number is not whole"},
        {THREE FACES(1) "0 0 0\n1 0 0\n0 1 0\n2 0 1\n", 13, "face 1 has 2 corners, 3 are needed"},
        {THREE FACES(1) "0 0 0\n1 0 0\n0 1 0\n-3 0 1 2\n", 13, "length below 0 or not whole"},
        {THREE FACES(1) "0 0 0\n1 0 0\n0 1 0\n3.5 0 1 2\n", 13, "length below 0 or not whole"},
        {THREE FACES(1) "0 0 0\n1 0 0\n0 1 0\n4000000000 0 1 2\n", 13, "a list of 4000000000 items"},
        {THREE FACES(1) "0 0 0\n1 0 0\n0 1 0\n3 0 1\n", 13, "unexpected end of file where a number should stand"},
        {THREE FACES(1) "0 0 0\n1 0\n0 1 0\n3 0 1 2\n", 11, "the line ends where a number should stand"},
        {THREE FACES(1) "0 0 0\n1 0,5 0\n0 1 0\n3 0 1 2\n", 11, "'0,5' has a comma"},
        {THREE FACES(1) "0 0 0\n\n1 0 inf\n0 1 0\n3 0 1 2\n", 12, "vertex 2 is not finite"},
        {THREE FACES(1) "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n3 2 1 0\n", 13, "8 bytes behind the last element"},
        {THREE "element tristrips 1\nproperty list int int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n",
         9, "triangle strips instead of faces"},
        {HEAD "element vertex 3\nproperty float x\nproperty float y\n" FACES(1), 8, "no vertices with x, y and z"},
        {HEAD "element vertex 3\nproperty list uchar float x\n", 4, "coordinates must be single numbers"},
        {THREE "element face 1\nproperty int vertex_indices\nend_header\n", 8, "vertex_indices a list"},
        {THREE "element face 1\nproperty int a\nend_header\n", 9, "the faces have no 'vertex_indices'"},
        {THREE "element face 1\nproperty list float int vertex_indices\nend_header\n", 8, "counted in floating point"},
        {THREE "element vertex 3\n", 7, "a second element 'vertex'"},
        {HEAD "element vertex -1\n", 3, "header says -1 of element 'vertex'"},
        {HEAD "element vertex 99999999999999999999\n", 3, "where a whole number should stand"},
        {HEAD "property float x\n", 3, "a property before the first element"},
        {HEAD "element vertex 3\nproperty real x\n", 4, "'real' where a PLY type should stand"},
        {HEAD "elements 3\n", 3, "'elements' where a line of the PLY header should stand"},
        {"ply\nformat binary 1.0\n", 2, "'binary' where the format ascii, binary_little_endian"},
        {"ply\nelement vertex 3\n" XYZ FACES(1), 8, "no 'format' line"},
        {THREE, 6, "unexpected end of file where 'end_header' should stand"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
        check_refused_text("bad.ply", cases[i].text, cases[i].line, cases[i].words);
}

static void wrong_binary_data_are_named_by_face_and_vertex(void **state)
{
    (void)state;
    for (int form = LITTLE; form <= BIG; form++) {
        dem_buffer file = cube(form, "float", "uint8", "int32");
        size_t faces = file.size - 6 * 17, vertices = faces - 8 * 12;
        memset(file.data + vertices + 12 * 3, 0xff, 4);
        check_refused("bad.ply", file.data, file.size, 0, "vertex 4 is not finite");
        memset(file.data + vertices + 12 * 3, 0, 4);
        memset(file.data + faces + 17 + 1, 0x7f, 4);
        check_refused("bad.ply", file.data, file.size, 0, "face 2 refers to vertex 2139062143 of 8");
        file.data[faces + 17] = (char)255;
        check_refused("bad.ply", file.data, file.size, 0,
                      "a list of 255 items in element 'face', file has room for 21");
        file.data[faces + 17] = 0;
        check_refused("bad.ply", file.data, file.size, 0, "face 2 has 0 corners");
        dem_buffer_release(&file);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(all_types_and_byte_orders_give_the_cube),
        cmocka_unit_test(what_is_not_needed_is_skipped),
        cmocka_unit_test(a_header_may_end_its_lines_in_any_way),
        cmocka_unit_test(a_file_cut_anywhere_is_refused),
        cmocka_unit_test(what_is_wrong_is_said_with_its_line),
        cmocka_unit_test(wrong_binary_data_are_named_by_face_and_vertex),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
