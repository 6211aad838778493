/// The errors of a clump under the names people use: targets, tables and plots walk this list.
#ifndef DEM_CLUMP_MEASURES_H
#define DEM_CLUMP_MEASURES_H

#include "dem/clump.h"

typedef enum dem_measure_kind {
    DEM_MEASURE_PART,     ///< a fraction, written in percent
    DEM_MEASURE_DEGREES,
    DEM_MEASURE_RATIO,
    DEM_MEASURE_COUNT,
} dem_measure_kind;

typedef struct dem_measure {
    const char *name;   ///< "gap"
    const char *also;   ///< other names, blanks between; "": none
    const char *field;  ///< of dem_fidelity, and of the files: "iou_gap"
    const char *title;  ///< "IoU gap"
    const char *unit;   ///< of what is shown: "%", "deg", ""
    const char *of;     ///< what the percentage is of; "": nothing else to say
    dem_measure_kind kind;
    double usual;       ///< of the default packer's 50 spheres on grains between a rock and a cube; 0: any
} dem_measure;

enum { DEM_MEASURES = 10 };
extern const dem_measure dem_measures[DEM_MEASURES];

/// By any of its names; NULL: there is none.
const dem_measure *dem_measure_find(const char *name);
/// For dem_nearest: the names by number.
const char *dem_measure_name(const void *unused, size_t index);

/// The figure without its sign.
double dem_measure_of(const dem_measure *measure, const dem_fidelity *fidelity);
/// As it is shown: in percent where it is a part.
double dem_measure_shown(const dem_measure *measure, double value);

#endif
