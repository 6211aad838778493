/// Rods and plates: their bounding balls are near to those of many bodies that their boxes are far from.
///
/// The largest gap of two boxes along the 15 directions that can part them (the faces of both, and the products of
/// their edges) is never more than the distance of the bodies, so that pairs farther apart than the skin may be left
/// out until some surface has moved by half of it. Unlike the distance of balls it changes as bodies turn.
#ifndef DEM_SIM_SLIM_H
#define DEM_SIM_SLIM_H

#include "sim/state.h"

/// Whether the boxes of two bodies are farther apart than `least` [m]; `offset`: from the centre of a to that of b.
bool dem_slim_apart(const dem_world *world, size_t a, size_t b, dem_vec3 offset, double least);

#endif
