#include "clump/pack_candidates.h"

#include <stdlib.h>

enum { SHRINKS = 12, POINT_SHRINKS = 6, SPARSE_POINTS = 1024 };
// Near the middle of a round grain all of its surface is as near: what is found so far has to do then.
enum { MOST_LEAVES = 500 };

static const double largest_radius = 0.6;        // a little more than that of the sphere of equal volume [d_eq]
static const double smallest_candidate = 0.01;   // [d_eq]

// Surface deeper than this inside a ball shrinks it, in radii. Without it every triangle of a fine round grain would.
static const double tolerance = 2e-3;

// The ball of radius r that touches p has its centre at p - r n. The one through s as well has r = e.e / (2 n.e), where
// e = p - s.
static double shrink(double r, dem_vec3 p, dem_vec3 n, dem_vec3 a, dem_vec3 b, dem_vec3 c)
{
    for (int i = 0; i < SHRINKS; i++) {
        dem_vec3 centre = v3_along(p, -r, n);
        dem_vec3 s = dem_triangle_closest(centre, a, b, c), e = v3_sub(p, s);
        double free = r * (1 - tolerance), low = 2 * v3_dot(n, e);
        if (v3_norm2(v3_sub(s, centre)) >= free * free || low <= 1e-12)
            break;
        double next = v3_norm2(e) / low;
        if (next >= r * (1 - 1e-6))
            break;
        r = next;
    }
    return r;
}

// Shrinking ball (Ma, Bae & Choi 2012) in a single traversal: the balls are nested, so what one of them does not
// reach none of the later ones does.
static double shrink_in_tree(const dem_tree *tree, dem_vec3 p, dem_vec3 n, double r)
{
    uint32_t stack[DEM_BOX_TREE_STACK];
    int top = 0, leaves = 0;
    stack[top++] = 0;
    while (top && leaves < MOST_LEAVES) {
        uint32_t at = stack[--top];
        const dem_tree_node *node = &tree->nodes[at];
        dem_vec3 centre = v3_along(p, -r, n);
        double free = r * (1 - tolerance);
        if (box_distance2(&node->box, centre) >= free * free)
            continue;
        if (node->right) {
            uint32_t left = at + 1, right = node->right;
            bool left_first = box_distance2(&tree->nodes[left].box, centre) < box_distance2(&tree->nodes[right].box, centre);
            stack[top++] = left_first ? right : left;
            stack[top++] = left_first ? left : right;
            continue;
        }
        leaves++;
        for (uint32_t i = node->begin; i < node->end; i++) {
            const uint32_t *t = tree->triangles + 3 * (size_t)tree->order[i];
            r = shrink(r, p, n, tree->vertices[t[0]], tree->vertices[t[1]], tree->vertices[t[2]]);
        }
    }
    return r;
}

double dem_medial_radius(const dem_tree *tree, dem_vec3 p, dem_vec3 n)
{
    return shrink_in_tree(tree, p, n, largest_radius);
}

// Shrinks to some of the samples that lie deepest inside, one after the other: what is left for the tree is a ball
// hardly too large, which meets few of its boxes.
static double shrink_to_points(const dem_pack_kernels *kernels, const dem_point_columns *points, dem_vec3 p, dem_vec3 n)
{
    const float at[3] = {(float)p.x, (float)p.y, (float)p.z}, out[3] = {(float)n.x, (float)n.y, (float)n.z};
    double r = largest_radius;
    for (int i = 0; i < POINT_SHRINKS; i++) {
        float least = (float)(r * r * (1 - (1 - tolerance) * (1 - tolerance))), touching;
        if (!kernels->deepest(points, at, out, (float)(2 * r), least, &touching))
            break;
        r = fmin(r, (double)touching);
    }
    // the points are rounded
    return fmin(largest_radius, r * (1 + tolerance));
}

typedef struct touching {
    dem_vec3 point, normal;
    double radius;
    uint32_t block;
} touching;

static void shell_corners(const void *surface, size_t triangle, dem_vec3 corners[3])
{
    const dem_mesh *shell = surface;
    for (size_t k = 0; k < 3; k++)
        corners[k] = shell->vertices[shell->triangles[3 * triangle + k]];
}

static void keep_touching(void *user, size_t number, dem_vec3 point, dem_vec3 normal)
{
    ((touching *)user)[number] = (touching){.point = point, .normal = normal};
}

static double shell_area(const dem_mesh *shell)
{
    double area = 0;
    for (size_t t = 0; t < shell->triangle_count; t++) {
        dem_vec3 c[3];
        shell_corners(shell, t, c);
        area += v3_norm(v3_cross(v3_sub(c[1], c[0]), v3_sub(c[2], c[0]))) / 2;
    }
    return area;
}

static uint32_t nearest_block(const dem_samples *samples, dem_vec3 p)
{
    uint32_t best = 0;
    float least = INFINITY, x = (float)p.x, y = (float)p.y, z = (float)p.z;
    for (size_t b = 0; b < samples->surface_blocks; b++) {
        float dx = samples->bounds[b].x - x, dy = samples->bounds[b].y - y, dz = samples->bounds[b].z - z;
        float d = dx * dx + dy * dy + dz * dz;
        if (d < least) {
            least = d;
            best = (uint32_t)b;
        }
    }
    return best;
}

// counting sort by block
static dem_status sort_by_block(const touching *points, size_t count, size_t blocks, dem_candidates *candidates,
                                dem_error *error)
{
    candidates->balls = dem_alloc(count, sizeof *candidates->balls);
    candidates->at_block = dem_alloc_zero(blocks + 2, sizeof *candidates->at_block);
    if (!candidates->balls || !candidates->at_block)
        return dem_fail_memory(error);
    uint32_t *start = candidates->at_block;
    for (size_t i = 0; i < count; i++)
        if (points[i].radius > smallest_candidate)
            start[points[i].block + 2]++;
    for (size_t b = 2; b < blocks + 2; b++)
        start[b] += start[b - 1];
    for (size_t i = 0; i < count; i++)
        if (points[i].radius > smallest_candidate)
            candidates->balls[start[points[i].block + 1]++] =
                (dem_ball){v3_along(points[i].point, -points[i].radius, points[i].normal), points[i].radius};
    candidates->count = start[blocks];
    return DEM_OK;
}

// evenly out of all blocks
static bool take_sparse(const dem_samples *samples, dem_point_columns *few)
{
    size_t all = samples->surface_blocks * DEM_BLOCK, step = all / SPARSE_POINTS + 1;
    few->count = all / step / DEM_LANES * DEM_LANES;
    few->x = dem_alloc(3 * few->count, sizeof *few->x);
    if (!few->x)
        return false;
    few->y = few->x + few->count;
    few->z = few->y + few->count;
    for (size_t k = 0; k < few->count; k++) {
        const dem_sample_block *block = &samples->blocks[k * step / DEM_BLOCK];
        size_t l = k * step % DEM_BLOCK;
        few->x[k] = block->x[l];
        few->y[k] = block->y[l];
        few->z[k] = block->z[l];
    }
    return true;
}

dem_status dem_candidates_build(const dem_pack_grain *grain, const dem_samples *samples,
                                const dem_pack_kernels *kernels, size_t count, int threads,
                                dem_candidates *candidates, dem_error *error)
{
    *candidates = (dem_candidates){0};
    const dem_mesh *shell = &grain->shell;
    touching *points = dem_alloc_zero(count, sizeof *points);
    if (!points)
        return dem_fail_memory(error);
    dem_point_columns few;
    if (!take_sparse(samples, &few)) {
        free(points);
        return dem_fail_memory(error);
    }
    dem_surface_spread(shell_corners, shell, shell->triangle_count, shell_area(shell), count, keep_touching, points);
#pragma omp parallel for num_threads(threads) schedule(dynamic, 64)
    for (size_t i = 0; i < count; i++) {
        double r = shrink_to_points(kernels, &few, points[i].point, points[i].normal);
        points[i].radius = shrink_in_tree(&grain->tree, points[i].point, points[i].normal, r);
        points[i].block = nearest_block(samples, points[i].point);
    }
    dem_status status = sort_by_block(points, count, samples->surface_blocks, candidates, error);
    free(points);
    free(few.x);
    if (status != DEM_OK)
        dem_candidates_release(candidates);
    return status;
}

void dem_candidates_release(dem_candidates *candidates)
{
    free(candidates->balls);
    free(candidates->at_block);
    *candidates = (dem_candidates){0};
}

typedef struct offer {
    dem_ball ball;
    int64_t gain;     // or more, as others have been taken
    int64_t now;      // the gain when there were `taken` others
    uint32_t taken;
} offer;

// a heap whose first offer has the largest gain
static void sink(offer *heap, size_t count, size_t at)
{
    offer moving = heap[at];
    for (size_t child; (child = 2 * at + 1) < count; at = child) {
        if (child + 1 < count && heap[child + 1].gain > heap[child].gain)
            child++;
        if (heap[child].gain <= moving.gain)
            break;
        heap[at] = heap[child];
    }
    heap[at] = moving;
}

enum { OFFERS_AT_ONCE = 64, NEXT = 6 };

// what the crew shares: offers whose gains are to be computed
typedef struct offers {
    offer *heap;
    size_t count;
    uint32_t taken;
    size_t next[NEXT];
    dem_lattice *lattice;
    const dem_pack_kernels *kernels;
} offers;

static void compute_gains(void *user, int part)
{
    const offers *o = user;
    size_t end = ((size_t)part + 1) * OFFERS_AT_ONCE;
    for (size_t i = (size_t)part * OFFERS_AT_ONCE; i < end && i < o->count; i++)
        o->heap[i].gain = o->heap[i].now = o->kernels->lattice_gain(o->lattice, o->heap[i].ball, NULL);
}

static void compute_next(void *user, int part)
{
    const offers *o = user;
    offer *one = &o->heap[o->next[part]];
    if (one->taken == o->taken)
        return;
    one->now = o->kernels->lattice_gain(o->lattice, one->ball, NULL);
    one->taken = o->taken;
}

// the offers that come to the top one after the other if each of them sinks far enough
static int list_next(offers *o, int most)
{
    size_t open[NEXT + 2] = {0};
    int count = 0, open_count = 1;
    while (count < most && open_count > 0) {
        int best = 0;
        for (int k = 1; k < open_count; k++)
            best = o->heap[open[k]].gain > o->heap[open[best]].gain ? k : best;
        size_t at = open[best], child = 2 * at + 1;
        o->next[count++] = at;
        open[best] = open[--open_count];
        for (size_t k = child; k < child + 2 && k < o->count; k++)
            open[open_count++] = k;
    }
    return count;
}

// Lazy greedy (Minoux 1978): a gain is only computed again when its offer comes to the top; where others help, those of
// the offers that may come there next at the same time.
static size_t take_best(offers *o, dem_crew *crew, size_t most, dem_ball *chosen)
{
    offer *heap = o->heap;
    for (size_t i = o->count / 2; i-- > 0;)
        sink(heap, o->count, i);
    while (o->taken < most && o->count > 0) {
        if (heap[0].taken != o->taken)
            dem_crew_run(crew, list_next(o, crew ? NEXT : 1), compute_next, o);
        if (heap[0].now < heap[0].gain) {
            heap[0].gain = heap[0].now;
            sink(heap, o->count, 0);
            continue;
        }
        if (heap[0].now <= 0)
            break;
        o->kernels->lattice_gain(o->lattice, heap[0].ball, o->lattice->covered);
        chosen[o->taken++] = heap[0].ball;
        heap[0] = heap[--o->count];
        sink(heap, o->count, 0);
    }
    return o->taken;
}

dem_status dem_candidates_greedy(const dem_candidates *candidates, dem_lattice *lattice,
                                 const dem_pack_kernels *kernels, const double *inflations, size_t inflation_count,
                                 size_t most, dem_crew *crew, dem_ball *chosen, size_t *chosen_count,
                                 dem_error *error)
{
    size_t count = candidates->count * inflation_count;
    offers o = {.heap = dem_alloc(count, sizeof *o.heap), .count = count, .lattice = lattice, .kernels = kernels};
    if (!o.heap)
        return dem_fail_memory(error);
    dem_lattice_clear(lattice);
    for (size_t i = 0; i < count; i++) {
        o.heap[i] = (offer){.ball = candidates->balls[i / inflation_count]};
        o.heap[i].ball.radius += inflations[i % inflation_count];
    }
    int parts = (int)((count + OFFERS_AT_ONCE - 1) / OFFERS_AT_ONCE);
    dem_crew_run(crew, parts, compute_gains, &o);
    *chosen_count = take_best(&o, crew, most, chosen);
    free(o.heap);
    return DEM_OK;
}
