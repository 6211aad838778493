/// Plug-ins with laws of the user's. The one place that loads code.
#ifndef DEM_SIM_PLUGIN_H
#define DEM_SIM_PLUGIN_H

#include "base/status.h"
#define DEM_LAW_TYPES
#include "dem/law.h"

typedef struct dem_plugin {
    void *handle;
    const dem_law_table *table;
} dem_plugin;

/// Errors: DEM_BAD_INPUT where the file is no plug-in, or not one for this library and machine.
dem_status dem_plugin_open(const char *path, dem_plugin *plugin, dem_error *error);
void dem_plugin_close(dem_plugin *plugin);

#endif
