#include "out/export.h"

#include <string.h>

#include "base/file.h"
#include "base/memory.h"

extern const dem_exporter dem_export_json, dem_export_xyzr, dem_export_vtp, dem_export_stl, dem_export_png;

static const dem_exporter *const exporters[] = {
    &dem_export_json,
    &dem_export_xyzr,
    &dem_export_vtp,
    &dem_export_stl,
    &dem_export_png,
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

const dem_exporter *dem_exporter_of_file(const char *path)
{
    for (int i = 0; exporters[i]; i++)
        if (dem_file_has_suffix(path, exporters[i]->suffix))
            return exporters[i];
    return NULL;
}

dem_status dem_export(const dem_exporter *exporter, const dem_clump *clump, const dem_export_options *options,
                      const char *path, dem_error *error)
{
    dem_buffer out = {0};
    dem_status status = exporter->write(clump, options, &out, error);
    if (status == DEM_OK)
        return dem_file_write_buffer(path, &out, error);
    dem_buffer_release(&out);
    return status;
}

dem_ball *dem_export_balls(const dem_export_options *options, const dem_clump_def *clump)
{
    dem_ball *balls = dem_alloc(clump->ball_count, sizeof *balls);
    for (size_t i = 0; balls && i < clump->ball_count; i++)
        balls[i] = export_ball(options, clump, clump->balls[i]);
    return balls;
}
