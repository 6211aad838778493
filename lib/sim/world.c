#include <stdlib.h>
#include <string.h>

#include "base/status.h"
#include "sim/bodies.h"
#include "sim/bonds.h"
#include "sim/broad.h"
#include "sim/contacts.h"
#include "sim/fluid.h"
#include "sim/lists.h"
#include "sim/measure.h"
#include "sim/motion.h"
#include "sim/pairs.h"
#include "sim/place.h"
#include "sim/population.h"
#include "sim/refresh.h"
#include "sim/scene.h"
#include "sim/schemes.h"
#include "sim/servo.h"
#include "sim/timestep.h"
#include "sim/touch.h"
#include "sim/wear.h"

static const char *const pass_names[DEM_PASSES] = {
    [DEM_PASS_PAIRS] = "contacts", [DEM_PASS_WALLS] = "walls",     [DEM_PASS_MOTION] = "motion",
    [DEM_PASS_SEARCH] = "search",  [DEM_PASS_REFRESH] = "refresh", [DEM_PASS_LISTS] = "lists",
    [DEM_PASS_STEP] = "time step", [DEM_PASS_MEASURE] = "measure",
    [DEM_PASS_BONDS] = "bonds",
};

enum { THREADS_FROM = 512, DOMAINS = 8, DOMAIN_LEAST = 256, DOMAIN_MOST = 4096 };
enum { BODIES_IN_CACHE = 2048 };  // with their momenta half a megabyte

// ---- making a world

static dem_status copy_shapes(dem_world *w, const dem_scene *scene, dem_error *error)
{
    w->shape_count = scene->shape_count;
    w->clumps = dem_alloc_zero(w->shape_count, sizeof *w->clumps);
    w->shape_names = dem_alloc_zero(w->shape_count, sizeof *w->shape_names);
    if (!w->clumps || !w->shape_names)
        return dem_fail_memory(error);
    for (size_t i = 0; i < w->shape_count; i++) {
        const dem_shape_def *shape = &scene->shapes[i];
        w->shape_names[i] = strdup(shape->name ? shape->name : "");
        if (!w->shape_names[i])
            return dem_fail_memory(error);
        if (shape->clump) {
            size_t bytes = dem_clump_bytes(shape->clump);
            w->clumps[i] = malloc(bytes);
            if (!w->clumps[i])
                return dem_fail_memory(error);
            memcpy(w->clumps[i], shape->clump, bytes);
        } else
            DEM_TRY(dem_sphere_clump(scene, i, &w->clumps[i], error));
    }
    return DEM_OK;
}

// what the scene needs of the kernels
static void set_features(dem_world *w, const dem_scene *scene, const dem_body_def *defs, size_t count)
{
    dem_features *f = &w->features;
    *f = w->laws.needs;
    f->watch = !(w->time_def.step > 0);
    f->ledger = w->ledger && (w->laws.damped || f->jkr || f->friction || features_turning(*f) || w->walls.move);
    f->periodic = w->periodic;
    f->moving = w->walls.move;
    f->reaction = w->walls.servo || w->walls.rub;
    f->weighted = w->multiple == DEM_MULTIPLE_MEAN || w->multiple == DEM_MULTIPLE_MERGE;
    f->soft = w->multiple == DEM_MULTIPLE_SOFT;
    for (size_t i = 0; i < scene->inlet_count; i++)
        for (size_t k = 0; k < scene->inlets[i].mix_count; k++) {
            f->offset |= !w->templates.items[scene->inlets[i].mix[k].shape].centred;
            f->scaled |= scene->inlets[i].mix[k].size.law != DEM_SIZE_AS_IS;
        }
    for (size_t i = 0; i < count; i++) {
        f->offset |= !w->templates.items[defs[i].shape].centred;
        f->scaled |= defs[i].scale != 1;
    }
}

static bool used(const dem_world *w, dem_wall_form form)
{
    for (size_t i = 0; i < w->walls.count; i++)
        if (w->walls.items[i].form == form)
            return true;
    return false;
}

static dem_status make_lists(dem_world *w, dem_error *error)
{
    size_t n = w->bodies.count;
    w->segment_count = (n + DEM_SEGMENT - 1) / DEM_SEGMENT;
    // a domain depends on the number of bodies only, so that sums do not depend on the threads
    w->domain_bodies = (n / DOMAINS / DEM_SEGMENT + 1) * DEM_SEGMENT;
    w->domain_bodies = w->domain_bodies < DOMAIN_LEAST ? DOMAIN_LEAST : w->domain_bodies;
    w->domain_bodies = w->domain_bodies > DOMAIN_MOST ? DOMAIN_MOST : w->domain_bodies;
    DEM_TRY(dem_contacts_create(w, &w->contacts, -1, error));
    for (int form = 0; form < DEM_WALL_FORMS; form++)
        if (used(w, (dem_wall_form)form))
            DEM_TRY(dem_contacts_create(w, &w->wall_contacts[form], form, error));
    if (used(w, DEM_FORM_MESH))
        w->mesh_touches = dem_alloc_zero(w->segment_count, sizeof *w->mesh_touches);
    w->tallies = dem_alloc_zero(w->segment_count * (1 + DEM_WALL_FORMS), sizeof *w->tallies);
    w->motion_tallies = dem_alloc_zero(w->segment_count, sizeof *w->motion_tallies);
    w->wear_events = dem_alloc_zero(w->walls.wear ? w->segment_count : 0, sizeof *w->wear_events);
    w->servo_sums = dem_alloc_zero(w->walls.servo ? w->segment_count * w->walls.count : 0, sizeof *w->servo_sums);
    w->asked = dem_alloc(w->bodies.padded, sizeof *w->asked);
    w->strained = dem_alloc(w->features.watch ? w->bodies.padded : 0, sizeof *w->strained);
    w->part_strained = dem_alloc_zero((size_t)w->threads + 1, sizeof *w->part_strained);
    w->part_asked = dem_alloc_zero((size_t)w->threads + 1, sizeof *w->part_asked);
    w->parts = dem_alloc_zero((size_t)w->threads + 1, sizeof *w->parts);
    w->candidates = dem_alloc_zero((size_t)w->threads, sizeof *w->candidates);
    if ((used(w, DEM_FORM_MESH) && !w->mesh_touches) || !w->tallies || !w->motion_tallies || !w->servo_sums || !w->wear_events || !w->asked ||
        !w->part_asked || !w->strained || !w->part_strained || !w->parts || !w->candidates)
        return dem_fail_memory(error);
    size_t longest = 0;
    for (size_t i = 0; i < w->templates.count; i++)
        if (w->templates.items[i].float_padded > longest)
            longest = w->templates.items[i].float_padded;
    for (int t = 0; t < w->threads; t++) {
        w->candidates[t].work = aligned_alloc(64, (8 * longest + 6 * 64) * sizeof(float));
        if (!w->candidates[t].work)
            return dem_fail_memory(error);
    }
    return dem_views_create(w, error);
}

// under the law that lets surfaces hold farthest; of JKR for the largest spheres, of bonds for the smallest
static dem_status set_reach(dem_world *w, dem_error *error)
{
    double most = 0, least = INFINITY;
    if (w->population)
        dem_population_spheres(w, &least, &most);
    for (size_t row = 0; row < w->bodies.count; row++) {
        if (body_absent(&w->bodies, row))
            continue;
        const dem_template *t = &w->templates.items[w->bodies.shape[row]];
        most = larger(most, t->radius_max * body_scale(&w->bodies, row));
        least = smaller(least, t->radius_min * body_scale(&w->bodies, row));
    }
    const dem_features *f = &w->features;
    for (size_t i = 0; (f->jkr || f->bonded || f->user_reaches) && most > 0 && i < w->laws.count; i++) {
        const double *law = w->laws.rows + LAW_SLOTS * i;
        double user = fmax(law_user_reach(&w->laws, i, most), law_user_reach(&w->laws, i, least / 2));
        if (!(user <= least))
            return dem_fail(error, DEM_BAD_INPUT,
                            "the law of the plug-in would hold until surfaces are %.3g m apart, more than the smallest "
                            "radius, %.3g m; check its numbers",
                            user, least);
        w->reach = larger(w->reach, user);
        double bond = law_bond_reach(law, least * least / (least + most));
        if (!(bond <= least))
            return dem_fail(error, DEM_BAD_INPUT,
                            "breakable cohesion would hold until surfaces are %.3g m apart, more than the smallest "
                            "radius, %.3g m; lower \"tension\" or \"gap\", or raise the stiffness",
                            bond, least);
        w->reach = larger(w->reach, larger(law_reach(law, most), bond));
    }
    return DEM_OK;
}

static void set_holds(dem_world *w, const dem_scene *scene, const dem_body_def *defs, size_t count)
{
    for (size_t i = 0; i < scene->inlet_count; i++) {
        bool sphere = scene->inlets[i].kind == DEM_INLET_SPHERE;
        w->held |= sphere || scene->dimension == 2;
        w->kept |= sphere;
    }
    for (size_t i = 0; i < count; i++) {
        w->held |= defs[i].hold != 0;
        w->kept |= (defs[i].hold & (DEM_HOLD_VELOCITY | DEM_HOLD_SPIN)) != 0;
    }
    w->other_motion = w->held || !dem_schemes_default(w->integrator);
}

// the contacts that bonds stand for leave the lists
static dem_status make_bonds(dem_world *w, dem_error *error)
{
    DEM_TRY(dem_bonds_make(w, error));
    return w->bonds->instead ? dem_lists_update(w, error) : DEM_OK;
}

static size_t body_of_row(const dem_world *w, size_t row)
{
    size_t i = 0;
    while (i < w->bodies.living && w->bodies.place[i] != row)
        i++;
    return i;
}

// Spheres with one centre have no direction to push each other. Where that happens on the way other contacts or the
// next step help; two bodies that begin in one place would stay there for good.
static dem_status check_places(const dem_world *w, dem_error *error)
{
    for (size_t i = 0; i < w->pairs.count; i++) {
        const dem_pair *p = &w->pairs.items[i];
        const dem_segment *s = &w->contacts.segments[p->a / DEM_SEGMENT];
        dem_vec3 x = body_position(&w->bodies, p->a);
        double same = 1e-12 * w->bodies.radius[p->a];
        if (p->a == p->b || v3_distance(x, body_position(&w->bodies, p->b)) > same)
            continue;
        for (size_t k = 0; k < p->count; k++) {
            dem_touch t = dem_touch_of_pair(w, segment_place(s, p->start + k));
            if (t.overlap >= t.radius[0] + t.radius[1] - same)
                return dem_fail(error, DEM_BAD_INPUT,
                                "bodies %zu and %zu stand in one place (%.6g, %.6g, %.6g) m, where nothing pushes them "
                                "apart; is one of them there twice?",
                                body_of_row(w, p->a), body_of_row(w, p->b), x.x, x.y, x.z);
        }
    }
    return DEM_OK;
}

// `spent`: the scene, where what has been taken from it may be forgotten, or NULL
static dem_status make_state(dem_world *w, const dem_scene *scene, dem_scene *spent, dem_error *error)
{
    dem_body_def *defs = NULL;
    size_t count = 0;
    DEM_TRY(copy_shapes(w, scene, error));
    DEM_TRY(dem_templates_create(scene, &w->templates, error));
    DEM_TRY(dem_laws_create(scene, &w->laws, error));
    DEM_TRY(dem_walls_create(w->ctx, scene, &w->walls, error));
    DEM_TRY(dem_population_create(w, scene, error));
    DEM_TRY(dem_place_bodies(w, scene, &defs, &count, error));
    if (spent)
        dem_scene_forget_files(spent);
    set_holds(w, scene, defs, count);
    set_features(w, scene, defs, count);
    size_t instances;
    const dem_contact_instance *kernels = world_instances(w, &instances);
    dem_features walls = w->features.user ? features_for_plugin(w->features) : w->features, still = walls;
    still.moving = still.reaction = false;
    w->instance = dem_kernels_instance(kernels, still);
    w->wall_instance = dem_kernels_instance(kernels, walls);
    dem_status status = dem_bodies_create(w, defs, count, dem_population_rows(w, count), error);
    if (w->population)
        w->population->next_id = count;
    if (w->bodies.count < THREADS_FROM && !dem_population_reaches(w, THREADS_FROM))
        w->threads = 1;
    if (status == DEM_OK)
        status = dem_bonds_create(w, scene, defs, error);
    free(defs);
    DEM_TRY(status);
    w->team = dem_team_create(w->threads);
    if (!w->team)
        return dem_fail_memory(error);
    DEM_TRY(dem_soft_create(w, scene->soft.tau, error));
    DEM_TRY(set_reach(w, error));
    w->skin = w->skin_least = larger(larger(dem_broad_skin(w), 2.2 * w->reach), 1.1 * dem_bonds_gap(w));
    DEM_TRY(dem_search_create(w, error));
    if (w->periodic)
        DEM_TRY(dem_broad_images(w, error));
    DEM_TRY(make_lists(w, error));
    DEM_TRY(dem_regions_create(scene, w->clumps, &w->regions, error));
    for (size_t i = 0; i < count; i++)
        w->asked[i] = (uint32_t)i;
    w->asked_count = count;
    // good enough for the margins of the first lists
    w->next_step = w->last_step = w->time_def.step > 0 ? w->time_def.step : dem_step_guess(w);
    DEM_TRY(dem_lists_update(w, error));
    if (w->bonds && w->bonds->due <= 0)
        DEM_TRY(make_bonds(w, error));
    DEM_TRY(check_places(w, error));
    DEM_TRY(dem_step_choose(w, error));
    // the first step kicks for half of it, which takes the momenta from the time of the positions
    w->last_step = 0;
    return DEM_OK;
}

static dem_status check_fluid(const dem_drag_def *drag, dem_error *error)
{
    if (drag->density >= 0 && drag->viscosity >= 0 && isfinite(drag->density + drag->viscosity) &&
        isfinite(v3_norm2(drag->velocity)))
        return DEM_OK;
    return dem_fail(error, DEM_USAGE, "damping.drag: has a number that cannot be; give density and viscosity from 0");
}

static dem_status check_schemes(const dem_scene *scene, dem_error *error)
{
    if ((unsigned)scene->integrator.translation < DEM_TRANSLATION_SCHEMES &&
        (unsigned)scene->integrator.rotation < DEM_ROTATION_SCHEMES)
        return DEM_OK;
    return dem_fail(error, DEM_USAGE, "integrator: there is no such scheme; take one of dem_translation, dem_rotation");
}

static dem_status create(const dem_ctx *ctx, const dem_scene *scene, dem_scene *spent, dem_world **world,
                         dem_error *error)
{
    *world = NULL;
    DEM_TRY(check_schemes(scene, error));
    DEM_TRY(check_fluid(&scene->damping.drag, error));
    dem_world *w = *world = aligned_alloc(64, (sizeof *w + 63) / 64 * 64);
    if (!w)
        return dem_fail_memory(error);
    *w = (dem_world){.gravity = scene->gravity,
                     .domain = scene->domain,
                     .damping = scene->damping,
                     .multiple = scene->multiple,
                     .integrator = scene->integrator,
                     .time_def = scene->time,
                     .ledger = scene->output.energy,
                     .threads = dem_threads(ctx),
                     .kernels = dem_kernels_choose(NULL)};
    w->own_ctx = ctx ? *ctx : (dem_ctx){0};
    w->ctx = &w->own_ctx;
    w->periodic = scene->domain.periodic[0] || scene->domain.periodic[1] || scene->domain.periodic[2];
    for (int i = 0; i < DEM_PASSES; i++)
        w->clocks[i].name = pass_names[i];
    dem_status status = make_state(w, scene, spent, error);
    if (status == DEM_OK)
        status = dem_world_measure(w, error);
    dem_world_reset_clocks(w);
    if (status != DEM_OK) {
        dem_world_destroy(w);
        *world = NULL;
    }
    return status;
}

dem_status dem_world_create(const dem_ctx *ctx, const dem_scene *scene, dem_world **world, dem_error *error)
{
    return create(ctx, scene, NULL, world, error);
}

dem_status dem_world_create_spending(const dem_ctx *ctx, dem_scene *scene, dem_world **world, dem_error *error)
{
    return create(ctx, scene, scene, world, error);
}

void dem_world_destroy(dem_world *w)
{
    if (!w)
        return;
    for (size_t i = 0; i < w->shape_count; i++) {
        if (w->clumps)
            dem_clump_destroy(w->clumps[i]);
        if (w->shape_names)
            free(w->shape_names[i]);
    }
    dem_templates_release(&w->templates);
    dem_laws_release(&w->laws);
    dem_walls_release(&w->walls);
    dem_population_release(w->population);
    dem_bodies_release(&w->bodies);
    dem_pairs_release(&w->pairs);
    dem_search_destroy(w->search);
    dem_contacts_release(&w->contacts, w->segment_count);
    for (int form = 0; form < DEM_WALL_FORMS; form++)
        dem_contacts_release(&w->wall_contacts[form], w->segment_count);
    for (size_t i = 0; w->mesh_touches && i < w->segment_count; i++)
        dem_mesh_touches_release(&w->mesh_touches[i]);
    dem_refresh_forget(w);
    for (int t = 0; w->candidates && t < w->threads; t++)
        free(w->candidates[t].work);
    dem_soft_release(w);
    for (size_t i = 0; w->wear_events && w->walls.wear && i < w->segment_count; i++)
        free(w->wear_events[i].items);
    dem_team_destroy(w->team);
    dem_views_release(&w->views);
    dem_regions_release(w->regions);
    dem_bonds_release(w->bonds);
    void *all[] = {w->clumps,         w->shape_names, w->shifts,     w->mesh_touches, w->tallies,
                   w->motion_tallies, w->asked,       w->part_asked, w->parts,
                   w->candidates,     w->pushes,      w->strained,   w->part_strained, w->servo_sums, w->wear_events};
    for (size_t i = 0; i < sizeof all / sizeof *all; i++)
        free(all[i]);
    free(w);
}

// ---- stepping

// whole domains for each thread, with about as many contacts
static void split_parts(dem_world *w)
{
    size_t per_domain = w->domain_bodies / DEM_SEGMENT, total = 0, done = 0;
    for (size_t i = 0; i < w->segment_count; i++)
        total += w->contacts.segments[i].end - w->contacts.segments[i].begin + DEM_SEGMENT;
    size_t part = 1;
    for (size_t i = 0; i < w->segment_count && part < (size_t)w->threads; i++) {
        done += w->contacts.segments[i].end - w->contacts.segments[i].begin + DEM_SEGMENT;
        if (done * (size_t)w->threads >= total * part && (i + 1) % per_domain == 0)
            w->parts[part++] = i + 1;
    }
    for (; part <= (size_t)w->threads; part++)
        w->parts[part] = w->segment_count;
}

static void contact_pass(dem_world *w, size_t begin, size_t end, double kick)
{
    dem_rows rows = world_rows(w);
    bool many = w->bodies.count > BODIES_IN_CACHE;
    for (size_t i = begin; i < end; i++) {
        const dem_segment *s = &w->contacts.segments[i];
        const dem_segment *next = &w->contacts.segments[i + 1 < end ? i + 1 : begin];
        dem_contact_job job = {.columns = w->contacts.columns,
                               .begin = s->begin,
                               .end = s->end,
                               .next = many ? next->begin : 0,
                               .next_end = many ? next->end : 0,
                               .last_step = w->last_step,
                               .kick = kick,
                               .next_step = w->next_step,
                               .tally = &w->tallies[i]};
        if (s->begin < s->end)
            w->instance->pairs(w->features, &rows, &job);
    }
}

// contacts with walls of one form from one block of 8 to another
static void wall_blocks(dem_world *w, size_t form, size_t segment, size_t begin, size_t end, double kick)
{
    if (begin >= end)
        return;
    dem_rows rows = world_rows(w);
    dem_contact_job job = {.columns = w->wall_contacts[form].columns,
                           .begin = begin,
                           .end = end,
                           .last_step = w->last_step,
                           .kick = kick,
                           .next_step = w->next_step,
                           .tally = &w->tallies[(1 + form) * w->segment_count + segment]};
    w->wall_instance->walls[form](w->features, &rows, &job);
}

// with meshes many blocks have no contact now
static void mesh_blocks(dem_world *w, size_t segment, const dem_segment *s, double kick)
{
    const dem_contact_columns *c = &w->wall_contacts[DEM_FORM_MESH].columns;
    size_t begin = s->begin;
    for (size_t block = s->begin; block < s->end; block += DEM_BLOCK_LANES) {
        if (!dem_mesh_block_idle(c, block))
            continue;
        wall_blocks(w, DEM_FORM_MESH, segment, begin, block, kick);
        begin = block + DEM_BLOCK_LANES;
    }
    wall_blocks(w, DEM_FORM_MESH, segment, begin, s->end, kick);
}

static void wall_pass(dem_world *w, size_t begin, size_t end, double kick)
{
    for (size_t form = 0; form < DEM_WALL_FORMS; form++) {
        const dem_contacts *contacts = &w->wall_contacts[form];
        for (size_t i = begin; contacts->segments && i < end; i++) {
            const dem_segment *s = &contacts->segments[i];
            if (form == DEM_FORM_MESH)
                mesh_blocks(w, i, s, kick);
            else
                wall_blocks(w, form, i, s->begin, s->end, kick);
        }
    }
}

// when all threads have come to their end, adds what they left, too; tells when it was done
static double bond_pass(dem_world *w, size_t begin, size_t end, double kick, size_t part)
{
    double t0 = dem_clock();
    dem_bonds_compute(w, begin * DEM_SEGMENT, end * DEM_SEGMENT, kick, part);
    dem_team_meet(w->team);
    dem_bonds_add(w, begin * DEM_SEGMENT, end * DEM_SEGMENT);
    double t1 = dem_clock();
    if (part == 0)
        w->clocks[DEM_PASS_BONDS].seconds += t1 - t0;
    return t1;
}

static void motion_pass(dem_world *w, size_t begin, size_t end, double kick, size_t part)
{
    dem_rows rows = world_rows(w);
    uint32_t *asked = w->asked + begin * DEM_SEGMENT;
    size_t *asked_count = &w->part_asked[part], *strained_count = &w->part_strained[part];
    *asked_count = *strained_count = 0;
    bool damped = w->damping.local > 0 || w->damping.viscous > 0;
    bool tally = (damped || w->features.roll_bound || w->kept) && w->ledger;
    double turn_kick = dem_motion_turn_kick(w);
    void (*move)(const dem_rows *, dem_motion_job *) = w->other_motion ? dem_motion_any : w->kernels->move;
    // the last part moves the rows that fill up, too
    size_t last = end == w->segment_count ? w->bodies.padded : end * DEM_SEGMENT;
    for (size_t from = begin * DEM_SEGMENT; from < last;) {
        size_t to = tally && from + DEM_SEGMENT < last ? from + DEM_SEGMENT : last;
        size_t segment = from / DEM_SEGMENT;
        dem_motion_job job = {.begin = from,
                              .end = to,
                              .step = w->next_step,
                              .kick = kick,
                              .gravity = {w->gravity.x, w->gravity.y, w->gravity.z},
                              .path = w->bodies.path,
                              .limit = w->bodies.limit,
                              .wall_limit = w->walls.sweep ? w->bodies.wall_limit : NULL,
                              .wall_path = w->wall_path,
                              .before = w->bodies.before,
                              .local = w->damping.local,
                              .viscous = w->damping.viscous,
                              .vector = w->damping.local_frame == DEM_LOCAL_VECTOR,
                              .exclude_gravity = w->damping.exclude_gravity,
                              .bounded = w->features.roll_bound,
                              .schemes = w->integrator,
                              .last_step = w->last_step,
                              .turn_kick = turn_kick,
                              .hold = w->bodies.hold,
                              .kept = w->bodies.kept,
                              .turning = w->bodies.turning,
                              .tally = tally && segment < w->segment_count ? &w->motion_tallies[segment] : NULL,
                              .strain_limit = w->bodies.strain_limit,
                              .strained = w->strained + begin * DEM_SEGMENT + *strained_count,
                              .asked = asked + *asked_count};
        move(&rows, &job);
        *asked_count += job.asked_count;
        *strained_count += job.strained_count;
        from = to;
    }
}

static void push_bodies(dem_world *w, double kick, const double sign)
{
    for (size_t i = 0; i < w->push_count; i++) {
        const dem_push *push = &w->pushes[i];
        double *p = w->bodies.momentum + DEM_ROW * push->row;
        const double *motion = body_pose(&w->bodies, push->row) + 8;
        double impulse[6] = {push->force.x,  push->force.y,  push->force.z,
                             push->moment.x, push->moment.y, push->moment.z};
        for (int k = 0; k < 6; k++) {
            if (sign > 0)
                p[k] += kick * impulse[k];
            // against the mean of the velocities before and after
            w->push_work += kick * impulse[k] * motion[k] / 2;
        }
    }
}

// seconds of the first thread by pass; the others do the same work beside it
static void step_part(void *user, int which)
{
    dem_world *w = user;
    size_t part = (size_t)which;
    double kick = dem_motion_kick(w);
    size_t begin = w->parts[part], end = w->parts[part + 1];
    double t0 = dem_clock();
    if (w->mesh_touches)
        dem_mesh_touch_measure(w, begin, end);
    if (w->features.weighted)
        dem_weigh_contacts(w, begin, end);
    if (w->features.soft)
        dem_soft_walls(w, begin, end, kick, part);
    else
        wall_pass(w, begin, end, kick);
    double t1 = dem_clock();
    if (w->walls.servo)
        dem_servo_gather(w, begin, end);
    if (w->walls.rub)
        dem_wear_rub(w, begin, end, kick);
    if (w->features.soft)
        dem_soft_pairs(w, begin, end, kick, part);
    else
        contact_pass(w, begin, end, kick);
    double t2 = dem_clock(), bonded = t2;
    if (w->bonds)
        bonded = bond_pass(w, begin, end, kick, part);
    else
        dem_team_meet(w->team);
    dem_contacts_add_slots(w, begin * DEM_SEGMENT, end * DEM_SEGMENT);
    if (w->push_count) {
        dem_team_meet(w->team);
        if (part == 0)
            push_bodies(w, kick, 1);
        dem_team_meet(w->team);
    }
    double t3 = dem_clock();
    if (w->bodies.fluid)
        dem_fluid_push(w, begin * DEM_SEGMENT, end * DEM_SEGMENT, kick);
    motion_pass(w, begin, end, kick, part);
    if (w->bodies.fluid && w->ledger)
        dem_fluid_tally(w, begin * DEM_SEGMENT, end * DEM_SEGMENT);
    double t4 = dem_clock();
    if (part == 0) {
        w->clocks[DEM_PASS_WALLS].seconds += t1 - t0;
        w->clocks[DEM_PASS_PAIRS].seconds += t2 - t1 + (t3 - bonded);
        w->clocks[DEM_PASS_MOTION].seconds += t4 - t3;
    }
}

static void join_asked(dem_world *w)
{
    w->asked_count = w->strained_count = 0;
    for (size_t part = 0; part < (size_t)w->threads; part++) {
        const uint32_t *from = w->asked + w->parts[part] * DEM_SEGMENT;
        for (size_t i = 0; i < w->part_asked[part]; i++)
            w->asked[w->asked_count++] = from[i];
        const dem_strained *strained = w->strained + w->parts[part] * DEM_SEGMENT;
        for (size_t i = 0; i < w->part_strained[part]; i++)
            w->strained[w->strained_count++] = strained[i];
    }
}

static void set_time(dem_world *w)
{
    w->steps++;
    w->last_step = w->next_step;
    if (w->walls.move)
        dem_walls_place(&w->walls, dem_world_time(w));
}

// once the lists are those of the bonds that live, those whose time has come are made
static dem_status tend_bonds(dem_world *w, dem_error *error)
{
    if (w->bonds->freed_count)
        dem_bonds_account(w);
    if (!(w->bonds->due <= dem_world_time(w)))
        return DEM_OK;
    DEM_TRY(dem_lists_renew(w, error));
    return make_bonds(w, error);
}

static dem_status step_once(dem_world *w, dem_error *error)
{
    double kick = dem_motion_kick(w);
    if (w->bodies.before)
        memcpy(w->bodies.before, w->bodies.momentum, w->bodies.padded * DEM_ROW * sizeof *w->bodies.before);
    w->wall_path += w->next_step * w->sweep_speed;
    if (w->steps % 64 == 0)
        split_parts(w);
    dem_team_run(w->team, step_part, w);
    if (w->push_count) {
        push_bodies(w, kick, 0);
        w->push_count = 0;
    }
    join_asked(w);
    if (w->walls.servo)
        dem_servo_move(w);
    if (w->walls.wear)
        DEM_TRY(dem_wear_settle(w, error));
    set_time(w);
    if (w->population) {
        DEM_TRY(dem_population_feed(w, error));
        if (w->parts[w->threads] != w->segment_count)
            split_parts(w);
    }
    if (w->bonds)
        DEM_TRY(dem_bonds_settle(w, error));
    if (w->asked_count)
        DEM_TRY(dem_lists_update(w, error));
    if (w->bonds)
        DEM_TRY(tend_bonds(w, error));
    return dem_step_review(w, error);
}

dem_status dem_world_step(dem_world *w, uint64_t steps, dem_error *error)
{
    if (w->steps == 0 || w->parts[w->threads] == 0)
        split_parts(w);
    for (uint64_t i = 0; i < steps; i++)
        DEM_TRY(step_once(w, error));
    return DEM_OK;
}

void dem_world_push(dem_world *w, size_t body, dem_vec3 force, dem_vec3 moment)
{
    if (dem_grow(&w->pushes, &w->push_capacity, w->push_count, sizeof *w->pushes))
        w->pushes[w->push_count++] = (dem_push){w->bodies.place[body], force, moment};
}

double dem_world_time(const dem_world *w)
{
    return w->epoch_time + (double)(w->steps - w->epoch_steps) * w->next_step;
}

uint64_t dem_world_steps(const dem_world *w)
{
    return w->steps;
}

double dem_world_step_size(const dem_world *w)
{
    return w->next_step;
}

const dem_clump *dem_world_clump(const dem_world *w, uint32_t shape)
{
    return w->clumps[shape];
}

const dem_pass_time *dem_world_passes(const dem_world *w, size_t *count)
{
    *count = w->bonds ? DEM_PASSES : DEM_PASS_BONDS;
    return w->clocks;
}

void dem_world_reset_clocks(dem_world *w)
{
    for (int i = 0; i < DEM_PASSES; i++)
        w->clocks[i].seconds = 0;
}
