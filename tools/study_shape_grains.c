// The grains of a study: one mesh packed with more and more spheres, families from the grain generators, clusters of
// spheres.
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "base/hash.h"
#include "mesh/grain.h"
#include "study/cluster.h"
#include "study_shape.h"

enum { TRIANGLES = 3000, DIGEST = 65 };

// ---- clumps of meshes, which are kept

static bool is_kept(const char *path, const char *name, const char *digest, const shape_request *q, dem_clump **clump)
{
    dem_error ignored;
    if (dem_clump_read(path, clump, &ignored) != DEM_OK)
        return false;
    dem_clump_def c = dem_clump_view(*clump);
    if (strcmp(c.name, name) == 0 && strcmp(c.source_sha256, digest) == 0 && c.seed == q->seed &&
        strcmp(c.version, dem_version()) == 0)
        return true;
    dem_clump_destroy(*clump);
    *clump = NULL;
    return false;
}

static dem_status pack(const dem_ctx *ctx, const shape_request *q, const dem_mesh *mesh, const char *source,
                       const char *digest, size_t spheres, const char *name, const char *path, dem_clump **clump,
                       dem_error *error)
{
    if (is_kept(path, name, digest, q, clump))
        return DEM_OK;
    dem_make_options make = dem_make_defaults();
    make.pack.spheres = spheres;
    make.pack.effort = (dem_effort)q->effort;
    make.pack.seed = q->seed;
    make.name = name;
    make.source_mesh = source;
    make.source_sha256 = digest;
    DEM_TRY(dem_clump_make(ctx, mesh, &make, clump, NULL, error));
    return dem_clump_write(*clump, path, error);
}

static dem_status add(const dem_ctx *ctx, const shape_request *q, const dem_mesh *mesh, const char *source,
                      const char *digest, size_t spheres, const char *stem, shape_grains *g, dem_error *error)
{
    dem_variant *v = &g->variants[g->count];
    snprintf(v->name, sizeof v->name, "%.48s-%zu-%s", stem, spheres,
             q->effort == DEM_EFFORT_FAST   ? "fast"
             : q->effort == DEM_EFFORT_BEST ? "best"
                                            : "default");
    char *path = dem_path_join(q->folder, "clumps/%s.json", v->name);
    dem_status status = path ? DEM_OK : dem_fail_memory(error);
    if (status == DEM_OK)
        status = pack(ctx, q, mesh, source, digest, spheres, v->name, path, &g->clumps[g->count], error);
    free(path);
    if (status != DEM_OK)
        return status;
    v->clump = g->clumps[g->count];
    v->x = (double)dem_clump_view(v->clump).ball_count;
    // a packing that was wanted finer than the method goes is not another grain
    if (g->count == 0 || !g->spheres || v->x > v[-1].x)
        g->count++;
    else {
        dem_clump_destroy(g->clumps[g->count]);
        g->clumps[g->count] = NULL;
    }
    return DEM_OK;
}

static dem_status make_counts(const dem_ctx *ctx, const shape_request *q, shape_grains *g, dem_error *error)
{
    dem_mesh mesh = {0};
    dem_mesh_report report;
    char digest[DIGEST];
    const dem_repair_options repair = {.repair = (dem_repair)q->repair};
    const char *name = dem_file_name(q->mesh), *end = strrchr(name, '.');
    char stem[64];
    // another repair makes another grain, whose clumps are kept beside those of the first
    static const char *const repaired[] = {"", "-strict", "-wrap", "-none"};
    snprintf(stem, sizeof stem, "%.*s%s", end && end > name ? (int)(end - name < 40 ? end - name : 40) : 40, name,
             repaired[q->repair]);
    DEM_TRY(dem_mesh_import(ctx, q->mesh, &mesh, error));
    dem_status status = dem_sha256_file(q->mesh, digest, error);
    if (status == DEM_OK)
        status = dem_mesh_repair(ctx, &mesh, &repair, &report, error);
    for (size_t i = 0; i < q->count_count && status == DEM_OK; i++)
        status = add(ctx, q, &mesh, name, digest, (size_t)q->counts[i], stem, g, error);
    dem_mesh_free(&mesh);
    return status;
}

// ---- families

typedef struct family {
    const char *kind, *params[3], *axis;  // what is given of the kind; the first is what goes along
    size_t count;
    double along[8];
    double rest[2];
    double (*x)(const dem_clump_def *clump, double along);
} family;

static double as_given(const dem_clump_def *c, double along)
{
    (void)c;
    return along;
}
static double roundness_of(const dem_clump_def *c, double along)
{
    (void)along;
    return c->shape.roundness;
}
static double angularity_of(const dem_clump_def *c, double along)
{
    (void)along;
    return c->shape.angularity;
}

static const family families[] = {
    [SHAPE_ASPECT] = {"ellipsoid",
                      {"longest", "intermediate", "shortest"},
                      "aspect ratio",
                      5,
                      {1, 1.25, 1.5, 2, 2.5},
                      {1, 1},
                      as_given},
    [SHAPE_ROUNDNESS] = {"polyhedron",
                         {"rounding", "solid", "points"},
                         "roundness",
                         5,
                         {0.05, 0.2, 0.4, 0.65, 1},
                         {0, 14},
                         roundness_of},
    [SHAPE_ANGULARITY] =
        {"polyhedron", {"points", "solid", "rounding"}, "angularity", 5, {60, 30, 18, 12, 8}, {0, 0.08}, angularity_of},
};

static dem_status make_member(const dem_ctx *ctx, const shape_request *q, const family *f, size_t i, shape_grains *g,
                              dem_error *error)
{
    const dem_grain_kind *kind = dem_grain_kind_find(f->kind);
    double values[DEM_GRAIN_PARAMS];
    for (size_t k = 0; k < kind->param_count; k++) {
        values[k] = NAN;
        for (size_t p = 0; p < 3; p++)
            if (strcmp(kind->params[k].name, f->params[p]) == 0)
                values[k] = p == 0 ? f->along[i] : f->rest[p - 1];
    }
    dem_grain_options grain = dem_grain_defaults();
    grain.kind = f->kind;
    grain.values = values;
    grain.seed = q->seed;
    grain.triangles = TRIANGLES;
    grain.size = 1;
    dem_mesh mesh = {0};
    char digest[DIGEST], stem[64], number[24];
    DEM_TRY(dem_grain_make(ctx, &grain, &mesh, error));
    dem_sha256(mesh.vertices, mesh.vertex_count * sizeof *mesh.vertices, digest);
    snprintf(stem, sizeof stem, "%s-%s-%s", f->kind, f->params[0],
             dem_format_double(number, sizeof number, f->along[i], 4));
    dem_status status = add(ctx, q, &mesh, f->kind, digest, (size_t)q->counts[q->count_count - 1], stem, g, error);
    dem_mesh_free(&mesh);
    if (status == DEM_OK) {
        dem_variant *v = &g->variants[g->count - 1];
        dem_clump_def c = dem_clump_view(v->clump);
        v->x = f->x(&c, f->along[i]);
        snprintf(v->name, sizeof v->name, "%s", stem);
    }
    return status;
}

static dem_status make_family(const dem_ctx *ctx, const shape_request *q, shape_grains *g, dem_error *error)
{
    const family *f = &families[q->series];
    dem_status status = DEM_OK;
    for (size_t i = 0; i < f->count && status == DEM_OK; i++)
        status = make_member(ctx, q, f, i, g, error);
    g->axis = f->axis;
    return status;
}

static dem_status make_clusters(shape_grains *g, dem_error *error)
{
    static const char *const names[] = {"sphere", "dimer", "triangle", "tetrahedron"};
    for (size_t i = 0; i < DEM_CLUSTER_MOST; i++) {
        DEM_TRY(dem_cluster_regular(i + 1, 0.6, &g->clumps[i], error));
        g->variants[i] = (dem_variant){.x = (double)(i + 1), .clump = i ? g->clumps[i] : NULL};
        snprintf(g->variants[i].name, sizeof g->variants[i].name, "%s", names[i]);
        g->count++;
    }
    g->axis = "spheres, 0.6 of a diameter apart";
    return DEM_OK;
}

dem_status shape_grains_make(const dem_ctx *ctx, const shape_request *q, shape_grains *g, dem_error *error)
{
    *g = (shape_grains){.axis = "spheres"};
    if (q->series == SHAPE_CLUSTERS)
        return make_clusters(g, error);
    char *path = dem_path_join(q->folder, "clumps");
    dem_status status = path ? dem_folder_create(path, error) : dem_fail_memory(error);
    free(path);
    if (status != DEM_OK)
        return status;
    if (q->series != SHAPE_GRAIN)
        return make_family(ctx, q, g, error);
    g->log = g->spheres = true;
    return make_counts(ctx, q, g, error);
}

void shape_grains_release(shape_grains *g)
{
    for (size_t i = 0; i < SHAPE_MOST; i++)
        dem_clump_destroy(g->clumps[i]);
}
