#include "sim/impact.h"

#include <math.h>

#include "math/vec.h"

// 2 int_0^1 dx / sqrt(1 - x^2.5) = 4/5 B(2/5, 1/2)
static const double HERTZ_DURATION = 2.94327518432470466;

double dem_hertz_stiffness(double modulus, double radius)
{
    return 4.0 / 3 * modulus * sqrt(radius);
}

double dem_hertz_overlap(double mass, double stiffness, double speed)
{
    // all of m v^2 / 2 is in the spring, 2/5 k d^2.5
    return pow(1.25 * mass * speed * speed / stiffness, 0.4);
}

double dem_hertz_duration(double mass, double stiffness, double speed)
{
    return HERTZ_DURATION * dem_hertz_overlap(mass, stiffness, speed) / speed;
}

double dem_hertz_force(double mass, double stiffness, double speed)
{
    return stiffness * pow(dem_hertz_overlap(mass, stiffness, speed), 1.5);
}

double dem_linear_overlap(double mass, double stiffness, double speed)
{
    return speed * sqrt(mass / stiffness);
}

double dem_linear_duration(double mass, double stiffness)
{
    return DEM_PI * sqrt(mass / stiffness);
}

double dem_linear_force(double mass, double stiffness, double speed)
{
    return speed * sqrt(mass * stiffness);
}
