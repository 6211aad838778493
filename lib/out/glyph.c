#include "out/glyph.h"

#include <math.h>
#include <stdlib.h>

#include "base/memory.h"
#include "math/vec.h"
#include "out/facets.h"
#include "out/vtp.h"

enum {
    FEW = 4,  // balls that are worth 320 triangles each, not 80
    FINE = 2,
    COARSE = 1,
};

// the corners of every facet stand for themselves, so that each ball has its own normals where balls meet
static dem_status write_facets(const char *path, const dem_clump_def *def, const dem_facets *facets, dem_error *error)
{
    size_t corners = 3 * facets->count;
    dem_vec3 *points = dem_alloc(corners, sizeof *points);
    float *normals = dem_alloc(3 * corners, sizeof *normals);
    uint32_t *triangles = dem_alloc(corners, sizeof *triangles);
    dem_status status = points && normals && triangles ? DEM_OK : dem_fail_memory(error);
    for (size_t i = 0; i < corners && status == DEM_OK; i++) {
        const dem_facet *f = &facets->facets[i / 3];
        points[i] = f->corners[i % 3];
        dem_vec3 n = v3_unit(v3_sub(points[i], def->balls[f->ball].centre));
        normals[3 * i] = (float)n.x, normals[3 * i + 1] = (float)n.y, normals[3 * i + 2] = (float)n.z;
        triangles[i] = (uint32_t)i;
    }
    const dem_vtp_array array = {"Normals", DEM_VTP_FLOAT32, 3, normals};
    if (status == DEM_OK)
        status = dem_vtp_write(path,
                               &(dem_vtp){.time = NAN,
                                          .points = points,
                                          .point_count = corners,
                                          .point_arrays = &array,
                                          .point_array_count = 1,
                                          .triangles = triangles,
                                          .triangle_count = facets->count},
                               error);
    free(points);
    free(normals);
    free(triangles);
    return status;
}

dem_status dem_glyph_write(const char *path, const dem_clump *clump, dem_error *error)
{
    dem_clump_def def = dem_clump_view(clump);
    const dem_mesh *surface = &def.surface;
    if (surface->triangle_count)
        return dem_vtp_write(path,
                             &(dem_vtp){.time = NAN,
                                        .points = surface->vertices,
                                        .point_count = surface->vertex_count,
                                        .triangles = surface->triangles,
                                        .triangle_count = surface->triangle_count},
                             error);
    dem_facets facets;
    DEM_TRY(dem_balls_facets(def.balls, def.ball_count, def.ball_count <= FEW ? FINE : COARSE, &facets, error));
    dem_status status = write_facets(path, &def, &facets, error);
    dem_facets_release(&facets);
    return status;
}
