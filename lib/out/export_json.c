#include "clump/file.h"
#include "out/export.h"

static dem_status write_json(const dem_clump *clump, const dem_export_options *options, dem_buffer *out,
                             dem_error *error)
{
    (void)options;
    return dem_clump_encode(clump, out, error);
}

extern const dem_exporter dem_export_json;
const dem_exporter dem_export_json = {
    .name = "json",
    .suffix = "json",
    .about = "everything (dem-clump/1): spheres, mass, inertia, fidelity, shape, how it was made",
    .write = write_json,
};
