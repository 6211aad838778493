// Our own file: all of it is kept.
#include <string.h>

#include "clump/file.h"
#include "clump/import_text.h"

static bool recognise_json(const char *text, size_t size)
{
    dem_word word = dem_import_first_word(text, size);
    return word.length > 0 && *word.text == '{';
}

static dem_status read_json(dem_import *import, const char *text, size_t size, dem_error *error)
{
    DEM_TRY(dem_clump_decode(text, size, import->file, &import->clump, error));
    dem_clump_def def = dem_clump_view(import->clump);
    for (size_t i = 0; i < def.ball_count; i++)
        DEM_TRY(dem_import_ball(import, 0, def.balls[i], error));
    import->in_metres = true;
    import->density = def.density;
    import->mass = def.mass;
    import->volume = def.volume;
    import->centre = (dem_vec3){0, 0, 0};
    memcpy(import->inertia, def.inertia, sizeof import->inertia);
    import->position = def.position;
    import->orientation = def.orientation;
    return DEM_OK;
}

extern const dem_importer dem_import_json;
const dem_importer dem_import_json = {
    .name = "json",
    .suffixes = "json",
    .about = "clumps of ours (dem-clump/1)",
    .recognise = recognise_json,
    .read = read_json,
};
