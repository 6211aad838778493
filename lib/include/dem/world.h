/// Worlds: many clumps as rigid bodies, taken through time by full 6-DOF central differences.
///
/// Between steps a world holds positions and orientations at time t and momenta half a step before it; at the
/// start momenta are of the same time, and the first step kicks for half of it. Everything the views show is brought to
/// time t by one evaluation of the contacts (dem_world_measure), which changes nothing.
#ifndef DEM_WORLD_H
#define DEM_WORLD_H

#include "dem/base.h"
#include "dem/clump.h"
#include "dem/scene.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct dem_world dem_world;

/// Places the scene's bodies and prepares everything; the scene may be released afterwards.
DEM_API dem_status dem_world_create(const dem_ctx *ctx, const dem_scene *scene, dem_world **world, dem_error *error);
DEM_API void dem_world_destroy(dem_world *world);

/// Steps forward. Fails with DEM_FAILED, naming body and step, where the state is not finite or runs away, or a body
/// leaves the domain; the world then stays as it is at that step.
DEM_API dem_status dem_world_step(dem_world *world, uint64_t steps, dem_error *error);

DEM_API double dem_world_time(const dem_world *world);       ///< [s]
DEM_API uint64_t dem_world_steps(const dem_world *world);    ///< since the scene's start
DEM_API double dem_world_step_size(const dem_world *world);  ///< of the next step [s]
/// The largest stable step for the contacts as they are listed now (see lib/sim/timestep.h) [s]; INFINITY: no contact.
DEM_API double dem_world_critical_step(dem_world *world);

/// Adds a force through the centre of mass and a moment to what acts on a body in the next step only [N], [N m].
/// `body` counts as in the views.
DEM_API void dem_world_push(dem_world *world, size_t body, dem_vec3 force, dem_vec3 moment);

/// The bodies that there are, in the order they were placed or came, at time t. Arrays of `count`, valid until the world steps again.
typedef struct dem_body_view {
    size_t count;
    const uint32_t *shape;         ///< index into the scene's shapes
    const double *scale;           ///< of the shape [-]
    const double *mass;            ///< [kg]
    const dem_vec3 *position;      ///< of the centre of mass, inside a periodic domain [m]
    const dem_quat *orientation;   ///< principal frame -> space
    const dem_vec3 *velocity;      ///< [m/s]
    const dem_vec3 *spin;          ///< angular velocity, axes of space [rad/s]
    const dem_vec3 *force;         ///< of contacts and walls [N]
    const dem_vec3 *moment;        ///< about the centre of mass [N m]
    const uint32_t *coordination;  ///< number of bodies and walls touched
    const uint32_t *id;            ///< number of the body by birth, which no other body ever has; NULL: its place
} dem_body_view;

/// One sphere that touches another body's sphere or a wall.
typedef struct dem_contact {
    uint32_t body, other;           ///< other: of the second body; UINT32_MAX: a wall
    uint32_t sphere, other_sphere;  ///< of the shapes; of a wall: 0
    uint32_t wall;                  ///< index into the scene's walls; UINT32_MAX: none
    dem_vec3 point;                 ///< [m]
    dem_vec3 normal;                ///< unit, out of `body`
    double overlap;                 ///< [m]
    double normal_force;            ///< positive where it pushes apart [N]
    dem_vec3 friction_force;        ///< on `body` [N]
} dem_contact;

typedef enum dem_bond_state {
    DEM_BOND_INTACT,
    DEM_BOND_BROKEN_TENSION,  ///< by stretch and bend
    DEM_BOND_BROKEN_SHEAR,    ///< by shear and twist
    DEM_BOND_LOST,            ///< one of its bodies is gone
} dem_bond_state;

/// One bond between spheres of two bodies. Of a broken one: point, stresses and time of the breakage, no force.
typedef struct dem_bond_view {
    uint32_t def;                   ///< index into the scene's bonds
    uint32_t body, other;           ///< UINT32_MAX: has left since
    uint32_t id, other_id;          ///< of these by birth, see dem_body_view
    uint32_t sphere, other_sphere;  ///< of the shapes
    dem_bond_state state;
    dem_vec3 point;         ///< half way between its ends; inside a periodic domain that of `body` [m]
    dem_vec3 axis;          ///< unit, from `body` to `other`
    dem_vec3 force;         ///< on `body`, dashpots included [N]
    dem_vec3 moment;        ///< on `body`, about the point [N m]
    double tensile_stress;  ///< largest in the disc, by stretch and bend [Pa]
    double shear_stress;    ///< largest in the disc, by shear and twist [Pa]
    double stress_ratio;    ///< the larger of the two over its strength [-]
    double radius;          ///< of the disc [m]
    double broken;          ///< time [s]; NAN: intact
    uint64_t broken_step;
} dem_bond_view;

typedef struct dem_wall_view {
    dem_vec3 position;  ///< where the frame of time 0 has moved to [m]
    dem_quat orientation;
    dem_vec3 force;   ///< of the bodies on the wall [N]
    dem_vec3 moment;  ///< about the wall's `through` [N m]
    size_t contacts;
    double pressure;     ///< with which a servo wall pushes over its area [Pa]; NAN: no servo, or no area
    double worn;         ///< volume taken off so far [m^3]
    const double *wear;  ///< of that, by triangle of the mesh as it was given, or of the whole wall [m^3]; NULL: none
    size_t wear_count;
} dem_wall_view;

/// What was found in a region that the scene measures. Pressure is positive.
typedef struct dem_measure_view {
    double volume;        ///< of the region [m^3]
    double solid_volume;  ///< of the grains in it, parts of those across its border counted as such [m^3]
    double void_ratio;    ///< volume of voids over that of solids; INFINITY: no solid [-]
    double coordination;  ///< mean number of bodies and walls touched by bodies whose centres are in it [-]
    dem_sym3 stress;      ///< sum of F l / V, symmetric part; see lib/sim/region.h [Pa]
    double mean_stress;   ///< p = trace / 3 [Pa]
    double deviatoric_stress;  ///< q = sqrt(3/2 s:s) [Pa]
    dem_sym3 fabric;           ///< mean of n n over the contacts of bodies in it; its trace is 1 [-]
    size_t bodies;             ///< whose centres are in it
    size_t contacts;           ///< of bodies with each other, in it
} dem_measure_view;

/// The energy ledger; what was dissipated and what walls have done is summed since the scene's start [J].
typedef struct dem_energy {
    double kinetic, rotational;  ///< of translation, of rotation
    double potential;            ///< of gravity, 0 at the origin
    double elastic;              ///< in contacts and bonds
    double friction;             ///< dissipated by sliding
    double viscous;              ///< dissipated by the dashpots of contacts
    double broken;               ///< let go by bonds that broke
    double local;                ///< dissipated by local damping
    double drag;                 ///< taken from the bodies by global viscous damping and by the drag of a fluid
    double work;                 ///< done by moving walls, pushes, and bodies whose motion is given
    double start;                ///< kinetic + rotational + potential + elastic at the scene's start
    double error;  ///< imbalance of all of these over the largest energy turned over [-]; NAN: no ledger kept
    double brought;  ///< by bodies that came, less what those took that left
} dem_energy;

typedef struct dem_figures {
    double time;  ///< [s]
    uint64_t step;
    size_t bodies, spheres;
    size_t came, left;           ///< bodies, through inlets and out of the domain, since the scene's start
    double came_mass, left_mass; ///< their mass [kg]
    size_t contacts;  ///< touching sphere pairs of different bodies
    size_t wall_contacts;
    double coordination;           ///< mean number of bodies and walls a body touches [-]
    double overlap_ratio;          ///< largest overlap over the smaller radius now [-]
    double largest_overlap_ratio;  ///< of the run so far [-]
    double largest_soft_overlap;   ///< of soft contacts of the run so far, over tau [-]
    double fastest;                ///< largest speed of a surface point [m/s]
    dem_vec3 centre;               ///< mean of the centres of mass, by mass [m]
    double highest;                ///< largest coordinate of a surface along -gravity (z without gravity) [m]
    size_t bonds;                  ///< intact
    size_t bonds_tension, bonds_shear;  ///< broken so far
    size_t bonds_lost;                  ///< that bodies have taken along as they left
    dem_energy energy;
} dem_figures;

/// What an inlet has done by now.
typedef struct dem_inlet_view {
    const char *name;
    size_t bodies;         ///< that came
    double mass;           ///< of these [kg]
    double asked;          ///< by the rate up to now: bodies [-] or mass [kg]
    double behind;         ///< what has not come of this for want of room: bodies [-] or mass [kg]
    bool by_mass;          ///< `asked` and `behind` are masses
    bool over;             ///< no more will come
} dem_inlet_view;

/// Brings the views to time t. Errors: DEM_NO_MEMORY.
DEM_API dem_status dem_world_measure(dem_world *world, dem_error *error);
/// All as of the last dem_world_measure.
DEM_API const dem_figures *dem_world_figures(const dem_world *world);
DEM_API dem_body_view dem_world_bodies(const dem_world *world);
/// Listed when they are first asked for, which is to be before the world steps again. NULL and 0: no memory for them.
DEM_API const dem_contact *dem_world_contacts(const dem_world *world, size_t *count);
DEM_API const dem_inlet_view *dem_world_inlets(const dem_world *world, size_t *count);
/// All that were ever made, broken ones too.
DEM_API const dem_bond_view *dem_world_bonds(const dem_world *world, size_t *count);
DEM_API const dem_wall_view *dem_world_walls(const dem_world *world, size_t *count);

/// Of the scene's measures, in their order.
DEM_API const dem_measure_view *dem_world_measures(const dem_world *world, size_t *count);

/// A shape as the world runs it: its clump in the principal frame (owned by the world).
DEM_API const dem_clump *dem_world_clump(const dem_world *world, uint32_t shape);

/// A copy of the whole state in one block, from which the run continues bit for bit. The caller frees *bytes.
DEM_API dem_status dem_world_save(const dem_world *world, void **bytes, size_t *size, dem_error *error);
/// Puts a world made from the same scene into the saved state. Errors: DEM_BAD_INPUT where the block is broken or of
/// another scene; the world is then unusable but for dem_world_destroy.
DEM_API dem_status dem_world_restore(dem_world *world, const void *bytes, size_t size, dem_error *error);

/// A hash of the state: equal for equal bits.
DEM_API uint64_t dem_world_hash(const dem_world *world);

/// What the scene pays for, as text: columns with bytes per body and contact, passes, kernels, libraries, step.
DEM_API dem_status dem_world_explain(dem_world *world, char **text, dem_error *error);

/// Seconds spent so far in each pass.
typedef struct dem_pass_time {
    const char *name;
    double seconds;
} dem_pass_time;
DEM_API const dem_pass_time *dem_world_passes(const dem_world *world, size_t *count);
/// Sets the clocks of the passes to 0.
DEM_API void dem_world_reset_clocks(dem_world *world);
/// Memory the state takes, by body [B].
DEM_API double dem_world_bytes_per_body(const dem_world *world);

#ifdef __cplusplus
}
#endif
#endif
