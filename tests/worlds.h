/// Worlds of small scenes made in code (study/model.h), and what tests look at in them.
#ifndef DEM_TESTS_WORLDS_H
#define DEM_TESTS_WORLDS_H

#include "check.h"

#include "sim/state.h"
#include "study/model.h"

static inline model *model_new(void)
{
    model *m = calloc(1, sizeof *m);
    check(m);
    model_begin(m);
    return m;
}

static inline void model_free(model *m)
{
    model_end(m);
    free(m);
}

static inline dem_world *model_world(const model *m, int threads)
{
    dem_world *w = NULL;
    dem_error error;
    check_ok(m->status, m->error);
    check_ok(dem_world_create(&(dem_ctx){.threads = threads}, &m->scene, &w, &error), error);
    return w;
}

/// A new world of the model that goes on from the saved state of `w`.
static inline dem_world *model_resumed(const model *m, const dem_world *w, int threads)
{
    dem_world *resumed = model_world(m, threads);
    void *bytes;
    size_t size;
    dem_error error;
    check_ok(dem_world_save(w, &bytes, &size, &error), error);
    check_ok(dem_world_restore(resumed, bytes, size, &error), error);
    free(bytes);
    return resumed;
}

static inline void run_steps(dem_world *w, uint64_t steps)
{
    dem_error error;
    check_ok(dem_world_step(w, steps, &error), error);
}

static inline const dem_figures *measured(dem_world *w)
{
    dem_error error;
    check_ok(dem_world_measure(w, &error), error);
    return dem_world_figures(w);
}

/// A body as the rows have it, without measuring: velocities are half a step old.
static inline size_t row_of(const dem_world *w, size_t body)
{
    return w->bodies.place[body];
}
static inline dem_vec3 position_now(const dem_world *w, size_t body)
{
    return body_position(&w->bodies, row_of(w, body));
}
static inline dem_quat orientation_now(const dem_world *w, size_t body)
{
    size_t row = row_of(w, body);
    return template_principal_orientation(&w->templates.items[w->bodies.shape[row]], body_orientation(&w->bodies, row));
}
static inline dem_vec3 velocity_before(const dem_world *w, size_t body)
{
    const double *m = body_pose(&w->bodies, row_of(w, body)) + 8;
    return v3(m[0], m[1], m[2]);
}
static inline dem_vec3 spin_before(const dem_world *w, size_t body)
{
    const double *m = body_pose(&w->bodies, row_of(w, body)) + 8;
    return v3(m[3], m[4], m[5]);
}

/// The larger size; what is no number stays none, which fmax would forget.
static inline double largest(double worst, double x)
{
    return fabs(x) <= worst ? worst : fabs(x);
}

/// Total momentum and angular momentum about the origin, at the half step, straight from the rows.
static inline void total_momentum(const dem_world *w, dem_vec3 *linear, dem_vec3 *angular)
{
    *linear = *angular = v3(0, 0, 0);
    for (size_t i = 0; i < w->bodies.count; i++) {
        const double *p = w->bodies.momentum + DEM_ROW * i;
        dem_vec3 momentum = v3(p[0], p[1], p[2]);
        *linear = v3_add(*linear, momentum);
        *angular = v3_add(*angular, v3_add(v3(p[3], p[4], p[5]), v3_cross(body_position(&w->bodies, i), momentum)));
    }
}

#endif
