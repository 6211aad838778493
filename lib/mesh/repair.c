// Repair of grain meshes: weld, clean, close, orient, unite, choose. Each step leaves the mesh valid for the next;
// what would be a guess is refused.
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "mesh/holes.h"
#include "mesh/mass.h"
#include "mesh/mender.h"
#include "mesh/weld.h"

static const double WELD = 1e-6, WIDEST_WELD = 1e-4;  // tolerances of the second weld over the diagonal
static const double COARSE_NUMBERS = 1e-5;            // spacing of the coordinates over the diagonal to warn of
static const double NO_VOLUME = 1e-9;                 // volume over area^1.5
static const double SMALL_GRAIN = 1e-7, LARGE_GRAIN = 1e5;  // [m]

dem_status dem_mender_note(dem_mender *m, const char *format, ...)
{
    char text[512];
    va_list args;
    va_start(args, format);
    vsnprintf(text, sizeof text, format, args);
    va_end(args);
    if (m->options.repair == DEM_REPAIR_STRICT)
        return dem_fail(m->error, DEM_BAD_INPUT, "needs repair (%s); use --repair auto", text);
    m->report->warnings++;
    dem_log(m->ctx, DEM_LOG_WARNING, "%s", text);
    return DEM_OK;
}

void dem_mender_warn(dem_mender *m, const char *format, ...)
{
    char text[512];
    va_list args;
    va_start(args, format);
    vsnprintf(text, sizeof text, format, args);
    va_end(args);
    m->report->warnings++;
    dem_log(m->ctx, DEM_LOG_WARNING, "%s", text);
}

static dem_status check_numbers(dem_mender *m)
{
    const dem_mesh *mesh = m->mesh;
    if (mesh->triangle_count == 0)
        return dem_fail(m->error, DEM_BAD_INPUT, "no triangles; give a mesh with faces");
    if (mesh->triangle_count >= UINT32_MAX / 3 || mesh->vertex_count >= UINT32_MAX)
        return dem_fail(m->error, DEM_BAD_INPUT, "%zu triangles; give fewer than 1.4e9", mesh->triangle_count);
    for (size_t i = 0; i < 3 * mesh->triangle_count; i++) {
        uint32_t v = mesh->triangles[i];
        if (v >= mesh->vertex_count)
            return dem_fail(m->error, DEM_BAD_INPUT, "triangle %zu refers to vertex %u of %zu; correct the faces",
                            i / 3 + 1, v, mesh->vertex_count);
        dem_vec3 p = mesh->vertices[v];
        if (!isfinite(p.x) || !isfinite(p.y) || !isfinite(p.z))
            return dem_fail(m->error, DEM_BAD_INPUT, "vertex %u is not finite; correct its coordinates", v + 1);
    }
    m->box = dem_mesh_box(mesh);
    m->size = box_diagonal(m->box);
    // the inertia goes with the fifth power
    if (!(pow(m->size, 5) < 1e300))
        return dem_fail(m->error, DEM_BAD_INPUT, "the mesh is %.3g m across; give coordinates in a sensible unit", m->size);
    if (!(pow(m->size, 5) > 1e-300))
        return dem_fail(m->error, DEM_BAD_INPUT, "all vertices are in one place; give the surface of a solid");
    return DEM_OK;
}

// builds the surface without duplicates
static dem_status build_surface(dem_mender *m)
{
    DEM_TRY(dem_surface_build(&m->surface, m->mesh, m->error));
    size_t duplicates = m->surface.edges.duplicates;
    if (duplicates == 0)
        return DEM_OK;
    m->report->duplicate_triangles += duplicates;
    dem_mesh_drop(m->mesh, m->surface.edges.duplicate);
    DEM_TRY(dem_surface_build(&m->surface, m->mesh, m->error));
    return dem_mender_note(m, "removed %zu duplicate triangle%s", duplicates, plural(duplicates));
}

static dem_status drop_collapsed(dem_mender *m)
{
    size_t count = dem_mesh_drop_collapsed(m->mesh);
    m->report->degenerate_triangles += count;
    if (m->mesh->triangle_count == 0)
        return dem_fail(m->error, DEM_BAD_INPUT, "the surface encloses no volume; give the closed surface of a solid");
    if (count)
        return dem_mender_note(m, "removed %zu degenerate triangle%s", count, plural(count));
    return DEM_OK;
}

// marks the vertices on borders; returns the length of the shortest border edge
static double mark_borders(const dem_mender *m, unsigned char *marked)
{
    double shortest = INFINITY;
    for (uint32_t h = 0; h < 3 * m->mesh->triangle_count; h++) {
        if (m->surface.edges.twin[h] != DEM_EDGE_BORDER)
            continue;
        uint32_t a = half_start(m->mesh, h), b = half_end(m->mesh, h);
        marked[a] = marked[b] = 1;
        shortest = fmin(shortest, v3_distance(m->mesh->vertices[a], m->mesh->vertices[b]));
    }
    return shortest;
}

// welds border vertices within `tolerance`, unless that could close an edge
static dem_status weld_borders(dem_mender *m, double tolerance)
{
    unsigned char *marked = dem_alloc_zero(m->mesh->vertex_count, 1);
    if (!marked)
        return dem_fail_memory(m->error);
    size_t merged = 0;
    double shortest = mark_borders(m, marked);
    dem_status status = DEM_OK;
    if (tolerance <= WELD * m->size || tolerance < shortest / 4)
        status = dem_mesh_weld_near(m->mesh, marked, tolerance, &merged, m->error);
    free(marked);
    if (status != DEM_OK || merged == 0)
        return status;
    m->report->welded_vertices += merged;
    m->report->weld_tolerance = tolerance;
    DEM_TRY(dem_mender_note(m, "welded %zu vert%s within %.2g m, %.0e of the diagonal", merged, merged == 1 ? "ex" : "ices",
                            tolerance, tolerance / m->size));
    DEM_TRY(drop_collapsed(m));
    return build_surface(m);
}

static dem_status weld(dem_mender *m)
{
    DEM_TRY(dem_mesh_weld_equal(m->mesh, &m->report->unreferenced_vertices, m->error));
    DEM_TRY(drop_collapsed(m));
    dem_vec3 centre = v3_along(m->box.low, 0.5, v3_sub(m->box.high, m->box.low));
    m->report->volume_before = m->reference = dem_mesh_moments(m->mesh, centre).volume;
    if (m->options.repair == DEM_REPAIR_NONE)
        return dem_surface_build(&m->surface, m->mesh, m->error);
    DEM_TRY(build_surface(m));
    m->report->boundary_edges = m->surface.edges.border;
    for (double part = WELD; part < 1.1 * WIDEST_WELD && m->surface.edges.border; part *= 10)
        DEM_TRY(weld_borders(m, part * m->size));
    m->report->nonmanifold_edges = m->surface.edges.many;
    return DEM_OK;
}

// closes what can be closed, so that the wrap does not get in, and wraps
static dem_status wrap(dem_mender *m)
{
    dem_error trouble, *error = m->error;
    m->error = &trouble;
    dem_status status = dem_mender_clean(m);
    if (status == DEM_OK)
        status = dem_mender_close(m, true);
    if (status == DEM_OK) {
        dem_vec3 centre = v3_along(m->box.low, 0.5, v3_sub(m->box.high, m->box.low));
        m->reference = fabs(dem_mesh_moments(m->mesh, centre).volume);
    }
    m->error = error;
    if (status == DEM_NO_MEMORY)
        return dem_fail_memory(error);
    if (!(m->surface.area > NO_VOLUME * m->size * m->size))
        return dem_fail(error, DEM_BAD_INPUT, "the triangles have no area to wrap; give the surface of a solid");
    DEM_TRY(dem_mender_wrap(m));
    DEM_TRY(dem_shells_find(&m->shells, &m->surface, error));
    m->report->shells = m->shells.count;
    return DEM_OK;
}

static dem_status mend(dem_mender *m)
{
    if (m->options.repair == DEM_REPAIR_WRAP)
        return wrap(m);
    DEM_TRY(dem_mender_clean(m));
    DEM_TRY(dem_mender_close(m, false));
    return dem_mender_solidify(m);
}

// taken as it is: says what is wrong with it
static dem_status take(dem_mender *m)
{
    size_t border = m->report->boundary_edges = m->surface.edges.border;
    size_t many = m->report->nonmanifold_edges = m->surface.edges.many;
    size_t against = dem_surface_unbalanced(&m->surface);
    if (border)
        dem_mender_warn(m, "open: %zu boundary edges; volume and inertia depend on where they are taken from", border);
    if (many)
        dem_mender_warn(m, "%zu edge%s of three and more triangles", many, plural(many));
    if (against)
        dem_mender_warn(m, "%zu edge%s whose triangles face different ways", against, plural(against));
    return DEM_OK;
}

// how far apart neighbouring numbers are at these coordinates
static double spacing(const dem_mesh *mesh, dem_box box)
{
    bool single = true;
    for (size_t i = 0; single && i < mesh->vertex_count; i++) {
        dem_vec3 p = mesh->vertices[i];
        single = (double)(float)p.x == p.x && (double)(float)p.y == p.y && (double)(float)p.z == p.z;
    }
    double far = 0;
    for (int k = 0; k < 3; k++)
        far = fmax(far, fmax(fabs(v3_get(box.low, k)), fabs(v3_get(box.high, k))));
    int exponent;
    frexp(far, &exponent);
    return ldexp(1, exponent - (single ? 24 : 53));
}

static void warn_of_numbers(dem_mender *m)
{
    double step = spacing(m->mesh, m->box);
    // of files in single precision the reader has said so
    if (step > COARSE_NUMBERS * m->size && !m->mesh->single_precision)
        dem_mender_warn(m, "precision lost: so far from zero the coordinates have a resolution of %.2g m, %.2g %% of the "
                           "size; move the grain to zero before saving it", step, 100 * step / m->size);
    if (m->size < SMALL_GRAIN || m->size > LARGE_GRAIN)
        dem_mender_warn(m, "the grain is %.2g m across: wrong unit?", m->size);
}

static dem_status finish(dem_mender *m)
{
    size_t unused;
    DEM_TRY(dem_mesh_compact(m->mesh, &unused, m->error));
    dem_solid solid = dem_mesh_solid(m->mesh);
    if (solid.volume < 0)
        return dem_fail(m->error, DEM_BAD_INPUT, "the mesh is inside out; use --repair auto");
    if (!(solid.volume > NO_VOLUME * solid.area * sqrt(solid.area)))
        return dem_fail(m->error, DEM_BAD_INPUT, "the surface encloses no volume; give the closed surface of a solid");
    if (!(solid.principal[0] > 0) || !isfinite(solid.principal[2]))
        return dem_fail(m->error, DEM_BAD_INPUT,
                        "the surface bounds no solid, its inertia is not positive; use --repair auto or wrap");
    m->report->vertices = m->mesh->vertex_count;
    m->report->triangles = m->mesh->triangle_count;
    m->report->volume = solid.volume;
    m->report->volume_change = (solid.volume - m->reference) / solid.volume;
    warn_of_numbers(m);
    return DEM_OK;
}

dem_status dem_mesh_repair(const dem_ctx *ctx, dem_mesh *mesh, const dem_repair_options *options,
                           dem_mesh_report *report, dem_error *error)
{
    dem_mesh_report own;
    dem_mender m = {.ctx = ctx, .mesh = mesh, .report = report ? report : &own, .error = error};
    if (options)
        m.options = *options;
    *m.report = (dem_mesh_report){.input_vertices = mesh->vertex_count, .input_triangles = mesh->triangle_count};
    dem_status status = check_numbers(&m);
    if (status == DEM_OK)
        status = weld(&m);
    if (status == DEM_OK && dem_progress(ctx, "repairing", 0.3))
        status = dem_fail(error, DEM_INTERRUPTED, "interrupted while repairing the mesh");
    if (status == DEM_OK && m.options.repair == DEM_REPAIR_NONE)
        status = take(&m);
    else if (status == DEM_OK)
        status = mend(&m);
    if (status == DEM_OK && m.options.repair != DEM_REPAIR_NONE)
        status = dem_mender_keep(&m);
    if (status == DEM_OK)
        status = finish(&m);
    dem_surface_release(&m.surface);
    dem_shells_release(&m.shells);
    dem_mesh_bodies_release(&m.bodies);
    free(m.flipped);
    return status;
}
