// Second half of the repair: from closed surfaces to the boundary of a solid.
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "mesh/crossings.h"
#include "mesh/mender.h"
#include "mesh/unite.h"
#include "mesh/weld.h"

static const double FLAT = 1e-9;      // volume over area^1.5 of a shell that encloses nothing
static const double DUST = 1e-4;      // part of the largest body's volume below which a body is dirt
static const double POCKET = 1e-6;    // the same for a cavity
static const double HARMLESS = 1e-3;  // part of the area in crossing triangles that may stay where CGAL is missing

enum { MOST_CROSSINGS = 100000, LISTED_BODIES = 5 };

static dem_status find_shells(dem_mender *m)
{
    dem_shells_release(&m->shells);
    return dem_shells_find(&m->shells, &m->surface, m->error);
}

// drops the shells marked
static dem_status drop_shells(dem_mender *m, const unsigned char *chosen)
{
    unsigned char *drop = dem_alloc(m->mesh->triangle_count, 1);
    if (!drop)
        return dem_fail_memory(m->error);
    for (size_t t = 0; t < m->mesh->triangle_count; t++)
        drop[t] = chosen[m->shells.of[t]];
    dem_status status = dem_mender_drop(m, drop);
    free(drop);
    if (status == DEM_OK)
        status = find_shells(m);
    return status;
}

static dem_status drop_flat_shells(dem_mender *m)
{
    unsigned char *flat = dem_alloc_zero(m->shells.count, 1);
    if (!flat)
        return dem_fail_memory(m->error);
    size_t count = 0, triangles = 0;
    for (size_t i = 0; i < m->shells.count; i++) {
        const dem_shell *s = &m->shells.list[i];
        flat[i] = !(fabs(s->volume) > FLAT * s->area * sqrt(s->area));
        count += flat[i];
        triangles += flat[i] ? s->triangles : 0;
    }
    dem_status status = DEM_OK;
    if (count == m->shells.count)
        status = dem_fail(m->error, DEM_BAD_INPUT, "the surface encloses no volume; give the closed surface of a solid");
    else if (count) {
        status = drop_shells(m, flat);
        m->report->dropped_triangles += triangles;
        if (status == DEM_OK)
            status = dem_mender_note(m, "removed %zu closed piece%s without volume (%zu triangles)", count,
                                     plural(count), triangles);
    }
    free(flat);
    return status;
}

// turns over the shells marked
static dem_status flip_shells(dem_mender *m, const unsigned char *chosen)
{
    if (!memchr(chosen, 1, m->shells.count))
        return DEM_OK;
    unsigned char *flip = dem_alloc(m->mesh->triangle_count, 1);
    if (!flip)
        return dem_fail_memory(m->error);
    for (size_t t = 0; t < m->mesh->triangle_count; t++)
        flip[t] = chosen[m->shells.of[t]];
    dem_surface_flip(&m->surface, flip);
    for (size_t i = 0; i < m->shells.count; i++)
        if (chosen[i])
            m->shells.list[i].volume *= -1;
    if (m->flipped)
        for (size_t t = 0; t < m->mesh->triangle_count; t++)
            m->flipped[t] ^= flip[t];
    free(flip);
    return DEM_OK;
}

// a root that is inside out is turned, with all that lies in it
static dem_status face_outward(dem_mender *m)
{
    unsigned char *turn = dem_alloc(m->shells.count, 1);
    if (!turn)
        return dem_fail_memory(m->error);
    for (uint32_t i = 0; i < m->shells.count; i++)
        turn[i] = m->shells.list[dem_shell_outermost(&m->shells, i)].volume < 0;
    dem_status status = flip_shells(m, turn);
    free(turn);
    return status;
}

// what was turned against the file: all of it, or some triangles?
static dem_status report_turned(dem_mender *m)
{
    size_t turned = 0, count = 0;
    for (size_t t = 0; t < m->mesh->triangle_count; t++) {
        turned += m->flipped[t] == 1;
        count += m->flipped[t] < DEM_MENDER_NEW;
    }
    m->report->inside_out = 2 * turned > count;
    m->report->reoriented_triangles = m->report->inside_out ? count - turned : turned;
    if (m->report->inside_out && turned == count)
        return dem_mender_note(m, "the mesh was inside out; turned it");
    if (turned)
        return dem_mender_note(m, "turned %zu of %zu triangles to face outward like their neighbours", turned, count);
    return DEM_OK;
}

static void mark_entangled(dem_shells *shells, const dem_crossings *crossings)
{
    for (size_t i = 0; i < crossings->count; i++) {
        uint32_t a = shells->of[crossings->pairs[i][0]], b = shells->of[crossings->pairs[i][1]];
        if (a != b)
            shells->list[a].entangled = shells->list[b].entangled = true;
    }
}

static size_t count_entangled(const dem_shells *shells)
{
    size_t count = 0;
    for (size_t i = 0; i < shells->count; i++)
        count += shells->list[i].entangled;
    return count;
}

// part of the area in triangles that cross
static double crossing_area(const dem_mender *m, const dem_crossings *crossings)
{
    double area = 0;
    for (size_t i = 0; i < crossings->count; i++)
        area += dem_triangle_area(m->mesh, crossings->pairs[i][0]) + dem_triangle_area(m->mesh, crossings->pairs[i][1]);
    return area / m->surface.area;
}

static dem_status unite(dem_mender *m, const dem_crossings *crossings)
{
    bool changed;
    size_t entangled = count_entangled(&m->shells);
    dem_error trouble;
    dem_status status = dem_mesh_unite(m->mesh, crossings, &changed, &trouble);
    if (status == DEM_NO_MEMORY)
        return dem_fail_memory(m->error);
    if (status != DEM_OK && entangled == 0 && crossing_area(m, crossings) < HARMLESS) {
        dem_mender_warn(m, "the surface crosses itself in %zu pair%s of triangles, left as they are: %s", crossings->count,
                        plural(crossings->count), trouble.text);
        return DEM_OK;
    }
    if (status != DEM_OK)
        return dem_fail(m->error, DEM_BAD_INPUT, "the surface crosses itself in %zu pair%s of triangles: %s",
                        crossings->count, plural(crossings->count), trouble.text);
    if (!changed)
        return DEM_OK;
    free(m->flipped);
    m->flipped = NULL;
    m->report->merged_shells = entangled;
    DEM_TRY(dem_surface_build(&m->surface, m->mesh, m->error));
    DEM_TRY(find_shells(m));
    double volume = dem_mesh_solid(m->mesh).volume, was = m->reference;
    if (entangled)
        return dem_mender_note(m, "united %zu overlapping shells (%zu crossing pairs of triangles); volume %+.3g %%",
                               entangled, crossings->count, 100 * (volume - was) / volume);
    return dem_mender_note(m, "the surface crosses itself in %zu pair%s of triangles; kept the outline of the solid it "
                              "winds around; volume %+.3g %%",
                           crossings->count, plural(crossings->count), 100 * (volume - was) / volume);
}

static dem_status find_crossings(dem_mender *m, dem_crossings *crossings)
{
    *crossings = (dem_crossings){0};
    dem_tree tree;
    DEM_TRY(dem_tree_build(&tree, m->mesh->vertices, m->mesh->triangles, m->mesh->triangle_count, m->error));
    dem_status status = dem_mesh_crossings(m->ctx, m->mesh, &tree, MOST_CROSSINGS, crossings, m->error);
    dem_tree_release(&tree);
    if (status != DEM_OK)
        return status;
    m->report->self_intersections = crossings->count;
    if (!crossings->complete)
        return dem_fail(m->error, DEM_BAD_INPUT,
                        "the surface crosses itself in more than %zu pairs of triangles; use --repair wrap",
                        crossings->count);
    return DEM_OK;
}

// keeps the shells with the solid on one side: winding number outside them 0 and inside not, or the other way round
static dem_status drop_inner_shells(dem_mender *m)
{
    const dem_shells *s = &m->shells;
    unsigned char *drop = dem_alloc_zero(s->count, 1), *flip = dem_alloc_zero(s->count, 1);
    size_t count = 0;
    dem_status status = drop && flip ? DEM_OK : dem_fail_memory(m->error);
    for (size_t i = 0; status == DEM_OK && i < s->count; i++) {
        int outside = 0;
        for (size_t k = s->list[i].hosts_begin; k < s->list[i].hosts_end; k++)
            outside += s->list[s->hosts[k]].volume > 0 ? 1 : -1;
        int inside = outside + (s->list[i].volume > 0 ? 1 : -1);
        drop[i] = (outside != 0) == (inside != 0);
        flip[i] = (outside == 0) != (s->list[i].volume > 0);
        count += drop[i];
    }
    m->report->ignored_shells = count;
    if (status == DEM_OK)
        status = flip_shells(m, flip);
    if (status == DEM_OK && count) {
        status = drop_shells(m, drop);
        if (status == DEM_OK)
            status = dem_mender_note(m, "ignored %zu shell%s inside the solid, turned the same way as the one around", count,
                                     plural(count));
    }
    free(drop);
    free(flip);
    return status;
}

dem_status dem_mender_solidify(dem_mender *m)
{
    dem_crossings crossings;
    DEM_TRY(find_shells(m));
    DEM_TRY(drop_flat_shells(m));
    dem_status status = find_crossings(m, &crossings);
    if (status != DEM_OK) {
        free(crossings.pairs);
        return status;
    }
    mark_entangled(&m->shells, &crossings);
    m->report->shells = m->shells.count;
    status = dem_shells_nest(&m->shells, m->mesh, m->error);
    if (status == DEM_OK)
        status = face_outward(m);
    if (status == DEM_OK)
        status = report_turned(m);
    double volume = 0;
    for (size_t i = 0; i < m->shells.count; i++)
        volume += m->shells.list[i].volume;
    m->reference += volume;
    if (status == DEM_OK && crossings.count)
        status = unite(m, &crossings);
    free(crossings.pairs);
    if (status == DEM_OK)
        status = dem_shells_nest(&m->shells, m->mesh, m->error);
    if (status == DEM_OK)
        status = drop_inner_shells(m);
    return status;
}

static dem_status find_bodies(dem_mender *m)
{
    DEM_TRY(dem_shells_nest(&m->shells, m->mesh, m->error));
    dem_mesh_bodies_release(&m->bodies);
    return dem_mesh_bodies_find(&m->bodies, &m->shells, m->mesh, m->error);
}

static dem_status drop_dust(dem_mender *m)
{
    unsigned char *drop = dem_alloc_zero(m->shells.count, 1);
    if (!drop)
        return dem_fail_memory(m->error);
    size_t count = 0;
    double volume = 0, largest = m->bodies.volume[0];
    for (size_t i = 0; i < m->shells.count; i++) {
        double v = m->shells.list[i].volume;
        bool pocket = v < 0 && -v < POCKET * largest;
        drop[i] = pocket || m->bodies.volume[m->bodies.of[i]] < DUST * largest;
        count += drop[i];
        volume += drop[i] ? fabs(v) : 0;
        m->report->dropped_triangles += drop[i] ? m->shells.list[i].triangles : 0;
    }
    dem_status status = DEM_OK;
    if (count) {
        status = drop_shells(m, drop);
        if (status == DEM_OK)
            status = dem_mender_note(m, "removed %zu speck%s and pore%s with %.2g %% of the volume", count, plural(count),
                                     plural(count), 100 * volume / largest);
        if (status == DEM_OK)
            status = find_bodies(m);
    }
    free(drop);
    return status;
}

static dem_status refuse_bodies(dem_mender *m)
{
    char list[200] = "";
    size_t used = 0;
    for (size_t i = 0; i < m->bodies.count && i < LISTED_BODIES; i++)
        used += (size_t)snprintf(list + used, sizeof list - used, "%s%.3g", i ? ", " : "", m->bodies.volume[i]);
    return dem_fail(m->error, DEM_BAD_INPUT,
                    "%zu separate bodies of %s%s m^3, but a grain is one; use --keep largest, --keep all or --split",
                    m->bodies.count, list, m->bodies.count > LISTED_BODIES ? ", ..." : "");
}

static dem_status keep_largest(dem_mender *m)
{
    unsigned char *drop = dem_alloc(m->shells.count, 1);
    if (!drop)
        return dem_fail_memory(m->error);
    for (size_t i = 0; i < m->shells.count; i++)
        drop[i] = m->bodies.of[i] != 0;
    size_t others = m->bodies.count - 1;
    dem_status status = drop_shells(m, drop);
    free(drop);
    if (status == DEM_OK) {
        dem_mender_warn(m, "kept the largest of %zu bodies", others + 1);
        status = find_bodies(m);
    }
    return status;
}

dem_status dem_mender_keep(dem_mender *m)
{
    DEM_TRY(find_bodies(m));
    DEM_TRY(drop_dust(m));
    m->report->bodies = m->bodies.count;
    if (m->bodies.count > 1 && m->options.keep == DEM_KEEP_ONE)
        return refuse_bodies(m);
    if (m->bodies.count > 1 && m->options.keep == DEM_KEEP_LARGEST)
        DEM_TRY(keep_largest(m));
    else if (m->bodies.count > 1)
        dem_mender_warn(m, "%zu separate bodies taken as one rigid body", m->bodies.count);
    double hollow = 0, volume = 0;
    size_t solids = 0;
    for (size_t i = 0; i < m->shells.count; i++) {
        bool cavity = m->shells.list[i].volume < 0;
        m->report->cavities += cavity;
        solids += !cavity;
        hollow -= cavity ? m->shells.list[i].volume : 0;
        volume += m->shells.list[i].volume;
    }
    if (solids > m->bodies.count)
        dem_mender_warn(m, "%zu closed surfaces that touch only at corners or edges taken as %s", solids,
                        m->bodies.count == 1 ? "one body" : "bodies");
    if (m->report->cavities)
        dem_mender_warn(m, "hollow: %zu cavit%s of %.3g %% of the solid volume left empty", m->report->cavities,
                        m->report->cavities == 1 ? "y" : "ies", 100 * hollow / volume);
    return DEM_OK;
}
