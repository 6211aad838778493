#include "fills.h"

#include <time.h>

static const dem_size_def AS_IS = {.law = DEM_SIZE_AS_IS, .largest = INFINITY};

typedef struct filled {
    dem_body_def *bodies;
    size_t count;
} filled;

static filled fill_up(const dem_fill_def *fill, const dem_fill_obstacles *there)
{
    filled f;
    dem_error error = {0};
    check_ok(dem_fill(NULL, fill, fill_shapes(), FILL_SHAPES, there, &f.bodies, &f.count, &error), error);
    return f;
}

// every ball of every body inside of the box and at least the gap away from every other one, by brute force
static void check_clear(filled f, const dem_fill_def *fill, const dem_fill_obstacles *there)
{
    dem_vec3 period = {0, 0, 0};
    for (int k = 0; there && there->domain && k < 3; k++)
        if (there->domain->periodic[k])
            v3_set(&period, k, v3_get(there->domain->high, k) - v3_get(there->domain->low, k));
    double limit = fill->gap + 1e-4;
    for (size_t i = 0; i < f.count; i++) {
        const dem_body_def *a = &f.bodies[i];
        for (size_t j = 0; j <= i; j++)
            check(image_gap(a, &f.bodies[j], period, limit) >= fill->gap);
        for (size_t j = 0; there && j < there->body_count; j++)
            check(image_gap(a, &there->bodies[j], period, limit) >= fill->gap);
        for (size_t k = 0; k < fill_shapes()[a->shape].ball_count; k++) {
            dem_ball b = body_ball(a, k);
            for (int axis = 0; axis < 3; axis++) {
                bool around = v3_get(period, axis) > 0;
                double x = v3_get(around ? a->position : b.centre, axis), r = around ? 0 : b.radius;
                check(x - r >= v3_get(fill->low, axis) && x + r <= v3_get(fill->high, axis));
            }
        }
    }
}

static double volume_of(filled f)
{
    double sum = 0;
    for (size_t i = 0; i < f.count; i++)
        sum += fill_shapes()[f.bodies[i].shape].volume * pow(f.bodies[i].scale, 3);
    return sum;
}

static double solids(filled f, const dem_fill_def *fill)
{
    dem_vec3 e = v3_sub(fill->high, fill->low);
    return volume_of(f) / (e.x * e.y * e.z);
}

static const dem_mix_def MIXED[] = {
    {0, 1, {.law = DEM_SIZE_AS_IS, .largest = INFINITY}},
    {1, 1, {.law = DEM_SIZE_FIXED, .a = 0.8e-3, .largest = INFINITY}},
    {2, 1, {.law = DEM_SIZE_LOGNORMAL, .a = 0.7e-3, .b = 0.3, .largest = INFINITY}},
    {3, 0.2, {.law = DEM_SIZE_UNIFORM, .a = 0.5e-3, .b = 1e-3, .largest = INFINITY}},
};

static void bodies_never_overlap_and_stay_inside(void **state)
{
    (void)state;
    for (int seed = 1; seed <= 4; seed++) {
        dem_fill_def fill = {.mix = MIXED, .mix_count = 4, .low = {-1e-3, 2e-3, 0}, .high = {4e-3, 8e-3, 5e-3}};
        fill.count = 80;
        fill.gap = seed % 2 ? 0 : 5e-5;
        fill.seed = (uint64_t)seed;
        filled f = fill_up(&fill, NULL);
        check(f.count == 80);
        check_clear(f, &fill, NULL);
        free(f.bodies);
    }
}

static void periodic_images_are_bodies_too(void **state)
{
    (void)state;
    const bool which[3][3] = {{true, true, true}, {false, true, false}, {true, false, true}};
    for (int i = 0; i < 3; i++) {
        dem_domain_def domain = {{1e-3, 0, -4e-3}, {5e-3, 4e-3, 0}, {which[i][0], which[i][1], which[i][2]}, 0};
        dem_fill_obstacles there = {.domain = &domain};
        dem_fill_def fill = {.mix = MIXED, .mix_count = 3, .low = domain.low, .high = domain.high, .count = 50};
        fill.gap = i == 1 ? 3e-5 : 0;
        fill.seed = 7;
        filled f = fill_up(&fill, &there);
        check_clear(f, &fill, &there);
        // the centres come near the faces, from where balls reach across
        int across = 0;
        for (size_t n = 0; n < f.count; n++)
            for (int k = 0; k < 3; k++)
                across += which[i][k] && v3_get(f.bodies[n].position, k) < v3_get(domain.low, k) + 2e-4;
        check(across > 0);
        free(f.bodies);
    }
}

static void a_box_inside_of_a_periodic_domain_holds_whole_bodies(void **state)
{
    (void)state;
    dem_domain_def domain = {{0, 0, 0}, {6e-3, 6e-3, 6e-3}, {true, true, true}, 0};
    // one that reaches into the box across a face
    const dem_body_def big[1] = {
        {.shape = 0, .scale = 4, .position = {5.5e-3, 3e-3, 3e-3}, .orientation = {1, 0, 0, 0}}};
    dem_fill_obstacles there = {.domain = &domain, .bodies = big, .body_count = 1};
    dem_fill_def fill = {.mix = MIXED, .mix_count = 3, .low = {0, 0, 0}, .high = {3e-3, 6e-3, 6e-3}, .count = 40};
    filled f = fill_up(&fill, &there);
    dem_domain_def half = domain;
    half.periodic[0] = false;
    dem_fill_obstacles as_checked = {.domain = &half};
    check_clear(f, &fill, &as_checked);
    for (size_t i = 0; i < f.count; i++)
        check(image_gap(&f.bodies[i], big, domain.high, 1e-4) >= 0);
    free(f.bodies);
}

static void a_body_longer_than_half_a_period_keeps_clear_of_itself(void **state)
{
    (void)state;
    // a dimer of 2.1 mm with periods of 1.5: it fits only along the third axis or a diagonal
    dem_mix_def dimers = {1, 1, AS_IS};
    dem_domain_def domain = {{0, 0, 0}, {1.5e-3, 1.5e-3, 8e-3}, {true, true, true}, 0};
    dem_fill_obstacles there = {.domain = &domain};
    dem_fill_def fill = {.mix = &dimers, .mix_count = 1, .high = domain.high, .count = 5, .gap = 2e-5};
    filled f = fill_up(&fill, &there);
    check_clear(f, &fill, &there);
    free(f.bodies);
}

static void what_is_there_stays_clear(void **state)
{
    (void)state;
    // a first fill, a coarse body, and dust that is much finer than what comes
    dem_mix_def dust = {0, 1, {.law = DEM_SIZE_FIXED, .a = 0.02e-3, .largest = INFINITY}};
    dem_domain_def domain = {{0, 0, 0}, {5e-3, 5e-3, 5e-3}, {true, false, false}, 0};
    dem_fill_obstacles there = {.domain = &domain};
    dem_fill_def fill = {.mix = &dust, .mix_count = 1, .high = domain.high, .count = 400};
    filled before = fill_up(&fill, &there);
    before.bodies[0] = (dem_body_def){.shape = 2, .scale = 3, .position = {0, 2e-3, 2e-3}, .orientation = {0, 0, 1, 0}};
    there.bodies = before.bodies;
    there.body_count = before.count;
    dem_fill_def next = {.mix = MIXED, .mix_count = 3, .high = domain.high, .count = 30, .gap = 1e-6};
    filled f = fill_up(&next, &there);
    check_clear(f, &next, &there);
    free(f.bodies);
    free(before.bodies);
}

static double from_sphere(void *user, dem_vec3 centre, double radius, double most)
{
    const dem_ball *b = user;
    return fmin(most, b->radius - v3_distance(centre, b->centre) - radius);
}

static void walls_are_not_crossed(void **state)
{
    (void)state;
    dem_ball vessel = {{3e-3, 3e-3, 3e-3}, 3.2e-3};
    dem_wall_def walls[3] = {
        {.kind = DEM_WALL_PLANE, .point = {0, 0, 1.5e-3}, .normal = {0.6, 0, 0.8}},
        {.kind = DEM_WALL_CYLINDER, .point = {3e-3, 3e-3, 0}, .normal = {0, 0, 1}, .radius = 2.8e-3},
        {.kind = DEM_WALL_CYLINDER, .point = {3e-3, 3e-3, 0}, .normal = {0, 0, 1}, .radius = 0.5e-3, .outside = true}};
    dem_fill_obstacles there = {.walls = walls, .wall_count = 3, .clearance = from_sphere, .user = &vessel};
    dem_fill_def fill = {.mix = MIXED, .mix_count = 4, .high = {6e-3, 6e-3, 6e-3}, .count = 50, .gap = 1e-5};
    filled f = fill_up(&fill, &there);
    check_clear(f, &fill, NULL);
    double nearest = INFINITY;
    for (size_t i = 0; i < f.count; i++)
        for (size_t k = 0; k < fill_shapes()[f.bodies[i].shape].ball_count; k++) {
            dem_ball b = body_ball(&f.bodies[i], k);
            dem_vec3 c = v3_sub(b.centre, vessel.centre);
            double gap = fmin(2.8e-3 - hypot(c.x, c.y), hypot(c.x, c.y) - 0.5e-3) - b.radius;
            gap = fmin(gap, 3.2e-3 - v3_norm(c) - b.radius);
            gap = fmin(gap, 0.6 * b.centre.x + 0.8 * (b.centre.z - 1.5e-3) - b.radius);
            check(gap >= 1e-5);
            nearest = fmin(nearest, gap);
        }
    // and room next to them is used
    check(nearest < 1e-4);
    free(f.bodies);
}

static void the_void_ratio_is_met_within_one_body(void **state)
{
    (void)state;
    for (int by_mass = 0; by_mass < 2; by_mass++) {
        dem_fill_def fill = {.mix = MIXED, .mix_count = 4, .high = {8e-3, 7e-3, 6e-3}, .void_ratio = 4};
        fill.share_by_mass = by_mass;
        filled f = fill_up(&fill, NULL);
        double largest = 0, box = 8e-3 * 7e-3 * 6e-3;
        for (size_t i = 0; i < f.count; i++)
            largest = fmax(largest, volume_of((filled){&f.bodies[i], 1}));
        check_near(volume_of(f), box / 5, largest / 2);
        free(f.bodies);
    }
}

static void the_last_body_of_a_void_ratio_is_the_nearer_one(void **state)
{
    (void)state;
    dem_mix_def mix = {0, 1, AS_IS};
    for (double ratio = 10; ratio < 40; ratio *= 1.07) {
        dem_fill_def fill = {.mix = &mix, .mix_count = 1, .high = {3e-3, 4e-3, 5e-3}, .void_ratio = ratio};
        filled f = fill_up(&fill, NULL);
        check((double)f.count == round(60e-9 / (1 + ratio) / fill_shapes()[0].volume));
        free(f.bodies);
    }
    // one body there is always
    dem_fill_def fill = {.mix = &mix, .mix_count = 1, .high = {3e-3, 4e-3, 5e-3}, .void_ratio = 1e6};
    filled f = fill_up(&fill, NULL);
    check(f.count == 1);
    free(f.bodies);
}

static void shares_are_as_close_as_whole_bodies_allow(void **state)
{
    (void)state;
    const double shares[3] = {5, 2, 1};
    dem_mix_def mix[3];
    for (int i = 0; i < 3; i++)
        mix[i] =
            (dem_mix_def){(uint32_t)i, shares[i], {.law = DEM_SIZE_FIXED, .a = 1e-4 * (i + 1), .largest = INFINITY}};
    for (size_t count = 1; count < 40; count += 3)
        for (int by_mass = 0; by_mass < 2; by_mass++) {
            dem_fill_def fill = {.mix = mix, .mix_count = 3, .high = {5e-3, 5e-3, 5e-3}, .count = count};
            fill.share_by_mass = by_mass;
            filled f = fill_up(&fill, NULL);
            double given[3] = {0}, total = 0, most = 0;
            for (size_t i = 0; i < f.count; i++) {
                const dem_body_def *b = &f.bodies[i];
                double amount = by_mass ? fill_shapes()[b->shape].mass * pow(b->scale, 3) : 1;
                given[b->shape] += amount;
                total += amount;
                most = fmax(most, amount);
                // and the first ones of them already
                for (int k = 0; k < 3 && !by_mass; k++)
                    check_near(given[k], total * shares[k] / 8, 1.0001);
            }
            for (int k = 0; k < 3; k++)
                check_near(given[k], total * shares[k] / 8, most * (1 - 1e-9));
            free(f.bodies);
        }
}

static void sizes_are_those_of_the_law(void **state)
{
    (void)state;
    enum { COUNT = 3000 };
    const double sizes[3] = {1e-4, 2e-4, 4e-4}, passing[3] = {0, 0.6, 1};
    dem_mix_def mix[2] = {{2, 1, {DEM_SIZE_TABLE, NAN, NAN, 0, INFINITY, true, sizes, passing, 3}}, {0, 1, AS_IS}};
    dem_fill_def fill = {.mix = mix, .mix_count = 2, .high = {2e-2, 2e-2, 2e-2}, .count = 2 * COUNT};
    filled f = fill_up(&fill, NULL);
    double below[4] = {0}, total = 0, coarsest = 0;
    for (size_t i = 0; i < f.count; i++) {
        if (f.bodies[i].shape == 0) {
            check(f.bodies[i].scale == 1);
            continue;
        }
        double d = f.bodies[i].scale * fill_shapes()[2].equivalent_diameter, mass = d * d * d;
        total += mass;
        coarsest = fmax(coarsest, mass);
        for (int k = 0; k < 4; k++)
            below[k] += d <= 1.5e-4 + 0.5e-4 * k ? mass : 0;
    }
    const double shares[4] = {0.3, 0.6, 0.7, 0.8};
    for (int k = 0; k < 4; k++)
        // the sequence keeps within a few bodies of the law
        check_near(below[k] / total, shares[k], 3 * coarsest / total);
    free(f.bodies);
}

static void orientations_are_uniform(void **state)
{
    (void)state;
    dem_mix_def dimers = {1, 1, AS_IS};
    // dilute, and so dense that most first orientations do not fit
    const double sides[2] = {60e-3, 24e-3};
    for (int i = 0; i < 2; i++) {
        enum { COUNT = 4000 };
        double s = sides[i], once[9] = {0}, twice[9] = {0}, fourth = 0;
        dem_fill_def fill = {.mix = &dimers, .mix_count = 1, .high = {s, s, s}, .count = COUNT, .seed = 5};
        filled f = fill_up(&fill, NULL);
        for (size_t n = 0; n < COUNT; n++) {
            dem_quat q = f.bodies[n].orientation;
            check_near(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z, 1, 1e-15);
            for (int k = 0; k < 3; k++) {
                dem_vec3 u = quat_rotate(q, v3(k == 0, k == 1, k == 2));
                for (int j = 0; j < 3; j++) {
                    double x = v3_get(u, j);
                    once[3 * k + j] += x / COUNT;
                    twice[3 * k + j] += x * x / COUNT;
                    fourth += x * x * x * x / COUNT / 9;
                }
            }
        }
        for (int k = 0; k < 9; k++) {
            // variances of an element of a uniform rotation: 1/3, and 1/5 - 1/9 of its square; four deviations
            check_near(once[k], 0, 4 * sqrt(1.0 / 3 / COUNT));
            check_near(twice[k], 1.0 / 3, 4 * sqrt((1.0 / 5 - 1.0 / 9) / COUNT));
        }
        check_near(fourth, 0.2, 4 * sqrt((1.0 / 9 - 1.0 / 25) / COUNT));
        free(f.bodies);
    }
}

static void positions_are_uniform(void **state)
{
    (void)state;
    enum { COUNT = 4000 };
    dem_mix_def balls = {0, 1, {.law = DEM_SIZE_FIXED, .a = 1e-5, .largest = INFINITY}};
    dem_fill_def fill = {
        .mix = &balls, .mix_count = 1, .low = {1, 0, 0}, .high = {1.003, 0.002, 0.001}, .count = COUNT};
    filled f = fill_up(&fill, NULL);
    dem_vec3 e = v3_sub(fill.high, fill.low);
    double slot[3][10] = {{0}};
    for (size_t i = 0; i < COUNT; i++)
        for (int k = 0; k < 3; k++)
            slot[k][(int)(10 * (v3_get(f.bodies[i].position, k) - v3_get(fill.low, k)) / v3_get(e, k))]++;
    for (int k = 0; k < 30; k++)
        check_near(slot[k / 10][k % 10], COUNT / 10, 4 * sqrt(COUNT * 0.09) + 0.005 * COUNT / 10);
    free(f.bodies);
}

static void a_box_may_be_no_thicker_than_a_body(void **state)
{
    (void)state;
    // a layer of balls so wide that cells of their size would be many
    dem_mix_def mix = {0, 1, AS_IS};
    dem_fill_def fill = {.mix = &mix, .mix_count = 1, .high = {20e-3, 20e-3, 1.0001e-3}, .count = 180, .gap = 1e-5};
    filled f = fill_up(&fill, NULL);
    check_clear(f, &fill, NULL);
    free(f.bodies);
    dem_mix_def fine = {0, 1, {.law = DEM_SIZE_FIXED, .a = 1e-6, .largest = INFINITY}};
    fill = (dem_fill_def){.mix = &fine, .mix_count = 1, .high = {1, 1, 0.9e-6}, .count = 1};
    dem_body_def *bodies;
    size_t count;
    check(dem_fill(NULL, &fill, fill_shapes(), FILL_SHAPES, NULL, &bodies, &count, NULL) == DEM_FAILED);
}

static void the_order_tells_neither_size_nor_place(void **state)
{
    (void)state;
    enum { COUNT = 2000 };
    dem_mix_def mix = {2, 1, {DEM_SIZE_UNIFORM, 1e-4, 1e-3, 0, INFINITY, true, NULL, NULL, 0}};
    dem_fill_def fill = {.mix = &mix, .mix_count = 1, .high = {6e-3, 6e-3, 6e-3}, .count = COUNT};
    filled f = fill_up(&fill, NULL);
    double sum[4] = {0};
    for (size_t i = 0; i < COUNT; i++) {
        const dem_body_def *b = &f.bodies[i];
        const double x[4] = {b->position.x - 3e-3, b->position.y - 3e-3, b->position.z - 3e-3, 1e-3 * b->scale};
        for (int k = 0; k < 4; k++)
            sum[k] += x[k] * ((double)i / COUNT - 0.5) / 1e-3 / COUNT;
    }
    for (int k = 0; k < 3; k++)
        // deviation of position * index, 1.7 * 0.29 / sqrt(COUNT), four times
        check_near(sum[k], 0, 4 * 1.7 * 0.29 / sqrt(COUNT));
    check_near(sum[3], 0, 0.01);
    free(f.bodies);
}

static void the_seed_alone_makes_the_difference(void **state)
{
    (void)state;
    dem_fill_def fill = {.mix = MIXED, .mix_count = 4, .high = {6e-3, 6e-3, 6e-3}, .count = 100, .seed = 3};
    fill.velocity = v3(1, 2, 3);
    dem_ctx one = {.threads = 1};
    dem_error error;
    filled a = fill_up(&fill, NULL), b, c;
    check_ok(dem_fill(&one, &fill, fill_shapes(), FILL_SHAPES, NULL, &b.bodies, &b.count, &error), error);
    check(a.count == b.count);
    assert_memory_equal(a.bodies, b.bodies, a.count * sizeof *a.bodies);
    fill.seed = 4;
    c = fill_up(&fill, NULL);
    size_t same = 0;
    for (size_t i = 0; i < a.count; i++) {
        same += a.bodies[i].position.x == c.bodies[i].position.x;
        check_vec(a.bodies[i].velocity, v3(1, 2, 3), 0);
        check_vec(a.bodies[i].spin, v3(0, 0, 0), 0);
    }
    check(same == 0);
    free(a.bodies);
    free(b.bodies);
    free(c.bodies);
}

static void sizes_may_differ_by_a_hundred(void **state)
{
    (void)state;
    dem_mix_def mix[2] = {{2, 1, {DEM_SIZE_UNIFORM, 4e-5, 4e-3, 0, INFINITY, true, NULL, NULL, 0}},
                          {0, 1, {DEM_SIZE_UNIFORM, 4e-5, 4e-3, 0, INFINITY, true, NULL, NULL, 0}}};
    dem_domain_def domain = {{0, 0, 0}, {6e-3, 6e-3, 6e-3}, {true, true, false}, 0};
    dem_fill_obstacles there = {.domain = &domain};
    dem_fill_def fill = {.mix = mix, .mix_count = 2, .high = domain.high, .count = 4000};
    filled f = fill_up(&fill, &there);
    double least = INFINITY, most = 0;
    for (size_t i = 0; i < f.count; i++) {
        least = fmin(least, f.bodies[i].scale);
        most = fmax(most, f.bodies[i].scale);
    }
    check(most > 20 * least);
    check_clear(f, &fill, &there);
    free(f.bodies);
}

static bool lattice_used;

static void hear(void *user, dem_log_level level, const char *subject, const char *text)
{
    (void)user;
    (void)level;
    (void)subject;
    lattice_used = lattice_used || strstr(text, "lattice");
}

static void dense_fills_are_shaken_and_denser_ones_stand_on_a_lattice(void **state)
{
    (void)state;
    const struct {
        uint32_t shape;
        size_t count;
        double solids;
        bool lattice;
    } cases[] = {{0, 200, 0.45, false}, {2, 100, 0.36, false}, {0, 500, 0.6, true}};
    for (int periodic = 0; periodic < 2; periodic++)
        for (int i = 0; i < 3; i++) {
            dem_mix_def mix = {cases[i].shape, 1, AS_IS};
            double side = cbrt((double)cases[i].count * fill_shapes()[mix.shape].volume / cases[i].solids);
            bool p = periodic && !cases[i].lattice;
            dem_domain_def domain = {{0, 0, 0}, {side, side, side}, {p, p, p}, 0};
            dem_fill_obstacles there = {.domain = &domain};
            // walls cost balls some room; on the lattice more than these have
            if (cases[i].lattice)
                domain.high = v3(8.2e-3, 8.2e-3, 8.2e-3);
            dem_fill_def fill = {.mix = &mix, .mix_count = 1, .high = domain.high, .count = cases[i].count};
            if (cases[i].lattice)
                fill.count = (size_t)(0.55 * pow(8.2e-3, 3) / fill_shapes()[0].volume);
            filled f;
            dem_error error = {0};
            dem_ctx ctx = {.log = hear};
            lattice_used = false;
            check_ok(dem_fill(&ctx, &fill, fill_shapes(), FILL_SHAPES, &there, &f.bodies, &f.count, &error), error);
            check(f.count == fill.count && lattice_used == cases[i].lattice);
            check(solids(f, &fill) > 0.35);
            for (size_t n = 0; n < f.count; n++)
                check(f.bodies[n].scale == 1);
            check_clear(f, &fill, &there);
            free(f.bodies);
        }
}

// the error of a fill that must fail
static dem_error refused(const dem_fill_def *fill, const dem_fill_obstacles *there, dem_status status)
{
    dem_body_def *bodies;
    size_t count;
    dem_error error = {0};
    dem_status got = dem_fill(NULL, fill, fill_shapes(), FILL_SHAPES, there, &bodies, &count, &error);
    if (got != status)
        print_error("%d: %s\n", got, error.text);
    check(got == status && !bodies && count == 0 && error.code == status);
    return error;
}

static void what_does_not_fit_is_refused_with_what_did(void **state)
{
    (void)state;
    dem_fill_def fill = {.mix = MIXED, .mix_count = 1, .high = {4e-3, 4e-3, 4e-3}, .count = 200};
    dem_error error = refused(&fill, NULL, DEM_FAILED);
    size_t fitted = 0;
    double ratio = 0;
    // rejects what random addition alone comes to, 38 %, less at walls
    check(sscanf(error.text, "fill: only %zu of 200 bodies fit (void ratio %lf); lower the count", &fitted, &ratio) ==
          2);
    check(fitted > 35 && fitted < 80);
    check_close(ratio, 64e-9 / ((double)fitted * fill_shapes()[0].volume) - 1, 0.005);
    check(strstr(error.text, "or fill a taller box and let it settle"));
    fill.count = 0;
    fill.void_ratio = 0.2;
    error = refused(&fill, NULL, DEM_FAILED);
    check(sscanf(error.text,
                 "fill: the void ratio of 0.2 was not reached, %zu bodies came to %lf; ask for a higher one", &fitted,
                 &ratio) == 2);
    check_close(ratio, 64e-9 / ((double)fitted * fill_shapes()[0].volume) - 1, 0.005);
    // so many do fit
    fill.void_ratio = 0;
    fill.count = fitted;
    filled f = fill_up(&fill, NULL);
    check_clear(f, &fill, NULL);
    free(f.bodies);
    fill.high.x = 0.9e-3;
    error = refused(&fill, NULL, DEM_FAILED);
    check(strstr(error.text, "not even the largest body, 0.001 m across, found room in the box"));
}

static void unusable_fills_are_refused_with_the_reason(void **state)
{
    (void)state;
    dem_fill_def good = {.mix = MIXED, .mix_count = 4, .high = {4e-3, 4e-3, 4e-3}, .count = 1}, bad = good;
    bad.high.y = 0;
    check(strstr(refused(&bad, NULL, DEM_USAGE).text, "the box needs a lower and an upper corner"));
    bad = good;
    bad.gap = -1e-9;
    check(strstr(refused(&bad, NULL, DEM_USAGE).text, "the gap must not be negative"));
    bad = good;
    bad.count = 0;
    bad.void_ratio = NAN;
    check(strstr(refused(&bad, NULL, DEM_USAGE).text, "give a count or a void ratio"));
    bad = good;
    bad.mix_count = 0;
    check(strstr(refused(&bad, NULL, DEM_USAGE).text, "the mix is empty"));
    dem_mix_def mix = {FILL_SHAPES, 1, AS_IS};
    bad = good;
    bad.mix = &mix;
    bad.mix_count = 1;
    check(strstr(refused(&bad, NULL, DEM_USAGE).text, "mix[0] has shape 4, there are 4"));
    mix = (dem_mix_def){0, -1, AS_IS};
    check(strstr(refused(&bad, NULL, DEM_USAGE).text, "the share of mix[0] must be positive"));
    mix = (dem_mix_def){0, 1, {.law = DEM_SIZE_FIXED, .a = 0, .largest = 1}};
    check(strstr(refused(&bad, NULL, DEM_USAGE).text, "size: must be positive"));
    dem_domain_def domain = {{0, 0, 0}, {4e-3, 4e-3, 3.9e-3}, {true, true, true}, 0};
    dem_fill_obstacles there = {.domain = &domain};
    check(strstr(refused(&good, &there, DEM_USAGE).text, "the box reaches out of the domain along z"));
    // endless on one side
    domain.periodic[2] = false;
    domain.low.z = -INFINITY;
    check(strstr(refused(&good, &there, DEM_USAGE).text, "the box reaches out of the domain along z"));
}

static int calls, stop_at;
static double last_fraction;

static bool watch(void *user, const char *what, double fraction)
{
    (void)user;
    assert_string_equal(what, "placing");
    check(fraction >= 0 && fraction <= 1);
    last_fraction = fraction;
    return ++calls == stop_at;
}

static void the_caller_may_stop_at_any_call(void **state)
{
    (void)state;
    dem_ctx ctx = {.progress = watch};
    // balls that need all the stages, the last one in vain
    dem_fill_def fill = {.mix = MIXED, .mix_count = 1, .high = {4e-3, 4e-3, 4e-3}, .count = 80};
    dem_body_def *bodies;
    size_t count;
    dem_error error;
    calls = 0;
    stop_at = -1;
    check(dem_fill(&ctx, &fill, fill_shapes(), FILL_SHAPES, NULL, &bodies, &count, &error) == DEM_FAILED);
    int all = calls;
    check(all > 4);
    for (stop_at = 1; stop_at <= all; stop_at = 2 * stop_at + (stop_at == 1)) {
        calls = 0;
        check(dem_fill(&ctx, &fill, fill_shapes(), FILL_SHAPES, NULL, &bodies, &count, &error) == DEM_INTERRUPTED);
        check(!bodies && calls == stop_at);
    }
}

static void neither_the_place_nor_the_unit_matters(void **state)
{
    (void)state;
    // far from the origin rounding is a hundredth of a micrometre
    dem_fill_def fill = {.mix = MIXED, .mix_count = 4, .low = {1e5, -1e5, 0}, .high = {1e5 + 5e-3, -1e5 + 5e-3, 5e-3}};
    fill.count = 60;
    filled f = fill_up(&fill, NULL);
    check_clear(f, &fill, NULL);
    free(f.bodies);
    // nanometres
    dem_mix_def mix = {2, 1, {.law = DEM_SIZE_FIXED, .a = 1e-9, .largest = INFINITY}};
    dem_fill_def tiny = {.mix = &mix, .mix_count = 1, .high = {4e-9, 4e-9, 4e-9}, .count = 25};
    f = fill_up(&tiny, NULL);
    check_clear(f, &tiny, NULL);
    free(f.bodies);
}

static void fine_clumps_cost_little(void **state)
{
    (void)state;
    dem_mix_def mix = {3, 1, AS_IS};
    dem_fill_def fill = {.mix = &mix, .mix_count = 1, .high = {12e-3, 12e-3, 12e-3}, .void_ratio = 4};
    clock_t start = clock();
    filled f = fill_up(&fill, NULL);
    // 0.1 s as measured; sanitizers are ten times slower, a test of all pairs of balls a thousand
    check((double)(clock() - start) / CLOCKS_PER_SEC < 10);
    check(f.count > 500);
    for (size_t i = 0; i < 30; i++)
        for (size_t j = 0; j < f.count; j++)
            check(i == j || body_gap(&f.bodies[i], &f.bodies[j], v3(0, 0, 0), 1e-5) >= 0);
    free(f.bodies);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bodies_never_overlap_and_stay_inside),
        cmocka_unit_test(periodic_images_are_bodies_too),
        cmocka_unit_test(a_box_inside_of_a_periodic_domain_holds_whole_bodies),
        cmocka_unit_test(a_body_longer_than_half_a_period_keeps_clear_of_itself),
        cmocka_unit_test(what_is_there_stays_clear),
        cmocka_unit_test(walls_are_not_crossed),
        cmocka_unit_test(the_void_ratio_is_met_within_one_body),
        cmocka_unit_test(the_last_body_of_a_void_ratio_is_the_nearer_one),
        cmocka_unit_test(shares_are_as_close_as_whole_bodies_allow),
        cmocka_unit_test(sizes_are_those_of_the_law),
        cmocka_unit_test(orientations_are_uniform),
        cmocka_unit_test(positions_are_uniform),
        cmocka_unit_test(a_box_may_be_no_thicker_than_a_body),
        cmocka_unit_test(the_order_tells_neither_size_nor_place),
        cmocka_unit_test(the_seed_alone_makes_the_difference),
        cmocka_unit_test(sizes_may_differ_by_a_hundred),
        cmocka_unit_test(dense_fills_are_shaken_and_denser_ones_stand_on_a_lattice),
        cmocka_unit_test(what_does_not_fit_is_refused_with_what_did),
        cmocka_unit_test(unusable_fills_are_refused_with_the_reason),
        cmocka_unit_test(the_caller_may_stop_at_any_call),
        cmocka_unit_test(neither_the_place_nor_the_unit_matters),
        cmocka_unit_test(fine_clumps_cost_little),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
