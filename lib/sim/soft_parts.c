// Cuts a clump into parts that are nearly convex, for soft contacts: where a grain is concave, it may touch another one
// in several places at once, and each of them is a contact of its own.
//
// Two spheres see each other if what their hull adds to the union, hollows filled, stands out by no more than SLACK. A
// part is a cluster of spheres of which nearly all see each other: medoids, whose number is the least that will do
// (compare Lien & Amato 2006 for meshes). It is found for a sample of spheres that are far apart, so it hardly depends
// on how many there are. Roughness within SLACK is not concavity: a rounded grain is one part.
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "math/vec.h"
#include "sim/soft.h"

enum { SAMPLE = 96, ROUNDS = 12 };
enum { ALONG = 5, AROUND = 8 };  // points of a hull that are looked at
enum { CELLS_MOST = 96 };        // along an edge of the grid
enum { EMPTY, FILLED, UNSEEN };

static const double SLACK = 0.12;  // [equivalent diameters]
static const double ROUGH = 0.02;  // of the pairs of a part need not see each other
static const double SAME = 1e-9;   // distance of centres that are one [equivalent diameters]

typedef struct splitting {
    const double (*spheres)[4];
    size_t count;
    double size, slack;
    size_t n;
    uint32_t sample[SAMPLE];
    double cost[SAMPLE][SAMPLE];  // distance, and a size more where they do not see each other [m]
    bool sees[SAMPLE][SAMPLE];
    // cells in which the outside is found
    dem_vec3 origin;
    double cell;  // edge [m]
    size_t cells[3], cell_count;
    uint8_t *outside;
    uint32_t *stack;
} splitting;

static dem_vec3 centre_of(const splitting *s, size_t i)
{
    return v3(s->spheres[i][0], s->spheres[i][1], s->spheres[i][2]);
}

static double between(const splitting *s, size_t i, size_t k)
{
    return v3_distance(centre_of(s, i), centre_of(s, k));
}

static size_t cell_of(const splitting *s, const size_t at[3])
{
    return (at[2] * s->cells[1] + at[1]) * s->cells[0] + at[0];
}

static bool make_grid(splitting *s)
{
    dem_box box = box_empty();
    for (size_t i = 0; i < s->count; i++) {
        double r = s->spheres[i][3] + s->slack;
        box = box_with(box_with(box, v3_add(centre_of(s, i), v3(r, r, r))), v3_sub(centre_of(s, i), v3(r, r, r)));
    }
    s->cell = 0.5 * s->slack;
    for (int k = 0; k < 3; k++)
        s->cell = larger(s->cell, (v3_get(box.high, k) - v3_get(box.low, k)) / CELLS_MOST);
    s->origin = v3_sub(box.low, v3(s->cell, s->cell, s->cell));
    for (int k = 0; k < 3; k++)
        s->cells[k] = (size_t)((v3_get(box.high, k) - v3_get(box.low, k)) / s->cell) + 3;
    s->cell_count = s->cells[0] * s->cells[1] * s->cells[2];
    s->outside = dem_alloc(s->cell_count, sizeof *s->outside);
    s->stack = dem_alloc(s->cell_count, sizeof *s->stack);
    return s->outside && s->stack;
}

// cells whose middles are within SLACK of a sphere
static void fill_sphere(splitting *s, size_t i)
{
    double r = s->spheres[i][3] + s->slack;
    size_t low[3], high[3], at[3];
    for (int k = 0; k < 3; k++) {
        double middle = (s->spheres[i][k] - v3_get(s->origin, k)) / s->cell;
        low[k] = (size_t)larger(0, middle - r / s->cell - 1);
        high[k] = (size_t)smaller((double)s->cells[k], middle + r / s->cell + 1);
    }
    for (at[2] = low[2]; at[2] < high[2]; at[2]++)
        for (at[1] = low[1]; at[1] < high[1]; at[1]++)
            for (at[0] = low[0]; at[0] < high[0]; at[0]++) {
                dem_vec3 middle = v3((double)at[0] + 0.5, (double)at[1] + 0.5, (double)at[2] + 0.5);
                if (v3_distance(v3_along(s->origin, s->cell, middle), centre_of(s, i)) < r)
                    s->outside[cell_of(s, at)] = FILLED;
            }
}

// what is reached from a corner, which no sphere fills; hollows within a grain are not
static void flood(splitting *s)
{
    const size_t step[3] = {1, s->cells[0], s->cells[0] * s->cells[1]};
    size_t count = 0;
    for (size_t i = 0; i < s->cell_count; i++)
        s->outside[i] = s->outside[i] == EMPTY ? UNSEEN : FILLED;
    s->outside[0] = EMPTY;
    s->stack[count++] = 0;
    while (count) {
        size_t cell = s->stack[--count];
        for (int k = 0; k < 3; k++) {
            size_t at = cell / step[k] % s->cells[k];
            for (int up = 0; up < 2; up++) {
                if (up ? at + 1 == s->cells[k] : at == 0)
                    continue;
                size_t next = up ? cell + step[k] : cell - step[k];
                if (s->outside[next] != UNSEEN)
                    continue;
                s->outside[next] = EMPTY;
                s->stack[count++] = (uint32_t)next;
            }
        }
    }
}

static bool find_outside(splitting *s)
{
    if (!make_grid(s))
        return false;
    memset(s->outside, EMPTY, s->cell_count);
    for (size_t i = 0; i < s->count; i++)
        fill_sphere(s, i);
    flood(s);
    return true;
}

static bool covered(const splitting *s, dem_vec3 point)
{
    size_t at[3];
    for (int k = 0; k < 3; k++)
        at[k] = (size_t)((v3_get(point, k) - v3_get(s->origin, k)) / s->cell);
    return s->outside[cell_of(s, at)] != EMPTY;
}

static bool see_each_other(const splitting *s, size_t i, size_t k)
{
    double distance = between(s, i, k), ri = s->spheres[i][3], rk = s->spheres[k][3];
    if (distance <= fabs(ri - rk) + s->slack)
        return true;
    dem_vec3 axis = v3_unit(v3_sub(centre_of(s, k), centre_of(s, i))), u = v3_normal_to(axis), v = v3_cross(axis, u);
    for (int a = 1; a <= ALONG; a++)
        for (int b = 0; b < AROUND; b++) {
            double t = a / (ALONG + 1.0), angle = 2 * DEM_PI * b / AROUND, radius = ri + t * (rk - ri);
            dem_vec3 on_axis = v3_along(centre_of(s, i), t * distance, axis);
            if (!covered(s, v3_along(v3_along(on_axis, radius * cos(angle), u), radius * sin(angle), v)))
                return false;
        }
    return true;
}

// spheres that are far from each other, the largest first
static void take_sample(splitting *s)
{
    size_t next = 0;
    for (size_t i = 1; i < s->count; i++)
        if (s->spheres[i][3] > s->spheres[next][3])
            next = i;
    double farthest = INFINITY;
    for (s->n = 0; s->n < SAMPLE && s->n < s->count && farthest > SAME * s->size;) {
        s->sample[s->n++] = (uint32_t)next;
        farthest = 0;
        for (size_t i = 0; i < s->count; i++) {
            double nearest = INFINITY;
            for (size_t k = 0; k < s->n; k++)
                nearest = smaller(nearest, between(s, i, s->sample[k]));
            if (nearest > farthest) {
                farthest = nearest;
                next = i;
            }
        }
    }
}

static void look_around(splitting *s)
{
    for (size_t i = 0; i < s->n; i++)
        for (size_t k = 0; k <= i; k++) {
            bool sees = i == k || see_each_other(s, s->sample[i], s->sample[k]);
            s->sees[i][k] = s->sees[k][i] = sees;
            s->cost[i][k] = s->cost[k][i] = between(s, s->sample[i], s->sample[k]) + (sees ? 0 : s->size);
        }
}

static void join_nearest(const splitting *s, const size_t *medoid, size_t parts, uint8_t *of)
{
    for (size_t i = 0; i < s->n; i++) {
        of[i] = 0;
        for (size_t p = 1; p < parts; p++)
            if (s->cost[i][medoid[p]] < s->cost[i][medoid[of[i]]])
                of[i] = (uint8_t)p;
    }
}

static bool move_medoids(const splitting *s, const uint8_t *of, size_t parts, size_t *medoid)
{
    bool moved = false;
    for (size_t p = 0; p < parts; p++) {
        double least = INFINITY;
        size_t best = medoid[p];
        for (size_t i = 0; i < s->n; i++) {
            double sum = 0;
            for (size_t k = 0; of[i] == p && k < s->n; k++)
                sum += of[k] == p ? s->cost[i][k] * s->cost[i][k] : 0;
            if (of[i] == p && sum < least) {
                least = sum;
                best = i;
            }
        }
        moved |= best != medoid[p];
        medoid[p] = best;
    }
    return moved;
}

static void cluster(const splitting *s, size_t parts, uint8_t *of)
{
    size_t medoid[DEM_SOFT_PARTS] = {0};
    for (size_t p = 1; p < parts; p++) {
        double farthest = -1;
        for (size_t i = 0; i < s->n; i++) {
            double nearest = INFINITY;
            for (size_t k = 0; k < p; k++)
                nearest = smaller(nearest, s->cost[i][medoid[k]]);
            if (nearest > farthest) {
                farthest = nearest;
                medoid[p] = i;
            }
        }
    }
    join_nearest(s, medoid, parts, of);
    for (int round = 0; round < ROUNDS && move_medoids(s, of, parts, medoid); round++)
        join_nearest(s, medoid, parts, of);
}

// of the pairs within parts, those that do not see each other
static double blindness(const splitting *s, const uint8_t *of)
{
    size_t pairs = 0, blind = 0;
    for (size_t i = 0; i < s->n; i++)
        for (size_t k = 0; k < i; k++)
            if (of[i] == of[k]) {
                pairs++;
                blind += !s->sees[i][k];
            }
    return pairs ? (double)blind / (double)pairs : 0;
}

// each sphere goes with that of the sample into which it reaches most
static void spread(const splitting *s, const uint8_t *of, uint8_t *part)
{
    for (size_t i = 0; i < s->count; i++) {
        double least = INFINITY;
        for (size_t k = 0; k < s->n; k++) {
            double gap = between(s, i, s->sample[k]) - s->spheres[s->sample[k]][3];
            if (gap < least) {
                least = gap;
                part[i] = of[k];
            }
        }
    }
}

size_t dem_soft_split(const double (*spheres)[4], size_t count, double size, uint8_t *part)
{
    memset(part, 0, count);
    if (count < 2)
        return 1;
    splitting *s = dem_alloc(1, sizeof *s);
    if (!s)
        return 0;
    *s = (splitting){.spheres = spheres, .count = count, .size = size, .slack = SLACK * size};
    size_t parts = 0;
    if (find_outside(s)) {
        uint8_t of[SAMPLE] = {0};
        take_sample(s);
        look_around(s);
        parts = 1;
        while (parts < DEM_SOFT_PARTS && parts < s->n && blindness(s, of) > ROUGH)
            cluster(s, ++parts, of);
        if (parts > 1)
            spread(s, of, part);
    }
    free(s->outside);
    free(s->stack);
    free(s);
    return parts;
}
