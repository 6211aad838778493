#include "geom/spread.h"

static double triangle_area2(const dem_tree *tree, size_t place, dem_vec3 p[3], dem_vec3 *normal)
{
    for (size_t k = 0; k < 3; k++)
        p[k] = tree->vertices[tree->triangles[3 * (size_t)tree->order[place] + k]];
    *normal = v3_cross(v3_sub(p[1], p[0]), v3_sub(p[2], p[0]));
    return v3_norm(*normal);
}

// at equal steps of the area summed in the order of the tree
double dem_tree_spread(const dem_tree *tree, dem_surface_point *points, size_t *count)
{
    double total = 0, passed = 0;
    dem_vec3 p[3], n;
    for (size_t i = 0; i < tree->count; i++)
        total += triangle_area2(tree, i, p, &n);
    size_t made = 0;
    for (size_t i = 0; i < tree->count && made < *count; i++) {
        passed += triangle_area2(tree, i, p, &n);
        for (; made < *count && ((double)made + 0.5) / (double)*count * total < passed; made++) {
            // the R2 sequence (Roberts 2018), folded into the triangle
            double k = (double)made + 0.5, u = k * 0.7548776662466927, v = k * 0.5698402909980532;
            u -= floor(u);
            v -= floor(v);
            if (u + v > 1) {
                u = 1 - u;
                v = 1 - v;
            }
            dem_vec3 at = v3_along(v3_along(p[0], u, v3_sub(p[1], p[0])), v, v3_sub(p[2], p[0]));
            points[made] = (dem_surface_point){at, v3_unit(n), (uint32_t)i};
        }
    }
    *count = made;
    return made ? total / 2 / (double)made : 0;
}
