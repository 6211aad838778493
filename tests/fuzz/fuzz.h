/// What every fuzz target of a reader checks: no crash, and on success a mesh that keeps its promises.
/// Seeds are written by make_seeds.py; run as ./fuzz_obj -max_len=4096 seeds/obj.
#ifndef DEM_TESTS_FUZZ_H
#define DEM_TESTS_FUZZ_H

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/read.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

typedef dem_status fuzz_reader(const dem_ctx *ctx, const char *name, const char *bytes, size_t size, dem_mesh *mesh,
                               dem_error *error);

/// `data` is a block of its own, without a 0 behind it.
static inline void fuzz_read(fuzz_reader *read, const uint8_t *data, size_t size)
{
    dem_mesh mesh;
    dem_error error = {0};
    dem_status status = read(NULL, "fuzz", (const char *)data, size, &mesh, &error);
    if (status != DEM_OK) {
        if (status != DEM_BAD_INPUT || error.code != status || !strchr(error.text, ';') || mesh.vertices ||
            mesh.triangles)
            abort();
        return;
    }
    if (mesh.triangle_count == 0 || mesh.vertex_count == 0 || mesh.triangle_count > size)
        abort();
    for (size_t i = 0; i < mesh.vertex_count; i++)
        if (!isfinite(mesh.vertices[i].x) || !isfinite(mesh.vertices[i].y) || !isfinite(mesh.vertices[i].z))
            abort();
    for (size_t i = 0; i < 3 * mesh.triangle_count; i++)
        if (mesh.triangles[i] >= mesh.vertex_count)
            abort();
    dem_mesh_free(&mesh);
}

#endif
