#include "mesh/polyhedron.h"

#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "math/sum.h"

enum { BISECTIONS = 45 };

static const double FAR = 100;         // half the edge of the box that planes cut up
static const double ON_PLANE = 1e-13;  // nearer to a plane, over the size, is on it

void dem_polyhedron_release(dem_polyhedron *p)
{
    free(p->corners);
    free(p->loops);
    free(p->faces);
    *p = (dem_polyhedron){0};
}

static bool add_corner(dem_polyhedron *p, dem_vec3 at)
{
    if (!dem_grow(&p->corners, &p->corner_room, p->corner_count, sizeof *p->corners))
        return false;
    p->corners[p->corner_count++] = at;
    return true;
}

static bool add_to_loop(dem_polyhedron *p, uint32_t corner)
{
    if (!dem_grow(&p->loops, &p->loop_room, p->loop_count, sizeof *p->loops))
        return false;
    p->loops[p->loop_count++] = corner;
    return true;
}

// a face of the corners added to the loops since `begin`; fewer than three are taken back
static bool add_face(dem_polyhedron *p, dem_plane plane, size_t begin, int tag)
{
    if (p->loop_count < begin + 3) {
        p->loop_count = begin;
        return true;
    }
    if (!dem_grow(&p->faces, &p->face_room, p->face_count, sizeof *p->faces))
        return false;
    p->faces[p->face_count++] = (dem_polyhedron_face){plane, begin, p->loop_count, tag};
    return true;
}

static void make_empty(dem_polyhedron *p)
{
    p->corner_count = p->loop_count = p->face_count = 0;
}

dem_status dem_polyhedron_box(dem_polyhedron *p, dem_box box, dem_error *error)
{
    static const uint32_t sides[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                                         {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
    make_empty(p);
    bool good = true;
    for (int i = 0; i < 8; i++)
        good = good && add_corner(p, v3(i & 1 ? box.high.x : box.low.x, i & 2 ? box.high.y : box.low.y,
                                        i & 4 ? box.high.z : box.low.z));
    for (int side = 0; side < 6; side++) {
        dem_plane plane = {{0}, 0};
        v3_set(&plane.normal, side / 2, side % 2 ? 1 : -1);
        plane.distance = side % 2 ? v3_get(box.high, side / 2) : -v3_get(box.low, side / 2);
        size_t begin = p->loop_count;
        for (int k = 0; k < 4; k++)
            good = good && add_to_loop(p, sides[side][k]);
        good = good && add_face(p, plane, begin, -1 - side);
    }
    return good ? DEM_OK : dem_fail_memory(error);
}

// a cut at work: what is left goes to `to`
typedef struct cutting {
    const dem_polyhedron *from;
    dem_polyhedron *to;
    double *above;         // [corner_count] of the old corners
    uint32_t *follows;     // [corner_count of both and more] next corner of the new face
    uint32_t (*split)[3];  // edges cut: lower corner, higher corner, the new one
    size_t split_count;
} cutting;

// the corner where an edge passes the plane, the same for both faces beside it
static bool split_edge(cutting *c, uint32_t a, uint32_t b, uint32_t *at)
{
    uint32_t low = a < b ? a : b, high = a < b ? b : a;
    for (size_t i = 0; i < c->split_count; i++)
        if (c->split[i][0] == low && c->split[i][1] == high) {
            *at = c->split[i][2];
            return true;
        }
    double s = c->above[low] / (c->above[low] - c->above[high]);
    dem_vec3 p = v3_along(v3_scale(c->from->corners[low], 1 - s), s, c->from->corners[high]);
    *at = (uint32_t)c->to->corner_count;
    c->split[c->split_count][0] = low;
    c->split[c->split_count][1] = high;
    c->split[c->split_count++][2] = *at;
    return add_corner(c->to, p);
}

// what is left of a face; the edge along the plane goes, turned, to the new face
static bool cut_face(cutting *c, const dem_polyhedron_face *face)
{
    size_t count = face->end - face->begin, begin = c->to->loop_count;
    const uint32_t *loop = c->from->loops + face->begin;
    uint32_t leaves = UINT32_MAX, enters = UINT32_MAX, at;
    for (size_t i = 0; i < count; i++) {
        uint32_t a = loop[i], b = loop[(i + 1) % count], before = loop[(i + count - 1) % count];
        if (c->above[a] <= 0 && !add_to_loop(c->to, a))
            return false;
        if (c->above[a] == 0 && c->above[b] > 0)
            leaves = a;
        if (c->above[a] == 0 && c->above[before] > 0)
            enters = a;
        if ((c->above[a] < 0 && c->above[b] > 0) || (c->above[a] > 0 && c->above[b] < 0)) {
            if (!split_edge(c, a, b, &at) || !add_to_loop(c->to, at))
                return false;
            *(c->above[a] < 0 ? &leaves : &enters) = at;
        }
    }
    if (leaves != UINT32_MAX && enters != UINT32_MAX && leaves != enters)
        c->follows[enters] = leaves;
    return add_face(c->to, face->plane, begin, face->tag);
}

static bool close_cut(cutting *c, dem_plane plane, int tag, size_t corners)
{
    size_t begin = c->to->loop_count, first = 0;
    while (first < corners && c->follows[first] == UINT32_MAX)
        first++;
    if (first == corners)
        return true;
    uint32_t at = (uint32_t)first;
    for (size_t k = 0; k < corners && at != UINT32_MAX; k++) {
        if (!add_to_loop(c->to, at))
            return false;
        at = c->follows[at];
        if (at == first)
            break;
    }
    return add_face(c->to, plane, begin, tag);
}

dem_status dem_polyhedron_cut(dem_polyhedron *p, dem_plane plane, int tag, bool *cut, dem_error *error)
{
    double highest = -INFINITY, size = 0;
    double *above = dem_alloc(p->corner_count, sizeof *above);
    if (!above)
        return dem_fail_memory(error);
    for (size_t i = 0; i < p->loop_count; i++) {
        uint32_t k = p->loops[i];
        above[k] = v3_dot(plane.normal, p->corners[k]) - plane.distance;
        size = fmax(size, fabs(above[k]));
    }
    for (size_t i = 0; i < p->loop_count; i++) {
        double *a = &above[p->loops[i]];
        *a = fabs(*a) <= ON_PLANE * size ? 0 : *a;
        highest = fmax(highest, *a);
    }
    *cut = highest > 0;
    if (!*cut) {
        free(above);
        return DEM_OK;
    }
    size_t room = p->corner_count + p->loop_count;
    dem_polyhedron left = {0};
    cutting c = {p, &left, above, dem_alloc(room, sizeof *c.follows), dem_alloc(p->loop_count, sizeof *c.split), 0};
    bool good = c.follows && c.split;
    for (size_t i = 0; i < p->corner_count && good; i++)
        good = add_corner(&left, p->corners[i]);
    if (good)
        memset(c.follows, 0xff, room * sizeof *c.follows);
    for (size_t i = 0; i < p->face_count && good; i++)
        good = cut_face(&c, &p->faces[i]);
    if (good && left.face_count)
        good = close_cut(&c, plane, tag, left.corner_count);
    free(above);
    free(c.follows);
    free(c.split);
    dem_polyhedron_release(p);
    if (!good) {
        dem_polyhedron_release(&left);
        return dem_fail_memory(error);
    }
    *p = left;
    return DEM_OK;
}

dem_status dem_polyhedron_from_planes(dem_polyhedron *p, const dem_plane *planes, size_t count, dem_error *error)
{
    DEM_TRY(dem_polyhedron_box(p, (dem_box){{-FAR, -FAR, -FAR}, {FAR, FAR, FAR}}, error));
    for (size_t i = 0; i < count; i++) {
        bool cut;
        DEM_TRY(dem_polyhedron_cut(p, planes[i], (int)i, &cut, error));
    }
    for (size_t i = 0; i < p->face_count; i++)
        if (p->faces[i].tag < 0)
            return dem_fail(error, DEM_BAD_INPUT, "the planes enclose no polyhedron; take more of them");
    return DEM_OK;
}

typedef struct side_key {
    uint32_t low, high, side;
} side_key;

static int compare_keys(const void *a, const void *b)
{
    const side_key *p = a, *q = b;
    if (p->low != q->low)
        return p->low < q->low ? -1 : 1;
    if (p->high != q->high)
        return p->high < q->high ? -1 : 1;
    return (p->side > q->side) - (p->side < q->side);
}

dem_status dem_polyhedron_sides_find(const dem_polyhedron *p, dem_polyhedron_sides *sides, dem_error *error)
{
    *sides = (dem_polyhedron_sides){dem_alloc(p->loop_count, 4), dem_alloc(p->loop_count, 4)};
    side_key *keys = dem_alloc(p->loop_count, sizeof *keys);
    if (!sides->twin || !sides->face || !keys) {
        free(keys);
        dem_polyhedron_sides_release(sides);
        return dem_fail_memory(error);
    }
    for (uint32_t f = 0; f < p->face_count; f++)
        for (size_t i = p->faces[f].begin; i < p->faces[f].end; i++) {
            uint32_t a = p->loops[i], b = p->loops[i + 1 < p->faces[f].end ? i + 1 : p->faces[f].begin];
            keys[i] = (side_key){a < b ? a : b, a < b ? b : a, (uint32_t)i};
            sides->face[i] = f;
        }
    qsort(keys, p->loop_count, sizeof *keys, compare_keys);
    bool paired = p->loop_count % 2 == 0;
    for (size_t i = 0; i + 1 < p->loop_count && paired; i += 2) {
        const side_key *one = &keys[i], *other = &keys[i + 1];
        paired = one->low == other->low && one->high == other->high &&
                 (i == 0 || keys[i - 1].low != one->low || keys[i - 1].high != one->high);
        sides->twin[one->side] = other->side;
        sides->twin[other->side] = one->side;
    }
    free(keys);
    if (paired)
        return DEM_OK;
    dem_polyhedron_sides_release(sides);
    return dem_fail(error, DEM_FAILED, "the planes meet too nearly in one point; take another seed");
}

void dem_polyhedron_sides_release(dem_polyhedron_sides *sides)
{
    free(sides->twin);
    free(sides->face);
    *sides = (dem_polyhedron_sides){0};
}

// a face of the dual: the faces around a corner, counter-clockwise from that of the side that begins there
static bool add_dual_face(dem_polyhedron *p, const dem_polyhedron *of, const dem_polyhedron_sides *sides,
                          uint32_t first)
{
    size_t begin = p->loop_count;
    uint32_t side = first;
    do {
        if (!add_to_loop(p, sides->face[side]))
            return false;
        side = sides->twin[polyhedron_before(of, sides, side)];
    } while (side != first && p->loop_count - begin < of->face_count);
    dem_vec3 corner = of->corners[of->loops[first]];
    double far = v3_norm(corner);
    return add_face(p, (dem_plane){v3_scale(corner, 1 / far), 1 / far}, begin, (int)of->loops[first]);
}

dem_status dem_polyhedron_dual(dem_polyhedron *p, const dem_polyhedron *of, dem_error *error)
{
    make_empty(p);
    dem_polyhedron_sides sides;
    DEM_TRY(dem_polyhedron_sides_find(of, &sides, error));
    bool good = true;
    unsigned char *seen = dem_alloc_zero(of->corner_count, 1);
    for (size_t f = 0; f < of->face_count && good; f++)
        good = add_corner(p, v3_scale(of->faces[f].plane.normal, 1 / of->faces[f].plane.distance));
    for (uint32_t i = 0; i < of->loop_count && good && seen; i++)
        if (!seen[of->loops[i]]) {
            seen[of->loops[i]] = 1;
            good = add_dual_face(p, of, &sides, i);
        }
    good = good && seen;
    free(seen);
    dem_polyhedron_sides_release(&sides);
    return good ? DEM_OK : dem_fail_memory(error);
}

// what is left when every plane moves in by `by`; its corners' mean
static dem_status erode(const dem_polyhedron *p, double by, dem_polyhedron *left, dem_vec3 *middle, dem_error *error)
{
    dem_box box = box_empty();
    for (size_t i = 0; i < p->loop_count; i++)
        box = box_with(box, p->corners[p->loops[i]]);
    DEM_TRY(dem_polyhedron_box(left, box, error));
    for (size_t f = 0; f < p->face_count && left->face_count; f++) {
        dem_plane plane = p->faces[f].plane;
        plane.distance -= by;
        bool cut;
        DEM_TRY(dem_polyhedron_cut(left, plane, p->faces[f].tag, &cut, error));
    }
    *middle = v3(0, 0, 0);
    for (size_t i = 0; i < left->loop_count; i++)
        *middle = v3_along(*middle, 1 / (double)left->loop_count, left->corners[left->loops[i]]);
    return DEM_OK;
}

// the ball shrinks to its centre when all planes move in by its radius
dem_status dem_polyhedron_inball(const dem_polyhedron *p, dem_ball *ball, dem_error *error)
{
    dem_polyhedron left = {0};
    double low = 0, high = 0;
    dem_status status = DEM_OK;
    *ball = (dem_ball){0};
    for (size_t i = 0; i < p->loop_count; i++)
        high = fmax(high, v3_distance(p->corners[p->loops[i]], p->corners[p->loops[0]]));
    for (int k = 0; k < BISECTIONS && status == DEM_OK && low < high; k++) {
        double radius = (low + high) / 2;
        dem_vec3 middle;
        status = erode(p, radius, &left, &middle, error);
        if (left.face_count) {
            low = radius;
            ball->centre = middle;
        } else {
            high = radius;
        }
    }
    ball->radius = INFINITY;  // of that centre exactly
    for (size_t f = 0; f < p->face_count; f++)
        ball->radius = fmin(ball->radius, p->faces[f].plane.distance - v3_dot(p->faces[f].plane.normal, ball->centre));
    dem_polyhedron_release(&left);
    return status;
}

dem_status dem_polyhedron_erode(dem_polyhedron *p, double by, dem_error *error)
{
    dem_polyhedron left = {0};
    dem_vec3 middle;
    dem_status status = erode(p, by, &left, &middle, error);
    dem_polyhedron_release(status == DEM_OK ? p : &left);
    if (status == DEM_OK)
        *p = left;
    return status;
}

void dem_polyhedron_move(dem_polyhedron *p, dem_vec3 by)
{
    for (size_t i = 0; i < p->corner_count; i++)
        p->corners[i] = v3_add(p->corners[i], by);
    for (size_t f = 0; f < p->face_count; f++)
        p->faces[f].plane.distance += v3_dot(p->faces[f].plane.normal, by);
}

void dem_polyhedron_scale(dem_polyhedron *p, double factor)
{
    for (size_t i = 0; i < p->corner_count; i++)
        p->corners[i] = v3_scale(p->corners[i], factor);
    for (size_t f = 0; f < p->face_count; f++)
        p->faces[f].plane.distance *= factor;
}

dem_status dem_polyhedron_measure(const dem_polyhedron *p, dem_polyhedron_measures *m, dem_error *error)
{
    dem_sum volume = {0}, area = {0}, curvature = {0}, first[3] = {{0}};
    dem_polyhedron_sides sides;
    DEM_TRY(dem_polyhedron_sides_find(p, &sides, error));
    dem_vec3 origin = p->corners[p->loops[0]];
    for (uint32_t i = 0; i < p->loop_count; i++) {
        const dem_polyhedron_face *face = &p->faces[sides.face[i]];
        dem_vec3 a = v3_sub(p->corners[p->loops[face->begin]], origin), b = v3_sub(p->corners[p->loops[i]], origin);
        dem_vec3 c = v3_sub(p->corners[p->loops[polyhedron_next(p, &sides, i)]], origin);
        dem_vec3 normal = v3_cross(v3_sub(b, a), v3_sub(c, a));
        double part = v3_dot(a, normal) / 6;
        sum_add(&volume, part);
        sum_add(&area, v3_norm(normal) / 2);
        for (int k = 0; k < 3; k++)
            sum_add(&first[k], part / 4 * (v3_get(a, k) + v3_get(b, k) + v3_get(c, k)));
        if (sides.twin[i] > i)
            sum_add(&curvature, v3_distance(b, c) / 2 * polyhedron_turn(p, &sides, i));
    }
    dem_polyhedron_sides_release(&sides);
    m->volume = sum_value(volume);
    m->area = sum_value(area);
    m->curvature = sum_value(curvature);
    m->centre = v3_scale(v3(sum_value(first[0]), sum_value(first[1]), sum_value(first[2])), 1 / m->volume);
    m->centre = v3_add(m->centre, origin);
    return DEM_OK;
}
