#include "cli.h"

#include <ctype.h>
#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "base/memory.h"
#include "base/nearest.h"
#include "base/units.h"
#include "cli_table.h"

enum { MESSAGE_BYTES = 2048, NAME_BYTES = 48 };

typedef struct parser {
    const cli_tool *tool;
    char **arguments;  // argv without the program's name
    int count, at;
    int status;  // of a failure already reported
} parser;

void cli_texts_release(cli_texts *texts)
{
    free(texts->items);
    *texts = (cli_texts){0};
}

static bool add_text(cli_texts *texts, const char *item)
{
    if (!dem_grow(&texts->items, &texts->capacity, texts->count, sizeof *texts->items))
        return false;
    texts->items[texts->count++] = item;
    return true;
}

static const char *option_name(const void *user, size_t index)
{
    const cli_option *option = cli_option_at(user, index);
    return option ? option->name : NULL;
}

static bool fail(parser *p, const char *format, ...) DEM_PRINTF(2, 3);
static bool fail(parser *p, const char *format, ...)
{
    char text[MESSAGE_BYTES];
    va_list args;
    va_start(args, format);
    vsnprintf(text, sizeof text, format, args);
    va_end(args);
    p->status = cli_wrong_usage(p->tool, "%s", text);
    return false;
}

// how the user names an option: --effort
static const char *shown(const cli_option *option, char text[static NAME_BYTES])
{
    snprintf(text, NAME_BYTES, "--%s", option->name);
    return text;
}

static bool in_range(const cli_option *option, double value)
{
    return (option->low == 0 && option->high == 0) || (value >= option->low && value <= option->high);
}

static bool refuse_value(parser *p, const cli_option *option, const char *what, const char *text)
{
    char name[NAME_BYTES], range[160];
    cli_range_text(option, range, sizeof range);
    return fail(p, "%s must be a %s%s, not '%s'", shown(option, name), what, range, text);
}

static bool take_whole(parser *p, const cli_option *option, const char *text)
{
    const char *end = text + strlen(text);
    long value;
    if (dem_parse_long(text, end, &value) != end || !in_range(option, (double)value))
        return refuse_value(p, option, "whole number", text);
    *(long *)option->value = value;
    return true;
}

static bool take_number(parser *p, const cli_option *option, const char *text)
{
    const char *end = text + strlen(text);
    bool percent = option->kind == CLI_PERCENT;
    double value = NAN;
    const char *rest = dem_parse_double(text, end, &value);
    if (rest && percent) {
        rest += strspn(rest, " ");
        rest += *rest == '%';
    }
    if (rest != end || !isfinite(value) || !in_range(option, value))
        return refuse_value(p, option, percent ? "percentage" : "number", text);
    *(double *)option->value = percent ? value / 100 : value;
    return true;
}

static bool take_quantity(parser *p, const cli_option *option, const char *text)
{
    static const struct {
        dem_dimension dimension;
        const char *name;
    } kinds[] = {[CLI_LENGTH] = {DEM_DIMENSION_LENGTH, "length"},
                 [CLI_DENSITY] = {DEM_DIMENSION_DENSITY, "density"},
                 [CLI_TIME] = {DEM_DIMENSION_TIME, "time"}};
    char name[NAME_BYTES];
    dem_error error;
    double value;
    if (dem_quantity(text, kinds[option->kind].dimension, &value, &error) != DEM_OK)
        return fail(p, "%s: %s", shown(option, name), error.text);
    if (!isfinite(value) || !in_range(option, value))
        return refuse_value(p, option, kinds[option->kind].name, text);
    *(double *)option->value = value;
    return true;
}

// the index-th of the names "a|b|c", in `user`'s own buffer
typedef struct choice_names {
    char text[512];
    const char *names[32];
    size_t count;
} choice_names;

static const char *choice_name(const void *user, size_t index)
{
    const choice_names *names = user;
    return index < names->count ? names->names[index] : NULL;
}

static void split_choices(choice_names *names, const char *joined)
{
    DEM_ASSERT(strlen(joined) < sizeof names->text);
    strcpy(names->text, joined);
    names->count = 0;
    for (char *at = names->text; at && names->count < 32;) {
        names->names[names->count++] = at;
        at = strchr(at, '|');
        if (at)
            *at++ = 0;
    }
}

static bool take_choice(parser *p, const cli_option *option, const char *text)
{
    choice_names names;
    split_choices(&names, option->argument);
    for (size_t i = 0; i < names.count; i++)
        if (strcmp(text, names.names[i]) == 0) {
            *(int *)option->value = (int)i;
            return true;
        }
    char name[NAME_BYTES], all[600] = "";
    for (size_t i = 0; i < names.count; i++) {
        const char *between = i == 0 ? "" : i + 1 < names.count ? ", " : " or ";
        snprintf(all + strlen(all), sizeof all - strlen(all), "%s%s", between, names.names[i]);
    }
    const char *near = dem_nearest(text, choice_name, &names);
    if (near)
        return fail(p, "%s must be %s, not '%s'; did you mean %s?", shown(option, name), all, text, near);
    return fail(p, "%s must be %s, not '%s'", shown(option, name), all, text);
}

static bool take(parser *p, const cli_option *option, const char *text)
{
    switch (option->kind) {
    case CLI_FLAG:
        *(bool *)option->value = true;
        return true;
    case CLI_TEXT:
    case CLI_WORDS:
        *(const char **)option->value = text;
        return true;
    case CLI_TEXTS:
        if (add_text(option->value, text))
            return true;
        p->status = DEM_FAILED;
        return false;
    case CLI_WHOLE:
        return take_whole(p, option, text);
    case CLI_NUMBER:
    case CLI_PERCENT:
        return take_number(p, option, text);
    case CLI_LENGTH:
    case CLI_DENSITY:
    case CLI_TIME:
        return take_quantity(p, option, text);
    case CLI_CHOICE:
        return take_choice(p, option, text);
    }
    return false;
}

// the argument behind the present one; what looks like a long option is more likely a forgotten value
static const char *value_behind(parser *p, const cli_option *option)
{
    char name[NAME_BYTES];
    if (p->at + 1 < p->count && strncmp(p->arguments[p->at + 1], "--", 2) != 0)
        return p->arguments[++p->at];
    fail(p, "%s needs a value: --%s %s", shown(option, name), option->name, option->argument);
    return NULL;
}

static bool is_words(const char *text)
{
    return *text && strspn(text, "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_:,") == strlen(text);
}

// words that may be left out: a file's name is rarely one of them, as it has a suffix
static const char *words_behind(parser *p)
{
    if (p->at + 1 < p->count && is_words(p->arguments[p->at + 1]))
        return p->arguments[++p->at];
    return "";
}

static const char *value_of(parser *p, const cli_option *option)
{
    if (option->kind == CLI_FLAG)
        return "";
    return option->kind == CLI_WORDS ? words_behind(p) : value_behind(p, option);
}

// every row of this name takes the value
static bool take_by_name(parser *p, const char *name, const char *text)
{
    for (size_t i = 0; i < p->tool->option_count; i++) {
        const cli_option *option = &p->tool->options[i];
        if (option->name && strcmp(option->name, name) == 0 && !take(p, option, text))
            return false;
    }
    return true;
}

static const cli_option *find(const cli_tool *tool, const char *name, size_t length, char letter)
{
    for (size_t i = 0; i < tool->option_count; i++) {
        const cli_option *option = &tool->options[i];
        if (!option->name)
            continue;
        if (name ? strlen(option->name) == length && strncmp(option->name, name, length) == 0
                 : option->letter == letter)
            return option;
    }
    return NULL;
}

static bool parse_long_option(parser *p, const char *argument)
{
    const char *name = argument + 2, *equals = strchr(name, '=');
    size_t length = equals ? (size_t)(equals - name) : strlen(name);
    const cli_option *option = find(p->tool, name, length, 0);
    if (!option) {
        char typed[NAME_BYTES + 1];
        snprintf(typed, sizeof typed, "%.*s", (int)(length < NAME_BYTES ? length : NAME_BYTES), name);
        const char *near = dem_nearest(typed, option_name, p->tool);
        if (near)
            return fail(p, "unknown option --%s; did you mean --%s?", typed, near);
        return fail(p, "unknown option --%s", typed);
    }
    if (option->kind == CLI_FLAG && equals)
        return fail(p, "--%s takes no value", option->name);
    const char *text = equals ? equals + 1 : value_of(p, option);
    return text && take_by_name(p, option->name, text);
}

// -n5, -n 5, and flags in a row: -qv
static bool parse_letters(parser *p, const char *argument)
{
    for (const char *at = argument + 1; *at; at++) {
        const cli_option *option = find(p->tool, NULL, 0, *at);
        if (!option)
            return fail(p, "unknown option -%c", isprint((unsigned char)*at) ? *at : '?');
        if (option->kind == CLI_FLAG) {
            if (!take_by_name(p, option->name, ""))
                return false;
            continue;
        }
        const char *text = at[1] ? at + 1 : value_of(p, option);
        return text && take_by_name(p, option->name, text);
    }
    return true;
}

static cli_next answer(const cli_tool *tool, const char *argument, int *exit_status)
{
    dem_buffer text = {0};
    if (strcmp(argument, "--version") == 0)
        dem_buffer_print(&text, "%s %s\n", tool->name, dem_version());
    else if (strncmp(argument, "--help=", 7) == 0) {
        if (!cli_help_form(tool, argument + 7, &text)) {
            *exit_status = cli_wrong_usage(tool, "--help= takes man, bash, zsh or fish, not '%s'", argument + 7);
            return CLI_STOP;
        }
    } else
        cli_help(tool, &text);
    *exit_status = cli_print(tool, &text);
    return CLI_STOP;
}

cli_next cli_parse(const cli_tool *tool, int argc, char **argv, cli_texts *operands, int *exit_status)
{
    parser p = {.tool = tool, .arguments = argv + 1, .count = argc - 1};
    bool options_over = false, good = true;
    for (; good && p.at < p.count; p.at++) {
        const char *argument = p.arguments[p.at];
        if (options_over || argument[0] != '-' || argument[1] == 0) {
            good = add_text(operands, argument);
            p.status = good ? 0 : DEM_FAILED;
        } else if (strcmp(argument, "--") == 0)
            options_over = true;
        else if (strcmp(argument, "-h") == 0 || strcmp(argument, "--help") == 0 ||
                 strncmp(argument, "--help=", 7) == 0 || strcmp(argument, "--version") == 0)
            return answer(tool, argument, exit_status);
        else
            good = argument[1] == '-' ? parse_long_option(&p, argument) : parse_letters(&p, argument);
    }
    *exit_status = p.status;
    return good ? CLI_GO : CLI_STOP;
}
