/// Clumps: rigid bodies of glued spheres that stand for one grain.
#ifndef DEM_CLUMP_H
#define DEM_CLUMP_H

#include "dem/base.h"
#include "dem/mesh.h"

#ifdef __cplusplus
extern "C" {
#endif

/// How well a clump reproduces its mesh. Lengths are divided by the equivalent diameter d_eq, the rest
/// are fractions unless the name carries a unit. NAN: not measured.
typedef struct dem_fidelity {
    double iou_gap;               ///< 1 - intersection / union of the two solids
    double volume_error;          ///< (union - mesh) / mesh
    double distance_mean;         ///< surface to surface, mean of both directions
    double distance_max;          ///< Hausdorff: the larger of both directions
    double protrusion;            ///< farthest point of the union outside the mesh
    double centre_offset;
    double inertia_error;         ///< largest relative error of the three principal moments
    double normal_deviation_deg;  ///< mean angle between the normals of mesh and union
    double overlap_ratio;         ///< sum of the ball volumes / volume of their union
    size_t pieces;                ///< connected pieces of the union
} dem_fidelity;

typedef enum dem_mass_source {
    DEM_MASS_FROM_MESH,
    DEM_MASS_FROM_UNION,
    DEM_MASS_GIVEN,  ///< told by whoever made the clump
} dem_mass_source;

/// What a clump is made from; every pointer is copied. Lengths in metres; `balls` and `surface` in the
/// clump's own frame: centre of mass at 0, principal axes I1 <= I2 <= I3. A text that is NULL comes back as "",
/// a figure of `union_*`, `fidelity`, `shape` or `seconds` that is not known is NAN.
typedef struct dem_clump_def {
    const char *name;
    const char *source_mesh, *source_sha256, *source_unit;
    double density;               ///< [kg/m^3]
    double mass;                  ///< [kg]
    double volume;                ///< that the mass stands for [m^3]
    double inertia[3];            ///< principal, ascending [kg m^2]
    dem_mass_source mass_from;
    dem_vec3 position;            ///< clump frame -> mesh frame [m]
    dem_quat orientation;
    double union_volume;          ///< exact volume of the union of the balls [m^3]
    dem_vec3 union_centre;        ///< in the clump frame [m]
    double union_inertia[3];      ///< principal, about the union's centre, same density [kg m^2]
    const dem_ball *balls;
    size_t ball_count;
    dem_mesh surface;             ///< for pictures; triangle_count 0: none
    dem_fidelity fidelity;
    dem_shape shape;
    const char *method;           ///< how it was made
    const char *parameters;       ///< one JSON object
    uint64_t seed;
    double seconds;
    const char *version;
} dem_clump_def;

/// Immutable; one block of memory with offsets, so a copy is one memcpy of dem_clump_bytes().
typedef struct dem_clump dem_clump;

DEM_API dem_status dem_clump_create(const dem_clump_def *def, dem_clump **clump, dem_error *error);
DEM_API void dem_clump_destroy(dem_clump *clump);
DEM_API size_t dem_clump_bytes(const dem_clump *clump);
/// Of everything but `seconds`: equal for two makings that came to the same clump.
DEM_API uint64_t dem_clump_hash(const dem_clump *clump);
/// A view of everything in the clump; its pointers live as long as the clump.
DEM_API dem_clump_def dem_clump_view(const dem_clump *clump);

/// The clump file `dem-clump/1` (JSON), written and read back without loss; "-" is standard output.
DEM_API dem_status dem_clump_write(const dem_clump *clump, const char *path, dem_error *error);
DEM_API dem_status dem_clump_read(const char *path, dem_clump **clump, dem_error *error);

/// Exact volume, centre, inertia and exposed area of a union of balls, at unit density.
typedef struct dem_union {
    dem_solid solid;
    size_t pieces;      ///< connected pieces
    size_t redundant;   ///< balls without exposed surface
} dem_union;
DEM_API dem_status dem_balls_union(const dem_ball *balls, size_t count, dem_union *result, dem_error *error);

typedef enum dem_effort { DEM_EFFORT_FAST, DEM_EFFORT_DEFAULT, DEM_EFFORT_BEST } dem_effort;
/// Which of the grain's moments the union of the spheres shall have exactly.
typedef enum dem_moments_kept { DEM_MOMENTS_FREE, DEM_MOMENTS_VOLUME, DEM_MOMENTS_EXACT } dem_moments_kept;
typedef enum dem_side { DEM_SIDE_BOTH, DEM_SIDE_INSCRIBED, DEM_SIDE_OUTER } dem_side;

/// A bound that a packing's error has to keep, as dem_fidelity_measure sees it.
typedef struct dem_target {
    const char *measure;      ///< member of dem_fidelity: "inertia_error"; dem_target_read knows shorter names
    double bound;             ///< of its size, in its unit
} dem_target;
/// Reads "inertia=0.5%", "hausdorff=2%", "normal=8deg", "overlap=1.5", "pieces=1". Error: DEM_USAGE.
DEM_API dem_status dem_target_read(const char *text, dem_target *target, dem_error *error);
/// The largest of error / bound; at most 1: all targets hold.
DEM_API double dem_target_ratio(const dem_target *targets, size_t count, const dem_fidelity *fidelity);

/// A parameter of a packing method, by the name the registry gives it.
typedef struct dem_pack_value {
    const char *name;
    double value;
} dem_pack_value;
enum { DEM_PACK_VALUES = 8 };  ///< most parameters of a method

/// A packing to make. Zero-initialised fields take the defaults in brackets.
typedef struct dem_pack_options {
    const char *method;       ///< registry name ["optimal"]
    size_t spheres;           ///< at most so many [50, or max_spheres where the method's parameters set the number];
                              ///< ignored when `gap` or targets are given
    double gap;               ///< fewest spheres whose IoU gap is at most this fraction [0: not asked]
    const dem_target *targets;  ///< [target_count] fewest spheres for which these hold, too
    size_t target_count;
    size_t max_spheres;       ///< bound of `gap` and targets [2000]
    dem_effort effort;        ///< set by dem_pack_defaults
    dem_moments_kept moments; ///< set by dem_pack_defaults
    dem_side side;
    uint64_t seed;            ///< [1]
    const dem_pack_value *values;  ///< parameters of the method; those not named take their defaults [none]
    size_t value_count;
} dem_pack_options;
DEM_API dem_pack_options dem_pack_defaults(void);

typedef struct dem_pack {
    dem_ball *balls;          ///< malloc'd, in the frame of the mesh [m]
    size_t count;
    bool reached;             ///< the asked gap and targets or, without any, always true
    bool interrupted;         ///< the search for them was stopped; this is the best so far
    dem_moments_kept moments; ///< what was met: exact (10 moments), volume (and centre), free
    double moment_residual;   ///< largest relative residual of the moments met [-]
    double gap_estimate;      ///< IoU gap as the packer saw it [-]
    size_t stand_in_triangles; ///< of the coarser surface that candidates of a large mesh came from; 0: the mesh itself.
                              ///< Moments and all figures are always those of the mesh
    double stand_in_volume;   ///< how much larger it is, relative to the mesh [-]
    double stand_in_distance; ///< farthest vertex of the mesh from it, over the equivalent diameter [-]
    double seconds;           ///< [s]
    dem_pack_value used[DEM_PACK_VALUES];  ///< the parameters of the method as they were used, found ones too
    size_t used_count;
} dem_pack;

/// Packs spheres into a repaired mesh. Same result for a given seed and any number of threads.
DEM_API dem_status dem_clump_pack(const dem_ctx *ctx, const dem_mesh *mesh, const dem_pack_options *options,
                                  dem_pack *pack, dem_error *error);
DEM_API void dem_pack_free(dem_pack *pack);

/// Measures a union of balls against a repaired mesh, independently of any packer. `samples`: lines per
/// axis and surface points, 0 for the default (errors of the figures well below 2 %).
DEM_API dem_status dem_fidelity_measure(const dem_ctx *ctx, const dem_mesh *mesh, const dem_ball *balls,
                                        size_t count, size_t samples, dem_fidelity *fidelity, dem_error *error);

/// A clump to make from a mesh; see dem_make_defaults.
typedef struct dem_make_options {
    dem_pack_options pack;
    double density;              ///< [kg/m^3]
    dem_mass_source mass_from;   ///< whose mass, centre and inertia the clump gets
    const char *name;
    const char *source_mesh, *source_sha256, *source_unit;
    size_t surface_triangles;    ///< of the reduced surface kept in the clump for pictures; 0: none
} dem_make_options;
DEM_API dem_make_options dem_make_defaults(void);

/// Packs a repaired mesh and measures the result: spheres, mass properties, fidelity, shape, surface.
/// `pack` (may be NULL) also receives the packing as it came, in the frame of the mesh; free it.
DEM_API dem_status dem_clump_make(const dem_ctx *ctx, const dem_mesh *mesh, const dem_make_options *options,
                                  dem_clump **clump, dem_pack *pack, dem_error *error);

/// Size and form of a repaired mesh.
DEM_API dem_status dem_shape_measure(const dem_ctx *ctx, const dem_mesh *mesh, dem_shape *shape, dem_error *error);

#ifdef __cplusplus
}
#endif
#endif
