#include "out/field.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/nearest.h"
#include "math/vec.h"
#include "out/vtp_read.h"

typedef enum builtin { SIZE, SPEED, SPIN, COORDINATION, HEIGHT, MASS, X, Y, Z, BUILTINS } builtin;

static const struct {
    const char *name, *unit;
} builtins[BUILTINS] = {
    [SIZE] = {"size", "m"},     [SPEED] = {"speed", "m/s"},
    [SPIN] = {"spin", "rad/s"}, [COORDINATION] = {"coordination", ""},
    [HEIGHT] = {"height", "m"}, [MASS] = {"mass", "kg"},
    [X] = {"x", "m"},           [Y] = {"y", "m"},
    [Z] = {"z", "m"},
};

// arrays of our frames
static const struct {
    const char *name, *unit;
} units[] = {{"velocity", "m/s"}, {"angular_velocity", "rad/s"}, {"mass", "kg"}};

static const struct {
    const char *unit;
    dem_dimension dimension;
} dimensions[] = {{"m", DEM_DIMENSION_LENGTH},
                  {"m/s", DEM_DIMENSION_VELOCITY},
                  {"rad/s", DEM_DIMENSION_ANGULAR_VELOCITY},
                  {"kg", DEM_DIMENSION_MASS},
                  {"s", DEM_DIMENSION_TIME}};

dem_dimension dem_field_dimension(const char *unit)
{
    for (size_t i = 0; i < sizeof dimensions / sizeof *dimensions; i++)
        if (strcmp(dimensions[i].unit, unit) == 0)
            return dimensions[i].dimension;
    return DEM_DIMENSION_NONE;
}

const char *dem_field_of_colour(dem_picture_colour colour)
{
    static const builtin of[] = {[DEM_PICTURE_SIZE] = SIZE,
                                 [DEM_PICTURE_SPEED] = SPEED,
                                 [DEM_PICTURE_SPIN] = SPIN,
                                 [DEM_PICTURE_COORDINATION] = COORDINATION,
                                 [DEM_PICTURE_HEIGHT] = HEIGHT};
    return colour >= DEM_PICTURE_SIZE && colour <= DEM_PICTURE_HEIGHT ? builtins[of[colour]].name : NULL;
}

void dem_field_range(const double *values, const unsigned char *hidden, size_t count, double *low, double *high)
{
    *low = INFINITY;
    *high = -INFINITY;
    for (size_t i = 0; i < count; i++)
        if (isfinite(values[i]) && !(hidden && hidden[i])) {
            *low = fmin(*low, values[i]);
            *high = fmax(*high, values[i]);
        }
}

// ---- what is always known

static bool is_there(const dem_body_view *b, builtin which)
{
    switch (which) {
    case SIZE:
        return b->scale && b->shape;
    case SPEED:
        return b->velocity;
    case SPIN:
        return b->spin;
    case COORDINATION:
        return b->coordination;
    case MASS:
        return b->mass;
    default:
        return b->position;
    }
}

static double value_of(const dem_field_source *s, builtin which, size_t i)
{
    const dem_body_view *b = s->bodies;
    switch (which) {
    case SIZE:
        return b->scale[i] * s->diameters[b->shape[i]];
    case SPEED:
        return v3_norm(b->velocity[i]);
    case SPIN:
        return v3_norm(b->spin[i]);
    case COORDINATION:
        return b->coordination[i];
    case HEIGHT:
        return v3_dot(b->position[i], s->up);
    case MASS:
        return b->mass[i];
    default:
        return v3_get(b->position[i], (int)which - X);
    }
}

static dem_status make_builtin(builtin which, const dem_field_source *s, dem_field *f, dem_error *error)
{
    size_t count = s->bodies->count;
    if (count && !is_there(s->bodies, which))
        return dem_fail(error, DEM_BAD_INPUT, "nothing tells the %s of these bodies; take a frame of the run",
                        builtins[which].name);
    snprintf(f->title, sizeof f->title, "%s", builtins[which].name);
    f->unit = builtins[which].unit;
    f->whole = which == COORDINATION;
    for (size_t i = 0; i < count; i++)
        f->values[i] = value_of(s, which, i);
    return DEM_OK;
}

// ---- arrays of a frame

// the component behind a colon: a number, or x, y, z (of four: w, x, y, z); -1: the length of all; -2: there is none
static int component_of(const dem_vtp_array *a, const char *text)
{
    static const char *const letters[] = {[3] = "xyz", [4] = "wxyz"};
    if (!*text)
        return a->width > 1 ? -1 : 0;
    long number;
    const char *rest = dem_parse_long(text + 1, text + strlen(text), &number);
    if (rest && !*rest)
        return number >= 0 && number < a->width ? (int)number : -2;
    const char *all = a->width == 3 || a->width == 4 ? letters[a->width] : "";
    const char *at = text[1] && !text[2] ? strchr(all, text[1]) : NULL;
    return at ? (int)(at - all) : -2;
}

static dem_status make_array(const dem_vtp_array *a, const char *component, size_t count, dem_field *f,
                             dem_error *error)
{
    int k = component_of(a, component);
    if (k < -1)
        return dem_fail(error, DEM_USAGE, "'%.60s' has %d component%s, '%.20s' is none of them; write %.60s:0", a->name,
                        a->width, a->width == 1 ? "" : "s", component, a->name);
    snprintf(f->title, sizeof f->title, "%.60s%s%.20s", a->name, *component ? " " : "",
             *component ? component + 1 : "");
    f->unit = "";
    for (size_t i = 0; i < sizeof units / sizeof *units; i++)
        if (strcmp(units[i].name, a->name) == 0)
            f->unit = units[i].unit;
    f->whole = a->type != DEM_VTP_FLOAT64 && a->type != DEM_VTP_FLOAT32;
    for (size_t i = 0; i < count; i++) {
        double sum = 0;
        for (int c = 0; k < 0 && c < a->width; c++)
            sum = hypot(sum, dem_vtp_value(a, i, c));
        f->values[i] = k < 0 ? sum : dem_vtp_value(a, i, k);
    }
    return DEM_OK;
}

// ---- by name

static const char *known_name(const void *user, size_t index)
{
    const dem_field_source *s = user;
    size_t arrays = s->frame ? s->frame->point_array_count : 0;
    return index < BUILTINS            ? builtins[index].name
           : index < BUILTINS + arrays ? s->frame->point_arrays[index - BUILTINS].name
                                       : NULL;
}

static dem_status refuse(const char *name, const dem_field_source *s, dem_error *error)
{
    char known[400] = "";
    const char *near = dem_nearest(name, known_name, s), *one;
    if (near)
        return dem_fail(error, DEM_USAGE, "'%.60s' is no number of these bodies; did you mean %s?", name, near);
    for (size_t i = 0; (one = known_name(s, i)); i++)
        if (strlen(known) + strlen(one) + 3 < sizeof known)
            snprintf(known + strlen(known), sizeof known - strlen(known), " %s", one);
    return dem_fail(error, DEM_USAGE, "'%.60s' is no number of these bodies; take one of:%s", name, known);
}

static dem_status find(const char *name, const dem_field_source *s, dem_field *f, dem_error *error)
{
    size_t length = strcspn(name, ":");
    for (size_t i = 0; i < BUILTINS; i++)
        if (strcmp(builtins[i].name, name) == 0)
            return make_builtin((builtin)i, s, f, error);
    for (size_t i = 0; s->frame && i < s->frame->point_array_count; i++) {
        const dem_vtp_array *a = &s->frame->point_arrays[i];
        if (strlen(a->name) == length && strncmp(a->name, name, length) == 0)
            return make_array(a, name + length, s->bodies->count, f, error);
    }
    return refuse(name, s, error);
}

dem_status dem_field_make(const char *name, const dem_field_source *s, dem_field *f, dem_error *error)
{
    *f = (dem_field){.unit = "", .values = dem_alloc(s->bodies->count, sizeof *f->values)};
    if (!f->values)
        return dem_fail_memory(error);
    dem_status status = find(name, s, f, error);
    if (status != DEM_OK) {
        free(f->values);
        f->values = NULL;
    }
    return status;
}
