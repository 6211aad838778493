// "measures": regions by name.
#include <string.h>

#include "math/vec.h"
#include "sim/region.h"
#include "sim/scene_reader.h"

// as a fill's, [[x, y, z], [x, y, z]], or as a wall's, { "min": ..., "max": ... }
static const dem_field corner_table[] = {
    {"min", dem_field_vector, .at = offsetof(dem_measure_def, low), true, DEM_DIMENSION_LENGTH},
    {"max", dem_field_vector, .at = offsetof(dem_measure_def, high), true, DEM_DIMENSION_LENGTH},
};
static const dem_fields corner_fields = DEM_FIELDS(corner_table);

static dem_status read_box(dem_scene_reader *r, const dem_scene_value *v, const dem_field *field, void *into)
{
    dem_measure_def *measure = into;
    measure->region = DEM_REGION_BOX;
    if (dem_json_is_object(v->json))
        return dem_fields_read(r, v, field->fields, measure, NULL);
    DEM_TRY(dem_read_array(r, v, 2, "the corners [[x, y, z], [x, y, z]]"));
    dem_scene_value low = dem_scene_item(v, 0), high = dem_scene_item(v, 1);
    DEM_TRY(dem_field_vector(r, &low, field, &measure->low));
    return dem_field_vector(r, &high, field, &measure->high);
}

static const dem_field ball_table[] = {
    {"centre", dem_field_vector, .at = offsetof(dem_measure_def, centre), true, DEM_DIMENSION_LENGTH},
    {"radius", dem_field_quantity, .at = offsetof(dem_measure_def, radius), true, DEM_DIMENSION_LENGTH,
     DEM_RANGE_POSITIVE},
};
static const dem_fields ball_fields = DEM_FIELDS(ball_table);

static dem_status read_ball(dem_scene_reader *r, const dem_scene_value *v, const dem_field *field, void *into)
{
    dem_measure_def *measure = into;
    measure->region = DEM_REGION_BALL;
    return dem_fields_read(r, v, field->fields, measure, NULL);
}

static dem_status read_whole(dem_scene_reader *r, const dem_scene_value *v, const dem_field *field, void *into)
{
    (void)into;
    bool whole;
    DEM_TRY(dem_field_flag(r, v, field, &whole));
    return whole ? DEM_OK : dem_scene_refuse(r, v, "write true, or give a box or ball", "is not a region");
}

enum { MEASURE_BOX, MEASURE_BALL, MEASURE_WHOLE };
static const dem_field measure_table[] = {
    [MEASURE_BOX] = {"box", read_box, .dimension = DEM_DIMENSION_LENGTH, .fields = &corner_fields},
    [MEASURE_BALL] = {"ball", read_ball, .fields = &ball_fields},
    [MEASURE_WHOLE] = {.name = "whole", .read = read_whole},
    {"kinetic", dem_field_flag, .at = offsetof(dem_measure_def, kinetic)},
};
const dem_fields dem_measure_fields = DEM_FIELDS(measure_table);

static dem_status read_measure(dem_scene_reader *r, const dem_scene_value *v, const dem_field *field, const char *name,
                               dem_measure_def *measure)
{
    uint64_t given;
    *measure = (dem_measure_def){.name = name, .region = DEM_REGION_WHOLE};
    DEM_TRY(dem_fields_read(r, v, field->fields, measure, &given));
    int regions = dem_given(given, MEASURE_BOX) + dem_given(given, MEASURE_BALL) + dem_given(given, MEASURE_WHOLE);
    if (regions != 1)
        return dem_scene_refuse(r, v, "give exactly one", "%s \"box\", \"ball\" and \"whole\"",
                                regions ? "has more than one of" : "needs one of");
    return DEM_OK;
}

dem_status dem_section_measures(dem_scene_reader *r, const dem_scene_value *v, const dem_field *field, void *into)
{
    (void)into;
    size_t count = 0;
    if (!dem_json_is_object(v->json))
        return dem_scene_refuse(r, v, "write { \"NAME\": { ... }, ... }", "needs an object of regions by name");
    for (const char *name = NULL; (name = dem_json_next(v->json, name));)
        count++;
    dem_measure_def *measures = dem_scene_take(r, count, sizeof *measures);
    if (!measures)
        return dem_fail_memory(r->error);
    r->scene->measures = measures;
    for (const char *name = NULL; (name = dem_json_next(v->json, name));) {
        dem_scene_value member = dem_scene_member(v, name);
        DEM_TRY(read_measure(r, &member, field, name, &measures[r->scene->measure_count]));
        r->scene->measure_count++;
    }
    return DEM_OK;
}

dem_status dem_scene_check_measures(dem_scene_reader *r, const dem_scene_value *root)
{
    dem_scene_value all = dem_scene_member(root, "measures");
    for (size_t i = 0; i < r->scene->measure_count; i++) {
        const dem_measure_def *m = &r->scene->measures[i];
        const char *fault = dem_measure_fault(r->scene, m), *advice = fault ? strchr(fault, ';') : NULL;
        dem_scene_value member = dem_scene_member(&all, m->name);
        if (fault)
            return dem_scene_refuse(r, &member, advice + 2, "%.*s", (int)(advice - fault), fault);
    }
    return DEM_OK;
}
