#include "cli_table.h"

#include <ctype.h>
#include <string.h>

const char *cli_next_line(const char *text, cli_line *line)
{
    size_t length = strcspn(text, "\n");
    size_t indent = strspn(text, " ");
    *line = (cli_line){.indent = indent < length ? indent : length};
    line->left = line->right = text + line->indent;
    size_t end = length - line->indent;
    line->left_length = end;
    for (size_t at = 0; at + 2 < end; at++)
        if (line->left[at] == ' ' && line->left[at + 1] == ' ') {
            size_t gap = strspn(line->left + at, " ");
            line->left_length = at;
            line->right = line->left + at + gap;
            line->right_length = end - at - gap;
            line->right_at = line->indent + at + gap;
            break;
        }
    return text[length] ? text + length + 1 : NULL;
}

static bool holds(const char *text, const char *const words[])
{
    for (; *words; words++)
        if (strstr(text, *words))
            return true;
    return false;
}

// PATH=VALUE and NAME are neither
static cli_values values_named(const char *argument)
{
    static const char *const folders[] = {"DIR", "FOLDER", NULL};
    static const char *const files[] = {"FILE",  "INPUT",  "CHECKPOINT", "MESH",     "SCENE", "CLUMP",
                                        "TABLE", "SCRIPT",     "TEMPLATE", "PATH",  NULL};
    if (strchr(argument, '='))
        return CLI_VALUES_ANY;
    if (holds(argument, files))
        return CLI_VALUES_FILES;
    return holds(argument, folders) ? CLI_VALUES_FOLDERS : CLI_VALUES_ANY;
}

cli_values cli_values_of(const cli_option *option)
{
    if (option->kind == CLI_CHOICE)
        return CLI_VALUES_CHOICE;
    if (option->kind == CLI_TEXT || option->kind == CLI_TEXTS)
        return values_named(option->argument);
    return CLI_VALUES_ANY;
}

bool cli_value_optional(const cli_option *option)
{
    return option->argument && option->argument[0] == '[';
}

cli_values cli_operands(const cli_tool *tool, char *name, size_t size)
{
    const char *usage = tool->usage;
    size_t length = 0;
    while (isupper((unsigned char)usage[length]))
        length++;
    snprintf(name, size, "%.*s", (int)length, usage);
    return values_named(name);
}

const cli_option *cli_option_at(const cli_tool *tool, size_t index)
{
    static const cli_option own[] = {{"help", 'h', CLI_FLAG, NULL, "this help", NULL, 0, 0},
                                     {"version", 0, CLI_FLAG, NULL, "the version", NULL, 0, 0}};
    for (size_t i = 0; i < tool->option_count; i++) {
        const cli_option *option = &tool->options[i];
        bool first = option->name;
        for (size_t k = 0; k < i && first; k++)
            first = !tool->options[k].name || strcmp(tool->options[k].name, option->name) != 0;
        if (first && index-- == 0)
            return option;
    }
    return index < sizeof own / sizeof *own ? &own[index] : NULL;
}

void cli_range_text(const cli_option *option, char *text, size_t size)
{
    static const char *const units[] = {
        [CLI_PERCENT] = " %", [CLI_LENGTH] = " m", [CLI_DENSITY] = " kg/m3", [CLI_TIME] = " s"};
    const char *unit = option->kind < sizeof units / sizeof *units && units[option->kind] ? units[option->kind] : "";
    char low[64], high[64];
    dem_format_double(low, sizeof low, option->low, 16);
    dem_format_double(high, sizeof high, option->high, 16);
    bool positive = option->low == CLI_POSITIVE;
    if (option->low == 0 && option->high == 0)
        *text = 0;
    else if (isinf(option->high) && positive)
        snprintf(text, size, " above 0%s", unit);
    else if (isinf(option->high))
        snprintf(text, size, " of at least %s%s", low, unit);
    else if (positive)
        snprintf(text, size, " above 0 and at most %s%s", high, unit);
    else
        snprintf(text, size, " from %s to %s%s", low, high, unit);
}

void cli_name_as(const cli_tool *tool, char blank, char hyphen, char *text, size_t size)
{
    snprintf(text, size, "%s", tool->name);
    for (char *c = text; *c; c++)
        *c = *c == ' ' ? blank : *c == '-' ? hyphen : *c;
}

bool cli_help_form(const cli_tool *tool, const char *form, dem_buffer *text)
{
    static const struct {
        const char *name;
        void (*put)(const cli_tool *, dem_buffer *);
    } forms[] = {{"man", cli_man}, {"bash", cli_complete_bash}, {"zsh", cli_complete_zsh}, {"fish", cli_complete_fish}};
    for (size_t i = 0; i < sizeof forms / sizeof *forms; i++)
        if (strcmp(form, forms[i].name) == 0) {
            forms[i].put(tool, text);
            return true;
        }
    return false;
}
