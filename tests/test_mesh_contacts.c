// Balls at walls of triangles: how often they touch, where, and what they feel. Radius 1 unless said otherwise.
#include "walls.h"

enum { MOST = DEM_MESH_CONTACTS };

static void check_is_push(const dem_mesh_wall *wall, dem_vec3 centre, dem_vec3 want, double tolerance)
{
    check_vec(wall_push_at(wall, centre, 1), want, tolerance);
}

// one contact with z = 0, as deep and as steep as with a plane; rounding of coordinates turns what is near more
static void check_is_floor(const dem_mesh_wall *wall, dem_vec3 centre)
{
    dem_mesh_contact c[MOST];
    assert_int_equal(wall_touch(wall, centre, 1, c), 1);
    check_near(c[0].distance, centre.z, 1e-15);
    check_vec(c[0].normal, v3(0, 0, 1), 1e-15 / centre.z);
    check_vec(c[0].point, v3(centre.x, centre.y, 0), 1e-15);
}

static void a_quad_is_felt_once_however_it_is_triangulated(void **state)
{
    (void)state;
    const double ends[2] = {-2, 2}, through_x[3] = {-2, 0.3, 2}, through_y[3] = {-2, 0.2, 2};
    const double slivers[6] = {-2, 0.3 - 1e-7, 0.3, 0.3 + 1e-7, 0.3 + 2e-7, 2};
    double fine[81];
    for (int i = 0; i <= 80; i++)
        fine[i] = -2 + i * 0.05;
    for (int pattern = 0; pattern < 3; pattern++) {
        dem_mesh_wall *walls[] = {wall_of(wall_sheet(ends, 2, ends, 2, pattern)),
                                  wall_of(wall_sheet(through_x, 3, ends, 2, pattern)),
                                  wall_of(wall_sheet(through_x, 3, through_y, 3, pattern)),
                                  wall_of(wall_sheet(slivers, 6, through_y, 3, pattern)),
                                  wall_of(wall_sheet(slivers, 6, ends, 2, pattern)),
                                  wall_of(wall_sheet(fine, 81, fine, 81, pattern)),
                                  wall_of(wall_refined(wall_sheet(slivers, 6, fine, 81, pattern)))};
        for (size_t i = 0; i < sizeof walls / sizeof *walls; i++) {
            check_is_floor(walls[i], v3(0.3, 0.2, 0.95));
            check_is_floor(walls[i], v3(0.3, 0.2, 0.05));
            dem_mesh_wall_destroy(walls[i]);
        }
    }
}

// beside, above and at shared edges and corners; the plane's force within rounding of its size 1
static void nothing_happens_above_a_shared_edge_or_corner(void **state)
{
    (void)state;
    const double xs[4] = {-3, 0, 0.7, 3}, ys[4] = {-3, -0.4, 0, 3};
    for (int pattern = 0; pattern < 3; pattern++) {
        dem_mesh_wall *wall = wall_of(wall_sheet(xs, 4, ys, 4, pattern));
        for (double aside = 1; aside > 1e-20; aside *= 0.1)
            for (int k = 0; k < 9; k++) {
                double x = (k % 3 - 1) * aside, y = (k / 3 - 1) * aside;
                check_is_push(wall, v3(x, y, 0.95), v3(0, 0, 0.05), 1e-14);
                check_is_push(wall, v3(0.7 + x, -0.4 + y, -0.95), v3(0, 0, -0.05), 1e-14);
                check_is_push(wall, v3(0.2 + x, 0.2 + y, 0.3), v3(0, 0, 0.7), 1e-14);
            }
        dem_mesh_wall_destroy(wall);
    }
}

static void a_groove_is_felt_on_both_sides(void **state)
{
    (void)state;
    dem_mesh_contact c[MOST];
    dem_mesh_wall *wall = wall_of(wall_groove());
    assert_int_equal(wall_touch(wall, v3(0.95, 0, 0.95), 1, c), 2);
    check_near(c[0].distance, 0.95, 1e-15);
    check_near(c[1].distance, 0.95, 1e-15);
    check_vec(wall_push(c, 2, 1), v3(0.05, 0, 0.05), 1e-15);
    // farther out only one side is in reach
    assert_int_equal(wall_touch(wall, v3(1.05, 0, 0.95), 1, c), 1);
    check_vec(c[0].normal, v3(0, 0, 1), 1e-15);
    // from below and behind, it is an edge that sticks out
    assert_int_equal(wall_touch(wall, v3(-0.6, 0, -0.6), 1, c), 1);
    check(c[0].part >= DEM_ON_EDGE_AB && c[0].part <= DEM_ON_EDGE_CA);
    check_near(c[0].distance, 0.6 * sqrt(2), 1e-15);
    check_vec(c[0].normal, v3(-sqrt(0.5), 0, -sqrt(0.5)), 1e-15);
    dem_mesh_wall_destroy(wall);
}

static void a_corner_of_three_planes_is_three_contacts(void **state)
{
    (void)state;
    dem_mesh_contact c[MOST];
    dem_mesh box = shape_box(4, 4, 4);
    for (int round = 0; round < 3; round++) {
        dem_mesh copy;
        dem_error error;
        check_ok(dem_mesh_copy(&box, &copy, &error), error);
        dem_mesh_wall *wall = wall_of(copy);
        assert_int_equal(wall_touch(wall, v3(0.97, 0.96, 0.95), 1, c), 3);
        check_vec(c[0].normal, v3(0, 0, 1), 1e-15);
        check_vec(c[1].normal, v3(0, 1, 0), 1e-15);
        check_vec(c[2].normal, v3(1, 0, 0), 1e-15);
        check_vec(wall_push(c, 3, 1), v3(0.03, 0.04, 0.05), 1e-15);
        assert_int_equal(wall_touch(wall, v3(2, 2, 2), 1.99, c), 0);
        assert_int_equal(wall_touch(wall, v3(2, 2, 2), 2.01, c), 6);
        dem_mesh_wall_destroy(wall);
        box = wall_refined(box);
    }
    dem_mesh_free(&box);
}

static void a_wedge_is_felt_at_its_edge_only(void **state)
{
    (void)state;
    dem_mesh_contact c[MOST];
    // a ridge along y at x = 0, z = 0, both sides falling at 45 degrees
    dem_mesh_wall *wall = wall_of(wall_join(wall_quad(v3(0, -4, 0), v3(4, -4, -4), v3(4, 4, -4), v3(0, 4, 0)),
                                            wall_quad(v3(-4, -4, -4), v3(0, -4, 0), v3(0, 4, 0), v3(-4, 4, -4))));
    assert_int_equal(wall_touch(wall, v3(0, 0.3, 0.95), 1, c), 1);
    check(c[0].part >= DEM_ON_EDGE_AB && c[0].part <= DEM_ON_EDGE_CA);
    check_vec(c[0].normal, v3(0, 0, 1), 1e-15);
    check_near(c[0].distance, 0.95, 1e-15);
    // rolling over it: always one contact, and the force turns with the place of the ball
    for (int i = -1000; i <= 1000; i++) {
        double angle = i * 0.0009 + 0.5 * DEM_PI;  // 51.6 degrees to both sides; faces from 45 on
        dem_vec3 out = v3(cos(angle), 0, sin(angle));
        assert_int_equal(wall_touch(wall, v3_scale(out, 0.9), 1, c), 1);
        double lean = fmax(fabs(angle - 0.5 * DEM_PI) - 0.25 * DEM_PI, 0);
        check_near(c[0].distance, 0.9 * cos(lean), 1e-15);
        check_near(v3_dot(c[0].normal, out), cos(lean), 1e-15);
    }
    dem_mesh_wall_destroy(wall);
}

// the ridge ends at a wall that shares its corner and is nearer: both count, whichever end its edge starts from
static void a_ridge_that_runs_into_a_wall_is_felt_beside_it(void **state)
{
    (void)state;
    const dem_vec3 vertices[] = {{0, 0, 0}, {4, 0, -4}, {-4, 0, -4}, {-4, 0, 4},
                                 {4, 0, 4}, {0, 4, 0},  {4, 4, -4},  {-4, 4, -4}};
    const uint32_t wall_triangles[9] = {0, 3, 2, 0, 4, 3, 0, 1, 4};
    const uint32_t ridges[2][12] = {{0, 5, 6, 0, 6, 1, 0, 5, 2, 5, 2, 7}, {5, 0, 6, 0, 6, 1, 5, 0, 2, 5, 2, 7}};
    for (int k = 0; k < 2; k++) {
        uint32_t triangles[21];
        memcpy(triangles, wall_triangles, sizeof wall_triangles);
        memcpy(&triangles[9], ridges[k], sizeof ridges[k]);
        dem_mesh_wall *wall = wall_of(shape_copy(vertices, 8, triangles, 7));
        dem_mesh_contact c[MOST];
        assert_int_equal(wall_touch(wall, v3(0, 0.9, 0.95), 1, c), 2);
        check_vec(c[0].normal, v3(0, 1, 0), 1e-15);
        check_vec(c[1].normal, v3(0, 0, 1), 1e-15);
        dem_mesh_wall_destroy(wall);
    }
}

static void of_equally_near_triangles_the_first_is_touched(void **state)
{
    (void)state;
    const double ends[2] = {-3, 3};
    dem_mesh_contact c[MOST];
    dem_mesh_wall *wall = wall_of(wall_join(wall_sheet(ends, 2, ends, 2, 0), wall_sheet(ends, 2, ends, 2, 0)));
    assert_int_equal(wall_touch(wall, v3(0.5, 0.2, 0.9), 1, c), 1);
    assert_int_equal(c[0].triangle, 0);
    assert_int_equal(wall_touch(wall, v3(0.2, 0.5, 0.9), 1, c), 1);
    assert_int_equal(c[0].triangle, 1);
    dem_mesh_wall_destroy(wall);
}

static void a_thin_plate_is_felt_on_the_near_side_and_a_slot_on_both(void **state)
{
    (void)state;
    dem_mesh_contact c[MOST];
    const double ends[2] = {-3, 3};
    dem_mesh upper = wall_sheet(ends, 2, ends, 2, 1);
    shape_move(&upper, (dem_quat){1, 0, 0, 0}, v3(0, 0, 0.1));
    dem_mesh_wall *plate = wall_of(wall_join(wall_sheet(ends, 2, ends, 2, 0), upper));
    assert_int_equal(wall_touch(plate, v3(0.5, 0.4, 0.9), 1, c), 1);
    check_near(c[0].distance, 0.8, 1e-15);
    assert_int_equal(wall_touch(plate, v3(0.5, 0.4, -0.9), 1, c), 1);
    check_near(c[0].distance, 0.9, 1e-15);
    check_vec(c[0].normal, v3(0, 0, -1), 1e-15);
    assert_int_equal(wall_touch(plate, v3(0.5, 0.4, 0.04), 0.08, c), 2);
    check_near(c[0].distance, 0.04, 1e-15);
    check_near(c[1].distance, 0.06, 1e-15);
    check_vec(c[1].normal, v3(0, 0, -1), 1e-15);
    dem_mesh_wall_destroy(plate);
}

// A strip of 1000 triangles 1 m long. Turned, its corners are off the plane by rounding of their coordinates, and that
// over the 2 mm between them turns the normals.
static void a_ball_rolls_over_a_thousand_triangles_as_over_a_plane(void **state)
{
    (void)state;
    const double radius = 0.05, height = 0.0499, ys[2] = {-0.1, 0.1};
    double xs[501];
    for (int i = 0; i <= 500; i++)
        xs[i] = i / 500.0;
    dem_random r = random_stream(2, 0);
    dem_quat turn = random_turn(&r);
    for (int turned = 0; turned < 2; turned++) {
        dem_mesh strip = wall_sheet(xs, 501, ys, 2, 2);
        if (turned)
            shape_move(&strip, turn, v3(0, 0, 0));
        dem_mesh_wall *wall = wall_of(strip);
        assert_int_equal(wall->mesh.triangle_count, 1000);
        for (int i = 0; i <= 10000; i++) {
            dem_mesh_contact c[MOST];
            dem_vec3 centre = v3(i / 10000.0, 0.03 * sin(i * 0.01), height);
            if (turned)
                centre = quat_rotate(turn, centre);
            assert_int_equal(wall_touch(wall, centre, radius, c), 1);
            check_near(radius - c[0].distance, radius - height, turned ? 3e-16 : 1e-15 * radius);
            check_vec(c[0].normal, turned ? quat_rotate(turn, v3(0, 0, 1)) : v3(0, 0, 1), turned ? 1e-13 : 1e-15);
        }
        dem_mesh_wall_destroy(wall);
    }
}

// ---- meshes that describe one surface in different ways

static void check_equal_pushes(const dem_mesh_wall *a, const dem_mesh_wall *b, dem_vec3 low, dem_vec3 high,
                               double radius, double tolerance)
{
    dem_random r = random_stream(4, 0);
    for (int i = 0; i < 3000; i++) {
        dem_mesh_contact ca[MOST], cb[MOST];
        double u = random_uniform(&r), v = random_uniform(&r), w = random_uniform(&r);
        dem_vec3 centre = v3_add(low, v3((high.x - low.x) * u, (high.y - low.y) * v, (high.z - low.z) * w));
        int na = wall_touch(a, centre, radius, ca), nb = wall_touch(b, centre, radius, cb);
        assert_int_equal(na, nb);
        for (int k = 0; k < na; k++)
            check_near(ca[k].distance, cb[k].distance, tolerance);
        if (na > 0)  // rounding of coordinates turns what is near more
            check_vec(wall_push(ca, na, radius), wall_push(cb, nb, radius), tolerance * radius / ca[0].distance);
    }
}

static void a_finer_mesh_of_the_same_surface_is_the_same_wall(void **state)
{
    (void)state;
    const double ends[2] = {-2, 2};
    const double radii[2] = {1, 0.3};
    for (int i = 0; i < 2; i++) {
        dem_mesh_wall *coarse[] = {wall_of(wall_sheet(ends, 2, ends, 2, 0)), wall_of(wall_groove()),
                                   wall_of(shape_box(2.5, 2.5, 2.5))};
        dem_mesh_wall *fine[] = {wall_of(wall_refined(wall_refined(wall_sheet(ends, 2, ends, 2, 1)))),
                                 wall_of(wall_refined(wall_groove())),
                                 wall_of(wall_refined(wall_refined(wall_refined(shape_box(2.5, 2.5, 2.5)))))};
        for (int k = 0; k < 3; k++) {
            check_equal_pushes(coarse[k], fine[k], v3(-1, -1, -1), v3(3, 3, 3), radii[i], 1e-14);
            dem_mesh_wall_destroy(coarse[k]);
            dem_mesh_wall_destroy(fine[k]);
        }
    }
}

// The ball reaches over folds of facets beyond the nearest two, which are no contacts: on this side of them the surface
// comes nearer. The corners of the finer mesh are off the facets by rounding.
static void the_folds_of_a_drum_farther_off_are_not_felt(void **state)
{
    (void)state;
    for (int facets = 24; facets <= 384; facets *= 4) {
        dem_mesh_wall *coarse = wall_of(wall_drum(facets)), *fine = wall_of(wall_refined(wall_drum(facets)));
        double inner = cos(DEM_PI / facets);  // distance of the facets from the axis
        for (int i = 0; i < 4000; i++) {
            dem_mesh_contact c[MOST];
            double angle = i * 2 * DEM_PI / 4000, away = inner - 0.295;  // 0.005 into the middle of a facet
            dem_vec3 centre = v3(away * cos(angle), 0.1, away * sin(angle));
            int count = wall_touch(coarse, centre, 0.3, c);
            check(count <= 2);
            assert_int_equal(wall_touch(fine, centre, 0.3, c), count);
            check_vec(wall_push_at(fine, centre, 0.3), wall_push_at(coarse, centre, 0.3), 1e-14);
        }
        dem_mesh_wall_destroy(coarse);
        dem_mesh_wall_destroy(fine);
    }
}

// triangles, their corners, and vertices in another order; what is equally near may then be taken from another triangle
static void the_order_of_triangles_and_vertices_does_not_matter(void **state)
{
    (void)state;
    dem_random r = random_stream(5, 0);
    for (int round = 0; round < 4; round++) {
        dem_mesh mesh = round % 2 ? wall_refined(shape_box(2, 2, 2)) : shape_grain(6), other;
        dem_error error;
        if (round > 1)
            shape_move(&mesh, random_turn(&r), random_point(&r));
        check_ok(dem_mesh_copy(&mesh, &other, &error), error);
        for (size_t i = 0; i < other.triangle_count; i++) {
            size_t k = random_below(&r, i + 1), turn = random_below(&r, 3);
            uint32_t own[3], *ti = &other.triangles[3 * i], *tk = &other.triangles[3 * k];
            memcpy(own, ti, sizeof own);
            memcpy(ti, tk, sizeof own);
            for (size_t j = 0; j < 3; j++)
                tk[j] = own[(j + turn) % 3];
        }
        for (size_t i = 0, n = other.vertex_count; i < n / 2; i++) {
            dem_vec3 swap = other.vertices[i];
            other.vertices[i] = other.vertices[n - 1 - i];
            other.vertices[n - 1 - i] = swap;
        }
        for (size_t i = 0; i < 3 * other.triangle_count; i++)
            other.triangles[i] = (uint32_t)other.vertex_count - 1 - other.triangles[i];
        dem_mesh_wall *a = wall_of(mesh), *b = wall_of(other);
        check_equal_pushes(a, b, v3(-2, -2, -2), v3(3, 3, 3), 0.6, 1e-14);
        dem_mesh_wall_destroy(a);
        dem_mesh_wall_destroy(b);
    }
}

// ---- hard cases

static dem_mesh random_soup(dem_random *r, size_t count, double length)
{
    dem_mesh mesh = {.vertices = malloc(3 * count * sizeof *mesh.vertices),
                     .triangles = malloc(3 * count * sizeof *mesh.triangles),
                     .vertex_count = 3 * count,
                     .triangle_count = count};
    check(mesh.vertices && mesh.triangles);
    for (size_t i = 0; i < 3 * count; i++) {
        // some share corners with earlier triangles, some are slivers, some lie in a plane
        dem_vec3 offset = v3_scale(random_point(r), length);
        mesh.vertices[i] = i % 3 == 0   ? random_point(r)
                           : i % 9 == 5 ? v3_along(mesh.vertices[i - 1], 1e-7, offset)
                                        : v3_add(mesh.vertices[i - 1], offset);
        if (i % 12 > 8)
            mesh.vertices[i].z = 0.25;
        mesh.triangles[i] = i > 20 && i % 5 == 0 ? (uint32_t)random_below(r, i) : (uint32_t)i;
    }
    return mesh;
}

static double brute_force_distance2(const dem_mesh_wall *wall, dem_vec3 p)
{
    double best = INFINITY;
    for (size_t i = 0; i < wall->mesh.triangle_count; i++) {
        double d = triangle_closest(&wall->triangles[i], p).distance2;
        best = d < best ? d : best;
    }
    return best;
}

static void in_a_soup_of_triangles_the_nearest_is_always_felt(void **state)
{
    (void)state;
    dem_random r = random_stream(6, 0);
    for (int round = 0; round < 12; round++) {
        dem_mesh_wall *wall = wall_of(random_soup(&r, 20 << round % 4, round < 4 ? 0.2 : round < 8 ? 1 : 20));
        for (int i = 0; i < 400; i++) {
            dem_mesh_contact c[MOST];
            const dem_triangle *t = &wall->triangles[random_below(&r, wall->mesh.triangle_count)];
            // anywhere, at a corner, on an edge, on a face
            dem_vec3 p = random_point(&r), places[4] = {p, t->a, v3_scale(v3_add(t->a, t->b), 0.5),
                                                        v3_scale(v3_add(t->a, v3_add(t->b, t->c)), 1.0 / 3)};
            double radius = pow(10, -4 * random_uniform(&r));
            p = places[i % 4];
            int count = wall_touch(wall, p, radius, c);
            double want = brute_force_distance2(wall, p);
            check((count > 0) == (want < radius * radius));
            check(count == 0 || c[0].distance == sqrt(want));
        }
        dem_mesh_wall_destroy(wall);
    }
}

static void a_centre_on_a_triangle_is_pushed_along_its_normal(void **state)
{
    (void)state;
    dem_mesh_contact c[MOST];
    const double ends[3] = {-2, 0, 2};
    dem_mesh_wall *wall = wall_of(wall_sheet(ends, 3, ends, 3, 0));
    const dem_vec3 places[] = {{0.3, 0.2, 0}, {0.5, 0.5, 0}, {0, 0.7, 0}, {0, 0, 0}, {-1, 0, 0}};
    for (size_t i = 0; i < sizeof places / sizeof *places; i++)
        for (int k = -3; k <= 3; k++) {
            dem_vec3 p = places[i];
            p.z = k * 1e-18;
            assert_int_equal(wall_touch(wall, p, 1, c), 1);
            check_vec(c[0].normal, v3(0, 0, k < 0 ? -1 : 1), 0);
            check_near(c[0].distance, fabs(p.z), 1e-30);
        }
    dem_mesh_wall_destroy(wall);
}

// a fine floor and a fine wall: more candidates than are kept at a time
static void many_candidates_come_to_the_same_contacts(void **state)
{
    (void)state;
    dem_mesh mesh = wall_groove();
    for (int i = 0; i < 7; i++)
        mesh = wall_refined(mesh);
    dem_mesh_wall *coarse = wall_of(wall_groove()), *fine = wall_of(mesh);
    dem_ray_list list = {0};
    dem_random r = random_stream(7, 0);
    for (int i = 0; i < 100; i++) {
        dem_mesh_contact want[MOST], got[MOST], sifted[MOST];
        dem_vec3 centre = v3_add(v3(0.95, 0, 0.95), v3_scale(random_point(&r), 0.04));
        int count = wall_touch(coarse, centre, 1, want);
        check(dem_mesh_wall_near(fine, centre, 1.05, &list) && list.count > 100);
        check(dem_mesh_wall_contacts(fine, list.items, list.count, centre, 1, got, MOST) == count);
        check_vec(wall_push(got, count, 1), wall_push(want, count, 1), 1e-14);
        // as sifted from closest points found beforehand
        dem_closest *spots = malloc(list.count * sizeof *spots);
        dem_vec3 *centres = malloc(list.count * sizeof *centres);
        check(spots && centres);
        for (size_t k = 0; k < list.count; k++)
            centres[k] = centre;
        dem_mesh_wall_spots(fine, list.items, centres, list.count, spots);
        check(dem_mesh_wall_sift(fine, list.items, spots, list.count, centre, 1, sifted, MOST) == count);
        check(memcmp(sifted, got, (size_t)count * sizeof *got) == 0);
        free(spots);
        free(centres);
    }
    free(list.items);
    dem_mesh_wall_destroy(coarse);
    dem_mesh_wall_destroy(fine);
}

static void beyond_the_most_contacts_the_nearest_are_kept(void **state)
{
    (void)state;
    dem_mesh sphere = shape_sphere(1), mesh = {0};  // an octahedron: 8 faces about the origin; two of them, turned
    for (int k = 0; k < 2; k++) {
        dem_mesh part;
        dem_error error;
        check_ok(dem_mesh_copy(&sphere, &part, &error), error);
        shape_scale(&part, 1.7, 1.7, 1.7);
        shape_move(&part, k ? quat_unit((dem_quat){1, 0.3, 0.2, 0.1}) : (dem_quat){1, 0, 0, 0},
                   v3(0.003, 0.002, 0.001));
        mesh = wall_join(mesh, part);
    }
    dem_mesh_free(&sphere);
    dem_mesh_wall *wall = wall_of(mesh);
    dem_mesh_contact c[MOST], fewer[MOST];
    assert_int_equal(wall_touch(wall, v3(0, 0, 0), 1, c), MOST);
    uint32_t ids[16];
    for (uint32_t i = 0; i < 16; i++)
        ids[i] = 15 - i;
    for (int most = 0; most <= MOST; most++) {
        assert_int_equal(dem_mesh_wall_contacts(wall, ids, 16, v3(0, 0, 0), 1, fewer, most), most);
        check(memcmp(fewer, c, (size_t)most * sizeof *c) == 0);
    }
    dem_mesh_wall_destroy(wall);
}

// ---- what a contact goes on with

// takes a ball along a path in `steps` steps; returns how many contacts began on the way
static int beginnings(const dem_mesh_wall *wall, dem_vec3 (*path)(double), int steps, double radius)
{
    dem_mesh_contact last[MOST];
    int last_count = 0, began = 0;
    for (int i = 0; i <= steps; i++) {
        dem_mesh_contact c[MOST];
        int from[MOST];
        dem_vec3 now = path((double)i / steps), before = path((i - 1.0) / steps);
        int count = wall_touch(wall, now, radius, c);
        dem_mesh_contacts_follow(last, last_count, c, count, 1.01 * v3_distance(now, before), from);
        for (int k = 0; k < count; k++)
            began += from[k] < 0;
        last_count = count;
        memcpy(last, c, sizeof last);
    }
    return began;
}

static dem_vec3 along_the_floor(double s)
{
    return v3(-1.5 + 3 * s, 0.4 * sin(3 * s), 0.98);
}

static dem_vec3 over_the_edge(double s)
{
    double angle = DEM_PI * (0.85 - 0.7 * s);
    return v3(cos(angle), 0.2 * s, sin(angle));
}

static dem_vec3 into_the_groove(double s)
{
    return v3(1.5 - 0.52 * s, 0, 0.98);
}

static void a_contact_goes_on_from_triangle_to_triangle(void **state)
{
    (void)state;
    double xs[41];
    for (int i = 0; i <= 40; i++)
        xs[i] = -2 + 0.1 * i;
    dem_mesh_wall *floor = wall_of(wall_sheet(xs, 41, xs, 41, 2));
    dem_mesh_wall *ridge = wall_of(wall_join(wall_quad(v3(0, -4, 0), v3(4, -4, -4), v3(4, 4, -4), v3(0, 4, 0)),
                                             wall_quad(v3(-4, -4, -4), v3(0, -4, 0), v3(0, 4, 0), v3(-4, 4, -4))));
    dem_mesh_wall *groove = wall_of(wall_groove());
    assert_int_equal(beginnings(floor, along_the_floor, 500, 1), 1);
    assert_int_equal(beginnings(ridge, over_the_edge, 500, 1.05), 1);
    // the second side of a groove is a contact of its own
    assert_int_equal(beginnings(groove, into_the_groove, 500, 1), 2);
    dem_mesh_wall_destroy(floor);
    dem_mesh_wall_destroy(ridge);
    dem_mesh_wall_destroy(groove);
}

static void the_nearest_contact_within_reach_goes_on_and_only_once(void **state)
{
    (void)state;
    const dem_vec3 up = {0, 0, 1}, leaning = {sin(0.25), 0, cos(0.25)}, fallen = {sin(0.27), 0, cos(0.27)};
    const dem_mesh_contact last[4] = {{.point = {0, 0, 0}, .normal = up},
                                      {.point = {1, 0, 0}, .normal = up},
                                      {.point = {1.3, 0, 0}, .normal = up},
                                      {.point = {5, 0, 0}, .normal = {1, 0, 0}}};
    dem_mesh_contact c[MOST] = {{.point = {0.2, 0, 0}, .normal = leaning}};
    int from[MOST];
    dem_mesh_contacts_follow(last, 4, c, 1, 0.21, from);
    assert_int_equal(from[0], 0);
    dem_mesh_contacts_follow(last, 4, c, 1, 0.19, from);  // too far
    assert_int_equal(from[0], -1);
    c[0].normal = fallen;  // 15.5 degrees
    dem_mesh_contacts_follow(last, 4, c, 1, 0.21, from);
    assert_int_equal(from[0], -1);
    dem_mesh_contacts_follow(last, 0, c, 1, 10, from);
    assert_int_equal(from[0], -1);
    // the first two want contact 1: the nearer gets it, the other takes what is left, the third finds nothing that fits
    c[0] = (dem_mesh_contact){.point = {0.8, 0, 0}, .normal = up};
    c[1] = (dem_mesh_contact){.point = {1.1, 0, 0}, .normal = up};
    c[2] = (dem_mesh_contact){.point = {5, 0, 0}, .normal = up};
    dem_mesh_contacts_follow(last, 4, c, 3, 0.9, from);
    check(from[0] == 2 && from[1] == 1 && from[2] == -1);
    dem_mesh_contacts_follow(last, 4, c, 3, 0.4, from);
    check(from[0] == -1 && from[1] == 1 && from[2] == -1);
    // exactly there, without any reach
    dem_mesh_contacts_follow(last, 4, (dem_mesh_contact[]){{.point = {1, 0, 0}, .normal = up}}, 1, 0, from);
    assert_int_equal(from[0], 1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_quad_is_felt_once_however_it_is_triangulated),
        cmocka_unit_test(nothing_happens_above_a_shared_edge_or_corner),
        cmocka_unit_test(a_groove_is_felt_on_both_sides),
        cmocka_unit_test(a_corner_of_three_planes_is_three_contacts),
        cmocka_unit_test(a_wedge_is_felt_at_its_edge_only),
        cmocka_unit_test(a_ridge_that_runs_into_a_wall_is_felt_beside_it),
        cmocka_unit_test(of_equally_near_triangles_the_first_is_touched),
        cmocka_unit_test(a_thin_plate_is_felt_on_the_near_side_and_a_slot_on_both),
        cmocka_unit_test(a_ball_rolls_over_a_thousand_triangles_as_over_a_plane),
        cmocka_unit_test(a_finer_mesh_of_the_same_surface_is_the_same_wall),
        cmocka_unit_test(the_folds_of_a_drum_farther_off_are_not_felt),
        cmocka_unit_test(the_order_of_triangles_and_vertices_does_not_matter),
        cmocka_unit_test(in_a_soup_of_triangles_the_nearest_is_always_felt),
        cmocka_unit_test(a_centre_on_a_triangle_is_pushed_along_its_normal),
        cmocka_unit_test(many_candidates_come_to_the_same_contacts),
        cmocka_unit_test(beyond_the_most_contacts_the_nearest_are_kept),
        cmocka_unit_test(a_contact_goes_on_from_triangle_to_triangle),
        cmocka_unit_test(the_nearest_contact_within_reach_goes_on_and_only_once),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
