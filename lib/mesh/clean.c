// First half of the repair: from welded triangles to a closed surface whose neighbours agree.
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "mesh/holes.h"
#include "mesh/mender.h"
#include "mesh/prune.h"
#include "mesh/weld.h"

enum { MOST_PASSES = 50 };               // over fins on fins

static const double SMALL_HOLES = 0.05;  // part of volume and of area that may be guessed

dem_status dem_mender_drop(dem_mender *m, const unsigned char *drop)
{
    if (m->flipped) {
        size_t kept = 0;
        for (size_t t = 0; t < m->mesh->triangle_count; t++)
            if (!drop[t])
                m->flipped[kept++] = m->flipped[t];
    }
    dem_mesh_drop(m->mesh, drop);
    return dem_surface_build(&m->surface, m->mesh, m->error);
}

static dem_status drop_fins(dem_mender *m, unsigned char *drop)
{
    size_t dropped = 0, count;
    for (int i = 0; i < MOST_PASSES && (count = dem_surface_mark_fins(&m->surface, drop)) > 0; i++) {
        dropped += count;
        DEM_TRY(dem_mender_drop(m, drop));
    }
    m->report->dropped_triangles += dropped;
    if (dropped)
        return dem_mender_note(m, "removed %zu triangle%s of fins and strays, which bound nothing", dropped, plural(dropped));
    return DEM_OK;
}

static dem_status drop_walls(dem_mender *m, unsigned char *drop)
{
    size_t count;
    DEM_TRY(dem_surface_mark_walls(&m->surface, drop, &count, m->error));
    if (count == 0)
        return DEM_OK;
    DEM_TRY(dem_mender_drop(m, drop));
    m->report->dropped_triangles += count;
    return dem_mender_note(m, "removed %zu triangle%s of inner walls", count, plural(count));
}

static dem_status orient(dem_mender *m)
{
    size_t conflicts;
    DEM_TRY(dem_surface_orient(&m->surface, m->flipped, &conflicts, m->error));
    if (conflicts)
        return dem_fail(m->error, DEM_BAD_INPUT,
                        "the surface is one-sided (Moebius band): no inside at %zu edge%s; mend it or use --repair wrap",
                        conflicts, plural(conflicts));
    return DEM_OK;
}

dem_status dem_mender_clean(dem_mender *m)
{
    unsigned char *drop = dem_alloc(m->mesh->triangle_count, 1);
    m->flipped = dem_alloc_zero(m->mesh->triangle_count, 1);
    dem_status status = drop && m->flipped ? DEM_OK : dem_fail_memory(m->error);
    if (status == DEM_OK)
        status = drop_fins(m, drop);
    if (status == DEM_OK)
        status = orient(m);
    if (status == DEM_OK && dem_surface_unbalanced(&m->surface)) {
        status = drop_walls(m, drop);
        if (status == DEM_OK)
            status = drop_fins(m, drop);
        if (status == DEM_OK)
            status = orient(m);
    }
    free(drop);
    size_t unbalanced = status == DEM_OK ? dem_surface_unbalanced(&m->surface) : 0;
    if (unbalanced)
        status = dem_fail(m->error, DEM_BAD_INPUT,
                          "%zu edge%s join%s surfaces that cannot bound one solid; mend them or use --repair wrap",
                          unbalanced, plural(unbalanced), unbalanced == 1 ? "s" : "");
    return status;
}

static double signed_volume(const dem_mesh *mesh, dem_vec3 centre)
{
    return dem_mesh_moments(mesh, centre).volume;
}

static dem_status refuse_open(dem_mender *m, const dem_holes *holes, double part)
{
    if (part > 10 || !isfinite(part))
        return dem_fail(m->error, DEM_BAD_INPUT,
                        "the surface is open and encloses no volume: %zu boundary edges; give a closed surface",
                        holes->edges);
    return dem_fail(m->error, DEM_BAD_INPUT,
                    "the surface is open: %zu boundary edges; filling %zu hole%s would add about %.3g %% of volume; "
                    "close it or use --repair wrap",
                    holes->edges, holes->holes, plural(holes->holes), 100 * part);
}

dem_status dem_mender_close(dem_mender *m, bool any_size)
{
    size_t before = m->mesh->triangle_count, vertices = m->mesh->vertex_count;
    dem_vec3 centre = v3_along(m->box.low, 0.5, v3_sub(m->box.high, m->box.low));
    dem_holes holes = {0};
    if (m->surface.edges.border) {
        double area = m->surface.area;
        DEM_TRY(dem_surface_fill(&m->surface, centre, &holes, m->error));
        double volume = fabs(signed_volume(m->mesh, centre)), part = holes.share / volume;
        bool small = part <= SMALL_HOLES && holes.area <= SMALL_HOLES * area;
        if (!any_size && !small) {
            m->mesh->triangle_count = before;
            m->mesh->vertex_count = vertices;
            return refuse_open(m, &holes, part);
        }
        unsigned char *flipped = realloc(m->flipped, m->mesh->triangle_count);
        if (!flipped)
            return dem_fail_memory(m->error);
        m->flipped = flipped;
        memset(flipped + before, DEM_MENDER_NEW, m->mesh->triangle_count - before);
        m->report->holes_filled = holes.holes;
        m->report->hole_edges = holes.edges;
        DEM_TRY(dem_mender_note(m, "filled %zu hole%s of %zu edge%s in all; %.2g %% of the volume stands on the new triangles",
                                holes.holes, plural(holes.holes), holes.edges, plural(holes.edges),
                                volume > 0 ? 100 * part : 0));
        DEM_TRY(dem_surface_build(&m->surface, m->mesh, m->error));
    }
    if (m->surface.edges.border && !any_size)
        return dem_fail(m->error, DEM_BAD_INPUT, "%zu boundary edges run in no closed ring; close the surface or use --repair wrap",
                        m->surface.edges.border);
    m->reference = -holes.volume;
    return DEM_OK;
}
