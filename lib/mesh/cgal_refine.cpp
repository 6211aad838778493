// Triangles cut along their intersections, in exact arithmetic: each cut triangle is triangulated in its own plane
// with the shared points, segments and polygons as constraints. Neighbours compute the same points from their own
// side; being exact, they are equal, and one number is given to both.
#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Constrained_triangulation_plus_2.h>
#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/intersections.h>

#include <map>

#include "mesh/cgal_shim.hpp"

namespace {

using Kernel = CGAL::Exact_predicates_exact_constructions_kernel;
using Point = Kernel::Point_3;
using Flat = Kernel::Point_2;
using Cut = std::vector<Point>; // a point, a segment, or the corners of a polygon
// remembers whole constraints, so that crossing points are computed from their true ends, not from one another
using Planar = CGAL::Constrained_triangulation_plus_2<
    CGAL::Constrained_Delaunay_triangulation_2<Kernel, CGAL::Default, CGAL::Exact_intersections_tag>>;

struct Share : boost::static_visitor<Cut> {
    Cut operator()(const Point &p) const { return {p}; }
    Cut operator()(const Kernel::Segment_3 &s) const { return {s.source(), s.target()}; }
    Cut operator()(const Kernel::Triangle_3 &t) const { return {t[0], t[1], t[2]}; }
    Cut operator()(const Cut &polygon) const { return polygon; }
};

class Refiner
{
public:
    explicit Refiner(const dem_mesh &m) : mesh(m)
    {
        for (std::size_t i = 0; i < m.vertex_count; i++)
            vertices.push_back(m.vertices[i]);
    }

    void share(std::uint32_t a, std::uint32_t b)
    {
        auto common = CGAL::intersection(triangle(a), triangle(b));
        if (!common)
            return;
        Cut cut = boost::apply_visitor(Share(), *common);
        cuts[a].push_back(cut);
        cuts[b].push_back(cut);
    }

    dem_status write(dem_mesh *out, dem_error *error)
    {
        for (const auto &c : cuts)
            for (int k = 0; k < 3; k++)
                numbers.emplace(corner(c.first, k), mesh.triangles[3 * std::size_t(c.first) + k]);
        for (std::size_t t = 0; t < mesh.triangle_count; t++) {
            const std::uint32_t *v = mesh.triangles + 3 * t;
            auto c = cuts.find(static_cast<std::uint32_t>(t));
            if (c == cuts.end())
                faces.push_back({v[0], v[1], v[2]});
            else
                cut_up(c->first, c->second);
        }
        struct Bare {
            dem_vec3 p;
            double x() const { return p.x; }
            double y() const { return p.y; }
            double z() const { return p.z; }
        };
        std::vector<Bare> bare;
        for (const dem_vec3 &p : vertices)
            bare.push_back({p});
        return shim::write(bare, faces, out, error);
    }

private:
    const dem_mesh &mesh;
    std::map<std::uint32_t, std::vector<Cut>> cuts;
    std::map<Point, std::size_t, Kernel::Less_xyz_3> numbers;
    std::vector<dem_vec3> vertices;
    std::vector<shim::Face> faces;

    Point corner(std::uint32_t t, int k) const
    {
        const dem_vec3 &p = mesh.vertices[mesh.triangles[3 * std::size_t(t) + k]];
        return Point(p.x, p.y, p.z);
    }

    Kernel::Triangle_3 triangle(std::uint32_t t) const { return {corner(t, 0), corner(t, 1), corner(t, 2)}; }

    std::size_t number(const Point &p)
    {
        auto found = numbers.emplace(p, vertices.size());
        if (found.second)
            vertices.push_back({CGAL::to_double(p.x()), CGAL::to_double(p.y()), CGAL::to_double(p.z())});
        return found.first->second;
    }

    void cut_up(std::uint32_t t, const std::vector<Cut> &lines)
    {
        Kernel::Plane_3 plane(corner(t, 0), corner(t, 1), corner(t, 2));
        Kernel::Vector_3 n = plane.orthogonal_vector();
        double size[3];
        for (int k = 0; k < 3; k++)
            size[k] = std::abs(CGAL::to_double(n[k]));
        int axis = size[0] >= size[1] && size[0] >= size[2] ? 0 : size[1] >= size[2] ? 1 : 2;
        int i = (axis + 1) % 3, j = (axis + 2) % 3;
        auto flat = [&](const Point &p) { return Flat(p[i], p[j]); };
        Planar planar;
        auto insert = [&](const Cut &cut) {
            if (cut.size() == 1)
                planar.insert(flat(cut[0]));
            for (std::size_t k = 0; k + 1 < cut.size(); k++)
                planar.insert_constraint(flat(cut[k]), flat(cut[k + 1]));
            if (cut.size() > 2)
                planar.insert_constraint(flat(cut.back()), flat(cut.front()));
        };
        insert({corner(t, 0), corner(t, 1), corner(t, 2)});
        for (const Cut &cut : lines)
            insert(cut);
        auto lift = [&](const Flat &p) {
            Kernel::FT c[3];
            c[i] = p.x();
            c[j] = p.y();
            c[axis] = -(n[i] * p.x() + n[j] * p.y() + plane.d()) / n[axis];
            return Point(c[0], c[1], c[2]);
        };
        std::map<Planar::Vertex_handle, std::size_t> known;
        for (auto v = planar.finite_vertices_begin(); v != planar.finite_vertices_end(); ++v)
            known[v] = number(lift(v->point()));
        bool turned = CGAL::sign(n[axis]) == CGAL::NEGATIVE;
        for (auto f = planar.finite_faces_begin(); f != planar.finite_faces_end(); ++f) {
            shim::Face face = {known[f->vertex(0)], known[f->vertex(1)], known[f->vertex(2)]};
            if (turned)
                std::swap(face[0], face[1]);
            faces.push_back(face);
        }
    }
};

} // namespace

extern "C" dem_status dem_mesh_refine(const dem_mesh *mesh, const uint32_t (*pairs)[2], size_t pair_count,
                                      dem_mesh *out, dem_error *error)
{
    *out = dem_mesh{};
    return shim::guarded("cutting the surface where it crosses itself", error, [&] {
        Refiner refiner(*mesh);
        for (std::size_t i = 0; i < pair_count; i++)
            refiner.share(pairs[i][0], pairs[i][1]);
        return refiner.write(out, error);
    });
}
