// VTK XML PolyData with raw appended data: one vertex per sphere. In ParaView: filter Glyph, type Sphere, scale
// array `diameter`, factor 1, all points; or the representation Point Gaussian with the array `radius`.
#include <stdlib.h>

#include "base/memory.h"
#include "out/export.h"
#include "out/vtp.h"

static dem_status write_vtp(const dem_clump *clump, const dem_export_options *options, dem_buffer *out,
                            dem_error *error)
{
    dem_clump_def def = dem_clump_view(clump);
    size_t n = def.ball_count;
    dem_vec3 *points = dem_alloc(n, sizeof *points);
    double *radii = dem_alloc(2 * n, sizeof *radii);  // then the diameters
    if (points && radii) {
        for (size_t i = 0; i < n; i++) {
            dem_ball b = export_ball(options, &def, def.balls[i]);
            points[i] = b.centre;
            radii[i] = b.radius;
            radii[n + i] = 2 * b.radius;
        }
        const double turn[4] = {def.orientation.w, def.orientation.x, def.orientation.y, def.orientation.z};
        const dem_vtp_array fields[] = {{"density", DEM_VTP_FLOAT64, 1, &def.density},
                                        {"mass", DEM_VTP_FLOAT64, 1, &def.mass},
                                        {"inertia", DEM_VTP_FLOAT64, 3, def.inertia},
                                        {"to_mesh_position", DEM_VTP_FLOAT64, 3, &def.position},
                                        {"to_mesh_orientation", DEM_VTP_FLOAT64, 4, turn}};
        const dem_vtp_array arrays[] = {{"radius", DEM_VTP_FLOAT64, 1, radii},
                                        {"diameter", DEM_VTP_FLOAT64, 1, radii + n}};
        dem_vtp_put(out, &(dem_vtp){.time = NAN,
                                    .fields = fields,
                                    .field_count = sizeof fields / sizeof *fields,
                                    .points = points,
                                    .point_count = n,
                                    .point_arrays = arrays,
                                    .point_array_count = sizeof arrays / sizeof *arrays,
                                    .scalars = "radius",
                                    .vertices = true});
    }
    bool failed = !points || !radii || out->failed;
    free(points);
    free(radii);
    return failed ? dem_fail_memory(error) : DEM_OK;
}

extern const dem_exporter dem_export_vtp;
const dem_exporter dem_export_vtp = {
    .name = "vtp",
    .suffix = "vtp",
    .about = "ParaView: a point per sphere; Glyph with type Sphere, scale array diameter, factor 1 shows them",
    .write = write_vtp,
};
