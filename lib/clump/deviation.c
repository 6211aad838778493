// Means over points spread evenly by area; the largest values are searched for from there.
#include "clump/deviation.h"

#include <stdlib.h>

#include "clump/farthest.h"

enum { CHUNK = 64 };

// neighbours in a list are near each other: the distance of one bounds that of the next
static double next_limit(double distance, dem_vec3 at, dem_vec3 next)
{
    return 1.000001 * (distance + v3_distance(at, next));
}

static void mesh_hits(const dem_boundary *boundary, const dem_surface_point *points, size_t count, int threads,
                      double *distance, double *angle)
{
    size_t chunks = (count + CHUNK - 1) / CHUNK;
#pragma omp parallel for num_threads(threads) schedule(dynamic)
    for (size_t k = 0; k < chunks; k++) {
        size_t end = (k + 1) * CHUNK < count ? (k + 1) * CHUNK : count;
        double limit = INFINITY;
        for (size_t i = k * CHUNK; i < end; i++) {
            dem_boundary_hit hit = dem_boundary_closest(boundary, points[i].point, -1, limit);
            dem_vec3 n = points[i].normal;
            distance[i] = hit.distance;
            angle[i] = atan2(v3_norm(v3_cross(hit.normal, n)), v3_dot(hit.normal, n));
            if (i + 1 < end)
                limit = next_limit(hit.distance, points[i].point, points[i + 1].point);
        }
    }
}

static bool mesh_side(const dem_tree *mesh, const dem_boundary *boundary, size_t count, int threads, dem_deviation *out)
{
    dem_surface_point *points = dem_alloc(count, sizeof *points);
    double *distance = dem_alloc(count, sizeof *distance), *angle = dem_alloc(count, sizeof *angle);
    bool done = points && distance && angle;
    if (done) {
        double area = dem_tree_spread(mesh, points, &count), sum = 0;
        mesh_hits(boundary, points, count, threads, distance, angle);
        for (size_t i = 0; i < count; i++) {
            out->mesh_mean += distance[i] / (double)count;
            sum += angle[i] / (double)count;
        }
        out->normal_deg = sum * 180 / DEM_PI;
        done = dem_farthest_of_mesh(mesh, boundary, threads, points, distance, count, area, &out->largest);
    }
    free(points);
    free(distance);
    free(angle);
    return done;
}

static void boundary_hits(const dem_tree *mesh, const dem_boundary_point *points, size_t count, int threads,
                          dem_boundary_sample_hit *hits)
{
    size_t chunks = (count + CHUNK - 1) / CHUNK;
#pragma omp parallel for num_threads(threads) schedule(dynamic)
    for (size_t k = 0; k < chunks; k++) {
        size_t end = (k + 1) * CHUNK < count ? (k + 1) * CHUNK : count;
        double limit = INFINITY;
        for (size_t i = k * CHUNK; i < end; i++) {
            hits[i].level = dem_mesh_level(mesh, points[i].point, limit, &hits[i].closest);
            if (i + 1 < end)
                limit = next_limit(fabs(hits[i].level), points[i].point, points[i + 1].point);
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
