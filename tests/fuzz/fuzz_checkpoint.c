// Whatever the reader of checkpoints accepts lies inside the file, and a whole file with any header is refused in words
// or accepted. The first byte chooses between a file as it is and a header to be put into a whole one.
#include <stdlib.h>
#include <string.h>

#include "base/hash.h"
#include "out/checkpoint.h"

static void must(bool so)
{
    if (!so)
        abort();
}

static void decode(dem_buffer *file)
{
    dem_checkpoint c;
    dem_error error = {0};
    const char *begin = file->data, *end = begin + file->size;
    dem_status status = dem_checkpoint_decode(file, "fuzz", NULL, &c, &error);
    if (status == DEM_OK) {
        const char *state = c.state;
        must(!file->data && state >= begin && c.state_size <= (size_t)(end - state));
        must(c.title && strlen(c.scene) == 64);
    } else {
        must(status == DEM_BAD_INPUT && error.code == status && error.text[0] && file->data == begin);
        must(!c.state && !c.header && !c.file.data);
    }
    dem_checkpoint_release(&c);
    dem_buffer_release(file);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    dem_buffer file = {0};
    if (size == 0)
        return 0;
    if (data[0] & 1) {
        char sum[65];
        dem_buffer_print(&file, "dem-checkpoint/1\n%020zu %020d\n", size - 1, 5);
        dem_buffer_bytes(&file, data + 1, size - 1);
        dem_buffer_text(&file, "state");
        dem_sha256(file.data, file.size, sum);
        dem_buffer_print(&file, "%s\n", sum);
    } else {
        dem_buffer_bytes(&file, data + 1, size - 1);
    }
    decode(&file);
    return 0;
}
