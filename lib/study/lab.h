/// Measured tests of granular matter: what a laboratory does to a sample, as scenes with parameters, and what it reads
/// off. The scene that is written for dem-run is the text that the test itself runs.
///
/// A test knows grains by one shape only, in sizes spread about one diameter (of the sphere of equal volume). Lengths
/// inside are counted in diameters and times in the time that a grain needs for a diameter, so that results do not
/// depend on the scale; how stiff grains are is told by the overlap that the load makes.
#ifndef DEM_STUDY_LAB_H
#define DEM_STUDY_LAB_H

#include "base/parameter.h"
#include "base/text.h"
#include "dem/world.h"
#include "math/vec.h"

/// Parameters that every test has, before its own.
typedef enum dem_lab_common {
    LAB_DIAMETER,
    LAB_SPREAD,
    LAB_DENSITY,
    LAB_FRICTION,
    LAB_RESTITUTION,
    LAB_OVERLAP,
    LAB_BODIES,
    LAB_COMMON
} dem_lab_common;
extern const dem_parameter dem_lab_common_params[LAB_COMMON];

enum { DEM_LAB_PARAMS = LAB_COMMON + 8, DEM_LAB_FIGURES = 12, DEM_LAB_COLUMNS = 10 };

/// A number that a test finds, or a column of its path.
typedef struct dem_lab_name {
    const char *name, *unit, *about;
} dem_lab_name;

typedef struct dem_lab dem_lab;

typedef struct dem_lab_test {
    const char *name, *about;
    const dem_parameter *params;  ///< its own
    size_t param_count;
    double bodies, overlap;  ///< standards of LAB_BODIES and LAB_OVERLAP
    const dem_lab_name *figures;
    size_t figure_count;
    size_t main_count;            ///< the first so many are what studies compare
    const dem_lab_name *columns;  ///< of the path; NULL: it has none
    size_t column_count;
    dem_status (*prepare)(dem_lab *lab, dem_error *error);  ///< NULL: nothing
    void (*write)(dem_lab *lab, dem_buffer *out);           ///< walls, bodies and all that is the test's own
    dem_status (*run)(dem_lab *lab, dem_error *error);      ///< of the world that was written
} dem_lab_test;

extern const dem_lab_test dem_lab_pour, dem_lab_heap, dem_lab_triaxial, dem_lab_shear_box, dem_lab_drum;

/// The index-th test, NULL behind the last.
const dem_lab_test *dem_lab_test_at(size_t index);
const dem_lab_test *dem_lab_test_find(const char *name);
/// The index-th parameter of a test, common ones first; NULL behind the last. Its standard is that of the test.
const dem_parameter *dem_lab_param(const dem_lab_test *test, size_t index, double *standard);

/// The grain. Neither: a sphere.
typedef struct dem_lab_grain {
    const char *clump_file;  ///< as a scene names it
    const dem_clump *clump;  ///< what is in it, or in no file
    dem_multiple multiple;
} dem_lab_grain;

/// A test under way. Begin, run or write, read, end.
struct dem_lab {
    const dem_ctx *ctx;
    const dem_lab_test *test;
    dem_lab_grain grain;
    uint64_t seed;
    double values[DEM_LAB_PARAMS];
    double figures[DEM_LAB_FIGURES];  ///< NAN: not found
    double *path;                     ///< [rows * column_count]
    size_t rows, capacity;
    uint64_t steps;  ///< of all bodies' worlds
    double seconds;  ///< spent in them

    // between prepare and run
    dem_body_def *sample;  ///< NULL: bodies are those of the fill
    size_t sample_count;
    const char *sample_file;  ///< where a scene that is written finds them
    double low[3], high[3];   ///< the box it fills [m]
    dem_scene scene;
    dem_world *world;
};

/// `values` one per parameter, NAN or no array at all: the standard. Errors: DEM_USAGE for what is out of range.
dem_status dem_lab_begin(dem_lab *lab, const dem_ctx *ctx, const dem_lab_test *test, const dem_lab_grain *grain,
                         const double *values, uint64_t seed, dem_error *error);
void dem_lab_end(dem_lab *lab);
/// Prepares the sample and does the test. Errors: those of the worlds.
dem_status dem_lab_run(dem_lab *lab, dem_error *error);
/// Prepares the sample where that is needed, and appends the scene of the test itself, with comments that say what it
/// shows. A prepared sample goes into `bodies`, for a file `bodies_file` beside the scene.
dem_status dem_lab_scene(dem_lab *lab, const char *bodies_file, dem_buffer *scene, dem_buffer *bodies,
                         dem_error *error);
double dem_lab_figure(const dem_lab *lab, const char *name);

// ---- for tests

/// Appends `format` with each '@' replaced by the next double, to all digits.
void dem_lab_put(dem_buffer *out, const char *format, ...);
/// Head, materials "grain", "rough" and "smooth", contacts, the shape. `pressure` [Pa] is the load that makes the
/// overlap.
void dem_lab_put_head(dem_lab *lab, dem_buffer *out, double pressure, double friction, double rough);
/// "bodies": the sample, or so many in a box.
void dem_lab_put_bodies(dem_lab *lab, dem_buffer *out, size_t count, dem_box box);
/// The scene of a text becomes the world; of the one before, the sample stays.
dem_status dem_lab_start(dem_lab *lab, const dem_buffer *text, dem_error *error);
/// Goes on to a time, and measures.
dem_status dem_lab_to(dem_lab *lab, double time, dem_error *error);
/// Goes on until the bodies whose centres are above `floor` [m] move less than `speed` [m/s] (root mean square), `from`
/// at the earliest and `until` at the latest [s].
typedef struct dem_lab_rest {
    double speed, floor, from, until, every;
} dem_lab_rest;
dem_status dem_lab_settle(dem_lab *lab, const dem_lab_rest *rest, dem_error *error);
/// Takes the bodies as they are now as the sample, at rest.
dem_status dem_lab_keep(dem_lab *lab, dem_error *error);
/// Goes on to `end` [s] in `rows` even parts; each becomes a row of the path, the mean of what `look` says of four times
/// in it. `close` (may be NULL) then sets the columns that are made of the others.
typedef struct dem_lab_walk {
    double end;
    size_t rows;
    void (*look)(const dem_lab *lab, double *row);
    void (*close)(double *row);
} dem_lab_walk;
dem_status dem_lab_go(dem_lab *lab, const dem_lab_walk *walk, dem_error *error);
/// A row for the path.
dem_status dem_lab_note(dem_lab *lab, const double *row, dem_error *error);
void dem_lab_found(dem_lab *lab, const char *name, double value);
/// The largest mean of so many rows of the path one behind the other, and the row in their middle.
double dem_lab_peak(const dem_lab *lab, size_t column, size_t width, size_t *at);
/// The mean of the rows from one on.
double dem_lab_mean(const dem_lab *lab, size_t column, size_t from);
/// The volume of the sample's grains [m^3].
double dem_lab_solid(const dem_lab *lab);
/// The mean volume of a grain over that of a sphere of the diameter [-].
double dem_lab_mean_volume(const dem_lab *lab);
/// The farthest point of the largest grain from its centre [m].
double dem_lab_reach(const dem_lab *lab);

#endif
