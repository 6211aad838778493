/// Impacts of a sphere on a rigid plane or on another sphere, taken from the first touch to the last.
#ifndef DEM_TESTS_IMPACTS_H
#define DEM_TESTS_IMPACTS_H

#include "sim/impact.h"
#include "worlds.h"

/// The sphere lies above the plane z = 0, or above the partner, and touches it. Two laws: of spheres, and of the wall.
typedef struct impact {
    double radius;  ///< [m]
    dem_material material;
    double partner_radius;  ///< [m]; 0: a rigid plane
    dem_material partner;
    dem_pair_law law;
    dem_vec3 velocity, spin;  ///< of the sphere
    dem_vec3 partner_velocity, partner_spin;
    double steps;  ///< in the elastic contact [-]
} impact;

typedef struct rebound {
    dem_vec3 velocity, spin;  ///< of the sphere
    dem_vec3 partner_velocity, partner_spin;
    double duration;        ///< [s]
    double overlap, force;  ///< largest [m], [N]
} rebound;

enum { CURVE = 2048 };

/// Normal force over the contact, sampled once a step.
typedef struct impact_curve {
    size_t count;
    double time[CURVE], overlap[CURVE], force[CURVE];
} impact_curve;

static inline double reduced_mass(const impact *c)
{
    double r = c->radius, m = c->material.density * 4 * DEM_PI / 3 * r * r * r, p = c->partner_radius;
    return p > 0 ? 1 / (1 / m + 1 / (c->partner.density * 4 * DEM_PI / 3 * p * p * p)) : m;
}

/// Speed of approach [m/s].
static inline double impact_speed(const impact *c)
{
    return c->partner_velocity.z - c->velocity.z;
}

/// Duration of the contact without damping [s].
static inline double elastic_duration(const impact *c)
{
    double m = reduced_mass(c);
    if (c->law.normal == DEM_NORMAL_LINEAR)
        return dem_linear_duration(m, c->law.stiffness);
    double na = c->material.poisson, nb = c->partner.poisson;
    double modulus = 1 / ((1 - na * na) / c->material.young + (1 - nb * nb) / c->partner.young);
    double radius = c->partner_radius > 0 ? 1 / (1 / c->radius + 1 / c->partner_radius) : c->radius;
    return dem_hertz_duration(m, dem_hertz_stiffness(modulus, radius), impact_speed(c));
}

static inline model *impact_model(const impact *c)
{
    model *m = model_new();
    m->materials[0] = c->material;
    m->materials[1] = c->partner;
    m->scene.material_count = 2;
    for (uint32_t i = 0; i < 3; i++) {
        m->laws[i] = c->law;
        m->laws[i].materials[0] = i / 2;
        m->laws[i].materials[1] = (i + 1) / 2;
    }
    m->scene.law_count = 3;
    dem_body_def *b = model_body(m, model_sphere(m, c->radius), v3(0, 0, c->radius));
    b->velocity = c->velocity;
    b->spin = c->spin;
    if (c->partner_radius > 0) {
        uint32_t shape = model_sphere(m, c->partner_radius);
        m->shapes[shape].material = 1;
        b = model_body(m, shape, v3(0, 0, -c->partner_radius));
        b->velocity = c->partner_velocity;
        b->spin = c->partner_spin;
    } else
        model_plane(m, v3(0, 0, 0), v3(0, 0, 1))->material = 1;
    m->scene.time.step = elastic_duration(c) / c->steps;
    return m;
}

/// Runs until the surfaces are apart; looks every `every` steps. `curve` may be NULL.
static inline rebound collide_looking(const impact *c, uint64_t every, impact_curve *curve)
{
    model *m = impact_model(c);
    dem_world *w = model_world(m, 1);
    rebound r = {0};
    double gap_before = 0, h = dem_world_step_size(w);
    for (;;) {
        run_steps(w, every);
        const dem_figures *f = measured(w);
        dem_body_view v = dem_world_bodies(w);
        double bottom = v.position[0].z - c->radius;
        double gap = c->partner_radius > 0 ? bottom - v.position[1].z - c->partner_radius : bottom;
        if (f->contacts + f->wall_contacts == 0) {
            // the line through the last two looks
            r.duration = dem_world_time(w) - h * (double)every * gap / (gap - gap_before);
            break;
        }
        gap_before = gap;
        size_t count;
        const dem_contact *contact = dem_world_contacts(w, &count);
        r.overlap = fmax(r.overlap, contact->overlap);
        r.force = fmax(r.force, contact->normal_force);
        if (curve) {
            check(curve->count < CURVE);
            curve->time[curve->count] = dem_world_time(w);
            curve->overlap[curve->count] = contact->overlap;
            curve->force[curve->count++] = contact->normal_force;
        }
        check(dem_world_time(w) < 100 * elastic_duration(c));
    }
    dem_body_view v = dem_world_bodies(w);
    r.velocity = v.velocity[0];
    r.spin = v.spin[0];
    if (c->partner_radius > 0) {
        r.partner_velocity = v.velocity[1];
        r.partner_spin = v.spin[1];
    }
    dem_world_destroy(w);
    model_free(m);
    return r;
}

/// What comes of it; a step is looked at now and then only.
static inline rebound collide(const impact *c)
{
    return collide_looking(c, 1 + (uint64_t)c->steps / 50, NULL);
}

static inline dem_material rigid(void)
{
    return (dem_material){"rigid", 1000, 1e30, 0.25};
}

/// Hertz and Mindlin with the dashpots of a restitution.
static inline dem_pair_law hertz_mindlin(double friction, double restitution)
{
    dem_pair_law law = dem_pair_law_defaults();
    law.normal = DEM_NORMAL_HERTZ;
    law.friction = friction > 0 ? DEM_FRICTION_MINDLIN : DEM_FRICTION_NONE;
    law.friction_coefficient = friction;
    law.damping = DEM_DAMPING_RESTITUTION;
    law.restitution = restitution;
    return law;
}

#endif
