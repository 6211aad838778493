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
    DEM_PICTURE_VALUES,  ///< `values` of the options
    DEM_PICTURE_WEAR,    ///< depth to which walls are worn, as `poses` has it; bodies are grey
} dem_picture_colour;

/// Colours of a range of values, in steps that look equal.
typedef enum dem_picture_map {
    DEM_PICTURE_MAP_AUTO,       ///< diverging where the range is as far below 0 as above, else ramp
    DEM_PICTURE_MAP_RAMP,       ///< violet, blue, green, yellow: ever lighter
    DEM_PICTURE_MAP_DIVERGING,  ///< blue, white, red
    DEM_PICTURE_MAP_WARM,       ///< purple, red, orange, cream: ever lighter
    DEM_PICTURE_MAP_GREY,
} dem_picture_map;

/// A picture of many bodies; see dem_picture_defaults. Borrowed pointers.
typedef struct dem_picture_options {
    int width, height;  ///< [pixels]
    dem_picture_colour colour;
    const double *values;  ///< of the bodies, for DEM_PICTURE_VALUES; grey where NAN
    const char *title;     ///< what these are; NULL: nothing is said
    const char *unit;      ///< their SI unit, as in "m/s"; NULL: none
    bool whole;            ///< they are whole numbers
    dem_picture_map map;
    double low, high;             ///< values with the colours of the ends; NAN: those of the bodies
    const unsigned char *hidden;  ///< of the bodies: not 0 where one is left out; NULL: none
    bool spheres;                 ///< draw the spheres even where the clump keeps the surface of its grain
    dem_vec3 up;                  ///< against gravity
    double azimuth_deg;           ///< where it is seen from, about `up`, from x (where that is not up)
    double elevation_deg;         ///< and above the ground
    bool parallel;                ///< rays of sight: no perspective
    double zoom;                  ///< of what fits into the picture [-]
    dem_vec3 look_at;             ///< what is in its middle [m]; NAN: the middle of everything
    int samples;                  ///< rays of sight through a pixel where edges are
    uint8_t background[3];        ///< sky and ground, sRGB
    const dem_wall_def *walls;    ///< drawn as glass; a level floor is the ground
    const dem_wall_view *poses;   ///< [wall_count]; NULL: as at time 0
    size_t wall_count;
    dem_domain_def domain;          ///< walls without an end are cut there, or about the bodies
    bool labels;                    ///< write a colour bar, a scale bar and the time beside what is drawn
    double label_size;              ///< height of their capital letters [pixels]; 0: as the picture needs
    double time;                    ///< [s]; NAN: none is written
    const char *const *shape_names; ///< [shape_count], for the labels of DEM_PICTURE_SHAPE; NULL: their numbers
} dem_picture_options;

/// 1200 x 1600, z up, seen from the front and a little from above, in perspective, white, no walls, no labels.
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
