/// Fills: bodies placed at random in a box without any overlap.
///
/// Which bodies: the entries of the mix take turns, always the one that is farthest behind its share, so that the
/// shares of any number of bodies are as close as whole bodies allow. The sizes of an entry follow its law by the
/// golden-ratio sequence, which keeps close to the law at every count. The returned bodies stand in this order, which
/// says nothing about size or place.
///
/// Where: the largest bounding sphere first, at random positions in uniformly random orientations (random sequential
/// addition). A body that finds no room is looked for in what is left of space, cell by cell; the last ones are placed
/// small and grow while all bodies are shaken; what is denser still is put on a lattice, jittered as far as it goes.
/// Overlap is tested sphere against sphere in double precision; nothing overlaps, not even by rounding.
#ifndef DEM_SIM_FILL_H
#define DEM_SIM_FILL_H

#include "base/status.h"
#include "dem/scene.h"

/// A grain in its principal frame, centre of mass at 0.
typedef struct dem_fill_shape {
    const dem_ball *balls;
    size_t ball_count;
    double mass;                 ///< [kg], for shares by mass
    double volume;               ///< of the grain; of a flat fill its area times the height of the box [m^3]
    bool flat;                   ///< mass and volume go by the square of the scale
    double equivalent_diameter;  ///< of the sphere with this volume [m]
    double radius_out;           ///< of the smallest sphere about the centre that holds all balls [m]
} dem_fill_shape;

/// What is there already; zero-initialised: nothing.
typedef struct dem_fill_obstacles {
    const dem_body_def *bodies;  ///< of the same shapes
    size_t body_count;
    const dem_domain_def *domain;  ///< NULL: endless
    bool flat;                     ///< two dimensions: centres in the plane halfway up the box, turned about z only
    const dem_wall_def *walls;     ///< planes and cylinders; the position of mesh walls is asked of `clearance`
    size_t wall_count;
    /// Least distance from the surface of a ball to any other wall [m], negative where it crosses one, or `most` where
    /// it is more than that. Shrinking the ball must raise it by as much. NULL: there are no other walls.
    double (*clearance)(void *user, dem_vec3 centre, double radius, double most);
    void *user;
} dem_fill_obstacles;

/// Places what `fill` asks for; the caller frees *bodies. Every sphere lies inside of the box, `fill->gap` or more away
/// from every other body and wall. On an axis on which the domain is periodic and the box as long as it, only the
/// centres do, and periodic images count as bodies; likewise along z where the fill is flat. A void ratio counts the bodies of this fill only.
/// `there` may be NULL. Same result for the same seed.
/// Errors: DEM_USAGE for what cannot be, DEM_FAILED where not all fit (the text says how many did), DEM_INTERRUPTED.
dem_status dem_fill(const dem_ctx *ctx, const dem_fill_def *fill, const dem_fill_shape *shapes, size_t shape_count,
                    const dem_fill_obstacles *there, dem_body_def **bodies, size_t *count, dem_error *error);

#endif
