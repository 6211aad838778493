/// `--help=bash`, `--help=zsh`, `--help=fish`: completions of a tool for the shells.
///
/// A subcommand ("dem-clump verify") is a table of its own; its text stands in the same file as that of its tool,
/// which finds it there by the name of its function (bash, zsh) or in a list (fish).
#include "cli_table.h"

#include <string.h>

// `text` to stand between single quotes; every letter of `escaped` gets a backslash in front
static void put_escaped(dem_buffer *out, const char *text, const char *escaped, const char *quote)
{
    for (const char *c = text; *c; c++) {
        if (*c == '\'') {
            dem_buffer_text(out, quote);
            continue;
        }
        if (strchr(escaped, *c))
            dem_buffer_text(out, "\\");
        dem_buffer_bytes(out, c, 1);
    }
}

// "a|b|c" as "a b c"
static void put_choices(dem_buffer *out, const char *choices)
{
    for (const char *c = choices; *c; c++)
        dem_buffer_bytes(out, *c == '|' ? " " : c, 1);
}

// ---- bash

static const char bash_begin[] = "{\n"
                                 "    local word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD - 1]}\n"
                                 "    if [[ $word == = ]]; then word=\n"
                                 "    elif [[ $before == = ]]; then before=${COMP_WORDS[COMP_CWORD - 2]}\n"
                                 "    fi\n"
                                 "    COMPREPLY=()\n";

static void put_bash_values(dem_buffer *out, cli_values values, const char *choices)
{
    if (values == CLI_VALUES_CHOICE) {
        dem_buffer_text(out, "mapfile -t COMPREPLY < <(compgen -W '");
        put_choices(out, choices);
        dem_buffer_text(out, "' -- \"$word\")");
    } else if (values == CLI_VALUES_ANY)
        dem_buffer_text(out, ":");  // nothing to offer
    else
        dem_buffer_print(out, "compopt -o filenames 2>/dev/null; mapfile -t COMPREPLY < <(compgen -%c -- \"$word\")",
                         values == CLI_VALUES_FILES ? 'f' : 'd');
}

static void put_bash_option(dem_buffer *out, const cli_option *option)
{
    dem_buffer_text(out, "    ");
    if (option->letter)
        dem_buffer_print(out, "-%c | ", option->letter);
    dem_buffer_print(out, "--%s) ", option->name);
    put_bash_values(out, cli_values_of(option), option->argument);
    dem_buffer_text(out, "; return ;;\n");
}

void cli_complete_bash(const cli_tool *tool, dem_buffer *text)
{
    char function[64], operand[64];
    bool sub = strchr(tool->name, ' ');
    cli_name_as(tool, '_', '_', function, sizeof function);
    dem_buffer_print(text, "# bash completion for %s\n_%s()\n%s", tool->name, function, bash_begin);
    if (!sub)
        dem_buffer_print(text,
                         "    if ((COMP_CWORD > 1)) && declare -F \"_%s_${COMP_WORDS[1]}\" >/dev/null; then\n"
                         "        \"_%s_${COMP_WORDS[1]}\"\n        return\n    fi\n",
                         function, function);
    dem_buffer_text(text, "    case $before in\n");
    const cli_option *option;
    for (size_t i = 0; (option = cli_option_at(tool, i)); i++)
        if (option->argument && !cli_value_optional(option))
            put_bash_option(text, option);
    dem_buffer_text(text, "    esac\n    if [[ $word == -* ]]; then\n        mapfile -t COMPREPLY < <(compgen -W '");
    for (size_t i = 0; (option = cli_option_at(tool, i)); i++) {
        if (option->letter)
            dem_buffer_print(text, "-%c ", option->letter);
        dem_buffer_print(text, "--%s ", option->name);
    }
    dem_buffer_text(text, "' -- \"$word\")\n        return\n    fi\n    ");
    put_bash_values(text, cli_operands(tool, operand, sizeof operand), NULL);
    dem_buffer_text(text, "\n");
    if (!sub)
        dem_buffer_print(text,
                         "    ((COMP_CWORD > 1)) && return\n"
                         "    local name\n"
                         "    for name in $(compgen -A function _%s_); do\n"
                         "        name=${name#_%s_}\n"
                         "        [[ $name == \"$word\"* ]] && COMPREPLY+=(\"$name\")\n"
                         "    done\n",
                         function, function);
    dem_buffer_text(text, "    return 0\n}\n");
    if (!sub)
        dem_buffer_print(text, "complete -F _%s %s\n", function, tool->name);
}

// ---- zsh

static void put_zsh_values(dem_buffer *out, cli_values values, bool optional, const char *name, const char *choices)
{
    dem_buffer_text(out, optional ? "::" : ":");
    for (const char *c = name; *c; c++)
        dem_buffer_bytes(out, strchr(":|'[]", *c) ? " " : c, 1);
    if (values == CLI_VALUES_CHOICE) {
        dem_buffer_text(out, ":(");
        put_choices(out, choices);
        dem_buffer_text(out, ")'");
    } else
        dem_buffer_text(out, values == CLI_VALUES_FILES     ? ":_files'"
                             : values == CLI_VALUES_FOLDERS ? ":_files -/'"
                                                            : ": '");
}

// '(-n --spheres)'{-n+,--spheres=}'[help]:N: '
static void put_zsh_option(dem_buffer *out, const cli_option *option)
{
    const char *value = option->argument ? "=" : "";
    dem_buffer_text(out, "        ");
    if (option->kind == CLI_TEXTS)
        dem_buffer_text(out, "'*'");
    else if (option->letter)
        dem_buffer_print(out, "'(-%c --%s)'", option->letter, option->name);
    if (option->letter)
        dem_buffer_print(out, "{-%c%s,--%s%s}", option->letter, option->argument ? "+" : "", option->name, value);
    else
        dem_buffer_print(out, "--%s%s", option->name, value);
    dem_buffer_text(out, "'[");
    put_escaped(out, option->help, "[]:\\", "'\\''");
    dem_buffer_text(out, "]");
    if (option->argument)
        put_zsh_values(out, cli_values_of(option), cli_value_optional(option),
                       option->kind == CLI_CHOICE ? option->name : option->argument, option->argument);
    else
        dem_buffer_text(out, "'");
    dem_buffer_text(out, " \\\n");
}

void cli_complete_zsh(const cli_tool *tool, dem_buffer *text)
{
    char function[64], operand[64];
    bool sub = strchr(tool->name, ' ');
    cli_name_as(tool, '_', '_', function, sizeof function);
    if (!sub)
        dem_buffer_print(text, "#compdef %s\n", tool->name);
    dem_buffer_print(text, "_%s()\n{\n", function);
    if (!sub)
        dem_buffer_print(text,
                         "    if ((CURRENT > 2 && $+functions[_%s_${words[2]}])); then\n"
                         "        shift words\n        ((CURRENT--))\n        _%s_${words[1]}\n        return\n    fi\n"
                         "    ((CURRENT == 2)) && compadd -- ${${(k)functions[(I)_%s_*]}#_%s_}\n",
                         function, function, function, function);
    dem_buffer_text(text, "    _arguments -s -S \\\n");
    const cli_option *option;
    for (size_t i = 0; (option = cli_option_at(tool, i)); i++)
        put_zsh_option(text, option);
    cli_values values = cli_operands(tool, operand, sizeof operand);
    dem_buffer_text(text, "        '*");
    put_zsh_values(text, values, false, *operand ? operand : " ", NULL);
    dem_buffer_text(text, "\n}\n");
}

// ---- fish

static void put_fish_option(dem_buffer *out, const cli_option *option)
{
    cli_values values = cli_values_of(option);
    if (option->letter)
        dem_buffer_print(out, " -s %c", option->letter);
    dem_buffer_print(out, " -l %s", option->name);
    if (option->argument && !cli_value_optional(option))
        dem_buffer_text(out, values == CLI_VALUES_FILES ? " -r -F" : " -x");
    if (values == CLI_VALUES_CHOICE) {
        dem_buffer_text(out, " -a '");
        put_choices(out, option->argument);
        dem_buffer_text(out, "'");
    } else if (values == CLI_VALUES_FOLDERS)
        dem_buffer_text(out, " -a '(__fish_complete_directories)'");
    dem_buffer_text(out, " -d '");
    put_escaped(out, option->help, "\\", "\\'");
    dem_buffer_text(out, "'\n");
}

void cli_complete_fish(const cli_tool *tool, dem_buffer *text)
{
    char list[80], name[64], operand[64], when[160];
    snprintf(name, sizeof name, "%s", tool->name);
    char *sub = strchr(name, ' ');
    if (sub)
        *sub++ = 0;
    cli_name_as(&(cli_tool){.name = name}, '_', '_', list, sizeof list);
    if (sub) {
        dem_buffer_print(text, "set -g __%s_commands $__%s_commands %s\n", list, list, sub);
        dem_buffer_print(text, "complete -c %s -n __fish_use_subcommand -a %s -d '", name, sub);
        put_escaped(text, tool->about, "\\", "\\'");
        dem_buffer_text(text, "'\n");
        snprintf(when, sizeof when, "'__fish_seen_subcommand_from %s'", sub);
    } else
        snprintf(when, sizeof when, "'not __fish_seen_subcommand_from $__%s_commands'", list);
    cli_values values = cli_operands(tool, operand, sizeof operand);
    if (values != CLI_VALUES_FILES)
        dem_buffer_print(text, "complete -c %s -n %s -f%s\n", name, when,
                         values == CLI_VALUES_FOLDERS ? " -a '(__fish_complete_directories)'" : "");
    const cli_option *option;
    for (size_t i = 0; (option = cli_option_at(tool, i)); i++) {
        dem_buffer_print(text, "complete -c %s -n %s", name, when);
        put_fish_option(text, option);
    }
}
