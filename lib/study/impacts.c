#include "study/impacts.h"

void dem_impact_model(dem_trial *t, const impact *c)
{
    model *m = dem_trial_model(t);
    m->materials[0] = c->material;
    m->materials[1] = c->partner;
    m->scene.material_count = 2;
    for (uint32_t i = 0; i < 3; i++) {
        m->laws[i] = c->law;
        m->laws[i].materials[0] = i / 2;
        m->laws[i].materials[1] = (i + 1) / 2;
    }
    m->scene.law_count = 3;
    dem_body_def *b = model_body(m, model_sphere(m, c->radius), v3(0, 0, c->radius));
    b->velocity = c->velocity;
    b->spin = c->spin;
    if (c->partner_radius > 0) {
        uint32_t shape = model_sphere(m, c->partner_radius);
        m->shapes[shape].material = 1;
        b = model_body(m, shape, v3(0, 0, -c->partner_radius));
        b->velocity = c->partner_velocity;
        b->spin = c->partner_spin;
    } else
        model_plane(m, v3(0, 0, 0), v3(0, 0, 1))->material = 1;
    m->scene.time.step = elastic_duration(c) / c->steps;
}

rebound dem_impact_watch(dem_trial *t, const impact *c, uint64_t every, impact_curve *curve)
{
    rebound r = {0};
    double gap_before = 0, h = elastic_duration(c) / c->steps;
    dem_impact_model(t, c);
    dem_trial_start(t);
    while (dem_trial_step(t, every)) {
        const dem_figures *f = dem_trial_figures(t);
        double bottom = dem_trial_body(t, 0).position.z - c->radius;
        double gap = c->partner_radius > 0 ? bottom - dem_trial_body(t, 1).position.z - c->partner_radius : bottom;
        if (f->contacts + f->wall_contacts == 0) {
            // the line through the last two looks
            r.duration = dem_trial_time(t) - h * (double)every * gap / (gap - gap_before);
            break;
        }
        gap_before = gap;
        size_t count;
        const dem_contact *contact = dem_trial_contacts(t, &count);
        r.overlap = fmax(r.overlap, contact->overlap);
        r.force = fmax(r.force, contact->normal_force);
        if (curve && curve->count < CURVE) {
            curve->time[curve->count] = dem_trial_time(t);
            curve->overlap[curve->count] = contact->overlap;
            curve->force[curve->count++] = contact->normal_force;
        }
        if (!(dem_trial_time(t) < 100 * elastic_duration(c)))
            t->status = dem_fail(&t->error, DEM_FAILED, "the surfaces do not come apart");
    }
    dem_motion first = dem_trial_body(t, 0), second = dem_trial_body(t, 1);
    r.velocity = first.velocity;
    r.spin = first.spin;
    if (c->partner_radius > 0) {
        r.partner_velocity = second.velocity;
        r.partner_spin = second.spin;
    }
    return r;
}

rebound dem_impact_run(dem_trial *t, const impact *c)
{
    return dem_impact_watch(t, c, 1 + (uint64_t)c->steps / 50, NULL);
}
