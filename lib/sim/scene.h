/// Scenes in memory: reading from a text, and what a scene that was read owns.
#ifndef DEM_SIM_SCENE_H
#define DEM_SIM_SCENE_H

#include "base/json.h"
#include "base/memory.h"
#include "dem/scene.h"
#include "dem/world.h"
#include "math/vec.h"

/// As dem_scene_read, from a text (comments and trailing commas allowed). `name` is for messages; paths in it are
/// relative to `folder`; NULL: files are refused, so that nothing but the text is read.
dem_status dem_scene_read_text(const dem_ctx *ctx, const char *text, size_t size, const char *name, const char *folder,
                               const char *const *overrides, dem_scene *scene, dem_error *error);

/// The volume of a sphere or disc that is no clump [m^3].
static inline double dem_ball_volume(const dem_shape_def *shape)
{
    double r = shape->sphere_radius;
    return shape->disc_thickness > 0 ? DEM_PI * r * r * shape->disc_thickness : 4.0 / 3 * DEM_PI * r * r * r;
}

/// The equivalent diameter of a shape: of the sphere of the volume its mass stands for [m].
double dem_shape_diameter(const dem_shape_def *shape);

/// True where a body of one material may meet a body or wall of the other.
bool dem_scene_can_meet(const dem_scene *scene, uint32_t a, uint32_t b);

/// Whether the elastic part of the normal force is Hertz', or becomes so without adhesion.
static inline bool dem_law_of_hertz(const dem_pair_law *law)
{
    return law->normal != DEM_NORMAL_LINEAR && law->normal != DEM_NORMAL_PLUGIN;
}

/// The safety of an automatic step that is not given: 0.8, 0.5 where a Hertz law is in force [-].
double dem_scene_safety(const dem_scene *scene);

typedef enum dem_scene_entry_kind { DEM_ENTRY_BODY, DEM_ENTRY_FILE, DEM_ENTRY_FILL } dem_scene_entry_kind;

/// One entry of "bodies" as it was given.
typedef struct dem_scene_entry {
    dem_scene_entry_kind kind;
    const char *file;     ///< resolved path
    size_t first, count;  ///< of the scene's bodies, or of its fills
    uint32_t hold;        ///< of the bodies of a file
    const char *group;    ///< of the bodies of a file
} dem_scene_entry;

/// Lets go of the bodies that came from files, which only placing them needs; the scene names the files as before.
void dem_scene_forget_files(dem_scene *scene);

/// As dem_world_create; the bodies of files are forgotten as soon as they are placed.
dem_status dem_world_create_spending(const dem_ctx *ctx, dem_scene *scene, dem_world **world, dem_error *error);

/// What a wall's definition does not tell of how it was given.
typedef struct dem_wall_source {
    const char *unit;  ///< of the mesh file; NULL: not a mesh
    dem_vec3 axis;     ///< unit; spin = rate axis
    double rate;       ///< [rad/s]
    // names of walls that a servo refers to, until all walls are known; NULL: none
    const char *partner, *extent[2][2];
} dem_wall_source;

/// Holds everything a scene that was read points to.
struct dem_scene_owner {
    dem_arena arena;
    dem_json *root;  ///< names and texts are this tree's
    dem_clump **clumps;
    size_t clump_count, clump_capacity;
    dem_body_def *bodies;
    size_t body_count, body_capacity;
    dem_fill_def *fills;
    size_t fill_count, fill_capacity;
    dem_scene_entry *entries;
    size_t entry_count, entry_capacity;
    dem_wall_def *walls;  ///< with their meshes
    size_t wall_count, wall_capacity;
    dem_wall_source *wall_sources;  ///< of each wall
    size_t source_capacity;
};

#endif
