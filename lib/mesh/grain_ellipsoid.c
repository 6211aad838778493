#include "math/vec.h"
#include "mesh/grain.h"
#include "mesh/icosphere.h"

static const dem_grain_param params[] = {
    {"longest", 2e-3, 1e-9, 1e9, "m", "axis along x, end to end"},
    {"intermediate", 1.6e-3, 1e-9, 1e9, "m", "axis along y"},
    {"shortest", 1.2e-3, 1e-9, 1e9, "m", "axis along z"},
};

static dem_status make(const dem_ctx *ctx, const dem_grain_request *request, dem_mesh *mesh, dem_error *error)
{
    (void)ctx;
    DEM_TRY(dem_icosphere(dem_icosphere_frequency(request->triangles), mesh, error));
    for (size_t i = 0; i < mesh->vertex_count; i++) {
        dem_vec3 *v = &mesh->vertices[i];
        *v = v3(v->x * request->values[0] / 2, v->y * request->values[1] / 2, v->z * request->values[2] / 2);
    }
    return DEM_OK;
}

const dem_grain_kind dem_grain_ellipsoid = {
    .name = "ellipsoid",
    .paper = "",
    .about = "An ellipsoid along x, y, z. Its vertices lie on it, so the mesh is a little smaller.",
    .params = params,
    .param_count = sizeof params / sizeof *params,
    .make = make,
};
