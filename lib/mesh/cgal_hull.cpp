// Convex hull.
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/convex_hull_3.h>

#include "mesh/cgal_shim.hpp"

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;

extern "C" dem_status dem_mesh_hull(const dem_mesh *mesh, dem_mesh *hull, dem_error *error)
{
    *hull = dem_mesh{};
    return shim::guarded("the convex hull", error, [&] {
        std::vector<Point> points, corners;
        std::vector<shim::Face> faces, sides;
        shim::read(*mesh, points, faces);
        CGAL::convex_hull_3(points.begin(), points.end(), corners, sides);
        if (sides.size() < 4)
            return dem_fail(error, DEM_BAD_INPUT, "all vertices lie in one plane; give a mesh of a solid");
        return shim::write(corners, sides, hull, error);
    });
}
