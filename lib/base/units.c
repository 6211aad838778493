#include "base/units.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/text.h"

#define PI 3.14159265358979323846

typedef struct unit {
    const char *name;
    dem_dimension dimension;
    double si;
} unit;

static const unit units[] = {
    {"m", DEM_DIMENSION_LENGTH, 1},
    {"cm", DEM_DIMENSION_LENGTH, 1e-2},
    {"mm", DEM_DIMENSION_LENGTH, 1e-3},
    {"um", DEM_DIMENSION_LENGTH, 1e-6},
    {"µm", DEM_DIMENSION_LENGTH, 1e-6},
    {"micron", DEM_DIMENSION_LENGTH, 1e-6},
    {"nm", DEM_DIMENSION_LENGTH, 1e-9},
    {"km", DEM_DIMENSION_LENGTH, 1e3},
    {"in", DEM_DIMENSION_LENGTH, 0.0254},
    {"inch", DEM_DIMENSION_LENGTH, 0.0254},
    {"ft", DEM_DIMENSION_LENGTH, 0.3048},
    {"kg/m3", DEM_DIMENSION_DENSITY, 1},
    {"kg/m^3", DEM_DIMENSION_DENSITY, 1},
    {"g/cm3", DEM_DIMENSION_DENSITY, 1e3},
    {"g/cm^3", DEM_DIMENSION_DENSITY, 1e3},
    {"t/m3", DEM_DIMENSION_DENSITY, 1e3},
    {"t/m^3", DEM_DIMENSION_DENSITY, 1e3},
    {"s", DEM_DIMENSION_TIME, 1},
    {"ms", DEM_DIMENSION_TIME, 1e-3},
    {"us", DEM_DIMENSION_TIME, 1e-6},
    {"µs", DEM_DIMENSION_TIME, 1e-6},
    {"ns", DEM_DIMENSION_TIME, 1e-9},
    {"min", DEM_DIMENSION_TIME, 60},
    {"h", DEM_DIMENSION_TIME, 3600},
    {"m/s", DEM_DIMENSION_VELOCITY, 1},
    {"cm/s", DEM_DIMENSION_VELOCITY, 1e-2},
    {"mm/s", DEM_DIMENSION_VELOCITY, 1e-3},
    {"km/h", DEM_DIMENSION_VELOCITY, 1 / 3.6},
    {"m/s2", DEM_DIMENSION_ACCELERATION, 1},
    {"m/s^2", DEM_DIMENSION_ACCELERATION, 1},
    {"mm/s2", DEM_DIMENSION_ACCELERATION, 1e-3},
    {"mm/s^2", DEM_DIMENSION_ACCELERATION, 1e-3},
    {"Pa", DEM_DIMENSION_PRESSURE, 1},
    {"kPa", DEM_DIMENSION_PRESSURE, 1e3},
    {"MPa", DEM_DIMENSION_PRESSURE, 1e6},
    {"GPa", DEM_DIMENSION_PRESSURE, 1e9},
    {"J/m3", DEM_DIMENSION_PRESSURE, 1},
    {"J/m^3", DEM_DIMENSION_PRESSURE, 1},
    {"N/m", DEM_DIMENSION_STIFFNESS, 1},
    {"J/m2", DEM_DIMENSION_STIFFNESS, 1},
    {"J/m^2", DEM_DIMENSION_STIFFNESS, 1},
    {"mJ/m2", DEM_DIMENSION_STIFFNESS, 1e-3},
    {"mJ/m^2", DEM_DIMENSION_STIFFNESS, 1e-3},
    {"kN/m", DEM_DIMENSION_STIFFNESS, 1e3},
    {"N/mm", DEM_DIMENSION_STIFFNESS, 1e3},
    {"MN/m", DEM_DIMENSION_STIFFNESS, 1e6},
    {"rad", DEM_DIMENSION_ANGLE, 1},
    {"deg", DEM_DIMENSION_ANGLE, PI / 180},
    {"rad/s", DEM_DIMENSION_ANGULAR_VELOCITY, 1},
    {"deg/s", DEM_DIMENSION_ANGULAR_VELOCITY, PI / 180},
    {"rpm", DEM_DIMENSION_ANGULAR_VELOCITY, PI / 30},
    {"kg", DEM_DIMENSION_MASS, 1},
    {"g", DEM_DIMENSION_MASS, 1e-3},
    {"mg", DEM_DIMENSION_MASS, 1e-6},
    {"t", DEM_DIMENSION_MASS, 1e3},
    {"m2", DEM_DIMENSION_AREA, 1},
    {"m^2", DEM_DIMENSION_AREA, 1},
    {"cm2", DEM_DIMENSION_AREA, 1e-4},
    {"cm^2", DEM_DIMENSION_AREA, 1e-4},
    {"mm2", DEM_DIMENSION_AREA, 1e-6},
    {"mm^2", DEM_DIMENSION_AREA, 1e-6},
    {"kg m2", DEM_DIMENSION_INERTIA, 1},
    {"kg m^2", DEM_DIMENSION_INERTIA, 1},
    {"1/s", DEM_DIMENSION_RATE, 1},
    {"Hz", DEM_DIMENSION_RATE, 1},
    {"Pa s", DEM_DIMENSION_VISCOSITY, 1},
    {"mPa s", DEM_DIMENSION_VISCOSITY, 1e-3},
    {"cP", DEM_DIMENSION_VISCOSITY, 1e-3},
    {"N", DEM_DIMENSION_FORCE, 1},
    {"kN", DEM_DIMENSION_FORCE, 1e3},
    {"MN", DEM_DIMENSION_FORCE, 1e6},
    {"mN", DEM_DIMENSION_FORCE, 1e-3},
    {"uN", DEM_DIMENSION_FORCE, 1e-6},
    {"µN", DEM_DIMENSION_FORCE, 1e-6},
    {"nN", DEM_DIMENSION_FORCE, 1e-9},
    {"kg/s", DEM_DIMENSION_MASS_RATE, 1},
    {"g/s", DEM_DIMENSION_MASS_RATE, 1e-3},
    {"kg/h", DEM_DIMENSION_MASS_RATE, 1 / 3600.0},
    {"t/h", DEM_DIMENSION_MASS_RATE, 1 / 3.6},
    {"s/m", DEM_DIMENSION_SLOWNESS, 1},
    {"s/mm", DEM_DIMENSION_SLOWNESS, 1e3},
};
enum { UNIT_COUNT = sizeof units / sizeof *units };

static const struct {
    const char *name, *example;
} dimensions[] = {
    [DEM_DIMENSION_LENGTH] = {"a length", "2 mm"},
    [DEM_DIMENSION_DENSITY] = {"a density", "2.65 g/cm3"},
    [DEM_DIMENSION_TIME] = {"a time", "5 ms"},
    [DEM_DIMENSION_VELOCITY] = {"a velocity", "2 m/s"},
    [DEM_DIMENSION_ACCELERATION] = {"an acceleration", "9.81 m/s2"},
    [DEM_DIMENSION_PRESSURE] = {"a pressure", "70 GPa"},
    [DEM_DIMENSION_STIFFNESS] = {"a stiffness", "10 kN/m"},
    [DEM_DIMENSION_ANGLE] = {"an angle", "30 deg"},
    [DEM_DIMENSION_ANGULAR_VELOCITY] = {"an angular velocity", "10 rpm"},
    [DEM_DIMENSION_MASS] = {"a mass", "5 g"},
    [DEM_DIMENSION_AREA] = {"an area", "4 cm2"},
    [DEM_DIMENSION_INERTIA] = {"a moment of inertia", "2e-9 kg m2"},
    [DEM_DIMENSION_RATE] = {"a rate", "100 1/s"},
    [DEM_DIMENSION_VISCOSITY] = {"a viscosity", "1 mPa s"},
    [DEM_DIMENSION_FORCE] = {"a force", "5 kN"},
    [DEM_DIMENSION_MASS_RATE] = {"a mass by time", "2 kg/s"},
    [DEM_DIMENSION_SLOWNESS] = {"an inverse velocity", "500 s/m"},
    [DEM_DIMENSION_NONE] = {"a number", "0.5"},
};

const char *dem_dimension_name(dem_dimension dimension)
{
    return dimensions[dimension].name;
}

const char *dem_dimension_example(dem_dimension dimension)
{
    return dimensions[dimension].example;
}

static dem_status find_unit(const char *name, size_t length, dem_dimension dimension, double *value, dem_error *error)
{
    char known[256] = "";
    for (int i = 0; i < UNIT_COUNT; i++) {
        if (units[i].dimension != dimension)
            continue;
        if (strlen(units[i].name) == length && strncmp(units[i].name, name, length) == 0) {
            *value = units[i].si;
            return DEM_OK;
        }
        snprintf(known + strlen(known), sizeof known - strlen(known), " %s", units[i].name);
    }
    const char *what = dimensions[dimension].name + strcspn(dimensions[dimension].name, " ") + 1;
    if (dimension == DEM_DIMENSION_NONE)
        return dem_fail(error, DEM_USAGE, "'%.*s' is not expected, this is a pure number; leave it out", (int)length,
                        name);
    return dem_fail(error, DEM_USAGE, "'%.*s' is not a unit of %s; use one of:%s", (int)length, name, what, known);
}

dem_status dem_unit(const char *name, dem_dimension dimension, double *value, dem_error *error)
{
    return find_unit(name, strlen(name), dimension, value, error);
}

dem_dimension dem_dimension_of(const char *name)
{
    for (int i = 0; name && i < UNIT_COUNT; i++)
        if (units[i].si == 1 && strcmp(units[i].name, name) == 0)
            return units[i].dimension;
    return DEM_DIMENSION_NONE;
}

dem_status dem_quantity(const char *text, dem_dimension dimension, double *value, dem_error *error)
{
    const char *end = text + strlen(text), *p = text;
    while (isspace((unsigned char)*p))
        p++;
    while (end > p && isspace((unsigned char)end[-1]))
        end--;
    double number;
    const char *rest = dem_parse_double(p, end, &number);
    if (!rest || !isfinite(number))
        return dem_fail(error, DEM_USAGE, "'%s' is not %s; write a number%s, as in \"%s\"", text,
                        dimensions[dimension].name, dimension == DEM_DIMENSION_NONE ? "" : " with a unit",
                        dimensions[dimension].example);
    while (rest < end && isspace((unsigned char)*rest))
        rest++;
    double factor = 1;
    if (rest < end)
        DEM_TRY(find_unit(rest, (size_t)(end - rest), dimension, &factor, error));
    // 20 us is 20 / 1e6, rounded once; 1e-6 is not a number of the machine
    double parts = round(1 / factor);
    *value = factor < 1 && fabs(parts * factor - 1) < 1e-12 ? number / parts : number * factor;
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
