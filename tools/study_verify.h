/// `dem-study verify`: cases with a known answer.
#ifndef DEM_TOOLS_STUDY_VERIFY_H
#define DEM_TOOLS_STUDY_VERIFY_H

#include "base/text.h"
#include "study/verify.h"

/// The subcommand, argv[0] its name; returns the exit status.
int study_verify(int argc, char **argv);

/// One case that was chosen, and what came of it.
typedef struct verified {
    const dem_case *about;
    dem_trial trial;
    bool ran;
} verified;

/// How many were tried, passed, failed and skipped.
typedef struct verified_counts {
    size_t cases, findings, passed, failed, skipped;
} verified_counts;
verified_counts verified_count(const verified *items, size_t count);

// study_verify_report.c: tables for people, for programs and as a page
void verified_text(dem_buffer *out, const verified *items, size_t count, bool all);
void verified_csv(dem_buffer *out, const verified *items, size_t count);
void verified_page(dem_buffer *out, const verified *items, size_t count);

#endif
