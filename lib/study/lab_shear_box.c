// Direct shear: a box in two halves, periodic across, without gravity. The top plate holds the normal stress, the lower
// half moves, and the upper one is held: the force on it is the shear force.
#include <math.h>

#include "study/lab.h"

static const dem_parameter params[] = {
    {"stress", 1e5, 1e-3, 1e12, "Pa", "normal stress"},
    {"displacement", 0.25, 0.02, 0.5, "-", "of the lower half at the end, of the length of the box"},
    {"rate", 2e-3, 1e-6, 0.1, "-", "inertial number in a band of six diameters"},
    {"thickness", 5, 3, 100, "d", "of the box across, which is periodic"},
    {"slenderness", 1.6, 0.5, 10, "-", "length of the box over its height"},
    {"preparation", 0, 0, 10, "-", "friction coefficient while the sample is pressed; the more the looser"},
};
enum { STRESS = LAB_COMMON, DISPLACEMENT, RATE, THICKNESS, SLENDERNESS, PREPARATION };

static const dem_lab_name figures[] = {
    {"peak_angle", "deg", "of the largest shear force over the normal one, mean over 1/30 of the path"},
    {"critical_angle", "deg", "of the mean over the last third of the path"},
    {"peak_displacement", "d", "of the lower half there"},
    {"dilation", "d", "rise of the top plate until the end"},
    {"void_ratio", "-", "of the box before"},
};
static const dem_lab_name columns[] = {
    {"displacement", "d", "displacement"},    {"shear_stress", "Pa", "shear stress"},
    {"normal_stress", "Pa", "normal stress"}, {"stress_ratio", "-", "shear over normal stress"},
    {"rise", "d", "rise of the top plate"},
};
enum { SHIFT, SHEAR, NORMAL, RATIO, RISE, COLUMNS };
enum { ROWS = 150 };
static const double LOOSE = 0.35, DENSE = 0.62;  // solid fraction where the sample begins, about as it ends

typedef struct box {
    double length, depth, height, unit, speed;
} box;

static box box_of(const dem_lab *l)
{
    double d = l->values[LAB_DIAMETER];
    double solid = floor(l->values[LAB_BODIES]) * dem_lab_mean_volume(l) * DEM_PI / 6 * d * d * d;
    box b = {.unit = d * sqrt(l->values[LAB_DENSITY] / l->values[STRESS])};
    b.depth = larger(l->values[THICKNESS] * d, 6.5 * dem_lab_reach(l));
    b.length = larger(sqrt(solid / DENSE / b.depth * l->values[SLENDERNESS]), 8 * dem_lab_reach(l));
    b.height = solid / (DENSE * b.depth * b.length);
    b.speed = l->values[RATE] * 6 * d / b.unit;
    return b;
}

static void put_domain(const box *b, dem_buffer *out, double height)
{
    dem_lab_put(out, "  \"domain\": { \"min\": [@, 0, @], \"max\": [@, @, @], \"periodic\": [false, true, false] },\n",
                -b->length, -b->height, 3 * b->length, b->depth, 2 * height);
}

static void put_top(const dem_lab *l, const box *b, dem_buffer *out, double height, const char *material)
{
    dem_lab_put(out, "    \"top\": { \"plane\": { \"point\": [0, 0, @], \"normal\": [0, 0, -1] }, ", height);
    dem_buffer_print(out, "\"material\": \"%s\",\n      \"servo\": { ", material);
    dem_lab_put(out, "\"stress\": @, \"area\": @, \"gain\": 1, \"max_velocity\": @ } }", l->values[STRESS], b->length * b->depth,
                0.1 * l->values[LAB_DIAMETER] / b->unit);
}

static dem_status prepare(dem_lab *l, dem_error *error)
{
    box b = box_of(l);
    double d = l->values[LAB_DIAMETER], high = b.height * DENSE / LOOSE + dem_lab_reach(l);
    dem_buffer text = {0};
    dem_lab_put_head(l, &text, l->values[STRESS], l->values[PREPARATION], 0);
    put_domain(&b, &text, high);
    dem_lab_put_bodies(l, &text, (size_t)l->values[LAB_BODIES], (dem_box){{0, 0, 0}, {b.length, b.depth, high}});
    dem_lab_put(&text, "  \"walls\": { \"left\": { \"plane\": { \"point\": [0, 0, 0], \"normal\": [1, 0, 0] }, "
                       "\"material\": \"smooth\" },\n");
    dem_lab_put(
        &text,
        "    \"right\": { \"plane\": { \"point\": [@, 0, 0], \"normal\": [-1, 0, 0] }, \"material\": \"smooth\" },\n",
        b.length);
    dem_lab_put(
        &text,
        "    \"bottom\": { \"plane\": { \"point\": [0, 0, 0], \"normal\": [0, 0, 1] }, \"material\": \"smooth\" },\n");
    put_top(l, &b, &text, high, "smooth");
    dem_lab_put(&text, " },\n  \"damping\": { \"local\": 0.2 }, \"time\": { \"end\": @, \"step\": \"auto\" } }\n",
                600 * b.unit);
    dem_status status = dem_lab_start(l, &text, error);
    dem_buffer_release(&text);
    double fall = (high - b.height) / (0.1 * d / b.unit);
    dem_lab_rest rest = {1e-3 * d / b.unit, -INFINITY, fall + 10 * b.unit, 600 * b.unit, 5 * b.unit};
    if (status == DEM_OK)
        status = dem_lab_settle(l, &rest, error);
    if (status != DEM_OK)
        return status;
    size_t count;
    const dem_vec3 size = {b.length, b.depth, high + dem_world_walls(l->world, &count)[3].position.z};
    for (int k = 0; k < 3; k++) {
        l->low[k] = 0;
        l->high[k] = v3_get(size, k);
    }
    return dem_lab_keep(l, error);
}

// an upright rectangle across the box, or a flat one
static void put_plate(dem_buffer *out, const char *name, dem_vec3 middle, bool upright, double side, double across,
                      double speed)
{
    dem_vec3 n = upright ? v3(1, 0, 0) : v3(0, 0, 1);
    dem_buffer_print(out, "    \"%s\": { \"plane\": ", name);
    dem_lab_put(out,
                "{ \"point\": [@, @, @], \"normal\": [@, 0, @], \"along\": [0, 1, 0], \"size\": [@, @] }, "
                "\"material\": \"smooth\"",
                middle.x, middle.y, middle.z, n.x, n.z, across, side);
    if (speed > 0)
        dem_lab_put(out, ",\n      \"motion\": { \"translate\": { \"velocity\": [@, 0, 0] } }", speed);
    dem_buffer_text(out, " },\n");
}

static void write(dem_lab *l, dem_buffer *out)
{
    box b = box_of(l);
    double height = l->high[2], half = height / 2, y = b.depth / 2, reach = dem_lab_reach(l);
    // the halves are as deep and high as nothing gets beyond; what the lower half uncovers, a flange covers
    double across = b.depth + 8 * reach, flange = l->values[DISPLACEMENT] * b.length + 4 * reach, up = half + 6 * reach;
    double end = l->values[DISPLACEMENT] * b.length / b.speed;
    dem_buffer_text(
        out,
        "// Direct shear: the top plate holds the normal stress, the lower half of the box moves to the right. Out of\n"
        "// series.csv: shear force upper_left_fx_N + upper_right_fx_N + flange_right_fx_N + top_fx_N, over "
        "top_fz_N.\n");
    dem_lab_put_head(l, out, l->values[STRESS], l->values[LAB_FRICTION], larger(l->values[LAB_FRICTION], 1));
    put_domain(&b, out, 2 * height);
    dem_lab_put_bodies(l, out, 0, box_empty());
    dem_lab_put(out, "  \"walls\": {\n    \"bottom\": { \"plane\": { \"point\": [0, 0, 0], \"normal\": [0, 0, 1] }, "
                     "\"material\": \"rough\",\n");
    dem_lab_put(out, "      \"motion\": { \"translate\": { \"velocity\": [@, 0, 0] } } },\n", b.speed);
    put_plate(out, "lower_left", v3(0, y, half / 2 - reach), true, half + 2 * reach, across, b.speed);
    put_plate(out, "lower_right", v3(b.length, y, half / 2 - reach), true, half + 2 * reach, across, b.speed);
    put_plate(out, "flange_left", v3(-flange / 2, y, half), false, flange, across, b.speed);
    put_plate(out, "upper_left", v3(0, y, half + up / 2), true, up, across, 0);
    put_plate(out, "upper_right", v3(b.length, y, half + up / 2), true, up, across, 0);
    put_plate(out, "flange_right", v3(b.length + flange / 2, y, half), false, flange, across, 0);
    put_top(l, &b, out, height, "rough");
    dem_lab_put(out, " },\n  \"time\": { \"end\": @, \"step\": \"auto\" },\n", end);
    dem_lab_put(out, "  \"output\": { \"directory\": \"shear-box\", \"frames\": @, \"series\": @ } }\n", end / 30,
                end / 300);
}

enum { UPPER_LEFT = 4, TOP = 7 };

static void look(const dem_lab *l, double *row)
{
    box b = box_of(l);
    size_t count;
    const dem_wall_view *w = dem_world_walls(l->world, &count);
    double d = l->values[LAB_DIAMETER], area = b.length * b.depth, shear = 0;
    for (int i = UPPER_LEFT; i <= TOP; i++)
        shear += w[i].force.x;
    row[SHIFT] = w[0].position.x / d;
    row[SHEAR] = shear / area;
    row[NORMAL] = w[TOP].force.z / area;
    row[RISE] = w[TOP].position.z / d;
}

static void close(double *row)
{
    row[RATIO] = row[SHEAR] / row[NORMAL];
}

static dem_status run(dem_lab *l, dem_error *error)
{
    dem_lab_found(l, "void_ratio", l->high[0] * l->high[1] * l->high[2] / dem_lab_solid(l) - 1);
    DEM_TRY(dem_lab_go(l, &(dem_lab_walk){l->scene.time.end, ROWS, look, close}, error));
    size_t at;
    dem_lab_found(l, "peak_angle", atan(dem_lab_peak(l, RATIO, ROWS / 30, &at)) * 180 / DEM_PI);
    dem_lab_found(l, "peak_displacement", l->path[at * COLUMNS + SHIFT]);
    dem_lab_found(l, "critical_angle", atan(dem_lab_mean(l, RATIO, 2 * ROWS / 3)) * 180 / DEM_PI);
    dem_lab_found(l, "dilation", l->path[(ROWS - 1) * COLUMNS + RISE]);
    return DEM_OK;
}

const dem_lab_test dem_lab_shear_box = {
    .name = "shear-box",
    .about = "Direct shear of a dense sample in a box of two halves: peak and critical strength.",
    .params = params,
    .param_count = sizeof params / sizeof *params,
    .bodies = 1000,
    .overlap = 0.003,
    .figures = figures,
    .figure_count = sizeof figures / sizeof *figures,
    .columns = columns,
    .column_count = COLUMNS,
    .prepare = prepare,
    .main_count = 2,
    .write = write,
    .run = run,
};
