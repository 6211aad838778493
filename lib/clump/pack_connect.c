#include "clump/pack_connect.h"

#include <string.h>

#include "base/status.h"

static double gap_between(const dem_ball *balls, const dem_link *link)
{
    const dem_ball *a = &balls[link->i], *b = &balls[link->j];
    return v3_distance(a->centre, b->centre) - a->radius - b->radius;
}

// does the tree found last still hold all balls together?
static bool still_joined(const dem_packing *p, const dem_ball *balls, size_t count, double overlap)
{
    bool joined = count == p->tree_count;
    for (size_t k = 0; k + 1 < count && joined; k++)
        joined = gap_between(balls, &p->tree[k]) + overlap <= 0;
    return joined;
}

// the links that are open of balls whose tree was found last are asked for twice in a row
static bool found_last(const dem_packing *p, const dem_ball *balls, size_t count, double overlap)
{
    return count == p->tree_count && overlap == p->tree_overlap &&
           memcmp(balls, p->tree_balls, count * sizeof *balls) == 0;
}

size_t dem_pack_links(dem_packing *p, const dem_ball *balls, size_t count, double overlap)
{
    if (found_last(p, balls, count, overlap))
        return p->link_count;
    if (still_joined(p, balls, count, overlap))
        return 0;
    dem_ball_columns *c = &p->tree_columns;
    float *reach = p->tree_reach;
    size_t edges = 0, open = 0;
    dem_ball_columns_set(c, balls, count);
    for (size_t i = 0; i < c->padded; i++)
        reach[i] = i < count ? 1e9f : -1e9f;
    // minimum spanning tree (Prim 1957); the gaps again in double
    for (int32_t joined = 0; joined >= 0;) {
        reach[joined] = -1e9f;
        joined = p->kernels->approach(c, (uint32_t)joined, reach, p->tree_nearest);
        if (joined < 0)
            break;
        dem_link *edge = &p->tree[edges++];
        *edge = (dem_link){(uint32_t)joined, (uint32_t)p->tree_nearest[joined], 0};
        edge->gap = gap_between(balls, edge) + overlap;
        if (edge->gap > 0)
            p->links[open++] = *edge;
    }
    p->tree_count = count;
    p->tree_overlap = overlap;
    p->link_count = open;
    memcpy(p->tree_balls, balls, count * sizeof *balls);
    return open;
}

double dem_pack_springs(dem_packing *p, const dem_pack_state *state, double (*equations)[DEM_EQUATION])
{
    if (!p->spring)
        return 0;
    double energy = 0;
    size_t count = dem_pack_links(p, state->balls, state->count, dem_pack_spring_overlap);
    for (size_t k = 0; k < count; k++) {
        const dem_link *link = &p->links[k];
        double gap = link->gap;
        dem_vec3 d = v3_unit(v3_sub(state->balls[link->i].centre, state->balls[link->j].centre));
        energy += p->stiffness * gap * gap;
        for (int side = 0; side < 2 && equations; side++) {
            double sign = side ? -1 : 1, row[4] = {sign * d.x, sign * d.y, sign * d.z, -1};
            double *equation = equations[side ? link->j : link->i];
            for (int a = 0, q = 0; a < 4; a++) {
                for (int b = a; b < 4; b++)
                    equation[q++] += 2 * p->stiffness * row[a] * row[b];
                equation[10 + a] += p->stiffness * row[a] * gap;  // half the gap: both balls move
            }
        }
    }
    return energy;
}

// Both balls of a link move towards each other, and grow by the share `growth` of the gap; the smaller one does more.
static void close_link(dem_pack_state *state, const dem_link *link, double growth)
{
    dem_ball *a = &state->balls[link->i], *b = &state->balls[link->j];
    dem_vec3 d = v3_unit(v3_sub(b->centre, a->centre));
    double share = b->radius / (a->radius + b->radius), way = link->gap * (1 - growth), swell = link->gap * growth;
    a->centre = v3_along(a->centre, way * share, d);
    b->centre = v3_along(b->centre, -way * (1 - share), d);
    a->radius += swell * share;
    b->radius += swell * (1 - share);
}

bool dem_pack_close(dem_packing *p, dem_pack_state *state, double growth)
{
    enum { ROUNDS = 20 };
    const double wanted = (dem_pack_overlap + dem_pack_spring_overlap) / 2;
    if (!p->connected || !dem_pack_links(p, state->balls, state->count, dem_pack_overlap))
        return false;
    for (int i = 0; i < ROUNDS; i++) {
        size_t open = dem_pack_links(p, state->balls, state->count, wanted);
        for (size_t k = 0; k < open; k++)
            close_link(state, &p->links[k], growth);
        if (!open)
            break;
    }
    return true;
}

dem_status dem_pack_join(dem_packing *p, dem_pack_state *state, dem_error *error)
{
    enum { RELAXATIONS = 6 };
    double stiffness = p->stiffness;
    for (int i = 0; i < RELAXATIONS && p->connected; i++) {
        if (!dem_pack_links(p, state->balls, state->count, dem_pack_overlap))
            break;
        p->spring = true;
        DEM_TRY(dem_pack_relax(p, state, (dem_relax_options){15, 0.02, 0}, error));
        p->stiffness *= 2;
    }
    p->stiffness = stiffness;
    dem_pack_close(p, state, 0.5);
    return DEM_OK;
}
