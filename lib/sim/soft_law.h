/// What a soft patch does by the laws of the scene, for soft_kernels.c. The laws are those of single contacts, taken
/// with all lanes alike.
#ifndef DEM_SIM_SOFT_LAW_H
#define DEM_SIM_SOFT_LAW_H

#include "sim/contacts.h"
#include "sim/soft_patch.h"

// of a disc, the mean distance of its points from the centre over their radius of gyration; a square has .94, too
static const double MEAN_ARM = 0.94;

typedef struct soft_result {
    double net;              // normal force along D [N]
    dem_vec3 force, moment;  // on a, about its centre [N], [N m]
    dem_vec3 turning;        // what of the moment on a is not that of the force at the mean point [N m]
    double elastic_normal, elastic_slide, elastic_turn;  // [J]
    double lost_friction, lost_viscous;                  // since the last step [J]
    double strain_a, strain_b;                           // h^2 k + 2 h c over the masses, see timestep.h [-]
} soft_result;

static inline double first_lane(wide x)
{
    double lane[DEM_WIDTH];
    wide_store(lane, x);
    return lane[0];
}
static inline dem_vec3 first3(wide3 v)
{
    return v3(first_lane(v.x), first_lane(v.y), first_lane(v.z));
}

// the features that soft contacts can have
static inline dem_features soft_features(const dem_world *w)
{
    const dem_features *f = &w->features;
    return (dem_features){.linear = f->linear,
                          .young = f->young,
                          .hertz = f->hertz,
                          .rate = f->rate,
                          .restitution = f->restitution,
                          .cut = f->cut,
                          .local_mass = f->local_mass,
                          .friction = f->friction,
                          .decay = f->decay,
                          .mindlin = f->mindlin,
                          .slide_damping = f->slide_damping,
                          .ledger = f->ledger,
                          .watch = f->watch,
                          .moving = f->moving,
                          .offset = true,
                          .scaled = true,
                          .periodic = f->periodic};
}

typedef struct soft_spot {
    const double *law;
    double reduced, area;  // R* [m]; R_min^2 / (R_a + R_b) [m]
    double last_step, next_step;
    double times;  // 2 between bodies, 1 at walls: see timestep.h
} soft_spot;

// the dashpot of a patch against what the speeds of its pairs differ by [N s/m]
static inline double uneven_damping(const dem_features f, const double *law, double stiffness, double mass, double step,
                                    double elastic, double net)
{
    double c = 0;
    if (f.rate)
        c = law[LAW_RATE] * mass;
    if (f.restitution)
        c += law[LAW_ZETA] * sqrt(stiffness * mass);
    // fades as the tail of the whole is cut, so that there is no jump
    double fades = elastic > 0 ? smaller(1, larger(0, net / elastic)) : 0;
    return fades * c / (1 + 0.25 * step * c / mass);
}

// the spring and the dashpot against twisting: k_t and c_t times the square of the radius of gyration, capped by the
// points' mean arm
static inline double twist(const dem_features f, const soft_spot *spot, const soft_whole *p, double slide,
                           double slide_damping, double cap, double rate, dem_contact_history *h, soft_result *out)
{
    double stiffness = p->depth > 0 ? slide * p->gyration * p->gyration : 0, old = h->patch, start = h->twist;
    double kept = stiffness > old ? old / stiffness : 1, most = cap * MEAN_ARM * p->gyration;
    double spring = stiffness * (start * kept + spot->last_step * rate);
    spring = larger(-most, smaller(most, spring));
    h->twist = stiffness > 0 ? spring / stiffness : 0;
    h->patch = stiffness;
    double held = spring * h->twist, damping = p->depth > 0 ? slide_damping * p->gyration * p->gyration : 0;
    double moment = larger(-most, smaller(most, spring + damping * rate));
    out->elastic_turn = held / 2;
    if (f.ledger) {
        out->lost_friction += 0.5 * (spot->last_step * (spring + old * start) * rate - (held - old * start * start));
        out->lost_viscous += spot->last_step * (moment - spring) * rate;
    }
    return moment;
}

static inline dem_vec3 soft_slide(const dem_features f, const soft_spot *spot, const soft_patch_data *p,
                                  const soft_whole *s, const wide *law, normal_law *normal, const contact_mass *mass,
                                  dem_contact_history *h, soft_result *out, double *slide, double *slide_damping)
{
    dem_vec3 from_b = v3_sub(s->point, p->between);
    dem_vec3 v = v3_sub(v3_add(p->b->velocity, v3_cross(p->b->spin, from_b)),
                        v3_add(p->a->velocity, v3_cross(p->a->spin, s->point)));
    double vn = v3_dot(v, s->n), turn = 0.5 * spot->last_step * v3_dot(v3_add(p->a->spin, p->b->spin), s->n);
    dem_vec3 slip = v3_along(v, -vn, s->n);
    wide3 spring = spring_turn(all3(v3(h->spring[0], h->spring[1], h->spring[2])), all3(s->n), wide_all(turn));
    // the cap is by the force along the mean normal
    normal->force = normal->force * wide_all(s->along);
    friction_law t = friction(f, law, normal, wide_all(spot->reduced), wide_all(s->depth), wide_all(s->speed),
                              mass, spring, all3(slip), wide_all(spot->last_step),
                              wide_less(wide_all(0), wide_all(s->depth)), wide_less(wide_all(1), wide_all(0)));
    dem_vec3 after = first3(t.spring), dash = first3(t.dash);
    *slide = first_lane(t.stiffness);
    *slide_damping = first_lane(t.damping);
    out->elastic_slide = 0.5 * *slide * v3_norm2(after);
    out->lost_friction += first_lane(t.lost);
    if (f.ledger && f.slide_damping) {
        dem_vec3 both = v3_add(v3(h->dash[0], h->dash[1], h->dash[2]), dash);
        out->lost_viscous += 0.5 * spot->last_step * v3_dot(both, slip);
    }
    for (int k = 0; k < 3; k++) {
        h->spring[k] = v3_get(after, k);
        h->dash[k] = v3_get(dash, k);
    }
    return first3(t.force);
}

// what the patch takes of the room for a stable step: along D, what its pairs differ by, sliding and twisting
static inline void soft_strain(const soft_spot *spot, const soft_patch_data *p, const soft_whole *s, double stiffness,
                               double per_tau, double c, double slide, double slide_damping, soft_result *out)
{
    double h = spot->next_step, gyration = s->gyration * s->gyration;
    for (int k = 0; k < 2; k++) {
        const soft_side *side = k == 0 ? p->a : p->b;
        double share = k == 0 ? s->share_a : s->share_b, spread = (k == 0 ? s->spread_a : s->spread_b) - share;
        double tangent = 2 * side->brisk + gyration * side->quick;
        double taken = stiffness * share + per_tau * spread + slide * tangent;
        double damping = c * (share + spread) + slide_damping * tangent;
        *(k == 0 ? &out->strain_a : &out->strain_b) = spot->times * h * (h * taken + 2 * damping);
    }
}

/// The patch touches, or has just parted: then there is no force, but something may be lost.
static inline soft_result soft_act(const dem_features f, const soft_spot *spot, const soft_patch_data *p,
                                   const soft_whole *s, dem_contact_history *h)
{
    soft_result out = {0};
    wide law[LAW_SLOTS];
    for (int k = 0; k < LAW_SLOTS; k++)
        law[k] = wide_all(spot->law[k]);
    double inverse = f.local_mass ? s->share_a + s->share_b : p->a->inverse_mass + p->b->inverse_mass;
    inverse = larger(inverse, 1e-300);
    contact_mass mass = contact_mass_of(f, wide_all(inverse));
    double step = spot->last_step > 0 ? spot->last_step : spot->next_step;
    normal_law normal = normal_elastic(f, law, NULL, wide_all(s->depth), wide_all(spot->reduced), wide_all(spot->area));
    normal_damp(f, law, &normal, &mass, wide_all(s->depth), wide_all(s->speed), wide_all(spot->last_step),
                wide_all(1 / step));
    double elastic = first_lane(normal.elastic), stiffness = first_lane(normal.stiffness), slide = 0, slide_damping = 0;
    double c = uneven_damping(f, spot->law, stiffness, 1 / inverse, spot->last_step, elastic, first_lane(normal.force));
    out.net = first_lane(normal.force);
    if (!(s->depth > 0))
        elastic = out.net = c = 0;  // the patch has just parted, and lets go of what its springs held
    // of the linear part F = k d the half, of Hertz' F = 2/3 k d two fifths
    double linear = f.hertz ? 3 * elastic - 2 * stiffness * s->depth : elastic;
    out.elastic_normal = s->depth <= 0 ? 0 : (linear / 2 + (elastic - linear) * 2 / 5) * s->depth;
    if (f.ledger && (f.rate || f.restitution)) {
        double now = elastic - out.net;
        out.lost_viscous = 0.5 * (h->loss + now) * s->speed * spot->last_step + spot->last_step * c * s->uneven_power;
        h->loss = now;
    }
    out.force = v3_sub(v3_scale(s->uneven, c), v3_scale(s->normal, out.net));
    out.moment = v3_sub(v3_scale(s->uneven_turn, c), v3_scale(s->turn, out.net));
    if (f.friction) {
        dem_vec3 drag = soft_slide(f, spot, p, s, law, &normal, &mass, h, &out, &slide, &slide_damping);
        double cap = spot->law[LAW_FRICTION] * fabs(out.net) * s->along;
        double rate = v3_dot(v3_sub(p->b->spin, p->a->spin), s->n);
        double turning = twist(f, spot, s, slide, slide_damping, cap, rate, h, &out);
        out.force = v3_add(out.force, drag);
        out.moment = v3_add(out.moment, v3_along(v3_cross(s->point, drag), turning, s->n));
    }
    out.turning = v3_sub(out.moment, v3_cross(s->point, out.force));
    if (f.watch)
        soft_strain(spot, p, s, stiffness, larger(out.net, elastic) / p->tau, c, slide, slide_damping, &out);
    return out;
}

#endif
