// Printing the numbers is all the work, so rows are printed by blocks in parallel, and the blocks written in order, a
// few at a time: the whole text takes more memory than the bodies' motion.
#include "out/final.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "base/memory.h"

enum { BLOCK = 256, BLOCKS = 16, DIGITS = 17, NUMBERS = 13, NUMBER_TEXT = 32 };

static const char HEAD[] = "shape,x,y,z,qw,qx,qy,qz,vx,vy,vz,wx,wy,wz";

// a name as a field of a table (RFC 4180)
static void put_name(dem_buffer *out, const char *name)
{
    if (name[0] && !strpbrk(name, ",\"\r\n#") && name[0] != ' ' && name[strlen(name) - 1] != ' ') {
        dem_buffer_text(out, name);
        return;
    }
    dem_buffer_text(out, "\"");
    for (const char *p = name; *p; p++)
        dem_buffer_bytes(out, *p == '"' ? "\"\"" : p, *p == '"' ? 2 : 1);
    dem_buffer_text(out, "\"");
}

static dem_buffer *print_names(const dem_shape_def *shapes, size_t count)
{
    dem_buffer *names = dem_alloc_zero(count, sizeof *names);
    for (size_t i = 0; names && i < count; i++)
        put_name(&names[i], shapes[i].name ? shapes[i].name : "");
    return names;
}

static void put_row(dem_buffer *out, const dem_body_view *b, size_t i, const dem_buffer *names, bool scaled)
{
    dem_vec3 x = b->position[i], v = b->velocity[i], w = b->spin[i];
    dem_quat q = b->orientation[i];
    const double values[NUMBERS + 1] = {x.x, x.y, x.z, q.w, q.x, q.y, q.z, v.x, v.y, v.z, w.x, w.y, w.z, b->scale[i]};
    const dem_buffer *name = &names[b->shape[i]];
    char text[(NUMBERS + 1) * (NUMBER_TEXT + 1) + 1], *at = text;
    for (int k = 0; k < NUMBERS + scaled; k++) {
        *at++ = ',';
        at += strlen(dem_format_double(at, NUMBER_TEXT, values[k], DIGITS));
    }
    *at++ = '\n';
    dem_buffer_bytes(out, name->data, name->size);
    dem_buffer_bytes(out, text, (size_t)(at - text));
}

// the rows from `begin` on, as far as the blocks go
static dem_status put_blocks(const dem_ctx *ctx, dem_file_making *file, const dem_body_view *b, size_t begin,
                             const dem_buffer *names, bool scaled, dem_error *error)
{
    dem_buffer rows[BLOCKS] = {0};
    dem_piece pieces[BLOCKS];
    bool failed = false;
#pragma omp parallel for schedule(dynamic) num_threads(dem_threads(ctx))
    for (size_t k = 0; k < BLOCKS; k++)
        for (size_t i = begin + k * BLOCK; i < b->count && i < begin + (k + 1) * BLOCK; i++)
            put_row(&rows[k], b, i, names, scaled);
    for (size_t k = 0; k < BLOCKS; k++) {
        failed |= rows[k].failed;
        pieces[k] = (dem_piece){rows[k].data, rows[k].size};
    }
    dem_status status = failed ? dem_fail_memory(error) : dem_file_put(file, pieces, BLOCKS, error);
    for (size_t k = 0; k < BLOCKS; k++)
        dem_buffer_release(&rows[k]);
    return status;
}

static dem_status write_rows(const dem_ctx *ctx, const char *path, const dem_body_view *b, const dem_buffer *names,
                             dem_error *error)
{
    bool scaled = false;
    char head[128];
    for (size_t i = 0; i < b->count && !scaled; i++)
        scaled = b->scale[i] != 1;
    int length = snprintf(head, sizeof head, "%s%s\n", HEAD, scaled ? ",scale" : "");
    dem_file_making file;
    DEM_TRY(dem_file_begin(path, &file, error));
    dem_status status = dem_file_put(&file, &(dem_piece){head, (size_t)length}, 1, error);
    for (size_t i = 0; i < b->count && status == DEM_OK; i += BLOCKS * BLOCK)
        status = put_blocks(ctx, &file, b, i, names, scaled, error);
    file.whole = status == DEM_OK;
    dem_status ended = dem_file_end(&file, status == DEM_OK ? error : NULL);
    return status == DEM_OK ? ended : status;
}

dem_status dem_final_write(const dem_ctx *ctx, const char *directory, const dem_shape_def *shapes, size_t shape_count,
                           const dem_body_view *bodies, dem_error *error)
{
    DEM_TRY(dem_folder_create(directory, error));
    char *path = dem_path_join(directory, "final.csv");
    dem_buffer *names = print_names(shapes, shape_count);
    bool failed = !path || !names;
    for (size_t i = 0; names && i < shape_count; i++)
        failed |= names[i].failed;
    dem_status status = failed ? dem_fail_memory(error) : write_rows(ctx, path, bodies, names, error);
    for (size_t i = 0; names && i < shape_count; i++)
        dem_buffer_release(&names[i]);
    free(names);
    free(path);
    return status;
}
