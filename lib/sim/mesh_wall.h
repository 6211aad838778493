/// Walls of triangles: which triangles are near a ball, and where a ball touches them.
///
/// A wall never changes. It stands in the frame its mesh was given in; for a wall that moves, bring the balls into that
/// frame. Candidates are gathered by Embree in 32-bit floats, everything that is handed out is computed in double and
/// has the same bits on every machine.
///
/// What a ball touches is found as by Santasusana et al. (2016, H2), in two steps. By type: a closest point on an edge
/// or corner counts only if no triangle that shares it has a nearer one, for only then the distance to the surface is
/// least there; a face so beats its own edges and corners, an edge its corners, and the folds of a concave surface
/// farther off do not count. By distance: what is left is taken from the nearest on, and a point on or behind the
/// tangent plane of one that was taken is passed over; what several triangles share so counts once, and coplanar and
/// convex neighbours that share no corners, and the back of a plate, add nothing. In a concave corner every face
/// counts. Both sides of a triangle are solid.
///
/// Known limit: of faces that fold inwards by less than 0.08 degrees only the nearer counts, and where the fold is
/// sharper but less than acos(1 - overlap / radius), the second face sets in with a jump.
#ifndef DEM_SIM_MESH_WALL_H
#define DEM_SIM_MESH_WALL_H

#include "base/memory.h"
#include "dem/mesh.h"
#include "geom/triangle.h"
#include "ray/ray.h"
#include "sim/mesh_spots.h"

typedef struct dem_mesh_wall {
    const dem_triangle *triangles;  ///< [mesh.triangle_count], the numbers that everything below speaks of
    dem_box box;                    ///< of the triangles [m]
    dem_mesh mesh;                  ///< what was given, equal vertices welded, without degenerate triangles
    const uint32_t *given;          ///< [mesh.triangle_count] which of the triangles as given it was
    dem_ray_scene *rays;
    const dem_mesh_spots *spots;
    dem_arena memory;
} dem_mesh_wall;

/// Copies the mesh. Triangles with less area than 1e-12 of their longest edge squared are dropped, with one warning.
/// Errors, with `name` in their text: DEM_BAD_INPUT where a vertex is not finite, an index out of range or nothing is
/// left; DEM_UNAVAILABLE without Embree; DEM_NO_MEMORY.
dem_status dem_mesh_wall_create(const dem_ctx *ctx, const dem_mesh *mesh, const char *name, dem_mesh_wall **wall,
                                dem_error *error);
void dem_mesh_wall_destroy(dem_mesh_wall *wall);

/// Makes `list` the triangles with a point within `reach` of `point`, ascending; one that is just beyond by rounding
/// may be among them. Any number of threads may ask at once, each with its own list. False: no memory.
bool dem_mesh_wall_near(const dem_mesh_wall *wall, dem_vec3 point, double reach, dem_ray_list *list);

/// The closest point of triangle ids[k] to centres[k] for `count` pairs at once; the bits of triangle_closest.
void dem_mesh_wall_spots(const dem_mesh_wall *wall, const uint32_t *ids, const dem_vec3 *centres, size_t count,
                         dem_closest *spots);

/// Where a ball touches a wall.
typedef struct dem_mesh_contact {
    uint32_t triangle;
    dem_triangle_part part;
    dem_vec3 point;   ///< closest point [m]
    dem_vec3 offset;  ///< from the centre to it [m]
    dem_vec3 normal;  ///< unit, from it towards the centre; with the centre on the triangle: the triangle's normal
    double distance;  ///< of the centre, less than the radius [m]
} dem_mesh_contact;

enum { DEM_MESH_CONTACTS = 8 };  ///< a ball has no more at one wall; farther ones are left out

/// The contacts of a ball, nearest first, at most `most` (up to DEM_MESH_CONTACTS). Returns how many. `ids` must hold
/// every triangle within the radius; others, their order and repetitions do not matter.
int dem_mesh_wall_contacts(const dem_mesh_wall *wall, const uint32_t *ids, size_t count, dem_vec3 centre, double radius,
                           dem_mesh_contact *contacts, int most);

/// The same where the closest points are known: spots[k] is that of ids[k] to `centre`. NULL: not known.
int dem_mesh_wall_sift(const dem_mesh_wall *wall, const uint32_t *ids, const dem_closest *spots, size_t count,
                       dem_vec3 centre, double radius, dem_mesh_contact *contacts, int most);

/// Of the triangles `ids` those with a point nearer than `reach` to the centre, to `close`; returns the distance of the
/// nearest of the others, INFINITY if there is none.
double dem_mesh_wall_close(const dem_mesh_wall *wall, const uint32_t *ids, size_t count, dem_vec3 centre, double reach,
                           uint32_t *close, uint32_t *close_count);

/// Which contact of the last step of the same ball and wall each contact goes on with: from[k] is an index into `last`,
/// or -1 for a new one. One goes on with a contact whose point, in the wall's frame, lies within `reach` of its own,
/// |v_t| h + 0.1 sqrt(R overlap), and whose normal within 15 degrees; the nearest pairs are joined first, and none goes
/// on twice. Both counts are at most DEM_MESH_CONTACTS.
void dem_mesh_contacts_follow(const dem_mesh_contact *last, int last_count, const dem_mesh_contact *contacts, int count,
                              double reach, int *from);

#endif
