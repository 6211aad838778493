/// Parallel bonds between bodies: a pass of its own, called only where a scene has some.
///
/// A bond is computed once, by the thread that owns the segment of its first body, and leaves its impulses in a row of
/// its own; once all are there, each body adds up those of its bonds in the order of the list. So any number of threads
/// gives the same bits. What breaks is taken out of the list after the step, but stays on record.
#ifndef DEM_SIM_BONDS_H
#define DEM_SIM_BONDS_H

#include "sim/bond.h"
#include "sim/state.h"

typedef struct dem_bond {
    uint32_t a, b;                     ///< rows of the bodies, a < b
    uint32_t sphere_a, sphere_b;       ///< rows of the spheres
    int32_t sides[3];                  ///< periodic sides between them, for bodies that were never put back
    uint32_t def, state;               ///< dem_bond_state
    uint32_t id[2];                    ///< of the bodies by birth
    uint32_t gone;                     ///< bits 1 and 2: the first, the second body has left, its row is not its own
    double anchor_a[3], anchor_b[3];   ///< the bond's ends in the bodies' run frames [m]
    double frame_a[4], frame_b[4];     ///< its frame in theirs, x from a to b
    double stiffness[BOND_WAYS];       ///< [N/m], [N m/rad]
    double damping[BOND_WAYS];         ///< [N s/m], [N m s/rad]
    double radius;                     ///< of the disc [m]
    double apart;                      ///< of the surfaces when it was made [m]
    double drag[6];                    ///< impulse of the dashpots on a in the last step [N s], [N m s]
    double viscous, broken;            ///< dissipated so far; let go by the breakage [J]
    double time, point[3], stress[2];  ///< of the breakage [s], [m], [Pa]
    uint64_t step;
} dem_bond;

/// What one bond does now.
typedef struct dem_bond_load {
    dem_vec3 arm_a, arm_b;              ///< of its ends about the centres [m]
    dem_vec3 shift;                     ///< of b's image [m]
    dem_vec3 way;                       ///< from a's end to b's [m]
    dem_vec3 axis;                      ///< of the frame half way
    dem_vec3 force, turning;            ///< of the springs: on a, and what turns a against b [N], [N m]
    dem_vec3 drag_force, drag_turning;  ///< of the dashpots
    dem_vec3 rate, turn_rate;           ///< of stretch and shear, of turning [m/s], [rad/s]
    double elastic;                     ///< [J]
    double stress[2];                   ///< tension, shear [Pa]
    dem_bond_state breaks;              ///< DEM_BOND_INTACT: holds
} dem_bond_load;

struct dem_bonds {
    dem_bond_def *defs;  ///< names are this structure's
    size_t def_count;
    unsigned char *made;    ///< [defs]
    unsigned char *kin;     ///< [shapes * defs] what bodies to come are by their shape, as `member`
    unsigned char *member;  ///< [rows * defs] bits 1 and 2: of the first and second name
    bool instead;           ///< some stand for the contact of their spheres
    double due;             ///< when the next are to be made [s]; INFINITY: never
    dem_bond *items;        ///< by bodies, image, spheres
    size_t count, capacity;
    // of those that live
    uint32_t *live;
    size_t live_count;
    size_t *first;            ///< [bodies + 1] of those in `live` whose a is the row
    size_t *adjacency_first;  ///< [bodies + 1]
    uint32_t *adjacency;      ///< 2 (place in `live`), plus 1 where the row is b
    double *strain;           ///< [2 bodies] sum of k and of c over the least mass, as of timestep.h [1/s^2], [1/s]
    double *impulse;          ///< [9 a live one] force on a; moment on a; on b [N s], [N m s]
    bool *part_broke;         ///< [threads]
    uint32_t *freed;          ///< bonds whose spheres are to touch again
    size_t freed_count, freed_capacity;
    dem_bond_view *views;
    size_t view_count;
};

/// NULL in world->bonds where the scene has none. Needs the bodies. Errors: DEM_BAD_INPUT, DEM_NO_MEMORY.
dem_status dem_bonds_create(dem_world *world, const dem_scene *scene, const dem_body_def *defs, dem_error *error);
void dem_bonds_release(dem_bonds *bonds);

/// How far apart surfaces may be that are bonded [m].
double dem_bonds_gap(const dem_world *world);

/// Makes those that are due, from the near pairs as they are listed, and asks for the pairs whose contact a bond stands
/// for. Errors: DEM_BAD_INPUT, DEM_NO_MEMORY.
dem_status dem_bonds_make(dem_world *world, dem_error *error);

/// Lists of those that live, after some were made or read.
bool dem_bonds_list(dem_world *world);

/// Takes those sphere pairs of two bodies out of a list whose contact a bond stands for; returns how many stay.
size_t dem_bonds_mask(const dem_world *world, const dem_pair *pair, uint32_t *spheres, size_t count);

/// The pass: computes the bonds of the rows [begin, end), and, when all threads have done so, adds them.
void dem_bonds_compute(dem_world *world, size_t begin, size_t end, double kick, size_t part);
void dem_bonds_add(dem_world *world, size_t begin, size_t end);

/// After a step in which some broke: takes them out and asks for the contacts they stood for; and once these are
/// listed, tells the ledger what energy came with them.
dem_status dem_bonds_settle(dem_world *world, dem_error *error);
void dem_bonds_account(dem_world *world);

/// Bodies that come and go: more rows, after the `old` first; a body has come into a row; one is about to leave its row;
/// all that are to leave have left. Errors: DEM_NO_MEMORY.
bool dem_bonds_grow(dem_world *world, size_t old);
void dem_bonds_join(dem_world *world, size_t row);
void dem_bonds_lose(dem_world *world, size_t row);
void dem_bonds_forget(dem_world *world);
/// Whether the body has a bond that lives.
bool dem_bonds_hold(const dem_bonds *bonds, size_t row);

dem_bond_load dem_bond_now(const dem_world *world, const dem_bond *bond);

/// Adds all to the views that are being measured.
dem_status dem_bonds_measure(dem_world *world, dem_error *error);

/// Energy that was dissipated and let go by now [J].
void dem_bonds_ledger(const dem_bonds *bonds, double *viscous, double *broken);

/// Memory [B].
double dem_bonds_bytes(const dem_bonds *bonds);

#endif
