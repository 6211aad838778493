#include "out/frames.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/file.h"
#include "base/memory.h"
#include "out/glyph.h"
#include "out/names.h"
#include "out/pvd.h"
#include "out/vtp.h"
#include "out/wall_mesh.h"
#include "sim/wall_motion.h"

static const char INDEX[] = "run.pvd", WALLS[] = "walls.pvd", STATIC[] = "walls_static.vtp";

struct dem_frames {
    dem_frames_def def;
    char *directory;
    double *radii;       // of balls about the centres of mass that hold the shapes [m]
    bool moving, still;  // there are walls that do
    dem_pvd index, walls;
};

// walls that are written with every frame
static bool changes(const dem_wall_def *wall)
{
    return dem_wall_moves(wall) || wall->wear.law != DEM_WEAR_NONE;
}

// ---- beginning

static dem_status write_shapes(const dem_frames *f, dem_error *error)
{
    dem_plain_name *names = dem_alloc(f->def.shape_count, sizeof *names);
    dem_status status = names ? DEM_OK : dem_fail_memory(error);
    for (size_t i = 0; i < f->def.shape_count && status == DEM_OK; i++) {
        names[i] = dem_name_plain(f->def.shapes[i].name, "shape", names, i);
        char *path = dem_path_join(f->directory, "shapes/%s.vtp", names[i].text);
        status = path ? dem_glyph_write(path, f->def.clumps[i], error) : dem_fail_memory(error);
        free(path);
    }
    free(names);
    return status;
}

// what an earlier run left, which would name frames that are gone
static dem_status remove_indexes(const dem_frames *f, dem_error *error)
{
    const char *const names[] = {INDEX, WALLS, STATIC};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        char *path = dem_path_join(f->directory, "%s", names[i]);
        if (!path)
            return dem_fail_memory(error);
        unlink(path);
        free(path);
    }
    return DEM_OK;
}

static dem_status make_folder(const dem_frames *f, const char *name, dem_error *error)
{
    char *path = dem_path_join(f->directory, "%s", name);
    dem_status status = path ? dem_folder_create(path, error) : dem_fail_memory(error);
    free(path);
    return status;
}

static void measure_shapes(dem_frames *f)
{
    for (size_t i = 0; i < f->def.shape_count; i++) {
        dem_clump_def clump = dem_clump_view(f->def.clumps[i]);
        f->radii[i] = 0;
        for (size_t k = 0; k < clump.ball_count; k++)
            f->radii[i] = fmax(f->radii[i], v3_norm(clump.balls[k].centre) + clump.balls[k].radius);
    }
}

static dem_status begin(dem_frames *f, dem_error *error)
{
    f->directory = strdup(f->def.directory);
    f->radii = dem_alloc(f->def.shape_count, sizeof *f->radii);
    if (!f->directory || !f->radii)
        return dem_fail_memory(error);
    measure_shapes(f);
    for (size_t i = 0; i < f->def.wall_count; i++)
        *(changes(&f->def.walls[i]) ? &f->moving : &f->still) = true;
    DEM_TRY(make_folder(f, "frames", error));
    DEM_TRY(make_folder(f, "shapes", error));
    if (f->moving)
        DEM_TRY(make_folder(f, "walls", error));
    if (isnan(f->def.resume))
        DEM_TRY(remove_indexes(f, error));
    DEM_TRY(dem_pvd_open(f->directory, INDEX, f->def.resume, &f->index, error));
    DEM_TRY(dem_pvd_open(f->directory, WALLS, f->def.resume, &f->walls, error));
    f->index.queue = f->walls.queue = f->def.queue;
    DEM_TRY(dem_pvd_remove(f->directory, "frames", "", f->index.count, error));
    DEM_TRY(dem_pvd_remove(f->directory, "walls", "", f->index.count, error));
    return write_shapes(f, error);
}

dem_status dem_frames_open(const dem_frames_def *def, dem_frames **frames, dem_error *error)
{
    *frames = dem_alloc_zero(1, sizeof **frames);
    if (!*frames)
        return dem_fail_memory(error);
    (*frames)->def = *def;
    dem_status status = begin(*frames, error);
    if (status != DEM_OK) {
        dem_frames_close(*frames);
        *frames = NULL;
    }
    return status;
}

size_t dem_frames_count(const dem_frames *f)
{
    return f->index.count;
}

void dem_frames_close(dem_frames *f)
{
    if (!f)
        return;
    dem_pvd_release(&f->index);
    dem_pvd_release(&f->walls);
    free(f->directory);
    free(f->radii);
    free(f);
}

// ---- bodies

// how far servos have brought their walls, which no function of time tells
static dem_vec3 *shifts_of(const dem_frames *f, double time, const dem_wall_view *walls)
{
    dem_vec3 *shifts = dem_alloc_zero(f->def.wall_count, sizeof *shifts);
    for (size_t i = 0; shifts && walls && i < f->def.wall_count; i++)
        if (f->def.walls[i].servo.on) {
            dem_wall_motion motion = dem_wall_motion_of(&f->def.walls[i]);
            dem_wall_moment now = dem_wall_motion_at(&motion, time);
            dem_quat turn;
            shifts[i] = v3_sub(walls[i].position, dem_wall_pose(&motion, &now, v3(0, 0, 0), &turn));
        }
    return shifts;
}

static dem_status write_bodies(const dem_frames *f, const char *path, double time, const dem_body_view *b,
                               const dem_wall_view *walls, dem_error *error)
{
    bool servo = false;
    for (size_t i = 0; i < f->def.wall_count; i++)
        servo |= f->def.walls[i].servo.on;
    dem_vec3 *shifts = shifts_of(f, time, walls);
    const dem_vtp_array field = {DEM_WALL_SHIFTS, DEM_VTP_FLOAT64, 3 * (int)f->def.wall_count, shifts};
    float *turns = dem_alloc(b->count, 4 * sizeof *turns);
    uint32_t *ids = dem_alloc(b->count, sizeof *ids);
    dem_status status = turns && ids && shifts ? DEM_OK : dem_fail_memory(error);
    for (size_t i = 0; i < b->count && status == DEM_OK; i++) {
        dem_quat q = b->orientation[i];
        float *turn = turns + 4 * i;
        turn[0] = (float)q.w, turn[1] = (float)q.x, turn[2] = (float)q.y, turn[3] = (float)q.z;
        ids[i] = b->id ? b->id[i] : (uint32_t)i;
    }
    const dem_vtp_array arrays[] = {
        {"orientation", DEM_VTP_FLOAT32, 4, turns},    {"scale", DEM_VTP_FLOAT64, 1, b->scale},
        {"template", DEM_VTP_INT32, 1, b->shape},      {"id", DEM_VTP_UINT32, 1, ids},
        {"velocity", DEM_VTP_FLOAT64, 3, b->velocity}, {"angular_velocity", DEM_VTP_FLOAT64, 3, b->spin},
        {"mass", DEM_VTP_FLOAT64, 1, b->mass},         {"coordination", DEM_VTP_UINT32, 1, b->coordination}};
    if (status == DEM_OK)
        status = dem_vtp_queue(f->def.queue, path,
                               &(dem_vtp){.time = time,
                                          .fields = &field,
                                          .field_count = servo,
                                          .points = b->position,
                                          .point_count = b->count,
                                          .point_arrays = arrays,
                                          .point_array_count = sizeof arrays / sizeof *arrays,
                                          .scalars = "template",
                                          .vertices = true},
                               error);
    free(turns);
    free(ids);
    free(shifts);
    return status;
}

// ---- walls

static dem_box bodies_box(const dem_frames *f, const dem_body_view *b)
{
    dem_box box = box_empty();
    for (size_t i = 0; i < b->count; i++) {
        double r = f->radii[b->shape[i]] * b->scale[i];
        box = box_with(box, v3_sub(b->position[i], v3(r, r, r)));
        box = box_with(box, v3_add(b->position[i], v3(r, r, r)));
    }
    return box;
}

typedef struct wall_cells {
    dem_mesh mesh;     // of all walls
    int32_t *numbers;  // of the wall, for every triangle
    double *volume, *depth;  // worn off [m^3], [m]
    size_t vertex_room, triangle_room, number_room, volume_room, depth_room;
} wall_cells;

static bool append_wall(wall_cells *all, const dem_mesh *wall, int32_t number, const dem_wall_view *view)
{
    dem_mesh *m = &all->mesh;
    size_t base = m->vertex_count, first = m->triangle_count;
    for (size_t i = 0; i < wall->vertex_count; i++) {
        if (!dem_grow(&m->vertices, &all->vertex_room, m->vertex_count, sizeof *m->vertices))
            return false;
        m->vertices[m->vertex_count++] = wall->vertices[i];
    }
    for (size_t t = 0; t < wall->triangle_count; t++) {
        if (!dem_grow(&m->triangles, &all->triangle_room, m->triangle_count, 3 * sizeof *m->triangles) ||
            !dem_grow(&all->numbers, &all->number_room, m->triangle_count, sizeof *all->numbers) ||
            !dem_grow(&all->volume, &all->volume_room, m->triangle_count, sizeof *all->volume) ||
            !dem_grow(&all->depth, &all->depth_room, m->triangle_count, sizeof *all->depth))
            return false;
        for (size_t k = 3 * t; k < 3 * t + 3; k++)
            m->triangles[3 * m->triangle_count + k - 3 * t] = (uint32_t)(base + wall->triangles[k]);
        all->numbers[m->triangle_count++] = number;
    }
    if (wall->triangle_count)
        dem_wall_worn(wall, view, all->volume + first, all->depth + first);
    return true;
}

// all walls that move, or all that do not
static dem_status gather_walls(const dem_frames *f, bool moving, const dem_wall_view *poses, dem_box box,
                               wall_cells *all, dem_error *error)
{
    dem_status status = DEM_OK;
    for (size_t i = 0; i < f->def.wall_count && status == DEM_OK; i++) {
        dem_mesh mesh = {0};
        if (changes(&f->def.walls[i]) != moving)
            continue;
        status = dem_wall_mesh(&f->def.walls[i], poses ? &poses[i] : NULL, box, &mesh, error);
        if (status == DEM_OK && !append_wall(all, &mesh, (int32_t)i, poses ? &poses[i] : NULL))
            status = dem_fail_memory(error);
        dem_mesh_free(&mesh);
    }
    return status;
}

static dem_status write_wall_file(const dem_frames *f, const char *name, double time, bool moving,
                                  const dem_wall_view *poses, dem_box box, dem_error *error)
{
    wall_cells all = {0};
    char *path = dem_path_join(f->directory, "%s", name);
    dem_status status = path ? gather_walls(f, moving, poses, box, &all, error) : dem_fail_memory(error);
    bool worn = false;
    for (size_t i = 0; moving && i < f->def.wall_count; i++)
        worn |= f->def.walls[i].wear.law != DEM_WEAR_NONE;
    const dem_vtp_array arrays[] = {{"wall", DEM_VTP_INT32, 1, all.numbers},
                                    {"wear_volume", DEM_VTP_FLOAT64, 1, all.volume},
                                    {"wear_depth", DEM_VTP_FLOAT64, 1, all.depth}};
    if (status == DEM_OK)
        status = dem_vtp_queue(f->def.queue, path,
                               &(dem_vtp){.time = moving ? time : NAN,
                                          .points = all.mesh.vertices,
                                          .point_count = all.mesh.vertex_count,
                                          .triangles = all.mesh.triangles,
                                          .triangle_count = all.mesh.triangle_count,
                                          .cell_arrays = arrays,
                                          .cell_array_count = worn ? 3 : 1},
                               error);
    dem_mesh_free(&all.mesh);
    free(all.numbers);
    free(all.volume);
    free(all.depth);
    free(path);
    return status;
}

static dem_status write_walls(dem_frames *f, double time, const dem_body_view *bodies, const dem_wall_view *poses,
                              dem_error *error)
{
    char name[32];
    bool first = f->walls.count == 0;
    if (f->def.wall_count == 0 || !(first || f->moving))
        return DEM_OK;
    dem_box box = dem_walls_box(&f->def.domain, bodies_box(f, bodies), f->def.walls, poses, f->def.wall_count);
    if (f->still && first)
        DEM_TRY(write_wall_file(f, STATIC, time, false, poses, box, error));
    snprintf(name, sizeof name, "walls/%06zu.vtp", f->index.count);
    if (f->moving)
        DEM_TRY(write_wall_file(f, name, time, true, poses, box, error));
    return dem_pvd_add(&f->walls, time, f->still ? STATIC : NULL, f->moving ? name : NULL, error);
}

dem_status dem_frames_write(dem_frames *f, double time, const dem_body_view *bodies, const dem_wall_view *walls,
                            dem_error *error)
{
    char name[32];
    snprintf(name, sizeof name, "frames/%06zu.vtp", f->index.count);
    char *path = dem_path_join(f->directory, "%s", name);
    dem_status status = path ? write_bodies(f, path, time, bodies, walls, error) : dem_fail_memory(error);
    if (status == DEM_OK)
        status = write_walls(f, time, bodies, walls, error);
    if (status == DEM_OK)
        status = dem_pvd_add(&f->index, time, name, NULL, error);
    free(path);
    return status;
}
