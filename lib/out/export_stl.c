// The surface of the union as a binary STL.
#include <stdlib.h>

#include "base/memory.h"
#include "out/export.h"
#include "out/facets.h"

enum {
    HEADER = 80,
    FINE = 3,
    COARSE = 2,
    MANY = 500,  // balls from which coarse is fine enough
};

static void put_floats(dem_buffer *out, dem_vec3 v)
{
    float f[3] = {(float)v.x, (float)v.y, (float)v.z};
    dem_buffer_bytes(out, f, sizeof f);
}

static void put_facet(dem_buffer *out, const dem_facet *f)
{
    const dem_vec3 *c = f->corners;
    put_floats(out, v3_unit(v3_cross(v3_sub(c[1], c[0]), v3_sub(c[2], c[0]))));
    for (int k = 0; k < 3; k++)
        put_floats(out, c[k]);
    dem_buffer_bytes(out, "\0\0", 2);
}

static dem_status write_stl(const dem_clump *clump, const dem_export_options *options, dem_buffer *out,
                            dem_error *error)
{
    static const char header[HEADER] = "union of the spheres of a clump; dem-clump " DEM_VERSION;
    dem_clump_def def = dem_clump_view(clump);
    dem_ball *balls = dem_export_balls(options, &def);
    if (!balls)
        return dem_fail_memory(error);
    dem_facets facets;
    dem_status status = dem_balls_facets(balls, def.ball_count, def.ball_count < MANY ? FINE : COARSE, &facets, error);
    free(balls);
    DEM_TRY(status);
    uint32_t count = (uint32_t)facets.count;
    dem_buffer_bytes(out, header, sizeof header);
    dem_buffer_bytes(out, &count, sizeof count);
    for (size_t i = 0; i < facets.count; i++)
        put_facet(out, &facets.facets[i]);
    dem_facets_release(&facets);
    return out->failed ? dem_fail_memory(error) : DEM_OK;
}

extern const dem_exporter dem_export_stl;
const dem_exporter dem_export_stl = {
    .name = "stl",
    .suffix = "stl",
    .about = "the surface of the union of the spheres as triangles (binary); looks closed, is not welded",
    .write = write_stl,
};
