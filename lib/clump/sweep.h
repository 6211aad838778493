/// Error against number of spheres and against packing time: one grain packed by several methods with several numbers.
#ifndef DEM_CLUMP_SWEEP_H
#define DEM_CLUMP_SWEEP_H

#include "clump/pack.h"

enum { DEM_SWEEP_SERIES = 24, DEM_SWEEP_COUNTS = 64 };

/// A method, or one of its efforts.
typedef struct dem_sweep_series {
    char name[48];  ///< as asked for: "optimal:fast"
    const dem_packer *packer;
    dem_effort effort;
    dem_pack_value values[DEM_PACK_VALUES];  ///< parameters of the method, if any are to be given
    size_t value_count;
} dem_sweep_series;

/// One packing and what it measures.
typedef struct dem_sweep_cell {
    bool ran;
    dem_status status;  ///< DEM_FAILED: the method cannot do it; `message` says why
    char message[256];  ///< of a failure, or the first warning; empty: none
    dem_pack pack;      ///< in the frame of the mesh
    dem_fidelity fidelity;
    dem_union whole;           ///< of the balls, at unit density
    double inertia_errors[3];  ///< (union - mesh) / mesh of the principal moments, ascending
    double seconds;            ///< processor time of the packing, of all threads
} dem_sweep_cell;

typedef struct dem_sweep {
    dem_sweep_series series[DEM_SWEEP_SERIES];
    size_t series_count;
    size_t counts[DEM_SWEEP_COUNTS];  ///< ascending
    size_t count_count;
    dem_sweep_cell *cells;  ///< [series_count * count_count], the counts of a series together
} dem_sweep;

/// Reads "5,10,20" or "optimal,optimal:fast,all" into the sweep: what stands twice counts once. A method without its
/// effort has `effort`. Error: DEM_USAGE.
dem_status dem_sweep_read_counts(dem_sweep *sweep, const char *text, dem_error *error);
dem_status dem_sweep_read_series(dem_sweep *sweep, const char *text, dem_effort effort, dem_error *error);

/// Packs and measures all cells, one after the other, the small ones first; `common` has all options but the method,
/// its effort and the number. A method that fails leaves its message in the cell. DEM_INTERRUPTED: the cells that have
/// `ran` are there.
dem_status dem_sweep_run(const dem_ctx *ctx, const dem_mesh *mesh, const dem_pack_options *common, dem_sweep *sweep,
                         dem_error *error);

static inline const dem_sweep_cell *dem_sweep_at(const dem_sweep *sweep, size_t series, size_t count)
{
    return &sweep->cells[series * sweep->count_count + count];
}

/// Frees the cells; series and counts stay, for the next grain.
void dem_sweep_release(dem_sweep *sweep);

#endif
