// The kinds whose volume is known in closed form, and the corners of everything that can be asked for.
#include "check.h"

#include "mesh/grain.h"
#include "mesh/mass.h"

static dem_grain_options of_kind(const char *kind, const double *values, size_t triangles)
{
    dem_grain_options o = dem_grain_defaults();
    o.kind = kind;
    o.values = values;
    o.triangles = triangles;
    return o;
}

static dem_mesh made(const dem_grain_options *options)
{
    dem_mesh mesh;
    dem_error error;
    check_ok(dem_grain_make(NULL, options, &mesh, &error), error);
    return mesh;
}

// one closed, outward body that the strictest reader takes without a word
static void check_sound(const dem_mesh *mesh)
{
    dem_mesh copy;
    dem_error error;
    dem_mesh_report report;
    check_ok(dem_mesh_copy(mesh, &copy, &error), error);
    check_ok(dem_mesh_repair(NULL, &copy, &(dem_repair_options){.repair = DEM_REPAIR_STRICT}, &report, &error), error);
    check(report.self_intersections == 0 && report.bodies == 1 && report.shells == 1 && report.boundary_edges == 0);
    check(report.vertices == mesh->vertex_count && report.triangles == mesh->triangle_count && report.volume > 0);
    dem_mesh_free(&copy);
}

static double beta(double x, double y)
{
    return exp(lgamma(x) + lgamma(y) - lgamma(x + y));
}

// what chords cut off goes with the square of their length: four times the triangles, about a quarter of it
static void check_converges(const double gaps[2], double coarse)
{
    if (!(gaps[0] > 0 && gaps[0] < coarse && gaps[1] < gaps[0] / 2))
        fail_msg("%g and %g of the volume are missing, at most %g and a half of it may", gaps[0], gaps[1], coarse);
}

static void superquadrics_have_the_volume_of_their_formula(void **state)
{
    (void)state;
    // a, b, c, n1, n2, and what 4000 triangles may cut off
    const double cases[][6] = {{1, 1, 1, 2, 2, 4e-3},       {2, 1.5, 1, 6, 6, 3e-3},  {1, 1, 3, 50, 2, 8e-3},
                               {1, 2, 1, 2, 50, 8e-3},      {1, 1, 1, 50, 50, 2e-3},  {1, 0.1, 0.05, 3, 5, 3e-2},
                               {0.05, 0.05, 1, 2, 2, 3e-2}, {1, 1, 0.02, 20, 2, 1e-2}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        const double *v = cases[i], e1 = 2 / v[3], e2 = 2 / v[4];
        // Jaklic, Leonardis & Solina 2000
        double volume = 2 * v[0] * v[1] * v[2] * e1 * e2 * beta(e1 / 2 + 1, e1) * beta(e2 / 2, e2 / 2), gaps[2];
        for (int fine = 0; fine < 2; fine++) {
            dem_grain_options o = of_kind("superquadric", v, fine ? 16000 : 4000);
            dem_mesh mesh = made(&o);
            check_sound(&mesh);
            for (size_t k = 0; k < mesh.vertex_count; k++) {
                dem_vec3 p = mesh.vertices[k];
                double across = pow(pow(fabs(p.x) / v[0], v[4]) + pow(fabs(p.y) / v[1], v[4]), v[3] / v[4]);
                check_near(across + pow(fabs(p.z) / v[2], v[3]), 1, 1e-12);  // rounding, times the exponent
            }
            gaps[fine] = 1 - dem_mesh_solid(&mesh).volume / volume;
            check((double)mesh.triangle_count > 0.7 * (double)o.triangles);
            check((double)mesh.triangle_count < 1.4 * (double)o.triangles);
            dem_mesh_free(&mesh);
        }
        check_converges(gaps, v[5]);
    }
}

static void superquadric_triangles_are_about_equal(void **state)
{
    (void)state;
    dem_grain_options o = of_kind("superquadric", (double[]){1, 1, 1, 2, 2}, 4000);
    dem_mesh mesh = made(&o);
    double smallest = INFINITY, largest = 0;
    for (size_t t = 0; t < mesh.triangle_count; t++) {
        const uint32_t *v = &mesh.triangles[3 * t];
        dem_vec3 a = mesh.vertices[v[0]];
        double area = v3_norm(v3_cross(v3_sub(mesh.vertices[v[1]], a), v3_sub(mesh.vertices[v[2]], a))) / 2;
        smallest = fmin(smallest, area);
        largest = fmax(largest, area);
    }
    check(largest < 3 * smallest);  // on a sphere, where a cube's own grid would have 5.2
    dem_mesh_free(&mesh);
}

// volume, area, curvature integral and inradius of the regular solids of inradius 1, from their edge length a and the
// angle by which they turn over an edge
typedef struct regular {
    int faces, edges;
    double edge, volume, turn;
} regular;

// of all triangles' planes, to the origin
static double nearest_plane(const dem_mesh *mesh)
{
    double nearest = INFINITY;
    for (size_t t = 0; t < mesh->triangle_count; t++) {
        const uint32_t *v = &mesh->triangles[3 * t];
        dem_vec3 a = mesh->vertices[v[0]];
        dem_vec3 n = v3_unit(v3_cross(v3_sub(mesh->vertices[v[1]], a), v3_sub(mesh->vertices[v[2]], a)));
        nearest = fmin(nearest, v3_dot(n, a));
    }
    return nearest;
}

static void rounded_solids_obey_steiner(void **state)
{
    (void)state;
    const double s5 = sqrt(5.0);
    const regular solids[] = {
        {4, 6, 2 * sqrt(6.0), 8 * sqrt(3.0), DEM_PI - acos(1.0 / 3)},
        {6, 12, 2, 8, DEM_PI / 2},
        {8, 12, sqrt(6.0), 4 * sqrt(3.0), acos(1.0 / 3)},
        {12, 30, 20 / sqrt(250 + 110 * s5), (15 + 7 * s5) / 4 * 8000 / pow(250 + 110 * s5, 1.5), atan(2.0)},
        {20, 30, 12 / (sqrt(3.0) * (3 + s5)), 5 * (3 + s5) / 12 * pow(12 / (sqrt(3.0) * (3 + s5)), 3), acos(s5 / 3)},
    };
    for (size_t i = 0; i < sizeof solids / sizeof *solids; i++)
        for (int round = 0; round < 3; round++) {
            regular s = solids[i];
            double r = 0.3 * round, core = 1 - r, gaps[2];
            double v = s.volume * pow(core, 3), a = 3 * s.volume * core * core;  // A = 3 V at inradius 1
            double m = s.edges * s.edge * core * s.turn / 2;
            double volume = v + a * r + m * r * r + 4 * DEM_PI / 3 * r * r * r;
            double area = a + 2 * m * r + 4 * DEM_PI * r * r;
            for (int fine = 0; fine < 2; fine++) {
                dem_grain_options o = of_kind("polyhedron", (double[]){s.faces, NAN, NAN, r}, fine ? 12000 : 3000);
                dem_mesh mesh = made(&o);
                check_sound(&mesh);
                double inradius = nearest_plane(&mesh);  // faces stay flat, so this one is exact
                dem_solid solid = dem_mesh_solid(&mesh);
                gaps[fine] = 1 - solid.volume / pow(inradius, 3) / volume;
                check_near(solid.area / pow(inradius, 2) / area, 1, round ? 1.2e-2 : 1e-12);
                dem_mesh_free(&mesh);
            }
            if (round == 0)
                check_near(gaps[0], 0, 1e-12);
            else
                check_converges(gaps, 1e-2);
            if (round == 1 && !SLOW_BUILD) {
                dem_grain_options o = of_kind("polyhedron", (double[]){s.faces, NAN, NAN, r}, 100000);
                dem_mesh mesh = made(&o);
                check_near(dem_mesh_solid(&mesh).volume / pow(nearest_plane(&mesh), 3) / volume, 1, 5e-4);
                dem_mesh_free(&mesh);
            }
        }
}

static void random_hulls_are_convex_and_grow_rounder(void **state)
{
    (void)state;
    for (uint64_t seed = 1; seed <= 8; seed++) {
        double before = INFINITY;
        for (int round = 0; round <= 4; round++) {
            dem_grain_options o = of_kind("polyhedron", (double[]){0, 12 + (double)seed, 0.5, round / 4.0}, 1500);
            o.seed = seed;
            dem_mesh mesh = made(&o);
            check_sound(&mesh);
            dem_solid solid = dem_mesh_solid(&mesh);
            double roundness = solid.area / pow(solid.volume, 2.0 / 3);
            check(roundness < before);
            before = roundness;
            for (size_t t = 0; t < mesh.triangle_count; t += 7) {
                dem_vec3 a = mesh.vertices[mesh.triangles[3 * t]], b = mesh.vertices[mesh.triangles[3 * t + 1]];
                dem_vec3 n = v3_unit(v3_cross(v3_sub(b, a), v3_sub(mesh.vertices[mesh.triangles[3 * t + 2]], a)));
                for (size_t i = 0; i < mesh.vertex_count; i++)
                    check(v3_dot(n, v3_sub(mesh.vertices[i], a)) < 1e-6 * 1e-3);
            }
            dem_mesh_free(&mesh);
        }
        check_near(before, cbrt(36 * DEM_PI), 0.02);  // a sphere's
    }
}

static void break_up(const dem_ctx *ctx, dem_grain_request request, dem_vec3 block, size_t count, dem_mesh *cells)
{
    dem_fracture fracture;
    dem_error error;
    check_ok(dem_grain_break(ctx, &request, block, count, &fracture, &error), error);
    for (size_t i = 0; i < count; i++)
        check_ok(dem_grain_cell(&request, &fracture, i, &cells[i], &error), error);
    dem_fracture_release(&fracture);
}

static void cells_fill_their_block(void **state)
{
    (void)state;
    enum { MOST = 150 };
    static dem_mesh cells[2][MOST];
    const dem_vec3 block = {0.04, 0.02, 0.01};
    const size_t counts[] = {1, 2, 17, SLOW_BUILD ? 60 : MOST};
    for (size_t i = 0; i < sizeof counts / sizeof *counts; i++)
        for (int even = 0; even < 3; even += 2) {
            dem_grain_request request = {(double[]){even, 0}, 7 + i, 100};
            for (int threads = 1; threads <= 3; threads += 2)
                break_up(&(dem_ctx){.threads = threads}, request, block, counts[i], cells[threads / 2]);
            double sum = 0;
            for (size_t k = 0; k < counts[i]; k++) {
                dem_mesh *a = &cells[0][k], *b = &cells[1][k];
                check_sound(a);
                sum += dem_mesh_solid(a).volume;
                dem_box box = dem_mesh_box(a);
                check_vec(v3_min(box.low, v3(0, 0, 0)), v3(0, 0, 0), 1e-15);
                check_vec(v3_max(box.high, block), block, 1e-15);
                check(a->vertex_count == b->vertex_count);
                assert_memory_equal(a->vertices, b->vertices, a->vertex_count * sizeof *a->vertices);
                dem_mesh_free(a);
                dem_mesh_free(b);
            }
            check_close(sum, block.x * block.y * block.z, 1e-12);  // rounding; 1e-10 is asked for
        }
}

static void evened_cells_are_more_alike(void **state)
{
    (void)state;
    enum { COUNT = 60 };
    double spread[2];
    for (int i = 0; i < 2; i++) {
        dem_mesh cells[COUNT];
        break_up(NULL, (dem_grain_request){(double[]){20.0 * i, 0}, 3, 80}, v3(1, 1, 1), COUNT, cells);
        double square = 0;
        for (size_t k = 0; k < COUNT; k++) {
            double v = COUNT * dem_mesh_solid(&cells[k]).volume - 1;
            square += v * v / COUNT;
            dem_mesh_free(&cells[k]);
        }
        spread[i] = sqrt(square);
    }
    check(spread[0] > 0.3 && spread[1] < 0.15);  // random cells in space: 0.42
}

static void wear_takes_edges_and_leaves_faces(void **state)
{
    (void)state;
    double area = INFINITY;
    for (int wear = 0; wear <= 3; wear++) {
        dem_mesh cube;
        // the one cell of a block is the block: worn, a rounded cube of the same faces
        break_up(NULL, (dem_grain_request){(double[]){0, 0.3 * wear}, 1, 4000}, v3(2, 2, 2), 1, &cube);
        check_sound(&cube);
        double r = 0.3 * wear, core = 2 - 2 * r;
        double volume = pow(core, 3) + 6 * core * core * r + 3 * DEM_PI * core * r * r + 4 * DEM_PI / 3 * r * r * r;
        dem_solid solid = dem_mesh_solid(&cube);
        check_close(solid.volume, volume, 8e-3);  // chords
        check(solid.volume <= volume * (1 + 1e-12) && solid.area < area);
        check_vec(v3_sub(dem_mesh_box(&cube).high, dem_mesh_box(&cube).low), v3(2, 2, 2), 1e-9);
        area = solid.area;
        dem_mesh_free(&cube);
    }
}

// Every corner of every range, at few triangles. Lengths differ by 49; where the sum of harmonics or a few planes make
// no grain they must say so.
static void every_corner_of_every_range_makes_a_sound_grain(void **state)
{
    (void)state;
    const dem_grain_kind *kind;
    for (size_t k = 0; (kind = dem_grain_kind_at(k)); k++) {
        size_t refused = 0, corners = (size_t)1 << kind->param_count;
        for (size_t corner = 0; corner < corners; corner += SLOW_BUILD ? 5 : 1) {
            double values[DEM_GRAIN_PARAMS];
            for (size_t i = 0; i < kind->param_count; i++) {
                const dem_grain_param *p = &kind->params[i];
                bool high = corner >> i & 1, length = strcmp(p->unit, "m") == 0;
                values[i] = length ? p->standard * (high ? 7 : 1.0 / 7) : high ? p->high : p->low;
            }
            dem_grain_options o = of_kind(kind->name, values, 300);
            o.seed = corner;
            if (corner % 3 == 1)
                o.elongation = o.flatness = DEM_GRAIN_MIN_STRETCH;
            if (corner % 3 == 2)
                o.dents = DEM_GRAIN_MAX_DENTS, o.dent_depth = DEM_GRAIN_MAX_DEPTH, o.dent_width_deg = 90;
            dem_mesh mesh;
            dem_error error;
            if (dem_grain_make(NULL, &o, &mesh, &error) != DEM_OK) {
                check(error.code == DEM_USAGE && (strstr(error.text, "hollowed out") || strstr(error.text, "enclose")));
                refused++;
                continue;
            }
            if (corner % 3 == 2 && strcmp(kind->name, "ellipsoid") != 0)
                check(dem_mesh_solid(&mesh).volume > 0);  // 20 deepest dents at few triangles: closed and star-shaped
            check_sound(&mesh);
            dem_mesh_free(&mesh);
        }
        bool may_refuse = kind == &dem_grain_harmonics || kind == &dem_grain_facets;
        check(may_refuse ? refused < corners * 2 / 3 : refused == 0);
    }
}

static void what_makes_no_grain_is_refused_in_words(void **state)
{
    (void)state;
    const struct {
        const char *kind, *want;
        double values[5];
    } bad[] = {
        {"polyhedron", "no regular solid of 5 faces; give 4, 6, 8, 12, 20", {5, NAN, NAN, NAN}},
        {"polyhedron", "rounding must be a number from 0 to 1, not 1.5", {NAN, NAN, NAN, 1.5}},
        {"superquadric", "n1 must be a number from 2 to 50, not 1", {NAN, NAN, NAN, 1, NAN}},
        {"superquadric", "half axes differ by a factor of 1e+06; at most 100", {1, 1, 1e-6, NAN, NAN}},
        {"ellipsoid", "axes differ by a factor of 1e+06; at most 2500", {1, 1, 1e-6}},
        {"rock", "wear must be a number from 0 to 0.9, not 1", {NAN, 1}},
    };
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        dem_grain_options o = of_kind(bad[i].kind, bad[i].values, 500);
        dem_mesh mesh;
        dem_error error;
        check(dem_grain_make(NULL, &o, &mesh, &error) == DEM_USAGE && mesh.vertices == NULL);
        if (!strstr(error.text, bad[i].want))
            fail_msg("%s", error.text);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(superquadrics_have_the_volume_of_their_formula),
        cmocka_unit_test(superquadric_triangles_are_about_equal),
        cmocka_unit_test(rounded_solids_obey_steiner),
        cmocka_unit_test(random_hulls_are_convex_and_grow_rounder),
        cmocka_unit_test(cells_fill_their_block),
        cmocka_unit_test(evened_cells_are_more_alike),
        cmocka_unit_test(wear_takes_edges_and_leaves_faces),
        cmocka_unit_test(every_corner_of_every_range_makes_a_sound_grain),
        cmocka_unit_test(what_makes_no_grain_is_refused_in_words),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
