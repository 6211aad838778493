#define _GNU_SOURCE
#include "clump_engine.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/clock.h"
#include "base/file.h"
#include "mesh/guard.h"
#include "out/export_text.h"

enum {
    LAST_WORDS = 600,  // bytes of a failed program's output to show
    MOST_ARGUMENTS = 8,
    MOST_VARIABLES = 512,
};

static const double MEMORY = 4e9;        // beyond what we have [byte]
static const double LARGEST_FILE = 1e9;  // [byte]
static const double MOST_OUTPUT = 1e8;   // printed [byte]

bool engine_find(const engine *e, char path[256])
{
    const char *folders = getenv("PATH");
    for (const char *at = folders; at && *at;) {
        size_t length = strcspn(at, ":");
        for (const char *const *program = e->programs; *program; program++)
            if (*at == '/' && snprintf(path, 256, "%.*s/%s", (int)length, at, *program) < 256 &&
                access(path, X_OK) == 0)
                return true;
        at += length + (at[length] == ':');
    }
    return false;
}

double engine_reach(const engine_question *question)
{
    return dem_export_reach(&question->def);
}

static char *path_of(const engine_question *question, const char *file)
{
    return dem_path_join(question->folder, "%s", file);
}

dem_status engine_export(const engine_question *question, const char *format, const char *file, dem_error *error)
{
    char *path = path_of(question, file);
    if (!path)
        return dem_fail_memory(error);
    dem_export_options options = {.threads = 1};
    dem_status status = dem_export(dem_exporter_find(format), question->clump, &options, path, error);
    free(path);
    return status;
}

dem_status engine_write(const engine_question *question, const char *file, dem_buffer *deck, dem_error *error)
{
    char *path = path_of(question, file);
    if (!path) {
        dem_buffer_release(deck);
        return dem_fail_memory(error);
    }
    dem_status status = dem_file_write_buffer(path, deck, error);
    free(path);
    return status;
}

// ---- running

typedef struct command {
    const char *folder;
    char *arguments[MOST_ARGUMENTS];
    char *variables[MOST_VARIABLES];
} command;

// in the child: only calls that need no lock
static void become(void *user, int out)
{
    const command *c = user;
    static const char sorry[] = "cannot be started\n";
    if (chdir(c->folder) == 0 && dup2(out, STDOUT_FILENO) >= 0 && dup2(out, STDERR_FILENO) >= 0)
        execve(c->arguments[0], c->arguments, c->variables);
    if (write(out, sorry, sizeof sorry - 1) > 0)
        _exit(127);
    _exit(126);
}

// the program's environment: ours, but on one thread and with its temporary files in the folder
static void set_variables(command *c, char *temporary)
{
    static char one_thread[] = "OMP_NUM_THREADS=1";
    static const char *const replaced[] = {"TMPDIR=", "OMP_NUM_THREADS=", "DISPLAY=", NULL};
    size_t count = 0;
    c->variables[count++] = temporary;
    c->variables[count++] = one_thread;
    for (char **v = environ; *v && count < MOST_VARIABLES - 1; v++) {
        bool kept = true;
        for (int i = 0; replaced[i]; i++)
            kept = kept && strncmp(*v, replaced[i], strlen(replaced[i])) != 0;
        if (kept)
            c->variables[count++] = *v;
    }
    c->variables[count] = NULL;
}

// the end of what it printed, as one line
static const char *last_words(const dem_buffer *printed, char text[LAST_WORDS + 1])
{
    size_t size = printed->size < LAST_WORDS ? printed->size : LAST_WORDS, length = 0;
    if (size == 0)
        return "none";
    for (const char *p = printed->data + printed->size - size; size--; p++) {
        bool blank = (unsigned char)*p <= ' ';
        if (!blank)
            text[length++] = *p;
        else if (length && text[length - 1] != ' ')
            text[length++] = ' ';
    }
    text[length] = 0;
    return length ? text : "none";
}

// the word behind the banner
static void set_version(const engine *e, const dem_buffer *printed, engine_answer *answer)
{
    const char *at = printed->size ? strstr(printed->data, e->banner) : NULL;
    if (!at)
        return;
    at += strlen(e->banner);
    snprintf(answer->version, sizeof answer->version, "%.*s", (int)strcspn(at, ",)\n"), at);
    for (size_t n = strlen(answer->version); n && answer->version[n - 1] == ' '; n--)
        answer->version[n - 1] = 0;
}

static dem_status follow(dem_guard *guard, const engine *e, engine_answer *answer, dem_buffer *printed,
                         dem_error *error)
{
    char bytes[4096], words[LAST_WORDS + 1];
    size_t got;
    guard->doing = e->name;
    while ((double)printed->size < MOST_OUTPUT && (got = dem_guard_read_some(guard, bytes, sizeof bytes)) > 0)
        dem_buffer_bytes(printed, bytes, got);
    const char *end = dem_guard_end(guard);
    set_version(e, printed, answer);
    if (printed->failed)
        return dem_fail_memory(error);
    if (guard->interrupted)
        return dem_fail(error, DEM_INTERRUPTED, "interrupted");
    if (guard->status == 0)
        return DEM_OK;
    last_words(printed, words);
    if (guard->status > 0)
        return dem_fail(error, DEM_FAILED, "%s left with status %d; its last words: %s", answer->program, guard->status,
                        words);
    return dem_fail(error, DEM_FAILED, "%s %s; its last words: %s", answer->program, end, words);
}

dem_status engine_run(const engine_question *question, const engine *e, engine_answer *answer,
                      const char *const *arguments, dem_buffer *printed, dem_error *error)
{
    command c = {.folder = question->folder, .arguments = {answer->program}};
    for (size_t i = 0; arguments[i] && i + 2 < MOST_ARGUMENTS; i++)
        c.arguments[i + 1] = (char *)arguments[i];
    char *temporary;
    if (asprintf(&temporary, "TMPDIR=%s", question->folder) < 0)
        return dem_fail_memory(error);
    set_variables(&c, temporary);
    double begin = dem_clock();
    dem_guard guard;
    dem_guard_limits limits = {.memory = MEMORY, .cpu = question->wall, .wall = question->wall, .file = LARGEST_FILE};
    dem_status status = dem_guard_start(&guard, question->ctx, limits, become, &c, error);
    if (status == DEM_OK)
        status = follow(&guard, e, answer, printed, error);
    answer->seconds += dem_clock() - begin;
    free(temporary);
    return status;
}

// ---- reading what came

static const char *read_numbers(const char *at, const char *end, double *numbers, int count)
{
    for (int i = 0; at && i < count; i++) {
        while (at < end && (*at == ' ' || *at == '\t'))
            at++;
        at = dem_parse_double(at, end, &numbers[i]);
    }
    return at;
}

static const char *line_end(const char *at, const char *end)
{
    const char *newline = memchr(at, '\n', (size_t)(end - at));
    return newline ? newline : end;
}

// the last line of four numbers between the marks
static bool find_energies(const dem_buffer *printed, int motion, engine_motion *m)
{
    char mark[64];
    snprintf(mark, sizeof mark, "\n" ENGINE_MARK " %d\n", motion);
    const char *at = printed->size ? strstr(printed->data, mark) : NULL;
    if (!at)
        return false;
    at += strlen(mark);
    const char *stop = strstr(at, "\n" ENGINE_END), *end = stop ? stop : printed->data + printed->size;
    bool found = false;
    for (; at < end; at = line_end(at, end) + 1) {
        double row[4];
        const char *behind = read_numbers(at, line_end(at, end), row, 4);
        if (!behind || behind[strspn(behind, " \r")] != '\n')
            continue;
        m->translating = row[2];
        m->turning = row[3];
        found = true;
    }
    return found && isfinite(m->translating) && isfinite(m->turning);
}

// the rows of the last table, or NULL
static const char *last_table(const dem_buffer *text, const char *what)
{
    const char *at = strstr(text->data, what), *next;
    while (at && (next = strstr(at + 1, what)))
        at = next;
    const char *end = text->data + text->size;
    return at && line_end(at, end) < end ? line_end(at, end) + 1 : NULL;
}

static dem_status read_dump(const engine_question *question, const char *file, dem_buffer *text, dem_error *error)
{
    char *path = path_of(question, file);
    if (!path)
        return dem_fail_memory(error);
    dem_status status = dem_file_read(path, text, error);
    free(path);
    if (status == DEM_BAD_INPUT)  // it is the program's fault, not that of our input
        status = error->code = DEM_FAILED;
    return status;
}

dem_status engine_read_spheres(const engine_question *question, const char *file, engine_motion *motion,
                               dem_error *error)
{
    dem_buffer text;
    size_t count = question->def.ball_count, seen = 0;
    DEM_TRY(read_dump(question, file, &text, error));
    const char *end = text.data + text.size, *at = last_table(&text, "ITEM: ATOMS");
    for (; at && at < end; at = line_end(at, end) + 1) {
        double row[7];
        if (!read_numbers(at, line_end(at, end), row, 7) || !(row[0] >= 1 && row[0] <= (double)count))
            break;
        size_t i = (size_t)row[0] - 1;
        motion->at[i] = (dem_vec3){row[1], row[2], row[3]};
        motion->velocity[i] = (dem_vec3){row[4], row[5], row[6]};
        seen++;
    }
    dem_buffer_release(&text);
    return seen == count ? DEM_OK : dem_fail(error, DEM_FAILED, "wrote %zu spheres to %s, not %zu", seen, file, count);
}

dem_status engine_read_row(const engine_question *question, const char *file, double *numbers, int count,
                           dem_error *error)
{
    dem_buffer text;
    DEM_TRY(read_dump(question, file, &text, error));
    const char *end = text.data + text.size, *at = last_table(&text, "ITEM: ENTRIES");
    bool read = at && read_numbers(at, line_end(at, end), numbers, count);
    dem_buffer_release(&text);
    return read ? DEM_OK : dem_fail(error, DEM_FAILED, "wrote no row of %d numbers to %s", count, file);
}

dem_status engine_read(const engine_question *question, const dem_buffer *printed, engine_answer *answer,
                       dem_error *error)
{
    for (int motion = 0; motion < ENGINE_MOTIONS; motion++) {
        engine_motion *m = &answer->motions[motion];
        if (isnan(m->rate))
            continue;
        char file[32], words[LAST_WORDS + 1];
        snprintf(file, sizeof file, "motion%d.dump", motion);
        if (!find_energies(printed, motion, m))
            return dem_fail(error, DEM_FAILED, "%s told no energy of motion %d; its last words: %s", answer->program,
                            motion, last_words(printed, words));
        DEM_TRY(engine_read_spheres(question, file, m, error));
    }
    return DEM_OK;
}

dem_status engine_move(const engine_question *question, const engine *e, engine_answer *answer,
                       const char *const *arguments, dem_error *error)
{
    dem_buffer printed = {0};
    dem_status status = engine_run(question, e, answer, arguments, &printed, error);
    for (int motion = 0; motion < ENGINE_MOTIONS; motion++)
        answer->motions[motion].rate = motion == 0 ? engine_reach(question) : 1;
    if (status == DEM_OK)
        status = engine_read(question, &printed, answer, error);
    dem_buffer_release(&printed);
    return status;
}
