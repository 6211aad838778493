/// What dem-clump tells about its grains: a screen of text, one JSON object, a CSV table.
#ifndef DEM_TOOLS_CLUMP_REPORT_H
#define DEM_TOOLS_CLUMP_REPORT_H

#include "base/text.h"
#include "clump_job.h"

/// One screen, aligned, with units.
void report_text(dem_buffer *out, const job_result *result, const job_options *options);

/// One JSON object: of the grain alone, or {"grains": [...], "failed": n} for several.
void report_json(dem_buffer *out, const job_results *results, bool several);

/// A header line, and a row per grain; SI units stand in the header. `labels`: with what label volumes tell.
void report_csv_header(dem_buffer *out, bool labels);
void report_csv_row(dem_buffer *out, const job_result *result, bool labels);
/// A text of a table, in quotes where it needs them (RFC 4180).
void report_csv_text(dem_buffer *out, const char *text);
/// What the row of a grain starts with: its input, its name and a status.
void report_csv_start(dem_buffer *out, const job_result *result, const char *status);

#endif
