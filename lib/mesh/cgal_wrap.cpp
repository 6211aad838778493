// Alpha wrapping.
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/polygon_mesh_to_polygon_soup.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/alpha_wrap_3.h>

#include "mesh/cgal_shim.hpp"

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;

extern "C" dem_status dem_mesh_alpha_wrap(const dem_mesh *mesh, double alpha, double offset, dem_mesh *out,
                                          dem_error *error)
{
    *out = dem_mesh{};
    return shim::guarded("the wrap", error, [&] {
        std::vector<Point> points;
        std::vector<shim::Face> faces;
        shim::read(*mesh, points, faces);
        CGAL::Surface_mesh<Point> wrap;
        CGAL::alpha_wrap_3(points, faces, alpha, offset, wrap);
        points.clear();
        faces.clear();
        CGAL::Polygon_mesh_processing::polygon_mesh_to_polygon_soup(wrap, points, faces);
        return shim::write(points, faces, out, error);
    });
}
