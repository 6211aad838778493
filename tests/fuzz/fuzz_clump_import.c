// Clumps of other programs: whatever a reader accepts becomes a clump that can be written, or is refused with a reason.
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "clump/file.h"
#include "clump/import.h"

static void must(bool so)
{
    if (!so)
        abort();
}

static void must_explain(dem_status status, const dem_error *error)
{
    must((status == DEM_BAD_INPUT || status == DEM_NO_MEMORY) && error->code == status && error->text[0]);
}

// a clump is written and read back as the same one
static void check_clump(dem_clump *clump)
{
    dem_clump_def def = dem_clump_view(clump);
    dem_error error = {0};
    dem_buffer text = {0};
    dem_clump *again;
    must(def.mass > 0 && isfinite(def.mass) && def.ball_count > 0);
    must(fabs(def.mass - def.density * def.volume) <= 1e-9 * def.mass || def.mass_from != DEM_MASS_FROM_UNION);
    must(dem_clump_encode(clump, &text, &error) == DEM_OK);
    must(dem_clump_decode(text.data, text.size, "again.json", &again, &error) == DEM_OK);
    must(dem_clump_bytes(clump) == dem_clump_bytes(again));
    dem_buffer_release(&text);
    dem_clump_destroy(again);
    dem_clump_destroy(clump);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

// the first byte chooses the reader and the options
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static const double units[] = {1, 1e-3}, densities[] = {0, 2000}, sizes[] = {0, 0.01};
    const dem_importer *const *all = dem_importers();
    dem_import import;
    dem_error error = {0};
    int choice = size ? data[0] : 0, count = 0;
    while (all[count])
        count++;
    const dem_importer *importer = choice % 8 < count ? all[choice % 8] : NULL;
    dem_status status = dem_import_decode(NULL, "fuzz", NULL, (const char *)data + (size > 0), size - (size > 0),
                                          importer, &import, NULL, &error);
    if (status == DEM_OK) {
        dem_import_options options = dem_import_defaults();
        dem_clump *clump;
        options.unit = units[choice >> 3 & 1];
        options.density = densities[choice >> 4 & 1];
        options.size = sizes[choice >> 5 & 1];
        options.mass_from = choice >> 6 & 1 ? DEM_IMPORT_UNION : DEM_IMPORT_FILE;
        status = dem_import_clump(&import, &options, &clump, NULL, &error);
        if (status == DEM_OK)
            check_clump(clump);
    }
    if (status != DEM_OK)
        must_explain(status, &error);
    dem_import_release(&import);
    return 0;
}
