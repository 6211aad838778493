/// What a world holds: bodies in rows and columns, near pairs, and the contacts they list, by segments of bodies.
///
/// Bodies keep their row from the start; `dem_bodies.place` says where the caller's bodies stand. Behind the last body
/// come rows that fill up the blocks of 8 and two dummies far from everything and each other, which idle contacts name.
#ifndef DEM_SIM_STATE_H
#define DEM_SIM_STATE_H

#include "base/clock.h"
#include "base/memory.h"
#include "base/threads.h"
#include "dem/world.h"
#include "math/quat.h"
#include "sim/hold.h"
#include "sim/kernels.h"
#include "sim/laws.h"
#include "sim/mesh_touch.h"
#include "sim/soft.h"
#include "sim/region.h"
#include "sim/template.h"
#include "sim/walls.h"

enum {
    DEM_SEGMENT = 64,      ///< bodies whose contacts stand together
    DEM_IMAGES_ASIDE = 7,  ///< images of a periodic side in each direction
    DEM_IMAGES_ROW = 2 * DEM_IMAGES_ASIDE + 1,
    DEM_IMAGES = DEM_IMAGES_ROW * DEM_IMAGES_ROW * DEM_IMAGES_ROW,
};

/// Columns of the bodies: type, name, numbers a body, unit, needed when (in terms of a world w), what it is. The list
/// makes allocation, checkpoint, hash and --explain. Written by the motion pass (bodies, momentum, path), the lists
/// (limits, then, wraps) and the contacts (momentum).
#define DEM_BODY_COLUMNS(X)                                                                                            \
    X(double, bodies, 16, "m, -, m/s, rad/s", true, "pose and motion")                                                 \
    X(double, momentum, 8, "kg m/s, kg m2/s", true, "momenta, half a step before")                                     \
    X(double, inertia, 8, "1/kg, 1/(kg m2), m", true, "inverse mass and moments, reach")                               \
    X(double, path, 1, "m", true, "path of the fastest surface point")                                                 \
    X(double, limit, 1, "m", true, "path at which the lists are looked at")                                            \
    X(double, search_limit, 1, "m", true, "path at which a search for pairs may be due")                               \
    X(double, then, 3, "m", true, "centre at the last search for pairs")                                               \
    X(double, radius, 1, "m", true, "bounding radius")                                                                 \
    X(uint32_t, shape, 1, "-", true, "index of the shape")                                                             \
    X(double, wall_limit, 1, "m", (w)->walls.count > 0, "path at which the wall lists are looked at")                  \
    X(double, strain_limit, 1, "-", (w)->features.watch, "strain at which the step is looked at")                      \
    X(uint32_t, id, 1, "-", (w)->population != NULL, "number of the body by birth, or that there is none")             \
    X(int32_t, wraps, 3, "-", (w)->periodic, "how often a periodic side was crossed")                                  \
    X(double, before, 8, "kg m/s, kg m2/s", (w)->damping.local > 0 || (w)->damping.viscous > 0 || (w)->other_motion,   \
      "momenta before the contacts")                                                                                   \
    X(uint32_t, hold, 1, "-", (w)->held, "what of the motion is held")                                                 \
    X(double, kept, 6, "m/s, rad/s", (w)->kept, "velocity and spin that are held")                                     \
    X(double, fluid, 4, "N s, J", fluid_drags(&(w)->damping.drag), "impulse of the drag in the last step")             \
    X(double, turning, 3, "rad/s2", (w)->integrator.rotation == DEM_ROTATION_WALTON_BRAUN,                             \
      "rate of the spin in the body, a step before")

typedef struct dem_bodies {
    size_t count, padded;  ///< rows, some of which may be without a body; padded: to 8, with the two dummies
    size_t living;         ///< bodies
    uint32_t dummy;        ///< row of the first dummy; the second follows
    size_t momentum_rows;  ///< rows of `momentum`: those of the bodies, then slots
#define COLUMN(type, name, width, unit, when, about) type *name;
    DEM_BODY_COLUMNS(COLUMN)
#undef COLUMN
    uint32_t *place;  ///< [living] row of the i-th body, in the order they came; there is room for `count`
} dem_bodies;

static inline bool fluid_drags(const dem_drag_def *drag)
{
    return drag->density > 0 || drag->viscosity > 0;
}

/// Two bodies whose bounding balls are nearer than the skin; a < b, or a == b across a periodic side.
typedef struct dem_pair {
    uint32_t a, b;
    uint32_t start, count;  ///< its contacts in the list of the segment of a
    uint32_t adjacent_a, adjacent_b;
    float normal[3];  ///< direction from a to b between their nearest spheres; [0] > 1: not known yet
    uint32_t image;   ///< of b
} dem_pair;

typedef struct dem_pairs {
    dem_pair *items;  ///< sorted by a, b, image
    size_t count, capacity;
    uint32_t *first;            ///< [bodies + 1] of the pairs of a
    uint32_t *adjacency_first;  ///< [bodies + 1]
    uint32_t *adjacency;        ///< [2 count] pairs of a body, as a or b
    double *adjacency_limit;    ///< [2 count] path of that body at which the pair is looked at
    uint32_t *fresh;            ///< [count] 1 + index into the results of the present refresh; 0: as it was
} dem_pairs;

/// Place of the contacts of DEM_SEGMENT bodies (or of their wall contacts of one form) in the columns.
typedef struct dem_segment {
    size_t begin, end, capacity;                   ///< multiples of 8
    size_t slot_begin, slot_count, slot_capacity;  ///< momenta for bodies of other domains
    size_t across;       ///< blocks that neighbours in the list are dealt to
    uint32_t idle;       ///< places without a contact
    uint32_t spare;      ///< places that are left idle when the list is rebuilt
    uint64_t built;      ///< step in which it was
    uint32_t changed;    ///< 1 + index of the last fresh result that changes it; 0: none
    bool dirty, fresh;   ///< dirty: to be rebuilt; fresh: the list has changed, and runs are not known yet (soft)
} dem_segment;

struct dem_contacts {
    dem_contact_columns columns;
    size_t capacity;  ///< of each column
    dem_segment *segments;
    uint32_t *slot_body;  ///< [slots] whose momentum a slot belongs to
    size_t slot_capacity;
    dem_soft_runs *runs;  ///< [segments] (soft)
};

/// Sphere pairs that a refresh has found, by thread.
typedef struct dem_candidates {
    uint32_t *pairs;  ///< [2 capacity] sphere of a, sphere of b, counted within their shapes
    size_t count, capacity;
    float *work;
    uint32_t *expired;  ///< pairs to be looked at, some of them twice
    size_t expired_count, expired_capacity;
    bool failed;
} dem_candidates;

/// A pair that is looked at: all are at the first lists, so it is small.
typedef struct dem_fresh {
    uint32_t pair;
    uint32_t next;   ///< 1 + index of the one before that changes the list of the same segment; 0: none
    uint32_t count;  ///< from `begin`, in the candidates of `thread`
    uint16_t thread;
    bool changed;  ///< the set of candidates is another one
    uint32_t begin;
} dem_fresh;

typedef enum dem_pass {
    DEM_PASS_PAIRS,
    DEM_PASS_WALLS,
    DEM_PASS_MOTION,
    DEM_PASS_SEARCH,
    DEM_PASS_REFRESH,
    DEM_PASS_LISTS,
    DEM_PASS_STEP,
    DEM_PASS_MEASURE,
    DEM_PASS_BONDS,  ///< last, for only some scenes have it
    DEM_PASSES
} dem_pass;

/// What measuring fills; see dem/world.h.
/// What the contacts of a segment do to a servo wall.
typedef struct dem_servo_sum {
    double force;     ///< that pushes the bodies, along the wall's direction [N]
    double hardness;  ///< of the contacts [N/m]
} dem_servo_sum;

typedef struct dem_wear_event {
    uint32_t wall, triangle;
    double volume;  ///< [m^3]
} dem_wear_event;

/// What a segment's bodies have taken off walls, until it is added there.
typedef struct dem_wear_events {
    dem_wear_event *items;
    size_t count, capacity;
    bool failed;
} dem_wear_events;

typedef struct dem_views {
    uint32_t *shape, *coordination, *id, *by_row;  ///< by_row: body of a row
    double *scale, *mass;
    dem_vec3 *position, *velocity, *spin, *force, *moment;
    dem_quat *orientation;
    dem_contact *contacts;
    size_t contact_count, contact_capacity;
    bool contacts_listed;  ///< since the last measure
    double passed;         ///< largest overlap with a wall over the sphere's radius, now [-]
    uint32_t passed_body, passed_wall;
    dem_wall_view *walls;
    dem_figures figures;
    dem_contact_record *records;
    size_t record_capacity;
    double elastic;
    dem_energy since;    ///< dissipated and done by now, but not in the tallies yet [J]
    double most_energy;  ///< largest of kinetic, elastic and change of potential energy seen [J]
} dem_views;

typedef struct dem_search dem_search;
typedef struct dem_population dem_population;
typedef struct dem_bonds dem_bonds;

typedef struct dem_push {
    size_t row;
    dem_vec3 force, moment;
} dem_push;

struct dem_world {
    // constant
    dem_vec3 gravity;
    dem_domain_def domain;
    bool periodic;
    dem_damping_def damping;
    dem_multiple multiple;
    dem_integrator_def integrator;
    bool other_motion;  ///< than the kernels': see motion.h
    bool held, kept;    ///< some bodies are held; some at a velocity or spin
    dem_time_def time_def;
    bool ledger;
    dem_clump **clumps;
    char **shape_names;
    size_t shape_count;
    dem_templates templates;
    dem_laws laws;
    dem_features features;
    const dem_kernels *kernels;
    const dem_contact_instance *instance, *wall_instance;
    double *shifts;             ///< [4 an image] (periodic)
    double reach;               ///< how far beyond the touch contacts may hold [m]
    double ahead;               ///< contacts are listed so much before they touch (soft) [m]
    dem_soft soft;
    double skin;                ///< of the last search: its pairs are nearer to each other [m]
    double skin_least;          ///< of bodies that are slow [m]
    int threads;
    size_t domain_bodies;  ///< bodies of a domain: their momenta are written by one thread
    // state
    dem_bodies bodies;
    dem_pairs pairs;
    dem_contacts contacts, wall_contacts[DEM_WALL_FORMS];
    dem_mesh_touches *mesh_touches;  ///< [segments]
    dem_walls walls;
    dem_bonds *bonds;  ///< NULL: none
    size_t segment_count;
    uint64_t steps, epoch_steps;              ///< the time is epoch_time + (steps - epoch_steps) next_step
    double epoch_time, last_step, next_step;  ///< last_step: 0 at the start, where the momenta are of the poses' time
    double wall_path;                         ///< what sweeping walls add to paths [m]
    double sweep_speed;                       ///< of sweeping walls about the bodies, at most [m/s]
    double sweep_least;                       ///< of them, but for what servos add [m/s]
    dem_tally *tallies;                       ///< [segments * (1 + DEM_WALL_FORMS)]
    dem_motion_tally *motion_tallies;         ///< [segments]
    double push_work;
    dem_population *population;            ///< NULL: bodies neither come nor go
    uint64_t step_reviewed;                ///< when all bodies were last asked for their step
    double energy_start, potential_start;  ///< [J]
    // work space
    dem_team *team;
    dem_search *search;
    uint32_t *asked;  ///< [padded]
    size_t asked_count, *part_asked;
    dem_strained *strained;  ///< [padded] (watch)
    size_t strained_count, *part_strained;
    size_t *parts;  ///< [threads + 1] first segment of each
    dem_fresh *fresh;
    size_t fresh_count, fresh_capacity;
    int fresh_parts;
    dem_candidates *candidates;  ///< [threads]
    dem_push *pushes;
    size_t push_count, push_capacity;
    dem_views views;
    dem_regions *regions;  ///< NULL: nothing is measured by region
    dem_servo_sum *servo_sums;     ///< [segments * walls] (servo)
    dem_wear_events *wear_events;  ///< [segments] (wear)
    dem_pass_time clocks[DEM_PASSES];
    uint64_t searches;  ///< for pairs, since the world was made
    double warned[9];
    const dem_ctx *ctx;
    dem_ctx own_ctx;
};

/// The k-th contact of a segment's list: neighbours in the list stand in different blocks of 8, so that the lanes of a
/// block mostly hit different bodies. Soft contacts stand one after the other: their sums are over neighbours.
static inline size_t segment_place(const dem_segment *s, size_t k)
{
    return s->begin + (k % s->across) * DEM_BLOCK_LANES + k / s->across;
}
static inline void segment_set_end(dem_segment *s, size_t count, bool soft)
{
    s->end = s->begin + count;
    s->across = soft ? 1 : count / DEM_BLOCK_LANES;
    s->fresh = true;
}

static inline double *body_pose(const dem_bodies *b, size_t row)
{
    return b->bodies + DEM_BODY_ROW * row;
}
static inline dem_vec3 body_position(const dem_bodies *b, size_t row)
{
    const double *p = body_pose(b, row);
    return v3(p[0], p[1], p[2]);
}
static inline dem_quat body_orientation(const dem_bodies *b, size_t row)
{
    const double *p = body_pose(b, row);
    return (dem_quat){p[3], p[4], p[5], p[6]};
}
static inline double body_scale(const dem_bodies *b, size_t row)
{
    return body_pose(b, row)[7];
}
/// Bound of the path of the fastest surface point in one step [m].
static inline double body_stride(const dem_bodies *b, size_t row, double step)
{
    const double *m = body_pose(b, row) + 8;
    double reach = b->inertia[DEM_ROW * row + 4];
    double turning = (m[3] * m[3] + m[4] * m[4] + m[5] * m[5]) * (reach * reach);
    return step * sqrt(2 * (m[0] * m[0] + m[1] * m[1] + m[2] * m[2] + turning));
}

static inline dem_rows world_rows(const dem_world *w)
{
    return (dem_rows){.bodies = w->bodies.bodies,
                      .momentum = w->bodies.momentum,
                      .inertia = w->bodies.inertia,
                      .spheres = &w->templates.spheres[0][0],
                      .shifts = w->shifts,
                      .laws = w->laws.rows,
                      .parameters = w->laws.parameters,
                      .walls = w->walls.rows};
}

/// What stands for a number of a body: a row without one; a row that a body has left, which lists may still name.
enum { DEM_ROW_LEFT = UINT32_MAX - 1, DEM_ROW_FREE = UINT32_MAX };
static inline bool body_absent(const dem_bodies *b, size_t row)
{
    return b->id && b->id[row] >= (uint32_t)DEM_ROW_LEFT;
}
static inline uint32_t body_hold(const dem_bodies *b, size_t row)
{
    return b->hold ? b->hold[row] : 0;
}
/// The mass itself, also of a body that others see without end of it [kg].
static inline double body_mass(const dem_world *w, size_t row)
{
    const dem_template *t = &w->templates.items[w->bodies.shape[row]];
    return t->mass * template_bulk(t, body_scale(&w->bodies, row));
}

/// Kernels of contacts: those of the machine, or of the scene's plug-in; the last is for any features.
static inline const dem_contact_instance *world_instances(const dem_world *w, size_t *count)
{
    const dem_law_table *user = w->laws.plugin.table;
    *count = user ? user->instance_count : w->kernels->instance_count;
    return user ? user->instances : w->kernels->instances;
}

#endif
