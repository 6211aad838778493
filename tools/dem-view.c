/// dem-view: pictures of runs, clumps and meshes.
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "base/memory.h"
#include "math/vec.h"
#include "out/legend.h"
#include "out/grid.h"
#include "view.h"

static const char about[] =
    "Draws runs, clumps and meshes by rays on the processor: no display, no GPU. A run is shown as the surfaces of its "
    "grains, with a scale bar, its time and a bar of the colours; several inputs, or a folder of clumps, as a sheet.";

static const char epilogue[] =
    "Colours: number (each body its own), shape, size, speed, spin, coordination, height, mass, x, y, z,\n"
    "and every array of a frame, as in velocity:z or angular_velocity.\n"
    "Examples:\n"
    "  dem-view out/ -o last.png\n"
    "  dem-view out/ -o fast.png --colour speed --range \"0..0.5 m/s\" --clip \"x<7mm\" --time 0.05\n"
    "  dem-view out/ -o chains.png --contacts    # which grains bear the load\n"
    "  dem-view out/ -o frames/%04d.png --frames all --colour velocity:z\n"
    "  dem-view grain.json -o grain.png           # its surface and its spheres, side by side\n"
    "  dem-view clumps/ -o sheet.png              # every clump of a folder, with its name\n"
    "  dem-view rock.stl --unit mm -o rock.png --azimuth 30 --elevation 20\n"
    "Exit status: 0 done, 2 wrong usage, 3 bad input, 4 cannot write, 130 interrupted.";

// ---- what was drawn, for the summary

typedef struct report {
    dem_buffer text;
    dem_json_writer json;
    bool as_json, quiet;
    double began;
} report;

static void report_picture(report *r, const char *path, const view_run *run, const dem_picture_span *span, long frame,
                           size_t parts)
{
    char low_text[DEM_LABEL_TEXT], high_text[DEM_LABEL_TEXT], time[DEM_LABEL_TEXT] = "";
    double low = NAN, high = NAN;
    bool valued = run && run->options.colour == DEM_PICTURE_VALUES;
    if (valued)
        dem_picture_range(&run->options, span, &low, &high);
    if (r->as_json) {
        dem_json_open_object(&r->json, NULL);
        dem_json_put_string(&r->json, "file", path);
        if (run && frame >= 0)
            dem_json_put_whole(&r->json, "frame", frame);
        if (run) {
            dem_json_put_number(&r->json, "time", run->options.time);
            dem_json_put_whole(&r->json, "bodies", (int64_t)run->shown);
        }
        if (valued) {
            dem_json_put_string(&r->json, "colour", run->field.title);
            dem_json_put_string(&r->json, "unit", run->field.unit);
            dem_json_put_numbers(&r->json, "range", (double[]){low, high}, 2);
        }
        if (!run)
            dem_json_put_whole(&r->json, "parts", (int64_t)parts);
        dem_json_close(&r->json, '}');
        return;
    }
    dem_buffer_print(&r->text, "%s: ", path);
    if (run) {
        if (isfinite(run->options.time))
            dem_quantity_text(run->options.time, "s", run->options.time, time);
        dem_buffer_print(&r->text, "%zu %s%s%s", run->shown, run->choices->arguments->contacts ? "contacts" : "bodies",
                         *time ? " at t = " : "", time);
        if (valued)
            dem_buffer_print(&r->text, ", %s from %s to %s", run->field.title,
                             dem_quantity_text(low, run->field.unit, fmax(fabs(low), fabs(high)), low_text),
                             dem_quantity_text(high, run->field.unit, fmax(fabs(low), fabs(high)), high_text));
    } else {
        dem_buffer_print(&r->text, "%zu picture%s", parts, parts == 1 ? "" : "s");
    }
    dem_buffer_text(&r->text, "\n");
}

static int print_report(cli_session *session, report *r, bool to_stdout)
{
    if (r->as_json) {
        dem_json_close(&r->json, ']');
        cli_put_warnings(session, &r->json);
        dem_json_close(&r->json, '}');
        dem_buffer_text(&r->text, "\n");
    }
    if (!r->as_json && (r->quiet || to_stdout)) {  // the picture itself is there
        dem_buffer_release(&r->text);
        return 0;
    }
    return cli_print(session->tool, &r->text);
}

// ---- one picture

static dem_status draw_run(const dem_ctx *ctx, const view_choices *c, const view_input *in, int width, int height,
                           dem_image *image, report *r, dem_error *error)
{
    view_run run;
    dem_picture_span span = {0};
    long frame = VIEW_LAST;
    dem_status status = view_run_open(ctx, c, in->kind == VIEW_FRAME ? in->directory : in->path, &run, error);
    if (status == DEM_OK && in->kind == VIEW_RUN)
        status = view_run_frame(&run, &frame, error);
    if (status == DEM_OK)
        status = view_run_load(&run, frame, in->kind == VIEW_FRAME ? in->path : NULL, error);
    run.options.width = width;
    run.options.height = height;
    if (status == DEM_OK)
        status = view_run_measure(&run, &span, error);
    if (status == DEM_OK)
        status = view_run_draw(ctx, &run, &span, width, height, image, error);
    if (status == DEM_OK && r)
        report_picture(r, c->arguments->output, &run, &span, frame, 1);
    view_run_release(&run);
    return status;
}

static dem_status draw_grain(const dem_ctx *ctx, const view_choices *c, const view_input *in, bool alone, double pixel,
                             int width, int height, dem_image *image, dem_error *error)
{
    view_grain grain;
    dem_status status = view_grain_open(ctx, c, in->path, alone, &grain, error);
    grain.picture.pixel = pixel;
    if (status == DEM_OK) {
        bool pair = grain.picture.mesh && grain.picture.count;
        width = width ? width : pair ? 2000 : 1200;
        height = height ? height : pair ? 1000 : 1200;
        status = view_grain_draw(ctx, c, &grain, width, height, image, error);
    }
    view_grain_release(&grain);
    return status;
}

static dem_status draw_one(const dem_ctx *ctx, const view_choices *c, const view_input *in, report *r, dem_error *error)
{
    dem_image image = {0};
    const dem_picture_options defaults = dem_picture_defaults();
    if (in->kind == VIEW_GRAIN) {
        DEM_TRY(draw_grain(ctx, c, in, true, 0, c->width, c->height, &image, error));
        report_picture(r, c->arguments->output, NULL, NULL, VIEW_LAST, 1);
    } else {
        DEM_TRY(draw_run(ctx, c, in, c->width ? c->width : defaults.width, c->height ? c->height : defaults.height,
                         &image, r, error));
    }
    return dem_png_write(&image, c->arguments->output, error);
}

// ---- a sequence

// progress over all pictures
typedef struct steps {
    const dem_ctx *outer;
    size_t done, all;
} steps;

static bool on_step(void *user, const char *what, double fraction)
{
    const steps *s = user;
    (void)what;
    return dem_progress(s->outer, "drawing", ((double)s->done + fraction) / (double)s->all);
}

static dem_ctx stepped(const dem_ctx *ctx, steps *s)
{
    dem_ctx own = *ctx;
    own.progress = on_step;
    own.user = s;
    own.log = NULL;
    return own;
}

static dem_status make_folder_of(const char *path, dem_error *error)
{
    size_t length = (size_t)(dem_file_name(path) - path);
    if (length == 0)
        return DEM_OK;
    char *folder = strndup(path, length);
    dem_status status = folder ? dem_folder_create(folder, error) : dem_fail_memory(error);
    free(folder);
    return status;
}

static dem_status measure_frames(const dem_ctx *ctx, view_run *run, const size_t *frames, size_t count,
                                 dem_picture_span *span, dem_error *error)
{
    for (size_t i = 0; i < count; i++) {
        if (dem_progress(ctx, "reading frames", (double)i / (double)count))
            return dem_fail(error, DEM_INTERRUPTED, "interrupted while reading frames");
        DEM_TRY(view_run_load(run, (long)frames[i], NULL, error));
        DEM_TRY(view_run_measure(run, span, error));
    }
    return DEM_OK;
}

static dem_status draw_frames(const dem_ctx *ctx, view_run *run, const size_t *frames, size_t count,
                              const dem_picture_span *span, report *r, dem_error *error)
{
    steps s = {ctx, 0, count};
    dem_ctx step = stepped(ctx, &s);
    for (; s.done < count; s.done++) {
        dem_image image = {0};
        char *path = view_numbered(run->choices->arguments->output, frames[s.done]);
        dem_status status = path ? make_folder_of(path, error) : dem_fail_memory(error);
        if (status == DEM_OK)
            status = view_run_load(run, (long)frames[s.done], NULL, error);
        if (status == DEM_OK)
            status = view_run_draw(&step, run, span, run->options.width, run->options.height, &image, error);
        if (status == DEM_OK)
            status = dem_png_write(&image, path, error);
        if (status == DEM_OK)
            report_picture(r, path, run, span, (long)frames[s.done], 1);
        free(path);
        DEM_TRY(status);
    }
    return DEM_OK;
}

// the camera and the colours are the same in all of them
static dem_status draw_sequence(const dem_ctx *ctx, const view_choices *c, const view_input *in, report *r,
                                dem_error *error)
{
    view_run run;
    dem_picture_span span = {0};
    size_t *frames = NULL, count = 0;
    dem_status status = view_run_open(ctx, c, in->path, &run, error);
    run.options.width = c->width ? c->width : run.options.width;
    run.options.height = c->height ? c->height : run.options.height;
    if (status == DEM_OK)
        status = view_frames(c->arguments->frames, run.results.index.count, &frames, &count, error);
    if (status == DEM_OK && count > 1 && !view_is_pattern(c->arguments->output))
        status = dem_fail(error, DEM_USAGE, "%zu pictures need names with a number; write -o frames/%%04d.png", count);
    if (status == DEM_OK)
        status = measure_frames(ctx, &run, frames, count, &span, error);
    if (status == DEM_OK)
        status = draw_frames(ctx, &run, frames, count, &span, r, error);
    free(frames);
    view_run_release(&run);
    return status;
}

// ---- a sheet

// a sheet that is rather broad than high, with few empty cells
static double choose_columns(double count, double aspect)
{
    double best = count, least = INFINITY;
    for (double columns = 1; columns <= count && columns <= 1000; columns++) {
        double rows = ceil(count / columns), off = fabs(log(columns * aspect / rows / 1.35));
        double cost = off + (rows > 1 ? 1.5 * (rows * columns - count) / count : 0);
        if (cost < least)
            best = columns, least = cost;
    }
    return best;
}

// as large as the number of cells asks for
static dem_grid divide(const view_choices *c, const view_inputs *all)
{
    const view_arguments *a = c->arguments;
    size_t runs = 0;
    for (size_t i = 0; i < all->count; i++)
        runs += all->items[i].kind != VIEW_GRAIN;
    double aspect = runs ? 0.75 : 1;
    double n = (double)all->count, columns = a->columns ? fmin((double)a->columns, n) : choose_columns(n, aspect);
    double cell = fmin(fmax(2400 / columns, 160), runs ? 900 : 700);
    int width = c->width ? c->width : (int)(columns * cell);
    int height = c->height ? c->height : (int)(ceil(n / columns) * cell * (1 / aspect + (a->no_names ? 0 : 0.12)));
    // columns that were not asked for are free where the size is
    size_t fixed = a->columns ? (size_t)a->columns : c->width || c->height ? 0 : (size_t)columns;
    return dem_grid_divide(all->count, width, height, fixed, aspect, !a->no_names, a->label_size);
}

// the largest breadth of a pixel of all grains, so that they are drawn to one scale
static dem_status common_pixel(const dem_ctx *ctx, const view_choices *c, const view_inputs *all, const dem_grid *sheet,
                               double *pixel, dem_error *error)
{
    *pixel = 0;
    for (size_t i = 0; i < all->count; i++) {
        view_grain grain;
        double own = 0;
        if (all->items[i].kind != VIEW_GRAIN)
            continue;
        dem_status status = view_grain_open(ctx, c, all->items[i].path, false, &grain, error);
        if (status == DEM_OK)
            status = view_grain_pixel(c, &grain, sheet->cell_width, sheet->cell_height, &own, error);
        view_grain_release(&grain);
        DEM_TRY(status);
        *pixel = fmax(*pixel, own);
    }
    return DEM_OK;
}

static dem_status draw_cells(const dem_ctx *ctx, const view_choices *c, const view_inputs *all, const dem_grid *sheet,
                             double pixel, dem_image *image, dem_error *error)
{
    view_choices cell = *c;
    view_arguments arguments = *c->arguments;
    steps s = {ctx, 0, all->count};
    dem_ctx step = stepped(ctx, &s);
    arguments.label_size = arguments.label_size > 0 ? arguments.label_size : fmax(round(0.7 * sheet->text_size), 8);
    cell.arguments = &arguments;
    c = &cell;
    for (; s.done < all->count; s.done++) {
        const view_input *in = &all->items[s.done];
        dem_image part = {0};
        int left, top, width = sheet->cell_width, height = sheet->cell_height;
        if (in->kind == VIEW_GRAIN)
            DEM_TRY(draw_grain(&step, c, in, false, pixel, width, height, &part, error));
        else
            DEM_TRY(draw_run(&step, c, in, width, height, &part, NULL, error));
        dem_grid_cell(sheet, s.done, &left, &top);
        dem_image_paste(image, &part, left, top);
        dem_image_free(&part);
        if (sheet->name_height)
            DEM_TRY(dem_grid_name(sheet, image, s.done, in->name, dem_ink_on(c->background), error));
    }
    return DEM_OK;
}

static dem_status draw_sheet(const dem_ctx *ctx, const view_choices *c, const view_inputs *all, report *r,
                             dem_error *error)
{
    dem_grid sheet = divide(c, all);
    const uint8_t *b = c->background;
    dem_image image;
    double pixel = 0;
    if (sheet.cell_width < 16 || sheet.cell_height < 16)
        return dem_fail(error, DEM_USAGE, "%zu pictures do not fit into %d x %d pixels; give a larger --size",
                        all->count, sheet.width, sheet.height);
    if (c->arguments->same_scale)
        DEM_TRY(common_pixel(ctx, c, all, &sheet, &pixel, error));
    DEM_TRY(dem_image_create(sheet.width, sheet.height, &image, error));
    dem_image_fill(&image, (dem_rgb){b[0], b[1], b[2]});
    dem_status status = draw_cells(ctx, c, all, &sheet, pixel, &image, error);
    if (status != DEM_OK) {
        dem_image_free(&image);
        return status;
    }
    report_picture(r, c->arguments->output, NULL, NULL, VIEW_LAST, all->count);
    return dem_png_write(&image, c->arguments->output, error);
}

// ---- the tool

static dem_status check_use(const view_arguments *a, const view_inputs *all, dem_error *error)
{
    size_t grains = 0, runs = 0;
    for (size_t i = 0; i < all->count; i++) {
        grains += all->items[i].kind == VIEW_GRAIN;
        runs += all->items[i].kind == VIEW_RUN;
    }
    if ((a->frames != NULL) + (a->frame != NULL) + !isnan(a->time) > 1)
        return dem_fail(error, DEM_USAGE, "--time, --frame and --frames each choose frames; give one of them");
    if ((a->frames || a->frame || !isnan(a->time)) && runs < all->count)
        return dem_fail(error, DEM_USAGE, "only the directory of a run has frames to choose from; name one");
    if (a->frames && all->count > 1)
        return dem_fail(error, DEM_USAGE, "a sequence shows one run; name one, or take a frame of each with --frame");
    if (grains && (a->colour || a->range || a->clips.count || a->bodies))
        return dem_fail(
            error, DEM_USAGE,
            "--colour, --range, --clip and --bodies are for runs; clumps and meshes have nothing to choose");
    if (a->contacts && runs < all->count)
        return dem_fail(error, DEM_USAGE, "--contacts are those of a run; name its directory");
    if (a->contacts && (a->colour || a->clips.count || a->bodies))
        return dem_fail(error, DEM_USAGE, "--contacts are coloured by their force and drawn all; leave --colour, --clip "
                                          "and --bodies out");
    if (a->orthographic && a->perspective)
        return dem_fail(error, DEM_USAGE, "--orthographic or --perspective; give one of them");
    return DEM_OK;
}

static dem_status work(const dem_ctx *ctx, const view_arguments *a, const cli_texts *operands, report *r,
                       dem_error *error)
{
    view_choices choices;
    view_inputs all = {0};
    dem_status status = view_choose(a, &choices, error);
    if (status == DEM_OK)
        status = view_find(operands, &all, error);
    if (status == DEM_OK)
        status = check_use(a, &all, error);
    if (status == DEM_OK && a->frames)
        status = draw_sequence(ctx, &choices, &all.items[0], r, error);
    else if (status == DEM_OK && all.count > 1)
        status = draw_sheet(ctx, &choices, &all, r, error);
    else if (status == DEM_OK)
        status = draw_one(ctx, &choices, &all.items[0], r, error);
    view_inputs_release(&all);
    return status;
}

static int run_tool(const cli_tool *tool, const view_arguments *a, const cli_texts *operands)
{
    cli_session session;
    dem_error error;
    cli_begin(&session, tool, &a->common);
    dem_ctx ctx = cli_ctx(&session, operands->count == 1 ? operands->items[0] : NULL);
    report r = {.as_json = a->common.json, .quiet = a->common.quiet};
    if (r.as_json) {
        r.json = dem_json_begin(&r.text);
        dem_json_open_object(&r.json, NULL);
        dem_json_open_array(&r.json, "pictures", true);
    }
    dem_status status = work(&ctx, a, operands, &r, &error);
    int exit_status = status == DEM_OK ? print_report(&session, &r, strcmp(a->output, "-") == 0)
                                       : cli_session_error(&session, &error);
    if (status != DEM_OK)
        dem_buffer_release(&r.text);
    cli_end(&session);
    return exit_status;
}

int main(int argc, char **argv)
{
    view_arguments a = {
        .common = CLI_COMMON_DEFAULTS, .samples = 16, .azimuth = NAN, .elevation = NAN, .zoom = 1, .time = NAN};
    const cli_option options[] = {
        {.help = "Picture"},
        {"output", 'o', CLI_TEXT, "FILE", "PNG file to write; - is standard output, %04d the number of a frame",
         &a.output, 0, 0},
        {"size", 0, CLI_TEXT, "WxH", "pixels (default 1200x1600 for a run, else as needed)", &a.size, 0, 0},
        {"width", 0, CLI_WHOLE, "PIXELS", "one of them alone", &a.width, 16, 16384},
        {"height", 0, CLI_WHOLE, "PIXELS", "the other", &a.height, 16, 16384},
        {"background", 0, CLI_TEXT, "COLOUR", "white (default), black, grey or \"#f4f1ea\"", &a.background, 0, 0},
        {"samples", 0, CLI_WHOLE, "N", "rays through a pixel where edges are (default 16)", &a.samples, 1, 1024},
        {"no-labels", 0, CLI_FLAG, NULL, "no colour bar, no scale bar, no time", &a.no_labels, 0, 0},
        {"label-size", 0, CLI_NUMBER, "PIXELS", "height of a capital letter (default: as the picture needs)",
         &a.label_size, 4, 400},
        {.help = "What is shown"},
        {"colour", 'c', CLI_TEXT, "FIELD", "what the colours of bodies show, or wear, of walls (default number)", &a.colour, 0, 0},
        {"range", 0, CLI_TEXT, "LOW..HIGH", "values at the ends of the colours, as in \"0..2 mm\" (default: all)",
         &a.range, 0, 0},
        {"map", 0, CLI_CHOICE, "auto|ramp|diverging|warm|grey", "colours of the range (default auto)", &a.map, 0, 0},
        {"spheres", 0, CLI_FLAG, NULL, "the spheres of clumps, not the surfaces of their grains", &a.spheres, 0, 0},
        {"surface", 0, CLI_FLAG, NULL, "of a clump file only the surface it keeps (default: both, side by side)",
         &a.surface, 0, 0},
        {"contacts", 0, CLI_FLAG, NULL,
         "the forces of contacts as rods, instead of bodies (needs output.contacts in the scene)", &a.contacts, 0, 0},
        {"clip", 0, CLI_TEXTS, "COND", "leave out the bodies for which it holds: \"x<5mm\", \"speed>1m/s\"; repeatable",
         &a.clips, 0, 0},
        {"bodies", 0, CLI_TEXT, "LIST", "only these, by number: 0-99,200,300-", &a.bodies, 0, 0},
        {"no-walls", 0, CLI_FLAG, NULL, "leave the walls out", &a.no_walls, 0, 0},
        {"unit", 0, CLI_TEXT, "UNIT", "length unit of mesh files, for the scale bar", &a.unit, 0, 0},
        {.help = "Frames of a run (default: its last state)"},
        {"time", 0, CLI_TIME, "T", "the frame nearest to this time", &a.time, 0, INFINITY},
        {"frame", 0, CLI_TEXT, "K", "by number, from 0; or last", &a.frame, 0, 0},
        {"frames", 0, CLI_TEXT, "WHICH", "a sequence: all, A-B, \"every N\", \"A-B every N\"; one camera and range",
         &a.frames, 0, 0},
        {.help = "Camera"},
        {"azimuth", 0, CLI_NUMBER, "DEG", "where it is seen from, about the vertical (default -60)", &a.azimuth, -360,
         360},
        {"elevation", 0, CLI_NUMBER, "DEG", "and above the ground (default 18)", &a.elevation, -89, 89},
        {"up", 0, CLI_TEXT, "AXIS", "x, y, z, -x, ... (default: against gravity)", &a.up, 0, 0},
        {"zoom", 0, CLI_NUMBER, "F", "enlarge by this factor (default 1: everything fits)", &a.zoom, 0.001, 1e6},
        {"look-at", 0, CLI_TEXT, "X,Y,Z", "point in the middle, as in 0,0,5mm (default: of everything)", &a.look_at, 0,
         0},
        {"orthographic", 0, CLI_FLAG, NULL, "parallel rays (default for clumps and meshes)", &a.orthographic, 0, 0},
        {"perspective", 0, CLI_FLAG, NULL, "the view of an eye (default for runs)", &a.perspective, 0, 0},
        {.help = "Several inputs"},
        {"columns", 0, CLI_WHOLE, "N", "of the sheet (default: as fits)", &a.columns, 1, 1000},
        {"same-scale", 0, CLI_FLAG, NULL, "draw all clumps and meshes to one scale", &a.same_scale, 0, 0},
        {"no-names", 0, CLI_FLAG, NULL, "no names under them", &a.no_names, 0, 0},
        CLI_COMMON_OPTIONS(a.common),
    };
    const cli_tool tool = {.name = "dem-view",
                           .usage = "INPUT... -o FILE.png [options]",
                           .about = about,
                           .options = options,
                           .option_count = sizeof options / sizeof *options,
                           .epilogue = epilogue};
    cli_texts operands = {0};
    int status;
    if (cli_parse(&tool, argc, argv, &operands, &status) == CLI_GO) {
        if (operands.count == 0)
            status = cli_wrong_usage(&tool, "name the output directory of a run, or clumps or meshes");
        else if (!a.output)
            status = cli_wrong_usage(&tool, "name the file to write, as in -o last.png");
        else if (a.common.json && strcmp(a.output, "-") == 0)
            status = cli_wrong_usage(&tool, "--json and the picture both want standard output");
        else
            status = run_tool(&tool, &a, &operands);
    }
    cli_texts_release(&operands);
    cli_texts_release(&a.clips);
    return status;
}
