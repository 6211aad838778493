// Compiled once as it is (plain) and once per instruction set with DEM_KERNELS set to v3 or v4. On x86-64 the plain
// one is -v1; v2 adds nothing these loops could use.
#include "clump/pack_kernels.h"

#include "base/level.h"
#include "base/simd.h"

enum { WIDTH = DEM_WIDTH_FLOAT, PARTS = DEM_BLOCK / WIDTH };  // of the samples of a block, taken together

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

// Which balls can be nearest or second nearest to a sample of a block of radius R about b: with t_i the distance of b
// to ball i, those with t_i <= (second smallest t) + 2 R.
static float near_limit(const dem_ball_columns *balls, const float smallest[2], const dem_block_bound *bound,
                        float slack)
{
    return (balls->count > 1 ? smallest[1] : smallest[0]) + 2 * bound->radius + slack;
}

static uint32_t lanes_within(const float *distance, float limit)
{
    uint32_t within = 0;
    for (int l = 0; l < DEM_LANES; l += WIDTH)
        within |= widef_bits(widef_up_to(widef_load(distance + l), widef_all(limit))) << l;
    return within;
}

static void gather_near(const dem_ball_columns *balls, const dem_block_bound *bound, float slack,
                        const dem_near_work *work, dem_ball_columns *some, uint32_t *restrict ids)
{
    float smallest[2], *restrict distance = work->distance;
    size_t count = 0;
    distances(balls, bound, distance, smallest);
    float limit = near_limit(balls, smallest, bound, slack);
    for (size_t i = 0; i < balls->padded; i += DEM_LANES)
        for (uint32_t within = lanes_within(distance + i, limit); within; within &= within - 1)
            ids[count++] = (uint32_t)i + (uint32_t)__builtin_ctz(within);
    some->count = count;
    some->padded = (count + DEM_LANES - 1) / DEM_LANES * DEM_LANES;
    for (size_t k = 0; k < some->padded; k++) {
        bool is = k < count;
        some->x[k] = is ? balls->x[ids[k]] : nowhere;
        some->y[k] = is ? balls->y[ids[k]] : nowhere;
        some->z[k] = is ? balls->z[ids[k]] : nowhere;
        some->r[k] = is ? balls->r[ids[k]] : 0;
    }
}

// Those balls are put into buckets by t, nearest first: few of them are looked at before no other one can be nearer.
static size_t list_near(const dem_ball_columns *balls, const dem_block_bound *bound, float slack,
                        const dem_near_work *work, uint32_t *restrict list, float *restrict least)
{
    enum { BUCKETS = 32 };
    float smallest[2], *restrict distance = work->distance;
    uint32_t *restrict found = work->found, *restrict bucket = work->bucket, begin[BUCKETS + 1] = {0};
    size_t count = 0;
    distances(balls, bound, distance, smallest);
    float limit = near_limit(balls, smallest, bound, slack);
    float per_bucket = BUCKETS / (limit - smallest[0]);
    for (size_t i = 0; i < balls->padded; i += DEM_LANES)
        for (uint32_t within = lanes_within(distance + i, limit); within; within &= within - 1) {
            uint32_t ball = (uint32_t)i + (uint32_t)__builtin_ctz(within);
            int32_t k = (int32_t)((distance[ball] - smallest[0]) * per_bucket);
            bucket[count] = k < BUCKETS ? (uint32_t)k : BUCKETS - 1;
            begin[bucket[count] + 1]++;
            found[count++] = ball;
        }
    for (int k = 0; k < BUCKETS; k++)
        begin[k + 1] += begin[k];
    for (size_t k = 0; k < count; k++) {
        uint32_t at = begin[bucket[k]]++;
        list[at] = found[k];
        least[at] = distance[found[k]];
    }
    for (size_t k = count; k-- > 1;)
        least[k - 1] = least[k] < least[k - 1] ? least[k] : least[k - 1];
    return count;
}

DEM_INLINE bool any_above(const widef *a, float limit)
{
    uint32_t any = 0;
    for (int p = 0; p < PARTS; p++)
        any |= widef_bits(widef_below(widef_all(limit), a[p]));
    return any;
}

// distances of some samples of a block to the surface of ball i
DEM_INLINE widef distance_to(const dem_sample_block *block, const dem_ball_columns *balls, uint32_t i, int part)
{
    widef dx = widef_load(block->x + part * WIDTH) - widef_all(balls->x[i]);
    widef dy = widef_load(block->y + part * WIDTH) - widef_all(balls->y[i]);
    widef dz = widef_load(block->z + part * WIDTH) - widef_all(balls->z[i]);
    return widef_sqrt(dx * dx + dy * dy + dz * dz) - widef_all(balls->r[i]);
}

// a ball's number goes through the lanes as a float: there are fewer of them than 2^24
static void store_nearest(const widef *best, const widef *who, float *f, int32_t *owner)
{
    float number[DEM_BLOCK];
    for (int p = 0; p < PARTS; p++) {
        widef_store(f + p * WIDTH, best[p]);
        widef_store(number + p * WIDTH, who[p]);
    }
    for (int l = 0; l < DEM_BLOCK; l++)
        owner[l] = (int32_t)number[l];
}

static void nearest(const dem_sample_block *block, const dem_ball_columns *balls, const dem_near_list *near, float *f,
                    int32_t *owner)
{
    widef best[PARTS], who[PARTS];
    for (int p = 0; p < PARTS; p++) {
        best[p] = widef_all(nowhere);
        who[p] = widef_all(-1);
    }
    for (size_t k = 0; k < near->count; k++) {
        float farther = near->least[k] - near->reach, limit = farther > near->enough ? farther : near->enough;
        if (k > 0 && !any_above(best, limit))
            break;
        uint32_t i = near->list[k];
        widef id = widef_all((float)i);
        for (int p = 0; p < PARTS; p++) {
            widef d = distance_to(block, balls, i, p);
            who[p] = widef_select(widef_below(d, best[p]), id, who[p]);
            best[p] = widef_min(d, best[p]);
        }
    }
    store_nearest(best, who, f, owner);
}

static void nearest_two(const dem_sample_block *block, const dem_ball_columns *balls, const dem_near_list *near,
                        float *f, int32_t *owner, float *second)
{
    widef best[PARTS], other[PARTS], who[PARTS];
    for (int p = 0; p < PARTS; p++) {
        best[p] = other[p] = widef_all(nowhere);
        who[p] = widef_all(-1);
    }
    for (size_t k = 0; k < near->count; k++) {
        float farther = near->least[k] - near->reach, limit = farther > near->enough ? farther : near->enough;
        if (k > 1 && !any_above(other, limit))
            break;
        uint32_t i = near->list[k];
        widef id = widef_all((float)i);
        for (int p = 0; p < PARTS; p++) {
            widef d = distance_to(block, balls, i, p);
            widef_mask nearer = widef_below(d, best[p]);
            other[p] = widef_min(widef_select(nearer, best[p], d), other[p]);
            who[p] = widef_select(nearer, id, who[p]);
            best[p] = widef_min(d, best[p]);
        }
    }
    store_nearest(best, who, f, owner);
    for (int p = 0; p < PARTS; p++)
        widef_store(second + p * WIDTH, other[p]);
}

static size_t owners_of(const int32_t *restrict owner, uint32_t *restrict owners)
{
    uint32_t left = ~(uint32_t)0;
    size_t count = 0;
    while (left) {
        int32_t id = owner[__builtin_ctz(left)];
        uint32_t same = 0;
        for (int l = 0; l < DEM_BLOCK; l++)
            same |= (uint32_t)(owner[l] == id) << l;
        owners[count++] = (uint32_t)id;
        left &= ~same;
    }
    return count;
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

static bool with_ball(const dem_sample_block *block, const float ball[4], const float *f, float *with)
{
    float one[4] = {ball[0], ball[1], ball[2], ball[3]};
    dem_ball_columns columns = {one, one + 1, one + 2, one + 3, 1, 1};
    uint32_t nearer = 0;
    for (int p = 0; p < PARTS; p++) {
        widef d = distance_to(block, &columns, 0, p), old = widef_load(f + p * WIDTH);
        nearer |= widef_bits(widef_below(d, old));
        widef_store(with + p * WIDTH, widef_min(d, old));
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

static int32_t approach(const dem_ball_columns *balls, uint32_t joined, float *restrict reach,
                        int32_t *restrict nearest)
{
    float least[DEM_LANES], x = balls->x[joined], y = balls->y[joined], z = balls->z[joined], r = balls->r[joined];
    int32_t who[DEM_LANES], id = (int32_t)joined, best = -1;
    for (int l = 0; l < DEM_LANES; l++) {
        least[l] = nowhere;
        who[l] = -1;
    }
    for (size_t i = 0; i < balls->padded; i += DEM_LANES) {
        const float *restrict bx = balls->x + i, *restrict by = balls->y + i, *restrict bz = balls->z + i;
        const float *restrict br = balls->r + i;
        float *restrict best_of = reach + i;
        int32_t *restrict from = nearest + i, first = (int32_t)i;
        for (int l = 0; l < DEM_LANES; l++) {
            float dx = bx[l] - x, dy = by[l] - y, dz = bz[l] - z;
            float gap = sqrtf(dx * dx + dy * dy + dz * dz) - br[l] - r;
            from[l] = gap < best_of[l] ? id : from[l];
            best_of[l] = gap < best_of[l] ? gap : best_of[l];
            float open = best_of[l] > -nowhere ? best_of[l] : nowhere;
            who[l] = open < least[l] ? first + l : who[l];
            least[l] = open < least[l] ? open : least[l];
        }
    }
    float smallest = nowhere;
    for (int l = 0; l < DEM_LANES; l++)
        if (least[l] < smallest || (least[l] == smallest && who[l] >= 0 && who[l] < best)) {
            smallest = least[l];
            best = who[l];
        }
    return best;
}

// with e = p - s of a point s: |s - centre|^2 = r^2 - d, where d = 2 r n.e - e.e
static bool deepest(const dem_point_columns *points, const float p[3], const float n[3], float two_r, float least,
                    float *radius)
{
    float depth[DEM_LANES], square[DEM_LANES], height[DEM_LANES], px = p[0], py = p[1], pz = p[2];
    float nx = n[0], ny = n[1], nz = n[2];
    for (int l = 0; l < DEM_LANES; l++) {
        depth[l] = least;
        square[l] = height[l] = 0;
    }
    for (size_t k = 0; k < points->count; k += DEM_LANES) {
        const float *restrict x = points->x + k, *restrict y = points->y + k, *restrict z = points->z + k;
        for (int l = 0; l < DEM_LANES; l++) {
            float ex = px - x[l], ey = py - y[l], ez = pz - z[l], e2 = ex * ex + ey * ey + ez * ez;
            float low = ex * nx + ey * ny + ez * nz, d = two_r * low - e2;
            square[l] = d > depth[l] ? e2 : square[l];
            height[l] = d > depth[l] ? low : height[l];
            depth[l] = d > depth[l] ? d : depth[l];
        }
    }
    int at = 0;
    for (int l = 1; l < DEM_LANES; l++)
        at = depth[l] > depth[at] ? l : at;
    *radius = square[at] / (2 * height[at]);
    return depth[at] > least;
}

// points i0..i1 of one row: inside and not yet covered minus outside and not yet covered
static int64_t row_gain(const dem_lattice *lattice, uint32_t row, int32_t i0, int32_t i1, uint64_t *cover)
{
    int32_t first = lattice->first[row], last = first + (int32_t)(lattice->word[row + 1] - lattice->word[row]) - 1;
    int64_t gain = 0;
    for (int32_t w = i0 >> 6; w <= i1 >> 6; w++) {
        uint64_t mask = lattice_mask(w, i0, i1);
        if (w < first || w > last) {
            gain -= __builtin_popcountll(mask);
            continue;
        }
        size_t at = lattice->word[row] + (size_t)(w - first);
        uint64_t fresh = mask & ~lattice->covered[at];
        gain += 2 * __builtin_popcountll(fresh & lattice->inside[at]) - __builtin_popcountll(fresh);
        if (cover)
            cover[at] |= mask;
    }
    return gain;
}

// whole steps up to x, and from x on; x is far from overflow
static inline int32_t steps_below(double x)
{
    int32_t i = (int32_t)x;
    return i - (x < (double)i);
}
static inline int32_t steps_above(double x)
{
    return -steps_below(-x);
}

enum { ROWS = 16 };  // taken together

// the first and the last point of rows k.. in a disc about (x, y)
static void row_ends(double x, double y, double disc, double k, double *restrict from, double *restrict to)
{
    for (int t = 0; t < ROWS; t++) {
        double dy = k + t - y, rest = disc - dy * dy, reach = sqrt(rest > 0 ? rest : 0);
        from[t] = ceil(x - reach);
        to[t] = rest > 0 ? floor(x + reach) : -1e9;
    }
}

static int64_t lattice_gain(const dem_lattice *lattice, dem_ball ball, uint64_t *cover)
{
    const dem_columns *c = &lattice->rows;
    double r = ball.radius / c->step, x = (ball.centre.x - lattice->origin) / c->step;
    double y = (ball.centre.y - c->origin[0]) / c->step, z = (ball.centre.z - c->origin[1]) / c->step;
    int64_t gain = 0;
    int32_t last = steps_below(z + r);
    double from[ROWS], to[ROWS];
    for (int32_t j = steps_above(z - r); j <= last; j++) {
        double dz = j - z, disc = r * r - dz * dz;
        if (disc <= 0)
            continue;
        double half = sqrt(disc);
        int32_t k1 = steps_below(y + half), begin = 0, end = 0, count;
        uint32_t row = 0;
        if (j >= 0 && j < c->row_count) {
            row = c->line[j];
            begin = c->first[j];
            end = begin + (int32_t)(c->line[j + 1] - row);
        }
        for (int32_t k = steps_above(y - half); k <= k1; k += count) {
            count = k1 - k + 1 < ROWS ? k1 - k + 1 : ROWS;
            row_ends(x, y, disc, k, from, to);
            for (int32_t t = 0; t < count; t++) {
                int32_t i0 = (int32_t)from[t], i1 = (int32_t)to[t];
                if (i1 < i0)
                    continue;
                if (k + t >= begin && k + t < end)
                    gain += row_gain(lattice, row + (uint32_t)(k + t - begin), i0, i1, cover);
                else
                    gain -= i1 - i0 + 1;
            }
        }
    }
    return gain;
}

const dem_pack_kernels DEM_LEVEL_OF(dem_pack_kernels) = {
    .gather_near = gather_near,
    .list_near = list_near,
    .nearest = nearest,
    .nearest_two = nearest_two,
    .owners_of = owners_of,
    .charges = charges,
    .energy = energy,
    .with_ball = with_ball,
    .equations = equations,
    .approach = approach,
    .deepest = deepest,
    .lattice_gain = lattice_gain,
    .lines = &DEM_LEVEL_OF(dem_line_kernels),
};
