/// Worlds that must be the same in every bit on every instruction set, with any threads and after a restart.
#ifndef DEM_TESTS_SAME_BITS_H
#define DEM_TESTS_SAME_BITS_H

#include "worlds.h"

/// Runs 2 `steps` of the model with 1, 2 and 8 threads, and with 2 and a restart with 1.
static inline void check_same_threads(const model *m, uint64_t steps)
{
    static const int threads[] = {1, 2, 8, 2};
    uint64_t want = 0;
    for (int k = 0; k < 4; k++) {
        dem_world *w = model_world(m, threads[k]);
        run_steps(w, steps);
        if (k == 3) {
            dem_world *resumed = model_resumed(m, w, 1);
            dem_world_destroy(w);
            w = resumed;
        }
        run_steps(w, steps);
        want = k ? want : dem_world_hash(w);
        check(dem_world_hash(w) == want);
        dem_world_destroy(w);
    }
}

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
            dem_world *resumed = model_resumed(m, w, 1);
            dem_world_destroy(w);
            w = resumed;
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
