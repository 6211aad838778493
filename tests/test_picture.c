#include "shapes.h"

#include <unistd.h>

#include "base/file.h"
#include "out/picture.h"
#include "out/smooth.h"

enum { WIDTH = 360, HEIGHT = 180 };

static const dem_ball BALLS[] = {{{0, 0, 0}, 0.5}, {{0.5, 0.1, 0}, 0.4}, {{-0.5, 0, 0}, 0.45}, {{0, 0.4, 0}, 0.35}};
enum { BALL_COUNT = sizeof BALLS / sizeof *BALLS };

static dem_image drawn(const dem_mesh *mesh, const dem_ball *balls, int threads, dem_view *left)
{
    dem_image image;
    dem_error error;
    dem_ctx ctx = {.threads = threads};
    if (!DEM_EMBREE)
        skip();
    check_ok(dem_picture_render(&ctx, mesh, balls, BALL_COUNT, WIDTH, HEIGHT, &image, left, &error), error);
    check(image.width == WIDTH && image.height == HEIGHT);
    return image;
}

static const uint8_t *pixel_at(const dem_image *image, int x, int y)
{
    return image->pixels + 3 * (y * image->width + x);
}

// the ground is grey or white; bodies are neither, but by chance where two colours mix
static bool shows_body(const dem_image *image, int x, int y)
{
    const uint8_t *p = pixel_at(image, x, y);
    return p[0] != p[1] || p[0] != p[2];
}

static void the_corners_are_white(void **state)
{
    (void)state;
    dem_mesh mesh = shape_grain(10);
    dem_image image = drawn(&mesh, BALLS, 1, NULL);
    for (int k = 0; k < 4; k++) {
        const uint8_t *p = pixel_at(&image, k & 1 ? WIDTH - 1 : 0, k & 2 ? HEIGHT - 1 : 0);
        check(p[0] == 255 && p[1] == 255 && p[2] == 255);
    }
    dem_image_free(&image);
    dem_mesh_free(&mesh);
}

static double edge(const double a[2], const double b[2], double x, double y)
{
    return (b[0] - a[0]) * (y - a[1]) - (b[1] - a[1]) * (x - a[0]);
}

// which pixels of the left half have their middle in the projection of a triangle
static void project_mesh(const dem_mesh *mesh, const dem_view *view, bool mask[HEIGHT][WIDTH / 2])
{
    memset(mask, 0, sizeof(bool[HEIGHT][WIDTH / 2]));
    for (size_t t = 0; t < mesh->triangle_count; t++) {
        double c[3][2];
        for (size_t k = 0; k < 3; k++)
            dem_view_project(view, mesh->vertices[mesh->triangles[3 * t + k]], &c[k][0], &c[k][1]);
        for (int y = 0; y < HEIGHT; y++)
            for (int x = 0; x < WIDTH / 2; x++) {
                double e[3];
                for (int k = 0; k < 3; k++)
                    e[k] = edge(c[k], c[(k + 1) % 3], x + 0.5, y + 0.5);
                if ((e[0] >= 0 && e[1] >= 0 && e[2] >= 0) || (e[0] <= 0 && e[1] <= 0 && e[2] <= 0))
                    mask[y][x] = true;
            }
    }
}

static void the_left_half_shows_the_outline_of_the_mesh(void **state)
{
    (void)state;
    dem_mesh mesh = shape_grain(8);
    dem_view view;
    dem_image image = drawn(&mesh, BALLS, 1, &view);
    static bool mask[HEIGHT][WIDTH / 2];
    project_mesh(&mesh, &view, mask);
    int inside = 0, outside = 0;
    for (int y = 1; y < HEIGHT - 1; y++)
        for (int x = 1; x < WIDTH / 2 - 1; x++) {
            int around = 0;
            for (int k = 0; k < 9; k++)
                around += mask[y - 1 + k / 3][x - 1 + k % 3];
            if (around != 0 && around != 9)
                continue;  // within a pixel of the outline
            check(shows_body(&image, x, y) == (around == 9));
            inside += around == 9;
            outside += around == 0;
        }
    check(inside > 2000 && outside > 2000);
    dem_image_free(&image);
    dem_mesh_free(&mesh);
}

static void the_right_half_shows_the_balls_in_the_same_scale(void **state)
{
    (void)state;
    dem_mesh mesh = shape_grain(8);
    dem_view view;
    dem_image image = drawn(&mesh, BALLS, 1, &view);
    int grey = 0, inside = 0;
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH / 2; x++) {
            double nearest = INFINITY;
            for (int i = 0; i < BALL_COUNT; i++) {
                double u, v;
                dem_view_project(&view, BALLS[i].centre, &u, &v);
                nearest = fmin(nearest, hypot(u - x - 0.5, v - y - 0.5) - BALLS[i].radius / view.pixel);
            }
            if (nearest > 1)
                check(!shows_body(&image, x + WIDTH / 2, y));
            inside += nearest < -1;
            grey += nearest < -1 && !shows_body(&image, x + WIDTH / 2, y);
        }
    check(inside > 2000);
    check_near(grey, 0, inside / 500.0);
    dem_image_free(&image);
    dem_mesh_free(&mesh);
}

static void the_picture_is_the_same_for_any_number_of_threads(void **state)
{
    (void)state;
    dem_mesh mesh = shape_grain(10);
    dem_image one = drawn(&mesh, BALLS, 1, NULL), other;
    for (int threads = 2; threads <= 3; threads++) {
        other = drawn(&mesh, BALLS, threads, NULL);
        assert_memory_equal(one.pixels, other.pixels, 3 * WIDTH * HEIGHT);
        dem_image_free(&other);
    }
    dem_image_free(&one);
    dem_mesh_free(&mesh);
}

static void the_picture_is_the_same_at_every_scale_and_place(void **state)
{
    (void)state;
    static const struct {
        double scale, shift;
    } cases[] = {{1e-9, 0}, {1e9, 0}, {1, 1e6}, {1e-3, 1e6}};
    dem_mesh mesh = shape_grain(10);
    dem_image want = drawn(&mesh, BALLS, 1, NULL);
    for (int i = 0; i < 4; i++) {
        double s = cases[i].scale;
        dem_vec3 shift = v3(cases[i].shift, -2 * cases[i].shift, cases[i].shift);
        dem_mesh moved = shape_copy(mesh.vertices, mesh.vertex_count, mesh.triangles, mesh.triangle_count);
        dem_ball balls[BALL_COUNT];
        for (size_t k = 0; k < moved.vertex_count; k++)
            moved.vertices[k] = v3_along(shift, s, mesh.vertices[k]);
        for (int k = 0; k < BALL_COUNT; k++)
            balls[k] = (dem_ball){v3_along(shift, s, BALLS[k].centre), s * BALLS[k].radius};
        dem_image got = drawn(&moved, balls, 1, NULL);
        // rounding moves single rays to the other side of an edge, hence a few pixels by a part
        int unlike = 0;
        for (int k = 0; k < 3 * WIDTH * HEIGHT; k++)
            unlike += abs(want.pixels[k] - got.pixels[k]) > 2;
        check_near(unlike, 0, 3 * WIDTH * HEIGHT / 1000.0);
        dem_image_free(&got);
        dem_mesh_free(&moved);
    }
    dem_image_free(&want);
    dem_mesh_free(&mesh);
}

// how far a ball reaches to the right in the picture: the eye sees its circle in the plane across the picture
static double reach(double x, double depth, double radius, double distance)
{
    return distance * tan(atan2(x, depth) + asin(radius / hypot(x, depth)));
}

// widens the box of what is seen, in pixels
static void see(const dem_view *view, dem_vec3 centre, double radius, double low[2], double high[2])
{
    dem_vec3 d = v3_sub(centre, view->centre);
    double at[2] = {v3_dot(d, view->right), -v3_dot(d, view->up)}, middle[2] = {view->width / 2.0, view->height / 2.0};
    double depth = view->distance + v3_dot(d, view->forward);
    for (int k = 0; k < 2; k++) {
        double left = -at[k] + radius, right = at[k] + radius;
        if (view->distance > 0) {
            left = reach(-at[k], depth, radius, view->distance);
            right = reach(at[k], depth, radius, view->distance);
        }
        low[k] = fmin(low[k], middle[k] - left / view->pixel);
        high[k] = fmax(high[k], middle[k] + right / view->pixel);
    }
}

static void everything_is_in_the_picture_up_to_its_margin(void **state)
{
    (void)state;
    dem_mesh mesh = shape_grain(6);
    dem_render_shape shapes[] = {{.mesh = &mesh}, {.balls = BALLS, .ball_count = BALL_COUNT}};
    // a clump on either side; a mesh in the middle, or large enough to be all that counts
    dem_render_body bodies[] = {{.shape = 0, .position = {0, 0, 0}, .orientation = {0.8, 0.6, 0, 0}, .scale = 1},
                                {.shape = 1, .position = {-3, 1, 5}, .orientation = {0.6, 0, 0, 0.8}, .scale = 0.5},
                                {.shape = 1, .position = {3, -1, -5}, .orientation = {0.6, 0, 0.8, 0}, .scale = 1.5}};
    dem_render_scene scene = {.shapes = shapes, .shape_count = 2, .bodies = bodies, .body_count = 3};
    for (int turn = 0; turn < 4; turn++) {
        bool perspective = turn & 1;
        bodies[0].scale = turn & 2 ? 20 : 1;
        dem_camera camera = {{1, 2, -0.5}, {0, 0, 1}, perspective ? 30 : 0, 0.1};
        dem_view view = dem_view_fit(&scene, &camera, 300, 100);
        double low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY}, ground = INFINITY;
        for (size_t i = 0; i < mesh.vertex_count; i++) {
            dem_vec3 x = v3_scale(quat_rotate(bodies[0].orientation, mesh.vertices[i]), bodies[0].scale);
            see(&view, x, 0, low, high);
            ground = fmin(ground, x.z);
        }
        for (int i = 0; i < 2 * BALL_COUNT; i++) {
            const dem_render_body *b = &bodies[1 + i % 2];
            dem_vec3 x = v3_along(b->position, b->scale, quat_rotate(b->orientation, BALLS[i / 2].centre));
            see(&view, x, b->scale * BALLS[i / 2].radius, low, high);
            ground = fmin(ground, x.z - b->scale * BALLS[i / 2].radius);
        }
        check_close(view.ground, ground, 1e-14);
        double left = low[0] - 10, right = 290 - high[0], above = low[1] - 10, below = 90 - high[1];
        // as large as can be, and in the middle; with perspective the side that limits it is
        if (!perspective) {
            check_near(left, right, 1e-9);
            check_near(above, below, 1e-9);
        }
        check_near(fmin(fmin(left, right), fmin(above, below)), 0, 1e-9);
        check_near(fmin(fmax(left, right), fmax(above, below)), 0, 1e-9);
    }
    dem_mesh_free(&mesh);
}

static void outlines_are_smooth(void **state)
{
    (void)state;
    dem_mesh mesh = shape_grain(10);
    dem_image image = drawn(&mesh, BALLS, 1, NULL);
    int between = 0, rows = 0;
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 1; x < WIDTH / 2; x++)
            if (shows_body(&image, x, y)) {
                // the first pixel of the body in its row is partly ground
                between += abs(*pixel_at(&image, x, y) - *pixel_at(&image, x + 1, y)) > 8;
                rows++;
                break;
            }
    check(rows > HEIGHT / 2);
    check(between > rows / 2);
    dem_image_free(&image);
    dem_mesh_free(&mesh);
}

static void smooth_faces_are_shaded_smooth_and_edges_stay(void **state)
{
    (void)state;
    dem_mesh sphere = shape_sphere(12), box = shape_box(1, 2, 3);
    float *n = dem_mesh_corner_normals(&sphere);
    for (size_t i = 0; i < 3 * sphere.triangle_count; i++) {
        dem_vec3 got = v3((double)n[3 * i], (double)n[3 * i + 1], (double)n[3 * i + 2]);
        check(v3_dot(got, sphere.vertices[sphere.triangles[i]]) > 0.9997);  // 1.4 of the facets' 7 degrees
    }
    free(n);
    n = dem_mesh_corner_normals(&box);
    for (size_t i = 0; i < 3 * box.triangle_count; i++)
        check_near(fmax(fabs((double)n[3 * i]), fmax(fabs((double)n[3 * i + 1]), fabs((double)n[3 * i + 2]))), 1, 1e-7);
    free(n);
    dem_mesh_free(&sphere);
    dem_mesh_free(&box);
}

static void thousands_of_bodies_share_a_shape(void **state)
{
    (void)state;
    if (!DEM_EMBREE)
        skip();
    enum { SIDE = 16, COUNT = SIDE * SIDE * SIDE };
    dem_mesh mesh = shape_grain(20);
    dem_render_shape shape = {.mesh = &mesh};
    dem_render_body *bodies = calloc(COUNT, sizeof *bodies);
    check(bodies != NULL);
    for (int i = 0; i < COUNT; i++)
        bodies[i] = (dem_render_body){.position = {2.0 * (i % SIDE), 2.0 * (i / SIDE % SIDE), 2.0 * (i / SIDE / SIDE)},
                                      .orientation = {1, 0, 0, 0},
                                      .scale = 1,
                                      .colour = {0.5f, 0.3f, 0.2f}};
    dem_render_scene scene = {.shapes = &shape, .shape_count = 1, .bodies = bodies, .body_count = COUNT};
    dem_camera camera = {{1, 2, -1}, {0, 0, 1}, 30, 0.05};
    dem_view view = dem_view_fit(&scene, &camera, 160, 120);
    dem_image image;
    dem_error error;
    check_ok(dem_render(NULL, &scene, &view, &image, &error), error);
    check(shows_body(&image, 80, 60));
    dem_image_free(&image);
    free(bodies);
    dem_mesh_free(&mesh);
}

static bool stop_at_once(void *user, const char *what, double fraction)
{
    (void)what, (void)fraction;
    ++*(int *)user;
    return true;
}

static void drawing_can_be_interrupted(void **state)
{
    (void)state;
    if (!DEM_EMBREE)
        skip();
    dem_mesh mesh = shape_grain(6);
    int calls = 0;
    dem_ctx ctx = {.progress = stop_at_once, .user = &calls, .threads = 1};
    dem_image image;
    dem_error error;
    check(dem_picture_render(&ctx, &mesh, BALLS, BALL_COUNT, WIDTH, HEIGHT, &image, NULL, &error) == DEM_INTERRUPTED);
    check(calls == 1 && !image.pixels);
    dem_mesh_free(&mesh);
}

static void the_picture_of_a_clump_is_a_png_file(void **state)
{
    (void)state;
    dem_mesh mesh = shape_box(1, 0.8, 0.6);
    dem_error error = {0};
    char path[] = "picture-XXXXXX";
    close(mkstemp(path));
    dem_status status = dem_picture_clump(NULL, &mesh, BALLS, BALL_COUNT, path, &error);
    if (!DEM_EMBREE) {
        check(status == DEM_UNAVAILABLE);
    } else {
        dem_buffer png;
        check_ok(status, error);
        check_ok(dem_file_read(path, &png, &error), error);
        assert_memory_equal(png.data, "\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\0\x07\xd0\0\0\x03\xe8\x08\x02", 26);
        dem_buffer_release(&png);
        check(dem_picture_clump(NULL, &mesh, BALLS, 0, path, &error) == DEM_USAGE);
    }
    unlink(path);
    dem_mesh_free(&mesh);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_corners_are_white),
        cmocka_unit_test(the_left_half_shows_the_outline_of_the_mesh),
        cmocka_unit_test(the_right_half_shows_the_balls_in_the_same_scale),
        cmocka_unit_test(the_picture_is_the_same_for_any_number_of_threads),
        cmocka_unit_test(the_picture_is_the_same_at_every_scale_and_place),
        cmocka_unit_test(everything_is_in_the_picture_up_to_its_margin),
        cmocka_unit_test(outlines_are_smooth),
        cmocka_unit_test(smooth_faces_are_shaded_smooth_and_edges_stay),
        cmocka_unit_test(thousands_of_bodies_share_a_shape),
        cmocka_unit_test(drawing_can_be_interrupted),
        cmocka_unit_test(the_picture_of_a_clump_is_a_png_file),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
