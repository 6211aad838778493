// Shares m_i with sum_i a_i m_i = b, nearest to the shares w_i by volume: minimise sum (m_i - w_i)^2 / w_i where
// m_i >= LEAST w_i. With a multiplier l for each equation m_i = w_i max(1 + a_i.l, LEAST), and l maximises a concave
// function, smooth but for a jump in its second derivative: Newton's method with a line search. No solution shows by
// steps without end.
#include "out/mass_shares.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/status.h"
#include "math/solve.h"
#include "math/vec.h"

enum {
    EQUATIONS = 10,  // mass, centre, second moments
    OF_CENTRE = 4,   // mass and centre alone
    MOST_STEPS = 60,
    MOST_HALVINGS = 40,
};

static const double LEAST = 1e-3;      // of the share by volume: programs refuse atoms without mass
static const double MET = 1e-13;       // residual, all sizes near 1
static const double ROUNDING = 1e-14;  // of the cost, likewise
static const double DAMPING = 1e-12;   // of the largest diagonal entry, where equations depend on each other

typedef struct sharing {
    size_t count, equations;
    double (*a)[EQUATIONS];  // of each sphere
    double *weight;          // by volume, sum 1
    double b[EQUATIONS];
} sharing;

// in units of the clump's mass and of its radius of gyration
static void set_equations(sharing *s, const dem_clump_def *clump)
{
    const double *moment = clump->inertia;
    double half = (moment[0] + moment[1] + moment[2]) / 2, length = sqrt(half / clump->mass), volume = 0;
    for (size_t i = 0; i < s->count; i++) {
        dem_vec3 x = v3_scale(clump->balls[i].centre, 1 / length);
        double r = clump->balls[i].radius / length, own = r * r / 5;
        const double row[EQUATIONS] = {
            1, x.x, x.y, x.z, x.x * x.x + own, x.y * x.y + own, x.z * x.z + own, x.x * x.y, x.x * x.z, x.y * x.z};
        memcpy(s->a[i], row, sizeof row);
        s->weight[i] = r * r * r;
        volume += s->weight[i];
    }
    for (size_t i = 0; i < s->count; i++)
        s->weight[i] /= volume;
    const double want[EQUATIONS] = {1, 0, 0, 0, 1 - moment[0] / half, 1 - moment[1] / half, 1 - moment[2] / half};
    memcpy(s->b, want, sizeof want);
}

// 1 + a_i.l
static double slope(const sharing *s, size_t i, const double *l)
{
    double sum = 1;
    for (size_t k = 0; k < s->equations; k++)
        sum += s->a[i][k] * l[k];
    return sum;
}

// what is minimised over l
static double cost(const sharing *s, const double *l)
{
    double sum = 0;
    for (size_t i = 0; i < s->count; i++) {
        double t = slope(s, i, l);
        sum += s->weight[i] * (t > LEAST ? t * t / 2 : LEAST * t - LEAST * LEAST / 2);
    }
    for (size_t k = 0; k < s->equations; k++)
        sum -= s->b[k] * l[k];
    return sum;
}

// the shares for l, the largest residual, and the equations of Newton's step
static double set_shares(const sharing *s, const double *l, double *shares, double newton[EQUATIONS][EQUATIONS + 1])
{
    size_t n = s->equations;
    double largest = 0, residual = 0;
    memset(newton, 0, sizeof(double[EQUATIONS][EQUATIONS + 1]));
    for (size_t k = 0; k < n; k++)
        newton[k][n] = s->b[k];
    for (size_t i = 0; i < s->count; i++) {
        double t = slope(s, i, l);
        shares[i] = s->weight[i] * fmax(t, LEAST);
        for (size_t k = 0; k < n; k++) {
            newton[k][n] -= s->a[i][k] * shares[i];
            for (size_t j = 0; j < n && t > LEAST; j++)
                newton[k][j] += s->weight[i] * s->a[i][k] * s->a[i][j];
        }
    }
    for (size_t k = 0; k < n; k++) {
        largest = fmax(largest, newton[k][k]);
        residual = fmax(residual, fabs(newton[k][n]));
    }
    for (size_t k = 0; k < n; k++)
        newton[k][k] += DAMPING * largest;
    return residual;
}

// one step downhill; false: there is none
static bool descend(const sharing *s, double *l, double newton[EQUATIONS][EQUATIONS + 1])
{
    size_t n = s->equations;
    double before = cost(s, l), trial[EQUATIONS], part = 1;
    if (!dem_solve(&newton[0][0], EQUATIONS + 1, n, 0))
        return false;
    for (int h = 0; h < MOST_HALVINGS; h++, part /= 2) {
        for (size_t k = 0; k < n; k++)
            trial[k] = l[k] + part * newton[k][n];
        if (cost(s, trial) <= before + ROUNDING) {
            memcpy(l, trial, n * sizeof *l);
            return true;
        }
    }
    return false;
}

static bool share(const sharing *s, double *shares)
{
    double l[EQUATIONS] = {0}, newton[EQUATIONS][EQUATIONS + 1];
    for (int step = 0; step < MOST_STEPS; step++) {
        if (set_shares(s, l, shares, newton) < MET)
            return true;
        if (!descend(s, l, newton))
            return false;
    }
    return false;
}

dem_status dem_mass_shares(const dem_clump_def *clump, double *masses, dem_shares_meet *meet, dem_error *error)
{
    sharing s = {.count = clump->ball_count};
    s.a = dem_alloc(s.count, sizeof *s.a);
    s.weight = dem_alloc(s.count, sizeof *s.weight);
    bool room = s.a && s.weight;
    if (room) {
        set_equations(&s, clump);
        *meet = DEM_SHARES_INERTIA;
        s.equations = EQUATIONS;
        if (!share(&s, masses)) {
            *meet = DEM_SHARES_CENTRE;
            s.equations = OF_CENTRE;
            if (!share(&s, masses)) {
                *meet = DEM_SHARES_MASS;
                memcpy(masses, s.weight, s.count * sizeof *masses);
            }
        }
        for (size_t i = 0; i < s.count; i++)
            masses[i] *= clump->mass;
    }
    free(s.a);
    free(s.weight);
    return room ? DEM_OK : dem_fail_memory(error);
}
