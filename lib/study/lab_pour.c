// Grains rain into a box without sides: how dense they lie, and how many others each touches.
#include <math.h>

#include "math/vec.h"
#include "study/lab.h"

static const dem_parameter params[] = {
    {"height", 1, 0.3, 10, "-", "of the bed over its width"},
    {"gravity", 9.81, 1e-6, 1e6, "m/s^2", "downwards"},
};
enum { HEIGHT = LAB_COMMON, GRAVITY };

static const dem_lab_name figures[] = {
    {"void_ratio", "-", "volume of voids over that of grains, in the middle of the bed"},
    {"coordination", "-", "grains that a grain touches, mean"},
    {"solid_fraction", "-", "share of the volume that grains take"},
    {"overlap", "-", "largest, of a radius"},
};

// of the settled bed [m]
typedef struct bed {
    double width, height, rain;
} bed;

static bed bed_of(const dem_lab *l)
{
    double d = l->values[LAB_DIAMETER], solid = l->values[LAB_BODIES] * dem_lab_mean_volume(l) * DEM_PI / 6;
    bed b = {.width = d * cbrt(solid / (0.6 * l->values[HEIGHT]))};
    // of a periodic side the engine wants room for two of the largest and more
    b.width = larger(b.width, 6.5 * dem_lab_reach(l));
    b.height = solid * d * d * d / (0.6 * b.width * b.width);
    b.rain = b.height * 0.6 / 0.22 + 2 * dem_lab_reach(l);
    return b;
}

static double end_of(const dem_lab *l, const bed *b)
{
    return 12 * sqrt(2 * b->rain / l->values[GRAVITY]);
}

static void write(dem_lab *l, dem_buffer *out)
{
    bed b = bed_of(l);
    double d = l->values[LAB_DIAMETER], g = l->values[GRAVITY];
    dem_buffer_text(out,
                    "// Grains rain into a box whose sides are periodic, and come to rest. In the region \"middle\" "
                    "series.csv has\n"
                    "// their void ratio and how many others each touches (middle_void_ratio, middle_coordination).\n");
    dem_lab_put_head(l, out, 0.6 * l->values[LAB_DENSITY] * g * b.height, l->values[LAB_FRICTION], 1);
    dem_lab_put(out, "  \"gravity\": [0, 0, @],\n", -g);
    dem_lab_put(out, "  \"domain\": { \"min\": [0, 0, @], \"max\": [@, @, @], \"periodic\": [true, true, false] },\n",
                -d, b.width, b.width, 2 * b.rain);
    dem_lab_put(out, "  \"walls\": { \"floor\": { \"plane\": { \"point\": [0, 0, 0], \"normal\": [0, 0, 1] }, "
                     "\"material\": \"rough\" } },\n");
    dem_lab_put_bodies(l, out, (size_t)l->values[LAB_BODIES], (dem_box){{0, 0, 0}, {b.width, b.width, b.rain}});
    dem_lab_put(out, "  \"measures\": { \"middle\": { \"box\": [[0, 0, @], [@, @, @]] } },\n", 0.2 * b.height, b.width,
                b.width, 0.7 * b.height);
    double end = end_of(l, &b);
    dem_lab_put(out, "  \"time\": { \"end\": @, \"step\": \"auto\" },\n", end);
    dem_lab_put(out, "  \"output\": { \"directory\": \"pour\", \"frames\": @, \"series\": @ } }\n", end / 40,
                end / 200);
}

static dem_status run(dem_lab *l, dem_error *error)
{
    bed b = bed_of(l);
    double fall = sqrt(2 * b.rain / l->values[GRAVITY]), unit = sqrt(l->values[LAB_DIAMETER] / l->values[GRAVITY]);
    dem_lab_rest rest = {2e-3 * l->values[LAB_DIAMETER] / unit, -INFINITY, 1.5 * fall, end_of(l, &b), 2 * unit};
    DEM_TRY(dem_lab_settle(l, &rest, error));
    size_t count;
    const dem_measure_view *middle = dem_world_measures(l->world, &count);
    dem_lab_found(l, "void_ratio", middle->void_ratio);
    dem_lab_found(l, "solid_fraction", middle->solid_volume / middle->volume);
    dem_lab_found(l, "coordination", middle->coordination);
    dem_lab_found(l, "overlap", dem_world_figures(l->world)->overlap_ratio);
    return DEM_OK;
}

const dem_lab_test dem_lab_pour = {
    .name = "pour",
    .about = "Grains rain into a box with periodic sides: void ratio and coordination.",
    .params = params,
    .param_count = sizeof params / sizeof *params,
    .bodies = 1000,
    .overlap = 0.002,
    .figures = figures,
    .figure_count = sizeof figures / sizeof *figures,
    .main_count = 2,
    .write = write,
    .run = run,
};
