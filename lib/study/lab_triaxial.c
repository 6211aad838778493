// Triaxial compression in a box of six smooth planes, without gravity: the sample is pressed evenly without friction,
// so that it is dense; then top and bottom approach each other and the four sides hold the confining stress.
#include <math.h>

#include "study/lab.h"

static const dem_parameter params[] = {
    {"confinement", 1e5, 1e-3, 1e12, "Pa", "stress on the sides"},
    {"strain", 0.3, 0.01, 0.6, "-", "axial strain at the end"},
    {"rate", 2e-3, 1e-6, 0.1, "-", "inertial number: strain rate times diameter times sqrt(density / stress)"},
    {"preparation", 0, 0, 10, "-", "friction coefficient while the sample is pressed; the more the looser"},
};
enum { CONFINEMENT = LAB_COMMON, STRAIN, RATE, PREPARATION };

static const dem_lab_name figures[] = {
    {"peak_angle", "deg", "largest mobilised friction angle, mean over 1 % of strain"},
    {"critical_angle", "deg", "mobilised friction angle, mean over the last third of the strain"},
    {"peak_strain", "-", "axial strain there"},
    {"void_ratio", "-", "of the box before"},
    {"critical_void_ratio", "-", "of the box, mean over the last third"},
    {"coordination", "-", "grains and walls that a grain touches before, mean"},
    {"lateral_error", "-", "of the confining stress, root mean square"},
};
static const dem_lab_name columns[] = {
    {"strain", "-", "axial strain"},
    {"axial_stress", "Pa", "axial stress"},
    {"lateral_stress", "Pa", "lateral stress"},
    {"angle", "deg", "mobilised friction angle"},
    {"stress_ratio", "-", "deviatoric over mean stress"},
    {"volume_strain", "-", "volume strain, compression positive"},
    {"void_ratio", "-", "void ratio"},
    {"coordination", "-", "coordination"},
};
enum { AXIAL_STRAIN, AXIAL, LATERAL, ANGLE, RATIO, VOLUME, VOID_RATIO, COORDINATION, COLUMNS };
enum { ROWS = 150 };  // along the path
static const double LOOSE = 0.35;  // solid fraction where the sample begins

// of stress, that a grain needs for a diameter [s]
static double unit_of(const dem_lab *l)
{
    return l->values[LAB_DIAMETER] * sqrt(l->values[LAB_DENSITY] / l->values[CONFINEMENT]);
}

static double solid_of(const dem_lab *l)
{
    return floor(l->values[LAB_BODIES]) * dem_lab_mean_volume(l) * DEM_PI / 6 * pow(l->values[LAB_DIAMETER], 3);
}

static dem_status prepare(dem_lab *l, dem_error *error)
{
    double p = l->values[CONFINEMENT], d = l->values[LAB_DIAMETER], unit = unit_of(l);
    double half = cbrt(solid_of(l) / LOOSE) / 2 + dem_lab_reach(l) / 2;
    dem_buffer text = {0};
    dem_lab_put_head(l, &text, p, l->values[PREPARATION], 0);
    dem_lab_put_bodies(l, &text, (size_t)l->values[LAB_BODIES], (dem_box){{-half, -half, -half}, {half, half, half}});
    dem_lab_put(&text, "\"walls\": { \"box\": { \"box\": { \"min\": [@, @, @], \"max\": [@, @, @] }, ", -half, -half,
                -half, half, half, half);
    dem_lab_put(&text, "\"material\": \"smooth\", \"servo\": { \"stress\": @, \"max_velocity\": @ } } },\n", p,
                0.05 * d / unit);
    dem_lab_put(&text, "\"damping\": { \"local\": 0.2 }, \"time\": { \"end\": @, \"step\": \"auto\" } }\n", 500 * unit);
    dem_status status = dem_lab_start(l, &text, error);
    dem_buffer_release(&text);
    double shrink = (half - cbrt(solid_of(l) / 0.66) / 2) / (0.05 * d / unit);
    dem_lab_rest rest = {1e-3 * d / unit, -INFINITY, shrink + 10 * unit, 500 * unit, 5 * unit};
    if (status == DEM_OK)
        status = dem_lab_settle(l, &rest, error);
    if (status != DEM_OK)
        return status;
    size_t count;
    const dem_wall_view *walls = dem_world_walls(l->world, &count);
    for (int k = 0; k < 3; k++) {
        l->low[k] = -half + v3_get(walls[2 * k].position, k);
        l->high[k] = half + v3_get(walls[2 * k + 1].position, k);
    }
    return dem_lab_keep(l, error);
}

static void write(dem_lab *l, dem_buffer *out)
{
    double p = l->values[CONFINEMENT], d = l->values[LAB_DIAMETER], unit = unit_of(l);
    double height = l->high[2] - l->low[2], speed = l->values[RATE] / unit * height / 2;
    double end = l->values[STRAIN] * height / (2 * speed);
    dem_buffer_text(
        out,
        "// Triaxial compression: the sides of a box hold a stress, top and bottom come nearer. Out of series.csv: "
        "axial\n"
        "// stress top_fz_N over the area of the top, lateral stress the mean of box.x-_stress_Pa and the like.\n");
    dem_lab_put_head(l, out, p, l->values[LAB_FRICTION], 0);
    dem_lab_put_bodies(l, out, 0, box_empty());
    dem_lab_put(out,
                "  \"walls\": {\n    \"bottom\": { \"plane\": { \"point\": [0, 0, @], \"normal\": [0, 0, 1] }, "
                "\"material\": \"smooth\",\n",
                l->low[2]);
    dem_lab_put(out, "      \"motion\": { \"translate\": { \"velocity\": [0, 0, @] } } },\n", speed);
    dem_lab_put(
        out, "    \"top\": { \"plane\": { \"point\": [0, 0, @], \"normal\": [0, 0, -1] }, \"material\": \"smooth\",\n",
        l->high[2]);
    dem_lab_put(out, "      \"motion\": { \"translate\": { \"velocity\": [0, 0, @] } } },\n", -speed);
    static const char *const sides[] = {"left", "right", "front", "back"};
    for (int i = 0; i < 4; i++) {
        double at = i % 2 ? l->high[i / 2] : l->low[i / 2], n = i % 2 ? -1 : 1;
        dem_buffer_print(out, "    \"%s\": { \"plane\": ", sides[i]);
        dem_lab_put(out, "{ \"point\": [@, @, 0], \"normal\": [@, @, 0] }, \"material\": \"smooth\",\n", i < 2 ? at : 0,
                    i < 2 ? 0 : at, i < 2 ? n : 0, i < 2 ? 0 : n);
        dem_lab_put(out, "      \"servo\": { \"stress\": @, \"max_velocity\": @, ", p, 0.05 * d / unit);
        dem_buffer_print(out, "\"extents\": [[\"%s\", \"%s\"], [\"bottom\", \"top\"]], \"partner\": \"%s\" } }%s\n",
                         sides[(i / 2 ? 0 : 2)], sides[(i / 2 ? 1 : 3)], sides[i ^ 1], i < 3 ? "," : " },");
    }
    dem_lab_put(out, "  \"time\": { \"end\": @, \"step\": \"auto\" },\n", end);
    dem_lab_put(out, "  \"output\": { \"directory\": \"triaxial\", \"frames\": @, \"series\": @ } }\n", end / 30,
                end / 300);
}

// walls: bottom, top, left, right, front, back
static void look(const dem_lab *l, double *row)
{
    size_t count;
    const dem_wall_view *w = dem_world_walls(l->world, &count);
    double size[3], start[3];
    for (int k = 0; k < 3; k++) {
        int low = k == 2 ? 0 : 2 + 2 * k;
        start[k] = l->high[k] - l->low[k];
        size[k] = start[k] + v3_get(w[low + 1].position, k) - v3_get(w[low].position, k);
    }
    double axial = (w[1].force.z - w[0].force.z) / 2 / (size[0] * size[1]);
    double lateral = (w[3].force.x - w[2].force.x) / 4 / (size[1] * size[2]) +
                     (w[5].force.y - w[4].force.y) / 4 / (size[0] * size[2]);
    double volume = size[0] * size[1] * size[2], before = start[0] * start[1] * start[2];
    row[AXIAL_STRAIN] = 1 - size[2] / start[2];
    row[AXIAL] = axial;
    row[LATERAL] = lateral;
    row[VOLUME] = 1 - volume / before;
    row[VOID_RATIO] = volume / dem_lab_solid(l) - 1;
    row[COORDINATION] = dem_world_figures(l->world)->coordination;
}

static void close(double *row)
{
    double sum = row[AXIAL] + row[LATERAL], q = row[AXIAL] - row[LATERAL];
    row[ANGLE] = sum > 0 ? asin(larger(-1, smaller(1, q / sum))) * 180 / DEM_PI : NAN;
    row[RATIO] = 3 * q / (row[AXIAL] + 2 * row[LATERAL]);
}

static double lateral_error(const dem_lab *l)
{
    double off = 0;
    for (size_t i = 0; i < l->rows; i++)
        off += pow(l->path[i * COLUMNS + LATERAL] / l->values[CONFINEMENT] - 1, 2) / ROWS;
    return sqrt(off);
}

static dem_status run(dem_lab *l, dem_error *error)
{
    DEM_TRY(dem_world_measure(l->world, error));
    double volume = 1;
    for (int k = 0; k < 3; k++)
        volume *= l->high[k] - l->low[k];
    dem_lab_found(l, "void_ratio", volume / dem_lab_solid(l) - 1);
    dem_lab_found(l, "coordination", dem_world_figures(l->world)->coordination);
    DEM_TRY(dem_lab_go(l, &(dem_lab_walk){l->scene.time.end, ROWS, look, close}, error));
    dem_lab_found(l, "lateral_error", lateral_error(l));
    size_t at, width = (size_t)ceil(0.01 / l->values[STRAIN] * ROWS);
    dem_lab_found(l, "peak_angle", dem_lab_peak(l, ANGLE, width, &at));
    dem_lab_found(l, "peak_strain", l->path[at * COLUMNS + AXIAL_STRAIN]);
    dem_lab_found(l, "critical_angle", dem_lab_mean(l, ANGLE, 2 * ROWS / 3));
    dem_lab_found(l, "critical_void_ratio", dem_lab_mean(l, VOID_RATIO, 2 * ROWS / 3));
    return DEM_OK;
}

const dem_lab_test dem_lab_triaxial = {
    .name = "triaxial",
    .about = "A dense sample between servo walls is compressed: stress and strain paths, peak and critical strength.",
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
