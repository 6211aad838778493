#include "sim/timestep.h"

#include <string.h>

#include "base/status.h"
#include "sim/bonds.h"
#include "sim/population.h"
#include "sim/scene.h"
#include "sim/touch.h"

enum { REVIEW_EVERY = 1000 };  // steps between questions whether the step may be raised

static const double SAFETY = 0.8, SAFETY_HERTZ = 0.5;
static const double GROW_FROM = 1.1;   // a step is not raised for less
static const double LOWER_BY = 0.95;   // of what is allowed, so that it need not be lowered again at once
static const double LEAST_REST = 0.1;  // of the whole room, that a body may use before it is asked again

double dem_largest_eigenvalue6(double a[6][6])
{
    for (int sweep = 0; sweep < 30; sweep++) {
        double off = 0, on = 0;
        for (int i = 0; i < 6; i++) {
            on += a[i][i] * a[i][i];
            for (int j = 0; j < i; j++)
                off += a[i][j] * a[i][j];
        }
        if (off <= 1e-24 * on)
            break;
        for (int i = 1; i < 6; i++)
            for (int j = 0; j < i; j++) {
                if (a[i][j] == 0)
                    continue;
                double theta = (a[i][i] - a[j][j]) / (2 * a[i][j]);
                double t = (theta < 0 ? -1 : 1) / (fabs(theta) + sqrt(theta * theta + 1)), c = 1 / sqrt(t * t + 1);
                double s = t * c;
                for (int k = 0; k < 6; k++) {
                    double x = a[k][j], y = a[k][i];
                    a[k][j] = c * x - s * y;
                    a[k][i] = s * x + c * y;
                }
                for (int k = 0; k < 6; k++) {
                    double x = a[j][k], y = a[i][k];
                    a[j][k] = c * x - s * y;
                    a[i][k] = s * x + c * y;
                }
            }
    }
    double largest = 0;
    for (int i = 0; i < 6; i++)
        largest = a[i][i] > largest ? a[i][i] : largest;
    return largest;
}

// B = A A, symmetric; returns the root of the sum of its squares
static double square6(const double a[6][6], double b[6][6])
{
    double sum = 0;
    for (int i = 0; i < 6; i++)
        for (int j = 0; j <= i; j++) {
            double s = 0;
            for (int k = 0; k < 6; k++)
                s += a[i][k] * a[j][k];
            b[i][j] = b[j][i] = s;
            sum += (i == j ? 1 : 2) * s * s;
        }
    return sqrt(sum);
}

double dem_eigenvalue_bound6(const double a[6][6])
{
    double once[6][6], twice[6][6], norm = 0;
    for (int i = 0; i < 6; i++)
        for (int j = 0; j < 6; j++)
            norm = fmax(norm, fabs(a[i][j]));
    if (!(norm > 0 && norm < INFINITY))
        return norm;
    for (int i = 0; i < 6; i++)
        for (int j = 0; j < 6; j++)
            once[i][j] = a[i][j] / norm;
    square6(once, twice);
    return 1.000001 * norm * sqrt(sqrt(square6(twice, once)));
}

// ---- the bound

// Local damping makes forces against the motion larger by this.
static double grown(const dem_world *w)
{
    return 1 + w->damping.local;
}

// of 4, what contacts and damping take of the room in a step
static double taken_by(const dem_world *w, double h, double k, double c)
{
    return grown(w) * h * (h * k + 2 * c) + 2 * h * w->damping.viscous;
}

// the h at which that is 4
static double limit_of(const dem_world *w, double k, double c)
{
    k *= grown(w);
    c = c * grown(w) + w->damping.viscous;
    return k > 0 || c > 0 ? 4 / (c + sqrt(c * c + 4 * k)) : INFINITY;
}

// one body's contacts, in its axes and in units of its masses
typedef struct body_problem {
    double stiffness[6][6], damping[6][6];
} body_problem;

// k_n n n^T + k_t (1 - n n^T) at `arm`
static void add_stiffness(const dem_world *w, double a[6][6], size_t row, dem_vec3 arm, dem_vec3 n, double kn,
                          double kt)
{
    const double *inertia = w->bodies.inertia + DEM_ROW * row;
    dem_quat q = body_orientation(&w->bodies, row);
    dem_vec3 r = quat_unrotate(q, arm), axis[3] = {quat_unrotate(q, n)};
    axis[1] = v3_normal_to(axis[0]);
    axis[2] = v3_cross(axis[0], axis[1]);
    for (int k = 0; k < 3; k++) {
        dem_vec3 u = axis[k], m = v3_cross(r, u);
        double b[6] = {u.x, u.y, u.z, m.x, m.y, m.z}, stiffness = k == 0 ? kn : kt;
        for (int i = 0; i < 6; i++)
            b[i] *= sqrt(inertia[i < 3 ? 0 : i - 2]);
        for (int i = 0; i < 6; i++)
            for (int j = 0; j < 6; j++)
                a[i][j] += stiffness * b[i] * b[j];
    }
}

// the same for turning: k_tw n n^T + k_r (1 - n n^T)
static void add_turning(const dem_world *w, double a[6][6], size_t row, dem_vec3 n, double twist, double roll)
{
    const double *inertia = w->bodies.inertia + DEM_ROW * row;
    dem_vec3 own = quat_unrotate(body_orientation(&w->bodies, row), n);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            a[3 + i][3 + j] += ((i == j ? roll : 0) + (twist - roll) * v3_get(own, i) * v3_get(own, j)) *
                               sqrt(inertia[1 + i] * inertia[1 + j]);
}

// 1 / (I + m r^2), as the kernels take it
static double inverse_rolling(const dem_world *w, size_t row, double radius)
{
    const double *inertia = w->bodies.inertia + DEM_ROW * row;
    double mean = (inertia[1] + inertia[2] + inertia[3]) / 3;
    return inertia[0] * mean / (inertia[0] + radius * radius * mean);
}

// 1 / mass that a contact at `arm` sees of one body
static double inverse_mass(const dem_world *w, size_t row, dem_vec3 arm, dem_vec3 n)
{
    const double *inertia = w->bodies.inertia + DEM_ROW * row;
    if (!w->features.local_mass)
        return inertia[0];
    dem_vec3 m = quat_unrotate(body_orientation(&w->bodies, row), v3_cross(arm, n));
    return inertia[0] + m.x * m.x * inertia[1] + m.y * m.y * inertia[2] + m.z * m.z * inertia[3];
}

// what a law of the user's says of surfaces at rest, as it remembers them (columns NULL: as new ones)
static dem_law_forces user_forces(const dem_world *w, const double *law, const dem_contact_columns *c,
                                  const dem_touch *t, double mass)
{
    dem_law_contact contact = {.overlap = t->overlap,
                               .overlap_before = t->overlap,
                               .normal = t->normal,
                               .radius_a = t->radius[0],
                               .radius_b = t->radius[1] > 0 ? t->radius[1] : INFINITY,
                               .reduced = t->reduced,
                               .mass = mass,
                               .inverse_mass = 1 / mass,
                               .step = w->next_step,
                               .next_step = w->next_step};
    dem_law_memory memory = {.vector = {{0, 0, 0}}};
    const dem_law_spec *spec = w->laws.plugin.table->spec;
    for (int k = 0; c && k < 3 * spec->vectors; k++)
        v3_set(&memory.vector[k / 3], k % 3, c->user[k][t->place]);
    for (int k = 0; c && k < spec->numbers; k++)
        memory.number[k] = c->user[3 * spec->vectors + k][t->place];
    size_t row = (size_t)(law - w->laws.rows) / LAW_SLOTS;
    return w->laws.plugin.table->law(&contact, w->laws.parameters + DEM_LAW_PARAMETERS * row, &memory);
}

static void add_user_contact(const dem_world *w, body_problem *p, const dem_touch *t, const dem_law_forces *s,
                             uint32_t row, dem_vec3 arm, double times)
{
    add_stiffness(w, p->stiffness, row, arm, t->normal, times * s->stiffness, times * s->slide_stiffness);
    add_stiffness(w, p->damping, row, arm, t->normal, times * s->damping, times * s->slide_damping);
    if (!w->features.user_turns)
        return;
    add_turning(w, p->stiffness, row, t->normal, times * s->turn_stiffness, times * s->turn_stiffness);
    add_turning(w, p->damping, row, t->normal, times * s->turn_damping, times * s->turn_damping);
}

// one contact of a body that stands at `arm` [0] from it and, of a pair, [1] from the other
static void add_contact(const dem_world *w, body_problem *p, const dem_contact_columns *c, const dem_touch *t,
                        const double *law, const uint32_t row[2], const dem_vec3 arm[2], bool wall)
{
    double mass = inverse_mass(w, row[0], arm[0], t->normal);
    if (!wall)
        mass += inverse_mass(w, row[1], arm[1], t->normal);
    mass = 1 / mass;
    if (law[LAW_USER] > 0) {
        dem_law_forces s = user_forces(w, law, c, t, mass);
        add_user_contact(w, p, t, &s, row[0], arm[0], wall ? 1 : 2);
        return;
    }
    double radius = law[LAW_HERTZ] > 0 ? sqrt(t->reduced * larger(t->overlap, 0)) : 0;
    double times = wall || hold_whole(body_hold(&w->bodies, row[1])) ? 1 : 2;  // a body that is held is a wall
    radius += law_radius_at_rest(law, t->reduced);
    double kn = law_stiffness(law, t->area_length, radius), kt = law_slide_stiffness(law, t->area_length, radius);
    add_stiffness(w, p->stiffness, row[0], arm[0], t->normal, times * kn, times * kt);
    double patch2 = t->reduced * larger(t->overlap, 0), roll = law_roll_stiffness(law, t->reduced, kn);
    double twist = law[LAW_TWIST_RATIO] * kt * patch2;
    if (roll + twist > 0)
        add_turning(w, p->stiffness, row[0], t->normal, times * twist, times * roll);
    if (!w->laws.damped && !(roll > 0))
        return;
    double cn = law[LAW_RATE] * mass + law[LAW_ZETA] * sqrt(kn * mass);
    double ct = law[LAW_SLIDE_RATE] * mass + law[LAW_SLIDE_ZETA] * sqrt(kt * mass);
    add_stiffness(w, p->damping, row[0], arm[0], t->normal, times * cn, times * ct);
    if (roll + twist > 0) {
        double inverse = inverse_rolling(w, row[0], t->radius[0]);
        if (!wall)
            inverse += inverse_rolling(w, row[1], t->radius[1]);
        double rolling = law[LAW_ROLL_ZETA] * sqrt(roll / inverse), twisting = law[LAW_TWIST_RATIO] * ct * patch2;
        add_turning(w, p->damping, row[0], t->normal, times * twisting, times * rolling);
    }
}

static const double *law_of(const dem_world *w, const dem_contact_columns *c, size_t at)
{
    return w->laws.rows + (c->law ? (size_t)LAW_SLOTS * c->law[at] : 0);
}

// whether a contact that does not touch counts: where it may hold, and all that are `listed`
static bool counts(const dem_world *w, const dem_contact_columns *c, const dem_touch *t, bool listed)
{
    if (listed || t->overlap > 0)
        return true;
    // at the start nothing is bonded yet
    bool may = w->features.jkr || w->features.user_reaches || w->steps == 0 || (c->bond && c->bond[t->place] > 0);
    return may && t->overlap > -w->reach;
}

static void add_pairs(const dem_world *w, size_t row, bool listed, body_problem *p)
{
    for (size_t i = w->pairs.adjacency_first[row]; i < w->pairs.adjacency_first[row + 1]; i++) {
        const dem_pair *pair = &w->pairs.items[w->pairs.adjacency[i]];
        const dem_segment *s = &w->contacts.segments[pair->a / DEM_SEGMENT];
        for (size_t k = 0; k < pair->count; k++) {
            dem_touch t = dem_touch_of_pair(w, segment_place(s, pair->start + k));
            if (!counts(w, &w->contacts.columns, &t, listed))
                continue;
            dem_vec3 from_a = v3_sub(t.point, body_position(&w->bodies, pair->a));
            dem_vec3 from_b = v3_sub(t.point, v3_add(body_position(&w->bodies, pair->b), t.shift));
            bool first = pair->a == row;
            add_contact(w, p, &w->contacts.columns, &t, law_of(w, &w->contacts.columns, t.place),
                        (uint32_t[]){first ? pair->a : pair->b, first ? pair->b : pair->a},
                        (dem_vec3[]){first ? from_a : from_b, first ? from_b : from_a}, false);
        }
    }
}

static void add_walls(const dem_world *w, size_t row, bool listed, body_problem *p)
{
    for (int form = 0; form < DEM_WALL_FORMS; form++) {
        const dem_contacts *contacts = &w->wall_contacts[form];
        if (!contacts->segments)
            continue;
        const dem_segment *s = &contacts->segments[row / DEM_SEGMENT];
        for (size_t k = 0; k < s->end - s->begin; k++) {
            size_t at = segment_place(s, k);
            if (contacts->columns.a[at] != row)
                continue;
            dem_touch t = dem_touch_of_wall(w, (dem_wall_form)form, at);
            dem_vec3 arm = v3_sub(t.point, body_position(&w->bodies, row));
            if (counts(w, &contacts->columns, &t, listed && form != DEM_FORM_MESH))
                add_contact(w, p, &contacts->columns, &t, law_of(w, &contacts->columns, at),
                            (uint32_t[]){(uint32_t)row, 0}, (dem_vec3[]){arm, arm}, true);
        }
    }
}

// a bond holds in any direction, and its moments besides
static void add_bonds(const dem_world *w, size_t row, body_problem *p)
{
    const dem_bonds *b = w->bonds;
    for (size_t i = b->adjacency_first[row]; i < b->adjacency_first[row + 1]; i++) {
        const dem_bond *bond = &b->items[b->live[b->adjacency[i] >> 1]];
        bool second = b->adjacency[i] & 1;
        const double *k = bond->stiffness, *c = bond->damping;
        dem_bond_load now = dem_bond_now(w, bond);
        dem_vec3 arm = second ? now.arm_b : now.arm_a;
        double times = hold_whole(body_hold(&w->bodies, second ? bond->a : bond->b)) ? 1 : 2;
        add_stiffness(w, p->stiffness, row, arm, now.axis, times * k[BOND_STRETCH], times * k[BOND_SHEAR]);
        add_turning(w, p->stiffness, row, now.axis, times * k[BOND_TWIST], times * k[BOND_BEND]);
        add_stiffness(w, p->damping, row, arm, now.axis, times * c[BOND_STRETCH], times * c[BOND_SHEAR]);
        add_turning(w, p->damping, row, now.axis, times * c[BOND_TWIST], times * c[BOND_BEND]);
    }
}

static void pose_problem(const dem_world *w, size_t row, bool listed, body_problem *p)
{
    memset(p, 0, sizeof *p);
    if (w->features.soft)
        dem_soft_problem(w, row, listed, p->stiffness, p->damping);
    else {
        add_pairs(w, row, listed, p);
        add_walls(w, row, listed, p);
    }
    if (w->bonds)
        add_bonds(w, row, p);
}

// the largest stable step of one body
static dem_step_bound solve_problem(const dem_world *w, size_t row, body_problem *p)
{
    bool damped = w->laws.damped || w->features.rolling || w->bonds;
    double k = dem_largest_eigenvalue6(p->stiffness), c = damped ? dem_largest_eigenvalue6(p->damping) : 0;
    return (dem_step_bound){k, c, limit_of(w, k, c), row};
}

static dem_step_bound body_bound(const dem_world *w, size_t row, bool listed)
{
    body_problem p;
    pose_problem(w, row, listed, &p);
    return solve_problem(w, row, &p);
}

dem_status dem_step_stable(dem_world *w, bool listed, dem_step_bound *bound, dem_error *error)
{
    DEM_TRY(dem_mesh_touch_measure_all(w, error));
    *bound = (dem_step_bound){.step = limit_of(w, 0, 0)};
    for (size_t row = 0; row < w->bodies.count; row++) {
        if (body_absent(&w->bodies, row))
            continue;
        body_problem p;
        pose_problem(w, row, listed, &p);
        // few come near to the worst
        double k = dem_eigenvalue_bound6(p.stiffness), c = dem_eigenvalue_bound6(p.damping);
        if (limit_of(w, k, c) > bound->step)
            continue;
        dem_step_bound own = solve_problem(w, row, &p);
        if (own.step < bound->step)
            *bound = own;
    }
    return DEM_OK;
}

double dem_world_critical_step(dem_world *w)
{
    dem_step_bound bound;
    return dem_step_stable(w, false, &bound, NULL) == DEM_OK ? bound.step : NAN;
}

// ---- the automatic step

// at the overlap that takes up the speed: F d = m v^2 with a linear law, and deeper with one that stiffens [1/s^2]
static double user_frequency2(const dem_world *w, const double *law, double radius, double mass, double speed)
{
    dem_touch t = {.normal = {0, 0, 1}, .reduced = radius / 2, .radius = {radius, radius}};
    dem_law_forces s = {.push = 0};
    for (t.overlap = 1e-9 * radius; t.overlap < radius; t.overlap *= 2) {
        s = user_forces(w, law, NULL, &t, mass);
        if (!(s.push * t.overlap < mass * speed * speed))
            break;
    }
    double stiffness = fmax(s.stiffness, s.push / t.overlap);
    return isfinite(stiffness) && stiffness > 0 ? stiffness / mass : 0;
}

// the frequency of a body's stiffest contact with its like [1/s^2], with Hertz at the speed given
static double stiffest_contact(const dem_world *w, const dem_template *t, double scale, const double *law, double speed)
{
    double r = t->radius_max * scale, mass = t->least_mass * template_bulk(t, scale) / 2;
    double radius = 0;
    if (law[LAW_USER] > 0)
        return user_frequency2(w, law, r, mass, speed);
    if (law[LAW_HERTZ] > 0) {
        // the duration of an impact, as that of a spring: 2.943 d / v = pi / w
        double overlap = pow(15 * mass * speed * speed / (8 * law[LAW_HERTZ] * sqrt(r / 2)), 0.4);
        double frequency = overlap > 0 ? DEM_PI * speed / (2.9432752 * overlap) : 0;
        double rest = law_radius_at_rest(law, r / 2);
        if (!(law[LAW_STIFFNESS] + law[LAW_YOUNG] + rest > 0))
            return frequency * frequency;
        radius = sqrt(r / 2 * overlap) + rest;
    }
    return law_stiffness(law, r / 2, radius) / mass;
}

double dem_step_impact_speed(const dem_world *w)
{
    double fastest = 0, size = 0;
    for (size_t i = 0; w->population && i < w->population->inlet_count; i++) {
        const dem_inlet *inlet = &w->population->inlets[i];
        if (!dem_inlet_over(w, inlet)) {
            fastest = fmax(fastest, v3_norm(inlet->def.velocity) + 3 * inlet->def.velocity_spread);
            size = fmax(size, inlet->radius);
        }
    }
    for (size_t row = 0; row < w->bodies.count; row++) {
        fastest = fmax(fastest, body_stride(&w->bodies, row, 1));
        size = fmax(size, w->bodies.radius[row]);
    }
    return fmax(fmax(2 * fastest, w->sweep_speed), sqrt(20 * v3_norm(w->gravity) * size));
}

// the highest frequency of a body's contacts, squared [1/s^2]
static double highest_frequency(const dem_world *w, uint32_t shape, double scale, double speed)
{
    const dem_template *t = &w->templates.items[shape];
    double highest = 0;
    for (uint32_t other = 0; other < w->laws.material_count; other++) {
        const double *law = laws_between(&w->laws, t->material, other);
        if (law)
            highest = fmax(highest, stiffest_contact(w, t, scale, law, speed));
    }
    return highest;
}

static double accurate_step(const dem_world *w, double highest)
{
    double steps = w->time_def.contact_steps > 0 ? w->time_def.contact_steps : DEM_PI;
    return highest > 0 ? DEM_PI / sqrt(highest) / steps : INFINITY;
}

double dem_step_accurate(const dem_world *w)
{
    double highest = 0, speed = w->features.hertz || w->features.user ? dem_step_impact_speed(w) : 0;
    for (size_t row = 0; row < w->bodies.count; row++)
        if (!body_absent(&w->bodies, row))
            highest = fmax(highest,
                           highest_frequency(w, w->bodies.shape[row], body_scale(&w->bodies, row), speed));
    // usual bodies that are to come; smaller ones lower the step when they do
    for (size_t i = 0; w->population && i < w->population->inlet_count; i++) {
        const dem_inlet *inlet = &w->population->inlets[i];
        dem_fill_draw draw;
        for (size_t k = 0; !dem_inlet_over(w, inlet) && dem_fill_drawer_quantile(inlet->drawer, k, 0.5, &draw); k++)
            highest = fmax(highest, highest_frequency(w, draw.shape, draw.scale, speed));
    }
    return accurate_step(w, highest);
}

static double safety(const dem_world *w)
{
    if (!isnan(w->time_def.safety))
        return w->time_def.safety;
    return w->features.hertz || w->features.user ? SAFETY_HERTZ : SAFETY;
}

static void set_step(dem_world *w, double step)
{
    if (step == w->next_step)
        return;
    w->epoch_time = dem_world_time(w);
    w->epoch_steps = w->steps;
    w->next_step = step;
}

double dem_step_guess(const dem_world *w)
{
    double step = dem_step_accurate(w);
    if (!isfinite(step))
        step = w->time_def.end > 0 ? w->time_def.end / 1000 : 1e-3;
    // global damping must not turn a velocity round
    return w->damping.viscous > 0 ? smaller(step, 1 / w->damping.viscous) : step;
}

// what the contacts of a body may strain it further, with so much of the room taken
static double strain_left(const dem_world *w, double taken)
{
    double most = 4 * safety(w) * safety(w);
    return larger(most - taken, LEAST_REST * most) / grown(w);
}

// what a body may strain before it is asked: nothing is known of it
static void forget_limits(dem_world *w)
{
    double unasked = strain_left(w, taken_by(w, w->next_step, 0, 0));
    for (size_t row = 0; row < w->bodies.count; row++)
        if (!body_absent(&w->bodies, row))
            w->bodies.strain_limit[row] = unasked;
}

dem_status dem_step_choose(dem_world *w, dem_error *error)
{
    double step = w->time_def.step;
    if (w->features.watch) {
        dem_step_bound bound;
        DEM_TRY(dem_step_stable(w, false, &bound, error));
        step = smaller(safety(w) * bound.step, dem_step_guess(w));
    }
    w->next_step = step;
    if (w->features.watch)
        forget_limits(w);
    return DEM_OK;
}

void dem_step_admit(dem_world *w, size_t row)
{
    if (!w->features.watch)
        return;
    double speed = w->features.hertz || w->features.user ? dem_step_impact_speed(w) : 0;
    double step =
        accurate_step(w, highest_frequency(w, w->bodies.shape[row], body_scale(&w->bodies, row), speed));
    set_step(w, smaller(w->next_step, step));
}

// lowers the step where a body's own problem asks for it, and allows it the strain that its present contacts leave
static double ask_body(dem_world *w, const dem_strained *s, double step)
{
    dem_step_bound own = body_bound(w, s->row, false);
    double allowed = safety(w) * own.step, h = step <= allowed ? step : LOWER_BY * allowed;
    // of 4 safety^2, what the contacts take by their eigenvalues; others may come until the rest is used up
    w->bodies.strain_limit[s->row] = s->strain + strain_left(w, taken_by(w, h, own.eigenvalue, own.damping));
    return h;
}

static double raised_step(dem_world *w, double step, dem_error *error)
{
    dem_step_bound bound;
    if (dem_step_stable(w, false, &bound, error) != DEM_OK)
        return step;
    double may = smaller(safety(w) * bound.step, dem_step_guess(w));
    return may > GROW_FROM * step || may < step ? may : step;
}

dem_status dem_step_review(dem_world *w, dem_error *error)
{
    if (!w->features.watch)
        return DEM_OK;
    bool again = w->steps % REVIEW_EVERY == 0;
    if (!w->strained_count && !again)
        return DEM_OK;
    double begin = dem_clock(), step = w->next_step;
    for (size_t i = 0; i < w->strained_count; i++)
        step = ask_body(w, &w->strained[i], step);
    w->strained_count = 0;
    if (again)
        step = raised_step(w, step, error);
    // a lower step strains less: what bodies were allowed stays good
    bool raised = step > w->next_step;
    set_step(w, step);
    if (raised)
        forget_limits(w);
    w->clocks[DEM_PASS_STEP].seconds += dem_clock() - begin;
    return DEM_OK;
}
