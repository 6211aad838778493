// Limited-memory BFGS (Nocedal 1980) on the symmetric difference by lines, in the variables of pack_metric.h.
#include "clump/pack_polish.h"

#include <string.h>

#include "base/status.h"
#include "clump/pack_connect.h"
#include "clump/pack_metric.h"

enum { HISTORY = 12, TRIALS = 6, LOOK_EVERY = 5 };

static const double longest_move = 0.01;     // of a coordinate in one step [d_eq]
static const double first_move = 0.002;      // of the first step [d_eq]
static const double sufficient = 1e-4;       // Armijo's share of the promised decrease
static const double shorten = 0.4;           // a step that failed
static const double link_stiffness = 20;     // of a link against volume [-]

typedef struct descent {
    dem_packing *p;
    dem_lines *lines;
    dem_pack_state *state;
    size_t count, size;             // balls, variables
    double (*slope)[4];             // gradient as the lines give it
    double *x, *g, *next_x, *next_g, *direction;
    double *move[HISTORY], *change[HISTORY], product[HISTORY];
    size_t history;
    double *tangent[10];
    size_t tangent_count;
    double value;
    bool strayed;                   // it was not evaluated at `x` last
    dem_line_volumes volumes;       // where it was
    dem_status status;
    dem_error *error;
} descent;

static double dot(const double *a, const double *b, size_t n)
{
    double lane[8] = {0};
    size_t i = 0;
    for (; i + 8 <= n; i += 8)
        for (size_t l = 0; l < 8; l++)
            lane[l] += a[i + l] * b[i + l];
    for (; i < n; i++)
        lane[i % 8] += a[i] * b[i];
    return ((lane[0] + lane[4]) + (lane[2] + lane[6])) + ((lane[1] + lane[5]) + (lane[3] + lane[7]));
}

static void add_scaled(double *a, double s, const double *b, size_t n)
{
    for (size_t i = 0; i < n; i++)
        a[i] += s * b[i];
}

static dem_status take_work_space(descent *d, dem_arena *arena, dem_error *error)
{
    d->slope = dem_arena_take(arena, d->count, sizeof *d->slope);
    double **vectors[] = {&d->x, &d->g, &d->next_x, &d->next_g, &d->direction};
    for (size_t k = 0; k < sizeof vectors / sizeof *vectors; k++)
        *vectors[k] = dem_arena_take(arena, d->size, sizeof(double));
    for (int k = 0; k < HISTORY; k++) {
        d->move[k] = dem_arena_take(arena, d->size, sizeof(double));
        d->change[k] = dem_arena_take(arena, d->size, sizeof(double));
    }
    for (size_t k = 0; k < d->tangent_count; k++)
        d->tangent[k] = dem_arena_take(arena, d->size, sizeof(double));
    return arena->failed ? dem_fail_memory(error) : DEM_OK;
}

static void project(const descent *d, double *vector)
{
    for (size_t k = 0; k < d->tangent_count; k++)
        add_scaled(vector, -dot(d->tangent[k], vector, d->size), d->tangent[k], d->size);
}

static void add_links(descent *d, const dem_ball *balls, double *value)
{
    dem_packing *p = d->p;
    size_t open = dem_pack_links(p, balls, d->count, dem_pack_spring_overlap);
    for (size_t k = 0; k < open; k++) {
        const dem_link *link = &p->links[k];
        dem_vec3 u = v3_unit(v3_sub(balls[link->i].centre, balls[link->j].centre));
        double force = 2 * link_stiffness * link->gap, axis[3] = {u.x, u.y, u.z};
        *value += link_stiffness * link->gap * link->gap;
        for (int a = 0; a < 3; a++) {
            d->slope[link->i][a] += force * axis[a];
            d->slope[link->j][a] -= force * axis[a];
        }
        d->slope[link->i][3] -= force;
        d->slope[link->j][3] -= force;
    }
}

// the balls of scaled variables x, value and projected gradient there; INFINITY where it failed
static double evaluate(descent *d, const double *x, double *g)
{
    dem_pack_state *state = d->state;
    for (size_t i = 0; i < d->count; i++) {
        double v[4];
        metric_leave(d->p->factor[i], x + 4 * i, v);
        state->balls[i] = (dem_ball){v3(v[0], v[1], v[2]), fmax(v[3], dem_pack_smallest_radius)};
    }
    dem_ball_columns_set(&d->p->columns, state->balls, state->count);
    d->status = dem_pack_go_on(d->p, d->error);
    if (d->status == DEM_OK)
        d->status = dem_lines_measure(d->lines, &d->p->columns, d->slope, &d->volumes, d->error);
    if (d->status != DEM_OK)
        return INFINITY;
    double value = d->volumes.difference;
    if (d->p->connected)
        add_links(d, state->balls, &value);
    for (size_t i = 0; i < d->count; i++)
        metric_gradient(d->p->factor[i], d->slope[i], g + 4 * i);
    project(d, g);
    return value;
}

// the directions that are to stay free of moves, made orthonormal
static void set_tangent(descent *d, dem_polish_options options)
{
    size_t kept = 0;
    for (size_t k = 0; k < options.tangent_count; k++) {
        double *row = d->tangent[kept];
        for (size_t i = 0; i < d->count; i++)
            metric_gradient(d->p->factor[i], options.tangent[k][i], row + 4 * i);
        for (int pass = 0; pass < 2; pass++)
            for (size_t q = 0; q < kept; q++)
                add_scaled(row, -dot(d->tangent[q], row, d->size), d->tangent[q], d->size);
        double norm = sqrt(dot(row, row, d->size));
        if (!(norm > 1e-10))
            continue;
        for (size_t i = 0; i < d->size; i++)
            row[i] /= norm;
        kept++;
    }
    d->tangent_count = kept;
}

// two-loop recursion; without a history steepest descent of a modest length
static double set_direction(descent *d)
{
    double alpha[HISTORY], *v = d->direction;
    memcpy(v, d->g, d->size * sizeof *v);
    for (size_t k = d->history; k-- > 0;) {
        alpha[k] = dot(d->move[k], v, d->size) / d->product[k];
        add_scaled(v, -alpha[k], d->change[k], d->size);
    }
    double scale;
    if (d->history) {
        size_t k = d->history - 1;
        scale = d->product[k] / dot(d->change[k], d->change[k], d->size);
    } else {
        double longest = 0;
        for (size_t i = 0; i < d->count; i++) {
            double move[4];
            metric_leave(d->p->factor[i], v + 4 * i, move);
            for (int a = 0; a < 4; a++)
                longest = fmax(longest, fabs(move[a]));
        }
        scale = first_move / fmax(longest, 1e-300);
    }
    for (size_t i = 0; i < d->size; i++)
        v[i] *= scale;
    for (size_t k = 0; k < d->history; k++)
        add_scaled(v, alpha[k] - dot(d->change[k], v, d->size) / d->product[k], d->move[k], d->size);
    return dot(v, d->g, d->size);
}

static double step_limit(const descent *d)
{
    double longest = 0;
    for (size_t i = 0; i < d->count; i++) {
        double move[4];
        metric_leave(d->p->factor[i], d->direction + 4 * i, move);
        for (int a = 0; a < 4; a++)
            longest = fmax(longest, fabs(move[a]));
    }
    return longest > longest_move ? longest_move / longest : 1;
}

static void remember(descent *d)
{
    if (d->history == HISTORY) {
        double *move = d->move[0], *change = d->change[0];
        for (int k = 0; k + 1 < HISTORY; k++) {
            d->move[k] = d->move[k + 1];
            d->change[k] = d->change[k + 1];
            d->product[k] = d->product[k + 1];
        }
        d->move[HISTORY - 1] = move;
        d->change[HISTORY - 1] = change;
        d->history--;
    }
    double *move = d->move[d->history], *change = d->change[d->history];
    for (size_t i = 0; i < d->size; i++) {
        move[i] = d->next_x[i] - d->x[i];
        change[i] = d->next_g[i] - d->g[i];
    }
    double product = dot(move, change, d->size);
    if (product > 1e-12) {
        d->product[d->history] = product;
        d->history++;
    }
}

static void accept(descent *d)
{
    double *x = d->x, *g = d->g;
    d->x = d->next_x;
    d->g = d->next_g;
    d->next_x = x;
    d->next_g = g;
    d->strayed = false;
}

static bool search(descent *d, double promise, double *next)
{
    double step = step_limit(d);
    for (int k = 0; k < TRIALS && d->status == DEM_OK; k++, step *= shorten) {
        for (size_t i = 0; i < d->size; i++)
            d->next_x[i] = d->x[i] - step * d->direction[i];
        *next = evaluate(d, d->next_x, d->next_g);
        d->strayed = true;
        if (*next < d->value - sufficient * step * promise)
            return true;
    }
    return false;
}

static void descend(descent *d, dem_polish_options options)
{
    bool failed = false;
    double mark = d->value;    // at the last look
    for (int it = 0; it < options.iterations && d->status == DEM_OK; it++) {
        if (it && it % LOOK_EVERY == 0) {
            if (mark - d->value < options.tolerance * d->value)
                break;
            mark = d->value;
        }
        d->status = dem_pack_progress(d->p, (double)it / options.iterations, d->error);
        if (d->status != DEM_OK)
            break;
        double promise = set_direction(d), next;
        if (!(promise > 0) || !search(d, promise, &next)) {
            // the flux is not quite the derivative of the discrete sum: near the optimum searches fail
            if (failed || d->history == 0)
                break;
            failed = true;
            d->history = 0;
            continue;
        }
        remember(d);
        accept(d);
        d->value = next;
    }
}

dem_status dem_pack_polish(dem_packing *p, dem_lines *lines, dem_pack_state *state, dem_polish_options options,
                           dem_line_volumes *volumes, dem_error *error)
{
    dem_arena arena = {0};
    descent d = {.p = p, .lines = lines, .state = state, .count = state->count, .size = 4 * state->count,
                 .tangent_count = options.tangent_count, .error = error};
    dem_status status = take_work_space(&d, &arena, error);
    if (status == DEM_OK)
        status = dem_pack_metric(p, state, error);
    if (status != DEM_OK)
        goto done;
    for (size_t i = 0; i < d.count; i++) {
        const dem_ball *b = &state->balls[i];
        double v[4] = {b->centre.x, b->centre.y, b->centre.z, b->radius};
        metric_enter(p->factor[i], v, d.x + 4 * i);
    }
    set_tangent(&d, options);
    d.value = evaluate(&d, d.x, d.g);
    if (d.status == DEM_OK)
        descend(&d, options);
    if (d.status == DEM_OK && d.strayed)
        evaluate(&d, d.x, d.g);
    status = d.status;
    if (volumes)
        *volumes = d.volumes;
done:
    dem_arena_release(&arena);
    return status;
}
