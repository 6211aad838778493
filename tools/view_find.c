// What the operands are.
#include <dirent.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/file.h"
#include "base/memory.h"
#include "view.h"

static const char *const mesh_suffixes[] = {"stl", "obj", "ply", "off"};

static bool is_mesh_name(const char *name)
{
    for (size_t i = 0; i < sizeof mesh_suffixes / sizeof *mesh_suffixes; i++)
        if (dem_file_has_suffix(name, mesh_suffixes[i]))
            return true;
    return false;
}

// takes over the texts; the name is that of the file, without its suffix
static dem_status add(view_inputs *all, view_kind kind, char *path, char *directory, dem_error *error)
{
    const char *name = path ? dem_file_name(path) : "";
    size_t length = strlen(name);
    const char *dot = strrchr(name, '.');
    if (kind == VIEW_GRAIN && dot && dot > name)
        length = (size_t)(dot - name);
    char *own = strndup(name, length);
    if (!path || !own || !dem_grow(&all->items, &all->capacity, all->count, sizeof *all->items)) {
        free(path);
        free(directory);
        free(own);
        return dem_fail_memory(error);
    }
    all->items[all->count++] = (view_input){kind, path, directory, own};
    return DEM_OK;
}

static int by_name(const void *a, const void *b)
{
    return strcmp(*(char *const *)a, *(char *const *)b);
}

static bool is_wanted(const char *name, bool meshes)
{
    return name[0] != '.' && (meshes ? is_mesh_name(name) : dem_file_has_suffix(name, "json"));
}

// the files of a folder, in the order of their names
static dem_status add_files(const char *folder, bool meshes, view_inputs *all, dem_error *error)
{
    char **names = NULL;
    size_t count = 0, capacity = 0;
    DIR *listing = opendir(folder);
    const struct dirent *entry;
    dem_status status = DEM_OK;
    while (listing && status == DEM_OK && (entry = readdir(listing))) {
        if (!is_wanted(entry->d_name, meshes))
            continue;
        char *name = strdup(entry->d_name);
        if (name && dem_grow(&names, &capacity, count, sizeof *names)) {
            names[count++] = name;
        } else {
            free(name);
            status = dem_fail_memory(error);
        }
    }
    if (listing)
        closedir(listing);
    if (count)
        qsort(names, count, sizeof *names, by_name);
    for (size_t i = 0; i < count; i++) {
        if (status == DEM_OK)
            status = add(all, VIEW_GRAIN, dem_path_join(folder, "%s", names[i]), NULL, error);
        free(names[i]);
    }
    free(names);
    return status;
}

static dem_status add_folder(const char *path, view_inputs *all, dem_error *error)
{
    char *run = dem_path_join(path, "run.json");
    bool is_run = run && access(run, F_OK) == 0;
    free(run);
    if (!run)
        return dem_fail_memory(error);
    if (is_run) {
        char *plain = strdup(path);
        for (size_t n = plain ? strlen(plain) : 0; n > 1 && plain[n - 1] == '/'; n--)
            plain[n - 1] = 0;
        return add(all, VIEW_RUN, plain, NULL, error);
    }
    size_t before = all->count;
    DEM_TRY(add_files(path, false, all, error));
    if (all->count == before)
        DEM_TRY(add_files(path, true, all, error));
    if (all->count == before)
        return dem_fail_at(error, DEM_BAD_INPUT, path, 0,
                           "holds neither a run (run.json) nor clumps or meshes; name a directory that does");
    return DEM_OK;
}

// a frame lies in DIR/frames; what else is in a VTP file is drawn as a grain
static dem_status add_vtp(const char *path, view_inputs *all, dem_error *error)
{
    dem_vtp_file file;
    DEM_TRY(dem_vtp_read(path, &file, error));
    bool frame = dem_vtp_find(&file.vtp, "template") && !dem_vtp_find(&file.vtp, "radius");
    dem_vtp_file_release(&file);
    if (!frame)
        return add(all, VIEW_GRAIN, strdup(path), NULL, error);
    dem_buffer directory = {0}, run = {0};
    const char *name = dem_file_name(path);
    dem_buffer_bytes(&directory, path, (size_t)(name - path));
    dem_buffer_text(&directory, "..");
    if (directory.failed)
        return dem_fail_memory(error);
    dem_buffer_print(&run, "%s/run.json", directory.data);
    bool there = run.data && access(run.data, F_OK) == 0;
    dem_buffer_release(&run);
    if (!there) {
        dem_buffer_release(&directory);
        return dem_fail_at(error, DEM_BAD_INPUT, path, 0,
                           "is a frame, whose shapes its run tells; leave it in the folder frames beside run.json");
    }
    return add(all, VIEW_FRAME, strdup(path), directory.data, error);
}

// names that stand for several files get their suffixes back
static dem_status tell_apart(view_inputs *all, dem_error *error)
{
    for (size_t i = 0; i < all->count; i++) {
        bool twice = false;
        for (size_t k = 0; k < all->count && !twice; k++)
            twice = k != i && strncmp(all->items[k].name, all->items[i].name, strlen(all->items[i].name)) == 0 &&
                    strcspn(all->items[k].name, ".") == strcspn(all->items[i].name, ".");
        if (!twice || all->items[i].kind == VIEW_RUN)
            continue;
        char *whole = strdup(dem_file_name(all->items[i].path));
        if (!whole)
            return dem_fail_memory(error);
        free(all->items[i].name);
        all->items[i].name = whole;
    }
    return DEM_OK;
}

dem_status view_find(const cli_texts *operands, view_inputs *all, dem_error *error)
{
    *all = (view_inputs){0};
    for (size_t i = 0; i < operands->count; i++) {
        const char *path = operands->items[i];
        if (dem_folder_exists(path))
            DEM_TRY(add_folder(path, all, error));
        else if (dem_file_has_suffix(path, "vtp"))
            DEM_TRY(add_vtp(path, all, error));
        else
            DEM_TRY(add(all, VIEW_GRAIN, strdup(path), NULL, error));
    }
    return tell_apart(all, error);
}

void view_inputs_release(view_inputs *all)
{
    for (size_t i = 0; i < all->count; i++) {
        free(all->items[i].path);
        free(all->items[i].directory);
        free(all->items[i].name);
    }
    free(all->items);
}
