/// Bodies, walls and figures as a world would show them, made by hand.
#ifndef DEM_TESTS_VIEWS_H
#define DEM_TESTS_VIEWS_H

#include "clumps.h"
#include "folder.h"

#include "base/random.h"
#include "math/quat.h"

enum { VIEW_BODIES = 7, VIEW_SHAPES = 3, VIEW_WALLS = 3 };

/// A view and its arrays; every number is another one.
typedef struct made_view {
    uint32_t shape[VIEW_BODIES], coordination[VIEW_BODIES];
    double scale[VIEW_BODIES], mass[VIEW_BODIES];
    dem_vec3 position[VIEW_BODIES], velocity[VIEW_BODIES], spin[VIEW_BODIES], force[VIEW_BODIES], moment[VIEW_BODIES];
    dem_quat orientation[VIEW_BODIES];
} made_view;

static inline dem_vec3 random_vector(dem_random *r)
{
    double x = random_normal(r), y = random_normal(r);
    return v3(x, y, random_normal(r));
}

static inline dem_body_view view_bodies(made_view *v, uint64_t seed)
{
    dem_random r = random_stream(seed, 1);
    for (int i = 0; i < VIEW_BODIES; i++) {
        v->shape[i] = (uint32_t)random_below(&r, VIEW_SHAPES);
        v->coordination[i] = (uint32_t)random_below(&r, 12);
        v->scale[i] = 0.5 + random_uniform(&r);
        v->mass[i] = random_uniform(&r);
        v->position[i] = random_vector(&r);
        v->velocity[i] = random_vector(&r);
        v->spin[i] = random_vector(&r);
        v->force[i] = random_vector(&r);
        v->moment[i] = random_vector(&r);
        dem_vec3 axis = random_vector(&r);
        v->orientation[i] = quat_unit((dem_quat){random_normal(&r), axis.x, axis.y, axis.z});
    }
    return (dem_body_view){VIEW_BODIES, v->shape, v->scale, v->mass,   v->position,    v->orientation,
                           v->velocity, v->spin,  v->force, v->moment, v->coordination, NULL};
}

/// A sphere, two spheres, and a grain with a surface (sample_clump). Destroy each.
static inline void view_clumps(dem_clump *clumps[VIEW_SHAPES])
{
    static const dem_ball one = {{0, 0, 0}, 0.5}, two[] = {{{0, 0, -0.3}, 0.5}, {{0, 0, 0.3}, 0.5}};
    dem_clump_def def = sample_clump();
    clumps[2] = made_clump(&def);
    def.surface = (dem_mesh){0};
    def.balls = &one;
    def.ball_count = 1;
    clumps[0] = made_clump(&def);
    def.balls = two;
    def.ball_count = 2;
    clumps[1] = made_clump(&def);
}

static const dem_shape_def VIEW_SHAPE_DEFS[VIEW_SHAPES] = {
    {.name = "ball"}, {.name = "two balls"}, {.name = "two/balls"}};

/// A floor, a cylinder about z, and a plane that moves up.
static const dem_wall_def VIEW_WALL_DEFS[VIEW_WALLS] = {
    {.name = "floor", .kind = DEM_WALL_PLANE, .point = {0, 0, -2}, .normal = {0, 0, 1}},
    {.name = "drum", .kind = DEM_WALL_CYLINDER, .normal = {0, 0, 1}, .radius = 3},
    {.name = "lid, moving", .kind = DEM_WALL_PLANE, .point = {0, 0, 2}, .normal = {0, 0, -1}, .velocity = {0, 0, 1}}};

/// Walls at a time.
static inline void view_walls(dem_wall_view walls[VIEW_WALLS], double time)
{
    for (int i = 0; i < VIEW_WALLS; i++)
        walls[i] = (dem_wall_view){.position = v3_scale(VIEW_WALL_DEFS[i].velocity, time),
                                   .orientation = {1, 0, 0, 0},
                                   .force = {i + time, 0.1, -i},
                                   .moment = {0, time, i / 3.0},
                                   .contacts = (size_t)i};
}

static dem_clump *clumps[VIEW_SHAPES];

/// Give them to cmocka_run_group_tests: the clumps, and a folder.
static inline int begin_views(void **state)
{
    view_clumps(clumps);
    return make_folder(state);
}

static inline int end_views(void **state)
{
    for (int i = 0; i < VIEW_SHAPES; i++)
        dem_clump_destroy(clumps[i]);
    return remove_folder(state);
}

#endif
