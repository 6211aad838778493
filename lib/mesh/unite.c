// The outline of a surface that crosses itself (after Zhou, Grinspun, Zorin & Jacobson 2016): cut all triangles
// where they meet, so that the winding number is the same all over each side of a patch; find it by rays; keep
// the patches with the solid on one side only.
#include "mesh/unite.h"

#include <stdlib.h>
#include <string.h>

#include "mesh/cgal.h"
#include "mesh/surface.h"
#include "mesh/weld.h"

enum { SEEDS = 3, DIRECTIONS = 5 };

static const double MOST_TANGLE = 5e5;  // some 10 s; a few dozen overlapping shells of thousands of triangles have less

typedef struct ray {
    const int *layers;
    uint32_t own;
    int winding;
} ray;

static void pass(void *user, uint32_t triangle, int leaving, double t)
{
    (void)t;
    ray *r = user;
    if (triangle != r->own)
        r->winding += leaving * r->layers[triangle];
}

// the winding number in front of a triangle, as one ray sees it; false where the ray is too flat
static bool winding_in_front(const dem_tree *tree, const int *layers, uint32_t triangle, dem_vec3 d, int *winding)
{
    const uint32_t *v = tree->triangles + 3 * (size_t)triangle;
    dem_vec3 a = tree->vertices[v[0]], b = tree->vertices[v[1]], c = tree->vertices[v[2]];
    dem_vec3 n = v3_unit(v3_cross(v3_sub(b, a), v3_sub(c, a)));
    if (fabs(v3_dot(n, d)) < 0.25)
        return false;
    ray r = {.layers = layers, .own = triangle};
    dem_tree_ray(tree, v3_scale(v3_add(a, v3_add(b, c)), 1.0 / 3), d, pass, &r);
    *winding = v3_dot(n, d) > 0 ? r.winding : r.winding - layers[triangle];
    return true;
}

// most frequent answer of rays from the largest triangles of a patch
static int patch_winding(const dem_tree *tree, const int *layers, const uint32_t seeds[SEEDS])
{
    static const dem_vec3 directions[DIRECTIONS] = {{0.5131, 0.6217, 0.5917},
                                                    {-0.7219, 0.3911, 0.5711},
                                                    {0.1917, -0.8317, 0.5219},
                                                    {0.9173, 0.3119, -0.2471},
                                                    {-0.3371, 0.1193, -0.9337}};
    int votes[SEEDS * DIRECTIONS], count = 0, best = 0, most = 0;
    for (int i = 0; i < SEEDS && seeds[i] != UINT32_MAX; i++)
        for (int k = 0; k < DIRECTIONS; k++)
            count += winding_in_front(tree, layers, seeds[i], directions[k], &votes[count]);
    for (int i = 0; i < count; i++) {
        int same = 0;
        for (int k = 0; k < count; k++)
            same += votes[k] == votes[i];
        if (same > most) {
            most = same;
            best = votes[i];
        }
    }
    return best;
}

// the SEEDS largest triangles of each patch, largest first
static uint32_t (*largest_triangles(const dem_surface *s))[SEEDS]
{
    uint32_t(*seeds)[SEEDS] = dem_alloc(s->patch_count, sizeof *seeds);
    if (!seeds)
        return NULL;
    memset(seeds, 0xff, s->patch_count * sizeof *seeds);
    for (uint32_t t = 0; t < s->mesh->triangle_count; t++) {
        uint32_t *best = seeds[s->patch[t]], at = SEEDS;
        double area = dem_triangle_area(s->mesh, t);
        while (at > 0 && (best[at - 1] == UINT32_MAX || dem_triangle_area(s->mesh, best[at - 1]) < area))
            at--;
        if (at == SEEDS)
            continue;
        memmove(best + at + 1, best + at, (SEEDS - 1 - at) * sizeof *best);
        best[at] = t;
    }
    return seeds;
}

// keeps the triangles with the solid on one side, turned so that it lies behind them
static dem_status select_outline(dem_surface *s, const int *layers, bool *changed, dem_error *error)
{
    dem_mesh *mesh = s->mesh;
    dem_tree tree;
    DEM_TRY(dem_tree_build(&tree, mesh->vertices, mesh->triangles, mesh->triangle_count, error));
    uint32_t(*seeds)[SEEDS] = largest_triangles(s);
    unsigned char *verdict = dem_alloc(s->patch_count, 1), *drop = dem_alloc(mesh->triangle_count, 1);
    unsigned char *flip = dem_alloc(mesh->triangle_count, 1);
    enum { KEEP, FLIP, DROP };
    bool fine = seeds && verdict && drop && flip;
    for (size_t i = 0; fine && i < s->patch_count; i++) {
        int front = patch_winding(&tree, layers, seeds[i]), back = front + layers[seeds[i][0]];
        verdict[i] = (front != 0) == (back != 0) ? DROP : front != 0 ? FLIP : KEEP;
        *changed |= verdict[i] != KEEP;
    }
    dem_tree_release(&tree);
    for (size_t t = 0; fine && t < mesh->triangle_count; t++) {
        flip[t] = verdict[s->patch[t]] == FLIP;
        drop[t] = verdict[s->patch[t]] == DROP;
    }
    if (fine) {
        dem_surface_flip(s, flip);
        dem_mesh_drop(mesh, drop);
    }
    free(seeds);
    free(verdict);
    free(drop);
    free(flip);
    return fine ? DEM_OK : dem_fail_memory(error);
}

static dem_status outline(dem_mesh *mesh, bool *changed, dem_error *error)
{
    dem_surface surface = {0};
    int *layers = dem_alloc(mesh->triangle_count, sizeof *layers);
    dem_status status = DEM_OK;
    size_t count = mesh->triangle_count;
    if (!layers || !dem_mesh_merge_layers(mesh, layers)) {
        status = dem_fail_memory(error);
        goto done;
    }
    *changed = mesh->triangle_count < count;
    status = dem_surface_build(&surface, mesh, error);
    if (status == DEM_OK)
        status = select_outline(&surface, layers, changed, error);
    if (status == DEM_OK)
        status = dem_surface_build(&surface, mesh, error);
    if (status == DEM_OK && (surface.edges.border || dem_surface_unbalanced(&surface)))
        status = dem_fail(error, DEM_FAILED, "the outline of the crossing surfaces does not close; use --repair wrap");
done:
    free(layers);
    dem_surface_release(&surface);
    return status;
}

// pairs, each counted as often as the less cut of its two triangles is cut: the lines that may cross on one triangle
static dem_status measure_tangle(const dem_mesh *mesh, const dem_crossings *crossings, double *tangle, dem_error *error)
{
    uint32_t *cuts = dem_alloc_zero(mesh->triangle_count, sizeof *cuts);
    if (!cuts)
        return dem_fail_memory(error);
    for (size_t i = 0; i < crossings->count; i++)
        for (int k = 0; k < 2; k++)
            cuts[crossings->pairs[i][k]]++;
    *tangle = 0;
    for (size_t i = 0; i < crossings->count; i++) {
        uint32_t a = cuts[crossings->pairs[i][0]], b = cuts[crossings->pairs[i][1]];
        *tangle += a < b ? a : b;
    }
    free(cuts);
    return DEM_OK;
}

dem_status dem_mesh_unite(dem_mesh *mesh, const dem_crossings *crossings, bool *changed, dem_error *error)
{
    *changed = false;
    dem_mesh pieces;
    size_t unused;
    double tangle = 0;
    DEM_TRY(measure_tangle(mesh, crossings, &tangle, error));
    if (tangle > MOST_TANGLE)
        return dem_fail(error, DEM_FAILED, "too tangled to take apart; use --repair wrap");
    DEM_TRY(dem_mesh_refine(mesh, (const uint32_t(*)[2])crossings->pairs, crossings->count, &pieces, error));
    pieces.single_precision = mesh->single_precision;
    dem_status status = dem_mesh_weld_equal(&pieces, &unused, error);
    if (status == DEM_OK) {
        dem_mesh_drop_collapsed(&pieces);
        status = outline(&pieces, changed, error);
    }
    if (status == DEM_OK && *changed)
        status = dem_mesh_compact(&pieces, &unused, error);
    if (status == DEM_OK && *changed) {
        dem_mesh_free(mesh);
        *mesh = pieces;
    } else {
        dem_mesh_free(&pieces);
    }
    return status;
}
