// A determinant in plain double with a bound of its error first; where the sign stays open, exactly, in sums of
// doubles that do not overlap ("expansions", Shewchuk 1997).
#include "math/orient.h"

enum { MAX_TERMS = 192 };  // 3 (products of 2, 2 and 2 terms, 8 for each of two)

typedef struct expansion {
    int count;
    double term[MAX_TERMS];  // increasing magnitude
} expansion;

static double two_sum(double a, double b, double *rest)
{
    double sum = a + b, bb = sum - a;
    *rest = (a - (sum - bb)) + (b - bb);
    return sum;
}

static double two_product(double a, double b, double *rest)
{
    double product = a * b;
    *rest = fma(a, b, -product);
    return product;
}

static void add_term(expansion *e, double b)
{
    int kept = 0;
    for (int i = 0; i < e->count; i++) {
        double rest;
        b = two_sum(b, e->term[i], &rest);
        if (rest != 0)
            e->term[kept++] = rest;
    }
    if (b != 0)
        e->term[kept++] = b;
    e->count = kept;
}

// e += x y z for sums x, y, z of two terms each
static void add_product(expansion *e, const double x[2], const double y[2], const double z[2], double sign)
{
    for (int i = 0; i < 2; i++)
        for (int j = 0; j < 2; j++) {
            double low, high = two_product(x[i], y[j], &low);
            for (int k = 0; k < 2; k++) {
                double rest, product = two_product(high, z[k], &rest);
                add_term(e, sign * rest);
                add_term(e, sign * product);
                product = two_product(low, z[k], &rest);
                add_term(e, sign * rest);
                add_term(e, sign * product);
            }
        }
}

static int expansion_sign(const expansion *e)
{
    if (e->count == 0)
        return 0;
    return e->term[e->count - 1] > 0 ? 1 : -1;
}

static void difference(dem_vec3 a, dem_vec3 b, double out[3][2])
{
    out[0][0] = two_sum(a.x, -b.x, &out[0][1]);
    out[1][0] = two_sum(a.y, -b.y, &out[1][1]);
    out[2][0] = two_sum(a.z, -b.z, &out[2][1]);
}

static int orient3_exact(dem_vec3 a, dem_vec3 b, dem_vec3 c, dem_vec3 d)
{
    double p[3][2], q[3][2], r[3][2];
    difference(a, d, p);
    difference(b, d, q);
    difference(c, d, r);
    expansion e = {0};
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3, k = (i + 2) % 3;
        add_product(&e, p[i], q[j], r[k], 1);
        add_product(&e, p[i], q[k], r[j], -1);
    }
    return expansion_sign(&e);
}

int dem_orient3(dem_vec3 a, dem_vec3 b, dem_vec3 c, dem_vec3 d)
{
    dem_vec3 p = v3_sub(a, d), q = v3_sub(b, d), r = v3_sub(c, d);
    double yz = q.y * r.z, zy = q.z * r.y, zx = q.z * r.x, xz = q.x * r.z, xy = q.x * r.y, yx = q.y * r.x;
    double det = p.x * (yz - zy) + p.y * (zx - xz) + p.z * (xy - yx);
    double size = fabs(p.x) * (fabs(yz) + fabs(zy)) + fabs(p.y) * (fabs(zx) + fabs(xz)) + fabs(p.z) * (fabs(xy) + fabs(yx));
    double bound = (7 + 56 * 0x1p-53) * 0x1p-53 * size;
    if (det > bound)
        return 1;
    if (det < -bound)
        return -1;
    return size > 0 ? orient3_exact(a, b, c, d) : 0;
}

int dem_orient2(dem_vec3 a, dem_vec3 b, dem_vec3 c, int axis)
{
    int i = (axis + 1) % 3, j = (axis + 2) % 3;
    double left = (v3_get(a, i) - v3_get(c, i)) * (v3_get(b, j) - v3_get(c, j));
    double right = (v3_get(a, j) - v3_get(c, j)) * (v3_get(b, i) - v3_get(c, i));
    double det = left - right, bound = (3 + 16 * 0x1p-53) * 0x1p-53 * (fabs(left) + fabs(right));
    if (det > bound)
        return 1;
    if (det < -bound)
        return -1;
    const double one[2] = {1, 0};
    double p[3][2], q[3][2];
    difference(a, c, p);
    difference(b, c, q);
    expansion e = {0};
    add_product(&e, p[i], q[j], one, 1);
    add_product(&e, p[j], q[i], one, -1);
    return expansion_sign(&e);
}
