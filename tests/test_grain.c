#include "check.h"

#include "base/memory.h"
#include "math/vec.h"
#include "mesh/grain.h"
#include "mesh/icosphere.h"
#include "mesh/mass.h"

static dem_mesh made(const dem_grain_options *options)
{
    dem_mesh mesh;
    dem_error error;
    check_ok(dem_grain_make(NULL, options, &mesh, &error), error);
    return mesh;
}

static dem_grain_options of_kind(const char *kind)
{
    dem_grain_options o = dem_grain_defaults();
    o.kind = kind;
    return o;
}

static dem_vec3 corner(const dem_mesh *mesh, size_t triangle, size_t k)
{
    return mesh->vertices[mesh->triangles[3 * triangle + k]];
}

typedef struct side {
    uint32_t from, to;
} side;

static int compare_sides(const void *a, const void *b)
{
    return memcmp(a, b, sizeof(side));
}

// every directed side once, and its opposite too
static void check_closed(const dem_mesh *mesh)
{
    size_t count = 3 * mesh->triangle_count;
    side *sides = dem_alloc(count, sizeof *sides);
    for (size_t i = 0; i < count; i++)
        sides[i] = (side){mesh->triangles[i], mesh->triangles[i % 3 == 2 ? i - 2 : i + 1]};
    qsort(sides, count, sizeof *sides, compare_sides);
    for (size_t i = 0; i < count; i++) {
        side back = {sides[i].to, sides[i].from};
        check(i == 0 || compare_sides(&sides[i], &sides[i - 1]) != 0);
        check(bsearch(&back, sides, count, sizeof back, compare_sides));
    }
    free(sides);
    check(mesh->vertex_count + mesh->triangle_count == count / 2 + 2);  // Euler: a sphere, all vertices used
}

// the triangles cover the directions once: all face outwards, and their solid angles (Van Oosterom & Strackee 1983)
// add up to one sphere
static void check_star(const dem_mesh *mesh)
{
    double sum = 0;
    for (size_t t = 0; t < mesh->triangle_count; t++) {
        dem_vec3 a = v3_unit(corner(mesh, t, 0)), b = v3_unit(corner(mesh, t, 1)), c = v3_unit(corner(mesh, t, 2));
        double six = v3_dot(a, v3_cross(b, c));
        check(six > 0);
        sum += 2 * atan2(six, 1 + v3_dot(a, b) + v3_dot(b, c) + v3_dot(c, a));
    }
    check_close(sum, 4 * DEM_PI, 1e-9);  // rounding of thousands of terms
}

static void every_kind_makes_closed_surfaces_without_self_intersections(void **state)
{
    (void)state;
    const dem_grain_kind *kind;
    for (size_t k = 0; (kind = dem_grain_kind_at(k)); k++)
        for (uint64_t seed = 1; seed <= 6; seed++) {
            dem_grain_options o = of_kind(kind->name);
            o.seed = seed;
            o.triangles = 400 * seed;
            if (seed % 2 == 0) {
                o.elongation = 0.4;
                o.flatness = 0.1 * (double)seed;
                o.dents = seed;
            }
            dem_mesh mesh = made(&o);
            check_closed(&mesh);
            check_star(&mesh);
            check((double)mesh.triangle_count > 0.5 * (double)o.triangles);
            check((double)mesh.triangle_count < 2 * (double)o.triangles);
            dem_mesh_free(&mesh);
        }
}

static void every_parameter_of_a_kind_is_described(void **state)
{
    (void)state;
    const dem_grain_kind *kind;
    for (size_t k = 0; (kind = dem_grain_kind_at(k)); k++) {
        check(dem_grain_kind_find(kind->name) == kind);
        check(*kind->about && kind->param_count <= DEM_GRAIN_PARAMS);
        for (size_t i = 0; i < kind->param_count; i++) {
            const dem_grain_param *p = &kind->params[i];
            check(*p->name && *p->help && p->low < p->high);
            check(isnan(p->standard) || (p->standard >= p->low && p->standard <= p->high));
            check(strcmp(p->unit, "-") == 0 || strcmp(p->unit, "m") == 0 || strcmp(p->unit, "count") == 0);
        }
    }
    check(!dem_grain_kind_find("potato"));
}

enum { DEGREE = 15, TERMS = (DEGREE + 1) * (DEGREE + 1) };

// twin of the recurrence: P_n by its explicit polynomial, differentiated m times
static double harmonic(int n, int m, dem_vec3 u)
{
    int order = abs(m);
    long double sum = 0, norm = (2 * n + 1) / (4 * (long double)DEM_PI);
    for (int k = 0; n - 2 * k >= order; k++) {
        long double c = k % 2 ? -1 : 1;
        for (int i = 1; i <= n; i++)  // (2n-2k)! / (2^n k! (n-k)! (n-2k)!)
            c *= (long double)(n - 2 * k + i) / (2 * (i <= k ? i : i - k));
        for (int i = 0; i < order; i++)
            c *= n - 2 * k - i;
        sum += c * powl(u.z, n - 2 * k - order);
    }
    for (int i = n - order + 1; i <= n + order; i++)
        norm /= i;
    double phi = atan2(u.y, u.x), s = hypot(u.x, u.y);
    double turn = m == 0 ? 1 : sqrt(2.0) * (m > 0 ? cos(m * phi) : sin(order * phi));
    return (double)(sum * sqrtl(norm)) * pow(s, order) * turn;
}

// least squares over the vertices, which is exact for a sum of harmonics; Cholesky of the normal equations
static void expand(const dem_mesh *mesh, double c[TERMS])
{
    double *a = dem_alloc_zero((size_t)TERMS * TERMS, sizeof *a), y[TERMS];
    memset(c, 0, TERMS * sizeof *c);
    for (size_t v = 0; v < mesh->vertex_count; v++) {
        double r = v3_norm(mesh->vertices[v]);
        dem_vec3 u = v3_unit(mesh->vertices[v]);
        for (int n = 0; n <= DEGREE; n++)
            for (int m = -n; m <= n; m++)
                y[n * n + n + m] = harmonic(n, m, u);
        for (int i = 0; i < TERMS; i++) {
            c[i] += y[i] * r;
            for (int j = 0; j <= i; j++)
                a[i * TERMS + j] += y[i] * y[j];
        }
    }
    for (int i = 0; i < TERMS; i++)
        for (int j = 0; j <= i; j++) {
            for (int k = 0; k < j; k++)
                a[i * TERMS + j] -= a[i * TERMS + k] * a[j * TERMS + k];
            a[i * TERMS + j] = i == j ? sqrt(a[i * TERMS + i]) : a[i * TERMS + j] / a[j * TERMS + j];
        }
    for (int i = 0; i < TERMS; i++) {
        for (int k = 0; k < i; k++)
            c[i] -= a[i * TERMS + k] * c[k];
        c[i] /= a[i * TERMS + i];
    }
    for (int i = TERMS - 1; i >= 0; i--) {
        for (int k = i + 1; k < TERMS; k++)
            c[i] -= a[k * TERMS + i] * c[k];
        c[i] /= a[i * TERMS + i];
    }
    free(a);
}

static void harmonic_grains_have_the_descriptors_asked_for(void **state)
{
    (void)state;
    // d2, d8, exponent, roughness, form, degree
    const double cases[][6] = {
        {0.15, 0.012, 1.4, 1, NAN, 15}, {0.05, 0.02, 0, 0.5, -1, 15}, {0.2, 0.005, 2, 3, 0.3, 11}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        dem_grain_options o = of_kind("harmonics");
        o.values = cases[i];
        o.seed = 11 + i;
        dem_mesh mesh = made(&o);
        double c[TERMS];
        expand(&mesh, c);
        for (int n = 1; n <= DEGREE; n++) {
            double d = 0, want = cases[i][1] * pow(n / 8.0, -cases[i][2]) * (n > 8 ? cases[i][3] : 1);
            for (int m = -n; m <= n; m++)
                d += c[n * n + n + m] * c[n * n + n + m];
            want = n == 1 || n > cases[i][5] ? 0 : n == 2 ? cases[i][0] : want;
            check_near(sqrt(d) / c[0], want, 1e-12);  // rounding; the requirement is 1e-6
        }
        dem_mesh_free(&mesh);
    }
}

static void form_makes_grains_long_or_flat(void **state)
{
    (void)state;
    // Y_20 at its pole is sqrt(5) Y_00, around its equator half of that with the other sign
    const double d2 = 0.08;  // beyond 0.11 the flat one has a dimple at its pole
    for (int form = -1; form <= 1; form += 2) {
        dem_grain_options o = of_kind("harmonics");
        o.values = (double[]){d2, 0, 1, 1, form, 4};
        dem_mesh mesh = made(&o);
        dem_vec3 extent = v3_sub(dem_mesh_box(&mesh).high, dem_mesh_box(&mesh).low);
        double pole = 1 + form * sqrt(5.0) * d2, equator = 1 - form * sqrt(5.0) * d2 / 2;
        check_close((form > 0 ? extent.x : extent.z) / extent.y, pole / equator, 1e-12);
        check_close((form > 0 ? extent.z : extent.x) / extent.y, 1, 1e-12);
        dem_mesh_free(&mesh);
    }
}

static void a_higher_degree_leaves_the_lower_ones_as_they_are(void **state)
{
    (void)state;
    double c[2][TERMS];
    for (int i = 0; i < 2; i++) {
        dem_grain_options o = of_kind("harmonics");
        o.values = (double[]){NAN, NAN, NAN, NAN, NAN, 5 + 10 * i};
        dem_mesh mesh = made(&o);
        expand(&mesh, c[i]);
        dem_mesh_free(&mesh);
    }
    for (int i = 1; i < 36; i++)
        check_near(c[0][i] / c[0][0], c[1][i] / c[1][0], 1e-12);
    check(fabs(c[1][40] / c[1][0]) > 1e-5);
}

static void amplitudes_that_reach_the_centre_are_refused(void **state)
{
    (void)state;
    dem_grain_options o = of_kind("harmonics");
    o.values = (double[]){0.4, 0.1, 2, 1, -1, 15};
    dem_mesh mesh;
    dem_error error;
    check(dem_grain_make(NULL, &o, &mesh, &error) == DEM_USAGE);
    check(strstr(error.text, "centre") && mesh.vertices == NULL);
}

static void ellipsoids_have_their_axes_and_volume(void **state)
{
    (void)state;
    dem_grain_options o = of_kind("ellipsoid");
    o.values = (double[]){4e-3, 3e-3, 1e-3};
    double gap[2];
    for (int i = 0; i < 2; i++) {
        o.triangles = i ? 8000 : 2000;
        dem_mesh mesh = made(&o);
        dem_vec3 extent = v3_sub(dem_mesh_box(&mesh).high, dem_mesh_box(&mesh).low);
        check_vec(extent, v3(4e-3, 3e-3, 1e-3), 1e-17);
        for (size_t v = 0; v < mesh.vertex_count; v++) {
            dem_vec3 p = mesh.vertices[v];
            check_near(hypot(hypot(p.x / 2e-3, p.y / 1.5e-3), p.z / 0.5e-3), 1, 1e-14);
        }
        gap[i] = 1 - dem_mesh_solid(&mesh).volume / (DEM_PI / 6 * 12e-9);
        dem_mesh_free(&mesh);
    }
    check(gap[1] > 0 && gap[1] < 1.5e-3);
    check_close(gap[0] / gap[1], 4, 0.02);  // second order in the edge length
}

// distance of p outside the plane of triangle t
static double above(const dem_mesh *mesh, size_t t, dem_vec3 p)
{
    dem_vec3 a = corner(mesh, t, 0);
    dem_vec3 n = v3_unit(v3_cross(v3_sub(corner(mesh, t, 1), a), v3_sub(corner(mesh, t, 2), a)));
    return v3_dot(n, v3_sub(p, a));
}

static void facets_make_a_convex_polyhedron(void **state)
{
    (void)state;
    dem_grain_options o = of_kind("facets");
    o.values = (double[]){20, 0.4};
    o.triangles = 80;  // the fans themselves
    for (o.seed = 1; o.seed <= 20; o.seed++) {
        dem_mesh mesh = made(&o);
        check_closed(&mesh);
        size_t planes = 0;
        for (size_t t = 0; t < mesh.triangle_count; t++) {
            bool first = true;
            for (size_t v = 0; v < mesh.vertex_count; v++)
                check(above(&mesh, t, mesh.vertices[v]) < 1e-9 * o.size + 1e-14);
            for (size_t s = 0; s < t && first; s++) {
                double apart = 0;
                for (size_t k = 0; k < 3; k++)
                    apart += fabs(above(&mesh, s, corner(&mesh, t, k)));
                first = apart > 1e-14;
            }
            planes += first;
        }
        check(planes >= 8 && planes <= 20);
        dem_mesh_free(&mesh);
    }
}

static void the_equivalent_diameter_is_the_size_asked_for(void **state)
{
    (void)state;
    const double sizes[] = {1e-9, 2e-3, 1e9};
    const dem_grain_kind *kind;
    for (size_t k = 0; (kind = dem_grain_kind_at(k)); k++)
        for (size_t i = 0; i < 3; i++) {
            dem_grain_options o = of_kind(kind->name);
            o.size = sizes[i];
            o.dents = i;
            dem_mesh mesh = made(&o);
            check_close(cbrt(6 * dem_mesh_solid(&mesh).volume / DEM_PI), sizes[i], 1e-12);
            dem_mesh_free(&mesh);
        }
}

static void stretching_divides_the_extents(void **state)
{
    (void)state;
    dem_grain_options o = of_kind("ellipsoid");
    o.values = (double[]){1, 1, 1};
    o.elongation = 0.5;
    o.flatness = 0.3;
    dem_mesh mesh = made(&o);
    check_vec(v3_sub(dem_mesh_box(&mesh).high, dem_mesh_box(&mesh).low), v3(1, 0.5, 0.15), 1e-15);
    dem_mesh_free(&mesh);
}

static void a_dent_has_its_depth_and_width(void **state)
{
    (void)state;
    dem_grain_options o = of_kind("ellipsoid");
    o.values = (double[]){2, 2, 2};
    o.triangles = 20000;
    o.dents = 1;
    o.dent_depth = 0.3;
    o.dent_width_deg = 40;
    dem_mesh mesh = made(&o);
    size_t deepest = 0, untouched = 0;
    for (size_t i = 0; i < mesh.vertex_count; i++)
        if (v3_norm(mesh.vertices[i]) < v3_norm(mesh.vertices[deepest]))
            deepest = i;
    dem_vec3 middle = v3_unit(mesh.vertices[deepest]);
    check_near(v3_norm(mesh.vertices[deepest]), 0.7, 1e-3);  // the nearest vertex is within 2 degrees
    for (size_t i = 0; i < mesh.vertex_count; i++) {
        double angle = acos(fmin(v3_dot(v3_unit(mesh.vertices[i]), middle), 1)) * 180 / DEM_PI;
        if (fabs(angle - 20) < 0.5)  // (1 - 1/4)^2 of the depth; the middle is known to 2 degrees
            check_near(v3_norm(mesh.vertices[i]), 1 - 0.3 * 9 / 16, 0.03);
        check(v3_norm(mesh.vertices[i]) < 1 - 1e-5 || angle > 38);
        untouched += fabs(v3_norm(mesh.vertices[i]) - 1) < 1e-12;
    }
    // the sphere outside a cap of 40 degrees
    check_near((double)untouched / (double)mesh.vertex_count, (1 + cos(40 * DEM_PI / 180)) / 2, 0.01);
    dem_mesh_free(&mesh);
}

static void the_same_seed_makes_the_same_grain_on_any_number_of_threads(void **state)
{
    (void)state;
    dem_grain_options o = of_kind("harmonics");
    o.triangles = 100000;
    dem_mesh mesh[3];
    dem_error error;
    for (int i = 0; i < 3; i++) {
        o.seed = i < 2 ? 5 : 6;
        check_ok(dem_grain_make(&(dem_ctx){.threads = 1 + 2 * i}, &o, &mesh[i], &error), error);
    }
    size_t bytes = mesh[0].vertex_count * sizeof(dem_vec3);
    assert_memory_equal(mesh[0].vertices, mesh[1].vertices, bytes);
    check(memcmp(mesh[0].vertices, mesh[2].vertices, bytes) != 0);
    for (int i = 0; i < 3; i++)
        dem_mesh_free(&mesh[i]);
}

static void values_out_of_range_are_refused_by_name(void **state)
{
    (void)state;
    dem_grain_options bad[8];
    const char *const want[] = {"potato",
                                "triangles",
                                "elongation",
                                "dents",
                                "d2 must be a number from 0 to 0.4, not 7",
                                "faces must be a whole number",
                                "size",
                                "flatness"};
    for (size_t i = 0; i < 8; i++)
        bad[i] = of_kind(i == 0 ? "potato" : i == 5 ? "facets" : "harmonics");
    bad[1].triangles = 3;
    bad[2].elongation = 1.5;
    bad[3].dents = 21;
    bad[4].values = (double[]){7, NAN, NAN, NAN, NAN, NAN};
    bad[5].values = (double[]){20.5, NAN};
    bad[6].size = -1;
    bad[7].flatness = NAN;
    for (size_t i = 0; i < 8; i++) {
        dem_mesh mesh;
        dem_error error;
        check(dem_grain_make(NULL, &bad[i], &mesh, &error) == DEM_USAGE);
        check(strstr(error.text, want[i]));
    }
}

static bool stop(void *user, const char *what, double fraction)
{
    (void)what;
    *(int *)user += 1;
    return fraction > 0.3;
}

static void the_caller_can_stop_it(void **state)
{
    (void)state;
    int calls = 0;
    dem_grain_options o = of_kind("harmonics");
    o.triangles = 500000;
    dem_mesh mesh;
    dem_error error;
    check(dem_grain_make(&(dem_ctx){.progress = stop, .user = &calls}, &o, &mesh, &error) == DEM_INTERRUPTED);
    check(calls > 1 && calls < 6 && mesh.vertices == NULL);
}

static void divided_triangles_cover_the_same_surface(void **state)
{
    (void)state;
    dem_mesh base, fine;
    dem_error error;
    check_ok(dem_icosphere(2, &base, &error), error);
    dem_solid want = dem_mesh_solid(&base);
    for (size_t f = 1; f <= 6; f++) {
        check_ok(dem_mesh_divide(&base, f, &fine, &error), error);
        check(fine.triangle_count == 80 * f * f);
        check_closed(&fine);
        check_close(dem_mesh_solid(&fine).volume, want.volume, 1e-13);
        check_close(dem_mesh_solid(&fine).area, want.area, 1e-13);
        dem_mesh_free(&fine);
    }
    dem_mesh_free(&base);
}

static void geodesic_spheres_have_about_the_triangles_asked_for(void **state)
{
    (void)state;
    for (size_t triangles = 80; triangles < 1000000; triangles = triangles * 3 / 2) {
        size_t f = dem_icosphere_frequency(triangles);
        check(f % 2 == 0);
        check((double)(20 * f * f) < 1.9 * (double)triangles && (double)(20 * f * f) > 0.5 * (double)triangles);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_kind_makes_closed_surfaces_without_self_intersections),
        cmocka_unit_test(every_parameter_of_a_kind_is_described),
        cmocka_unit_test(harmonic_grains_have_the_descriptors_asked_for),
        cmocka_unit_test(form_makes_grains_long_or_flat),
        cmocka_unit_test(a_higher_degree_leaves_the_lower_ones_as_they_are),
        cmocka_unit_test(amplitudes_that_reach_the_centre_are_refused),
        cmocka_unit_test(ellipsoids_have_their_axes_and_volume),
        cmocka_unit_test(facets_make_a_convex_polyhedron),
        cmocka_unit_test(the_equivalent_diameter_is_the_size_asked_for),
        cmocka_unit_test(stretching_divides_the_extents),
        cmocka_unit_test(a_dent_has_its_depth_and_width),
        cmocka_unit_test(the_same_seed_makes_the_same_grain_on_any_number_of_threads),
        cmocka_unit_test(values_out_of_range_are_refused_by_name),
        cmocka_unit_test(the_caller_can_stop_it),
        cmocka_unit_test(divided_triangles_cover_the_same_surface),
        cmocka_unit_test(geodesic_spheres_have_about_the_triangles_asked_for),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
