// Exact union of balls: the boundary is made of patches (geom/patch.c), and the divergence theorem turns every volume
// moment into integrals over them. Balls whose patches do not close are shaken and tried once more.
#include "geom/union.h"

#include <stdlib.h>

#include "base/random.h"
#include "geom/ball_tree.h"
#include "geom/patch.h"

// arcs or a boundary that fail to close by more than this are in doubt [-]; rounding makes 1e-15 to 1e-12
#define CLOSURE 1e-9
// how far balls move, in radii, when they are [-]
#define SHAKE 1e-11

enum { FEW_PATCHES = 64, PATCHES_AT_ONCE = 8 };  // done alone; a thread's share at a time

typedef struct rooms {
    size_t arcs, caps, cap_count;
} rooms;

// the caps of ball i, and each crease once, from the ball of lower index
static bool creases_export(const dem_patch_work *w, uint32_t i, dem_ball_union *result, rooms *room)
{
    for (size_t k = 0; k < dem_patch_cap_count(w); k++) {
        if (!dem_grow(&result->caps, &room->caps, room->cap_count, sizeof *result->caps))
            return false;
        result->caps[room->cap_count++] = dem_patch_cap(w, k);
    }
    result->cap_start[i + 1] = room->cap_count;
    for (size_t k = 0; k < dem_patch_arc_count(w); k++) {
        dem_arc arc = dem_patch_arc(w, i, k);
        if (arc.j < i)
            continue;
        if (!dem_grow(&result->arcs, &room->arcs, result->arc_count, sizeof *result->arcs))
            return false;
        result->arcs[result->arc_count++] = arc;
    }
    return true;
}

// T c, the contraction of the third moments with a vector
static dem_sym3 third_apply(const double t[10], dem_vec3 c)
{
    return (dem_sym3){t[0] * c.x + t[1] * c.y + t[2] * c.z, t[3] * c.x + t[6] * c.y + t[7] * c.z,
                      t[5] * c.x + t[8] * c.y + t[9] * c.z, t[1] * c.x + t[3] * c.y + t[4] * c.z,
                      t[2] * c.x + t[4] * c.y + t[5] * c.z, t[4] * c.x + t[7] * c.y + t[8] * c.z};
}

// volume moments of one patch: 1/3, 1/4, 1/5 of oint (1, x, x x) (x.n), x = c + r n
static void moments_add(dem_moments *m, const dem_patch *p, dem_vec3 c, double r)
{
    double cn = v3_dot(c, p->first), r2 = r * r, flux = cn + r * p->area;
    dem_vec3 sc = sym3_apply(p->second, c);
    m->volume += r2 / 3 * flux;
    dem_vec3 first = v3_along(v3_along(v3_scale(c, flux), r, sc), r2, p->first);
    m->first = v3_along(m->first, r2 / 4, first);
    dem_sym3 second = sym3_scale(sym3_outer(c), flux);
    second = sym3_add(second, sym3_scale(sym3_pair(c, v3_along(v3_scale(sc, r), r2, p->first)), 2));
    second = sym3_add(second, sym3_scale(third_apply(p->third, c), r2));
    second = sym3_add(second, sym3_scale(p->second, r2 * r));
    m->second = sym3_add(m->second, sym3_scale(second, r2 / 5));
}

// moments about another origin: the old origin lies at `at` of the new frame
static dem_moments moments_shift(dem_moments m, dem_vec3 at)
{
    dem_moments out = m;
    out.first = v3_along(m.first, m.volume, at);
    out.second = sym3_add(m.second, sym3_scale(sym3_pair(at, m.first), 2));
    out.second = sym3_add(out.second, sym3_scale(sym3_outer(at), m.volume));
    return out;
}

// The boundary closes: oint n = 0 and oint x n = V 1, to `CLOSURE` of their size.
static bool boundary_closes(const dem_ball *balls, const dem_patch *patches, size_t count, dem_vec3 origin,
                            double volume, double area)
{
    dem_vec3 n = {0}, rows[3] = {{-volume, 0, 0}, {0, -volume, 0}, {0, 0, -volume}};
    double size = 0;
    for (size_t i = 0; i < count; i++) {
        const dem_patch *p = &patches[i];
        dem_vec3 c = v3_sub(balls[i].centre, origin);
        double r = balls[i].radius;
        dem_vec3 flux = v3_scale(p->first, r * r);
        dem_sym3 s = sym3_scale(p->second, r * r * r);
        n = v3_add(n, flux);
        rows[0] = v3_add(v3_along(rows[0], c.x, flux), v3(s.xx, s.xy, s.xz));
        rows[1] = v3_add(v3_along(rows[1], c.y, flux), v3(s.xy, s.yy, s.yz));
        rows[2] = v3_add(v3_along(rows[2], c.z, flux), v3(s.xz, s.yz, s.zz));
        size = fmax(size, v3_norm(c) + r);
    }
    double open = v3_norm(n) * size + v3_norm(rows[0]) + v3_norm(rows[1]) + v3_norm(rows[2]);
    return open <= CLOSURE * area * size;
}

dem_status dem_balls_check(const dem_ball *balls, size_t count, dem_error *error)
{
    for (size_t i = 0; i < count; i++) {
        dem_vec3 c = balls[i].centre;
        double r = balls[i].radius;
        if (!(r > 0) || !isfinite(r) || !isfinite(v3_norm2(c)))
            return dem_fail(error, DEM_USAGE,
                            "sphere %zu is (%g, %g, %g) with radius %g; give finite centres and positive radii", i + 1,
                            c.x, c.y, c.z, r);
    }
    return DEM_OK;
}

// all patches, and with them the creases if they are wanted; *doubt is that of the worst one
static bool patches_and_creases(const dem_ball_tree *tree, bool want_arcs, dem_ball_union *result, double *doubt)
{
    rooms room = {0};
    dem_patch_work *w = dem_patch_work_create(tree);
    bool done = w != NULL;
    for (uint32_t i = 0; done && i < tree->boxes.count; i++) {
        done = dem_patch_compute(w, i, &result->patches[i]) && (!want_arcs || creases_export(w, i, result, &room));
        *doubt = fmax(*doubt, dem_patch_doubt(w));
    }
    dem_patch_work_destroy(w);
    return done;
}

static bool patches_by_threads(const dem_ball_tree *tree, int threads, dem_patch *patches, double *doubt)
{
    bool done = true;
    double most = 0;
#pragma omp parallel num_threads(threads) reduction(&& : done) reduction(max : most)
    {
        dem_patch_work *w = dem_patch_work_create(tree);
        done = w != NULL;
#pragma omp for schedule(dynamic, PATCHES_AT_ONCE)
        for (uint32_t i = 0; i < tree->boxes.count; i++) {
            done = done && dem_patch_compute(w, i, &patches[i]);
            most = done ? fmax(most, dem_patch_doubt(w)) : most;
        }
        dem_patch_work_destroy(w);
    }
    *doubt = most;
    return done;
}

static bool union_compute(const dem_ball_tree *tree, bool want_arcs, int threads, dem_ball_union *result)
{
    const dem_ball *balls = tree->balls;
    size_t count = tree->boxes.count;
    *result = (dem_ball_union){.patches = dem_alloc(count, sizeof *result->patches)};
    if (want_arcs)
        result->cap_start = dem_alloc_zero(count + 1, sizeof *result->cap_start);
    if (!result->patches || (want_arcs && !result->cap_start))
        return false;
    double doubt = 0;
    bool alone = want_arcs || threads < 2 || count < FEW_PATCHES;
    if (alone ? !patches_and_creases(tree, want_arcs, result, &doubt)
              : !patches_by_threads(tree, threads, result->patches, &doubt))
        return false;
    dem_vec3 origin = {0};
    for (size_t i = 0; i < count; i++)
        origin = v3_along(origin, 1.0 / (double)count, balls[i].centre);
    dem_moments moments = {0};
    for (size_t i = 0; i < count; i++) {
        const dem_patch *p = &result->patches[i];
        double r = balls[i].radius;
        moments_add(&moments, p, v3_sub(balls[i].centre, origin), r);
        result->area += r * r * p->area;
        result->redundant += p->area == 0;
    }
    result->consistent =
        doubt <= CLOSURE && boundary_closes(balls, result->patches, count, origin, moments.volume, result->area);
    result->moments = moments_shift(moments, origin);
    return true;
}

// moves every ball by `size` of its radius
static void shake(const dem_ball *balls, size_t count, double size, dem_ball *shaken)
{
    for (size_t i = 0; i < count; i++) {
        dem_random r = random_stream(0, i);
        double step = size * balls[i].radius, x = random_uniform(&r), y = random_uniform(&r), z = random_uniform(&r);
        shaken[i].centre = v3_along(balls[i].centre, step, v3(2 * x - 1, 2 * y - 1, 2 * z - 1));
        shaken[i].radius = balls[i].radius + step * random_uniform(&r);
    }
}

dem_status dem_ball_union_compute(const dem_ball *balls, size_t count, bool want_arcs, int threads,
                                  dem_ball_union *result, dem_error *error)
{
    dem_ball_tree tree;
    dem_ball *shaken = NULL;
    *result = (dem_ball_union){0};
    DEM_TRY(dem_ball_tree_build(&tree, balls, count, error));
    bool done = union_compute(&tree, want_arcs, threads, result);
    // only many circles that touch in one point get here: their ends are known to 1e-8 and no better
    if (done && !result->consistent && (shaken = dem_alloc(count, sizeof *shaken)) != NULL) {
        dem_ball_union_release(result);
        shake(balls, count, SHAKE, shaken);
        tree.balls = shaken;
        done = union_compute(&tree, want_arcs, threads, result);
    }
    dem_ball_tree_release(&tree);
    free(shaken);
    if (done)
        return DEM_OK;
    dem_ball_union_release(result);
    return dem_fail_memory(error);
}

void dem_ball_union_release(dem_ball_union *result)
{
    free(result->patches);
    free(result->arcs);
    free(result->caps);
    free(result->cap_start);
    *result = (dem_ball_union){0};
}

static uint32_t piece_root(uint32_t *parent, uint32_t i)
{
    while (parent[i] != i)
        i = parent[i] = parent[parent[i]];
    return i;
}

size_t dem_ball_pieces(const dem_ball *balls, size_t count, double margin, uint32_t *piece)
{
    dem_ball_tree tree;
    if (dem_ball_tree_build(&tree, balls, count, NULL) != DEM_OK)
        return 0;
    uint32_t *near = dem_alloc(count, sizeof *near), *parent = dem_alloc(count, sizeof *parent);
    size_t pieces = 0;
    if (!near || !parent)
        goto done;
    for (uint32_t i = 0; i < count; i++)
        parent[i] = i;
    pieces = count;
    for (uint32_t i = 0; i < count; i++) {
        size_t found = dem_ball_tree_near(&tree, balls[i], -margin, near);
        for (size_t k = 0; k < found; k++) {
            uint32_t a = piece_root(parent, i), b = piece_root(parent, near[k]);
            pieces -= a != b;
            parent[a > b ? a : b] = a > b ? b : a;
        }
    }
    for (uint32_t i = 0; piece && i < count; i++)
        piece[i] = piece_root(parent, i);
done:
    free(near);
    free(parent);
    dem_ball_tree_release(&tree);
    return pieces;
}
