#include "clump/measures.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/nearest.h"
#include "base/status.h"
#include "base/text.h"
#include "clump/figures.h"

const dem_measure dem_measures[DEM_MEASURES] = {
    {"gap", "iou", "iou_gap", "IoU gap", "%", "", DEM_MEASURE_PART, 0.045},
    {"distance", "mean", "distance_mean", "mean surface distance", "%", "of d_eq", DEM_MEASURE_PART, 0.008},
    {"hausdorff", "", "distance_max", "Hausdorff distance", "%", "of d_eq", DEM_MEASURE_PART, 0.05},
    {"protrusion", "", "protrusion", "protrusion", "%", "of d_eq", DEM_MEASURE_PART, 0.03},
    {"normal", "normals", "normal_deviation_deg", "normal deviation", "deg", "", DEM_MEASURE_DEGREES, 15},
    {"volume", "", "volume_error", "volume error", "%", "", DEM_MEASURE_PART, 0},
    {"centre", "center", "centre_offset", "centre offset", "%", "of d_eq", DEM_MEASURE_PART, 0},
    {"inertia", "", "inertia_error", "inertia error", "%", "", DEM_MEASURE_PART, 0},
    {"overlap", "", "overlap_ratio", "overlap ratio", "", "", DEM_MEASURE_RATIO, 0},
    {"pieces", "", "pieces", "pieces", "", "", DEM_MEASURE_COUNT, 0},
};

static bool lists(const char *words, const char *name)
{
    size_t length = strlen(name);
    for (const char *at = words; *at; at += strspn(at, " ")) {
        size_t word = strcspn(at, " ");
        if (word == length && strncmp(at, name, word) == 0)
            return true;
        at += word;
    }
    return false;
}

const dem_measure *dem_measure_find(const char *name)
{
    for (int i = 0; i < DEM_MEASURES; i++) {
        const dem_measure *m = &dem_measures[i];
        if (strcmp(m->name, name) == 0 || strcmp(m->field, name) == 0 || lists(m->also, name))
            return m;
    }
    return NULL;
}

const char *dem_measure_name(const void *unused, size_t index)
{
    (void)unused;
    if (index < DEM_MEASURES)
        return dem_measures[index].name;
    return index < 2 * DEM_MEASURES ? dem_measures[index - DEM_MEASURES].field : NULL;
}

double dem_measure_of(const dem_measure *measure, const dem_fidelity *fidelity)
{
    if (measure->kind == DEM_MEASURE_COUNT)
        return (double)fidelity->pieces;
    dem_fidelity copy = *fidelity;
    for (int i = 0; i < DEM_FIDELITY_FIGURES; i++)
        if (strcmp(dem_fidelity_figures[i].name, measure->field) == 0)
            return fabs(*figure_of(&copy, &dem_fidelity_figures[i]));
    return NAN;
}

double dem_measure_shown(const dem_measure *measure, double value)
{
    return measure->kind == DEM_MEASURE_PART ? 100 * value : value;
}

static dem_status refuse(const dem_measure *m, const char *value, dem_error *error)
{
    static const char *const wanted[] = {[DEM_MEASURE_PART] = "a percentage above 0 and at most 100 %, as in 2%",
                                         [DEM_MEASURE_DEGREES] = "an angle above 0 and at most 180 degrees, as in 8deg",
                                         [DEM_MEASURE_RATIO] = "a ratio of at least 1, as in 1.8",
                                         [DEM_MEASURE_COUNT] = "a whole number of at least 1"};
    return dem_fail(error, DEM_USAGE, "%s must be %s, not '%s'", m->name, wanted[m->kind], value);
}

static dem_status read_bound(const dem_measure *m, const char *value, double *bound, dem_error *error)
{
    static const struct {
        const char *unit;
        double low, high, factor;
    } kinds[] = {[DEM_MEASURE_PART] = {"%", 0, 100, 0.01},
                 [DEM_MEASURE_DEGREES] = {"deg", 0, 180, 1},
                 [DEM_MEASURE_RATIO] = {"", 1, 1e6, 1},
                 [DEM_MEASURE_COUNT] = {"", 1, 1e5, 1}};
    const char *end = value + strlen(value), *rest = dem_parse_double(value, end, bound);
    if (!rest)
        return refuse(m, value, error);
    rest += strspn(rest, " ");
    if (*rest && (!*kinds[m->kind].unit || strcmp(rest, kinds[m->kind].unit) != 0))
        return refuse(m, value, error);
    if (!(*bound >= kinds[m->kind].low && *bound > 0 && *bound <= kinds[m->kind].high) ||
        (m->kind == DEM_MEASURE_COUNT && *bound != floor(*bound)))
        return refuse(m, value, error);
    *bound *= kinds[m->kind].factor;
    return DEM_OK;
}

dem_status dem_target_read(const char *text, dem_target *target, dem_error *error)
{
    char name[64];
    size_t length = strcspn(text, "=");
    if (text[length] != '=')
        return dem_fail(error, DEM_USAGE, "'%s' has no value; write MEASURE=VALUE, as in hausdorff=2%%", text);
    size_t kept = length < sizeof name - 1 ? length : sizeof name - 1;
    memcpy(name, text, kept);
    name[kept] = 0;
    const dem_measure *m = length == kept ? dem_measure_find(name) : NULL;
    if (!m) {
        const char *near = dem_nearest(name, dem_measure_name, NULL);
        if (near)
            return dem_fail(error, DEM_USAGE, "there is no measure '%s'; did you mean %s?", name, near);
        char all[256] = "";
        for (int i = 0; i < DEM_MEASURES; i++)
            snprintf(all + strlen(all), sizeof all - strlen(all), " %s", dem_measures[i].name);
        return dem_fail(error, DEM_USAGE, "there is no measure '%s'; use one of:%s", name, all);
    }
    *target = (dem_target){.measure = m->field};
    return read_bound(m, text + length + 1, &target->bound, error);
}

double dem_target_ratio(const dem_target *targets, size_t count, const dem_fidelity *fidelity)
{
    double worst = 0;
    for (size_t i = 0; i < count; i++) {
        const dem_measure *m = dem_measure_find(targets[i].measure);
        double ratio = m ? dem_measure_of(m, fidelity) / targets[i].bound : NAN;
        worst = isnan(ratio) ? INFINITY : fmax(worst, ratio);
    }
    return worst;
}
