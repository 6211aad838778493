#include "sim/laws.h"

#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/status.h"
#include "math/vec.h"
#include "sim/restitution.h"
#include "sim/scene.h"

// A dashpot that cannot pull gives no restitution of 0, and near 0 the step would have to be very small: this one
// leaves a hundredth of the speed, at twice the critical damping.
static const double LEAST_RESTITUTION = 0.01;

static const char *name_of(const dem_scene *scene, uint32_t material)
{
    return scene->materials[material].name ? scene->materials[material].name : "";
}

static dem_status refuse(const dem_scene *scene, const dem_pair_law *law, const char *what, dem_error *error)
{
    return dem_fail(error, DEM_BAD_INPUT, "the contact between \"%s\" and \"%s\" %s", name_of(scene, law->materials[0]),
                    name_of(scene, law->materials[1]), what);
}

// E* and G* of two materials (Johnson 1985; Mindlin & Deresiewicz 1953)
static bool moduli(const dem_material *a, const dem_material *b, double *young, double *shear)
{
    double ea = a->young, eb = b->young, na = a->poisson, nb = b->poisson;
    *young = 1 / ((1 - na * na) / ea + (1 - nb * nb) / eb);
    double ga = ea / (2 * (1 + na)), gb = eb / (2 * (1 + nb));
    *shear = 1 / ((2 - na) / ga + (2 - nb) / gb);
    return *young > 0 && isfinite(*young) && *shear > 0 && isfinite(*shear);
}

static dem_status fill_normal(const dem_scene *scene, const dem_pair_law *law, double *row, dem_features *needs,
                              dem_error *error)
{
    const dem_material *a = &scene->materials[law->materials[0]], *b = &scene->materials[law->materials[1]];
    double young, shear;
    if (dem_law_of_hertz(law)) {
        if (!moduli(a, b, &young, &shear))
            return refuse(scene, law, "is of Hertz; give both materials \"young\" and \"poisson\"", error);
        row[LAW_HERTZ] = 2 * young;
        needs->hertz = true;
        if (law->normal == DEM_NORMAL_JKR) {
            if (scene->multiple != DEM_MULTIPLE_SUM)
                return refuse(scene, law, "is of JKR, for which \"contacts_between_clumps\" must be \"sum\"", error);
            row[LAW_JKR] = 2 * DEM_PI * law->work_of_adhesion;
            needs->jkr = true;
        }
        if (law->normal == DEM_NORMAL_DMT) {
            row[LAW_ADHESION] = 2 * DEM_PI * law->work_of_adhesion;
            needs->dmt = true;
        }
    } else if (law->stiffness > 0) {
        row[LAW_STIFFNESS] = law->stiffness;
        needs->linear = true;
    } else {
        // two bars in series
        double both = 2 / (1 / a->young + 1 / b->young);
        if (!(both > 0 && isfinite(both)))
            return refuse(scene, law, "has no stiffness; give \"stiffness\", or both materials \"young\"", error);
        row[LAW_YOUNG] = DEM_PI * both;
        needs->linear = needs->young = true;
    }
    return DEM_OK;
}

static void fill_damping(const dem_pair_law *law, double *row, dem_features *needs)
{
    // where surfaces pull anyway, the dashpot may, too
    bool cut = law->tail == DEM_TAIL_CUT && law->normal != DEM_NORMAL_JKR;
    row[LAW_FLOOR] = cut && law->damping != DEM_DAMPING_NONE ? 0 : -INFINITY;
    double zeta = 0;
    if (law->damping == DEM_DAMPING_RATE && law->damping_rate > 0) {
        row[LAW_RATE] = law->damping_rate;
        needs->rate = true;
    } else if (law->damping == DEM_DAMPING_RESTITUTION && law->restitution < 1) {
        zeta = cut ? dem_damping_ratio_cut(fmax(law->restitution, LEAST_RESTITUTION))
                   : dem_damping_ratio(law->restitution);
        row[LAW_ZETA] = 2 * zeta * (dem_law_of_hertz(law) ? sqrt(5.0 / 6) : 1);
        needs->restitution = true;
    } else
        return;
    needs->cut |= cut;
}

// k_t = modulus * contact radius; the spring must not get force, and so energy, from a normal force that grows
static void grow_with_radius(const dem_pair_law *law, double *row, double modulus, dem_features *needs)
{
    row[LAW_SLIDE_HERTZ] = modulus;
    row[LAW_KEEP_LEAST] = 0;
    row[LAW_KEEP_MOST] = law->rescale ? 1 : INFINITY;
    needs->mindlin = true;
}

// a bond needs the spring even where no friction is left once it has broken
static bool has_friction(const dem_pair_law *law)
{
    return law->friction != DEM_FRICTION_NONE &&
           (law->friction_coefficient > 0 || law->static_coefficient > 0 || law->cohesion == DEM_COHESION_BREAKABLE);
}

static dem_status fill_friction(const dem_scene *scene, const dem_pair_law *law, double *row, dem_features *needs,
                                dem_error *error)
{
    row[LAW_KEEP_LEAST] = row[LAW_KEEP_MOST] = 1;
    if (!has_friction(law))
        return DEM_OK;
    needs->friction = true;
    row[LAW_FRICTION] = law->friction_coefficient;
    if (law->static_coefficient > law->friction_coefficient) {
        row[LAW_FRICTION_MORE] = law->static_coefficient - law->friction_coefficient;
        row[LAW_FRICTION_DECAY] = law->friction_decay;
        needs->decay = true;
    }
    if (law->friction == DEM_FRICTION_MINDLIN) {
        double young, shear;
        if (!dem_law_of_hertz(law) ||
            !moduli(&scene->materials[law->materials[0]], &scene->materials[law->materials[1]], &young, &shear))
            return refuse(scene, law,
                          "has Mindlin's friction, which needs the normal law of Hertz; take \"hertz\" with it, or "
                          "friction \"linear\"",
                          error);
        grow_with_radius(law, row, 8 * shear, needs);
    } else if (law->tangential_stiffness > 0)
        row[LAW_SLIDE_STIFFNESS] = law->tangential_stiffness;
    else if (dem_law_of_hertz(law))
        grow_with_radius(law, row, law->stiffness_ratio * row[LAW_HERTZ], needs);
    else
        row[LAW_SLIDE_RATIO] = law->stiffness_ratio;
    if (law->tangential_rate > 0) {
        row[LAW_SLIDE_RATE] = law->tangential_rate;
        needs->rate = needs->slide_damping = true;
    } else if (isnan(law->tangential_rate) && row[LAW_ZETA] > 0) {
        row[LAW_SLIDE_ZETA] = row[LAW_ZETA];
        needs->slide_damping = true;
    }
    return DEM_OK;
}

static void fill_rolling(const dem_pair_law *law, double *row, dem_features *needs)
{
    double mu = law->rolling_coefficient;
    if (law->rolling == DEM_ROLLING_NONE || !(mu > 0))
        return;
    if (law->rolling == DEM_ROLLING_BOUNDED) {
        row[LAW_ROLL_BOUND] = mu;
        needs->roll_bound = true;
    } else if (law->rolling == DEM_ROLLING_CONSTANT) {
        row[LAW_ROLL_CONSTANT] = mu;
        needs->roll_constant = true;
    } else {
        if (law->rolling_stiffness > 0)
            row[LAW_ROLL_STIFFNESS] = law->rolling_stiffness;
        else
            row[LAW_ROLL_RATIO] = 2.25 * mu * mu;
        row[LAW_ROLL_CAP] = mu;
        row[LAW_ROLL_ZETA] = 2 * law->rolling_damping;
        needs->rolling = true;
    }
}

static dem_status fill_twisting(const dem_scene *scene, const dem_pair_law *law, double *row, dem_features *needs,
                                dem_error *error)
{
    if (law->twisting == DEM_TWISTING_CONSTANT && law->twisting_coefficient > 0) {
        row[LAW_TWIST_CONSTANT] = law->twisting_coefficient;
        needs->twist_constant = true;
    } else if (law->twisting == DEM_TWISTING_MARSHALL) {
        if (law->friction == DEM_FRICTION_NONE || !(law->friction_coefficient > 0))
            return refuse(scene, law, "has Marshall's twisting, which needs friction; add \"friction\"", error);
        row[LAW_TWIST_RATIO] = 0.5;
        row[LAW_TWIST_CAP] = 2.0 / 3 * law->friction_coefficient;
        needs->twisting = true;
    }
    return DEM_OK;
}

static dem_status fill_cohesion(const dem_scene *scene, const dem_pair_law *law, double *row, dem_features *needs,
                                dem_error *error)
{
    row[LAW_BOND_GAP] = -INFINITY;
    if (law->cohesion == DEM_COHESION_SJKR && law->energy_density > 0) {
        row[LAW_ENERGY_DENSITY] = law->energy_density;
        needs->sjkr = true;
    }
    if (law->cohesion != DEM_COHESION_BREAKABLE)
        return DEM_OK;
    if (scene->multiple != DEM_MULTIPLE_SUM)
        return refuse(scene, law, "is breakable, for which \"contacts_between_clumps\" must be \"sum\"", error);
    if (law->normal != DEM_NORMAL_LINEAR || law->friction == DEM_FRICTION_NONE)
        return refuse(scene, law, "is breakable, which needs the normal law linear and friction", error);
    row[LAW_BOND_TENSION] = law->bond_tension;
    row[LAW_BOND_SHEAR] = law->bond_shear;
    row[LAW_BOND_GAP] = law->bond_gap;
    row[LAW_BOND_AGAIN] = law->bonded == DEM_BONDED_AT_TOUCH;
    needs->bonded = true;
    return DEM_OK;
}

// ---- laws of the user's

// one plug-in a scene: it brings the loops
static dem_status open_plugin(const dem_scene *scene, const dem_pair_law *law, dem_laws *laws, dem_error *error)
{
    dem_plugin plugin;
    if (!law->plugin)
        return refuse(scene, law, "is of a plug-in, but names none; give \"plugin\"", error);
    DEM_TRY(dem_plugin_open(law->plugin, &plugin, error));
    if (!laws->plugin.table) {
        laws->plugin = plugin;
        laws->parameters = dem_alloc_zero(DEM_LAW_PARAMETERS * (scene->law_count + 1), sizeof *laws->parameters);
        return laws->parameters ? DEM_OK : dem_fail_memory(error);
    }
    bool same = plugin.table == laws->plugin.table;
    dem_plugin_close(&plugin);
    return same ? DEM_OK : refuse(scene, law, "is of another plug-in than the others; write both laws in one", error);
}

static dem_status fill_user(const dem_scene *scene, const dem_pair_law *law, dem_laws *laws, double *row,
                            double parameters[DEM_LAW_PARAMETERS], dem_error *error)
{
    if (scene->multiple == DEM_MULTIPLE_SOFT)
        return refuse(scene, law, "is of a plug-in, for which \"contacts_between_clumps\" cannot be \"soft\"", error);
    DEM_TRY(open_plugin(scene, law, laws, error));
    const dem_law_table *t = laws->plugin.table;
    const dem_law_spec *spec = t->spec;
    for (uint32_t i = 0; i < spec->parameter_count; i++) {
        parameters[i] = spec->parameters[i].fallback;
        for (size_t k = 0; k < law->parameter_count; k++)
            if (strcmp(law->parameters[k].name, spec->parameters[i].name) == 0)
                parameters[i] = law->parameters[k].value;
        if (isnan(parameters[i]))
            return dem_fail(error, DEM_BAD_INPUT, "the law %s needs \"%s\"; add it", spec->name,
                            spec->parameters[i].name);
    }
    row[LAW_KEEP_LEAST] = row[LAW_KEEP_MOST] = row[LAW_USER] = 1;
    row[LAW_FLOOR] = row[LAW_BOND_GAP] = -INFINITY;
    dem_features *needs = &laws->needs;
    needs->user = true;
    needs->user_reaches = t->reach;
    needs->user_turns = spec->turns;
    needs->user_vectors = spec->vectors;
    needs->user_numbers = spec->numbers;
    return DEM_OK;
}

static uint32_t row_equal_to(dem_laws *laws, const double row[LAW_SLOTS], const double parameters[DEM_LAW_PARAMETERS])
{
    uint32_t i = 0;
    size_t bytes = DEM_LAW_PARAMETERS * sizeof *parameters;
    for (; i < laws->count; i++) {
        bool same = memcmp(laws->rows + (size_t)LAW_SLOTS * i, row, LAW_SLOTS * sizeof *row) == 0;
        if (same && laws->parameters)
            same = memcmp(laws->parameters + (size_t)DEM_LAW_PARAMETERS * i, parameters, bytes) == 0;
        if (same)
            return i;
    }
    memcpy(laws->rows + (size_t)LAW_SLOTS * i, row, LAW_SLOTS * sizeof *row);
    if (laws->parameters)
        memcpy(laws->parameters + (size_t)DEM_LAW_PARAMETERS * i, parameters, bytes);
    laws->count++;
    return i;
}

static dem_status fill_law(const dem_scene *scene, const dem_pair_law *law, dem_laws *laws, double *row,
                           dem_error *error)
{
    dem_features *needs = &laws->needs;
    DEM_TRY(fill_normal(scene, law, row, needs, error));
    fill_damping(law, row, needs);
    DEM_TRY(fill_friction(scene, law, row, needs, error));
    fill_rolling(law, row, needs);
    DEM_TRY(fill_twisting(scene, law, row, needs, error));
    return fill_cohesion(scene, law, row, needs, error);
}

static dem_status add_law(const dem_scene *scene, const dem_pair_law *law, dem_laws *laws, dem_error *error)
{
    uint32_t a = law->materials[0], b = law->materials[1];
    if (a >= scene->material_count || b >= scene->material_count)
        return dem_fail(error, DEM_BAD_INPUT, "a contact names a material that is not there; correct it");
    if (!dem_scene_can_meet(scene, a, b))
        return DEM_OK;
    double row[LAW_SLOTS] = {0}, parameters[DEM_LAW_PARAMETERS] = {0};
    dem_features *needs = &laws->needs;
    if (law->normal == DEM_NORMAL_PLUGIN)
        DEM_TRY(fill_user(scene, law, laws, row, parameters, error));
    else
        DEM_TRY(fill_law(scene, law, laws, row, error));
    if (row[LAW_RATE] > 0 || row[LAW_ZETA] > 0 || row[LAW_SLIDE_RATE] > 0 || row[LAW_USER] > 0) {
        bool local = law->effective_mass == DEM_MASS_LOCAL;
        if (laws->damped && needs->local_mass != local)
            return refuse(scene, law, "has another \"effective_mass\" than the others; use one for all", error);
        laws->damped = true;
        needs->local_mass = local;
    }
    size_t n = laws->material_count;
    laws->table[a * n + b] = laws->table[b * n + a] = row_equal_to(laws, row, parameters);
    return DEM_OK;
}

static dem_status check_complete(const dem_scene *scene, const dem_laws *laws, dem_error *error)
{
    for (uint32_t a = 0; a < laws->material_count; a++)
        for (uint32_t b = 0; b <= a; b++)
            if (dem_scene_can_meet(scene, a, b) && !laws_between(laws, a, b))
                return dem_fail(error, DEM_BAD_INPUT,
                                "no contact law between \"%s\" and \"%s\"; add an entry to \"contacts\"",
                                name_of(scene, b), name_of(scene, a));
    return DEM_OK;
}

dem_status dem_laws_create(const dem_scene *scene, dem_laws *laws, dem_error *error)
{
    size_t n = scene->material_count;
    *laws = (dem_laws){.material_count = n};
    laws->rows = aligned_alloc(64, (scene->law_count + 1) * LAW_SLOTS * sizeof(double));
    laws->table = dem_alloc(n * n, sizeof *laws->table);
    if (!laws->rows || !laws->table)
        return dem_fail_memory(error);
    memset(laws->rows, 0, (scene->law_count + 1) * LAW_SLOTS * sizeof(double));
    for (size_t i = 0; i < n * n; i++)
        laws->table[i] = DEM_NO_LAW;
    for (size_t i = 0; i < scene->law_count; i++)
        DEM_TRY(add_law(scene, &scene->laws[i], laws, error));
    DEM_TRY(check_complete(scene, laws, error));
    laws->needs.mixed = laws->count > 1;
    return DEM_OK;
}

void dem_laws_release(dem_laws *laws)
{
    free(laws->rows);
    free(laws->parameters);
    free(laws->table);
    dem_plugin_close(&laws->plugin);
}
