// Pairs of parts of the same two bodies that bear side by side: where a grain is cut in two, a contact at the seam must
// not be twice as stiff, and a ring that lies flat should not care into how many parts it is cut.
//
// With u(D) the potential of one contact and r = sqrt(u), the potential of all is the largest 2 z r - z K z of any z >=
// 0 where K = exp(-distance / l) by the constant distances of the parts' middles on each of the bodies. So each bears
// z / r (its share, at most 1) of what it would alone. No force ever pulls; parts far apart have a share of 1; for a
// linear law, these are the f >= 0 that maximise f D - f K f / (2 k). K is positive definite, as products of
// exponentials of distances are.
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "sim/state.h"

enum { MOST = DEM_SOFT_PARTS * DEM_SOFT_PARTS, SWEEPS = 400, ROUNDS = 2000 };

static const double LENGTH = 0.6;      // l [equivalent diameters]
static const double ROUNDING = 1e-15;  // of a sweep that has arrived, of the largest

// ---- of a shape

// the largest eigenvalue of (shift - K) by its powers
static double largest_eigenvalue(size_t n, const double (*k)[DEM_SOFT_PARTS], double shift)
{
    double x[DEM_SOFT_PARTS], y[DEM_SOFT_PARTS], value = 0;
    for (size_t i = 0; i < n; i++)
        x[i] = 1 + 0.37 * (double)(i * i % 5) - 0.9 * (double)(i % 2);
    for (int round = 0; round < ROUNDS; round++) {
        double square = 0, norm = 0;
        for (size_t i = 0; i < n; i++) {
            y[i] = shift * x[i];
            for (size_t j = 0; j < n; j++)
                y[i] -= k[i][j] * x[j];
            square += y[i] * y[i];
            norm += x[i] * x[i];
        }
        if (!(square > 0))
            return 0;
        value = sqrt(square / norm);
        for (size_t i = 0; i < n; i++)
            x[i] = y[i] / sqrt(square);
    }
    return value;
}

void dem_soft_part_distances(const double (*spheres)[4], size_t count, double size, const uint8_t *part, size_t parts,
                             dem_soft_coupling *c)
{
    dem_vec3 middle[DEM_SOFT_PARTS] = {{0}};
    double mass[DEM_SOFT_PARTS] = {0};
    for (size_t i = 0; i < count; i++) {
        double m = spheres[i][3] * spheres[i][3] * spheres[i][3] / (size * size * size);
        mass[part[i]] += m;
        middle[part[i]] = v3_along(middle[part[i]], m, v3(spheres[i][0], spheres[i][1], spheres[i][2]));
    }
    for (size_t p = 0; p < parts; p++)
        middle[p] = v3_scale(middle[p], mass[p] > 0 ? 1 / mass[p] : 0);
    for (size_t p = 0; p < parts; p++)
        for (size_t q = 0; q < parts; q++)
            c->near[p][q] = exp(-v3_distance(middle[p], middle[q]) / (LENGTH * size));
    // no eigenvalue is above the number of parts
    double shift = (double)parts,
           least = shift - largest_eigenvalue(parts, (const double(*)[DEM_SOFT_PARTS])c->near, shift);
    c->stiffening = 1 / larger(least, 0.05);
}

// ---- of the patches of two bodies

typedef struct coupling {
    const dem_world *w;
    const dem_contact_columns *c;
    size_t begin;  // of the segment
    int form;
    const dem_soft_work *work;
} coupling;

static double depth_of(const coupling *c, const dem_soft_patch *p)
{
    double tau = c->w->soft.tau, sum = 0;
    for (uint32_t k = 0; k < p->count; k++) {
        const double *row = c->work->rows + DEM_ROW * (size_t)(p->row + k);
        double u = row[0] / tau, t = larger(0, smaller(1, 2 * (u + DEM_SOFT_REACH) / DEM_SOFT_REACH));
        if (t > 0)
            sum += row[7] * (t * t * (3 - 2 * t)) * exp((row[0] - p->deepest) / tau);
    }
    return sum > 0 ? p->deepest + tau * log(sum) : -INFINITY;
}

// how near the parts of two patches are
static double nearness(const coupling *c, const dem_soft_patch *p, const dem_soft_patch *q)
{
    const dem_soft *soft = &c->w->soft;
    const uint32_t *a = c->c->sphere_a, *b = c->c->sphere_b;
    size_t i = c->begin + p->place, k = c->begin + q->place;
    double near = soft->couplings[c->w->bodies.shape[c->c->a[i]]].near[soft->part[a[i]]][soft->part[a[k]]];
    if (c->form < 0)
        near *= soft->couplings[c->w->bodies.shape[c->c->b[i]]].near[soft->part[b[i]]][soft->part[b[k]]];
    if (c->form != DEM_FORM_MESH)
        return near;
    // at a mesh, only what is grouped by about the same normal
    const double *n = c->work->rows + DEM_ROW * (size_t)p->place + 1,
                 *m = c->work->rows + DEM_ROW * (size_t)q->place + 1;
    bool other = soft->part[a[i]] != soft->part[a[k]];
    return other && n[0] * m[0] + n[1] * m[1] + n[2] * m[2] > DEM_SOFT_NEAR ? near : 0;
}

// z >= 0 with the largest 2 z r - z K z, one after the other
static void find_shares(size_t n, const double (*k)[MOST], const double *r, double *z)
{
    double most = 0;
    for (size_t i = 0; i < n; i++) {
        z[i] = r[i];
        most = larger(most, r[i]);
    }
    for (int sweep = 0; sweep < SWEEPS; sweep++) {
        double change = 0;
        for (size_t i = 0; i < n; i++) {
            double next = r[i];
            for (size_t j = 0; j < n; j++)
                next -= j == i ? 0 : k[i][j] * z[j];
            next = larger(0, next);
            change = larger(change, fabs(next - z[i]));
            z[i] = next;
        }
        if (!(change > ROUNDING * most))
            return;
    }
}

// of the patches [first, end)
static void couple(const coupling *c, size_t first, size_t end)
{
    const dem_soft_patch *p = c->work->patches;
    size_t at = c->begin + p[first].place, n = 0, which[MOST];
    const double *law = c->w->laws.rows + (c->c->law ? (size_t)LAW_SLOTS * c->c->law[at] : 0);
    double r[MOST], z[MOST], k[MOST][MOST];
    for (size_t i = first; i < end && n < MOST; i++) {
        double depth = depth_of(c, &p[i]) / c->w->soft.tau;
        if (!(depth > 0))
            continue;
        which[n] = i;
        r[n++] = law[LAW_HERTZ] > 0 ? depth * sqrt(sqrt(depth)) : depth;
    }
    if (n < 2)
        return;
    for (size_t i = 0; i < n; i++)
        for (size_t j = 0; j < n; j++)
            k[i][j] = i == j ? 1 : nearness(c, &p[which[i]], &p[which[j]]);
    find_shares(n, (const double(*)[MOST])k, r, z);
    double stiffening = dem_soft_stiffening(c->w, c->c->a[at], c->form < 0 ? c->c->b[at] : c->c->a[at], c->form);
    for (size_t i = 0; i < n; i++) {
        c->work->share[2 * which[i]] = z[i] / r[i];
        c->work->share[2 * which[i] + 1] = stiffening;
    }
}

double dem_soft_stiffening(const dem_world *w, uint32_t a, uint32_t b, int form)
{
    const dem_soft_coupling *c = w->soft.couplings;
    if (!c)
        return 1;
    double own = c[w->bodies.shape[a]].stiffening;
    return form < 0 ? own * c[w->bodies.shape[b]].stiffening : own;
}

static bool same_bodies(const coupling *c, const dem_soft_patch *p, const dem_soft_patch *q)
{
    size_t i = c->begin + p->place, k = c->begin + q->place;
    if (c->c->a[i] != c->c->a[k])
        return false;
    if (c->form >= 0)
        return c->c->sphere_b[i] == c->c->sphere_b[k];
    return c->c->b[i] == c->c->b[k] && !(c->c->shift && c->c->shift[i] != c->c->shift[k]);
}

void dem_soft_couple(const dem_world *w, const dem_contacts *contacts, size_t segment, int form,
                     const dem_soft_work *work, size_t count)
{
    const coupling c = {w, &contacts->columns, contacts->segments[segment].begin, form, work};
    for (size_t first = 0, end; first < count; first = end) {
        for (end = first; end < count && same_bodies(&c, &work->patches[first], &work->patches[end]); end++)
            work->share[2 * end] = work->share[2 * end + 1] = 1;
        if (end - first > 1)
            couple(&c, first, end);
    }
}
