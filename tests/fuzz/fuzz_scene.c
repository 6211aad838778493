// Whatever the scene reader accepts is written, read back, and written as the same text. A first byte above 127 takes
// the part up to the first newline as an override. No files are read.
#include <stdlib.h>
#include <string.h>

#include "sim/scene.h"

static void must(bool so)
{
    if (!so)
        abort();
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static void write_and_read(const dem_scene *scene)
{
    char *once, *twice;
    dem_scene back;
    dem_error error;
    must(dem_scene_resolved(scene, &once, &error) == DEM_OK);
    must(dem_scene_read_text(NULL, once, strlen(once), "again.json", NULL, NULL, &back, &error) == DEM_OK);
    must(dem_scene_resolved(&back, &twice, &error) == DEM_OK);
    must(strcmp(once, twice) == 0);
    dem_scene_release(&back);
    free(once);
    free(twice);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    const char *text = (const char *)data, *newline = memchr(text, '\n', size);
    const char *overrides[2] = {NULL, NULL};
    char *first = NULL;
    if (size && data[0] > 127 && newline) {
        size_t length = (size_t)(newline - text);
        first = malloc(length);
        if (!first)
            return 0;
        memcpy(first, text + 1, length - 1);
        first[length - 1] = 0;
        overrides[0] = first;
        text += length + 1;
        size -= length + 1;
    }
    dem_scene scene;
    dem_error error = {0};
    dem_status status = dem_scene_read_text(NULL, text, size, "fuzz.json", NULL, overrides, &scene, &error);
    if (status == DEM_OK)
        write_and_read(&scene);
    else
        must(error.code == status && error.text[0] && !scene.owner);
    dem_scene_release(&scene);
    free(first);
    return 0;
}
