/// Renders placed meshes and clumps on a white ground, in soft light, by rays on the processor.
#ifndef DEM_OUT_RENDER_H
#define DEM_OUT_RENDER_H

#include "dem/clump.h"
#include "dem/mesh.h"
#include "math/vec.h"
#include "out/colour.h"
#include "out/png.h"

/// A mesh or balls; many bodies may share one shape. Everything is borrowed.
typedef struct dem_render_shape {
    const dem_mesh *mesh;  ///< NULL: balls
    const dem_ball *balls;
    size_t ball_count;
    const dem_colour *part_colours;  ///< one each ball or triangle; NULL: all in the body's colour
} dem_render_shape;

typedef struct dem_render_body {
    uint32_t shape;
    dem_vec3 position;  ///< [m]
    dem_quat orientation;
    double scale;  ///< [-]
    dem_colour colour;
    float clear;  ///< part of the light that passes straight through it; 0: none. A clear body is a mesh; it casts no
                  ///< shadow
} dem_render_body;

typedef struct dem_render_scene {
    const dem_render_shape *shapes;
    size_t shape_count;
    const dem_render_body *bodies;
    size_t body_count;
    const dem_colour *background;  ///< of sky and ground; NULL: white
    int samples;                   ///< of a pixel at an edge; 0: as many as look smooth
} dem_render_scene;

/// A camera that finds its own place: everything is in the picture, `margin` of its smaller side left free.
typedef struct dem_camera {
    dem_vec3 forward;  ///< direction of sight
    dem_vec3 up;       ///< normal of the ground, upwards in the picture; not parallel to `forward`
    double field_deg;  ///< angle of view across the smaller side of the picture; 0: parallel rays
    double margin;     ///< [-]
} dem_camera;

/// One that looks from an azimuth about `up`, from x (where that is not up), and an elevation above the ground.
dem_camera dem_camera_around(dem_vec3 up, double azimuth_deg, double elevation_deg, double field_deg, double margin);

/// A camera in its place. Pixel (0, 0) is the upper left one, its centre at (0.5, 0.5).
typedef struct dem_view {
    dem_vec3 centre;              ///< in the middle of the picture [m]
    dem_vec3 right, up, forward;  ///< orthonormal
    dem_vec3 ground_up;           ///< normal of the ground
    double ground;                ///< height of the ground: its points x have x . ground_up = ground [m]
    double pixel;                 ///< breadth of a pixel at the centre [m]
    double distance;              ///< of the eye from the centre [m]; 0: parallel rays
    double radius;                ///< of a ball about the centre that holds everything [m]
    int width, height;
} dem_view;

dem_view dem_view_fit(const dem_render_scene *scene, const dem_camera *camera, int width, int height);

/// The same for several scenes that shall be seen from one place: begin, add each, end. All extents are of sums of
/// coordinates, so that nothing of a scene needs to be kept.
typedef struct dem_fit {
    dem_view view;
    dem_camera camera;
    bool begun;
    dem_vec3 origin;                 // of the coordinates: near the first point
    double low[4], high[4];          // along right, up, forward and the normal of the ground
    double slope[2], need[2][2];     // of the sides of the picture: right, up
} dem_fit;
void dem_fit_begin(dem_fit *fit, const dem_camera *camera, int width, int height);
void dem_fit_add(dem_fit *fit, const dem_render_scene *scene);
dem_view dem_fit_end(const dem_fit *fit);

/// Where a point is in the picture [pixels].
void dem_view_project(const dem_view *view, dem_vec3 point, double *x, double *y);

/// Draws the scene. Same picture for any number of threads. Errors: DEM_UNAVAILABLE without Embree,
/// DEM_INTERRUPTED, DEM_NO_MEMORY.
dem_status dem_render(const dem_ctx *ctx, const dem_render_scene *scene, const dem_view *view, dem_image *image,
                      dem_error *error);

#endif
