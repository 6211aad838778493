// Gauss-Newton on f(q) = min_i (|q - c_i| - r_i). Each sample belongs to one ball, so the normal equations fall apart
// into one 4x4 system per ball; |f|^p is minimised as reweighted squares, damped as by Levenberg.
#include <string.h>

#include "base/status.h"
#include "clump/pack_connect.h"
#include "clump/packing.h"

enum { SUM_PARTS = 8 };

static const double least_damping = 1e-4, most_damping = 50;
static const double longest_step = 0.3;  // of the ball's radius

// a slot for the equations of each of a block's owners
static bool open_slots(dem_pack_chunk *chunk, const uint32_t *owners, size_t count)
{
    for (size_t k = 0; k < count; k++) {
        uint32_t i = owners[k];
        if (chunk->slot[i] >= 0)
            continue;
        if (!dem_grow(&chunk->lanes, &chunk->lane_capacity, chunk->touched_count, sizeof *chunk->lanes))
            return false;
        chunk->slot[i] = (int32_t)chunk->touched_count;
        chunk->lanes[chunk->touched_count] = (dem_equation_lanes){0};
        chunk->touched_count++;
    }
    return true;
}

static void add_equations(dem_packing *p, dem_pack_chunk *chunk, const dem_pack_state *state)
{
    chunk->touched_count = 0;
    for (size_t b = chunk->begin; b < chunk->end && !chunk->failed; b++) {
        const float *f = state->f + b * DEM_BLOCK;
        if (b >= p->samples.surface_blocks && state->block_energy[b] == 0)
            continue;
        const int32_t *owner = state->owner + b * DEM_BLOCK;
        uint32_t owners[DEM_BLOCK];
        dem_equation_lanes *slots[DEM_BLOCK];
        size_t count = p->kernels->owners_of(owner, owners);
        if (!open_slots(chunk, owners, count)) {
            chunk->failed = true;
            return;
        }
        for (size_t k = 0; k < count; k++)
            slots[k] = &chunk->lanes[chunk->slot[owners[k]]];
        dem_charge charge = p->charge;
        charge.interior = b >= p->samples.surface_blocks;
        p->kernels->equations(&p->samples.blocks[b], &p->columns, f, owner, &charge, owners, count, slots);
    }
}

// what the crew shares: chunks of one state
typedef struct shared {
    dem_packing *p;
    const dem_pack_state *state;
} shared;

static void equations_part(void *user, int part)
{
    const shared *s = user;
    add_equations(s->p, &s->p->chunks[part], s->state);
}

static void add_lanes(const dem_equation_lanes *lanes, double sum[DEM_EQUATION])
{
    for (int q = 0; q < DEM_EQUATION; q++) {
        float half[8];
        for (int l = 0; l < 8; l++)
            half[l] = lanes->sum[q][l] + lanes->sum[q][l + 8];
        sum[q] += (double)(((half[0] + half[4]) + (half[2] + half[6])) + ((half[1] + half[5]) + (half[3] + half[7])));
    }
}

// of a share of the balls the sums of all chunks, in their order
static void sum_part(void *user, int part)
{
    const shared *s = user;
    dem_packing *p = s->p;
    size_t begin = s->state->count * (size_t)part / SUM_PARTS, end = s->state->count * (size_t)(part + 1) / SUM_PARTS;
    for (size_t i = begin; i < end; i++)
        for (int q = 0; q < DEM_EQUATION; q++)
            p->equations[i][q] = 0;
    for (int k = 0; k < DEM_CHUNKS; k++) {
        dem_pack_chunk *chunk = &p->chunks[k];
        for (size_t i = begin; i < end; i++)
            if (chunk->slot[i] >= 0) {
                add_lanes(&chunk->lanes[chunk->slot[i]], p->equations[i]);
                chunk->slot[i] = -1;
            }
    }
}

static dem_status assemble(dem_packing *p, const dem_pack_state *state, dem_error *error)
{
    shared s = {p, state};
    dem_crew_run(p->crew, DEM_CHUNKS, equations_part, &s);
    dem_crew_run(p->crew, SUM_PARTS, sum_part, &s);
    bool failed = false;
    for (int k = 0; k < DEM_CHUNKS; k++)
        failed |= p->chunks[k].failed;
    return failed ? dem_fail_memory(error) : DEM_OK;
}

// (H + damping trace/4) step = -g by Cholesky; false: not solvable
static bool solve(const double equation[DEM_EQUATION], double damping, double step[4])
{
    double a[4][4], trace = equation[0] + equation[4] + equation[7] + equation[9];
    if (!(trace > 1e-14))
        return false;
    for (int i = 0, q = 0; i < 4; i++)
        for (int j = i; j < 4; j++, q++)
            a[j][i] = equation[q] + (i == j ? damping * trace / 4 : 0);
    for (int j = 0; j < 4; j++) {
        for (int k = 0; k < j; k++)
            a[j][j] -= a[j][k] * a[j][k];
        if (!(a[j][j] > 0))
            return false;
        a[j][j] = sqrt(a[j][j]);
        for (int i = j + 1; i < 4; i++) {
            for (int k = 0; k < j; k++)
                a[i][j] -= a[i][k] * a[j][k];
            a[i][j] /= a[j][j];
        }
    }
    for (int i = 0; i < 4; i++) {
        step[i] = -equation[10 + i];
        for (int k = 0; k < i; k++)
            step[i] -= a[i][k] * step[k];
        step[i] /= a[i][i];
    }
    for (int i = 3; i >= 0; i--) {
        for (int k = i + 1; k < 4; k++)
            step[i] -= a[k][i] * step[k];
        step[i] /= a[i][i];
    }
    return true;
}

// A ball whose step leads where no ball may be stays. What is learnt of the clearances holds for both states.
static void move_balls(dem_packing *p, dem_pack_state *from, dem_pack_state *to, double damping)
{
    to->count = from->count;
    for (size_t i = 0; i < from->count; i++) {
        double step[4];
        to->balls[i] = from->balls[i];
        if (!solve(p->equations[i], damping, step))
            continue;
        double largest = 0;
        for (int k = 0; k < 4; k++)
            largest = fmax(largest, fabs(step[k]));
        if (!(largest < 1e9))
            continue;
        double limit = longest_step * from->balls[i].radius, scale = largest > limit ? limit / largest : 1;
        dem_ball moved = from->balls[i];
        moved.centre = v3_along(moved.centre, scale, v3(step[0], step[1], step[2]));
        moved.radius = fmax(moved.radius + scale * step[3], dem_pack_smallest_radius);
        if (dem_pack_ball_allowed(p, moved, &from->clearances[i]))
            to->balls[i] = moved;
    }
    memcpy(to->clearances, from->clearances, from->count * sizeof *to->clearances);
}

static void swap_states(dem_pack_state *a, dem_pack_state *b)
{
    dem_pack_state c = *a;
    *a = *b;
    *b = c;
}

dem_status dem_pack_equations(dem_packing *p, dem_pack_state *state, dem_error *error)
{
    DEM_TRY(dem_pack_assign(p, state, error));
    return assemble(p, state, error);
}

dem_status dem_pack_relax(dem_packing *p, dem_pack_state *state, dem_relax_options options, dem_error *error)
{
    dem_pack_state *trial = &p->trial;
    double damping = options.damping;
    DEM_TRY(dem_pack_assign(p, state, error));
    double energy = state->energy + dem_pack_springs(p, state, NULL);
    bool assembled = false;
    for (int i = 0; i < options.iterations; i++) {
        DEM_TRY(dem_pack_go_on(p, error));
        if (!assembled) {
            DEM_TRY(assemble(p, state, error));
            dem_pack_springs(p, state, p->equations);
        }
        move_balls(p, state, trial, damping);
        DEM_TRY(dem_pack_assign_moved(p, trial, error));
        double next = trial->energy + dem_pack_springs(p, trial, NULL);
        if (next < energy) {
            double gain = (energy - next) / energy;
            swap_states(state, trial);
            energy = next;
            assembled = false;
            damping = fmax(damping / 2, least_damping);
            if (gain < options.tolerance)
                break;
        } else {
            damping *= 4;
            if (damping > most_damping)
                break;
            assembled = true;
        }
    }
    return DEM_OK;
}
