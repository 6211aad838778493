#include "cli_table.h"

#include <string.h>

enum { COLUMNS = 80, HELP_AT = 28 };

// breaks `text` at blanks so that lines starting at column `indent` end before COLUMNS; '\n' is kept
static void put_wrapped(dem_buffer *out, const char *text, size_t length, size_t at, size_t indent)
{
    const char *end = text + length;
    while (text < end) {
        size_t word = strcspn(text, " \n");
        if (word > (size_t)(end - text))
            word = (size_t)(end - text);
        if (at > indent && at + 1 + word > COLUMNS) {
            dem_buffer_text(out, "\n");
            at = 0;
        } else if (at > indent) {
            dem_buffer_text(out, " ");
            at++;
        }
        for (; at < indent; at++)
            dem_buffer_text(out, " ");
        dem_buffer_bytes(out, text, word);
        at += word;
        text += word;
        if (text < end && *text == '\n') {
            dem_buffer_text(out, "\n");
            at = 0;
        }
        text++;
    }
    dem_buffer_text(out, "\n");
}

// examples: where one does not fit, what it does goes on below
static void put_line(dem_buffer *out, const cli_line *line)
{
    size_t at = line->indent;
    dem_buffer_print(out, "%*s", (int)line->indent, "");
    if (!line->right_length) {
        put_wrapped(out, line->left, line->left_length, at, at);
        return;
    }
    dem_buffer_bytes(out, line->left, line->left_length);
    at += line->left_length;
    for (; at < line->right_at; at++)
        dem_buffer_text(out, " ");
    put_wrapped(out, line->right, line->right_length, at, at);
}

static void put_option(dem_buffer *out, const cli_option *option)
{
    size_t begin = out->size;
    if (option->letter)
        dem_buffer_print(out, "  -%c, --%s", option->letter, option->name);
    else
        dem_buffer_print(out, "      --%s", option->name);
    if (option->argument)
        dem_buffer_print(out, " %s", option->argument);
    size_t at = out->size - begin;
    if (at + 2 > HELP_AT) {
        dem_buffer_text(out, "\n");
        at = 0;
    }
    for (; at < HELP_AT; at++)
        dem_buffer_text(out, " ");
    put_wrapped(out, option->help, strlen(option->help), HELP_AT, HELP_AT);
}

void cli_help(const cli_tool *tool, dem_buffer *text)
{
    dem_buffer_print(text, "Usage: %s %s\n\n", tool->name, tool->usage);
    put_wrapped(text, tool->about, strlen(tool->about), 0, 0);
    bool headed = false;
    for (size_t i = 0; i < tool->option_count; i++) {
        const cli_option *option = &tool->options[i];
        if (!option->name || !headed)
            dem_buffer_print(text, "\n%s:\n", option->name ? "Options" : option->help);
        headed = true;
        if (option->name)
            put_option(text, option);
    }
    size_t own = 0;
    while (cli_option_at(tool, own))
        own++;
    put_option(text, cli_option_at(tool, own - 2));
    put_option(text, cli_option_at(tool, own - 1));
    if (!tool->epilogue)
        return;
    dem_buffer_text(text, "\n");
    cli_line line;
    for (const char *at = tool->epilogue; at;) {
        at = cli_next_line(at, &line);
        put_line(text, &line);
    }
}
