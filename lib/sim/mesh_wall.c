#include "sim/mesh_wall.h"

#include <stdlib.h>
#include <string.h>

#include "mesh/weld.h"

// ---- the wall

// coordinates whose squares and cubes are still numbers
static const double LARGEST = 1e100;  // [m]

static dem_status check_mesh(const dem_mesh *mesh, const char *name, dem_error *error)
{
    for (size_t i = 0; i < mesh->vertex_count; i++) {
        dem_vec3 v = mesh->vertices[i];
        if (!(fabs(v.x) < LARGEST && fabs(v.y) < LARGEST && fabs(v.z) < LARGEST))
            return dem_fail(error, DEM_BAD_INPUT,
                            "wall %s: vertex %zu is not finite or beyond 1e100 m; correct the mesh or its unit", name,
                            i);
    }
    for (size_t i = 0; i < 3 * mesh->triangle_count; i++)
        if (mesh->triangles[i] >= mesh->vertex_count)
            return dem_fail(error, DEM_BAD_INPUT, "wall %s: triangle %zu names vertex %u of %zu; correct the mesh",
                            name, i / 3, (unsigned)mesh->triangles[i], mesh->vertex_count);
    return DEM_OK;
}

static bool prepare(const dem_mesh *mesh, size_t triangle, dem_triangle *t)
{
    const dem_vec3 *v = mesh->vertices;
    const uint32_t *corners = &mesh->triangles[3 * triangle];
    return triangle_prepare(v[corners[0]], v[corners[1]], v[corners[2]], t);
}

static dem_status drop_degenerate(const dem_ctx *ctx, dem_mesh_wall *wall, const char *name, dem_error *error)
{
    dem_mesh *mesh = &wall->mesh;
    unsigned char *drop = dem_alloc_zero(mesh->triangle_count, 1);
    if (!drop)
        return dem_fail_memory(error);
    size_t given = mesh->triangle_count;
    dem_triangle t;
    for (size_t i = 0; i < given; i++)
        drop[i] = !prepare(mesh, i, &t);
    dem_mesh_drop(mesh, drop);
    uint32_t *kept = dem_arena_take(&wall->memory, mesh->triangle_count + 1, sizeof *kept);
    for (size_t i = 0, k = 0; kept && i < given; i++)
        if (!drop[i])
            kept[k++] = (uint32_t)i;
    wall->given = kept;
    free(drop);
    if (!kept)
        return dem_fail_memory(error);
    size_t dropped = given - mesh->triangle_count;
    if (mesh->triangle_count == 0)
        return dem_fail(error, DEM_BAD_INPUT, "wall %s: none of its %zu triangles has an area; give a mesh with faces",
                        name, given);
    if (dropped)
        dem_log(ctx, DEM_LOG_WARNING, "wall %s: %zu of %zu triangles have no area and were left out", name, dropped,
                given);
    return DEM_OK;
}

static dem_status prepare_all(dem_mesh_wall *wall, dem_error *error)
{
    size_t count = wall->mesh.triangle_count;
    dem_triangle *triangles = dem_arena_take(&wall->memory, count, sizeof *triangles);
    if (!triangles)
        return dem_fail_memory(error);
    wall->triangles = triangles;
    wall->box = box_empty();
    for (size_t i = 0; i < count; i++) {
        dem_triangle *t = &triangles[i];
        bool whole = prepare(&wall->mesh, i, t);
        DEM_ASSERT(whole);
        wall->box = box_with(box_with(box_with(wall->box, t->a), t->b), t->c);
    }
    return DEM_OK;
}

static dem_status build(const dem_ctx *ctx, const dem_mesh *mesh, const char *name, dem_mesh_wall *wall,
                        dem_error *error)
{
    size_t unused;
    DEM_TRY(check_mesh(mesh, name, error));
    DEM_TRY(dem_ray_create(&wall->rays, error));
    DEM_TRY(dem_mesh_copy(mesh, &wall->mesh, error));
    DEM_TRY(drop_degenerate(ctx, wall, name, error));
    DEM_TRY(dem_mesh_weld_equal(&wall->mesh, &unused, error));
    DEM_TRY(prepare_all(wall, error));
    wall->spots = dem_mesh_spots_choose(NULL);
    dem_vec3 middle = v3_scale(v3_add(wall->box.low, wall->box.high), 0.5);
    return dem_ray_add_mesh(wall->rays, wall->mesh.vertices, wall->mesh.vertex_count, wall->mesh.triangles,
                            wall->mesh.triangle_count, middle, 1 / box_diagonal(wall->box), error);
}

dem_status dem_mesh_wall_create(const dem_ctx *ctx, const dem_mesh *mesh, const char *name, dem_mesh_wall **wall,
                                dem_error *error)
{
    *wall = dem_alloc_zero(1, sizeof **wall);
    if (!*wall)
        return dem_fail_memory(error);
    dem_status status = build(ctx, mesh, name, *wall, error);
    if (status != DEM_OK) {
        dem_mesh_wall_destroy(*wall);
        *wall = NULL;
    }
    return status;
}

void dem_mesh_wall_destroy(dem_mesh_wall *wall)
{
    if (!wall)
        return;
    dem_ray_destroy(wall->rays);
    dem_mesh_free(&wall->mesh);
    dem_arena_release(&wall->memory);
    free(wall);
}

// ---- what is near

// Shell (1959); lists are short, and qsort may take memory
static void sort_ascending(uint32_t *items, size_t count)
{
    size_t gap = 1;
    while (gap < count / 3)
        gap = 3 * gap + 1;
    for (; gap > 0; gap /= 3)
        for (size_t i = gap; i < count; i++) {
            uint32_t item = items[i];
            size_t at = i;
            for (; at >= gap && items[at - gap] > item; at -= gap)
                items[at] = items[at - gap];
            items[at] = item;
        }
}

bool dem_mesh_wall_near(const dem_mesh_wall *wall, dem_vec3 point, double reach, dem_ray_list *list)
{
    if (!dem_ray_near(wall->rays, 0, point, reach, list))
        return false;
    // which triangles Embree adds depends on the machine; these do not
    size_t kept = 0;
    for (size_t i = 0; i < list->count; i++) {
        const dem_triangle *t = &wall->triangles[list->items[i]];
        double limit = reach * (1 + 1e-12) + 1e-14 * t->length;
        if (triangle_closest(t, point).distance2 <= limit * limit)
            list->items[kept++] = list->items[i];
    }
    list->count = kept;
    sort_ascending(list->items, list->count);
    return true;
}

void dem_mesh_wall_spots(const dem_mesh_wall *wall, const uint32_t *ids, const dem_vec3 *centres, size_t count,
                         dem_closest *spots)
{
    wall->spots->run(wall->triangles, ids, centres, count, spots);
}

// ---- contacts

// A point this much above the tangent plane of a nearer one, in radii, still counts as on it. Faces that fold inwards
// by an angle up to sqrt(2e-6) so are one face; points of one edge seen from two triangles differ by far less.
static const double FLAT = 1e-6;

// The direction from a centre to a triangle that is nearer than this many lengths of its longest edge is taken from the
// triangle's normal: rounding is left of anything else.
static const double NOISE = 1e-10;

typedef struct candidate {
    uint32_t triangle;
    dem_closest spot;
} candidate;

enum { KEPT = 128 };  // candidates within a ball that are kept; where there are more they are computed each time

// a ball and the triangles it may touch
typedef struct search {
    const dem_mesh_wall *wall;
    dem_vec3 centre;
    double radius;
    const uint32_t *ids;
    const dem_closest *spots;  // of the ids; NULL: not known
    size_t count;
    const candidate *kept;  // the candidates themselves, in place of all these; NULL: too many
} search;

static void make_candidate(const search *s, size_t k, candidate *c)
{
    c->triangle = s->ids[k];
    c->spot = s->spots ? s->spots[k] : triangle_closest(&s->wall->triangles[c->triangle], s->centre);
}

// `room` is where it may stand
static const candidate *candidate_at(const search *s, size_t k, candidate *room)
{
    if (s->kept)
        return &s->kept[k];
    make_candidate(s, k, room);
    return room;
}

// the order in which candidates are looked at
static bool is_before(const candidate *a, const candidate *b)
{
    return a->spot.distance2 < b->spot.distance2 ||
           (a->spot.distance2 == b->spot.distance2 && a->triangle < b->triangle);
}

static bool has_corner(const uint32_t *corners, uint32_t vertex)
{
    return corners[0] == vertex || corners[1] == vertex || corners[2] == vertex;
}

// do the triangle's corners include those of the edge or corner that a candidate lies on?
static bool shares_place(const uint32_t *corners, const uint32_t *own, int64_t part)
{
    bool edge = part < DEM_ON_VERTEX_A;
    int64_t first = edge ? part - DEM_ON_EDGE_AB : part - DEM_ON_VERTEX_A;
    return has_corner(corners, own[first]) && (!edge || has_corner(corners, own[(first + 1) % 3]));
}

// The same point of the surface, as far as the distances can tell? Beside an edge by less than 1e-8 of the distance,
// all triangles around are equally far.
static bool is_same_place(const search *s, const candidate *a, const candidate *b)
{
    double distance = sqrt(a->spot.distance2), length = s->wall->triangles[b->triangle].length;
    double rounding = 0x1p-50 * distance * (distance + length), close = FLAT * s->radius;
    return b->spot.distance2 - a->spot.distance2 <= rounding &&
           v3_norm2(v3_sub(a->spot.offset, b->spot.offset)) <= close * close;
}

// A point on an edge or corner is one where the ball touches only if the distance is least there for the other
// triangles that share it, too: where one of them has a nearer point, the surface goes on towards the ball. If the
// point is one, it is taken from that triangle of those at the same place that lies squarest under the ball, which is a
// face if one is there; the distance alone would leave it to rounding.
static bool settle(const search *s, candidate *c)
{
    const uint32_t *triangles = s->wall->mesh.triangles, *own = &triangles[3 * (size_t)c->triangle];
    candidate best = *c, room;
    for (size_t k = 0; k < s->count && c->spot.part != DEM_ON_FACE; k++) {
        const candidate *other = candidate_at(s, k, &room);
        if (other->spot.distance2 < c->spot.distance2 &&
            shares_place(&triangles[3 * (size_t)other->triangle], own, c->spot.part))
            return false;
        double nearer = other->spot.aside2 - best.spot.aside2;
        if ((nearer < 0 || (nearer == 0 && is_before(other, &best))) && is_same_place(s, c, other))
            best = *other;
    }
    *c = best;
    return true;
}

// on or behind the tangent plane of one of the contacts?
static bool is_hidden(const dem_mesh_contact *contacts, int count, dem_vec3 offset, double slack)
{
    for (int i = 0; i < count; i++)
        if (-v3_dot(offset, contacts[i].normal) >= contacts[i].distance - slack)
            return true;
    return false;
}

// goes from one candidate within the ball to the next that no contact hides; false: there is none
static bool next_candidate(const search *s, const dem_mesh_contact *contacts, int count, candidate *at)
{
    const double end = s->radius * s->radius;
    candidate best = {.spot.distance2 = end}, room;
    for (size_t k = 0; k < s->count; k++) {
        const candidate *c = candidate_at(s, k, &room);
        if (is_before(at, c) && is_before(c, &best) && !is_hidden(contacts, count, c->spot.offset, FLAT * s->radius))
            best = *c;
    }
    *at = best;
    return best.spot.distance2 < end;
}

static dem_mesh_contact contact_at(const search *s, const candidate *c)
{
    const dem_triangle *t = &s->wall->triangles[c->triangle];
    dem_vec3 offset = c->spot.offset;
    double distance = sqrt(c->spot.distance2);
    dem_vec3 normal = v3_scale(offset, -1 / distance);
    if (distance <= NOISE * t->length)
        normal = v3_dot(offset, t->normal) > 0 ? v3_scale(t->normal, -1) : t->normal;
    dem_vec3 point = v3_add(s->centre, offset);
    return (dem_mesh_contact){c->triangle, (dem_triangle_part)c->spot.part, point, offset, normal, distance};
}

// keeps the candidates within the ball at hand if they are few enough
static void keep(search *s, candidate *room)
{
    const double end = s->radius * s->radius;
    size_t count = 0;
    for (size_t k = 0; k < s->count; k++) {
        if (count == KEPT)
            return;
        if (triangle_is_beyond(&s->wall->triangles[s->ids[k]], s->centre, s->radius))
            continue;
        make_candidate(s, k, &room[count]);
        count += room[count].spot.distance2 < end;
    }
    s->kept = room;
    s->count = count;
}

// one triangle alone is hidden by nothing
static int touch_one(const search *s, dem_mesh_contact *contact)
{
    candidate c;
    make_candidate(s, 0, &c);
    if (!(c.spot.distance2 < s->radius * s->radius) ||
        triangle_is_beyond(&s->wall->triangles[c.triangle], s->centre, s->radius))
        return 0;
    *contact = contact_at(s, &c);
    return 1;
}

int dem_mesh_wall_sift(const dem_mesh_wall *wall, const uint32_t *ids, const dem_closest *spots, size_t count,
                       dem_vec3 centre, double radius, dem_mesh_contact *contacts, int most)
{
    candidate room[KEPT], at = {.spot.distance2 = -1};
    search s = {wall, centre, radius, ids, spots, count, NULL};
    int found = 0;
    DEM_ASSERT(most <= DEM_MESH_CONTACTS);
    if (count == 1 && most > 0)
        return touch_one(&s, contacts);
    keep(&s, room);
    while (found < most && next_candidate(&s, contacts, found, &at)) {
        candidate c = at;
        if (settle(&s, &c))
            contacts[found++] = contact_at(&s, &c);
    }
    return found;
}

int dem_mesh_wall_contacts(const dem_mesh_wall *wall, const uint32_t *ids, size_t count, dem_vec3 centre, double radius,
                           dem_mesh_contact *contacts, int most)
{
    return dem_mesh_wall_sift(wall, ids, NULL, count, centre, radius, contacts, most);
}

double dem_mesh_wall_close(const dem_mesh_wall *wall, const uint32_t *ids, size_t count, dem_vec3 centre, double reach,
                           uint32_t *close, uint32_t *close_count)
{
    double next2 = INFINITY;
    *close_count = 0;
    for (size_t k = 0; k < count; k++) {
        double distance2 = triangle_closest(&wall->triangles[ids[k]], centre).distance2;
        if (distance2 < reach * reach)
            close[(*close_count)++] = ids[k];
        else
            next2 = distance2 < next2 ? distance2 : next2;
    }
    return sqrt(next2);
}

// ---- history

void dem_mesh_contacts_follow(const dem_mesh_contact *last, int last_count, const dem_mesh_contact *contacts, int count,
                              double reach, int *from)
{
    const double aligned = 0.96592582628906829;  // cos 15 degrees
    bool used[DEM_MESH_CONTACTS] = {false};
    DEM_ASSERT(last_count <= DEM_MESH_CONTACTS && count <= DEM_MESH_CONTACTS);
    if (count == 1 && last_count == 1) {
        // most are alone
        bool near = v3_norm2(v3_sub(contacts->point, last->point)) <= reach * reach;
        from[0] = near && v3_dot(contacts->normal, last->normal) >= aligned ? 0 : -1;
        return;
    }
    for (int k = 0; k < count; k++)
        from[k] = -1;
    for (;;) {
        double nearest2 = reach * reach;
        int contact = -1, earlier = -1;
        for (int k = 0; k < count; k++)
            for (int i = 0; i < last_count && from[k] < 0; i++) {
                double distance2 = v3_norm2(v3_sub(contacts[k].point, last[i].point));
                bool fits = !used[i] && v3_dot(contacts[k].normal, last[i].normal) >= aligned;
                if (fits && (distance2 < nearest2 || (contact < 0 && distance2 == nearest2))) {
                    nearest2 = distance2;
                    contact = k;
                    earlier = i;
                }
            }
        if (contact < 0)
            return;
        from[contact] = earlier;
        used[earlier] = true;
    }
}
