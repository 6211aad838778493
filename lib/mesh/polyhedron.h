/// Convex polyhedra: cut out by planes, turned into their duals, rounded by a ball, meshed.
#ifndef DEM_MESH_POLYHEDRON_H
#define DEM_MESH_POLYHEDRON_H

#include "base/status.h"
#include "dem/mesh.h"
#include "math/vec.h"

/// normal . x = distance; the solid lies below.
typedef struct dem_plane {
    dem_vec3 normal;  ///< unit
    double distance;  ///< [m]
} dem_plane;

typedef struct dem_polyhedron_face {
    dem_plane plane;
    size_t begin, end;  ///< its corners in `loops`, counter-clockwise from outside
    int tag;            ///< of the plane that cut it; of the box's own -1 to -6
} dem_polyhedron_face;

/// Zero-initialise. Corners no face names may be left over from cuts.
typedef struct dem_polyhedron {
    dem_vec3 *corners;
    uint32_t *loops;
    dem_polyhedron_face *faces;
    size_t corner_count, loop_count, face_count;
    size_t corner_room, loop_room, face_room;
} dem_polyhedron;

void dem_polyhedron_release(dem_polyhedron *p);

/// Becomes a box along the axes.
dem_status dem_polyhedron_box(dem_polyhedron *p, dem_box box, dem_error *error);

/// Cuts off what lies above the plane; nothing may be left (no faces). `cut` tells whether anything was.
dem_status dem_polyhedron_cut(dem_polyhedron *p, dem_plane plane, int tag, bool *cut, dem_error *error);

/// Becomes what lies below all planes, which must enclose it: DEM_BAD_INPUT where they do not within 100 of the
/// origin. Nothing may be left.
dem_status dem_polyhedron_from_planes(dem_polyhedron *p, const dem_plane *planes, size_t count, dem_error *error);

/// Becomes the polar dual of `of`, which has the origin inside: a corner for each face, a face for each corner.
dem_status dem_polyhedron_dual(dem_polyhedron *p, const dem_polyhedron *of, dem_error *error);

/// The largest ball inside.
dem_status dem_polyhedron_inball(const dem_polyhedron *p, dem_ball *ball, dem_error *error);

/// Moves every plane in by as much; nothing may be left.
dem_status dem_polyhedron_erode(dem_polyhedron *p, double by, dem_error *error);

void dem_polyhedron_move(dem_polyhedron *p, dem_vec3 by);
void dem_polyhedron_scale(dem_polyhedron *p, double factor);

/// Who is beside whom. A side is a place in `loops`: it runs from the corner there to the next of its face.
typedef struct dem_polyhedron_sides {
    uint32_t *twin, *face;  ///< [loop_count]
} dem_polyhedron_sides;
dem_status dem_polyhedron_sides_find(const dem_polyhedron *p, dem_polyhedron_sides *sides, dem_error *error);
void dem_polyhedron_sides_release(dem_polyhedron_sides *sides);

static inline uint32_t polyhedron_next(const dem_polyhedron *p, const dem_polyhedron_sides *sides, uint32_t side)
{
    const dem_polyhedron_face *face = &p->faces[sides->face[side]];
    return side + 1 < face->end ? side + 1 : (uint32_t)face->begin;
}
static inline uint32_t polyhedron_before(const dem_polyhedron *p, const dem_polyhedron_sides *sides, uint32_t side)
{
    const dem_polyhedron_face *face = &p->faces[sides->face[side]];
    return side > face->begin ? side - 1 : (uint32_t)face->end - 1;
}
/// Angle by which the surface turns over a side [rad].
static inline double polyhedron_turn(const dem_polyhedron *p, const dem_polyhedron_sides *sides, uint32_t side)
{
    dem_vec3 a = p->faces[sides->face[side]].plane.normal, b = p->faces[sides->face[sides->twin[side]]].plane.normal;
    return atan2(v3_norm(v3_cross(a, b)), v3_dot(a, b));
}

/// Volume [m^3], area [m^2] and integral of the mean curvature, sum(length x exterior angle) / 2 over the edges [m].
typedef struct dem_polyhedron_measures {
    double volume, area, curvature;
    dem_vec3 centre;  ///< of mass [m]
} dem_polyhedron_measures;
dem_status dem_polyhedron_measure(const dem_polyhedron *p, dem_polyhedron_measures *m, dem_error *error);

/// The surface at distance `radius` around the polyhedron, which is its Minkowski sum with a ball, with about so many
/// triangles. Its volume is V + A r + M r^2 + 4 pi r^3 / 3 of the polyhedron's own measures, its area
/// A + 2 M r + 4 pi r^2 (Steiner 1840), less what chords cut off.
dem_status dem_polyhedron_mesh(const dem_polyhedron *p, double radius, size_t triangles, dem_mesh *mesh,
                               dem_error *error);

#endif
