// The linear spring with a dashpot and Coulomb's friction (Cundall & Strack 1979) as a law of your own: what the engine
// has built in, to show what it takes. How to compile it: dem/law.h.
#include <dem/law.h>

enum { STIFFNESS, DAMPING_RATIO, SLIDE_STIFFNESS, FRICTION, PARAMETERS };

static const dem_law_parameter parameters[PARAMETERS] = {
    [STIFFNESS] = {"stiffness", "N/m", NAN, 0, 1e100},
    [DAMPING_RATIO] = {"damping_ratio", NULL, 0, 0, 1e3},
    [SLIDE_STIFFNESS] = {"slide_stiffness", "N/m", NAN, 0, 1e100},
    [FRICTION] = {"friction", NULL, 0.5, 0, 1e3},
};

static dem_law_forces law(const dem_law_contact *c, const double *p, dem_law_memory *m)
{
    dem_law_forces f = {.stiffness = p[STIFFNESS], .slide_stiffness = p[SLIDE_STIFFNESS]};
    f.damping = 2 * p[DAMPING_RATIO] * sqrt(f.stiffness * c->mass);
    f.push = f.stiffness * c->overlap + dem_law_dashpot(c, f.damping, true);
    f.push = dem_law_most(f.push, 0);

    // the spring, and a dashpot of the same ratio, up to Coulomb's cap
    double k = f.slide_stiffness;
    dem_vec3 before = m->vector[0], spring = dem_law_along(before, c->step, c->slip);
    f.slide_damping = 2 * p[DAMPING_RATIO] * sqrt(k * c->mass);
    dem_vec3 whole = dem_law_along(dem_law_scaled(spring, k), f.slide_damping, c->slip);
    double cap = p[FRICTION] * f.push, part = dem_law_cap(whole, cap);
    f.slide = dem_law_scaled(whole, part);
    // while it slides, the spring keeps what it has, up to the cap
    bool full = (part < 1) & dem_law_longer(dem_law_scaled(spring, k), cap);
    dem_vec3 capped = dem_law_scaled(f.slide, 1 / k);
    m->vector[0].x = full ? capped.x : spring.x;
    m->vector[0].y = full ? capped.y : spring.y;
    m->vector[0].z = full ? capped.z : spring.z;

    double held = k * dem_law_dot(m->vector[0], m->vector[0]), held_before = k * dem_law_dot(before, before);
    f.stored = 0.5 * (f.stiffness * c->overlap * c->overlap + held);
    dem_vec3 both = dem_law_along(m->vector[0], 1, before);
    f.slid = 0.5 * (c->step * k * dem_law_dot(both, c->slip) - (held - held_before));
    return f;
}

DEM_LAW_PLUGIN(law, .name = "linear", .version = 1, .parameters = parameters, .parameter_count = PARAMETERS,
               .vectors = 1);
