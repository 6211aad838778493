#include "folder.h"
#include "views.h"

#include "out/scene_picture.h"

enum { WIDTH = 240, HEIGHT = 200 };

static dem_clump *clumps[VIEW_SHAPES];

// two bodies side by side: a ball of shape 0 to the left, one of twice the size to the right, half a unit below
typedef struct pair {
    uint32_t shape[2], coordination[2];
    double scale[2], mass[2];
    dem_vec3 position[2], velocity[2], spin[2];
    dem_quat orientation[2];
    dem_body_view view;
} pair;

static void make_pair(pair *p)
{
    *p = (pair){.coordination = {1, 5},
                .scale = {1, 2},
                .mass = {1, 8},
                .position = {{-1.5, 0, 1}, {1, 0, 1}},
                .velocity = {{0, 0, 0.1}, {0, 3, 4}},
                .spin = {{0, 9, 0}, {0, 0, 0}},
                .orientation = {{1, 0, 0, 0}, {0.6, 0, 0.8, 0}}};
    p->view = (dem_body_view){2,           p->shape, p->scale, p->mass,     p->position,    p->orientation,
                              p->velocity, p->spin,  p->spin,  p->velocity, p->coordination};
}

// seen along y, x to the right
static dem_picture_options options_of(void)
{
    dem_picture_options o = dem_picture_defaults();
    o.width = WIDTH;
    o.height = HEIGHT;
    o.azimuth_deg = -90;
    return o;
}

static dem_image drawn(const dem_body_view *bodies, const dem_picture_options *options, int threads, dem_view *view)
{
    dem_image image;
    dem_error error;
    dem_ctx ctx = {.threads = threads};
    if (!DEM_EMBREE)
        skip();
    check_ok(dem_scene_picture_render(&ctx, bodies, (const dem_clump *const *)clumps, VIEW_SHAPES, options, NULL,
                                      &image, view, &error),
             error);
    check(image.width == options->width && image.height == options->height);
    return image;
}

// where a point is seen
static const uint8_t *pixel_of(const dem_image *image, const dem_view *view, dem_vec3 point)
{
    double x, y;
    dem_view_project(view, point, &x, &y);
    check(x >= 0 && x < image->width && y >= 0 && y < image->height);
    return image->pixels + 3 * ((int)y * image->width + (int)x);
}

static bool is_grey(const uint8_t *p)
{
    return p[0] == p[1] && p[1] == p[2];
}

static void bodies_are_seen_where_they_are(void **state)
{
    (void)state;
    pair p;
    dem_view view;
    make_pair(&p);
    dem_picture_options o = options_of();
    o.colour = DEM_PICTURE_SPEED;
    dem_image image = drawn(&p.view, &o, 1, &view);
    int inside = 0, outside = 0;
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++) {
            // the shadow of a ball in the picture is nearly a circle about its centre: a tenth off for sure
            double nearest = INFINITY;
            for (int i = 0; i < 2; i++) {
                double u, v, r = 0.5 * p.scale[i];
                dem_view_project(&view, p.position[i], &u, &v);
                nearest = fmin(nearest, hypot(x + 0.5 - u, y + 0.5 - v) * view.pixel / r);
            }
            bool grey = is_grey(image.pixels + 3 * (y * WIDTH + x));
            if (nearest < 0.85)
                check(!grey);
            if (nearest > 1.15)
                check(grey);
            inside += nearest < 0.85;
            outside += nearest > 1.15;
        }
    check(inside > 2000 && outside > 10000);
    // stable: its lowest point is what the ground touches
    check_near(view.ground, 0, 1e-12);
    dem_image_free(&image);
}

static void colours_show_the_field(void **state)
{
    (void)state;
    const struct {
        dem_picture_colour colour;
        bool right_is_higher;
    } cases[] = {{DEM_PICTURE_SPEED, true},
                 {DEM_PICTURE_SPIN, false},
                 {DEM_PICTURE_SIZE, true},
                 {DEM_PICTURE_COORDINATION, true}};
    pair p;
    dem_view view;
    make_pair(&p);
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        dem_picture_options o = options_of();
        o.colour = cases[i].colour;
        dem_image image = drawn(&p.view, &o, 1, &view);
        const uint8_t *low = pixel_of(&image, &view, p.position[cases[i].right_is_higher ? 0 : 1]),
                      *high = pixel_of(&image, &view, p.position[cases[i].right_is_higher ? 1 : 0]);
        check(low[2] > low[0] && high[0] > high[2]);  // blue and yellow
        dem_image_free(&image);
    }
    // a range that is given holds: far above everything, all are at the low end
    dem_picture_options o = options_of();
    o.colour = DEM_PICTURE_SPEED;
    o.low = 100;
    o.high = 200;
    dem_image image = drawn(&p.view, &o, 1, &view);
    const uint8_t *right = pixel_of(&image, &view, p.position[1]);
    check(right[2] > right[0]);
    dem_image_free(&image);
}

static int count_unlike(const dem_image *a, const dem_image *b)
{
    int count = 0;
    for (int i = 0; i < a->width * a->height; i++)
        count += memcmp(a->pixels + 3 * i, b->pixels + 3 * i, 3) != 0;
    return count;
}

static void the_surface_or_the_spheres_are_drawn(void **state)
{
    (void)state;
    pair p;
    make_pair(&p);
    p.shape[0] = p.shape[1] = 2;  // a tetrahedron kept as the surface of three balls
    dem_picture_options o = options_of();
    o.colour = DEM_PICTURE_SHAPE;
    dem_view view;
    dem_image surface = drawn(&p.view, &o, 1, &view);
    // the tetrahedron has corners in x, y, z from 0 on, the balls lie on both sides
    dem_vec3 in_ball = v3_add(p.position[0], v3(-0.6, 0, 0));
    double x, y;
    dem_view_project(&view, in_ball, &x, &y);
    check(x < 0 || is_grey(pixel_of(&surface, &view, in_ball)));
    o.spheres = true;
    dem_image spheres = drawn(&p.view, &o, 1, &view);
    check(!is_grey(pixel_of(&spheres, &view, in_ball)));
    dem_image_free(&surface);
    dem_image_free(&spheres);
}

static void walls_are_glass(void **state)
{
    (void)state;
    pair p;
    dem_view view, same;
    make_pair(&p);
    dem_picture_options o = options_of();
    const dem_wall_def walls[] = {{.kind = DEM_WALL_PLANE, .point = {0, 0, 0}, .normal = {0, 0, 1}},
                                  {.kind = DEM_WALL_PLANE, .point = {0, 1.5, 0}, .normal = {0, -1, 0}},
                                  {.kind = DEM_WALL_PLANE, .point = {0, -1.5, 0}, .normal = {0, 1, 0}}};
    o.walls = walls;
    o.wall_count = 3;
    o.domain.low = v3(-3, -1.5, -INFINITY);
    o.domain.high = v3(3, 1.5, 3);
    dem_image glass = drawn(&p.view, &o, 1, &view);
    check_near(view.ground, 0, 1e-12);  // the floor, though the walls go on below it
    // behind and before the bodies there is a pane, beside them two
    const uint8_t *empty = pixel_of(&glass, &view, v3(-0.2, 0, 2.5)), *sky = glass.pixels;
    check(sky[0] == 255 && sky[1] == 255 && sky[2] == 255);
    check(empty[0] < 250 && empty[2] > empty[0] && empty[0] > 200);  // light and bluish
    // without the front pane the same body is clearer, but not by much
    const uint8_t *body = pixel_of(&glass, &view, p.position[0]);
    o.wall_count = 2;
    dem_image open = drawn(&p.view, &o, 1, &same);
    const uint8_t *clear = pixel_of(&open, &same, p.position[0]);
    int change = abs(clear[0] - body[0]) + abs(clear[1] - body[1]) + abs(clear[2] - body[2]);
    check(change > 0 && change < 60);
    dem_image_free(&glass);
    dem_image_free(&open);
    // glass casts no shadow: the ground at its foot is white
    dem_image alone = drawn(&(dem_body_view){0}, &o, 1, &same);
    const uint8_t *foot = pixel_of(&alone, &same, v3(0, 1.3, 0));
    check(foot[0] == 255 && foot[2] == 255);
    dem_image_free(&alone);
}

static void bodies_hide_the_glass_behind_them(void **state)
{
    (void)state;
    pair p;
    dem_view view;
    make_pair(&p);
    dem_picture_options o = options_of();
    dem_image images[2];
    for (int i = 0; i < 2; i++) {  // seen from its two sides, glass looks different
        const dem_wall_def wall = {.kind = DEM_WALL_PLANE, .point = {0, 1.5, 0}, .normal = {0, i ? 1 : -1, 0}};
        o.walls = &wall;
        o.wall_count = 1;
        images[i] = drawn(&p.view, &o, 1, &view);
    }
    for (int i = 0; i < 2; i++)
        assert_memory_equal(pixel_of(&images[0], &view, p.position[i]), pixel_of(&images[1], &view, p.position[i]), 3);
    dem_vec3 beside = v3(-1.5, 0, 1.6);
    check(memcmp(pixel_of(&images[0], &view, beside), pixel_of(&images[1], &view, beside), 3) != 0);
    dem_image_free(&images[0]);
    dem_image_free(&images[1]);
}

static void the_edges_of_glass_are_lines(void **state)
{
    (void)state;
    pair p;
    dem_view view;
    make_pair(&p);
    dem_picture_options o = options_of();
    const dem_wall_def wall = {.kind = DEM_WALL_PLANE, .point = {0, 1.5, 0}, .normal = {0, -1, 0}};
    o.walls = &wall;
    o.wall_count = 1;
    o.domain.low = v3(-3, -1.5, 0);
    o.domain.high = v3(3, 1.5, 3);
    dem_image image = drawn(&p.view, &o, 1, &view);
    double x, y;
    dem_view_project(&view, v3(0, 1.5, 3), &x, &y);
    int darkest = 255, on = 255;
    for (int k = -6; k <= 6; k++) {
        int value = image.pixels[3 * (((int)y + k) * WIDTH + (int)x)];
        darkest = value < darkest ? value : darkest;
        on = abs(k) <= 1 && value < on ? value : on;
    }
    check(darkest == on && on < 225);  // a line of a pixel that lies across two
    // the diagonal where the plane's triangles meet is none
    const uint8_t *middle = pixel_of(&image, &view, v3(0, 1.5, 2.2));
    check(middle[0] > 200);
    dem_image_free(&image);
}

static void the_picture_is_the_same_for_any_number_of_threads(void **state)
{
    (void)state;
    made_view arrays;
    dem_wall_view poses[VIEW_WALLS];
    dem_body_view bodies = view_bodies(&arrays, 4);
    view_walls(poses, 0.5);
    dem_picture_options o = options_of();
    o.walls = VIEW_WALL_DEFS;
    o.poses = poses;
    o.wall_count = VIEW_WALLS;
    dem_image one = drawn(&bodies, &o, 1, NULL), three = drawn(&bodies, &o, 3, NULL);
    check(count_unlike(&one, &three) == 0);
    dem_image_free(&one);
    dem_image_free(&three);
}

static void nothing_is_a_picture_too(void **state)
{
    (void)state;
    dem_picture_options o = options_of();
    dem_image image = drawn(&(dem_body_view){0}, &o, 1, NULL);
    for (int i = 0; i < 3 * WIDTH * HEIGHT; i++)
        check(image.pixels[i] == 255);
    dem_image_free(&image);
}

static void the_picture_is_a_png_file(void **state)
{
    (void)state;
    pair p;
    dem_error error = {0};
    make_pair(&p);
    dem_picture_options o = options_of();
    const dem_clump *const *shapes = (const dem_clump *const *)clumps;
    dem_status status = dem_picture_bodies(NULL, &p.view, shapes, VIEW_SHAPES, &o, in_folder("a.png"), &error);
    if (!DEM_EMBREE) {
        check(status == DEM_UNAVAILABLE);
        return;
    }
    check_ok(status, error);
    dem_buffer png = content(in_folder("a.png"));
    assert_memory_equal(png.data, "\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\0\0\xf0\0\0\0\xc8\x08\x02", 26);
    dem_buffer_release(&png);
    check(dem_picture_bodies(NULL, &p.view, shapes, VIEW_SHAPES, &o, "no such folder/a.png", &error) ==
          DEM_CANNOT_WRITE);
    o.width = 0;
    check(dem_picture_bodies(NULL, &p.view, shapes, VIEW_SHAPES, &o, in_folder("b.png"), &error) == DEM_USAGE);
    check(strchr(error.text, ';') && !exists(in_folder("b.png")));
    o = options_of();
    o.elevation_deg = 90;
    check(dem_picture_bodies(NULL, &p.view, shapes, VIEW_SHAPES, &o, in_folder("b.png"), &error) == DEM_USAGE);
}

static int begin(void **state)
{
    view_clumps(clumps);
    return make_folder(state);
}

static int end(void **state)
{
    for (int i = 0; i < VIEW_SHAPES; i++)
        dem_clump_destroy(clumps[i]);
    return remove_folder(state);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bodies_are_seen_where_they_are),
        cmocka_unit_test(colours_show_the_field),
        cmocka_unit_test(the_surface_or_the_spheres_are_drawn),
        cmocka_unit_test(walls_are_glass),
        cmocka_unit_test(bodies_hide_the_glass_behind_them),
        cmocka_unit_test(the_edges_of_glass_are_lines),
        cmocka_unit_test(the_picture_is_the_same_for_any_number_of_threads),
        cmocka_unit_test(nothing_is_a_picture_too),
        cmocka_unit_test(the_picture_is_a_png_file),
    };
    return cmocka_run_group_tests(tests, begin, end);
}
