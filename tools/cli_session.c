#include "cli.h"

#include <math.h>
#include <signal.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/clock.h"
#include "base/file.h"
#include "base/memory.h"

enum { LINE_BYTES = 2048 };

static const double REDRAW = 0.1;      // [s] on a terminal
static const double FIRST_DRAW = 0.3;  // [s] short work shows nothing
static const double LINE_EVERY = 10;   // [s] elsewhere

static volatile sig_atomic_t stop_asked;

bool cli_colours(FILE *stream)
{
    const char *none = getenv("NO_COLOR"), *term = getenv("TERM");
    return !(none && *none) && term && strcmp(term, "dumb") != 0 && isatty(fileno(stream));
}

// one message is one line, whatever bytes a file name holds
static void print_line(const char *tool, const char *level, const char *colour, const char *text)
{
    char line[LINE_BYTES];
    snprintf(line, sizeof line, "%s", text);
    for (char *c = line; *c; c++)
        if ((unsigned char)*c < ' ' || *c == 127)
            *c = '?';
    bool coloured = colour && cli_colours(stderr);
    fprintf(stderr, "%s: %s%s%s%s%s\n", tool, coloured ? colour : "", level, coloured ? "\033[0m" : "",
            *level ? " " : "", line);
}

static const char RED[] = "\033[1;31m", YELLOW[] = "\033[1;33m";

int cli_wrong_usage(const cli_tool *tool, const char *format, ...)
{
    char text[LINE_BYTES];
    va_list args;
    va_start(args, format);
    vsnprintf(text, sizeof text, format, args);
    va_end(args);
    size_t length = strlen(text);
    if (length == 0 || text[length - 1] != '?')  // "did you mean ...?" says enough
        snprintf(text + length, sizeof text - length, "; see %s --help", tool->name);
    print_line(tool->name, "error:", RED, text);
    return DEM_USAGE;
}

static int exit_status(dem_status code)
{
    if (code == DEM_NO_MEMORY)
        return DEM_FAILED;
    if (code == DEM_UNAVAILABLE)
        return DEM_BAD_INPUT;
    return code;
}

int cli_error(const cli_tool *tool, const dem_error *error)
{
    char text[LINE_BYTES] = "";
    if (error->file[0] && error->line)
        snprintf(text, sizeof text, "%s:%ld: ", error->file, error->line);
    else if (error->file[0])
        snprintf(text, sizeof text, "%s: ", error->file);
    snprintf(text + strlen(text), sizeof text - strlen(text), "%s", error->text);
    print_line(tool->name, "error:", RED, text);
    return exit_status(error->code);
}

int cli_print(const cli_tool *tool, dem_buffer *text)
{
    dem_error error;
    return dem_file_write_buffer("-", text, &error) == DEM_OK ? DEM_OK : cli_error(tool, &error);
}

static void ask_to_stop(int signal_number)
{
    (void)signal_number;
    stop_asked = 1;
}

bool cli_interrupted(void)
{
    return stop_asked;
}

void cli_begin(cli_session *session, const cli_tool *tool, const cli_common *common)
{
    *session = (cli_session){.tool = tool, .common = common, .terminal = isatty(STDERR_FILENO)};
    session->phase_begin = session->last_shown = dem_clock();
    pthread_mutex_init(&session->lock, NULL);
    struct sigaction action = {.sa_handler = ask_to_stop, .sa_flags = (int)SA_RESETHAND};
    sigemptyset(&action.sa_mask);
    sigaction(SIGINT, &action, NULL);
    sigaction(SIGTERM, &action, NULL);
}

static void clear_line(cli_session *session)
{
    if (session->line_shown)
        fputs("\r\033[K", stderr);
    session->line_shown = false;
}

void cli_end(cli_session *session)
{
    clear_line(session);
    for (size_t i = 0; i < session->warnings.count; i++)
        free((char *)session->warnings.items[i]);
    cli_texts_release(&session->warnings);
    pthread_mutex_destroy(&session->lock);
}

static void keep_warning(cli_session *session, const char *text)
{
    cli_texts *kept = &session->warnings;
    char *copy = strdup(text);
    if (copy && dem_grow(&kept->items, &kept->capacity, kept->count, sizeof *kept->items))
        kept->items[kept->count++] = copy;
    else
        free(copy);
}

static void log_line(void *user, dem_log_level level, const char *subject, const char *text)
{
    cli_session *session = user;
    char line[LINE_BYTES];
    snprintf(line, sizeof line, "%s%s%s", subject ? subject : "", subject ? ": " : "", text);
    pthread_mutex_lock(&session->lock);
    bool warning = level == DEM_LOG_WARNING;
    if (warning)
        keep_warning(session, line);
    if (!session->common->quiet && (warning || session->common->verbose)) {
        clear_line(session);
        print_line(session->tool->name, warning ? "warning:" : "", YELLOW, line);
    }
    pthread_mutex_unlock(&session->lock);
}

static void draw(cli_session *session, const char *what, double fraction)
{
    double time = dem_clock(), spent = time - session->phase_begin;
    bool early = time - session->last_shown < (session->terminal ? REDRAW : LINE_EVERY);
    if (session->common->quiet || early || (session->terminal && spent < FIRST_DRAW))
        return;
    session->last_shown = time;
    char left[48] = "";
    if (fraction > 0.02)
        snprintf(left, sizeof left, ", %.0f s left", spent * (1 - fraction) / fraction);
    fprintf(stderr, "%s%s: %.60s %.0f %%, %.0f s%s%s", session->terminal ? "\r\033[K" : "", session->tool->name, what,
            100 * fraction, spent, left, session->terminal ? "" : "\n");
    fflush(stderr);
    session->line_shown = session->terminal;
}

static bool on_progress(void *user, const char *what, double fraction)
{
    cli_session *session = user;
    if (session->jobs > 1 || pthread_mutex_trylock(&session->lock) != 0)
        return stop_asked;
    // a new phase, or the old one over again: the clock of "time left" starts again. A phase is named by what stands
    // before the first comma
    size_t name = strcspn(what, ",");
    name = name < sizeof session->phase - 1 ? name : sizeof session->phase - 1;
    if (fraction < session->last_fraction || strncmp(session->phase, what, name) != 0)
        session->phase_begin = dem_clock();
    snprintf(session->phase, sizeof session->phase, "%s", what);
    session->last_fraction = fraction;
    draw(session, what, fmin(fmax(fraction, 0), 1));
    pthread_mutex_unlock(&session->lock);
    return stop_asked;
}

void cli_job_done(cli_session *session)
{
    pthread_mutex_lock(&session->lock);
    session->jobs_done++;
    if (session->jobs > 1) {
        char what[64];
        snprintf(what, sizeof what, "%zu of %zu grains,", session->jobs_done, session->jobs);
        draw(session, what, (double)session->jobs_done / (double)session->jobs);
    }
    pthread_mutex_unlock(&session->lock);
}

dem_ctx cli_ctx(cli_session *session, const char *subject)
{
    return (dem_ctx){.log = log_line,
                     .progress = on_progress,
                     .user = session,
                     .subject = subject,
                     .threads = (int)session->common->threads};
}

int cli_session_error(cli_session *session, const dem_error *error)
{
    pthread_mutex_lock(&session->lock);
    clear_line(session);
    int status = cli_error(session->tool, error);
    pthread_mutex_unlock(&session->lock);
    return status;
}

void cli_session_say(cli_session *session, const char *text)
{
    pthread_mutex_lock(&session->lock);
    clear_line(session);
    print_line(session->tool->name, "", NULL, text);
    pthread_mutex_unlock(&session->lock);
}

void cli_put_warnings(cli_session *session, dem_json_writer *json)
{
    dem_json_open_array(json, "warnings", false);
    for (size_t i = 0; i < session->warnings.count; i++)
        dem_json_put_string(json, NULL, session->warnings.items[i]);
    dem_json_close(json, ']');
}
