// `dem-clump verify`: exports a clump, lets the programs move it, and compares the kinetic energies they report with
// what its mass and moments of inertia give.
#define _GNU_SOURCE
#include "clump_verify.h"

#include <errno.h>
#include <ftw.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/file.h"
#include "base/memory.h"
#include "cli.h"
#include "clump_engine.h"
#include "math/vec.h"

static const double TOLERANCE = 1e-6;  // relative; of the centre, of the clump's radius

static const engine *const engines[] = {&engine_lammps, &engine_liggghts, &engine_yade};
enum { ENGINES = sizeof engines / sizeof *engines, QUANTITIES = 5 };
static const char engine_names[] = "lammps|liggghts|yade|all";

typedef struct arguments {
    cli_common common;
    int engine;
    double wall;
    const char *kept;
} arguments;

typedef struct quantity {
    const char *name, *unit;
    double ours, theirs, difference;  // NAN: not known
    bool told;                        // not measured, but what the program says
} quantity;

// what came of one program
typedef struct verdict {
    const engine *e;
    const char *skipped;  // why it was not asked; NULL: it was
    dem_status status;
    dem_error error;
    engine_answer answer;
    quantity quantities[QUANTITIES];
    bool agrees;
} verdict;

// ---- asking

// largest difference between how far a sphere is from the axis about which the clump turns and how far it should be
static double centre_offset(const engine_question *q, const engine_answer *answer)
{
    double worst = NAN;
    for (int axis = 0; axis < 3; axis++) {
        const engine_motion *m = &answer->motions[1 + axis];
        for (size_t i = 0; !isnan(m->rate) && i < q->def.ball_count; i++) {
            dem_vec3 c = q->def.balls[i].centre;
            v3_set(&c, axis, 0);
            double off = fabs(v3_norm(m->velocity[i]) / m->rate - v3_norm(c));
            worst = isnan(worst) ? off : fmax(worst, off);
        }
    }
    return worst;
}

// E = m v^2 / 2 and E = I w^2 / 2, the other way round
static void set_quantities(const engine_question *q, verdict *v)
{
    static const char *const names[] = {"mass", "I1", "I2", "I3"};
    v->agrees = true;
    for (int k = 0; k < ENGINE_MOTIONS; k++) {
        const engine_motion *m = &v->answer.motions[k];
        double ours = k == 0 ? q->def.mass : q->def.inertia[k - 1];
        double theirs = 2 * (k == 0 ? m->translating : m->turning) / (m->rate * m->rate);
        bool told = k > 0 && isnan(theirs) && !isnan(v->answer.told[k - 1]);
        if (told)
            theirs = v->answer.told[k - 1];
        v->quantities[k] = (quantity){names[k], k == 0 ? "kg" : "kg m^2", ours, theirs, theirs / ours - 1, told};
    }
    double off = centre_offset(q, &v->answer);
    v->quantities[4] = (quantity){"centre", "m", 0, off, off / engine_reach(q), false};
    for (int k = 0; k < QUANTITIES; k++)
        v->agrees = v->agrees && !(fabs(v->quantities[k].difference) > TOLERANCE);
    v->agrees = v->agrees && fabs(v->quantities[0].difference) <= TOLERANCE;  // known in any case
}

static dem_status take_room(engine_answer *answer, size_t count, dem_error *error)
{
    bool room = true;
    answer->told[0] = answer->told[1] = answer->told[2] = NAN;
    for (int k = 0; k < ENGINE_MOTIONS; k++) {
        answer->motions[k].at = dem_alloc(count, sizeof *answer->motions[k].at);
        answer->motions[k].velocity = dem_alloc(count, sizeof *answer->motions[k].velocity);
        room = room && answer->motions[k].at && answer->motions[k].velocity;
    }
    return room ? DEM_OK : dem_fail_memory(error);
}

static int remove_entry(const char *path, const struct stat *about, int kind, struct FTW *walk)
{
    (void)about;
    (void)kind;
    (void)walk;
    return remove(path);
}

// the folder a program runs in, from the root: of its own in the one to keep, or for a while
static dem_status make_folder(const arguments *a, const engine *e, char **folder, dem_error *error)
{
    const char *temporary = getenv("TMPDIR");
    char *path;
    int length = a->kept ? asprintf(&path, "%s/%s", a->kept, e->name)
                         : asprintf(&path, "%s/dem-clump-XXXXXX", temporary && *temporary ? temporary : "/tmp");
    if (length < 0)
        return dem_fail_memory(error);
    dem_status status = a->kept ? dem_folder_create(path, error)
                        : mkdtemp(path)
                            ? DEM_OK
                            : dem_fail_at(error, DEM_CANNOT_WRITE, path, 0,
                                          "cannot make a folder; set TMPDIR to a place that can be written");
    if (status == DEM_OK && !(*folder = realpath(path, NULL)))
        status = dem_fail_at(error, DEM_CANNOT_WRITE, path, 0, "%s; choose another place", strerror(errno));
    free(path);
    return status;
}

static dem_status ask(const arguments *a, engine_question *q, verdict *v)
{
    char *folder = NULL;
    DEM_TRY(make_folder(a, v->e, &folder, &v->error));
    q->folder = folder;
    dem_status status = take_room(&v->answer, q->def.ball_count, &v->error);
    if (status == DEM_OK)
        status = v->e->ask(q, &v->answer, &v->error);
    if (status == DEM_OK)
        set_quantities(q, v);
    for (int k = 0; k < ENGINE_MOTIONS; k++) {
        free(v->answer.motions[k].at);
        free(v->answer.motions[k].velocity);
    }
    if (!a->kept)
        nftw(folder, remove_entry, 16, FTW_DEPTH | FTW_PHYS);
    free(folder);
    return status;
}

// ---- telling

static const char *number(char text[32], double value)
{
    return isnan(value) ? "-" : dem_format_double(text, 32, value, 10);
}

static const char *word(const quantity *q)
{
    bool agrees = fabs(q->difference) <= TOLERANCE;
    if (q->told)
        return agrees ? "agrees, as it says" : "DIFFERS, as it says";
    return isnan(q->difference) ? "not measured" : agrees ? "agrees" : "DIFFERS";
}

static void tell(dem_buffer *out, const verdict *v)
{
    char version[96], ours[32], theirs[32], difference[32];
    snprintf(version, sizeof version, "%s %s", v->e->title, v->answer.version);
    if (v->skipped)
        dem_buffer_print(out, "  %-34.34s skipped: %s\n", v->e->title, v->skipped);
    else if (v->status != DEM_OK)
        dem_buffer_print(out, "  %-34.34s FAILED\n", version);
    for (int k = 0; !v->skipped && v->status == DEM_OK && k < QUANTITIES; k++) {
        const quantity *q = &v->quantities[k];
        dem_buffer_print(out, "  %-34.34s %-7s%-8s %17s %17s %11s  %s\n", k ? "" : version, q->name, q->unit,
                         number(ours, q->ours), number(theirs, q->theirs),
                         isnan(q->difference) ? "-" : dem_format_double(difference, 32, q->difference, 2), word(q));
    }
}

static void tell_all(dem_buffer *out, const char *path, const dem_clump_def *def, const verdict *verdicts, int count)
{
    dem_buffer_print(out, "%s: %zu sphere%s; what each program really uses, from the kinetic energy it reports\n\n",
                     path, def->ball_count, def->ball_count == 1 ? "" : "s");
    dem_buffer_print(out, "  %-34s %-15s %17s %17s %11s\n", "program", "quantity", "clump", "program", "difference");
    for (int i = 0; i < count; i++)
        tell(out, &verdicts[i]);
}

static void put_verdict(dem_json_writer *w, const verdict *v)
{
    dem_json_open_object(w, NULL);
    dem_json_put_string(w, "engine", v->e->name);
    dem_json_put_string(w, "version", v->answer.version);
    dem_json_put_string(w, "status",
                        v->skipped            ? "skipped"
                        : v->status != DEM_OK ? "failed"
                        : v->agrees           ? "agrees"
                                              : "differs");
    if (v->skipped || v->status != DEM_OK)
        dem_json_put_string(w, "reason", v->skipped ? v->skipped : v->error.text);
    dem_json_put_number(w, "seconds", v->answer.seconds);
    dem_json_open_array(w, "quantities", false);
    for (int k = 0; !v->skipped && v->status == DEM_OK && k < QUANTITIES; k++) {
        const quantity *q = &v->quantities[k];
        dem_json_open_object(w, NULL);
        dem_json_put_string(w, "name", q->name);
        dem_json_put_string(w, "unit", q->unit);
        dem_json_put_number(w, "clump", q->ours);
        dem_json_put_number(w, "engine", q->theirs);
        dem_json_put_number(w, "difference", q->difference);
        dem_json_put_bool(w, "measured", !q->told && !isnan(q->difference));
        dem_json_close(w, '}');
    }
    dem_json_close(w, ']');
    dem_json_close(w, '}');
}

static void put_all(cli_session *session, dem_buffer *out, const char *path, const dem_clump_def *def,
                    const verdict *verdicts, int count, bool agree)
{
    dem_json_writer writer = dem_json_begin(out), *w = &writer;
    dem_json_open_object(w, NULL);
    dem_json_put_string(w, "clump", path);
    dem_json_put_whole(w, "spheres", (int64_t)def->ball_count);
    dem_json_put_number(w, "tolerance", TOLERANCE);
    dem_json_put_bool(w, "agree", agree);
    dem_json_open_array(w, "engines", true);
    for (int i = 0; i < count; i++)
        put_verdict(w, &verdicts[i]);
    dem_json_close(w, ']');
    cli_put_warnings(session, w);
    dem_json_close(w, '}');
}

// ---- the whole

// asks one program, or says why not
static void judge(cli_session *session, const arguments *a, engine_question *q, verdict *v)
{
    dem_ctx ctx = cli_ctx(session, NULL);
    if (q->def.ball_count < v->e->least_spheres) {
        v->skipped = "it has no clump of a single sphere";
    } else if (!engine_find(v->e, v->answer.program)) {
        v->skipped = "not installed";
        if (a->engine != ENGINES) {
            v->status = dem_fail(&v->error, DEM_BAD_INPUT, "%s is not in PATH; install it (Debian: apt install %s)",
                                 v->e->title, v->e->package);
            cli_session_error(session, &v->error);
        }
    } else {
        q->ctx = &ctx;
        v->status = ask(a, q, v);
        if (v->status != DEM_OK)
            cli_session_error(session, &v->error);
    }
}

static int verify(const cli_tool *tool, const arguments *a, const char *path, dem_clump *clump)
{
    verdict verdicts[ENGINES] = {0};
    engine_question q = {.clump = clump, .def = dem_clump_view(clump), .wall = a->wall};
    cli_session session;
    int count = 0, asked = 0, status = 0;
    cli_begin(&session, tool, &a->common);
    for (int i = 0; i < ENGINES && !cli_interrupted(); i++) {
        if (a->engine != ENGINES && a->engine != i)
            continue;
        verdict *v = &verdicts[count++];
        v->e = engines[i];
        judge(&session, a, &q, v);
        asked += !v->skipped;
        if (v->status != DEM_OK)
            status = v->status == DEM_NO_MEMORY ? DEM_FAILED : v->status;
        else if (!v->skipped && !v->agrees && status == 0)
            status = DEM_FAILED;
    }
    dem_ctx ctx = cli_ctx(&session, NULL);
    if (asked == 0 && status == 0)
        dem_log(&ctx, DEM_LOG_WARNING,
                "nothing was verified: none of LAMMPS, LIGGGHTS, Yade can be asked; install one");
    dem_buffer text = {0};
    if (a->common.json)
        put_all(&session, &text, path, &q.def, verdicts, count, asked && status == 0);
    else if (!a->common.quiet)
        tell_all(&text, path, &q.def, verdicts, count);
    cli_end(&session);
    int printed = text.size ? cli_print(tool, &text) : 0;
    return cli_interrupted() ? DEM_INTERRUPTED : printed ? printed : status;
}

int clump_verify(int argc, char **argv)
{
    static const char about[] =
        "Exports a clump to simulation programs that are installed, lets each of them move it (a translation, and a "
        "turn "
        "about each principal axis), and compares mass, moments of inertia and centre that follow from the kinetic "
        "energies it reports with those of the clump, to 1e-6.";
    static const char epilogue[] =
        "Exit status: 0 all that were asked agree, 1 one differs or failed, 2 wrong usage, 3 bad clump or the program "
        "that was named is not installed, 4 cannot write, 130 interrupted.";
    arguments a = {.common = CLI_COMMON_DEFAULTS, .engine = ENGINES, .wall = 120};
    const cli_option options[] = {
        {"engine", 0, CLI_CHOICE, engine_names, "which program (default all: those that are installed)", &a.engine, 0,
         0},
        {"time-limit", 0, CLI_TIME, "T", "longest a program may run (default 120 s)", &a.wall, CLI_POSITIVE, 1e6},
        {"keep-files", 0, CLI_TEXT, "DIR", "keep what each program reads and writes in DIR/NAME", &a.kept, 0, 0},
        {"json", 0, CLI_FLAG, NULL, "one JSON object on standard output instead of the table", &a.common.json, 0, 0},
        {"quiet", 'q', CLI_FLAG, NULL, "only errors", &a.common.quiet, 0, 0},
        {"verbose", 'v', CLI_FLAG, NULL, "say more", &a.common.verbose, 0, 0},
    };
    const cli_tool tool = {
        "dem-clump verify", "CLUMP [options]", about, options, sizeof options / sizeof *options, epilogue};
    cli_texts inputs = {0};
    int status;
    if (cli_parse(&tool, argc, argv, &inputs, &status) == CLI_GO) {
        dem_clump *clump = NULL;
        dem_error error;
        if (inputs.count != 1)
            status = cli_wrong_usage(&tool, inputs.count ? "one clump at a time" : "no clump given");
        else if (dem_clump_read(inputs.items[0], &clump, &error) != DEM_OK)
            status = cli_error(&tool, &error);
        else
            status = verify(&tool, &a, inputs.items[0], clump);
        dem_clump_destroy(clump);
    }
    cli_texts_release(&inputs);
    return status;
}
