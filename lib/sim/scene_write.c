// A scene as a file with every default written out, in SI units.
#include <math.h>
#include <string.h>

#include "math/vec.h"
#include "sim/hold.h"
#include "sim/scene_writer.h"
#include "sim/schemes.h"

// a number that was not given has no key
static void put_known(dem_json_writer *w, const char *key, double value)
{
    if (!isnan(value))
        dem_json_put_number(w, key, value);
}

static const char *shape_of(const dem_scene *scene, uint32_t shape)
{
    return shape < scene->shape_count ? text_of(scene->shapes[shape].name) : "";
}

// ---- head

static void put_time(dem_json_writer *w, const dem_scene *scene)
{
    const dem_time_def *time = &scene->time;
    dem_json_open_object(w, "time");
    put_known(w, "end", time->end);
    if (time->step > 0)
        dem_json_put_number(w, "step", time->step);
    else
        dem_json_put_string(w, "step", "auto");
    dem_json_put_number(w, "safety", dem_scene_safety(scene));
    dem_json_put_number(w, "contact_steps", time->contact_steps);
    dem_json_close(w, '}');
}

static void put_domain(dem_json_writer *w, const dem_domain_def *domain)
{
    static const char *const leavings[] = {
        [DEM_LEAVING_ERROR] = "error", [DEM_LEAVING_IGNORE] = "ignore", [DEM_LEAVING_DELETE] = "delete"};
    dem_json_open_object(w, "domain");
    put_vec(w, "min", domain->low);
    put_vec(w, "max", domain->high);
    dem_json_open_array(w, "periodic", false);
    for (int i = 0; i < 3; i++)
        dem_json_put_bool(w, NULL, domain->periodic[i]);
    dem_json_close(w, ']');
    dem_json_put_string(w, "leaving", leavings[domain->leaving]);
    dem_json_close(w, '}');
}

// ---- materials and contacts

static void put_materials(dem_json_writer *w, const dem_scene *scene)
{
    open_map(w, "materials");
    for (size_t i = 0; i < scene->material_count; i++) {
        const dem_material *m = &scene->materials[i];
        dem_json_open_object(w, text_of(m->name));
        put_known(w, "density", m->density);
        put_known(w, "young", m->young);
        put_known(w, "poisson", m->poisson);
        dem_json_close(w, '}');
    }
    dem_json_close(w, '}');
}

static void put_normal(dem_json_writer *w, const dem_pair_law *law)
{
    dem_json_open_object(w, "normal");
    if (law->normal == DEM_NORMAL_PLUGIN) {
        dem_json_put_string(w, "plugin", text_of(law->plugin));
        for (size_t i = 0; i < law->parameter_count; i++)
            dem_json_put_number(w, law->parameters[i].name, law->parameters[i].value);
        dem_json_close(w, '}');
        return;
    }
    static const char *const names[] = {
        [DEM_NORMAL_LINEAR] = "linear",
        [DEM_NORMAL_HERTZ] = "hertz",
        [DEM_NORMAL_JKR] = "jkr",
        [DEM_NORMAL_DMT] = "dmt",
    };
    bool hertz = dem_law_of_hertz(law);
    dem_json_put_string(w, "law", names[law->normal]);
    if (law->normal == DEM_NORMAL_DMT || law->normal == DEM_NORMAL_JKR)
        dem_json_put_number(w, "work_of_adhesion", law->work_of_adhesion);
    if (!hertz && law->stiffness > 0)
        dem_json_put_number(w, "stiffness", law->stiffness);
    else if (!hertz)
        dem_json_put_string(w, "stiffness_from", "young");
    if (law->damping == DEM_DAMPING_RESTITUTION)
        dem_json_put_number(w, "restitution", law->restitution);
    else if (law->damping == DEM_DAMPING_RATE)
        dem_json_put_number(w, "damping_rate", law->damping_rate);
    dem_json_put_string(w, "restitution_mode", law->tail == DEM_TAIL_CUT ? "cut_corrected" : "tension_allowed");
    dem_json_close(w, '}');
}

static void put_friction(dem_json_writer *w, const dem_pair_law *law)
{
    if (law->friction == DEM_FRICTION_NONE) {
        dem_json_put_raw(w, "friction", "null");
        return;
    }
    bool mindlin = law->friction == DEM_FRICTION_MINDLIN;
    dem_json_open_object(w, "friction");
    dem_json_put_string(w, "law", mindlin ? "mindlin" : "linear");
    if (!mindlin && law->tangential_stiffness > 0)
        dem_json_put_number(w, "stiffness", law->tangential_stiffness);
    else if (!mindlin)
        dem_json_put_number(w, "stiffness_ratio", law->stiffness_ratio);
    dem_json_put_number(w, "coefficient", law->friction_coefficient);
    if (!isnan(law->static_coefficient)) {
        dem_json_put_number(w, "static_coefficient", law->static_coefficient);
        dem_json_put_number(w, "decay", law->friction_decay);
    }
    put_known(w, "damping_rate", law->tangential_rate);
    if (mindlin)
        dem_json_put_bool(w, "rescale", law->rescale);
    dem_json_close(w, '}');
}

// what a scene does not name is left out
static void put_moments(dem_json_writer *w, const dem_pair_law *law)
{
    static const char *const rolling[] = {[DEM_ROLLING_BOUNDED] = "bounded",
                                          [DEM_ROLLING_EPSD] = "epsd",
                                          [DEM_ROLLING_CONSTANT] = "constant"};
    if (law->rolling != DEM_ROLLING_NONE) {
        dem_json_open_object(w, "rolling");
        dem_json_put_string(w, "law", rolling[law->rolling]);
        dem_json_put_number(w, "coefficient", law->rolling_coefficient);
        if (law->rolling == DEM_ROLLING_EPSD) {
            put_known(w, "stiffness", law->rolling_stiffness);
            dem_json_put_number(w, "damping", law->rolling_damping);
        }
        dem_json_close(w, '}');
    }
    if (law->twisting != DEM_TWISTING_NONE) {
        bool constant = law->twisting == DEM_TWISTING_CONSTANT;
        dem_json_open_object(w, "twisting");
        dem_json_put_string(w, "law", constant ? "constant" : "marshall");
        if (constant)
            dem_json_put_number(w, "coefficient", law->twisting_coefficient);
        dem_json_close(w, '}');
    }
    if (law->cohesion != DEM_COHESION_NONE) {
        dem_json_open_object(w, "cohesion");
        bool breakable = law->cohesion == DEM_COHESION_BREAKABLE, touch = law->bonded == DEM_BONDED_AT_TOUCH;
        dem_json_put_string(w, "law", breakable ? "breakable" : "sjkr");
        if (breakable) {
            dem_json_put_number(w, "tension", law->bond_tension);
            dem_json_put_number(w, "shear", law->bond_shear);
            dem_json_put_string(w, "bonded", touch ? "at_touch" : "at_start");
            if (!touch)
                dem_json_put_number(w, "gap", law->bond_gap);
        } else
            dem_json_put_number(w, "energy_density", law->energy_density);
        dem_json_close(w, '}');
    }
}

static void put_contacts(dem_json_writer *w, const dem_scene *scene)
{
    dem_json_open_array(w, "contacts", true);
    for (size_t i = 0; i < scene->law_count; i++) {
        const dem_pair_law *law = &scene->laws[i];
        dem_json_open_object(w, NULL);
        dem_json_open_array(w, "between", false);
        for (int k = 0; k < 2; k++)
            dem_json_put_string(w, NULL, material_of(scene, law->materials[k]));
        dem_json_close(w, ']');
        dem_json_put_string(w, "effective_mass", law->effective_mass == DEM_MASS_BODY ? "body" : "local");
        put_normal(w, law);
        put_friction(w, law);
        put_moments(w, law);
        dem_json_close(w, '}');
    }
    dem_json_close(w, ']');
}

// ---- shapes

// the world gives a clump the density of its material; spheres of the scene say the mass that comes to
static void put_spheres(dem_json_writer *w, const dem_clump *clump, double density)
{
    dem_clump_def def = dem_clump_view(clump);
    double factor = isnan(density) ? 1 : density / def.density;
    dem_json_put_number(w, "mass", def.mass * factor);
    dem_json_put_numbers(w, "inertia",
                         (double[]){def.inertia[0] * factor, def.inertia[1] * factor, def.inertia[2] * factor}, 3);
    dem_json_open_array(w, "spheres", false);
    for (size_t i = 0; i < def.ball_count; i++) {
        dem_vec3 c = def.balls[i].centre;
        dem_json_put_numbers(w, NULL, (double[]){c.x, c.y, c.z, def.balls[i].radius}, 4);
    }
    dem_json_close(w, ']');
}

static void put_shapes(dem_json_writer *w, const dem_scene *scene)
{
    open_map(w, "shapes");
    for (size_t i = 0; i < scene->shape_count; i++) {
        const dem_shape_def *shape = &scene->shapes[i];
        dem_json_open_object(w, text_of(shape->name));
        dem_json_put_string(w, "material", material_of(scene, shape->material));
        if (shape->clump_file)
            dem_json_put_string(w, "clump", shape->clump_file);
        else if (shape->clump)
            put_spheres(w, shape->clump,
                        shape->material < scene->material_count ? scene->materials[shape->material].density : NAN);
        else {
            bool disc = shape->disc_thickness > 0;
            dem_json_open_object(w, disc ? "disc" : "sphere");
            dem_json_put_number(w, "radius", shape->sphere_radius);
            if (disc)
                dem_json_put_number(w, "thickness", shape->disc_thickness);
            dem_json_close(w, '}');
        }
        dem_json_close(w, '}');
    }
    dem_json_close(w, '}');
}

// ---- bodies

// what of it is held; a scene that holds nothing names nothing
static void put_hold(dem_json_writer *w, uint32_t hold)
{
    static const char *const locks[] = {"x", "y", "z", "rx", "ry", "rz"}, *const kept[] = {"velocity", "spin"};
    if (hold & (DEM_LOCK_ALL | DEM_LOCK_TURNS)) {
        dem_json_open_array(w, "lock", false);
        for (int k = 0; k < 6; k++)
            if (hold >> k & 1)
                dem_json_put_string(w, NULL, locks[k]);
        dem_json_close(w, ']');
    }
    if (hold & (DEM_HOLD_VELOCITY | DEM_HOLD_SPIN)) {
        dem_json_open_array(w, "prescribed", false);
        for (int k = 0; k < 2; k++)
            if (hold & (uint32_t)(DEM_HOLD_VELOCITY << k))
                dem_json_put_string(w, NULL, kept[k]);
        dem_json_close(w, ']');
    }
}

static void put_group(dem_json_writer *w, const char *group)
{
    if (group)
        dem_json_put_string(w, "group", group);
}

static void put_body(dem_json_writer *w, const dem_scene *scene, const dem_body_def *body)
{
    dem_quat q = body->orientation;
    dem_json_open_object(w, NULL);
    dem_json_put_string(w, "shape", shape_of(scene, body->shape));
    put_vec(w, "position", body->position);
    dem_json_put_numbers(w, "orientation", (double[]){q.w, q.x, q.y, q.z}, 4);
    put_vec(w, "velocity", body->velocity);
    put_vec(w, "spin", body->spin);
    dem_json_put_number(w, "scale", body->scale);
    put_hold(w, body->hold);
    put_group(w, body->group);
    dem_json_close(w, '}');
}

static void put_table(dem_json_writer *w, const dem_size_def *size)
{
    dem_json_put_numbers(w, "sizes", size->sizes, size->table_count);
    dem_json_put_numbers(w, "passing", size->passing, size->table_count);
}

static void put_size(dem_json_writer *w, const dem_size_def *size)
{
    static const char *const names[] = {[DEM_SIZE_FIXED] = "fixed",
                                        [DEM_SIZE_UNIFORM] = "uniform",
                                        [DEM_SIZE_NORMAL] = "normal",
                                        [DEM_SIZE_LOGNORMAL] = "lognormal",
                                        [DEM_SIZE_TABLE] = "table"};
    static const char *const keys[][2] = {[DEM_SIZE_FIXED] = {"value"},
                                          [DEM_SIZE_UNIFORM] = {"min", "max"},
                                          [DEM_SIZE_NORMAL] = {"mean", "sigma"},
                                          [DEM_SIZE_LOGNORMAL] = {"median", "sigma"},
                                          [DEM_SIZE_TABLE] = {NULL}};
    if (size->law == DEM_SIZE_AS_IS)
        return;
    dem_json_open_object(w, "size");
    dem_json_put_string(w, "law", names[size->law]);
    for (int i = 0; i < 2 && keys[size->law][i]; i++)
        dem_json_put_number(w, keys[size->law][i], i ? size->b : size->a);
    if (size->law == DEM_SIZE_TABLE)
        put_table(w, size);
    if ((size->law == DEM_SIZE_NORMAL || size->law == DEM_SIZE_LOGNORMAL) && size->smallest > 0)
        dem_json_put_number(w, "min", size->smallest);
    if ((size->law == DEM_SIZE_NORMAL || size->law == DEM_SIZE_LOGNORMAL) && isfinite(size->largest))
        dem_json_put_number(w, "max", size->largest);
    dem_json_put_string(w, "by", size->by_mass ? "mass" : "number");
    dem_json_close(w, '}');
}

static void put_mix(dem_json_writer *w, const dem_scene *scene, const dem_mix_def *mix, size_t count, bool by_mass)
{
    dem_json_open_array(w, "mix", false);
    for (size_t i = 0; i < count; i++) {
        dem_json_open_object(w, NULL);
        dem_json_put_string(w, "shape", shape_of(scene, mix[i].shape));
        dem_json_put_number(w, "share", mix[i].share);
        put_size(w, &mix[i].size);
        dem_json_close(w, '}');
    }
    dem_json_close(w, ']');
    dem_json_put_string(w, "share_by", by_mass ? "mass" : "number");
}

static void put_fill(dem_json_writer *w, const dem_scene *scene, const dem_fill_def *fill)
{
    dem_json_open_object(w, NULL);
    dem_json_open_object(w, "fill");
    put_mix(w, scene, fill->mix, fill->mix_count, fill->share_by_mass);
    dem_json_open_array(w, "box", false);
    put_vec(w, NULL, fill->low);
    put_vec(w, NULL, fill->high);
    dem_json_close(w, ']');
    if (fill->count)
        dem_json_put_whole(w, "count", (int64_t)fill->count);
    else
        dem_json_put_number(w, "void_ratio", fill->void_ratio);
    dem_json_put_whole(w, "seed", (int64_t)fill->seed);  // JSON whole numbers are signed: seeds from 2^63 wrap
    dem_json_put_number(w, "gap", fill->gap);
    put_vec(w, "velocity", fill->velocity);
    dem_json_close(w, '}');
    put_hold(w, fill->hold);
    put_group(w, fill->group);
    dem_json_close(w, '}');
}

static void put_entry(dem_json_writer *w, const dem_scene *scene, const dem_scene_entry *entry)
{
    if (entry->kind == DEM_ENTRY_FILE) {
        dem_json_open_object(w, NULL);
        dem_json_put_string(w, "file", entry->file);
        put_hold(w, entry->hold);
        put_group(w, entry->group);
        dem_json_close(w, '}');
        return;
    }
    for (size_t i = entry->first; i < entry->first + entry->count; i++)
        if (entry->kind == DEM_ENTRY_BODY)
            put_body(w, scene, &scene->bodies.bodies[i]);
        else
            put_fill(w, scene, &scene->bodies.fills[i]);
}

// the entries of a scene that was read, unless its bodies have been replaced since
static void put_bodies(dem_json_writer *w, const dem_scene *scene)
{
    const struct dem_scene_owner *o = scene->owner;
    const dem_bodies_def *b = &scene->bodies;
    bool as_read = o && o->bodies == b->bodies && o->body_count == b->count && o->fills == b->fills &&
                   o->fill_count == b->fill_count;
    const dem_scene_entry plain[] = {{DEM_ENTRY_BODY, NULL, 0, b->count, 0, NULL},
                                     {DEM_ENTRY_FILL, NULL, 0, b->fill_count, 0, NULL}};
    const dem_scene_entry *entries = as_read ? o->entries : plain;
    dem_json_open_array(w, "bodies", true);
    for (size_t i = 0; i < (as_read ? o->entry_count : 2); i++)
        put_entry(w, scene, &entries[i]);
    dem_json_close(w, ']');
}

// ---- the rest

static void put_damping(dem_json_writer *w, const dem_damping_def *damping)
{
    dem_json_open_object(w, "damping");
    dem_json_put_number(w, "local", damping->local);
    dem_json_put_string(w, "local_frame", damping->local_frame == DEM_LOCAL_VECTOR ? "vector" : "space");
    dem_json_put_bool(w, "exclude_gravity", damping->exclude_gravity);
    dem_json_put_number(w, "viscous", damping->viscous);
    const dem_drag_def *drag = &damping->drag;
    if (!(drag->density > 0 || drag->viscosity > 0))
        dem_json_put_raw(w, "drag", "null");
    else {
        dem_json_open_object(w, "drag");
        dem_json_put_number(w, "density", drag->density);
        dem_json_put_number(w, "viscosity", drag->viscosity);
        put_vec(w, "velocity", drag->velocity);
        dem_json_put_bool(w, "buoyancy", drag->buoyancy);
        dem_json_close(w, '}');
    }
    dem_json_close(w, '}');
}

static void put_inlet(dem_json_writer *w, const dem_scene *scene, const dem_inlet_def *inlet)
{
    dem_json_open_object(w, text_of(inlet->name));
    if (inlet->kind == DEM_INLET_BOX) {
        dem_json_open_array(w, "box", false);
        put_vec(w, NULL, inlet->low);
        put_vec(w, NULL, inlet->high);
        dem_json_close(w, ']');
    } else {
        dem_json_open_object(w, "sphere");
        put_vec(w, "centre", inlet->centre);
        dem_json_put_number(w, "radius", inlet->radius);
        dem_json_put_bool(w, "solid", inlet->solid);
        if (inlet->solid)
            dem_json_put_string(w, "material", material_of(scene, inlet->material));
        dem_json_close(w, '}');
    }
    put_mix(w, scene, inlet->mix, inlet->mix_count, inlet->share_by_mass);
    dem_json_put_number(w, inlet->by_mass ? "mass_rate" : "rate", inlet->rate);
    put_vec(w, "velocity", inlet->velocity);
    dem_json_put_number(w, "velocity_spread", inlet->velocity_spread);
    put_vec(w, "spin", inlet->spin);
    dem_json_put_number(w, "spin_spread", inlet->spin_spread);
    dem_json_put_number(w, "start", inlet->start);
    if (isfinite(inlet->stop))
        dem_json_put_number(w, "stop", inlet->stop);
    if (inlet->count)
        dem_json_put_whole(w, "count", (int64_t)inlet->count);
    dem_json_put_number(w, "gap", inlet->gap);
    dem_json_put_whole(w, "seed", (int64_t)inlet->seed);
    dem_json_close(w, '}');
}

// a scene that has none names none
static void put_inlets(dem_json_writer *w, const dem_scene *scene)
{
    if (!scene->inlet_count)
        return;
    open_map(w, "inlets");
    for (size_t i = 0; i < scene->inlet_count; i++)
        put_inlet(w, scene, &scene->inlets[i]);
    dem_json_close(w, '}');
}

// a scene without bonds does not name them
static void put_bonds(dem_json_writer *w, const dem_scene *scene)
{
    if (!scene->bond_count)
        return;
    open_map(w, "bonds");
    for (size_t i = 0; i < scene->bond_count; i++) {
        const dem_bond_def *b = &scene->bonds[i];
        dem_json_open_object(w, text_of(b->name));
        if (b->between[0] && b->between[1]) {
            dem_json_open_array(w, "between", false);
            for (int k = 0; k < 2; k++)
                dem_json_put_string(w, NULL, b->between[k]);
            dem_json_close(w, ']');
        } else
            dem_json_put_string(w, "between", "all");
        dem_json_put_number(w, "gap", b->gap);
        dem_json_put_number(w, "at", b->at);
        dem_json_put_number(w, "radius_multiplier", b->radius_multiplier);
        dem_json_put_number(w, "young", b->young);
        dem_json_put_number(w, "shear_ratio", b->shear_ratio);
        if (isfinite(b->tensile_strength))
            dem_json_put_number(w, "tensile_strength", b->tensile_strength);
        if (isfinite(b->shear_strength))
            dem_json_put_number(w, "shear_strength", b->shear_strength);
        dem_json_put_number(w, "moment_contribution", b->moment_contribution);
        dem_json_put_number(w, "damping", b->damping);
        dem_json_put_string(w, "contact", b->contact == DEM_BOND_INSTEAD ? "instead" : "parallel");
        dem_json_close(w, '}');
    }
    dem_json_close(w, '}');
}

static void put_measures(dem_json_writer *w, const dem_scene *scene)
{
    open_map(w, "measures");
    for (size_t i = 0; i < scene->measure_count; i++) {
        const dem_measure_def *m = &scene->measures[i];
        dem_json_open_object(w, text_of(m->name));
        if (m->region == DEM_REGION_BOX) {
            dem_json_open_array(w, "box", false);
            put_vec(w, NULL, m->low);
            put_vec(w, NULL, m->high);
            dem_json_close(w, ']');
        } else if (m->region == DEM_REGION_BALL) {
            dem_json_open_object(w, "ball");
            put_vec(w, "centre", m->centre);
            dem_json_put_number(w, "radius", m->radius);
            dem_json_close(w, '}');
        } else
            dem_json_put_bool(w, "whole", true);
        dem_json_put_bool(w, "kinetic", m->kinetic);
        dem_json_close(w, '}');
    }
    dem_json_close(w, '}');
}

static void put_output(dem_json_writer *w, const dem_output_def *output)
{
    char checkpoint[64];
    dem_json_open_object(w, "output");
    dem_json_put_string(w, "directory", text_of(output->directory));
    dem_json_put_number(w, "frames", output->frames);
    dem_json_put_number(w, "series", output->series);
    dem_json_put_number(w, "contacts", output->contacts);
    if (output->checkpoint_wall) {
        dem_format_double(checkpoint, sizeof checkpoint, output->checkpoint, 17);
        strcat(checkpoint, " s wall");
        dem_json_put_string(w, "checkpoint", checkpoint);
    } else
        dem_json_put_number(w, "checkpoint", output->checkpoint);
    dem_json_put_bool(w, "energy", output->energy);
    dem_json_close(w, '}');
}

static dem_status put_scene(dem_json_writer *w, const dem_scene *scene, dem_error *error)
{
    static const char *const multiples[] = {
        [DEM_MULTIPLE_SUM] = "sum", [DEM_MULTIPLE_MEAN] = "mean", [DEM_MULTIPLE_MERGE] = "merge",
        [DEM_MULTIPLE_SOFT] = "soft"};
    dem_json_open_object(w, NULL);
    dem_json_put_string(w, "schema", "dem-scene/1");
    dem_json_put_string(w, "title", text_of(scene->title));
    dem_json_put_whole(w, "dimension", scene->dimension == 2 ? 2 : 3);
    put_vec(w, "gravity", scene->gravity);
    put_time(w, scene);
    put_domain(w, &scene->domain);
    put_materials(w, scene);
    put_contacts(w, scene);
    put_shapes(w, scene);
    put_bodies(w, scene);
    DEM_TRY(dem_scene_put_walls(w, scene, error));
    put_inlets(w, scene);
    put_bonds(w, scene);
    put_damping(w, &scene->damping);
    dem_json_open_object(w, "integrator");
    dem_json_put_string(w, "translation", dem_translations[scene->integrator.translation].name);
    dem_json_put_string(w, "rotation", dem_rotations[scene->integrator.rotation].name);
    dem_json_close(w, '}');
    dem_json_put_string(w, "contacts_between_clumps", multiples[scene->multiple]);
    if (scene->multiple == DEM_MULTIPLE_SOFT) {
        dem_json_open_object(w, "soft");
        if (scene->soft.tau > 0)
            dem_json_put_number(w, "tau", scene->soft.tau);
        else
            dem_json_put_string(w, "tau", "auto");
        dem_json_close(w, '}');
    }
    put_measures(w, scene);
    put_output(w, &scene->output);
    dem_json_close(w, '}');
    return DEM_OK;
}

dem_status dem_scene_resolved(const dem_scene *scene, char **text, dem_error *error)
{
    dem_buffer out = {0};
    dem_json_writer writer = dem_json_begin(&out);
    *text = NULL;
    dem_status status = put_scene(&writer, scene, error);
    if (status == DEM_OK && out.failed)
        status = dem_fail_memory(error);
    if (status == DEM_OK)
        *text = out.data;
    else
        dem_buffer_release(&out);
    return status;
}
