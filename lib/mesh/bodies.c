#include "mesh/bodies.h"

#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/sets.h"

void dem_mesh_bodies_release(dem_mesh_bodies *bodies)
{
    free(bodies->of);
    free(bodies->volume);
    *bodies = (dem_mesh_bodies){0};
}

typedef struct body_rank {
    double volume;
    uint32_t shell;  // that stands for the body
} body_rank;

static int by_volume(const void *pa, const void *pb)
{
    const body_rank *a = pa, *b = pb;
    if (a->volume != b->volume)
        return a->volume > b->volume ? -1 : 1;
    return (a->shell > b->shell) - (a->shell < b->shell);
}

static void join_shells(const dem_shells *shells, const dem_mesh *mesh, uint32_t *parent, uint32_t *owner)
{
    sets_init(parent, shells->count);
    memset(owner, 0xff, mesh->vertex_count * sizeof *owner);
    for (size_t i = 0; i < 3 * mesh->triangle_count; i++) {
        uint32_t *first = &owner[mesh->triangles[i]], shell = shells->of[i / 3];
        if (*first == UINT32_MAX)
            *first = shell;
        else if (*first != shell)
            sets_join(parent, *first, shell);
    }
    for (uint32_t i = 0; i < shells->count; i++)
        if (shells->list[i].volume < 0)
            sets_join(parent, i, dem_shell_innermost(shells, i));
}

dem_status dem_mesh_bodies_find(dem_mesh_bodies *bodies, const dem_shells *shells, const dem_mesh *mesh,
                                dem_error *error)
{
    size_t count = shells->count;
    *bodies = (dem_mesh_bodies){.of = dem_alloc(count, sizeof *bodies->of), .volume = dem_alloc(count, sizeof(double))};
    uint32_t *parent = dem_alloc(count, sizeof *parent), *owner = dem_alloc(mesh->vertex_count, sizeof *owner);
    body_rank *rank = dem_alloc_zero(count, sizeof *rank);
    bool fine = bodies->of && bodies->volume && parent && owner && rank;
    if (fine) {
        join_shells(shells, mesh, parent, owner);
        for (uint32_t i = 0; i < count; i++) {
            rank[i].shell = i;
            rank[sets_root(parent, i)].volume += shells->list[i].volume;
        }
        size_t roots = 0;
        for (uint32_t i = 0; i < count; i++)
            if (parent[i] == i)
                rank[roots++] = rank[i];
        qsort(rank, roots, sizeof *rank, by_volume);
        for (size_t i = 0; i < roots; i++) {
            bodies->volume[i] = rank[i].volume;
            bodies->of[rank[i].shell] = (uint32_t)i;
        }
        bodies->count = roots;
        for (uint32_t i = 0; i < count; i++)
            bodies->of[i] = bodies->of[sets_root(parent, i)];
    }
    free(parent);
    free(owner);
    free(rank);
    if (!fine)
        dem_mesh_bodies_release(bodies);
    return fine ? DEM_OK : dem_fail_memory(error);
}

// one mesh per body, in one pass: no vertex is in two bodies
static bool copy_bodies(const dem_mesh *mesh, const dem_shells *shells, const dem_mesh_bodies *bodies, dem_mesh *parts)
{
    uint32_t *number = dem_alloc(mesh->vertex_count, sizeof *number);
    if (!number)
        return false;
    memset(number, 0xff, mesh->vertex_count * sizeof *number);
    for (size_t i = 0; i < 3 * mesh->triangle_count; i++) {
        dem_mesh *part = &parts[bodies->of[shells->of[i / 3]]];
        part->triangle_count += i % 3 == 0;
        if (number[mesh->triangles[i]] == UINT32_MAX)
            number[mesh->triangles[i]] = (uint32_t)part->vertex_count++;
    }
    bool fine = true;
    for (size_t i = 0; i < bodies->count; i++) {
        parts[i].single_precision = mesh->single_precision;
        parts[i].vertices = dem_alloc(parts[i].vertex_count, sizeof *parts[i].vertices);
        parts[i].triangles = dem_alloc(parts[i].triangle_count, 3 * sizeof *parts[i].triangles);
        fine = fine && parts[i].vertices && parts[i].triangles;
        parts[i].triangle_count = 0;
    }
    for (size_t t = 0; fine && t < mesh->triangle_count; t++) {
        dem_mesh *part = &parts[bodies->of[shells->of[t]]];
        for (size_t k = 0; k < 3; k++) {
            uint32_t v = mesh->triangles[3 * t + k];
            part->triangles[3 * part->triangle_count + k] = number[v];
            part->vertices[number[v]] = mesh->vertices[v];
        }
        part->triangle_count++;
    }
    free(number);
    return fine;
}

dem_status dem_mesh_split(const dem_mesh *mesh, dem_mesh **list, size_t *count, dem_error *error)
{
    *list = NULL;
    *count = 0;
    dem_surface surface = {0};
    dem_shells shells = {0};
    dem_mesh_bodies bodies = {0};
    dem_mesh view = *mesh;
    dem_status status = dem_surface_build(&surface, &view, error);
    if (status == DEM_OK)
        status = dem_shells_find(&shells, &surface, error);
    if (status == DEM_OK)
        status = dem_shells_nest(&shells, mesh, error);
    if (status == DEM_OK)
        status = dem_mesh_bodies_find(&bodies, &shells, mesh, error);
    dem_mesh *parts = status == DEM_OK ? dem_alloc_zero(bodies.count, sizeof *parts) : NULL;
    if (status == DEM_OK && (!parts || !copy_bodies(mesh, &shells, &bodies, parts)))
        status = dem_fail_memory(error);
    if (status == DEM_OK) {
        *list = parts;
        *count = bodies.count;
    } else if (parts) {
        for (size_t i = 0; i < bodies.count; i++)
            dem_mesh_free(&parts[i]);
        free(parts);
    }
    dem_surface_release(&surface);
    dem_shells_release(&shells);
    dem_mesh_bodies_release(&bodies);
    return status;
}
