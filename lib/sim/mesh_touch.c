#include "sim/mesh_touch.h"

#include <stdlib.h>
#include <string.h>

#include "sim/contacts.h"
#include "sim/wear.h"

static const double LOOK_AROUND = 0.5;  // of the bounding radius: how far triangles are asked for, at least
static const double CLOSE_STRIDES = 32; // steps for which the triangles that a ball may touch should be the same
static const double KEPT_SLACK = 0.999, ROUNDING = 1e-13;  // of distances; of coordinates

void dem_mesh_touches_release(dem_mesh_touches *t)
{
    free(t->items);
    free(t->near);
    free(t->triangles);
    free(t->close);
    free(t->last);
    *t = (dem_mesh_touches){0};
}

bool dem_mesh_touches_forget(dem_mesh_touches *t)
{
    free(t->near);
    free(t->close);
    t->near = dem_alloc(t->count, sizeof *t->near);
    t->close = dem_alloc(t->triangle_count, sizeof *t->close);
    t->near_capacity = t->near ? t->count : 0;
    t->close_capacity = t->close ? t->triangle_count : 0;
    for (size_t i = 0; t->near && i < t->count; i++)
        t->near[i] = (dem_mesh_near){.until = -1, .shown = t->items[i].slot_count};
    return t->near && t->close;
}

// a sphere of a body in space
static dem_ball space_ball(const dem_world *w, size_t row, size_t sphere)
{
    const double *s = w->templates.spheres[sphere];
    double scale = body_scale(&w->bodies, row);
    dem_vec3 arm = quat_rotate(body_orientation(&w->bodies, row), v3_scale(v3(s[0], s[1], s[2]), scale));
    return (dem_ball){v3_add(body_position(&w->bodies, row), arm), s[3] * scale};
}

static bool add_triangle(dem_mesh_touches *t, uint32_t triangle)
{
    if (!dem_grow(&t->triangles, &t->triangle_capacity, t->triangle_count, sizeof *t->triangles) ||
        !dem_grow(&t->close, &t->close_capacity, t->triangle_count, sizeof *t->close))
        return false;
    t->triangles[t->triangle_count++] = triangle;
    return true;
}

static bool add_touch(dem_mesh_touches *t, dem_mesh_touch touch)
{
    if (!dem_grow(&t->items, &t->capacity, t->count, sizeof *t->items) ||
        !dem_grow(&t->near, &t->near_capacity, t->count, sizeof *t->near))
        return false;
    // new places say that nothing touches
    t->near[t->count] = (dem_mesh_near){.until = -1};
    t->items[t->count++] = touch;
    return true;
}

static uint32_t slots_for(const dem_world *w, uint32_t contacts)
{
    uint32_t slots = w->walls.slots, needed = contacts < DEM_MESH_CONTACTS ? contacts : DEM_MESH_CONTACTS;
    return (needed + slots - 1) / slots * slots;
}

// one ball against the triangles about its body; lowers the slack to the nearest that is not listed
static bool search_ball(dem_world *w, size_t row, uint32_t sphere, uint32_t wall, const dem_ray_list *near,
                        double margin, dem_mesh_touches *t, double *slack)
{
    const dem_wall *about = &w->walls.items[wall];
    dem_ball ball = space_ball(w, row, sphere);
    dem_vec3 centre = wall_from_space(about, ball.centre);
    dem_mesh_touch touch = {.a = (uint32_t)row, .sphere = sphere, .wall = wall, .first = (uint32_t)t->triangle_count};
    for (size_t i = 0; i < near->count; i++) {
        if (triangle_is_beyond(&about->mesh->triangles[near->items[i]], centre, ball.radius + larger(margin, *slack)))
            continue;
        dem_closest spot = triangle_closest(&about->mesh->triangles[near->items[i]], centre);
        double gap = sqrt(spot.distance2) - ball.radius;
        if (gap < margin) {
            if (!add_triangle(t, near->items[i]))
                return false;
            gap = margin;
        }
        *slack = smaller(*slack, gap);
    }
    touch.count = (uint32_t)(t->triangle_count - touch.first);
    touch.slot_count = slots_for(w, touch.count);
    return touch.count == 0 || add_touch(t, touch);
}

// the same at a smooth surface, which has no triangles
static bool search_surface(dem_world *w, size_t row, uint32_t wall, double margin, dem_mesh_touches *t, double *slack)
{
    const dem_template *shape = &w->templates.items[w->bodies.shape[row]];
    const dem_wall *about = &w->walls.items[wall];
    dem_vec3 centre = wall_from_space(about, body_position(&w->bodies, row));
    *slack = dem_surface_distance(&about->surface, centre) - w->bodies.radius[row];
    if (*slack > margin)
        return true;
    *slack = INFINITY;
    for (uint32_t i = shape->first; i < shape->first + shape->count; i++) {
        dem_ball ball = space_ball(w, row, i);
        double gap = dem_surface_distance(&about->surface, wall_from_space(about, ball.centre)) - ball.radius;
        dem_mesh_touch touch = {.a = (uint32_t)row,
                                .sphere = i,
                                .wall = wall,
                                .first = (uint32_t)t->triangle_count,
                                .slot_count = slots_for(w, (uint32_t)dem_surface_most(&about->surface))};
        if (gap < margin && !add_touch(t, touch))
            return false;
        *slack = smaller(*slack, larger(gap, margin));
    }
    return true;
}

bool dem_mesh_touch_search(dem_world *w, size_t row, uint32_t wall, double margin, dem_mesh_touches *t, double *slack)
{
    if (!w->walls.items[wall].mesh)
        return search_surface(w, row, wall, margin, t, slack);
    const dem_template *shape = &w->templates.items[w->bodies.shape[row]];
    double radius = w->bodies.radius[row], look = larger(margin, LOOK_AROUND * radius);
    dem_vec3 centre = wall_from_space(&w->walls.items[wall], body_position(&w->bodies, row));
    dem_ray_list near = {0};
    bool good = dem_mesh_wall_near(w->walls.items[wall].mesh, centre, radius + look, &near);
    *slack = look;
    for (uint32_t i = shape->first; good && near.count && i < shape->first + shape->count; i++)
        good = search_ball(w, row, i, wall, &near, margin, t, slack);
    free(near.items);
    return good;
}

static bool reserve_last(dem_mesh_touches *t, size_t slots)
{
    if (slots <= t->last_capacity)
        return true;
    size_t capacity = slots + slots / 2;
    dem_mesh_contact *last = realloc(t->last, capacity * sizeof *last);
    if (!last)
        return false;
    memset(last + t->last_capacity, 0, (capacity - t->last_capacity) * sizeof *last);
    t->last = last;
    t->last_capacity = capacity;
    return true;
}

static bool take_last(const dem_mesh_touches *from, const dem_mesh_touch *old, dem_mesh_touches *to,
                      dem_mesh_touch *touch)
{
    touch->last_count = old->last_count < touch->slot_count ? old->last_count : touch->slot_count;
    if (!reserve_last(to, touch->slot + touch->slot_count))
        return false;
    memcpy(to->last + touch->slot, from->last + old->slot, touch->last_count * sizeof *to->last);
    return true;
}

bool dem_mesh_touch_copy(const dem_mesh_touches *from, const dem_mesh_touch *old, uint32_t slot, dem_mesh_touches *to)
{
    dem_mesh_touch touch = *old;
    touch.slot = slot;
    touch.first = (uint32_t)to->triangle_count;
    for (size_t i = old->first; i < old->first + old->count; i++)
        if (!add_triangle(to, from->triangles[i]))
            return false;
    if (!take_last(from, old, to, &touch) || !add_touch(to, touch))
        return false;
    to->near[to->count - 1] = from->near[old - from->items];
    to->near[to->count - 1].shown = 0;
    if (touch.count)
        memcpy(to->close + touch.first, from->close + old->first, touch.count * sizeof *to->close);
    return true;
}

bool dem_mesh_touch_remember(const dem_mesh_touches *old, dem_mesh_touches *t, size_t from)
{
    for (size_t i = from; i < t->count; i++) {
        dem_mesh_touch *touch = &t->items[i];
        if (!reserve_last(t, touch->slot + touch->slot_count))
            return false;
        for (size_t k = 0; k < old->count; k++) {
            const dem_mesh_touch *o = &old->items[k];
            if (o->a == touch->a && o->sphere == touch->sphere && o->wall == touch->wall &&
                !take_last(old, o, t, touch))
                return false;
        }
    }
    return true;
}

// ---- in each step

static void put_geometry(const dem_contact_columns *c, size_t at, dem_vec3 normal, double overlap, dem_vec3 arm)
{
    double g[7] = {normal.x, normal.y, normal.z, overlap, arm.x, arm.y, arm.z};
    for (int k = 0; k < 7; k++)
        c->geometry[k][at] = g[k];
}

// springs go to the slots of the contacts that continue theirs
static void hand_over(const dem_contact_columns *c, const dem_contact_extras *extras, const dem_segment *s,
                      dem_mesh_touches *t, dem_mesh_touch *touch, const dem_mesh_contact *contacts, int count, double reach)
{
    int from[DEM_MESH_CONTACTS];
    dem_contact_history old[DEM_MESH_CONTACTS], none = {0};
    dem_mesh_contacts_follow(t->last + touch->slot, (int)touch->last_count, contacts, count, reach, from);
    for (uint32_t k = 0; k < touch->slot_count; k++)
        old[k] = dem_history_get(c, segment_place(s, touch->slot + k));
    for (uint32_t k = 0; k < touch->slot_count; k++) {
        bool goes_on = (int)k < count && from[k] >= 0;
        dem_history_put(c, segment_place(s, touch->slot + k), goes_on ? &old[from[k]] : &none);
    }
    for (int e = 0; e < extras->count; e++) {
        double *column = extras->column[e], number[DEM_MESH_CONTACTS];
        for (uint32_t k = 0; k < touch->slot_count; k++)
            number[k] = column[segment_place(s, touch->slot + k)];
        for (uint32_t k = 0; k < touch->slot_count; k++)
            column[segment_place(s, touch->slot + k)] = (int)k < count && from[k] >= 0 ? number[from[k]] : 0;
    }
    for (int k = 0; k < count; k++)
        t->last[touch->slot + (uint32_t)k] = contacts[k];
    touch->last_count = (uint32_t)count;
}

// Do contacts find their springs where they are? Most do: one that has moved by less than a share of its own size.
static bool stay(const dem_mesh_touches *t, const dem_mesh_touch *touch, const dem_mesh_contact *contacts, int count,
                 double reach)
{
    const dem_mesh_contact *last = &t->last[touch->slot];
    int from[1];
    if (count != 1 || touch->last_count != 1)
        return false;
    dem_mesh_contacts_follow(last, 1, contacts, 1, reach, from);
    return from[0] == 0;
}

// what is known holds until the body or a wall has come nearer by this
static void holds_for(const dem_world *w, const dem_mesh_touch *touch, dem_mesh_near *near, dem_vec3 centre,
                      double radius, double gap)
{
    // the walls' path already has the step that is being made
    double now = w->bodies.path[touch->a] + w->wall_path - w->sweep_speed * w->next_step;
    near->until = now + KEPT_SLACK * gap - ROUNDING * (v3_norm(centre) + radius);
}

// Which of its candidates a ball may touch before it, or a wall, has gone on by some steps.
static void look_close(dem_world *w, dem_mesh_touches *t, size_t k, dem_vec3 centre, double radius)
{
    const dem_mesh_touch *touch = &t->items[k];
    double stride = body_stride(&w->bodies, touch->a, w->next_step) + w->sweep_speed * w->next_step;
    double next = dem_mesh_wall_close(w->walls.items[touch->wall].mesh, t->triangles + touch->first, touch->count, centre,
                                      radius + CLOSE_STRIDES * stride, t->close + touch->first, &t->near[k].count);
    holds_for(w, touch, &t->near[k], centre, radius, next - radius);
}

static int surface_contacts(dem_world *w, dem_mesh_touches *t, size_t k, dem_vec3 centre, double radius,
                            dem_mesh_contact *contacts)
{
    const dem_surface *surface = &w->walls.items[t->items[k].wall].surface;
    int count = dem_surface_contacts(surface, centre, radius, contacts);
    t->near[k].count = (uint32_t)count;
    if (!count)
        holds_for(w, &t->items[k], &t->near[k], centre, radius, dem_surface_distance(surface, centre) - radius);
    return count;
}

static int find_contacts(dem_world *w, dem_mesh_touches *t, size_t k, dem_vec3 centre, double radius, bool known,
                         dem_mesh_contact *contacts)
{
    const dem_mesh_touch *touch = &t->items[k];
    const dem_mesh_wall *mesh = w->walls.items[touch->wall].mesh;
    if (!mesh)
        return surface_contacts(w, t, k, centre, radius, contacts);
    if (!known)
        look_close(w, t, k, centre, radius);
    if (!t->near[k].count)
        return 0;
    return dem_mesh_wall_contacts(mesh, t->close + touch->first, t->near[k].count, centre, radius, contacts,
                                  (int)touch->slot_count);
}

static void show(const dem_world *w, const dem_segment *s, dem_mesh_touches *t, size_t k, dem_vec3 arm, double radius,
                 const dem_mesh_contact *contacts, uint32_t count)
{
    const dem_contact_columns *c = &w->wall_contacts[DEM_FORM_MESH].columns;
    const dem_mesh_touch *touch = &t->items[k];
    const dem_wall *wall = &w->walls.items[touch->wall];
    for (uint32_t i = 0; i < count; i++)
        put_geometry(c, segment_place(s, touch->slot + i), v3_scale(wall_turn(wall, contacts[i].normal), -1),
                     radius - contacts[i].distance, v3_add(arm, wall_turn(wall, contacts[i].offset)));
    for (uint32_t i = count; i < t->near[k].shown; i++)
        put_geometry(c, segment_place(s, touch->slot + i), v3(0, 0, 0), DEM_MESH_NO_OVERLAP, v3(0, 0, 0));
    t->near[k].shown = count;
}

static void measure_touch(dem_world *w, const dem_contact_extras *extras, const dem_segment *s, dem_mesh_touches *t,
                          size_t k)
{
    dem_mesh_touch *touch = &t->items[k];
    const dem_wall *wall = &w->walls.items[touch->wall];
    bool known = w->bodies.path[touch->a] + w->wall_path <= t->near[k].until;
    if (known && !t->near[k].count && !touch->last_count) {
        show(w, s, t, k, v3(0, 0, 0), 0, NULL, 0);
        return;
    }
    dem_ball ball = space_ball(w, touch->a, touch->sphere);
    dem_vec3 centre = wall_from_space(wall, ball.centre);
    double radius = ball.radius + (w->reach + w->ahead);
    dem_mesh_contact contacts[DEM_MESH_CONTACTS];
    int count = find_contacts(w, t, k, centre, radius, known, contacts);
    double overlap = count ? larger(ball.radius - contacts[0].distance, 0) : 0, close = 0.1 * sqrt(ball.radius * overlap);
    if (stay(t, touch, contacts, count, close))
        t->last[touch->slot] = contacts[0];
    else if (count || touch->last_count) {
        double moved = body_stride(&w->bodies, touch->a, w->last_step) + w->sweep_speed * w->last_step;
        hand_over(&w->wall_contacts[DEM_FORM_MESH].columns, extras, s, t, touch, contacts, count, moved + close);
    }
    show(w, s, t, k, v3_sub(ball.centre, body_position(&w->bodies, touch->a)), ball.radius, contacts, (uint32_t)count);
}

// A body's balls at one wall, from touch k on: where none touched in the last step and one does now, it has struck the
// wall. Returns the first touch behind them.
static size_t measure_body(dem_world *w, const dem_contact_extras *extras, size_t segment, size_t k)
{
    dem_mesh_touches *t = &w->mesh_touches[segment];
    const dem_segment *s = &w->wall_contacts[DEM_FORM_MESH].segments[segment];
    uint32_t row = t->items[k].a, wall = t->items[k].wall;
    const dem_mesh_contact *deepest = NULL;
    double most = 0;
    bool before = false;
    for (; k < t->count && t->items[k].a == row && t->items[k].wall == wall; k++) {
        dem_mesh_touch *touch = &t->items[k];
        double radius = w->templates.spheres[touch->sphere][3] * body_scale(&w->bodies, row);
        for (uint32_t i = 0; i < touch->last_count; i++)
            before |= t->last[touch->slot + i].distance < radius;
        measure_touch(w, extras, s, t, k);
        if (touch->last_count && radius - t->last[touch->slot].distance > most) {
            deepest = &t->last[touch->slot];
            most = radius - deepest->distance;
        }
    }
    if (deepest && !before && w->walls.items[wall].wear.law == DEM_WEAR_FINNIE)
        dem_wear_strike(w, segment, row, wall, deepest);
    return k;
}

void dem_mesh_touch_measure(dem_world *w, size_t begin, size_t end)
{
    dem_contact_extras extras = dem_extras_of(&w->wall_contacts[DEM_FORM_MESH].columns);
    for (size_t i = begin; i < end; i++) {
        dem_mesh_touches *t = &w->mesh_touches[i];
        for (size_t k = 0; k < t->count && w->walls.wear;)
            k = measure_body(w, &extras, i, k);
        for (size_t k = 0; k < t->count && !w->walls.wear; k++)
            measure_touch(w, &extras, &w->wall_contacts[DEM_FORM_MESH].segments[i], t, k);
    }
}

dem_status dem_mesh_touch_measure_all(dem_world *w, dem_error *error)
{
    if (w->mesh_touches)
        dem_mesh_touch_measure(w, 0, w->segment_count);
    return w->walls.wear ? dem_wear_settle(w, error) : DEM_OK;
}
