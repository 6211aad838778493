#include "geom/ball_tree.h"

enum { LEAF_BALLS = 6 };

static dem_box ball_box(const void *items, uint32_t item)
{
    dem_ball ball = ((const dem_ball *)items)[item];
    dem_vec3 reach = v3(ball.radius, ball.radius, ball.radius);
    return (dem_box){v3_sub(ball.centre, reach), v3_add(ball.centre, reach)};
}

dem_status dem_ball_tree_build(dem_ball_tree *tree, const dem_ball *balls, size_t count, dem_error *error)
{
    *tree = (dem_ball_tree){.balls = balls};
    if (count == 0 || count >= UINT32_MAX / 2)
        return dem_fail(error, DEM_USAGE, "%zu spheres; give at least 1 and fewer than 2^31", count);
    return dem_box_tree_build(&tree->boxes, balls, count, LEAF_BALLS, ball_box) ? DEM_OK : dem_fail_memory(error);
}

void dem_ball_tree_release(dem_ball_tree *tree)
{
    dem_box_tree_release(&tree->boxes);
}

size_t dem_ball_tree_near(const dem_ball_tree *tree, dem_ball ball, double gap, uint32_t *found)
{
    size_t count = 0;
    uint32_t stack[DEM_BOX_TREE_STACK];
    int top = 0;
    stack[top++] = 0;
    // a box holds whole balls, so the ball must come within `gap` of it; a hair more against rounding
    double reach = fmax(0, ball.radius + fmax(gap, 0)) * (1 + 1e-12);
    while (top) {
        uint32_t at = stack[--top];
        const dem_box_node *node = &tree->boxes.nodes[at];
        if (box_distance2(&node->box, ball.centre) > reach * reach)
            continue;
        if (node->right) {
            stack[top++] = node->right;
            stack[top++] = at + 1;
            continue;
        }
        for (uint32_t i = node->begin; i < node->end; i++) {
            const dem_ball *other = &tree->balls[tree->boxes.order[i]];
            double sum = ball.radius + other->radius + gap;
            if (sum > 0 && v3_norm2(v3_sub(other->centre, ball.centre)) < sum * sum)
                found[count++] = tree->boxes.order[i];
        }
    }
    return count;
}

double dem_ball_tree_level(const dem_ball_tree *tree, dem_vec3 p, double limit, double enough, uint32_t *nearest)
{
    double best = limit;
    uint32_t stack[DEM_BOX_TREE_STACK];
    int top = 0;
    stack[top++] = 0;
    while (top && best >= enough) {
        uint32_t at = stack[--top];
        const dem_box_node *node = &tree->boxes.nodes[at];
        double away = box_distance2(&node->box, p);
        if (away > 0 && (best <= 0 || away > best * best))
            continue;
        if (node->right) {
            const dem_box_node *left = node + 1, *right = &tree->boxes.nodes[node->right];
            bool left_first = box_distance2(&left->box, p) < box_distance2(&right->box, p);
            stack[top++] = left_first ? node->right : at + 1;
            stack[top++] = left_first ? at + 1 : node->right;
            continue;
        }
        for (uint32_t i = node->begin; i < node->end; i++) {
            const dem_ball *ball = &tree->balls[tree->boxes.order[i]];
            double level = v3_distance(p, ball->centre) - ball->radius;
            if (level < best) {
                best = level;
                if (nearest)
                    *nearest = tree->boxes.order[i];
            }
        }
    }
    return best;
}
