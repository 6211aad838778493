// Whatever the reader of VTP files accepts is, written again, the same bytes.
#include <stdlib.h>
#include <string.h>

#include "out/vtp_read.h"

static void must(bool so)
{
    if (!so)
        abort();
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    dem_vtp_file file;
    dem_error error = {0};
    dem_status status = dem_vtp_decode((const char *)data, size, "fuzz", &file, &error);
    if (status != DEM_OK) {
        must(status == DEM_BAD_INPUT && error.code == status && strchr(error.text, ';') && !file.arena.chunks);
        return 0;
    }
    dem_buffer again = {0};
    dem_vtp_put(&again, &file.vtp);
    must(again.size == size && memcmp(again.data, data, size) == 0);
    dem_buffer_release(&again);
    dem_vtp_file_release(&file);
    return 0;
}
