/// The hot loops of a run, compiled once per instruction set from one source; all give the same bits.
///
/// Bodies stand in rows of 8 doubles on 64-byte boundaries:
///   pose     x y z  q0 q1 q2 q3  scale          two rows side by side, 16 doubles a body
///   motion   vx vy vz  wx wy wz  1/m  1/m_least: the least mass that a contact can see
///   momentum P x y z  L x y z  strain bound      half a step before the pose; axes of space. strain: see timestep.h;
///                                                bound: of what may be taken off L (rolling "bounded")
///   inertia  1/m  1/I1 1/I2 1/I3  reach  m  1/m_least  isotropic
/// `reach` bounds the distance of a surface point from the centre where it counts for motion: 0 for one sphere at the
/// centre.
#ifndef DEM_SIM_KERNELS_H
#define DEM_SIM_KERNELS_H

#include "base/simd.h"
#include "dem/scene.h"
#include "sim/features.h"

enum { DEM_BODY_ROW = 16, DEM_ROW = 8, DEM_SPHERE_ROW = 4 };

/// Rows of bodies and of what contacts refer to.
typedef struct dem_rows {
    double *bodies;         ///< [16 a body] pose and motion
    double *momentum;       ///< [8 a body, then 8 a slot] P [kg m/s], L [kg m^2/s]
    const double *inertia;  ///< [8 a body]
    const double *spheres;  ///< [4 a sphere] x y z r of all shapes, run frame [m]
    const double *shifts;   ///< [4 an image] where images stand off [m]
    const double *laws;     ///< [LAW_SLOTS a law]
    const double *parameters;  ///< [32 a law] of the user's; NULL: there is none
    const double *walls;    ///< [16 a wall] see wall.h
} dem_rows;

/// Energy that the contacts of a segment have dissipated or let go, in lanes [J], and the largest overlap ratio.
typedef struct dem_tally {
    double friction[DEM_BLOCK_LANES], viscous[DEM_BLOCK_LANES], broken[DEM_BLOCK_LANES], work[DEM_BLOCK_LANES];
    double overlap_ratio;
    double soft_overlap;  ///< largest D of soft contacts [m]
} dem_tally;

/// What one contact does, for measuring.
typedef struct dem_contact_record {
    double normal[3], point_a[3], point_b[3];  ///< normal out of a; contact point from the centres [m]
    double overlap, normal_force, elastic_normal, elastic_slide, elastic_turn, reduced_mass, stiffness, slide_stiffness;
    double force[3];                     ///< on a [N]
    double lost_friction, lost_viscous;  ///< dissipated since the last step [J] (ledger)
    double broken;                       ///< energy of bonds that broke in it [J] (ledger)
    double turning[3];                   ///< moment on a beside that of the force [N m]
    double wall_power;                   ///< of a moving wall [W]
    double radius_a, radius_b;
    bool touches;
} dem_contact_record;

/// Columns of contacts: a multiple of 8, padded with such that never touch. Absent columns are NULL.
typedef struct dem_contact_columns {
    uint32_t *a, *b;                ///< rows of the bodies; walls have no b
    uint32_t *sphere_a, *sphere_b;  ///< rows of the spheres; of walls: row of the wall instead of sphere_b
    uint32_t *target;               ///< row of `momentum` that takes b's share
    uint32_t *shift;                ///< row of the image of b (periodic)
    uint32_t *law;                  ///< row of the law (mixed)
    double *spring[3];              ///< tangential spring [m] (friction)
    double *dash[3];                ///< force of the tangential dashpot in the last step [N] (ledger, slide_damping)
    double *roll[3];                ///< angle of the rolling spring [rad] (rolling)
    double *twist;                  ///< angle of the twisting spring [rad] (twisting)
    double *patch;                  ///< stiffness of the twisting spring in the last step [N m/rad] (soft)
    double *bond;                   ///< 1: bonded, -1: broken [-] (bonded)
    double *attached;               ///< 1: surfaces hold on to each other [-] (jkr), or the patch touches (soft)
    double *drag[3];                ///< moment not of the springs in the last step [N m] (ledger, with any of these)
    double *user[DEM_USER_COLUMNS];  ///< what a law of the user's remembers (user)
    double *user_was[7];             ///< its force, moment and energy in the last step [N, N m, J] (user, ledger)
    double *loss;                   ///< elastic force that was not passed on in the last step [N] (ledger, damped)
    double *reaction[3];            ///< force of the wall on the body [N] (walls, reaction)
    double *hardness;               ///< stiffness and dashpot over the step [N/m] (walls, reaction)
    double *weight;                 ///< share of the force that counts [-] (weighted)
    double *geometry[7];            ///< of mesh walls: normal, overlap, point from the body's centre
} dem_contact_columns;

typedef struct dem_contact_job {
    dem_contact_columns columns;
    size_t begin, end;       ///< multiples of 8
    size_t next, next_end;   ///< those that follow, whose bodies are fetched ahead; equal: all bodies are in a cache
    double last_step, kick;  ///< time since the last step; time the forces act [s]
    double next_step;        ///< the one to come [s]
    dem_tally *tally;
    dem_contact_record *records;  ///< [end - begin] instead of forces, in the columns' order; NULL: forces
} dem_contact_job;

typedef void (*dem_contact_kernel)(dem_features f, const dem_rows *rows, const dem_contact_job *job);

/// Contacts of the form MESH are measured in plain doubles before the pass: those of meshes, and of surfaces (surface.h).
typedef enum dem_wall_form { DEM_FORM_PLANE, DEM_FORM_CYLINDER, DEM_FORM_MESH, DEM_WALL_FORMS } dem_wall_form;

/// A kernel made for one set of features; the last of a set of instances serves all others.
typedef struct dem_contact_instance {
    const char *name;
    dem_features features;
    bool any;
    dem_contact_kernel pairs, walls[DEM_WALL_FORMS];
} dem_contact_instance;

/// Tells plug-ins that were made with other loops.
#define DEM_USER_SIZES                                                                                                 \
    ((uint32_t)(sizeof(dem_contact_job) + 1000 * sizeof(dem_rows) + 100000 * sizeof(dem_contact_record) +              \
                10000000 * (sizeof(dem_contact_instance) + sizeof(dem_features)) + LAW_SLOTS))

/// Energy that the motion of bodies has taken out and put in, in lanes [J].
typedef struct dem_motion_tally {
    double local[DEM_BLOCK_LANES], drag[DEM_BLOCK_LANES], rolling[DEM_BLOCK_LANES];
    double work[DEM_BLOCK_LANES];  ///< done by bodies whose motion is given
} dem_motion_tally;

/// A body whose contacts strain the time step more than it was allowed, see timestep.h.
typedef struct dem_strained {
    uint32_t row;
    double strain;  ///< [-]
} dem_strained;

typedef struct dem_motion_job {
    size_t begin, end;           ///< bodies, multiples of 8
    double step, kick;           ///< of the positions; of the forces [s]
    double gravity[3];           ///< [m/s^2]
    double *path;                ///< [bodies] length of the path of the fastest surface point [m]
    const double *limit;         ///< [bodies] of the path, that asks for a look at the body's lists
    const double *wall_limit;    ///< [bodies] of the path plus that of moving walls; NULL: none move
    double wall_path;            ///< [m]
    const double *strain_limit;  ///< [bodies] of the strain, that asks for a look at the step; NULL: not watched
    dem_strained *strained;      ///< bodies beyond it
    size_t strained_count;
    const double *before;   ///< [8 a body] momentum before the contacts (local damping)
    double local, viscous;  ///< damping: Cundall's alpha [-], c [1/s]
    bool vector, exclude_gravity;
    bool bounded;  ///< contacts set bounds to the spin
    // of motion.h only
    dem_integrator_def schemes;
    double last_step, turn_kick;  ///< time since the last step; time the moments act [s]
    const uint32_t *hold;         ///< [bodies] bits of dem_hold; NULL: none is held
    const double *kept;           ///< [6 a body] velocity and spin that are held [m/s], [rad/s]
    double *turning;              ///< [3 a body] rate of the spin in the body, a step before [rad/s^2] (walton-braun)
    dem_motion_tally *tally;  ///< ledger; NULL: none
    uint32_t *asked;          ///< bodies beyond their limit, or not finite
    size_t asked_count;
} dem_motion_job;

/// One body of a pair of near bodies, for culling its spheres.
typedef struct dem_cull_side {
    const float *x, *y, *z, *r;  ///< columns of its shape, padded to 16 by spheres that are never near
    size_t padded;
    float axes[9];  ///< run frame -> space, scale included
    float scale;
} dem_cull_side;

/// Sphere pairs nearer than a margin: found by slabs along a normal, then one by one.
typedef struct dem_cull_job {
    dem_cull_side a, b;
    float offset[3];  ///< centre of b from that of a [m]
    float normal[3];  ///< in: a guess of the direction from a to b; out: of the nearest pair
    float margin;     ///< [m]
    float error;      ///< of the heights in 32 bits [m]
    float gap;        ///< out: the bodies are at least so far apart; at most `margin` says only that pairs are listed
    float *work;      ///< [2 a.padded + 6 b.padded]
    uint32_t *pairs;  ///< out: [2 * capacity] sphere of a, sphere of b, counted within their shapes
    size_t capacity, count;  ///< count > capacity: there was no room, nothing else is valid
} dem_cull_job;

/// Bodies of one row of cells, to be compared with one body.
typedef struct dem_scan_job {
    const float *x, *y, *z, *r;  ///< columns of bodies sorted by cell [m]
    const uint32_t *id;
    size_t begin, end;
    float centre[3], reach;  ///< candidates' spheres of r nearer than `reach`
    uint32_t *found;         ///< out; room for end - begin more plus 16
    size_t count;
} dem_scan_job;

typedef struct dem_kernels {
    const char *name;
    const dem_contact_instance *instances;
    size_t instance_count;
    void (*move)(const dem_rows *rows, dem_motion_job *job);
    void (*cull)(dem_cull_job *job);
    void (*scan)(dem_scan_job *job);
} dem_kernels;

/// The best set this machine can run, or the named one (NULL: none such, or not usable here).
const dem_kernels *dem_kernels_choose(const char *name);

extern const dem_kernels dem_kernels_plain, dem_kernels_v3, dem_kernels_v4;

/// The kernel made for these features, or the one for any.
const dem_contact_instance *dem_kernels_instance(const dem_contact_instance *instances, dem_features features);

#endif
