/// A scene made ready for rays: what a ray of sight meets, and the light that falls there.
#ifndef DEM_OUT_STAGE_H
#define DEM_OUT_STAGE_H

#include "out/render.h"
#include "ray/ray.h"

enum {
    STAGE_SUBSETS = 16,  // neighbouring pixels share a set of light rays, each takes another part of it
    STAGE_SKY_RAYS = 6,  // of one part
    STAGE_SUN_RAYS = 3,
};
/// The `body` of a spot on the ground.
#define STAGE_GROUND UINT32_MAX

typedef struct stage_lights {
    dem_vec3 sky[STAGE_SUBSETS * STAGE_SKY_RAYS];  // directions, cosine-weighted about z
    dem_vec3 sun[STAGE_SUBSETS * STAGE_SUN_RAYS];  // points of a unit disk, z = 0
} stage_lights;

/// A shape's own frame, in which it has about unit size: the middle of its box, half its diagonal.
typedef struct stage_shape {
    dem_vec3 origin;
    double size;
    float *normals;          ///< of the corners; NULL: flat, or balls
    unsigned char *creases;  ///< of what is clear
    uint32_t solid, clear;   ///< number of the shape among the rays' solid ones and clear ones
} stage_shape;

/// Lengths are in radii of the view, the origin is its centre.
typedef struct dem_stage {
    const dem_render_scene *scene;
    const dem_view *view;
    dem_ray_scene *rays;      ///< of the solid bodies
    dem_ray_scene *panes;     ///< of the clear ones; NULL: there are none
    uint32_t *solid, *clear;  ///< the bodies of their instances
    stage_shape *shapes;
    double ground;  ///< height
    dem_vec3 up, sun, sun_u, sun_v;
    stage_lights lights;
} dem_stage;

/// A point of a surface.
typedef struct dem_spot {
    uint32_t body, primitive;
    dem_vec3 at;
    dem_vec3 normal, face;  ///< smoothed; of the triangle itself
} dem_spot;

/// Points that fill the unit square evenly, however many are taken (Roberts 2018, from the plastic number).
void dem_even_point(size_t index, double *u, double *v);

dem_status dem_stage_init(dem_stage *stage, const dem_render_scene *scene, const dem_view *view, dem_error *error);
void dem_stage_release(dem_stage *stage);

/// What is seen at a point of the picture [pixels]; false: nothing but sky.
bool dem_stage_look(const dem_stage *stage, double x, double y, dem_spot *spot);

/// What clear bodies do to the light that comes from behind them.
typedef struct dem_veil {
    float through;     ///< part of it that comes through
    dem_colour light;  ///< their own
    uint32_t key;      ///< differs where something else is seen
} dem_veil;

/// The clear bodies before a point of the picture; `spot`: what is behind them, NULL: sky.
dem_veil dem_stage_veil(const dem_stage *stage, double x, double y, const dem_spot *spot);

/// Light on a spot of a body, from one part of the light rays, 0..STAGE_SUBSETS - 1.
dem_colour dem_stage_light(const dem_stage *stage, const dem_spot *spot, size_t subset);

/// How white the ground is at a point of the picture: 1 wherever nothing stands in the light.
float dem_stage_ground(const dem_stage *stage, int x, int y);

#endif
