// Harmonics of a given mesh: c_nm = int r(u) Y_nm(u) du over the sphere, by Gauss-Legendre nodes in z and even steps
// around it. Piecewise flat surfaces have no highest degree, so there are many more nodes than a sum of that degree
// would need; what is left of the rest folds back as r's own power far beyond the degree.
#include <stdlib.h>

#include "base/memory.h"
#include "geom/spread.h"
#include "mesh/harmonics.h"

enum { ROWS = 128, COLUMNS = 2 * ROWS, SAMPLES = 20000 };

static const double OUTSIDE = 1e-3;  // part of the rays that may miss by rounding at an edge

// what a ray meets
typedef struct hits {
    size_t count;
    double first, last;  // [m]
} hits;

static void keep_hit(void *user, uint32_t triangle, int leaving, double t)
{
    (void)triangle, (void)leaving;
    hits *h = user;
    h->count++;
    h->first = fmin(h->first, t);
    h->last = fmax(h->last, t);
}

// nodes and weights of Gauss & Legendre by Newton's method
static void legendre_nodes(double *nodes, double *weights)
{
    for (int i = 0; i < ROWS; i++) {
        double x = cos(DEM_PI * (i + 0.75) / (ROWS + 0.5)), slope = 1;
        for (int k = 0; k < 10; k++) {
            double before = 1, p = x;
            for (int n = 2; n <= ROWS; n++) {
                double next = ((2 * n - 1) * x * p - (n - 1) * before) / n;
                before = p;
                p = next;
            }
            slope = ROWS * (x * p - before) / (x * x - 1);
            x -= p / slope;
        }
        nodes[i] = x;
        weights[i] = 2 / ((1 - x * x) * slope * slope);
    }
}

static dem_vec3 node_direction(const double *nodes, size_t ray)
{
    // half a step aside, so that no plane of symmetry of a mesh along the axes is hit along its edges
    double z = nodes[ray / COLUMNS], angle = 2 * DEM_PI * ((double)(ray % COLUMNS) + 0.5) / COLUMNS,
           s = sqrt(1 - z * z);
    return v3(s * cos(angle), s * sin(angle), z);
}

// the radius in every direction of the nodes; NAN where the ray meets nothing
static void look_around(const dem_ctx *ctx, const dem_tree *tree, const double *nodes, double *radii,
                        dem_harmonics_fit *fit)
{
    size_t hidden = 0;
    double deepest = 0;
#pragma omp parallel for num_threads(dem_threads(ctx)) reduction(+ : hidden) reduction(max : deepest)
    for (size_t i = 0; i < (size_t)ROWS * COLUMNS; i++) {
        hits h = {.first = INFINITY};
        dem_tree_ray(tree, fit->centre, node_direction(nodes, i), keep_hit, &h);
        radii[i] = h.count ? h.last : NAN;
        // one surface met at the edge of two of its triangles is no second one
        if (h.count > 1 && h.last - h.first > 1e-9 * fit->equivalent_diameter) {
            hidden++;
            deepest = h.last - h.first > deepest ? h.last - h.first : deepest;
        }
    }
    fit->rays = (size_t)ROWS * COLUMNS;
    fit->hidden = (double)hidden / (double)fit->rays;
    fit->hidden_depth = deepest;
}

// rays that slipped through take their neighbour's radius; many of them mean that the centre is outside
static dem_status mend_misses(double *radii, size_t count, dem_error *error)
{
    size_t missing = 0;
    for (size_t i = 0; i < count; i++)
        missing += isnan(radii[i]);
    if ((double)missing > OUTSIDE * (double)count)
        return dem_fail(
            error, DEM_BAD_INPUT,
            "its centre of mass lies outside of it: in %.3g %% of all directions there is no surface, so no "
            "harmonics fit; cut it into rounder pieces",
            100 * (double)missing / (double)count);
    for (size_t i = 0; i < count && missing; i++)
        for (size_t k = 1; k < count && isnan(radii[i]); k++)
            radii[i] = radii[(i + k) % count];
    return DEM_OK;
}

// the coefficients of row after row: Legendre functions of z by the same recurrence as the radius'
static void project(dem_harmonics *h, const double *nodes, const double *weights, const double *radii)
{
    for (int row = 0; row < ROWS; row++) {
        double z = nodes[row], s = sqrt(1 - z * z), power = 1;
        for (int m = 0; m <= h->degree; m++, power *= s) {
            double even = 0, odd = 0, before = 0, p = h->sector[m];
            for (int k = 0; k < COLUMNS; k++) {
                double angle = 2 * DEM_PI * (k + 0.5) / COLUMNS * m;
                even += radii[row * COLUMNS + k] * cos(angle);
                odd += radii[row * COLUMNS + k] * sin(angle);
            }
            double factor = weights[row] * 2 * DEM_PI / COLUMNS * power * (m ? sqrt(2.0) : 1);
            for (int n = m;; n++) {
                h->c[harmonics_term(n, m)] += factor * p * even;
                if (m)
                    h->c[harmonics_term(n, -m)] += factor * p * odd;
                if (n == h->degree)
                    break;
                double next = h->rise[harmonics_term(n + 1, m)] * z * p - h->fall[harmonics_term(n + 1, m)] * before;
                before = p;
                p = next;
            }
        }
    }
}

dem_status dem_harmonics_fit_mesh(const dem_ctx *ctx, const dem_mesh *mesh, int degree, dem_harmonics *h,
                                  dem_harmonics_fit *fit, dem_error *error)
{
    dem_solid solid = dem_mesh_solid(mesh);
    *fit = (dem_harmonics_fit){
        .centre = solid.centre, .volume = solid.volume, .equivalent_diameter = cbrt(6 * solid.volume / DEM_PI)};
    dem_harmonics_init(h, degree);
    double nodes[ROWS], weights[ROWS], *radii = dem_alloc((size_t)ROWS * COLUMNS, sizeof *radii);
    if (!radii)
        return dem_fail_memory(error);
    dem_tree tree;
    dem_status status = dem_tree_build(&tree, mesh->vertices, mesh->triangles, mesh->triangle_count, error);
    if (status == DEM_OK) {
        legendre_nodes(nodes, weights);
        look_around(ctx, &tree, nodes, radii, fit);
        dem_tree_release(&tree);
        status = mend_misses(radii, fit->rays, error);
    }
    if (status == DEM_OK)
        project(h, nodes, weights, radii);
    free(radii);
    return status;
}

// from the surface of one mesh to the other's
static dem_status measure_way(const dem_mesh *from, const dem_tree *to, double *square, double *largest,
                              dem_error *error)
{
    dem_tree tree;
    DEM_TRY(dem_tree_build(&tree, from->vertices, from->triangles, from->triangle_count, error));
    size_t count = SAMPLES;
    dem_surface_point *points = dem_alloc(count, sizeof *points);
    if (points) {
        dem_tree_spread(&tree, points, &count);
        double sum = 0;
        for (size_t i = 0; i < count; i++) {
            double d = dem_tree_closest(to, points[i].point, INFINITY, NULL, NULL);
            sum += d * d;
            *largest = fmax(*largest, d);
        }
        *square = sum / (double)count;
    }
    // extremes are at vertices more often than between them
    for (size_t i = 0; i < from->vertex_count && points; i++)
        *largest = fmax(*largest, dem_tree_closest(to, from->vertices[i], INFINITY, NULL, NULL));
    dem_tree_release(&tree);
    free(points);
    return points ? DEM_OK : dem_fail_memory(error);
}

dem_status dem_mesh_distance(const dem_mesh *a, const dem_mesh *b, dem_surface_distance *distance, dem_error *error)
{
    dem_tree one, other;
    *distance = (dem_surface_distance){0};
    DEM_TRY(dem_tree_build(&one, a->vertices, a->triangles, a->triangle_count, error));
    dem_status status = dem_tree_build(&other, b->vertices, b->triangles, b->triangle_count, error);
    double square[2] = {0};
    if (status == DEM_OK) {
        status = measure_way(a, &other, &square[0], &distance->largest, error);
        if (status == DEM_OK)
            status = measure_way(b, &one, &square[1], &distance->largest, error);
        dem_tree_release(&other);
    }
    dem_tree_release(&one);
    distance->rms = sqrt((square[0] + square[1]) / 2);
    return status;
}
