#define _GNU_SOURCE
#include "clump_labels.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"

// reads "3" or "10-20" at `text`; NULL: neither
static const char *parse_range(const char *text, long *first, long *last)
{
    const char *end = text + strlen(text);
    text = dem_parse_long(text, end, first);
    *last = *first;
    if (text && *text == '-')
        text = dem_parse_long(text + 1, end, last);
    return text && *first >= 1 && *last >= *first && *last <= UINT32_MAX ? text : NULL;
}

dem_status labels_parse(const char *text, dem_error *error)
{
    long first, last;
    for (const char *at = text; (at = parse_range(at, &first, &last)); at++)
        if (*at == 0)
            return DEM_OK;
        else if (*at != ',')
            break;
    return dem_fail(error, DEM_USAGE, "'%.60s' is no list of labels as in 3,7,10-20", text);
}

static bool is_asked(const char *text, uint32_t value)
{
    long first, last;
    bool asked = !text;
    for (const char *at = text; !asked && at && (at = parse_range(at, &first, &last)); at += *at == ',')
        if (value >= first && value <= last)
            asked = true;
        else if (*at == 0)
            break;
    return asked;
}

// metres: by --unit, by the header, or as they are
static void set_unit(const dem_ctx *ctx, const job_options *options, const batch_options *asked, dem_volume *v)
{
    if (asked->spacing.x > 0) {
        dem_volume_space(v, asked->spacing);
        v->origin = (dem_vec3){0};
        v->unit_name[0] = 0;
    } else if (options->unit_given) {
        dem_volume_scale(v, options->unit);
        if (v->unit > 0 && fabs(v->unit / options->unit - 1) > 1e-9)
            dem_log(ctx, DEM_LOG_WARNING, "the header names another unit; --unit %s is taken", options->unit_name);
    } else if (v->unit > 0) {
        dem_volume_scale(v, v->unit);
    } else {
        dem_log(ctx, DEM_LOG_WARNING, "the file tells no unit of length: its spacing is taken in metres; give --unit");
    }
    if (!v->spaced)
        dem_log(ctx, DEM_LOG_WARNING, "the file tells no size of its voxels: they are taken as 1; give --voxel-size");
}

typedef struct left_out {
    size_t small, cut, unasked;
} left_out;

static bool is_wanted(const dem_label *label, const batch_options *asked, left_out *out)
{
    if (!is_asked(asked->labels, label->value))
        out->unasked++;
    else if (label->voxels < (size_t)asked->min_voxels)
        out->small++;
    else if (asked->drop_border && label->border)
        out->cut++;
    else
        return true;
    return false;
}

static dem_status choose(const dem_ctx *ctx, const clump_input *input, const batch_options *asked, size_t found,
                         label_list *list, dem_error *error)
{
    left_out out = {0};
    list->items = dem_alloc(found, sizeof *list->items);
    list->names = dem_alloc_zero(found, sizeof *list->names);
    if (!list->items || !list->names)
        return dem_fail_memory(error);
    size_t cut = 0;
    for (size_t i = 0; i < found; i++) {
        if (!is_wanted(&list->all[i], asked, &out))
            continue;
        cut += list->all[i].border;
        list->items[list->count] = &list->all[i];
        if (asprintf(&list->names[list->count], "%.200s_%u", input->name, list->all[i].value) < 0) {
            list->names[list->count] = NULL;
            return dem_fail_memory(error);
        }
        list->count++;
    }
    if (list->count == 0)
        return dem_fail(error, DEM_BAD_INPUT,
                        "none of %zu labels is left: %zu not asked for, %zu of fewer than %ld voxels "
                        "(--min-voxels), %zu cut by the border; ask for others",
                        found, out.unasked, out.small, asked->min_voxels, out.cut);
    if (out.small)
        dem_log(ctx, DEM_LOG_WARNING, "left out %zu label%s of fewer than %ld voxels (--min-voxels)", out.small,
                out.small == 1 ? "" : "s", asked->min_voxels);
    if (out.cut)
        dem_log(ctx, DEM_LOG_WARNING, "left out %zu label%s that the border of the image cuts", out.cut,
                out.cut == 1 ? "" : "s");
    if (cut)
        dem_log(ctx, DEM_LOG_WARNING, "%zu label%s cut flat by the border of the image; --drop-border leaves them out",
                cut, cut == 1 ? " is" : "s are");
    return DEM_OK;
}

dem_status labels_find(const dem_ctx *ctx, const clump_input *input, const job_options *options,
                       const batch_options *asked, dem_volume *volume, label_list *list, dem_error *error)
{
    size_t found;
    *list = (label_list){0};
    DEM_TRY(dem_volume_read(ctx, input->path, &asked->raw, volume, error));
    dem_status status = dem_labels_find(ctx, volume, &list->all, &found, error);
    if (status == DEM_OK) {
        set_unit(ctx, options, asked, volume);
        status = choose(ctx, input, asked, found, list, error);
    }
    if (status != DEM_OK) {
        labels_release(list);
        dem_volume_free(volume);
    }
    return status;
}

void labels_release(label_list *list)
{
    for (size_t i = 0; list->names && i < list->count; i++)
        free(list->names[i]);
    free(list->names);
    free(list->items);
    free(list->all);
    *list = (label_list){0};
}
