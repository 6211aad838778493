/// bench_pack [-j THREADS] [-s SEEDS] [-e fast|default|best] COUNT,COUNT.. MESH...: what packing takes and how near it
/// comes, of each number of spheres on each mesh, as means over the seeds: processor seconds, and the IoU gap in %
/// on far more lines than dem-clump takes.
#include <getopt.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "clump/fidelity.h"
#include "dem/dem.h"
#include "geom/union.h"

enum { LINES = 300000 };

typedef struct bench {
    dem_ctx ctx;
    int seeds;
    dem_pack_options options;
} bench;

static double processor_seconds(void)
{
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static dem_status pack_mesh(const bench *b, const dem_mesh *mesh, const char *name, size_t count, dem_error *error)
{
    double seconds = 0, gap_sum = 0;
    int exact = 0, one_piece = 1;
    for (int seed = 1; seed <= b->seeds; seed++) {
        dem_pack_options options = b->options;
        dem_pack pack;
        options.spheres = count;
        options.seed = (uint64_t)seed;
        double begin = processor_seconds(), gap = 0, spread = 0;
        dem_status status = dem_clump_pack(&b->ctx, mesh, &options, &pack, error);
        if (status != DEM_OK)
            return status;
        seconds += (processor_seconds() - begin) / b->seeds;
        status = dem_fidelity_gap(&b->ctx, mesh, pack.balls, pack.count, LINES, &gap, &spread, error);
        gap_sum += 100 * gap / b->seeds;
        exact += pack.moments == DEM_MOMENTS_EXACT;
        one_piece = one_piece && dem_ball_pieces(pack.balls, pack.count, 0, NULL) == 1;
        dem_pack_free(&pack);
        if (status != DEM_OK)
            return status;
    }
    const char *slash = strrchr(name, '/');
    printf("%-24.24s %5zu  %8.4f %%  %7.3f s  exact %d/%d%s\n", slash ? slash + 1 : name, count, gap_sum, seconds,
           exact, b->seeds, one_piece ? "" : "  IN PIECES");
    fflush(stdout);
    return DEM_OK;
}

static dem_status run(const bench *b, const char *counts, const char *path, dem_error *error)
{
    dem_mesh mesh = {0};
    dem_mesh_report report;
    dem_repair_options repair = {0};
    dem_status status = dem_mesh_import(NULL, path, &mesh, error);
    if (status == DEM_OK)
        status = dem_mesh_repair(NULL, &mesh, &repair, &report, error);
    for (const char *at = counts; status == DEM_OK && at;) {
        status = pack_mesh(b, &mesh, path, (size_t)strtoul(at, NULL, 10), error);
        at = strchr(at, ',');
        at += at != NULL;
    }
    dem_mesh_free(&mesh);
    return status;
}

int main(int argc, char **argv)
{
    bench b = {.seeds = 1, .options = dem_pack_defaults(), .ctx = {.threads = 1}};
    int option;
    while ((option = getopt(argc, argv, "j:s:e:")) != -1) {
        if (option == 'j')
            b.ctx.threads = atoi(optarg);
        else if (option == 's')
            b.seeds = atoi(optarg);
        else if (option == 'e')
            b.options.effort = *optarg == 'f' ? DEM_EFFORT_FAST : *optarg == 'b' ? DEM_EFFORT_BEST : DEM_EFFORT_DEFAULT;
        else
            return DEM_USAGE;
    }
    if (optind + 1 >= argc)
        return DEM_USAGE;
    for (int i = optind + 1; i < argc; i++) {
        dem_error error = {0};
        if (run(&b, argv[optind], argv[i], &error) != DEM_OK)
            fprintf(stderr, "%s: %s\n", argv[i], error.text);
    }
    return 0;
}
