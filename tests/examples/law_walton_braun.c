// A spring that is stiffer when unloading (Walton & Braun 1986), with Coulomb's friction: plastic surfaces, which lose
// the same part of the energy at every speed, without any dashpot: e = sqrt(loading / unloading). How to compile it:
// dem/law.h.
//
//   force
//    |      /|
//    |    /  |
//    |  /   /      up along `loading` to the largest overlap; back along `unloading`, to 0 where the surfaces stay
//    |/    /       dented by d0 = d_max (1 - loading / unloading)
//    +----+--- overlap
#include <dem/law.h>

enum { LOADING, UNLOADING, SLIDE_RATIO, FRICTION, PARAMETERS };
enum { DEEPEST, REMEMBERED };

static const dem_law_parameter parameters[PARAMETERS] = {
    [LOADING] = {"loading", "N/m", NAN, 1e-100, 1e100},
    [UNLOADING] = {"unloading", "N/m", NAN, 1e-100, 1e100},
    [SLIDE_RATIO] = {"slide_ratio", NULL, 2.0 / 7, 0, 10},
    [FRICTION] = {"friction", NULL, 0.5, 0, 1e3},
};

static dem_law_forces law(const dem_law_contact *c, const double *p, dem_law_memory *m)
{
    dem_law_forces f = {.stiffness = dem_law_most(p[LOADING], p[UNLOADING])};
    double deepest = dem_law_most(m->number[DEEPEST], c->overlap);
    double dent = deepest * (1 - p[LOADING] / f.stiffness);
    f.push = f.stiffness * (c->overlap - dent);
    f.push = dem_law_most(dem_law_least(p[LOADING] * c->overlap, f.push), 0);
    m->number[DEEPEST] = deepest;

    double k = f.slide_stiffness = p[SLIDE_RATIO] * p[LOADING];
    dem_vec3 before = m->vector[0], spring = dem_law_along(before, c->step, c->slip);
    double part = dem_law_cap(dem_law_scaled(spring, k), p[FRICTION] * f.push);
    m->vector[0] = dem_law_scaled(spring, part);
    f.slide = dem_law_scaled(m->vector[0], k);

    // what the dent has taken is lost, not stored
    double held = k * dem_law_dot(m->vector[0], m->vector[0]), held_before = k * dem_law_dot(before, before);
    f.stored = 0.5 * (f.push * f.push / f.stiffness + held);
    dem_vec3 both = dem_law_along(m->vector[0], 1, before);
    f.slid = 0.5 * (c->step * k * dem_law_dot(both, c->slip) - (held - held_before));
    return f;
}

DEM_LAW_PLUGIN(law, .name = "walton-braun", .version = 1, .parameters = parameters, .parameter_count = PARAMETERS,
               .vectors = 1, .numbers = REMEMBERED);
