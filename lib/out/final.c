// Printing the numbers is all the work, so rows are printed by blocks in parallel, and the blocks written in order.
#include "out/final.h"

#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "base/memory.h"

enum { BLOCK = 4096, DIGITS = 17, NUMBERS = 13, NUMBER_TEXT = 32 };

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

static dem_status write_rows(const dem_ctx *ctx, const char *path, const dem_body_view *b, const dem_buffer *names,
                             dem_error *error)
{
    bool scaled = false, failed = false;
    for (size_t i = 0; i < b->count && !scaled; i++)
        scaled = b->scale[i] != 1;
    size_t blocks = (b->count + BLOCK - 1) / BLOCK;
    dem_buffer *rows = dem_alloc_zero(blocks + 1, sizeof *rows);  // behind the head
    dem_piece *pieces = dem_alloc(blocks + 1, sizeof *pieces);
    if (rows && pieces) {
        dem_buffer_print(&rows[0], "%s%s\n", HEAD, scaled ? ",scale" : "");
#pragma omp parallel for schedule(dynamic) num_threads(dem_threads(ctx))
        for (size_t k = 0; k < blocks; k++)
            for (size_t i = k * BLOCK; i < b->count && i < (k + 1) * BLOCK; i++)
                put_row(&rows[k + 1], b, i, names, scaled);
        for (size_t k = 0; k <= blocks; k++) {
            failed |= rows[k].failed;
            pieces[k] = (dem_piece){rows[k].data, rows[k].size};
        }
    }
    failed |= !rows || !pieces;
    dem_status status = failed ? dem_fail_memory(error) : dem_file_write_pieces(path, pieces, blocks + 1, error);
    for (size_t k = 0; rows && k <= blocks; k++)
        dem_buffer_release(&rows[k]);
    free(rows);
    free(pieces);
    return status;
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
