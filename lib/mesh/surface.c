#include "mesh/surface.h"

#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "math/vec.h"

double dem_triangle_area(const dem_mesh *mesh, size_t triangle)
{
    const uint32_t *t = mesh->triangles + 3 * triangle;
    dem_vec3 a = mesh->vertices[t[0]];
    return v3_norm(v3_cross(v3_sub(mesh->vertices[t[1]], a), v3_sub(mesh->vertices[t[2]], a))) / 2;
}

void dem_surface_release(dem_surface *surface)
{
    dem_edges_release(&surface->edges);
    free(surface->patch);
    free(surface->patches);
    *surface = (dem_surface){0};
}

static bool has_twin(const dem_edges *edges, uint32_t half)
{
    return edges->twin[half] < DEM_EDGE_MANY;
}

// gives the triangles reachable from `seed` the number `id`
static void flood_patch(dem_surface *s, uint32_t seed, uint32_t id, uint32_t *stack)
{
    dem_patch *patch = &s->patches[id];
    size_t top = 0;
    stack[top++] = seed;
    s->patch[seed] = id;
    while (top) {
        uint32_t t = stack[--top];
        patch->triangles++;
        patch->area += dem_triangle_area(s->mesh, t);
        for (uint32_t h = 3 * t; h < 3 * t + 3; h++) {
            patch->border += s->edges.twin[h] == DEM_EDGE_BORDER;
            patch->many += s->edges.twin[h] == DEM_EDGE_MANY;
            if (!has_twin(&s->edges, h) || s->patch[s->edges.twin[h] / 3] != UINT32_MAX)
                continue;
            s->patch[s->edges.twin[h] / 3] = id;
            stack[top++] = s->edges.twin[h] / 3;
        }
    }
}

dem_status dem_surface_build(dem_surface *surface, dem_mesh *mesh, dem_error *error)
{
    dem_surface_release(surface);
    surface->mesh = mesh;
    DEM_TRY(dem_edges_build(&surface->edges, mesh, error));
    uint32_t *stack = dem_alloc(mesh->triangle_count, sizeof *stack);
    surface->patch = dem_alloc(mesh->triangle_count, sizeof *surface->patch);
    size_t room = 0;
    bool enough = stack && surface->patch;
    if (enough)
        memset(surface->patch, 0xff, mesh->triangle_count * sizeof *surface->patch);
    for (uint32_t t = 0; enough && t < mesh->triangle_count; t++) {
        if (surface->patch[t] != UINT32_MAX)
            continue;
        enough = dem_grow(&surface->patches, &room, surface->patch_count, sizeof *surface->patches);
        if (!enough)
            break;
        surface->patches[surface->patch_count] = (dem_patch){0};
        flood_patch(surface, t, (uint32_t)surface->patch_count, stack);
        surface->area += surface->patches[surface->patch_count++].area;
    }
    free(stack);
    return enough ? DEM_OK : dem_fail_memory(error);
}

// a flipped triangle has corners 0 and 1 exchanged: its sides 1 and 2 change places
static uint32_t flipped_half(uint32_t half, const unsigned char *flip)
{
    if (half >= DEM_EDGE_MANY || !flip[half / 3] || half % 3 == 0)
        return half;
    return half % 3 == 1 ? half + 1 : half - 1;
}

void dem_surface_flip(dem_surface *surface, const unsigned char *flip)
{
    dem_mesh *mesh = surface->mesh;
    dem_edges *edges = &surface->edges;
    for (size_t t = 0; t < mesh->triangle_count; t++) {
        if (!flip[t])
            continue;
        uint32_t *v = mesh->triangles + 3 * t, corner = v[0], *twin = edges->twin + 3 * t, half = twin[1];
        v[0] = v[1];
        v[1] = corner;
        twin[1] = twin[2];
        twin[2] = half;
    }
    for (size_t h = 0; h < 3 * mesh->triangle_count; h++)
        edges->twin[h] = flipped_half(edges->twin[h], flip);
    for (size_t i = 0; i < (edges->many ? edges->fan_start[edges->many] : 0); i++)
        edges->fan[i] = flipped_half(edges->fan[i], flip);
}

// marks in `turn` (2: not seen, 0 or 1: as it is or flipped) what makes the patch of `seed` agree with it
static size_t flood_turns(const dem_surface *s, uint32_t seed, unsigned char *turn, uint32_t *stack, size_t *conflicts)
{
    size_t top = 0, end = 1;
    stack[0] = seed;
    turn[seed] = 0;
    for (; top < end; top++) {
        uint32_t t = stack[top];
        for (uint32_t h = 3 * t; h < 3 * t + 3; h++) {
            if (!has_twin(&s->edges, h))
                continue;
            uint32_t twin = s->edges.twin[h], other = twin / 3;
            bool same_way = half_start(s->mesh, h) == half_start(s->mesh, twin);
            unsigned char want = turn[t] ^ (same_way ? 1 : 0);
            if (turn[other] == 2) {
                turn[other] = want;
                stack[end++] = other;
            } else {
                *conflicts += turn[other] != want && h < twin;
            }
        }
    }
    return end;
}

dem_status dem_surface_orient(dem_surface *surface, unsigned char *flipped, size_t *conflicts, dem_error *error)
{
    size_t count = surface->mesh->triangle_count;
    unsigned char *turn = dem_alloc(count, 1);
    uint32_t *stack = dem_alloc(count, sizeof *stack);
    *conflicts = 0;
    if (!turn || !stack) {
        free(turn);
        free(stack);
        return dem_fail_memory(error);
    }
    memset(turn, 2, count);
    for (uint32_t t = 0; t < count; t++) {
        if (turn[t] != 2)
            continue;
        size_t reached = flood_turns(surface, t, turn, stack, conflicts), turned = 0;
        for (size_t i = 0; i < reached; i++)
            turned += turn[stack[i]];
        if (2 * turned > reached)
            for (size_t i = 0; i < reached; i++)
                turn[stack[i]] ^= 1;
    }
    for (size_t t = 0; t < count; t++)
        flipped[t] ^= turn[t];
    dem_surface_flip(surface, turn);
    free(turn);
    free(stack);
    return DEM_OK;
}

size_t dem_surface_unbalanced(const dem_surface *s)
{
    size_t unbalanced = 0;
    for (uint32_t h = 0; h < 3 * s->mesh->triangle_count; h++)
        unbalanced += has_twin(&s->edges, h) && h < s->edges.twin[h] &&
                      half_start(s->mesh, h) == half_start(s->mesh, s->edges.twin[h]);
    for (size_t i = 0; i < s->edges.many; i++) {
        long net = 0;
        uint32_t from = half_start(s->mesh, s->edges.fan[s->edges.fan_start[i]]);
        for (size_t k = s->edges.fan_start[i]; k < s->edges.fan_start[i + 1]; k++)
            net += half_start(s->mesh, s->edges.fan[k]) == from ? 1 : -1;
        unbalanced += net != 0;
    }
    return unbalanced;
}
