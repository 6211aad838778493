/// The surface of a union of balls as triangles.
///
/// Each ball is a subdivided icosahedron, of which only the part on its own side of the planes through the circles
/// where balls cut each other is kept; cut corners are moved onto the circle. Neighbouring parts meet on these circles
/// up to the sag of their facets, so it looks closed but is not welded.
#ifndef DEM_OUT_FACETS_H
#define DEM_OUT_FACETS_H

#include "base/status.h"

typedef struct dem_facet {
    dem_vec3 corners[3];  ///< counter-clockwise seen from outside [m]
    uint32_t ball;
} dem_facet;

typedef struct dem_facets {
    dem_facet *facets;
    size_t count, capacity;
} dem_facets;

/// `times`: how often each of the 20 triangles of a ball is divided in four. Error: DEM_NO_MEMORY.
dem_status dem_balls_facets(const dem_ball *balls, size_t count, int times, dem_facets *facets, dem_error *error);
void dem_facets_release(dem_facets *facets);

#endif
