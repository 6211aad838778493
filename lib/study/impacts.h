/// Impacts of a sphere on a rigid plane or on another sphere, taken from the first touch to the last.
#ifndef DEM_STUDY_IMPACTS_H
#define DEM_STUDY_IMPACTS_H

#include "sim/impact.h"
#include "study/trial.h"

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

/// The scene of it, in the trial's model.
void dem_impact_model(dem_trial *trial, const impact *c);
/// Runs until the surfaces are apart; looks every `every` steps. `curve` may be NULL.
rebound dem_impact_watch(dem_trial *trial, const impact *c, uint64_t every, impact_curve *curve);
/// What comes of it; a step is looked at now and then only.
rebound dem_impact_run(dem_trial *trial, const impact *c);

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
