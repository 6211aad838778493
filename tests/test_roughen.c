// Roughness of a chosen scale.
#include "check.h"

#include "geom/tree.h"
#include "mesh/grain.h"
#include "mesh/mass.h"
#include "mesh/polyhedron.h"
#include "mesh/roughen.h"

static dem_mesh made(const dem_grain_options *options, const dem_ctx *ctx)
{
    dem_mesh mesh;
    dem_error error;
    check_ok(dem_grain_make(ctx, options, &mesh, &error), error);
    return mesh;
}

static size_t sound(const dem_mesh *mesh)
{
    dem_mesh copy;
    dem_error error;
    dem_mesh_report report;
    check_ok(dem_mesh_copy(mesh, &copy, &error), error);
    check_ok(dem_mesh_repair(NULL, &copy, &(dem_repair_options){.repair = DEM_REPAIR_STRICT}, &report, &error), error);
    dem_mesh_free(&copy);
    return report.self_intersections;
}

// a plate 1 x 1 x 0.1, so that its large faces show the field itself
static dem_mesh plate(size_t triangles)
{
    dem_polyhedron box = {0};
    dem_mesh mesh;
    dem_error error;
    check_ok(dem_polyhedron_box(&box, (dem_box){{-0.5, -0.5, -0.05}, {0.5, 0.5, 0.05}}, &error), error);
    check_ok(dem_polyhedron_mesh(&box, 0, triangles, &mesh, &error), error);
    dem_polyhedron_release(&box);
    return mesh;
}

static void heights_have_the_amplitude_and_wavelength_asked_for(void **state)
{
    (void)state;
    const double amplitude = 1e-3, wavelength = 0.06;
    dem_mesh flat = plate(SLOW_BUILD ? 60000 : 150000), rough;
    dem_error error;
    double reached;
    check_ok(dem_mesh_copy(&flat, &rough, &error), error);
    check_ok(dem_mesh_roughen(NULL, &rough, amplitude, wavelength, 4, &reached, &error), error);
    check(reached == amplitude && sound(&rough) == 0);
    // over the flat part of the faces: mean square of the height, and of its slope, triangle by triangle
    double square = 0, slope = 0, area = 0;
    for (size_t t = 0; t < flat.triangle_count; t++) {
        dem_vec3 p[3], q[3];
        bool inner = true;
        for (size_t k = 0; k < 3; k++) {
            p[k] = flat.vertices[flat.triangles[3 * t + k]];
            q[k] = rough.vertices[flat.triangles[3 * t + k]];
            inner = inner && fabs(fabs(p[k].z) - 0.05) < 1e-12 && fmax(fabs(p[k].x), fabs(p[k].y)) < 0.48;
            if (inner)
                check_near(hypot(q[k].x - p[k].x, q[k].y - p[k].y), 0, 1e-12);  // along the normals
        }
        if (!inner)
            continue;
        double part = v3_norm(v3_cross(v3_sub(p[1], p[0]), v3_sub(p[2], p[0]))) / 2;
        double h[3] = {fabs(q[0].z) - 0.05, fabs(q[1].z) - 0.05, fabs(q[2].z) - 0.05};
        square += part * (h[0] * h[0] + h[1] * h[1] + h[2] * h[2] + h[0] * h[1] + h[1] * h[2] + h[2] * h[0]) / 6;
        dem_vec3 n = v3_cross(v3_sub(q[1], q[0]), v3_sub(q[2], q[0]));
        slope += part * (n.x * n.x + n.y * n.y) / (n.z * n.z);
        area += part;
    }
    check(area > 1.5);
    check_close(sqrt(square / area), amplitude, 0.05);  // the faces are a sample of the surface
    // flat triangles lose a little of the slope; the directions seen are a sample of 128 waves
    check_close(2 * DEM_PI / sqrt(slope / square), wavelength, 0.08);
    dem_mesh_free(&flat);
    dem_mesh_free(&rough);
}

static void distances_to_the_smooth_grain_have_the_amplitude(void **state)
{
    (void)state;
    const dem_grain_kind *kind;
    for (size_t k = 0; (kind = dem_grain_kind_at(k)); k++) {
        dem_grain_options o = dem_grain_defaults();
        o.kind = kind->name;
        o.size = 1e-3;
        o.triangles = SLOW_BUILD ? 6000 : 12000;
        dem_mesh smooth = made(&o, NULL);
        o.roughness = 4e-6;
        o.roughness_scale = 0.2e-3;
        dem_mesh rough = made(&o, NULL);
        check(sound(&rough) == 0);
        check_close(dem_mesh_solid(&rough).volume, dem_mesh_solid(&smooth).volume, 1e-12);
        dem_tree tree;
        dem_error error;
        check_ok(dem_tree_build(&tree, smooth.vertices, smooth.triangles, smooth.triangle_count, &error), error);
        double square = 0, area = 0;
        for (size_t t = 0; t < rough.triangle_count; t++) {
            dem_vec3 p[3], middle = v3(0, 0, 0);
            for (size_t i = 0; i < 3; i++) {
                p[i] = rough.vertices[rough.triangles[3 * t + i]];
                middle = v3_along(middle, 1.0 / 3, p[i]);
            }
            double part = v3_norm(v3_cross(v3_sub(p[1], p[0]), v3_sub(p[2], p[0]))) / 2;
            double d = dem_tree_closest(&tree, middle, INFINITY, NULL, NULL);
            square += part * d * d;
            area += part;
        }
        check_close(sqrt(square / area), o.roughness,
                    0.06);  // less at sharp edges, which are moved along their bisector
        dem_tree_release(&tree);
        dem_mesh_free(&smooth);
        dem_mesh_free(&rough);
    }
}

typedef struct heard {
    int warnings;
    char text[256];
} heard;

static void listen(void *user, dem_log_level level, const char *subject, const char *text)
{
    (void)subject;
    heard *h = user;
    h->warnings += level == DEM_LOG_WARNING;
    snprintf(h->text, sizeof h->text, "%s", text);
}

static void coarse_triangles_are_made_finer_with_a_word(void **state)
{
    (void)state;
    heard h = {0};
    dem_grain_options o = dem_grain_defaults();
    o.triangles = 500;
    o.roughness = 2e-6;
    o.roughness_scale = 0.2e-3;
    dem_mesh mesh = made(&o, &(dem_ctx){.log = listen, .user = &h});
    check(h.warnings == 1 && strstr(h.text, "500 triangles cannot carry"));
    check(dem_mesh_triangles_for(&mesh, o.roughness_scale) < 1.1 * (double)mesh.triangle_count);
    dem_mesh_free(&mesh);
    dem_error error;
    o.roughness_scale = 1e-7;
    o.roughness = 1e-8;
    check(dem_grain_make(NULL, &o, &mesh, &error) == DEM_USAGE && strstr(error.text, "raise --roughness-scale"));
    check(mesh.vertices == NULL);
    o.roughness_scale = 1.1e-3;
    check(dem_grain_make(NULL, &o, &mesh, &error) == DEM_USAGE && strstr(error.text, "must be less than the grain"));
    o.roughness_scale = 1e-4;
    o.roughness = 6e-5;
    check(dem_grain_make(NULL, &o, &mesh, &error) == DEM_USAGE &&
          strstr(error.text, "roughness must be a number from 0 to 5e-05"));
}

static void too_much_of_it_is_lowered_with_a_word_or_refused(void **state)
{
    (void)state;
    // a blade as thin as the waves are high: both sides would meet
    heard h = {0};
    dem_grain_options o = dem_grain_defaults();
    o.kind = "ellipsoid";
    o.values = (double[]){1e-3, 1e-3, 0.1e-3};
    o.triangles = 8000;
    o.roughness_scale = 0.2e-3;
    o.roughness = 0.02e-3;
    dem_mesh mesh = made(&o, &(dem_ctx){.log = listen, .user = &h});
    check(h.warnings >= 1 && strstr(h.text, "roughness lowered from 2e-05 m to "));
    check(sound(&mesh) == 0);
    dem_mesh_free(&mesh);
    dem_error error;
    o.values = (double[]){1e-3, 1e-3, 0.002e-3};
    o.roughness_scale = 0.1e-3;
    o.roughness = 0.05e-3;
    check(dem_grain_make(NULL, &o, &mesh, &error) == DEM_USAGE && strstr(error.text, "crosses itself"));
    check(mesh.vertices == NULL);
}

static void roughness_is_the_same_on_any_number_of_threads(void **state)
{
    (void)state;
    dem_grain_options o = dem_grain_defaults();
    o.kind = "polyhedron";
    o.roughness = 2e-6;
    o.roughness_scale = 0.1e-3;
    dem_mesh mesh[3];
    for (int i = 0; i < 3; i++) {
        o.seed = i < 2 ? 5 : 6;
        mesh[i] = made(&o, &(dem_ctx){.threads = 1 + 2 * i});
    }
    assert_memory_equal(mesh[0].vertices, mesh[1].vertices, mesh[0].vertex_count * sizeof(dem_vec3));
    check(mesh[2].vertex_count != mesh[0].vertex_count ||
          memcmp(mesh[0].vertices, mesh[2].vertices, mesh[0].vertex_count * sizeof(dem_vec3)) != 0);
    for (int i = 0; i < 3; i++)
        dem_mesh_free(&mesh[i]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(heights_have_the_amplitude_and_wavelength_asked_for),
        cmocka_unit_test(distances_to_the_smooth_grain_have_the_amplitude),
        cmocka_unit_test(coarse_triangles_are_made_finer_with_a_word),
        cmocka_unit_test(too_much_of_it_is_lowered_with_a_word_or_refused),
        cmocka_unit_test(roughness_is_the_same_on_any_number_of_threads),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
