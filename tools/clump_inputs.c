#define _GNU_SOURCE
#include "clump_inputs.h"

#include <dirent.h>
#include <errno.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "base/memory.h"
#include "mesh/volume.h"

enum { DEEPEST = 32 };  // folders within folders; links may lead in circles

// what is taken from a folder; what else assimp may know has to be named
static const char *const mesh_suffixes[] = {"stl", "obj", "ply", "off", "gltf", "glb", "3mf",
                                            "dae", "fbx", "amf", "x3d", "3ds",  "wrl", NULL};

static bool is_mesh_name(const char *path)
{
    for (size_t i = 0; mesh_suffixes[i]; i++)
        if (dem_file_has_suffix(path, mesh_suffixes[i]))
            return true;
    return false;
}

// takes `path` over
static dem_status add_file(clump_inputs *inputs, char *path, bool labels, dem_error *error)
{
    if (path && dem_grow(&inputs->items, &inputs->capacity, inputs->count, sizeof *inputs->items)) {
        inputs->items[inputs->count++] = (clump_input){.path = path, .labels = labels};
        inputs->several |= labels;
        return DEM_OK;
    }
    free(path);
    return dem_fail_memory(error);
}

static int is_visible(const struct dirent *entry)
{
    return entry->d_name[0] != '.';
}

static int by_bytes(const struct dirent **a, const struct dirent **b)
{
    return strcmp((*a)->d_name, (*b)->d_name);
}

static dem_status add_folder(clump_inputs *inputs, const char *folder, const clump_input_options *options, int depth,
                             dem_error *error)
{
    struct dirent **entries;
    int count = scandir(folder, &entries, is_visible, by_bytes);
    if (count < 0)
        return dem_fail_at(error, DEM_BAD_INPUT, folder, 0, "cannot read the folder: %s; check its permissions",
                           strerror(errno));
    dem_status status = DEM_OK;
    for (int i = 0; i < count; i++) {
        size_t length = strlen(folder);
        const char *slash = length && folder[length - 1] == '/' ? "" : "/";
        char *path = NULL;
        if (status == DEM_OK && asprintf(&path, "%s%s%s", folder, slash, entries[i]->d_name) < 0) {
            path = NULL;
            status = dem_fail_memory(error);
        }
        free(entries[i]);
        if (status != DEM_OK)
            continue;
        bool labels = dem_volume_is_name(path) || (options->raw && dem_file_has_suffix(path, "raw"));
        if (dem_folder_exists(path)) {
            if (options->recursive && depth < DEEPEST)
                status = add_folder(inputs, path, options, depth + 1, error);
        } else if (labels || (is_mesh_name(path) && !options->raw)) {
            status = add_file(inputs, path, labels, error);
            path = NULL;
        }
        free(path);
    }
    free(entries);
    return status;
}

// takes `path` over
static dem_status add_path(clump_inputs *inputs, char *path, const clump_input_options *options, dem_error *error)
{
    if (!path)
        return dem_fail_memory(error);
    if (strcmp(path, "-") == 0 || !dem_folder_exists(path))
        return add_file(inputs, path, options->raw || dem_volume_is_file(path), error);
    size_t before = inputs->count;
    inputs->several = true;
    dem_status status = add_folder(inputs, path, options, 0, error);
    if (status == DEM_OK && inputs->count == before)
        status =
            dem_fail_at(error, DEM_BAD_INPUT, path, 0, "no mesh in this folder; %s",
                        options->recursive ? "known are files ending in stl, obj, ply, off, glb, 3mf, nrrd, mha ..."
                                           : "--recursive also looks into the folders in it");
    free(path);
    return status;
}

static dem_status add_list(clump_inputs *inputs, const clump_input_options *options, dem_error *error)
{
    dem_buffer text;
    DEM_TRY(dem_file_read(options->list, &text, error));
    int folder = (int)(dem_file_name(options->list) - options->list);  // with its slash
    size_t before = inputs->count;
    inputs->several = true;
    dem_status status = DEM_OK;
    for (char *line = text.data, *next; status == DEM_OK && line; line = next) {
        next = strchr(line, '\n');
        if (next)
            *next++ = 0;
        size_t length = strlen(line);
        while (length && strchr(" \t\r", line[length - 1]))
            line[--length] = 0;
        line += strspn(line, " \t");
        if (!*line || *line == '#')
            continue;
        char *path = NULL;
        if (asprintf(&path, "%.*s%s", *line == '/' ? 0 : folder, options->list, line) < 0)
            path = NULL;
        status = add_path(inputs, path, options, error);
    }
    dem_buffer_release(&text);
    if (status == DEM_OK && inputs->count == before)
        status = dem_fail_at(error, DEM_BAD_INPUT, options->list, 0, "the list names no mesh; write one path per line");
    return status;
}

// ---- names

typedef struct named {
    clump_input *input;
    size_t index;
} named;

static int by_name(const void *a, const void *b)
{
    const named *x = a, *y = b;
    int order = strcmp(x->input->name, y->input->name);
    return order ? order : (x->index > y->index) - (x->index < y->index);
}

static char *stem(const char *path)
{
    const char *file = strcmp(path, "-") ? dem_file_name(path) : "grain", *dot = strrchr(file, '.');
    return strndup(file, dot && dot != file ? (size_t)(dot - file) : strlen(file));
}

// numbers equal names, until all differ; false: no memory
static bool number_names(named *all, size_t count)
{
    for (bool changed = true; changed;) {
        changed = false;
        qsort(all, count, sizeof *all, by_name);
        for (size_t i = 0, first = 0; i < count; i++) {
            if (i == first || strcmp(all[i].input->name, all[first].input->name) != 0) {
                first = i;
                continue;
            }
            char *numbered;
            if (asprintf(&numbered, "%s_%zu", all[i].input->name, i - first + 1) < 0)
                return false;
            free(all[i].input->name);
            all[i].input->name = numbered;
            changed = true;
        }
    }
    return true;
}

static dem_status name_all(clump_inputs *inputs, dem_error *error)
{
    named *all = dem_alloc(inputs->count, sizeof *all);
    bool fine = all != NULL;
    for (size_t i = 0; fine && i < inputs->count; i++) {
        all[i] = (named){&inputs->items[i], i};
        inputs->items[i].name = stem(inputs->items[i].path);
        fine = inputs->items[i].name != NULL;
    }
    fine = fine && number_names(all, inputs->count);
    free(all);
    return fine ? DEM_OK : dem_fail_memory(error);
}

dem_status clump_inputs_collect(const cli_texts *operands, const clump_input_options *options, clump_inputs *inputs,
                                dem_error *error)
{
    *inputs = (clump_inputs){.several = operands->count > 1};
    dem_status status = DEM_OK;
    for (size_t i = 0; status == DEM_OK && i < operands->count; i++)
        status = add_path(inputs, strdup(operands->items[i]), options, error);
    if (status == DEM_OK && options->list)
        status = add_list(inputs, options, error);
    return status == DEM_OK ? name_all(inputs, error) : status;
}

dem_status clump_inputs_files(const cli_texts *operands, clump_inputs *inputs, dem_error *error)
{
    *inputs = (clump_inputs){.several = operands->count > 1};
    for (size_t i = 0; i < operands->count; i++)
        DEM_TRY(add_file(inputs, strdup(operands->items[i]), false, error));
    return name_all(inputs, error);
}

void clump_inputs_release(clump_inputs *inputs)
{
    for (size_t i = 0; i < inputs->count; i++) {
        free(inputs->items[i].path);
        free(inputs->items[i].name);
    }
    free(inputs->items);
    *inputs = (clump_inputs){0};
}
