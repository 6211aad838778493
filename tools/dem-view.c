/// dem-view: pictures of runs.
#include <stdlib.h>
#include <string.h>

#include "cli.h"
#include "dem/picture.h"
#include "out/results.h"

typedef struct arguments {
    cli_common common;
    const char *output;
    int colour;
    bool spheres, no_walls;
    long width, height;
    double azimuth, elevation;
} arguments;

static const char about[] =
    "Draws the last state of a run, grains as their surfaces, by rays on the processor: no display, no GPU.";

static const char epilogue[] = "Examples:\n"
                               "  dem-view out/ -o last.png\n"
                               "  dem-view out/ -o fast.png --colour speed --width 1600 --height 900\n"
                               "Exit status: 0 done, 2 wrong usage, 3 bad input, 4 cannot write, 130 interrupted.";

// the choices as the library counts them
static const char colour_names[] = "number|shape|size|speed|spin|coordination|height";

static int draw(const cli_tool *tool, const arguments *a, const char *directory)
{
    cli_session session;
    cli_begin(&session, tool, &a->common);
    dem_ctx ctx = cli_ctx(&session, directory);
    dem_results results;
    dem_error error;
    dem_status status = dem_results_read(&ctx, directory, &results, &error);
    if (status == DEM_OK) {
        dem_picture_options o = dem_picture_defaults();
        o.width = (int)a->width;
        o.height = (int)a->height;
        o.colour = (dem_picture_colour)a->colour;
        o.spheres = a->spheres;
        o.azimuth_deg = a->azimuth;
        o.elevation_deg = a->elevation;
        o.domain = results.scene.domain;
        if (!a->no_walls) {
            o.walls = results.scene.walls;
            o.wall_count = results.scene.wall_count;
        }
        status = dem_picture_bodies(&ctx, &results.bodies, (const dem_clump *const *)results.clumps,
                                    results.scene.shape_count, &o, a->output, &error);
    }
    int exit_status = status == DEM_OK ? 0 : cli_session_error(&session, &error);
    dem_results_release(&results);
    cli_end(&session);
    return exit_status;
}

int main(int argc, char **argv)
{
    dem_picture_options o = dem_picture_defaults();
    arguments a = {.common = CLI_COMMON_DEFAULTS,
                   .width = o.width,
                   .height = o.height,
                   .azimuth = o.azimuth_deg,
                   .elevation = o.elevation_deg};
    const cli_option options[] = {
        {.help = "Picture"},
        {"output", 'o', CLI_TEXT, "FILE", "PNG file to write; - is standard output", &a.output, 0, 0},
        {"colour", 'c', CLI_CHOICE, colour_names, "what the colours show (default number: each body its own)",
         &a.colour, 0, 0},
        {"spheres", 0, CLI_FLAG, NULL, "draw the spheres of the clumps, not the surfaces of the grains", &a.spheres, 0,
         0},
        {"no-walls", 0, CLI_FLAG, NULL, "leave the walls out", &a.no_walls, 0, 0},
        {"width", 0, CLI_WHOLE, "PIXELS", "of the picture (default 1200)", &a.width, 16, 16384},
        {"height", 0, CLI_WHOLE, "PIXELS", "of the picture (default 1600)", &a.height, 16, 16384},
        {"azimuth", 0, CLI_NUMBER, "DEG", "where it is seen from, about the vertical (default -60)", &a.azimuth, -360,
         360},
        {"elevation", 0, CLI_NUMBER, "DEG", "and above the ground (default 18)", &a.elevation, -89, 89},
        CLI_COMMON_OPTIONS(a.common),
    };
    const cli_tool tool = {.name = "dem-view",
                           .usage = "DIR -o FILE.png [options]",
                           .about = about,
                           .options = options,
                           .option_count = sizeof options / sizeof *options,
                           .epilogue = epilogue};
    cli_texts operands = {0};
    int status;
    if (cli_parse(&tool, argc, argv, &operands, &status) == CLI_GO) {
        if (operands.count != 1)
            status =
                cli_wrong_usage(&tool, operands.count ? "one run at a time" : "name the output directory of a run");
        else if (!a.output)
            status = cli_wrong_usage(&tool, "name the file to write, as in -o last.png");
        else
            status = draw(&tool, &a, operands.items[0]);
    }
    cli_texts_release(&operands);
    return status;
}
