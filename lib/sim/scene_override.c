// "path.to.key=value": a value laid over the parsed scene. Steps are keys, or items as .0 or [0].
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "sim/scene_reader.h"

typedef struct step {
    const char *text;
    size_t length;
    bool bracket;  // [0]
    bool last;
} step;

static dem_status refuse(const dem_scene_reader *r, const dem_scene_override *o, const char *what)
{
    return dem_fail(r->error, DEM_USAGE, "-D %s: %s", o->path, what);
}

// the step at *at, which is moved behind it; false: that is no step
static bool next_step(const char **at, step *s)
{
    const char *p = *at;
    s->bracket = *p == '[';
    p += s->bracket;
    s->text = p;
    s->length = strcspn(p, s->bracket ? "]" : ".[");
    p += s->length;
    if (s->bracket && *p++ != ']')
        return false;
    s->last = *p == 0;
    if (*p == '.' && p[1] == 0)
        return false;
    p += *p == '.';
    *at = p;
    return s->length > 0;
}

static bool to_index(const step *s, size_t *index)
{
    long value;
    if (dem_parse_long(s->text, s->text + s->length, &value) != s->text + s->length || value < 0)
        return false;
    *index = (size_t)value;
    return true;
}

static dem_json *value_of(const char *text)
{
    dem_json *value;
    return dem_json_parse(text, strlen(text), NULL, &value, NULL) == DEM_OK ? value : dem_json_new_string(text);
}

static bool put(dem_json *in, const dem_json_place *place, dem_json *value)
{
    return place->key ? dem_json_set_member(in, place->key, value) : dem_json_set_item(in, place->index, value);
}

static const dem_json *get(const dem_json *in, const dem_json_place *place)
{
    return place->key ? dem_json_member(in, place->key) : dem_json_item(in, place->index);
}

// one step into `in`, kept as a place
static dem_status take_step(dem_scene_reader *r, const dem_scene_override *o, const step *s, const dem_json *in,
                            dem_json_place **place)
{
    dem_json_place *next = dem_scene_take(r, 1, sizeof *next);
    char *key = dem_scene_take(r, s->length + 1, 1);
    if (!next || !key)
        return dem_fail_memory(r->error);
    memcpy(key, s->text, s->length);
    key[s->length] = 0;
    *next = (dem_json_place){.in = *place};
    *place = next;
    char what[200];
    if (dem_json_is_array(in)) {
        if (to_index(s, &next->index) && next->index < dem_json_length(in))
            return DEM_OK;
        snprintf(what, sizeof what, "there is no item \"%.60s\" in a list of %zu; count from 0", key,
                 dem_json_length(in));
        return refuse(r, o, what);
    }
    if (dem_json_is_object(in) && !s->bracket) {
        next->key = key;
        return DEM_OK;
    }
    snprintf(what, sizeof what, "\"%.60s\" does not stand in %s; check the path", key,
             s->bracket ? "a list" : "an object");
    return refuse(r, o, what);
}

static dem_status apply(dem_scene_reader *r, dem_scene_override *o, const char *value)
{
    dem_json *in = r->owner->root;
    dem_json_place *place = dem_scene_take(r, 1, sizeof *place);
    if (!place)
        return dem_fail_memory(r->error);
    *place = (dem_json_place){0};
    const char *at = o->path;
    for (step s = {0}; !s.last;) {
        if (!next_step(&at, &s))
            return refuse(r, o, "is no path; write path.to.key=value, items of lists as .0 or [0]");
        DEM_TRY(take_step(r, o, &s, in, &place));
        // what is on the way is made
        if (s.last ? !put(in, place, value_of(value)) : !get(in, place) && !put(in, place, dem_json_new_object()))
            return refuse(r, o, "is not text in UTF-8; correct it");
        in = (dem_json *)get(in, place);
    }
    o->place = place;
    return DEM_OK;
}

dem_status dem_scene_override_all(dem_scene_reader *r, const char *const *overrides)
{
    size_t count = 0;
    while (overrides && overrides[count])
        count++;
    r->overrides = dem_scene_take(r, count, sizeof *r->overrides);
    if (!r->overrides)
        return dem_fail_memory(r->error);
    for (size_t i = 0; i < count; i++) {
        const char *equals = strchr(overrides[i], '=');
        if (!equals || equals == overrides[i])
            return dem_fail(r->error, DEM_USAGE, "-D %s: has no value; write path.to.key=value", overrides[i]);
        size_t length = (size_t)(equals - overrides[i]);
        char *path = dem_scene_take(r, length + 1, 1);
        if (!path)
            return dem_fail_memory(r->error);
        memcpy(path, overrides[i], length);
        path[length] = 0;
        dem_scene_override *o = &r->overrides[i];
        *o = (dem_scene_override){.path = path};
        DEM_TRY(apply(r, o, equals + 1));
        r->override_count++;
    }
    return DEM_OK;
}
