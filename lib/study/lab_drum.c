// A drum that turns slowly, periodic along its axis: the angle of the surface while grains flow down it, by the line
// from the axis to the centre of mass of the bed, which stands upright on an even surface.
#include <math.h>

#include "study/lab.h"

static const dem_parameter params[] = {
    {"filling", 0.35, 0.1, 0.6, "-", "of the drum's section by the bed"},
    {"length", 5, 3, 100, "d", "of the drum along its axis, which is periodic"},
    {"froude", 0.005, 1e-5, 0.5, "-", "square of the angular velocity times radius over gravity"},
    {"turns", 0.6, 0.2, 100, "-", "of the drum; the last half counts"},
    {"lifters", 12, 0, 24, "count", "bars along the drum, of half a diameter, so that the bed does not slide"},
    {"gravity", 9.81, 1e-6, 1e6, "m/s^2", "downwards"},
};
enum { FILLING = LAB_COMMON, LENGTH, FROUDE, TURNS, LIFTERS, GRAVITY };

static const dem_lab_name figures[] = {
    {"drum_angle", "deg", "of the surface, mean over the last half of the turning"},
    {"drum_swing", "deg", "its standard deviation over time"},
    {"coordination", "-", "grains and walls that a grain touches, mean over that time"},
};
static const dem_lab_name columns[] = {
    {"turned", "deg", "turned"}, {"angle", "deg", "angle of the surface"}, {"coordination", "-", "coordination"}};
enum { TURNED, ANGLE, COORDINATION, COLUMNS };
enum { ROWS = 200 };

typedef struct drum {
    double radius, length, spin, start, end, unit;
} drum;

static drum drum_of(const dem_lab *l)
{
    double d = l->values[LAB_DIAMETER], g = l->values[GRAVITY];
    drum r = {.length = larger(l->values[LENGTH] * d, 6.5 * dem_lab_reach(l)), .unit = sqrt(d / g)};
    double solid = l->values[LAB_BODIES] * dem_lab_mean_volume(l) * DEM_PI / 6 * d * d * d;
    r.radius = larger(sqrt(solid / (0.6 * l->values[FILLING] * DEM_PI * r.length)), 4 * dem_lab_reach(l));
    r.spin = sqrt(l->values[FROUDE] * g / r.radius);
    r.start = 5 * sqrt(2 * r.radius / g);
    r.end = r.start + 2 * DEM_PI * l->values[TURNS] / r.spin;
    return r;
}

static void put_motion(const drum *r, dem_buffer *out, const char *end)
{
    dem_lab_put(out,
                "\"material\": \"rough\",\n      \"motion\": { \"rotate\": { \"axis\": [0, 1, 0], \"through\": [0, 0, "
                "0], \"rate\": @ }, \"start\": @ } }",
                r->spin, r->start);
    dem_buffer_text(out, end);
}

static void write(dem_lab *l, dem_buffer *out)
{
    drum r = drum_of(l);
    double d = l->values[LAB_DIAMETER], g = l->values[GRAVITY], a = 0.68 * r.radius, b = 0.7 * r.radius;
    dem_buffer_text(out, "// A slowly turning drum, periodic along its axis. The angle of the bed's surface is that of "
                         "the line from the axis\n"
                         "// to the centre of mass (centre_x_m, centre_z_m of series.csv). To draw it: dem-view drum "
                         "-o drum.png --azimuth 270\n"
                         "// --elevation 0 --orthographic\n");
    dem_lab_put_head(l, out, 0.6 * l->values[LAB_DENSITY] * g * r.radius, l->values[LAB_FRICTION],
                     larger(l->values[LAB_FRICTION], 1));
    dem_lab_put(out, "  \"gravity\": [0, 0, @],\n", -g);
    dem_lab_put(out, "  \"domain\": { \"min\": [@, 0, @], \"max\": [@, @, @], \"periodic\": [false, true, false] },\n",
                -2 * r.radius, -2 * r.radius, 2 * r.radius, r.length, 2 * r.radius);
    dem_lab_put(
        out,
        "  \"walls\": {\n    \"drum\": { \"cylinder\": { \"point\": [0, 0, 0], \"axis\": [0, 1, 0], \"radius\": @ }, ",
        r.radius);
    size_t lifters = (size_t)l->values[LIFTERS];
    put_motion(&r, out, lifters ? ",\n" : " },\n");
    for (size_t i = 0; i < lifters; i++) {
        double t = 2 * DEM_PI * (double)i / (double)lifters, c = cos(t), s = sin(t);
        // half of a bar is outside of the drum
        dem_buffer_print(out, "    \"bar%zu\": ", i + 1);
        dem_lab_put(
            out,
            "{ \"plane\": { \"point\": [@, @, @], \"normal\": [@, 0, @], \"along\": [0, 1, 0], \"size\": [@, @] }, ",
            c * r.radius, r.length / 2, s * r.radius, -s, c, r.length + 8 * dem_lab_reach(l), d);
        put_motion(&r, out, i + 1 < lifters ? ",\n" : " },\n");
    }
    dem_lab_put_bodies(l, out, (size_t)l->values[LAB_BODIES], (dem_box){{-a, 0, -b}, {a, r.length, b}});
    dem_lab_put(out, "  \"time\": { \"end\": @, \"step\": \"auto\" },\n", r.end);
    dem_lab_put(out, "  \"output\": { \"directory\": \"drum\", \"frames\": @, \"series\": @ } }\n", r.end / 40,
                r.end / 400);
}

static dem_status run(dem_lab *l, dem_error *error)
{
    drum r = drum_of(l);
    DEM_TRY(dem_lab_to(l, r.start, error));
    for (int i = 0; i < ROWS; i++) {
        double time = r.start + (r.end - r.start) * (i + 1) / ROWS;
        DEM_TRY(dem_lab_to(l, time, error));
        const dem_figures *f = dem_world_figures(l->world);
        // about +y the floor of the drum goes towards -x
        const double row[COLUMNS] = {r.spin * (time - r.start) * 180 / DEM_PI,
                                     atan2(-f->centre.x, -f->centre.z) * 180 / DEM_PI, f->coordination};
        DEM_TRY(dem_lab_note(l, row, error));
    }
    double mean = dem_lab_mean(l, ANGLE, ROWS / 2), swing = 0;
    for (int i = ROWS / 2; i < ROWS; i++)
        swing += pow(l->path[i * COLUMNS + ANGLE] - mean, 2);
    dem_lab_found(l, "drum_angle", mean);
    dem_lab_found(l, "drum_swing", sqrt(swing / (ROWS - ROWS / 2)));
    dem_lab_found(l, "coordination", dem_lab_mean(l, COORDINATION, ROWS / 2));
    return DEM_OK;
}

const dem_lab_test dem_lab_drum = {
    .name = "drum",
    .about = "A slowly turning drum: angle of the surface on which grains flow.",
    .params = params,
    .param_count = sizeof params / sizeof *params,
    .bodies = 1000,
    .overlap = 0.005,
    .figures = figures,
    .figure_count = sizeof figures / sizeof *figures,
    .columns = columns,
    .column_count = COLUMNS,
    .main_count = 1,
    .write = write,
    .run = run,
};
