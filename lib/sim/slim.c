#include "sim/slim.h"

static const double PARALLEL = 1e-6;   // squared sine of edges whose product has no direction
static const double ROUNDING = 1e-12;  // of the sizes

typedef struct box {
    dem_vec3 axis[3], centre;  // the centre from that of the body
    double half[3];
} box;

static box box_of(const dem_world *w, size_t row)
{
    const dem_template *t = &w->templates.items[w->bodies.shape[row]];
    dem_quat q = body_orientation(&w->bodies, row);
    double scale = body_scale(&w->bodies, row);
    return (box){.axis = {quat_rotate(q, v3(1, 0, 0)), quat_rotate(q, v3(0, 1, 0)), quat_rotate(q, v3(0, 0, 1))},
                 .centre = v3_scale(quat_rotate(q, t->box_centre), scale),
                 .half = {t->box_half.x * scale, t->box_half.y * scale, t->box_half.z * scale}};
}

bool dem_slim_apart(const dem_world *w, size_t row_a, size_t row_b, dem_vec3 offset, double least)
{
    box a = box_of(w, row_a), b = box_of(w, row_b);
    dem_vec3 d = v3_add(offset, v3_sub(b.centre, a.centre));
    double along_a[3], along_b[3], r[3][3], size[3][3];  // r: cosines of the axes of a with those of b
    least += ROUNDING * (w->bodies.radius[row_a] + w->bodies.radius[row_b] + v3_norm(d));
    for (int i = 0; i < 3; i++) {
        along_a[i] = v3_dot(d, a.axis[i]);
        along_b[i] = v3_dot(d, b.axis[i]);
        for (int j = 0; j < 3; j++) {
            r[i][j] = v3_dot(a.axis[i], b.axis[j]);
            size[i][j] = fabs(r[i][j]);
        }
    }
    for (int i = 0; i < 3; i++) {
        double of_b = b.half[0] * size[i][0] + b.half[1] * size[i][1] + b.half[2] * size[i][2];
        double of_a = a.half[0] * size[0][i] + a.half[1] * size[1][i] + a.half[2] * size[2][i];
        if (fabs(along_a[i]) - a.half[i] - of_b > least || fabs(along_b[i]) - b.half[i] - of_a > least)
            return true;
    }
    // along the product of edge i of a and edge j of b, which is as long as the sine between them
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            int i1 = (i + 1) % 3, i2 = (i + 2) % 3, j1 = (j + 1) % 3, j2 = (j + 2) % 3;
            double sine2 = 1 - r[i][j] * r[i][j];
            if (sine2 < PARALLEL)
                continue;
            double gap = fabs(along_a[i2] * r[i1][j] - along_a[i1] * r[i2][j]) - a.half[i1] * size[i2][j] -
                         a.half[i2] * size[i1][j] - b.half[j1] * size[i][j2] - b.half[j2] * size[i][j1];
            if (gap > 0 && gap * gap > least * least * sine2)
                return true;
        }
    return false;
}
