#include "dem/mesh.h"

#include <stdlib.h>
#include <string.h>

#include "base/memory.h"

void dem_mesh_free(dem_mesh *mesh)
{
    free(mesh->vertices);
    free(mesh->triangles);
    *mesh = (dem_mesh){0};
}

dem_status dem_mesh_copy(const dem_mesh *from, dem_mesh *to, dem_error *error)
{
    dem_mesh copy = *from;
    copy.vertices = dem_alloc(from->vertex_count, sizeof *copy.vertices);
    copy.triangles = dem_alloc(from->triangle_count, 3 * sizeof *copy.triangles);
    *to = (dem_mesh){0};
    if (!copy.vertices || !copy.triangles) {
        dem_mesh_free(&copy);
        return dem_fail_memory(error);
    }
    if (from->vertex_count)
        memcpy(copy.vertices, from->vertices, from->vertex_count * sizeof *copy.vertices);
    if (from->triangle_count)
        memcpy(copy.triangles, from->triangles, from->triangle_count * 3 * sizeof *copy.triangles);
    *to = copy;
    return DEM_OK;
}

void dem_mesh_scale(dem_mesh *mesh, double factor)
{
    for (size_t i = 0; i < mesh->vertex_count; i++) {
        mesh->vertices[i].x *= factor;
        mesh->vertices[i].y *= factor;
        mesh->vertices[i].z *= factor;
    }
}
