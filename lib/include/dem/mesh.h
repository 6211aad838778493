/// Triangle meshes of grains: reading, checking, repairing, measuring, making.
#ifndef DEM_MESH_H
#define DEM_MESH_H

#include "dem/base.h"

#ifdef __cplusplus
extern "C" {
#endif

/// Indexed triangles, counter-clockwise seen from outside. Both arrays come from malloc.
typedef struct dem_mesh {
    dem_vec3 *vertices;      ///< [vertex_count] [m]
    uint32_t *triangles;     ///< [3 * triangle_count] vertex indices
    size_t vertex_count;
    size_t triangle_count;
    bool single_precision;   ///< the file stored 32-bit coordinates (binary STL, float PLY, assimp)
} dem_mesh;

/// Reads STL, OBJ, PLY or OFF, decided by content first and name second; "-" is standard input.
/// The mesh is as the file has it (triangulated, finite, indices in range), neither welded nor checked.
/// Errors: DEM_BAD_INPUT with file and line, DEM_NO_MEMORY. In libdem.
DEM_API dem_status dem_mesh_read(const dem_ctx *ctx, const char *path, dem_mesh *mesh, dem_error *error);
/// The same, and what only assimp knows (glTF, 3MF, COLLADA, FBX, ...), read in a guarded child process.
/// Also DEM_UNAVAILABLE without assimp. In libdemshape.
DEM_API dem_status dem_mesh_import(const dem_ctx *ctx, const char *path, dem_mesh *mesh, dem_error *error);
DEM_API void dem_mesh_free(dem_mesh *mesh);
DEM_API dem_status dem_mesh_copy(const dem_mesh *from, dem_mesh *to, dem_error *error);
/// Multiplies every coordinate.
DEM_API void dem_mesh_scale(dem_mesh *mesh, double factor);

typedef enum dem_repair {
    DEM_REPAIR_AUTO,    ///< mend what can be mended without guessing
    DEM_REPAIR_STRICT,  ///< refuse a mesh that needs anything but welding
    DEM_REPAIR_WRAP,    ///< wrap whatever is there in a closed surface
    DEM_REPAIR_NONE,    ///< weld only, take the surface as it is; refuse what encloses no volume
} dem_repair;

typedef enum dem_keep {
    DEM_KEEP_ONE,      ///< several separate bodies are an error
    DEM_KEEP_LARGEST,
    DEM_KEEP_ALL,      ///< as one rigid body
} dem_keep;

typedef struct dem_repair_options {
    dem_repair repair;
    dem_keep keep;
    double wrap_detail;  ///< smallest feature the wrap follows, as a part of the bounding diagonal [-]; 0: 1/100
} dem_repair_options;

/// What was found in a mesh and what was done about it. Counts are of the input unless named otherwise.
typedef struct dem_mesh_report {
    size_t input_vertices, input_triangles;
    size_t vertices, triangles;          ///< of the result
    size_t unreferenced_vertices;
    size_t welded_vertices;              ///< merged with another one by tolerance (exact duplicates not counted)
    double weld_tolerance;               ///< [m]; 0: exact
    size_t degenerate_triangles;         ///< zero area, removed
    size_t duplicate_triangles;          ///< removed
    size_t nonmanifold_edges;
    size_t dropped_triangles;            ///< fins and strays removed
    size_t reoriented_triangles;         ///< flipped to agree with their neighbours
    bool inside_out;                     ///< the whole surface was flipped
    size_t boundary_edges;
    size_t holes_filled, hole_edges;
    size_t shells;                       ///< closed surfaces found
    size_t bodies;                       ///< separate solids found
    size_t cavities;                     ///< inner surfaces kept as voids
    size_t ignored_shells;               ///< inner shells of the same orientation, removed
    size_t merged_shells;                ///< overlapping shells united
    size_t self_intersections;           ///< pairs of triangles
    bool wrapped;
    double volume_before;                ///< signed volume as welded, before any repair [m^3]
    double volume;                       ///< of the result [m^3]
    double volume_change;                ///< what filling, dropping, uniting and wrapping changed, relative to `volume` [-]
    size_t warnings;                     ///< lines sent to the log
} dem_mesh_report;

/// Welds, checks and repairs in place until the mesh is one closed, outward-oriented surface per body.
/// Every repair is one warning in the log. Errors: DEM_BAD_INPUT where it encloses no volume or the volume
/// would be a guess.
DEM_API dem_status dem_mesh_repair(const dem_ctx *ctx, dem_mesh *mesh, const dem_repair_options *options,
                                   dem_mesh_report *report, dem_error *error);

/// The closed bodies of a repaired mesh, largest first, cavities with the body that holds them.
/// `bodies` is one malloc'd array of *count meshes; free each and the array.
DEM_API dem_status dem_mesh_split(const dem_mesh *mesh, dem_mesh **bodies, size_t *count, dem_error *error);

/// Exact mass properties at unit density by the divergence theorem about a local origin
/// (Tonon 2004; Mirtich 1996), compensated sums. The mesh must be closed.
DEM_API dem_solid dem_mesh_solid(const dem_mesh *mesh);
/// Volume, first and second moments about `origin`, axes of the mesh's frame; same method and condition.
DEM_API dem_moments dem_mesh_moments(const dem_mesh *mesh, dem_vec3 origin);

/// Size and form of a grain. Lengths in metres, the rest pure numbers.
typedef struct dem_shape {
    double equivalent_diameter;               ///< of the sphere of equal volume [m]
    double longest, intermediate, shortest;   ///< edges of the minimum-volume bounding box [m]
    double elongation;     ///< intermediate / longest [-]
    double flatness;       ///< shortest / intermediate [-]
    double sphericity;     ///< true sphericity (Wadell 1932): area of the equal-volume sphere / area [-]
    double convexity;      ///< volume / volume of the convex hull [-]
    double roundness;      ///< see lib/clump/shape.c [-]
    double angularity;     ///< see lib/clump/shape.c [-]
} dem_shape;

#ifdef __cplusplus
}
#endif
#endif
