#include "mesh/prune.h"

#include <stdlib.h>
#include <string.h>

#include "geom/tree.h"

static const double FIN_AREA = 0.5;     // a fin is less than this part of the area
static const double STRAY_AREA = 0.01;  // a stray too
static const double STRAYS_AREA = 0.02; // all of them together; more are the surface itself, in pieces

enum { SAMPLES = 12, RAYS = 26 };

static size_t mark_patches(const dem_surface *s, const unsigned char *chosen, unsigned char *drop)
{
    size_t count = 0;
    for (size_t t = 0; t < s->mesh->triangle_count; t++) {
        drop[t] = chosen[s->patch[t]];
        count += drop[t];
    }
    return count;
}

static bool is_fin(const dem_surface *s, const dem_patch *p)
{
    return p->border && p->many && p->area < FIN_AREA * s->area;
}

static bool is_stray(const dem_surface *s, const dem_patch *p)
{
    return p->border && !p->many && p->area < STRAY_AREA * s->area;
}

size_t dem_surface_mark_fins(const dem_surface *s, unsigned char *drop)
{
    double strays = 0;
    for (size_t i = 0; i < s->patch_count; i++)
        strays += is_stray(s, &s->patches[i]) ? s->patches[i].area : 0;
    size_t count = 0;
    for (size_t t = 0; t < s->mesh->triangle_count; t++) {
        const dem_patch *p = &s->patches[s->patch[t]];
        drop[t] = is_fin(s, p) || (strays < STRAYS_AREA * s->area && is_stray(s, p));
        count += drop[t];
    }
    return count;
}

typedef struct sight {
    uint32_t own;
    bool blocked;
} sight;

static void block(void *user, uint32_t triangle, int leaving, double t)
{
    (void)leaving, (void)t;
    sight *s = user;
    s->blocked |= triangle != s->own;
}

// does any ray from the middle of a triangle get away?
static bool is_seen(const dem_surface *s, const dem_tree *tree, uint32_t triangle)
{
    const uint32_t *v = s->mesh->triangles + 3 * (size_t)triangle;
    const dem_vec3 *p = s->mesh->vertices;
    dem_vec3 middle = v3_scale(v3_add(v3_add(p[v[0]], p[v[1]]), p[v[2]]), 1.0 / 3);
    for (int i = 0; i < RAYS; i++) {
        double z = 2 * (i + 0.5) / RAYS - 1, r = sqrt(1 - z * z), angle = i * (DEM_PI * (3 - sqrt(5)));
        sight look = {.own = triangle};
        dem_tree_ray(tree, middle, v3(r * cos(angle), r * sin(angle), z), block, &look);
        if (!look.blocked)
            return true;
    }
    return false;
}

dem_status dem_surface_mark_walls(const dem_surface *s, unsigned char *drop, size_t *count, dem_error *error)
{
    *count = 0;
    memset(drop, 0, s->mesh->triangle_count);
    unsigned char *hidden = dem_alloc_zero(s->patch_count, 1);
    size_t *looked = dem_alloc_zero(s->patch_count, sizeof *looked);
    dem_tree tree = {0};
    dem_status status = DEM_OK;
    if (!hidden || !looked) {
        status = dem_fail_memory(error);
        goto done;
    }
    status = dem_tree_build(&tree, s->mesh->vertices, s->mesh->triangles, s->mesh->triangle_count, error);
    if (status != DEM_OK)
        goto done;
    for (size_t i = 0; i < s->patch_count; i++)
        hidden[i] = s->patches[i].many && !s->patches[i].border;
    // some triangles of each, evenly spread in the order of the file
    for (uint32_t t = 0; t < s->mesh->triangle_count; t++) {
        uint32_t p = s->patch[t];
        if (hidden[p] && looked[p]++ % (1 + s->patches[p].triangles / SAMPLES) == 0)
            hidden[p] = !is_seen(s, &tree, t);
    }
    *count = mark_patches(s, hidden, drop);
done:
    free(hidden);
    free(looked);
    dem_tree_release(&tree);
    return status;
}
