// Whatever the clump reader accepts is written and read back as the same bytes.
#include <stdlib.h>
#include <string.h>

#include "clump/file.h"

static void must(bool so)
{
    if (!so)
        abort();
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    dem_clump *clump, *again;
    dem_error error = {0};
    if (dem_clump_decode((const char *)data, size, "fuzz.json", &clump, &error) != DEM_OK) {
        must(!clump && error.code != DEM_OK && error.text[0]);
        return 0;
    }
    dem_buffer text = {0};
    must(dem_clump_encode(clump, &text, &error) == DEM_OK);
    must(dem_clump_decode(text.data, text.size, "again.json", &again, &error) == DEM_OK);
    must(dem_clump_bytes(clump) == dem_clump_bytes(again));
    must(memcmp(clump, again, dem_clump_bytes(clump)) == 0);
    dem_buffer_release(&text);
    dem_clump_destroy(clump);
    dem_clump_destroy(again);
    return 0;
}
