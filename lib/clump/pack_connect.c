#include "clump/pack_connect.h"

#include <string.h>

#include "base/status.h"

// Whatever moves by at most d changes an overlap by at most 2 d: so long the tree found last still holds together.
static bool still_joined(const dem_packing *p, const dem_ball *balls, size_t count, double overlap)
{
    if (count != p->tree_count || p->tree_overlap <= overlap)
        return false;
    double limit = (p->tree_overlap - overlap) / 2;
    for (size_t i = 0; i < count; i++) {
        const dem_ball *then = &p->tree_balls[i];
        double move = v3_distance(balls[i].centre, then->centre) + fabs(balls[i].radius - then->radius);
        if (!(move < limit))
            return false;
    }
    return true;
}

size_t dem_pack_links(dem_packing *p, const dem_ball *balls, size_t count, double overlap, dem_link *links)
{
    if (still_joined(p, balls, count, overlap))
        return 0;
    dem_ball_columns *c = &p->tree_columns;
    float *reach = p->tree_reach;
    double widest = -INFINITY;
    size_t open = 0;
    dem_ball_columns_set(c, balls, count);
    for (size_t i = 0; i < c->padded; i++)
        reach[i] = i < count ? 1e9f : -1e9f;
    // minimum spanning tree (Prim 1957); the gaps again in double
    for (int32_t joined = 0; joined >= 0;) {
        reach[joined] = -1e9f;
        joined = p->kernels->approach(c, (uint32_t)joined, reach, p->tree_nearest);
        if (joined < 0)
            break;
        uint32_t i = (uint32_t)joined, j = (uint32_t)p->tree_nearest[joined];
        double gap = v3_distance(balls[i].centre, balls[j].centre) - balls[i].radius - balls[j].radius;
        widest = fmax(widest, gap);
        if (gap + overlap > 0)
            links[open++] = (dem_link){i, j, gap + overlap};
    }
    p->tree_count = count;
    p->tree_overlap = -widest;
    memcpy(p->tree_balls, balls, count * sizeof *balls);
    return open;
}

double dem_pack_springs(dem_packing *p, const dem_pack_state *state, double (*equations)[DEM_EQUATION])
{
    if (!p->spring)
        return 0;
    double energy = 0;
    size_t count = dem_pack_links(p, state->balls, state->count, dem_pack_spring_overlap, p->links);
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
    if (!p->connected || !dem_pack_links(p, state->balls, state->count, dem_pack_overlap, p->links))
        return false;
    for (int i = 0; i < ROUNDS; i++) {
        size_t open = dem_pack_links(p, state->balls, state->count, wanted, p->links);
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
        if (!dem_pack_links(p, state->balls, state->count, dem_pack_overlap, p->links))
            break;
        p->spring = true;
        DEM_TRY(dem_pack_relax(p, state, (dem_relax_options){15, 0.02, 0}, error));
        p->stiffness *= 2;
    }
    p->stiffness = stiffness;
    dem_pack_close(p, state, 0.5);
    return DEM_OK;
}
