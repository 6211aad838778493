#include "out/checkpoint.h"

#include <ctype.h>
#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/file.h"
#include "base/hash.h"
#include "base/memory.h"

#define MAGIC "dem-checkpoint/"
#define VERSION "1"

enum {
    DIGITS = 20,                            // of a length
    LENGTHS = 2 * (DIGITS + 1),             // the line of both
    HEAD = sizeof MAGIC VERSION + LENGTHS,  // the line of the version ends in a newline for the 0
    SUM = 64 + 1,
    MOST_HEADER = 1 << 20,
};

static const char *byte_order(void)
{
    const uint16_t probe = 1;
    return *(const unsigned char *)&probe ? "little" : "big";
}

char *dem_checkpoint_path(const char *directory, uint64_t step)
{
    return dem_path_join(directory, "checkpoint-%llu.dem", (unsigned long long)step);
}

// ---- reading

static dem_status refuse(dem_error *error, const char *name, const char *what)
{
    return dem_fail_at(error, DEM_BAD_INPUT, name, 0, "%s", what);
}

static dem_status refuse_altered(dem_error *error, const char *name)
{
    return refuse(error, name, "was altered since it was written; resume from another checkpoint");
}

static dem_status refuse_short(dem_error *error, const char *name)
{
    return refuse(error, name, "is cut short; resume from another checkpoint");
}

// all digits, so that a length has one form only
static bool read_length(const char *at, uint64_t *length)
{
    *length = 0;
    for (int k = 0; k < DIGITS; k++)
        if (!isdigit((unsigned char)at[k]) || __builtin_mul_overflow(*length, (uint64_t)10, length) ||
            __builtin_add_overflow(*length, (uint64_t)(at[k] - '0'), length))
            return false;
    return true;
}

// the first two lines; what is behind them may be missing
static dem_status read_head(const char *bytes, size_t size, const char *name, uint64_t lengths[2], dem_error *error)
{
    size_t prefix = strlen(MAGIC);
    if (memcmp(bytes, MAGIC, size < prefix ? size : prefix) != 0)
        return refuse(error, name, "is no checkpoint; name a file checkpoint-STEP.dem");
    const char *version = bytes + prefix, *line = size > prefix ? memchr(version, '\n', size - prefix) : NULL;
    int length = line ? (int)(line - version < 20 ? line - version : 20) : 0;
    if (line && (length != (int)strlen(VERSION) || memcmp(version, VERSION, strlen(VERSION)) != 0))
        return dem_fail_at(error, DEM_BAD_INPUT, name, 0,
                           "is a checkpoint of version %.*s, only " VERSION " is known; use the program that wrote it",
                           length, version);
    if (size < HEAD)
        return refuse_short(error, name);
    const char *at = bytes + HEAD - LENGTHS;
    if (!read_length(at, &lengths[0]) || at[DIGITS] != ' ' || !read_length(at + DIGITS + 1, &lengths[1]) ||
        at[LENGTHS - 1] != '\n' || lengths[0] > MOST_HEADER || lengths[1] > SIZE_MAX / 2)
        return refuse_altered(error, name);
    return DEM_OK;
}

static bool read_count(const dem_json *header, const char *key, uint64_t *count)
{
    int64_t whole;
    if (!dem_json_whole(dem_json_member(header, key), &whole) || whole < 0)
        return false;
    *count = (uint64_t)whole;
    return true;
}

static dem_status read_header(const char *name, const char *scene, dem_checkpoint *c, dem_error *error)
{
    const char *of = dem_json_string(dem_json_member(c->header, "scene"));
    const char *order = dem_json_string(dem_json_member(c->header, "byte_order"));
    c->title = dem_json_string(dem_json_member(c->header, "title"));
    if (!c->title || !of || strlen(of) != 64 || !order ||
        !dem_json_number(dem_json_member(c->header, "time"), &c->time) || !read_count(c->header, "step", &c->step) ||
        !read_count(c->header, "frames", &c->frames) || !read_count(c->header, "rows", &c->rows))
        return refuse(error, name, "lacks a part of its header; resume from another checkpoint");
    memcpy(c->scene, of, sizeof c->scene);
    if (strcmp(order, byte_order()) != 0)
        return refuse(error, name, "was written on a machine of the other byte order; resume it on such a one");
    if (scene && strcmp(scene, of) != 0)
        return dem_fail_at(error, DEM_BAD_INPUT, name, 0,
                           "belongs to another scene (%.100s), or to this one before it was changed; resume with the "
                           "scene it was made from",
                           *c->title ? c->title : "without a title");
    return DEM_OK;
}

dem_status dem_checkpoint_decode(dem_buffer *file, const char *name, const char *scene, dem_checkpoint *checkpoint,
                                 dem_error *error)
{
    uint64_t lengths[2];
    char sum[65];
    *checkpoint = (dem_checkpoint){0};
    DEM_TRY(read_head(file->data, file->size, name, lengths, error));
    size_t end = HEAD + (size_t)lengths[0] + (size_t)lengths[1];
    if (file->size < end + SUM)
        return refuse_short(error, name);
    dem_sha256(file->data, end, sum);
    if (file->size > end + SUM || memcmp(file->data + end, sum, SUM - 1) != 0 || file->data[end + SUM - 1] != '\n')
        return refuse_altered(error, name);
    dem_checkpoint c = {.state = file->data + HEAD + lengths[0], .state_size = (size_t)lengths[1]};
    dem_status status = dem_json_parse(file->data + HEAD, (size_t)lengths[0], name, &c.header, error);
    if (status == DEM_OK)
        status = read_header(name, scene, &c, error);
    if (status != DEM_OK) {
        dem_json_release(c.header);
        return status;
    }
    c.file = *file;
    *file = (dem_buffer){0};
    *checkpoint = c;
    return DEM_OK;
}

dem_status dem_checkpoint_read(const char *path, const char *scene, dem_checkpoint *checkpoint, dem_error *error)
{
    dem_buffer file;
    *checkpoint = (dem_checkpoint){0};
    DEM_TRY(dem_file_read(path, &file, error));
    dem_status status = dem_checkpoint_decode(&file, path, scene, checkpoint, error);
    dem_buffer_release(&file);
    return status;
}

void dem_checkpoint_release(dem_checkpoint *checkpoint)
{
    dem_json_release(checkpoint->header);
    dem_buffer_release(&checkpoint->file);
    *checkpoint = (dem_checkpoint){0};
}

// ---- removing

// true where the header of a file names the scene; the state is not read
static bool is_of_scene(const char *path, const char *scene)
{
    char head[HEAD];
    uint64_t lengths[2];
    dem_json *header = NULL;
    FILE *file = fopen(path, "rb");
    bool same = false;
    if (file && fread(head, 1, HEAD, file) == HEAD && read_head(head, HEAD, path, lengths, NULL) == DEM_OK) {
        char *text = malloc((size_t)lengths[0] + 1);
        if (text && fread(text, 1, (size_t)lengths[0], file) == lengths[0] &&
            dem_json_parse(text, (size_t)lengths[0], path, &header, NULL) == DEM_OK) {
            const char *of = dem_json_string(dem_json_member(header, "scene"));
            same = of && strcmp(of, scene) == 0;
        }
        free(text);
    }
    if (file)
        fclose(file);
    dem_json_release(header);
    return same;
}

// the step in a name as dem_checkpoint_path gives it
static bool step_of(const char *name, uint64_t *step)
{
    int end = 0;
    unsigned long long number;
    char again[64];
    if (sscanf(name, "checkpoint-%llu.dem%n", &number, &end) != 1 || end == 0)
        return false;
    snprintf(again, sizeof again, "checkpoint-%llu.dem", number);
    *step = number;
    return strcmp(again, name) == 0;
}

typedef struct steps {
    uint64_t *steps;
    size_t count, capacity;
} steps;

// checkpoints of the scene before this step
static steps find_older(const char *directory, const dem_checkpoint *c)
{
    steps found = {0};
    DIR *listing = opendir(directory);
    const struct dirent *entry;
    while (listing && (entry = readdir(listing))) {
        uint64_t step;
        char *path = dem_path_join(directory, "%s", entry->d_name);
        if (path && step_of(entry->d_name, &step) && step < c->step && is_of_scene(path, c->scene) &&
            dem_grow(&found.steps, &found.capacity, found.count, sizeof *found.steps))
            found.steps[found.count++] = step;
        free(path);
    }
    if (listing)
        closedir(listing);
    return found;
}

// all but the newest; those behind this step are of a run that once went on from here, and may be wanted
static void remove_older(const char *directory, const dem_checkpoint *c)
{
    steps found = find_older(directory, c);
    uint64_t newest = 0;
    for (size_t i = 0; i < found.count; i++)
        newest = found.steps[i] > newest ? found.steps[i] : newest;
    for (size_t i = 0; i < found.count; i++) {
        char *path = found.steps[i] < newest ? dem_checkpoint_path(directory, found.steps[i]) : NULL;
        if (path)
            unlink(path);
        free(path);
    }
    free(found.steps);
}

// ---- writing

static void put_header(dem_buffer *out, const dem_checkpoint *c)
{
    dem_json_writer writer = dem_json_begin(out), *w = &writer;
    dem_json_open_object(w, NULL);
    dem_json_put_string(w, "program", "dem-clump " DEM_VERSION);
    dem_json_put_string(w, "title", c->title);
    dem_json_put_string(w, "scene", c->scene);
    dem_json_put_number(w, "time", c->time);
    dem_json_put_whole(w, "step", (int64_t)c->step);
    dem_json_put_whole(w, "frames", (int64_t)c->frames);
    dem_json_put_whole(w, "rows", (int64_t)c->rows);
    dem_json_put_string(w, "byte_order", byte_order());
    dem_json_close(w, '}');
}

dem_status dem_checkpoint_write(const char *directory, const dem_checkpoint *c, dem_error *error)
{
    char head[HEAD + 1], sum[65 + 1];
    dem_buffer header = {0};
    DEM_TRY(dem_folder_create(directory, error));
    char *path = dem_checkpoint_path(directory, c->step);
    put_header(&header, c);
    dem_status status = path && !header.failed ? DEM_OK : dem_fail_memory(error);
    if (status == DEM_OK) {
        snprintf(head, sizeof head, MAGIC VERSION "\n%020zu %020zu\n", header.size, c->state_size);
        dem_piece pieces[] = {{head, HEAD}, {header.data, header.size}, {c->state, c->state_size}, {sum, SUM}};
        dem_sha256_pieces(pieces, 3, sum);
        sum[SUM - 1] = '\n';
        status = dem_file_write_pieces(path, pieces, 4, error);
    }
    if (status == DEM_OK)
        remove_older(directory, c);
    dem_buffer_release(&header);
    free(path);
    return status;
}
