// Angle of repose by draining: a bed behind a gate on a ledge, as thick as some grains and periodic across. The gate
// goes up, grains fall off the ledge, and what is left leans on the back wall in a slope that ends at the ledge's edge.
#include <math.h>
#include <stdlib.h>

#include "base/memory.h"
#include "math/vec.h"
#include "study/lab.h"
#include "study/slope.h"

static const dem_parameter params[] = {
    {"thickness", 5, 3, 100, "d", "of the bed across the slope, which is periodic"},
    {"height", 1.3, 0.3, 5, "-", "of the bed behind the gate over the length of the ledge"},
    {"gate_speed", 1, 0.01, 10, "sqrt(g d)", "with which the gate goes up"},
    {"lip", 0.7, 0.1, 3, "d", "height of the lip at the edge, so that the lowest grains do not roll off"},
    {"gravity", 9.81, 1e-6, 1e6, "m/s^2", "downwards"},
};
enum { THICKNESS = LAB_COMMON, HEIGHT, GATE_SPEED, LIP, GRAVITY };

static const dem_lab_name figures[] = {
    {"repose", "deg", "angle of the slope that is left, by mass and first moments of the heap"},
    {"surface_angle", "deg", "by a line through its topmost grains"},
    {"surface_error", "deg", "standard error of that line"},
    {"coordination", "-", "grains and walls that a grain touches, mean"},
    {"left", "-", "share of the grains that stay"},
};

// lengths [m], times [s]
typedef struct heap {
    double length, depth, height, lip, rain, drop, unit, open, speed, up, end;
} heap;

static heap heap_of(const dem_lab *l)
{
    double d = l->values[LAB_DIAMETER], g = l->values[GRAVITY], reach = dem_lab_reach(l);
    double solid = l->values[LAB_BODIES] * dem_lab_mean_volume(l) * DEM_PI / 6 * d * d * d;
    heap h = {.depth = larger(l->values[THICKNESS] * d, 6.5 * reach), .unit = sqrt(d / g), .lip = l->values[LIP] * d};
    h.length = larger(sqrt(solid / (0.6 * h.depth * l->values[HEIGHT])), 4 * reach);
    h.height = solid / (0.6 * h.depth * h.length);
    h.rain = h.height * 0.6 / 0.25 + 2 * reach;
    double fall = sqrt(2 * h.rain / g);
    h.open = 3 * fall;
    h.speed = l->values[GATE_SPEED] * d / h.unit;
    h.drop = larger(6 * d, 0.6 * h.height);
    h.up = h.open + 1.2 * h.height / h.speed;
    h.end = h.up + 12 * fall;
    return h;
}

static void put_walls(const heap *h, dem_buffer *out, double reach)
{
    double margin = 4 * reach, y = h->depth / 2, across = h->depth + 2 * margin;
    dem_buffer_text(out, "  \"walls\": {\n    \"back\": { \"plane\": { \"point\": [0, 0, 0], \"normal\": [1, 0, 0] }, "
                         "\"material\": \"smooth\" },\n");
    // it goes on behind the back wall, where nothing is
    dem_lab_put(out,
                "    \"ledge\": { \"plane\": { \"point\": [@, @, 0], \"normal\": [0, 0, 1], \"size\": [@, @], "
                "\"along\": [1, 0, 0] }, \"material\": \"rough\" },\n",
                h->length / 2 - margin, y, h->length + 2 * margin, across);
    dem_lab_put(out,
                "    \"lip\": { \"plane\": { \"point\": [@, @, @], \"normal\": [1, 0, 0], \"size\": [@, @], "
                "\"along\": [0, 1, 0] }, \"material\": \"rough\" },\n",
                h->length, y, h->lip / 2, across, h->lip);
    dem_lab_put(out,
                "    \"gate\": { \"plane\": { \"point\": [@, @, @], \"normal\": [1, 0, 0], \"size\": [@, @], "
                "\"along\": [0, 1, 0] }, \"material\": \"smooth\",\n",
                h->length, y, (h->rain + h->lip) / 2, across, h->rain - h->lip);
    dem_lab_put(out, "      \"motion\": { \"translate\": { \"velocity\": [0, 0, @] }, \"start\": @, \"stop\": @ } },\n",
                h->speed, h->open, h->up);
    dem_lab_put(out,
                "    \"ground\": { \"plane\": { \"point\": [0, 0, @], \"normal\": [0, 0, 1] }, "
                "\"material\": \"rough\" },\n",
                -h->drop);
    dem_lab_put(out,
                "    \"far\": { \"plane\": { \"point\": [@, 0, 0], \"normal\": [-1, 0, 0] }, "
                "\"material\": \"smooth\" } },\n",
                3 * h->length);
}

static void write(dem_lab *l, dem_buffer *out)
{
    heap h = heap_of(l);
    double d = l->values[LAB_DIAMETER], g = l->values[GRAVITY];
    dem_buffer_text(out,
                    "// A bed of grains settles behind a gate on a ledge with a low lip. The gate goes up, grains fall "
                    "off the ledge,\n"
                    "// and what is left leans on the back wall: the slope of its surface (out of final.csv) is the "
                    "angle of repose. To\n"
                    "// draw it from the side: dem-view heap -o heap.png --azimuth 270 --elevation 0 --orthographic\n");
    dem_lab_put_head(l, out, 0.6 * l->values[LAB_DENSITY] * g * h.height, l->values[LAB_FRICTION],
                     larger(l->values[LAB_FRICTION], 1));
    dem_lab_put(out, "  \"gravity\": [0, 0, @],\n", -g);
    dem_lab_put(out, "  \"domain\": { \"min\": [@, 0, @], \"max\": [@, @, @], \"periodic\": [false, true, false] },\n",
                -d, -h.drop - d, 4 * h.length, h.depth, 2 * h.rain);
    put_walls(&h, out, dem_lab_reach(l));
    dem_lab_put_bodies(l, out, (size_t)l->values[LAB_BODIES], (dem_box){{0, 0, 0}, {h.length, h.depth, h.rain}});
    dem_lab_put(out, "  \"time\": { \"end\": @, \"step\": \"auto\" },\n", h.end);
    dem_lab_put(out, "  \"output\": { \"directory\": \"heap\", \"frames\": @, \"series\": @ } }\n", h.end / 40,
                h.end / 200);
}

static dem_status measure(dem_lab *l, const heap *h, dem_error *error)
{
    dem_body_view v = dem_world_bodies(l->world);
    double d = l->values[LAB_DIAMETER];
    dem_vec3 *tops = dem_alloc(v.count, sizeof *tops);
    double *masses = dem_alloc(v.count, sizeof *masses);
    if (!tops || !masses) {
        free(tops);
        free(masses);
        return dem_fail_memory(error);
    }
    size_t on = 0;
    for (size_t i = 0; i < v.count; i++)
        if (v.position[i].z > 0 && v.position[i].x < h->length) {
            masses[on] = v.mass[i];
            tops[on++] = v.position[i];
        }
    double whole = dem_slope_of_heap(tops, masses, on, h->length);
    // not near the back wall nor where the slope runs out
    dem_slope_def def = {0.12 * h->length, 0.85 * h->length, 0, h->depth, 1.25 * d};
    dem_slope slope;
    dem_status status = dem_slope_fit(&def, tops, on, &slope, error);
    free(tops);
    free(masses);
    if (status != DEM_OK)
        return status;
    dem_lab_found(l, "repose", whole * 180 / DEM_PI);
    dem_lab_found(l, "surface_angle", slope.angle * 180 / DEM_PI);
    dem_lab_found(l, "surface_error", slope.error * 180 / DEM_PI);
    dem_lab_found(l, "coordination", dem_world_figures(l->world)->coordination);
    dem_lab_found(l, "left", (double)on / floor(l->values[LAB_BODIES]));
    return DEM_OK;
}

static dem_status run(dem_lab *l, dem_error *error)
{
    heap h = heap_of(l);
    dem_lab_rest rest = {0.02 * l->values[LAB_DIAMETER] / h.unit, 0, h.up + 5 * h.unit, h.end, 2 * h.unit};
    DEM_TRY(dem_lab_settle(l, &rest, error));
    return measure(l, &h, error);
}

const dem_lab_test dem_lab_heap = {
    .name = "heap",
    .about = "A bed drains over a ledge: angle of repose.",
    .params = params,
    .param_count = sizeof params / sizeof *params,
    .bodies = 1000,
    .overlap = 0.005,
    .figures = figures,
    .figure_count = sizeof figures / sizeof *figures,
    .main_count = 1,
    .write = write,
    .run = run,
};
