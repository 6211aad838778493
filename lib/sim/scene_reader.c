#include "sim/scene_reader.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "base/nearest.h"

enum { PATH_BYTES = 200, TEXT_BYTES = 700 };

dem_scene_value dem_scene_member(const dem_scene_value *object, const char *key)
{
    return (dem_scene_value){{&object->place, key, 0}, dem_json_member(object->json, key)};
}

dem_scene_value dem_scene_item(const dem_scene_value *array, size_t index)
{
    return (dem_scene_value){{&array->place, NULL, index}, dem_json_item(array->json, index)};
}

// ---- errors

// contacts[0].normal.law
static void print_path(const dem_json_place *place, char path[static PATH_BYTES])
{
    *path = 0;
    if (!place->in)
        return;
    print_path(place->in, path);
    size_t used = strlen(path);
    if (place->key)
        snprintf(path + used, PATH_BYTES - used, "%s%s", used ? "." : "", place->key);
    else
        snprintf(path + used, PATH_BYTES - used, "[%zu]", place->index);
}

static size_t depth_of(const dem_json_place *place)
{
    size_t depth = 0;
    for (; place->in; place = place->in)
        depth++;
    return depth;
}

static bool same_place(const dem_json_place *a, const dem_json_place *b)
{
    for (; a->in && b->in; a = a->in, b = b->in) {
        if (!a->key != !b->key || (a->key ? strcmp(a->key, b->key) != 0 : a->index != b->index))
            return false;
    }
    return !a->in && !b->in;
}

// true: `inner` is the place `outer` or inside of it
static bool is_within(const dem_json_place *inner, const dem_json_place *outer)
{
    for (size_t spare = depth_of(inner), depth = depth_of(outer); spare > depth; spare--)
        inner = inner->in;
    return same_place(inner, outer);
}

static const dem_scene_override *override_of(const dem_scene_reader *r, const dem_json_place *place, bool around)
{
    for (size_t i = r->override_count; i-- > 0;) {
        const dem_json_place *other = r->overrides[i].place;
        if (around ? is_within(place, other) : is_within(other, place))
            return &r->overrides[i];
    }
    return NULL;
}

static dem_status refuse_override(const dem_scene_reader *r, const dem_scene_override *o, const char *what,
                                  const char *advice)
{
    char file[sizeof r->error->file];
    snprintf(file, sizeof file, "-D %s", o->path);
    return dem_fail_at(r->error, DEM_BAD_INPUT, file, 0, "%s; %s", what, advice);
}

// the value may be of an override, stand in the text, or have come with an override of something inside of it
static dem_status fail_at_place(const dem_scene_reader *r, const dem_json_place *place, dem_json_part part,
                                const char *what, const char *advice)
{
    const dem_scene_override *override = override_of(r, place, true);
    if (override)
        return refuse_override(r, override, what, advice);
    long line = 0, column = 0;
    if (dem_json_locate(r->text, r->size, place, part, &line, &column))
        return dem_fail_at(r->error, DEM_BAD_INPUT, r->name, line, "%s (column %ld); %s", what, column, advice);
    override = override_of(r, place, false);
    if (override)
        return refuse_override(r, override, what, advice);
    return dem_fail_at(r->error, DEM_BAD_INPUT, r->name, 0, "%s; %s", what, advice);
}

dem_status dem_scene_refuse(const dem_scene_reader *r, const dem_scene_value *v, const char *advice, const char *format,
                            ...)
{
    char what[TEXT_BYTES], path[PATH_BYTES];
    print_path(&v->place, path);
    int used = snprintf(what, sizeof what, "%s%s", path, *path ? ": " : "");
    va_list args;
    va_start(args, format);
    vsnprintf(what + used, sizeof what - (size_t)used, format, args);
    va_end(args);
    return fail_at_place(r, &v->place, DEM_JSON_VALUE, what, advice);
}

dem_status dem_scene_pass_on(const dem_scene_reader *r, const dem_scene_value *v, const dem_error *inner)
{
    if (inner->code == DEM_NO_MEMORY)
        return dem_fail_memory(r->error);
    const char *advice = strchr(inner->text, ';');
    int length = advice ? (int)(advice - inner->text) : (int)strlen(inner->text);
    advice = advice ? advice + 1 + strspn(advice + 1, " ") : "correct it";
    return dem_scene_refuse(r, v, advice, "%.*s", length, inner->text);
}

// "a, b, c"
static void list_names(const char *(*next)(const void *user, size_t index), const void *user, char *list, size_t size)
{
    const char *name;
    *list = 0;
    for (size_t i = 0; (name = next(user, i)); i++) {
        size_t used = strlen(list);
        snprintf(list + used, size - used, "%s%s", i ? ", " : "", name);
    }
}

dem_status dem_scene_unknown(const dem_scene_reader *r, const dem_scene_value *v, dem_json_part part, const char *what,
                             const char *name, const char *(*next)(const void *user, size_t index), const void *user)
{
    char text[TEXT_BYTES], advice[TEXT_BYTES], names[300];
    snprintf(text, sizeof text, "unknown %s \"%.200s\"", what, name);
    const char *near = dem_nearest(name, next, user);
    list_names(next, user, names, sizeof names);
    if (near)
        snprintf(advice, sizeof advice, "did you mean \"%s\"?", near);
    else if (*names)
        snprintf(advice, sizeof advice, "use one of: %s", names);
    else
        snprintf(advice, sizeof advice, "there is no %s yet", what);
    return fail_at_place(r, &v->place, part, text, advice);
}

// ---- objects by their tables

static const char *field_name(const void *user, size_t index)
{
    const dem_fields *fields = user;
    for (size_t i = 0; i < fields->count; i++)
        if (fields->items[i].read != dem_field_not_built && index-- == 0)
            return fields->items[i].name;
    return NULL;
}

static bool is_field(const dem_fields *fields, const char *key)
{
    for (size_t i = 0; i < fields->count; i++)
        if (strcmp(fields->items[i].name, key) == 0)
            return true;
    return false;
}

dem_status dem_fields_read(dem_scene_reader *r, const dem_scene_value *v, const dem_fields *fields, void *into,
                           uint64_t *given)
{
    if (given)
        *given = 0;
    if (!dem_json_is_object(v->json))
        return dem_scene_refuse(r, v, "write { ... }", "needs an object");
    for (const char *key = NULL; (key = dem_json_next(v->json, key));)
        if (!is_field(fields, key)) {
            dem_scene_value unknown = dem_scene_member(v, key);
            return dem_scene_unknown(r, &unknown, DEM_JSON_KEY, "key", key, field_name, fields);
        }
    for (size_t i = 0; i < fields->count; i++) {
        const dem_field *field = &fields->items[i];
        dem_scene_value member = dem_scene_member(v, field->name);
        if (!member.json && field->needed)
            return dem_scene_refuse(r, v, "add it", "\"%s\" is missing", field->name);
        if (!member.json)
            continue;
        if (given)
            *given |= (uint64_t)1 << i;
        DEM_TRY(field->read(r, &member, field, (char *)into + field->at));
    }
    return DEM_OK;
}

// ---- what lives as long as the scene

void *dem_scene_take(dem_scene_reader *r, size_t count, size_t size)
{
    return dem_arena_take(&r->owner->arena, count ? count : 1, size);
}

const char *dem_scene_path(dem_scene_reader *r, const char *path)
{
    if (*path == '/' || !r->folder)
        return path;
    size_t size = strlen(r->folder) + strlen(path) + 2;
    char *joined = dem_scene_take(r, size, 1);
    if (joined)
        snprintf(joined, size, "%s/%s", r->folder, path);
    return joined;
}
