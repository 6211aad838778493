// VTK XML PolyData with raw appended data: one vertex per sphere. In ParaView: filter Glyph, type Sphere, scale
// array `diameter`, factor 1, all points; or the representation Point Gaussian with the array `radius`.
#include <stdlib.h>

#include "base/memory.h"
#include "out/export.h"

typedef struct array {
    const char *type, *name;
    int width;  // components of a tuple
    const void *data;
    size_t bytes;
    size_t tuples;  // only of field data
} array;

static void put_array(dem_buffer *out, const array *a, size_t *offset)
{
    dem_buffer_print(out, "<DataArray type=\"%s\" Name=\"%s\" NumberOfComponents=\"%d\"", a->type, a->name, a->width);
    if (a->tuples)
        dem_buffer_print(out, " NumberOfTuples=\"%zu\"", a->tuples);
    dem_buffer_print(out, " format=\"appended\" offset=\"%zu\"/>\n", *offset);
    *offset += sizeof(uint64_t) + a->bytes;
}

enum { FIELDS = 5, ARRAYS = FIELDS + 5 };

static void put_file(dem_buffer *out, const array arrays[ARRAYS], size_t count)
{
    size_t offset = 0;
    const uint16_t probe = 1;
    dem_buffer_print(
        out,
        "<?xml version=\"1.0\"?>\n"
        "<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"%s\" header_type=\"UInt64\">\n<PolyData>\n",
        *(const unsigned char *)&probe ? "LittleEndian" : "BigEndian");
    dem_buffer_text(out, "<FieldData>\n");
    for (int i = 0; i < FIELDS; i++)
        put_array(out, &arrays[i], &offset);
    dem_buffer_print(out,
                     "</FieldData>\n<Piece NumberOfPoints=\"%zu\" NumberOfVerts=\"%zu\" NumberOfLines=\"0\" "
                     "NumberOfStrips=\"0\" NumberOfPolys=\"0\">\n<Points>\n",
                     count, count);
    put_array(out, &arrays[FIELDS], &offset);
    dem_buffer_text(out, "</Points>\n<PointData Scalars=\"radius\">\n");
    put_array(out, &arrays[FIELDS + 1], &offset);
    put_array(out, &arrays[FIELDS + 2], &offset);
    dem_buffer_text(out, "</PointData>\n<Verts>\n");
    put_array(out, &arrays[FIELDS + 3], &offset);
    put_array(out, &arrays[FIELDS + 4], &offset);
    dem_buffer_text(out, "</Verts>\n</Piece>\n</PolyData>\n<AppendedData encoding=\"raw\">\n_");
    for (int i = 0; i < ARRAYS; i++) {
        uint64_t bytes = arrays[i].bytes;
        dem_buffer_bytes(out, &bytes, sizeof bytes);
        dem_buffer_bytes(out, arrays[i].data, arrays[i].bytes);
    }
    dem_buffer_text(out, "\n</AppendedData>\n</VTKFile>\n");
}

static dem_status write_vtp(const dem_clump *clump, const dem_export_options *options, dem_buffer *out,
                            dem_error *error)
{
    dem_clump_def def = dem_clump_view(clump);
    size_t n = def.ball_count;
    double *points = dem_alloc(5 * n, sizeof *points);     // x y z of each, then the radii, then the diameters
    int64_t *numbers = dem_alloc(2 * n, sizeof *numbers);  // 0 1 2 ..., then 1 2 3 ...
    if (points && numbers) {
        for (size_t i = 0; i < n; i++) {
            dem_ball b = export_ball(options, &def, def.balls[i]);
            points[3 * i] = b.centre.x;
            points[3 * i + 1] = b.centre.y;
            points[3 * i + 2] = b.centre.z;
            points[3 * n + i] = b.radius;
            points[4 * n + i] = 2 * b.radius;
            numbers[i] = (int64_t)i;
            numbers[n + i] = (int64_t)i + 1;
        }
        const double position[3] = {def.position.x, def.position.y, def.position.z};
        const double turn[4] = {def.orientation.w, def.orientation.x, def.orientation.y, def.orientation.z};
        const size_t real = sizeof(double), whole = sizeof(int64_t);
        const array arrays[ARRAYS] = {{"Float64", "density", 1, &def.density, real, 1},
                                      {"Float64", "mass", 1, &def.mass, real, 1},
                                      {"Float64", "inertia", 3, def.inertia, 3 * real, 1},
                                      {"Float64", "to_mesh_position", 3, position, 3 * real, 1},
                                      {"Float64", "to_mesh_orientation", 4, turn, 4 * real, 1},
                                      {"Float64", "Points", 3, points, 3 * n * real, 0},
                                      {"Float64", "radius", 1, points + 3 * n, n * real, 0},
                                      {"Float64", "diameter", 1, points + 4 * n, n * real, 0},
                                      {"Int64", "connectivity", 1, numbers, n * whole, 0},
                                      {"Int64", "offsets", 1, numbers + n, n * whole, 0}};
        put_file(out, arrays, n);
    }
    bool failed = !points || !numbers || out->failed;
    free(points);
    free(numbers);
    return failed ? dem_fail_memory(error) : DEM_OK;
}

extern const dem_exporter dem_export_vtp;
const dem_exporter dem_export_vtp = {
    .name = "vtp",
    .suffix = "vtp",
    .about = "ParaView: a point per sphere; Glyph with type Sphere, scale array diameter, factor 1 shows them",
    .write = write_vtp,
};
