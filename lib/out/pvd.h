/// ParaView's index of files and the times they belong to (.pvd). Rewritten whole whenever it grows.
#ifndef DEM_OUT_PVD_H
#define DEM_OUT_PVD_H

#include "base/file_queue.h"

enum { DEM_PVD_PARTS = 2 };

/// What belongs to one time; a name that is empty is left out.
typedef struct dem_pvd_entry {
    double time;                    ///< [s]
    char files[DEM_PVD_PARTS][48];  ///< from the index's folder
} dem_pvd_entry;

typedef struct dem_pvd {
    char *path;
    dem_file_queue *queue;  ///< borrowed, to be set by the caller; NULL: writes at once
    dem_pvd_entry *entries;
    size_t count, capacity;
    dem_buffer lines;  ///< of the first `printed` entries
    size_t printed;
} dem_pvd;

/// Begins an index; with a time in `resume` [s] (NAN: a new run) it goes on with the entries of the file that is there,
/// up to that time. Writes nothing yet. Errors: DEM_BAD_INPUT for a file that is none of ours, DEM_NO_MEMORY.
dem_status dem_pvd_open(const char *folder, const char *name, double resume, dem_pvd *index, dem_error *error);

/// Adds an entry (files: NULL: none) and writes the index. Errors: DEM_CANNOT_WRITE, DEM_NO_MEMORY.
dem_status dem_pvd_add(dem_pvd *index, double time, const char *file, const char *other, dem_error *error);

/// Removes the files `prefix`NNNNNN.vtp of a folder in `directory` whose number is `first` or more: those that no entry
/// names. Error: DEM_NO_MEMORY.
dem_status dem_pvd_remove(const char *directory, const char *folder, const char *prefix, size_t first,
                          dem_error *error);

/// The entry whose time is nearest, the first of such; the last one for a time that is NAN; NULL: there is none.
const dem_pvd_entry *dem_pvd_nearest(const dem_pvd *index, double time);

void dem_pvd_release(dem_pvd *index);

#endif
