/// `--help=man`: the page of a tool in the language of man pages (troff, macros of man(7)).
#include "cli_table.h"

#include <ctype.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#ifndef DEM_TOOLS
#define DEM_TOOLS ""  // all tools, with blanks between
#endif

// text as it shall be read: nothing in it is a command, hyphens can be copied into a shell
static void put_text(dem_buffer *out, const char *text, size_t length)
{
    bool line_start = out->size == 0 || out->data[out->size - 1] == '\n';
    for (const char *c = text, *end = text + length; c < end; c++) {
        if (line_start && (*c == '.' || *c == '\''))
            dem_buffer_text(out, "\\&");
        line_start = *c == '\n';
        const char *escaped = *c == '\\'   ? "\\e"
                              : *c == '-'  ? "\\-"
                              : *c == '\'' ? "\\(aq"
                              : *c == '`'  ? "\\(ga"
                              : *c == '^'  ? "\\(ha"
                              : *c == '~'  ? "\\(ti"
                                           : NULL;
        if (escaped)
            dem_buffer_text(out, escaped);
        else
            dem_buffer_bytes(out, c, 1);
    }
}

static void put_all(dem_buffer *out, const char *text)
{
    put_text(out, text, strlen(text));
}

// words in capitals stand for something else, the others are typed as they are
static void put_syntax(dem_buffer *out, const char *syntax, char typed)
{
    while (*syntax) {
        size_t word = strspn(syntax, "ABCDEFGHIJKLMNOPQRSTUVWXYZ");
        bool variable = word > 0;
        if (!variable)
            word = strspn(syntax, "abcdefghijklmnopqrstuvwxyz0123456789-_.");
        if (word) {
            dem_buffer_print(out, "\\f%c", variable ? 'I' : typed);
            put_text(out, syntax, word);
            dem_buffer_text(out, "\\fR");
            syntax += word;
        } else
            put_text(out, syntax++, 1);
    }
}

static void put_option(dem_buffer *out, const cli_option *option)
{
    dem_buffer_text(out, ".TP\n");
    if (option->letter)
        dem_buffer_print(out, "\\fB\\-%c\\fR, ", option->letter);
    dem_buffer_text(out, "\\fB\\-\\-");
    put_all(out, option->name);
    dem_buffer_text(out, "\\fR");
    if (option->argument) {
        dem_buffer_text(out, " ");
        put_syntax(out, option->argument, option->kind == CLI_CHOICE ? 'B' : 'R');
    }
    dem_buffer_text(out, "\n");
    put_all(out, option->help);
    char range[160];
    cli_range_text(option, range, sizeof range);
    if (*range) {
        dem_buffer_text(out, ";");
        put_all(out, range);
    }
    dem_buffer_text(out, "\n");
}

static void put_options(dem_buffer *out, const cli_tool *tool)
{
    dem_buffer_text(out, ".SH OPTIONS\n");
    for (size_t i = 0; i < tool->option_count; i++) {
        const cli_option *option = &tool->options[i];
        if (option->name) {
            put_option(out, option);
            continue;
        }
        dem_buffer_text(out, ".SS ");
        put_all(out, option->help);
        dem_buffer_text(out, "\n");
    }
    size_t count = 0;
    while (cli_option_at(tool, count))
        count++;
    put_option(out, cli_option_at(tool, count - 2));
    put_option(out, cli_option_at(tool, count - 1));
}

// the first clause of the description, begun small
static void put_summary(dem_buffer *out, const char *about)
{
    size_t length = 0;
    while (about[length] && !strchr(".:;,(", about[length]))
        length++;
    while (length && about[length - 1] == ' ')
        length--;
    char first[2] = {(char)tolower((unsigned char)about[0])};
    if (length) {
        put_text(out, first, 1);
        put_text(out, about + 1, length - 1);
    }
    dem_buffer_text(out, "\n");
}

// "0 done, 1 failed, 2 wrong usage."
static void put_exit_status(dem_buffer *out, const char *list, size_t length)
{
    dem_buffer_text(out, ".SH EXIT STATUS\n");
    for (const char *end = list + length; list < end;) {
        list += strspn(list, " ");
        size_t item = strcspn(list, ","), number = strspn(list, "0123456789");
        if (item > (size_t)(end - list))
            item = (size_t)(end - list);
        size_t text = item;
        while (text > number && list[text - 1] == '.')
            text--;
        dem_buffer_text(out, ".TP\n\\fB");
        put_text(out, list, number);
        dem_buffer_text(out, "\\fR\n");
        put_text(out, list + number + (list[number] == ' '), text - number - (list[number] == ' '));
        dem_buffer_text(out, "\n");
        list += item + (list + item < end);
    }
}

static bool begins(const cli_line *line, const char *with)
{
    size_t length = strlen(with);
    return line->indent == 0 && line->left_length >= length && strncmp(line->left, with, length) == 0;
}

// a line with nothing but "Examples:"
static bool is_heading(const cli_line *line)
{
    return line->indent == 0 && line->left_length > 1 && line->left[line->left_length - 1] == ':' &&
           !line->right_length;
}

static void put_heading(dem_buffer *out, const cli_line *line)
{
    dem_buffer_text(out, ".SH ");
    for (size_t i = 0; i + 1 < line->left_length; i++) {
        char letter = (char)toupper((unsigned char)line->left[i]);
        put_text(out, &letter, 1);
    }
    dem_buffer_text(out, "\n");
}

static const char exit_status_line[] = "Exit status: ";

static void put_exit_status_of(dem_buffer *out, const char *epilogue)
{
    static const char usual[] = "0 done, 1 failed, 2 wrong usage, 3 bad input, 4 cannot write, 130 interrupted";
    cli_line line;
    for (const char *at = epilogue; at;) {
        at = cli_next_line(at, &line);
        if (begins(&line, exit_status_line)) {
            const char *list = line.left + strlen(exit_status_line);
            put_exit_status(out, list, strcspn(list, "\n"));
            return;
        }
    }
    put_exit_status(out, usual, strlen(usual));
}

// a command with what it does
static void put_example(dem_buffer *out, const cli_line *line)
{
    dem_buffer_text(out, ".TP\n\\fB");
    put_text(out, line->left, line->left_length);
    dem_buffer_text(out, "\\fR\n");
    if (line->right_length)
        put_text(out, line->right, line->right_length);
    else
        dem_buffer_text(out, "\\&");
    dem_buffer_text(out, "\n");
}

// the epilogue: headings with indented lines under them, and paragraphs
static void put_epilogue(dem_buffer *out, const char *epilogue)
{
    bool headed = false;
    cli_line line;
    for (const char *at = epilogue; at;) {
        at = cli_next_line(at, &line);
        if (line.left_length == 0 || begins(&line, exit_status_line))
            continue;
        if (is_heading(&line))
            put_heading(out, &line);
        else if (line.indent)
            put_example(out, &line);
        else {
            dem_buffer_text(out, headed ? ".PP\n" : ".SH NOTES\n");
            put_text(out, line.left, line.left_length);
            dem_buffer_text(out, "\n");
        }
        headed = true;
    }
}

// a subcommand's tool, and the other tools
static void put_see_also(dem_buffer *out, const cli_tool *tool)
{
    size_t own = strcspn(tool->name, " "), shown = 0;
    for (const char *at = DEM_TOOLS; *at;) {
        size_t length = strcspn(at, " ");
        bool same = length == own && strncmp(at, tool->name, own) == 0;
        if (!same || tool->name[own]) {
            dem_buffer_text(out, shown++ ? ",\n\\fB" : ".SH SEE ALSO\n\\fB");
            put_text(out, at, length);
            dem_buffer_text(out, "\\fR(1)");
        }
        at += length + (at[length] == ' ');
    }
    if (shown)
        dem_buffer_text(out, "\n");
}

// of the making, or what a packager sets instead
static void put_date(dem_buffer *out)
{
    const char *given = getenv("SOURCE_DATE_EPOCH");
    time_t now = given ? (time_t)strtoll(given, NULL, 10) : time(NULL);
    struct tm day;
    char text[32] = "";
    if (gmtime_r(&now, &day))
        strftime(text, sizeof text, "%Y-%m-%d", &day);
    dem_buffer_text(out, text);
}

void cli_man(const cli_tool *tool, dem_buffer *text)
{
    char page[64];
    cli_name_as(tool, '-', '-', page, sizeof page);
    dem_buffer_text(text, ".TH \"");
    for (const char *c = page; *c; c++) {
        char letter = (char)toupper((unsigned char)*c);
        put_text(text, &letter, 1);
    }
    dem_buffer_text(text, "\" 1 ");
    put_date(text);
    dem_buffer_print(text, " \"dem-clump %s\"\n.SH NAME\n", dem_version());
    put_all(text, page);
    dem_buffer_text(text, " \\- ");
    put_summary(text, tool->about);
    dem_buffer_text(text, ".SH SYNOPSIS\n\\fB");
    put_all(text, tool->name);
    dem_buffer_text(text, "\\fR ");
    put_syntax(text, tool->usage, 'R');
    dem_buffer_text(text, "\n.SH DESCRIPTION\n");
    put_all(text, tool->about);
    dem_buffer_text(text, "\n");
    put_options(text, tool);
    put_exit_status_of(text, tool->epilogue);
    if (tool->epilogue)
        put_epilogue(text, tool->epilogue);
    put_see_also(text, tool);
}
