#include "study/verify.h"

static const dem_case *const parts[] = {
    dem_verify_chung_ooi,
    dem_verify_impacts,
    dem_verify_sliding,
    dem_verify_rotation,
    dem_verify_adhesion,
    dem_verify_damping,
    dem_verify_gas,
    dem_verify_whole,
    dem_verify_integrators,
    dem_verify_laws,
    dem_verify_soft,
    dem_verify_walls,
    dem_verify_bonds,
    dem_verify_inlets,
};

const dem_case *dem_verify_case(size_t index)
{
    for (size_t i = 0; i < sizeof parts / sizeof *parts; i++)
        for (const dem_case *c = parts[i]; c->name; c++)
            if (index-- == 0)
                return c;
    return NULL;
}
