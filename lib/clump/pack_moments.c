#include "clump/pack_moments.h"

#include <stdlib.h>
#include <string.h>

#include "base/status.h"
#include "clump/pack_metric.h"
#include "geom/union.h"
#include "math/solve.h"

enum { MOST_STEPS = 40 };

static const double met_residual = 1e-11;   // well below what is promised, well above rounding
static const double promised = 1e-9;
static const double longest_move = 0.02;    // in one step [d_eq]
static const double radius_share = 0.15;    // of the radius, likewise
static const double bold = 0.3;             // a step shortened to less spreads the next ones more evenly
static const double most_even = 10;
static const double least_damping = 1e-9, most_damping = 1e3;
static const double shaken = 0.02;          // of a radius
static const double singular = 1e-12;       // of a pivot, against the largest

static const int first_of[6] = {0, 1, 2, 0, 0, 1}, second_of[6] = {0, 1, 2, 1, 2, 2};

dem_status dem_moment_rows_init(dem_packing *p, dem_moment_rows *rows, dem_error *error)
{
    *rows = (dem_moment_rows){0};
    for (int k = 0; k < DEM_MOMENT_COUNT; k++)
        rows->rows[k] = dem_arena_take(&p->arena, p->capacity, sizeof *rows->rows[k]);
    return p->arena.failed ? dem_fail_memory(error) : DEM_OK;
}

// int n_a n_b n_c over the patch
static double third_of(const dem_patch *patch, int a, int b, int c)
{
    static const int at[3][3][3] = {{{0, 1, 2}, {1, 3, 4}, {2, 4, 5}},
                                    {{1, 3, 4}, {3, 6, 7}, {4, 7, 8}},
                                    {{2, 4, 5}, {4, 7, 8}, {5, 8, 9}}};
    return patch->third[at[a][b][c]];
}

// r^2 int f(c + r n) (n, 1) dn for f = 1, x_a, x_a x_b
static void set_gradients(dem_ball ball, const dem_patch *patch, size_t i, dem_moment_rows *rows)
{
    double r = ball.radius, r2 = r * r, c[3] = {ball.centre.x, ball.centre.y, ball.centre.z};
    double n[4] = {patch->first.x, patch->first.y, patch->first.z, patch->area};
    dem_sym3 s = patch->second;
    double q[3][4] = {{s.xx, s.xy, s.xz, n[0]}, {s.xy, s.yy, s.yz, n[1]}, {s.xz, s.yz, s.zz, n[2]}};
    for (int d = 0; d < 4; d++) {
        rows->rows[0][i][d] = r2 * n[d];
        for (int a = 0; a < 3; a++)
            rows->rows[1 + a][i][d] = r2 * (c[a] * n[d] + r * q[a][d]);
        for (int k = 0; k < 6; k++) {
            int a = first_of[k], b = second_of[k];
            double third = d < 3 ? third_of(patch, a, b, d) : q[a][b];
            rows->rows[4 + k][i][d] = r2 * (c[a] * c[b] * n[d] + r * (c[a] * q[b][d] + c[b] * q[a][d]) + r2 * third);
        }
    }
}

static void list_moments(dem_moments m, double list[DEM_MOMENT_COUNT])
{
    const double all[DEM_MOMENT_COUNT] = {m.volume, m.first.x, m.first.y, m.first.z, m.second.xx,
                                          m.second.yy, m.second.zz, m.second.xy, m.second.xz, m.second.yz};
    memcpy(list, all, sizeof all);
}

dem_status dem_moment_rows_set(dem_packing *p, const dem_pack_state *state, size_t kept, dem_moment_rows *rows,
                               dem_error *error)
{
    dem_ball_union u;
    DEM_TRY(dem_ball_union_compute(state->balls, state->count, false, dem_threads(p->ctx), &u, error));
    double want[DEM_MOMENT_COUNT], have[DEM_MOMENT_COUNT];
    const dem_moments *m = &p->grain->moments;
    list_moments(*m, want);
    list_moments(u.moments, have);
    double gyration2 = (m->second.xx + m->second.yy + m->second.zz) / m->volume;
    rows->kept = kept;
    rows->residual = rows->merit = 0;
    for (size_t k = 0; k < kept; k++) {
        rows->scale[k] = m->volume * (k == 0 ? 1 : k < 4 ? sqrt(gyration2) : gyration2);
        rows->lack[k] = want[k] - have[k];
        rows->residual = fmax(rows->residual, fabs(rows->lack[k]) / rows->scale[k]);
        rows->merit += rows->lack[k] * rows->lack[k] / (rows->scale[k] * rows->scale[k]);
    }
    for (size_t i = 0; i < state->count; i++)
        set_gradients(state->balls[i], &u.patches[i], i, rows);
    dem_ball_union_release(&u);
    return DEM_OK;
}

// Multipliers of the moments' gradients in the move of least cost that makes up for the lack to first order; with
// damping less of what is hard to make up for.
static bool set_multipliers(const dem_packing *p, const dem_pack_state *state, const dem_moment_rows *rows,
                            double damping, double multiplier[DEM_MOMENT_COUNT])
{
    size_t n = rows->kept;
    double a[DEM_MOMENT_COUNT][DEM_MOMENT_COUNT + 1] = {{0}}, largest = 0;
    for (size_t i = 0; i < state->count; i++) {
        double scaled[DEM_MOMENT_COUNT][4];
        for (size_t k = 0; k < n; k++)
            metric_gradient(p->factor[i], rows->rows[k][i], scaled[k]);
        for (size_t k = 0; k < n; k++)
            for (size_t l = 0; l < n; l++)
                for (int d = 0; d < 4; d++)
                    a[k][l] += scaled[k][d] * scaled[l][d];
    }
    for (size_t k = 0; k < n; k++) {
        for (size_t l = 0; l < n; l++)
            a[k][l] /= rows->scale[k] * rows->scale[l];
        largest = fmax(largest, a[k][k]);
        a[k][n] = rows->lack[k] / rows->scale[k];
    }
    for (size_t k = 0; k < n; k++)
        a[k][k] += damping * largest;
    if (!dem_solve(&a[0][0], DEM_MOMENT_COUNT + 1, n, singular * largest))
        return false;
    for (size_t k = 0; k < n; k++)
        multiplier[k] = a[k][n] / rows->scale[k];
    return true;
}

static void ball_move(const dem_packing *p, size_t i, const dem_moment_rows *rows, const double *multiplier,
                      double move[4])
{
    double sum[4] = {0, 0, 0, 0}, y[4];
    for (size_t k = 0; k < rows->kept; k++)
        for (int d = 0; d < 4; d++)
            sum[d] += multiplier[k] * rows->rows[k][i][d];
    metric_gradient(p->factor[i], sum, y);
    metric_leave(p->factor[i], y, move);
}

// one Newton step, shortened where it is bold; `taken` is the part of it that was left. False: there is none
static bool step(const dem_packing *p, dem_pack_state *state, const dem_moment_rows *rows, double damping, double *taken)
{
    double multiplier[DEM_MOMENT_COUNT], move[4];
    if (!set_multipliers(p, state, rows, damping, multiplier))
        return false;
    *taken = 1;
    for (size_t i = 0; i < state->count; i++) {
        double longest = 1e-300;
        ball_move(p, i, rows, multiplier, move);
        for (int d = 0; d < 4; d++)
            longest = fmax(longest, fabs(move[d]));
        *taken = fmin(*taken, fmin(longest_move, radius_share * state->balls[i].radius) / longest);
    }
    for (size_t i = 0; i < state->count; i++) {
        dem_ball *ball = &state->balls[i];
        ball_move(p, i, rows, multiplier, move);
        ball->centre = v3_along(ball->centre, *taken, v3(move[0], move[1], move[2]));
        ball->radius += *taken * move[3];
    }
    return true;
}

// Levenberg (1944) on the lacks: undamped as long as the steps get nearer. `trial` gets the gradients of the step tried.
static dem_status newton(dem_packing *p, dem_pack_state *state, size_t kept, dem_moment_rows *rows,
                         dem_moment_rows *trial, dem_ball *before, dem_error *error)
{
    double taken = 1, evenness = dem_metric_evenness, damping = 0;
    DEM_TRY(dem_pack_metric(p, state, error));
    DEM_TRY(dem_moment_rows_set(p, state, kept, rows, error));
    for (int k = 0; k < MOST_STEPS && rows->residual >= met_residual && damping < most_damping; k++) {
        DEM_TRY(dem_pack_go_on(p, error));
        memcpy(before, state->balls, state->count * sizeof *before);
        if (!step(p, state, rows, damping, &taken)) {
            damping = fmax(10 * damping, least_damping);
            continue;
        }
        DEM_TRY(dem_moment_rows_set(p, state, kept, trial, error));
        if (trial->merit < rows->merit) {
            dem_moment_rows better = *trial;
            *trial = *rows;
            *rows = better;
            damping = damping > least_damping ? damping / 10 : 0;
        } else {
            memcpy(state->balls, before, state->count * sizeof *before);
            if (rows->residual < promised)  // the last digits come and go
                break;
            damping = fmax(10 * damping, least_damping);
        }
        if (taken < bold && evenness < most_even) {
            evenness *= 3;
            dem_pack_metric_set(p, state->count, evenness);
        }
    }
    return DEM_OK;
}

// off the places where a symmetric clump cannot change a moment to first order
static void shake(dem_packing *p, dem_pack_state *state)
{
    for (size_t i = 0; i < state->count; i++) {
        dem_vec3 d = v3(random_uniform(&p->random) - 0.5, random_uniform(&p->random) - 0.5, random_uniform(&p->random) - 0.5);
        state->balls[i].centre = v3_along(state->balls[i].centre, shaken * state->balls[i].radius, d);
    }
}

dem_status dem_pack_project(dem_packing *p, dem_pack_state *state, size_t kept, dem_moment_rows *rows,
                            dem_moment_rows *spare, bool *met, dem_error *error)
{
    size_t bytes = state->count * sizeof(dem_ball);
    dem_ball *before = dem_alloc(3 * state->count, sizeof *before);
    if (!before)
        return dem_fail_memory(error);
    dem_ball *last = before + state->count, *nearest = last + state->count;
    memcpy(before, state->balls, bytes);
    dem_status status = newton(p, state, kept, rows, spare, last, error);
    *met = rows->residual < promised;
    if (status == DEM_OK && !*met) {
        double merit = rows->merit;
        memcpy(nearest, state->balls, bytes);
        memcpy(state->balls, before, bytes);
        shake(p, state);
        status = newton(p, state, kept, rows, spare, last, error);
        *met = rows->residual < promised;
        if (!*met && merit < rows->merit)
            memcpy(state->balls, nearest, bytes);
    }
    free(before);
    return status;
}
