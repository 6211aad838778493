#include "out/pvd.h"

#include <dirent.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/file.h"
#include "base/memory.h"

static const char HEAD[] = "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\">\n<Collection>\n";
static const char TAIL[] = "</Collection>\n</VTKFile>\n";
static const char SET[] = "<DataSet timestep=\"", PART[] = "\" part=\"", NAMED[] = "\" file=\"", CLOSE[] = "\"/>\n";

// ---- reading

// steps over a text; false: something else stands there
static bool skip_text(const char **at, const char *text)
{
    size_t length = strlen(text);
    if (strncmp(*at, text, length) != 0)
        return false;
    *at += length;
    return true;
}

// one line of the index: time, part, file
static bool read_line(const char **at, const char *end, double *time, long *part, char *file, size_t size)
{
    if (!skip_text(at, SET) || !(*at = dem_parse_double(*at, end, time)) || !skip_text(at, PART) ||
        !(*at = dem_parse_long(*at, end, part)) || !skip_text(at, NAMED))
        return false;
    size_t length = strcspn(*at, "\"<>&\n");
    if (length == 0 || length >= size)
        return false;
    memcpy(file, *at, length);
    file[length] = 0;
    *at += length;
    return skip_text(at, CLOSE) && *part >= 0 && *part < DEM_PVD_PARTS;
}

static bool append(dem_pvd *index, const dem_pvd_entry *entry)
{
    if (!dem_grow(&index->entries, &index->capacity, index->count, sizeof *index->entries))
        return false;
    index->entries[index->count++] = *entry;
    return true;
}

static dem_status read_entries(dem_pvd *index, const char *at, const char *end, double resume, dem_error *error)
{
    bool ours = skip_text(&at, HEAD);
    while (ours && !skip_text(&at, TAIL)) {
        dem_pvd_entry entry = {0};
        long part;
        char file[sizeof entry.files[0]];
        ours = read_line(&at, end, &entry.time, &part, file, sizeof file);
        if (!ours || entry.time > resume)
            continue;
        bool same = index->count > 0 && index->entries[index->count - 1].time == entry.time;
        if (!same && !append(index, &entry))
            return dem_fail_memory(error);
        memcpy(index->entries[index->count - 1].files[part], file, sizeof file);
    }
    if (!ours || at != end)
        return dem_fail_at(error, DEM_BAD_INPUT, index->path, 0,
                           "is not as this program writes it; remove it or resume with another folder (-o)");
    return DEM_OK;
}

dem_status dem_pvd_open(const char *folder, const char *name, double resume, dem_pvd *index, dem_error *error)
{
    *index = (dem_pvd){.path = dem_path_join(folder, "%s", name)};
    if (!index->path)
        return dem_fail_memory(error);
    if (isnan(resume) || access(index->path, F_OK) != 0)
        return DEM_OK;
    dem_buffer file;
    dem_status status = dem_file_read(index->path, &file, error);
    if (status == DEM_OK)
        status = read_entries(index, file.data, file.data + file.size, resume, error);
    dem_buffer_release(&file);
    if (status != DEM_OK)
        dem_pvd_release(index);
    return status;
}

// ---- files that are not named any more

// the number of a file, six digits and more between prefix and suffix; below 0: it has none
static long number_of(const char *name, const char *prefix)
{
    size_t length = strlen(prefix);
    if (strncmp(name, prefix, length) != 0 || name[length] < '0' || name[length] > '9')
        return -1;
    long number;
    const char *digits = name + length, *rest = dem_parse_long(digits, name + strlen(name), &number);
    return rest && rest - digits >= 6 && strcmp(rest, ".vtp") == 0 ? number : -1;
}

dem_status dem_pvd_remove(const char *directory, const char *folder, const char *prefix, size_t first, dem_error *error)
{
    char *path = dem_path_join(directory, "%s", folder);
    if (!path)
        return dem_fail_memory(error);
    DIR *listing = opendir(path);
    const struct dirent *entry;
    while (listing && (entry = readdir(listing))) {
        long number = number_of(entry->d_name, prefix);
        if (number >= 0 && (size_t)number >= first)
            unlinkat(dirfd(listing), entry->d_name, 0);
    }
    if (listing)
        closedir(listing);
    free(path);
    return DEM_OK;
}

// ---- writing

static void put_lines(dem_buffer *out, const dem_pvd_entry *entry)
{
    for (int part = 0; part < DEM_PVD_PARTS; part++)
        if (entry->files[part][0]) {
            dem_buffer_text(out, SET);
            dem_buffer_shortest(out, entry->time);
            dem_buffer_print(out, "%s%d%s%s%s", PART, part, NAMED, entry->files[part], CLOSE);
        }
}

// only what is new is printed
static dem_status write_index(dem_pvd *index, dem_error *error)
{
    dem_buffer out = {0};
    for (; index->printed < index->count; index->printed++)
        put_lines(&index->lines, &index->entries[index->printed]);
    dem_buffer_text(&out, HEAD);
    dem_buffer_bytes(&out, index->lines.data, index->lines.size);
    dem_buffer_text(&out, TAIL);
    out.failed |= index->lines.failed;
    return dem_file_queue_put(index->queue, index->path, &out, error);
}

dem_status dem_pvd_add(dem_pvd *index, double time, const char *file, const char *other, dem_error *error)
{
    dem_pvd_entry entry = {.time = time};
    const char *files[DEM_PVD_PARTS] = {file, other};
    for (int part = 0; part < DEM_PVD_PARTS; part++)
        snprintf(entry.files[part], sizeof entry.files[part], "%s", files[part] ? files[part] : "");
    return append(index, &entry) ? write_index(index, error) : dem_fail_memory(error);
}

const dem_pvd_entry *dem_pvd_nearest(const dem_pvd *index, double time)
{
    if (!index->count)
        return NULL;
    const dem_pvd_entry *best = &index->entries[isnan(time) ? index->count - 1 : 0];
    for (size_t i = 1; i < index->count && !isnan(time); i++)
        if (fabs(index->entries[i].time - time) < fabs(best->time - time))
            best = &index->entries[i];
    return best;
}

void dem_pvd_release(dem_pvd *index)
{
    free(index->path);
    free(index->entries);
    dem_buffer_release(&index->lines);
    *index = (dem_pvd){0};
}
