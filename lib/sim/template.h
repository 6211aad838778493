/// Templates: the scene's shapes prepared for running, one per shape in the same order; bodies are scaled copies.
///
/// A body of scale s has lengths s, masses s^3, moments of inertia s^5 times those of its template (discs s^2 and s^4).
///
/// *Run frame.* The rotation is split so that one axis, c, is turned about apart from a top that is symmetric about it;
/// the split is best where |1/I_a - 1/I_b| is smallest (PHYSICS 2.2, symmetric-top splitting). The run frame is the
/// principal frame with its axes renamed in cyclic order, so that c is z: coordinates are only permuted, without any
/// rounding. As moments ascend, c is the last axis (nothing is renamed) or the first. Outside of a running world
/// everything is told in the principal frame; see template_run_orientation.
#ifndef DEM_SIM_TEMPLATE_H
#define DEM_SIM_TEMPLATE_H

#include "base/status.h"
#include "dem/scene.h"
#include "math/quat.h"

/// All of scale 1.
typedef struct dem_template {
    double mass, inverse_mass;              ///< [kg], [1/kg]
    double inertia[3], inverse_inertia[3];  ///< about the axes of the run frame [kg m^2], [1/(kg m^2)]
    bool isotropic;                         ///< the three moments are the same number
    bool centred;                           ///< one sphere, at the centre: its centre is exactly 0
    dem_quat to_run;                        ///< principal frame -> run frame
    uint32_t first, count;                  ///< spheres: rows of dem_templates.spheres
    uint32_t float_first, float_padded;     ///< places in the columns, both multiples of DEM_TEMPLATE_PAD
    double radius_out;                      ///< from the centre of mass to the farthest point of the surface [m]
    double radius_min, radius_max;          ///< of the spheres [m]
    dem_vec3 box_centre, box_half;          ///< of the box along the axes that holds the spheres, and its half edges [m]
    bool slim;                              ///< the box is much smaller than the ball: it tells more of what is near
    double volume;                          ///< that the mass stands for [m^3]
    double equivalent_diameter;             ///< of the sphere with the grain's volume; of a disc its own [m]
    bool flat;                              ///< a disc: bodies keep its thickness, so that masses go by s^2
    double least_mass;                      ///< smallest mass that a contact on the surface can see, see below [kg]
    uint32_t material;
} dem_template;

enum { DEM_TEMPLATE_PAD = 16 };

/// A padding sphere lies at the centre with a negative radius, smaller than minus any size a template can have: on
/// every axis its upper end, n.c + r, is below and its lower end, n.c - r, above those of all real spheres, so a slab
/// test drops it and no extremum sees it. Squares of it and of sums of two are finite.
#define DEM_TEMPLATE_NEVER (-1e18f)

/// Released as a whole; everything in the run frames.
typedef struct dem_templates {
    dem_template *items;
    size_t count;
    double (*spheres)[4];  ///< x y z r of each sphere, aligned to 64 bytes [m]
    float *x, *y, *z,
        *r;  ///< the same as columns, for culling, aligned to 64 bytes; see dem_template.float_first. Each
             ///< ball contains the one it stands for, so only the rounding of the test itself remains [m]
    size_t sphere_count, float_count;
} dem_templates;

/// From scene->shapes (whose clump files have been read) and scene->materials. The mass of a clump is its own times
/// material density / its density, where the material has a density; spheres need it.
///
/// A clump of one sphere at the centre (to 1e-12 of its radius) whose moments agree to 1e-9 is the template of a plain
/// sphere, bit for bit where mass, volume and the middle moment are the same numbers.
///
/// `least_mass` is 1 / (1/m + max (c x n).I^-1 (c x n)) over all spheres' centres c and directions n: with the lever
/// arm c + r n of a contact on a sphere, r x n = c x n. It bounds the local mass of PHYSICS 1.13 for one side.
dem_status dem_templates_create(const dem_scene *scene, dem_templates *templates, dem_error *error);
void dem_templates_release(dem_templates *templates);

/// Mass of a body of that scale over the template's [-].
static inline double template_bulk(const dem_template *t, double scale)
{
    return t->flat ? scale * scale : scale * scale * scale;
}

/// Run frame -> space from principal frame -> space: x_space = R(q) x_principal = R(q to_run^-1) x_run.
static inline dem_quat template_run_orientation(const dem_template *t, dem_quat principal)
{
    return quat_multiply(principal, quat_conjugate(t->to_run));
}
static inline dem_quat template_principal_orientation(const dem_template *t, dem_quat run)
{
    return quat_multiply(run, t->to_run);
}

#endif
