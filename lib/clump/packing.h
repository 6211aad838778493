/// One packing under way: the grain, its samples and candidates, work space, and the states (sets of balls) that the
/// stages improve. Lengths in units of d_eq, in the frame of pack_grain.h.
#ifndef DEM_CLUMP_PACKING_H
#define DEM_CLUMP_PACKING_H

#include "base/clock.h"
#include "base/crew.h"
#include "base/random.h"
#include "clump/pack_candidates.h"
#include "clump/pack_kernels.h"

enum { DEM_CHUNKS = 16 };

/// Smallest overlap (r_i + r_j - distance) that joins two balls of a clump into one piece.
static const double dem_pack_overlap = 0.008;
/// Springs pull a little farther.
static const double dem_pack_spring_overlap = 0.012;
/// No ball is smaller.
static const double dem_pack_smallest_radius = 0.004;

/// The surface distance last found near a ball's centre; it bounds the distance of places nearby.
typedef struct dem_clearance {
    dem_vec3 at;
    double distance;   ///< < 0: not known
    bool inside;
} dem_clearance;

/// A set of balls, and for each sample its distance f to their union and the ball that gives it.
typedef struct dem_pack_state {
    dem_ball *balls;
    dem_clearance *clearances;
    size_t count, capacity;
    float *f;
    int32_t *owner;
    double *block_energy;
    double energy;
} dem_pack_state;

/// A fixed share of the sample blocks. Threads take whole chunks, so results do not depend on their number.
typedef struct dem_pack_chunk {
    size_t begin, end;           ///< blocks
    dem_near_work work;
    dem_ball_columns some;       ///< [capacity, padded] those near the blocks at hand
    uint32_t *ids;               ///< [capacity, padded] of `some`
    uint32_t *near;              ///< balls near each block, one list after the other
    float *near_least;           ///< as in dem_near_list
    size_t near_count, near_capacity;
    int32_t *slot;               ///< [capacity] of a ball in `lanes`; -1: not touched
    size_t touched_count;        ///< balls that have a slot
    dem_equation_lanes *lanes;
    size_t lane_capacity;
    bool failed;                 ///< out of memory
} dem_pack_chunk;

/// What an effort buys for the number of balls at hand.
typedef struct dem_pack_effort {
    double prune_share;      ///< of the balls removed at a time
    int prune_iterations;    ///< of relaxation after each
    int breaths;
    int polish_steps;
    double polish_tolerance;
    double line_density;     ///< lines of each axis per ball
} dem_pack_effort;

typedef struct dem_packing {
    const dem_ctx *ctx;
    const dem_pack_options *options;
    const dem_pack_kernels *kernels;
    dem_crew *crew;              ///< NULL: alone
    dem_random random;
    dem_pack_effort effort;
    const dem_pack_grain *grain;
    dem_lattice lattice;
    dem_samples samples;
    dem_candidates candidates;
    dem_charge charge;           ///< of surface samples
    double inflations[4];        ///< what a candidate's radius may be raised by
    size_t inflation_count;
    bool spring;                 ///< pull separate pieces together
    double stiffness;            ///< of the springs
    bool connected;              ///< refuse what takes the clump apart
    dem_arena arena;
    size_t capacity;             ///< most balls of a state
    dem_ball_columns columns;    ///< the balls of the state being evaluated
    dem_pack_chunk chunks[DEM_CHUNKS];
    size_t *near_begin;          ///< [blocks] into the chunk's `near`
    uint32_t *near_size;         ///< [blocks]
    dem_ball *near_at;           ///< [capacity] the balls the lists were made for
    size_t near_balls;           ///< their number; 0: there are no lists
    double near_slack;           ///< lists hold while no ball has moved by more than half of it
    double near_moved;           ///< the farthest that one has moved since
    struct dem_link *links;      ///< [capacity] the open ones, as dem_pack_links left them
    struct dem_link *tree;       ///< [capacity] the spanning tree found last
    dem_ball *tree_balls;        ///< [capacity] its balls
    size_t tree_count, link_count;
    double tree_overlap;         ///< what was asked of its links
    dem_ball_columns tree_columns;
    float *tree_reach;           ///< [capacity, padded]
    int32_t *tree_nearest;       ///< [capacity, padded]
    double (*equations)[DEM_EQUATION];  ///< [capacity]
    double (*factor)[4][4];      ///< [capacity] of pack_metric.h
    double *cost;                ///< [capacity] of removing a ball
    float *rise;                 ///< [samples] what a sample is charged more without its nearest ball
    uint32_t *order;             ///< [capacity]
    dem_pack_state trial;        ///< of `dem_pack_relax`
    dem_pack_state moved;        ///< of `dem_pack_breathe`
    double stage_begin, stage_end, done;  ///< parts of the whole work: of the stage at hand, and what is done
    dem_laps laps;
} dem_packing;

dem_status dem_packing_open(const dem_ctx *ctx, const dem_pack_grain *grain, const dem_pack_options *options,
                            const dem_pack_kernels *kernels, dem_packing *p, dem_error *error);
void dem_packing_close(dem_packing *p);

// progress: pack_progress.c
/// Begins a stage at whose end this part of the whole work is done.
void dem_pack_stage(dem_packing *p, double until);
/// `part` of the stage is done. DEM_INTERRUPTED: the caller wants to stop.
dem_status dem_pack_progress(dem_packing *p, double part, dem_error *error);
/// The same without anything new to tell.
dem_status dem_pack_go_on(const dem_packing *p, dem_error *error);

// states: pack_state.c
dem_status dem_pack_state_init(dem_packing *p, dem_pack_state *state, dem_error *error);
void dem_pack_state_copy(const dem_packing *p, const dem_pack_state *from, dem_pack_state *to);
void dem_pack_state_add(dem_pack_state *state, dem_ball ball);
/// Removes the balls marked; the others keep their order. Leaves f and owner stale.
void dem_pack_state_remove(dem_pack_state *state, const bool *gone);
/// May a ball stand here? Its centre must not lie outside the grain, its radius not be much more than its clearance.
bool dem_pack_ball_allowed(const dem_packing *p, dem_ball ball, dem_clearance *clearance);

// samples and balls: pack_assign.c
void dem_ball_columns_set(dem_ball_columns *columns, const dem_ball *balls, size_t count);
/// f, owner and energy of every sample, after any change.
dem_status dem_pack_assign(dem_packing *p, dem_pack_state *state, dem_error *error);
/// The same for balls that have moved a little since the last `dem_pack_assign` of balls of the same numbers.
dem_status dem_pack_assign_moved(dem_packing *p, dem_pack_state *state, dem_error *error);
/// Sets f and owner of every sample, and p->cost: what the energy rises by when a ball is removed and the others stay.
dem_status dem_pack_removal_costs(dem_packing *p, dem_pack_state *state, dem_error *error);
/// The IoU gap as the surface samples see it.
double dem_pack_gap_estimate(const dem_packing *p, const dem_pack_state *state);

// block Gauss-Newton: pack_relax.c
typedef struct dem_relax_options {
    int iterations;
    double damping;    ///< first Levenberg damping
    double tolerance;  ///< stop when a step gains less than this part of the energy
} dem_relax_options;
/// Assigns and sets p->equations: upper triangle of each ball's Gauss-Newton matrix and its gradient.
dem_status dem_pack_equations(dem_packing *p, dem_pack_state *state, dem_error *error);
dem_status dem_pack_relax(dem_packing *p, dem_pack_state *state, dem_relax_options options, dem_error *error);

#endif
