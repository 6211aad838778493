/// Grains as files: one, or a folder of them with a table; and the report about them.
#ifndef DEM_TOOLS_GRAIN_FAMILY_H
#define DEM_TOOLS_GRAIN_FAMILY_H

#include "grain_settings.h"
#include "mesh/harmonics.h"

/// What is known of a scan that grains were fitted to.
typedef struct grain_scan {
    dem_harmonics of;
    dem_harmonics_fit fit;
    dem_surface_distance distance;  // between scan and twin [m]
} grain_scan;

typedef struct grain_row {
    char file[64];  // name within the folder
    long seed;
    size_t vertices, triangles;
    double volume, diameter;
    dem_vec3 extent;
} grain_row;

typedef struct grain_family {
    const settings *s;
    dem_mesh_format format;
    size_t wanted, made, room;
    int digits;  // of coordinates; 0: as many as the mesh needs
    const char *kind;
    const grain_scan *scan;  // NULL: none
    cli_session session;
    grain_row *rows;  // [made]
} grain_family;

/// Opens the session and makes the folder, if there is to be one. Returns the exit status.
int grain_family_begin(grain_family *family, const cli_tool *tool, const settings *s, dem_mesh_format format,
                       size_t wanted, const char *kind);
/// Writes one grain; `name` is that in a folder, without its suffix, `origin` the command that makes it again.
dem_status grain_family_add(grain_family *family, const dem_mesh *mesh, const char *name, long seed, const char *origin,
                            dem_error *error);
/// Writes the table, reports, releases. `command` is the one that makes all of it.
int grain_family_end(grain_family *family, const char *command, int status);

#endif
