// The volume and moments of a union of balls by its cross-sections: unions of discs, whose areas are summed by Gauss
// quadrature between all heights where their shape changes. Independent of geom/union.c.
#ifndef DEM_TESTS_SECTIONS_H
#define DEM_TESTS_SECTIONS_H

#include "check.h"

#include "geom/union.h"

enum { MAX_BALLS = 600, NODES = 16 };

typedef struct disc {
    double x, y, r;
} disc;

typedef struct span {
    double from, to;
} span;

static int span_order(const void *left, const void *right)
{
    double a = ((const span *)left)->from, b = ((const span *)right)->from;
    return a < b ? -1 : a > b;
}

// area of a union of discs by Green's theorem along the exposed arcs
static double discs_area(const disc *discs, size_t count)
{
    static span hidden[2 * MAX_BALLS + 1];
    double area = 0;
    for (size_t i = 0; i < count; i++) {
        disc a = discs[i];
        size_t spans = 0;
        bool covered = false;
        for (size_t j = 0; j < count && !covered; j++) {
            double dx = discs[j].x - a.x, dy = discs[j].y - a.y, d = hypot(dx, dy), r = discs[j].r;
            if (i == j || d >= a.r + r || d + r <= a.r)
                continue;
            if (d + a.r <= r) {
                covered = true;
                continue;
            }
            double middle = atan2(dy, dx), half = acos((a.r * a.r + d * d - r * r) / (2 * a.r * d));
            double from = middle - half, to = middle + half;
            from += from < 0 ? 2 * DEM_PI : 0;
            to += to < 0 ? 2 * DEM_PI : 0;
            from -= from > 2 * DEM_PI ? 2 * DEM_PI : 0;
            to -= to > 2 * DEM_PI ? 2 * DEM_PI : 0;
            if (from > to) {
                hidden[spans++] = (span){0, to};
                to = 2 * DEM_PI;
            }
            hidden[spans++] = (span){from, to};
        }
        if (covered)
            continue;
        hidden[spans++] = (span){2 * DEM_PI, 2 * DEM_PI};
        qsort(hidden, spans, sizeof *hidden, span_order);
        double reach = 0;
        for (size_t k = 0; k < spans; k++) {
            if (hidden[k].from > reach) {
                double t0 = reach, t1 = hidden[k].from;
                area += 0.5 * a.r * (a.r * (t1 - t0) + a.x * (sin(t1) - sin(t0)) - a.y * (cos(t1) - cos(t0)));
            }
            reach = fmax(reach, hidden[k].to);
        }
    }
    return area;
}

static double section_area(const dem_ball *balls, size_t count, double z)
{
    static disc discs[MAX_BALLS];
    size_t n = 0;
    for (size_t i = 0; i < count; i++) {
        double h = z - balls[i].centre.z, r2 = balls[i].radius * balls[i].radius - h * h;
        if (r2 > 0)
            discs[n++] = (disc){balls[i].centre.x, balls[i].centre.y, sqrt(r2)};
    }
    return discs_area(discs, n);
}

static bool inside_another(const dem_ball *balls, size_t count, dem_vec3 p, size_t i, size_t j, size_t k)
{
    for (size_t l = 0; l < count; l++)
        if (l != i && l != j && l != k && v3_distance(p, balls[l].centre) < balls[l].radius)
            return true;
    return false;
}

// heights of exposed points common to three spheres
static size_t triple_heights(const dem_ball *balls, size_t count, size_t i, size_t j, double *z, size_t n)
{
    dem_vec3 d = v3_sub(balls[j].centre, balls[i].centre), u = v3_unit(d);
    double dist = v3_norm(d), r = balls[i].radius, r2 = balls[j].radius;
    double h = (r * r + dist * dist - r2 * r2) / (2 * dist);
    for (size_t k = j + 1; k < count; k++) {
        // the planes of the circles (i, j) and (i, k) meet in a line p + t w
        dem_vec3 e = v3_sub(balls[k].centre, balls[i].centre);
        double g = (r * r + v3_norm2(e) - balls[k].radius * balls[k].radius) / 2;
        dem_vec3 w = v3_cross(u, e);
        double w2 = v3_norm2(w);
        if (!(v3_norm(e) < r + balls[k].radius) || w2 == 0)
            continue;
        dem_vec3 p = v3_scale(v3_add(v3_scale(v3_cross(e, w), h), v3_scale(v3_cross(w, u), g)), 1 / w2);
        double t2 = (r * r - v3_norm2(p)) / w2;
        for (int side = -1; side <= 1 && t2 > 0; side += 2) {
            dem_vec3 q = v3_add(balls[i].centre, v3_along(p, side * sqrt(t2), w));
            if (!inside_another(balls, count, q, i, j, k))
                z[n++] = q.z;
        }
    }
    return n;
}

static int double_order(const void *left, const void *right)
{
    double a = *(const double *)left, b = *(const double *)right;
    return a < b ? -1 : a > b;
}

// Gauss-Legendre nodes and weights on 0..1 by Newton's method on the Legendre polynomial
static void gauss(double node[NODES], double weight[NODES])
{
    for (int k = 0; k < NODES; k++) {
        double x = cos(DEM_PI * (k + 0.75) / (NODES + 0.5)), slope = 1;
        for (int step = 0; step < 20; step++) {
            double p0 = 1, p1 = x;
            for (int n = 2; n <= NODES; n++) {
                double p2 = ((2 * n - 1) * x * p1 - (n - 1) * p0) / n;
                p0 = p1;
                p1 = p2;
            }
            slope = NODES * (p0 - x * p1) / (1 - x * x);
            x -= p1 / slope;
        }
        node[k] = (1 + x) / 2;
        weight[k] = 1 / ((1 - x * x) * slope * slope);
    }
}

// volume, int z dV, int z^2 dV
static void sections_moments(const dem_ball *balls, size_t count, double out[3])
{
    static double z[200000];
    double node[NODES], weight[NODES];
    gauss(node, weight);
    size_t n = 0;
    for (size_t i = 0; i < count; i++) {
        double r = balls[i].radius;
        z[n++] = balls[i].centre.z - r;
        z[n++] = balls[i].centre.z + r;
        for (size_t j = i + 1; j < count; j++) {
            dem_vec3 d = v3_sub(balls[j].centre, balls[i].centre);
            double dist = v3_norm(d), r2 = balls[j].radius;
            if (dist >= r + r2 || dist <= fabs(r - r2))
                continue;
            // the lowest and highest point of the circle
            double h = (r * r + dist * dist - r2 * r2) / (2 * dist), s = sqrt(r * r - h * h);
            for (int side = -1; side <= 1; side += 2) {
                dem_vec3 u = v3_scale(d, 1 / dist), up = v3_unit(v3_along(v3(0, 0, 1), -u.z, u));
                dem_vec3 q = v3_add(balls[i].centre, v3_along(v3_scale(u, h), side * s, up));
                if (!inside_another(balls, count, q, i, j, j))
                    z[n++] = q.z;
            }
            n = triple_heights(balls, count, i, j, z, n);
        }
    }
    // short intervals, for the singularities that lie just outside of one
    for (int k = -60; k <= 60; k++)
        z[n++] = 0.025 * k;
    qsort(z, n, sizeof *z, double_order);
    out[0] = out[1] = out[2] = 0;
    for (size_t i = 0; i + 1 < n; i++) {
        double length = z[i + 1] - z[i];
        for (int k = 0; k < NODES && length > 1e-13; k++) {
            // z = a + L (3 t^2 - 2 t^3) takes the square roots at both ends out of the integrand
            double t = node[k], at = z[i] + length * t * t * (3 - 2 * t);
            double area = section_area(balls, count, at) * length * 6 * t * (1 - t) * weight[k];
            out[0] += area;
            out[1] += area * at;
            out[2] += area * at * at;
        }
    }
}

#endif
