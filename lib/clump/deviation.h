/// How far the surface of a mesh and the boundary of a union of balls lie from each other.
#ifndef DEM_CLUMP_DEVIATION_H
#define DEM_CLUMP_DEVIATION_H

#include "geom/boundary.h"
#include "geom/tree.h"

typedef struct dem_deviation {
    double mesh_mean;   ///< distance of the mesh's points to the boundary, mean by area
    double union_mean;  ///< distance of the boundary's points to the mesh, mean by area
    double largest;     ///< of both
    double protrusion;  ///< largest distance of a boundary point outside the mesh; 0: none
    double normal_deg;  ///< mean over the mesh's area of the angle between its normal and that of the closest
                        ///< boundary point (on a crease the mean of both sides)
} dem_deviation;

/// `samples` points on each surface for the means; the largest values are searched for, to about half a percent.
dem_status dem_deviation_measure(const dem_tree *mesh, const dem_boundary *boundary, size_t samples, int threads,
                                 dem_deviation *deviation, dem_error *error);

#endif
