/// Studies that are a table of cases (study/trial.h): chosen, run side by side, told as text, JSON, CSV and page.
#ifndef DEM_TOOLS_STUDY_SUITE_H
#define DEM_TOOLS_STUDY_SUITE_H

#include "base/text.h"
#include "study/trial.h"

/// One such study.
typedef struct suite {
    const char *tool, *about, *epilogue;  ///< for the command line
    const char *title, *cases;            ///< of the page, and what the cases are
    const dem_case *(*at)(size_t index);  ///< the table; NULL behind the last
    bool quick;                           ///< slow cases are left out by --quick; else they are asked for by --slow
} suite;

/// Runs what the command line asks for, argv[0] its first word; returns the exit status.
int suite_main(const suite *suite, int argc, char **argv);

/// `dem-study verify`, `dem-study stability`.
int study_verify(int argc, char **argv);
int study_stability(int argc, char **argv);

/// One case that was chosen, and what came of it.
typedef struct tried {
    const dem_case *about;
    dem_trial trial;
    bool ran;
} tried;

/// How many were tried, passed, failed and skipped.
typedef struct suite_counts {
    size_t cases, findings, passed, failed, skipped;
} suite_counts;
suite_counts suite_count(const tried *items, size_t count);

// study_suite_report.c: tables for people, for programs and as a page
void suite_text(dem_buffer *out, const tried *items, size_t count, bool all);
void suite_csv(dem_buffer *out, const tried *items, size_t count);
void suite_page(dem_buffer *out, const suite *suite, const tried *items, size_t count);

#endif
