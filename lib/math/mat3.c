#include "math/mat3.h"

#include "math/quat.h"

enum { MAX_SWEEPS = 50 };

// one Jacobi rotation in the plane (p, q) that zeroes a[p][q]
static void jacobi_rotate(double a[3][3], double v[3][3], int p, int q)
{
    if (a[p][q] == 0)
        return;
    double theta = (a[q][q] - a[p][p]) / (2 * a[p][q]);
    double t = isfinite(theta * theta) ? copysign(1, theta) / (fabs(theta) + sqrt(theta * theta + 1)) : 0.5 / theta;
    double c = 1 / sqrt(t * t + 1), s = t * c;
    for (int k = 0; k < 3; k++) {
        double x = a[k][p], y = a[k][q];
        a[k][p] = c * x - s * y;
        a[k][q] = s * x + c * y;
    }
    for (int k = 0; k < 3; k++) {
        double x = a[p][k], y = a[q][k];
        a[p][k] = c * x - s * y;
        a[q][k] = s * x + c * y;
        x = v[k][p], y = v[k][q];
        v[k][p] = c * x - s * y;
        v[k][q] = s * x + c * y;
    }
    a[p][q] = a[q][p] = 0;
}

void dem_sym3_eigen(dem_sym3 m, double values[3], dem_vec3 vectors[3])
{
    double a[3][3] = {{m.xx, m.xy, m.xz}, {m.xy, m.yy, m.yz}, {m.xz, m.yz, m.zz}};
    double v[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    double size = fabs(m.xx) + fabs(m.yy) + fabs(m.zz);
    for (int sweep = 0; sweep < MAX_SWEEPS; sweep++) {
        double off = fabs(a[0][1]) + fabs(a[0][2]) + fabs(a[1][2]);
        if (!(off > 1e-18 * size))
            break;
        jacobi_rotate(a, v, 0, 1);
        jacobi_rotate(a, v, 0, 2);
        jacobi_rotate(a, v, 1, 2);
    }
    int order[3] = {0, 1, 2};
    for (int i = 0; i < 2; i++)
        for (int j = 0; j < 2 - i; j++)
            if (a[order[j]][order[j]] > a[order[j + 1]][order[j + 1]]) {
                int swap = order[j];
                order[j] = order[j + 1];
                order[j + 1] = swap;
            }
    for (int i = 0; i < 3; i++) {
        int k = order[i];
        values[i] = a[k][k];
        vectors[i] = v3(v[0][k], v[1][k], v[2][k]);
    }
    // a fixed sign (largest component positive) for the first two, the third completes a right-handed frame
    for (int i = 0; i < 2; i++) {
        dem_vec3 u = vectors[i];
        double largest = fabs(u.x) >= fabs(u.y) && fabs(u.x) >= fabs(u.z) ? u.x : fabs(u.y) >= fabs(u.z) ? u.y : u.z;
        if (largest < 0)
            vectors[i] = v3_scale(u, -1);
    }
    vectors[2] = v3_unit(v3_cross(vectors[0], vectors[1]));
}

dem_solid dem_solid_from_moments(dem_moments m, dem_vec3 origin, double area)
{
    dem_solid solid = {.volume = m.volume, .area = area};
    dem_vec3 c = v3_scale(m.first, 1 / m.volume);
    dem_sym3 s = sym3_add(m.second, sym3_scale(sym3_outer(c), -m.volume));
    double trace = s.xx + s.yy + s.zz;
    solid.centre = v3_add(c, origin);
    solid.inertia = (dem_sym3){trace - s.xx, trace - s.yy, trace - s.zz, -s.xy, -s.xz, -s.yz};
    dem_vec3 axes[3];
    dem_sym3_eigen(solid.inertia, solid.principal, axes);
    solid.axes = dem_quat_from_axes(axes[0], axes[1], axes[2]);
    return solid;
}
