#include "cli_registry.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/nearest.h"
#include "base/units.h"

static bool is_length(const dem_parameter *p)
{
    return strcmp(p->unit, "m") == 0;
}

// " deg" behind a number; "" for pure numbers and counts
static const char *unit_name(const dem_parameter *p, char text[16])
{
    bool pure = strcmp(p->unit, "-") == 0 || strcmp(p->unit, "count") == 0;
    snprintf(text, 16, "%s%s", pure ? "" : " ", pure ? "" : p->unit);
    return text;
}

// "0 to 0.4, default 0.1"
static void put_range(const cli_registry *registry, const dem_parameter *p, dem_buffer *out)
{
    char unit[16];
    double factor = 1;
    if (is_length(p))
        snprintf(unit, sizeof unit, " %s", dem_length_unit(p->standard, &factor));
    else {
        dem_buffer_number(out, p->low, 6);
        dem_buffer_text(out, " to ");
        dem_buffer_number(out, p->high, 6);
        dem_buffer_print(out, "%s, ", unit_name(p, unit));
    }
    dem_buffer_text(out, "default ");
    if (isnan(p->standard)) {
        dem_buffer_text(out, registry->unset);
        return;
    }
    dem_buffer_number(out, p->standard * factor, 6);
    if (is_length(p))
        dem_buffer_text(out, unit);
}

size_t cli_registry_options(cli_registry *registry, cli_option *options, size_t count)
{
    for (size_t k = 0; k < registry->count; k++) {
        const cli_entry *entry = &registry->entries[k];
        DEM_ASSERT(entry->parameter_count <= CLI_PARAMETERS);
        if (entry->parameter_count) {
            snprintf(registry->headings[k], sizeof registry->headings[k], "%c%s %s", registry->what[0] - 'a' + 'A',
                     registry->what + 1, entry->name);
            options[count++] = (cli_option){.help = registry->headings[k]};
        }
        for (size_t i = 0; i < entry->parameter_count; i++) {
            const dem_parameter *p = &entry->parameters[i];
            dem_buffer range = {0};
            put_range(registry, p, &range);
            snprintf(registry->help[k][i], sizeof registry->help[k][i], "%s (%s)", p->help,
                     range.data ? range.data : "");
            dem_buffer_release(&range);
            registry->values[k][i] = NAN;
            options[count++] = (cli_option){.name = p->name,
                                            .kind = is_length(p) ? CLI_LENGTH : CLI_NUMBER,
                                            .argument = is_length(p) ? "D" : "X",
                                            .help = registry->help[k][i],
                                            .value = &registry->values[k][i]};
        }
    }
    return count;
}

static const char *entry_name(const void *user, size_t index)
{
    const cli_registry *registry = user;
    return index < registry->count ? registry->entries[index].name : NULL;
}

size_t cli_registry_find(const cli_registry *registry, const char *name)
{
    size_t k = 0;
    while (k < registry->count && strcmp(registry->entries[k].name, name) != 0)
        k++;
    return k;
}

static bool has_parameter(const cli_entry *entry, const char *name)
{
    for (size_t i = 0; i < entry->parameter_count; i++)
        if (strcmp(entry->parameters[i].name, name) == 0)
            return true;
    return false;
}

int cli_registry_check(const cli_tool *tool, const cli_registry *registry, const char *name, const char *list)
{
    size_t chosen = cli_registry_find(registry, name);
    if (chosen == registry->count) {
        const char *near = dem_nearest(name, entry_name, registry);
        return near ? cli_wrong_usage(tool, "unknown %s '%s'; did you mean %s?", registry->what, name, near)
                    : cli_wrong_usage(tool, "unknown %s '%s'; --%s shows all", registry->what, name, list);
    }
    for (size_t k = 0; k < registry->count; k++) {
        const cli_entry *entry = &registry->entries[k];
        for (size_t i = 0; i < entry->parameter_count; i++)
            if (!isnan(registry->values[k][i]) && !has_parameter(&registry->entries[chosen], entry->parameters[i].name))
                return cli_wrong_usage(tool, "--%s belongs to %s %s, not to %s", entry->parameters[i].name,
                                       registry->what, entry->name, name);
    }
    return 0;
}

void cli_registry_list(const cli_registry *registry, dem_buffer *out)
{
    for (size_t k = 0; k < registry->count; k++) {
        const cli_entry *entry = &registry->entries[k];
        dem_buffer_print(out, "%s%s: %s\n", k ? "\n" : "", entry->name, entry->about);
        if (entry->paper && *entry->paper)
            dem_buffer_print(out, "    %s\n", entry->paper);
        for (size_t i = 0; i < entry->parameter_count; i++) {
            dem_buffer_print(out, "  --%-14s %s (", entry->parameters[i].name, entry->parameters[i].help);
            put_range(registry, &entry->parameters[i], out);
            dem_buffer_text(out, ")\n");
        }
    }
}

void cli_registry_list_json(const cli_registry *registry, dem_buffer *out)
{
    char plural[32];
    snprintf(plural, sizeof plural, "%ss", registry->what);
    dem_json_writer json = dem_json_begin(out);
    dem_json_open_object(&json, NULL);
    dem_json_open_array(&json, plural, true);
    for (size_t k = 0; k < registry->count; k++) {
        const cli_entry *entry = &registry->entries[k];
        dem_json_open_object(&json, NULL);
        dem_json_put_string(&json, "name", entry->name);
        dem_json_put_string(&json, "about", entry->about);
        dem_json_put_string(&json, "paper", entry->paper ? entry->paper : "");
        dem_json_open_array(&json, "parameters", false);
        for (size_t i = 0; i < entry->parameter_count; i++) {
            const dem_parameter *p = &entry->parameters[i];
            dem_json_open_object(&json, NULL);
            dem_json_put_string(&json, "name", p->name);
            dem_json_put_number(&json, "default", p->standard);
            dem_json_put_number(&json, "low", p->low);
            dem_json_put_number(&json, "high", p->high);
            dem_json_put_string(&json, "unit", p->unit);
            dem_json_put_string(&json, "help", p->help);
            dem_json_close(&json, '}');
        }
        dem_json_close(&json, ']');
        dem_json_close(&json, '}');
    }
    dem_json_close(&json, ']');
    dem_json_close(&json, '}');
}
