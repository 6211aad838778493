#include "out/facets.h"

#include <stdlib.h>

#include "base/memory.h"
#include "math/vec.h"

// the circle in which a neighbour cuts the ball: the part with x . u > h is hidden, x from the ball's centre
typedef struct cut {
    dem_vec3 u;
    double h, s;  // height and radius of the circle
} cut;

typedef struct writer {
    dem_facets *out;
    bool failed;
    uint32_t index;  // of the ball
    dem_ball ball;
    cut *cuts;
    size_t cut_count;
    dem_vec3 *polygon, *rest;  // [3 + cuts]
} writer;

static void put_triangle(writer *w, dem_vec3 a, dem_vec3 b, dem_vec3 c)
{
    dem_facets *out = w->out;
    dem_vec3 o = w->ball.centre;
    if (!(v3_norm2(v3_cross(v3_sub(b, a), v3_sub(c, a))) > 0))
        return;
    if (!dem_grow(&out->facets, &out->capacity, out->count, sizeof *out->facets)) {
        w->failed = true;
        return;
    }
    out->facets[out->count++] = (dem_facet){{v3_add(o, a), v3_add(o, b), v3_add(o, c)}, w->index};
}

static dem_vec3 onto_circle(dem_vec3 x, const cut *c)
{
    dem_vec3 flat = v3_along(x, -v3_dot(x, c->u), c->u);
    return v3_add(v3_scale(c->u, c->h), v3_scale(v3_unit(flat), c->s));
}

// cuts the convex polygon (Sutherland & Hodgman 1974); returns the corners left
static size_t cut_polygon(writer *w, size_t corners, const cut *c)
{
    size_t left = 0;
    for (size_t i = 0; i < corners; i++) {
        dem_vec3 a = w->polygon[i], b = w->polygon[(i + 1) % corners];
        double over_a = v3_dot(a, c->u) - c->h, over_b = v3_dot(b, c->u) - c->h;
        if (over_a <= 0)
            w->rest[left++] = a;
        if ((over_a <= 0) != (over_b <= 0))
            w->rest[left++] = onto_circle(v3_along(a, over_a / (over_a - over_b), v3_sub(b, a)), c);
    }
    dem_vec3 *swap = w->polygon;
    w->polygon = w->rest;
    w->rest = swap;
    return left;
}

static void put_facet(writer *w, dem_vec3 a, dem_vec3 b, dem_vec3 c)
{
    size_t corners = 3;
    w->polygon[0] = v3_scale(a, w->ball.radius);
    w->polygon[1] = v3_scale(b, w->ball.radius);
    w->polygon[2] = v3_scale(c, w->ball.radius);
    for (size_t i = 0; i < w->cut_count && corners; i++) {
        bool crossed = false;
        for (size_t k = 0; k < corners && !crossed; k++)
            crossed = v3_dot(w->polygon[k], w->cuts[i].u) > w->cuts[i].h;
        if (crossed)
            corners = cut_polygon(w, corners, &w->cuts[i]);
    }
    for (size_t k = 2; k < corners; k++)
        put_triangle(w, w->polygon[0], w->polygon[k - 1], w->polygon[k]);
}

static void divide_facet(writer *w, dem_vec3 a, dem_vec3 b, dem_vec3 c, int times)
{
    if (times == 0) {
        put_facet(w, a, b, c);
        return;
    }
    dem_vec3 ab = v3_unit(v3_add(a, b)), bc = v3_unit(v3_add(b, c)), ca = v3_unit(v3_add(c, a));
    divide_facet(w, a, ab, ca, times - 1);
    divide_facet(w, ab, b, bc, times - 1);
    divide_facet(w, ca, bc, c, times - 1);
    divide_facet(w, ab, bc, ca, times - 1);
}

static void put_icosahedron(writer *w, int times)
{
    static const unsigned char faces[20][3] = {{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
                                               {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                                               {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
                                               {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}};
    const double g = 1.618033988749894848;
    const dem_vec3 corners[12] = {{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                                  {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
    for (int i = 0; i < 20; i++)
        divide_facet(w, v3_unit(corners[faces[i][0]]), v3_unit(corners[faces[i][1]]), v3_unit(corners[faces[i][2]]),
                     times);
}

// the circles on ball i; false: another ball holds it whole
static bool find_cuts(writer *w, const dem_ball *balls, size_t count, size_t i)
{
    w->cut_count = 0;
    double r = balls[i].radius;
    for (size_t j = 0; j < count; j++) {
        dem_vec3 apart = v3_sub(balls[j].centre, balls[i].centre);
        double d = v3_norm(apart), other = balls[j].radius;
        if (j == i || d >= r + other)
            continue;
        if (d <= fabs(r - other)) {
            if (r < other || (r == other && j < i))
                return false;
            continue;
        }
        double h = (d + (r - other) * (r + other) / d) / 2;
        w->cuts[w->cut_count++] = (cut){v3_scale(apart, 1 / d), h, sqrt(fmax(0, (r - h) * (r + h)))};
    }
    return true;
}

dem_status dem_balls_facets(const dem_ball *balls, size_t count, int times, dem_facets *facets, dem_error *error)
{
    *facets = (dem_facets){0};
    writer w = {.out = facets,
                .cuts = dem_alloc(count, sizeof *w.cuts),
                .polygon = dem_alloc(count + 3, sizeof *w.polygon),
                .rest = dem_alloc(count + 3, sizeof *w.rest)};
    w.failed = !w.cuts || !w.polygon || !w.rest;
    for (size_t i = 0; i < count && !w.failed; i++) {
        w.ball = balls[i];
        w.index = (uint32_t)i;
        if (find_cuts(&w, balls, count, i))
            put_icosahedron(&w, times);
    }
    free(w.cuts);
    free(w.polygon);
    free(w.rest);
    if (w.failed)
        dem_facets_release(facets);
    return w.failed ? dem_fail_memory(error) : DEM_OK;
}

void dem_facets_release(dem_facets *facets)
{
    free(facets->facets);
    *facets = (dem_facets){0};
}
