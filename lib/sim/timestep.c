#include "sim/timestep.h"

#include <stdlib.h>
#include <string.h>

#include "base/status.h"
#include "sim/measure.h"

enum {
    REVIEW_EVERY = 100, // steps between looks at an automatic step
    EXACT_EVERY = 1000, // ... and at its bound where the cheap one does not suffice
};

static const double SAFETY = 0.8, SAFETY_HERTZ = 0.5;
static const double GROW_FROM = 1.1; // a step is not raised for less
static const double CRUDE_GROWTH = 1.12;  // of the step's cheap bound, that asks for the exact one

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

// ---- the bound

// the h at which h^2 k + 2 h c = 4
static double limit_of(double k, double c)
{
    return k > 0 || c > 0 ? 4 / (c + sqrt(c * c + 4 * k)) : INFINITY;
}

typedef double matrix6[6][6];

typedef struct assembly {
    matrix6 *stiffness, *damping;  // [bodies] in the body's axes, in units of its masses
    bool listed;
} assembly;

// k_n n n^T + k_t (1 - n n^T) at `arm`, seen in the body's axes and in units of its masses
static void add_stiffness(const dem_world *w, matrix6 *a, size_t row, dem_vec3 arm, dem_vec3 n, double kn, double kt)
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
                (*a)[i][j] += stiffness * b[i] * b[j];
    }
}

// overlap of a Hertz contact that is to be expected: of the present speed [m]
static double expected_overlap(const dem_world *w, const dem_contact_item *item, const dem_contact_record *r, bool wall,
                               double reduced)
{
    double speed = body_stride(&w->bodies, item->a, 1) + (wall ? w->sweep_speed : body_stride(&w->bodies, item->b, 1));
    double inverse = w->bodies.inertia[DEM_ROW * item->a] + (wall ? 0 : w->bodies.inertia[DEM_ROW * item->b]);
    const double *law = w->laws.rows + (size_t)LAW_SLOTS * item->law;
    double impact = pow(15 * speed * speed / (8 * inverse * law[LAW_HERTZ] * sqrt(reduced)), 0.4);
    return fmax(r->overlap, impact);
}

// a contact by its numbers along the normal and across it
typedef struct stiffness {
    double normal, slide, damping, slide_damping;  // [N/m], [N s/m]
} stiffness;

static stiffness stiffness_of(const dem_world *w, const assembly *all, const dem_contact_item *item,
                              const dem_contact_record *r, bool wall)
{
    const double *law = w->laws.rows + (size_t)LAW_SLOTS * item->law;
    double ra = w->templates.spheres[item->sphere_a][3] * body_scale(&w->bodies, item->a);
    double rb = wall ? ra : w->templates.spheres[item->sphere_b][3] * body_scale(&w->bodies, item->b);
    double area = wall ? ra : fmin(ra, rb) * fmin(ra, rb) / (ra + rb), radius = 0, m = r->reduced_mass;
    if (law[LAW_HERTZ] > 0) {
        double reduced = wall ? ra : ra * rb / (ra + rb);
        radius = sqrt(reduced * fmax(all->listed ? expected_overlap(w, item, r, wall, reduced) : r->overlap, 0));
    }
    stiffness s = {.normal = law_stiffness(law, area, radius), .slide = law_slide_stiffness(law, area, radius)};
    s.damping = law[LAW_RATE] * m + law[LAW_ZETA] * sqrt(s.normal * m);
    s.slide_damping = law[LAW_SLIDE_RATE] * m + law[LAW_SLIDE_ZETA] * sqrt(s.slide * m);
    return s;
}

static void visit_stiffness(void *user, dem_world *w, int form, const dem_contact_item *item,
                            const dem_contact_record *r)
{
    assembly *all = user;
    bool wall = form >= 0;
    if (!r->touches && !all->listed)
        return;
    stiffness s = stiffness_of(w, all, item, r, wall);
    dem_vec3 n = v3(r->normal[0], r->normal[1], r->normal[2]);
    dem_vec3 arm[2] = {v3(r->point_a[0], r->point_a[1], r->point_a[2]), v3(r->point_b[0], r->point_b[1], r->point_b[2])};
    uint32_t row[2] = {item->a, item->b};
    for (int side = 0; side < (wall ? 1 : 2); side++) {
        double times = wall ? 1 : 2;
        add_stiffness(w, &all->stiffness[row[side]], row[side], arm[side], n, times * s.normal, times * s.slide);
        if (w->laws.damped)
            add_stiffness(w, &all->damping[row[side]], row[side], arm[side], n, times * s.damping,
                          times * s.slide_damping);
    }
}

static double trace(matrix6 *a)
{
    double sum = 0;
    for (int i = 0; i < 6; i++)
        sum += (*a)[i][i];
    return sum;
}

dem_status dem_step_stable(dem_world *w, bool listed, dem_step_bound *bound, dem_error *error)
{
    size_t n = w->bodies.count;
    assembly all = {dem_alloc_zero(n, sizeof *all.stiffness), dem_alloc_zero(w->laws.damped ? n : 0, sizeof *all.damping),
                    listed};
    *bound = (dem_step_bound){.step = INFINITY};
    dem_status status = all.stiffness && all.damping ? DEM_OK : dem_fail_memory(error);
    if (status == DEM_OK)
        status = dem_visit_contacts(w, visit_stiffness, &all, error);
    for (size_t row = 0; status == DEM_OK && row < n; row++) {
        matrix6 *k = &all.stiffness[row], *c = w->laws.damped ? &all.damping[row] : NULL;
        // no eigenvalue is larger than the trace
        if (limit_of(trace(k), c ? trace(c) : 0) >= bound->step)
            continue;
        double largest = dem_largest_eigenvalue6(*k), damping = c ? dem_largest_eigenvalue6(*c) : 0;
        double step = limit_of(largest, damping);
        if (step < bound->step)
            *bound = (dem_step_bound){largest, damping, step, row};
    }
    free(all.stiffness);
    free(all.damping);
    return status;
}

double dem_world_critical_step(dem_world *w)
{
    dem_step_bound bound;
    return dem_step_stable(w, false, &bound, NULL) == DEM_OK ? bound.step : NAN;
}

// ---- the automatic step

// the frequency of a body's stiffest contact with its like [1/s^2], with Hertz at the speed given
static double stiffest_contact(const dem_world *w, size_t row, const double *law, double speed)
{
    const dem_template *t = &w->templates.items[w->bodies.shape[row]];
    double scale = body_scale(&w->bodies, row), r = t->radius_max * scale,
           mass = t->least_mass * scale * scale * scale / 2;
    double radius = 0;
    if (law[LAW_HERTZ] > 0) {
        // the duration of an impact, as that of a spring: 2.943 d / v = pi / w
        double overlap = pow(15 * mass * speed * speed / (8 * law[LAW_HERTZ] * sqrt(r / 2)), 0.4);
        double frequency = overlap > 0 ? DEM_PI * speed / (2.9432752 * overlap) : 0;
        if (!(law[LAW_STIFFNESS] + law[LAW_YOUNG] > 0))
            return frequency * frequency;
        radius = sqrt(r / 2 * overlap);
    }
    return law_stiffness(law, r / 2, radius) / mass;
}

// a speed that impacts may have: twice the present one, or of a fall by some sizes [m/s]
static double impact_speed(const dem_world *w)
{
    double fastest = 0, size = 0;
    for (size_t row = 0; row < w->bodies.count; row++) {
        fastest = fmax(fastest, body_stride(&w->bodies, row, 1));
        size = fmax(size, w->bodies.radius[row]);
    }
    return fmax(fmax(2 * fastest, w->sweep_speed), sqrt(20 * v3_norm(w->gravity) * size));
}

double dem_step_accurate(const dem_world *w)
{
    double highest = 0, speed = w->features.hertz ? impact_speed(w) : 0;
    size_t n = w->laws.material_count;
    for (size_t row = 0; row < w->bodies.count; row++) {
        uint32_t material = w->templates.items[w->bodies.shape[row]].material;
        for (uint32_t other = 0; other < n; other++) {
            const double *law = laws_between(&w->laws, material, other);
            if (law)
                highest = fmax(highest, stiffest_contact(w, row, law, speed));
        }
    }
    double steps = w->time_def.contact_steps > 0 ? w->time_def.contact_steps : DEM_PI;
    return highest > 0 ? DEM_PI / sqrt(highest) / steps : INFINITY;
}

static double safety(const dem_world *w)
{
    return isnan(w->time_def.safety) ? (w->features.hertz ? SAFETY_HERTZ : SAFETY) : w->time_def.safety;
}

// a lower bound of the stable step in the time of a look: the listed contacts of a body times the worst one can do
static double crude_step(const dem_world *w)
{
    double least = INFINITY;
    size_t n = w->laws.material_count;
    for (size_t row = 0; row < w->bodies.count; row++) {
        double contacts = 0;
        for (size_t i = w->pairs.adjacency_first[row]; i < w->pairs.adjacency_first[row + 1]; i++)
            contacts += w->pairs.items[w->pairs.adjacency[i]].count;
        const dem_template *t = &w->templates.items[w->bodies.shape[row]];
        double scale = body_scale(&w->bodies, row), cube = scale * scale * scale, r = t->radius_max * scale;
        double mass = t->mass * cube, inverse = 2 * contacts / (t->least_mass * cube);
        for (uint32_t other = 0; other < n; other++) {
            const double *law = laws_between(&w->laws, t->material, other);
            if (!law)
                continue;
            double k = law_stiffness(law, r / 2, r), kt = law_slide_stiffness(law, r / 2, r);
            double c = law[LAW_RATE] * mass + law[LAW_ZETA] * sqrt(k * mass);
            double ct = law[LAW_SLIDE_RATE] * mass + law[LAW_SLIDE_ZETA] * sqrt(kt * mass);
            least = fmin(least, limit_of(inverse * (k + 2 * kt), inverse * (c + 2 * ct)));
        }
    }
    return least;
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
    return isfinite(step) ? step : w->time_def.end > 0 ? w->time_def.end / 1000 : 1e-3;
}

static dem_status choose(dem_world *w, double *step, dem_error *error)
{
    dem_step_bound bound;
    DEM_TRY(dem_step_stable(w, true, &bound, error));
    w->crude_then = crude_step(w);
    w->exact_then = w->steps;
    w->stable_step = bound.step;
    *step = fmin(safety(w) * bound.step, dem_step_guess(w));
    return DEM_OK;
}

dem_status dem_step_choose(dem_world *w, dem_error *error)
{
    double step = w->time_def.step;
    if (!(step > 0))
        DEM_TRY(choose(w, &step, error));
    w->last_step = w->next_step = step;
    return DEM_OK;
}

dem_status dem_step_review(dem_world *w, dem_error *error)
{
    if (w->time_def.step > 0 || w->steps % REVIEW_EVERY != 0)
        return DEM_OK;
    double begin = dem_clock(), crude = crude_step(w), step = dem_step_guess(w);
    // where even the cheap bound asks for no smaller step, the other need not be known
    if (safety(w) * crude < step) {
        if (CRUDE_GROWTH * crude < w->crude_then || w->steps - w->exact_then >= EXACT_EVERY)
            DEM_TRY(choose(w, &step, error));
        else
            step = fmin(step, safety(w) * w->stable_step);
    }
    if (step < w->next_step || step > GROW_FROM * w->next_step)
        set_step(w, step);
    w->clocks[DEM_PASS_STEP].seconds += dem_clock() - begin;
    return DEM_OK;
}
