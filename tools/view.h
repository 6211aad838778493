/// The parts of dem-view.
#ifndef DEM_TOOLS_VIEW_H
#define DEM_TOOLS_VIEW_H

#include "cli.h"
#include "out/field.h"
#include "out/links.h"
#include "out/picture.h"
#include "out/results.h"
#include "out/scene_picture.h"

/// The command line as it was given.
typedef struct view_arguments {
    cli_common common;
    const char *output;
    long width, height;  ///< 0: not given
    const char *size, *background;
    long samples;
    bool no_labels;
    double label_size;
    const char *colour, *range, *bodies, *unit;
    int map;
    bool spheres, surface, no_walls, contacts;
    cli_texts clips;
    double azimuth, elevation;  ///< NAN: not given
    double zoom;
    const char *look_at, *up;
    bool orthographic, perspective;
    double time;  ///< NAN: not given
    const char *frame, *frames;
    long columns;
    bool no_names, same_scale;
} view_arguments;

/// What the texts of the arguments mean.
typedef struct view_choices {
    const view_arguments *arguments;
    int width, height;  ///< 0: not given
    uint8_t background[3];
    dem_colour light;  ///< of the background
    dem_vec3 look_at;  ///< NAN: not given
    dem_vec3 up;
    bool up_given, camera_given;
    double unit;  ///< of meshes [m]; NAN: not given
} view_choices;

dem_status view_choose(const view_arguments *arguments, view_choices *choices, dem_error *error);

/// "LOW..HIGH" as values of a field in an SI unit; an end that is left out is NAN. A unit behind HIGH is also that of a
/// bare LOW.
dem_status view_range(const char *text, const char *unit, double *low, double *high, dem_error *error);

/// Hides the bodies for which "FIELD<VALUE" holds (also <=, >, >=).
dem_status view_clip(const char *text, const dem_field_source *source, unsigned char *hidden, dem_error *error);

/// Hides the bodies that are not in a list as "0-99,200,300-".
dem_status view_subset(const char *text, size_t count, unsigned char *hidden, dem_error *error);

/// Frames by "all", "A-B", "every N", "A-B every N", "A"; of `count`. *numbers is to be freed.
dem_status view_frames(const char *text, size_t count, size_t **numbers, size_t *selected, dem_error *error);

/// The file of a number by a name such as "frames/%04d.png", to be freed; NULL: no memory. False: the name has no place
/// for a number.
bool view_is_pattern(const char *name);
char *view_numbered(const char *pattern, size_t number);

/// ---- runs

typedef struct view_run {
    const view_choices *choices;
    dem_results results;
    dem_picture_options options;
    dem_field field;
    unsigned char *hidden;
    const char **names;
    dem_links links;  ///< what is drawn instead of the bodies, where the arguments ask for contacts
    size_t shown;     ///< bodies that are not hidden, or contacts
} view_run;

enum { VIEW_LAST = -1 };

/// Opens a run by its directory. To be released either way.
dem_status view_run_open(const dem_ctx *ctx, const view_choices *choices, const char *directory, view_run *run,
                         dem_error *error);
/// Reads a frame (VIEW_LAST: the last state; `file` not NULL: that one), its colours and what is hidden.
dem_status view_run_load(view_run *run, long frame, const char *file, dem_error *error);
/// The frame that the arguments ask for; VIEW_LAST without one.
dem_status view_run_frame(const view_run *run, long *frame, dem_error *error);
dem_status view_run_measure(view_run *run, dem_picture_span *span, dem_error *error);
dem_status view_run_draw(const dem_ctx *ctx, view_run *run, const dem_picture_span *span, int width, int height,
                         dem_image *image, dem_error *error);
void view_run_release(view_run *run);

/// ---- grains

/// A clump, a mesh or balls.
typedef struct view_grain {
    dem_clump *clump;
    dem_clump_def def;
    dem_mesh mesh;
    dem_ball *balls;  ///< of a file that holds nothing else
    bool in_metres;
    dem_grain_picture picture;
    dem_camera camera;
} view_grain;

/// `alone`: a clump shows its surface too. To be released either way.
dem_status view_grain_open(const dem_ctx *ctx, const view_choices *choices, const char *path, bool alone,
                           view_grain *grain, dem_error *error);
dem_status view_grain_draw(const dem_ctx *ctx, const view_choices *choices, const view_grain *grain, int width,
                           int height, dem_image *image, dem_error *error);
/// Breadth of a pixel of its picture, if it is drawn as large as it fits [m].
dem_status view_grain_pixel(const view_choices *choices, const view_grain *grain, int width, int height, double *pixel,
                            dem_error *error);
void view_grain_release(view_grain *grain);

/// ---- what was named

typedef enum view_kind { VIEW_RUN, VIEW_FRAME, VIEW_GRAIN } view_kind;

typedef struct view_input {
    view_kind kind;
    char *path;
    char *directory;  ///< of the run
    char *name;
} view_input;

typedef struct view_inputs {
    view_input *items;
    size_t count, capacity;
} view_inputs;

/// Finds out what the operands are; a folder that is no run stands for the clumps, or else the meshes, in it.
dem_status view_find(const cli_texts *operands, view_inputs *inputs, dem_error *error);
void view_inputs_release(view_inputs *inputs);

#endif
