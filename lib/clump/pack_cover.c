// A ball is convex: it covers a triangle when it covers its corners. Triangles that no single ball covers are divided
// in four, down to a size at which raising a ball for the whole piece costs next to nothing.
#include "clump/pack_cover.h"

#include <stdlib.h>

#include "base/status.h"

enum { DEEPEST = 24, TRIANGLES_PER_REPORT = 4096 };

static const double smallest_piece = 1e-3; // [d_eq]
static const double safety = 1e-9;         // against rounding [d_eq]

typedef struct cover {
    dem_ball *balls;
    size_t count;
    uint32_t *lists; // [DEEPEST + 1][count] balls near the piece at hand and the pieces it is part of
} cover;

static double farthest_corner(const dem_vec3 corners[3], dem_vec3 centre)
{
    return fmax(v3_distance(corners[0], centre),
                fmax(v3_distance(corners[1], centre), v3_distance(corners[2], centre)));
}

static void raise_one(cover *c, const dem_vec3 corners[3])
{
    size_t best = 0;
    double least = INFINITY;
    for (size_t i = 0; i < c->count; i++) {
        double lack = farthest_corner(corners, c->balls[i].centre) - c->balls[i].radius;
        if (lack < least) {
            least = lack;
            best = i;
        }
    }
    if (least > -safety)
        c->balls[best].radius += least + 2 * safety;
}

// `from`: balls near the piece this one is part of
static void cover_piece(cover *c, const dem_vec3 t[3], const uint32_t *from, size_t from_count, int depth)
{
    dem_vec3 middle = v3_scale(v3_add(v3_add(t[0], t[1]), t[2]), 1.0 / 3);
    double radius = farthest_corner(t, middle);
    uint32_t *near = c->lists + (size_t)depth * c->count;
    size_t near_count = 0;
    for (size_t k = 0; k < from_count; k++) {
        const dem_ball *ball = &c->balls[from[k]];
        double d = v3_distance(ball->centre, middle);
        if (d > ball->radius + radius)
            continue;
        if (d + radius < ball->radius || farthest_corner(t, ball->centre) < ball->radius - safety)
            return;
        near[near_count++] = from[k];
    }
    if (radius < smallest_piece || depth == DEEPEST) {
        raise_one(c, t);
        return;
    }
    dem_vec3 a = v3_scale(v3_add(t[1], t[2]), 0.5), b = v3_scale(v3_add(t[2], t[0]), 0.5);
    dem_vec3 o = v3_scale(v3_add(t[0], t[1]), 0.5);
    const dem_vec3 parts[4][3] = {{t[0], o, b}, {o, t[1], a}, {b, a, t[2]}, {a, b, o}};
    for (int k = 0; k < 4; k++)
        cover_piece(c, parts[k], near, near_count, depth + 1);
}

static dem_status cover_surface(dem_packing *p, cover *c, const uint32_t *all, dem_error *error)
{
    for (size_t t = 0; t < p->grain->mesh->triangle_count; t++) {
        dem_vec3 corners[3];
        dem_pack_grain_corners(p->grain, t, corners);
        if (t % TRIANGLES_PER_REPORT == 0)
            DEM_TRY(dem_pack_go_on(p, error));
        cover_piece(c, corners, all, c->count, 0);
    }
    return DEM_OK;
}

static dem_status cover_inside(const dem_packing *p, cover *c, dem_error *error)
{
    dem_vec3 *points = dem_alloc(p->lattice.inside_count, sizeof *points);
    if (!points)
        return dem_fail_memory(error);
    size_t count = dem_lattice_sample(&p->lattice, p->lattice.inside_count, points);
    for (size_t k = 0; k < count; k++)
        raise_one(c, (dem_vec3[3]){points[k], points[k], points[k]});
    free(points);
    return DEM_OK;
}

dem_status dem_pack_cover(dem_packing *p, dem_pack_state *state, dem_error *error)
{
    cover c = {.balls = state->balls, .count = state->count};
    c.lists = dem_alloc((DEEPEST + 2) * state->count, sizeof *c.lists);
    if (!c.lists)
        return dem_fail_memory(error);
    uint32_t *all = c.lists + (DEEPEST + 1) * state->count;
    for (uint32_t i = 0; i < state->count; i++)
        all[i] = i;
    dem_status status = cover_surface(p, &c, all, error);
    if (status == DEM_OK)
        status = cover_inside(p, &c, error);
    free(c.lists);
    return status;
}
