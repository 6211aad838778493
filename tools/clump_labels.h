/// Which labels of a volume become clumps.
#ifndef DEM_TOOLS_CLUMP_LABELS_H
#define DEM_TOOLS_CLUMP_LABELS_H

#include "clump_batch.h"
#include "clump_inputs.h"

typedef struct label_list {
    dem_label *all;
    const dem_label **items;  ///< [count] into `all`
    char **names;             ///< [count] of the clumps: NAME_17
    size_t count;
} label_list;

/// Checks a text as "3,7,10-20".
dem_status labels_parse(const char *text, dem_error *error);

/// Reads a volume, in metres, and finds its labels; what is left out is told in one warning for each reason. Errors:
/// those of reading, and DEM_BAD_INPUT where no label is left.
dem_status labels_find(const dem_ctx *ctx, const clump_input *input, const job_options *options,
                       const batch_options *asked, dem_volume *volume, label_list *list, dem_error *error);
void labels_release(label_list *list);

#endif
