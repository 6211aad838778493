#include "fuzz.h"

enum { HEADER = 84, FACET = 50 };

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    fuzz_read(dem_read_stl_text, data, size);
    fuzz_read(dem_read_stl_binary, data, size);
    if (size < HEADER)
        return 0;
    // and with a count that fits, to get at the facets
    size_t count = (size - HEADER) / FACET, fitting = HEADER + count * FACET;
    uint8_t *copy = malloc(fitting);
    if (!copy)
        return 0;
    memcpy(copy, data, fitting);
    for (int k = 0; k < 4; k++)
        copy[80 + k] = (uint8_t)(count >> 8 * k);
    fuzz_read(dem_read_stl_binary, copy, fitting);
    free(copy);
    return 0;
}
