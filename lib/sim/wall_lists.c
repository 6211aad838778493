// Bodies are looked at one by one, but lists are rebuilt by segment: where a body's items change, it is looked at again
// for the new list, and the items of bodies that were not looked at are taken over.
#include "sim/wall_lists.h"

#include <stdlib.h>
#include <string.h>

#include "base/status.h"
#include "sim/mesh_touch.h"
#include "sim/refresh.h"

static const double WALL_STRIDES = 2;  // a wall's margin lasts longer than that of pairs: its list is cheap

// a segment's new list of one form
typedef struct new_list {
    size_t segment;
    dem_wall_form form;
    size_t begin, count;  // in the items
    dem_mesh_touches touches;
} new_list;

typedef struct wall_look {
    dem_world *w;
    dem_contact_item *items;
    size_t count, capacity;
    new_list *lists;
    size_t list_count, list_capacity;
    bool failed;
} wall_look;

static void add_item(wall_look *look, const dem_contact_item *item)
{
    if (!dem_grow(&look->items, &look->capacity, look->count, sizeof *item))
        look->failed = true;
    else
        look->items[look->count++] = *item;
}

static dem_contact_item wall_item(const dem_world *w, size_t row, uint32_t sphere, uint32_t wall)
{
    uint32_t material = w->templates.items[w->bodies.shape[row]].material;
    return (dem_contact_item){.a = (uint32_t)row,
                              .sphere_a = sphere,
                              .sphere_b = wall,
                              .law = w->laws.table[material * w->laws.material_count + w->walls.items[wall].material]};
}

// those of one part that are nearer than the margin; lowers `slack`
static void look_at_part(wall_look *look, size_t row, uint32_t wall, double margin, uint32_t part, double *slack)
{
    const dem_world *w = look->w;
    const dem_template *shape = &w->templates.items[w->bodies.shape[row]];
    dem_vec3 x = body_position(&w->bodies, row);
    dem_quat q = body_orientation(&w->bodies, row);
    double scale = body_scale(&w->bodies, row);
    bool plane = w->walls.items[wall].form == DEM_FORM_PLANE;
    double level = plane ? dem_wall_distance(&w->walls, wall, x) : 0;
    const double *n = w->walls.rows + DEM_WALL_ROW * wall;
    dem_vec3 rise = plane ? v3_scale(quat_unrotate(q, v3(n[0], n[1], n[2])), scale) : v3(0, 0, 0);
    for (uint32_t i = shape->first; i < shape->first + shape->count; i++) {
        if (soft_part(&w->soft, i) != part)
            continue;
        const double *s = w->templates.spheres[i];
        dem_vec3 own = v3(s[0], s[1], s[2]);
        if (!plane)
            level = dem_wall_distance(&w->walls, wall, v3_add(x, quat_rotate(q, v3_scale(own, scale))));
        double gap = level + v3_dot(rise, own) - s[3] * scale;
        if (gap < margin) {
            dem_contact_item item = wall_item(w, row, i, wall);
            add_item(look, &item);
            gap = margin;
        }
        *slack = smaller(*slack, gap);
    }
}

// the spheres of the body that are nearer to a plane or cylinder than the margin, part by part; returns the slack
static double look_at_smooth(wall_look *look, size_t row, uint32_t wall, double margin)
{
    const dem_world *w = look->w;
    uint32_t parts = w->soft.parts ? w->soft.parts[w->bodies.shape[row]] : 1;
    double apart = dem_wall_distance(&w->walls, wall, body_position(&w->bodies, row)) - w->bodies.radius[row];
    double slack = INFINITY;
    if (apart > margin)
        return apart;
    for (uint32_t part = 0; part < parts; part++)
        look_at_part(look, row, wall, margin, part, &slack);
    return slack;
}

// a slot for each contact that a ball may have at once
static double look_at_mesh(wall_look *look, size_t row, uint32_t wall, double margin, size_t begin,
                           dem_mesh_touches *touches)
{
    double slack = 0;
    size_t before = touches->count;
    look->failed |= !dem_mesh_touch_search(look->w, row, wall, margin, touches, &slack);
    for (size_t i = before; !look->failed && i < touches->count; i++) {
        dem_mesh_touch *t = &touches->items[i];
        t->slot = (uint32_t)(look->count - begin);
        dem_contact_item item = wall_item(look->w, row, t->sphere, wall);
        for (uint32_t k = 0; k < t->slot_count; k++)
            add_item(look, &item);
    }
    return slack;
}

// the springs of a body's old items, [k, end) of the old list; both are sorted by wall, then sphere, and a ball's slots
// at one mesh follow each other
static void take_springs(const dem_contacts *contacts, const dem_segment *s, size_t k, size_t end,
                         dem_contact_item *items, size_t count)
{
    const dem_contact_columns *c = &contacts->columns;
    for (size_t i = 0; i < count; i++) {
        dem_contact_item *item = &items[i];
        size_t at = 0;
        for (; k < end; k++) {
            at = segment_place(s, k);
            if (c->sphere_b[at] > item->sphere_b ||
                (c->sphere_b[at] == item->sphere_b && c->sphere_a[at] >= item->sphere_a))
                break;
        }
        if (k == end || c->sphere_a[at] != item->sphere_a || c->sphere_b[at] != item->sphere_b)
            continue;
        item->history = dem_history_get(c, at);
        item->old = (uint32_t)(at - s->begin) + 1;
        k++;
    }
}

static bool comes_before(const dem_soft *soft, uint32_t wall, uint32_t sphere, const dem_contact_item *item)
{
    if (wall != item->sphere_b)
        return wall < item->sphere_b;
    return soft_part(soft, sphere) < soft_part(soft, item->sphere_a);
}

// what the first one of each part at each wall remembers stands for all
static void take_soft_springs(const dem_soft *soft, const dem_contacts *contacts, const dem_segment *s, size_t k,
                              size_t end, dem_contact_item *items, size_t count)
{
    const dem_contact_columns *c = &contacts->columns;
    for (size_t i = 0; i < count; i++) {
        if (i > 0 && !comes_before(soft, items[i - 1].sphere_b, items[i - 1].sphere_a, &items[i]))
            continue;
        size_t at = 0;
        for (; k < end; k++) {
            at = segment_place(s, k);
            if (!comes_before(soft, c->sphere_b[at], c->sphere_a[at], &items[i]))
                break;
        }
        if (k < end && c->sphere_b[at] == items[i].sphere_b &&
            soft_part(soft, c->sphere_a[at]) == soft_part(soft, items[i].sphere_a)) {
            items[i].history = dem_history_get(c, at);
            items[i].old = (uint32_t)(at - s->begin) + 1;
        }
    }
}

static bool expired(const dem_world *w, size_t row)
{
    return !(w->bodies.path[row] + w->wall_path <= w->bodies.wall_limit[row]);
}

// all items of one body in one form, anew; lowers `slack`
static void look_at_body(wall_look *look, size_t row, new_list *list, double *slack)
{
    dem_world *w = look->w;
    if (body_absent(&w->bodies, row) || hold_whole(body_hold(&w->bodies, row)))
        return;
    double strides = WALL_STRIDES * (body_stride(&w->bodies, row, w->next_step) + w->sweep_speed * w->next_step);
    double margin = dem_refresh_margin(w, row, row, strides) + w->ahead;
    for (uint32_t i = 0; i < w->walls.count; i++) {
        if (w->walls.items[i].form != list->form)
            continue;
        double room = list->form == DEM_FORM_MESH ? look_at_mesh(look, row, i, margin, list->begin, &list->touches)
                                                  : look_at_smooth(look, row, i, margin);
        *slack = smaller(*slack, room - w->ahead);
    }
}

// the touches of a body that was not looked at move with its items
static void keep_touches(wall_look *look, size_t row, size_t old_begin, size_t begin, new_list *list)
{
    const dem_mesh_touches *old = &look->w->mesh_touches[list->segment];
    for (size_t i = 0; i < old->count; i++)
        if (old->items[i].a == row) {
            uint32_t slot = (uint32_t)(old->items[i].slot - old_begin + begin);
            look->failed |= !dem_mesh_touch_copy(old, &old->items[i], slot, &list->touches);
        }
}

static bool same_items(const dem_contacts *contacts, const dem_segment *s, size_t begin, const dem_contact_item *items,
                       size_t count)
{
    for (size_t k = 0; k < count; k++) {
        size_t at = segment_place(s, begin + k);
        if (contacts->columns.sphere_a[at] != items[k].sphere_a || contacts->columns.sphere_b[at] != items[k].sphere_b)
            return false;
    }
    return true;
}

// whether all of the bodies that are looked at keep their items, so that the list stays as it is
static bool nothing_new(wall_look *look, size_t segment, dem_wall_form form, const bool *looked, double *slack)
{
    dem_world *w = look->w;
    const dem_contacts *contacts = &w->wall_contacts[form];
    const dem_segment *s = &contacts->segments[segment];
    size_t row = segment * DEM_SEGMENT, k = 0, size = s->end - s->begin, begin = look->count;
    new_list none = {.segment = segment, .form = form, .begin = begin};
    bool same = form != DEM_FORM_MESH;
    for (size_t i = 0; same && i < DEM_SEGMENT; i++, row++) {
        if (!looked[i])
            continue;
        look_at_body(look, row, &none, &slack[i]);
        while (k < size && contacts->columns.a[segment_place(s, k)] < row)
            k++;
        size_t end = k;
        while (end < size && contacts->columns.a[segment_place(s, end)] == row)
            end++;
        same = !look->failed && look->count - begin == end - k;
        same = same && (end == k || same_items(contacts, s, k, look->items + begin, end - k));
        look->count = begin;
        k = end;
    }
    return same;
}

static void look_at_form(wall_look *look, size_t segment, dem_wall_form form, const bool *looked, double *slack)
{
    dem_world *w = look->w;
    const dem_contacts *contacts = &w->wall_contacts[form];
    const dem_segment *s = &contacts->segments[segment];
    size_t rows = segment * DEM_SEGMENT, end = rows + DEM_SEGMENT, old = 0, size = s->end - s->begin;
    end = end < w->bodies.count ? end : w->bodies.count;
    if (nothing_new(look, segment, form, looked, slack))
        return;
    new_list list = {.segment = segment, .form = form, .begin = look->count};
    for (size_t row = rows; row < end && !look->failed; row++) {
        size_t from = old, begin = look->count;
        while (old < size && contacts->columns.a[segment_place(s, old)] == row)
            old++;
        if (looked[row - rows]) {
            size_t touches = list.touches.count;
            look_at_body(look, row, &list, &slack[row - rows]);
            if (look->count > begin && w->features.soft && form != DEM_FORM_MESH)
                take_soft_springs(&w->soft, contacts, s, from, old, look->items + begin, look->count - begin);
            else if (look->count > begin)
                take_springs(contacts, s, from, old, look->items + begin, look->count - begin);
            if (form == DEM_FORM_MESH && !look->failed)
                look->failed |= !dem_mesh_touch_remember(&w->mesh_touches[segment], &list.touches, touches);
        } else {
            for (size_t k = from; k < old; k++) {
                size_t at = segment_place(s, k);
                dem_contact_item item = dem_contact_get(&contacts->columns, at);
                item.old = (uint32_t)(at - s->begin) + 1;
                add_item(look, &item);
            }
            if (form == DEM_FORM_MESH)
                keep_touches(look, row, from, begin - list.begin, &list);
        }
    }
    list.count = look->count - list.begin;
    if (dem_grow(&look->lists, &look->list_capacity, look->list_count, sizeof list))
        look->lists[look->list_count++] = list;
    else
        look->failed = true;
}

static void look_at_segment(wall_look *look, size_t segment, const bool *looked)
{
    dem_world *w = look->w;
    double slack[DEM_SEGMENT];
    for (int i = 0; i < DEM_SEGMENT; i++)
        slack[i] = INFINITY;
    for (int form = 0; form < DEM_WALL_FORMS; form++)
        if (w->wall_contacts[form].segments)
            look_at_form(look, segment, (dem_wall_form)form, looked, slack);
    for (size_t i = 0; i < DEM_SEGMENT; i++)
        if (looked[i]) {
            size_t row = segment * DEM_SEGMENT + i;
            w->bodies.wall_limit[row] = w->bodies.path[row] + w->wall_path + slack[i];
        }
}

// In whole blocks, of meshes in a multiple of the places of a ball: its first place is then always in one of the same
// blocks, its second in one of the next, and most of those that are not first are idle as a whole.
static size_t padded(const dem_world *w, dem_wall_form form, size_t count)
{
    size_t together = DEM_BLOCK_LANES * (form == DEM_FORM_MESH ? w->walls.slots : 1);
    return (count + together - 1) / together * together;
}

static bool put_lists(wall_look *look, dem_wall_form form, size_t *needed)
{
    dem_world *w = look->w;
    dem_contacts *contacts = &w->wall_contacts[form];
    for (size_t i = 0; i < look->list_count; i++)
        if (look->lists[i].form == form) {
            needed[look->lists[i].segment] = padded(w, form, look->lists[i].count);
            contacts->segments[look->lists[i].segment].dirty = true;
        }
    if (!dem_contacts_reserve(w, contacts, (int)form, needed))
        return false;
    dem_contact_item idle = dem_contact_idle(w, (int)form);
    dem_contact_extras extras = dem_extras_of(&contacts->columns);
    dem_extras_kept kept = {0};
    bool good = true;
    for (size_t i = 0; good && i < look->list_count; i++) {
        new_list *list = &look->lists[i];
        if (list->form != form)
            continue;
        dem_segment *s = &contacts->segments[list->segment];
        const dem_contact_item *items = list->count ? look->items + list->begin : NULL;
        good = dem_extras_keep(&extras, s, items, list->count, &kept);
        size_t full = padded(w, form, list->count);
        segment_set_end(s, full, w->features.soft);
        s->dirty = false;
        for (size_t k = 0; k < full; k++)
            dem_contact_put(&contacts->columns, segment_place(s, k),
                            k < list->count ? &items[k] : &idle);
        if (good)
            dem_extras_give(&extras, s, list->count, full, &kept);
        if (form == DEM_FORM_MESH) {
            dem_mesh_touches_release(&w->mesh_touches[list->segment]);
            w->mesh_touches[list->segment] = list->touches;
            list->touches = (dem_mesh_touches){0};
        }
    }
    free(kept.numbers);
    return good;
}

dem_status dem_wall_refresh(dem_world *w, dem_error *error)
{
    wall_look look = {.w = w};
    for (size_t k = 0; k < w->asked_count && !look.failed;) {
        size_t segment = w->asked[k] / DEM_SEGMENT;
        bool looked[DEM_SEGMENT] = {false}, some = false;
        for (; k < w->asked_count && w->asked[k] / DEM_SEGMENT == segment; k++)
            some |= looked[w->asked[k] % DEM_SEGMENT] = expired(w, w->asked[k]);
        if (some)
            look_at_segment(&look, segment, looked);
    }
    size_t *needed = look.list_count ? dem_alloc_zero(w->segment_count, sizeof *needed) : NULL;
    bool good = !look.failed && (needed || !look.list_count);
    for (int form = 0; needed && good && form < DEM_WALL_FORMS; form++)
        if (w->wall_contacts[form].segments)
            good = put_lists(&look, (dem_wall_form)form, needed);
    for (size_t i = 0; i < look.list_count; i++)
        dem_mesh_touches_release(&look.lists[i].touches);
    free(needed);
    free(look.items);
    free(look.lists);
    return good ? DEM_OK : dem_fail_memory(error);
}
