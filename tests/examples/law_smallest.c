// The smallest law: a spring whose stiffness is written in the code. How to compile it: dem/law.h.
#include <dem/law.h>

static dem_law_forces law(const dem_law_contact *c, const double *p, dem_law_memory *m)
{
    (void)p;
    (void)m;
    dem_law_forces f = {.stiffness = 1e5};
    f.push = f.stiffness * c->overlap;
    f.stored = 0.5 * f.push * c->overlap;
    return f;
}

DEM_LAW_PLUGIN(law, .name = "smallest", .version = 1);
