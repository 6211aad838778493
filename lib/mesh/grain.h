/// Irregular grains on demand: a registry of kinds, and what can be done to any of them afterwards.
#ifndef DEM_MESH_GRAIN_H
#define DEM_MESH_GRAIN_H

#include "base/parameter.h"
#include "base/random.h"
#include "base/status.h"
#include "dem/mesh.h"
#include "mesh/fracture.h"

enum { DEM_GRAIN_PARAMS = 16 };

/// Its standard NAN: drawn from the seed.
typedef dem_parameter dem_grain_param;

/// What a kind is given to work with.
typedef struct dem_grain_request {
    const double *values;  ///< one per parameter of the kind, all in range
    uint64_t seed;
    size_t triangles;  ///< about so many
} dem_grain_request;

/// One way to make a grain. The mesh is closed, faces outwards and is star-shaped about the origin: each ray from
/// there meets it once. Its size matters only where a parameter is a length.
typedef struct dem_grain_kind {
    const char *name, *paper, *about;
    const dem_grain_param *params;
    size_t param_count;
    dem_status (*make)(const dem_ctx *ctx, const dem_grain_request *request, dem_mesh *mesh, dem_error *error);
} dem_grain_kind;

extern const dem_grain_kind dem_grain_harmonics, dem_grain_facets, dem_grain_ellipsoid, dem_grain_superquadric,
    dem_grain_polyhedron, dem_grain_rock;

/// The index-th kind, NULL behind the last.
const dem_grain_kind *dem_grain_kind_at(size_t index);
const dem_grain_kind *dem_grain_kind_find(const char *name);
/// True where the kind's own parameters set its size.
bool dem_grain_kind_has_size(const dem_grain_kind *kind);

/// A grain to make. Start from dem_grain_defaults.
typedef struct dem_grain_options {
    const char *kind;
    const double *values;  ///< one per parameter of the kind, NAN: its default; NULL: all defaults
    uint64_t seed;
    size_t triangles;        ///< about so many
    double size;             ///< diameter of the sphere of equal volume [m]; 0: the kind's own, or 1 mm
    double elongation;       ///< stretches the made grain: y by this factor [-]
    double flatness;         ///< and z by this one times the elongation [-]
    size_t dents;            ///< hollows pressed into it after that
    double dent_depth;       ///< of a hollow, part of the radius there [-]
    double dent_width_deg;   ///< angle between its middle and its rim
    double roughness;        ///< root mean square of waves on the finished surface, along its normals [m]
    double roughness_scale;  ///< their wavelength [m]
} dem_grain_options;
dem_grain_options dem_grain_defaults(void);

enum { DEM_GRAIN_MIN_TRIANGLES = 80, DEM_GRAIN_MAX_TRIANGLES = 10000000, DEM_GRAIN_MAX_DENTS = 20 };
#define DEM_GRAIN_MIN_STRETCH 0.02
#define DEM_GRAIN_MAX_DEPTH 0.8
#define DEM_GRAIN_MIN_WIDTH 5

/// Makes a grain, the same bits for the same options. Errors: DEM_USAGE for a value outside its range, or for
/// values that do not go together; DEM_INTERRUPTED.
dem_status dem_grain_make(const dem_ctx *ctx, const dem_grain_options *options, dem_mesh *mesh, dem_error *error);

/// Fills `values` of a kind with those given (NULL or NAN: none) and its defaults. DEM_USAGE for one out of range.
dem_status dem_grain_values(const dem_grain_kind *kind, const double *given, double *values, dem_error *error);

/// Breaks a block as kind rock does, from the origin to `block` [m], with the values and the seed of the request.
dem_status dem_grain_break(const dem_ctx *ctx, const dem_grain_request *request, dem_vec3 block, size_t count,
                           dem_fracture *fracture, dem_error *error);
/// One cell of it where it lies in the block; each once, for wear takes from it. Without wear they fill the block.
dem_status dem_grain_cell(const dem_grain_request *request, dem_fracture *fracture, size_t cell, dem_mesh *mesh,
                          dem_error *error);

/// For kinds: unit vectors spread over the sphere, each the one of some random candidates that is farthest from
/// all before it (Mitchell 1991).
void dem_grain_directions(dem_random *random, dem_vec3 *directions, size_t count);

#endif
