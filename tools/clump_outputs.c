#include "clump_outputs.h"

#include <string.h>

#include "base/file.h"
#include "base/memory.h"

static const char *format_names(char text[256])
{
    *text = 0;
    for (const dem_exporter *const *e = dem_exporters(); *e; e++)
        snprintf(text + strlen(text), 256 - strlen(text), " %s", (*e)->name);
    return text;
}

static bool add_format(cli_texts *formats, const dem_exporter *exporter)
{
    for (size_t i = 0; i < formats->count; i++)
        if (strcmp(formats->items[i], exporter->name) == 0)
            return true;
    if (!dem_grow(&formats->items, &formats->capacity, formats->count, sizeof *formats->items))
        return false;
    formats->items[formats->count++] = exporter->name;
    return true;
}

int outputs_exports(const cli_tool *tool, const char *list, job_options *o, cli_texts *formats)
{
    char name[32], known[256];
    for (const char *at = list;; at++) {
        size_t length = strcspn(at, ",");
        snprintf(name, sizeof name, "%.*s", (int)(length < sizeof name ? length : sizeof name - 1), at);
        bool all = strcmp(name, "all") == 0, engines = strcmp(name, "engines") == 0, found = false;
        o->every_format |= all;
        for (const dem_exporter *const *e = dem_exporters(); *e; e++) {
            if (!(all || (engines && (*e)->for_engine) || strcmp(name, (*e)->name) == 0))
                continue;
            found = true;
            if (!add_format(formats, *e))
                return cli_error(tool, &(dem_error){.code = DEM_NO_MEMORY, .text = "out of memory"});
        }
        if (!found)
            return cli_wrong_usage(tool, "unknown format '%s' in --exports; use all, engines or some of:%s", name,
                                   format_names(known));
        at += length;
        if (!*at)
            break;
    }
    o->formats = *formats;
    o->into_folder = true;
    return 0;
}

// one file of one clump
static int add_file(const cli_tool *tool, const job_options *o, const char *path, cli_texts *files)
{
    char known[256];
    const dem_exporter *exporter = dem_exporter_of_file(path);
    if (files->count < o->formats.count)
        exporter = dem_exporter_find(o->formats.items[files->count]);
    if (!exporter)
        return cli_wrong_usage(tool, "the name '%s' does not tell the format; add --format, one of:%s", path,
                               format_names(known));
    if (exporter->parts && strcmp(path, "-") == 0)
        return cli_wrong_usage(tool, "%s is a folder of files, it cannot go to standard output; name it with -o",
                               exporter->name);
    files->items[files->count++] = path;
    return 0;
}

static int sort_one(const cli_tool *tool, job_options *o, bool several, const char *path, cli_texts *files,
                    const char **table, const char **sheet)
{
    const dem_exporter *exporter = dem_exporter_of_file(path);
    bool standard = strcmp(path, "-") == 0;
    if (!standard && dem_folder_is_meant(path) && !(exporter && exporter->parts))
        o->folder = path;
    else if (!exporter && dem_file_has_suffix(path, "csv"))
        *table = path;
    else if (several && sheet && dem_file_has_suffix(path, "png"))
        *sheet = path;
    else if (o->into_folder && (standard || exporter))
        return cli_wrong_usage(tool, "--exports writes into a folder, '%s' is a file; name a folder with -o DIR", path);
    else if (o->into_folder)
        o->folder = path;
    else if (several)
        return cli_wrong_usage(tool, "several grains cannot all go to '%s'; name a folder with -o DIR/", path);
    else
        return add_file(tool, o, path, files);
    return 0;
}

int outputs_sort(const cli_tool *tool, job_options *o, bool several, cli_texts *files, const char **table,
                 const char **sheet)
{
    char known[256];
    dem_error error;
    for (size_t i = 0; i < o->formats.count; i++)
        if (!dem_exporter_find(o->formats.items[i]))
            return cli_wrong_usage(tool, "unknown format '%s'; use one of:%s", o->formats.items[i],
                                   format_names(known));
    for (size_t i = 0; i < o->outputs.count; i++) {
        int status = sort_one(tool, o, several, o->outputs.items[i], files, table, sheet);
        if (status)
            return status;
    }
    if (o->folder && files->count)
        return cli_wrong_usage(tool, "give -o either a folder or files, not both");
    if (o->folder && dem_folder_create(o->folder, &error) != DEM_OK)
        return cli_error(tool, &error);
    o->outputs = *files;
    return 0;
}

int outputs_status(dem_status worst, bool failed)
{
    if (cli_interrupted())
        return DEM_INTERRUPTED;
    if (worst == DEM_UNAVAILABLE || failed)
        return DEM_BAD_INPUT;
    return worst == DEM_NO_MEMORY ? DEM_FAILED : (int)worst;
}
