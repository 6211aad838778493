// "fill": bodies to be placed at random, and the laws of their sizes.
#include "math/vec.h"
#include "sim/scene_reader.h"

// ---- sizes

typedef struct size_text {
    dem_size_def size;
    double value, low, high, mean, median, sigma;
    double *sizes, *passing;
    size_t size_count, passing_count;
} size_text;

static dem_status read_numbers(dem_scene_reader *r, const dem_scene_value *v, const dem_field *field, double **numbers,
                               size_t *count)
{
    *count = dem_json_length(v->json);
    if (*count < 2)
        return dem_scene_refuse(r, v, "give at least two", "needs a list of numbers");
    *numbers = dem_scene_take(r, *count, sizeof **numbers);
    if (!*numbers)
        return dem_fail_memory(r->error);
    for (size_t i = 0; i < *count; i++) {
        dem_scene_value item = dem_scene_item(v, i);
        DEM_TRY(dem_read_quantity(r, &item, field->dimension, field->range, &(*numbers)[i]));
    }
    return DEM_OK;
}

static dem_status read_sizes(dem_scene_reader *r, const dem_scene_value *v, const dem_field *field, void *into)
{
    size_text *text = into;
    DEM_TRY(read_numbers(r, v, field, &text->sizes, &text->size_count));
    for (size_t i = 1; i < text->size_count; i++)
        if (!(text->sizes[i] > text->sizes[i - 1])) {
            dem_scene_value item = dem_scene_item(v, i);
            return dem_scene_refuse(r, &item, "order the sizes from small to large", "must be above the one before");
        }
    return DEM_OK;
}

static dem_status read_passing(dem_scene_reader *r, const dem_scene_value *v, const dem_field *field, void *into)
{
    size_text *text = into;
    DEM_TRY(read_numbers(r, v, field, &text->passing, &text->passing_count));
    for (size_t i = 1; i < text->passing_count; i++)
        if (text->passing[i] < text->passing[i - 1]) {
            dem_scene_value item = dem_scene_item(v, i);
            return dem_scene_refuse(r, &item, "give what is smaller than each size", "must not fall");
        }
    if (text->passing[0] != 0 || text->passing[text->passing_count - 1] != 1)
        return dem_scene_refuse(r, v, "add the sizes that nothing and everything passes",
                                "must begin with 0 and end with 1");
    return DEM_OK;
}

static const dem_choice size_laws[] = {{"fixed", DEM_SIZE_FIXED},   {"uniform", DEM_SIZE_UNIFORM},
                                       {"normal", DEM_SIZE_NORMAL}, {"lognormal", DEM_SIZE_LOGNORMAL},
                                       {"table", DEM_SIZE_TABLE},   {NULL, 0}};
const dem_choice dem_shares_by[] = {{"number", false}, {"mass", true}, {NULL, 0}};

dem_status dem_field_share_by(dem_scene_reader *r, const dem_scene_value *v, const dem_field *field, void *into)
{
    int by;
    DEM_TRY(dem_field_choice(r, v, field, &by));
    *(bool *)into = by;
    return DEM_OK;
}

enum { KEY_LAW, KEY_VALUE, KEY_MIN, KEY_MAX, KEY_MEAN, KEY_MEDIAN, KEY_SIGMA, KEY_SIZES, KEY_PASSING, KEY_BY };
#define LENGTH_FIELD(name, member)                                                                                     \
    {                                                                                                                  \
        name, dem_field_quantity, offsetof(size_text, member), .dimension = DEM_DIMENSION_LENGTH,                      \
                                                               .range = DEM_RANGE_POSITIVE                             \
    }
static dem_field_reader read_sigma;
static const dem_field size_table[] = {
    [KEY_LAW] = {"law", dem_field_choice, .at = offsetof(size_text, size.law), .needed = true, .choices = size_laws},
    [KEY_VALUE] = LENGTH_FIELD("value", value),
    [KEY_MIN] = LENGTH_FIELD("min", low),
    [KEY_MAX] = LENGTH_FIELD("max", high),
    [KEY_MEAN] = LENGTH_FIELD("mean", mean),
    [KEY_MEDIAN] = LENGTH_FIELD("median", median),
    [KEY_SIGMA] = {"sigma", read_sigma, .range = DEM_RANGE_FROM_0},
    [KEY_SIZES] = {"sizes", read_sizes, .dimension = DEM_DIMENSION_LENGTH, .range = DEM_RANGE_POSITIVE},
    [KEY_PASSING] = {"passing", read_passing, .dimension = DEM_DIMENSION_NONE, .range = {.high = 1}},
    [KEY_BY] = {"by", dem_field_share_by, .at = offsetof(size_text, size.by_mass), .choices = dem_shares_by},
};
static const dem_fields size_fields = DEM_FIELDS(size_table);

// a length with the law normal; with lognormal it is of the logarithm
static dem_status read_sigma(dem_scene_reader *r, const dem_scene_value *v, const dem_field *field, void *into)
{
    size_text *text = into;
    dem_dimension dimension = text->size.law == DEM_SIZE_LOGNORMAL ? DEM_DIMENSION_NONE : DEM_DIMENSION_LENGTH;
    return dem_read_quantity(r, v, dimension, field->range, &text->sigma);
}

#define BIT(field) (1u << (field))
static const struct {
    uint64_t needed, allowed;
} size_keys[] = {
    [DEM_SIZE_FIXED] = {BIT(KEY_VALUE), 0},
    [DEM_SIZE_UNIFORM] = {BIT(KEY_MIN) | BIT(KEY_MAX), 0},
    [DEM_SIZE_NORMAL] = {BIT(KEY_MEAN) | BIT(KEY_SIGMA), BIT(KEY_MIN) | BIT(KEY_MAX)},
    [DEM_SIZE_LOGNORMAL] = {BIT(KEY_MEDIAN) | BIT(KEY_SIGMA), BIT(KEY_MIN) | BIT(KEY_MAX)},
    [DEM_SIZE_TABLE] = {BIT(KEY_SIZES) | BIT(KEY_PASSING), 0},
};

static dem_status check_size_keys(dem_scene_reader *r, const dem_scene_value *v, dem_size_law law, uint64_t given)
{
    uint64_t needed = size_keys[law].needed, allowed = needed | size_keys[law].allowed | BIT(KEY_LAW) | BIT(KEY_BY);
    const char *name = size_laws[law - DEM_SIZE_FIXED].name;
    for (size_t i = 0; i < size_fields.count; i++) {
        if (needed & BIT(i) & ~given)
            return dem_scene_refuse(r, v, "add it", "the law %s needs \"%s\"", name, size_table[i].name);
        if (given & BIT(i) & ~allowed)
            return dem_scene_refuse(r, v, "leave it out", "the law %s has no \"%s\"", name, size_table[i].name);
    }
    return DEM_OK;
}

static dem_status fill_in_size(dem_scene_reader *r, const dem_scene_value *v, size_text *text, uint64_t given)
{
    dem_size_def *size = &text->size;
    bool bounds = dem_given(given, KEY_MIN) && dem_given(given, KEY_MAX);
    if (bounds && !(text->low < text->high))
        return dem_scene_refuse(r, v, "exchange or correct them", "min must be below max");
    if (size->law == DEM_SIZE_TABLE && text->size_count != text->passing_count)
        return dem_scene_refuse(r, v, "give one passing for each size", "has %zu sizes and %zu passing",
                                text->size_count, text->passing_count);
    if (size->law == DEM_SIZE_FIXED)
        size->a = text->value;
    else if (size->law == DEM_SIZE_UNIFORM) {
        size->a = text->low;
        size->b = text->high;
    } else if (size->law == DEM_SIZE_TABLE) {
        size->sizes = text->sizes;
        size->passing = text->passing;
        size->table_count = text->size_count;
    } else {
        size->a = size->law == DEM_SIZE_NORMAL ? text->mean : text->median;
        size->b = text->sigma;
        if (dem_given(given, KEY_MIN))
            size->smallest = text->low;
        if (dem_given(given, KEY_MAX))
            size->largest = text->high;
    }
    return DEM_OK;
}

// a bare length is a fixed size
static dem_status read_size(dem_scene_reader *r, const dem_scene_value *v, const dem_field *field, void *into)
{
    dem_size_def *size = into;
    size_text text = {.size = *size};
    uint64_t given;
    if (!dem_json_is_object(v->json)) {
        size->law = DEM_SIZE_FIXED;
        return dem_read_quantity(r, v, DEM_DIMENSION_LENGTH, (dem_range)DEM_RANGE_POSITIVE, &size->a);
    }
    DEM_TRY(dem_fields_read(r, v, field->fields, &text, &given));
    DEM_TRY(check_size_keys(r, v, text.size.law, given));
    DEM_TRY(fill_in_size(r, v, &text, given));
    *size = text.size;
    return DEM_OK;
}

// ---- the mix

static const dem_field mix_table[] = {
    {"shape", dem_field_shape, .at = offsetof(dem_mix_def, shape), .needed = true},
    {"share", dem_field_quantity, .at = offsetof(dem_mix_def, share), .dimension = DEM_DIMENSION_NONE,
     .range = DEM_RANGE_POSITIVE},
    {"size", read_size, .at = offsetof(dem_mix_def, size), .fields = &size_fields},
};
const dem_fields dem_mix_fields = DEM_FIELDS(mix_table);

dem_status dem_field_mix(dem_scene_reader *r, const dem_scene_value *v, const dem_field *field, void *into)
{
    dem_fill_def *fill = into;
    size_t count = dem_json_length(v->json);
    if (!count)
        return dem_scene_refuse(r, v, "write [ { \"shape\": \"NAME\" }, ... ]", "needs a list of shapes");
    dem_mix_def *mix = dem_scene_take(r, count, sizeof *mix);
    if (!mix)
        return dem_fail_memory(r->error);
    for (size_t i = 0; i < count; i++) {
        dem_scene_value item = dem_scene_item(v, i);
        mix[i] = (dem_mix_def){.share = 1, .size = {.largest = INFINITY}};
        DEM_TRY(dem_fields_read(r, &item, field->fields, &mix[i], NULL));
    }
    fill->mix = mix;
    fill->mix_count = count;
    return DEM_OK;
}

// ---- the fill

dem_status dem_field_corners(dem_scene_reader *r, const dem_scene_value *v, const dem_field *field, void *into)
{
    dem_fill_def *fill = into;
    DEM_TRY(dem_read_array(r, v, 2, "the corners [[x, y, z], [x, y, z]]"));
    dem_scene_value low = dem_scene_item(v, 0), high = dem_scene_item(v, 1);
    DEM_TRY(dem_field_vector(r, &low, field, &fill->low));
    DEM_TRY(dem_field_vector(r, &high, field, &fill->high));
    for (int i = 0; i < 3; i++)
        if (!(v3_get(fill->low, i) < v3_get(fill->high, i)))
            return dem_scene_refuse(r, v, "exchange or correct them",
                                    "the first corner must be below the second along %c", "xyz"[i]);
    return DEM_OK;
}

enum { FILL_MIX, FILL_SHARE_BY, FILL_BOX, FILL_COUNT, FILL_VOID_RATIO };
static const dem_field fill_table[] = {
    [FILL_MIX] = {"mix", dem_field_mix, .needed = true, .fields = &dem_mix_fields},
    [FILL_SHARE_BY] = {"share_by", dem_field_share_by, .at = offsetof(dem_fill_def, share_by_mass), .choices = dem_shares_by},
    [FILL_BOX] = {"box", dem_field_corners, .needed = true, .dimension = DEM_DIMENSION_LENGTH},
    [FILL_COUNT] = {"count", dem_field_whole, .at = offsetof(dem_fill_def, count), .range = {.low = 1, .high = 4e9}},
    [FILL_VOID_RATIO] = {"void_ratio", dem_field_quantity, .at = offsetof(dem_fill_def, void_ratio),
                         .dimension = DEM_DIMENSION_NONE, .range = DEM_RANGE_POSITIVE},
    {"seed", dem_field_whole, .at = offsetof(dem_fill_def, seed)},
    {"gap", dem_field_quantity, .at = offsetof(dem_fill_def, gap), .dimension = DEM_DIMENSION_LENGTH,
     .range = DEM_RANGE_FROM_0},
    {"velocity", dem_field_vector, .at = offsetof(dem_fill_def, velocity), .dimension = DEM_DIMENSION_VELOCITY},
};
const dem_fields dem_fill_fields = DEM_FIELDS(fill_table);
_Static_assert(sizeof(size_t) == sizeof(uint64_t), "count is read as a whole number of 64 bits");

dem_status dem_section_fill(dem_scene_reader *r, const dem_scene_value *v, const dem_field *field, void *into)
{
    (void)into;
    struct dem_scene_owner *o = r->owner;
    dem_fill_def fill = {.seed = 1};
    uint64_t given;
    DEM_TRY(dem_fields_read(r, v, field->fields, &fill, &given));
    bool count = dem_given(given, FILL_COUNT);
    if (count == dem_given(given, FILL_VOID_RATIO))
        return dem_scene_refuse(r, v, "give one of them", "%s \"count\" %s \"void_ratio\"",
                                count ? "has both" : "needs", count ? "and" : "or");
    if (!dem_grow(&o->fills, &o->fill_capacity, o->fill_count, sizeof *o->fills))
        return dem_fail_memory(r->error);
    o->fills[o->fill_count++] = fill;
    return DEM_OK;
}
