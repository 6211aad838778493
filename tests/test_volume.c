#include "folder.h"

#include <zlib.h>

#include "base/text.h"
#include "mesh/volume.h"

// a file in memory, read as one that lies in a folder of its own
static dem_status parse(const char *bytes, size_t size, const char *raw_text, dem_volume *volume, dem_error *error)
{
    dem_volume_raw raw = {0};
    dem_buffer buffer = {.data = malloc(size + 1), .size = size, .capacity = size + 1};
    assert_non_null(buffer.data);
    memcpy(buffer.data, bytes, size);
    buffer.data[size] = 0;
    *error = (dem_error){0};
    if (raw_text)
        check_ok(dem_volume_raw_parse(raw_text, &raw, error), *error);
    return dem_volume_read_bytes(NULL, "scan", NULL, &buffer, &raw, volume, error);
}

// 4 x 3 x 2 voxels that hold 0, 1, 2, ...
enum { NX = 4, NY = 3, NZ = 2, COUNT = NX * NY * NZ };

static void check_counting_(const dem_volume *v, int line)
{
    _assert_int_equal(v->size[0], NX, __FILE__, line);
    _assert_int_equal(v->size[1], NY, __FILE__, line);
    _assert_int_equal(v->size[2], NZ, __FILE__, line);
    for (size_t i = 0; i < COUNT; i++)
        _assert_int_equal(dem_volume_label(v, i), i, __FILE__, line);
}

static void check_counting(const dem_buffer *file, const char *raw, int line)
{
    dem_volume v;
    dem_error error;
    assert_false(file->failed);
    if (parse(file->data, file->size, raw, &v, &error) != DEM_OK) {
        print_error("%s:%ld: %s\n", error.file, error.line, error.text);
        _fail(__FILE__, line);
    }
    check_counting_(&v, line);
    dem_volume_free(&v);
}

// a voxel as a file has it
static void put_voxel(dem_buffer *out, double value, dem_voxel_type type, bool big)
{
    static const int bytes[] = {1, 1, 2, 2, 4, 4, 8, 8, 4, 8};
    unsigned char b[8];
    if (type == DEM_VOXEL_FLOAT) {
        float f = (float)value;
        memcpy(b, &f, 4);
    } else if (type == DEM_VOXEL_DOUBLE) {
        memcpy(b, &value, 8);
    } else {
        int64_t whole = (int64_t)value;
        memcpy(b, &whole, 8);
    }
    int n = bytes[type];
    for (int i = 0; i < n; i++)  // the tests' machines are little-endian, as every one this runs on
        dem_buffer_bytes(out, &b[big ? n - 1 - i : i], 1);
}

static void put_voxels(dem_buffer *out, dem_voxel_type type, bool big)
{
    for (int i = 0; i < COUNT; i++)
        put_voxel(out, i, type, big);
}

static void put_gzip(dem_buffer *out, const dem_buffer *plain, int window_bits)
{
    unsigned char packed[4096];
    z_stream z = {.next_in = (unsigned char *)plain->data,
                  .avail_in = (uInt)plain->size,
                  .next_out = packed,
                  .avail_out = sizeof packed};
    assert_int_equal(deflateInit2(&z, 9, Z_DEFLATED, window_bits, 8, Z_DEFAULT_STRATEGY), Z_OK);
    assert_int_equal(deflate(&z, Z_FINISH), Z_STREAM_END);
    dem_buffer_bytes(out, packed, z.total_out);
    deflateEnd(&z);
}

static const char *const nrrd_types[] = {"uchar", "int8_t", "unsigned short", "short", "uint",
                                         "int",   "uint64", "long long",      "float", "double"};

static void every_type_and_order_of_nrrd_is_read(void **state)
{
    (void)state;
    for (int type = DEM_VOXEL_UINT8; type <= DEM_VOXEL_DOUBLE; type++)
        for (int big = 0; big < 2; big++)
            for (int packed = 0; packed < 2; packed++) {
                dem_buffer file = {0}, plain = {0};
                dem_buffer_print(&file,
                                 "NRRD0004\n# a comment\ntype: %s\ndimension: 3\nsizes: 4 3 2\nencoding: %s\n"
                                 "endian: %s\nkey:=value: with colon\nspacings: 1 2 3\n\n",
                                 nrrd_types[type], packed ? "gzip" : "raw", big ? "big" : "little");
                put_voxels(&plain, (dem_voxel_type)type, big);
                if (packed)
                    put_gzip(&file, &plain, 15 + 16);
                else
                    dem_buffer_bytes(&file, plain.data, plain.size);
                check_counting(&file, NULL, __LINE__);
                dem_buffer_release(&file);
                dem_buffer_release(&plain);
            }
}

static void text_skips_and_spare_axes_are_read(void **state)
{
    (void)state;
    dem_buffer file = {0};
    dem_buffer_text(&file, "NRRD0005\r\ntype: int\r\ndimension: 4\r\nsizes: 4 1 3 2\r\nencoding: ascii\r\n"
                           "space directions: (1,0,0) none (0,2,0) (0,0,3)\r\nspace origin: (5,6,7)\r\n"
                           "space units: \"mm\" \"mm\" \"mm\"\r\n\r\n");
    for (int i = 0; i < COUNT; i++)
        dem_buffer_print(&file, "%d%s", i, i % 7 ? " " : "\n");
    check_counting(&file, NULL, __LINE__);
    dem_volume v;
    dem_error error;
    check_ok(parse(file.data, file.size, NULL, &v, &error), error);
    check(v.spaced);
    check_near(v.unit, 1e-3, 0);
    check_near(dem_volume_voxel(&v), 6, 1e-15);
    check_vec(v.axes[2], ((dem_vec3){0, 0, 3}), 0);
    check_vec(v.origin, ((dem_vec3){5, 6, 7}), 0);
    dem_volume_free(&v);
    dem_buffer_release(&file);
    dem_buffer skipping = {0};
    dem_buffer_text(&skipping, "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 4 3 2\nencoding: raw\nline skip: 1\n"
                               "byte skip: 2\n\na line\nab");
    put_voxels(&skipping, DEM_VOXEL_UINT8, false);
    check_counting(&skipping, NULL, __LINE__);
    dem_buffer_release(&skipping);
    dem_buffer at_end = {0};
    dem_buffer_text(&at_end,
                    "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 4 3 2\nencoding: raw\nbyte skip: -1\n\nanything");
    put_voxels(&at_end, DEM_VOXEL_UINT8, false);
    check_counting(&at_end, NULL, __LINE__);
    dem_buffer_release(&at_end);
}

static void meta_images_are_read(void **state)
{
    (void)state;
    for (int packed = 0; packed < 2; packed++)
        for (int big = 0; big < 2; big++) {
            dem_buffer file = {0}, plain = {0};
            dem_buffer_print(&file,
                             "ObjectType = Image\nNDims = 3\nBinaryData = True\nBinaryDataByteOrderMSB = %s\n"
                             "CompressedData = %s\nTransformMatrix = 0 1 0 1 0 0 0 0 1\nOffset = 1 2 3\n"
                             "ElementSpacing = 0.5 0.5 2\nDimSize = 4 3 2\nElementType = MET_USHORT\n"
                             "ElementDataFile = LOCAL\n",
                             big ? "True" : "False", packed ? "True" : "False");
            put_voxels(&plain, DEM_VOXEL_UINT16, big);
            if (packed)
                put_gzip(&file, &plain, 15);
            else
                dem_buffer_bytes(&file, plain.data, plain.size);
            check_counting(&file, NULL, __LINE__);
            dem_volume v;
            dem_error error;
            check_ok(parse(file.data, file.size, NULL, &v, &error), error);
            check_vec(v.axes[0], ((dem_vec3){0, 0.5, 0}), 0);
            check_vec(v.origin, ((dem_vec3){1, 2, 3}), 0);
            dem_volume_free(&v);
            dem_buffer_release(&file);
            dem_buffer_release(&plain);
        }
}

static void raw_voxels_are_read_if_the_size_is_right(void **state)
{
    (void)state;
    dem_buffer file = {0};
    dem_buffer_text(&file, "abcde");
    put_voxels(&file, DEM_VOXEL_INT32, true);
    check_counting(&file, "4x3x2 int32 big skip 5", __LINE__);
    check_counting(&file, "4x3x2,int32,big,skip,5", __LINE__);
    dem_volume v;
    dem_error error;
    check(parse(file.data, file.size, "4x3x2 int32 big", &v, &error) == DEM_BAD_INPUT);
    check(strstr(error.text, "--raw") != NULL);
    dem_buffer_release(&file);
    static const char *const wrong[] = {"",
                                        "4x3 uint8",
                                        "4x3x2",
                                        "4x3x2 uint9",
                                        "0x3x2 uint8",
                                        "-1x3x2 uint8",
                                        "4x3x2x5 uint8",
                                        "4x3x2 uint8 skip",
                                        "4x3x2 uint8 skip -1",
                                        "999999999x999999999x999999999 uint8"};
    dem_volume_raw raw;
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++)
        check(dem_volume_raw_parse(wrong[i], &raw, &error) == DEM_USAGE);
}

static void data_beside_the_header_are_found(void **state)
{
    (void)state;
    dem_buffer header = {0}, data = {0};
    dem_error error;
    dem_volume v;
    dem_buffer_text(&header, "NRRD0004\ntype: uint16\nendian: big\ndimension: 3\nsizes: 4 3 2\nencoding: raw\n"
                             "data file: voxels.raw\n");
    put_voxels(&data, DEM_VOXEL_UINT16, true);
    check_ok(dem_file_write_buffer(in_folder("scan.nhdr"), &header, &error), error);
    check(dem_volume_read(NULL, in_folder("scan.nhdr"), NULL, &v, &error) == DEM_BAD_INPUT);
    check(strstr(error.text, "voxels.raw") != NULL);
    check_ok(dem_file_write_buffer(in_folder("voxels.raw"), &data, &error), error);
    check_ok(dem_volume_read(NULL, in_folder("scan.nhdr"), NULL, &v, &error), error);
    check_counting_(&v, __LINE__);
    dem_volume_free(&v);
    dem_buffer_text(&header, "NDims = 3\nDimSize = 4 3 2\nElementType = MET_USHORT\nElementByteOrderMSB = True\n"
                             "ElementDataFile = voxels.raw\n");
    check_ok(dem_file_write_buffer(in_folder("scan.mhd"), &header, &error), error);
    check_ok(dem_volume_read(NULL, in_folder("scan.mhd"), NULL, &v, &error), error);
    check_counting_(&v, __LINE__);
    dem_volume_free(&v);
}

static void refused(const char *text, size_t size, long at_line, const char *words)
{
    dem_volume v;
    dem_error error;
    dem_status status = parse(text, size, NULL, &v, &error);
    if (status != DEM_BAD_INPUT || !strstr(error.text, words) || !strchr(error.text, ';') || strchr(error.text, '\n') ||
        (at_line && error.line != at_line) || v.labels) {
        print_error("%.300s\nstatus %d: line %ld: %s\nwant line %ld: %s\n", text, status, error.line, error.text,
                    at_line, words);
        fail();
    }
}

#define NRRD_HEAD "NRRD0004\ntype: uint8\ndimension: 3\n"
static void malformed_volumes_are_refused(void **state)
{
    (void)state;
    static const struct {
        const char *text, *words;
        long line;
    } cases[] = {
        {NRRD_HEAD "sizes: 4 3 2\nencoding: raw\n\nabc", "24 bytes", 0},
        {NRRD_HEAD "sizes: 1000000000 1000000000 1000000000\nencoding: raw\n\nabc", "more than a computer", 0},
        {NRRD_HEAD "sizes: 100000 100000 90\nencoding: gzip\n\nabc", "cannot hold", 0},
        {NRRD_HEAD "sizes: 4 0 2\nencoding: raw\n\nabc", "size of 0", 0},
        {NRRD_HEAD "sizes: 4 -3 2\nencoding: raw\n\nabc", "size of -3", 0},
        {NRRD_HEAD "sizes: 4 2.5 2\nencoding: raw\n\nabc", "size of 2.5", 0},
        {NRRD_HEAD "sizes: 4 nan 2\nencoding: raw\n\nabc", "size of", 0},
        {NRRD_HEAD "sizes: 4 3\nencoding: raw\n\nabc", "do not agree", 0},
        {NRRD_HEAD "sizes: 4 x 2\nencoding: raw\n\nabc", "cannot be read", 4},
        {NRRD_HEAD "sizes: 1 1 1\nencoding: raw\n", "blank line", 0},
        {NRRD_HEAD "sizes: 1 1 1\nencoding: raw", "blank line", 0},
        {NRRD_HEAD "sizes: 1 1 1\nencoding: bzip2\n\nabc", "bzip2", 5},
        {NRRD_HEAD "sizes: 1 1 1\n\na", "'encoding' is missing", 0},
        {NRRD_HEAD "sizes: 1 1 1\nencoding: raw\nspacings: 1 0 1\n\na", "not positive", 0},
        {NRRD_HEAD "sizes: 1 1 1\nencoding: raw\nspacings: 1 -1 1\n\na", "not positive", 0},
        {NRRD_HEAD "sizes: 1 1 1\nencoding: raw\nspacings: nan nan nan\n\na", "not positive", 0},
        {NRRD_HEAD "sizes: 1 1 1\nencoding: raw\nspace directions: (1,0,0) (1,0,0) (0,0,1)\n\na", "no volume", 0},
        {NRRD_HEAD "sizes: 1 1 1\nencoding: raw\nspace directions: (1,0) (1,0) (0,0)\n\na", "three numbers", 6},
        {NRRD_HEAD "sizes: 1 1 1\nencoding: raw\nspace directions: none none none\n\na", "no volume", 0},
        {NRRD_HEAD "sizes: 1 1 1\nencoding: raw\ndata file: LIST\n\na", "many files", 6},
        {NRRD_HEAD "sizes: 1 1 1\nencoding: raw\ndata file: x.raw\n\na", "another file", 0},
        {NRRD_HEAD "sizes: 1 1 1\nencoding: raw\nbyte skip: 99\n\na", "pass over 99", 0},
        {NRRD_HEAD "sizes: 1 1 1\nencoding: raw\nline skip: 9\n\na", "line skip", 0},
        {NRRD_HEAD "sizes: 1 1 1\nencoding: ascii\n\nx", "no number", 0},
        {NRRD_HEAD "sizes: 2 1 1\nencoding: ascii\n\n1", "cut short", 0},
        {NRRD_HEAD "sizes: 1 1 1\nencoding: ascii\n\n0.5", "no label", 0},
        {NRRD_HEAD "sizes: 1 1 1\nencoding: ascii\n\nnan", "no label", 0},
        {NRRD_HEAD "sizes: 1 1 1\nencoding: ascii\n\n1e10", "no label", 0},
        {NRRD_HEAD "sizes: 4 3 2\nencoding: gzip\n\nno gzip at all, but long enough", "damaged", 0},
        {"NRRD0004\ntype: uint16\ndimension: 3\nsizes: 1 1 1\nencoding: raw\n\nab", "endian", 0},
        {"NRRD0004\ntype: block\ndimension: 3\nsizes: 1 1 1\nencoding: raw\n\nab", "block", 2},
        {"NRRD0004\ntype: uint8\ndimension: 2\nsizes: 1 1\nencoding: raw\n\nab", "2 axes", 0},
        {"NRRD0004\ntype: uint8\ndimension: 4\nsizes: 3 1 2 2\nsizes: 3 2 2 2\nencoding: raw\n\nab", "4 axes", 0},
        {"NRRD0004\ntype: uint8\ndimension: 99\nsizes: 1 1\nencoding: raw\n\nab", "cannot be read", 3},
        {"NRRD0004\nno field\n\n", "blank line", 2},
        {"a file of text\n", "MetaImage", 1},
        {"NDims = 3\n", "ElementDataFile", 0},
        {"NDims = 3\nDimSize = 1 1 1\nElementDataFile = LOCAL\na", "ElementType", 0},
        {"NDims = 2\nDimSize = 1 1\nElementType = MET_UCHAR\nElementDataFile = LOCAL\na", "NDims is 2", 0},
        {"NDims = 3\nDimSize = 1 1 1\nElementType = MET_OTHER\nElementDataFile = LOCAL\na", "MET_OTHER", 3},
        {"NDims = 3\nDimSize = 1 1 1\nElementType = MET_UCHAR\nElementSpacing = 1 0 1\nElementDataFile = LOCAL\na",
         "positive", 0},
        {"NDims = 3\nDimSize = 1 1 1\nElementType = MET_UCHAR\nElementNumberOfChannels = 3\nElementDataFile = LOCAL\na",
         "3 values", 4},
        {"NDims = 3\nDimSize = 9 9 9\nElementType = MET_UCHAR\nElementDataFile = LOCAL\na", "729 bytes", 0},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
        refused(cases[i].text, strlen(cases[i].text), cases[i].line, cases[i].words);
}

static void packed_data_of_another_size_are_refused(void **state)
{
    (void)state;
    dem_buffer plain = {0};
    for (int i = 0; i < 100000; i++)
        dem_buffer_bytes(&plain, "", 1);
    for (int k = 0; k < 3; k++) {
        dem_buffer file = {0};
        // fewer voxels than data (as a bomb would have), more, and data that are cut
        dem_buffer_print(&file, NRRD_HEAD "sizes: %d 100 10\nencoding: gzip\n\n", k == 0 ? 50 : k == 1 ? 101 : 100);
        put_gzip(&file, &plain, 15 + 16);
        refused(file.data, file.size - (k == 2 ? 12 : 0), 0, k == 0 ? "more than" : k == 1 ? "of 101000" : "cut short");
        dem_buffer_release(&file);
    }
    dem_buffer_release(&plain);
}

// cut anywhere, a file is refused and nothing is read beyond it
static void every_cut_is_refused(void **state)
{
    (void)state;
    dem_buffer file = {0};
    dem_buffer_text(&file, NRRD_HEAD "sizes: 4 3 2\nencoding: raw\n\n");
    put_voxels(&file, DEM_VOXEL_UINT8, false);
    for (size_t size = 0; size < file.size; size++)
        refused(file.data, size, 0, "");
    dem_buffer_release(&file);
}

static void values_below_zero_are_background(void **state)
{
    (void)state;
    static const char text[] = NRRD_HEAD "sizes: 3 1 1\nencoding: ascii\n\n-1 5 4294967295";
    static const char bytes[] = "NRRD0004\ntype: int8\ndimension: 3\nsizes: 3 1 1\nencoding: raw\n\n\xff\x05\x7f";
    dem_volume v;
    dem_error error;
    check_ok(parse(text, sizeof text - 1, NULL, &v, &error), error);
    check(dem_volume_label(&v, 0) == 0 && dem_volume_label(&v, 1) == 5 && dem_volume_label(&v, 2) == 4294967295);
    dem_volume_free(&v);
    check_ok(parse(bytes, sizeof bytes - 1, NULL, &v, &error), error);
    check(dem_volume_label(&v, 0) == 0 && dem_volume_label(&v, 1) == 5 && dem_volume_label(&v, 2) == 127);
    dem_volume_free(&v);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_type_and_order_of_nrrd_is_read),
        cmocka_unit_test(text_skips_and_spare_axes_are_read),
        cmocka_unit_test(meta_images_are_read),
        cmocka_unit_test(raw_voxels_are_read_if_the_size_is_right),
        cmocka_unit_test(data_beside_the_header_are_found),
        cmocka_unit_test(malformed_volumes_are_refused),
        cmocka_unit_test(packed_data_of_another_size_are_refused),
        cmocka_unit_test(every_cut_is_refused),
        cmocka_unit_test(values_below_zero_are_background),
    };
    return cmocka_run_group_tests_name("volume", tests, make_folder, remove_folder);
}
