/// Soft contacts: one contact per pair of bodies, whose stiffness, damping and friction do not depend on how many
/// spheres describe the surfaces ("contacts_between_clumps": "soft").
///
/// Over the pairs of spheres a = (i, j) of two bodies, with overlaps d_a and weights w_i w_j (walls: w_j = 1), the
/// overlap of the bodies is the soft maximum D = tau ln S, S = sum w_i w_j s(d_a / tau), where s is the exponential
/// function, taken smoothly to 0 between -3 and -6. The law of the scene acts on D. A single sphere has D = d.
///
/// All forces are those of the potential U(D), so they are conservative and smooth; a sphere that is there twice has
/// half the weight each time. With omega_a = d D / d d_a (they add up to about 1) the pair a bears F(D) omega_a along
/// its own line of centres. Dashpots: the law's along D, with the mass that the whole patch sees, and the same constant
/// against what the pairs' speeds differ by, so that rocking on a patch is damped, too. Friction acts at the mean
/// contact point and, as a twisting spring, by the radius of gyration of the patch.
///
/// Where a grain is concave, it is cut into parts that are nearly convex (soft_parts.c), and each pair of parts has a D
/// and a memory of its own: they bear side by side, and share where they are near (soft_couple.c). All has a potential.
///
/// A wall is one partner, and so is each of the six sides of a box. The contacts with a mesh are grouped by normals
/// first, deepest first, so that each face of a groove bears for itself; see dem_soft_leaders.
///
/// The weights are those with which a plane or a ball that touches the grain's surface has S = 1: see soft_weights.c.
/// Radii of curvature (Hertz) are those of the equivalent spheres, never of a sphere of the clump.
#ifndef DEM_SIM_SOFT_H
#define DEM_SIM_SOFT_H

#include "base/text.h"
#include "dem/world.h"
#include "sim/kernels.h"

typedef struct dem_contacts dem_contacts;

/// Pairs of spheres count down to this overlap [tau]; with less than the half of it, in part.
#define DEM_SOFT_REACH 6.0

/// 1 / mass of a patch that nothing would move, as those of lanes without one: with any stiffness its inverse is
/// finite [1/kg].
#define DEM_SOFT_HEAVIEST 1e-100

/// The contacts of one pair of parts of bodies, or of a part and a wall, stand in a run. Its first one remembers for
/// all; at a mesh, where they change places, all do.
typedef struct dem_soft_runs {
    uint32_t *first;  ///< [count + 1] contact, from the segment's first
    double *rise;     ///< [count] what D is above the deepest overlap at most [m]
    size_t count, capacity, rise_capacity;
} dem_soft_runs;

/// Of a run, or of a group of it.
typedef struct dem_soft_patch {
    uint32_t row, count;     ///< first of its rows
    uint32_t place, memory;  ///< contact that stands for it, and that which remembers
    double deepest;          ///< overlap [m]
} dem_soft_patch;

/// What is found of a segment's contacts.
typedef struct dem_soft_work {
    double *rows;     ///< [8 a contact, then 8 a member of a group] see soft_patch.h
    double *overlap;  ///< [m]
    uint32_t *place;  ///< contacts of the rows of groups
    uint32_t *sorted;
    dem_soft_patch *patches;
    double *share;  ///< [2 a patch] of its force that it bears, by how much stiffer it may be; NULL: no parts
} dem_soft_work;

/// The weights that bodies of one shape and of about the same size share.
typedef struct dem_soft_table {
    uint32_t shape;
    int rung;        ///< of sizes
    uint32_t first;  ///< weight
} dem_soft_table;

typedef struct dem_soft {
    double tau;           ///< [m]; 0: contacts are not soft
    bool automatic;       ///< tau was not given
    double *weights;      ///< of the spheres of each shape and rung of sizes [-]
    uint32_t *first;      ///< [bodies] weight of a sphere: this plus the sphere's row, modulo 2^32
    double *radius;       ///< [bodies] of curvature [m]
    uint8_t *part;        ///< [template spheres] NULL: every shape is one part
    uint8_t *parts;       ///< [shapes] how many each has; NULL: one
    struct dem_soft_coupling *couplings;  ///< [shapes] of the parts; NULL: one
    dem_soft_work *work;  ///< [threads]
    size_t capacity;      ///< contacts in each
    dem_soft_table *tables;
    size_t table_count, table_capacity, weight_count, weight_capacity;
    const struct dem_soft_kernels *kernels;
} dem_soft;

static inline double soft_weight(const dem_soft *soft, uint32_t row, uint32_t sphere)
{
    return soft->weights[(uint32_t)(soft->first[row] + sphere)];
}

/// Parts of a grain at most.
enum { DEM_SOFT_PARTS = 8 };

static inline uint32_t soft_part(const dem_soft *soft, uint32_t sphere)
{
    return soft->part ? soft->part[sphere] : 0;
}

/// Cuts the spheres (x y z r) of a template, of the equivalent diameter `size` [m], into parts; part[i] is below their
/// number, which is returned. 0: no memory.
size_t dem_soft_split(const double (*spheres)[4], size_t count, double size, uint8_t *part);

/// How the parts of a shape share what they bear.
typedef struct dem_soft_coupling {
    double near[DEM_SOFT_PARTS][DEM_SOFT_PARTS];  ///< 1: the same place; 0: far apart [-]
    double stiffening;                            ///< 1 over the least eigenvalue of that [-]
} dem_soft_coupling;

void dem_soft_part_distances(const double (*spheres)[4], size_t count, double size, const uint8_t *part, size_t parts,
                             dem_soft_coupling *coupling);

/// How much stiffer than one contact the parts of two bodies may be together, or of one at a wall [-].
double dem_soft_stiffening(const dem_world *world, uint32_t a, uint32_t b, int form);

/// Sets the shares of the patches of a segment.
void dem_soft_couple(const dem_world *world, const dem_contacts *contacts, size_t segment, int form,
                     const dem_soft_work *work, size_t count);

/// Contacts with a mesh are of one group where the cosine of their normals is above that of 30 degrees.
#define DEM_SOFT_NEAR 0.866

/// The normals about which the contacts of a part with a mesh are grouped: that of the deepest, of the deepest that is
/// not near it, and so on. A contact belongs to the first one of its part that it is near to.
enum { DEM_SOFT_LEADERS = 16 };
typedef struct dem_soft_leaders {
    dem_vec3 normal[DEM_SOFT_LEADERS];
    uint32_t part[DEM_SOFT_LEADERS];
    int count;
} dem_soft_leaders;

/// The group of a contact; -1: of none yet.
static inline int soft_group(const dem_soft_leaders *leaders, dem_vec3 normal, uint32_t part)
{
    for (int i = 0; i < leaders->count; i++)
        if (leaders->part[i] == part && normal.x * leaders->normal[i].x + normal.y * leaders->normal[i].y +
                                                normal.z * leaders->normal[i].z > DEM_SOFT_NEAR)
            return i;
    return leaders->count == DEM_SOFT_LEADERS ? DEM_SOFT_LEADERS - 1 : -1;
}

/// Weights for the bodies of a world whose contacts are soft; `tau` [m], 0: by the overlap of likely impacts, see
/// soft.c. Refuses what soft contacts do not have. Nothing where contacts are not soft.
dem_status dem_soft_create(dem_world *world, double tau, dem_error *error);
void dem_soft_release(dem_world *world);

/// A body has come to a row, or to many.
dem_status dem_soft_join(dem_world *world, size_t row, dem_error *error);
dem_status dem_soft_join_all(dem_world *world, dem_error *error);

/// The mean over the bodies of the overlap that a likely impact with their like has [m].
double dem_soft_likely_overlap(const dem_world *world);

/// What --explain says of the number of spheres that touch at once.
void dem_soft_explain(const dem_world *world, dem_buffer *out);

void dem_soft_runs_release(dem_soft_runs *runs);

/// Whether two contacts, of pairs (form -1) or walls, are of the same bodies and parts. A mesh's are not yet cut by
/// parts in runs.
bool dem_soft_same_run(const dem_world *world, const dem_contacts *contacts, size_t place, size_t other,
                       int form);

/// Finds the runs and weights of the segments whose lists have changed, and makes room for the work of all.
dem_status dem_soft_reserve(dem_world *world, dem_error *error);

/// The forces of the contacts of the segments [begin, end), added to the momenta: of pairs, or of all walls.
void dem_soft_pairs(dem_world *world, size_t begin, size_t end, double kick, size_t thread);
void dem_soft_walls(dem_world *world, size_t begin, size_t end, double kick, size_t thread);

/// What the contacts of a segment do: each patch is told at the place of its deepest pair of spheres.
void dem_soft_records(dem_world *world, size_t segment, int form, dem_contact_record *records);

/// Adds the soft contacts of a body, in its axes and in units of its masses, to its problem of the time step.
void dem_soft_problem(const dem_world *world, size_t row, bool listed, double stiffness[6][6], double damping[6][6]);

/// Weights of the spheres (x y z r) of one template for the given tau; `size`: its equivalent diameter [m].
/// False: no memory.
bool dem_soft_weigh(const double (*spheres)[4], size_t count, double tau, double size, double *weights);

/// The loop over the contacts of a segment, compiled once per instruction set (kernels.cmake); all give the same bits.
/// Forces, or records.
typedef struct dem_soft_kernels {
    void (*segment)(dem_world *world, size_t segment, int form, double kick, dem_soft_work *work,
                    dem_contact_record *records);
} dem_soft_kernels;

/// The set named; NULL: none such, or not usable here.
const dem_soft_kernels *dem_soft_kernels_choose(const char *name);

extern const dem_soft_kernels dem_soft_kernels_plain, dem_soft_kernels_v3, dem_soft_kernels_v4;

#endif
