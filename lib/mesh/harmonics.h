/// A star-shaped surface as a sum of spherical harmonics, r(u) = sum c_nm Y_nm(u), with real orthonormal Y_nm.
#ifndef DEM_MESH_HARMONICS_H
#define DEM_MESH_HARMONICS_H

#include "base/random.h"
#include "base/status.h"
#include "dem/mesh.h"
#include "math/vec.h"

enum {
    DEM_HARMONICS_DEGREE = 30,  ///< the highest
    DEM_HARMONICS_TERMS = (DEM_HARMONICS_DEGREE + 1) * (DEM_HARMONICS_DEGREE + 1),
};

typedef struct dem_harmonics {
    int degree;
    double c[DEM_HARMONICS_TERMS];  ///< c_nm at n^2 + n + m; m < 0 are the sines [m]
    // of the recurrence
    double rise[DEM_HARMONICS_TERMS], fall[DEM_HARMONICS_TERMS], sector[DEM_HARMONICS_DEGREE + 1];
} dem_harmonics;

static inline int harmonics_term(int n, int m)
{
    return n * n + n + m;
}

/// All coefficients 0.
void dem_harmonics_init(dem_harmonics *h, int degree);

double dem_harmonics_radius(const dem_harmonics *h, dem_vec3 direction);

/// D_n = sqrt(sum_m c_nm^2) / c_00, which does not change when the grain is turned or scaled [-].
double dem_harmonics_power(const dem_harmonics *h, int n);

/// New coefficients of degree n with the D_n given: independent normal numbers scaled to it, so that no orientation is
/// preferred.
void dem_harmonics_draw(dem_harmonics *h, int n, double power, dem_random *random);

/// The surface about the origin. DEM_USAGE where a radius is less than a tenth of the mean; DEM_INTERRUPTED.
dem_status dem_harmonics_mesh(const dem_ctx *ctx, const dem_harmonics *h, size_t triangles, dem_mesh *mesh,
                              dem_error *error);

/// What a fit to a mesh came to.
typedef struct dem_harmonics_fit {
    dem_vec3 centre;             ///< of the mesh, the origin of the harmonics [m]
    double equivalent_diameter;  ///< of the mesh [m]
    double volume;               ///< of the mesh [m^3]
    size_t rays;                 ///< directions looked into
    double hidden;               ///< part of the directions in which the surface is met more than once [-]
    double hidden_depth;         ///< most that lies below its outermost point there [m]
} dem_harmonics_fit;

/// Fits a closed, outward mesh by quadrature over the sphere about its centre of mass, by its outermost points.
/// DEM_BAD_INPUT where the centre lies outside of it.
dem_status dem_harmonics_fit_mesh(const dem_ctx *ctx, const dem_mesh *mesh, int degree, dem_harmonics *h,
                                  dem_harmonics_fit *fit, dem_error *error);

/// Root mean square and largest distance between two surfaces, both ways [m].
typedef struct dem_surface_distance {
    double rms, largest;
} dem_surface_distance;
dem_status dem_mesh_distance(const dem_mesh *a, const dem_mesh *b, dem_surface_distance *distance, dem_error *error);

/// A grain of the same spectrum: degrees above `kept` are drawn anew with the D_n of `of`, again and again until the
/// grain is nowhere hollowed out. DEM_USAGE where that never comes.
dem_status dem_harmonics_sibling(const dem_ctx *ctx, const dem_harmonics *of, int kept, uint64_t seed, size_t triangles,
                                 dem_harmonics *sibling, dem_mesh *mesh, dem_error *error);

#endif
