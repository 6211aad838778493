#include "dem/export.h"

#include <stdio.h>
#include <string.h>

#include "base/status.h"
#include "out/export.h"

const char *dem_export_format(size_t index)
{
    const dem_exporter *const *all = dem_exporters();
    size_t count = 0;
    while (all[count])
        count++;
    return index < count ? all[index]->name : NULL;
}

static dem_status refuse(const char *format, const char *path, dem_error *error)
{
    char known[512] = "";
    for (const dem_exporter *const *e = dem_exporters(); *e; e++)
        snprintf(known + strlen(known), sizeof known - strlen(known), " %s", (*e)->name);
    if (format)
        return dem_fail(error, DEM_USAGE, "unknown format '%s'; use one of:%s", format, known);
    return dem_fail(error, DEM_USAGE, "the name '%s' does not tell the format; name one of:%s", path, known);
}

dem_status dem_clump_export(const dem_ctx *ctx, const dem_clump *clump, const dem_mesh *mesh, const char *format,
                            bool in_mesh_frame, const char *path, dem_error *error)
{
    const dem_exporter *exporter = format ? dem_exporter_find(format) : dem_exporter_of_file(path);
    if (!exporter)
        return refuse(format, path, error);
    dem_export_options options = {
        .frame = in_mesh_frame ? DEM_FRAME_MESH : DEM_FRAME_PRINCIPAL, .mesh = mesh, .threads = dem_threads(ctx)};
    return dem_export(exporter, clump, &options, path, error);
}
