/// Grains against a wall and against their twins, placed by hand or in impact: what soft contacts are judged by.
#ifndef DEM_TESTS_SOFT_CASES_H
#define DEM_TESTS_SOFT_CASES_H

#include "sim/bodies.h"
#include "sim/lists.h"
#include "worlds.h"

static inline model *soft_model(double tau)
{
    model *m = model_new();
    m->scene.multiple = DEM_MULTIPLE_SOFT;
    m->scene.soft.tau = tau;
    m->scene.domain.leaving = DEM_LEAVING_IGNORE;
    return m;
}

/// One of small grains that lose energy at every hit, and keep a ledger of it.
static inline model *soft_lossy_model(void)
{
    model *m = soft_model(4e-5);
    m->scene.output.energy = true;
    m->laws[0].damping = DEM_DAMPING_RESTITUTION;
    m->laws[0].restitution = 0.6;
    m->laws[0].friction = DEM_FRICTION_LINEAR;
    m->laws[0].friction_coefficient = 0.4;
    return m;
}

/// The hash after so many steps; `kernels`: of an instruction set (NULL: the best), 0 where there is none; `look`
/// judges the world at the end.
static inline uint64_t soft_hash(const model *m, int threads, const char *kernels, uint64_t steps,
                                 void (*look)(dem_world *w))
{
    const dem_soft_kernels *soft = kernels ? dem_soft_kernels_choose(kernels) : NULL;
    if (kernels && !soft)
        return 0;
    dem_world *w = model_world(m, threads);
    if (kernels) {
        w->kernels = dem_kernels_choose(kernels);
        w->soft.kernels = soft;
    }
    run_steps(w, steps);
    look(w);
    uint64_t hash = dem_world_hash(w);
    dem_world_destroy(w);
    return hash;
}

static inline void check_soft_bits(const model *m, uint64_t steps, void (*look)(dem_world *w))
{
    uint64_t one = soft_hash(m, 1, NULL, steps, look);
    check(soft_hash(m, 2, NULL, steps, look) == one);
    check(soft_hash(m, 8, NULL, steps, look) == one);
    static const char *const levels[] = {"plain", "v3", "v4"};
    for (int i = 0; i < 3; i++) {
        uint64_t other = soft_hash(m, 2, levels[i], steps, look);
        check(other == one || other == 0);
    }
}

/// A world of the model after some steps, which a copy made halfway has followed bit for bit.
static inline dem_world *check_soft_resumed(const model *m)
{
    dem_world *straight = model_world(m, 1);
    run_steps(straight, 700);
    dem_world *again = model_resumed(m, straight, 1);
    run_steps(straight, 700);
    run_steps(again, 700);
    check(dem_world_hash(straight) == dem_world_hash(again));
    check(measured(straight)->energy.error == measured(again)->energy.error);
    dem_world_destroy(again);
    return straight;
}

/// Adds a clump of a diameter of 1 m, scaled from what it is given in.
static inline uint32_t model_of_clump(model *m, const dem_clump *clump, double *scale)
{
    dem_clump_def def = dem_clump_view(clump);
    uint32_t i = (uint32_t)m->scene.shape_count++;
    m->shapes[i] = (dem_shape_def){.name = "grain", .clump = clump};
    *scale = 1 / cbrt(6 * def.volume / DEM_PI);
    return i;
}

/// Puts a body somewhere by hand, at rest; call soft_placed behind the last.
static inline void soft_place(dem_world *w, size_t body, dem_vec3 position, dem_quat orientation)
{
    size_t row = row_of(w, body);
    double *pose = body_pose(&w->bodies, row);
    dem_quat q = template_run_orientation(&w->templates.items[w->bodies.shape[row]], quat_unit(orientation));
    memcpy(pose, (double[]){position.x, position.y, position.z, q.w, q.x, q.y, q.z}, 7 * sizeof *pose);
    w->bodies.limit[row] = -1;
    w->bodies.search_limit[row] = -INFINITY;
    if (w->bodies.wall_limit)
        w->bodies.wall_limit[row] = -1;
}

/// Lets a body move without spin, from when it stands where it was put.
static inline void soft_throw(dem_world *w, size_t body, dem_vec3 velocity)
{
    size_t row = row_of(w, body);
    double *motion = body_pose(&w->bodies, row) + 8, *momentum = w->bodies.momentum + DEM_ROW * row;
    double mass = w->bodies.inertia[DEM_ROW * row + 5];
    memcpy(motion, (double[]){velocity.x, velocity.y, velocity.z, 0, 0, 0}, 6 * sizeof *motion);
    memcpy(momentum, (double[]){mass * velocity.x, mass * velocity.y, mass * velocity.z, 0, 0, 0},
           6 * sizeof *momentum);
}

static inline void soft_placed(dem_world *w)
{
    dem_error error;
    w->asked_count = w->bodies.count;
    for (size_t i = 0; i < w->asked_count; i++)
        w->asked[i] = (uint32_t)i;
    for (size_t i = 0; i < w->pairs.count; i++)
        w->pairs.items[i].normal[0] = 2;  // forget where they were nearest
    for (size_t i = 0; i < 2 * w->pairs.count; i++)
        w->pairs.adjacency_limit[i] = -1;
    check_ok(dem_lists_update(w, &error), error);
    measured(w);
}

/// How far the spheres of a body reach in the direction [m].
static inline double soft_support(const dem_world *w, size_t body, dem_vec3 n)
{
    size_t row = row_of(w, body);
    const dem_template *t = &w->templates.items[w->bodies.shape[row]];
    dem_vec3 own = quat_unrotate(body_orientation(&w->bodies, row), n);
    double most = -INFINITY;
    for (uint32_t i = t->first; i < t->first + t->count; i++) {
        const double *s = w->templates.spheres[i];
        most = fmax(most, v3_dot(own, v3(s[0], s[1], s[2])) + s[3]);
    }
    return most * body_scale(&w->bodies, row);
}

/// The spheres of a body in space; the caller frees them.
static inline dem_ball *soft_balls(const dem_world *w, size_t body, size_t *count)
{
    size_t row = row_of(w, body);
    const dem_template *t = &w->templates.items[w->bodies.shape[row]];
    double scale = body_scale(&w->bodies, row);
    dem_ball *balls = calloc(t->count, sizeof *balls);
    check(balls);
    *count = t->count;
    for (uint32_t i = 0; i < t->count; i++) {
        const double *s = w->templates.spheres[t->first + i];
        dem_vec3 arm = quat_rotate(body_orientation(&w->bodies, row), v3_scale(v3(s[0], s[1], s[2]), scale));
        balls[i] = (dem_ball){v3_add(body_position(&w->bodies, row), arm), s[3] * scale};
    }
    return balls;
}

/// The deepest pair of spheres of bodies 0 and 1: its overlap and normal.
static inline double soft_deepest(const dem_world *w, dem_vec3 *normal)
{
    double most = -INFINITY;
    size_t count[2];
    dem_ball *a = soft_balls(w, 0, &count[0]), *b = soft_balls(w, 1, &count[1]);
    *normal = v3(1, 0, 0);
    for (size_t i = 0; i < count[0]; i++)
        for (size_t j = 0; j < count[1]; j++) {
            double overlap = a[i].radius + b[j].radius - v3_distance(a[i].centre, b[j].centre);
            if (overlap > most) {
                most = overlap;
                *normal = v3_unit(v3_sub(b[j].centre, a[i].centre));
            }
        }
    free(a);
    free(b);
    return most;
}

/// The twin's place along the x axis from body 0 at which the deepest overlap is as given.
static inline double soft_twin_place(dem_world *w, dem_quat q0, dem_quat q1, double overlap, dem_vec3 *normal)
{
    double low = 0.1, high = 4;
    *normal = v3(1, 0, 0);
    for (int i = 0; i < 40; i++) {
        double x = 0.5 * (low + high);
        soft_place(w, 0, v3(0, 0, 0), q0);
        soft_place(w, 1, v3(x, 0, 0), q1);
        if (soft_deepest(w, normal) > overlap)
            low = x;
        else
            high = x;
    }
    return low;
}

/// What a path takes: work around it and the largest stored energy on it [J]; the largest change of the force in a step
/// of it and the largest force [N].
typedef struct path_figures {
    double work, stored, jump, force;
} path_figures;

/// Leads body 1, turned by q1, around a closed path of places and attitudes beside its twin that keeps in touch; the
/// work by trapezoids.
static inline path_figures soft_closed_path(dem_world *w, dem_quat q0, dem_quat q1, double overlap, int steps)
{
    dem_quat last_q = q1;
    dem_vec3 normal, last_x = v3(0, 0, 0), last_f = last_x, last_t = last_x;
    double x = soft_twin_place(w, q0, q1, overlap, &normal);
    dem_vec3 across = v3_normal_to(normal);
    path_figures p = {0, 0, 0, 0};
    for (int i = 0; i <= steps; i++) {
        double a = 2 * DEM_PI * i / steps;
        dem_vec3 at = v3_along(v3(x, 0, 0), 0.4 * overlap * (1 - cos(a)), normal);
        at = v3_along(at, 2 * overlap * sin(a), across);
        dem_quat turn = quat_multiply(quat_about(v3(0.02 * sin(a), 0.015 * (1 - cos(a)), -0.02 * sin(2 * a))), q1);
        soft_place(w, 1, at, turn);
        soft_placed(w);
        dem_vec3 f = dem_world_bodies(w).force[1], t = dem_world_bodies(w).moment[1];
        if (i > 0) {
            dem_quat d = quat_multiply(turn, quat_conjugate(last_q));
            dem_vec3 by = v3_scale(v3(d.x, d.y, d.z), d.w < 0 ? -2 : 2);
            p.work += 0.5 * (v3_dot(v3_add(f, last_f), v3_sub(at, last_x)) + v3_dot(v3_add(t, last_t), by));
            p.jump = largest(p.jump, v3_distance(f, last_f));
        }
        p.stored = largest(p.stored, measured(w)->energy.elastic);
        p.force = largest(p.force, v3_norm(f));
        last_x = at;
        last_q = turn;
        last_f = f;
        last_t = t;
    }
    return p;
}

#endif
