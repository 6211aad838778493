// The part of soft contacts in a body's own problem of the time step (timestep.h), in units of its masses. With b_a =
// (n, r x n) of the pairs and B their mean by omega: k B B^T + (F / tau) (mean of b_a b_a^T - B B^T), where the second
// part is how fast the shares of the pairs change. What the turning of the normals adds is left out, as with single
// contacts. So it is an estimate, which was never exceeded in the tests.
#include <math.h>
#include <string.h>

#include "sim/timestep.h"
#include "sim/touch.h"

typedef struct vector6 {
    double x[6];
} vector6;

// what is gathered of one patch for the two bodies
typedef struct patch_problem {
    double sum, slopes;
    vector6 mean[2];
    double spread[6][6];  // sum of e b b^T, of the first body
    dem_vec3 point, normal;
    double gyration;
} patch_problem;

// along u at `arm` of a body, in its own axes and in units of its masses
static vector6 screw(const dem_world *w, size_t row, dem_vec3 arm, dem_vec3 u)
{
    const double *inertia = w->bodies.inertia + DEM_ROW * row;
    dem_quat q = body_orientation(&w->bodies, row);
    dem_vec3 own = quat_unrotate(q, u), m = quat_unrotate(q, v3_cross(arm, u));
    vector6 b = {{own.x, own.y, own.z, m.x, m.y, m.z}};
    for (int i = 0; i < 6; i++)
        b.x[i] *= sqrt(inertia[i < 3 ? 0 : i - 2]);
    return b;
}

static void add_outer(double a[6][6], double factor, const vector6 *b)
{
    for (int i = 0; i < 6; i++)
        for (int j = 0; j < 6; j++)
            a[i][j] += factor * b->x[i] * b->x[j];
}

static double norm2(const vector6 *b)
{
    double sum = 0;
    for (int i = 0; i < 6; i++)
        sum += b->x[i] * b->x[i];
    return sum;
}

typedef struct patch_members {
    const dem_contacts *contacts;
    const dem_segment *s;
    int form;
    size_t begin, end;
    uint32_t row[2];           // the body in question, and the other one
    bool turned;               // the body in question is the second one
    dem_vec3 shift;            // from the other to the first one's image
    dem_soft_leaders leaders;  // of a mesh
    int group;
} patch_members;

static dem_touch touch_of(const dem_world *w, const patch_members *m, size_t k)
{
    size_t at = segment_place(m->s, k);
    return m->form < 0 ? dem_touch_of_pair(w, at) : dem_touch_of_wall(w, (dem_wall_form)m->form, at);
}

static uint32_t part_of(const dem_world *w, const patch_members *m, const dem_touch *t)
{
    return soft_part(&w->soft, m->contacts->columns.sphere_a[t->place]);
}

static bool belongs(const dem_world *w, const patch_members *m, const dem_touch *t)
{
    return m->form != DEM_FORM_MESH || soft_group(&m->leaders, t->normal, part_of(w, m, t)) == m->group;
}

static double deepest_of(const dem_world *w, const patch_members *m, dem_vec3 *normal, uint32_t *part)
{
    double deepest = -INFINITY;
    for (size_t k = m->begin; k < m->end; k++) {
        dem_touch t = touch_of(w, m, k);
        if (t.overlap > deepest && belongs(w, m, &t)) {
            deepest = t.overlap;
            *normal = t.normal;
            *part = part_of(w, m, &t);
        }
    }
    return deepest;
}

// sums over the pairs of spheres; their second moments about the centre of the first body of the list
static void gather(const dem_world *w, const patch_members *m, double deepest, patch_problem *p)
{
    const dem_contact_columns *c = &m->contacts->columns;
    double tau = w->soft.tau, square = 0;
    for (size_t k = m->begin; k < m->end; k++) {
        dem_touch t = touch_of(w, m, k);
        if (t.overlap <= -DEM_SOFT_REACH * tau || !belongs(w, m, &t))
            continue;
        double weight = soft_weight(&w->soft, c->a[t.place], c->sphere_a[t.place]);
        if (m->form < 0)
            weight *= soft_weight(&w->soft, c->b[t.place], c->sphere_b[t.place]);
        double e = weight * exp((t.overlap - deepest) / tau);
        dem_vec3 from_a = v3_sub(t.point, body_position(&w->bodies, c->a[t.place]));
        for (int side = 0; side < (m->form < 0 ? 2 : 1); side++) {
            bool first = (side == 0) != m->turned;
            dem_vec3 arm = from_a;
            if (!first)
                arm = v3_sub(t.point, v3_add(body_position(&w->bodies, c->b[t.place]), t.shift));
            vector6 b = screw(w, m->row[side], arm, t.normal);
            for (int i = 0; i < 6; i++)
                p->mean[side].x[i] += e * b.x[i];
            if (side == 0)
                add_outer(p->spread, e, &b);
        }
        p->sum += e;
        p->normal = v3_along(p->normal, e, t.normal);
        p->point = v3_along(p->point, e, from_a);
        square += e * v3_norm2(from_a);
    }
    double per = p->sum > 0 ? 1 / p->sum : 0;
    for (int side = 0; side < 2; side++)
        for (int i = 0; i < 6; i++)
            p->mean[side].x[i] *= per;
    p->normal = v3_unit(p->normal);
    p->point = v3_scale(p->point, per);
    p->gyration = sqrt(larger(square * per - v3_norm2(p->point), 0));
}

// a moment about the axis
static void add_turn(const dem_world *w, size_t row, dem_vec3 axis, double factor, double a[6][6])
{
    const double *inertia = w->bodies.inertia + DEM_ROW * row;
    dem_vec3 own = quat_unrotate(body_orientation(&w->bodies, row), axis);
    vector6 turn = {{0}};
    for (int i = 0; i < 3; i++)
        turn.x[3 + i] = v3_get(own, i) * sqrt(inertia[1 + i]);
    add_outer(a, factor, &turn);
}

// 1 / (I + m r^2) of both, as the kernels take it
static double inverse_rolling(const dem_world *w, const patch_members *m)
{
    double sum = 0;
    for (int side = 0; side < (m->form < 0 ? 2 : 1); side++) {
        const double *inertia = w->bodies.inertia + DEM_ROW * m->row[side];
        double mean = (inertia[1] + inertia[2] + inertia[3]) / 3, radius = w->soft.radius[m->row[side]];
        sum += inertia[0] * mean / (inertia[0] + radius * radius * mean);
    }
    return larger(sum, DEM_SOFT_HEAVIEST);
}

static void add_tangents(const dem_world *w, const patch_members *m, const patch_problem *p, double factor,
                         double twist, double roll, double a[6][6])
{
    const dem_contact_columns *c = &m->contacts->columns;
    size_t at = segment_place(m->s, m->begin), row = m->row[0];
    dem_vec3 arm = v3_add(p->point, v3_sub(body_position(&w->bodies, c->a[at]), body_position(&w->bodies, row)));
    if (m->turned)
        arm = v3_sub(arm, m->shift);
    dem_vec3 u = v3_normal_to(p->normal), v = v3_cross(p->normal, u);
    vector6 along = screw(w, row, arm, u), across = screw(w, row, arm, v);
    add_outer(a, factor, &along);
    add_outer(a, factor, &across);
    add_turn(w, row, p->normal, twist, a);
    if (roll > 0) {
        add_turn(w, row, u, roll, a);
        add_turn(w, row, v, roll, a);
    }
}

static void add_patch(const dem_world *w, const patch_members *m, bool listed, double k[6][6], double c[6][6])
{
    dem_vec3 normal;
    uint32_t part;
    double tau = w->soft.tau, deepest = deepest_of(w, m, &normal, &part);
    if (!(deepest > -DEM_SOFT_REACH * tau))
        return;
    patch_problem p;
    memset(&p, 0, sizeof p);
    gather(w, m, deepest, &p);
    double depth = p.sum > 0 ? deepest + tau * log(p.sum) : 0;
    if (!(depth > 0) && !listed)
        return;
    bool wall = m->form >= 0;
    depth = larger(depth, 0);
    const dem_contact_columns *columns = &m->contacts->columns;
    size_t at = segment_place(m->s, m->begin);
    const double *law = w->laws.rows + (columns->law ? (size_t)LAW_SLOTS * columns->law[at] : 0);
    double ra = w->soft.radius[m->row[0]], rb = wall ? ra : w->soft.radius[m->row[1]], least = smaller(ra, rb);
    double reduced = wall ? ra : ra * rb / (ra + rb), area = wall ? ra : least * least / (ra + rb);
    double radius = sqrt(reduced * depth), kn = law_stiffness(law, area, radius), times = wall ? 1 : 2;
    double kt = law_slide_stiffness(law, area, radius);
    double stiffening = dem_soft_stiffening(w, m->row[0], m->row[1], m->form);
    double force = kn * depth - law[LAW_HERTZ] * radius * depth / 3, per_tau = force / tau;
    double share = norm2(&p.mean[0]) + (wall ? 0 : norm2(&p.mean[1]));
    double mass = w->features.local_mass ? share : 0;
    for (int side = 0; side < (wall ? 1 : 2) && !w->features.local_mass; side++)
        mass += w->bodies.inertia[DEM_ROW * m->row[side]];
    mass = 1 / larger(mass, DEM_SOFT_HEAVIEST);
    add_outer(k, times * (stiffening * kn - per_tau), &p.mean[0]);
    for (int i = 0; i < 6; i++)
        for (int j = 0; j < 6; j++)
            k[i][j] += times * per_tau * p.spread[i][j] / p.sum;
    double arm2 = p.gyration * p.gyration + law[LAW_TWIST_RATIO] * reduced * depth;
    double roll = law_roll_stiffness(law, reduced, kn);
    if (kt > 0 || roll > 0)
        add_tangents(w, m, &p, times * kt, times * kt * arm2, times * roll, k);
    if (!w->laws.damped && !(roll > 0))
        return;
    double rolling = roll > 0 ? law[LAW_ROLL_ZETA] * sqrt(roll / inverse_rolling(w, m)) : 0;
    double cn = law[LAW_RATE] * mass + law[LAW_ZETA] * sqrt(kn * mass);
    double ct = law[LAW_SLIDE_RATE] * mass + law[LAW_SLIDE_ZETA] * sqrt(kt * mass);
    for (int i = 0; i < 6; i++)
        for (int j = 0; j < 6; j++)
            c[i][j] += times * cn * p.spread[i][j] / p.sum;
    if (ct > 0 || rolling > 0)
        add_tangents(w, m, &p, times * ct, times * ct * arm2, times * rolling, c);
}

// the groups of a mesh, deepest first
static void add_groups(const dem_world *w, patch_members *m, double k[6][6], double c[6][6])
{
    dem_vec3 normal;
    uint32_t part;
    for (m->group = -1; m->leaders.count < DEM_SOFT_LEADERS && deepest_of(w, m, &normal, &part) > -w->ahead;) {
        m->leaders.part[m->leaders.count] = part;
        m->leaders.normal[m->leaders.count++] = normal;
    }
    for (m->group = 0; m->group < m->leaders.count; m->group++)
        add_patch(w, m, false, k, c);
}

// where the run of the contact `k` ends
static size_t run_end(const dem_world *w, const patch_members *m, size_t k, size_t end)
{
    size_t first = segment_place(m->s, k);
    while (++k < end && dem_soft_same_run(w, m->contacts, first, segment_place(m->s, k), m->form))
        continue;
    return k;
}

static void add_pairs(const dem_world *w, size_t row, bool listed, double k[6][6], double c[6][6])
{
    for (size_t i = w->pairs.adjacency_first[row]; i < w->pairs.adjacency_first[row + 1]; i++) {
        const dem_pair *pair = &w->pairs.items[w->pairs.adjacency[i]];
        if (!pair->count)
            continue;
        bool first = pair->a == row;
        patch_members m = {.contacts = &w->contacts,
                           .s = &w->contacts.segments[pair->a / DEM_SEGMENT],
                           .form = -1,
                           .row = {first ? pair->a : pair->b, first ? pair->b : pair->a},
                           .turned = !first};
        if (w->periodic) {
            const double *shift = w->shifts + 4 * (size_t)pair->image;
            m.shift = v3(shift[0], shift[1], shift[2]);
        }
        size_t end = pair->start + pair->count;
        for (m.begin = pair->start; m.begin < end; m.begin = m.end) {
            m.end = run_end(w, &m, m.begin, end);
            add_patch(w, &m, listed, k, c);
        }
    }
}

static void add_walls(const dem_world *w, size_t row, bool listed, double k[6][6], double c[6][6])
{
    for (int form = 0; form < DEM_WALL_FORMS; form++) {
        const dem_contacts *contacts = &w->wall_contacts[form];
        if (!contacts->segments)
            continue;
        const dem_segment *s = &contacts->segments[row / DEM_SEGMENT];
        size_t size = s->end - s->begin;
        for (size_t begin = 0, end; begin < size; begin = end) {
            patch_members m = {.contacts = contacts,
                               .s = s,
                               .form = form,
                               .begin = begin,
                               .row = {(uint32_t)row, (uint32_t)row}};
            m.end = end = run_end(w, &m, begin, size);
            if (contacts->columns.a[segment_place(s, begin)] != row)
                continue;
            if (form == DEM_FORM_MESH)
                add_groups(w, &m, k, c);
            else
                add_patch(w, &m, listed, k, c);
        }
    }
}

void dem_soft_problem(const dem_world *w, size_t row, bool listed, double stiffness[6][6], double damping[6][6])
{
    add_pairs(w, row, listed, stiffness, damping);
    add_walls(w, row, listed, stiffness, damping);
}
