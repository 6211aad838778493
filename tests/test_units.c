#include "check.h"

#include "base/units.h"
#include "math/vec.h"

static void quantities_become_si(void **state)
{
    (void)state;
    static const struct {
        const char *text;
        dem_dimension dimension;
        double si;
    } cases[] = {
        {"2 mm", DEM_DIMENSION_LENGTH, 2e-3},
        {"1 inch", DEM_DIMENSION_LENGTH, 0.0254},
        {" 3µm ", DEM_DIMENSION_LENGTH, 3e-6},
        {"2.65 g/cm3", DEM_DIMENSION_DENSITY, 2650},
        {"5 ms", DEM_DIMENSION_TIME, 5e-3},
        {"7us", DEM_DIMENSION_TIME, 7e-6},
        {"7 ns", DEM_DIMENSION_TIME, 7e-9},
        {"2 min", DEM_DIMENSION_TIME, 120},
        {"1.5 h", DEM_DIMENSION_TIME, 5400},
        {"36 km/h", DEM_DIMENSION_VELOCITY, 10},
        {"-5 mm/s", DEM_DIMENSION_VELOCITY, -5e-3},
        {"5 cm/s", DEM_DIMENSION_VELOCITY, 5e-2},
        {"5 m/s", DEM_DIMENSION_VELOCITY, 5},
        {"-9.81 m/s2", DEM_DIMENSION_ACCELERATION, -9.81},
        {"-9810 mm/s^2", DEM_DIMENSION_ACCELERATION, -9.81},
        {"70 GPa", DEM_DIMENSION_PRESSURE, 70e9},
        {"70MPa", DEM_DIMENSION_PRESSURE, 70e6},
        {"70 kPa", DEM_DIMENSION_PRESSURE, 70e3},
        {"10 kN/m", DEM_DIMENSION_STIFFNESS, 1e4},
        {"10 N/mm", DEM_DIMENSION_STIFFNESS, 1e4},
        {"1 MN/m", DEM_DIMENSION_STIFFNESS, 1e6},
        {"30 deg", DEM_DIMENSION_ANGLE, DEM_PI / 6},
        {"1 rad", DEM_DIMENSION_ANGLE, 1},
        {"60 rpm", DEM_DIMENSION_ANGULAR_VELOCITY, 2 * DEM_PI},
        {"180 deg/s", DEM_DIMENSION_ANGULAR_VELOCITY, DEM_PI},
        {"2 rad/s", DEM_DIMENSION_ANGULAR_VELOCITY, 2},
        {"5 g", DEM_DIMENSION_MASS, 5e-3},
        {"5 mg", DEM_DIMENSION_MASS, 5e-6},
        {"5 t", DEM_DIMENSION_MASS, 5e3},
        {"2e-9 kg m2", DEM_DIMENSION_INERTIA, 2e-9},
        {"100 1/s", DEM_DIMENSION_RATE, 100},
        {"100 Hz", DEM_DIMENSION_RATE, 100},
        {"0.5", DEM_DIMENSION_NONE, 0.5},
        {"1e-3", DEM_DIMENSION_TIME, 1e-3},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        double value = NAN;
        dem_error error;
        check_ok(dem_quantity(cases[i].text, cases[i].dimension, &value, &error), error);
        check_close(value, cases[i].si, 4e-16);  // one rounding of the factor, one of the product
    }
}

static void another_dimensions_unit_is_refused_with_those_that_fit(void **state)
{
    (void)state;
    for (int dimension = 0; dimension <= DEM_DIMENSION_NONE; dimension++) {
        double value;
        dem_error error;
        const char *example = dem_dimension_example((dem_dimension)dimension);
        check_ok(dem_quantity(example, (dem_dimension)dimension, &value, &error), error);
        check(dem_quantity("2 parsec", (dem_dimension)dimension, &value, &error) == DEM_USAGE);
        const char *unit = strchr(example, ' ');
        if (unit) {
            char listed[40];
            snprintf(listed, sizeof listed, "%s", unit);
            check(strstr(error.text, "use one of:") && strstr(error.text, listed));
        } else
            check(strstr(error.text, "pure number") != NULL);
        check(dem_quantity("fast", (dem_dimension)dimension, &value, &error) == DEM_USAGE);
        check(strstr(error.text, dem_dimension_name((dem_dimension)dimension)) && strstr(error.text, example));
    }
    double value;
    dem_error error;
    check(dem_quantity("2 kg", DEM_DIMENSION_TIME, &value, &error) == DEM_USAGE);
    assert_string_equal(error.text, "'kg' is not a unit of time; use one of: s ms us µs ns min h");
    check(dem_unit("g", DEM_DIMENSION_ACCELERATION, &value, &error) == DEM_USAGE);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(quantities_become_si),
        cmocka_unit_test(another_dimensions_unit_is_refused_with_those_that_fit),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
