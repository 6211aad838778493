#include "clumps.h"
#include "vtp.h"

#include <unistd.h>

#include "base/file.h"
#include "base/text.h"
#include "clump/file.h"
#include "math/quat.h"
#include "out/export.h"

static dem_buffer written(const char *format, const dem_clump_def *def, dem_export_options options)
{
    dem_clump *clump = made_clump(def);
    dem_buffer out = {0};
    dem_error error;
    check_ok(dem_exporter_find(format)->write(clump, &options, &out, &error), error);
    dem_clump_destroy(clump);
    return out;
}

static dem_clump_def balls_only(const dem_ball *balls, size_t count)
{
    dem_clump_def def = sample_clump();
    def.balls = balls;
    def.ball_count = count;
    return def;
}

static void formats_are_found_by_name_and_by_file(void **state)
{
    (void)state;
    int count = 0;
    for (const dem_exporter *const *e = dem_exporters(); *e; e++, count++) {
        char path[64];
        snprintf(path, sizeof path, "out.d/grain.%s", (*e)->suffix);
        check(dem_exporter_find((*e)->name) == *e);
        check(dem_exporter_of_file(path) == *e);
        check((*e)->about[0] && !(*e)->write == ((*e)->parts != NULL));
        snprintf(path, sizeof path, "out.d/grain.%s", (*e)->name);
        check(dem_exporter_of_file(path) == *e);
    }
    check(count == 14);
    check(dem_exporter_of_file("A.JSON") == dem_exporter_find("json"));
    check(!dem_exporter_find("jpeg") && !dem_exporter_of_file("json") && !dem_exporter_of_file("a.json/b"));
    check(!dem_exporter_of_file("a.py") && !dem_exporter_of_file("a.csv") && !dem_exporter_of_file("a.txt"));
}

static void files_of_a_batch_never_collide(void **state)
{
    (void)state;
    // no suffix is the end of another one, so that grain names with dots do not matter
    for (const dem_exporter *const *a = dem_exporters(); *a; a++)
        for (const dem_exporter *const *b = dem_exporters(); *b; b++) {
            char path[64];
            snprintf(path, sizeof path, "grain.%s", (*a)->suffix);
            check(a == b || dem_exporter_of_file(path) != *b);
            check(a == b || !dem_file_has_suffix(path, (*b)->suffix));
        }
}

static void the_stem_of_a_name_is_before_what_tells_the_format(void **state)
{
    (void)state;
    static const struct {
        const char *format, *path;
        size_t stem;
    } cases[] = {{"json", "out.d/a.json", 7},     {"yade", "out.d/a.b.yade.py", 9}, {"yade", "a.YADE", 1},
                 {"yade", "a.py", 1},             {"lammps", "a.mol", 1},           {"xyzr", "out.d/plain", 11},
                 {"deme", "out.d/a.deme.csv", 7}, {"mercury", "a.mercury", 1}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
        check(dem_exporter_stem(dem_exporter_find(cases[i].format), cases[i].path) == cases[i].stem);
}

static void json_is_the_clump_file(void **state)
{
    (void)state;
    dem_clump_def def = sample_clump();
    dem_buffer out = written("json", &def, (dem_export_options){0});
    dem_clump *clump = made_clump(&def), *back;
    dem_error error;
    check_ok(dem_clump_decode(out.data, out.size, "x", &back, &error), error);
    check_same_clump(clump, back);
    dem_clump_destroy(clump);
    dem_clump_destroy(back);
    dem_buffer_release(&out);
}

// reads what is behind the comments; returns the number of spheres
static size_t read_xyzr(const dem_buffer *text, dem_ball *balls, size_t room)
{
    size_t count = 0;
    const char *end = text->data + text->size;
    for (const char *p = text->data, *next; p < end; p = next + 1) {
        next = memchr(p, '\n', (size_t)(end - p));
        check(next != NULL);
        if (*p == '#')
            continue;
        check(count < room);
        double *parts[4] = {&balls[count].centre.x, &balls[count].centre.y, &balls[count].centre.z,
                            &balls[count].radius};
        for (int k = 0; k < 4; k++) {
            p = dem_parse_double(p, next, parts[k]);
            check(p && *p == (k < 3 ? ' ' : '\n'));
            p++;
        }
        count++;
    }
    return count;
}

static void xyzr_gives_the_spheres_back_without_loss(void **state)
{
    (void)state;
    dem_clump_def def = sample_clump();
    def.name = "two\nlines";
    dem_buffer out = written("xyzr", &def, (dem_export_options){0});
    dem_ball balls[SAMPLE_BALLS];
    check(read_xyzr(&out, balls, SAMPLE_BALLS) == SAMPLE_BALLS);
    for (int i = 0; i < SAMPLE_BALLS; i++)
        check(balls[i].centre.x == def.balls[i].centre.x && balls[i].centre.y == def.balls[i].centre.y &&
              balls[i].centre.z == def.balls[i].centre.z && balls[i].radius == def.balls[i].radius);
    check(strstr(out.data, "# two lines: 3 spheres") == out.data);
    check(strstr(out.data, "\n# unit of x y z r: m\n") && strstr(out.data, "\n# density [kg/m^3]: 2650\n"));
    check(strstr(out.data, "\n# centre of mass [m]: 0 0 0\n"));
    dem_buffer_release(&out);
}

static void the_mesh_frame_is_that_of_the_file(void **state)
{
    (void)state;
    dem_clump_def def = sample_clump();
    dem_export_options options = {.frame = DEM_FRAME_MESH};
    dem_buffer out = written("xyzr", &def, options);
    dem_ball balls[SAMPLE_BALLS];
    check(read_xyzr(&out, balls, SAMPLE_BALLS) == SAMPLE_BALLS);
    for (int i = 0; i < SAMPLE_BALLS; i++) {
        // the quaternion (.6, 0, .8, 0) turns about y by an angle of cosine .36 - .64 and sine .96
        dem_vec3 c = def.balls[i].centre;
        dem_vec3 want = v3(1e6 + (-0.28 * c.x + 0.96 * c.z), -2 + c.y, 3 + (-0.96 * c.x - 0.28 * c.z));
        check_vec(balls[i].centre, want, 1e-9); // ulp of 1e6
        check_near(balls[i].radius, def.balls[i].radius, 0);
    }
    check(strstr(out.data, "\n# unit of x y z r: m\n"));
    dem_buffer_release(&out);
}

static void vtp_holds_a_point_with_its_radius_per_sphere(void **state)
{
    (void)state;
    dem_clump_def def = sample_clump();
    dem_buffer out = written("vtp", &def, (dem_export_options){0});
    check(strstr(out.data, "NumberOfPoints=\"3\" NumberOfVerts=\"3\"") != NULL);
    dem_vec3 points[3];
    double radius[3], diameter[3], mass;
    int64_t connectivity[3], offsets[3];
    memcpy(points, vtp_array(&out, "Points", "Points", "Float64", 3, sizeof points), sizeof points);
    memcpy(radius, vtp_array(&out, "PointData", "radius", "Float64", 1, sizeof radius), sizeof radius);
    memcpy(diameter, vtp_array(&out, "PointData", "diameter", "Float64", 1, sizeof diameter), sizeof diameter);
    memcpy(connectivity, vtp_array(&out, "Verts", "connectivity", "Int64", 1, sizeof connectivity),
           sizeof connectivity);
    memcpy(offsets, vtp_array(&out, "Verts", "offsets", "Int64", 1, sizeof offsets), sizeof offsets);
    memcpy(&mass, vtp_array(&out, "FieldData", "mass", "Float64", 1, sizeof mass), sizeof mass);
    for (int i = 0; i < 3; i++) {
        check_vec(points[i], def.balls[i].centre, 0);
        check(radius[i] == def.balls[i].radius && diameter[i] == 2 * radius[i]);
        check(connectivity[i] == i && offsets[i] == i + 1);
    }
    check(mass == def.mass);
    vtp_check_blocks(&out);
    dem_buffer_release(&out);
}

typedef struct triangles {
    dem_vec3 *corners;
    size_t count;
} triangles;

static triangles read_stl(const dem_buffer *file)
{
    uint32_t count;
    check(file->size >= 84);
    memcpy(&count, file->data + 80, sizeof count);
    check(file->size == 84 + 50 * (size_t)count);
    triangles t = {malloc((3 * (size_t)count + 1) * sizeof *t.corners), count};
    for (size_t i = 0; i < 3 * (size_t)count; i++) {
        float f[3];
        memcpy(f, file->data + 84 + 50 * (i / 3) + 12 + 12 * (i % 3), sizeof f);
        t.corners[i] = v3((double)f[0], (double)f[1], (double)f[2]);
    }
    return t;
}

static double stl_volume(const triangles *t, double *area)
{
    double volume = 0;
    *area = 0;
    for (size_t i = 0; i < t->count; i++) {
        dem_vec3 a = t->corners[3 * i], b = t->corners[3 * i + 1], c = t->corners[3 * i + 2];
        dem_vec3 n = v3_cross(v3_sub(b, a), v3_sub(c, a));
        volume += v3_dot(a, n) / 6;
        *area += v3_norm(n) / 2;
    }
    return volume;
}

// an icosahedron divided three times has facets of .12 r: sag .002 r, volume .6 % low
#define SAG 0.012

static void stl_of_two_balls_is_the_surface_of_their_union(void **state)
{
    (void)state;
    const dem_ball balls[] = {{{0, 0, 0}, 1}, {{1, 0, 0}, 1}, {{0.1, 0, 0}, 0.5}, {{1, 0, 0}, 1}};
    for (size_t count = 1; count <= 4; count++) { // the third is swallowed, the fourth is the second again
        dem_clump_def def = balls_only(balls, count);
        dem_buffer out = written("stl", &def, (dem_export_options){0});
        triangles t = read_stl(&out);
        double area, volume = stl_volume(&t, &area);
        check_close(volume, count == 1 ? 4 * DEM_PI / 3 : 9 * DEM_PI / 4, SAG);
        check_close(area, count == 1 ? 4 * DEM_PI : 6 * DEM_PI, SAG);
        for (size_t i = 0; i < 3 * t.count; i++) {
            double first = v3_norm(t.corners[i]) - 1, second = v3_distance(t.corners[i], v3(1, 0, 0)) - 1;
            check_near(count == 1 ? first : fmin(first, second), 0, 1e-6); // floats
        }
        free(t.corners);
        dem_buffer_release(&out);
    }
}

static void stl_keeps_its_form_at_every_scale(void **state)
{
    (void)state;
    dem_clump_def def = sample_clump();
    size_t sizes[2];
    for (int i = 0; i < 2; i++) {
        dem_ball balls[SAMPLE_BALLS];
        for (int k = 0; k < SAMPLE_BALLS; k++)
            balls[k] =
                (dem_ball){v3_scale(def.balls[k].centre, i ? 1e9 : 1e-9), def.balls[k].radius * (i ? 1e9 : 1e-9)};
        dem_clump_def scaled = balls_only(balls, SAMPLE_BALLS);
        dem_buffer out = written("stl", &scaled, (dem_export_options){0});
        sizes[i] = out.size;
        dem_buffer_release(&out);
    }
    check(sizes[0] > 84 + 50 * 1000);
    check_near((double)sizes[0], (double)sizes[1], 50 * 10); // a corner on a circle may fall on either side
}

static void png_needs_embree(void **state)
{
    (void)state;
    dem_clump_def def = sample_clump();
    dem_clump *clump = made_clump(&def);
    dem_export_options options = {0};
    dem_buffer out = {0};
    dem_error error = {0};
    dem_status status = dem_exporter_find("png")->write(clump, &options, &out, &error);
    if (DEM_EMBREE) {
        check_ok(status, error);
        assert_memory_equal(out.data, "\x89PNG\r\n\x1a\n", 8);
    } else {
        check(status == DEM_UNAVAILABLE && strstr(error.text, "DEM_EMBREE"));
    }
    dem_clump_destroy(clump);
    dem_buffer_release(&out);
}

static void files_are_written_whole_or_not_at_all(void **state)
{
    (void)state;
    dem_clump_def def = sample_clump();
    dem_clump *clump = made_clump(&def);
    dem_export_options options = {0};
    dem_error error;
    char path[] = "export-XXXXXX";
    close(mkstemp(path));
    check_ok(dem_export(dem_exporter_find("xyzr"), clump, &options, path, &error), error);
    dem_buffer text;
    check_ok(dem_file_read(path, &text, &error), error);
    dem_ball balls[SAMPLE_BALLS];
    check(read_xyzr(&text, balls, SAMPLE_BALLS) == SAMPLE_BALLS);
    unlink(path);
    check(dem_export(dem_exporter_find("xyzr"), clump, &options, "no such folder/a.xyzr", &error) == DEM_CANNOT_WRITE);
    dem_buffer_release(&text);
    dem_clump_destroy(clump);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(formats_are_found_by_name_and_by_file),
        cmocka_unit_test(files_of_a_batch_never_collide),
        cmocka_unit_test(the_stem_of_a_name_is_before_what_tells_the_format),
        cmocka_unit_test(json_is_the_clump_file),
        cmocka_unit_test(xyzr_gives_the_spheres_back_without_loss),
        cmocka_unit_test(the_mesh_frame_is_that_of_the_file),
        cmocka_unit_test(vtp_holds_a_point_with_its_radius_per_sphere),
        cmocka_unit_test(stl_of_two_balls_is_the_surface_of_their_union),
        cmocka_unit_test(stl_keeps_its_form_at_every_scale),
        cmocka_unit_test(png_needs_embree),
        cmocka_unit_test(files_are_written_whole_or_not_at_all),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
