// Harmonics of scans, and grains with the spectrum of another.
#include "check.h"

#include "mesh/harmonics.h"
#include "mesh/icosphere.h"
#include "mesh/mass.h"
#include "shapes.h"

enum { DEGREE = 8 };

// a grain of known coefficients, with its centre of mass moved off the origin by D_1
static dem_harmonics *known(uint64_t seed, double first)
{
    dem_harmonics *h = malloc(sizeof *h);
    dem_harmonics_init(h, DEGREE);
    h->c[0] = 1e-3 * sqrt(4 * DEM_PI);
    dem_random random = random_stream(seed, 99);
    for (int n = 1; n <= DEGREE; n++)
        dem_harmonics_draw(h, n, n == 1 ? first : 0.12 / n / n, &random);
    return h;
}

static dem_mesh meshed(const dem_harmonics *h, size_t triangles)
{
    dem_mesh mesh;
    dem_error error;
    check_ok(dem_harmonics_mesh(NULL, h, triangles, &mesh, &error), error);
    return mesh;
}

// moves the mesh's centre of mass to the origin
static dem_vec3 centre(dem_mesh *mesh)
{
    dem_vec3 c = dem_mesh_solid(mesh).centre;
    shape_move(mesh, (dem_quat){1, 0, 0, 0}, v3_scale(c, -1));
    return c;
}

static void a_fit_finds_the_coefficients_again(void **state)
{
    (void)state;
    dem_harmonics *h = known(3, 0), *found = malloc(sizeof *found);
    // even degrees only: symmetric about the origin, so the centre of mass is there
    for (int n = 1; n <= DEGREE; n += 2)
        for (int m = -n; m <= n; m++)
            h->c[harmonics_term(n, m)] = 0;
    double errors[2];
    for (int fine = 0; fine < 2; fine++) {
        dem_mesh mesh = meshed(h, fine ? 80000 : 20000);
        dem_harmonics_fit fit;
        dem_error error;
        check_ok(dem_harmonics_fit_mesh(NULL, &mesh, DEGREE + 2, found, &fit, &error), error);
        check_vec(fit.centre, v3(0, 0, 0), 1e-15);
        check(fit.hidden == 0 && fit.rays > 10000);
        check_close(fit.equivalent_diameter, cbrt(6 * dem_mesh_solid(&mesh).volume / DEM_PI), 1e-12);
        errors[fine] = 0;
        for (int i = 0; i < (DEGREE + 3) * (DEGREE + 3); i++) {
            double want = i < (DEGREE + 1) * (DEGREE + 1) ? h->c[i] : 0;
            errors[fine] = fmax(errors[fine], fabs(found->c[i] - want) / h->c[0]);
        }
        dem_mesh_free(&mesh);
    }
    check(errors[0] < 5e-4);           // flat triangles lie inside of the surface, by their side^2 / 8
    check(errors[1] < errors[0] / 3);  // and four times as many by a quarter of it
    free(h);
    free(found);
}

static void a_fit_does_not_mind_where_the_grain_lies(void **state)
{
    (void)state;
    dem_harmonics *h = known(5, 0.02), *found[2] = {malloc(sizeof **found), malloc(sizeof **found)};
    dem_mesh mesh = meshed(h, 8000);
    dem_harmonics_fit fit[2];
    dem_error error;
    dem_vec3 at = centre(&mesh), far = v3(7, -3, 2);
    check(v3_norm(at) > 1e-6);
    check_ok(dem_harmonics_fit_mesh(&(dem_ctx){.threads = 1}, &mesh, DEGREE, found[0], &fit[0], &error), error);
    check_ok(dem_harmonics_fit_mesh(&(dem_ctx){.threads = 3}, &mesh, DEGREE, found[1], &fit[1], &error), error);
    assert_memory_equal(found[0]->c, found[1]->c, sizeof found[0]->c);
    shape_move(&mesh, (dem_quat){1, 0, 0, 0}, far);
    check_ok(dem_harmonics_fit_mesh(NULL, &mesh, DEGREE, found[1], &fit[1], &error), error);
    check_vec(fit[1].centre, far, 1e-12);
    for (int i = 0; i < (DEGREE + 1) * (DEGREE + 1); i++)
        check_near(found[0]->c[i], found[1]->c[i], 1e-10 * h->c[0]);  // coordinates of 7 m lose four digits
    // turned, each degree keeps its power
    shape_move(&mesh, quat_unit((dem_quat){0.3, 0.5, -0.7, 0.2}), v3(0, 0, 0));
    check_ok(dem_harmonics_fit_mesh(NULL, &mesh, DEGREE, found[1], &fit[1], &error), error);
    for (int n = 1; n <= DEGREE; n++)  // up to what triangles add beyond the degree
        check_near(dem_harmonics_power(found[0], n), dem_harmonics_power(found[1], n), 1e-5);
    check(fabs(found[0]->c[6] - found[1]->c[6]) > 1e-3 * h->c[0]);
    dem_mesh_free(&mesh);
    free(h);
    free(found[0]);
    free(found[1]);
}

static void siblings_have_the_spectrum_and_another_shape(void **state)
{
    (void)state;
    dem_harmonics *h = known(7, 0.01), *sibling = malloc(sizeof *sibling);
    dem_mesh parent = meshed(h, 2000);
    for (int kept = 0; kept <= 4; kept += 2)
        for (uint64_t seed = 1; seed <= 4; seed++) {
            dem_mesh mesh, again;
            dem_error error;
            dem_mesh_report report;
            dem_surface_distance apart;
            check_ok(dem_harmonics_sibling(NULL, h, kept, seed, 2000, sibling, &mesh, &error), error);
            for (int n = 1; n <= DEGREE; n++) {
                check_close(dem_harmonics_power(sibling, n), dem_harmonics_power(h, n), 1e-12);
                bool same = memcmp(&sibling->c[n * n], &h->c[n * n], (size_t)(2 * n + 1) * sizeof(double)) == 0;
                check(same == (n <= kept));
            }
            check_ok(dem_mesh_distance(&parent, &mesh, &apart, &error), error);
            check(apart.rms > 2e-6 && apart.largest > apart.rms);
            check_ok(dem_harmonics_sibling(&(dem_ctx){.threads = 3}, h, kept, seed, 2000, sibling, &again, &error),
                     error);
            assert_memory_equal(mesh.vertices, again.vertices, mesh.vertex_count * sizeof *mesh.vertices);
            dem_mesh_free(&again);
            check_ok(dem_mesh_repair(NULL, &mesh, &(dem_repair_options){.repair = DEM_REPAIR_STRICT}, &report, &error),
                     error);
            check(report.self_intersections == 0 && report.shells == 1);
            dem_mesh_free(&mesh);
        }
    dem_mesh_free(&parent);
    free(h);
    free(sibling);
}

static void hollow_siblings_are_drawn_again_or_refused(void **state)
{
    (void)state;
    dem_harmonics *h = malloc(sizeof *h), *sibling = malloc(sizeof *sibling);
    dem_harmonics_init(h, 4);
    h->c[0] = sqrt(4 * DEM_PI);
    dem_random random = random_stream(1, 1);
    dem_mesh mesh;
    dem_error error;
    dem_harmonics_draw(h, 3, 0.36, &random);  // reaches the centre in some orientations of coefficients only
    size_t first = 0;
    for (uint64_t seed = 1; seed <= 20; seed++) {
        check_ok(dem_harmonics_sibling(NULL, h, 0, seed, 500, sibling, &mesh, &error), error);
        for (size_t i = 0; i < mesh.vertex_count; i++)
            check(v3_norm(mesh.vertices[i]) >= 0.1);
        dem_mesh_free(&mesh);
        dem_harmonics once = *h;
        random = random_stream(seed, 5 + 300);
        dem_harmonics_draw(&once, 3, 0.36, &random);
        first += fabs(once.c[9] - sibling->c[9]) < 1e-12;
    }
    check(first > 0 && first < 20);
    dem_harmonics_draw(h, 3, 2, &random);
    check(dem_harmonics_sibling(NULL, h, 0, 1, 500, sibling, &mesh, &error) == DEM_USAGE);
    check(strstr(error.text, "keep more degrees") && mesh.vertices == NULL);
    free(h);
    free(sibling);
}

static void what_rays_meet_twice_is_told(void **state)
{
    (void)state;
    // a ball of radius 1 and a rod on it that ends in a wider head: from below, the head's rim hides the rod
    dem_mesh mesh;
    dem_error error;
    check_ok(dem_icosphere(30, &mesh, &error), error);
    for (size_t i = 0; i < mesh.vertex_count; i++) {
        dem_vec3 *p = &mesh.vertices[i];
        double t = fmax(0, (p->z - 0.8) / 0.2);  // 0 at the shoulder, 1 at the tip
        double r = hypot(p->x, p->y),
               width = t > 0 ? (t < 0.5 ? 0.5 - 0.2 * t : 0.4 + 1.0 * (t - 0.5) * (1 - t) * 4) : r;
        if (t > 0.95)
            width = 0.5 * (1 - t) * 20 * 0.6;
        if (t > 0 && r > 0)
            *p = v3(p->x / r * width, p->y / r * width, 0.8 + 2 * t);
    }
    dem_harmonics *h = malloc(sizeof *h);
    dem_harmonics_fit fit;
    check_ok(dem_harmonics_fit_mesh(NULL, &mesh, 4, h, &fit, &error), error);
    check(fit.hidden > 1e-3 && fit.hidden < 0.2 && fit.hidden_depth > 0.05);
    dem_mesh_free(&mesh);
    // a hollow ball: the outer surface counts
    dem_mesh hole = shape_sphere(30);
    mesh = shape_sphere(60);
    shape_scale(&hole, 0.5, 0.5, 0.5);
    shape_flip(&hole, 0, hole.triangle_count);
    shape_append(&mesh, &hole, 0, hole.triangle_count);
    check_ok(dem_harmonics_fit_mesh(NULL, &mesh, 4, h, &fit, &error), error);
    check(fit.hidden == 1);
    check_near(fit.hidden_depth, 0.5, 1e-2);
    check_close(h->c[0], sqrt(4 * DEM_PI), 1e-3);
    dem_mesh_free(&hole);
    dem_mesh_free(&mesh);
    // a ring's centre of mass is outside of it
    const int around = 60, across = 20;
    mesh = (dem_mesh){malloc((size_t)(around * across) * sizeof *mesh.vertices),
                      malloc((size_t)(around * across) * 6 * sizeof *mesh.triangles), (size_t)(around * across), 0, 0};
    for (int i = 0; i < around; i++)
        for (int k = 0; k < across; k++) {
            double a = 2 * DEM_PI * i / around, b = 2 * DEM_PI * k / across, r = 1 + 0.2 * cos(b);
            mesh.vertices[i * across + k] = v3(r * cos(a), r * sin(a), 0.2 * sin(b));
            uint32_t q[4] = {(uint32_t)(i * across + k), (uint32_t)((i + 1) % around * across + k),
                             (uint32_t)((i + 1) % around * across + (k + 1) % across),
                             (uint32_t)(i * across + (k + 1) % across)};
            uint32_t *t = &mesh.triangles[3 * mesh.triangle_count];
            t[0] = q[0], t[1] = q[1], t[2] = q[2], t[3] = q[0], t[4] = q[2], t[5] = q[3];
            mesh.triangle_count += 2;
        }
    check(dem_harmonics_fit_mesh(NULL, &mesh, 4, h, &fit, &error) == DEM_BAD_INPUT);
    check(strstr(error.text, "centre of mass lies outside"));
    dem_mesh_free(&mesh);
    free(h);
}

static void a_box_seen_from_its_middle_has_its_mean_radius(void **state)
{
    (void)state;
    // c_00 = int r Y_00 = sqrt(4 pi) times the mean radius; of a cube of edge 2 that is the integral over one face of
    // z / r^2 dA / (4 pi) times 6, here by a fine midpoint rule
    enum { STEPS = 2000 };
    double mean = 0;
    for (int i = 0; i < STEPS; i++)
        for (int k = 0; k < STEPS; k++) {
            double x = (i + 0.5) / STEPS, y = (k + 0.5) / STEPS;
            mean += 24 / (4 * DEM_PI) / (1 + x * x + y * y) / ((double)STEPS * STEPS);
        }
    dem_mesh cube = shape_box(2, 2, 2);
    dem_harmonics *h = malloc(sizeof *h);
    dem_harmonics_fit fit;
    dem_error error;
    check_ok(dem_harmonics_fit_mesh(NULL, &cube, 6, h, &fit, &error), error);
    check_vec(fit.centre, v3(1, 1, 1), 1e-14);
    check_close(h->c[0], mean * sqrt(4 * DEM_PI), 1e-4);  // the nodes are 1.4 degrees apart
    for (int n = 1; n <= 3; n++)                          // cubic symmetry has no degree below 4
        check(dem_harmonics_power(h, n) < 1e-4);
    check(dem_harmonics_power(h, 4) > 0.02 && dem_harmonics_power(h, 5) < 1e-4);
    dem_mesh_free(&cube);
    free(h);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_fit_finds_the_coefficients_again),
        cmocka_unit_test(a_fit_does_not_mind_where_the_grain_lies),
        cmocka_unit_test(siblings_have_the_spectrum_and_another_shape),
        cmocka_unit_test(hollow_siblings_are_drawn_again_or_refused),
        cmocka_unit_test(what_rays_meet_twice_is_told),
        cmocka_unit_test(a_box_seen_from_its_middle_has_its_mean_radius),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
