#include "mesh/labels.h"

#include <stdlib.h>

#include "base/memory.h"

enum { MOST_LABELS = 1000000, FIRST_SLOTS = 1024 };

// labels by value: open addressing, slots hold the index + 1
typedef struct label_map {
    uint32_t *slots;
    size_t mask;
    dem_label *labels;
    size_t count, capacity;
} label_map;

static size_t slot_of(const label_map *map, uint32_t value)
{
    size_t at = (size_t)((value * 0x9e3779b97f4a7c15u) >> 32) & map->mask;
    while (map->slots[at] && map->labels[map->slots[at] - 1].value != value)
        at = (at + 1) & map->mask;
    return at;
}

static bool widen(label_map *map)
{
    size_t mask = map->slots ? 2 * map->mask + 1 : FIRST_SLOTS - 1;
    uint32_t *slots = dem_alloc_zero(mask + 1, sizeof *slots);
    if (!slots)
        return false;
    free(map->slots);
    map->slots = slots;
    map->mask = mask;
    for (size_t i = 0; i < map->count; i++)
        map->slots[slot_of(map, map->labels[i].value)] = (uint32_t)i + 1;
    return true;
}

// NULL: no memory
static dem_label *label_for(label_map *map, uint32_t value)
{
    size_t slot = slot_of(map, value);
    if (map->slots[slot])
        return &map->labels[map->slots[slot] - 1];
    if (!dem_grow(&map->labels, &map->capacity, map->count, sizeof *map->labels))
        return NULL;
    map->labels[map->count++] = (dem_label){.value = value, .low = {SIZE_MAX, SIZE_MAX, SIZE_MAX}};
    map->slots[slot] = (uint32_t)map->count;
    if (2 * map->count > map->mask && !widen(map))
        return NULL;
    return &map->labels[map->count - 1];
}

static void include(dem_label *label, const size_t low[3], const size_t high[3])
{
    for (int k = 0; k < 3; k++) {
        label->low[k] = low[k] < label->low[k] ? low[k] : label->low[k];
        label->high[k] = high[k] > label->high[k] ? high[k] : label->high[k];
    }
}

// the runs of equal voxels of a row
static dem_status take_row(label_map *map, const dem_volume *v, size_t y, size_t z, dem_error *error)
{
    size_t row = (z * v->size[1] + y) * v->size[0];
    for (size_t x = 0, end; x < v->size[0]; x = end) {
        uint32_t value = dem_volume_label(v, row + x);
        for (end = x + 1; end < v->size[0] && dem_volume_label(v, row + end) == value; end++)
            ;
        if (value == 0)
            continue;
        dem_label *label = label_for(map, value);
        if (!label)
            return dem_fail_memory(error);
        label->voxels += end - x;
        include(label, (size_t[]){x, y, z}, (size_t[]){end - 1, y, z});
    }
    if (map->count > MOST_LABELS)
        return dem_fail(error, DEM_BAD_INPUT, "more than %d different values are no labels; segment the image first",
                        MOST_LABELS);
    return DEM_OK;
}

static int by_value(const void *a, const void *b)
{
    uint32_t x = ((const dem_label *)a)->value, y = ((const dem_label *)b)->value;
    return (x > y) - (x < y);
}

dem_status dem_labels_find(const dem_ctx *ctx, const dem_volume *volume, dem_label **labels, size_t *count,
                           dem_error *error)
{
    label_map map = {0};
    dem_status status = widen(&map) ? DEM_OK : dem_fail_memory(error);
    for (size_t z = 0; status == DEM_OK && z < volume->size[2]; z++) {
        if (dem_progress(ctx, "looking for labels", (double)z / (double)volume->size[2]))
            status = dem_fail(error, DEM_INTERRUPTED, "interrupted while looking for labels");
        for (size_t y = 0; status == DEM_OK && y < volume->size[1]; y++)
            status = take_row(&map, volume, y, z, error);
    }
    if (status == DEM_OK && map.count == 0)
        status =
            dem_fail(error, DEM_BAD_INPUT, "no label: all voxels are 0, which is the background; segment the image");
    free(map.slots);
    if (status != DEM_OK) {
        free(map.labels);
        return status;
    }
    for (size_t i = 0; i < map.count; i++)
        for (int k = 0; k < 3; k++)
            map.labels[i].border |= map.labels[i].low[k] == 0 || map.labels[i].high[k] + 1 == volume->size[k];
    qsort(map.labels, map.count, sizeof *map.labels, by_value);
    *labels = map.labels;
    *count = map.count;
    return DEM_OK;
}
