/// Roughness of one wavelength on any surface.
#ifndef DEM_MESH_ROUGHEN_H
#define DEM_MESH_ROUGHEN_H

#include "base/status.h"
#include "dem/mesh.h"

/// How many triangles it takes to carry waves of that length: six of their longer sides to a wave.
double dem_mesh_triangles_for(const dem_mesh *mesh, double wavelength);

/// Moves the vertices of a closed, outward mesh along their normals by a random field, whose root mean square over the
/// surface is `amplitude`, its mean 0 and its root mean square wave number 2 pi / wavelength: 128 plane waves of random
/// direction and phase. Where that would make the surface cross itself, the amplitude is less; `reached` tells.
/// DEM_USAGE where not even a tenth of it would do.
dem_status dem_mesh_roughen(const dem_ctx *ctx, dem_mesh *mesh, double amplitude, double wavelength, uint64_t seed,
                            double *reached, dem_error *error);

#endif
