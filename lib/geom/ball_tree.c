#include "geom/ball_tree.h"

#include <stdlib.h>

#include "geom/tree.h"

enum { LEAF_BALLS = 6, STACK = 96 };

static void split_at(const dem_ball_tree *tree, uint32_t begin, uint32_t end, uint32_t middle, int axis)
{
    uint32_t *order = tree->order;
    int64_t low = begin, high = (int64_t)end - 1;
    while (low < high) {
        double pivot = v3_get(tree->balls[order[low + (high - low) / 2]].centre, axis);
        int64_t i = low, j = high;
        while (i <= j) {
            while (v3_get(tree->balls[order[i]].centre, axis) < pivot)
                i++;
            while (v3_get(tree->balls[order[j]].centre, axis) > pivot)
                j--;
            if (i <= j) {
                uint32_t swap = order[i];
                order[i++] = order[j];
                order[j--] = swap;
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

static uint32_t build_range(dem_ball_tree *tree, uint32_t begin, uint32_t end)
{
    uint32_t me = (uint32_t)tree->node_count++;
    dem_box box = box_empty(), centres = box_empty();
    for (uint32_t i = begin; i < end; i++) {
        dem_ball ball = tree->balls[tree->order[i]];
        dem_vec3 reach = v3(ball.radius, ball.radius, ball.radius);
        box = box_with(box_with(box, v3_sub(ball.centre, reach)), v3_add(ball.centre, reach));
        centres = box_with(centres, ball.centre);
    }
    tree->nodes[me] = (dem_ball_node){.box = box, .begin = begin, .end = end};
    if (end - begin > LEAF_BALLS) {
        dem_vec3 size = v3_sub(centres.high, centres.low);
        int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
        uint32_t middle = begin + (end - begin) / 2;
        split_at(tree, begin, end, middle, axis);
        build_range(tree, begin, middle);
        tree->nodes[me].right = build_range(tree, middle, end);
    }
    return me;
}

dem_status dem_ball_tree_build(dem_ball_tree *tree, const dem_ball *balls, size_t count, dem_error *error)
{
    *tree = (dem_ball_tree){.balls = balls, .count = count};
    if (count == 0 || count > UINT32_MAX / 2)
        return dem_fail(error, DEM_USAGE, "%zu spheres; give at least 1 and fewer than 2^31", count);
    tree->nodes = dem_alloc(count, sizeof *tree->nodes);  // leaves hold at least 3 balls, or there is one node
    tree->order = dem_alloc(count, sizeof *tree->order);
    if (!tree->nodes || !tree->order) {
        dem_ball_tree_release(tree);
        return dem_fail_memory(error);
    }
    for (size_t i = 0; i < count; i++)
        tree->order[i] = (uint32_t)i;
    build_range(tree, 0, (uint32_t)count);
    return DEM_OK;
}

void dem_ball_tree_release(dem_ball_tree *tree)
{
    free(tree->nodes);
    free(tree->order);
    *tree = (dem_ball_tree){0};
}

size_t dem_ball_tree_near(const dem_ball_tree *tree, dem_ball ball, double gap, uint32_t *found)
{
    size_t count = 0;
    uint32_t stack[STACK];
    int top = 0;
    stack[top++] = 0;
    // a box holds whole balls, so the ball must come within `gap` of it; a hair more against rounding
    double reach = fmax(0, ball.radius + fmax(gap, 0)) * (1 + 1e-12);
    while (top) {
        uint32_t at = stack[--top];
        const dem_ball_node *node = &tree->nodes[at];
        if (box_distance2(&node->box, ball.centre) > reach * reach)
            continue;
        if (node->right) {
            stack[top++] = node->right;
            stack[top++] = at + 1;
            continue;
        }
        for (uint32_t i = node->begin; i < node->end; i++) {
            const dem_ball *other = &tree->balls[tree->order[i]];
            double sum = ball.radius + other->radius + gap;
            if (sum > 0 && v3_norm2(v3_sub(other->centre, ball.centre)) < sum * sum)
                found[count++] = tree->order[i];
        }
    }
    return count;
}

double dem_ball_tree_level(const dem_ball_tree *tree, dem_vec3 p, double limit, uint32_t *nearest)
{
    double best = limit;
    uint32_t stack[STACK];
    int top = 0;
    stack[top++] = 0;
    while (top) {
        uint32_t at = stack[--top];
        const dem_ball_node *node = &tree->nodes[at];
        double away = box_distance2(&node->box, p);
        if (away > 0 && (best <= 0 || away > best * best))
            continue;
        if (node->right) {
            stack[top++] = node->right;
            stack[top++] = at + 1;
            continue;
        }
        for (uint32_t i = node->begin; i < node->end; i++) {
            const dem_ball *ball = &tree->balls[tree->order[i]];
            double level = v3_distance(p, ball->centre) - ball->radius;
            if (level < best) {
                best = level;
                if (nearest)
                    *nearest = tree->order[i];
            }
        }
    }
    return best;
}
