// One patch of the boundary of a union of balls: the unit sphere of a ball without the caps its neighbours cut off.
// It is bounded by exposed arcs of circles, found by a sorted union of the intervals hidden on each circle. Integrals
// over the patch turn into closed forms along the arcs by the divergence theorem on the sphere, v being the outward
// conormal:
//   int n = -1/2 oint v,   int n n = (A 1 - oint n v) / 3,   int n n n = (sym(1, int n) - oint n n v) / 4.
// The area is a sum over arcs too, known up to a multiple of 4 pi, and the largest cap decides which one.
//
// Exact coincidences (lattices of equal balls, four spheres through a point, circles that touch or coincide) need no
// perturbation: the crossings of two circles are computed once, by expressions that do not cancel, and used on both.
// So the arcs close up to rounding whichever way a tie falls, and every integral is continuous in their ends. Only
// where many circles touch in one point do the ends fail to close, by 1e-9 to 1e-8, and that is reported.
#include "geom/patch.h"

#include <stdlib.h>
#include <string.h>

#define TWO_PI 6.28318530717958647692
#define FOUR_PI 12.56637061435917295385
// slack of the decision about the multiple of 4 pi [sr]
#define SLACK 1e-9
// circles whose axes and heights differ by less than this are one; their ends would be noise [-]
#define SAME 1e-14
// a cap that is inside another one by more than this is so whatever rounding does [-]
#define CLEARLY 1e-9
// circles that overlap by less than the square root of this only touch: the ends could not be told apart [-]
#define TOUCH 1e-28

// directions n of the unit sphere with n.u > h lie in the neighbour
typedef struct cap {
    dem_vec3 u, a, b;  // right-handed; a, b span the plane of the circle
    double h, s;       // cosine and sine of the opening angle
    double rest;       // 1 - h without cancellation
    uint32_t ball;
} cap;

// where the circles of two caps meet, as directions: seen along the first cap's axis, the second one covers
// `from` to `to` counter-clockwise
typedef struct crossing {
    uint32_t first, second;
    dem_vec3 from, to;
} crossing;

// an end of an interval on a circle: pseudo-angle in [0, 4) for sorting, and the direction in the circle's plane
typedef struct angle {
    double order, cos, sin;
} angle;

typedef struct hidden {
    angle from, to;
} hidden;

typedef struct arc {
    uint32_t cap;
    double cos0, sin0, cos1, sin1, begin, span;
} arc;

// work space, grown as needed, used for one ball after the other
struct dem_patch_work {
    const dem_ball_tree *tree;
    uint32_t *near;
    cap *caps, *found;  // those that count, and those not yet looked at
    size_t cap_room, found_room, cap_count;
    crossing *crossings;
    size_t crossing_room, crossing_count;
    hidden *hidden;
    size_t hidden_room;
    size_t *start;  // [cap_count + 1] ranges of `hidden` by circle
    size_t start_room;
    arc *arcs;
    size_t arc_room, arc_count;
    double doubt;  // largest sign of arcs that do not close [-]
};

dem_patch_work *dem_patch_work_create(const dem_ball_tree *tree)
{
    dem_patch_work *w = dem_alloc_zero(1, sizeof *w);
    if (!w)
        return NULL;
    w->tree = tree;
    w->near = dem_alloc(tree->boxes.count, sizeof *w->near);
    if (!w->near) {
        free(w);
        return NULL;
    }
    return w;
}

void dem_patch_work_destroy(dem_patch_work *w)
{
    if (!w)
        return;
    free(w->near);
    free(w->caps);
    free(w->found);
    free(w->crossings);
    free(w->hidden);
    free(w->start);
    free(w->arcs);
    free(w);
}

static bool reserve(void *array, size_t *room, size_t wanted, size_t size)
{
    while (*room < wanted)
        if (!dem_grow(array, room, *room, size))
            return false;
    return true;
}

// The cap ball j cuts off ball i. False: none. `swallowed` is set where j covers all of i.
// All three sign decisions are taken on numbers that come out the same seen from i and from j.
static bool cap_make(const dem_ball *balls, uint32_t i, uint32_t j, cap *c, bool *swallowed)
{
    dem_vec3 d = v3_sub(balls[j].centre, balls[i].centre);
    double ri = balls[i].radius, rj = balls[j].radius, distance = v3_norm(d);
    double overlap = (ri + rj) - distance;
    double i_beyond_j = distance + (ri - rj), j_beyond_i = distance + (rj - ri);
    if (overlap <= 0)
        return false;
    if (i_beyond_j <= 0 && (j_beyond_i > 0 || j < i)) {
        *swallowed = true;
        return false;
    }
    if (j_beyond_i <= 0)
        return false;
    double scale = 1 / (2 * ri * distance);
    double below = i_beyond_j * (distance + (ri + rj)) * scale;  // 1 + h
    c->rest = overlap * j_beyond_i * scale;
    c->h = below < c->rest ? below - 1 : 1 - c->rest;
    c->s = sqrt(below * c->rest);
    c->u = v3_scale(d, 1 / distance);
    c->ball = j;
    return c->s > 0;
}

typedef enum relation { APART, CROSSING, NESTED, COVERING } relation;

// How the cap j lies to k, which is at least as large. The cap k is turned to the side of j first (its complement
// where the axes point apart), so that 1 - cos(angle) comes from a difference of vectors and nothing cancels.
static relation cap_relate(const cap *j, const cap *k, crossing *x)
{
    double side = v3_dot(j->u, k->u) < 0 ? -1 : 1;
    dem_vec3 difference = v3_along(j->u, -side, k->u);
    double m = v3_norm2(difference) / 2, hk = side * k->h, dh = j->h - hk;
    if (m + dh * dh < SAME * SAME)
        return side > 0 ? NESTED : COVERING;
    double discriminant = m * (2 - m - 2 * j->h * hk) - dh * dh, sine2 = m * (2 - m);
    if (discriminant <= TOUCH * sine2) {
        if (side * (dh - m * j->h) < 0)
            return APART;
        double covered = -dh - m * hk;  // how far the circle of k reaches into j
        return covered > 0 || (covered == 0 && side < 0) ? COVERING : NESTED;
    }
    dem_vec3 toward = v3_along(v3_scale(difference, -1), m, j->u);
    dem_vec3 across = v3_scale(v3_cross(j->u, difference), -side * sqrt(discriminant) / sine2);
    dem_vec3 middle = v3_along(v3_scale(j->u, j->h), (m * j->h - dh) / sine2, toward);
    x->from = v3_sub(middle, across);
    x->to = v3_add(middle, across);
    return CROSSING;
}

// The caps of ball i. False: another ball covers all of it, or no memory.
static bool caps_find(dem_patch_work *w, uint32_t i, size_t *count, bool *memory)
{
    const dem_ball *balls = w->tree->balls;
    size_t near = dem_ball_tree_near(w->tree, balls[i], 0, w->near);
    bool swallowed = false;
    *count = 0;
    *memory = reserve(&w->caps, &w->cap_room, near, sizeof *w->caps) &&
              reserve(&w->found, &w->found_room, near, sizeof *w->found);
    for (size_t k = 0; *memory && k < near && !swallowed; k++)
        if (w->near[k] != i)
            *count += cap_make(balls, i, w->near[k], &w->found[*count], &swallowed);
    return *memory && !swallowed;
}

// Takes the largest cap out of those found, and with it most of those it contains: cos(angle between the axes) >
// cos(difference of the openings), by more than rounding could do. Close calls are left to cap_relate.
static cap take_largest(cap *found, size_t *count)
{
    size_t largest = 0, left = 0;
    for (size_t k = 1; k < *count; k++) {
        const cap *a = &found[k], *b = &found[largest];
        largest = a->h != b->h ? (a->h < b->h ? k : largest) : a->ball < b->ball ? k : largest;
    }
    cap c = found[largest];
    for (size_t k = 0; k < *count; k++)
        if (k != largest && !(v3_dot(found[k].u, c.u) > c.h * found[k].h + c.s * found[k].s + CLEARLY)) {
            if (left < k)
                found[left] = found[k];
            left++;
        }
    *count = left;
    return c;
}

// Collects the caps of ball i that no other single cap contains, with their crossings, largest first.
// False: the ball has no surface of its own. Sets *memory to false when there is none left.
static bool caps_collect(dem_patch_work *w, uint32_t i, bool *memory)
{
    size_t kept = 0, found;
    w->cap_count = w->crossing_count = 0;
    if (!caps_find(w, i, &found, memory))
        return false;
    while (found) {
        size_t crossings = w->crossing_count;
        cap c = take_largest(w->found, &found);
        relation r = APART;
        if (!(*memory = reserve(&w->crossings, &w->crossing_room, crossings + kept, sizeof *w->crossings)))
            return false;
        for (size_t k = 0; k < kept && r != NESTED; k++) {
            crossing *x = &w->crossings[w->crossing_count];
            r = cap_relate(&c, &w->caps[k], x);
            if (r == COVERING)
                return false;
            x->first = (uint32_t)kept;
            x->second = (uint32_t)k;
            w->crossing_count += r == CROSSING;
        }
        if (r == NESTED) {
            w->crossing_count = crossings;
            continue;
        }
        c.a = v3_normal_to(c.u);
        c.b = v3_cross(c.u, c.a);
        w->caps[kept++] = c;
    }
    w->cap_count = kept;
    return true;
}

static angle angle_on(const cap *c, dem_vec3 n)
{
    double x = v3_dot(n, c->a), y = v3_dot(n, c->b);
    double t = y / (fabs(x) + fabs(y));
    return (angle){x < 0 ? 2 - t : t < 0 ? 4 + t : t, x, y};
}

static int hidden_order(const void *left, const void *right)
{
    const hidden *a = left, *b = right;
    return a->from.order < b->from.order ? -1 : a->from.order > b->from.order;
}

// insertion sort for the usual handful
static void hidden_sort(hidden *list, size_t count)
{
    if (count > 24) {
        qsort(list, count, sizeof *list, hidden_order);
        return;
    }
    for (size_t i = 1; i < count; i++) {
        hidden item = list[i];
        size_t k = i;
        for (; k > 0 && list[k - 1].from.order > item.from.order; k--)
            list[k] = list[k - 1];
        list[k] = item;
    }
}

// the intervals hidden on each circle, circle after circle
static bool hidden_collect(dem_patch_work *w)
{
    size_t circles = w->cap_count;
    if (!reserve(&w->start, &w->start_room, circles + 2, sizeof *w->start) ||
        !reserve(&w->hidden, &w->hidden_room, 2 * w->crossing_count + 1, sizeof *w->hidden))
        return false;
    memset(w->start, 0, (circles + 2) * sizeof *w->start);
    for (size_t i = 0; i < w->crossing_count; i++) {
        w->start[w->crossings[i].first + 2]++;
        w->start[w->crossings[i].second + 2]++;
    }
    for (size_t c = 2; c < circles + 2; c++)
        w->start[c] += w->start[c - 1];
    for (size_t i = 0; i < w->crossing_count; i++) {
        const crossing *x = &w->crossings[i];
        const cap *first = &w->caps[x->first], *second = &w->caps[x->second];
        w->hidden[w->start[x->first + 1]++] = (hidden){angle_on(first, x->from), angle_on(first, x->to)};
        w->hidden[w->start[x->second + 1]++] = (hidden){angle_on(second, x->to), angle_on(second, x->from)};
    }
    return true;
}

static void arc_add(dem_patch_work *w, uint32_t c, const angle *from, const angle *to)
{
    double r0 = 1 / hypot(from->cos, from->sin), r1 = 1 / hypot(to->cos, to->sin);
    arc a = {c, from->cos * r0, from->sin * r0, to->cos * r1, to->sin * r1, 0, TWO_PI};
    if (from != to) {
        a.begin = atan2(a.sin0, a.cos0);
        a.span = atan2(a.sin1, a.cos1) - a.begin;
        // the order decides between an arc and its complement where rounding makes them look alike
        double turn = to->order - from->order;
        turn += turn < 0 ? 4 : 0;
        if (a.span < 0 || (a.span < 1 && turn > 3))
            a.span += TWO_PI;
        if (a.span > 5 && turn < 1)
            a.span = 0;
    }
    w->arcs[w->arc_count++] = a;
}

// what the sorted intervals [begin, end) leave of circle c
static void arcs_expose(dem_patch_work *w, uint32_t c, hidden *list, size_t count)
{
    static const angle zero = {0, 1, 0};
    if (count == 0) {
        arc_add(w, c, &zero, &zero);
        return;
    }
    hidden_sort(list, count);
    const angle *reach = NULL;
    for (size_t k = 0; k < count; k++)
        if (list[k].to.order < list[k].from.order && (!reach || list[k].to.order > reach->order))
            reach = &list[k].to;
    bool wraps = reach != NULL;
    for (size_t k = 0; k < count; k++) {
        const hidden *h = &list[k];
        if (reach && h->from.order > reach->order)
            arc_add(w, c, reach, &h->from);
        if (h->to.order < h->from.order)
            return;
        if (!reach || h->to.order > reach->order)
            reach = &h->to;
    }
    if (!wraps)
        arc_add(w, c, reach, &list[0].from);
}

static bool arcs_collect(dem_patch_work *w)
{
    // each interval ends at most one arc, a circle without intervals is one
    if (!hidden_collect(w) || !reserve(&w->arcs, &w->arc_room, 2 * w->crossing_count + w->cap_count, sizeof *w->arcs))
        return false;
    w->arc_count = 0;
    for (uint32_t c = 0; c < w->cap_count; c++)
        arcs_expose(w, c, w->hidden + w->start[c], w->start[c + 1] - w->start[c]);
    return true;
}

// Area of the patch modulo 4 pi: minus the areas between each arc, counter-clockwise about its cap, and the pole:
// segment between arc and chord + spherical triangle (pole, ends), arguments collected as one complex product
// (van Oosterom & Strackee 1983). Returns how far the sum stayed from its singular cases; *doubt is not zero where
// the arcs do not close: the sum of f(end) - f(begin) with an arbitrary f.
static double area_about(const dem_patch_work *w, dem_vec3 pole, double *area, double *doubt)
{
    double re = 1, im = 0, straight = 0, clearance = 1, gaps = 0;
    for (size_t k = 0; k < w->arc_count; k++) {
        const arc *a = &w->arcs[k];
        const cap *c = &w->caps[a->cap];
        straight += a->span * c->rest;
        int pieces = a->span >= TWO_PI ? 0 : a->span > 4 ? 3 : a->span > 2 ? 2 : 1;  // chords stay short of a half turn
        dem_vec3 n0 = v3_along(v3_scale(c->u, c->h), c->s, v3_along(v3_scale(c->a, a->cos0), a->sin0, c->b));
        for (int p = 1; p <= pieces; p++) {
            double t = a->begin + a->span * p / pieces, step = a->span / pieces;
            double x = p == pieces ? a->cos1 : cos(t), y = p == pieces ? a->sin1 : sin(t);
            dem_vec3 n1 = v3_along(v3_scale(c->u, c->h), c->s, v3_along(v3_scale(c->a, x), y, c->b));
            // triangles (pole, n0, n1) and (u, n0, n1)
            double zr = 1 + v3_dot(pole, n0) + v3_dot(n0, n1) + v3_dot(n1, pole), zi = v3_dot(pole, v3_cross(n0, n1));
            double ur = 1 + c->h + c->rest * cos(step), ui = c->rest * sin(step);
            double r = zr * ur + zi * ui, i = zi * ur - zr * ui;
            double product = re * r - im * i;
            im = re * i + im * r;
            re = product;
            double size = 1 / (fabs(re) + fabs(im));
            re *= size;
            im *= size;
            clearance = fmin(clearance, fmin(zr * zr + zi * zi, ur * ur + ui * ui));
            double q0 = v3_dot(pole, n0), q1 = v3_dot(pole, n1);
            gaps += (q1 - q0) * (1 + q0 + q1);
            n0 = n1;
        }
    }
    *doubt = fabs(gaps);
    *area = fmod(-straight - 2 * atan2(im, re), FOUR_PI);
    return clearance;
}

// Area of the patch; notes where it is not certain.
static double patch_area(dem_patch_work *w)
{
    static const dem_vec3 poles[] = {{0.48, 0.6, 0.64},   {-0.64, 0.48, -0.6}, {0.6, -0.64, -0.48},
                                     {-0.36, -0.48, 0.8}, {0.96, 0, -0.28},    {0, -0.96, -0.28}};
    double largest = 0, sum = 0, area = 0, doubt = 0, best = -1;
    for (size_t c = 0; c < w->cap_count; c++) {
        largest = fmax(largest, TWO_PI * w->caps[c].rest);
        sum += TWO_PI * w->caps[c].rest;
    }
    for (size_t k = 0; k < sizeof poles / sizeof *poles && best < 0.01; k++) {
        double trial, gaps, clearance = area_about(w, poles[k], &trial, &gaps);
        doubt = fmax(doubt, gaps);
        if (clearance > best) {
            best = clearance;
            area = trial;
        }
    }
    // the caps leave at least 4 pi - sum and at most 4 pi - largest
    area += area < 0 ? FOUR_PI : 0;
    if (area > FOUR_PI - largest + SLACK)
        area -= FOUR_PI;
    else if (area < FOUR_PI - sum - SLACK)
        area += FOUR_PI;
    w->doubt = fmax(doubt, fmax(-area, area - (FOUR_PI - largest)));
    return fmax(area, 0);
}

// integrals over the exposed arcs of one circle: of 1, the direction e = (cos, sin), e e, e e e
typedef struct turn {
    double one, c, s, cc, cs, ss, ccc, ccs, css, sss;
} turn;

static void turn_add(turn *t, const arc *a)
{
    if (a->span >= TWO_PI) {
        t->one += TWO_PI;
        t->cc += TWO_PI / 2;
        t->ss += TWO_PI / 2;
        return;
    }
    double c0 = a->cos0, s0 = a->sin0, c1 = a->cos1, s1 = a->sin1;
    double s3 = (s1 * s1 * s1 - s0 * s0 * s0) / 3, c3 = (c0 * c0 * c0 - c1 * c1 * c1) / 3;
    double cc = (a->span + s1 * c1 - s0 * c0) / 2;
    t->one += a->span;
    t->c += s1 - s0;
    t->s += c0 - c1;
    t->cc += cc;
    t->ss += a->span - cc;
    t->cs += (s1 * s1 - s0 * s0) / 2;
    t->ccc += s1 - s0 - s3;
    t->css += s3;
    t->ccs += c3;
    t->sss += c0 - c1 - c3;
}

// adds weight * sym(p q r) to the ten components of a symmetric tensor
static void third_add(double third[10], double weight, dem_vec3 p, dem_vec3 q, dem_vec3 r)
{
    dem_sym3 m = sym3_pair(p, q);
    third[0] += weight * m.xx * r.x;
    third[1] += weight * (m.xx * r.y + 2 * m.xy * r.x) / 3;
    third[2] += weight * (m.xx * r.z + 2 * m.xz * r.x) / 3;
    third[3] += weight * (m.yy * r.x + 2 * m.xy * r.y) / 3;
    third[4] += weight * (m.xy * r.z + m.xz * r.y + m.yz * r.x) / 3;
    third[5] += weight * (m.zz * r.x + 2 * m.xz * r.z) / 3;
    third[6] += weight * m.yy * r.y;
    third[7] += weight * (m.yy * r.z + 2 * m.yz * r.y) / 3;
    third[8] += weight * (m.zz * r.y + 2 * m.yz * r.z) / 3;
    third[9] += weight * m.zz * r.z;
}

// the line integrals oint v, oint sym(n v), oint sym(n n v) of one circle, n = h u + s e, v = s u - h e, dl = s dt
static void circle_add(const cap *circle, const turn *t, dem_patch *p)
{
    double h = circle->h, s = circle->s;
    dem_vec3 u = circle->u, a = circle->a, b = circle->b;
    dem_vec3 e = v3_along(v3_scale(a, t->c), t->s, b);
    p->first = v3_add(p->first, v3_along(v3_scale(u, s * s * t->one), -s * h, e));
    dem_sym3 ee = sym3_add(sym3_add(sym3_scale(sym3_outer(a), t->cc), sym3_scale(sym3_outer(b), t->ss)),
                           sym3_scale(sym3_pair(a, b), 2 * t->cs));
    dem_sym3 sum = sym3_add(sym3_scale(sym3_outer(u), h * s * t->one), sym3_scale(sym3_pair(u, e), s * s - h * h));
    p->second = sym3_add(p->second, sym3_scale(sym3_add(sum, sym3_scale(ee, -h * s)), s));
    // (h u + s e)^2 (s u - h e) by powers of e; u u e and u e e as u (u e) and u (e e) in the frame
    double w1 = s * (2 * h * s * s - h * h * h), w2 = s * (s * s * s - 2 * h * h * s), w3 = -s * h * s * s;
    third_add(p->third, s * h * h * s * t->one, u, u, u);
    third_add(p->third, w1, u, u, e);
    dem_vec3 ea = v3_along(v3_scale(a, t->cc), t->cs, b), eb = v3_along(v3_scale(a, t->cs), t->ss, b);
    third_add(p->third, w2, u, a, ea);
    third_add(p->third, w2, u, b, eb);
    third_add(p->third, w3, a, a, v3_along(v3_scale(a, t->ccc), 3 * t->ccs, b));
    third_add(p->third, w3, b, b, v3_along(v3_scale(b, t->sss), 3 * t->css, a));
}

// from line integrals to the patch
static void patch_finish(dem_patch *p, double area)
{
    static const int diagonal[10][3] = {{3, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 0}, {0, 0, 0},
                                        {1, 0, 0}, {0, 3, 0}, {0, 0, 1}, {0, 1, 0}, {0, 0, 3}};
    p->area = area;
    p->first = v3_scale(p->first, -0.5);
    p->second = sym3_scale(sym3_add((dem_sym3){area, area, area, 0, 0, 0}, sym3_scale(p->second, -1)), 1.0 / 3);
    // sym(1, N)_abc = 2/3 (d_ab N_c + d_bc N_a + d_ca N_b)
    for (int k = 0; k < 10; k++) {
        double trace = diagonal[k][0] * p->first.x + diagonal[k][1] * p->first.y + diagonal[k][2] * p->first.z;
        p->third[k] = (2.0 / 3 * trace - p->third[k]) / 4;
    }
}

bool dem_patch_compute(dem_patch_work *w, uint32_t i, dem_patch *p)
{
    bool memory;
    *p = (dem_patch){0};
    w->arc_count = 0;
    w->doubt = 0;
    if (!caps_collect(w, i, &memory)) {
        w->cap_count = 0;
        return memory;
    }
    if (!arcs_collect(w))
        return false;
    if (w->arc_count == 0 && w->cap_count > 0)
        return true;
    double area = patch_area(w);
    if (area == 0) {
        w->arc_count = 0;
        return true;
    }
    turn t = {0};
    for (size_t k = 0; k < w->arc_count; k++) {
        turn_add(&t, &w->arcs[k]);
        if (k + 1 == w->arc_count || w->arcs[k + 1].cap != w->arcs[k].cap) {
            circle_add(&w->caps[w->arcs[k].cap], &t, p);
            t = (turn){0};
        }
    }
    patch_finish(p, area);
    return true;
}

double dem_patch_doubt(const dem_patch_work *w)
{
    return w->doubt;
}

size_t dem_patch_arc_count(const dem_patch_work *w)
{
    return w->arc_count;
}

dem_arc dem_patch_arc(const dem_patch_work *w, uint32_t i, size_t k)
{
    const arc *a = &w->arcs[k];
    const cap *c = &w->caps[a->cap];
    return (dem_arc){.i = i,
                     .j = c->ball,
                     .u = c->u,
                     .a = c->a,
                     .b = c->b,
                     .h = c->h,
                     .s = c->s,
                     .begin = a->begin,
                     .end = a->begin + a->span};
}

size_t dem_patch_cap_count(const dem_patch_work *w)
{
    return w->cap_count;
}

dem_cap dem_patch_cap(const dem_patch_work *w, size_t k)
{
    return (dem_cap){w->caps[k].u, w->caps[k].h, w->caps[k].ball};
}
