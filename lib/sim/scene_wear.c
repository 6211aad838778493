// "wear" of a wall.
#include "sim/scene_wall.h"

static const dem_choice laws[] = {{"finnie", DEM_WEAR_FINNIE}, {"archard", DEM_WEAR_ARCHARD}, {NULL, 0}};

#define WEAR(member) offsetof(wall_text, wall.wear.member)
enum { LAW, PRESSURE, CONSTANT, PSI, ROUGHNESS, COEFFICIENT, HARDNESS };
static const dem_field wear_table[] = {
    [LAW] = {"law", dem_field_choice, .at = WEAR(law), .needed = true, .choices = laws},
    [PRESSURE] = {"pressure", dem_field_quantity, .at = WEAR(pressure), .dimension = DEM_DIMENSION_PRESSURE,
                  .range = DEM_RANGE_POSITIVE},
    [CONSTANT] = {"constant", dem_field_quantity, .at = WEAR(constant), .dimension = DEM_DIMENSION_NONE,
                  .range = DEM_RANGE_POSITIVE},
    [PSI] = {"psi", dem_field_quantity, .at = WEAR(psi), .dimension = DEM_DIMENSION_NONE, .range = DEM_RANGE_POSITIVE},
    [ROUGHNESS] = {"roughness", dem_field_quantity, .at = WEAR(roughness), .dimension = DEM_DIMENSION_NONE,
                   .range = {.high = 1, .above = true}},
    [COEFFICIENT] = {"coefficient", dem_field_quantity, .at = WEAR(coefficient), .dimension = DEM_DIMENSION_NONE,
                     .range = DEM_RANGE_POSITIVE},
    [HARDNESS] = {"hardness", dem_field_quantity, .at = WEAR(hardness), .dimension = DEM_DIMENSION_PRESSURE,
                  .range = DEM_RANGE_POSITIVE},
};
const dem_fields dem_wall_wear_fields = DEM_FIELDS(wear_table);

dem_status dem_wall_read_wear(dem_scene_reader *r, const dem_scene_value *v, const dem_field *field, void *into)
{
    wall_text *text = into;
    uint64_t given;
    text->wall.wear = (dem_wear_def){.constant = 2, .psi = 2, .roughness = 0.5};
    DEM_TRY(dem_fields_read(r, v, field->fields, text, &given));
    const uint64_t of_archard = 1u << COEFFICIENT | 1u << HARDNESS,
                   of_finnie = 1u << PRESSURE | 1u << CONSTANT | 1u << PSI | 1u << ROUGHNESS;
    bool finnie = text->wall.wear.law == DEM_WEAR_FINNIE;
    if (given & (finnie ? of_archard : of_finnie))
        return dem_scene_refuse(r, v,
                                finnie ? "take pressure, constant, psi and roughness" : "take coefficient and hardness",
                                "has keys of the other law");
    if (finnie && !dem_given(given, PRESSURE))
        return dem_scene_refuse(r, v, "add the pressure at which the wall flows", "\"pressure\" is missing");
    if (!finnie && (given & of_archard) != of_archard)
        return dem_scene_refuse(r, v, "add them", "needs \"coefficient\" and \"hardness\"");
    return DEM_OK;
}
