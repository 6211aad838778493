#include "out/export.h"

#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "base/file.h"
#include "base/memory.h"

extern const dem_exporter dem_export_json, dem_export_xyzr, dem_export_vtp, dem_export_stl, dem_export_png;
extern const dem_exporter dem_export_pfc, dem_export_liggghts, dem_export_lammps, dem_export_yade, dem_export_mercury,
    dem_export_deme, dem_export_kratos, dem_export_edem, dem_export_mfix;

static const dem_exporter *const exporters[] = {
    &dem_export_json,
    &dem_export_xyzr,
    &dem_export_vtp,
    &dem_export_stl,
    &dem_export_png,
    &dem_export_pfc,
    &dem_export_liggghts,
    &dem_export_lammps,
    &dem_export_yade,
    &dem_export_mercury,
    &dem_export_deme,
    &dem_export_kratos,
    &dem_export_edem,
    &dem_export_mfix,
    NULL,
};

const dem_exporter *const *dem_exporters(void)
{
    return exporters;
}

const dem_exporter *dem_exporter_find(const char *name)
{
    for (int i = 0; exporters[i]; i++)
        if (strcmp(exporters[i]->name, name) == 0)
            return exporters[i];
    return NULL;
}

// where `.ending` begins at the end of the file's name; NULL: it does not end so
static const char *ending(const char *path, const char *text)
{
    const char *name = dem_file_name(path);
    size_t length = strlen(name), wanted = strlen(text) + 1;
    const char *at = name + length - wanted;
    return length >= wanted && *at == '.' && strcasecmp(at + 1, text) == 0 ? at : NULL;
}

const dem_exporter *dem_exporter_of_file(const char *path)
{
    for (int i = 0; exporters[i]; i++)
        if (ending(path, exporters[i]->suffix) || ending(path, exporters[i]->name))
            return exporters[i];
    return NULL;
}

size_t dem_exporter_stem(const dem_exporter *exporter, const char *path)
{
    const char *end = ending(path, exporter->suffix);
    if (!end)
        end = ending(path, exporter->name);
    if (!end)
        end = strrchr(dem_file_name(path), '.');
    return end ? (size_t)(end - path) : strlen(path);
}

static dem_status write_file(dem_export_write *write, const dem_clump *clump, const dem_export_options *options,
                             const char *path, dem_error *error)
{
    dem_buffer out = {0};
    dem_status status = write(clump, options, &out, error);
    if (status == DEM_OK)
        return dem_file_write_buffer(path, &out, error);
    dem_buffer_release(&out);
    return status;
}

static dem_status write_part(const dem_export_part *part, const dem_clump *clump, const dem_export_options *options,
                             const char *folder, dem_error *error)
{
    char *path = dem_path_join(folder, "%s", part->path);
    if (!path)
        return dem_fail_memory(error);
    char *slash = strrchr(path, '/');
    *slash = 0;
    dem_status status = dem_folder_create(path, error);
    *slash = '/';
    if (status == DEM_OK)
        status = write_file(part->write, clump, options, path, error);
    free(path);
    return status;
}

dem_status dem_export(const dem_exporter *exporter, const dem_clump *clump, const dem_export_options *options,
                      const char *path, dem_error *error)
{
    dem_export_options named = *options;
    bool standard = strcmp(path, "-") == 0;
    named.file = standard ? NULL : path;
    if (exporter->write)
        return write_file(exporter->write, clump, &named, path, error);
    if (standard)
        return dem_fail(error, DEM_USAGE, "%s is a folder of files; give it a name with -o", exporter->name);
    for (const dem_export_part *part = exporter->parts; part->path; part++)
        DEM_TRY(write_part(part, clump, &named, path, error));
    return DEM_OK;
}

dem_ball *dem_export_balls(const dem_export_options *options, const dem_clump_def *clump)
{
    dem_ball *balls = dem_alloc(clump->ball_count, sizeof *balls);
    for (size_t i = 0; balls && i < clump->ball_count; i++)
        balls[i] = export_ball(options, clump, clump->balls[i]);
    return balls;
}
