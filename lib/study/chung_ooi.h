/// The impacts of Chung & Ooi (2011), Granular Matter 13:643, with the materials of the reference.
///
/// The curves of the reference were computed for a rigid geometry: the arm of the friction is R. Here it ends at the
/// contact point, R - overlap, so results differ by the order of overlap / R. As nothing else in these cases depends on
/// the modulus, each is run with the modulus asked for and with one so high (STIFF) that the overlap does not count.
#ifndef DEM_STUDY_CHUNG_OOI_H
#define DEM_STUDY_CHUNG_OOI_H

#include "study/impacts.h"

static const double STIFF = 1e10;  ///< times the modulus: overlaps are 1e-4 of what they were
static const double STEPS = 4000;  ///< in the elastic contact, unless said otherwise

static const dem_material GLASS = {"glass", 2800, 48e9, 0.2}, LIMESTONE = {"limestone", 2500, 20e9, 0.25};
static const dem_material STEEL = {"steel", 7850, 208e9, 0.3}, POLYETHYLENE = {"polyethylene", 1400, 1e9, 0.4};
static const dem_material ALLOY_6 = {"alloy", 2700, 70e9, 0.33}, NYLON = {"nylon", 1000, 2.5e9, 0.4};
static const dem_material ALLOY = {"alloy", 2699, 70e9, 0.3}, MAGNESIUM = {"magnesium", 1800, 40e9, 0.35};
static const dem_material OXIDE = {"oxide", 4000, 380e9, 0.23}, IRON = {"iron", 7000, 100e9, 0.25};

static inline dem_material stiffer(dem_material m, double times)
{
    m.young *= times;
    return m;
}

static inline impact on_plane(double radius, dem_material material, double speed, double friction, double restitution)
{
    return (impact){.radius = radius,
                    .material = material,
                    .partner = rigid(),
                    .law = hertz_mindlin(friction, restitution),
                    .velocity = v3(0, 0, -speed),
                    .steps = STEPS};
}

static inline impact on_twin(double radius, dem_material material, double speed, double friction, double restitution)
{
    impact c = on_plane(radius, material, speed, friction, restitution);
    c.partner_radius = radius;
    c.partner = material;
    c.partner_velocity = v3(0, 0, speed);
    return c;
}

/// Largest overlap without damping, by the radius: what the arm is shorter by
static inline double overlap_share(const impact *c)
{
    return elastic_duration(c) * impact_speed(c) / 2.9432752 / c->radius;
}

// ---- test 4

static inline impact oblique(double angle_deg, double times)
{
    double angle = angle_deg * DEM_PI / 180;
    impact c = on_plane(0.0025, stiffer(OXIDE, times), 3.9 * cos(angle), 0.092, 0.98);
    c.velocity.x = 3.9 * sin(angle);
    return c;
}

/// As the figures of the paper count them; spins induced by friction are negative there.
typedef struct oblique_figures {
    double kept, spin, angle_deg, restitution;  ///< v_t'/v_t; [rad/s]; of the contact point
} oblique_figures;

static inline double slip_of(const impact *c, dem_vec3 velocity, dem_vec3 spin)
{
    return velocity.x - c->radius * spin.y;
}

static inline oblique_figures oblique_of(const impact *c, const rebound *b)
{
    return (oblique_figures){b->velocity.x / c->velocity.x, -b->spin.y,
                             atan2(slip_of(c, b->velocity, b->spin), b->velocity.z) * 180 / DEM_PI,
                             -b->velocity.z / c->velocity.z};
}

// ---- test 5

static const double SLIP_UNIT = 0.3 * 5;  ///< mu v_n [m/s]

static inline impact tangential(dem_material material, double psi1, double times, bool rescale)
{
    impact c = on_plane(1e-5, stiffer(material, times), 5, 0.3, 1);
    c.law.rescale = rescale;
    c.velocity.x = psi1 * SLIP_UNIT;
    return c;
}

/// psi = v_t / (mu v_n) of the contact point afterwards; spin R w / (mu v_n).
typedef struct slip_figures {
    double psi2, spin;
} slip_figures;

static inline slip_figures slip_figures_of(const impact *c, const rebound *b)
{
    return (slip_figures){slip_of(c, b->velocity, b->spin) / SLIP_UNIT, -c->radius * b->spin.y / SLIP_UNIT};
}

// ---- tests 6 and 8

/// A sphere of radius 0.1 m that falls with 0.2 m/s and slips by v_t = v_n tan(angle) in its spin alone.
static inline impact spinning(dem_material material, double angle_deg)
{
    impact c = on_plane(0.1, material, 0.2, 0.4, 0.5);
    c.spin = v3(0, -0.2 * tan(angle_deg * DEM_PI / 180) / 0.1, 0);
    return c;
}

static inline impact spinning_on_sphere(double angle_deg, double heavier, double times)
{
    impact c = spinning(stiffer(ALLOY_6, times), angle_deg);
    c.partner_radius = 0.5;
    c.partner = stiffer(ALLOY_6, times * heavier);
    c.partner.density *= heavier;
    return c;
}

typedef struct spin_figures {
    double beta, tan_out, vx, vz, spin;  ///< as the reference counts them
} spin_figures;

static inline spin_figures spin_figures_of(const impact *c, const rebound *b)
{
    double slip = slip_of(c, b->velocity, b->spin);
    return (spin_figures){-slip / slip_of(c, c->velocity, c->spin), slip / b->velocity.z, b->velocity.x, b->velocity.z,
                          -b->spin.y};
}

#endif
