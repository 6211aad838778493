// What the translation units of the CGAL shim share: meshes in and out, and the wall against exceptions.
#pragma once

#include <array>
#include <cstdlib>
#include <exception>
#include <new>
#include <string>
#include <vector>

#include "mesh/cgal.h"

extern "C" {
dem_status dem_fail(dem_error *error, dem_status code, const char *format, ...);
dem_status dem_fail_memory(dem_error *error);
}

namespace shim {

using Face = std::array<std::size_t, 3>;

/// Runs `work`; whatever it throws becomes a status.
template <class Work> dem_status guarded(const char *what, dem_error *error, Work work) noexcept
{
    try {
        return work();
    } catch (const std::bad_alloc &) {
        return dem_fail_memory(error);
    } catch (const std::exception &e) {
        std::string text = e.what();
        for (char &c : text)
            c = c == '\n' ? ' ' : c;
        return dem_fail(error, DEM_FAILED, "%s failed inside CGAL (%.150s); simplify or repair the mesh first", what,
                        text.c_str());
    } catch (...) {
        return dem_fail(error, DEM_FAILED, "%s failed inside CGAL; simplify or repair the mesh first", what);
    }
}

/// The used vertices, numbered in the order the triangles meet them, and the triangles in these numbers.
template <class Point> void read(const dem_mesh &mesh, std::vector<Point> &points, std::vector<Face> &faces)
{
    std::vector<std::size_t> number(mesh.vertex_count, SIZE_MAX);
    faces.resize(mesh.triangle_count);
    for (std::size_t i = 0; i < 3 * mesh.triangle_count; i++) {
        std::uint32_t v = mesh.triangles[i];
        if (number[v] == SIZE_MAX) {
            number[v] = points.size();
            points.emplace_back(mesh.vertices[v].x, mesh.vertices[v].y, mesh.vertices[v].z);
        }
        faces[i / 3][i % 3] = number[v];
    }
}

/// Fills `out` from ranges of points (x(), y(), z()) and index triples.
template <class Points, class Faces>
dem_status write(const Points &points, const Faces &faces, dem_mesh *out, dem_error *error)
{
    dem_mesh mesh = {};
    mesh.vertices = static_cast<dem_vec3 *>(std::malloc((points.size() + 1) * sizeof *mesh.vertices));
    mesh.triangles = static_cast<std::uint32_t *>(std::malloc((3 * faces.size() + 1) * sizeof *mesh.triangles));
    if (!mesh.vertices || !mesh.triangles) {
        dem_mesh_free(&mesh);
        return dem_fail_memory(error);
    }
    for (const auto &p : points)
        mesh.vertices[mesh.vertex_count++] = dem_vec3{p.x(), p.y(), p.z()};
    for (const auto &f : faces) {
        for (int k = 0; k < 3; k++)
            mesh.triangles[3 * mesh.triangle_count + k] = static_cast<std::uint32_t>(f[k]);
        mesh.triangle_count++;
    }
    *out = mesh;
    return DEM_OK;
}

} // namespace shim
