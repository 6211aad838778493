// Convex hull and decimation.
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/orient_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/polygon_mesh_to_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Count_stop_predicate.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/LindstromTurk_cost.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/LindstromTurk_placement.h>
#include <CGAL/Surface_mesh_simplification/edge_collapse.h>
#include <CGAL/convex_hull_3.h>

#include "mesh/cgal_shim.hpp"

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using Surface = CGAL::Surface_mesh<Point>;
namespace PMP = CGAL::Polygon_mesh_processing;
namespace SMS = CGAL::Surface_mesh_simplification;

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

extern "C" dem_status dem_mesh_collapse(const dem_mesh *mesh, size_t triangles, dem_mesh *out, dem_error *error)
{
    *out = dem_mesh{};
    return shim::guarded("the decimation", error, [&] {
        std::vector<Point> points;
        std::vector<shim::Face> faces;
        shim::read(*mesh, points, faces);
        PMP::orient_polygon_soup(points, faces); // splits what is not manifold
        Surface surface;
        PMP::polygon_soup_to_polygon_mesh(points, faces, surface);
        SMS::Count_stop_predicate<Surface> stop(triangles + triangles / 2 + 1);
        SMS::edge_collapse(surface, stop,
                           CGAL::parameters::get_cost(SMS::LindstromTurk_cost<Surface>())
                               .get_placement(SMS::LindstromTurk_placement<Surface>()));
        points.clear();
        faces.clear();
        PMP::polygon_mesh_to_polygon_soup(surface, points, faces);
        return shim::write(points, faces, out, error);
    });
}
