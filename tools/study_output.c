#include "study_output.h"

#include <stdlib.h>
#include <string.h>

#include "base/file.h"

study_form study_output_form(const char *path)
{
    static const char *const suffixes[] = {[STUDY_HTML] = "html", [STUDY_CSV] = "csv", [STUDY_SVG] = "svg"};
    for (int i = 0; i < STUDY_UNKNOWN; i++)
        if (dem_file_has_suffix(path, suffixes[i]))
            return (study_form)i;
    return STUDY_UNKNOWN;
}

int study_check_outputs(const cli_tool *tool, const cli_texts *outputs, bool svg)
{
    for (size_t i = 0; i < outputs->count; i++) {
        study_form form = study_output_form(outputs->items[i]);
        if (form == STUDY_UNKNOWN || (form == STUDY_SVG && !svg))
            return cli_wrong_usage(tool, "'%s' names no form that can be written; end it in %s", outputs->items[i],
                                   svg ? ".html, .svg or .csv" : ".html or .csv");
    }
    return 0;
}

int study_read_numbers(const cli_tool *tool, const char *option, const char *text, double low, double high,
                       double *numbers, size_t most, size_t *count)
{
    const char *end = text + strlen(text);
    *count = 0;
    for (const char *at = text;; at++) {
        if (*count == most)
            return cli_wrong_usage(tool, "--%s has more than %zu numbers", option, most);
        double *number = &numbers[*count];
        at = dem_parse_double(at, end, number);
        if (!at || (*at && *at != ','))
            return cli_wrong_usage(tool, "--%s is numbers with commas between, not '%s'", option, text);
        if (!(*number >= low && *number <= high))
            return cli_wrong_usage(tool, "--%s goes from %g to %g, not to %g", option, low, high, *number);
        ++*count;
        if (!*at)
            return 0;
    }
}

int study_write(cli_session *session, const char *folder, const char *name, dem_buffer *text)
{
    dem_error error;
    char *path = dem_path_join(folder, "%s", name);
    dem_status status = path ? dem_file_write_buffer(path, text, &error) : dem_fail_memory(&error);
    if (!path)
        dem_buffer_release(text);
    free(path);
    return status == DEM_OK ? 0 : cli_session_error(session, &error);
}
