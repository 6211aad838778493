/// Small scenes made in code, for tests and studies. Begin a `model`, say what is in it, make its world.
#ifndef DEM_STUDY_MODEL_H
#define DEM_STUDY_MODEL_H

#include <stdlib.h>
#include <string.h>

#include "base/random.h"
#include "base/status.h"
#include "dem/scene.h"
#include "math/quat.h"

enum {
    MODEL_SHAPES = 8,
    MODEL_BODIES = 6000,
    MODEL_WALLS = 12,
    MODEL_MATERIALS = 3,
    MODEL_LAWS = 6,
    MODEL_CLOUD = 2000
};

typedef struct model {
    dem_scene scene;
    dem_material materials[MODEL_MATERIALS];
    dem_pair_law laws[MODEL_LAWS];
    dem_shape_def shapes[MODEL_SHAPES];
    dem_clump *clumps[MODEL_SHAPES];
    dem_body_def bodies[MODEL_BODIES];
    dem_wall_def walls[MODEL_WALLS];
    dem_status status;  ///< of the clumps
    dem_error error;
} model;

/// One material "stone" (2500 kg/m^3, 1 GPa, 0.25) and one law: linear, 1e4 N/m, nothing else. Step 1e-5 s.
/// The model is zero, or was ended.
static inline void model_begin(model *m)
{
    m->scene = dem_scene_defaults();
    m->materials[0] = (dem_material){"stone", 2500, 1e9, 0.25};
    m->laws[0] = dem_pair_law_defaults();
    m->laws[0].stiffness = 1e4;
    m->scene.time.step = 1e-5;
    m->scene.materials = m->materials;
    m->scene.material_count = 1;
    m->scene.laws = m->laws;
    m->scene.law_count = 1;
    m->scene.shapes = m->shapes;
    m->scene.bodies.bodies = m->bodies;
    m->scene.walls = m->walls;
}

/// Releases what it holds; it is zero then.
static inline void model_end(model *m)
{
    for (int i = 0; i < MODEL_SHAPES; i++)
        dem_clump_destroy(m->clumps[i]);
    for (int i = 0; i < MODEL_WALLS; i++)
        dem_mesh_free(&m->walls[i].mesh);
    memset(m, 0, sizeof *m);
}

static inline uint32_t model_sphere(model *m, double radius)
{
    uint32_t i = (uint32_t)m->scene.shape_count++;
    DEM_ASSERT(i < MODEL_SHAPES);
    m->shapes[i] = (dem_shape_def){.name = "sphere", .sphere_radius = radius};
    return i;
}

/// The mass of a ball of "stone".
static inline double model_ball_mass(double radius)
{
    return 2500 * 4 * DEM_PI / 3 * radius * radius * radius;
}

/// A clump as given: balls in the principal frame, inertia ascending.
static inline uint32_t model_clump(model *m, const dem_ball *balls, size_t count, double mass, const double inertia[3])
{
    uint32_t i = (uint32_t)m->scene.shape_count++;
    DEM_ASSERT(i < MODEL_SHAPES);
    dem_clump_def def = {.name = "clump",
                         .density = 2500,
                         .mass = mass,
                         .volume = mass / 2500,
                         .inertia = {inertia[0], inertia[1], inertia[2]},
                         .balls = balls,
                         .ball_count = count,
                         .orientation = {1, 0, 0, 0},
                         .parameters = "{}",
                         .union_volume = NAN,
                         .union_centre = {NAN, NAN, NAN},
                         .union_inertia = {NAN, NAN, NAN},
                         .seconds = NAN};
    if (m->status == DEM_OK)
        m->status = dem_clump_create(&def, &m->clumps[i], &m->error);
    m->shapes[i] = (dem_shape_def){.name = "clump", .clump = m->clumps[i]};
    return i;
}

/// Two balls of radius r, centres `apart`, with mass and inertia of two separate spheres; the axis is x.
static inline uint32_t model_dumbbell(model *m, double r, double apart)
{
    double ball = 2500 * 4 * DEM_PI / 3 * r * r * r, axial = 2 * 0.4 * ball * r * r;
    double across = axial + 2 * ball * apart * apart / 4;
    return model_clump(m, (dem_ball[]){{{-apart / 2, 0, 0}, r}, {{apart / 2, 0, 0}, r}}, 2, 2 * ball,
                       (double[]){axial, across, across});
}

/// `count` balls on an ellipsoid-like cloud of about the size given, with three different moments.
static inline uint32_t model_cloud(model *m, size_t count, double size, uint64_t seed)
{
    dem_ball balls[MODEL_CLOUD];
    DEM_ASSERT(count <= MODEL_CLOUD);
    dem_random r = random_stream(seed, 1);
    for (size_t i = 0; i < count; i++) {
        double z = 2 * random_uniform(&r) - 1, a = 2 * DEM_PI * random_uniform(&r), s = sqrt(1 - z * z);
        double radius = size * (0.15 + 0.1 * random_uniform(&r));
        balls[i] = (dem_ball){v3(0.4 * size * s * cos(a), 0.28 * size * s * sin(a), 0.22 * size * z), radius};
    }
    double mass = 2500 * 0.25 * size * size * size, unit = mass * size * size;
    uint32_t shape = model_clump(m, balls, count, mass, (double[]){0.03 * unit, 0.045 * unit, 0.055 * unit});
    return shape;
}

/// An ellipsoid of diameters 1.26, 1, .79 m, with its own mass and moments, lined by `count` balls that touch its
/// surface from inside.
static inline uint32_t model_ellipsoid(model *m, size_t count)
{
    static const dem_vec3 axes = {0.63, 0.5, 0.397};
    dem_ball balls[MODEL_CLOUD];
    DEM_ASSERT(count <= MODEL_CLOUD);
    for (size_t i = 0; i < count; i++) {
        double z = 1 - (2 * (double)i + 1) / (double)count, s = sqrt(1 - z * z), a = 2.39996322972865332 * (double)i;
        dem_vec3 u = v3(s * cos(a), s * sin(a), z), p = v3(axes.x * u.x, axes.y * u.y, axes.z * u.z);
        dem_vec3 out = v3_unit(v3(u.x / axes.x, u.y / axes.y, u.z / axes.z));
        balls[i] = (dem_ball){v3_along(p, -0.24, out), 0.24};
    }
    double mass = 2500 * 4 * DEM_PI / 3 * axes.x * axes.y * axes.z, xx = axes.x * axes.x, yy = axes.y * axes.y,
           zz = axes.z * axes.z;
    return model_clump(m, balls, count, mass,
                       (double[]){mass * (yy + zz) / 5, mass * (xx + zz) / 5, mass * (xx + yy) / 5});
}

static inline dem_body_def *model_body(model *m, uint32_t shape, dem_vec3 position)
{
    size_t i = m->scene.bodies.count++;
    DEM_ASSERT(i < MODEL_BODIES);
    m->bodies[i] = (dem_body_def){.shape = shape, .scale = 1, .position = position, .orientation = {1, 0, 0, 0}};
    return &m->bodies[i];
}

static inline dem_wall_def *model_plane(model *m, dem_vec3 point, dem_vec3 normal)
{
    size_t i = m->scene.wall_count++;
    DEM_ASSERT(i < MODEL_WALLS);
    m->walls[i] = (dem_wall_def){.name = "plane", .kind = DEM_WALL_PLANE, .point = point, .normal = normal};
    return &m->walls[i];
}

/// Six planes.
static inline void model_box(model *m, dem_vec3 low, dem_vec3 high)
{
    for (int k = 0; k < 3; k++) {
        dem_vec3 n = v3(k == 0, k == 1, k == 2);
        model_plane(m, low, n);
        model_plane(m, high, v3_scale(n, -1));
    }
}

static inline dem_quat random_quat(dem_random *r)
{
    double a = random_normal(r), b = random_normal(r), c = random_normal(r);
    return quat_unit((dem_quat){a, b, c, random_normal(r)});
}

static inline dem_vec3 random_in(dem_random *r, dem_vec3 low, dem_vec3 high)
{
    double x = random_uniform(r), y = random_uniform(r), z = random_uniform(r);
    return v3(low.x + x * (high.x - low.x), low.y + y * (high.y - low.y), low.z + z * (high.z - low.z));
}

/// A jittered lattice of `n` bodies over the shapes in turn, cells of edge `cell`, random velocities and spins.
static inline void model_lattice(model *m, size_t n, double cell, double speed, uint64_t seed)
{
    dem_random r = random_stream(seed, 2);
    int side = (int)ceil(cbrt((double)n) - 1e-9);
    for (size_t i = 0; i < n; i++) {
        int x = (int)i % side, y = (int)i / side % side, z = (int)i / side / side;
        uint32_t shape = (uint32_t)(i % m->scene.shape_count);
        dem_vec3 jitter = random_in(&r, v3(-0.1, -0.1, -0.1), v3(0.1, 0.1, 0.1));
        dem_body_def *b = model_body(m, shape, v3_scale(v3_add(v3(x + 0.5, y + 0.5, z + 0.5), jitter), cell));
        b->orientation = random_quat(&r);
        b->velocity = v3_scale(random_in(&r, v3(-1, -1, -1), v3(1, 1, 1)), speed);
        b->spin = v3_scale(random_in(&r, v3(-1, -1, -1), v3(1, 1, 1)), speed / cell);
    }
}

/// The angle between two orientations [rad].
static inline double angle_between(dem_quat a, dem_quat b)
{
    dem_quat d = quat_multiply(a, quat_conjugate(b));
    return 2 * atan2(sqrt(d.x * d.x + d.y * d.y + d.z * d.z), fabs(d.w));
}

/// The turn by |v| [rad] about v.
static inline dem_quat quat_about(dem_vec3 v)
{
    double angle = v3_norm(v), s = angle > 0 ? sin(angle / 2) / angle : 0.5;
    return (dem_quat){cos(angle / 2), s * v.x, s * v.y, s * v.z};
}

#endif
