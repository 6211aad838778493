/// Crushed grains: the polyhedron that random planes cut out, with its exact edges and corners.
#include <stdlib.h>

#include "base/memory.h"
#include "math/vec.h"
#include "mesh/grain.h"
#include "mesh/icosphere.h"

enum { FACES, SPREAD };
enum { MAX_FACES = 100, MAX_CORNERS = 2 * MAX_FACES - 4, STREAM = 1 };

static const dem_grain_param params[] = {
    [FACES] = {"faces", 24, 8, MAX_FACES, "count", "planes cut; some may miss the grain"},
    [SPREAD] = {"spread", 0.3, 0, 0.6, "-", "of their distances: from 1 - spread to 1"},
};

typedef struct corner {
    dem_vec3 at;
    int planes[3];
} corner;

typedef struct polyhedron {
    dem_vec3 normals[MAX_FACES];
    double distances[MAX_FACES];
    int plane_count;
    corner corners[MAX_CORNERS];
    size_t corner_count;
} polyhedron;

static dem_vec3 meet(const polyhedron *p, int i, int j, int k)
{
    dem_vec3 a = p->normals[i], b = p->normals[j], c = p->normals[k];
    dem_vec3 bc = v3_cross(b, c), sum = v3_scale(bc, p->distances[i]);
    sum = v3_along(sum, p->distances[j], v3_cross(c, a));
    sum = v3_along(sum, p->distances[k], v3_cross(a, b));
    return v3_scale(sum, 1 / v3_dot(a, bc));
}

static bool cut_off(const polyhedron *p, dem_vec3 at, int i, int j, int k)
{
    for (int l = 0; l < p->plane_count; l++)
        if (l != i && l != j && l != k && !(v3_dot(p->normals[l], at) < p->distances[l]))
            return true;
    return false;
}

// every three planes meet in a point, which is a corner unless a fourth one cuts it off. Planes in general position
// make a simple polyhedron, three faces at each corner: it is bounded if and only if corners = 2 faces - 4.
static bool find_corners(polyhedron *p)
{
    bool seen[MAX_FACES] = {0};
    for (int i = 0; i < p->plane_count; i++)
        for (int j = i + 1; j < p->plane_count; j++)
            for (int k = j + 1; k < p->plane_count; k++) {
                dem_vec3 at = meet(p, i, j, k);
                if (cut_off(p, at, i, j, k))
                    continue;
                if (p->corner_count == MAX_CORNERS)
                    return false;
                p->corners[p->corner_count++] = (corner){at, {i, j, k}};
                seen[i] = seen[j] = seen[k] = true;
            }
    size_t faces = 0;
    for (int i = 0; i < p->plane_count; i++)
        faces += seen[i];
    return faces >= 4 && p->corner_count == 2 * faces - 4;
}

// the corners of a face counter-clockwise, by their angle about its middle; returns how many
static size_t face_corners(const polyhedron *p, int face, uint32_t *around, dem_vec3 *middle)
{
    size_t count = 0;
    double angles[MAX_CORNERS];
    *middle = v3(0, 0, 0);
    for (uint32_t i = 0; i < p->corner_count; i++) {
        const int *planes = p->corners[i].planes;
        if (planes[0] == face || planes[1] == face || planes[2] == face) {
            around[count++] = i;
            *middle = v3_add(*middle, p->corners[i].at);
        }
    }
    if (count == 0)
        return 0;
    *middle = v3_scale(*middle, 1 / (double)count);
    dem_vec3 x = v3_normal_to(p->normals[face]), y = v3_cross(p->normals[face], x);
    for (size_t i = 0; i < count; i++) {  // insertion sort
        uint32_t me = around[i];
        dem_vec3 d = v3_sub(p->corners[me].at, *middle);
        double angle = atan2(v3_dot(d, y), v3_dot(d, x));
        size_t j = i;
        for (; j > 0 && angles[j - 1] > angle; j--) {
            angles[j] = angles[j - 1];
            around[j] = around[j - 1];
        }
        angles[j] = angle;
        around[j] = me;
    }
    return count;
}

// each face as a fan about its middle
static void put_fans(const polyhedron *p, dem_mesh *mesh)
{
    uint32_t around[MAX_CORNERS];
    for (size_t i = 0; i < p->corner_count; i++)
        mesh->vertices[mesh->vertex_count++] = p->corners[i].at;
    for (int face = 0; face < p->plane_count; face++) {
        dem_vec3 middle;
        size_t count = face_corners(p, face, around, &middle);
        if (count == 0)
            continue;
        mesh->vertices[mesh->vertex_count] = middle;
        for (size_t i = 0; i < count; i++) {
            uint32_t *t = &mesh->triangles[3 * mesh->triangle_count++];
            t[0] = (uint32_t)mesh->vertex_count;
            t[1] = around[i];
            t[2] = around[(i + 1) % count];
        }
        mesh->vertex_count++;
    }
}

static dem_status make(const dem_ctx *ctx, const dem_grain_request *request, dem_mesh *mesh, dem_error *error)
{
    (void)ctx;
    polyhedron p = {.plane_count = (int)request->values[FACES]};
    dem_random random = random_stream(request->seed, STREAM);
    dem_grain_directions(&random, p.normals, (size_t)p.plane_count);
    for (int i = 0; i < p.plane_count; i++)
        p.distances[i] = 1 - request->values[SPREAD] * random_uniform(&random);
    if (!find_corners(&p))
        return dem_fail(error, DEM_USAGE,
                        "the planes of this seed enclose no polyhedron; take more faces or another seed");
    // a fan has one triangle per edge of its face, and each of the 3/2 corners edges has two faces
    dem_vec3 vertices[MAX_CORNERS + MAX_FACES];
    uint32_t triangles[9 * MAX_CORNERS];
    dem_mesh fans = {.vertices = vertices, .triangles = triangles};
    put_fans(&p, &fans);
    DEM_ASSERT(fans.triangle_count == 3 * p.corner_count);
    size_t frequency = (size_t)(sqrt((double)request->triangles / (double)fans.triangle_count) + 0.5);
    return dem_mesh_divide(&fans, frequency ? frequency : 1, mesh, error);
}

const dem_grain_kind dem_grain_facets = {
    .name = "facets",
    .paper = "",
    .about = "Crushed rock: the convex polyhedron inside random planes, with sharp edges and corners.",
    .params = params,
    .param_count = sizeof params / sizeof *params,
    .make = make,
};
