/// Volumes of labels: headers and data of any kind, and the surfaces of what they hold.
#include <math.h>
#include <stdlib.h>

#include "mesh/labels.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

enum { MOST_VOXELS = 20000, MOST_LABELS = 3 };

static void check_surface(const dem_volume *volume, dem_label label)
{
    dem_mesh mesh;
    dem_error error = {0};
    dem_status status = dem_label_surface(NULL, volume, &label, DEM_KEEP_ALL, &mesh, &error);
    if (status == DEM_BAD_INPUT && strchr(error.text, ';') && !mesh.vertices)
        return;
    if (status != DEM_OK || mesh.triangle_count < 12)
        abort();
    double volume_of = dem_mesh_solid(&mesh).volume, wanted = (double)label.voxels * dem_volume_voxel(volume);
    // coordinates far from zero have no digits left for it
    bool far = !(v3_norm(volume->origin) < 1e4 * cbrt(dem_volume_voxel(volume)));
    if (!far && fabs(volume_of / wanted - 1) > 0.01 && wanted > 1e-30 && wanted < 1e30)
        abort();
    dem_mesh_free(&mesh);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    dem_buffer bytes = {.data = malloc(size + 1), .size = size, .capacity = size + 1};
    dem_volume volume;
    dem_error error = {0};
    // the first byte chooses whether there is a header
    dem_volume_raw raw = {0};
    if (size && data[0] == 'R' && size > 2) {
        raw = (dem_volume_raw){.size = {1 + data[1] % 16, 1 + data[1] / 16, 1}, .type = (dem_voxel_type)(data[2] % 10)};
        raw.skip = 3;
    }
    memcpy(bytes.data, data, size);
    bytes.data[size] = 0;
    dem_status status = dem_volume_read_bytes(NULL, "fuzz", NULL, &bytes, &raw, &volume, &error);
    if (status != DEM_OK) {
        if (status != DEM_BAD_INPUT || error.code != status || !strchr(error.text, ';') || volume.labels)
            abort();
        return 0;
    }
    dem_label *labels;
    size_t count;
    status = dem_volume_count(&volume) <= MOST_VOXELS ? dem_labels_find(NULL, &volume, &labels, &count, &error)
                                                      : DEM_BAD_INPUT;
    for (size_t i = 0; status == DEM_OK && i < count && i < MOST_LABELS; i++)
        check_surface(&volume, labels[i]);
    if (status == DEM_OK)
        free(labels);
    dem_volume_free(&volume);
    return 0;
}
