#include "dem/mesh.h"

#include <stdlib.h>

void dem_mesh_free(dem_mesh *mesh)
{
    free(mesh->vertices);
    free(mesh->triangles);
    *mesh = (dem_mesh){0};
}
