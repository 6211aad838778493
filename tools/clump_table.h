/// The CSV table of a batch: grows row by row, so that what is done is there whatever happens.
#ifndef DEM_TOOLS_CLUMP_TABLE_H
#define DEM_TOOLS_CLUMP_TABLE_H

#include "clump_job.h"

/// Rows go to PATH.part, which becomes PATH when it is closed.
typedef struct clump_table {
    FILE *file;  ///< NULL: no table
    const char *path;
    char *part;          ///< NULL: written directly (standard output, a pipe)
    bool labels;         ///< with the columns of labels
    char *old;           ///< rows of an earlier run, one line each
    const char *old_at;  ///< behind the last one used
} clump_table;

/// `path` NULL: there is no table, and the rest does nothing. With `resume` the rows of finished grains of an earlier
/// run serve for those that are kept. Error: DEM_CANNOT_WRITE.
dem_status clump_table_open(clump_table *table, const char *path, bool labels, bool resume, dem_error *error);
dem_status clump_table_add(clump_table *table, const job_result *result, dem_error *error);
/// Also after a failure.
dem_status clump_table_close(clump_table *table, dem_error *error);

#endif
