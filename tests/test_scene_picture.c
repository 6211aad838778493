#include "folder.h"
#include "views.h"

#include "out/palette.h"
#include "out/scene_picture.h"

enum { WIDTH = 240, HEIGHT = 200 };


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
                              p->velocity, p->spin,  p->spin,  p->velocity, p->coordination, NULL};
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
    dem_vec3 in_ball = v3_add(p.position[0], v3(-0.7, 0, 0.115));
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

static void worn_walls_show_how_deep(void **state)
{
    (void)state;
    pair p;
    dem_view view;
    make_pair(&p);
    dem_picture_options o = options_of();
    // behind the bodies, the right one worn twice as deep; the third wears, but has not
    const dem_wall_def walls[] = {
        {.kind = DEM_WALL_DISC, .point = {-2, 1.5, 2.5}, .normal = {0, -1, 0}, .radius = 0.6},
        {.kind = DEM_WALL_DISC, .point = {2, 1.5, 2.5}, .normal = {0, -1, 0}, .radius = 0.6},
        {.kind = DEM_WALL_DISC, .point = {0, 1.5, 2.5}, .normal = {0, -1, 0}, .radius = 0.6}};
    const double worn[3] = {1e-6, 2e-6, 0};
    dem_wall_view poses[3];
    for (int i = 0; i < 3; i++)
        poses[i] = (dem_wall_view){
            .orientation = {1, 0, 0, 0}, .worn = worn[i], .wear = &worn[i], .wear_count = 1};
    o.colour = DEM_PICTURE_WEAR;
    o.walls = walls;
    o.poses = poses;
    o.wall_count = 3;
    o.labels = true;
    dem_image image = drawn(&p.view, &o, 1, &view);
    const uint8_t *left = pixel_of(&image, &view, walls[0].point), *right = pixel_of(&image, &view, walls[1].point),
                  *none = pixel_of(&image, &view, walls[2].point), *body = pixel_of(&image, &view, p.position[0]);
    check(is_grey(body));
    check(right[0] > right[2] + 60);              // yellow: the largest depth
    check(left[1] > left[0] && left[1] > none[1] + 20);  // green: half of it
    check(none[2] > none[0] && none[2] > none[1]);  // violet: 0
    dem_image_free(&image);
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

// ---- what surrounds the bodies, and what is left out

static dem_picture_options plain_options(void)
{
    dem_picture_options o = options_of();
    o.parallel = true;
    o.elevation_deg = 0;
    return o;
}

// seen along the ground there is no shadow: what is not white is the ball
static void a_sphere_covers_its_pixels(void **state)
{
    (void)state;
    pair p;
    dem_view view;
    make_pair(&p);
    for (int zoomed = 0; zoomed < 2; zoomed++) {
        dem_picture_options o = plain_options();
        o.zoom = zoomed ? 1.7 : 1;
        if (zoomed)
            o.look_at = v3(1, 5, 1.1);
        dem_image image = drawn(&p.view, &o, 1, &view);
        double x, y, r = 0.5 * p.scale[1] / view.pixel;
        dem_view_project(&view, p.position[1], &x, &y);
        if (zoomed) {
            check_near(x, WIDTH / 2.0, 1e-9);
            check_near(y, HEIGHT / 2.0 + 0.1 / view.pixel, 1e-9);
        }
        for (int j = 0; j < HEIGHT; j++)
            for (int i = WIDTH / 2; i < WIDTH; i++) {
                double off = hypot(i + 0.5 - x, j + 0.5 - y) - r;
                bool white = memcmp(image.pixels + 3 * (j * WIDTH + i), "\xff\xff\xff", 3) == 0;
                if (fabs(off) > 1)
                    check(white == (off > 0));
            }
        dem_image_free(&image);
    }
}

static void zoom_enlarges_what_is_seen(void **state)
{
    (void)state;
    pair p;
    dem_view one, two;
    make_pair(&p);
    dem_picture_options o = options_of();
    dem_image a = drawn(&p.view, &o, 1, &one);
    o.zoom = 2;
    dem_image b = drawn(&p.view, &o, 1, &two);
    check_close(two.pixel, one.pixel / 2, 1e-12);
    check_near(two.distance, one.distance, 0);
    dem_image_free(&a);
    dem_image_free(&b);
}

// the colour of a body where nothing shades it, as a direction: light only makes it brighter or darker
static double hue_error(const uint8_t *got, dem_colour want)
{
    dem_colour c = dem_colour_of_srgb(got[0], got[1], got[2]);
    double a[3] = {(double)c.r, (double)c.g, (double)c.b}, b[3] = {(double)want.r, (double)want.g, (double)want.b};
    double ab = 0, aa = 0, bb = 0;
    for (int k = 0; k < 3; k++)
        ab += a[k] * b[k], aa += a[k] * a[k], bb += b[k] * b[k];
    return 1 - ab / sqrt(aa * bb);
}

static void the_ends_of_the_range_have_the_colours_of_the_map(void **state)
{
    (void)state;
    pair p;
    dem_view view;
    make_pair(&p);
    for (dem_picture_map map = DEM_PICTURE_MAP_RAMP; map <= DEM_PICTURE_MAP_GREY; map++) {
        const double values[2] = {-3, 7};
        dem_palette palette;
        dem_palette_make(map, &palette);
        dem_picture_options o = options_of();
        o.colour = DEM_PICTURE_VALUES;
        o.values = values;
        o.map = map;
        o.low = -3;
        o.high = 7;
        dem_image image = drawn(&p.view, &o, 1, &view);
        // the light is a little warm or cool
        check(hue_error(pixel_of(&image, &view, p.position[0]), dem_palette_at(&palette, 0)) < 4e-3);
        check(hue_error(pixel_of(&image, &view, p.position[1]), dem_palette_at(&palette, 1)) < 4e-3);
        dem_image_free(&image);
    }
}

static void ranges_are_chosen_from_the_values(void **state)
{
    (void)state;
    dem_picture_options o = dem_picture_defaults();
    dem_picture_span span = {.low = 0.0021, .high = 0.1987};
    double low, high;
    check(dem_picture_range(&o, &span, &low, &high) == DEM_PICTURE_MAP_RAMP);
    check_near(low, 0, 1e-15);  // nearly round ends become round
    check_near(high, 0.2, 1e-15);
    span.low = 0.03;
    dem_picture_range(&o, &span, &low, &high);
    check(low == 0.03);
    span.low = -0.1;
    check(dem_picture_range(&o, &span, &low, &high) == DEM_PICTURE_MAP_DIVERGING);
    check_near(low, -0.2, 1e-15);
    o.low = -0.1;  // who asks for another range gets it
    check(dem_picture_range(&o, &span, &low, &high) == DEM_PICTURE_MAP_RAMP);
    check(low == -0.1);
    o.map = DEM_PICTURE_MAP_WARM;
    check(dem_picture_range(&o, &span, &low, &high) == DEM_PICTURE_MAP_WARM);
    o.low = NAN;
    dem_picture_range(&o, &(dem_picture_span){.low = INFINITY, .high = -INFINITY}, &low, &high);
    check(low == 0 && high == 0);
}

static void hidden_bodies_are_not_there(void **state)
{
    (void)state;
    pair p;
    dem_view view, alone;
    make_pair(&p);
    dem_picture_options o = options_of();
    const unsigned char hidden[2] = {1, 0};
    dem_picture_span span = {0};
    dem_error error;
    const dem_clump *const *shapes = (const dem_clump *const *)clumps;
    check_ok(dem_scene_picture_measure(&p.view, shapes, VIEW_SHAPES, &o, &span, &error), error);
    o.hidden = hidden;
    dem_image own = drawn(&p.view, &o, 1, &alone), image;
    check_vec(alone.centre, p.position[1], 0.2);  // the camera looks at what is left
    dem_image_free(&own);
    if (!DEM_EMBREE)
        skip();
    check_ok(dem_scene_picture_render(NULL, &p.view, shapes, VIEW_SHAPES, &o, &span, &image, &view, &error), error);
    check(is_grey(pixel_of(&image, &view, p.position[0])));
    check(!is_grey(pixel_of(&image, &view, p.position[1])));
    dem_image_free(&image);
}

static void a_sequence_has_one_camera_and_range(void **state)
{
    (void)state;
    enum { FRAMES = 3 };
    pair p;
    dem_error error;
    dem_picture_span span = {0};
    dem_view first, view;
    const dem_clump *const *shapes = (const dem_clump *const *)clumps;
    make_pair(&p);
    dem_picture_options o = options_of();
    o.colour = DEM_PICTURE_SPEED;
    for (int i = 0; i < FRAMES; i++) {
        p.position[0].x = -1.5 - 2 * i;
        p.velocity[0].z = i;
        o.time = 0.1 * i;
        check_ok(dem_scene_picture_measure(&p.view, shapes, VIEW_SHAPES, &o, &span, &error), error);
    }
    check(span.low == 0 && span.high == 5);
    check_near(span.end, 0.2, 1e-15);
    if (!DEM_EMBREE)
        skip();
    uint8_t right[3];
    for (int i = 0; i < FRAMES; i++) {
        dem_image image;
        p.position[0].x = -1.5 - 2 * i;
        p.velocity[0].z = i;
        check_ok(dem_scene_picture_render(NULL, &p.view, shapes, VIEW_SHAPES, &o, &span, &image, &view, &error), error);
        if (i == 0) {
            first = view;
            memcpy(right, pixel_of(&image, &view, p.position[1]), 3);
        }
        check(memcmp(&view, &first, sizeof view) == 0);
        check(!is_grey(pixel_of(&image, &view, p.position[0])));  // always in the picture
        assert_memory_equal(pixel_of(&image, &view, p.position[1]), right, 3);
        dem_image_free(&image);
    }
}

static void the_camera_of_a_sequence_holds_all_of_it_tightly(void **state)
{
    (void)state;
    pair p;
    dem_error error;
    make_pair(&p);
    const dem_clump *const *shapes = (const dem_clump *const *)clumps;
    dem_picture_options o = options_of();
    // the two bodies one after the other are seen from where both are seen at once
    dem_picture_span both = {0}, each = {0};
    check_ok(dem_scene_picture_measure(&p.view, shapes, VIEW_SHAPES, &o, &both, &error), error);
    for (int i = 0; i < 2; i++) {
        const unsigned char hidden[2] = {i == 0, i == 1};
        o.hidden = hidden;
        check_ok(dem_scene_picture_measure(&p.view, shapes, VIEW_SHAPES, &o, &each, &error), error);
    }
    dem_view a = dem_fit_end(&both.fit), b = dem_fit_end(&each.fit);
    check_vec(b.centre, a.centre, 1e-12);
    check_close(b.pixel, a.pixel, 1e-12);
    check_close(b.distance, a.distance, 1e-12);
}

static void the_background_is_as_asked(void **state)
{
    (void)state;
    pair p;
    dem_view view;
    make_pair(&p);
    dem_picture_options o = options_of();
    o.labels = true;
    memcpy(o.background, (uint8_t[]){32, 48, 64}, 3);
    dem_image image = drawn(&p.view, &o, 1, &view);
    static const int corners[4][2] = {{0, 0}, {WIDTH - 1, 0}, {0, HEIGHT - 1}, {WIDTH - 1, HEIGHT - 1}};
    for (int k = 0; k < 4; k++)
        assert_memory_equal(image.pixels + 3 * (corners[k][1] * WIDTH + corners[k][0]), o.background, 3);
    dem_image_free(&image);
    check(dem_ink_on((uint8_t[]){255, 255, 255}).r < 50 && dem_ink_on((uint8_t[]){20, 20, 80}).r > 200);
}

static void labels_stand_beside_the_bodies(void **state)
{
    (void)state;
    pair p;
    dem_view view;
    make_pair(&p);
    dem_picture_options o = plain_options();
    o.colour = DEM_PICTURE_SPEED;
    o.label_size = 9;
    dem_image bare = drawn(&p.view, &o, 1, &view);
    check(view.width == WIDTH && view.height == HEIGHT);
    dem_image_free(&bare);
    o.labels = true;
    o.time = 0.5;
    dem_image image = drawn(&p.view, &o, 1, &view);
    check(view.width < WIDTH - 30 && view.height < HEIGHT - 20);
    // the scale bar is ink of the length that it says
    int y = HEIGHT - 1 - 16, length = 0, from = 0;
    for (int x = 0; x < view.width; x++)
        if (image.pixels[3 * (y * WIDTH + x)] < 60) {
            from = length ? from : x;
            length += x == from + length;
        }
    check_near(length * view.pixel, 0.5, view.pixel);
    // a colour bar to the right, dark below and yellow above
    int blue = 0, yellow = 0;
    for (int j = 0; j < HEIGHT; j++) {
        const uint8_t *pixel = image.pixels + 3 * (j * WIDTH + view.width + 18);
        blue += pixel[2] > pixel[0] + 40 && j > HEIGHT / 3;
        yellow += pixel[0] > pixel[2] + 40 && j < HEIGHT / 2;
    }
    check(blue > 10 && yellow > 10);
    dem_image_free(&image);
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

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bodies_are_seen_where_they_are),
        cmocka_unit_test(colours_show_the_field),
        cmocka_unit_test(the_surface_or_the_spheres_are_drawn),
        cmocka_unit_test(walls_are_glass),
        cmocka_unit_test(worn_walls_show_how_deep),
        cmocka_unit_test(bodies_hide_the_glass_behind_them),
        cmocka_unit_test(the_edges_of_glass_are_lines),
        cmocka_unit_test(the_picture_is_the_same_for_any_number_of_threads),
        cmocka_unit_test(a_sphere_covers_its_pixels),
        cmocka_unit_test(zoom_enlarges_what_is_seen),
        cmocka_unit_test(the_ends_of_the_range_have_the_colours_of_the_map),
        cmocka_unit_test(ranges_are_chosen_from_the_values),
        cmocka_unit_test(hidden_bodies_are_not_there),
        cmocka_unit_test(a_sequence_has_one_camera_and_range),
        cmocka_unit_test(the_camera_of_a_sequence_holds_all_of_it_tightly),
        cmocka_unit_test(the_background_is_as_asked),
        cmocka_unit_test(labels_stand_beside_the_bodies),
        cmocka_unit_test(nothing_is_a_picture_too),
        cmocka_unit_test(the_picture_is_a_png_file),
    };
    return cmocka_run_group_tests(tests, begin_views, end_views);
}
