/// The command line of every tool: options from one table, help, messages, progress, exit status.
#ifndef DEM_TOOLS_CLI_H
#define DEM_TOOLS_CLI_H

#include <float.h>
#include <math.h>
#include <pthread.h>
#include <stdio.h>

#include "base/json.h"
#include "base/status.h"

typedef enum cli_kind {
    CLI_FLAG,     ///< bool
    CLI_TEXT,     ///< const char *
    CLI_WHOLE,    ///< long
    CLI_NUMBER,   ///< double
    CLI_PERCENT,  ///< double, as a fraction: "3" and "3 %" give 0.03; the range is in percent
    CLI_LENGTH,   ///< double [m], "2 mm"
    CLI_DENSITY,  ///< double [kg/m^3], "2.65 g/cm3"
    CLI_TIME,     ///< double [s], "0.5 s"
    CLI_CHOICE,   ///< int, index into the names of `argument`
    CLI_TEXTS,    ///< cli_texts, one item each time the option is given
    CLI_WORDS,    ///< const char *, words of letters, digits, '_' and ':' with commas between; "" without them
} cli_kind;

/// One row of a tool's table: an option, or with name NULL a heading (`help`) over the rows that follow.
/// An option may stand under several headings; each row of that name then gets the value.
typedef struct cli_option {
    const char *name;      ///< "effort" for --effort
    char letter;           ///< 'n' for -n; 0: none
    cli_kind kind;
    const char *argument;  ///< "N", "FILE"; for CLI_CHOICE "fast|default|best"; NULL for flags
    const char *help;      ///< one line, with the default
    void *value;           ///< keeps what it holds when the option is not given
    double low, high;      ///< allowed range, both 0: any. low CLI_POSITIVE: above 0; high INFINITY: no bound
} cli_option;

#define CLI_POSITIVE DBL_MIN

/// Texts in the order they were given; they point into argv.
typedef struct cli_texts {
    const char **items;
    size_t count, capacity;
} cli_texts;
void cli_texts_release(cli_texts *texts);

typedef struct cli_tool {
    const char *name;
    const char *usage;     ///< what follows the name in the first line of the help
    const char *about;     ///< paragraph under it
    const cli_option *options;
    size_t option_count;
    const char *epilogue;  ///< paragraph at the end, for instance examples; NULL: none
} cli_tool;

typedef struct cli_common {
    bool quiet, verbose, json;
    long threads;  ///< 0: all cores
    long seed;
} cli_common;

#define CLI_COMMON_DEFAULTS {.seed = 1}
/// Rows of the options every tool has; `common` is the name of its cli_common.
#define CLI_COMMON_OPTIONS(common)                                                                           \
    {.help = "Common"},                                                                                      \
    {"threads", 'j', CLI_WHOLE, "N", "threads (default: all cores); the result does not depend on it",       \
     &(common).threads, 1, 4096},                                                                            \
    {"seed", 0, CLI_WHOLE, "N", "seed of the random numbers (default 1)", &(common).seed, 0, 0x1p53},        \
    {"json", 0, CLI_FLAG, NULL, "one JSON object on standard output instead of the summary",                 \
     &(common).json, 0, 0},                                                                                  \
    {"quiet", 'q', CLI_FLAG, NULL, "only errors", &(common).quiet, 0, 0},                                    \
    {"verbose", 'v', CLI_FLAG, NULL, "say more", &(common).verbose, 0, 0}

typedef enum cli_next { CLI_GO, CLI_STOP } cli_next;

/// Reads argv into the values of the table; operands ("-" and all behind "--" too) in order. Answers --help
/// (also as --help=man, bash, zsh, fish; see cli_table.h) and --version. CLI_STOP: leave main with *exit_status; 2 and one line on stderr for wrong usage.
cli_next cli_parse(const cli_tool *tool, int argc, char **argv, cli_texts *operands, int *exit_status);

/// Prints `tool: error: text; see tool --help` (a text that ends in '?' stands alone); returns 2.
int cli_wrong_usage(const cli_tool *tool, const char *format, ...) DEM_PRINTF(2, 3);

/// Prints `tool: error: FILE:LINE: text`; returns the exit status for the code.
int cli_error(const cli_tool *tool, const dem_error *error);

/// Writes a buffer to standard output and releases it; returns the exit status, having said why it failed.
int cli_print(const cli_tool *tool, dem_buffer *text);

/// The help as text (cli_parse prints it).
void cli_help(const cli_tool *tool, dem_buffer *text);

/// Messages and progress of one run of a tool; safe to use from several threads. Not to be copied or moved.
typedef struct cli_session {
    const cli_tool *tool;
    const cli_common *common;
    size_t jobs, jobs_done;  ///< jobs > 1: the progress is that of the batch, whatever each job reports
    bool terminal, line_shown;
    double phase_begin, last_shown;  ///< [s]
    double last_fraction;
    char phase[64];
    cli_texts warnings;  ///< "SUBJECT: text", owned
    pthread_mutex_t lock;
} cli_session;

/// Also makes SIGINT and SIGTERM ask long work to stop; a second one kills.
void cli_begin(cli_session *session, const cli_tool *tool, const cli_common *common);
void cli_end(cli_session *session);
/// For library calls about `subject` (a file name, or NULL), which is kept as a pointer.
dem_ctx cli_ctx(cli_session *session, const char *subject);
/// One job of a batch is through.
void cli_job_done(cli_session *session);
/// A signal asked to stop.
bool cli_interrupted(void);
/// As cli_error, but clears the progress line first and waits for other messages.
int cli_session_error(cli_session *session, const dem_error *error);
/// One line without a level, whether quiet or not.
void cli_session_say(cli_session *session, const char *text);
/// `"warnings": [...]`
void cli_put_warnings(cli_session *session, dem_json_writer *json);

/// True where `stream`'s terminal shall see colours: NO_COLOR unset, TERM not dumb.
bool cli_colours(FILE *stream);

#endif
