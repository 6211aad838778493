#include <stdlib.h>

#include "base/status.h"
#include "clump/pack_connect.h"

// Samples: at least 100 per sphere or the spheres fit the samples instead of the surface; twice as many spheres as
// asked for are under way at first.
enum { FEWEST_SAMPLES = 6144, MOST_SAMPLES = 65536, BASE_SAMPLES = 4096, SAMPLES_PER_SPHERE = 100 };
enum { OUTER_SAMPLES = 4 };     // times as many where none may stay uncovered, nor what lies between them
enum { FEWEST_INTERIOR = 2048, INTERIOR_PER_SPHERE = 10, MOST_INTERIOR = 4096 };
enum { FEWEST_POINTS = 8000, POINTS_PER_SPHERE = 150 };    // of the lattice
enum { FEWEST_CANDIDATES = 3000, CANDIDATES_PER_SPHERE = 3 };

static const double softening = 0.0015;  // below this depth a sample's charge turns from |f|^p to f^2 [d_eq]

// A breath costs about as much as the balls it relaxes, and where there are many of them hardly one is in vain: their
// number goes down as that of the balls goes up, but not as fast.
static const double fewer_breaths = 0.65;  // power of the number of balls

static dem_pack_effort effort_for(dem_effort effort, size_t balls)
{
    static const struct {
        dem_pack_effort each;
        double breaths;      // with 50 balls
        double most_breaths;
    } levels[] = {
        [DEM_EFFORT_FAST] = {{.prune_share = 0.06, .prune_iterations = 6, .polish_steps = 15, .polish_tolerance = 2e-3, .line_density = 25}, 18, 50},
        [DEM_EFFORT_DEFAULT] = {{.prune_share = 0.05, .prune_iterations = 7, .polish_steps = 80, .polish_tolerance = 5e-4, .line_density = 40}, 55, 250},
        [DEM_EFFORT_BEST] = {{.prune_share = 0.03, .prune_iterations = 8, .polish_steps = 200, .polish_tolerance = 5e-5, .line_density = 60}, 1200, 2000},
    };
    dem_pack_effort bought = levels[effort].each;
    bought.breaths = (int)fmin(levels[effort].breaths * pow(50 / (double)balls, fewer_breaths),
                               levels[effort].most_breaths);
    return bought;
}

static size_t at_least(size_t a, size_t b)
{
    return a > b ? a : b;
}

// Which sizes the candidates come in: the medial balls, and larger ones that stick out a little [d_eq].
static void set_inflations(dem_packing *p)
{
    static const double few[4] = {0, 0.01, 0.03, 0.06}, some[4] = {0, 0.006, 0.015, 0.03}, many[3] = {0, 0.003, 0.008};
    size_t n = p->options->spheres;
    p->inflation_count = n > 150 ? 3 : 4;
    for (size_t i = 0; i < p->inflation_count; i++)
        p->inflations[i] = n < 30 ? few[i] : n > 150 ? many[i] : some[i];
}

static void split_chunks(dem_packing *p)
{
    for (size_t k = 0; k < DEM_CHUNKS; k++) {
        p->chunks[k].begin = p->samples.block_count * k / DEM_CHUNKS;
        p->chunks[k].end = p->samples.block_count * (k + 1) / DEM_CHUNKS;
    }
}

static void take_columns(dem_packing *p, dem_ball_columns *columns, size_t padded)
{
    float **each[4] = {&columns->x, &columns->y, &columns->z, &columns->r};
    for (int k = 0; k < 4; k++)
        *each[k] = dem_arena_take(&p->arena, padded, sizeof(float));
}

static dem_status take_work_space(dem_packing *p, dem_error *error)
{
    size_t n = p->capacity, padded = (n + DEM_LANES - 1) / DEM_LANES * DEM_LANES, blocks = p->samples.block_count;
    take_columns(p, &p->columns, padded);
    take_columns(p, &p->tree_columns, padded);
    for (int k = 0; k < DEM_CHUNKS; k++) {
        dem_pack_chunk *chunk = &p->chunks[k];
        chunk->work.distance = dem_arena_take(&p->arena, padded, sizeof *chunk->work.distance);
        chunk->work.found = dem_arena_take(&p->arena, padded, sizeof *chunk->work.found);
        chunk->work.bucket = dem_arena_take(&p->arena, padded, sizeof *chunk->work.bucket);
        take_columns(p, &chunk->some, padded);
        chunk->ids = dem_arena_take(&p->arena, padded, sizeof *chunk->ids);
        chunk->slot = dem_arena_take(&p->arena, n, sizeof *chunk->slot);
        for (size_t i = 0; chunk->slot && i < n; i++)
            chunk->slot[i] = -1;
    }
    p->near_begin = dem_arena_take(&p->arena, blocks, sizeof *p->near_begin);
    p->near_size = dem_arena_take(&p->arena, blocks, sizeof *p->near_size);
    p->near_at = dem_arena_take(&p->arena, n, sizeof *p->near_at);
    p->links = dem_arena_take(&p->arena, n, sizeof *p->links);
    p->tree = dem_arena_take(&p->arena, n, sizeof *p->tree);
    p->tree_reach = dem_arena_take(&p->arena, padded, sizeof *p->tree_reach);
    p->tree_nearest = dem_arena_take(&p->arena, padded, sizeof *p->tree_nearest);
    p->tree_balls = dem_arena_take(&p->arena, n, sizeof *p->tree_balls);
    p->equations = dem_arena_take(&p->arena, n, sizeof *p->equations);
    p->factor = dem_arena_take(&p->arena, n, sizeof *p->factor);
    p->cost = dem_arena_take(&p->arena, n, sizeof *p->cost);
    p->rise = dem_arena_take(&p->arena, blocks * DEM_BLOCK, sizeof *p->rise);
    p->order = dem_arena_take(&p->arena, n, sizeof *p->order);
    if (p->arena.failed)
        return dem_fail_memory(error);
    DEM_TRY(dem_pack_state_init(p, &p->trial, error));
    return dem_pack_state_init(p, &p->moved, error);
}

dem_status dem_packing_open(const dem_ctx *ctx, const dem_pack_grain *grain, const dem_pack_options *options,
                            const dem_pack_kernels *kernels, dem_packing *p, dem_error *error)
{
    size_t n = options->spheres;
    *p = (dem_packing){.ctx = ctx, .options = options, .grain = grain,
                       .kernels = kernels ? kernels : dem_pack_kernels_choose(NULL),
                       .random = random_stream(options->seed, 0), .connected = true, .effort = effort_for(options->effort, n), .stiffness = 0.5,
                       .charge = {.softening = (float)(softening * softening / 4), .inside = 1, .outside = 1}};
    size_t surface = at_least(FEWEST_SAMPLES, BASE_SAMPLES + SAMPLES_PER_SPHERE * n);
    if (options->side == DEM_SIDE_OUTER)
        surface *= OUTER_SAMPLES;
    if (surface > MOST_SAMPLES)
        surface = MOST_SAMPLES;
    size_t interior = FEWEST_INTERIOR + INTERIOR_PER_SPHERE * n;
    if (interior > MOST_INTERIOR)
        interior = MOST_INTERIOR;
    p->capacity = 2 * n + 64;
    dem_laps_begin(&p->laps);
    dem_status status = dem_lattice_build(grain, at_least(FEWEST_POINTS, POINTS_PER_SPHERE * n), &p->lattice, error);
    if (status == DEM_OK)
        status = dem_samples_build(grain, &p->lattice, surface, interior, &p->samples, error);
    dem_laps_end(&p->laps, "samples");
    if (status == DEM_OK)
        status = dem_candidates_build(grain, &p->samples, p->kernels,
                                      at_least(FEWEST_CANDIDATES, CANDIDATES_PER_SPHERE * n), dem_threads(ctx),
                                      &p->candidates, error);
    dem_laps_end(&p->laps, "candidates");
    if (status == DEM_OK) {
        p->crew = dem_crew_create(dem_threads(ctx));
        split_chunks(p);
        set_inflations(p);
        status = take_work_space(p, error);
    }
    if (status != DEM_OK)
        dem_packing_close(p);
    return status;
}

void dem_packing_close(dem_packing *p)
{
    for (int k = 0; k < DEM_CHUNKS; k++) {
        free(p->chunks[k].near);
        free(p->chunks[k].near_least);
        free(p->chunks[k].lanes);
    }
    dem_crew_destroy(p->crew);
    dem_arena_release(&p->arena);
    dem_candidates_release(&p->candidates);
    dem_samples_release(&p->samples);
    dem_lattice_release(&p->lattice);
    *p = (dem_packing){0};
}
