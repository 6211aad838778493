/// What dem-clump tells about its grains: a screen of text, one JSON object, a CSV table.
#ifndef DEM_TOOLS_CLUMP_REPORT_H
#define DEM_TOOLS_CLUMP_REPORT_H

#include "base/text.h"
#include "clump_job.h"

/// One screen, aligned, with units.
void report_text(dem_buffer *out, const job_result *result, const job_options *options);

/// One JSON object: of the grain alone, or {"grains": [...], "failed": n} for several.
void report_json(dem_buffer *out, const job_results *results, const job_options *options, bool several);

/// A header line, and a row per grain; SI units stand in the header. `labels`: with what label volumes tell.
void report_csv_header(dem_buffer *out, bool labels);
void report_csv_row(dem_buffer *out, const job_result *result, bool labels);
/// What the row of a grain starts with: its input, its name and a status.
void report_csv_start(dem_buffer *out, const job_result *result, const char *status);

/// Pieces of these: a row of a table that compares two solids (NAN: unknown), a cell of a CSV table, texts and an error
/// in JSON.
void report_compare(dem_buffer *out, const char *name, double mesh, double balls);
void report_csv_text(dem_buffer *out, const char *text);
void report_put_mesh(dem_json_writer *w, const dem_mesh_report *report);
void report_put_texts(dem_json_writer *w, const char *key, char **texts, size_t count);
void report_put_error(dem_json_writer *w, const dem_error *error);

#endif
