#include "clump/pack_connect.h"

#include "base/status.h"

size_t dem_pack_links(dem_packing *p, const dem_ball *balls, size_t count, double overlap, dem_link *links)
{
    double *gap = p->link_gap;
    uint32_t *nearest = p->link_nearest;   // in the tree, for each ball that is not
    uint32_t *left = p->order;             // balls not in the tree
    size_t open = 0, left_count = 0;
    for (uint32_t i = 1; i < count; i++) {
        left[left_count++] = i;
        gap[i] = INFINITY;
    }
    // minimum spanning tree (Prim 1957)
    for (uint32_t joined = 0; left_count > 0;) {
        size_t best = 0;
        for (size_t k = 0; k < left_count; k++) {
            uint32_t i = left[k];
            double d = v3_distance(balls[i].centre, balls[joined].centre) - balls[i].radius - balls[joined].radius;
            if (d < gap[i]) {
                gap[i] = d;
                nearest[i] = joined;
            }
            if (gap[i] < gap[left[best]])
                best = k;
        }
        joined = left[best];
        left[best] = left[--left_count];
        if (gap[joined] + overlap > 0)
            links[open++] = (dem_link){joined, nearest[joined], gap[joined] + overlap};
    }
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

// both balls of a link move towards each other and grow until they overlap; the smaller one does more
static void close_link(dem_pack_state *state, const dem_link *link)
{
    dem_ball *a = &state->balls[link->i], *b = &state->balls[link->j];
    dem_vec3 d = v3_unit(v3_sub(b->centre, a->centre));
    double gap = link->gap, share = b->radius / (a->radius + b->radius);
    a->centre = v3_along(a->centre, gap * share / 2, d);
    b->centre = v3_along(b->centre, -gap * (1 - share) / 2, d);
    a->radius += gap * share / 2;
    b->radius += gap * (1 - share) / 2;
}

bool dem_pack_close(dem_packing *p, dem_pack_state *state)
{
    enum { ROUNDS = 20 };
    if (!p->connected || !dem_pack_links(p, state->balls, state->count, dem_pack_overlap, p->links))
        return false;
    for (int i = 0; i < ROUNDS; i++) {
        size_t open = dem_pack_links(p, state->balls, state->count, (dem_pack_overlap + dem_pack_spring_overlap) / 2, p->links);
        for (size_t k = 0; k < open; k++)
            close_link(state, &p->links[k]);
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
    dem_pack_close(p, state);
    return DEM_OK;
}
