#include "dem/clump.h"

#include <stdlib.h>

#include "base/clock.h"
#include "base/memory.h"
#include "base/text.h"
#include "clump/fidelity.h"
#include "clump/make.h"
#include "clump/pack.h"
#include "clump/shape_parts.h"
#include "math/quat.h"
#include "mesh/decimate.h"

static const double density_quartz = 2650;  // [kg/m^3]
enum { SURFACE_TRIANGLES = 2000 };          // a picture of some thousand clumps, and 100 kB of file

dem_make_options dem_make_defaults(void)
{
    return (dem_make_options){.pack = dem_pack_defaults(),
                              .density = density_quartz,
                              .mass_from = DEM_MASS_FROM_MESH,
                              .surface_triangles = SURFACE_TRIANGLES};
}

// what is freed when the clump is made or has failed
typedef struct make_work {
    dem_pack pack;
    dem_ball *balls;      // in the clump frame
    dem_mesh surface;
    dem_buffer parameters;
} make_work;

static void to_clump_frame(dem_vec3 *point, dem_vec3 position, dem_quat orientation)
{
    *point = quat_unrotate(orientation, v3_sub(*point, position));
}

static void surface_to_clump_frame(const dem_clump_def *def, dem_mesh *surface)
{
    for (size_t i = 0; i < surface->vertex_count; i++)
        to_clump_frame(&surface->vertices[i], def->position, def->orientation);
}

dem_status dem_make_surface(const dem_mesh *mesh, size_t triangles, const dem_clump_def *def, dem_mesh *surface,
                            dem_error *error)
{
    if (triangles == 0)
        return DEM_OK;
    DEM_TRY(dem_mesh_decimate(mesh, triangles, surface, error));
    surface_to_clump_frame(def, surface);
    return DEM_OK;
}

static void write_targets(dem_buffer *out, const dem_pack_options *asked)
{
    for (size_t i = 0; i < asked->target_count; i++) {
        dem_buffer_print(out, "%s\"%s\":", i ? "," : ",\"targets\":{", asked->targets[i].measure);
        dem_buffer_number(out, asked->targets[i].bound, 17);
    }
    if (asked->target_count > 0)
        dem_buffer_text(out, "}");
}

static void write_parameters(dem_buffer *out, const dem_pack_options *asked, const dem_pack *pack)
{
    static const char *const efforts[] = {"fast", "default", "best"};
    static const char *const moments[] = {"free", "volume", "exact"};
    static const char *const sides[] = {"both", "inscribed", "outer"};
    if (asked->gap > 0 || asked->target_count > 0) {
        dem_buffer_print(out, "{\"max_spheres\":%zu", asked->max_spheres);
        if (asked->gap > 0) {
            dem_buffer_text(out, ",\"gap\":");
            dem_buffer_number(out, asked->gap, 17);
        }
        write_targets(out, asked);
    } else {
        dem_buffer_print(out, "{\"spheres\":%zu", asked->spheres);
    }
    dem_buffer_print(out, ",\"effort\":\"%s\",\"moments\":\"%s\",\"moments_met\":\"%s\",\"side\":\"%s\"",
                     efforts[asked->effort], moments[asked->moments], moments[pack->moments], sides[asked->side]);
    for (size_t i = 0; i < pack->used_count; i++)
        if (isfinite(pack->used[i].value)) {
            dem_buffer_print(out, ",\"%s\":", pack->used[i].name);
            dem_buffer_shortest(out, pack->used[i].value);
        }
    dem_buffer_text(out, "}");
}

// mass, centre, frame and inertia from the solid that was asked for; the union's own beside them
static void set_mass(dem_clump_def *def, const dem_solid *mesh, const dem_union *balls, const dem_make_options *options)
{
    const dem_solid *solid = options->mass_from == DEM_MASS_FROM_UNION ? &balls->solid : mesh;
    def->density = options->density;
    def->mass_from = options->mass_from;
    def->volume = solid->volume;
    def->mass = options->density * solid->volume;
    def->position = solid->centre;
    def->orientation = solid->axes;
    def->union_volume = balls->solid.volume;
    def->union_centre = balls->solid.centre;
    to_clump_frame(&def->union_centre, def->position, def->orientation);
    for (int i = 0; i < 3; i++) {
        def->inertia[i] = options->density * solid->principal[i];
        def->union_inertia[i] = options->density * balls->solid.principal[i];
    }
}

// ---- measuring: nothing of it needs anything else, so it is shared out, what takes longest first

enum { DISTANCES, CORNERS, GAP, BOX, UNION, HULL, SURFACE, MEASURES };

typedef struct measuring {
    const dem_mesh *mesh;
    size_t surface_triangles;
    make_work *work;
    dem_union balls;
    dem_fidelity_work fidelity;
    dem_shape_work shape;
    dem_status status[MEASURES];
    dem_error error[MEASURES];
} measuring;

static dem_status measure_one(measuring *m, int part, dem_error *error)
{
    switch (part) {
    case DISTANCES: return dem_fidelity_part(&m->fidelity, DEM_FIDELITY_SURFACES, 1, error);
    case GAP: return dem_fidelity_part(&m->fidelity, DEM_FIDELITY_GAP, 1, error);
    case CORNERS: return dem_shape_part(&m->shape, DEM_SHAPE_CORNERS, 1, error);
    case BOX: return dem_shape_part(&m->shape, DEM_SHAPE_BOX, 1, error);
    case HULL: return dem_shape_part(&m->shape, DEM_SHAPE_HULL, 1, error);
    case UNION: return dem_balls_union(m->work->pack.balls, m->work->pack.count, &m->balls, error);
    default:
        return m->surface_triangles ? dem_mesh_decimate(m->mesh, m->surface_triangles, &m->work->surface, error)
                                    : DEM_OK;
    }
}

// the clump's errors and shape, the union of its balls, and the surface in the frame of the mesh
static dem_status measure(const dem_ctx *ctx, const dem_mesh *mesh, const dem_make_options *options, make_work *work,
                          dem_clump_def *def, dem_union *balls, dem_error *error)
{
    int threads = dem_threads(ctx);
    measuring m = {.mesh = mesh, .surface_triangles = options->surface_triangles, .work = work};
    dem_status status =
        dem_fidelity_begin(mesh, work->pack.balls, work->pack.count, 0, &def->fidelity, &m.fidelity, error);
    if (status == DEM_OK)
        status = dem_shape_begin(mesh, &def->shape, &m.shape, error);
    if (status == DEM_OK) {
#pragma omp parallel for num_threads(threads) schedule(dynamic, 1) if (threads > 1)
        for (int part = 0; part < MEASURES; part++)
            m.status[part] = measure_one(&m, part, &m.error[part]);
        for (int part = 0; part < MEASURES && status == DEM_OK; part++)
            if ((status = m.status[part]) != DEM_OK && error)
                *error = m.error[part];
    }
    dem_fidelity_end(&m.fidelity);
    dem_shape_end(ctx, &m.shape);
    *balls = m.balls;
    return status;
}

static dem_status make(const dem_ctx *ctx, const dem_mesh *mesh, const dem_make_options *options, make_work *work,
                       dem_clump **clump, dem_error *error)
{
    dem_pack_options packing = options->pack;
    DEM_TRY(dem_pack_complete(&packing, error));
    dem_clump_def def = {.name = options->name,
                         .source_mesh = options->source_mesh,
                         .source_sha256 = options->source_sha256,
                         .source_unit = options->source_unit,
                         .method = packing.method,
                         .seed = packing.seed,
                         .version = DEM_VERSION};
    dem_union balls;
    dem_laps laps;
    dem_laps_begin(&laps);
    DEM_TRY(dem_clump_pack(ctx, mesh, &packing, &work->pack, error));
    dem_laps_end(&laps, "packing");
    DEM_TRY(measure(ctx, mesh, options, work, &def, &balls, error));
    dem_solid solid = dem_mesh_solid(mesh);
    set_mass(&def, &solid, &balls, options);
    surface_to_clump_frame(&def, &work->surface);
    dem_laps_end(&laps, "measuring");
    dem_laps_log(&laps, ctx, "clump");

    work->balls = dem_alloc(work->pack.count, sizeof *work->balls);
    if (!work->balls)
        return dem_fail_memory(error);
    for (size_t i = 0; i < work->pack.count; i++) {
        work->balls[i] = work->pack.balls[i];
        to_clump_frame(&work->balls[i].centre, def.position, def.orientation);
    }
    write_parameters(&work->parameters, &packing, &work->pack);
    if (work->parameters.failed)
        return dem_fail_memory(error);
    def.balls = work->balls;
    def.ball_count = work->pack.count;
    def.surface = work->surface;
    def.parameters = work->parameters.data;
    def.seconds = work->pack.seconds;
    return dem_clump_create(&def, clump, error);
}

dem_status dem_clump_make(const dem_ctx *ctx, const dem_mesh *mesh, const dem_make_options *options,
                          dem_clump **clump, dem_pack *pack, dem_error *error)
{
    make_work work = {0};
    *clump = NULL;
    if (!(options->density > 0) || !isfinite(options->density))
        return dem_fail(error, DEM_USAGE, "the density is %g kg/m3; give a positive one", options->density);
    dem_status status = make(ctx, mesh, options, &work, clump, error);
    if (pack) {
        *pack = work.pack;
        work.pack = (dem_pack){0};
    }
    dem_pack_free(&work.pack);
    dem_mesh_free(&work.surface);
    dem_buffer_release(&work.parameters);
    free(work.balls);
    return status;
}
