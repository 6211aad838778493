// Wet surfaces: where they have touched, a liquid bridge pulls until it is stretched to `rupture`, by a force that
// falls with its length: pull (1 - gap / rupture). A law that holds surfaces beyond the touch. How to compile it:
// dem/law.h.
#include <dem/law.h>

enum { STIFFNESS, DAMPING_RATIO, PULL, RUPTURE, PARAMETERS };
enum { WET, REMEMBERED };

static const dem_law_parameter parameters[PARAMETERS] = {
    [STIFFNESS] = {"stiffness", "N/m", NAN, 1e-100, 1e100},
    [DAMPING_RATIO] = {"damping_ratio", NULL, 0, 0, 1e3},
    [PULL] = {"pull", "N", NAN, 0, 1e100},
    [RUPTURE] = {"rupture", "m", NAN, 1e-100, 1e100},
};

static double reach(const double *p, double reduced)
{
    (void)reduced;
    return p[RUPTURE];
}

static dem_law_forces law(const dem_law_contact *c, const double *p, dem_law_memory *m)
{
    bool touches = c->overlap > 0, wet = touches | (m->number[WET] > 0);
    dem_law_forces f = {.holds = wet & (c->overlap > -p[RUPTURE]), .stiffness = p[STIFFNESS] + p[PULL] / p[RUPTURE]};
    double gap = dem_law_most(-c->overlap, 0), left = 1 - gap / p[RUPTURE];
    f.damping = 2 * p[DAMPING_RATIO] * sqrt(p[STIFFNESS] * c->mass);
    double spring = p[STIFFNESS] * c->overlap + dem_law_dashpot(c, f.damping, false);
    f.push = (touches ? spring : 0) - p[PULL] * left;
    m->number[WET] = 1;
    // of the pull from here to the rupture: what is not there any more when it breaks
    double pressed = dem_law_most(c->overlap, 0);
    f.stored = 0.5 * p[STIFFNESS] * pressed * pressed - p[PULL] * (pressed + 0.5 * p[RUPTURE] * left * left);
    return f;
}

DEM_LAW_PLUGIN_REACHING(law, reach, .name = "bridge", .version = 1, .parameters = parameters,
                        .parameter_count = PARAMETERS, .numbers = REMEMBERED);
