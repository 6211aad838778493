/// Converting texts in a test: the clump, what was reported and what was warned of.
#ifndef DEM_TESTS_CONVERTED_H
#define DEM_TESTS_CONVERTED_H

#include "check.h"

#include "clump/import.h"

// what was warned of
typedef struct listener {
    char text[4096];
    int count;
} listener;

static inline void listen(void *user, dem_log_level level, const char *subject, const char *text)
{
    listener *l = user;
    (void)subject;
    if (level != DEM_LOG_WARNING)
        return;
    l->count++;
    snprintf(l->text + strlen(l->text), sizeof l->text - strlen(l->text), "%s\n", text);
}

typedef struct converted {
    dem_clump *clump;
    dem_clump_def def;
    dem_import_report report;
    const dem_importer *format;
    listener heard;
    dem_error error;
    dem_status status;
} converted;

static inline converted convert_as(const char *file, const char *text, size_t size, const dem_importer *importer,
                                   const dem_import_options *options)
{
    converted c = {0};
    dem_ctx ctx = {.log = listen, .user = &c.heard};
    dem_import import;
    dem_import_options plain = dem_import_defaults();
    c.status = dem_import_decode(&ctx, file, NULL, text, size, importer, &import, &c.format, &c.error);
    if (c.status == DEM_OK)
        c.status = dem_import_clump(&import, options ? options : &plain, &c.clump, &c.report, &c.error);
    if (c.status == DEM_OK)
        c.def = dem_clump_view(c.clump);
    dem_import_release(&import);
    return c;
}

static inline converted convert(const char *file, const char *text, const dem_import_options *options)
{
    converted c = convert_as(file, text, strlen(text), NULL, options);
    check_ok(c.status, c.error);
    return c;
}

static inline void done(converted *c)
{
    dem_clump_destroy(c->clump);
    c->clump = NULL;
}

static inline void warned(const converted *c, const char *of)
{
    if (!strstr(c->heard.text, of))
        print_error("no '%s' among: %s\n", of, c->heard.text);
    check(strstr(c->heard.text, of) != NULL);
}

/// Five spheres, and a molecule of them.
#define ROWS                                                                                                           \
    "-0.00231590444 -0.000839033229 -0.000263204445 0.01\n0.00683335774 0.000666104975 -0.000423081062 0.008\n"        \
    "-0.00810299602 0.00654214754 0.000750571413 0.006\n-1.69499065e-05 -0.00991916834 0.0020315623 0.005\n"           \
    "0.0125426732 0.00678788363 0.00239250824 0.004\n"
#define ATOMS                                                                                                          \
    "\nCoords\n\n1 -0.00231590444 -0.000839033229 -0.000263204445\n2 0.00683335774 0.000666104975 -0.000423081062\n"   \
    "3 -0.00810299602 0.00654214754 0.000750571413\n4 -1.69499065e-05 -0.00991916834 0.0020315623\n"                   \
    "5 0.0125426732 0.00678788363 0.00239250824\n\nTypes\n\n1 1\n2 1\n3 1\n4 1\n5 1\n\nDiameters\n\n"                  \
    "5 0.008\n1 0.02\n2 0.016\n3 0.012\n4 0.01\n"
#define MOLECULE "grain\n\n5 atoms\n0.015 mass\n0 0 0 com\n6.8e-07 9.3e-07 1.1e-06 0 0 0 inertia\n" ATOMS

#endif
