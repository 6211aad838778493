/// Culling in 32 bits, for kernels.c: sphere pairs of two near bodies, and bodies near a body.
///
/// Along a direction n, only spheres of a that reach as high as the lowest of b less the margin, and of b as low as the
/// highest of a plus it, can make a pair. The direction of the nearest pair of last time leaves few of them.
#ifndef DEM_SIM_SLAB_H
#define DEM_SIM_SLAB_H

#include "sim/kernels.h"

static const float FAR_AWAY = 1e30f;

// heights of the near ends of the spheres along n (sign -1: of the far side's, from below), and their extreme
DEM_INLINE float heights(const dem_cull_side *side, const float n[3], float offset, const bool lower, float *height)
{
    // n in the frame of the shape, with the scale
    const float *m = side->axes;
    widef nx = widef_all(m[0] * n[0] + m[3] * n[1] + m[6] * n[2]),
          ny = widef_all(m[1] * n[0] + m[4] * n[1] + m[7] * n[2]);
    widef nz = widef_all(m[2] * n[0] + m[5] * n[1] + m[8] * n[2]), scale = widef_all(side->scale),
          at = widef_all(offset);
    widef extreme = widef_all(lower ? FAR_AWAY : -FAR_AWAY);
    for (size_t i = 0; i < side->padded; i += DEM_WIDTH_FLOAT) {
        widef along = nx * widef_load(side->x + i) + ny * widef_load(side->y + i) + nz * widef_load(side->z + i) + at;
        widef r = scale * widef_load(side->r + i);
        widef h = lower ? along - r : along + r;
        widef_store(height + i, h);
        extreme = lower ? widef_min(extreme, h) : widef_max(extreme, h);
    }
    return lower ? widef_lowest(extreme) : widef_highest(extreme);
}

typedef struct placed_spheres {
    float *x, *y, *z, *r;
    uint32_t *index;
    size_t count;
} placed_spheres;

// the spheres of b that are low enough, placed with respect to the centre of a
DEM_INLINE void low_spheres(const dem_cull_job *job, const float *height, float most, placed_spheres *out)
{
    const dem_cull_side *b = &job->b;
    const float *m = b->axes;
    out->count = 0;
    for (size_t i = 0; i < b->padded; i += DEM_WIDTH_FLOAT) {
        uint32_t bits = widef_bits(widef_below(widef_load(height + i), widef_all(most)));
        if (!bits)
            continue;
        widef x = widef_load(b->x + i), y = widef_load(b->y + i), z = widef_load(b->z + i);
        size_t at = out->count;
        widef_pack(out->x + at, bits,
                   widef_all(m[0]) * x + widef_all(m[1]) * y + widef_all(m[2]) * z + widef_all(job->offset[0]));
        widef_pack(out->y + at, bits,
                   widef_all(m[3]) * x + widef_all(m[4]) * y + widef_all(m[5]) * z + widef_all(job->offset[1]));
        widef_pack(out->z + at, bits,
                   widef_all(m[6]) * x + widef_all(m[7]) * y + widef_all(m[8]) * z + widef_all(job->offset[2]));
        widef_pack(out->r + at, bits, widef_all(b->scale) * widef_load(b->r + i));
        indices_pack(out->index + at, bits, (uint32_t)i);
        out->count += (size_t)__builtin_popcount(bits);
    }
}

typedef struct nearest_pair {
    float gap;
    float from[3], to[3];
} nearest_pair;

// one sphere of a against those of b
DEM_INLINE void compare_sphere(dem_cull_job *job, uint32_t sphere, const placed_spheres *b, float margin,
                               nearest_pair *nearest)
{
    const float *m = job->a.axes;
    float x = job->a.x[sphere], y = job->a.y[sphere], z = job->a.z[sphere], r = job->a.scale * job->a.r[sphere];
    float px = m[0] * x + m[1] * y + m[2] * z, py = m[3] * x + m[4] * y + m[5] * z, pz = m[6] * x + m[7] * y + m[8] * z;
    for (size_t j = 0; j < b->count; j += DEM_WIDTH_FLOAT) {
        widef dx = widef_load(b->x + j) - widef_all(px), dy = widef_load(b->y + j) - widef_all(py);
        widef dz = widef_load(b->z + j) - widef_all(pz);
        widef gap = widef_sqrt(dx * dx + dy * dy + dz * dz) - widef_load(b->r + j) - widef_all(r);
        uint32_t better = first_lanes(widef_below(gap, widef_all(nearest->gap)), b->count - j);
        uint32_t near = first_lanes(widef_below(gap, widef_all(margin)), b->count - j);
        if (better) {
            float lane[DEM_WIDTH_FLOAT];
            widef_store(lane, gap);
            for (; better; better &= better - 1) {
                size_t k = (size_t)__builtin_ctz(better);
                if (lane[k] < nearest->gap)
                    *nearest = (nearest_pair){lane[k], {px, py, pz}, {b->x[j + k], b->y[j + k], b->z[j + k]}};
            }
        }
        for (; near; near &= near - 1) {
            if (job->count < job->capacity) {
                job->pairs[2 * job->count] = sphere;
                job->pairs[2 * job->count + 1] = b->index[j + (size_t)__builtin_ctz(near)];
            }
            job->count++;
        }
    }
}

DEM_INLINE void cull_pair(dem_cull_job *job)
{
    float *height_a = job->work, *height_b = height_a + job->a.padded, *place = height_b + job->b.padded;
    size_t room = job->b.padded + DEM_WIDTH_FLOAT;
    const float *n = job->normal;
    float offset = job->offset[0] * n[0] + job->offset[1] * n[1] + job->offset[2] * n[2];
    float top = heights(&job->a, n, 0, false, height_a), bottom = heights(&job->b, n, offset, true, height_b);
    float margin = job->margin * 1.0001f + job->error;
    job->count = 0;
    if (bottom - top > margin) {
        job->gap = bottom - top - job->error;
        return;
    }
    placed_spheres b = {place, place + room, place + 2 * room, place + 3 * room, (uint32_t *)(place + 4 * room), 0};
    low_spheres(job, height_b, top + margin, &b);
    nearest_pair nearest = {.gap = FAR_AWAY};
    for (size_t i = 0; i < job->a.padded; i += DEM_WIDTH_FLOAT) {
        uint32_t bits = widef_bits(widef_below(widef_all(bottom - margin), widef_load(height_a + i)));
        for (; bits; bits &= bits - 1)
            compare_sphere(job, (uint32_t)i + (uint32_t)__builtin_ctz(bits), &b, margin, &nearest);
    }
    job->gap = nearest.gap > margin ? job->margin : 0;
    if (nearest.gap < FAR_AWAY) {
        float d[3], size2 = 0;
        for (int k = 0; k < 3; k++) {
            d[k] = nearest.to[k] - nearest.from[k];
            size2 += d[k] * d[k];
        }
        for (int k = 0; k < 3 && size2 > 0; k++)
            job->normal[k] = d[k] / sqrtf(size2);
    }
}

DEM_INLINE void scan_cells(dem_scan_job *job)
{
    widef x = widef_all(job->centre[0]), y = widef_all(job->centre[1]), z = widef_all(job->centre[2]);
    widef reach = widef_all(job->reach);
    for (size_t i = job->begin; i < job->end; i += DEM_WIDTH_FLOAT) {
        widef dx = widef_load(job->x + i) - x, dy = widef_load(job->y + i) - y, dz = widef_load(job->z + i) - z;
        widef far = widef_load(job->r + i) + reach;
        uint32_t bits = first_lanes(widef_below(dx * dx + dy * dy + dz * dz, far * far), job->end - i);
        for (; bits; bits &= bits - 1)
            job->found[job->count++] = job->id[i + (size_t)__builtin_ctz(bits)];
    }
}

#endif
