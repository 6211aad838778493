#include "sim/plugin.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/level.h"
#include "sim/kernels.h"

#if DEM_PLUGINS
#include <dlfcn.h>

static dem_status refuse(dem_plugin *plugin, dem_error *error, const char *what, const char *name, const char *advice)
{
    dem_plugin_close(plugin);
    return dem_fail(error, DEM_BAD_INPUT, "the plug-in %s%s%s; %s", what, *name ? " " : "", name, advice);
}

static bool sound(const dem_law_spec *s)
{
    if (!s || !s->name || s->parameter_count > DEM_LAW_PARAMETERS || (s->parameter_count && !s->parameters))
        return false;
    for (uint32_t i = 0; i < s->parameter_count; i++)
        if (!s->parameters[i].name)
            return false;
    return s->vectors <= DEM_LAW_VECTORS && s->numbers <= DEM_LAW_NUMBERS;
}

dem_status dem_plugin_open(const char *path, dem_plugin *plugin, dem_error *error)
{
    *plugin = (dem_plugin){.handle = dlopen(path, RTLD_NOW | RTLD_LOCAL)};
    if (!plugin->handle) {
        const char *why = dlerror();
        return dem_fail(error, DEM_BAD_INPUT, "cannot load the plug-in: %.300s; compile it as dem/law.h says",
                        why ? why : path);
    }
    const dem_law_table *t = plugin->table = dlsym(plugin->handle, "dem_law_plugin");
    if (!t)
        return refuse(plugin, error, "has no symbol \"dem_law_plugin\"", "", "end its file with DEM_LAW_PLUGIN");
    if (t->abi != DEM_LAW_ABI || t->sizes != DEM_USER_SIZES || strcmp(t->made_for, DEM_VERSION) != 0)
        return refuse(plugin, error, "was compiled for another version of the library than", DEM_VERSION,
                      "compile it again with the headers of this one");
    char level[32];
    snprintf(level, sizeof level, "%s", t->level);
    if (dem_level_find(level) < 0)
        return refuse(plugin, error, "was compiled for x86-64", level,
                      "which this machine does not have: compile it here, with -march=native");
    if (!sound(t->spec) || !t->law || !t->instance_count)
        return refuse(plugin, error, "does not say rightly what its law has", "",
                      "see dem_law_spec in dem/law.h for names and largest numbers");
    return DEM_OK;
}

void dem_plugin_close(dem_plugin *plugin)
{
    if (plugin->handle)
        dlclose(plugin->handle);
    *plugin = (dem_plugin){NULL, NULL};
}

#else

dem_status dem_plugin_open(const char *path, dem_plugin *plugin, dem_error *error)
{
    (void)path;
    *plugin = (dem_plugin){NULL, NULL};
    return dem_fail(error, DEM_UNAVAILABLE, "this build loads no plug-ins; build with -DDEM_PLUGINS=ON");
}

void dem_plugin_close(dem_plugin *plugin)
{
    (void)plugin;
}

#endif
