/// One parallel bond: an elastic disc between two bodies, which resists stretch, shear, twist and bend (Potyondy &
/// Cundall 2004). Pure functions.
///
/// Formulation: total, from a potential, so that nothing drifts however far the bodies have turned, and forces do no
/// work on a closed path. At creation each body gets the bond's point (`anchor`) and its frame (`frame`, x along the
/// bond) in its own axes. Later the two frames differ by a turn phi; the frame half way between them (m) does not
/// prefer either body. With u the way from a's anchor to b's, seen in m,
///   E = 1/2 (k_n u_x^2 + k_s (u_y^2 + u_z^2) + k_t phi_x^2 + k_b (phi_y^2 + phi_z^2)).
/// With d = (w, s) the quaternion of phi, x = |phi| / 2 and k = x / sin x = phi / (2 |s|), the gradient is
///   force on a     F  = m (dE/du)
///   moment on a       = r_a x F + t / 2 + N,  on b = -r_b x F + t / 2 - N,  t = u x F
///   N = k M' + (1 - k) (M' . s^) s^,  M' = dE/dphi + (1 - cos x) / (4 x^2) t x phi
/// which leaves momentum and angular momentum as they are (their sum about any point is 0) and the energy, too.
#ifndef DEM_SIM_BOND_H
#define DEM_SIM_BOND_H

#include "math/quat.h"

typedef enum dem_bond_way { BOND_STRETCH, BOND_SHEAR, BOND_TWIST, BOND_BEND, BOND_WAYS } dem_bond_way;

/// How far two bodies have moved from where they were bonded.
typedef struct bond_strain {
    dem_quat middle;  ///< frame half way, to space
    dem_vec3 way;     ///< u in it [m]
    dem_vec3 turn;    ///< phi in it [rad]
    dem_vec3 sine;    ///< phi^ sin x
    double ratio;     ///< k = x / sin x
    double excess;    ///< (1 - k) / sin^2 x
    double bow;       ///< (1 - cos x) / (4 x^2)
} bond_strain;

/// `frame_a`, `frame_b`: of the bond in space, as either body has it; `way` in space.
static inline bond_strain bond_strain_of(dem_quat frame_a, dem_quat frame_b, dem_vec3 way)
{
    dem_quat d = quat_multiply(quat_conjugate(frame_a), frame_b);
    if (d.w < 0)
        d = (dem_quat){-d.w, -d.x, -d.y, -d.z};
    bond_strain b = {.sine = v3(d.x, d.y, d.z)};
    double s2 = v3_norm2(b.sine), s = sqrt(s2);
    // of asin(s) / s: beyond this the next term is below the last bit
    if (s < 0.01) {
        b.excess = -(1.0 / 6 + s2 * (3.0 / 40 + s2 * (15.0 / 336)));
        b.ratio = 1 - s2 * b.excess;
    } else {
        b.ratio = atan2(s, d.w) / s;
        b.excess = (1 - b.ratio) / s2;
    }
    b.bow = 1 / (4 * (1 + d.w) * b.ratio * b.ratio);
    b.turn = v3_scale(b.sine, 2 * b.ratio);
    b.middle = quat_multiply(frame_a, quat_unit((dem_quat){1 + d.w, d.x, d.y, d.z}));
    b.way = quat_unrotate(b.middle, way);
    return b;
}

/// Along the bond and across it, each with its own factor.
static inline dem_vec3 bond_scaled(dem_vec3 v, double along, double across)
{
    return v3(along * v.x, across * v.y, across * v.z);
}

/// The moment that opposes the turn, in the frame half way, before the bow is taken into account.
static inline dem_vec3 bond_moment(const bond_strain *b, const double stiffness[BOND_WAYS])
{
    return bond_scaled(b->turn, stiffness[BOND_TWIST], stiffness[BOND_BEND]);
}
static inline dem_vec3 bond_force(const bond_strain *b, const double stiffness[BOND_WAYS])
{
    return bond_scaled(b->way, stiffness[BOND_STRETCH], stiffness[BOND_SHEAR]);
}

/// N in the frame half way, for the moment and the force there.
static inline dem_vec3 bond_turning(const bond_strain *b, dem_vec3 force, dem_vec3 moment)
{
    dem_vec3 lever = v3_cross(b->way, force);
    moment = v3_along(moment, b->bow, v3_cross(lever, b->turn));
    return v3_along(v3_scale(moment, b->ratio), b->excess * v3_dot(moment, b->sine), b->sine);
}

static inline double bond_energy(const bond_strain *b, dem_vec3 force, dem_vec3 moment)
{
    return (v3_dot(b->way, force) + v3_dot(b->turn, moment)) / 2;
}

static inline double bond_area(double radius)
{
    return DEM_PI * radius * radius;
}
/// Of the disc about a diameter; about its axis it is twice that [m^4].
static inline double bond_second_moment(double radius)
{
    return DEM_PI / 4 * radius * radius * radius * radius;
}

/// Largest tension in the disc by stretch and bend, largest shear by shear and twist [Pa]; `share` of the moments.
static inline void bond_stress(dem_vec3 force, dem_vec3 moment, double radius, double share, double stress[2])
{
    double area = bond_area(radius), second = bond_second_moment(radius);
    stress[0] = force.x / area + share * sqrt(moment.y * moment.y + moment.z * moment.z) * radius / second;
    stress[1] = sqrt(force.y * force.y + force.z * force.z) / area + share * fabs(moment.x) * radius / (2 * second);
}

#endif
