#include "folder.h"

#include "out/vtp_read.h"

enum { POINTS = 5 };

typedef struct sample {
    dem_vec3 points[POINTS];
    double masses[POINTS];
    float turns[4 * POINTS];
    uint32_t ids[POINTS];
    int32_t kinds[POINTS];
    int64_t cells[8];
    double field[3];
    dem_vtp_array fields[1], point_arrays[4], cell_arrays[1];
    uint32_t lines[2], triangles[6];
} sample;

// every kind of number and cell; `parts` leaves some out
static dem_vtp made(sample *s, unsigned parts)
{
    for (int i = 0; i < POINTS; i++) {
        s->points[i] = (dem_vec3){i / 3.0, -1e-300 * i, i ? 1e300 : -0.0};
        s->masses[i] = i == 2 ? NAN : 0.1 * i;
        for (int k = 0; k < 4; k++)
            s->turns[4 * i + k] = (float)(i + k / 7.0);
        s->ids[i] = UINT32_MAX - (uint32_t)i;
        s->kinds[i] = -i;
    }
    for (int i = 0; i < 8; i++)
        s->cells[i] = INT64_MIN + i;
    memcpy(s->field, (double[]){1, 2, INFINITY}, sizeof s->field);
    s->fields[0] = (dem_vtp_array){"inertia", DEM_VTP_FLOAT64, 3, s->field};
    s->point_arrays[0] = (dem_vtp_array){"mass", DEM_VTP_FLOAT64, 1, s->masses};
    s->point_arrays[1] = (dem_vtp_array){"orientation", DEM_VTP_FLOAT32, 4, s->turns};
    s->point_arrays[2] = (dem_vtp_array){"id", DEM_VTP_UINT32, 1, s->ids};
    s->point_arrays[3] = (dem_vtp_array){"template", DEM_VTP_INT32, 1, s->kinds};
    s->cell_arrays[0] = (dem_vtp_array){"wall", DEM_VTP_INT64, 1, s->cells};
    memcpy(s->lines, (uint32_t[]){4, 0}, sizeof s->lines);
    memcpy(s->triangles, (uint32_t[]){0, 1, 2, 4, 3, 2}, sizeof s->triangles);
    return (dem_vtp){.time = parts & 1 ? 0.1 : NAN,
                     .fields = s->fields,
                     .field_count = parts & 2 ? 1 : 0,
                     .points = s->points,
                     .point_count = parts & 4 ? POINTS : 0,
                     .point_arrays = s->point_arrays,
                     .point_array_count = parts & 8 ? 4 : 0,
                     .scalars = parts & 8 ? "template" : NULL,
                     .vertices = parts & 16,
                     .lines = s->lines,
                     .line_count = (parts & 36) == 36 ? 1 : 0,
                     .triangles = s->triangles,
                     .triangle_count = (parts & 68) == 68 ? 2 : 0,
                     .cell_arrays = s->cell_arrays,
                     .cell_array_count = (parts & 116) == 116 ? 1 : 0};
}

static dem_status decode(const char *bytes, size_t size, dem_vtp_file *file, dem_error *error)
{
    return dem_vtp_decode(bytes, size, "a.vtp", file, error);
}

static void what_is_written_is_read_bit_for_bit(void **state)
{
    (void)state;
    for (unsigned parts = 0; parts < 128; parts++) {
        sample s;
        dem_vtp vtp = made(&s, parts);
        dem_buffer file = {0}, again = {0};
        dem_vtp_file read;
        dem_error error;
        dem_vtp_put(&file, &vtp);
        check_ok(decode(file.data, file.size, &read, &error), error);
        check(read.vtp.point_count == vtp.point_count && read.vtp.triangle_count == vtp.triangle_count);
        check(read.vtp.point_array_count == vtp.point_array_count && read.vtp.field_count == vtp.field_count);
        assert_memory_equal(read.vtp.points, s.points, vtp.point_count * sizeof *s.points);
        dem_vtp_put(&again, &read.vtp);
        check(again.size == file.size);
        assert_memory_equal(again.data, file.data, file.size);
        dem_buffer_release(&file);
        dem_buffer_release(&again);
        dem_vtp_file_release(&read);
    }
}

static void arrays_are_found_by_name(void **state)
{
    (void)state;
    sample s;
    dem_vtp vtp = made(&s, 127);
    dem_vtp_file read;
    dem_error error;
    check_ok(dem_vtp_write(in_folder("a.vtp"), &vtp, &error), error);
    check_ok(dem_vtp_read(in_folder("a.vtp"), &read, &error), error);
    check(read.vtp.time == 0.1 && strcmp(read.vtp.scalars, "template") == 0);
    check(dem_vtp_value(dem_vtp_find(&read.vtp, "mass"), 3, 0) == s.masses[3]);
    check(dem_vtp_value(dem_vtp_find(&read.vtp, "orientation"), 2, 3) == (double)s.turns[11]);
    check(dem_vtp_value(dem_vtp_find(&read.vtp, "id"), 4, 0) == UINT32_MAX - 4.0);
    check(dem_vtp_value(dem_vtp_find(&read.vtp, "template"), 4, 0) == -4);
    check(dem_vtp_value(&read.vtp.cell_arrays[0], 0, 0) == (double)INT64_MIN);
    check(dem_vtp_find(&read.vtp, "mas") == NULL && dem_vtp_find(&read.vtp, "wall") == NULL);
    dem_vtp_file_release(&read);
    check(dem_vtp_read(in_folder("none.vtp"), &read, &error) == DEM_BAD_INPUT);
    dem_vtp_file_release(&read);
}

// a file cut anywhere, or with any byte changed, is refused in words or read as what it then says
static void a_broken_file_is_refused(void **state)
{
    (void)state;
    sample s;
    dem_vtp vtp = made(&s, 127);
    dem_buffer file = {0};
    dem_vtp_file read;
    dem_error error;
    dem_vtp_put(&file, &vtp);
    for (size_t size = 0; size < file.size; size++) {
        char *cut = malloc(size + 1);  // so that a sanitizer sees what is read behind the end
        memcpy(cut, file.data, size);
        check(decode(cut, size, &read, &error) == DEM_BAD_INPUT);
        check(strchr(error.text, ';') && strcmp(error.file, "a.vtp") == 0 && !read.arena.chunks);
        free(cut);
    }
    check(decode(file.data, file.size - 1, &read, &error) == DEM_BAD_INPUT &&
          strstr(error.text, "cut short by 1 byte"));
    size_t refused = 0;
    for (size_t i = 0; i < file.size; i++) {
        char was = file.data[i];
        file.data[i] = (char)(was ^ 1);
        dem_status status = decode(file.data, file.size, &read, &error);
        check(status == DEM_OK || status == DEM_BAD_INPUT);
        refused += status != DEM_OK;
        dem_vtp_file_release(&read);
        file.data[i] = was;
    }
    check(refused > 1800);  // all of the XML but names, and the sizes and places of cells
    dem_buffer_release(&file);
}

static void refused(const char *bytes, size_t size, const char *words)
{
    dem_vtp_file read;
    dem_error error = {0};
    check(decode(bytes, size, &read, &error) == DEM_BAD_INPUT);
    if (!strstr(error.text, words))
        print_error("no '%s' in '%s'\n", words, error.text);
    check(strstr(error.text, words) != NULL);
}

// the file with the first `from` turned into `to`, of equal length
static void refused_with(const dem_buffer *file, const char *from, const char *to, const char *words)
{
    char *copy = malloc(file->size), *at = NULL;
    memcpy(copy, file->data, file->size);
    for (size_t i = 0; !at && i + strlen(from) <= file->size; i++)
        at = memcmp(copy + i, from, strlen(from)) == 0 ? copy + i : NULL;
    check(at && strlen(from) == strlen(to));
    memcpy(at, to, strlen(to));
    refused(copy, file->size, words);
    free(copy);
}

static void foreign_files_are_refused_in_words(void **state)
{
    (void)state;
    sample s;
    dem_vtp vtp = made(&s, 127);
    dem_buffer file = {0};
    dem_vtp_put(&file, &vtp);
    static const char other[] = "<VTKFile type=\"PolyData\" version=\"0.1\" byte_order=\"LittleEndian\">\n";
    refused("", 0, "(byte 0)");
    refused(other, sizeof other - 1, "as these tools write it");
    refused_with(&file, "LittleEndian\"", "BigEndian\"   ", "other byte order");
    refused_with(&file, "NumberOfPoints=\"5\"", "NumberOfPoints=\"6\"", "as these tools write it");
    refused_with(&file, "NumberOfPolys=\"2\"", "NumberOfPolys=\"9\"", "as these tools write it");
    refused_with(&file, "Components=\"4\"", "Components=\"0\"", "as these tools write it");
    refused_with(&file, "Float32", "Float16", "as these tools write it");
    refused_with(&file, "offset=\"0\"", "offset=\"1\"", "as these tools write it");
    // a corner that is no point
    int64_t *corner = NULL;
    for (size_t i = 0; i + 24 <= file.size; i++)
        if (memcmp(file.data + i, (int64_t[]){4, 3, 2}, 24) == 0)
            corner = (int64_t *)(void *)(file.data + i);
    check(corner != NULL);
    memcpy(corner, &(int64_t){5}, 8);
    refused(file.data, file.size, "as these tools write it");
    memcpy(corner, &(int64_t){-1}, 8);
    refused(file.data, file.size, "as these tools write it");
    dem_buffer_release(&file);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_is_written_is_read_bit_for_bit),
        cmocka_unit_test(arrays_are_found_by_name),
        cmocka_unit_test(a_broken_file_is_refused),
        cmocka_unit_test(foreign_files_are_refused_in_words),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
