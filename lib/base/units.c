#include "base/units.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/text.h"

typedef struct unit {
    const char *name;
    dem_dimension dimension;
    double si;
} unit;

static const unit units[] = {
    {"m", DEM_DIMENSION_LENGTH, 1},          {"cm", DEM_DIMENSION_LENGTH, 1e-2},
    {"mm", DEM_DIMENSION_LENGTH, 1e-3},      {"um", DEM_DIMENSION_LENGTH, 1e-6},
    {"µm", DEM_DIMENSION_LENGTH, 1e-6},      {"micron", DEM_DIMENSION_LENGTH, 1e-6},
    {"nm", DEM_DIMENSION_LENGTH, 1e-9},      {"km", DEM_DIMENSION_LENGTH, 1e3},
    {"in", DEM_DIMENSION_LENGTH, 0.0254},    {"inch", DEM_DIMENSION_LENGTH, 0.0254},
    {"ft", DEM_DIMENSION_LENGTH, 0.3048},    {"kg/m3", DEM_DIMENSION_DENSITY, 1},
    {"kg/m^3", DEM_DIMENSION_DENSITY, 1},    {"g/cm3", DEM_DIMENSION_DENSITY, 1000},
    {"g/cm^3", DEM_DIMENSION_DENSITY, 1000}, {"t/m3", DEM_DIMENSION_DENSITY, 1000},
    {"t/m^3", DEM_DIMENSION_DENSITY, 1000},
};
enum { UNIT_COUNT = sizeof units / sizeof *units };

static const char *const dimension_names[] = {"length", "density"};

dem_status dem_unit(const char *name, dem_dimension dimension, double *value, dem_error *error)
{
    char known[256] = "";
    for (int i = 0; i < UNIT_COUNT; i++) {
        if (units[i].dimension != dimension)
            continue;
        if (strcmp(units[i].name, name) == 0) {
            *value = units[i].si;
            return DEM_OK;
        }
        snprintf(known + strlen(known), sizeof known - strlen(known), " %s", units[i].name);
    }
    return dem_fail(error, DEM_USAGE, "'%s' is not a unit of %s; use one of:%s", name, dimension_names[dimension], known);
}

dem_status dem_quantity(const char *text, dem_dimension dimension, double *value, dem_error *error)
{
    const char *end = text + strlen(text), *p = text;
    while (isspace((unsigned char)*p))
        p++;
    double number;
    const char *rest = dem_parse_double(p, end, &number);
    if (!rest || !isfinite(number))
        return dem_fail(error, DEM_USAGE, "'%s' is not a %s; write a number with a unit, as in \"2 %s\"", text,
                        dimension_names[dimension], dimension == DEM_DIMENSION_LENGTH ? "mm" : "g/cm3");
    while (isspace((unsigned char)*rest))
        rest++;
    double factor = 1;
    if (*rest)
        DEM_TRY(dem_unit(rest, dimension, &factor, error));
    *value = number * factor;
    return DEM_OK;
}

const char *dem_length_unit(double length, double *factor)
{
    double size = fabs(length);
    if (size >= 1e3)
        return *factor = 1e-3, "km";
    if (size >= 1)
        return *factor = 1, "m";
    if (size >= 1e-3)
        return *factor = 1e3, "mm";
    if (size >= 1e-6)
        return *factor = 1e6, "um";
    return *factor = 1e9, "nm";
}
