#include "out/results.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/file.h"
#include "base/json.h"
#include "base/memory.h"
#include "base/status.h"
#include "math/quat.h"
#include "out/frames.h"
#include "sim/bodies_csv.h"
#include "sim/place.h"
#include "sim/scene.h"
#include "sim/walls.h"

// the scene of run.json; its bodies are those of final.csv
static dem_status read_scene(const dem_ctx *ctx, const char *path, dem_results *r, dem_error *error)
{
    dem_buffer text;
    dem_json *root;
    DEM_TRY(dem_file_read(path, &text, error));
    dem_status status = dem_json_parse(text.data, text.size, path, &root, error);
    dem_buffer_release(&text);
    DEM_TRY(status);
    char *scene = dem_json_text(dem_json_member(root, "scene"));
    if (!dem_json_number(dem_json_member(root, "time"), &r->end))
        r->end = NAN;
    dem_json_release(root);
    if (!scene)
        return dem_fail_at(error, DEM_BAD_INPUT, path, 0, "holds no scene; name the output directory of dem-run");
    status = dem_scene_read_text(ctx, scene, strlen(scene), path, "/", (const char *[]){"bodies=[]", "bonds={}", NULL}, &r->scene,
                                 error);
    free(scene);
    return status;
}

static dem_status make_clumps(dem_results *r, dem_error *error)
{
    r->clumps = dem_alloc_zero(r->scene.shape_count, sizeof *r->clumps);
    r->diameters = dem_alloc(r->scene.shape_count, sizeof *r->diameters);
    if (!r->clumps || !r->diameters)
        return dem_fail_memory(error);
    for (size_t i = 0; i < r->scene.shape_count; i++) {
        const dem_clump *clump = r->scene.shapes[i].clump;
        if (!clump) {
            DEM_TRY(dem_sphere_clump(&r->scene, i, &r->clumps[i], error));
        } else {
            r->clumps[i] = malloc(dem_clump_bytes(clump));
            if (!r->clumps[i])
                return dem_fail_memory(error);
            memcpy(r->clumps[i], clump, dem_clump_bytes(clump));
        }
        r->diameters[i] = cbrt(6 * dem_clump_view(r->clumps[i]).volume / DEM_PI);
    }
    return DEM_OK;
}

// ---- bodies

// fields of a view are const, though what we read is ours
static void release_bodies(dem_results *r)
{
    const dem_body_view *b = &r->bodies;
    const void *all[] = {b->shape,       b->scale,    b->mass, b->position,
                         b->orientation, b->velocity, b->spin, b->coordination,
                         b->id};
    for (size_t i = 0; i < sizeof all / sizeof *all; i++)
        free((void *)all[i]);
    r->bodies = (dem_body_view){0};
    r->time = NAN;
    dem_vtp_file_release(&r->frame);
}

typedef struct columns {
    uint32_t *shape;
    double *scale, *mass;
    dem_vec3 *position, *velocity, *spin;
    dem_quat *orientation;
    uint32_t *coordination;
} columns;

static dem_status make_columns(dem_results *r, size_t n, columns *c, dem_error *error)
{
    *c =
        (columns){dem_alloc(n, sizeof *c->shape),      dem_alloc(n, sizeof *c->scale),    dem_alloc(n, sizeof *c->mass),
                  dem_alloc(n, sizeof *c->position),   dem_alloc(n, sizeof *c->velocity), dem_alloc(n, sizeof *c->spin),
                  dem_alloc(n, sizeof *c->orientation),
                   NULL};
    r->bodies = (dem_body_view){.count = n,
                                .shape = c->shape,
                                .scale = c->scale,
                                .mass = c->mass,
                                .position = c->position,
                                .velocity = c->velocity,
                                .spin = c->spin,
                                .orientation = c->orientation};
    if (!c->shape || !c->scale || !c->mass || !c->position || !c->velocity || !c->spin || !c->orientation)
        return dem_fail_memory(error);
    return DEM_OK;
}

// of the frame that was read, or the last one before a state that is none
static dem_vec3 shift_of(const dem_results *r, size_t wall)
{
    const dem_vtp *v = &r->frame.vtp;
    for (size_t i = 0; i < v->field_count; i++)
        if (strcmp(v->fields[i].name, DEM_WALL_SHIFTS) == 0 && v->fields[i].type == DEM_VTP_FLOAT64 &&
            v->fields[i].width == 3 * (int)r->scene.wall_count)
            return ((const dem_vec3 *)v->fields[i].data)[wall];
    return v3(0, 0, 0);
}

static void release_walls(dem_results *r)
{
    for (size_t i = 0; r->worn && i < r->scene.wall_count; i++)
        free(r->worn[i]);
    free(r->worn);
    free(r->walls);
    r->worn = NULL;
    r->walls = NULL;
}

// the triangles of all walls follow each other in the file
static dem_status take_wear(dem_results *r, const dem_vtp *v, dem_error *error)
{
    const int32_t *number = dem_vtp_cells(v, "wall", DEM_VTP_INT32, 1);
    const double *volume = dem_vtp_cells(v, "wear_volume", DEM_VTP_FLOAT64, 1);
    for (size_t begin = 0, end; number && volume && begin < v->triangle_count; begin = end) {
        size_t wall = (size_t)number[begin];
        for (end = begin + 1; end < v->triangle_count && number[end] == number[begin];)
            end++;
        if (number[begin] < 0 || wall >= r->scene.wall_count || r->worn[wall] ||
            r->scene.walls[wall].wear.law == DEM_WEAR_NONE)
            continue;
        r->worn[wall] = dem_alloc(end - begin, sizeof **r->worn);
        if (!r->worn[wall])
            return dem_fail_memory(error);
        memcpy(r->worn[wall], volume + begin, (end - begin) * sizeof *volume);
        r->walls[wall].wear = r->worn[wall];
        r->walls[wall].wear_count = end - begin;
        for (size_t t = begin; t < end; t++)
            r->walls[wall].worn += volume[t];
    }
    return DEM_OK;
}

dem_status dem_results_wear(dem_results *r, dem_error *error)
{
    dem_pvd index;
    dem_vtp_file file;
    DEM_TRY(dem_pvd_open(r->directory, "walls.pvd", INFINITY, &index, error));
    const dem_pvd_entry *entry = dem_pvd_nearest(&index, r->time);
    dem_status status = DEM_OK;
    for (int k = 0; entry && k < DEM_PVD_PARTS && status == DEM_OK; k++) {
        if (!entry->files[k][0])
            continue;
        char *path = dem_path_join(r->directory, "%s", entry->files[k]);
        status = path ? dem_vtp_read(path, &file, error) : dem_fail_memory(error);
        free(path);
        if (status != DEM_OK)
            break;
        status = take_wear(r, &file.vtp, error);
        dem_vtp_file_release(&file);
    }
    dem_pvd_release(&index);
    return status;
}

static dem_status place_walls(dem_results *r, dem_error *error)
{
    release_walls(r);
    r->walls = dem_alloc_zero(r->scene.wall_count, sizeof *r->walls);
    r->worn = dem_alloc_zero(r->scene.wall_count, sizeof *r->worn);
    if (!r->walls || !r->worn)
        return dem_fail_memory(error);
    for (size_t i = 0; i < r->scene.wall_count; i++) {
        const dem_wall_def *w = &r->scene.walls[i];
        double time = isfinite(r->time) ? r->time : 0;
        dem_wall_motion motion = dem_wall_motion_of(w);
        dem_wall_moment now = dem_wall_motion_at(&motion, time);
        r->walls[i].position = dem_wall_pose(&motion, &now, shift_of(r, i), &r->walls[i].orientation);
    }
    return DEM_OK;
}

static dem_status fill_view(dem_results *r, const dem_body_def *defs, size_t n, dem_error *error)
{
    columns c;
    DEM_TRY(make_columns(r, n, &c, error));
    for (size_t i = 0; i < n; i++) {
        const dem_body_def *d = &defs[i];
        c.shape[i] = d->shape;
        c.scale[i] = d->scale;
        c.mass[i] = dem_clump_view(r->clumps[d->shape]).mass * d->scale * d->scale * d->scale;
        c.position[i] = d->position;
        c.velocity[i] = d->velocity;
        c.spin[i] = d->spin;
        c.orientation[i] = d->orientation;
    }
    return DEM_OK;
}

static dem_status read_final(const char *path, dem_results *r, dem_error *error)
{
    dem_buffer text;
    dem_body_def *defs = NULL;
    size_t count = 0, capacity = 0;
    DEM_TRY(dem_file_read(path, &text, error));
    dem_status status = dem_bodies_csv_parse(text.data, text.size, path, r->scene.shapes, r->scene.shape_count, &defs,
                                             &count, &capacity, error);
    if (status == DEM_OK)
        status = fill_view(r, defs, count, error);
    dem_buffer_release(&text);
    free(defs);
    r->time = r->end;
    return status;
}

// ---- frames

// a number of a body of a frame that cannot be
static dem_status refuse(const char *path, const char *what, size_t body, dem_error *error)
{
    return dem_fail_at(error, DEM_BAD_INPUT, path, 0,
                       "%s of body %zu does not fit this run; take a frame of the run itself", what, body);
}

static dem_status fill_frame(dem_results *r, const char *path, dem_error *error)
{
    const dem_vtp *v = &r->frame.vtp;
    static const struct {
        const char *name;
        dem_vtp_type type;
        int width;
    } wanted[] = {{"orientation", DEM_VTP_FLOAT32, 4},      {"scale", DEM_VTP_FLOAT64, 1},
                  {"template", DEM_VTP_INT32, 1},           {"velocity", DEM_VTP_FLOAT64, 3},
                  {"angular_velocity", DEM_VTP_FLOAT64, 3}, {"mass", DEM_VTP_FLOAT64, 1},
                  {"coordination", DEM_VTP_UINT32, 1}};
    enum { ARRAYS = sizeof wanted / sizeof *wanted };
    const void *data[ARRAYS];
    for (size_t i = 0; i < ARRAYS; i++) {
        const dem_vtp_array *a = dem_vtp_find(v, wanted[i].name);
        if (!a || a->type != wanted[i].type || a->width != wanted[i].width)
            return dem_fail_at(error, DEM_BAD_INPUT, path, 0, "holds no %s of bodies; name a frame of dem-run",
                               wanted[i].name);
        data[i] = a->data;
    }
    size_t n = v->point_count;
    columns c;
    DEM_TRY(make_columns(r, n, &c, error));
    const dem_vtp_array *ids = dem_vtp_find(v, "id");
    if (ids && ids->type == DEM_VTP_UINT32 && ids->width == 1) {
        uint32_t *id = dem_alloc(n, sizeof *id);
        r->bodies.id = id;
        if (!id)
            return dem_fail_memory(error);
        memcpy(id, ids->data, n * sizeof *id);
    }
    r->bodies.coordination = c.coordination = dem_alloc(n, sizeof *c.coordination);
    if (!c.coordination)
        return dem_fail_memory(error);
    memcpy(c.position, v->points, n * sizeof *c.position);
    memcpy(c.scale, data[1], n * sizeof *c.scale);
    memcpy(c.shape, data[2], n * sizeof *c.shape);
    memcpy(c.velocity, data[3], n * sizeof *c.velocity);
    memcpy(c.spin, data[4], n * sizeof *c.spin);
    memcpy(c.mass, data[5], n * sizeof *c.mass);
    memcpy(c.coordination, data[6], n * sizeof *c.coordination);
    for (size_t i = 0; i < n; i++) {
        const float *q = (const float *)data[0] + 4 * i;
        dem_quat turn = {(double)q[0], (double)q[1], (double)q[2], (double)q[3]};
        double norm2 = turn.w * turn.w + turn.x * turn.x + turn.y * turn.y + turn.z * turn.z;
        if (!(fabs(norm2 - 1) < 1e-3))
            return refuse(path, "the orientation", i, error);
        if (c.shape[i] >= r->scene.shape_count)
            return refuse(path, "the template", i, error);
        if (!(c.scale[i] > 0 && isfinite(c.scale[i])))
            return refuse(path, "the scale", i, error);
        if (!isfinite(v3_norm2(c.position[i])))
            return refuse(path, "the position", i, error);
        c.orientation[i] = quat_unit(turn);
    }
    return DEM_OK;
}

dem_status dem_results_frame_file(dem_results *r, const char *path, dem_error *error)
{
    release_bodies(r);
    DEM_TRY(dem_vtp_read(path, &r->frame, error));
    DEM_TRY(fill_frame(r, path, error));
    r->time = r->frame.vtp.time;
    return place_walls(r, error);
}

dem_status dem_results_frame(dem_results *r, size_t index, dem_error *error)
{
    if (index >= r->index.count)
        return dem_fail_at(error, DEM_USAGE, r->directory, 0, "has no frame %zu; it has %zu, counted from 0", index,
                           r->index.count);
    char *path = dem_path_join(r->directory, "%s", r->index.entries[index].files[0]);
    dem_status status = path ? dem_results_frame_file(r, path, error) : dem_fail_memory(error);
    free(path);
    return status;
}

dem_status dem_results_at(const dem_results *r, double time, size_t *index, dem_error *error)
{
    const dem_pvd_entry *e = r->index.entries;
    size_t n = r->index.count;
    if (n == 0)
        return dem_fail_at(error, DEM_BAD_INPUT, r->directory, 0,
                           "has no frames; give the scene an interval of frames (output.frames)");
    size_t best = (size_t)(dem_pvd_nearest(&r->index, time) - e);
    double gap = n == 1 ? 0 : best > 0 ? e[best].time - e[best - 1].time : e[1].time - e[0].time;
    if (!(fabs(e[best].time - time) <= 0.5001 * gap + 1e-9 * fabs(time))) {
        char asked[40], first[40], last[40];
        return dem_fail_at(error, DEM_USAGE, r->directory, 0, "has no frame near %s s; take a time from %s s to %s s",
                           dem_format_double(asked, sizeof asked, time, 6),
                           dem_format_double(first, sizeof first, e[0].time, 6),
                           dem_format_double(last, sizeof last, e[n - 1].time, 6));
    }
    *index = best;
    return DEM_OK;
}

// ---- the run

dem_status dem_results_open(const dem_ctx *ctx, const char *directory, dem_results *r, dem_error *error)
{
    *r = (dem_results){.directory = strdup(directory), .end = NAN, .time = NAN};
    char *run = dem_path_join(directory, "run.json");
    dem_status status = run && r->directory ? read_scene(ctx, run, r, error) : dem_fail_memory(error);
    free(run);
    DEM_TRY(status);
    DEM_TRY(make_clumps(r, error));
    return dem_pvd_open(directory, "run.pvd", INFINITY, &r->index, error);
}

dem_status dem_results_last(dem_results *r, dem_error *error)
{
    size_t n = r->index.count;
    char *final = dem_path_join(r->directory, "final.csv");
    if (!final)
        return dem_fail_memory(error);
    bool whole = access(final, F_OK) == 0;  // a run that was stopped has none
    double last = n ? r->index.entries[n - 1].time : NAN;
    dem_status status;
    // only frames know where servo walls are
    bool servo = false;
    for (size_t i = 0; i < r->scene.wall_count; i++)
        servo |= r->scene.walls[i].servo.on;
    if (n && (!whole || servo || fabs(last - r->end) <= 1e-9 * fabs(r->end))) {
        status = dem_results_frame(r, n - 1, error);
    } else {
        release_bodies(r);
        status = read_final(final, r, error);
        if (status == DEM_OK)
            status = place_walls(r, error);
    }
    free(final);
    return status;
}

dem_status dem_results_read(const dem_ctx *ctx, const char *directory, dem_results *r, dem_error *error)
{
    DEM_TRY(dem_results_open(ctx, directory, r, error));
    return dem_results_last(r, error);
}

void dem_results_release(dem_results *r)
{
    for (size_t i = 0; r->clumps && i < r->scene.shape_count; i++)
        dem_clump_destroy(r->clumps[i]);
    release_bodies(r);
    free(r->clumps);
    free(r->diameters);
    release_walls(r);
    free(r->directory);
    dem_pvd_release(&r->index);
    dem_scene_release(&r->scene);
    *r = (dem_results){0};
}
