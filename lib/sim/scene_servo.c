// "servo" of a wall.
#include <string.h>

#include "sim/scene_wall.h"

// a stress, or of a box one for each axis, null where there is no servo
static dem_status read_stress(dem_scene_reader *r, const dem_scene_value *v, const dem_field *field, void *into)
{
    wall_text *text = into;
    text->three_stresses = dem_json_is_array(v->json);
    if (!text->three_stresses) {
        DEM_TRY(dem_field_quantity(r, v, field, &text->wall.servo.target));
        for (int k = 0; k < 3; k++)
            text->stress[k] = text->wall.servo.target;
        return DEM_OK;
    }
    DEM_TRY(dem_read_array(r, v, 3, "[x, y, z]"));
    for (size_t k = 0; k < 3; k++) {
        dem_scene_value item = dem_scene_item(v, k);
        text->stress[k] = NAN;
        if (!dem_json_is_null(item.json))
            DEM_TRY(dem_read_quantity(r, &item, field->dimension, field->range, &text->stress[k]));
    }
    return DEM_OK;
}

// two lengths, or pairs of names of planes
static dem_status read_extents(dem_scene_reader *r, const dem_scene_value *v, const dem_field *field, void *into)
{
    wall_text *text = into;
    DEM_TRY(dem_read_array(r, v, 2, "the two lengths of the area"));
    for (size_t k = 0; k < 2; k++) {
        dem_scene_value item = dem_scene_item(v, k);
        if (!dem_json_is_array(item.json)) {
            DEM_TRY(dem_read_quantity(r, &item, field->dimension, field->range, &text->wall.servo.extent[k].length));
            continue;
        }
        DEM_TRY(dem_read_array(r, &item, 2, "the names of two planes"));
        for (size_t e = 0; e < 2; e++) {
            dem_scene_value name = dem_scene_item(&item, e);
            DEM_TRY(dem_field_text(r, &name, field, &text->source.extent[k][e]));
        }
    }
    return DEM_OK;
}

#define SERVO(member) offsetof(wall_text, wall.servo.member)
enum { FORCE, STRESS, DIRECTION, AREA, EXTENTS, GAIN, MAX_VELOCITY, MASS, DAMPING_RATE, PARTNER };
static const dem_field servo_table[] = {
    [FORCE] = {"force", dem_field_quantity, .at = SERVO(target), .dimension = DEM_DIMENSION_FORCE,
               .range = DEM_RANGE_FROM_0},
    [STRESS] = {"stress", read_stress, .dimension = DEM_DIMENSION_PRESSURE, .range = DEM_RANGE_FROM_0},
    [DIRECTION] = {"direction", dem_field_direction, .at = SERVO(direction), .dimension = DEM_DIMENSION_NONE},
    [AREA] = {"area", dem_field_quantity, .at = SERVO(area), .dimension = DEM_DIMENSION_AREA,
              .range = DEM_RANGE_POSITIVE},
    [EXTENTS] = {"extents", read_extents, .dimension = DEM_DIMENSION_LENGTH, .range = DEM_RANGE_POSITIVE},
    [GAIN] = {"gain", dem_field_quantity, .at = SERVO(gain), .dimension = DEM_DIMENSION_NONE,
              .range = {.high = 1, .above = true}},
    [MAX_VELOCITY] = {"max_velocity", dem_field_quantity, .at = SERVO(max_velocity), true, DEM_DIMENSION_VELOCITY,
                      DEM_RANGE_POSITIVE},
    [MASS] = {"mass", dem_field_quantity, .at = SERVO(mass), .dimension = DEM_DIMENSION_MASS,
              .range = DEM_RANGE_FROM_0},
    [DAMPING_RATE] = {"damping_rate", dem_field_quantity, .at = SERVO(damping_rate), .dimension = DEM_DIMENSION_RATE,
                      .range = DEM_RANGE_FROM_0},
    [PARTNER] = {"partner", dem_field_text, .at = offsetof(wall_text, source.partner)},
};
const dem_fields dem_wall_servo_fields = DEM_FIELDS(servo_table);

dem_status dem_wall_read_servo(dem_scene_reader *r, const dem_scene_value *v, const dem_field *field, void *into)
{
    wall_text *text = into;
    text->wall.servo = (dem_servo_def){.on = true, .gain = 0.5};
    DEM_TRY(dem_fields_read(r, v, field->fields, text, &text->servo_given));
    uint64_t given = text->servo_given;
    if (dem_given(given, FORCE) == dem_given(given, STRESS))
        return dem_scene_refuse(r, v, "give exactly one", "needs \"force\" or \"stress\"");
    text->wall.servo.stress = dem_given(given, STRESS);
    if (dem_given(given, AREA) && dem_given(given, EXTENTS))
        return dem_scene_refuse(r, v, "leave one out", "has both \"area\" and \"extents\"");
    if (dem_given(given, DAMPING_RATE) && !(text->wall.servo.mass > 0))
        return dem_scene_refuse(r, v, "add \"mass\" or leave it out", "\"damping_rate\" is that of a wall with a mass");
    return DEM_OK;
}

dem_status dem_wall_check_servo(dem_scene_reader *r, const dem_scene_value *v, wall_text *text, bool box, bool plane)
{
    uint64_t given = text->servo_given, of_box = 1u << DIRECTION | 1u << AREA | 1u << EXTENTS | 1u << PARTNER;
    dem_servo_def *s = &text->wall.servo;
    if (box && (given & of_box))
        return dem_scene_refuse(r, v, "leave \"direction\", \"area\", \"extents\" and \"partner\" out",
                                "the sides of a box have their own directions and areas, and go two by two");
    if (text->three_stresses && !box)
        return dem_scene_refuse(r, v, "give one number", "three stresses are those of a box");
    if (box || dem_given(given, DIRECTION))
        return DEM_OK;
    if (!plane)
        return dem_scene_refuse(r, v, "add it, towards the bodies", "\"direction\" is missing");
    s->direction = text->wall.normal;
    return DEM_OK;
}

void dem_wall_servo_of_side(dem_wall_def *side, const wall_text *text, int index, uint32_t first)
{
    dem_servo_def *s = &side->servo;
    if (!s->on)
        return;
    int axis = index / 2;
    if (s->stress && isnan(text->stress[axis])) {
        *s = (dem_servo_def){0};
        return;
    }
    if (s->stress)
        s->target = text->stress[axis];
    s->direction = side->normal;
    s->partner = first + (uint32_t)(index ^ 1) + 1;
    for (int k = 0; k < 2; k++) {
        uint32_t low = first + 2 * (uint32_t)((axis + 1 + k) % 3);
        s->extent[k] = (dem_servo_extent){0, {low, low + 1}};
    }
}

static const char *wall_name(const void *user, size_t index)
{
    const struct dem_scene_owner *o = user;
    return index < o->wall_count ? o->walls[index].name : NULL;
}

static dem_status find(dem_scene_reader *r, const dem_scene_value *v, size_t wall, const char *name, uint32_t *index)
{
    const struct dem_scene_owner *o = r->owner;
    for (size_t i = 0; i < o->wall_count; i++)
        if (strcmp(o->walls[i].name, name) == 0) {
            *index = (uint32_t)i;
            return DEM_OK;
        }
    dem_scene_value member = dem_scene_member(v, o->walls[wall].name);
    return dem_scene_unknown(r, &member, DEM_JSON_VALUE, "wall", name, wall_name, o);
}

dem_status dem_wall_find_names(dem_scene_reader *r, const dem_scene_value *v)
{
    struct dem_scene_owner *o = r->owner;
    for (size_t i = 0; i < o->wall_count; i++) {
        const dem_wall_source *source = &o->wall_sources[i];
        dem_servo_def *s = &o->walls[i].servo;
        uint32_t index = 0;
        if (source->partner) {
            DEM_TRY(find(r, v, i, source->partner, &index));
            s->partner = index + 1;
        }
        for (int k = 0; k < 2; k++)
            for (int e = 0; e < 2; e++)
                if (source->extent[k][e])
                    DEM_TRY(find(r, v, i, source->extent[k][e], &s->extent[k].walls[e]));
    }
    return DEM_OK;
}
