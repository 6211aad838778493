#include "mesh/flips.h"

#include "mesh/edges.h"
#include "mesh/mass.h"

enum { MOST_PASSES = 100 };

static const double FLAT = 1e-9;  // a crease less deep, over the size, is none

static double six_volume(const dem_mesh *mesh, uint32_t a, uint32_t b, uint32_t c)
{
    return v3_dot(mesh->vertices[a], v3_cross(mesh->vertices[b], mesh->vertices[c]));
}

// how far `p` lies above the plane of a, b, c
static double above(const dem_mesh *mesh, uint32_t a, uint32_t b, uint32_t c, uint32_t p)
{
    dem_vec3 o = mesh->vertices[a];
    dem_vec3 n = v3_cross(v3_sub(mesh->vertices[b], o), v3_sub(mesh->vertices[c], o));
    double length = v3_norm(n);
    return length > 0 ? v3_dot(n, v3_sub(mesh->vertices[p], o)) / length : 0;
}

static void join(uint32_t *twin, uint32_t half, uint32_t other)
{
    twin[half] = other;
    twin[other] = half;
}

// the edge between a-b-c and b-a-d becomes that between c and d, where both triangles still face outwards
static bool flip(dem_mesh *mesh, uint32_t *twin, uint32_t half)
{
    uint32_t other = twin[half], t = half / 3, u = other / 3;
    uint32_t a = half_start(mesh, half), b = half_end(mesh, half);
    uint32_t c = half_apex(mesh, half), d = half_apex(mesh, other);
    uint32_t bc = twin[half_next(half)], ca = twin[half_before(half)];
    uint32_t ad = twin[half_next(other)], db = twin[half_before(other)];
    if (ca / 3 == ad / 3 || bc / 3 == db / 3)  // three triangles around a corner: c and d are joined already
        return false;
    if (!(six_volume(mesh, a, d, c) > 0 && six_volume(mesh, d, b, c) > 0))
        return false;
    uint32_t *first = &mesh->triangles[3 * (size_t)t], *second = &mesh->triangles[3 * (size_t)u];
    first[0] = a, first[1] = d, first[2] = c;
    second[0] = d, second[1] = b, second[2] = c;
    join(twin, 3 * t, ad);
    join(twin, 3 * t + 1, 3 * u + 2);
    join(twin, 3 * t + 2, ca);
    join(twin, 3 * u, db);
    join(twin, 3 * u + 1, bc);
    return true;
}

dem_status dem_mesh_flip_to_convex(dem_mesh *mesh, dem_error *error)
{
    dem_edges edges = {0};
    DEM_TRY(dem_edges_build(&edges, mesh, error));
    double deep = FLAT * box_diagonal(dem_mesh_box(mesh));
    size_t flipped = 1;
    // each flip adds volume, so this ends by itself
    for (int pass = 0; pass < MOST_PASSES && flipped && !edges.border && !edges.many; pass++) {
        flipped = 0;
        for (uint32_t half = 0; half < 3 * mesh->triangle_count; half++) {
            uint32_t other = edges.twin[half];
            if (above(mesh, half_start(mesh, half), half_end(mesh, half), half_apex(mesh, half),
                      half_apex(mesh, other)) > deep)
                flipped += flip(mesh, edges.twin, half);
        }
    }
    dem_edges_release(&edges);
    return DEM_OK;
}
