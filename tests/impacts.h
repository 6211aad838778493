/// Impacts (study/impacts.h) for tests.
#ifndef DEM_TESTS_IMPACTS_H
#define DEM_TESTS_IMPACTS_H

#include "study/impacts.h"
#include "worlds.h"

static inline rebound collide_looking(const impact *c, uint64_t every, impact_curve *curve)
{
    dem_trial t = {.model = calloc(1, sizeof(model))};
    check(t.model);
    rebound r = dem_impact_watch(&t, c, every, curve);
    check_ok(t.status, t.error);
    dem_world_destroy(t.world);
    model_free(t.model);
    return r;
}

/// What comes of it; a step is looked at now and then only.
static inline rebound collide(const impact *c)
{
    return collide_looking(c, 1 + (uint64_t)c->steps / 50, NULL);
}

#endif
