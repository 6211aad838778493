// On one side of the surface a ball's radius follows from its centre: that of an inscribed ball is its distance to the
// surface, that of an outer ball reaches the farthest point it has to cover. Either way the radius hangs on one point q
// and changes by (c - q) / |c - q| as the centre moves, so that centres alone descend on the symmetric difference, with
// a step length of each ball's own that shrinks where its direction turns round (Rprop, Riedmiller & Braun 1993).
#include "clump/pack_side.h"

#include <stdlib.h>
#include <string.h>

#include "base/status.h"
#include "clump/pack_connect.h"
#include "clump/pack_cover.h"
#include "geom/ball_tree.h"
#include "geom/union.h"

enum { STEPS = 120, TRIANGLES_PER_REPORT = 4096 };

static const double dear_protrusion[] = {30, 300}, dear_uncovered = 10;            // against the other side [-]
static const double first_step = 0.004, longest_step = 0.02, shortest_step = 1e-5; // [d_eq]
static const double lengthen = 1.15, shorten = 0.5;
static const double rounding = 1e-9; // kept from the surface [d_eq]

typedef struct side_run {
    dem_packing *p;
    dem_lines *lines;
    dem_pack_state *state;
    const dem_tree *tree; // of the grain's shell: the mesh, or a coarser stand-in for a large one
    bool outer;
    dem_vec3 *hangs_on; // [capacity] q
    dem_vec3 *last;     // [capacity] direction of the last step
    double *step;       // [capacity]
    double (*slope)[4]; // [capacity]
    double best;        // least difference in one piece, of p->moved; INFINITY: none
} side_run;

void dem_pack_side_begin(dem_packing *p)
{
    if (p->options->side == DEM_SIDE_INSCRIBED) {
        p->charge.inside = (float)dear_protrusion[0];
        p->inflation_count = 1;
    } else if (p->options->side == DEM_SIDE_OUTER) {
        p->charge.outside = (float)dear_uncovered;
    }
}

// false: no ball can stand here
static bool inscribe(const side_run *s, dem_ball *ball, dem_vec3 *hangs_on)
{
    double d = dem_tree_closest(s->tree, ball->centre, INFINITY, hangs_on, NULL);
    if (!(d > dem_pack_smallest_radius) || !dem_tree_inside(s->tree, ball->centre))
        return false;
    ball->radius = d - rounding;
    return true;
}

// every ball reaches the farthest of the samples that were nearest to it
static dem_status reach_out(side_run *s, dem_error *error)
{
    dem_packing *p = s->p;
    dem_pack_state *state = s->state;
    DEM_TRY(dem_pack_assign(p, state, error));
    float *farthest = p->tree_reach;
    for (size_t i = 0; i < state->count; i++)
        farthest[i] = -INFINITY;
    for (size_t b = 0; b < p->samples.block_count; b++)
        for (int l = 0; l < DEM_BLOCK; l++) {
            const dem_sample_block *block = &p->samples.blocks[b];
            int32_t i = state->owner[b * DEM_BLOCK + (size_t)l];
            float f = state->f[b * DEM_BLOCK + (size_t)l];
            if (f <= farthest[i])
                continue;
            farthest[i] = f;
            s->hangs_on[i] = v3((double)block->x[l], (double)block->y[l], (double)block->z[l]);
        }
    for (size_t i = 0; i < state->count; i++)
        if (isfinite(farthest[i]))
            state->balls[i].radius = fmax(state->balls[i].radius + (double)farthest[i], dem_pack_smallest_radius);
        else
            s->hangs_on[i] = v3_add(state->balls[i].centre, v3(0, 0, 1e9));
    return DEM_OK;
}

// balls that cannot be inscribed go
static void inscribe_all(side_run *s)
{
    dem_pack_state *state = s->state;
    size_t kept = 0;
    for (size_t i = 0; i < state->count; i++) {
        dem_ball ball = state->balls[i];
        if (inscribe(s, &ball, &s->hangs_on[kept]))
            state->balls[kept++] = ball;
    }
    state->count = kept;
}

static void keep_best(side_run *s, double difference)
{
    dem_pack_state *best = &s->p->moved;
    best->count = s->state->count;
    memcpy(best->balls, s->state->balls, best->count * sizeof *best->balls);
    s->best = difference;
}

// where each ball wants to go, as unit vectors in `slope`; links pull harder than the fit
static void set_directions(side_run *s, size_t open)
{
    for (size_t i = 0; i < s->state->count; i++) {
        double *g = s->slope[i];
        dem_vec3 u = v3_unit(v3_sub(s->state->balls[i].centre, s->hangs_on[i]));
        dem_vec3 d = v3_scale(v3_along(v3(g[0], g[1], g[2]), g[3], u), -1);
        double norm = v3_norm(d);
        d = norm > 1e-12 ? v3_scale(d, 1 / norm) : v3(0, 0, 0);
        g[0] = d.x, g[1] = d.y, g[2] = d.z;
    }
    for (size_t k = 0; k < open; k++) {
        const dem_link *link = &s->p->links[k];
        dem_vec3 d = v3_unit(v3_sub(s->state->balls[link->j].centre, s->state->balls[link->i].centre));
        double *i = s->slope[link->i], *j = s->slope[link->j];
        i[0] = d.x, i[1] = d.y, i[2] = d.z;
        j[0] = -d.x, j[1] = -d.y, j[2] = -d.z;
    }
}

static void move(side_run *s)
{
    for (size_t i = 0; i < s->state->count; i++) {
        dem_vec3 d = v3(s->slope[i][0], s->slope[i][1], s->slope[i][2]);
        s->step[i] *= v3_dot(d, s->last[i]) < 0 ? shorten : lengthen;
        s->step[i] = fmin(fmax(s->step[i], shortest_step), longest_step);
        s->last[i] = d;
        dem_ball moved = s->state->balls[i];
        moved.centre = v3_along(moved.centre, s->step[i], d);
        if (s->outer || inscribe(s, &moved, &s->hangs_on[i]))
            s->state->balls[i] = moved;
        else
            s->step[i] *= shorten;
    }
}

static dem_status descend(side_run *s, dem_error *error)
{
    dem_packing *p = s->p;
    dem_pack_state *state = s->state;
    for (size_t i = 0; i < state->count; i++) {
        s->step[i] = first_step;
        s->last[i] = v3(0, 0, 0);
    }
    s->best = INFINITY;
    for (int k = 0; k <= STEPS; k++) {
        dem_line_volumes volumes;
        DEM_TRY(dem_pack_progress(p, (double)k / STEPS, error));
        if (s->outer)
            DEM_TRY(reach_out(s, error));
        dem_ball_columns_set(&p->columns, state->balls, state->count);
        DEM_TRY(dem_lines_measure(s->lines, &p->columns, s->slope, &volumes, error));
        size_t open = dem_pack_links(p, state->balls, state->count, dem_pack_overlap);
        if (!open && volumes.difference < s->best)
            keep_best(s, volumes.difference);
        set_directions(s, open);
        move(s);
    }
    if (s->best < INFINITY) {
        state->count = p->moved.count;
        memcpy(state->balls, p->moved.balls, state->count * sizeof *state->balls);
    }
    return DEM_OK;
}

// of separate pieces the one of the most volume remains; returns how many balls went
static dem_status keep_largest_piece(side_run *s, size_t *dropped, dem_error *error)
{
    dem_pack_state *state = s->state;
    uint32_t *piece = s->p->order;
    dem_ball *balls = state->balls;
    size_t count = state->count, kept = 0, largest = 0;
    *dropped = 0;
    if (dem_ball_pieces(balls, count, dem_pack_overlap / 2, piece) <= 1)
        return DEM_OK;
    double *volume = dem_alloc_zero(count, sizeof *volume);
    if (!volume)
        return dem_fail_memory(error);
    for (size_t i = 0; i < count; i++) {
        volume[piece[i]] += pow(balls[i].radius, 3);
        if (volume[piece[i]] > volume[largest])
            largest = piece[i];
    }
    free(volume);
    for (size_t i = 0; i < count; i++)
        if (piece[i] == largest)
            balls[kept++] = balls[i];
    state->count = kept;
    *dropped = count - kept;
    return DEM_OK;
}

typedef struct offer {
    dem_ball ball;
    int64_t gain; // at most
    bool joins;   // overlaps a ball of the clump
} offer;

static void mark_joining(offer *offers, size_t count, dem_ball ball)
{
    for (size_t i = 0; i < count; i++)
        if (v3_distance(offers[i].ball.centre, ball.centre) < offers[i].ball.radius + ball.radius - dem_pack_overlap)
            offers[i].joins = true;
}

static offer *best_offer(offer *offers, size_t count)
{
    offer *best = NULL;
    for (size_t i = 0; i < count; i++)
        if (offers[i].joins && offers[i].gain > (best ? best->gain : 0))
            best = &offers[i];
    return best;
}

// adds medial balls that overlap the clump, each time the one that covers most; gains only fall (Minoux 1978)
static void take_offers(side_run *s, offer *offers, size_t count, size_t wanted)
{
    dem_packing *p = s->p;
    offer *best;
    while (s->state->count < wanted && (best = best_offer(offers, count))) {
        int64_t gain = p->kernels->lattice_gain(&p->lattice, best->ball, NULL);
        bool sure = gain == best->gain;
        best->gain = gain;
        if (!sure)
            continue;
        best->gain = 0;
        if (!inscribe(s, &best->ball, &s->hangs_on[s->state->count]))
            continue;
        p->kernels->lattice_gain(&p->lattice, best->ball, p->lattice.covered);
        dem_pack_state_add(s->state, best->ball);
        mark_joining(offers, count, best->ball);
    }
}

static dem_status refill(side_run *s, size_t wanted, dem_error *error)
{
    dem_packing *p = s->p;
    size_t count = p->candidates.count;
    offer *offers = dem_alloc(count, sizeof *offers);
    if (!offers)
        return dem_fail_memory(error);
    dem_lattice_clear(&p->lattice);
    for (size_t i = 0; i < count; i++)
        offers[i] = (offer){p->candidates.balls[i], INT64_MAX, false};
    for (size_t i = 0; i < s->state->count; i++) {
        p->kernels->lattice_gain(&p->lattice, s->state->balls[i], p->lattice.covered);
        mark_joining(offers, count, s->state->balls[i]);
    }
    take_offers(s, offers, count, wanted);
    free(offers);
    return DEM_OK;
}

// A stand-in is not exact: every triangle of the mesh against the balls it is near to. No copy of the mesh is made.
static dem_status shrink_to_mesh(side_run *s, dem_error *error)
{
    const dem_pack_grain *grain = s->p->grain;
    dem_ball *balls = s->state->balls, *before = s->p->moved.balls;
    size_t count = s->state->count;
    uint32_t *near = s->p->order;
    dem_ball_tree tree;
    memcpy(before, balls, count * sizeof *before);
    DEM_TRY(dem_ball_tree_build(&tree, before, count, error));
    dem_status status = DEM_OK;
    for (size_t t = 0; t < grain->mesh->triangle_count && status == DEM_OK; t++) {
        dem_vec3 c[3];
        if (t % TRIANGLES_PER_REPORT == 0)
            status = dem_pack_go_on(s->p, error);
        dem_pack_grain_corners(grain, t, c);
        dem_vec3 middle = v3_scale(v3_add(c[0], v3_add(c[1], c[2])), 1.0 / 3);
        double reach = fmax(v3_distance(middle, c[0]), fmax(v3_distance(middle, c[1]), v3_distance(middle, c[2])));
        size_t found = dem_ball_tree_near(&tree, (dem_ball){middle, reach}, rounding, near);
        for (size_t k = 0; k < found; k++) {
            dem_ball *ball = &balls[near[k]];
            double d = v3_distance(dem_triangle_closest(ball->centre, c[0], c[1], c[2]), ball->centre);
            ball->radius = fmin(ball->radius, d - rounding);
        }
    }
    dem_ball_tree_release(&tree);
    size_t kept = 0;
    for (size_t i = 0; i < count; i++)
        if (balls[i].radius > dem_pack_smallest_radius)
            balls[kept++] = balls[i];
    s->state->count = kept;
    return status;
}

static dem_status inscribe_and_join(side_run *s, dem_error *error)
{
    size_t wanted = s->state->count, dropped;
    inscribe_all(s);
    if (s->state->count == 0)
        return dem_fail(error, DEM_FAILED, "no sphere fits into the grain; repair the mesh or ask for no side");
    DEM_TRY(descend(s, error));
    DEM_TRY(keep_largest_piece(s, &dropped, error));
    if (!dropped)
        return DEM_OK;
    DEM_TRY(refill(s, wanted, error));
    DEM_TRY(descend(s, error));
    return keep_largest_piece(s, &dropped, error);
}

static dem_status keep_inscribed(side_run *s, dem_error *error)
{
    size_t dropped;
    DEM_TRY(inscribe_and_join(s, error));
    if (s->p->grain->shell.triangle_count == s->p->grain->mesh->triangle_count)
        return DEM_OK;
    DEM_TRY(shrink_to_mesh(s, error));
    return keep_largest_piece(s, &dropped, error);
}

static dem_status keep_outer(side_run *s, dem_error *error)
{
    DEM_TRY(descend(s, error));
    return dem_pack_cover(s->p, s->state, error);
}

static dem_status take_work_space(side_run *s, dem_error *error)
{
    dem_arena *arena = &s->p->arena;
    size_t n = s->p->capacity;
    s->hangs_on = dem_arena_take(arena, n, sizeof *s->hangs_on);
    s->last = dem_arena_take(arena, n, sizeof *s->last);
    s->step = dem_arena_take(arena, n, sizeof *s->step);
    s->slope = dem_arena_take(arena, n, sizeof *s->slope);
    return arena->failed ? dem_fail_memory(error) : DEM_OK;
}

// protrusion is charged so dearly that hardly any is left before the balls shrink to what fits
static dem_status fit_inside(dem_pack_stages *run, dem_error *error)
{
    for (size_t k = 0; k < sizeof dear_protrusion / sizeof *dear_protrusion; k++) {
        run->p.charge.inside = (float)dear_protrusion[k];
        run->lines.protruding = dear_protrusion[k];
        DEM_TRY(dem_pack_fit(run, error));
    }
    run->lines.protruding = 1;
    return DEM_OK;
}

dem_status dem_pack_side_keep(dem_pack_stages *run, dem_error *error)
{
    dem_packing *p = &run->p;
    side_run s = {.p = p,
                  .lines = &run->lines,
                  .state = &run->state,
                  .tree = &p->grain->tree,
                  .outer = p->options->side == DEM_SIDE_OUTER};
    p->charge.linear = true;
    DEM_TRY(take_work_space(&s, error));
    if (s.outer)
        DEM_TRY(dem_pack_resize(run, run->state.count, error));
    else
        DEM_TRY(fit_inside(run, error));
    dem_pack_stage(p, 0.98);
    DEM_TRY(s.outer ? keep_outer(&s, error) : keep_inscribed(&s, error));
    p->connected = false; // nothing may move any more
    return DEM_OK;
}
