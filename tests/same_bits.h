/// Worlds that must be the same in every bit on every instruction set, with any threads and after a restart.
#ifndef DEM_TESTS_SAME_BITS_H
#define DEM_TESTS_SAME_BITS_H

#include "worlds.h"

/// Runs 2 `steps` of five worlds of one model; `look` (may be NULL) judges each at the end.
static inline void check_same_bits(model *(*make)(void), uint64_t steps, void (*look)(dem_world *w))
{
    uint64_t want = 0;
    for (int i = 0; i < 5; i++) {
        model *m = make();
        const dem_kernels *kernels = dem_kernels_choose(i == 1 ? "plain" : i == 2 ? "v3" : NULL);
        dem_world *w = model_world(m, i == 3 ? 2 : 1);
        if (kernels) {
            w->kernels = kernels;
            w->instance = w->wall_instance = &kernels->instances[kernels->instance_count - 1];
        }
        run_steps(w, steps);
        if (i == 4) {
            void *bytes;
            size_t size;
            dem_error error;
            check_ok(dem_world_save(w, &bytes, &size, &error), error);
            dem_world_destroy(w);
            w = model_world(m, 1);
            check_ok(dem_world_restore(w, bytes, size, &error), error);
            free(bytes);
        }
        run_steps(w, steps);
        measured(w);
        if (look)
            look(w);
        want = want ? want : dem_world_hash(w);
        assert_int_equal(dem_world_hash(w), want);
        dem_world_destroy(w);
        model_free(m);
    }
}

#endif
