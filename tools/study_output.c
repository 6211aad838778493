#include "study_output.h"

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
