/// Smooth walls whose closest point is found in plain doubles: cones, frusta, discs, spheres, rectangles.
///
/// One form does for all that turn about an axis: a straight piece of a meridian, which may go on without an end. With
/// ends it is solid on both sides, and round its rims the closest point is on the rim; a cone without an end and a
/// sphere have bodies on one side only, so that a ball that has gone too deep is still driven back.
///
/// In the plane through the axis a ball may touch the near piece and the one across. Both count: the energy is then a
/// smooth function of the ball's place, also of one that sits in the middle of a funnel.
#ifndef DEM_SIM_SURFACE_H
#define DEM_SIM_SURFACE_H

#include "dem/scene.h"
#include "sim/mesh_wall.h"

typedef enum dem_surface_kind {
    DEM_SURFACE_NONE,
    DEM_SURFACE_TURNED,
    DEM_SURFACE_SPHERE,
    DEM_SURFACE_RECTANGLE
} dem_surface_kind;

typedef struct dem_surface {
    dem_surface_kind kind;
    dem_vec3 point, axis, along;  ///< of a rectangle: normal, first side
    double begin;                 ///< distance from the axis at `point`; of a sphere: radius [m]
    double run[2];                ///< from there to the end, away from the axis and along it [m]; endless: [-]
    bool endless;
    double side;     ///< 1: bodies inside, -1: outside, 0: on both sides
    double half[2];  ///< of the sides of a rectangle [m]
} dem_surface;

enum { DEM_SURFACE_CONTACTS = 2 };

/// Kind NONE for other walls.
dem_surface dem_surface_of(const dem_wall_def *wall);

/// Where a ball touches, nearest first; returns how many.
int dem_surface_contacts(const dem_surface *surface, dem_vec3 centre, double radius,
                         dem_mesh_contact contacts[DEM_SURFACE_CONTACTS]);

/// Distance of a point, negative on the wrong side of one that has only one [m].
double dem_surface_distance(const dem_surface *surface, dem_vec3 x);

/// How many contacts a ball may have.
int dem_surface_most(const dem_surface *surface);

/// Whether turning about this axis leaves it in place.
bool dem_surface_turns_in_place(const dem_surface *surface, dem_vec3 through, dem_vec3 axis);

/// Area of a flat one as it is seen along a direction, else 0 [m^2].
double dem_surface_shadow(const dem_surface *surface, dem_vec3 direction);

/// [m^2]; INFINITY: endless.
double dem_surface_area(const dem_surface *surface);

#endif
