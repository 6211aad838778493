#include "clump/pack_columns.h"

#include <stdlib.h>
#include <string.h>

typedef struct line_hit {
    int32_t i, j;
    float at;
    int32_t sign;     // +1 enters, -1 leaves
} line_hit;

typedef struct hit_list {
    line_hit *items;
    size_t count, capacity;
} hit_list;

typedef struct flat {
    double x, y, z;   // on the grid's two axes and along the lines
} flat;

static flat flatten(dem_vec3 p, int axis)
{
    return (flat){v3_get(p, (axis + 1) % 3), v3_get(p, (axis + 2) % 3), v3_get(p, axis)};
}

// which side of p -> q the point (x, y) lies on; the same to the last bit for q -> p but for the sign, and never 0,
// so that a line through a shared edge or corner meets exactly one of the triangles around it
static double side_of(flat p, flat q, double x, double y)
{
    bool swap = q.x < p.x || (q.x == p.x && q.y < p.y);
    flat a = swap ? q : p, b = swap ? p : q;
    double side = (b.x - a.x) * (y - a.y) - (b.y - a.y) * (x - a.x);
    if (side == 0)
        side = 1e-300;
    return swap ? -side : side;
}

// the part of the line y = const that the triangle covers, a little wider for the rounding
static void row_extent(const flat p[3], double y, double *low, double *high)
{
    *low = INFINITY;
    *high = -INFINITY;
    for (int k = 0; k < 3; k++) {
        flat a = p[k], b = p[(k + 1) % 3];
        if ((a.y > y && b.y > y) || (a.y < y && b.y < y))
            continue;
        double x = a.y == b.y ? b.x : a.x + (b.x - a.x) * ((y - a.y) / (b.y - a.y));
        double from = a.y == b.y ? a.x : x;
        *low = fmin(*low, fmin(x, from));
        *high = fmax(*high, fmax(x, from));
    }
    *low -= 1e-9 * (1 + fabs(*low));
    *high += 1e-9 * (1 + fabs(*high));
}

static bool meet(const dem_columns *c, const flat p[3], hit_list *hits)
{
    double turn = (p[1].x - p[0].x) * (p[2].y - p[0].y) - (p[2].x - p[0].x) * (p[1].y - p[0].y);
    if (turn == 0)
        return true;
    double low_y = fmin(p[0].y, fmin(p[1].y, p[2].y)), high_y = fmax(p[0].y, fmax(p[1].y, p[2].y));
    int32_t j0 = (int32_t)ceil((low_y - c->origin[1]) / c->step), j1 = (int32_t)floor((high_y - c->origin[1]) / c->step);
    for (int32_t j = j0; j <= j1; j++) {
        double y = c->origin[1] + j * c->step, low, high;
        row_extent(p, y, &low, &high);
        int32_t i1 = (int32_t)floor((high - c->origin[0]) / c->step);
        for (int32_t i = (int32_t)ceil((low - c->origin[0]) / c->step); i <= i1; i++) {
            double x = c->origin[0] + i * c->step;
            double w0 = side_of(p[1], p[2], x, y), w1 = side_of(p[2], p[0], x, y), w2 = side_of(p[0], p[1], x, y);
            if (!((w0 > 0 && w1 > 0 && w2 > 0) || (w0 < 0 && w1 < 0 && w2 < 0)))
                continue;
            double at = (w0 * p[0].z + w1 * p[1].z + w2 * p[2].z) / (w0 + w1 + w2);
            if (!dem_grow(&hits->items, &hits->capacity, hits->count, sizeof *hits->items))
                return false;
            // outward normals: a line enters where the triangle, seen along it, turns clockwise
            hits->items[hits->count++] = (line_hit){i, j, (float)at, w0 < 0 ? 1 : -1};
        }
    }
    return true;
}

// which lines of each row are kept: those within `reach` lines of one that meets the grain
static dem_status set_rows(dem_columns *c, const hit_list *hits, int32_t reach, dem_error *error)
{
    int32_t *low = dem_alloc((size_t)c->row_count, sizeof *low), *high = dem_alloc((size_t)c->row_count, sizeof *high);
    c->first = dem_alloc_zero((size_t)c->row_count, sizeof *c->first);
    c->line = dem_alloc_zero((size_t)c->row_count + 1, sizeof *c->line);
    if (!low || !high || !c->first || !c->line) {
        free(low);
        free(high);
        return dem_fail_memory(error);
    }
    for (int32_t j = 0; j < c->row_count; j++) {
        low[j] = INT32_MAX;
        high[j] = INT32_MIN;
    }
    for (size_t k = 0; k < hits->count; k++) {
        const line_hit *hit = &hits->items[k];
        low[hit->j] = hit->i < low[hit->j] ? hit->i : low[hit->j];
        high[hit->j] = hit->i > high[hit->j] ? hit->i : high[hit->j];
    }
    for (int32_t j = 0; j < c->row_count; j++) {
        int32_t from = INT32_MAX, to = INT32_MIN;
        for (int32_t k = j > reach ? j - reach : 0; k <= j + reach && k < c->row_count; k++) {
            from = low[k] < from ? low[k] : from;
            to = high[k] > to ? high[k] : to;
        }
        c->first[j] = from <= to ? from - reach : 0;
        c->line[j + 1] = c->line[j] + (from <= to ? (uint32_t)(to - from + 1 + 2 * reach) : 0);
    }
    free(low);
    free(high);
    return DEM_OK;
}

// the crossings of one line in ascending order; what is inside for more than one reason counts once
static uint32_t settle_line(line_hit *hits, uint32_t count, float *crossing)
{
    uint32_t kept = 0;
    int32_t winding = 0;
    for (uint32_t i = 1; i < count; i++)
        for (uint32_t k = i; k > 0 && hits[k].at < hits[k - 1].at; k--) {
            line_hit swap = hits[k];
            hits[k] = hits[k - 1];
            hits[k - 1] = swap;
        }
    for (uint32_t i = 0; i < count; i++) {
        int32_t next = winding + hits[i].sign;
        if ((winding == 0) != (next == 0))
            crossing[kept++] = hits[i].at;
        winding = next;
    }
    return kept - kept % 2;  // a line that leaks out of a surface not quite closed
}

static dem_status sort_hits(dem_columns *c, const hit_list *hits, dem_error *error)
{
    size_t lines = columns_lines(c);
    c->start = dem_alloc_zero(lines + 1, sizeof *c->start);
    c->crossing = dem_alloc(hits->count, sizeof *c->crossing);
    line_hit *sorted = dem_alloc(hits->count, sizeof *sorted);
    if (!c->start || !c->crossing || !sorted) {
        free(sorted);
        return dem_fail_memory(error);
    }
    for (size_t k = 0; k < hits->count; k++) {
        const line_hit *hit = &hits->items[k];
        c->start[c->line[hit->j] + (uint32_t)(hit->i - c->first[hit->j]) + 1]++;
    }
    for (size_t l = 0; l < lines; l++)
        c->start[l + 1] += c->start[l];
    for (size_t k = hits->count; k-- > 0;) {  // backwards, each line filled from its end
        const line_hit *hit = &hits->items[k];
        sorted[--c->start[c->line[hit->j] + (uint32_t)(hit->i - c->first[hit->j]) + 1]] = *hit;
    }
    // start[l + 1] now is where line l begins
    uint32_t kept = 0;
    for (size_t l = 0; l < lines; l++) {
        uint32_t from = c->start[l + 1], to = l + 1 < lines ? c->start[l + 2] : (uint32_t)hits->count;
        c->start[l] = kept;
        kept += settle_line(sorted + from, to - from, c->crossing + kept);
    }
    c->start[lines] = kept;
    free(sorted);
    return DEM_OK;
}

dem_status dem_columns_build(const dem_pack_grain *grain, int axis, double step, double margin, const double offset[2],
                             dem_columns *columns, dem_error *error)
{
    dem_columns *c = columns;
    hit_list hits = {0};
    dem_status status = DEM_OK;
    int32_t reach = (int32_t)ceil(margin / step);
    flat low = flatten(grain->box.low, axis), high = flatten(grain->box.high, axis);
    *c = (dem_columns){.axis = axis, .step = step};
    c->origin[0] = low.x - (reach + offset[0]) * step;
    c->origin[1] = low.y - (reach + offset[1]) * step;
    c->row_count = (int32_t)ceil((high.y - c->origin[1]) / step) + reach + 1;
    for (size_t t = 0; t < grain->mesh->triangle_count; t++) {
        dem_vec3 corners[3];
        dem_pack_grain_corners(grain, t, corners);
        flat p[3] = {flatten(corners[0], axis), flatten(corners[1], axis), flatten(corners[2], axis)};
        if (!meet(c, p, &hits)) {
            status = dem_fail_memory(error);
            goto done;
        }
    }
    status = set_rows(c, &hits, reach, error);
    if (status == DEM_OK)
        status = sort_hits(c, &hits, error);
done:
    free(hits.items);
    if (status != DEM_OK)
        dem_columns_release(c);
    return status;
}

void dem_columns_release(dem_columns *columns)
{
    free(columns->first);
    free(columns->line);
    free(columns->start);
    free(columns->crossing);
    *columns = (dem_columns){0};
}
