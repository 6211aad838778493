#include "geom/box_tree.h"

#include <stdlib.h>

// an item on its way to its leaf; moved as a whole, so that every pass over a range is sequential
typedef struct entry {
    dem_vec3 centre;
    uint32_t item;
} entry;

typedef struct builder {
    dem_box_tree *tree;
    entry *entries;
    const void *items;
    dem_box_of box_of;
    uint32_t leaf;
} builder;

// quickselect of entries[begin, end) about position `middle` by centre coordinate
static void split_at(entry *entries, uint32_t begin, uint32_t end, uint32_t middle, int axis)
{
    int64_t low = begin, high = (int64_t)end - 1;
    while (low < high) {
        double pivot = v3_get(entries[low + (high - low) / 2].centre, axis);
        int64_t i = low, j = high;
        while (i <= j) {
            while (v3_get(entries[i].centre, axis) < pivot)
                i++;
            while (v3_get(entries[j].centre, axis) > pivot)
                j--;
            if (i <= j) {
                entry swap = entries[i];
                entries[i++] = entries[j];
                entries[j--] = swap;
            }
        }
        if (middle <= j)
            high = j;
        else if (middle >= i)
            low = i;
        else
            return;
    }
}

static uint32_t build_range(builder *b, uint32_t begin, uint32_t end)
{
    dem_box_tree *tree = b->tree;
    uint32_t me = (uint32_t)tree->node_count++, right = 0;
    dem_box box = box_empty();
    if (end - begin <= b->leaf) {
        for (uint32_t i = begin; i < end; i++) {
            tree->order[i] = b->entries[i].item;
            dem_box own = b->box_of(b->items, tree->order[i]);
            box = box_with(box_with(box, own.low), own.high);
        }
    } else {
        dem_box centres = box_empty();
        for (uint32_t i = begin; i < end; i++)
            centres = box_with(centres, b->entries[i].centre);
        dem_vec3 size = v3_sub(centres.high, centres.low);
        int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
        uint32_t middle = begin + (end - begin) / 2;
        split_at(b->entries, begin, end, middle, axis);
        uint32_t left = build_range(b, begin, middle);
        right = build_range(b, middle, end);
        box = tree->nodes[left].box;
        box = box_with(box_with(box, tree->nodes[right].box.low), tree->nodes[right].box.high);
    }
    tree->nodes[me] = (dem_box_node){.box = box, .begin = begin, .end = end, .right = right};
    return me;
}

bool dem_box_tree_build(dem_box_tree *tree, const void *items, size_t count, uint32_t leaf, dem_box_of box_of)
{
    DEM_ASSERT(count > 0 && count < UINT32_MAX / 2 && leaf >= 2);
    *tree = (dem_box_tree){.count = count};
    // leaves hold at least (leaf + 1) / 2 items unless there is only one
    size_t leaves = count / ((leaf + 1) / 2) + 1;
    tree->nodes = dem_alloc(2 * leaves, sizeof *tree->nodes);
    tree->order = dem_alloc(count, sizeof *tree->order);
    builder b = {tree, dem_alloc(count, sizeof(entry)), items, box_of, leaf};
    bool done = tree->nodes && tree->order && b.entries;
    if (done) {
        for (uint32_t i = 0; i < count; i++) {
            dem_box box = box_of(items, i);
            b.entries[i] = (entry){v3_scale(v3_add(box.low, box.high), 0.5), i};
        }
        build_range(&b, 0, (uint32_t)count);
    } else {
        dem_box_tree_release(tree);
    }
    free(b.entries);
    return done;
}

void dem_box_tree_release(dem_box_tree *tree)
{
    free(tree->nodes);
    free(tree->order);
    *tree = (dem_box_tree){0};
}
