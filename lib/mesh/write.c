#include "mesh/write.h"

#include <string.h>

#include "base/file.h"
#include "math/vec.h"

enum { STL_HEADER = 80 };

static const char *const suffixes[] = {
    [DEM_MESH_OBJ] = "obj", [DEM_MESH_STL] = "stl", [DEM_MESH_PLY] = "ply", [DEM_MESH_OFF] = "off"};

bool dem_mesh_format_of(const char *path, dem_mesh_format *format)
{
    for (size_t i = 0; i < sizeof suffixes / sizeof *suffixes; i++)
        if (dem_file_has_suffix(path, suffixes[i])) {
            *format = (dem_mesh_format)i;
            return true;
        }
    return false;
}

static void put_comment(dem_buffer *out, const char *mark, const char *comment)
{
    if (comment)
        dem_buffer_print(out, "%s %s\n", mark, comment);
}

static void put_vertices(dem_buffer *out, const dem_mesh *mesh, const char *lead, int digits)
{
    for (size_t i = 0; i < mesh->vertex_count; i++) {
        dem_buffer_text(out, lead);
        for (int k = 0; k < 3; k++) {
            dem_buffer_number(out, v3_get(mesh->vertices[i], k) + 0.0, digits);  // + 0.0: no "-0"
            dem_buffer_text(out, k < 2 ? " " : "\n");
        }
    }
}

static void put_obj(dem_buffer *out, const dem_mesh *mesh, const char *comment, int digits)
{
    put_comment(out, "#", comment);
    put_vertices(out, mesh, "v ", digits);
    for (size_t t = 0; t < mesh->triangle_count; t++) {
        const uint32_t *v = &mesh->triangles[3 * t];
        dem_buffer_print(out, "f %lu %lu %lu\n", v[0] + 1ul, v[1] + 1ul, v[2] + 1ul);
    }
}

static void put_off(dem_buffer *out, const dem_mesh *mesh, const char *comment, int digits)
{
    dem_buffer_text(out, "OFF\n");
    put_comment(out, "#", comment);
    dem_buffer_print(out, "%zu %zu 0\n", mesh->vertex_count, mesh->triangle_count);
    put_vertices(out, mesh, "", digits);
    for (size_t t = 0; t < mesh->triangle_count; t++) {
        const uint32_t *v = &mesh->triangles[3 * t];
        dem_buffer_print(out, "3 %lu %lu %lu\n", v[0] + 0ul, v[1] + 0ul, v[2] + 0ul);
    }
}

// little-endian on every machine
static void put_bits(dem_buffer *out, uint64_t bits, int bytes)
{
    char text[8];
    for (int i = 0; i < bytes; i++)
        text[i] = (char)(bits >> (8 * i) & 0xff);
    dem_buffer_bytes(out, text, (size_t)bytes);
}

static void put_float(dem_buffer *out, double value)
{
    float narrow = (float)value;
    uint32_t bits;
    memcpy(&bits, &narrow, sizeof bits);
    put_bits(out, bits, 4);
}

static void put_double(dem_buffer *out, double value)
{
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    put_bits(out, bits, 8);
}

static void put_stl(dem_buffer *out, const dem_mesh *mesh, const char *comment)
{
    char header[STL_HEADER] = "binary STL ";  // must not begin with "solid"
    size_t used = strlen(header), length = comment ? strlen(comment) : 0;
    memcpy(header + used, comment ? comment : "", length < STL_HEADER - used ? length : STL_HEADER - used);
    dem_buffer_bytes(out, header, sizeof header);
    put_bits(out, mesh->triangle_count, 4);
    for (size_t t = 0; t < mesh->triangle_count; t++) {
        const uint32_t *v = &mesh->triangles[3 * t];
        dem_vec3 a = mesh->vertices[v[0]], b = mesh->vertices[v[1]], c = mesh->vertices[v[2]];
        dem_vec3 normal = v3_cross(v3_sub(b, a), v3_sub(c, a));
        double length2 = v3_norm2(normal);
        dem_vec3 rows[4] = {length2 > 0 ? v3_scale(normal, 1 / sqrt(length2)) : v3(0, 0, 0), a, b, c};
        for (int i = 0; i < 4; i++)
            for (int k = 0; k < 3; k++)
                put_float(out, v3_get(rows[i], k));
        put_bits(out, 0, 2);
    }
}

static void put_ply(dem_buffer *out, const dem_mesh *mesh, const char *comment)
{
    dem_buffer_text(out, "ply\nformat binary_little_endian 1.0\n");
    put_comment(out, "comment", comment);
    dem_buffer_print(out, "element vertex %zu\nproperty double x\nproperty double y\nproperty double z\n",
                     mesh->vertex_count);
    dem_buffer_print(out, "element face %zu\nproperty list uchar uint vertex_indices\nend_header\n",
                     mesh->triangle_count);
    for (size_t i = 0; i < mesh->vertex_count; i++)
        for (int k = 0; k < 3; k++)
            put_double(out, v3_get(mesh->vertices[i], k));
    for (size_t t = 0; t < mesh->triangle_count; t++) {
        put_bits(out, 3, 1);
        for (size_t k = 0; k < 3; k++)
            put_bits(out, mesh->triangles[3 * t + k], 4);
    }
}

void dem_mesh_put(const dem_mesh *mesh, dem_mesh_format format, const char *comment, int digits, dem_buffer *out)
{
    switch (format) {
    case DEM_MESH_OBJ:
        put_obj(out, mesh, comment, digits);
        return;
    case DEM_MESH_STL:
        put_stl(out, mesh, comment);
        return;
    case DEM_MESH_PLY:
        put_ply(out, mesh, comment);
        return;
    case DEM_MESH_OFF:
        put_off(out, mesh, comment, digits);
        return;
    }
}
