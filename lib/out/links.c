#include "out/links.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "base/memory.h"
#include "math/quat.h"
#include "out/pvd.h"
#include "out/vtp_read.h"

enum { SIDES = 10 };                  // of a rod
static const double THICKEST = 0.28;  // radius of the rod of the largest force, over the mean length of rods
static const double SLENDER = 0.004, STEP = 1.18;  // radius over length of the first shape, and its growth

// ---- rods

// a rod of length 1 along z about the origin
static dem_status make_rod(double radius, dem_clump **rod, dem_error *error)
{
    dem_vec3 vertices[2 * SIDES + 2];
    uint32_t triangles[3 * 4 * SIDES];
    for (uint32_t i = 0; i < SIDES; i++) {
        double a = 2 * DEM_PI * i / SIDES;
        uint32_t next = (i + 1) % SIDES;
        vertices[i] = v3(radius * cos(a), radius * sin(a), -0.5);
        vertices[SIDES + i] = v3(vertices[i].x, vertices[i].y, 0.5);
        const uint32_t corners[12] = {i,         next, SIDES + i, next,          SIDES + next, SIDES + i,
                                      2 * SIDES, next, i,         2 * SIDES + 1, SIDES + i,    SIDES + next};
        memcpy(triangles + 12 * i, corners, sizeof corners);
    }
    vertices[2 * SIDES] = v3(0, 0, -0.5);
    vertices[2 * SIDES + 1] = v3(0, 0, 0.5);
    const dem_ball ball = {{0, 0, 0}, 0.5};
    const dem_clump_def def = {
        .name = "rod",
        .density = 1,
        .mass = 1,
        .volume = 1,
        .inertia = {1, 1, 1},
        .balls = &ball,
        .ball_count = 1,
        .orientation = {1, 0, 0, 0},
        .surface = {.vertices = vertices,
                    .triangles = triangles,
                    .vertex_count = 2 * SIDES + 2,
                    .triangle_count = 4 * SIDES},
        .parameters = "{}",
        .union_volume = NAN,
        .union_centre = {NAN, NAN, NAN},
        .union_inertia = {NAN, NAN, NAN},
        .seconds = NAN,
    };
    return dem_clump_create(&def, rod, error);
}

static dem_quat turn_to(dem_vec3 direction)
{
    dem_vec3 a = v3_normal_to(direction);
    return dem_quat_from_axes(a, v3_cross(direction, a), direction);
}

// ---- the file

typedef struct columns {
    const dem_vec3 *force;
    const int32_t *body, *other, *wall;
} columns;

static dem_status find_columns(const char *path, const dem_vtp *v, columns *c, dem_error *error)
{
    *c = (columns){dem_vtp_cells(v, "force", DEM_VTP_FLOAT64, 3), dem_vtp_cells(v, "body", DEM_VTP_INT32, 1),
                   dem_vtp_cells(v, "other", DEM_VTP_INT32, 1), dem_vtp_cells(v, "wall", DEM_VTP_INT32, 1)};
    bool finite = true;
    for (size_t i = 0; i < v->point_count; i++)
        finite = finite && isfinite(v3_norm2(v->points[i]));
    if (c->force && c->body && c->other && c->wall && finite && !v->vertices && !v->triangle_count)
        return DEM_OK;
    return dem_fail_at(error, DEM_BAD_INPUT, path, 0, "is no network of contacts; name one as dem-run writes it");
}

// takes the next line and those of the same pair behind it; the force is that of all
static size_t take_pair(const dem_vtp *v, const columns *c, size_t at, dem_vec3 *force)
{
    size_t i = at;
    *force = v3(0, 0, 0);
    for (; i < v->line_count && c->body[i] == c->body[at] && c->other[i] == c->other[at] && c->wall[i] == c->wall[at];
         i++)
        *force = v3_add(*force, c->force[i]);
    return i;
}

static bool make_room(dem_links *l, size_t n)
{
    dem_body_view *b = &l->bodies;
    *b = (dem_body_view){.shape = dem_alloc_zero(n, sizeof *b->shape),
                         .scale = dem_alloc_zero(n, sizeof *b->scale),
                         .position = dem_alloc_zero(n, sizeof *b->position),
                         .orientation = dem_alloc_zero(n, sizeof *b->orientation)};
    l->force = dem_alloc_zero(n, sizeof *l->force);
    return b->shape && b->scale && b->position && b->orientation && l->force;
}

// one rod a pair, not yet with its thickness; returns the mean length
static double place_rods(dem_links *l, const dem_vtp *v, const columns *c)
{
    // columns of a view are const, though these are ours
    double *scale = (double *)l->bodies.scale, sum = 0;
    dem_vec3 *position = (dem_vec3 *)l->bodies.position, force;
    dem_quat *orientation = (dem_quat *)l->bodies.orientation;
    for (size_t at = 0; at < v->line_count;) {
        const uint32_t *ends = v->lines + 2 * at;
        dem_vec3 a = v->points[ends[0]], b = v->points[ends[1]];
        size_t i = l->bodies.count, next = take_pair(v, c, at, &force);
        at = next;
        if (!(v3_distance(a, b) > 0) || !isfinite(v3_norm(force)))
            continue;
        l->bodies.count++;
        l->force[i] = v3_norm(force);
        scale[i] = v3_distance(a, b);
        position[i] = v3_scale(v3_add(a, b), 0.5);
        orientation[i] = turn_to(v3_unit(v3_sub(b, a)));
        sum += scale[i];
    }
    return l->bodies.count ? sum / (double)l->bodies.count : 0;
}

static void choose_rods(dem_links *l, double mean)
{
    uint32_t *shape = (uint32_t *)l->bodies.shape;
    double most = 0;
    for (size_t i = 0; i < l->bodies.count; i++)
        most = fmax(most, l->force[i]);
    for (size_t i = 0; i < l->bodies.count; i++) {
        double radius = most > 0 ? THICKEST * mean * sqrt(l->force[i] / most) : 0;
        double step = log(fmax(radius / l->bodies.scale[i], SLENDER) / SLENDER) / log(STEP);
        shape[i] = (uint32_t)fmin(round(step), DEM_LINK_SHAPES - 1);
    }
}

static dem_status read_file(const char *path, dem_links *l, dem_error *error)
{
    dem_vtp_file file;
    columns c;
    DEM_TRY(dem_vtp_read(path, &file, error));
    dem_status status = find_columns(path, &file.vtp, &c, error);
    if (status == DEM_OK && !make_room(l, file.vtp.line_count))
        status = dem_fail_memory(error);
    if (status == DEM_OK)
        choose_rods(l, place_rods(l, &file.vtp, &c));
    dem_vtp_file_release(&file);
    return status;
}

dem_status dem_links_read(const char *directory, double time, dem_links *l, dem_error *error)
{
    dem_pvd index;
    dem_links_release(l);
    DEM_TRY(dem_pvd_open(directory, "contacts.pvd", INFINITY, &index, error));
    const dem_pvd_entry *entry = dem_pvd_nearest(&index, time);
    dem_status status = DEM_OK;
    if (!entry)
        status = dem_fail_at(error, DEM_BAD_INPUT, directory, 0,
                             "has no network of contacts; give the scene an interval of contacts (output.contacts)");
    char *path = status == DEM_OK ? dem_path_join(directory, "%s", entry->files[0]) : NULL;
    if (status == DEM_OK)
        status = path ? read_file(path, l, error) : dem_fail_memory(error);
    if (status == DEM_OK)
        l->time = entry->time;
    for (int i = 0; i < DEM_LINK_SHAPES && status == DEM_OK; i++)
        status = make_rod(SLENDER * pow(STEP, i), &l->shapes[i], error);
    free(path);
    dem_pvd_release(&index);
    return status;
}

void dem_links_release(dem_links *l)
{
    const void *all[] = {l->bodies.shape, l->bodies.scale, l->bodies.position, l->bodies.orientation, l->force};
    for (size_t i = 0; i < sizeof all / sizeof *all; i++)
        free((void *)all[i]);
    for (int i = 0; i < DEM_LINK_SHAPES; i++)
        dem_clump_destroy(l->shapes[i]);
    *l = (dem_links){0};
}
