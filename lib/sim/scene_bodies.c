// "bodies": single ones, files of them, and fills.
#include <math.h>
#include <stdlib.h>

#include "base/file.h"
#include "sim/bodies_csv.h"
#include "sim/hold.h"
#include "sim/scene_reader.h"

// one entry as it stands in the list
typedef struct entry_text {
    dem_body_def body;
    const char *file;
    double size;
    bool fixed;
} entry_text;

static dem_status read_orientation(dem_scene_reader *r, const dem_scene_value *v, const dem_field *field, void *into)
{
    dem_quat *q = into;
    double *parts[4] = {&q->w, &q->x, &q->y, &q->z};
    DEM_TRY(dem_read_array(r, v, 4, "a quaternion [w, x, y, z]"));
    for (size_t i = 0; i < 4; i++) {
        dem_scene_value item = dem_scene_item(v, i);
        DEM_TRY(dem_read_quantity(r, &item, DEM_DIMENSION_NONE, field->range, parts[i]));
    }
    if (!dem_quat_normalise(q))
        return dem_scene_refuse(r, v, "[1, 0, 0, 0] means not turned", "has no length");
    return DEM_OK;
}

enum {
    BODY_FILE,
    BODY_FILL,
    BODY_SHAPE,
    BODY_POSITION,
    BODY_ORIENTATION,
    BODY_VELOCITY,
    BODY_SPIN,
    BODY_SIZE,
    BODY_SCALE,
    BODY_FIXED,
    BODY_LOCK,
    BODY_PRESCRIBED,
    BODY_GROUP,
};

// ---- what is held

static const dem_choice locks[] = {{"x", DEM_LOCK_X},   {"y", DEM_LOCK_Y},   {"z", DEM_LOCK_Z}, {"rx", DEM_LOCK_RX},
                                   {"ry", DEM_LOCK_RY}, {"rz", DEM_LOCK_RZ}, {NULL, 0}};
static const dem_choice kept[] = {{"velocity", DEM_HOLD_VELOCITY}, {"spin", DEM_HOLD_SPIN}, {NULL, 0}};

// one name or a list of names, as bits
static dem_status read_hold(dem_scene_reader *r, const dem_scene_value *v, const dem_field *field, void *into)
{
    uint32_t *hold = into;
    int bit;
    if (dem_json_string(v->json)) {
        DEM_TRY(dem_field_choice(r, v, field, &bit));
        *hold |= (uint32_t)bit;
        return DEM_OK;
    }
    if (!dem_json_is_array(v->json) || !dem_json_length(v->json))
        return dem_scene_refuse(
            r, v, field->choices == locks ? "write it as in [\"z\", \"rx\"]" : "write it as in [\"velocity\"]",
            "needs a list of names");
    for (size_t i = 0; i < dem_json_length(v->json); i++) {
        dem_scene_value item = dem_scene_item(v, i);
        DEM_TRY(dem_field_choice(r, &item, field, &bit));
        *hold |= (uint32_t)bit;
    }
    return DEM_OK;
}

static dem_status read_fixed(dem_scene_reader *r, const dem_scene_value *v, const dem_field *field, void *into)
{
    uint32_t *hold = into;
    bool fixed;
    DEM_TRY(dem_field_flag(r, v, field, &fixed));
    *hold |= fixed ? DEM_HOLD_VELOCITY | DEM_HOLD_SPIN : 0;
    return DEM_OK;
}

// ---- entries

void dem_scene_forget_files(dem_scene *scene)
{
    struct dem_scene_owner *o = scene->owner;
    size_t stay = 0;
    if (!o || scene->bodies.bodies != o->bodies)
        return;
    for (size_t i = 0; i < o->entry_count; i++) {
        dem_scene_entry *entry = &o->entries[i];
        if (entry->kind == DEM_ENTRY_BODY) {
            o->bodies[stay] = o->bodies[entry->first];
            entry->first = stay++;
        } else if (entry->kind == DEM_ENTRY_FILE)
            entry->first = entry->count = 0;
    }
    dem_body_def *less = realloc(o->bodies, (stay + 1) * sizeof *less);
    o->bodies = less ? less : o->bodies;
    o->body_count = stay;
    o->body_capacity = less ? stay + 1 : o->body_capacity;
    scene->bodies.bodies = o->bodies;
    scene->bodies.count = stay;
}

static const dem_field body_table[] = {
    [BODY_FILE] = {"file", dem_field_path, .at = offsetof(entry_text, file)},
    [BODY_FILL] = {"fill", dem_section_fill, .fields = &dem_fill_fields},
    [BODY_SHAPE] = {"shape", dem_field_shape, .at = offsetof(entry_text, body.shape)},
    [BODY_POSITION] = {"position", dem_field_vector, .at = offsetof(entry_text, body.position),
                       .dimension = DEM_DIMENSION_LENGTH},
    [BODY_ORIENTATION] = {"orientation", read_orientation, .at = offsetof(entry_text, body.orientation)},
    [BODY_VELOCITY] = {"velocity", dem_field_vector, .at = offsetof(entry_text, body.velocity),
                       .dimension = DEM_DIMENSION_VELOCITY},
    [BODY_SPIN] = {"spin", dem_field_vector, .at = offsetof(entry_text, body.spin),
                   .dimension = DEM_DIMENSION_ANGULAR_VELOCITY},
    [BODY_SIZE] = {"size", dem_field_quantity, .at = offsetof(entry_text, size), .dimension = DEM_DIMENSION_LENGTH,
                   .range = DEM_RANGE_POSITIVE},
    [BODY_SCALE] = {"scale", dem_field_quantity, .at = offsetof(entry_text, body.scale),
                    .dimension = DEM_DIMENSION_NONE, .range = DEM_RANGE_POSITIVE},
    [BODY_FIXED] = {"fixed", read_fixed, .at = offsetof(entry_text, body.hold)},
    [BODY_LOCK] = {"lock", read_hold, .at = offsetof(entry_text, body.hold), .choices = locks},
    [BODY_PRESCRIBED] = {"prescribed", read_hold, .at = offsetof(entry_text, body.hold), .choices = kept},
    [BODY_GROUP] = {"group", dem_field_text, .at = offsetof(entry_text, body.group)},
};
const dem_fields dem_body_fields = DEM_FIELDS(body_table);

static dem_status add_entry(dem_scene_reader *r, dem_scene_entry entry)
{
    struct dem_scene_owner *o = r->owner;
    if (!dem_grow(&o->entries, &o->entry_capacity, o->entry_count, sizeof *o->entries))
        return dem_fail_memory(r->error);
    o->entries[o->entry_count++] = entry;
    return DEM_OK;
}

static bool is_zero(dem_vec3 v)
{
    return v.x == 0 && v.y == 0 && v.z == 0;
}

// a body that is fixed and moves, or is held at what it is locked out of, is a mistake
static dem_status check_hold(dem_scene_reader *r, const dem_scene_value *v, bool fixed, dem_vec3 velocity,
                             dem_vec3 spin, uint32_t hold)
{
    bool turns = !is_zero(v3_sub(spin, unlocked_spin(spin, hold)));
    if (fixed && !(is_zero(velocity) && is_zero(spin)))
        return dem_scene_refuse(r, v, "leave one out, or write \"prescribed\": [\"velocity\", \"spin\"]",
                                "is \"fixed\" and moves");
    if (turns || !is_zero(v3_sub(velocity, unlocked_velocity(velocity, hold))))
        return dem_scene_refuse(r, v, "set it to 0 there", "has a %s along an axis of \"lock\"",
                                turns ? "spin" : "velocity");
    return DEM_OK;
}

static dem_status add_file(dem_scene_reader *r, const dem_scene_value *v, const char *file, bool fixed, uint32_t hold,
                           const char *group)
{
    struct dem_scene_owner *o = r->owner;
    dem_buffer text;
    DEM_TRY(dem_file_read(file, &text, r->error));
    size_t first = o->body_count;
    dem_status status = dem_bodies_csv_parse(text.data, text.size, file, r->scene->shapes, r->scene->shape_count,
                                             &o->bodies, &o->body_count, &o->body_capacity, r->error);
    dem_buffer_release(&text);
    for (size_t i = first; status == DEM_OK && i < o->body_count; i++) {
        o->bodies[i].hold = hold;
        o->bodies[i].group = group;
        status = check_hold(r, v, fixed, o->bodies[i].velocity, o->bodies[i].spin, hold);
    }
    if (status != DEM_OK)
        return status;
    return add_entry(r, (dem_scene_entry){DEM_ENTRY_FILE, file, first, o->body_count - first, hold, group});
}

static dem_status add_body(dem_scene_reader *r, const dem_scene_value *v, uint64_t given, entry_text *text)
{
    struct dem_scene_owner *o = r->owner;
    if (!dem_given(given, BODY_POSITION))
        return dem_scene_refuse(r, v, "add it", "\"position\" is missing");
    if (dem_given(given, BODY_SIZE) && dem_given(given, BODY_SCALE))
        return dem_scene_refuse(r, v, "give one of them", "has both \"size\" and \"scale\"");
    if (dem_given(given, BODY_SIZE))
        text->body.scale = text->size / dem_shape_diameter(&r->scene->shapes[text->body.shape]);
    if (!(text->body.scale > 0 && text->body.scale <= 1e100))
        return dem_scene_refuse(r, v, "check the unit of \"size\"", "is too far from the size of its shape");
    if (!dem_grow(&o->bodies, &o->body_capacity, o->body_count, sizeof *o->bodies))
        return dem_fail_memory(r->error);
    o->bodies[o->body_count] = text->body;
    DEM_TRY(check_hold(r, v, text->fixed, text->body.velocity, text->body.spin, text->body.hold));
    return add_entry(r, (dem_scene_entry){DEM_ENTRY_BODY, NULL, o->body_count++, 1, 0, NULL});
}

static dem_status add_fill(dem_scene_reader *r, const dem_scene_value *v, const entry_text *text)
{
    dem_fill_def *fill = &r->owner->fills[r->owner->fill_count - 1];
    fill->hold = text->body.hold;
    fill->group = text->body.group;
    DEM_TRY(check_hold(r, v, text->fixed, fill->velocity, v3(0, 0, 0), fill->hold));
    return add_entry(r, (dem_scene_entry){DEM_ENTRY_FILL, NULL, r->owner->fill_count - 1, 1, 0, NULL});
}

static dem_status read_entry(dem_scene_reader *r, const dem_scene_value *v, const dem_field *field)
{
    entry_text text = {.body = {.scale = 1, .orientation = {1, 0, 0, 0}}};
    uint64_t given;
    DEM_TRY(dem_fields_read(r, v, field->fields, &text, &given));
    bool file = dem_given(given, BODY_FILE), fill = dem_given(given, BODY_FILL);
    uint64_t options = 1ull << BODY_FIXED | 1ull << BODY_LOCK | 1ull << BODY_PRESCRIBED | 1ull << BODY_GROUP, others = given & ~options;
    text.fixed = (text.body.hold & (DEM_HOLD_VELOCITY | DEM_HOLD_SPIN)) && !dem_given(given, BODY_PRESCRIBED);
    if ((file || fill) && (others & (others - 1)))
        return dem_scene_refuse(r, v, "make two entries of it",
                                "\"%s\" stands alone, or with \"fixed\", \"lock\", \"prescribed\", \"group\"",
                                file ? "file" : "fill");
    if (!file && !fill && !dem_given(given, BODY_SHAPE))
        return dem_scene_refuse(r, v, "give one of them", "needs \"shape\", \"file\" or \"fill\"");
    if (fill)
        return add_fill(r, v, &text);
    return file ? add_file(r, v, text.file, text.fixed, text.body.hold, text.body.group) : add_body(r, v, given, &text);
}

dem_status dem_section_bodies(dem_scene_reader *r, const dem_scene_value *v, const dem_field *field, void *into)
{
    (void)into;
    if (!dem_json_is_array(v->json))
        return dem_scene_refuse(r, v, "write [ { ... }, ... ]", "needs a list of bodies, files and fills");
    for (size_t i = 0; i < dem_json_length(v->json); i++) {
        dem_scene_value item = dem_scene_item(v, i);
        DEM_TRY(read_entry(r, &item, field));
    }
    const struct dem_scene_owner *o = r->owner;
    r->scene->bodies = (dem_bodies_def){o->bodies, o->body_count, o->fills, o->fill_count};
    return DEM_OK;
}
