#include "fills.h"

#include "sim/fill_room.h"

// a room with a few bodies of all shapes at random, which may overlap
typedef struct scene {
    dem_domain_def domain;
    dem_body_def bodies[24];
    dem_wall_def walls[2];
    dem_fill_obstacles there;
    dem_fill_def fill;
    dem_room room;
    dem_ball balls[FINE_BALLS];
    dem_room_trial trial;
} scene;

static double radius_of_trial(const dem_room_trial *t)
{
    return fill_shapes()[t->shape].radius_out * t->scale;
}

static void make_scene(scene *s, int bodies, const bool periodic[3], bool walls, double gap, double size)
{
    memset(s, 0, sizeof *s);
    dem_random r = random_stream(4, (uint64_t)bodies);
    s->domain = (dem_domain_def){{0, 0, 0}, {size, size, size}, {periodic[0], periodic[1], periodic[2]}, 0};
    for (int i = 0; i < bodies; i++) {
        double scale = i % 5 == 0 ? 0.02 : 0.3 + 0.7 * random_uniform(&r);
        dem_vec3 at = v3(random_uniform(&r), random_uniform(&r), random_uniform(&r));
        s->bodies[i] = (dem_body_def){.shape = (uint32_t)(i % 3), .scale = scale, .position = v3_scale(at, size)};
        s->bodies[i].orientation = some_turn(&r);
    }
    s->walls[0] = (dem_wall_def){.kind = DEM_WALL_PLANE, .normal = {0.6, 0, 0.8}, .point = {0.2 * size, 0, 0.1 * size}};
    s->walls[1] = (dem_wall_def){
        .kind = DEM_WALL_CYLINDER, .point = {size / 2, 0, size / 2}, .normal = {0, 1, 0}, .radius = 0.45 * size};
    s->there = (dem_fill_obstacles){.bodies = s->bodies, .body_count = (size_t)bodies, .domain = &s->domain};
    if (walls) {
        s->there.walls = s->walls;
        s->there.wall_count = 2;
    }
    s->fill = (dem_fill_def){.high = {size, size, size}, .gap = gap};
    dem_error error;
    const double radii[1] = {1e-3};
    check_ok(dem_room_create(&s->room, &s->fill, fill_shapes(), FILL_SHAPES, &s->there, radii, 1, &error), error);
    s->trial.balls = s->balls;
}

// the least gap of the trial to everything; the walls as make_scene has them
static double true_gap(const scene *s, const dem_body_def *body, double limit)
{
    dem_vec3 period = s->room.period;
    double least = image_gap(body, body, period, limit), size = s->domain.high.x;
    for (size_t i = 0; i < s->there.body_count; i++)
        least = fmin(least, image_gap(body, &s->bodies[i], period, limit));
    for (size_t i = 0; s->there.wall_count && i < fill_shapes()[body->shape].ball_count; i++) {
        dem_ball b = body_ball(body, i);
        least = fmin(least, 0.6 * (b.centre.x - 0.2 * size) + 0.8 * (b.centre.z - 0.1 * size) - b.radius);
        least = fmin(least, 0.45 * size - hypot(b.centre.x - size / 2, b.centre.z - size / 2) - b.radius);
    }
    return least;
}

static void room_and_brute_force_agree(const bool periodic[3], bool walls, double gap, double size)
{
    scene *s = malloc(sizeof *s);
    check(s);
    dem_random r = random_stream(12, walls);
    int sights[3] = {0}, fitting = 0;
    for (int bodies = 0; bodies <= 24; bodies += 8) {
        make_scene(s, bodies, periodic, walls, gap, size);
        for (int n = 0; n < 2000; n++) {
            dem_body_def body = {.shape = (uint32_t)random_below(&r, 3), .scale = 0.05 + random_uniform(&r)};
            body.orientation = some_turn(&r);
            body.position = v3(size * random_uniform(&r), size * random_uniform(&r), size * random_uniform(&r));
            dem_room_take(&s->room, &s->trial, body.shape, body.scale);
            dem_room_turn(&s->room, &s->trial, body.orientation);
            dem_room_sight sight = dem_room_look(&s->room, &s->trial, body.position, DEM_ROOM_NONE);
            bool fits = sight != DEM_ROOM_BLOCKED && dem_room_fits(&s->room, &s->trial, body.position);
            double least = true_gap(s, &body, 2 * gap + 1e-4);
            // within rounding of each other both answers are right
            if (fabs(least - gap) > 1e-12)
                check(fits == (least > gap));
            check(sight != DEM_ROOM_FREE || fits);
            sights[sight]++;
            fitting += fits;
        }
        dem_room_release(&s->room);
    }
    free(s);
    check(sights[DEM_ROOM_BLOCKED] > 100 && sights[DEM_ROOM_NEAR] > 100 && fitting > 100);
}

static void what_fits_is_what_brute_force_says(void **state)
{
    (void)state;
    const bool none[3] = {false, false, false}, all[3] = {true, true, true}, one[3] = {false, true, false};
    room_and_brute_force_agree(none, false, 0, 4e-3);
    room_and_brute_force_agree(none, true, 1e-4, 5e-3);
    room_and_brute_force_agree(all, false, 1e-4, 4e-3);
    room_and_brute_force_agree(one, true, 0, 5e-3);
    // periods shorter than a body: its own images are in the way
    room_and_brute_force_agree(all, false, 0, 1.5e-3);
}

static void bodies_that_moved_are_found_where_they_are(void **state)
{
    (void)state;
    const bool all[3] = {true, true, true};
    scene *s = malloc(sizeof *s);
    check(s);
    make_scene(s, 24, all, false, 0, 4e-3);
    dem_random r = random_stream(13, 0);
    for (int n = 0; n < 3000; n++) {
        uint32_t i = (uint32_t)random_below(&r, s->room.count);
        dem_body_def *b = &s->bodies[i];
        b->orientation = some_turn(&r);
        b->position = v3(4e-3 * random_uniform(&r), 4e-3 * random_uniform(&r), 4e-3 * random_uniform(&r));
        dem_room_take(&s->room, &s->trial, b->shape, b->scale);
        dem_room_turn(&s->room, &s->trial, b->orientation);
        // told from any period
        dem_vec3 at = b->position;
        for (int k = 0; k < 3; k++)
            v3_set(&at, k, v3_get(at, k) + 4e-3 * (double)((int)random_below(&r, 5) - 2));
        dem_room_sight sight = dem_room_look(&s->room, &s->trial, at, i);
        bool fits = sight != DEM_ROOM_BLOCKED && dem_room_fits(&s->room, &s->trial, at);
        double least = image_gap(b, b, s->room.period, 1e-4);
        for (uint32_t k = 0; k < s->room.count; k++)
            if (k != i)
                least = fmin(least, image_gap(b, &s->bodies[k], s->room.period, 1e-4));
        if (fabs(least) > 1e-12)
            check(fits == (least > 0));
        dem_room_move(&s->room, i, &s->trial, at);
        // rounding of the period
        check_vec(s->room.bodies[i].position, b->position, 1e-17);
    }
    dem_room_release(&s->room);
    free(s);
}

static void a_covered_cell_has_no_room_and_a_small_free_one_has(void **state)
{
    (void)state;
    const bool one[3] = {true, false, false};
    scene *s = malloc(sizeof *s);
    check(s);
    make_scene(s, 24, one, true, 1e-4, 6e-3);
    dem_random r = random_stream(14, 0);
    int covered = 0, differ = 0;
    for (int n = 0; n < 20000; n++) {
        dem_vec3 c = v3(6e-3 * random_uniform(&r), 6e-3 * random_uniform(&r), 6e-3 * random_uniform(&r));
        double half = 3e-4 * random_uniform(&r);
        dem_room_take(&s->room, &s->trial, n % 2 ? 0 : 2, 0.5);
        if (dem_room_covered(&s->room, c, half, s->trial.core)) {
            covered++;
            for (int k = 0; k < 5; k++) {
                dem_vec3 u = v3_unit(v3(random_normal(&r), random_normal(&r), random_normal(&r)));
                dem_vec3 at = v3_along(c, half * random_uniform(&r), u);
                dem_room_turn(&s->room, &s->trial, some_turn(&r));
                check(dem_room_look(&s->room, &s->trial, at, DEM_ROOM_NONE) == DEM_ROOM_BLOCKED ||
                      !dem_room_fits(&s->room, &s->trial, at));
            }
        }
        // of a ball everything is known: a point is covered or fits
        dem_room_take(&s->room, &s->trial, 0, 0.5);
        dem_room_turn(&s->room, &s->trial, (dem_quat){1, 0, 0, 0});
        bool fits = dem_room_look(&s->room, &s->trial, c, DEM_ROOM_NONE) != DEM_ROOM_BLOCKED &&
                    dem_room_fits(&s->room, &s->trial, c);
        differ += fits == dem_room_covered(&s->room, c, 0, s->trial.core);
    }
    check(covered > 1000 && differ == 0);
    dem_room_release(&s->room);
    free(s);
}

static void what_is_inside_is_inside_with_every_ball(void **state)
{
    (void)state;
    const bool one[3] = {false, false, true};
    scene *s = malloc(sizeof *s);
    check(s);
    make_scene(s, 0, one, false, 0, 6e-3);
    dem_random r = random_stream(15, 0);
    for (int n = 0; n < 3000; n++) {
        dem_vec3 low, high;
        dem_room_take(&s->room, &s->trial, (uint32_t)(n % FILL_SHAPES), 0.5 + random_uniform(&r));
        dem_room_turn(&s->room, &s->trial, some_turn(&r));
        check(dem_room_range(&s->room, &s->trial, &low, &high));
        check(low.z == 0 && high.z == 6e-3 && radius_of_trial(&s->trial) == s->trial.radius);
        // a corner of the range: as far as it goes
        dem_vec3 at = v3(n & 4 ? low.x : high.x, n & 8 ? low.y : high.y, 0);
        check(dem_room_inside(&s->room, &s->trial, at));
        double nearest = INFINITY;
        for (size_t i = 0; i < s->trial.count; i++) {
            dem_ball b = s->trial.balls[i];
            b.centre = v3_add(b.centre, at);
            const double d[4] = {b.centre.x, 6e-3 - b.centre.x, b.centre.y, 6e-3 - b.centre.y};
            for (int k = 0; k < 4; k++) {
                check(d[k] >= b.radius);
                nearest = fmin(nearest, d[k] - b.radius);
            }
        }
        // 64 units of the last place of the largest number about
        check(nearest < 64 * 2.3e-16 * 1e-2);
        check(!dem_room_inside(&s->room, &s->trial, v3(at.x + (n & 4 ? -2e-16 : 2e-16), at.y, 0)));
    }
    dem_room_release(&s->room);
    free(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_fits_is_what_brute_force_says),
        cmocka_unit_test(bodies_that_moved_are_found_where_they_are),
        cmocka_unit_test(a_covered_cell_has_no_room_and_a_small_free_one_has),
        cmocka_unit_test(what_is_inside_is_inside_with_every_ball),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
