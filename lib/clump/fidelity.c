// Everything is measured in a frame of the grain's own: centre of mass at 0, d_eq = 1, turned by a fixed generic
// rotation, so that no flat face of the grain lies along the lines.
#include "clump/fidelity.h"

#include <stdlib.h>

#include "base/memory.h"
#include "clump/deviation.h"
#include "geom/boundary.h"
#include "geom/tree.h"
#include "math/quat.h"

enum { FIRST_LINES = 16000, MOST_LINES = 1024000, SAMPLES = 20000, SAMPLES_PER_BALL = 50, MOST_SAMPLES = 500000 };
#define GAP_ERROR 0.005  // standard error of the gap where it may be chosen, relative [-]

static const dem_quat TURN = {0.74, 0.36, -0.42, 0.38};  // nothing special about it

static void subject_release(dem_fidelity_work *s)
{
    free(s->vertices);
    free(s->balls);
    *s = (dem_fidelity_work){0};
}

static dem_status subject_make(dem_fidelity_work *s, const dem_mesh *mesh, const dem_ball *balls, size_t count,
                               dem_error *error)
{
    *s = (dem_fidelity_work){0};
    if (mesh->triangle_count == 0 || count == 0)
        return dem_fail(error, DEM_USAGE, "nothing to compare; give a mesh with faces and at least one sphere");
    DEM_TRY(dem_balls_check(balls, count, error));
    s->solid = dem_mesh_solid(mesh);
    s->size = cbrt(6 / DEM_PI * s->solid.volume);
    if (!(s->size > 0) || !isfinite(s->size))
        return dem_fail(error, DEM_BAD_INPUT, "the mesh encloses no volume; repair it first");
    s->vertices = dem_alloc(mesh->vertex_count, sizeof *s->vertices);
    s->balls = dem_alloc(count, sizeof *s->balls);
    if (!s->vertices || !s->balls) {
        subject_release(s);
        return dem_fail_memory(error);
    }
    dem_quat turn = quat_unit(TURN);
    for (size_t i = 0; i < mesh->vertex_count; i++)
        s->vertices[i] = quat_rotate(turn, v3_scale(v3_sub(mesh->vertices[i], s->solid.centre), 1 / s->size));
    for (size_t i = 0; i < count; i++) {
        dem_vec3 c = quat_rotate(turn, v3_scale(v3_sub(balls[i].centre, s->solid.centre), 1 / s->size));
        s->balls[i] = (dem_ball){c, balls[i].radius / s->size};
    }
    s->bodies =
        (dem_line_bodies){s->vertices, mesh->triangles, mesh->vertex_count, mesh->triangle_count, s->balls, count};
    return DEM_OK;
}

// symmetric difference of mesh and union, and the standard error of it, from about `lines` lines in each bundle
static dem_status difference(const dem_fidelity_work *s, double lines, int threads, double *volume, double *deviation,
                             dem_error *error)
{
    static const dem_vec3 axes[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    // a closed surface shows a quarter of its area to a random direction, twice if it is convex
    double area = s->solid.area / (s->size * s->size), variance = 0;
    *volume = 0;
    for (int k = 0; k < 3; k++) {
        dem_bundle_volumes groups[DEM_LINE_GROUPS];
        dem_line_bundle bundle = {{axes[k], axes[(k + 1) % 3], axes[(k + 2) % 3]}, sqrt(area / 4 / lines)};
        DEM_TRY(dem_line_bundle_measure(&s->bodies, &bundle, threads, groups, error));
        double mean = 0, square = 0;
        for (int g = 0; g < DEM_LINE_GROUPS; g++) {
            // lines where the mesh is open are left out; the others stand for them
            double heard = 1 - (double)groups[g].broken / fmax(1, (double)groups[g].lines);
            double only = (groups[g].mesh + groups[g].balls - 2 * groups[g].both) / fmax(heard, 0.1);
            mean += only / DEM_LINE_GROUPS;
            square += only * only / DEM_LINE_GROUPS;
        }
        *volume += mean / 3;
        variance += fmax(0, square - mean * mean) / (DEM_LINE_GROUPS - 1) / 9;
    }
    *deviation = sqrt(variance);
    return DEM_OK;
}

// the volume where the two differ and its standard error, relative
static dem_status difference_settled(const dem_fidelity_work *s, size_t lines, int threads, double *volume,
                                     double *error_estimate, dem_error *error)
{
    double deviation, count = lines ? (double)lines : FIRST_LINES;
    DEM_TRY(difference(s, count, threads, volume, &deviation, error));
    while (!lines && deviation > GAP_ERROR * *volume && count < MOST_LINES) {
        count *= fmin(8, fmax(2, pow(deviation / (GAP_ERROR * *volume), 1.5)));
        DEM_TRY(difference(s, count, threads, volume, &deviation, error));
    }
    *error_estimate = *volume > 0 ? deviation / *volume : 0;
    return DEM_OK;
}

// the volumes of both are exact, the lines only measure where they differ
static double gap_of(double difference_volume, double union_volume)
{
    return difference_volume / ((DEM_PI / 6 + union_volume + difference_volume) / 2);
}

dem_status dem_fidelity_gap(const dem_ctx *ctx, const dem_mesh *mesh, const dem_ball *balls, size_t count, size_t lines,
                            double *gap, double *error_estimate, dem_error *error)
{
    dem_fidelity_work s;
    dem_ball_union whole;
    double volume, spread;
    DEM_TRY(subject_make(&s, mesh, balls, count, error));
    dem_status status = dem_ball_union_compute(s.balls, count, false, 1, &whole, error);
    if (status == DEM_OK) {
        status = difference_settled(&s, lines, dem_threads(ctx), &volume, &spread, error);
        if (status == DEM_OK) {
            *gap = gap_of(volume, whole.moments.volume);
            if (error_estimate)
                *error_estimate = spread;
        }
        dem_ball_union_release(&whole);
    }
    subject_release(&s);
    return status;
}

// the figures of the exact solids
static void masses_compare(const dem_fidelity_work *s, const dem_ball_union *whole, dem_fidelity *f)
{
    dem_solid balls = dem_solid_from_moments(whole->moments, v3(0, 0, 0), whole->area);
    double mesh_volume = DEM_PI / 6, sum = 0, scale = pow(s->size, 5);
    f->volume_error = balls.volume / mesh_volume - 1;
    f->centre_offset = v3_norm(balls.centre);
    f->inertia_error = 0;
    for (int k = 0; k < 3; k++)
        f->inertia_error = fmax(f->inertia_error, fabs(balls.principal[k] * scale / s->solid.principal[k] - 1));
    for (size_t i = 0; i < s->bodies.ball_count; i++)
        sum += 4 * DEM_PI / 3 * pow(s->balls[i].radius, 3);
    f->overlap_ratio = sum / balls.volume;
    f->pieces = dem_ball_pieces(s->balls, s->bodies.ball_count, 0, NULL);
}

// masses and distances
static dem_status surfaces_compare(dem_fidelity_work *s, int threads, dem_error *error)
{
    dem_boundary boundary;
    dem_tree tree;
    dem_deviation d;
    dem_fidelity *f = s->fidelity;
    size_t count = s->bodies.ball_count;
    DEM_TRY(dem_boundary_build(&boundary, s->balls, count, error));
    s->union_volume = boundary.whole.moments.volume;
    masses_compare(s, &boundary.whole, f);
    dem_status status = f->pieces ? DEM_OK : dem_fail_memory(error);
    if (status == DEM_OK)
        status = dem_tree_build(&tree, s->vertices, s->bodies.triangles, s->bodies.triangle_count, error);
    if (status == DEM_OK) {
        // small patches need denser samples
        size_t points = count < MOST_SAMPLES / SAMPLES_PER_BALL ? count * SAMPLES_PER_BALL : MOST_SAMPLES;
        points = s->samples ? s->samples : points > SAMPLES ? points : SAMPLES;
        status = dem_deviation_measure(&tree, &boundary, points, threads, &d, error);
        dem_tree_release(&tree);
    }
    if (status == DEM_OK) {
        f->distance_mean = (d.mesh_mean + d.union_mean) / 2;
        f->distance_max = d.largest;
        f->protrusion = d.protrusion;
        f->normal_deviation_deg = d.normal_deg;
    }
    dem_boundary_release(&boundary);
    return status;
}

dem_status dem_fidelity_begin(const dem_mesh *mesh, const dem_ball *balls, size_t count, size_t samples,
                              dem_fidelity *fidelity, dem_fidelity_work *work, dem_error *error)
{
    *fidelity = (dem_fidelity){0};
    DEM_TRY(subject_make(work, mesh, balls, count, error));
    work->fidelity = fidelity;
    work->samples = samples;
    return DEM_OK;
}

dem_status dem_fidelity_part(dem_fidelity_work *work, int part, int threads, dem_error *error)
{
    double spread;
    return part == DEM_FIDELITY_GAP
               ? difference_settled(work, work->samples, threads, &work->difference, &spread, error)
               : surfaces_compare(work, threads, error);
}

void dem_fidelity_end(dem_fidelity_work *work)
{
    if (work->fidelity)
        work->fidelity->iou_gap = gap_of(work->difference, work->union_volume);
    subject_release(work);
}

dem_status dem_fidelity_measure(const dem_ctx *ctx, const dem_mesh *mesh, const dem_ball *balls, size_t count,
                                size_t samples, dem_fidelity *fidelity, dem_error *error)
{
    dem_fidelity_work work;
    dem_status status = dem_fidelity_begin(mesh, balls, count, samples, fidelity, &work, error);
    for (int part = 0; part < DEM_FIDELITY_PARTS && status == DEM_OK; part++)
        status = dem_fidelity_part(&work, part, dem_threads(ctx), error);
    dem_fidelity_end(&work);
    return status;
}
