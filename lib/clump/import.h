/// Clumps of other programs: a registry of readers, and what makes a clump of ours of what they find.
///
/// A format is one file import_<name>.c with one const record, and one line in import.c.
#ifndef DEM_CLUMP_IMPORT_H
#define DEM_CLUMP_IMPORT_H

#include "base/text.h"
#include "dem/clump.h"

/// More spheres than that are not a clump that anyone can run.
enum { DEM_IMPORT_SPHERES = 100000 };

/// What a file says, in its own frame and units. What it does not say is NAN.
typedef struct dem_import {
    const char *file;    ///< for messages
    const char *folder;  ///< where files that it names are looked for; NULL: they are not read
    const char *format;  ///< of the reader
    const dem_ctx *ctx;
    char name[256];  ///< "": the file has none
    dem_ball *balls;
    size_t count, capacity;
    double density, mass, volume;
    dem_vec3 centre;    ///< of mass
    double inertia[3];  ///< principal, ascending, about the centre
    dem_quat axes;      ///< principal frame -> frame of the file
    bool inertia_of_unit_mass;
    long mass_line, inertia_line;  ///< where they stand; 0: unknown
    bool in_metres;                ///< the file itself says that it is in SI units
    dem_vec3 position;             ///< frame of the file -> frame of the mesh
    dem_quat orientation;
    dem_clump *clump;  ///< the clump of ours that the file was, or NULL
} dem_import;

typedef struct dem_importer {
    const char *name;
    const char *suffixes;  ///< of file names, separated by blanks; they decide where the content fits several formats
    const char *about;
    /// True where the text looks like this format.
    bool (*recognise)(const char *text, size_t size);
    /// Fills what `import` is to hold. Errors: DEM_BAD_INPUT with file and line, DEM_NO_MEMORY.
    dem_status (*read)(dem_import *import, const char *text, size_t size, dem_error *error);
} dem_importer;

/// All formats, NULL behind the last.
const dem_importer *const *dem_importers(void);
/// By name; NULL: there is none.
const dem_importer *dem_importer_find(const char *name);
/// By content, and by name where that leaves a choice; NULL: it is none of them.
const dem_importer *dem_importer_of(const char *name, const char *text, size_t size);

/// Reads a text. `importer` NULL: decided by dem_importer_of. `folder` as in dem_import. `import` is to be released
/// whether it succeeds or not; `*used` (may be NULL) receives the format.
dem_status dem_import_decode(const dem_ctx *ctx, const char *file, const char *folder, const char *text, size_t size,
                             const dem_importer *importer, dem_import *import, const dem_importer **used,
                             dem_error *error);
/// Reads a file; "-" is standard input.
dem_status dem_import_read(const dem_ctx *ctx, const char *path, const dem_importer *importer, dem_import *import,
                           const dem_importer **used, dem_error *error);
void dem_import_release(dem_import *import);

/// For readers: adds a sphere at a line of the file; refuses what is not finite or has no radius.
dem_status dem_import_ball(dem_import *import, long line, dem_ball ball, dem_error *error);
/// For readers: the inertia tensor about the centre of mass, as it stands at a line; refuses what no body can have.
dem_status dem_import_tensor(dem_import *import, long line, dem_sym3 tensor, dem_error *error);
/// For readers: a name, made printable.
void dem_import_name(dem_import *import, const char *text, size_t length);

typedef enum dem_import_mass { DEM_IMPORT_FILE, DEM_IMPORT_UNION, DEM_IMPORT_MESH } dem_import_mass;

/// What becomes of it. Zero-initialised but for the units and the density: nothing is changed.
typedef struct dem_import_options {
    double unit;       ///< length of one unit of the file [m]
    double mass_unit;  ///< [kg]
    const char *unit_name;
    double density;             ///< wanted [kg/m^3]; 0: the file's, or that of its mass and volume, or quartz
    double mass;                ///< wanted [kg]; 0: as it comes
    double size;                ///< equivalent-volume diameter to rescale to [m]; 0: as it is
    dem_import_mass mass_from;  ///< whose mass, centre and inertia the clump gets; what the file lacks is the union's
    const char *name;           ///< NULL: the file's, or that of the file
    const char *source_mesh, *source_sha256;
    const dem_mesh *mesh;  ///< of the grain, closed, in metres in the frame the file's `position` leads to; NULL: none
    size_t surface_triangles;  ///< of the mesh that are kept for pictures
} dem_import_options;
dem_import_options dem_import_defaults(void);

/// What the file had, in SI units after scaling, beside what is exact for its spheres. NAN: not in the file.
typedef struct dem_import_report {
    double mass, volume, inertia[3];
    double centre_offset;  ///< of the file's centre from the union's [m]
    double density;        ///< that both are compared at [kg/m^3]
    size_t duplicates;     ///< spheres that stand there more than once
    size_t redundant;      ///< spheres without exposed surface
    size_t pieces;
    double moment_residual;  ///< largest relative difference of volume and inertia tensor, file against union [-]
} dem_import_report;

/// Makes the clump: spheres moved and turned into the principal frame, which `to_mesh` leads back from. Warnings go
/// to the log. `report` may be NULL.
dem_status dem_import_clump(const dem_import *import, const dem_import_options *options, dem_clump **clump,
                            dem_import_report *report, dem_error *error);

#endif
