#include "fuzz.h"

// the whole way of dem_mesh_read behind the file
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static const char *const names[] = {"a.stl", "a.obj", "a.off", "a"};
    if (size == 0)
        return 0;
    const char *name = names[data[0] % 4], *bytes = (const char *)data + 1;
    dem_mesh_format format = dem_mesh_sniff(name, bytes, size - 1);
    dem_mesh mesh = {0};
    dem_error error;
    if (format == DEM_FORMAT_UNKNOWN) {
        if (dem_mesh_refuse(name, bytes, size - 1, "STL", &error) != DEM_BAD_INPUT)
            abort();
        return 0;
    }
    dem_buffer copy = {.data = malloc(size)};
    if (!copy.data)
        return 0;
    memcpy(copy.data, bytes, size - 1);
    copy.size = copy.capacity = size - 1;
    if (dem_mesh_read_bytes(NULL, name, format, &copy, &mesh, &error) == DEM_OK)
        dem_mesh_free(&mesh);
    return 0;
}
