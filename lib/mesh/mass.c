// Volume integrals of a closed surface: the sum over the signed tetrahedra between a local origin and the
// triangles (Tonon 2004). Far from the coordinates' own zero the local origin keeps the digits, and the
// compensated sums keep them for millions of triangles.
#include "mesh/mass.h"

#include "math/mat3.h"
#include "math/sum.h"

typedef struct moment_sums {
    dem_sum volume, first[3], second[6], area;
} moment_sums;

dem_box dem_mesh_box(const dem_mesh *mesh)
{
    dem_box box = box_empty();
    for (size_t i = 0; i < 3 * mesh->triangle_count; i++)
        box = box_with(box, mesh->vertices[mesh->triangles[i]]);
    return box;
}

// one tetrahedron (0, a, b, c): V = det/6, int x = V s/4, int x x^T = V (a a^T + b b^T + c c^T + s s^T)/20
static void add_triangle(moment_sums *sums, dem_vec3 a, dem_vec3 b, dem_vec3 c)
{
    dem_vec3 normal = v3_cross(v3_sub(b, a), v3_sub(c, a));
    double volume = v3_dot(a, normal) / 6;
    dem_vec3 s = v3_add(a, v3_add(b, c));
    sum_add(&sums->volume, volume);
    sum_add(&sums->first[0], volume * s.x / 4);
    sum_add(&sums->first[1], volume * s.y / 4);
    sum_add(&sums->first[2], volume * s.z / 4);
    double w = volume / 20;
    sum_add(&sums->second[0], w * (a.x * a.x + b.x * b.x + c.x * c.x + s.x * s.x));
    sum_add(&sums->second[1], w * (a.y * a.y + b.y * b.y + c.y * c.y + s.y * s.y));
    sum_add(&sums->second[2], w * (a.z * a.z + b.z * b.z + c.z * c.z + s.z * s.z));
    sum_add(&sums->second[3], w * (a.x * a.y + b.x * b.y + c.x * c.y + s.x * s.y));
    sum_add(&sums->second[4], w * (a.x * a.z + b.x * b.z + c.x * c.z + s.x * s.z));
    sum_add(&sums->second[5], w * (a.y * a.z + b.y * b.z + c.y * c.z + s.y * s.z));
    sum_add(&sums->area, v3_norm(normal) / 2);
}

static dem_moments integrate(const dem_mesh *mesh, dem_vec3 origin, double *area)
{
    moment_sums sums = {0};
    for (size_t i = 0; i < mesh->triangle_count; i++) {
        const uint32_t *t = mesh->triangles + 3 * i;
        add_triangle(&sums, v3_sub(mesh->vertices[t[0]], origin), v3_sub(mesh->vertices[t[1]], origin),
                     v3_sub(mesh->vertices[t[2]], origin));
    }
    double second[6];
    for (int k = 0; k < 6; k++)
        second[k] = sum_value(sums.second[k]);
    *area = sum_value(sums.area);
    return (dem_moments){
        .volume = sum_value(sums.volume),
        .first = v3(sum_value(sums.first[0]), sum_value(sums.first[1]), sum_value(sums.first[2])),
        .second = {second[0], second[1], second[2], second[3], second[4], second[5]},
    };
}

dem_moments dem_mesh_moments(const dem_mesh *mesh, dem_vec3 origin)
{
    double area;
    return integrate(mesh, origin, &area);
}

dem_solid dem_mesh_solid(const dem_mesh *mesh)
{
    dem_box box = dem_mesh_box(mesh);
    dem_vec3 origin = v3_along(box.low, 0.5, v3_sub(box.high, box.low));
    double area;
    dem_moments moments = integrate(mesh, origin, &area);
    return dem_solid_from_moments(moments, origin, area);
}
