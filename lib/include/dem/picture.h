/// Pictures of meshes and clumps, rendered with Embree on the processor: no display, no GPU.
#ifndef DEM_PICTURE_H
#define DEM_PICTURE_H

#include "dem/base.h"
#include "dem/clump.h"
#include "dem/mesh.h"
#include "dem/scene.h"
#include "dem/world.h"

#ifdef __cplusplus
extern "C" {
#endif

/// The mesh and its clump side by side (PNG), same view and scale, soft shading, white ground.
/// `path` "-" is standard output. Errors: DEM_UNAVAILABLE without Embree, DEM_CANNOT_WRITE.
DEM_API dem_status dem_picture_clump(const dem_ctx *ctx, const dem_mesh *mesh, const dem_ball *balls,
                                     size_t count, const char *path, dem_error *error);

/// What the colour of a body shows.
typedef enum dem_picture_colour {
    DEM_PICTURE_NUMBER,  ///< nothing: a random one that stays with the body
    DEM_PICTURE_SHAPE,
    DEM_PICTURE_SIZE,  ///< diameter of the sphere of equal volume
    DEM_PICTURE_SPEED,
    DEM_PICTURE_SPIN,
    DEM_PICTURE_COORDINATION,
    DEM_PICTURE_HEIGHT,
} dem_picture_colour;

/// A picture of many bodies; see dem_picture_defaults. Borrowed pointers.
typedef struct dem_picture_options {
    int width, height;  ///< [pixels]
    dem_picture_colour colour;
    double low, high;            ///< values with the colours of the ends; NAN: those of the bodies
    bool spheres;                ///< draw the spheres even where the clump keeps the surface of its grain
    dem_vec3 up;                 ///< against gravity
    double azimuth_deg;          ///< where it is seen from, about `up`, from x (where that is not up)
    double elevation_deg;        ///< and above the ground
    const dem_wall_def *walls;   ///< drawn as glass; a level floor is the ground
    const dem_wall_view *poses;  ///< [wall_count]; NULL: as at time 0
    size_t wall_count;
    dem_domain_def domain;  ///< walls without an end are cut there, or about the bodies
} dem_picture_options;

/// 1200 x 1600, z up, seen from the front and a little from above, no walls.
DEM_API dem_picture_options dem_picture_defaults(void);

/// Bodies as the surfaces of their grains, or as their spheres (PNG), `shapes` [shape_count]. `path` "-" is standard
/// output. Errors: DEM_UNAVAILABLE without Embree, DEM_INTERRUPTED, DEM_CANNOT_WRITE, DEM_USAGE.
DEM_API dem_status dem_picture_bodies(const dem_ctx *ctx, const dem_body_view *bodies, const dem_clump *const *shapes,
                                      size_t shape_count, const dem_picture_options *options, const char *path,
                                      dem_error *error);

#ifdef __cplusplus
}
#endif
#endif
