// "motion" of a wall: translate, rotate, oscillate, table, start and stop.
#include <string.h>

#include "sim/scene_wall.h"
#include "sim/wall_motion.h"

// ---- steady

static const dem_field translate_table[] = {
    {"velocity", dem_field_vector, .at = offsetof(wall_text, wall.velocity), true, DEM_DIMENSION_VELOCITY},
};
static const dem_fields translate_fields = DEM_FIELDS(translate_table);

static const dem_field rotate_table[] = {
    {"axis", dem_field_direction, .at = offsetof(wall_text, source.axis), true, DEM_DIMENSION_NONE},
    {"through", dem_field_vector, .at = offsetof(wall_text, wall.through), .dimension = DEM_DIMENSION_LENGTH},
    {"rate", dem_field_quantity, .at = offsetof(wall_text, source.rate), true, DEM_DIMENSION_ANGULAR_VELOCITY},
};
static const dem_fields rotate_fields = DEM_FIELDS(rotate_table);

static dem_status read_rotate(dem_scene_reader *r, const dem_scene_value *v, const dem_field *field, void *into)
{
    wall_text *text = into;
    DEM_TRY(dem_fields_read(r, v, field->fields, text, NULL));
    // without a rate it says nothing, and others may take another axis
    text->turns = text->source.rate != 0;
    if (text->source.rate < 0)
        text->wall.axis = v3_scale(text->source.axis, -1);
    else
        text->wall.axis = text->source.axis;
    return DEM_OK;
}

// a wall turns about one axis; the first part that turns sets it
static dem_status set_axis(dem_scene_reader *r, const dem_scene_value *v, wall_text *text, dem_vec3 axis,
                           dem_vec3 through)
{
    if (!text->turns) {
        text->wall.axis = axis;
        text->wall.through = through;
    }
    double size = 1e-9 * (v3_norm(through) + v3_norm(text->wall.through));
    bool same = v3_norm(v3_sub(axis, text->wall.axis)) < 1e-9 && v3_distance(through, text->wall.through) <= size;
    text->turns = true;
    return same ? DEM_OK
                : dem_scene_refuse(r, v,
                                   "give the same \"axis\" and \"through\" everywhere, the axis so that a rate is "
                                   "positive",
                                   "turns about another axis than the rest of the motion");
}

// ---- oscillation

typedef struct swing_text {
    dem_oscillation swing;
    dem_vec3 direction, axis, through;
    double amplitude;
} swing_text;

// a vector, or a length along "direction"
static dem_status read_amplitude(dem_scene_reader *r, const dem_scene_value *v, const dem_field *field, void *into)
{
    swing_text *text = into;
    if (dem_json_is_array(v->json))
        return dem_field_vector(r, v, field, &text->swing.shift);
    return dem_field_quantity(r, v, field, &text->amplitude);
}

enum { SWING_AMPLITUDE, SWING_DIRECTION, SWING_ANGLE, SWING_AXIS, SWING_THROUGH, SWING_FREQUENCY, SWING_PHASE };
static const dem_field swing_table[] = {
    [SWING_AMPLITUDE] = {"amplitude", read_amplitude, .dimension = DEM_DIMENSION_LENGTH},
    [SWING_DIRECTION] = {"direction", dem_field_direction, .at = offsetof(swing_text, direction),
                         .dimension = DEM_DIMENSION_NONE},
    [SWING_ANGLE] = {"angle", dem_field_quantity, .at = offsetof(swing_text, swing.turn),
                     .dimension = DEM_DIMENSION_ANGLE},
    [SWING_AXIS] = {"axis", dem_field_direction, .at = offsetof(swing_text, axis), .dimension = DEM_DIMENSION_NONE},
    [SWING_THROUGH] = {"through", dem_field_vector, .at = offsetof(swing_text, through),
                       .dimension = DEM_DIMENSION_LENGTH},
    [SWING_FREQUENCY] = {"frequency", dem_field_quantity, .at = offsetof(swing_text, swing.frequency), true,
                         DEM_DIMENSION_RATE, DEM_RANGE_POSITIVE},
    [SWING_PHASE] = {"phase", dem_field_quantity, .at = offsetof(swing_text, swing.phase),
                     .dimension = DEM_DIMENSION_ANGLE},
};
static const dem_fields swing_fields = DEM_FIELDS(swing_table);

static dem_status read_swing(dem_scene_reader *r, const dem_scene_value *v, wall_text *text, dem_oscillation *swing)
{
    swing_text t = {.through = text->turns ? text->wall.through : v3(0, 0, 0)};
    uint64_t given;
    DEM_TRY(dem_fields_read(r, v, &swing_fields, &t, &given));
    bool shifts = dem_given(given, SWING_AMPLITUDE), turns = dem_given(given, SWING_ANGLE);
    bool length = t.amplitude != 0 || !(v3_norm2(t.swing.shift) > 0);
    if (!shifts && !turns)
        return dem_scene_refuse(r, v, "add the amplitude of a shift or the angle of a turn",
                                "needs \"amplitude\" or \"angle\"");
    if (shifts && length && !dem_given(given, SWING_DIRECTION))
        return dem_scene_refuse(r, v, "add it, or write the amplitude as [x, y, z]", "\"direction\" is missing");
    if (!length && dem_given(given, SWING_DIRECTION))
        return dem_scene_refuse(r, v, "leave it out", "the amplitude has a direction already");
    if (shifts && length)
        t.swing.shift = v3_scale(t.direction, t.amplitude);
    if (turns && !dem_given(given, SWING_AXIS))
        return dem_scene_refuse(r, v, "add it", "\"axis\" of the angle is missing");
    if (turns)
        DEM_TRY(set_axis(r, v, text, t.axis, t.through));
    *swing = t.swing;
    return DEM_OK;
}

static dem_status read_oscillate(dem_scene_reader *r, const dem_scene_value *v, const dem_field *field, void *into)
{
    (void)field;
    wall_text *text = into;
    bool many = dem_json_is_array(v->json);
    size_t count = many ? dem_json_length(v->json) : 1;
    dem_oscillation *swings = dem_scene_take(r, count, sizeof *swings);
    if (!swings)
        return dem_fail_memory(r->error);
    for (size_t i = 0; i < count; i++) {
        dem_scene_value item = many ? dem_scene_item(v, i) : *v;
        DEM_TRY(read_swing(r, &item, text, &swings[i]));
    }
    text->wall.oscillations = count ? swings : NULL;
    text->wall.oscillation_count = count;
    return DEM_OK;
}

// ---- table

typedef struct table_text {
    dem_wall_table table;
    int interpolation;
    dem_vec3 axis, through;
} table_text;

static const dem_choice interpolations[] = {{"linear", false}, {"cubic", true}, {NULL, 0}};

enum { TABLE_FILE, TABLE_INTERPOLATION, TABLE_AXIS, TABLE_THROUGH };
static const dem_field table_table[] = {
    [TABLE_FILE] = {"file", dem_field_path, .at = offsetof(table_text, table.file), true, DEM_DIMENSION_NONE},
    [TABLE_INTERPOLATION] = {"interpolation", dem_field_choice, .at = offsetof(table_text, interpolation),
                             .choices = interpolations},
    [TABLE_AXIS] = {"axis", dem_field_direction, .at = offsetof(table_text, axis), .dimension = DEM_DIMENSION_NONE},
    [TABLE_THROUGH] = {"through", dem_field_vector, .at = offsetof(table_text, through),
                       .dimension = DEM_DIMENSION_LENGTH},
};
static const dem_fields table_fields = DEM_FIELDS(table_table);

static dem_status check_start(dem_scene_reader *r, const dem_scene_value *v, const dem_wall_table *table)
{
    dem_wall_def alone = {.table = *table};
    dem_wall_motion motion = dem_wall_motion_of(&alone);
    dem_wall_moment now = dem_wall_motion_at(&motion, 0);
    if (v3_norm(now.shift) <= 1e-9 * motion.range && fabs(now.angle) <= 1e-9)
        return DEM_OK;
    return dem_scene_refuse(r, v, "begin the table with zeros, and move the wall itself",
                            "the table shifts the wall at time 0, where it stands as it is given");
}

static dem_status read_table(dem_scene_reader *r, const dem_scene_value *v, const dem_field *field, void *into)
{
    wall_text *text = into;
    table_text t = {.through = text->turns ? text->wall.through : v3(0, 0, 0)};
    uint64_t given = 0;
    if (dem_json_string(v->json)) {
        const dem_field path = {"file", dem_field_path, .at = 0};
        DEM_TRY(dem_field_path(r, v, &path, &t.table.file));
    } else
        DEM_TRY(dem_fields_read(r, v, field->fields, &t, &given));
    t.table.cubic = t.interpolation;
    DEM_TRY(dem_wall_read_table(r, v, &t.table));
    if (t.table.turn && !dem_given(given, TABLE_AXIS))
        return dem_scene_refuse(r, v, "write { \"file\": ..., \"axis\": [x, y, z] }",
                                "the table has angles; \"axis\" is missing");
    if (t.table.turn)
        DEM_TRY(set_axis(r, v, text, t.axis, t.through));
    DEM_TRY(check_start(r, v, &t.table));
    text->wall.table = t.table;
    return DEM_OK;
}

// ---- all

static const dem_field motion_table[] = {
    {"translate", dem_field_object, .fields = &translate_fields},
    {"rotate", read_rotate, .fields = &rotate_fields},
    {"oscillate", read_oscillate, .fields = &swing_fields},
    {"table", read_table, .fields = &table_fields},
    {"start", dem_field_quantity, .at = offsetof(wall_text, wall.start), .dimension = DEM_DIMENSION_TIME,
     .range = DEM_RANGE_FROM_0},
    {"stop", dem_field_quantity, .at = offsetof(wall_text, wall.stop), .dimension = DEM_DIMENSION_TIME,
     .range = DEM_RANGE_POSITIVE},
};
const dem_fields dem_wall_motion_fields = DEM_FIELDS(motion_table);

dem_status dem_wall_read_motion(dem_scene_reader *r, const dem_scene_value *v, const dem_field *field, void *into)
{
    wall_text *text = into;
    DEM_TRY(dem_fields_read(r, v, field->fields, text, NULL));
    if (text->wall.stop > 0 && !(text->wall.stop > text->wall.start))
        return dem_scene_refuse(r, v, "exchange or correct them", "\"stop\" must be after \"start\"");
    return DEM_OK;
}
