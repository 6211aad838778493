#include "check.h"
#include "shapes.h"

#include "clump/pack.h"
#include "geom/tree.h"
#include "mesh/mass.h"

static const char *const classics[] = {"bubble", "favier", "ferellec", "euclidean", "grid"};
enum { CLASSICS = sizeof classics / sizeof *classics };

// parameters as (name, value) pairs behind the count
static dem_pack pack_with(const dem_ctx *ctx, const dem_mesh *mesh, const char *method, size_t spheres,
                          const dem_pack_value *values, size_t value_count)
{
    dem_pack result;
    dem_error error;
    dem_pack_options options = dem_pack_defaults();
    options.method = method;
    options.spheres = spheres;
    options.values = values;
    options.value_count = value_count;
    check_ok(dem_clump_pack(ctx, mesh, &options, &result, &error), error);
    return result;
}

static dem_pack pack(const dem_mesh *mesh, const char *method, size_t spheres)
{
    return pack_with(NULL, mesh, method, spheres, NULL, 0);
}

static double used(const dem_pack *p, const char *name)
{
    for (size_t i = 0; i < p->used_count; i++)
        if (strcmp(p->used[i].name, name) == 0)
            return p->used[i].value;
    print_error("nothing says which %s was used\n", name);
    fail();
    return NAN;
}

static double diameter(const dem_mesh *mesh)
{
    return cbrt(6 * dem_mesh_solid(mesh).volume / DEM_PI);
}

// farthest that a ball reaches out of the mesh: its radius less the distance of its centre, which must be inside
static double protrusion(const dem_mesh *mesh, const dem_pack *p)
{
    dem_tree tree;
    dem_error error;
    double most = -INFINITY;
    check_ok(dem_tree_build(&tree, mesh->vertices, mesh->triangles, mesh->triangle_count, &error), error);
    for (size_t i = 0; i < p->count; i++) {
        check(dem_tree_inside(&tree, p->balls[i].centre));
        double depth = dem_tree_closest(&tree, p->balls[i].centre, INFINITY, NULL, NULL);
        most = fmax(most, p->balls[i].radius - depth);
    }
    dem_tree_release(&tree);
    return most;
}

static void the_first_sphere_in_a_sphere_is_that_sphere(void **state)
{
    (void)state;
    // the inscribed radius of the facets is 0.5 % below 1
    dem_mesh sphere = shape_sphere(12);
    shape_move(&sphere, (dem_quat){1, 0, 0, 0}, v3(5, -3, 2));
    for (size_t m = 0; m < CLASSICS; m++) {
        dem_pack p = pack(&sphere, classics[m], 1);
        check(p.count == 1 && p.moments == DEM_MOMENTS_FREE && p.reached);
        // tangent at a facet: off the middle by no more than facets are off the sphere; the transform's margin is a
        // voxel, of 49 across; the grid's radius is one of a ladder of 14 %
        double tolerance = strcmp(classics[m], "euclidean") == 0 ? 2.0 / 49
                           : strcmp(classics[m], "grid") == 0    ? 0.1
                                                                 : 9e-3;
        // smallest radii to try go up to 0.96 here, so the random point is one where the ball is at least that large
        bool random = strcmp(classics[m], "ferellec") == 0;
        check_vec(p.balls[0].centre, v3(5, -3, 2), random ? 0.05 : 1e-2);
        check_near(p.balls[0].radius, 1, random ? 0.05 : tolerance);
        dem_pack_free(&p);
    }
    dem_mesh_free(&sphere);
}

// radius of the largest ball at x on the axis of the ellipsoid x^2/a^2 + (y^2 + z^2)/b^2 = 1, a > b: by the derivative
// of the squared distance it touches at x a^2 / (a^2 - b^2), or at the tip
static double radius_in_ellipsoid(double a, double b, double x)
{
    double at = x * a * a / (a * a - b * b);
    return fabs(at) < a ? b * sqrt(1 - x * x / (a * a - b * b)) : a - fabs(x);
}

static void favier_places_the_analytic_inscribed_spheres_on_the_axis_of_an_ellipsoid(void **state)
{
    (void)state;
    dem_mesh ellipsoid = shape_sphere(40);
    shape_scale(&ellipsoid, 2, 1, 1);
    dem_pack p = pack(&ellipsoid, "favier", 9);
    check(p.count == 9 && used(&p, "axis") == 1);
    for (size_t i = 0; i < p.count; i++) {
        dem_vec3 c = p.balls[i].centre;
        check_near(hypot(c.y, c.z), 0, 1e-6);
        // facets are up to (edge / 2)^2 / 2 below the surface, edges pi / 80
        check_near(p.balls[i].radius, radius_in_ellipsoid(2, 1, c.x), 1.5e-3);
        check(i == 0 || p.balls[i].radius <= p.balls[i - 1].radius);
    }
    check(p.gap_estimate < 0.035);
    dem_pack_free(&p);
    dem_mesh_free(&ellipsoid);
}

static void favier_on_a_capsule_finds_its_radius_everywhere(void **state)
{
    (void)state;
    dem_mesh capsule = shape_sphere(24);
    for (size_t i = 0; i < capsule.vertex_count; i++)
        capsule.vertices[i].z += capsule.vertices[i].z > 1e-9 ? 1.5 : capsule.vertices[i].z < -1e-9 ? -1.5 : 0;
    dem_quat turn = quat_unit((dem_quat){0.7, 0.1, -0.5, 0.3});
    shape_move(&capsule, turn, v3(0, 0, 0));
    dem_pack p = pack(&capsule, "favier", 12);
    for (size_t i = 0; i < p.count; i++) {
        dem_vec3 c = quat_unrotate(turn, p.balls[i].centre);
        check_near(hypot(c.x, c.y), 0, 1e-6);
        check_near(p.balls[i].radius, 1 - fmax(fabs(c.z) - 1.5, 0), 6e-3);
    }
    dem_pack_free(&p);
    dem_mesh_free(&capsule);
}

// a ring of square section about z
static dem_mesh square_ring(double radius, double half)
{
    enum { TURNS = 32 };
    static const double side[4][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
    dem_vec3 vertices[4 * TURNS];
    uint32_t triangles[4 * TURNS * 6], *t = triangles;
    for (uint32_t i = 0; i < TURNS; i++)
        for (uint32_t k = 0; k < 4; k++) {
            double turn = 2 * DEM_PI * i / TURNS, out = radius + half * side[k][0];
            uint32_t a = 4 * i + k, b = 4 * ((i + 1) % TURNS) + k, next = (k + 1) % 4 - k;
            vertices[a] = v3(out * cos(turn), out * sin(turn), half * side[k][1]);
            const uint32_t faces[6] = {a, b, b + next, a, b + next, a + next};
            for (int c = 0; c < 6; c++)
                *t++ = faces[c];
        }
    dem_mesh ring = shape_copy(vertices, 4 * TURNS, triangles, (size_t)8 * TURNS);
    if (dem_mesh_solid(&ring).volume < 0)
        shape_flip(&ring, 0, ring.triangle_count);
    return ring;
}

static void favier_uses_the_axis_asked_for_and_says_when_it_never_meets_the_inside(void **state)
{
    (void)state;
    dem_mesh box = shape_box(3, 2, 1);
    const double half[3] = {1, 1, 0.5};  // no farther than the nearest face, on each axis
    for (int axis = 1; axis <= 3; axis++) {
        dem_pack p = pack_with(NULL, &box, "favier", 5, &(dem_pack_value){"axis", axis}, 1);
        for (size_t i = 0; i < p.count; i++) {
            dem_vec3 c = v3_sub(p.balls[i].centre, v3(1.5, 1, 0.5));
            v3_set(&c, axis - 1, 0);
            check_vec(c, v3(0, 0, 0), 1e-9);
            check(p.balls[i].radius <= half[axis - 1] + 1e-9);
        }
        dem_pack_free(&p);
    }
    dem_mesh_free(&box);
    dem_mesh ring = square_ring(1, 0.2);
    dem_pack p = pack(&ring, "favier", 2);
    check(p.count == 2 && used(&p, "axis") < 3);
    dem_pack_free(&p);
    dem_pack_options options = dem_pack_defaults();
    dem_error error;
    options.method = "favier";
    options.values = &(dem_pack_value){"axis", 3};
    options.value_count = 1;
    check(dem_clump_pack(NULL, &ring, &options, &p, &error) == DEM_FAILED);
    check(strstr(error.text, "axis") && strstr(error.text, "another"));
    dem_mesh_free(&ring);
}

static void a_grid_in_a_cube_has_the_spheres_and_the_volume_of_geometry(void **state)
{
    (void)state;
    dem_mesh cube = shape_box(1, 1, 1);
    dem_quat turn = quat_unit((dem_quat){0.6, -0.4, 0.5, 0.2});
    shape_move(&cube, turn, v3(0.3, -7, 2));
    for (int n = 1; n <= 4; n++) {
        dem_pack_value values[] = {{"spacing", 1 / (n * diameter(&cube))}, {"fill", 1}};
        dem_pack p = pack_with(NULL, &cube, "grid", 0, values, 2);
        dem_union sum;
        dem_error error;
        check((int)p.count == n * n * n);
        check_ok(dem_balls_union(p.balls, p.count, &sum, &error), error);
        // touching spheres: pi / 6 of each cell
        check_close(sum.solid.volume, DEM_PI / 6, 1e-6);
        check(protrusion(&cube, &p) < 1e-6);
        dem_pack_free(&p);
    }
    dem_mesh_free(&cube);
}

static void bubbles_overlap_by_no_more_than_the_angle_and_are_not_smaller_than_the_ratio(void **state)
{
    (void)state;
    dem_mesh grain = shape_grain(10);
    const double ratio = 0.2, angles[] = {0, 60, 120, 160};
    size_t last = 0;
    for (int k = 0; k < 4; k++) {
        dem_pack_value values[] = {{"ratio", ratio}, {"distance", angles[k]}};
        dem_pack p = pack_with(NULL, &grain, "bubble", 0, values, 2);
        check(p.count > last);  // a wider angle takes more
        last = p.count;
        for (size_t i = 0; i < p.count; i++) {
            check(p.balls[i].radius >= ratio * p.balls[0].radius * (1 - 1e-12));
            for (size_t j = 0; j < i; j++) {
                double a = p.balls[i].radius, b = p.balls[j].radius;
                double d = v3_distance(p.balls[i].centre, p.balls[j].centre);
                double meeting = (a * a + b * b - d * d) / (2 * a * b);  // cosine of the angle of the radii
                check(180 - acos(fmax(meeting, -1)) * 180 / DEM_PI <= angles[k] + 1e-4);
            }
        }
        check(protrusion(&grain, &p) <= 0.005 * p.balls[0].radius);
        dem_pack_free(&p);
    }
    dem_mesh_free(&grain);
}

static void ferellec_keeps_its_distance_its_smallest_radius_and_its_step(void **state)
{
    (void)state;
    dem_mesh grain = shape_grain(10);
    double d = diameter(&grain);
    dem_pack_value values[] = {{"dmin", 0.05}, {"rmin", 0.1}, {"rstep", 0.02}, {"pmax", 0.5}};
    dem_pack p = pack_with(NULL, &grain, "ferellec", 0, values, 4);
    check(p.count > 5);
    check(protrusion(&grain, &p) <= 0.005 * d);
    for (size_t i = 0; i < p.count; i++) {
        double steps = (p.balls[i].radius / d - 0.1) / 0.02;
        check(steps > -1e-9);
        check_near(steps, round(steps), 1e-6);
    }
    // fewer points start fewer spheres
    values[3].value = 0.01;
    dem_pack few = pack_with(NULL, &grain, "ferellec", 0, values, 4);
    check(few.count < p.count);
    dem_pack_free(&few);
    dem_pack_free(&p);
    dem_mesh_free(&grain);
}

static void euclidean_spheres_are_inscribed_up_to_a_voxel_and_overlap_as_allowed(void **state)
{
    (void)state;
    dem_mesh grain = shape_grain(10);
    double d = diameter(&grain), voxels = 40;
    const double overlaps[] = {0, 0.5, 1};
    for (int k = 0; k < 3; k++)
        for (int margin = 0; margin < 2; margin++) {
            dem_pack_value values[] = {{"overlap", overlaps[k]}, {"margin", margin}, {"voxels", voxels}};
            dem_pack p = pack_with(NULL, &grain, "euclidean", 40, values, 3);
            check(p.count == 40);
            check(protrusion(&grain, &p) <= margin * d / voxels * 1.01 + 1e-9);
            for (size_t i = 0; i < p.count; i++)
                for (size_t j = 0; j < i; j++) {
                    double room =
                        v3_distance(p.balls[i].centre, p.balls[j].centre) - (1 - overlaps[k]) * p.balls[j].radius;
                    check(p.balls[i].radius <= room + 1e-9);
                }
            dem_pack_free(&p);
        }
    dem_mesh_free(&grain);
}

// The first one fills as much of a cube as a ball can, the next eight go to the corners, all of one size: tangent to
// three faces and the first ball, r (1 + sqrt 3) = (sqrt 3 - 1) / 2.
static void euclidean_without_overlap_is_apollonian_in_a_cube(void **state)
{
    (void)state;
    dem_mesh cube = shape_box(1, 1, 1);
    dem_pack_value values[] = {{"overlap", 0}, {"margin", 0}};
    dem_pack p = pack_with(NULL, &cube, "euclidean", 9, values, 2);
    check(p.count == 9);
    // climbing ends at a 64th of a voxel, of 49 across
    check_vec(p.balls[0].centre, v3(0.5, 0.5, 0.5), 2e-3);
    check_near(p.balls[0].radius, 0.5, 1e-3);
    for (size_t i = 1; i < 9; i++)
        check_near(p.balls[i].radius, (sqrt(3) - 1) / (2 * (1 + sqrt(3))), 2e-3);
    dem_pack_free(&p);
    dem_mesh_free(&cube);
}

static void every_classic_gives_at_most_the_spheres_asked_for_and_gains_by_more(void **state)
{
    (void)state;
    dem_mesh grain = shape_grain(8);
    for (size_t m = 0; m < CLASSICS; m++) {
        double gap = 1;
        for (size_t n = 4; n <= 64; n *= 4) {
            dem_pack p = pack(&grain, classics[m], n);
            check(p.count >= 1 && p.count <= n);
            if (strcmp(classics[m], "grid") != 0 && strcmp(classics[m], "favier") != 0)
                check(p.count >= n * 3 / 4);
            if (p.gap_estimate > gap + 0.005)
                print_error("%s %zu: %g after %g\n", classics[m], n, p.gap_estimate, gap);
            check(p.gap_estimate <= gap + 0.005);
            gap = p.gap_estimate;
            dem_pack_free(&p);
        }
        check(gap < (strcmp(classics[m], "favier") == 0 ? 0.4 : strcmp(classics[m], "grid") == 0 ? 0.3 : 0.15));
    }
    dem_mesh_free(&grain);
}

static void thin_long_tiny_and_huge_grains_end_in_spheres_or_in_words(void **state)
{
    (void)state;
    dem_mesh meshes[] = {shape_box(100, 1, 1), shape_box(100, 100, 1), shape_box(3e-6, 2e-6, 1e-6),
                         shape_box(3000, 2000, 1000),
                         shape_tetrahedron(v3(0, 0, 0), v3(1, 0, 0), v3(0, 1, 0), v3(0, 0, 1))};
    for (size_t k = 0; k < sizeof meshes / sizeof *meshes; k++) {
        double d = diameter(&meshes[k]);
        for (size_t m = 0; m < CLASSICS; m++) {
            dem_pack p = pack(&meshes[k], classics[m], 6);
            check(p.count >= 1 && p.count <= 6);
            for (size_t i = 0; i < p.count; i++)
                check(p.balls[i].radius > 1e-5 * d && p.balls[i].radius < d);
            dem_pack_free(&p);
        }
        dem_mesh_free(&meshes[k]);
    }
}

static void a_classic_is_the_same_for_any_number_of_threads_and_ferellec_another_for_another_seed(void **state)
{
    (void)state;
    dem_mesh grain = shape_grain(8);
    for (size_t m = 0; m < CLASSICS; m++) {
        dem_pack one = pack_with(&(dem_ctx){.threads = 1}, &grain, classics[m], 20, NULL, 0);
        dem_pack three = pack_with(&(dem_ctx){.threads = 3}, &grain, classics[m], 20, NULL, 0);
        check(one.count == three.count && memcmp(one.balls, three.balls, one.count * sizeof *one.balls) == 0);
        dem_pack_free(&one);
        dem_pack_free(&three);
    }
    dem_pack_options options = dem_pack_defaults();
    dem_pack first = pack(&grain, "ferellec", 20), other;
    dem_error error;
    options.method = "ferellec";
    options.spheres = 20;
    options.seed = 2;
    check_ok(dem_clump_pack(NULL, &grain, &options, &other, &error), error);
    check(memcmp(first.balls, other.balls, sizeof *first.balls) != 0);
    dem_pack_free(&first);
    dem_pack_free(&other);
    dem_mesh_free(&grain);
}

static void parameters_out_of_range_and_of_other_methods_are_refused(void **state)
{
    (void)state;
    dem_mesh box = shape_box(1, 1, 1);
    const struct {
        const char *method, *name;
        double value;
        const char *says;
    } wrong[] = {
        {"bubble", "distance", 181, "0 to 180 deg"},        {"bubble", "ratio", 0, "0.001 to 0.999"},
        {"bubble", "dmin", 0.1, "has no parameter 'dmin'"}, {"optimal", "ratio", 0.1, "has no parameter 'ratio'"},
        {"ferellec", "rmin", -1, "0 to 0.5 d_eq"},          {"favier", "axis", 1.5, "whole numbers from 1 to 3"},
        {"euclidean", "overlap", INFINITY, "0 to 1"},       {"grid", "spacing", 1e-3, "ask for at least"}};
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        dem_pack_options options = dem_pack_defaults();
        dem_pack_value value = {wrong[i].name, wrong[i].value};
        dem_pack p;
        dem_error error;
        options.method = wrong[i].method;
        options.values = &value;
        options.value_count = 1;
        check(dem_clump_pack(NULL, &box, &options, &p, &error) == DEM_USAGE);
        if (!strstr(error.text, wrong[i].says))
            print_error("'%s' does not say '%s'\n", error.text, wrong[i].says);
        check(strstr(error.text, wrong[i].says));
        check(p.balls == NULL);
    }
    dem_mesh_free(&box);
}

static void inscribed_is_honoured_by_all_and_outer_refused(void **state)
{
    (void)state;
    dem_mesh grain = shape_grain(8);
    dem_pack_options options = dem_pack_defaults();
    dem_error error;
    options.spheres = 25;
    for (size_t m = 0; m < CLASSICS; m++) {
        dem_pack p;
        options.method = classics[m];
        options.side = DEM_SIDE_INSCRIBED;
        check_ok(dem_clump_pack(NULL, &grain, &options, &p, &error), error);
        check(protrusion(&grain, &p) < 1e-8);
        for (size_t i = 1; strcmp(classics[m], "grid") == 0 && i < p.count; i++)
            check_close(p.balls[i].radius, p.balls[0].radius, 1e-6);
        dem_pack_free(&p);
        options.side = DEM_SIDE_OUTER;
        check(dem_clump_pack(NULL, &grain, &options, &p, &error) == DEM_USAGE);
        check(strstr(error.text, "--outer"));
    }
    dem_mesh_free(&grain);
}

typedef struct told {
    char warning[400];
    int calls;
} told;

static void keep_warning(void *user, dem_log_level level, const char *subject, const char *text)
{
    (void)subject;
    if (level == DEM_LOG_WARNING)
        snprintf(((told *)user)->warning, sizeof((told *)user)->warning, "%s", text);
}

static void parameters_that_give_too_many_spheres_are_cut_with_a_warning(void **state)
{
    (void)state;
    dem_mesh grain = shape_grain(8);
    told t = {.calls = 0};
    dem_ctx ctx = {.log = keep_warning, .user = &t};
    dem_pack_value values[] = {{"ratio", 0.1}, {"distance", 150}};
    dem_pack all = pack_with(&ctx, &grain, "bubble", 0, values, 2);
    check(all.count > 20 && !*t.warning);
    dem_pack some = pack_with(&ctx, &grain, "bubble", 10, values, 2);
    char left_out[32];
    snprintf(left_out, sizeof left_out, "%zu left out", all.count - 10);
    check(some.count == 10 && strstr(t.warning, left_out) && strstr(t.warning, "largest first"));
    check(memcmp(some.balls, all.balls, 10 * sizeof *all.balls) == 0);
    dem_pack_free(&some);
    // what was found, given again, comes to the same
    some = pack(&grain, "bubble", 30);
    dem_pack_value found[] = {{"ratio", used(&some, "ratio")}, {"distance", used(&some, "distance")}};
    dem_pack again = pack_with(&ctx, &grain, "bubble", 0, found, 2);
    check(again.count == some.count && memcmp(again.balls, some.balls, some.count * sizeof *some.balls) == 0);
    dem_pack_free(&again);
    dem_pack_free(&some);
    dem_pack_free(&all);
    dem_mesh_free(&grain);
}

static bool stop_soon(void *user, const char *what, double fraction)
{
    (void)what;
    check(fraction >= 0 && fraction <= 1);
    return ++((told *)user)->calls > 1;
}

static void every_classic_can_be_interrupted(void **state)
{
    (void)state;
    dem_mesh grain = shape_grain(8);
    for (size_t m = 0; m < CLASSICS; m++) {
        told t = {.calls = 0};
        dem_ctx ctx = {.progress = stop_soon, .user = &t};
        dem_pack_options options = dem_pack_defaults();
        dem_pack p;
        dem_error error;
        options.method = classics[m];
        check(dem_clump_pack(&ctx, &grain, &options, &p, &error) == DEM_INTERRUPTED);
        check(t.calls == 2 && p.balls == NULL);
    }
    dem_mesh_free(&grain);
}

static void a_gap_asked_for_is_searched_with_any_method(void **state)
{
    (void)state;
    dem_mesh grain = shape_grain(8);
    dem_pack_options options = dem_pack_defaults();
    dem_pack p;
    dem_error error;
    options.method = "bubble";
    options.gap = 0.15;
    check_ok(dem_clump_pack(NULL, &grain, &options, &p, &error), error);
    check(p.reached && p.gap_estimate <= 0.15 && p.count < 100);
    dem_pack_free(&p);
    dem_pack_value values[] = {{"ratio", 0.8}, {"distance", 20}};
    options.values = values;
    options.value_count = 2;
    check_ok(dem_clump_pack(NULL, &grain, &options, &p, &error), error);
    check(!p.reached && p.gap_estimate > 0.15);
    dem_pack_free(&p);
    dem_mesh_free(&grain);
}

// the field's own code reached 25.9 and 19.0 % on this femur by the Euclidean transform
static void on_a_real_femur_the_euclidean_transform_does_as_well_as_the_field(void **state)
{
    (void)state;
    check_shared(SHARED_MESH("human_femur.stl"));
    if (SLOW_BUILD)
        skip();
    dem_mesh femur;
    dem_mesh_report report;
    dem_error error;
    check_ok(dem_mesh_read(NULL, SHARED_MESH("human_femur.stl"), &femur, &error), error);
    check_ok(dem_mesh_repair(NULL, &femur, &(dem_repair_options){0}, &report, &error), error);
    dem_pack p = pack(&femur, "euclidean", 20);
    check(p.gap_estimate < 0.259);
    dem_pack_free(&p);
    dem_mesh_free(&femur);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_first_sphere_in_a_sphere_is_that_sphere),
        cmocka_unit_test(favier_places_the_analytic_inscribed_spheres_on_the_axis_of_an_ellipsoid),
        cmocka_unit_test(favier_on_a_capsule_finds_its_radius_everywhere),
        cmocka_unit_test(favier_uses_the_axis_asked_for_and_says_when_it_never_meets_the_inside),
        cmocka_unit_test(a_grid_in_a_cube_has_the_spheres_and_the_volume_of_geometry),
        cmocka_unit_test(bubbles_overlap_by_no_more_than_the_angle_and_are_not_smaller_than_the_ratio),
        cmocka_unit_test(ferellec_keeps_its_distance_its_smallest_radius_and_its_step),
        cmocka_unit_test(euclidean_spheres_are_inscribed_up_to_a_voxel_and_overlap_as_allowed),
        cmocka_unit_test(euclidean_without_overlap_is_apollonian_in_a_cube),
        cmocka_unit_test(every_classic_gives_at_most_the_spheres_asked_for_and_gains_by_more),
        cmocka_unit_test(thin_long_tiny_and_huge_grains_end_in_spheres_or_in_words),
        cmocka_unit_test(a_classic_is_the_same_for_any_number_of_threads_and_ferellec_another_for_another_seed),
        cmocka_unit_test(parameters_out_of_range_and_of_other_methods_are_refused),
        cmocka_unit_test(inscribed_is_honoured_by_all_and_outer_refused),
        cmocka_unit_test(parameters_that_give_too_many_spheres_are_cut_with_a_warning),
        cmocka_unit_test(every_classic_can_be_interrupted),
        cmocka_unit_test(a_gap_asked_for_is_searched_with_any_method),
        cmocka_unit_test(on_a_real_femur_the_euclidean_transform_does_as_well_as_the_field),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
