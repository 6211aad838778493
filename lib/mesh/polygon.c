#include "mesh/polygon.h"

#include <float.h>
#include <stdlib.h>

#include "base/memory.h"

// a corner in the polygon's own plane, in a ring of those not yet cut off
typedef struct dem_polygon_corner {
    double x, y;
    uint32_t before, after;
    uint32_t blocker;  // place in the list of blockers + 1; 0: not in it
    bool ear;
} polygon_corner;

typedef struct polygon {
    polygon_corner *corners;
    uint32_t *blockers;  // corners that are not convex: only they can lie in an ear
    size_t blocker_count;
    double tolerance;  // twice the area of a triangle that counts as none [m^2]
} polygon;

// twice the vector area (Newell); `size` becomes the largest distance from the first corner
static dem_vec3 vector_area(const dem_vec3 *vertices, const uint32_t *corners, size_t count, double *size)
{
    dem_vec3 origin = vertices[corners[0]], area = v3(0, 0, 0);
    double far = 0;
    for (size_t i = 1; i + 1 < count; i++) {
        dem_vec3 a = v3_sub(vertices[corners[i]], origin), b = v3_sub(vertices[corners[i + 1]], origin);
        area = v3_add(area, v3_cross(a, b));
        far = fmax(far, fmax(v3_norm2(a), v3_norm2(b)));
    }
    *size = sqrt(far);
    return area;
}

// areas below this are rounding: of the coordinates themselves (far from the origin) or of the products
static double area_tolerance(dem_vec3 at, double size)
{
    double far = fmax(fabs(at.x), fmax(fabs(at.y), fabs(at.z)));
    return size * (1e-12 * size + 8 * DBL_EPSILON * far);
}

static uint32_t *put(uint32_t *to, uint32_t a, uint32_t b, uint32_t c)
{
    to[0] = a;
    to[1] = b;
    to[2] = c;
    return to + 3;
}

static bool triangle_faces(dem_vec3 a, dem_vec3 b, dem_vec3 c, dem_vec3 normal, double tolerance)
{
    return v3_dot(v3_cross(v3_sub(b, a), v3_sub(c, a)), normal) > tolerance;
}

// all triangles of the fan about the first corner face the same way: right for every polygon that does not
// meet itself, convex or not, and what other programs make of quads that are not flat
static bool fan_fits(const dem_vec3 *vertices, const uint32_t *corners, size_t count, dem_vec3 normal, double tolerance)
{
    for (size_t i = 1; i + 1 < count; i++)
        if (!triangle_faces(vertices[corners[0]], vertices[corners[i]], vertices[corners[i + 1]], normal, tolerance))
            return false;
    return true;
}

static double turn(const polygon_corner *a, const polygon_corner *b, const polygon_corner *c)
{
    return (b->x - a->x) * (c->y - a->y) - (b->y - a->y) * (c->x - a->x);
}

// a convex corner whose triangle holds no other corner, neither inside nor on the diagonal it would be cut by
static bool is_ear(const polygon *p, uint32_t at)
{
    const polygon_corner *b = &p->corners[at], *a = &p->corners[b->before], *c = &p->corners[b->after];
    if (!(turn(a, b, c) > p->tolerance))
        return false;
    double low = fmin(a->x, fmin(b->x, c->x)), high = fmax(a->x, fmax(b->x, c->x));
    for (size_t i = 0; i < p->blocker_count; i++) {
        const polygon_corner *q = &p->corners[p->blockers[i]];
        if (q->x < low || q->x > high || q == a || q == c)
            continue;
        if (turn(a, b, q) > 0 && turn(b, c, q) > 0 && turn(c, a, q) >= -p->tolerance)
            return false;
    }
    return true;
}

static void unblock(polygon *p, uint32_t at)
{
    if (!p->corners[at].blocker)
        return;
    uint32_t place = p->corners[at].blocker - 1, last = p->blockers[--p->blocker_count];
    p->blockers[place] = last;
    p->corners[last].blocker = place + 1;
    p->corners[at].blocker = 0;
}

static void look_again(polygon *p, uint32_t at)
{
    const polygon_corner *b = &p->corners[at];
    if (turn(&p->corners[b->before], b, &p->corners[b->after]) > p->tolerance)
        unblock(p, at);
    p->corners[at].ear = is_ear(p, at);
}

// the ring of corners, projected along `normal`, with its blockers and ears
static void lay_out(polygon *p, const dem_vec3 *vertices, const uint32_t *corners, uint32_t count, dem_vec3 normal)
{
    dem_vec3 u = v3_normal_to(normal), v = v3_cross(normal, u), origin = vertices[corners[0]];
    for (uint32_t i = 0; i < count; i++) {
        dem_vec3 d = v3_sub(vertices[corners[i]], origin);
        p->corners[i] = (polygon_corner){.x = v3_dot(d, u), .y = v3_dot(d, v)};
        p->corners[i].before = i ? i - 1 : count - 1;
        p->corners[i].after = i + 1 < count ? i + 1 : 0;
    }
    for (uint32_t i = 0; i < count; i++) {
        polygon_corner *c = &p->corners[i];
        if (!(turn(&p->corners[c->before], c, &p->corners[c->after]) > p->tolerance)) {
            p->blockers[p->blocker_count++] = i;
            c->blocker = (uint32_t)p->blocker_count;
        }
    }
    for (uint32_t i = 0; i < count; i++)
        p->corners[i].ear = is_ear(p, i);
}

// ear clipping (Meisters 1975); where a polygon that meets itself has no ear left, any corner is cut off
static void clip_ears(polygon *p, const uint32_t *corners, uint32_t count, uint32_t *triangles)
{
    uint32_t at = 0, passed = 0;
    while (count > 3) {
        polygon_corner *c = &p->corners[at];
        if (!c->ear && passed < count) {
            at = c->after;
            passed++;
            continue;
        }
        triangles = put(triangles, corners[c->before], corners[at], corners[c->after]);
        p->corners[c->before].after = c->after;
        p->corners[c->after].before = c->before;
        look_again(p, c->before);
        look_again(p, c->after);
        at = p->corners[c->after].after;  // not the next one: that would make a fan of slivers
        passed = 0;
        count--;
    }
    put(triangles, corners[p->corners[at].before], corners[at], corners[p->corners[at].after]);
}

static bool make_room(dem_polygon_work *work, size_t count)
{
    while (work->corner_capacity < count)
        if (!dem_grow(&work->corners, &work->corner_capacity, work->corner_capacity, sizeof *work->corners))
            return false;
    while (work->blocker_capacity < count)
        if (!dem_grow(&work->blockers, &work->blocker_capacity, work->blocker_capacity, sizeof *work->blockers))
            return false;
    return true;
}

dem_status dem_polygon_split(dem_polygon_work *work, const dem_vec3 *vertices, const uint32_t *corners, size_t count,
                             uint32_t *triangles)
{
    if (count == 3) {
        put(triangles, corners[0], corners[1], corners[2]);
        return DEM_OK;
    }
    double size;
    dem_vec3 area = vector_area(vertices, corners, count, &size), normal = v3_unit(area);
    double tolerance = area_tolerance(vertices[corners[0]], size);
    if (!(v3_norm(area) > tolerance) || fan_fits(vertices, corners, count, normal, tolerance)) {
        for (size_t i = 1; i + 1 < count; i++)
            triangles = put(triangles, corners[0], corners[i], corners[i + 1]);
        return DEM_OK;
    }
    if (count > DEM_POLYGON_MOST_CORNERS)
        return DEM_BAD_INPUT;
    if (!make_room(work, count))
        return DEM_NO_MEMORY;
    polygon p = {.corners = work->corners, .blockers = work->blockers, .tolerance = tolerance};
    lay_out(&p, vertices, corners, (uint32_t)count, normal);
    clip_ears(&p, corners, (uint32_t)count, triangles);
    return DEM_OK;
}

void dem_polygon_work_release(dem_polygon_work *work)
{
    free(work->corners);
    free(work->blockers);
    *work = (dem_polygon_work){0};
}
