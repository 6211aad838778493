// Compiled once as it is (plain) and once per instruction set with DEM_KERNELS set to v3 or v4. On x86-64 the plain
// one is -v1; v2 adds nothing these loops could use.
#include "clump/pack_kernels.h"

#ifndef DEM_KERNELS
#define DEM_KERNELS plain
#endif
#define JOIN_(a, b) a##b
#define JOIN(a, b) JOIN_(a, b)
#define TEXT_(a) #a
#define TEXT(a) TEXT_(a)

static const float nowhere = 1e9f;

static void distances(const dem_ball_columns *balls, const dem_block_bound *bound, float *restrict distance,
                      float smallest[2])
{
    float first[DEM_LANES], second[DEM_LANES];
    float x = bound->x, y = bound->y, z = bound->z;
    for (int l = 0; l < DEM_LANES; l++)
        first[l] = second[l] = nowhere;
    for (size_t i = 0; i < balls->padded; i += DEM_LANES)
        for (int l = 0; l < DEM_LANES; l++) {
            float dx = balls->x[i + (size_t)l] - x, dy = balls->y[i + (size_t)l] - y, dz = balls->z[i + (size_t)l] - z;
            float d = sqrtf(dx * dx + dy * dy + dz * dz) - balls->r[i + (size_t)l];
            float other = d < first[l] ? first[l] : d;
            distance[i + (size_t)l] = d;
            first[l] = d < first[l] ? d : first[l];
            second[l] = other < second[l] ? other : second[l];
        }
    smallest[0] = smallest[1] = nowhere;
    for (int l = 0; l < DEM_LANES; l++) {
        float other = first[l] < smallest[0] ? smallest[0] : first[l];
        smallest[0] = first[l] < smallest[0] ? first[l] : smallest[0];
        smallest[1] = other < smallest[1] ? other : smallest[1];
        smallest[1] = second[l] < smallest[1] ? second[l] : smallest[1];
    }
}

static void nearest(const dem_sample_block *restrict block, const dem_ball_columns *balls, const uint32_t *list,
                    size_t count, float *restrict f, int32_t *restrict owner)
{
    float best[DEM_BLOCK];
    int32_t who[DEM_BLOCK];
    for (int l = 0; l < DEM_BLOCK; l++) {
        best[l] = nowhere;
        who[l] = -1;
    }
    for (size_t k = 0; k < count; k++) {
        uint32_t i = list[k];
        int32_t id = (int32_t)i;
        float x = balls->x[i], y = balls->y[i], z = balls->z[i], r = balls->r[i];
        for (int l = 0; l < DEM_BLOCK; l++) {
            float dx = block->x[l] - x, dy = block->y[l] - y, dz = block->z[l] - z;
            float d = sqrtf(dx * dx + dy * dy + dz * dz) - r;
            who[l] = d < best[l] ? id : who[l];
            best[l] = d < best[l] ? d : best[l];
        }
    }
    for (int l = 0; l < DEM_BLOCK; l++) {
        f[l] = best[l];
        owner[l] = who[l];
    }
}

static void nearest_two(const dem_sample_block *restrict block, const dem_ball_columns *balls, const uint32_t *list,
                        size_t count, float *restrict f, int32_t *restrict owner, float *restrict second)
{
    for (int l = 0; l < DEM_BLOCK; l++) {
        f[l] = second[l] = nowhere;
        owner[l] = -1;
    }
    for (size_t k = 0; k < count; k++) {
        uint32_t i = list[k];
        int32_t id = (int32_t)i;
        float x = balls->x[i], y = balls->y[i], z = balls->z[i], r = balls->r[i];
        for (int l = 0; l < DEM_BLOCK; l++) {
            float dx = block->x[l] - x, dy = block->y[l] - y, dz = block->z[l] - z;
            float d = sqrtf(dx * dx + dy * dy + dz * dz) - r;
            float other = d < f[l] ? f[l] : d;
            owner[l] = d < f[l] ? id : owner[l];
            f[l] = d < f[l] ? d : f[l];
            second[l] = other < second[l] ? other : second[l];
        }
    }
}

// lanes are halved until one is left: the same order everywhere
static float total(float lane[DEM_LANES])
{
    for (int half = DEM_LANES / 2; half > 0; half /= 2)
        for (int l = 0; l < half; l++)
            lane[l] += lane[l + half];
    return lane[0];
}

// v^(p/2) for v = f^2 + softening
static inline float power(float v, bool linear)
{
    float s = sqrtf(v);
    return linear ? s : s * sqrtf(sqrtf(s));
}

// weight of the square of f > 0 of an interior sample: a void costs as much as a surface gap of the same depth
static const float interior_weight = 120;

static void charges(const dem_sample_block *restrict block, const float *restrict f, const dem_charge *charge,
                    float *restrict out)
{
    float softening = charge->softening, inside = charge->inside, outside = charge->outside;
    if (charge->interior)
        for (int l = 0; l < DEM_BLOCK; l++) {
            float depth = f[l] > 0 ? f[l] : 0;
            out[l] = interior_weight * block->weight[l] * depth * depth;
        }
    else if (charge->linear)
        for (int l = 0; l < DEM_BLOCK; l++)
            out[l] = block->weight[l] * (f[l] < 0 ? inside : outside) * power(f[l] * f[l] + softening, true);
    else
        for (int l = 0; l < DEM_BLOCK; l++)
            out[l] = block->weight[l] * (f[l] < 0 ? inside : outside) * power(f[l] * f[l] + softening, false);
}

static float energy(const dem_sample_block *block, const float *f, const dem_charge *charge)
{
    float each[DEM_BLOCK], lane[DEM_LANES];
    charges(block, f, charge, each);
    for (int l = 0; l < DEM_LANES; l++)
        lane[l] = each[l] + each[l + DEM_LANES];
    return total(lane);
}

static bool with_ball(const dem_sample_block *restrict block, const float ball[4], const float *restrict f,
                      float *restrict with)
{
    float x = ball[0], y = ball[1], z = ball[2], r = ball[3];
    int32_t nearer = 0;
    for (int l = 0; l < DEM_BLOCK; l++) {
        float dx = block->x[l] - x, dy = block->y[l] - y, dz = block->z[l] - z;
        float d = sqrtf(dx * dx + dy * dy + dz * dz) - r;
        nearer |= d < f[l];
        with[l] = d < f[l] ? d : f[l];
    }
    return nearer;
}

// iteratively reweighted least squares: the derivative of the charge divided by f
static void weigh(const dem_sample_block *restrict block, const float *restrict f, const dem_charge *charge,
                  float *restrict weight)
{
    float softening = charge->softening, inside = charge->inside, outside = charge->outside;
    if (charge->interior) {
        for (int l = 0; l < DEM_BLOCK; l++)
            weight[l] = f[l] > 0 ? 2 * interior_weight * block->weight[l] : 0;
    } else if (charge->linear) {
        for (int l = 0; l < DEM_BLOCK; l++)
            weight[l] = block->weight[l] * (f[l] < 0 ? inside : outside) / sqrtf(f[l] * f[l] + softening);
    } else {
        for (int l = 0; l < DEM_BLOCK; l++) {
            float v = f[l] * f[l] + softening;
            weight[l] = 1.25f * block->weight[l] * (f[l] < 0 ? inside : outside) * power(v, false) / v;
        }
    }
}

// for each owner the products of (n, -1) with itself and with f, n the direction from sample to centre
static void equations(const dem_sample_block *restrict block, const dem_ball_columns *balls, const float *restrict f,
                      const int32_t *restrict owner, const dem_charge *charge, const uint32_t *owners,
                      size_t owner_count, dem_equation_lanes *const *slots)
{
    float weight[DEM_BLOCK];
    weigh(block, f, charge, weight);
    for (size_t k = 0; k < owner_count; k++) {
        uint32_t i = owners[k];
        int32_t id = (int32_t)i;
        float x = balls->x[i], y = balls->y[i], z = balls->z[i];
        float(*restrict sum)[DEM_LANES] = slots[k]->sum;
        for (int half = 0; half < DEM_BLOCK; half += DEM_LANES)
            for (int l = 0; l < DEM_LANES; l++) {
                int m = half + l;
                float dx = x - block->x[m], dy = y - block->y[m], dz = z - block->z[m];
                float s = 1 / (sqrtf(dx * dx + dy * dy + dz * dz) + 1e-9f);
                float w = owner[m] == id ? weight[m] : 0;
                dx *= s;
                dy *= s;
                dz *= s;
                float wx = w * dx, wy = w * dy, wz = w * dz, g = f[m];
                sum[0][l] += wx * dx;
                sum[1][l] += wx * dy;
                sum[2][l] += wx * dz;
                sum[3][l] -= wx;
                sum[4][l] += wy * dy;
                sum[5][l] += wy * dz;
                sum[6][l] -= wy;
                sum[7][l] += wz * dz;
                sum[8][l] -= wz;
                sum[9][l] += w;
                sum[10][l] += wx * g;
                sum[11][l] += wy * g;
                sum[12][l] += wz * g;
                sum[13][l] -= w * g;
            }
    }
}

// the balls that a row of lines meets
static size_t row_balls(const dem_ball_columns *balls, const dem_line_task *task, int32_t row)
{
    const dem_line_field *field = task->field;
    const float *axes[3] = {balls->x, balls->y, balls->z};
    const float *u = axes[(field->axis + 1) % 3], *v = axes[(field->axis + 2) % 3], *w = axes[field->axis];
    float y = field->origin[1] + (float)row * field->step;
    float x = field->origin[0] + (float)field->first[row] * field->step, per_strip = 1 / (field->step * DEM_LINE_LANES);
    int32_t strips = (int32_t)(field->strip[row + 1] - field->strip[row]);
    size_t count = 0;
    for (size_t i = 0; i < balls->count; i++) {
        float off = y - v[i], reach2 = balls->r[i] * balls->r[i] - off * off;
        if (reach2 <= 0)
            continue;
        float reach = sqrtf(reach2), from = (u[i] - reach - x) * per_strip, to = (u[i] + reach - x) * per_strip;
        if (to < 0 || from >= (float)strips)
            continue;
        int32_t first = from > 0 ? (int32_t)from : 0, last = to < (float)strips ? (int32_t)to : strips - 1;
        task->active[count++] = (dem_line_ball){u[i], w[i], reach2, off, first, last, (uint32_t)i};
    }
    return count;
}

// the interval of one ball on each line of a strip; empty ones are inside out and far away
static void strip_ends(const dem_line_ball *ball, float x, float step, float *restrict from, float *restrict to)
{
    float u = ball->u, w = ball->w, reach2 = ball->reach2;
    for (int l = 0; l < DEM_LINE_LANES; l++) {
        float off = x + (float)l * step - u, rest = reach2 - off * off;
        float half = sqrtf(rest > 0 ? rest : 0);
        from[l] = rest > 0 ? w - half : nowhere;
        to[l] = rest > 0 ? w + half : -nowhere;
    }
}

/// Which ends of a ball's intervals are exposed, as 1 and 0.
typedef struct strip_exposed {
    float from[DEM_LINE_LANES], to[DEM_LINE_LANES];
} strip_exposed;

// An end is exposed where it lies in no other ball; of two ends in the same place that of the later ball.
static bool strip_expose(const dem_line_task *task, size_t count, size_t k, strip_exposed *restrict exposed)
{
    int32_t hidden_from[DEM_LINE_LANES], hidden_to[DEM_LINE_LANES];
    const float *restrict from = task->from[k], *restrict to = task->to[k];
    for (int l = 0; l < DEM_LINE_LANES; l++)
        hidden_from[l] = hidden_to[l] = to[l] < from[l];
    for (size_t j = 0; j < k; j++) {
        const float *restrict low = task->from[j], *restrict high = task->to[j];
        for (int l = 0; l < DEM_LINE_LANES; l++) {
            hidden_from[l] |= (low[l] < from[l]) & (from[l] <= high[l]);
            hidden_to[l] |= (low[l] <= to[l]) & (to[l] < high[l]);
        }
    }
    for (size_t j = k + 1; j < count; j++) {
        const float *restrict low = task->from[j], *restrict high = task->to[j];
        for (int l = 0; l < DEM_LINE_LANES; l++) {
            hidden_from[l] |= (low[l] <= from[l]) & (from[l] <= high[l]);
            hidden_to[l] |= (low[l] <= to[l]) & (to[l] <= high[l]);
        }
    }
    int32_t any = 0;
    for (int l = 0; l < DEM_LINE_LANES; l++) {
        exposed->from[l] = hidden_from[l] ? 0.0f : 1.0f;
        exposed->to[l] = hidden_to[l] ? 0.0f : 1.0f;
    }
    for (int l = 0; l < DEM_LINE_LANES; l++)
        any |= !(hidden_from[l] & hidden_to[l]);
    return any;
}

typedef struct strip_sums {
    float covered[DEM_LINE_LANES], common[DEM_LINE_LANES];
} strip_sums;

/// Ends against the grain: the length of the line inside it before the end, and whether the end itself is.
typedef struct strip_inside {
    float before[DEM_LINE_LANES], inside[DEM_LINE_LANES];
} strip_inside;

static void compare_spans(const dem_line_field *field, uint32_t strip, const float *restrict end,
                          strip_inside *restrict result)
{
    for (int l = 0; l < DEM_LINE_LANES; l++)
        result->before[l] = result->inside[l] = 0;
    for (uint32_t s = field->span[strip]; s < field->span[strip + 1]; s++) {
        const float *restrict enter = field->spans[s][0], *restrict leave = field->spans[s][1];
        for (int l = 0; l < DEM_LINE_LANES; l++) {
            float z = end[l], up = z > enter[l] ? z : enter[l];
            up = up < leave[l] ? up : leave[l];
            result->before[l] += up - enter[l];
            result->inside[l] += ((z > enter[l]) & (z < leave[l])) ? 1.0f : 0.0f;
        }
    }
}

// what one ball's exposed ends on a strip add
static void add_ends(const dem_line_task *task, uint32_t strip, float x, const dem_line_ball *ball, size_t k,
                     const strip_exposed *restrict exposed, strip_sums *restrict sums)
{
    const float *restrict from = task->from[k], *restrict to = task->to[k];
    float step = task->field->step, u = ball->u, v = ball->v;
    strip_inside low, high;
    compare_spans(task->field, strip, from, &low);
    compare_spans(task->field, strip, to, &high);
    for (int l = 0; l < DEM_LINE_LANES; l++) {
        sums->covered[l] += exposed->to[l] * to[l] - exposed->from[l] * from[l];
        sums->common[l] += exposed->to[l] * high.before[l] - exposed->from[l] * low.before[l];
    }
    if (!task->lanes)
        return;
    dem_line_lanes *restrict lanes = &task->lanes[ball->ball];
    for (int l = 0; l < DEM_LINE_LANES; l++) {
        float off = x + (float)l * step - u, half = (to[l] - from[l]) * 0.5f;
        float a = exposed->from[l] * (1 - 2 * low.inside[l]), b = exposed->to[l] * (1 - 2 * high.inside[l]);
        float both = (a + b) * half;
        lanes->radial[l] += both;
        lanes->across[0][l] += both * off;
        lanes->across[1][l] += both * v;
        lanes->along[l] += (b - a) * half * half;
    }
}

static void lines(const dem_ball_columns *balls, dem_line_task *task)
{
    const dem_line_field *field = task->field;
    double covered = 0, common = 0;
    for (int32_t row = task->begin; row < task->end; row++) {
        size_t count = row_balls(balls, task, row);
        strip_sums sums = {{0}, {0}};
        uint32_t strips = field->strip[row + 1] - field->strip[row];
        for (uint32_t s = 0; s < strips && count; s++) {
            float x = field->origin[0] + (float)(field->first[row] + (int32_t)s * DEM_LINE_LANES) * field->step;
            size_t here = 0;
            for (uint32_t k = 0; k < count; k++)
                if (task->active[k].first <= (int32_t)s && (int32_t)s <= task->active[k].last)
                    task->strip_balls[here++] = k;
            for (size_t k = 0; k < here; k++)
                strip_ends(&task->active[task->strip_balls[k]], x, field->step, task->from[k], task->to[k]);
            for (size_t k = 0; k < here; k++) {
                strip_exposed exposed;
                if (strip_expose(task, here, k, &exposed))
                    add_ends(task, field->strip[row] + s, x, &task->active[task->strip_balls[k]], k, &exposed, &sums);
            }
        }
        for (int l = 0; l < DEM_LINE_LANES; l++) {
            covered += (double)sums.covered[l];
            common += (double)sums.common[l];
        }
    }
    task->covered = covered;
    task->common = common;
}

static bool usable(void)
{
#if defined(__AVX512F__) && defined(__AVX512BW__)
    return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
           __builtin_cpu_supports("avx512cd") && __builtin_cpu_supports("avx512dq") &&
           __builtin_cpu_supports("avx512vl");
#elif defined(__AVX2__)
    return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") && __builtin_cpu_supports("bmi") &&
           __builtin_cpu_supports("bmi2") && __builtin_cpu_supports("popcnt");
#else
    return true;
#endif
}

const dem_pack_kernels JOIN(dem_pack_kernels_, DEM_KERNELS) = {
    .name = TEXT(DEM_KERNELS),
    .usable = usable,
    .distances = distances,
    .nearest = nearest,
    .nearest_two = nearest_two,
    .charges = charges,
    .energy = energy,
    .with_ball = with_ball,
    .equations = equations,
    .lines = lines,
};
