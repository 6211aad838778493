/// The figures of fidelity and shape, named once: files, tables and reports walk these lists.
#ifndef DEM_CLUMP_FIGURES_H
#define DEM_CLUMP_FIGURES_H

#include "dem/clump.h"

typedef struct dem_figure {
    const char *name;
    const char *unit;  ///< "" for a pure number
    size_t at;         ///< offset of the double in its struct
} dem_figure;

enum { DEM_FIDELITY_FIGURES = 9, DEM_SHAPE_FIGURES = 10 };
extern const dem_figure dem_fidelity_figures[DEM_FIDELITY_FIGURES];  ///< of dem_fidelity; `pieces` apart
extern const dem_figure dem_shape_figures[DEM_SHAPE_FIGURES];        ///< of dem_shape

static inline double *figure_of(void *values, const dem_figure *figure)
{
    return (double *)((char *)values + figure->at);
}

#endif
