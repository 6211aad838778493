#include "sim/surface.h"

dem_surface dem_surface_of(const dem_wall_def *wall)
{
    dem_surface s = {.point = wall->point, .axis = v3_unit(wall->normal), .begin = wall->radius};
    switch (wall->kind) {
    case DEM_WALL_CONE:
        s.kind = DEM_SURFACE_TURNED;
        s.endless = isinf(wall->length);
        s.run[0] = s.endless ? sin(wall->angle) : wall->end_radius - wall->radius;
        s.run[1] = s.endless ? cos(wall->angle) : wall->length;
        s.side = !s.endless ? 0 : wall->outside ? -1 : 1;
        break;
    case DEM_WALL_DISC:
        s.kind = DEM_SURFACE_TURNED;
        s.begin = 0;
        s.run[0] = wall->radius;
        break;
    case DEM_WALL_SPHERE:
        s.kind = DEM_SURFACE_SPHERE;
        s.side = wall->outside ? -1 : 1;
        break;
    case DEM_WALL_RECTANGLE:
        s.kind = DEM_SURFACE_RECTANGLE;
        s.along = v3_unit(v3_along(wall->along, -v3_dot(wall->along, s.axis), s.axis));
        s.half[0] = wall->size[0] / 2;
        s.half[1] = wall->size[1] / 2;
        break;
    default:
        s.kind = DEM_SURFACE_NONE;
    }
    return s;
}

int dem_surface_most(const dem_surface *s)
{
    bool disc = s->begin == 0 && s->run[1] == 0;
    return s->kind == DEM_SURFACE_TURNED && !disc ? 2 : 1;
}

// a closest point: `to` from the centre to it, `inward`: where the bodies are if it is at the centre
static dem_mesh_contact contact_of(dem_vec3 centre, dem_vec3 to, dem_vec3 inward, double sign)
{
    double distance = v3_norm(to);
    dem_vec3 normal = distance > 0 ? v3_scale(to, -sign / distance) : inward;
    return (dem_mesh_contact){0, DEM_ON_FACE, v3_add(centre, to), to, normal, sign * distance};
}

// the near piece of the meridian, or that across the axis
static dem_mesh_contact on_meridian(const dem_surface *s, dem_vec3 centre, dem_vec3 out, double r, double h)
{
    double length2 = s->run[0] * s->run[0] + s->run[1] * s->run[1];
    double t = ((r - s->begin) * s->run[0] + h * s->run[1]) / length2;
    t = larger(t, 0);
    if (!s->endless)
        t = smaller(t, 1);
    double to[2] = {s->begin + t * s->run[0] - r, t * s->run[1] - h}, length = sqrt(length2);
    double inward[2] = {-s->run[1] / length, s->run[0] / length};
    // what is beyond the tip of an endless cone is outside
    bool inside = t > 0 && -(to[0] * inward[0] + to[1] * inward[1]) > 0;
    double sign = s->side == 0 || (s->side > 0) == inside ? 1 : -1, side = s->side < 0 ? -1 : 1;
    return contact_of(centre, v3_along(v3_scale(out, to[0]), to[1], s->axis),
                      v3_scale(v3_along(v3_scale(out, inward[0]), inward[1], s->axis), side), sign);
}

static int turned_contacts(const dem_surface *s, dem_vec3 centre, double radius, dem_mesh_contact *contacts)
{
    dem_vec3 from = v3_sub(centre, s->point);
    double h = v3_dot(from, s->axis);
    dem_vec3 aside = v3_along(from, -h, s->axis);
    double r = v3_norm(aside);
    dem_vec3 out = r > 0 ? v3_scale(aside, 1 / r) : v3_normal_to(s->axis);
    dem_mesh_contact near = on_meridian(s, centre, out, r, h);
    if (!(near.distance < radius))
        return 0;
    contacts[0] = near;
    // across the axis, everything is at least as far as the axis
    if (r >= radius || dem_surface_most(s) < 2 || s->side < 0 || near.distance <= 0)
        return 1;
    dem_mesh_contact far = on_meridian(s, centre, v3_scale(out, -1), -r, h);
    // the tip is one point, and what is behind the plane of the near contact is out of reach
    bool apart = v3_distance(far.point, near.point) > 1e-9 * radius;
    if (!apart || !(far.distance < radius) || -v3_dot(far.offset, near.normal) >= near.distance * (1 - 1e-9))
        return 1;
    contacts[1] = far;
    return 2;
}

static dem_mesh_contact on_sphere(const dem_surface *s, dem_vec3 centre)
{
    dem_vec3 from = v3_sub(centre, s->point), out = v3_unit(from);
    double gap = s->begin - v3_norm(from), sign = s->side * gap < 0 ? -1 : 1;
    return contact_of(centre, v3_scale(out, gap), v3_scale(out, -s->side), sign);
}

static dem_mesh_contact on_rectangle(const dem_surface *s, dem_vec3 centre)
{
    dem_vec3 across = v3_cross(s->axis, s->along), from = v3_sub(centre, s->point);
    double u = v3_dot(from, s->along), v = v3_dot(from, across);
    u = larger(smaller(u, s->half[0]), -s->half[0]);
    v = larger(smaller(v, s->half[1]), -s->half[1]);
    dem_vec3 to = v3_sub(v3_along(v3_scale(s->along, u), v, across), from);
    return contact_of(centre, to, s->axis, 1);
}

int dem_surface_contacts(const dem_surface *s, dem_vec3 centre, double radius,
                         dem_mesh_contact contacts[DEM_SURFACE_CONTACTS])
{
    if (s->kind == DEM_SURFACE_TURNED)
        return turned_contacts(s, centre, radius, contacts);
    contacts[0] = s->kind == DEM_SURFACE_SPHERE ? on_sphere(s, centre) : on_rectangle(s, centre);
    return contacts[0].distance < radius;
}

double dem_surface_distance(const dem_surface *s, dem_vec3 x)
{
    dem_mesh_contact contacts[DEM_SURFACE_CONTACTS];
    dem_surface_contacts(s, x, INFINITY, contacts);
    return contacts[0].distance;
}

bool dem_surface_turns_in_place(const dem_surface *s, dem_vec3 through, dem_vec3 axis)
{
    dem_vec3 off = v3_sub(s->point, through);
    double size = s->begin + fabs(s->run[0]) + fabs(s->run[1]);
    if (s->kind == DEM_SURFACE_SPHERE)
        return v3_norm(v3_cross(off, axis)) <= 1e-12 * s->begin;
    return s->kind == DEM_SURFACE_TURNED && v3_norm(v3_cross(s->axis, axis)) <= 1e-12 &&
           v3_norm(v3_cross(off, axis)) <= 1e-12 * size;
}

double dem_surface_area(const dem_surface *s)
{
    if (s->endless)
        return INFINITY;
    if (s->kind == DEM_SURFACE_RECTANGLE)
        return 4 * s->half[0] * s->half[1];
    if (s->kind == DEM_SURFACE_SPHERE)
        return 4 * DEM_PI * s->begin * s->begin;
    return DEM_PI * fabs(2 * s->begin + s->run[0]) * sqrt(s->run[0] * s->run[0] + s->run[1] * s->run[1]);
}

double dem_surface_shadow(const dem_surface *s, dem_vec3 direction)
{
    bool flat = s->kind == DEM_SURFACE_RECTANGLE || (s->kind == DEM_SURFACE_TURNED && !s->endless && s->run[1] == 0);
    return flat ? dem_surface_area(s) * fabs(v3_dot(s->axis, direction)) : 0;
}
