#include "sim/touch.h"

static dem_vec3 centre_of(const dem_world *w, uint32_t row, uint32_t sphere, double *radius)
{
    const double *s = w->templates.spheres[sphere];
    double scale = body_scale(&w->bodies, row);
    *radius = s[3] * scale;
    return v3_add(body_position(&w->bodies, row),
                  quat_rotate(body_orientation(&w->bodies, row), v3_scale(v3(s[0], s[1], s[2]), scale)));
}

dem_touch dem_touch_of_pair(const dem_world *w, size_t at)
{
    const dem_contact_columns *c = &w->contacts.columns;
    double ra, rb;
    dem_vec3 a = centre_of(w, c->a[at], c->sphere_a[at], &ra), b = centre_of(w, c->b[at], c->sphere_b[at], &rb);
    dem_vec3 shift = v3(0, 0, 0);
    if (c->shift) {
        const double *s = w->shifts + 4 * (size_t)c->shift[at];
        shift = v3(s[0], s[1], s[2]);
    }
    dem_vec3 d = v3_sub(v3_add(b, shift), a), n = v3_unit(d);
    double overlap = ra + rb - v3_norm(d), least = smaller(ra, rb);
    return (dem_touch){at,
                       v3_along(a, ra - overlap / 2, n),
                       n,
                       overlap,
                       ra * rb / (ra + rb),
                       {ra, rb},
                       least * least / (ra + rb),
                       shift};
}

dem_touch dem_touch_of_wall(const dem_world *w, dem_wall_form form, size_t at)
{
    const dem_contact_columns *c = &w->wall_contacts[form].columns;
    double r;
    dem_vec3 x = centre_of(w, c->a[at], c->sphere_a[at], &r), none = v3(0, 0, 0);
    if (form == DEM_FORM_MESH) {
        dem_vec3 n = v3(c->geometry[0][at], c->geometry[1][at], c->geometry[2][at]);
        dem_vec3 arm = v3(c->geometry[4][at], c->geometry[5][at], c->geometry[6][at]);
        return (dem_touch){at, v3_add(body_position(&w->bodies, c->a[at]), arm), n, c->geometry[3][at], r, {r, 0}, r, none};
    }
    double distance = dem_wall_distance(&w->walls, c->sphere_b[at], x);
    const double *row = w->walls.rows + DEM_WALL_ROW * c->sphere_b[at];
    dem_vec3 n = v3(-row[0], -row[1], -row[2]);
    if (form == DEM_FORM_CYLINDER) {
        dem_vec3 axis = v3(row[0], row[1], row[2]), from = v3_sub(x, v3(row[4], row[5], row[6]));
        n = v3_scale(v3_unit(v3_along(from, -v3_dot(from, axis), axis)), row[3] < 0 ? -1 : 1);
    }
    return (dem_touch){at, v3_along(x, distance, n), n, r - distance, r, {r, 0}, r, none};
}
