/// Rays through scenes of placed meshes and balls, and the triangles near a point, by Embree, in 32-bit floats.
///
/// A shape is built once, in a frame of its own in which it has about unit size: a point x of it becomes
/// (x - origin) * scale before it is rounded, so neither tiny grains nor far ones lose their form. Instances
/// place shapes in the scene, whose size should be of order one as well.
///
/// Who only asks what is near needs neither instances nor a commit.
///
/// Without Embree every dem_ray_create is DEM_UNAVAILABLE.
#ifndef DEM_RAY_RAY_H
#define DEM_RAY_RAY_H

#include "base/status.h"

typedef struct dem_ray_scene dem_ray_scene;

typedef struct dem_ray {
    float origin[3], near;  ///< hits nearer than `near` do not count
    float direction[3], far;
} dem_ray;

typedef struct dem_ray_hit {
    float distance;                ///< in lengths of the direction
    float u, v;                    ///< barycentric weights of the second and third vertex (meshes only)
    uint32_t instance, primitive;  ///< primitive: triangle or ball of the instance's shape
} dem_ray_hit;

/// Where an instance stands: x_scene = axes x_shape + position, axes by columns, scale included.
typedef struct dem_ray_pose {
    float axes[3][3], position[3];
} dem_ray_pose;

dem_status dem_ray_create(dem_ray_scene **scene, dem_error *error);
void dem_ray_destroy(dem_ray_scene *scene);

/// Shapes are numbered from 0 in the order they are added, whatever their kind; nothing given is kept.
dem_status dem_ray_add_mesh(dem_ray_scene *scene, const dem_vec3 *vertices, size_t vertex_count,
                            const uint32_t *triangles, size_t triangle_count, dem_vec3 origin, double scale,
                            dem_error *error);
dem_status dem_ray_add_balls(dem_ray_scene *scene, const dem_ball *balls, size_t count, dem_vec3 origin, double scale,
                             dem_error *error);

/// Instances are numbered from 0 in the order they are added.
dem_status dem_ray_add_instance(dem_ray_scene *scene, uint32_t shape, const dem_ray_pose *pose, dem_error *error);

/// Ends building; before it no ray may be cast, after it nothing added (asking what is near may start earlier).
dem_status dem_ray_commit(dem_ray_scene *scene, dem_error *error);

/// The nearest hit. Any number of threads may cast rays at once.
bool dem_ray_closest(const dem_ray_scene *scene, const dem_ray *ray, dem_ray_hit *hit);
bool dem_ray_occluded(const dem_ray_scene *scene, const dem_ray *ray);

/// Triangle numbers; grows as needed. Zero-initialise, free `items` at the end.
typedef struct dem_ray_list {
    uint32_t *items;
    size_t count, capacity;
} dem_ray_list;

/// Puts all triangles of a mesh shape that may lie within `radius` of a point into the list, in any order: none that
/// does in exact arithmetic is missing, some that do not may be there, and which depends on the machine. Point and
/// radius are in the frame the vertices were given in. Any number of threads may ask at once, each with a list of its
/// own. False: no memory.
bool dem_ray_near(const dem_ray_scene *scene, uint32_t shape, dem_vec3 point, double radius, dem_ray_list *list);

#endif
