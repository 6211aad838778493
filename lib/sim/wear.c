#include "sim/wear.h"

#include "base/status.h"
#include "sim/contacts.h"

double dem_wear_finnie(const dem_wear_def *law, double mass, double speed, double angle)
{
    double s = sin(angle), c = cos(angle), k = law->constant;
    double whole = law->roughness * mass * speed * speed / (law->pressure * law->psi);
    if (!(s > 0))
        return 0;
    return s <= c * k / 6 ? whole / k * (2 * s * c - 6 / k * s * s) : whole * c * c / 6;
}

// velocity of a body's surface over the wall's, at a point of space
static dem_vec3 sliding(const dem_world *w, uint32_t row, uint32_t wall, dem_vec3 point)
{
    const double *m = body_pose(&w->bodies, row) + 8, *s = w->walls.rows + DEM_WALL_ROW * wall + 8;
    dem_vec3 arm = v3_sub(point, body_position(&w->bodies, row));
    dem_vec3 body = v3_add(v3(m[0], m[1], m[2]), v3_cross(v3(m[3], m[4], m[5]), arm));
    return v3_sub(body, v3_add(v3(s[0], s[1], s[2]), v3_cross(v3(s[3], s[4], s[5]), point)));
}

static void note(dem_world *w, size_t segment, uint32_t wall, uint32_t triangle, double volume)
{
    dem_wear_events *e = &w->wear_events[segment];
    if (!(volume > 0))
        return;
    if (!dem_grow(&e->items, &e->capacity, e->count, sizeof *e->items))
        e->failed = true;
    else
        e->items[e->count++] = (dem_wear_event){wall, triangle, volume};
}

void dem_wear_strike(dem_world *w, size_t segment, uint32_t row, uint32_t wall, const dem_mesh_contact *contact)
{
    const dem_wall *about = &w->walls.items[wall];
    dem_vec3 v = sliding(w, row, wall, wall_to_space(about, contact->point));
    double speed = v3_norm(v), into = -v3_dot(v, wall_turn(about, contact->normal));
    if (!(speed > 0))
        return;
    double angle = asin(larger(smaller(into / speed, 1), -1)), mass = w->bodies.inertia[DEM_ROW * row + 5];
    note(w, segment, wall, contact->triangle, dem_wear_finnie(&about->wear, mass, speed, angle));
}

static void rub(dem_world *w, size_t segment, const dem_mesh_touches *t, const dem_mesh_touch *touch, double kick)
{
    const dem_contact_columns *c = &w->wall_contacts[DEM_FORM_MESH].columns;
    const dem_segment *s = &w->wall_contacts[DEM_FORM_MESH].segments[segment];
    const dem_wall *wall = &w->walls.items[touch->wall];
    for (uint32_t k = 0; k < touch->last_count; k++) {
        size_t at = segment_place(s, touch->slot + k);
        const dem_mesh_contact *contact = &t->last[touch->slot + k];
        dem_vec3 n = wall_turn(wall, contact->normal);
        dem_vec3 v = sliding(w, touch->a, touch->wall, wall_to_space(wall, contact->point));
        double normal = v3_dot(n, v3(c->reaction[0][at], c->reaction[1][at], c->reaction[2][at]));
        double path = kick * v3_norm(v3_along(v, -v3_dot(v, n), n));
        note(w, segment, touch->wall, contact->triangle, wall->wear.coefficient * normal * path / wall->wear.hardness);
    }
}

void dem_wear_rub(dem_world *w, size_t begin, size_t end, double kick)
{
    for (size_t i = begin; i < end; i++) {
        const dem_mesh_touches *t = &w->mesh_touches[i];
        for (size_t k = 0; k < t->count; k++)
            if (w->walls.items[t->items[k].wall].wear.law == DEM_WEAR_ARCHARD)
                rub(w, i, t, &t->items[k], kick);
    }
}

dem_status dem_wear_settle(dem_world *w, dem_error *error)
{
    bool failed = false;
    for (size_t i = 0; i < w->segment_count; i++) {
        dem_wear_events *e = &w->wear_events[i];
        for (size_t k = 0; k < e->count; k++) {
            const dem_wall *wall = &w->walls.items[e->items[k].wall];
            uint32_t place = wall->mesh ? wall->mesh->given[e->items[k].triangle] : 0;
            wall->worn[place] += e->items[k].volume;
        }
        failed |= e->failed;
        e->count = 0;
    }
    return failed ? dem_fail_memory(error) : DEM_OK;
}
