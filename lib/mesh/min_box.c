// Minimum-volume bounding box. Turning a box about one of its axes is a planar problem with an exact answer:
// the smallest rectangle around the projected points has a side flush with their hull (Freeman & Shapira 1975).
// We solve it about many axes, then turn the best ones about their three axes in turn until nothing is
// gained. The search runs on a few hundred extreme points, only the last turns on all of them.
#include "mesh/min_box.h"

#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "math/mat3.h"
#include "math/quat.h"
#include "mesh/mass.h"

enum {
    EXTREME_DIRECTIONS = 150,
    SEARCH_AXES = 300,
    KEPT = 16,
    POLISHED = 4,
    MAX_TURNS = 60,
    MAX_JOINS = 25,
    SHARED_JOINS = 6,
    TILTS = 27,
    NO_TILT = 13,
    EXTREME_POINTS = 2 * EXTREME_DIRECTIONS + 6 * (MAX_JOINS + 1 + POLISHED * SHARED_JOINS),
    FILTER = 8
};

static const double SMALL_TILT = 0.03;

typedef struct frame {
    dem_vec3 axis[3];
    double edge[3], volume;
} frame;

typedef struct flat_point {
    double x, y;
} flat_point;

typedef struct point_set {
    dem_vec3 *points;
    size_t count;
    flat_point *flat, *hull;  // [count], [2 count]
} point_set;

static double cross2(flat_point o, flat_point a, flat_point b)
{
    return (a.x - o.x) * (b.y - o.y) - (a.y - o.y) * (b.x - o.x);
}

static bool x_then_y(flat_point a, flat_point b)
{
    return a.x < b.x || (a.x == b.x && a.y < b.y);
}

// Projects along axis 2 of `f`, leaving out most points that lie inside the polygon of the extreme ones: those of
// x, x + y, y, y - x and their opposites.
static size_t project(const point_set *set, const frame *f)
{
    flat_point edge[FILTER], corner[FILTER];
    double low[FILTER / 2], high[FILTER / 2];
    size_t lowest[FILTER / 2] = {0}, highest[FILTER / 2] = {0};
    for (int k = 0; k < FILTER / 2; k++) {
        low[k] = INFINITY;
        high[k] = -INFINITY;
    }
    for (size_t i = 0; i < set->count; i++) {
        flat_point p = {v3_dot(set->points[i], f->axis[0]), v3_dot(set->points[i], f->axis[1])};
        const double along_each[FILTER / 2] = {p.x, p.x + p.y, p.y, p.y - p.x};
        set->flat[i] = p;
        for (int k = 0; k < FILTER / 2; k++) {
            if (along_each[k] < low[k])
                low[k] = along_each[k], lowest[k] = i;
            if (along_each[k] > high[k])
                high[k] = along_each[k], highest[k] = i;
        }
    }
    int corners = 0;
    for (int k = 0; k < FILTER; k++) {
        size_t at = k < FILTER / 2 ? highest[k] : lowest[k - FILTER / 2];
        size_t next = k + 1 < FILTER / 2 ? highest[k + 1] : lowest[(k + 1) % (FILTER / 2)];
        next = k + 1 == FILTER ? highest[0] : next;
        if (at == next)
            continue;
        corner[corners] = set->flat[at];
        edge[corners++] = (flat_point){set->flat[next].x - set->flat[at].x, set->flat[next].y - set->flat[at].y};
    }
    size_t kept = 0;
    for (size_t i = 0; i < set->count; i++) {
        flat_point p = set->flat[i];
        bool inside = true;
        for (int k = 0; k < corners && inside; k++)
            inside = edge[k].x * (p.y - corner[k].y) - edge[k].y * (p.x - corner[k].x) > 0;
        if (!inside)
            set->flat[kept++] = p;
    }
    return kept;
}

// some dozens: by insertion over shrinking gaps (Shell 1959, with the gaps of Ciura 2001)
static void sort_points(flat_point *p, size_t count)
{
    static const size_t gaps[] = {301, 132, 57, 23, 10, 4, 1};
    for (size_t g = 0; g < sizeof gaps / sizeof *gaps; g++)
        for (size_t i = gaps[g]; i < count; i++) {
            flat_point moving = p[i];
            size_t k = i;
            for (; k >= gaps[g] && x_then_y(moving, p[k - gaps[g]]); k -= gaps[g])
                p[k] = p[k - gaps[g]];
            p[k] = moving;
        }
}

// counter-clockwise hull without collinear points (Andrew 1979)
static size_t planar_hull(flat_point *p, size_t count, flat_point *hull)
{
    sort_points(p, count);
    size_t n = 0;
    for (size_t i = 0; i < count; i++) {
        while (n >= 2 && cross2(hull[n - 2], hull[n - 1], p[i]) <= 0)
            n--;
        hull[n++] = p[i];
    }
    for (size_t i = count - 1, lower = n + 1; i-- > 0;) {
        while (n >= lower && cross2(hull[n - 2], hull[n - 1], p[i]) <= 0)
            n--;
        hull[n++] = p[i];
    }
    return n > 1 ? n - 1 : n;
}

static double along(flat_point p, flat_point direction)
{
    return p.x * direction.x + p.y * direction.y;
}

// smallest rectangle around a convex polygon: direction of one side and the two edges (rotating calipers)
static double smallest_rectangle(const flat_point *hull, size_t n, flat_point *direction, double edge[2])
{
    double best = INFINITY;
    double slack = 1e-15 * (hypot(hull[0].x, hull[0].y) + hypot(hull[n / 2].x, hull[n / 2].y));
    size_t far = 1, top = 1, near = 1;
    for (size_t i = 0; i < n; i++) {
        flat_point a = hull[i], b = hull[(i + 1) % n];
        double length = hypot(b.x - a.x, b.y - a.y);
        if (!(length > 0))
            continue;
        flat_point u = {(b.x - a.x) / length, (b.y - a.y) / length}, v = {-u.y, u.x};
        for (size_t k = 0; k < n && along(hull[(far + 1) % n], u) > along(hull[far], u) - slack; k++)
            far = (far + 1) % n;
        if (i == 0)
            top = far;
        for (size_t k = 0; k < n && along(hull[(top + 1) % n], v) > along(hull[top], v) - slack; k++)
            top = (top + 1) % n;
        if (i == 0)
            near = top;
        for (size_t k = 0; k < n && along(hull[(near + 1) % n], u) < along(hull[near], u) + slack; k++)
            near = (near + 1) % n;
        double width = along(hull[far], u) - along(hull[near], u), height = along(hull[top], v) - along(a, v);
        if (width * height < best) {
            best = width * height;
            *direction = u;
            edge[0] = width;
            edge[1] = height;
        }
    }
    return best;
}

static double extent(const point_set *set, dem_vec3 axis)
{
    double low = INFINITY, high = -INFINITY;
    for (size_t i = 0; i < set->count; i++) {
        double d = v3_dot(set->points[i], axis);
        low = d < low ? d : low;
        high = d > high ? d : high;
    }
    return high - low;
}

// Turns the frame, whose edge 2 is known, about its axis 2 into the best position; false where the projection has no
// area. `rim` are points of which all can be missing that do not lie on the rim of the projection.
static bool turn_rim(const point_set *rim, frame *f)
{
    size_t kept = project(rim, f), n = planar_hull(rim->flat, kept, rim->hull);
    flat_point u = {1, 0};
    double edge[2] = {0, 0};
    if (n < 3 || !(smallest_rectangle(rim->hull, n, &u, edge) > 0))
        return false;
    dem_vec3 a = f->axis[0], b = f->axis[1];
    f->axis[0] = v3_unit(v3_along(v3_scale(a, u.x), u.y, b));
    f->axis[1] = v3_cross(f->axis[2], f->axis[0]);
    f->edge[0] = edge[0];
    f->edge[1] = edge[1];
    f->volume = f->edge[0] * f->edge[1] * f->edge[2];
    return true;
}

static bool turn(const point_set *set, frame *f)
{
    f->edge[2] = extent(set, f->axis[2]);
    return turn_rim(set, f);
}

static frame rolled(frame f)
{
    return (frame){{f.axis[1], f.axis[2], f.axis[0]}, {f.edge[1], f.edge[2], f.edge[0]}, f.volume};
}

// turns about the three axes in turn until a whole round gains nothing
static void settle(const point_set *set, frame *f)
{
    int idle = 0;
    for (int i = 0; i < MAX_TURNS && idle < 3; i++) {
        frame next = rolled(*f);
        *f = next;
        if (turn(set, &next) && next.volume < f->volume * (1 - 1e-13)) {
            *f = next;
            idle = 0;
        } else {
            idle++;
        }
    }
}

// the frame turned by a small angle about p of its own axes: a - b, a + b + c, ...
static frame tilted(const point_set *set, const frame *f, const int p[3], double angle)
{
    dem_vec3 axis = v3_add(v3_add(v3_scale(f->axis[0], p[0]), v3_scale(f->axis[1], p[1])), v3_scale(f->axis[2], p[2]));
    axis = v3_scale(v3_unit(axis), sin(angle / 2));
    dem_quat q = {cos(angle / 2), axis.x, axis.y, axis.z};
    frame g = {.volume = 1};
    for (int k = 0; k < 3; k++) {
        g.axis[k] = v3_unit(quat_rotate(q, f->axis[k]));
        g.edge[k] = extent(set, g.axis[k]);
        g.volume *= g.edge[k];
    }
    return g;
}

// The points that can lie on the rim of the projection along axis 2 when the frame is turned by an angle at most: in
// the projection a point moves by less than its distance times the angle, and so do the corners of the hull.
static void near_rim(const point_set *set, const frame *f, double angle, point_set *rim)
{
    size_t n = planar_hull(set->flat, project(set, f), set->hull);
    double farthest2 = 0;
    rim->count = 0;
    for (size_t i = 0; i < set->count; i++)
        farthest2 = larger(farthest2, v3_norm2(set->points[i]));
    double margin = 2.01 * angle * sqrt(farthest2);
    for (size_t i = 0; i < set->count; i++) {
        flat_point p = {v3_dot(set->points[i], f->axis[0]), v3_dot(set->points[i], f->axis[1])};
        bool inside = n > 2;
        for (size_t k = 0; k < n && inside; k++) {
            flat_point a = set->hull[k], b = set->hull[k + 1 < n ? k + 1 : 0];
            double depth = cross2(a, b, p), edge2 = (b.x - a.x) * (b.x - a.x) + (b.y - a.y) * (b.y - a.y);
            inside = depth > 0 && depth * depth > margin * margin * edge2;
        }
        if (!inside)
            rim->points[rim->count++] = set->points[i];
    }
}

// settles, tries tilts of ever smaller angles, and settles again
static void tilt(const point_set *set, frame *f, double angle)
{
    int idle = 0;
    settle(set, f);
    dem_vec3 points[3][EXTREME_POINTS];
    for (; angle > 1e-4 && idle < 2; angle /= 3) {
        frame best = *f, rolling = *f;
        point_set rim[3];
        for (int k = 0; k < 3; k++) {
            rim[k] = (point_set){points[k], 0, set->flat, set->hull};
            near_rim(set, &rolling, angle, &rim[k]);
            rolling = rolled(rolling);
        }
        for (int i = 0; i < TILTS; i++) {
            if (i == NO_TILT)
                continue;
            frame g = tilted(set, f, (int[]){i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1}, angle);
            for (int k = 0; k < 3; k++) {
                frame h = g;
                if (turn_rim(&rim[k], &h) && h.volume < best.volume * (1 - 1e-12))
                    best = h;
                g = rolled(g);
            }
        }
        // where two small angles in turn gain nothing smaller ones do not either
        if (best.volume < f->volume) {
            settle(set, &best);
            idle = 0;
        } else if (angle < SMALL_TILT) {
            idle++;
        }
        *f = best;
    }
}

static frame frame_about(dem_vec3 axis)
{
    dem_vec3 a = v3_normal_to(axis);
    return (frame){.axis = {a, v3_cross(axis, a), axis}, .volume = INFINITY};
}

// spiral over the half sphere (Vogel 1979)
static dem_vec3 spiral(int i, int count)
{
    double z = (i + 0.5) / count, r = sqrt(1 - z * z), angle = i * (DEM_PI * (3 - sqrt(5)));
    return v3(r * cos(angle), r * sin(angle), z);
}

// one point is the farthest in many directions: each is taken once
static size_t add_extreme(const point_set *all, size_t point, size_t *taken, dem_vec3 *extreme, size_t found)
{
    for (size_t k = 0; k < found; k++)
        if (taken[k] == point)
            return found;
    taken[found] = point;
    extreme[found] = all->points[point];
    return found + 1;
}

static size_t extreme_points(const point_set *all, dem_vec3 *extreme)
{
    size_t found = 0, taken[2 * EXTREME_DIRECTIONS];
    for (int i = 0; i < EXTREME_DIRECTIONS; i++) {
        dem_vec3 d = spiral(i, EXTREME_DIRECTIONS);
        size_t low = 0, high = 0;
        double least = INFINITY, most = -INFINITY;
        for (size_t k = 0; k < all->count; k++) {
            double x = v3_dot(all->points[k], d);
            if (x < least)
                least = x, low = k;
            if (x > most)
                most = x, high = k;
        }
        found = add_extreme(all, low, taken, extreme, found);
        found = add_extreme(all, high, taken, extreme, found);
    }
    return found;
}

// keeps the KEPT best frames, best first
static void keep_best(frame *best, size_t *count, const frame *f)
{
    if (*count == KEPT && best[KEPT - 1].volume <= f->volume)
        return;
    size_t at = *count < KEPT ? (*count)++ : KEPT - 1;
    for (; at > 0 && best[at - 1].volume > f->volume; at--)
        best[at] = best[at - 1];
    best[at] = *f;
}

// the frames of least volume about many axes
static size_t search(const point_set *few, int threads, frame *best)
{
    size_t count = 0;
    dem_sym3 spread = {0};
    for (size_t i = 0; i < few->count; i++)
        spread = sym3_add(spread, sym3_outer(few->points[i]));
    double values[3];
    dem_vec3 principal[3];
    dem_sym3_eigen(spread, values, principal);
    frame all[SEARCH_AXES + 6];
#pragma omp parallel for num_threads(threads) schedule(dynamic, 16) if (threads > 1)
    for (int k = 0; k < SEARCH_AXES + 6; k++) {
        flat_point flat[EXTREME_POINTS], hull[2 * EXTREME_POINTS];
        point_set own = {few->points, few->count, flat, hull};
        int i = k - 6;
        all[k] = frame_about(i >= 0    ? spiral(i, SEARCH_AXES)
                             : i >= -3 ? principal[i + 3]
                                       : v3(i == -4, i == -5, i == -6));
        if (!turn(&own, &all[k]))
            all[k].volume = INFINITY;
    }
    for (int k = 0; k < SEARCH_AXES + 6; k++)
        if (all[k].volume < INFINITY)
            keep_best(best, &count, &all[k]);
    return count;
}

// lets the farthest points outside the box join `few`; false: there are none. Afterwards the edges are true
static bool join(point_set *few, const point_set *all, frame *f)
{
    bool grown = false;
    f->volume = 1;
    for (int k = 0; k < 3; k++) {
        size_t low = 0, high = 0;
        double least = INFINITY, most = -INFINITY;
        for (size_t i = 0; i < all->count; i++) {
            double d = v3_dot(all->points[i], f->axis[k]);
            if (d < least)
                least = d, low = i;
            if (d > most)
                most = d, high = i;
        }
        if (most - least > f->edge[k] * (1 + 1e-12)) {
            few->points[few->count++] = all->points[low];
            few->points[few->count++] = all->points[high];
            grown = true;
        }
        f->edge[k] = most - least;
        f->volume *= f->edge[k];
    }
    return grown;
}

// a frame found on few points made the best one near it for all
static void polish(const point_set *start, const point_set *all, frame *f)
{
    dem_vec3 points[EXTREME_POINTS];
    flat_point flat[EXTREME_POINTS], hull[2 * EXTREME_POINTS];
    point_set few = {points, start->count, flat, hull};
    memcpy(points, start->points, start->count * sizeof *points);
    tilt(&few, f, 0.2);
    // most of those that were missing come in while it only turns
    int joins = 0;
    for (; joins < MAX_JOINS && join(&few, all, f); joins++)
        settle(&few, f);
    for (tilt(&few, f, 0.01); joins < MAX_JOINS && join(&few, all, f); joins++)
        tilt(&few, f, 0.01);
    join(&few, all, f);
}

static frame smallest_frame(point_set *few, const point_set *all, int threads)
{
    frame best[KEPT], polished[POLISHED], least = {.volume = INFINITY};
    size_t count = search(few, threads, best), taken = 0;
    for (size_t i = 0; i < count; i++)
        settle(few, &best[i]);
    for (; taken < POLISHED && taken < count; taken++) {
        size_t pick = 0;
        for (size_t k = 1; k < count; k++)
            if (best[k].volume < best[pick].volume)
                pick = k;
        polished[taken] = best[pick];
        best[pick].volume = INFINITY;
        for (int k = 0; k < SHARED_JOINS && join(few, all, &polished[taken]); k++)
            settle(few, &polished[taken]);
    }
#pragma omp parallel for num_threads(threads) schedule(dynamic, 1) if (threads > 1)
    for (size_t i = 0; i < taken; i++)
        polish(few, all, &polished[i]);
    for (size_t i = 0; i < taken; i++)
        if (polished[i].volume < least.volume)
            least = polished[i];
    return least;
}

// the used vertices about the middle of their box
static size_t centred_points(const dem_mesh *mesh, dem_vec3 *points, unsigned char *used)
{
    dem_box box = dem_mesh_box(mesh);
    dem_vec3 middle = v3_along(box.low, 0.5, v3_sub(box.high, box.low));
    for (size_t i = 0; i < 3 * mesh->triangle_count; i++)
        used[mesh->triangles[i]] = 1;
    size_t count = 0;
    for (size_t i = 0; i < mesh->vertex_count; i++)
        if (used[i])
            points[count++] = v3_sub(mesh->vertices[i], middle);
    return count;
}

dem_status dem_mesh_min_box(const dem_mesh *mesh, int threads, double edges[3], dem_vec3 axes[3], dem_error *error)
{
    dem_status status = DEM_OK;
    dem_vec3 *points = dem_alloc(mesh->vertex_count, sizeof *points), extreme[EXTREME_POINTS];
    unsigned char *used = dem_alloc_zero(mesh->vertex_count, 1);
    flat_point flat[EXTREME_POINTS], hull[2 * EXTREME_POINTS];
    if (!points || !used) {
        status = dem_fail_memory(error);
        goto done;
    }
    point_set all = {.points = points, .count = centred_points(mesh, points, used)};
    point_set few = {extreme, extreme_points(&all, extreme), flat, hull};
    frame f = smallest_frame(&few, &all, threads);
    for (int k = 0; k < 3; k++)
        edges[k] = f.edge[k];
    for (int k = 0; k < 2; k++)
        for (int i = 0; i < 2 - k; i++)
            if (edges[i] < edges[i + 1]) {
                double swap = edges[i];
                edges[i] = edges[i + 1];
                edges[i + 1] = swap;
                dem_vec3 axis = f.axis[i];
                f.axis[i] = f.axis[i + 1];
                f.axis[i + 1] = axis;
            }
    for (int k = 0; axes && k < 2; k++)
        axes[k] = f.axis[k];
    if (axes)
        axes[2] = v3_cross(axes[0], axes[1]);
    if (!(f.volume < INFINITY) || edges[1] <= 1e-12 * edges[0])
        status = dem_fail(error, DEM_BAD_INPUT, "all vertices lie on one line; give a mesh of a solid");
done:
    free(points);
    free(used);
    return status;
}
