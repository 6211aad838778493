#include "clump/pack_moments.h"

#include <stdlib.h>
#include <string.h>

#include "base/status.h"
#include "clump/pack_metric.h"
#include "geom/union.h"

enum { MOST_STEPS = 40 };

static const double met_residual = 1e-11;   // well below what is promised, well above rounding
static const double promised = 1e-9;
static const double longest_move = 0.02;    // in one step [d_eq]
static const double radius_share = 0.15;    // of the radius, likewise

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
    DEM_TRY(dem_ball_union_compute(state->balls, state->count, false, &u, error));
    double want[DEM_MOMENT_COUNT], have[DEM_MOMENT_COUNT];
    const dem_moments *m = &p->grain.moments;
    list_moments(*m, want);
    list_moments(u.moments, have);
    double gyration2 = (m->second.xx + m->second.yy + m->second.zz) / m->volume;
    rows->kept = kept;
    rows->residual = 0;
    for (size_t k = 0; k < kept; k++) {
        double scale = m->volume * (k == 0 ? 1 : k < 4 ? sqrt(gyration2) : gyration2);
        rows->lack[k] = want[k] - have[k];
        rows->residual = fmax(rows->residual, fabs(rows->lack[k]) / scale);
    }
    for (size_t i = 0; i < state->count; i++)
        set_gradients(state->balls[i], &u.patches[i], i, rows);
    dem_ball_union_release(&u);
    return DEM_OK;
}

// solves the symmetric system a x = b of size n by elimination with pivots; false: singular
static bool solve(double a[DEM_MOMENT_COUNT][DEM_MOMENT_COUNT + 1], size_t n)
{
    double largest = 0;
    for (size_t i = 0; i < n; i++)
        largest = fmax(largest, a[i][i]);
    for (size_t q = 0; q < n; q++) {
        size_t pivot = q;
        for (size_t i = q + 1; i < n; i++)
            if (fabs(a[i][q]) > fabs(a[pivot][q]))
                pivot = i;
        if (!(fabs(a[pivot][q]) > 1e-12 * largest))
            return false;
        for (size_t k = 0; k <= n; k++) {
            double swap = a[q][k];
            a[q][k] = a[pivot][k];
            a[pivot][k] = swap;
        }
        for (size_t i = 0; i < n; i++) {
            double factor = i == q ? 0 : a[i][q] / a[q][q];
            for (size_t k = q; k <= n && i != q; k++)
                a[i][k] -= factor * a[q][k];
        }
    }
    for (size_t q = 0; q < n; q++)
        a[q][n] /= a[q][q];
    return true;
}

// the move of least cost that makes up for the lack to first order, shortened where it is bold; false: there is none
static bool step(dem_pack_state *state, const dem_moment_rows *rows, double (*factor)[4][4])
{
    size_t n = rows->kept;
    double a[DEM_MOMENT_COUNT][DEM_MOMENT_COUNT + 1] = {{0}};
    for (size_t i = 0; i < state->count; i++) {
        double scaled[DEM_MOMENT_COUNT][4];
        for (size_t k = 0; k < n; k++)
            metric_gradient(factor[i], rows->rows[k][i], scaled[k]);
        for (size_t k = 0; k < n; k++)
            for (size_t l = 0; l < n; l++)
                for (int d = 0; d < 4; d++)
                    a[k][l] += scaled[k][d] * scaled[l][d];
    }
    for (size_t k = 0; k < n; k++)
        a[k][n] = rows->lack[k];
    if (!solve(a, n))
        return false;
    double shorten = 1;
    for (int pass = 0; pass < 2; pass++)
        for (size_t i = 0; i < state->count; i++) {
            double y[4] = {0, 0, 0, 0}, move[4], longest = 0;
            for (size_t k = 0; k < n; k++) {
                double scaled[4];
                metric_gradient(factor[i], rows->rows[k][i], scaled);
                for (int d = 0; d < 4; d++)
                    y[d] += a[k][n] * scaled[d];
            }
            metric_leave(factor[i], y, move);
            for (int d = 0; d < 4; d++)
                longest = fmax(longest, fabs(move[d]));
            dem_ball *ball = &state->balls[i];
            if (pass == 0) {
                shorten = fmin(shorten, fmin(longest_move, radius_share * ball->radius) / fmax(longest, 1e-300));
            } else {
                ball->centre = v3_along(ball->centre, shorten, v3(move[0], move[1], move[2]));
                ball->radius += shorten * move[3];
            }
        }
    return true;
}

dem_status dem_pack_project(dem_packing *p, dem_pack_state *state, size_t kept, dem_moment_rows *rows, bool *met,
                            dem_error *error)
{
    dem_status status = dem_pack_metric(p, state, p->factor, error);
    dem_ball *before = dem_alloc(state->count, sizeof *before);
    if (status == DEM_OK && !before)
        status = dem_fail_memory(error);
    if (status != DEM_OK)
        goto done;
    memcpy(before, state->balls, state->count * sizeof *before);
    double last = INFINITY;
    for (int k = 0; k <= MOST_STEPS; k++) {
        status = dem_moment_rows_set(p, state, kept, rows, error);
        // the last digits come and go: stop when a step in that range no longer helps
        if (status != DEM_OK || rows->residual < met_residual || (rows->residual < promised && rows->residual > last / 2))
            break;
        last = rows->residual;
        if (k == MOST_STEPS || !step(state, rows, p->factor))
            break;
    }
    *met = rows->residual < promised;
    if (status == DEM_OK && !*met)
        memcpy(state->balls, before, state->count * sizeof *before);
done:
    free(before);
    return status;
}
