// Wrapping as the last resort. The wrap lies `offset` outside the surface; its vertices are put back onto the
// surface afterwards. Where the balls get in (holes larger than they are), the wrap is a thin skin around the
// triangles without volume, and larger balls are tried.
#include <stdlib.h>

#include "geom/tree.h"
#include "mesh/cgal.h"
#include "mesh/mass.h"
#include "mesh/mender.h"

static const double DETAIL = 1.0 / 100, COARSEST = 1.0 / 8;  // radius of the ball over the diagonal
static const double OFFSET = 1.0 / 30;                       // offset over the radius
static const double SKIN = 4;                                // volume over area and offset; a skin has 1

static void move(dem_mesh *mesh, dem_vec3 shift, double factor)
{
    for (size_t i = 0; i < mesh->vertex_count; i++)
        mesh->vertices[i] = v3_scale(v3_add(mesh->vertices[i], shift), factor);
}

// the vertices to the closest points of what was wrapped
static dem_status tighten(dem_mesh *wrap, const dem_mesh *mesh, double offset, dem_error *error)
{
    dem_tree tree;
    DEM_TRY(dem_tree_build(&tree, mesh->vertices, mesh->triangles, mesh->triangle_count, error));
    for (size_t i = 0; i < wrap->vertex_count; i++) {
        dem_vec3 point;
        if (dem_tree_closest(&tree, wrap->vertices[i], 2 * offset, &point, NULL) < INFINITY)
            wrap->vertices[i] = point;
    }
    dem_tree_release(&tree);
    return DEM_OK;
}

// around a mesh of size 1
static dem_status wrap_unit(const dem_mesh *mesh, double detail, dem_mesh *wrap, double *used, dem_error *error)
{
    for (double alpha = detail; alpha <= fmax(COARSEST, detail); alpha *= 2) {
        DEM_TRY(dem_mesh_alpha_wrap(mesh, alpha, alpha * OFFSET, wrap, error));
        dem_solid solid = dem_mesh_solid(wrap);
        *used = alpha;
        if (solid.volume > SKIN * solid.area * alpha * OFFSET)
            return tighten(wrap, mesh, alpha * OFFSET, error);
        dem_mesh_free(wrap);
    }
    return dem_fail(error, DEM_BAD_INPUT, "even a coarse wrap encloses no volume; give the surface of a solid");
}

dem_status dem_mender_wrap(dem_mender *m)
{
    dem_vec3 middle = v3_along(m->box.low, 0.5, v3_sub(m->box.high, m->box.low));
    double detail = m->options.wrap_detail > 0 ? m->options.wrap_detail : DETAIL, used = detail;
    dem_mesh wrap = {0};
    move(m->mesh, v3_scale(middle, -1), 1 / m->size);
    dem_status status = wrap_unit(m->mesh, detail, &wrap, &used, m->error);
    if (status != DEM_OK) {
        dem_mesh_free(&wrap);
        return status;
    }
    move(&wrap, v3_scale(middle, 1 / m->size), m->size);
    wrap.single_precision = m->mesh->single_precision;
    dem_mesh_free(m->mesh);
    *m->mesh = wrap;
    free(m->flipped);
    m->flipped = NULL;
    m->report->wrapped = true;
    DEM_TRY(dem_surface_build(&m->surface, m->mesh, m->error));
    double volume = dem_mesh_solid(m->mesh).volume;
    dem_mender_warn(m, "wrapped: details below %.3g m are lost, %zu triangles; volume %+.3g %%", 2 * used * m->size,
                    m->mesh->triangle_count, 100 * (volume - m->reference) / volume);
    return DEM_OK;
}
