/// Contacts whose bodies are moved by hand: what the plain kernels make of given positions and velocities.
#ifndef DEM_TESTS_BENCH_CONTACT_H
#define DEM_TESTS_BENCH_CONTACT_H

#include "worlds.h"

typedef struct bench {
    model *m;
    dem_world *w;
} bench;

/// What acts on a body.
typedef struct wrench {
    dem_vec3 force, moment;
} wrench;

/// The bodies of the model must be near each other, so that their contacts are listed.
static inline bench bench_open(model *m)
{
    bench b = {m, model_world(m, 1)};
    b.w->kernels = dem_kernels_choose("plain");
    b.w->instance = &b.w->kernels->instances[b.w->kernels->instance_count - 1];
    b.w->wall_instance = b.w->instance;
    return b;
}

static inline void bench_close(bench *b)
{
    dem_world_destroy(b->w);
    model_free(b->m);
}

static inline void bench_put(bench *b, size_t body, dem_vec3 x, dem_vec3 v, dem_vec3 spin)
{
    double *pose = body_pose(&b->w->bodies, b->w->bodies.place[body]);
    memcpy(pose, (double[]){x.x, x.y, x.z}, 3 * sizeof *pose);
    memcpy(pose + 8, (double[]){v.x, v.y, v.z, spin.x, spin.y, spin.z}, 6 * sizeof *pose);
}

static inline void bench_turn(bench *b, size_t body, dem_quat q)
{
    double *pose = body_pose(&b->w->bodies, b->w->bodies.place[body]);
    memcpy(pose + 3, (double[]){q.w, q.x, q.y, q.z}, 4 * sizeof *pose);
}

/// Evaluates all contacts, springs grow by what passed in `step`; the impulses of a second are the forces.
static inline void bench_step(bench *b, double step)
{
    dem_world *w = b->w;
    dem_rows rows = world_rows(w);
    memset(w->bodies.momentum, 0, w->bodies.padded * DEM_ROW * sizeof(double));
    for (size_t i = 0; i < w->segment_count; i++)
        for (int form = -1; form < DEM_WALL_FORMS; form++) {
            const dem_contacts *contacts = form < 0 ? &w->contacts : &w->wall_contacts[form];
            if (!contacts->segments)
                continue;
            dem_contact_job job = {.columns = contacts->columns,
                                   .begin = contacts->segments[i].begin,
                                   .end = contacts->segments[i].end,
                                   .last_step = step,
                                   .kick = 1,
                                   .next_step = step,
                                   .tally = &w->tallies[i]};
            (form < 0 ? w->instance->pairs : w->instance->walls[form])(w->features, &rows, &job);
        }
}

static inline wrench bench_wrench(const bench *b, size_t body)
{
    const double *p = b->w->bodies.momentum + DEM_ROW * b->w->bodies.place[body];
    return (wrench){v3(p[0], p[1], p[2]), v3(p[3], p[4], p[5])};
}

/// The same at once.
static inline dem_vec3 bench_force(bench *b, size_t body, double step)
{
    bench_step(b, step);
    return bench_wrench(b, body).force;
}

/// Spring of the first contact of pairs [m].
static inline dem_vec3 bench_spring(const bench *b)
{
    const dem_contact_columns *c = &b->w->contacts.columns;
    size_t at = segment_place(&b->w->contacts.segments[0], 0);
    return v3(c->spring[0][at], c->spring[1][at], c->spring[2][at]);
}

/// Two spheres along x, the second to the right of the first, overlapping; `w->bodies.place` need not be looked at.
static inline bench bench_spheres(model *m, double left, double right, double overlap)
{
    uint32_t a = model_sphere(m, left), b = model_sphere(m, right);
    if (m->scene.material_count > 1)
        m->shapes[b].material = 1;
    model_body(m, a, v3(0, 0, 0));
    model_body(m, b, v3(left + right - overlap, 0, 0));
    return bench_open(m);
}

/// Places them anew: the first at rest.
static inline void set_pair(bench *b, double left, double right, double overlap, dem_vec3 velocity)
{
    bench_put(b, 0, v3(0, 0, 0), v3(0, 0, 0), v3(0, 0, 0));
    bench_put(b, 1, v3(left + right - overlap, 0, 0), velocity, v3(0, 0, 0));
}

/// Two materials with a Hertz law each with itself and between them
static inline model *hertz_model(void)
{
    model *m = model_new();
    m->materials[1] = (dem_material){"soft", 1000, 3e7, 0.4};
    m->scene.material_count = 2;
    m->scene.law_count = 3;
    for (uint32_t i = 0; i < 3; i++) {
        m->laws[i] = dem_pair_law_defaults();
        m->laws[i].normal = DEM_NORMAL_HERTZ;
        m->laws[i].materials[0] = i / 2;
        m->laws[i].materials[1] = (i + 1) / 2;
    }
    return m;
}

/// Work that goes into the contact of spheres of 0.01 and 0.02 m along a straight leg of overlap and slip.
static inline double leg(bench *b, double from, double to, double s_from, double s_to, int steps)
{
    double work = 0, h = 1e-6;
    dem_vec3 before = bench_wrench(b, 1).force;
    for (int i = 1; i <= steps; i++) {
        double d = from + (to - from) * i / steps;
        dem_vec3 v = v3((from - to) / steps / h, (s_to - s_from) / steps / h, 0);
        bench_put(b, 0, v3(0, 0, 0), v3(0, 0, 0), v3(0, 0, 0));
        bench_put(b, 1, v3(0.03 - d, 0, 0), v, v3(0, 0, 0));
        bench_step(b, h);
        dem_vec3 now = bench_wrench(b, 1).force;
        work -= h * v3_dot(v, v3_scale(v3_add(before, now), 0.5));
        before = now;
    }
    return work;
}

#endif
