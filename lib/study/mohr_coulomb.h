/// The Mohr-Coulomb line through the strengths of several tests: friction angle, cohesion and what follows from them.
///
/// Pressure is positive. With s = (s1 + s3) / 2 and t = (s1 - s3) / 2 a sample fails at t = s sin(phi) + c cos(phi): a
/// straight line through the tops of the circles, fitted by least squares in t.
#ifndef DEM_STUDY_MOHR_COULOMB_H
#define DEM_STUDY_MOHR_COULOMB_H

#include "base/text.h"

/// Largest and smallest principal stress at failure [Pa].
typedef struct dem_failure {
    double sigma1, sigma3;
} dem_failure;

typedef struct dem_mohr_coulomb {
    double friction_angle;  ///< phi [rad]
    double angle_error;     ///< its standard error [rad]; NAN with two tests
    double cohesion;        ///< c [Pa]
    double cohesion_error;  ///< [Pa]; NAN with two tests
    double residual;        ///< root mean square of t off the line [Pa]
    double axial_strength;  ///< 2 c cos(phi) / (1 - sin(phi)): sigma1 at failure without confinement [Pa]
    double shear_strength;  ///< c cos(phi) / (1 - sin(phi)): the largest shear stress of that test, half of it [Pa]
    double tensile_cutoff;  ///< 2 c cos(phi) / (1 + sin(phi)): -sigma3 at failure with sigma1 = 0 [Pa]
    size_t count;
} dem_mohr_coulomb;

/// Errors: DEM_BAD_INPUT for fewer than two tests, tests of one confinement only, or strengths that no friction angle
/// below 90 degrees explains.
dem_status dem_mohr_coulomb_fit(const dem_failure *tests, size_t count, dem_mohr_coulomb *fit, dem_error *error);

/// What follows from friction angle [rad] and cohesion [Pa].
void dem_mohr_coulomb_complete(dem_mohr_coulomb *fit);

/// The columns sigma1 and sigma3 of a CSV text, in any order among others; a unit may stand behind the name, as in
/// sigma1_kPa, else they are in `unit` [Pa]. Lines that begin with # are left out. *tests is to be freed. Errors:
/// DEM_BAD_INPUT with file and line, DEM_NO_MEMORY.
dem_status dem_failures_parse(const char *text, size_t size, const char *name, double unit, dem_failure **tests,
                              size_t *count, dem_error *error);

/// Appends circles and line as SVG, both axes to one scale; `fragment`: for inside of a page.
void dem_mohr_coulomb_draw(dem_buffer *out, const dem_failure *tests, size_t count, const dem_mohr_coulomb *fit,
                           bool fragment);

#endif
