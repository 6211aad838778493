/// Shapes for fills, and brute-force tests of what was filled.
#ifndef DEM_TESTS_FILLS_H
#define DEM_TESTS_FILLS_H

#include "check.h"

#include "base/random.h"
#include "math/quat.h"
#include "sim/fill.h"

static inline dem_quat some_turn(dem_random *r)
{
    double w = random_normal(r), x = random_normal(r), y = random_normal(r);
    return quat_unit((dem_quat){w, x, y, random_normal(r)});
}

static inline dem_fill_shape fill_shape(const dem_ball *balls, size_t count)
{
    dem_fill_shape s = {.balls = balls, .ball_count = count};
    dem_union joined;
    dem_error error;
    check_ok(dem_balls_union(balls, count, &joined, &error), error);
    s.volume = joined.solid.volume;
    s.mass = 2650 * s.volume;
    s.equivalent_diameter = cbrt(6 * s.volume / DEM_PI);
    for (size_t i = 0; i < count; i++)
        s.radius_out = fmax(s.radius_out, v3_norm(balls[i].centre) + balls[i].radius);
    return s;
}

enum { GRAIN_BALLS = 12, FINE_BALLS = 500, FILL_SHAPES = 4 };

/// A ball, a dimer whose centre lies in no ball, an irregular grain, and a fine one of 500 balls. Sizes about 1 mm.
static inline const dem_fill_shape *fill_shapes(void)
{
    static dem_ball ball[1], dimer[2], grain[GRAIN_BALLS], fine[FINE_BALLS];
    static dem_fill_shape shapes[FILL_SHAPES];
    if (shapes[0].ball_count)
        return shapes;
    ball[0] = (dem_ball){{0, 0, 0}, 0.5e-3};
    dimer[0] = (dem_ball){{0.6e-3, 0, 0}, 0.5e-3};
    dimer[1] = (dem_ball){{-0.6e-3, 0, 0}, 0.4e-3};
    dem_random r = random_stream(99, 0);
    for (int i = 0; i < GRAIN_BALLS + FINE_BALLS; i++) {
        dem_vec3 u = v3(random_uniform(&r) - 0.5, random_uniform(&r) - 0.5, random_uniform(&r) - 0.5);
        dem_ball b = {v3(1e-3 * u.x, 0.6e-3 * u.y, 0.4e-3 * u.z), 1e-4 * (2 + 2 * random_uniform(&r))};
        if (i < GRAIN_BALLS)
            grain[i] = b;
        else
            fine[i - GRAIN_BALLS] = (dem_ball){b.centre, b.radius / 2};
    }
    shapes[0] = fill_shape(ball, 1);
    shapes[1] = fill_shape(dimer, 2);
    shapes[2] = fill_shape(grain, GRAIN_BALLS);
    shapes[3] = fill_shape(fine, FINE_BALLS);
    return shapes;
}

static inline double radius_out(const dem_body_def *b)
{
    return fill_shapes()[b->shape].radius_out * b->scale;
}

/// Ball i of a body in space.
static inline dem_ball body_ball(const dem_body_def *b, size_t i)
{
    const dem_ball *ball = &fill_shapes()[b->shape].balls[i];
    dem_vec3 c = quat_rotate(b->orientation, v3_scale(ball->centre, b->scale));
    return (dem_ball){v3_add(b->position, c), ball->radius * b->scale};
}

/// The least gap between the balls of two bodies, b shifted; `limit` where it is larger than that.
static inline double body_gap(const dem_body_def *a, const dem_body_def *b, dem_vec3 shift, double limit)
{
    dem_body_def moved = *b;
    moved.position = v3_add(b->position, shift);
    if (v3_distance(a->position, moved.position) - radius_out(a) - radius_out(b) > limit)
        return limit;
    double least = limit;
    for (size_t i = 0; i < fill_shapes()[a->shape].ball_count; i++) {
        dem_ball p = body_ball(a, i);
        if (v3_distance(p.centre, moved.position) - p.radius - radius_out(b) > limit)
            continue;
        for (size_t j = 0; j < fill_shapes()[b->shape].ball_count; j++) {
            dem_ball q = body_ball(&moved, j);
            least = fmin(least, v3_distance(p.centre, q.centre) - p.radius - q.radius);
        }
    }
    return least;
}

/// The same over all images of b within two periods (0: not periodic), but for the body itself.
static inline double image_gap(const dem_body_def *a, const dem_body_def *b, dem_vec3 period, double limit)
{
    int n[3] = {period.x > 0 ? 2 : 0, period.y > 0 ? 2 : 0, period.z > 0 ? 2 : 0};
    double least = limit;
    for (int x = -n[0]; x <= n[0]; x++)
        for (int y = -n[1]; y <= n[1]; y++)
            for (int z = -n[2]; z <= n[2]; z++)
                if (a != b || x || y || z)
                    least = fmin(least, body_gap(a, b, v3(x * period.x, y * period.y, z * period.z), limit));
    return least;
}

#endif
