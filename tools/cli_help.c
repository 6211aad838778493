#include "cli.h"

#include <string.h>

enum { COLUMNS = 100, HELP_AT = 28 };

// breaks `text` at blanks so that lines starting at column `indent` end before COLUMNS; '\n' is kept
static void put_wrapped(dem_buffer *out, const char *text, size_t at, size_t indent)
{
    while (*text) {
        size_t word = strcspn(text, " \n");
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
        if (*text == '\n') {
            dem_buffer_text(out, "\n");
            at = 0;
            text++;
        } else
            text += *text == ' ';
    }
    dem_buffer_text(out, "\n");
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
    put_wrapped(out, option->help, HELP_AT, HELP_AT);
}

void cli_help(const cli_tool *tool, dem_buffer *text)
{
    dem_buffer_print(text, "Usage: %s %s\n\n", tool->name, tool->usage);
    put_wrapped(text, tool->about, 0, 0);
    bool headed = false;
    for (size_t i = 0; i < tool->option_count; i++) {
        const cli_option *option = &tool->options[i];
        if (!option->name || !headed)
            dem_buffer_print(text, "\n%s:\n", option->name ? "Options" : option->help);
        headed = true;
        if (option->name)
            put_option(text, option);
    }
    put_option(text, &(cli_option){"help", 'h', CLI_FLAG, NULL, "this help", NULL, 0, 0});
    put_option(text, &(cli_option){"version", 0, CLI_FLAG, NULL, "the version", NULL, 0, 0});
    if (tool->epilogue)
        dem_buffer_print(text, "\n%s\n", tool->epilogue);
}
