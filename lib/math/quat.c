#include "math/quat.h"

// the largest of the four components first, so no division by a small number (Shepperd 1978)
dem_quat dem_quat_from_axes(dem_vec3 a, dem_vec3 b, dem_vec3 c)
{
    double trace = a.x + b.y + c.z;
    dem_quat q;
    if (trace >= a.x && trace >= b.y && trace >= c.z)
        q = (dem_quat){1 + trace, b.z - c.y, c.x - a.z, a.y - b.x};
    else if (a.x >= b.y && a.x >= c.z)
        q = (dem_quat){b.z - c.y, 1 + a.x - b.y - c.z, a.y + b.x, c.x + a.z};
    else if (b.y >= c.z)
        q = (dem_quat){c.x - a.z, a.y + b.x, 1 + b.y - a.x - c.z, b.z + c.y};
    else
        q = (dem_quat){a.y - b.x, c.x + a.z, b.z + c.y, 1 + c.z - a.x - b.y};
    if (q.w < 0)
        q = (dem_quat){-q.w, -q.x, -q.y, -q.z};
    return quat_unit(q);
}
