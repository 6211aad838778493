/// One run of a scene through time on one thread, looked at at even times: places and orientations of bodies and all
/// columns of the series. What studies of the step and of the schemes compare.
#ifndef DEM_STUDY_COURSE_H
#define DEM_STUDY_COURSE_H

#include "dem/world.h"
#include "study/cells.h"

enum { DEM_COURSE_BODIES = 64 };  ///< no more are followed, evenly over all there are

typedef struct dem_course_def {
    const dem_scene *scene;          ///< with its end, its step and its schemes
    void (*push)(dem_world *world);  ///< what acts in the next step (dem_world_push), called before each; NULL: nothing
    size_t samples;                  ///< even times behind the start
    uint64_t steps;                  ///< of equal size, a multiple of the samples; 0: the step is the scene's
    double nudge;                    ///< every free body is shifted by such a part of its size, turned by as much [rad]
    uint64_t seed;                   ///< of the nudges
    bool series_alone;               ///< no body is followed
} dem_course_def;

typedef struct dem_course {
    char failed[200];    ///< why it did not come to its end; "" it did
    size_t rows;         ///< times it was looked at, with the start
    size_t bodies;       ///< that are followed
    size_t columns;      ///< of the series
    char (*names)[100];  ///< [columns]
    double *size;        ///< [bodies] diameter of the bounding ball [m]
    double *place;       ///< [rows * bodies * 3] [m]
    double *turn;        ///< [rows * bodies * 4]
    double *series;      ///< [rows * columns]
    double seconds;      ///< of the processor, for the steps alone
    double least_step;   ///< smallest step seen [s]
    double contact;      ///< shortest time that a contact is expected to take [s]; INFINITY: none
    bool flows;          ///< bodies came or left
} dem_course;

/// A run that becomes unstable or is refused is a result (`failed`). Errors: DEM_INTERRUPTED, DEM_NO_MEMORY.
dem_status dem_course_run(const dem_ctx *ctx, const dem_course_def *def, dem_course *course, dem_error *error);
void dem_course_release(dem_course *course);

/// To and from the members of a cell's result.
void dem_course_put(dem_json_writer *w, const dem_course *course);
dem_status dem_course_get(const dem_cell_result *cell, dem_course *course, dem_error *error);

size_t dem_course_column(const dem_course *course, const char *name);  ///< SIZE_MAX: there is none

/// How far two courses of one scene are apart at a time: places in sizes of the body, across periodic sides the shorter
/// way, and angles [rad], each the largest of all bodies. NAN: one of them did not come so far.
typedef struct dem_apart {
    double place, turn;
} dem_apart;
dem_apart dem_course_apart(const dem_course *a, const dem_course *b, const dem_domain_def *domain, size_t row);

#endif
