// Materials and the laws between them.
#include <stdio.h>
#include <string.h>

#include "math/vec.h"
#include "sim/plugin.h"
#include "sim/scene_reader.h"

// ---- materials

static const dem_field material_table[] = {
    {"density", dem_field_quantity, .at = offsetof(dem_material, density), .dimension = DEM_DIMENSION_DENSITY,
     .range = DEM_RANGE_POSITIVE},
    {"young", dem_field_quantity, .at = offsetof(dem_material, young), .dimension = DEM_DIMENSION_PRESSURE,
     .range = DEM_RANGE_POSITIVE},
    {"poisson", dem_field_quantity, .at = offsetof(dem_material, poisson), .dimension = DEM_DIMENSION_NONE,
     .range = {.low = -1, .high = 0.5, .above = true}},
};
const dem_fields dem_material_fields = DEM_FIELDS(material_table);

dem_status dem_section_materials(dem_scene_reader *r, const dem_scene_value *v, const dem_field *field, void *into)
{
    (void)into;
    size_t count = 0;
    if (!dem_json_is_object(v->json))
        return dem_scene_refuse(r, v, "write { \"NAME\": { ... }, ... }", "needs an object of materials by name");
    for (const char *name = NULL; (name = dem_json_next(v->json, name));)
        count++;
    dem_material *materials = dem_scene_take(r, count, sizeof *materials);
    if (!materials)
        return dem_fail_memory(r->error);
    r->scene->materials = materials;
    for (const char *name = NULL; (name = dem_json_next(v->json, name)); r->scene->material_count++) {
        dem_scene_value member = dem_scene_member(v, name);
        *materials = (dem_material){.name = name, .density = NAN, .young = NAN, .poisson = NAN};
        DEM_TRY(dem_fields_read(r, &member, field->fields, materials++, NULL));
    }
    return DEM_OK;
}

// ---- normal law

static dem_status read_stiffness_from(dem_scene_reader *r, const dem_scene_value *v, const dem_field *field, void *into)
{
    static const dem_choice sources[] = {{"young", 0}, {NULL, 0}};
    dem_field choice = {field->name, dem_field_choice, .choices = sources};
    int source;
    DEM_TRY(dem_field_choice(r, v, &choice, &source));
    *(double *)into = 0;
    return DEM_OK;
}

// a perfectly sticky contact would need an endless dashpot
static dem_status read_restitution(dem_scene_reader *r, const dem_scene_value *v, const dem_field *field, void *into)
{
    double *restitution = into;
    DEM_TRY(dem_field_quantity(r, v, field, restitution));
    if (*restitution == 0)
        return dem_scene_refuse(r, v, "use a small value such as 0.01", "must be above 0");
    return DEM_OK;
}

static const dem_choice normal_laws[] = {{"linear", DEM_NORMAL_LINEAR}, {"hertz", DEM_NORMAL_HERTZ},
                                         {"dmt", DEM_NORMAL_DMT},       {"jkr", DEM_NORMAL_JKR},
                                         {NULL, 0}};
static const dem_choice tails[] = {{"cut_corrected", DEM_TAIL_CUT}, {"tension_allowed", DEM_TAIL_TENSION}, {NULL, 0}};

enum {
    NORMAL_LAW,
    NORMAL_STIFFNESS,
    NORMAL_STIFFNESS_FROM,
    NORMAL_RESTITUTION,
    NORMAL_MODE,
    NORMAL_RATE,
    NORMAL_WORK,
    NORMAL_PLUGIN
};
static const dem_field normal_table[] = {
    [NORMAL_LAW] = {"law", dem_field_choice, .at = offsetof(dem_pair_law, normal), .choices = normal_laws},
    [NORMAL_STIFFNESS] = {"stiffness", dem_field_quantity, .at = offsetof(dem_pair_law, stiffness),
                          .dimension = DEM_DIMENSION_STIFFNESS, .range = DEM_RANGE_POSITIVE},
    [NORMAL_STIFFNESS_FROM] = {"stiffness_from", read_stiffness_from, .at = offsetof(dem_pair_law, stiffness)},
    [NORMAL_RESTITUTION] = {"restitution", read_restitution, .at = offsetof(dem_pair_law, restitution),
                            .dimension = DEM_DIMENSION_NONE, .range = {.high = 1}},
    [NORMAL_MODE] = {"restitution_mode", dem_field_choice, .at = offsetof(dem_pair_law, tail), .choices = tails},
    [NORMAL_RATE] = {"damping_rate", dem_field_quantity, .at = offsetof(dem_pair_law, damping_rate),
                     .dimension = DEM_DIMENSION_RATE, .range = DEM_RANGE_FROM_0},
    [NORMAL_WORK] = {"work_of_adhesion", dem_field_quantity, .at = offsetof(dem_pair_law, work_of_adhesion),
                     .dimension = DEM_DIMENSION_STIFFNESS, .range = DEM_RANGE_FROM_0},
    [NORMAL_PLUGIN] = {"plugin", dem_field_path, .at = offsetof(dem_pair_law, plugin)},
};
static const dem_fields normal_fields = DEM_FIELDS(normal_table);

static dem_status check_elastic(dem_scene_reader *r, const dem_scene_value *v, const dem_pair_law *law, bool poisson)
{
    for (int i = 0; i < 2; i++) {
        const dem_material *m = &r->scene->materials[law->materials[i]];
        bool young = isnan(m->young);
        if (young || (poisson && isnan(m->poisson)))
            return dem_scene_refuse(r, v, "add it to the material", "needs \"%s\" of \"%.60s\"",
                                    young ? "young" : "poisson", m->name);
    }
    return DEM_OK;
}

static const char *parameter_name(const void *user, size_t index)
{
    const dem_law_spec *spec = user;
    return index < spec->parameter_count ? spec->parameters[index].name : NULL;
}

static dem_status read_parameter(dem_scene_reader *r, const dem_scene_value *v, const dem_law_spec *spec,
                                 dem_law_value *value)
{
    const dem_law_parameter *p = spec->parameters, *end = p + spec->parameter_count;
    while (p < end && strcmp(p->name, value->name) != 0)
        p++;
    if (p == end)
        return dem_scene_unknown(r, v, DEM_JSON_KEY, "parameter", value->name, parameter_name, spec);
    return dem_read_quantity(r, v, dem_dimension_of(p->unit), (dem_range){.low = p->least, .high = p->most},
                             &value->value);
}

static dem_status read_parameters(dem_scene_reader *r, const dem_scene_value *v, const dem_law_spec *spec,
                                  dem_pair_law *law)
{
    dem_law_value *values = dem_scene_take(r, dem_json_length(v->json), sizeof *values);
    if (!values)
        return dem_fail_memory(r->error);
    law->parameters = values;
    for (const char *key = NULL; (key = dem_json_next(v->json, key));) {
        if (strcmp(key, "plugin") == 0)
            continue;
        dem_scene_value member = dem_scene_member(v, key);
        values[law->parameter_count] = (dem_law_value){key, 0};
        DEM_TRY(read_parameter(r, &member, spec, &values[law->parameter_count++]));
    }
    for (uint32_t i = 0; i < spec->parameter_count; i++) {
        const char *name = spec->parameters[i].name;
        if (isnan(spec->parameters[i].fallback) && !dem_json_member(v->json, name))
            return dem_scene_refuse(r, v, "add it", "the law %s needs \"%s\"", spec->name, name);
    }
    return DEM_OK;
}

// { "plugin": "law.so", numbers by their names }
static dem_status read_plugin(dem_scene_reader *r, const dem_scene_value *v, dem_pair_law *law)
{
    dem_scene_value path = dem_scene_member(v, "plugin");
    dem_plugin plugin;
    dem_error inner;
    law->normal = DEM_NORMAL_PLUGIN;
    DEM_TRY(dem_field_path(r, &path, &normal_table[NORMAL_PLUGIN], &law->plugin));
    if (dem_plugin_open(law->plugin, &plugin, &inner) != DEM_OK)
        return dem_scene_pass_on(r, &path, &inner);
    dem_status status = read_parameters(r, v, plugin.table->spec, law);
    dem_plugin_close(&plugin);
    return status;
}

static dem_status read_normal(dem_scene_reader *r, const dem_scene_value *v, const dem_field *field, void *into)
{
    dem_pair_law *law = into;
    uint64_t given;
    if (dem_json_member(v->json, "plugin"))
        return read_plugin(r, v, law);
    DEM_TRY(dem_fields_read(r, v, field->fields, law, &given));
    bool stiffness = dem_given(given, NORMAL_STIFFNESS), from = dem_given(given, NORMAL_STIFFNESS_FROM);
    bool restitution = dem_given(given, NORMAL_RESTITUTION), rate = dem_given(given, NORMAL_RATE);
    if (restitution && rate)
        return dem_scene_refuse(r, v, "give one of them", "has both \"restitution\" and \"damping_rate\"");
    law->damping = restitution ? DEM_DAMPING_RESTITUTION : rate ? DEM_DAMPING_RATE : DEM_DAMPING_NONE;
    bool adhesive = law->normal == DEM_NORMAL_DMT || law->normal == DEM_NORMAL_JKR;
    const char *name = law->normal == DEM_NORMAL_DMT ? "dmt" : law->normal == DEM_NORMAL_JKR ? "jkr" : "hertz";
    if (adhesive != dem_given(given, NORMAL_WORK))
        return adhesive ? dem_scene_refuse(r, v, "add it", "the law %s needs \"work_of_adhesion\"", name)
                        : dem_scene_refuse(r, v, "use one of them with it",
                                           "only the laws jkr and dmt have \"work_of_adhesion\"");
    if (dem_law_of_hertz(law)) {
        if (stiffness || from)
            return dem_scene_refuse(r, v, "leave it out, or use the linear law",
                                    "the law %s has no \"%s\", it follows from the materials", name,
                                    stiffness ? "stiffness" : "stiffness_from");
        return check_elastic(r, v, law, true);
    }
    if (stiffness == from)
        return dem_scene_refuse(r, v, "give one of them", "%s \"stiffness\" %s \"stiffness_from\"",
                                from ? "has both" : "the law linear needs", from ? "and" : "or");
    return from ? check_elastic(r, v, law, false) : DEM_OK;
}

// ---- friction

static const dem_choice friction_laws[] = {
    {"linear", DEM_FRICTION_LINEAR}, {"mindlin", DEM_FRICTION_MINDLIN}, {NULL, 0}};

enum {
    FRICTION_LAW,
    FRICTION_STIFFNESS,
    FRICTION_STIFFNESS_RATIO,
    FRICTION_COEFFICIENT,
    FRICTION_STATIC,
    FRICTION_DECAY,
    FRICTION_RATE,
    FRICTION_RESCALE
};
static const dem_field friction_table[] = {
    [FRICTION_LAW] = {"law", dem_field_choice, .at = offsetof(dem_pair_law, friction), .choices = friction_laws},
    [FRICTION_STIFFNESS] = {"stiffness", dem_field_quantity, .at = offsetof(dem_pair_law, tangential_stiffness),
                            .dimension = DEM_DIMENSION_STIFFNESS, .range = DEM_RANGE_POSITIVE},
    [FRICTION_STIFFNESS_RATIO] = {"stiffness_ratio", dem_field_quantity, .at = offsetof(dem_pair_law, stiffness_ratio),
                                  .dimension = DEM_DIMENSION_NONE, .range = DEM_RANGE_POSITIVE},
    [FRICTION_COEFFICIENT] = {"coefficient", dem_field_quantity, .at = offsetof(dem_pair_law, friction_coefficient),
                              true, DEM_DIMENSION_NONE, DEM_RANGE_FROM_0},
    [FRICTION_STATIC] = {"static_coefficient", dem_field_quantity, .at = offsetof(dem_pair_law, static_coefficient),
                         .dimension = DEM_DIMENSION_NONE, .range = DEM_RANGE_FROM_0},
    [FRICTION_DECAY] = {"decay", dem_field_quantity, .at = offsetof(dem_pair_law, friction_decay),
                        .dimension = DEM_DIMENSION_SLOWNESS, .range = DEM_RANGE_FROM_0},
    [FRICTION_RATE] = {"damping_rate", dem_field_quantity, .at = offsetof(dem_pair_law, tangential_rate),
                       .dimension = DEM_DIMENSION_RATE, .range = DEM_RANGE_FROM_0},
    [FRICTION_RESCALE] = {"rescale", dem_field_flag, .at = offsetof(dem_pair_law, rescale)},
};
static const dem_fields friction_fields = DEM_FIELDS(friction_table);

// A key that only one law of an object has.
typedef struct key_rule {
    int key, law;
    bool needed;  // by this law
} key_rule;

static dem_status check_keys(dem_scene_reader *r, const dem_scene_value *v, const dem_field *keys,
                             const dem_choice *laws, int law, uint64_t given, const key_rule *rules, int count)
{
    for (const key_rule *rule = rules; rule < rules + count; rule++) {
        const char *key = keys[rule->key].name, *name = laws->name;
        for (const dem_choice *c = laws; c->name; c++)
            name = c->value == rule->law ? c->name : name;
        bool has = dem_given(given, rule->key), of = law == rule->law;
        if (has && !of)
            return dem_scene_refuse(r, v, "leave it out", "only the law %s has \"%s\"", name, key);
        if (!has && of && rule->needed)
            return dem_scene_refuse(r, v, "add it", "the law %s needs \"%s\"", name, key);
    }
    return DEM_OK;
}

// the keys of a law that may be left out; null: none, and nothing is given
static dem_status read_keys(dem_scene_reader *r, const dem_scene_value *v, const dem_field *field, dem_pair_law *law,
                            uint64_t *given)
{
    *given = 0;
    if (dem_json_is_null(v->json))
        return DEM_OK;
    if (law->normal == DEM_NORMAL_PLUGIN)
        return dem_scene_refuse(r, v, "leave it out", "the law of a plug-in says all forces");
    return dem_fields_read(r, v, field->fields, law, given);
}

static dem_status check_static(dem_scene_reader *r, const dem_scene_value *v, const dem_pair_law *law, uint64_t given)
{
    if (dem_given(given, FRICTION_DECAY) && !dem_given(given, FRICTION_STATIC))
        return dem_scene_refuse(r, v, "add it, or leave \"decay\" out", "has \"decay\" without \"static_coefficient\"");
    if (law->static_coefficient < law->friction_coefficient)
        return dem_scene_refuse(r, v, "\"coefficient\" is that of sliding surfaces; correct one of them",
                                "has a \"static_coefficient\" below \"coefficient\"");
    return DEM_OK;
}

// without a name the law is the one that goes with the normal law
static dem_status read_friction(dem_scene_reader *r, const dem_scene_value *v, const dem_field *field, void *into)
{
    dem_pair_law *law = into;
    uint64_t given;
    if (!dem_json_is_null(v->json))
        law->friction = dem_law_of_hertz(law) ? DEM_FRICTION_MINDLIN : DEM_FRICTION_LINEAR;
    DEM_TRY(read_keys(r, v, field, law, &given));
    if (!given)
        return DEM_OK;
    bool mindlin = law->friction == DEM_FRICTION_MINDLIN;
    if (mindlin && !dem_law_of_hertz(law))
        return dem_scene_refuse(r, v, "use the law linear, or hertz for the normal force",
                                "the law mindlin needs the normal law hertz");
    if (dem_given(given, FRICTION_STIFFNESS) && dem_given(given, FRICTION_STIFFNESS_RATIO))
        return dem_scene_refuse(r, v, "give one of them", "has both \"stiffness\" and \"stiffness_ratio\"");
    static const int of_linear[] = {FRICTION_STIFFNESS, FRICTION_STIFFNESS_RATIO};
    for (int i = 0; mindlin && i < 2; i++)
        if (dem_given(given, of_linear[i]))
            return dem_scene_refuse(r, v, "leave it out, it follows from the materials",
                                    "the law mindlin has no \"%s\"", friction_table[of_linear[i]].name);
    if (!mindlin && dem_given(given, FRICTION_RESCALE))
        return dem_scene_refuse(r, v, "leave it out", "the law linear has no \"rescale\"");
    return check_static(r, v, law, given);
}

// ---- rolling, twisting, cohesion

static const dem_choice rolling_laws[] = {
    {"bounded", DEM_ROLLING_BOUNDED}, {"epsd", DEM_ROLLING_EPSD}, {"constant", DEM_ROLLING_CONSTANT}, {NULL, 0}};

enum { ROLLING_LAW, ROLLING_COEFFICIENT, ROLLING_STIFFNESS, ROLLING_DAMPING };
static const dem_field rolling_table[] = {
    [ROLLING_LAW] = {"law", dem_field_choice, .at = offsetof(dem_pair_law, rolling), .needed = true,
                     .choices = rolling_laws},
    [ROLLING_COEFFICIENT] = {"coefficient", dem_field_quantity, .at = offsetof(dem_pair_law, rolling_coefficient), true,
                             DEM_DIMENSION_NONE, DEM_RANGE_FROM_0},
    [ROLLING_STIFFNESS] = {"stiffness", dem_field_quantity, .at = offsetof(dem_pair_law, rolling_stiffness),
                           .dimension = DEM_DIMENSION_NONE, .range = DEM_RANGE_POSITIVE},
    [ROLLING_DAMPING] = {"damping", dem_field_quantity, .at = offsetof(dem_pair_law, rolling_damping),
                         .dimension = DEM_DIMENSION_NONE, .range = DEM_RANGE_FROM_0},
};
static const dem_fields rolling_fields = DEM_FIELDS(rolling_table);

static dem_status read_rolling(dem_scene_reader *r, const dem_scene_value *v, const dem_field *field, void *into)
{
    static const key_rule rules[] = {{ROLLING_STIFFNESS, DEM_ROLLING_EPSD, false},
                                     {ROLLING_DAMPING, DEM_ROLLING_EPSD, false}};
    dem_pair_law *law = into;
    uint64_t given;
    DEM_TRY(read_keys(r, v, field, law, &given));
    return check_keys(r, v, rolling_table, rolling_laws, law->rolling, given, rules, 2);
}

static const dem_choice twisting_laws[] = {
    {"marshall", DEM_TWISTING_MARSHALL}, {"constant", DEM_TWISTING_CONSTANT}, {NULL, 0}};

enum { TWISTING_LAW, TWISTING_COEFFICIENT };
static const dem_field twisting_table[] = {
    [TWISTING_LAW] = {"law", dem_field_choice, .at = offsetof(dem_pair_law, twisting), .needed = true,
                      .choices = twisting_laws},
    [TWISTING_COEFFICIENT] = {"coefficient", dem_field_quantity, .at = offsetof(dem_pair_law, twisting_coefficient),
                              .dimension = DEM_DIMENSION_NONE, .range = DEM_RANGE_FROM_0},
};
static const dem_fields twisting_fields = DEM_FIELDS(twisting_table);

static dem_status read_twisting(dem_scene_reader *r, const dem_scene_value *v, const dem_field *field, void *into)
{
    static const key_rule rules[] = {{TWISTING_COEFFICIENT, DEM_TWISTING_CONSTANT, true}};
    dem_pair_law *law = into;
    uint64_t given;
    DEM_TRY(read_keys(r, v, field, law, &given));
    if (law->twisting == DEM_TWISTING_MARSHALL && dem_given(given, TWISTING_COEFFICIENT))
        return dem_scene_refuse(r, v, "leave it out", "the law marshall takes the coefficient of the friction");
    return check_keys(r, v, twisting_table, twisting_laws, law->twisting, given, rules, 1);
}

static const dem_choice cohesion_laws[] = {
    {"sjkr", DEM_COHESION_SJKR}, {"breakable", DEM_COHESION_BREAKABLE}, {NULL, 0}};
static const dem_choice bonding_times[] = {
    {"at_start", DEM_BONDED_AT_START}, {"at_touch", DEM_BONDED_AT_TOUCH}, {NULL, 0}};

enum { COHESION_LAW, COHESION_DENSITY, COHESION_TENSION, COHESION_SHEAR, COHESION_BONDED, COHESION_GAP };
static const dem_field cohesion_table[] = {
    [COHESION_LAW] = {"law", dem_field_choice, .at = offsetof(dem_pair_law, cohesion), .needed = true,
                      .choices = cohesion_laws},
    [COHESION_DENSITY] = {"energy_density", dem_field_quantity, .at = offsetof(dem_pair_law, energy_density),
                          .dimension = DEM_DIMENSION_PRESSURE, .range = DEM_RANGE_FROM_0},
    [COHESION_TENSION] = {"tension", dem_field_quantity, .at = offsetof(dem_pair_law, bond_tension),
                          .dimension = DEM_DIMENSION_FORCE, .range = DEM_RANGE_FROM_0},
    [COHESION_SHEAR] = {"shear", dem_field_quantity, .at = offsetof(dem_pair_law, bond_shear),
                        .dimension = DEM_DIMENSION_FORCE, .range = DEM_RANGE_FROM_0},
    [COHESION_BONDED] = {"bonded", dem_field_choice, .at = offsetof(dem_pair_law, bonded), .choices = bonding_times},
    [COHESION_GAP] = {"gap", dem_field_quantity, .at = offsetof(dem_pair_law, bond_gap),
                      .dimension = DEM_DIMENSION_LENGTH, .range = DEM_RANGE_FROM_0},
};
static const dem_fields cohesion_fields = DEM_FIELDS(cohesion_table);

static dem_status read_cohesion(dem_scene_reader *r, const dem_scene_value *v, const dem_field *field, void *into)
{
    static const key_rule rules[] = {{COHESION_DENSITY, DEM_COHESION_SJKR, true},
                                     {COHESION_TENSION, DEM_COHESION_BREAKABLE, true},
                                     {COHESION_SHEAR, DEM_COHESION_BREAKABLE, true},
                                     {COHESION_BONDED, DEM_COHESION_BREAKABLE, false},
                                     {COHESION_GAP, DEM_COHESION_BREAKABLE, false}};
    dem_pair_law *law = into;
    uint64_t given;
    DEM_TRY(read_keys(r, v, field, law, &given));
    DEM_TRY(check_keys(r, v, cohesion_table, cohesion_laws, law->cohesion, given, rules, 5));
    if (law->cohesion != DEM_COHESION_BREAKABLE)
        return DEM_OK;
    if (law->normal != DEM_NORMAL_LINEAR)
        return dem_scene_refuse(r, v, "use the linear law, whose spring can pull, or \"bonds\"",
                                "the law breakable needs the normal law linear");
    if (law->friction == DEM_FRICTION_NONE)
        return dem_scene_refuse(r, v, "add \"friction\", with the coefficient that is left once it is broken",
                                "the law breakable holds the surfaces by the spring of the friction");
    if (law->bonded == DEM_BONDED_AT_TOUCH && dem_given(given, COHESION_GAP))
        return dem_scene_refuse(r, v, "leave it out", "surfaces that are bonded at_touch have no \"gap\"");
    return DEM_OK;
}

// ---- contacts

static dem_status read_between(dem_scene_reader *r, const dem_scene_value *v, const dem_field *field, void *into)
{
    uint32_t *materials = into;
    DEM_TRY(dem_read_array(r, v, 2, "the names of two materials"));
    for (size_t i = 0; i < 2; i++) {
        dem_scene_value item = dem_scene_item(v, i);
        DEM_TRY(dem_field_material(r, &item, field, &materials[i]));
    }
    return DEM_OK;
}

static const dem_choice effective_masses[] = {{"local", DEM_MASS_LOCAL}, {"body", DEM_MASS_BODY}, {NULL, 0}};

static const dem_field contact_table[] = {
    {"between", read_between, .at = offsetof(dem_pair_law, materials), .needed = true},
    {"effective_mass", dem_field_choice, .at = offsetof(dem_pair_law, effective_mass), .choices = effective_masses},
    {"normal", read_normal, .needed = true, .fields = &normal_fields},
    {"friction", read_friction, .fields = &friction_fields},
    {"rolling", read_rolling, .fields = &rolling_fields},
    {"twisting", read_twisting, .fields = &twisting_fields},
    {"cohesion", read_cohesion, .fields = &cohesion_fields},
};
const dem_fields dem_contact_fields = DEM_FIELDS(contact_table);

static dem_status check_first_of_its_pair(dem_scene_reader *r, const dem_scene_value *v, const dem_pair_law *law)
{
    const uint32_t *m = law->materials;
    for (const dem_pair_law *other = r->scene->laws; other < law; other++) {
        const uint32_t *n = other->materials;
        if ((m[0] == n[0] && m[1] == n[1]) || (m[0] == n[1] && m[1] == n[0])) {
            dem_scene_value between = dem_scene_member(v, "between");
            return dem_scene_refuse(r, &between, "leave one of them", "contacts[%zu] is between these two already",
                                    (size_t)(other - r->scene->laws));
        }
    }
    return DEM_OK;
}

dem_status dem_section_contacts(dem_scene_reader *r, const dem_scene_value *v, const dem_field *field, void *into)
{
    (void)into;
    if (!dem_json_is_array(v->json))
        return dem_scene_refuse(r, v, "write [ { \"between\": [\"A\", \"B\"], ... }, ... ]",
                                "needs a list of contacts");
    size_t count = dem_json_length(v->json);
    dem_pair_law *laws = dem_scene_take(r, count, sizeof *laws);
    if (!laws)
        return dem_fail_memory(r->error);
    r->scene->laws = laws;
    for (size_t i = 0; i < count; i++) {
        dem_scene_value item = dem_scene_item(v, i);
        laws[i] = dem_pair_law_defaults();
        DEM_TRY(dem_fields_read(r, &item, field->fields, &laws[i], NULL));
        DEM_TRY(check_first_of_its_pair(r, &item, &laws[i]));
        r->scene->law_count++;
    }
    return DEM_OK;
}
