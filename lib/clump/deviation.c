// Means over points spread evenly by area; the largest values are searched for from there.
#include "clump/deviation.h"

#include <stdlib.h>

#include "clump/farthest.h"

enum { CHUNK = 64 };

static double triangle_area2(const dem_tree *mesh, uint32_t triangle, dem_vec3 p[3], dem_vec3 *normal)
{
    for (int k = 0; k < 3; k++)
        p[k] = mesh->vertices[mesh->triangles[3 * (size_t)triangle + (size_t)k]];
    *normal = v3_cross(v3_sub(p[1], p[0]), v3_sub(p[2], p[0]));
    return v3_norm(*normal);
}

// direction of the mesh at a sample and its angle to that of the boundary
typedef struct mesh_side_normal {
    dem_vec3 normal;
    double angle;
} mesh_side_normal;

// points at equal steps of the area summed in the order of the tree: neighbours in the list are near each other;
// returns the area of each
static double mesh_samples(const dem_tree *mesh, size_t *count, dem_mesh_sample *samples, mesh_side_normal *normals)
{
    double total = 0, passed = 0;
    dem_vec3 p[3], n;
    for (size_t i = 0; i < mesh->count; i++)
        total += triangle_area2(mesh, mesh->order[i], p, &n);
    size_t made = 0;
    for (size_t i = 0; i < mesh->count && made < *count; i++) {
        passed += triangle_area2(mesh, mesh->order[i], p, &n);
        for (; made < *count && ((double)made + 0.5) / (double)*count * total < passed; made++) {
            // the R2 sequence (Roberts 2018), folded into the triangle
            double k = (double)made + 0.5, u = k * 0.7548776662466927, v = k * 0.5698402909980532;
            u -= floor(u);
            v -= floor(v);
            if (u + v > 1) {
                u = 1 - u;
                v = 1 - v;
            }
            samples[made].point = v3_along(v3_along(p[0], u, v3_sub(p[1], p[0])), v, v3_sub(p[2], p[0]));
            samples[made].place = (uint32_t)i;
            normals[made].normal = v3_unit(n);
        }
    }
    *count = made;
    return total / 2 / (double)made;
}

static bool mesh_side(const dem_tree *mesh, const dem_boundary *boundary, size_t count, int threads, dem_deviation *out)
{
    dem_mesh_sample *samples = dem_alloc(count, sizeof *samples);
    mesh_side_normal *normals = dem_alloc(count, sizeof *normals);
    bool done = samples && normals;
    if (done) {
        double area = mesh_samples(mesh, &count, samples, normals), angle = 0;
#pragma omp parallel for num_threads(threads) schedule(dynamic, CHUNK)
        for (size_t i = 0; i < count; i++) {
            dem_boundary_hit hit = dem_boundary_closest(boundary, samples[i].point, -1);
            dem_vec3 n = normals[i].normal;
            samples[i].distance = hit.distance;
            normals[i].angle = atan2(v3_norm(v3_cross(hit.normal, n)), v3_dot(hit.normal, n));
        }
        for (size_t i = 0; i < count; i++) {
            out->mesh_mean += samples[i].distance / (double)count;
            angle += normals[i].angle / (double)count;
        }
        out->normal_deg = angle * 180 / DEM_PI;
        done = dem_farthest_of_mesh(mesh, boundary, threads, samples, count, area, &out->largest);
    }
    free(samples);
    free(normals);
    return done;
}

static void boundary_hits(const dem_tree *mesh, const dem_boundary_point *points, size_t count, int threads,
                          dem_boundary_sample_hit *hits)
{
    // neighbours in the list are near each other: the last distance bounds the next
    size_t chunks = (count + CHUNK - 1) / CHUNK;
#pragma omp parallel for num_threads(threads) schedule(dynamic)
    for (size_t k = 0; k < chunks; k++) {
        size_t end = (k + 1) * CHUNK < count ? (k + 1) * CHUNK : count;
        double limit = INFINITY;
        for (size_t i = k * CHUNK; i < end; i++) {
            hits[i].level = dem_mesh_level(mesh, points[i].point, limit, &hits[i].closest);
            if (i + 1 < end)
                limit = 1.000001 * (fabs(hits[i].level) + v3_distance(points[i].point, points[i + 1].point));
        }
    }
}

static bool boundary_side(const dem_tree *mesh, const dem_boundary *boundary, size_t count, int threads,
                          dem_deviation *out)
{
    dem_boundary_point *points;
    if (dem_boundary_sample(boundary, count, &points, &count, NULL) != DEM_OK)
        return false;
    dem_boundary_sample_hit *hits = dem_alloc(count, sizeof *hits);
    bool done = hits != NULL;
    if (done) {
        boundary_hits(mesh, points, count, threads, hits);
        double area = 0, sum = 0;
        for (size_t i = 0; i < count; i++) {
            area += points[i].area;
            sum += points[i].area * fabs(hits[i].level);
        }
        out->union_mean = sum / area;
        done = dem_farthest_of_boundary(mesh, boundary, threads, points, hits, count, 1, &out->protrusion);
        out->largest = fmax(out->largest, out->protrusion);
        done = done && dem_farthest_of_boundary(mesh, boundary, threads, points, hits, count, -1, &out->largest);
    }
    free(points);
    free(hits);
    return done;
}

dem_status dem_deviation_measure(const dem_tree *mesh, const dem_boundary *boundary, size_t samples, int threads,
                                 dem_deviation *deviation, dem_error *error)
{
    *deviation = (dem_deviation){0};
    if (boundary_side(mesh, boundary, samples, threads, deviation) &&
        mesh_side(mesh, boundary, samples, threads, deviation))
        return DEM_OK;
    return dem_fail_memory(error);
}
