/// Scenes: what a world is made from. Plain values with defaults; a scene file (dem-scene/1) reads into them.
///
/// SI units. A number that was not given and has no default is NAN. Formulas: PHYSICS of the design, named where used.
#ifndef DEM_SCENE_H
#define DEM_SCENE_H

#include "dem/base.h"
#include "dem/clump.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct dem_material {
    const char *name;
    double density;  ///< [kg/m^3]; NAN: the clump's own
    double young;    ///< Young's modulus [Pa]
    double poisson;  ///< Poisson's ratio [-]
} dem_material;

typedef enum dem_normal_law {
    DEM_NORMAL_LINEAR,  ///< F = k overlap
    DEM_NORMAL_HERTZ,   ///< F = 4/3 E* sqrt(R*) overlap^1.5
    DEM_NORMAL_JKR,     ///< soft adhesive surfaces, which hold on beyond the touch (Johnson, Kendall & Roberts 1971)
    DEM_NORMAL_DMT,     ///< the same less 2 pi w R*, the pull of stiff dry adhesive surfaces (Derjaguin et al. 1975)
    DEM_NORMAL_PLUGIN,  ///< a law of the user's (dem/law.h), which says all forces
} dem_normal_law;

typedef enum dem_damping_law {
    DEM_DAMPING_NONE,
    DEM_DAMPING_RESTITUTION,  ///< a dashpot that gives the asked coefficient of restitution
    DEM_DAMPING_RATE,         ///< c = m_eff G
} dem_damping_law;

/// What happens where spring and dashpot together would pull at the end of a contact.
typedef enum dem_tail {
    DEM_TAIL_CUT,      ///< the force is cut at 0, and the damping ratio is the one that gives the asked restitution so
    DEM_TAIL_TENSION,  ///< the dashpot may pull
} dem_tail;

/// The mass that a contact's dashpot sees.
typedef enum dem_effective_mass {
    DEM_MASS_LOCAL,  ///< of the two surfaces at the contact point, along its normal
    DEM_MASS_BODY,   ///< m_p m_q / (m_p + m_q)
} dem_effective_mass;

typedef enum dem_friction_law {
    DEM_FRICTION_NONE,
    DEM_FRICTION_LINEAR,   ///< spring k_t
    DEM_FRICTION_MINDLIN,  ///< spring 8 G* sqrt(R* overlap)
} dem_friction_law;

/// Resistance to rolling of two surfaces over each other.
typedef enum dem_rolling_law {
    DEM_ROLLING_NONE,
    DEM_ROLLING_BOUNDED,   ///< stops or slows the spin of each body by at most sum of eta R_min F_n (Irazabal et al. 2017)
    DEM_ROLLING_EPSD,      ///< spring, dashpot and cap mu_r R* F_n (Ai et al. 2011, type C)
    DEM_ROLLING_CONSTANT,  ///< mu_r R* F_n against the rate; trembles at rest (Ai et al. 2011, type A)
} dem_rolling_law;

/// Resistance to twisting about the normal.
typedef enum dem_twisting_law {
    DEM_TWISTING_NONE,
    DEM_TWISTING_MARSHALL,  ///< spring k_t a^2 / 2, dashpot c_t a^2 / 2, cap 2/3 mu a F_n, a = sqrt(R* overlap) (2009)
    DEM_TWISTING_CONSTANT,  ///< mu_tw R* F_n against the rate
} dem_twisting_law;

typedef enum dem_cohesion_law {
    DEM_COHESION_NONE,
    DEM_COHESION_SJKR,       ///< pull by an energy density times the area of the overlap
    DEM_COHESION_BREAKABLE,  ///< surfaces hold, both ways, until the pull or the shear is too large
} dem_cohesion_law;

/// When surfaces of breakable cohesion are bonded. What has broken stays so until they have parted.
typedef enum dem_bonded {
    DEM_BONDED_AT_START,  ///< those that touch when the run starts (nearer than the gap), as contact bonds of PFC
    DEM_BONDED_AT_TOUCH,  ///< these, and all that come to touch later
} dem_bonded;

/// A number of a law of the user's.
typedef struct dem_law_value {
    const char *name;
    double value;
} dem_law_value;

/// The law between two materials.
typedef struct dem_pair_law {
    uint32_t materials[2];
    dem_effective_mass effective_mass;
    dem_normal_law normal;
    const char *plugin;               ///< resolved path of the plug-in
    const dem_law_value *parameters;  ///< those of its law's numbers that are given
    size_t parameter_count;
    double stiffness;  ///< of the linear law [N/m]; 0: k = E A / L from the materials
    dem_damping_law damping;
    double restitution;   ///< 0..1 [-]
    double damping_rate;  ///< G [1/s]
    dem_tail tail;
    dem_friction_law friction;
    double friction_coefficient;  ///< [-]
    double static_coefficient;    ///< at rest: mu = mu_d + (mu_s - mu_d) exp(-decay |v_t|) [-]; NAN: the same
    double friction_decay;        ///< how fast friction falls with the speed [s/m]
    double tangential_stiffness;  ///< of the linear law [N/m]; NAN: stiffness_ratio of the normal one
    double stiffness_ratio;       ///< k_t / k_n [-]
    double tangential_rate;       ///< c_t = m_eff G_t [1/s]; NAN: c_t = c_n sqrt(k_t / k_n) with a restitution, else 0
    bool rescale;                 ///< Mindlin: let the spring fall with the contact radius when unloading
    double work_of_adhesion;      ///< w of JKR and DMT [J/m^2]
    dem_rolling_law rolling;
    double rolling_coefficient;  ///< eta or mu_r [-]
    double rolling_stiffness;    ///< k_r of epsd [N m/rad]; NAN: 2.25 k_n mu_r^2 R*^2
    double rolling_damping;      ///< ratio of the dashpot of epsd [-]
    dem_twisting_law twisting;
    double twisting_coefficient;  ///< mu_tw of the constant law [-]
    dem_cohesion_law cohesion;
    double energy_density;  ///< of SJKR [J/m^3]
    double bond_tension;    ///< strength of breakable cohesion: largest pull [N]
    double bond_shear;      ///< and largest tangential force [N]
    dem_bonded bonded;
    double bond_gap;  ///< surfaces nearer than this are bonded at the start [m]
} dem_pair_law;

/// One kind of grain. Exactly one of `clump_file`, `clump`, `sphere_radius` tells its form.
typedef struct dem_shape_def {
    const char *name;
    const char *clump_file;  ///< resolved path; NULL: none
    const dem_clump *clump;  ///< also what was read from `clump_file`
    double sphere_radius;    ///< [m]; 0: not a sphere
    double disc_thickness;   ///< 0, or the sphere is a disc of two dimensions: m = rho pi r^2 t, I = m r^2 / 2 [m]
    uint32_t material;
} dem_shape_def;

/// What of a body's motion is held, as bits: components in the axes of space that stay 0, or its velocity and spin,
/// which stay what they are at the start. A fixed body has both held at 0. What holds it does work (dem_energy).
typedef enum dem_hold {
    DEM_LOCK_X = 1,
    DEM_LOCK_Y = 2,
    DEM_LOCK_Z = 4,
    DEM_LOCK_RX = 8,  ///< turning about x
    DEM_LOCK_RY = 16,
    DEM_LOCK_RZ = 32,
    DEM_HOLD_VELOCITY = 64,
    DEM_HOLD_SPIN = 128,
} dem_hold;

/// One body as it starts, velocities at the time of the position.
typedef struct dem_body_def {
    uint32_t shape;
    double scale;          ///< of the shape [-]
    dem_vec3 position;     ///< of the centre of mass [m]
    dem_quat orientation;  ///< principal frame -> space
    dem_vec3 velocity;     ///< [m/s]
    dem_vec3 spin;         ///< angular velocity, axes of space [rad/s]
    uint32_t hold;         ///< bits of dem_hold
    const char *group;     ///< for bonds; NULL: none
} dem_body_def;

typedef enum dem_size_law {
    DEM_SIZE_AS_IS,      ///< the shape's own
    DEM_SIZE_FIXED,      ///< a
    DEM_SIZE_UNIFORM,    ///< from a to b
    DEM_SIZE_NORMAL,     ///< mean a, standard deviation b
    DEM_SIZE_LOGNORMAL,  ///< median a, standard deviation b of the logarithm
    DEM_SIZE_TABLE,      ///< a grading curve: `passing` of `sizes`
} dem_size_law;

/// How the equivalent diameters of bodies are drawn.
typedef struct dem_size_def {
    dem_size_law law;
    double a, b;               ///< [m], of the lognormal b [-]
    double smallest, largest;  ///< draws outside are repeated [m]; 0 and INFINITY: any
    bool by_mass;              ///< the law tells shares of mass, not of number
    const double *sizes;       ///< ascending [m]
    const double *passing;     ///< ascending from 0 to 1 [-]
    size_t table_count;
} dem_size_def;

typedef struct dem_mix_def {
    uint32_t shape;
    double share;  ///< of the number of bodies, or of their mass; relative to the sum of all [-]
    dem_size_def size;
} dem_mix_def;

/// Bodies to be placed at random without any overlap.
typedef struct dem_fill_def {
    const dem_mix_def *mix;
    size_t mix_count;
    bool share_by_mass;
    dem_vec3 low, high;  ///< box that holds every sphere of every body [m]
    size_t count;        ///< 0: by void ratio
    double void_ratio;   ///< of the box: volume of voids / volume of solids [-]
    double gap;          ///< least distance between surfaces [m]
    dem_vec3 velocity;   ///< of all [m/s]
    uint32_t hold;       ///< of all, bits of dem_hold
    const char *group;   ///< of all; NULL: none
    uint64_t seed;
} dem_fill_def;

/// Where the bodies come from, in this order: listed ones, then fills.
typedef struct dem_bodies_def {
    const dem_body_def *bodies;
    size_t count;
    const dem_fill_def *fills;
    size_t fill_count;
} dem_bodies_def;

typedef enum dem_inlet_kind { DEM_INLET_BOX, DEM_INLET_SPHERE } dem_inlet_kind;

/// A place where bodies come from while the scene runs, never into an overlap: where there is no room they wait. Each
/// is turned at random, uniformly over all orientations.
///
/// In a box a body appears at a random place and is free at once. In a generator sphere it appears with its centre of
/// mass at the sphere's and keeps its velocity and spin, whatever it meets, until it is wholly outside; the next one
/// comes after that. To free bodies generator spheres are solid where a wall stands for them, see
/// dem_wall_def.generator.
typedef struct dem_inlet_def {
    const char *name;
    dem_inlet_kind kind;
    dem_vec3 low, high;  ///< of a box, which holds every sphere of a body as it appears [m]
    dem_vec3 centre;     ///< of a generator sphere [m]
    double radius;       ///< of a generator sphere, not less than that of the largest body [m]
    bool solid;          ///< the scene has a wall for this sphere, written with the inlet
    uint32_t material;   ///< of that wall
    const dem_mix_def *mix;
    size_t mix_count;
    bool share_by_mass;
    double rate;             ///< bodies [1/s], or mass [kg/s]
    bool by_mass;            ///< the rate is of mass
    dem_vec3 velocity;       ///< mean [m/s]
    double velocity_spread;  ///< standard deviation of each component [m/s]
    dem_vec3 spin;           ///< mean, axes of space [rad/s]
    double spin_spread;      ///< standard deviation of each component [rad/s]
    double start, stop;      ///< from when to when [s]; stop INFINITY: never
    size_t count;            ///< bodies in all; 0: no end
    double gap;              ///< least distance to others where a body appears [m]
    uint64_t seed;
} dem_inlet_def;

typedef enum dem_wall_kind {
    DEM_WALL_PLANE,
    DEM_WALL_CYLINDER,
    DEM_WALL_MESH,
    DEM_WALL_CONE,       ///< with ends solid on both sides, also between equal radii and of no length
    DEM_WALL_SPHERE,
    DEM_WALL_DISC,       ///< solid on both sides
    DEM_WALL_RECTANGLE,  ///< solid on both sides
} dem_wall_kind;

/// What a bond does to the contact of the two spheres it joins, while it lives.
typedef enum dem_bond_contact {
    DEM_BOND_PARALLEL,  ///< both act
    DEM_BOND_INSTEAD,   ///< the bond alone acts
} dem_bond_contact;

/// Parallel bonds: elastic discs between spheres of different bodies (Potyondy & Cundall 2004; PHYSICS 1.7). One stands
/// between every two spheres whose surfaces are near enough, half way between the surfaces.
typedef struct dem_bond_def {
    const char *name;
    const char *between[2];      ///< groups of bodies, or shapes; NULL: all
    double gap;                  ///< surfaces nearer than this are bonded [m]
    double at;                   ///< when [s]
    double radius_multiplier;    ///< radius of the disc over that of the smaller sphere [-]
    double young;                ///< k_n = E / L, L between the spheres' centres [Pa]
    double shear_ratio;          ///< k_s / k_n [-]
    double tensile_strength;     ///< the bond breaks beyond this tension in the disc [Pa]; INFINITY: never
    double shear_strength;       ///< and beyond this shear [Pa]
    double moment_contribution;  ///< share of the moments in these stresses, 0..1 [-]
    double damping;              ///< ratio of the dashpots of all four ways [-]
    dem_bond_contact contact;
} dem_bond_def;

/// A sine about the place at time 0: the wall is shifted by `shift` (sin(2 pi f t + phase) - sin(phase)), and turned
/// likewise.
typedef struct dem_oscillation {
    dem_vec3 shift;    ///< amplitude [m]
    double turn;       ///< amplitude about the wall's `axis` [rad]
    double frequency;  ///< [Hz]
    double phase;      ///< [rad]
} dem_oscillation;

/// Where a wall is by time, between the rows of a table; before the first and behind the last it stands still.
typedef struct dem_wall_table {
    const char *file;       ///< resolved path; NULL: made by hand
    bool cubic;             ///< smooth: cubic between the rows, with the slopes of their neighbours; else straight
    size_t count;           ///< of rows; 0: no table
    const double *time;     ///< ascending [s]
    const dem_vec3 *shift;  ///< [m]
    const double *turn;     ///< about the wall's `axis` [rad]; NULL: does not turn
} dem_wall_table;

/// One of the two lengths that an area of a servo wall is the product of.
typedef struct dem_servo_extent {
    double length;      ///< [m]; 0: the distance between two planes as they stand
    uint32_t walls[2];  ///< these
} dem_servo_extent;

/// A wall that moves along a direction until the bodies push back as asked (PHYSICS 5):
/// v = gain (F - F now) / (step sum of (stiffness + damping / step) of its contacts), at most max_velocity either way.
typedef struct dem_servo_def {
    bool on;
    dem_vec3 direction;          ///< unit, towards the bodies
    bool stress;                 ///< `target` is over an area
    double target;               ///< [N] or [Pa]
    double area;                 ///< [m^2]; 0: from the extents
    dem_servo_extent extent[2];  ///< both 0: a wall that has an area of its own
    double gain;                 ///< alpha, above 0 and at most 1 [-]
    double max_velocity;         ///< [m/s]
    double mass;                 ///< 0: none, the velocity follows the force at once [kg]
    double damping_rate;         ///< of a wall with a mass [1/s]
    uint32_t partner;            ///< 1 + the wall that goes as fast the other way, both by the mean; 0: none
} dem_servo_def;

typedef enum dem_wear_law {
    DEM_WEAR_NONE,
    DEM_WEAR_FINNIE,   ///< by the impacts of bodies (1960)
    DEM_WEAR_ARCHARD,  ///< by sliding under a force (1953)
} dem_wear_law;

/// What bodies take off a wall; see lib/sim/wear.h. The wall keeps its form.
typedef struct dem_wear_def {
    dem_wear_law law;
    double constant;     ///< K of Finnie, normal over tangential force [-]
    double pressure;     ///< p of Finnie, at which the wall flows [Pa]
    double psi;          ///< of Finnie: length of the cut over its depth [-]
    double roughness;    ///< of Finnie: share of the grains that cut [-]
    double coefficient;  ///< of Archard [-]
    double hardness;     ///< of Archard [Pa]
} dem_wear_def;

/// A rigid wall. A box is six planes. Geometry as it stands at time 0.
typedef struct dem_wall_def {
    const char *name;
    dem_wall_kind kind;
    uint32_t material;
    dem_vec3 point;         ///< of a plane; of a cylinder's axis; where a cone begins; a centre [m]
    dem_vec3 normal;        ///< unit, towards the bodies; of a cylinder or cone: its axis
    double radius;          ///< of a cylinder, sphere or disc; of a cone where it begins [m]
    bool outside;           ///< the bodies are outside of a cylinder, a sphere, a cone without an end
    double length;          ///< of a cone; INFINITY: without an end, from its tip on [m]
    double end_radius;      ///< of a cone with ends [m]
    double angle;           ///< of a cone without an end, between axis and surface [rad]
    dem_vec3 along;         ///< direction of a rectangle's first side
    double size[2];         ///< of a rectangle [m]
    const char *mesh_file;  ///< resolved path
    dem_mesh mesh;          ///< [m]; read from mesh_file where that is given
    dem_vec3 velocity;      ///< [m/s]
    dem_vec3 through;       ///< a point of the axis of rotation [m]
    dem_vec3 spin;          ///< angular velocity [rad/s]
    double start, stop;     ///< velocity, spin and oscillations act between; stop 0: on and on [s]
    const dem_oscillation *oscillations;
    size_t oscillation_count;
    dem_wall_table table;  ///< comes on top, and is not stopped
    dem_vec3 axis;         ///< unit, that oscillations and table turn about; along `spin` where that is not 0
    dem_servo_def servo;   ///< comes on top, too
    dem_wear_def wear;     ///< not of planes and cylinders without an end
    bool generator;        ///< it is a generator sphere: in no inlet's way, and no body is freed before it is out of it
} dem_wall_def;

typedef enum dem_leaving { DEM_LEAVING_ERROR, DEM_LEAVING_IGNORE, DEM_LEAVING_DELETE } dem_leaving;

typedef struct dem_domain_def {
    dem_vec3 low, high;  ///< infinite where not given [m]
    bool periodic[3];
    dem_leaving leaving;  ///< what a body's centre outside of a side that is not periodic comes to
} dem_domain_def;

typedef enum dem_local_frame {
    DEM_LOCAL_SPACE,   ///< each component of force and moment against that of the velocity
    DEM_LOCAL_VECTOR,  ///< force and moment as vectors against the velocity
} dem_local_frame;

/// A fluid that flows evenly and drags each body as the sphere of its volume (Schiller & Naumann 1933). Density and
/// viscosity 0: there is none.
typedef struct dem_drag_def {
    double density;     ///< [kg/m^3]
    double viscosity;   ///< dynamic [Pa s]
    dem_vec3 velocity;  ///< [m/s]
    bool buoyancy;      ///< bodies weigh less by the fluid they displace
} dem_drag_def;

typedef struct dem_damping_def {
    double local;  ///< Cundall's alpha, 0..1 [-]
    dem_local_frame local_frame;
    bool exclude_gravity;  ///< local damping acts on the contact forces only
    double viscous;        ///< F = -c m v, T = -c L [1/s]
    dem_drag_def drag;
} dem_damping_def;

/// How positions follow from forces, one evaluation of the forces a step (PHYSICS 2.1).
typedef enum dem_translation {
    DEM_TRANSLATION_CENTRAL,           ///< v(n+1/2) = v(n-1/2) + a h, x += v(n+1/2) h: order 2, symplectic
    DEM_TRANSLATION_SYMPLECTIC_EULER,  ///< v += a h, x += v h, velocities said to be of the time of the positions
    DEM_TRANSLATION_VELOCITY_VERLET,   ///< two half kicks about the step: the trajectory of `central`
    DEM_TRANSLATION_TAYLOR,            ///< x += v h + a h^2 / 2, v += a h: grows by sqrt(1 + (w h)^2 / 2) a step
    DEM_TRANSLATION_FORWARD_EULER,     ///< x += v h, v += a h: grows by sqrt(1 + (w h)^2) a step
    DEM_TRANSLATION_NEWMARK,           ///< explicit, beta 0 and gamma 1/2: the trajectory of `central`
} dem_translation;

/// How orientations follow from moments (PHYSICS 2.2).
typedef enum dem_rotation {
    DEM_ROTATION_LSYM,          ///< angular momentum at half steps, free rotor by a symmetric top between half turns
    DEM_ROTATION_LSYM4,         ///< the same with five turns of order 4 (Suzuki 1990)
    DEM_ROTATION_SPIRAL,        ///< leapfrog form of SPIRAL (del Valle et al. 2024)
    DEM_ROTATION_NO_SQUISH,     ///< turns about single axes in the order 3, 2, 1, 2, 3 (Miller et al. 2002)
    DEM_ROTATION_OMELYAN,       ///< angular velocity in the body by fixed-point iteration (Omelyan 1998)
    DEM_ROTATION_FINCHAM,       ///< angular momentum at half steps, orientation by a half step (Fincham 1992)
    DEM_ROTATION_WALTON_BRAUN,  ///< angular velocity in the body, its rate carried on (Walton & Braun 1993)
    DEM_ROTATION_PCDM,          ///< predictor and corrector, direct multiplication (Zhao & van Wachem 2013)
} dem_rotation;

typedef struct dem_integrator_def {
    dem_translation translation;
    dem_rotation rotation;
} dem_integrator_def;

/// How several contacts of one pair of bodies add up.
typedef enum dem_multiple {
    DEM_MULTIPLE_SUM,
    DEM_MULTIPLE_MEAN,
    DEM_MULTIPLE_MERGE,
    DEM_MULTIPLE_SOFT,  ///< one contact by a soft maximum of the overlaps, whatever the number of spheres
} dem_multiple;

typedef struct dem_soft_def {
    double tau;  ///< length of the soft maximum, .2 to .3 of the typical largest overlap [m]; 0: by likely impacts
} dem_soft_def;

typedef struct dem_time_def {
    double end;            ///< [s]; NAN: not given
    double step;           ///< [s]; 0: auto
    double safety;         ///< of the automatic step [-]; NAN: 0.8, with a Hertz law 0.5
    double contact_steps;  ///< least number of automatic steps in the shortest contact [-]; 0: stability alone
} dem_time_def;

typedef enum dem_region {
    DEM_REGION_WHOLE,  ///< the domain; where it is open, the box that holds all spheres
    DEM_REGION_BOX,
    DEM_REGION_BALL,
} dem_region;

/// A region whose stress, fabric and packing are measured whenever the world is; it does not move.
typedef struct dem_measure_def {
    const char *name;
    dem_region region;
    dem_vec3 low, high;  ///< of a box [m]
    dem_vec3 centre;     ///< of a ball [m]
    double radius;       ///< of a ball [m]
    bool kinetic;        ///< the stress with that of the bodies' motion about their mean
} dem_measure_def;

typedef struct dem_output_def {
    const char *directory;
    double frames;         ///< interval [s]; 0: none
    double series;         ///< interval [s]; 0: none
    double contacts;       ///< interval of the network of contacts [s]; 0: none
    double checkpoint;     ///< interval [s]; 0: none
    bool checkpoint_wall;  ///< the interval is of the clock on the wall
    bool energy;           ///< keep the energy ledger
} dem_output_def;

/// A whole scene. Arrays are borrowed; those of a scene that was read belong to `owner`.
typedef struct dem_scene {
    const char *title;
    unsigned dimension;  ///< 3, or 2: bodies keep their z and turn about it only
    dem_vec3 gravity;    ///< [m/s^2]
    dem_time_def time;
    dem_domain_def domain;
    const dem_material *materials;
    size_t material_count;
    const dem_pair_law *laws;
    size_t law_count;
    const dem_shape_def *shapes;
    size_t shape_count;
    dem_bodies_def bodies;
    const dem_wall_def *walls;
    size_t wall_count;
    const dem_inlet_def *inlets;
    size_t inlet_count;
    const dem_bond_def *bonds;  ///< of two that fit the same spheres the first counts
    size_t bond_count;
    dem_damping_def damping;
    dem_integrator_def integrator;
    dem_multiple multiple;
    dem_soft_def soft;
    const dem_measure_def *measures;
    size_t measure_count;
    dem_output_def output;
    struct dem_scene_owner *owner;
} dem_scene;

/// An empty scene with all defaults.
DEM_API dem_scene dem_scene_defaults(void);
/// A law between two materials with all defaults: linear, no stiffness yet, no damping, no friction.
DEM_API dem_pair_law dem_pair_law_defaults(void);
/// Bonds with all defaults: between all bodies whose spheres touch, unbreakable, no Young's modulus yet.
DEM_API dem_bond_def dem_bond_defaults(void);

/// Reads a scene file; the paths in it are relative to its folder. `overrides` are "path.to.key=value" texts, NULL
/// behind the last (or NULL). Clumps, bodies' files and wall meshes are read too, so that a scene that was read is
/// whole. Errors: DEM_BAD_INPUT with file, line and column, DEM_USAGE for a wrong override.
DEM_API dem_status dem_scene_read(const dem_ctx *ctx, const char *path, const char *const *overrides, dem_scene *scene,
                                  dem_error *error);
DEM_API void dem_scene_release(dem_scene *scene);

/// Appends the scene as a file with every default written out, bodies as they were given (files by name).
/// The caller frees *text.
DEM_API dem_status dem_scene_resolved(const dem_scene *scene, char **text, dem_error *error);

#ifdef __cplusplus
}
#endif
#endif
