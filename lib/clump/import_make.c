// From what a file says to a clump of ours. Everything is first brought to SI units, then to the wanted size; mass,
// centre and inertia are the file's where it tells them, the exact union's where it does not.
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "base/json.h"
#include "base/memory.h"
#include "clump/figures.h"
#include "clump/import.h"
#include "clump/import_weigh.h"
#include "clump/make.h"
#include "math/mat3.h"
#include "math/quat.h"

static const double DENSITY_QUARTZ = 2650;   // [kg/m^3]
static const double WORTH_A_WARNING = 0.01;  // relative difference between file and union
enum { SURFACE_TRIANGLES = 2000 };

typedef struct work {
    const dem_import *import;
    const dem_import_options *options;
    dem_error *error;
    double length;  // of one unit of the file in the clump [m]
    double shrink;  // of it, for the wanted size
    dem_ball *balls;
    dem_union balls_union;  // in the frame of the file [m]
    size_t duplicates;
    // what the file says, in SI units; NAN: nothing
    double mass, volume, density, inertia[3];
    dem_vec3 centre;
    // what the clump gets
    dem_clump_def def;
    double unit_inertia[3];  // per mass [m^2]
    bool given;              // some of it is the file's
    dem_mesh mesh, surface;
    dem_buffer parameters;
} work;

dem_import_options dem_import_defaults(void)
{
    return (dem_import_options){.unit = 1, .mass_unit = 1, .unit_name = "m", .surface_triangles = SURFACE_TRIANGLES};
}

static dem_status refuse(const work *w, long line, const char *what)
{
    return dem_fail_at(w->error, DEM_BAD_INPUT, w->import->file, line, "%s", what);
}

// ---- units and size

static void to_si(work *w)
{
    const dem_import *in = w->import;
    double length = w->options->unit, mass = w->options->mass_unit;
    w->mass = in->mass * mass;
    w->volume = in->volume * length * length * length;
    w->density = in->density * mass / (length * length * length);
    w->centre = v3_scale(in->centre, length);
    for (int i = 0; i < 3; i++)
        w->inertia[i] = in->inertia[i] * length * length * (in->inertia_of_unit_mass ? 1 : mass);
    if (isnan(w->volume))
        w->volume = w->mass / w->density;
    w->length = length;
    w->shrink = 1;
}

static dem_status place_balls(work *w, double factor)
{
    for (size_t i = 0; i < w->import->count; i++) {
        dem_ball b = w->import->balls[i];
        w->balls[i] = (dem_ball){v3_scale(b.centre, factor), b.radius * factor};
        if (!(w->balls[i].radius >= 1e-60 && w->balls[i].radius <= 1e60) || !(v3_norm(w->balls[i].centre) <= 1e60))
            return refuse(w, 0, "its spheres are larger or smaller than can be computed with; check the unit");
    }
    return DEM_OK;
}

// the volume that size and density refer to, as far as it is known before a density is asked
static double reference_volume(const work *w)
{
    if (w->options->mass_from == DEM_IMPORT_MESH)
        return dem_mesh_solid(&w->mesh).volume;
    if (w->options->mass_from == DEM_IMPORT_FILE && isfinite(w->volume))
        return w->volume;
    if (w->options->mass_from == DEM_IMPORT_FILE && isfinite(w->mass) && w->options->density > 0)
        return w->mass / w->options->density;
    return w->balls_union.solid.volume;
}

// everything grows by s at the same density
static dem_status resize(work *w, double s)
{
    double cube = s * s * s, fifth = cube * s * s;
    dem_solid *u = &w->balls_union.solid;
    w->shrink = s;
    w->length *= s;
    w->mass *= cube;
    w->volume *= cube;
    w->centre = v3_scale(w->centre, s);
    u->volume *= cube;
    u->area *= s * s;
    u->centre = v3_scale(u->centre, s);
    u->inertia = sym3_scale(u->inertia, fifth);
    for (int i = 0; i < 3; i++) {
        u->principal[i] *= fifth;
        w->inertia[i] *= w->import->inertia_of_unit_mass ? s * s : fifth;
    }
    dem_mesh_scale(&w->mesh, s);
    return place_balls(w, w->length);
}

static dem_status weigh(work *w)
{
    const dem_import_options *o = w->options;
    size_t count = w->import->count;
    if (w->import->in_metres && (o->unit != 1 || o->mass_unit != 1))
        return refuse(w, 0, "says itself that it is in metres and kilograms; leave --unit and --mass-unit out");
    to_si(w);
    w->balls = dem_alloc(count, sizeof *w->balls);
    if (!w->balls)
        return dem_fail_memory(w->error);
    DEM_TRY(place_balls(w, w->length));
    DEM_TRY(dem_import_weigh(w->balls, count, &w->balls_union, &w->duplicates, w->error));
    const dem_solid *u = &w->balls_union.solid;
    if (!(u->volume > 0) || !isfinite(u->volume) || !(u->principal[0] > 0) || !isfinite(u->principal[2]))
        return refuse(w, 0, "its spheres are larger or smaller than can be computed with; check the unit");
    if (o->mesh)
        DEM_TRY(dem_mesh_copy(o->mesh, &w->mesh, w->error));
    return o->size > 0 ? resize(w, o->size / cbrt(6 / DEM_PI * reference_volume(w))) : DEM_OK;
}

// ---- mass, centre, inertia

// mass, volume and density, of which two are enough
static void choose_mass(work *w)
{
    const dem_import_options *o = w->options;
    bool file = o->mass_from == DEM_IMPORT_FILE, had_mass = isfinite(w->mass), had_volume = isfinite(w->volume);
    double volume = reference_volume(w), density = o->density, mass = o->mass;
    if (file && had_mass && !had_volume && density > 0 && !(mass > 0))
        mass = w->mass;  // a density alone leaves the file's mass and tells the volume it stands for
    if (density > 0 && mass > 0) {
        volume = file ? mass / density : volume;
        density = mass / volume;
    } else if (mass > 0) {
        density = mass / volume;
    } else {
        if (!(density > 0))
            density = isfinite(w->density) ? w->density : had_mass ? w->mass / (had_volume ? w->volume : volume) : 0;
        if (!(density > 0))
            density = DENSITY_QUARTZ;
        bool kept = file && had_mass && !(o->density > 0);
        mass = kept ? w->mass : density * volume;
        if (kept && !isfinite(w->density))
            density = mass / volume;
    }
    w->given |= file && (had_mass || had_volume);
    w->def.mass = mass;
    w->def.volume = volume;
    w->def.density = density;
}

// whose centre, axes and inertia per mass
static dem_quat choose_inertia(work *w)
{
    const dem_import *in = w->import;
    dem_import_mass from = w->options->mass_from;
    dem_solid solid = from == DEM_IMPORT_MESH ? dem_mesh_solid(&w->mesh) : w->balls_union.solid;
    if (from == DEM_IMPORT_MESH) {  // it stands in the frame that `position` leads to
        solid.centre = quat_unrotate(in->orientation, v3_sub(solid.centre, v3_scale(in->position, w->length)));
        solid.axes = quat_multiply(quat_conjugate(in->orientation), solid.axes);
    }
    bool centred = from == DEM_IMPORT_FILE && isfinite(w->centre.x);
    bool inert = from == DEM_IMPORT_FILE && isfinite(w->inertia[0]);
    double mass = in->inertia_of_unit_mass ? 1 : isfinite(w->mass) ? w->mass : w->def.mass;
    for (int i = 0; i < 3; i++)
        w->def.inertia[i] =
            inert ? w->inertia[i] * (w->def.mass / mass) : solid.principal[i] * (w->def.mass / solid.volume);
    w->def.position = centred ? w->centre : solid.centre;
    w->given |= centred || inert;
    return inert ? in->axes : solid.axes;
}

static bool is_identity(dem_vec3 p, dem_quat q)
{
    return p.x == 0 && p.y == 0 && p.z == 0 && q.w == 1 && q.x == 0 && q.y == 0 && q.z == 0;
}

// into the principal frame; a file that is in it already keeps every digit. `def` then leads to the mesh.
static void settle(work *w, dem_quat axes)
{
    const dem_import *in = w->import;
    dem_clump_def *def = &w->def;
    dem_vec3 centre = def->position, u = w->balls_union.solid.centre;
    if (!is_identity(centre, axes))
        for (size_t i = 0; i < in->count; i++)
            w->balls[i].centre = quat_unrotate(axes, v3_sub(w->balls[i].centre, centre));
    def->balls = w->balls;
    def->ball_count = in->count;
    def->union_volume = w->balls_union.solid.volume;
    def->union_centre = quat_unrotate(axes, v3_sub(u, centre));
    for (int i = 0; i < 3; i++)
        def->union_inertia[i] = def->density * w->balls_union.solid.principal[i];
    def->position = v3_add(v3_scale(in->position, w->length), quat_rotate(in->orientation, centre));
    def->orientation = is_identity(v3(0, 0, 0), axes) ? in->orientation : quat_multiply(in->orientation, axes);
}

// ---- what is odd

static double relative(double a, double b)
{
    return fabs(a - b) / fabs(b);
}

static dem_sym3 tensor_of(const double *moments, dem_quat axes, double factor)
{
    dem_sym3 t = {0};
    for (int i = 0; i < 3; i++) {
        dem_vec3 axis = quat_rotate(axes, v3(i == 0, i == 1, i == 2));
        t = sym3_add(t, sym3_scale(sym3_outer(axis), moments[i] * factor));
    }
    return t;
}

static double largest_part(dem_sym3 t)
{
    return larger(larger(larger(fabs(t.xx), fabs(t.yy)), larger(fabs(t.zz), fabs(t.xy))),
                  larger(fabs(t.xz), fabs(t.yz)));
}

// of what the clump does not take there is no need to warn
static dem_log_level importance(const work *w)
{
    return w->options->mass_from == DEM_IMPORT_FILE ? DEM_LOG_WARNING : DEM_LOG_INFO;
}

static const char *at_line(char text[32], long line)
{
    *text = 0;
    if (line > 0)
        snprintf(text, 32, "line %ld: ", line);
    return text;
}

static void warn_inertia(const work *w, double *residual)
{
    char where[32];
    const dem_import *in = w->import;
    const dem_solid *u = &w->balls_union.solid;
    double mass = in->inertia_of_unit_mass ? 1 : isfinite(w->mass) ? w->mass : w->def.mass, worst = 0;
    if (!isfinite(w->inertia[0]))
        return;
    for (int i = 0; i < 3; i++)
        worst = larger(worst, relative(w->inertia[i] / mass, u->principal[i] / u->volume));
    dem_sym3 file = tensor_of(w->inertia, in->axes, 1 / mass), balls = tensor_of(u->principal, u->axes, 1 / u->volume);
    double turned = largest_part(sym3_add(file, sym3_scale(balls, -1))) / (u->principal[2] / u->volume);
    *residual = larger(*residual, larger(worst, turned));
    if (worst > WORTH_A_WARNING)
        dem_log(in->ctx, importance(w),
                "%sits moments of inertia differ from the union's by up to %.3g %%; if they are not the grain's own, "
                "use --mass-from union",
                at_line(where, in->inertia_line), 100 * worst);
    else if (turned > WORTH_A_WARNING)
        dem_log(in->ctx, importance(w),
                "%sits inertia has the moments of the union but other axes; check the order of its components, or use "
                "--mass-from union",
                at_line(where, in->inertia_line));
}

static void warn_mass(const work *w, dem_import_report *r)
{
    const dem_ctx *ctx = w->import->ctx;
    const dem_solid *u = &w->balls_union.solid;
    char where[32];
    double size = cbrt(6 / DEM_PI * u->volume);
    double volume = isfinite(w->volume)                      ? w->volume
                    : w->options->density > 0 && w->mass > 0 ? w->mass / w->options->density
                                                             : NAN;
    if (isfinite(volume))
        r->moment_residual = relative(volume, u->volume);
    if (r->moment_residual > WORTH_A_WARNING)
        dem_log(ctx, importance(w),
                "%sits mass is %.3g %% %s than that of the union of its spheres; if it is not the grain's own, use "
                "--mass-from union",
                at_line(where, w->import->mass_line), 100 * r->moment_residual, volume > u->volume ? "more" : "less");
    r->centre_offset = v3_distance(w->centre, u->centre);
    if (r->centre_offset > WORTH_A_WARNING * size)
        dem_log(ctx, importance(w),
                "its centre of mass is %.3g %% of its size away from that of the union; if it is not the grain's own, "
                "use --mass-from union",
                100 * r->centre_offset / size);
    warn_inertia(w, &r->moment_residual);
    if (w->def.density < 1 || w->def.density > 3e4)
        dem_log(ctx, DEM_LOG_WARNING, "its density comes to %.3g kg/m3; check --unit, --mass-unit and --density",
                w->def.density);
}

static void report_and_warn(const work *w, dem_import_report *r)
{
    const dem_ctx *ctx = w->import->ctx;
    *r = (dem_import_report){.mass = w->mass,
                             .volume = w->volume,
                             .density = w->def.density,
                             .duplicates = w->duplicates,
                             .redundant = w->balls_union.redundant + w->duplicates,
                             .pieces = w->balls_union.pieces};
    double mass = w->import->inertia_of_unit_mass ? w->def.mass : 1;
    for (int i = 0; i < 3; i++)
        r->inertia[i] = w->inertia[i] * mass;
    warn_mass(w, r);
    if (w->duplicates)
        dem_log(ctx, DEM_LOG_WARNING, "%zu of its spheres stand there more than once; they are kept, and push twice",
                w->duplicates);
    if (r->pieces > 1)
        dem_log(ctx, DEM_LOG_WARNING, "its spheres make %zu pieces that do not touch; they move as one body",
                r->pieces);
    if (w->import->count == 1)
        dem_log(ctx, DEM_LOG_WARNING, "is one sphere alone; some engines take no clump below two");
}

// ---- texts, fidelity, surface

static void scale_shape(dem_shape *shape, double s)
{
    shape->equivalent_diameter *= s;
    shape->longest *= s;
    shape->intermediate *= s;
    shape->shortest *= s;
}

static void unknown_figures(dem_clump_def *def)
{
    for (int i = 0; i < DEM_FIDELITY_FIGURES; i++)
        *figure_of(&def->fidelity, &dem_fidelity_figures[i]) = NAN;
    for (int i = 0; i < DEM_SHAPE_FIGURES; i++)
        *figure_of(&def->shape, &dem_shape_figures[i]) = NAN;
}

// what is known without a mesh
static void figures_of_spheres(work *w)
{
    double sum = 0;
    for (size_t i = 0; i < w->import->count; i++)
        sum += 4 * DEM_PI / 3 * w->balls[i].radius * w->balls[i].radius * w->balls[i].radius;
    unknown_figures(&w->def);
    w->def.fidelity.overlap_ratio = sum / w->def.union_volume;
    w->def.fidelity.pieces = w->balls_union.pieces;
    w->def.seconds = NAN;
}

static dem_status measure(work *w)
{
    const dem_import *in = w->import;
    dem_clump_def *def = &w->def;
    dem_ball *placed = dem_alloc(in->count, sizeof *placed);
    if (!placed)
        return dem_fail_memory(w->error);
    for (size_t i = 0; i < in->count; i++)
        placed[i] =
            (dem_ball){v3_add(def->position, quat_rotate(def->orientation, w->balls[i].centre)), w->balls[i].radius};
    dem_status status = dem_fidelity_measure(in->ctx, &w->mesh, placed, in->count, 0, &def->fidelity, w->error);
    if (status == DEM_OK)
        status = dem_shape_measure(in->ctx, &w->mesh, &def->shape, w->error);
    if (status == DEM_OK)
        status = dem_make_surface(&w->mesh, w->options->surface_triangles, def, &w->surface, w->error);
    free(placed);
    def->surface = w->surface;
    if (status == DEM_OK && def->fidelity.iou_gap > 0.5)
        dem_log(in->ctx, DEM_LOG_WARNING,
                "the mesh and the spheres have little in common (IoU gap %.0f %%); is it in their frame, and "
                "--mesh-unit right?",
                100 * def->fidelity.iou_gap);
    return status;
}

// the surface that a clump of ours had, from its old frame to the new one
static dem_status keep_surface(work *w, const dem_clump_def *old, dem_vec3 centre, dem_quat axes)
{
    if (old->surface.triangle_count == 0)
        return DEM_OK;
    DEM_TRY(dem_mesh_copy(&old->surface, &w->surface, w->error));
    dem_mesh_scale(&w->surface, w->length);
    for (size_t i = 0; i < w->surface.vertex_count; i++)
        w->surface.vertices[i] = quat_unrotate(axes, v3_sub(w->surface.vertices[i], centre));
    w->def.surface = w->surface;
    return DEM_OK;
}

static dem_status keep_figures(work *w, const dem_clump_def *old)
{
    w->def.fidelity = old->fidelity;
    w->def.shape = old->shape;
    scale_shape(&w->def.shape, w->shrink);
    return DEM_OK;
}

static void set_texts(work *w, const char *name)
{
    const dem_import *in = w->import;
    dem_clump_def *def = &w->def;
    if (in->clump) {
        dem_clump_def old = dem_clump_view(in->clump);
        def->source_mesh = old.source_mesh, def->source_sha256 = old.source_sha256, def->source_unit = old.source_unit;
        def->method = old.method, def->parameters = old.parameters, def->version = old.version;
        def->seed = old.seed, def->seconds = old.seconds;
        def->mass_from = old.mass_from;
    } else {
        def->method = "converted";
        def->parameters = w->parameters.data;
        def->version = DEM_VERSION;
        def->mass_from = w->given ? DEM_MASS_GIVEN : DEM_MASS_FROM_UNION;
    }
    if (w->options->mass_from != DEM_IMPORT_FILE)
        def->mass_from = w->options->mass_from == DEM_IMPORT_MESH ? DEM_MASS_FROM_MESH : DEM_MASS_FROM_UNION;
    if (!in->clump || w->options->mesh) {
        def->source_mesh = w->options->source_mesh;
        def->source_sha256 = w->options->source_sha256;
        def->source_unit = w->options->unit_name;
    }
    def->name = name;
}

// a clump of ours that nothing is asked of stays as it is, to the last bit
static bool is_untouched(const dem_import *in, const dem_import_options *o)
{
    return in->clump && !o->mesh && o->mass_from == DEM_IMPORT_FILE && !(o->density > 0) && !(o->mass > 0) &&
           !(o->size > 0);
}

static dem_status build(work *w, const char *name)
{
    const dem_import *in = w->import;
    choose_mass(w);
    dem_quat axes = choose_inertia(w);
    dem_vec3 centre = w->def.position;
    settle(w, axes);
    figures_of_spheres(w);
    set_texts(w, name);
    if (w->options->mesh)
        return measure(w);
    if (!in->clump)
        return DEM_OK;
    dem_clump_def old = dem_clump_view(in->clump);
    if (is_untouched(in, w->options)) {
        old.name = name;
        w->def = old;
        return DEM_OK;
    }
    DEM_TRY(keep_figures(w, &old));
    return keep_surface(w, &old, centre, axes);
}

static void put_parameters(work *w)
{
    dem_json_writer json = dem_json_begin(&w->parameters);
    dem_json_open_object(&json, NULL);
    dem_json_put_string(&json, "format", w->import->format);
    dem_json_put_string(&json, "file", dem_file_name(w->import->file));
    dem_json_close(&json, '}');
}

dem_status dem_import_clump(const dem_import *import, const dem_import_options *options, dem_clump **clump,
                            dem_import_report *report, dem_error *error)
{
    *clump = NULL;
    work w = {.import = import, .options = options, .error = error};
    char name[256];
    dem_import_report own;
    const char *file = dem_file_name(import->file), *dot = strrchr(file, '.');
    snprintf(name, sizeof name, "%.*s", (int)(dot && dot > file ? dot - file : (long)strlen(file)), file);
    const char *named = options->name   ? options->name
                        : import->clump ? dem_clump_view(import->clump).name
                                        : import->name;
    if (options->mass_from == DEM_IMPORT_MESH && !options->mesh)
        return dem_fail(error, DEM_USAGE, "the mass is to be the mesh's, but there is none; give --mesh FILE");
    put_parameters(&w);
    dem_status status = w.parameters.failed ? dem_fail_memory(error) : weigh(&w);
    if (status == DEM_OK)
        status = build(&w, *named ? named : name);
    if (status == DEM_OK) {
        report_and_warn(&w, report ? report : &own);
        status = dem_clump_create(&w.def, clump, error);
    }
    if (status == DEM_BAD_INPUT && error && !error->file[0])
        snprintf(error->file, sizeof error->file, "%s", import->file);
    dem_buffer_release(&w.parameters);
    dem_mesh_free(&w.mesh);
    dem_mesh_free(&w.surface);
    free(w.balls);
    return status;
}
