#include "check.h"
#include "shapes.h"

#include "base/level.h"
#include "clump/pack_connect.h"
#include "clump/pack_moments.h"
#include "clump/packing.h"
#include "geom/union.h"

enum { BALLS = 40 };

typedef struct fixture {
    dem_mesh mesh;
    dem_pack_grain grain;
    dem_pack_options options;
    dem_packing p;
    dem_pack_state state;
} fixture;

static void open_fixture(fixture *f, const dem_pack_kernels *kernels, int threads)
{
    static dem_ctx ctx;
    dem_error error;
    ctx = (dem_ctx){.threads = threads};
    f->mesh = shape_box(2, 1.2, 1);
    f->options = dem_pack_defaults();
    f->options.spheres = BALLS;
    check_ok(dem_pack_grain_open(&f->mesh, &f->grain, &error), error);
    check_ok(dem_packing_open(&ctx, &f->grain, &f->options, kernels, &f->p, &error), error);
    check_ok(dem_pack_state_init(&f->p, &f->state, &error), error);
    f->state.count = 0;
    dem_random r = random_stream(2, 0);
    for (int i = 0; i < BALLS; i++) {
        double x = random_uniform(&r) - 0.5, y = random_uniform(&r) - 0.5, z = random_uniform(&r) - 0.5;
        dem_pack_state_add(&f->state, (dem_ball){v3_scale(v3(x, y, z), 0.8), 0.1 + 0.1 * random_uniform(&r)});
    }
}

static void close_fixture(fixture *f)
{
    dem_packing_close(&f->p);
    dem_pack_grain_close(&f->grain);
    dem_mesh_free(&f->mesh);
}

// the two smallest distances of a sample to balls, by trying all
static void nearest_two(const fixture *f, size_t sample, double d[2])
{
    const dem_sample_block *b = &f->p.samples.blocks[sample / DEM_BLOCK];
    size_t l = sample % DEM_BLOCK;
    dem_vec3 q = v3((double)b->x[l], (double)b->y[l], (double)b->z[l]);
    d[0] = d[1] = INFINITY;
    for (size_t i = 0; i < f->state.count; i++) {
        double x = v3_distance(q, f->state.balls[i].centre) - f->state.balls[i].radius;
        if (x < d[0]) {
            d[1] = d[0];
            d[0] = x;
        } else if (x < d[1]) {
            d[1] = x;
        }
    }
}

static void check_assignment(const fixture *f)
{
    for (size_t k = 0; k < f->p.samples.block_count * DEM_BLOCK; k++) {
        double d[2];
        nearest_two(f, k, d);
        double now = (double)f->state.f[k];
        if (k / DEM_BLOCK >= f->p.samples.surface_blocks && d[0] < -1e-6)
            check(now <= 0 && now > d[0] - 1e-6);  // how deep inside a ball is not asked
        else
            check_near(now, d[0], 1e-6);  // floats
    }
}

static void samples_belong_to_the_nearest_ball_also_after_small_and_large_moves(void **state)
{
    (void)state;
    fixture f;
    dem_error error;
    open_fixture(&f, NULL, 1);
    check_ok(dem_pack_assign(&f.p, &f.state, &error), error);
    check_assignment(&f);
    for (int k = 0; k < 10; k++) {
        for (size_t i = 0; i < f.state.count; i++) {
            double step = k < 8 ? 0.005 : 0.1;   // adding up to more than the slack of the near lists, then far beyond
            f.state.balls[i].centre.x += i % 2 ? step : -step;
            f.state.balls[i].radius += i % 3 ? 0.001 : -0.001;
        }
        check_ok(dem_pack_assign_moved(&f.p, &f.state, &error), error);
        check_assignment(&f);
    }
    close_fixture(&f);
}

static double charge(const fixture *f, size_t sample, double distance)
{
    const dem_sample_block *b = &f->p.samples.blocks[sample / DEM_BLOCK];
    double w = (double)b->weight[sample % DEM_BLOCK];
    if (sample / DEM_BLOCK >= f->p.samples.surface_blocks)
        return distance > 0 ? 120 * w * distance * distance : 0;
    return w * pow(distance * distance + (double)f->p.charge.softening, 0.625);
}

static void the_cost_of_removing_a_ball_is_what_the_energy_rises_by(void **state)
{
    (void)state;
    fixture f;
    dem_error error;
    open_fixture(&f, NULL, 1);
    // lists of balls that stood elsewhere are not taken for theirs
    dem_ball elsewhere[BALLS];
    memcpy(elsewhere, f.state.balls, sizeof elsewhere);
    for (int i = 0; i < BALLS; i++)
        f.state.balls[i].centre.x += 0.3 * (i % 2);
    check_ok(dem_pack_assign(&f.p, &f.state, &error), error);
    memcpy(f.state.balls, elsewhere, sizeof elsewhere);
    check_ok(dem_pack_removal_costs(&f.p, &f.state, &error), error);
    double fresh[BALLS];
    memcpy(fresh, f.p.cost, sizeof fresh);
    check_ok(dem_pack_assign(&f.p, &f.state, &error), error);
    check_ok(dem_pack_removal_costs(&f.p, &f.state, &error), error);
    double energy = 0, want[BALLS] = {0};
    for (size_t k = 0; k < f.p.samples.block_count * DEM_BLOCK; k++) {
        double d[2];
        nearest_two(&f, k, d);
        energy += charge(&f, k, d[0]);
        want[f.state.owner[k]] += charge(&f, k, d[1]) - charge(&f, k, d[0]);
    }
    check_close(f.state.energy, energy, 1e-5);
    for (int i = 0; i < BALLS; i++)
        check(fabs(f.p.cost[i] - want[i]) <= 1e-5 * energy && f.p.cost[i] == fresh[i]);
    // and of one of them by doing it
    bool gone[BALLS] = {[7] = true};
    double rise = f.p.cost[7], before = f.state.energy;
    dem_pack_state_remove(&f.state, gone);
    check_ok(dem_pack_assign(&f.p, &f.state, &error), error);
    check_near(f.state.energy - before, rise, 1e-5 * energy);
    close_fixture(&f);
}

static void relaxing_lowers_the_energy_and_gives_the_same_bits_everywhere(void **state)
{
    (void)state;
    dem_ball first[BALLS];
    bool have = false;
    for (int s = 0; s < DEM_LEVELS; s++) {
        const dem_pack_kernels *kernels = dem_pack_kernels_choose(dem_level_name(s));
        for (int threads = 1; kernels && threads <= 3; threads++) {
            fixture f;
            dem_error error;
            open_fixture(&f, kernels, threads);
            check_ok(dem_pack_assign(&f.p, &f.state, &error), error);
            double before = f.state.energy;
            check_ok(dem_pack_relax(&f.p, &f.state, (dem_relax_options){10, 0.02, 0}, &error), error);
            check(f.state.energy < 0.7 * before);
            if (!have)
                memcpy(first, f.state.balls, sizeof first);
            have = true;
            check(memcmp(first, f.state.balls, sizeof first) == 0);
            close_fixture(&f);
        }
    }
}

static void open_links_are_one_less_than_pieces_and_closing_leaves_one(void **state)
{
    (void)state;
    fixture f;
    open_fixture(&f, NULL, 1);
    for (int k = 0; k < 3; k++) {
        size_t pieces = dem_ball_pieces(f.state.balls, f.state.count, dem_pack_overlap, NULL);
        size_t open = dem_pack_links(&f.p, f.state.balls, f.state.count, dem_pack_overlap);
        check(open + 1 == pieces);
        for (size_t i = 0; i < open; i++) {
            const dem_ball *a = &f.state.balls[f.p.links[i].i], *b = &f.state.balls[f.p.links[i].j];
            double overlap = a->radius + b->radius - v3_distance(a->centre, b->centre);
            check_near(f.p.links[i].gap, dem_pack_overlap - overlap, 1e-12);
        }
        for (size_t i = 0; i < f.state.count; i++)
            f.state.balls[i].radius *= 0.7;
    }
    check(dem_ball_pieces(f.state.balls, f.state.count, dem_pack_overlap, NULL) > 1);
    check(dem_pack_close(&f.p, &f.state, 0.5));
    check(dem_ball_pieces(f.state.balls, f.state.count, dem_pack_overlap, NULL) == 1);
    check(!dem_pack_close(&f.p, &f.state, 0.5));
    close_fixture(&f);
}

static void gradients_of_the_moments_are_those_of_finite_differences_and_projecting_meets_them(void **state)
{
    (void)state;
    fixture f;
    dem_error error;
    dem_moment_rows rows, spare;
    open_fixture(&f, NULL, 1);
    check_ok(dem_moment_rows_init(&f.p, &rows, &error), error);
    check_ok(dem_moment_rows_init(&f.p, &spare, &error), error);
    check_ok(dem_moment_rows_set(&f.p, &f.state, DEM_MOMENT_COUNT, &rows, &error), error);
    for (size_t i = 0; i < BALLS; i += 7)
        for (int d = 0; d < 4; d++) {
            const double h = 1e-6;
            double value[2][DEM_MOMENT_COUNT];
            dem_ball ball = f.state.balls[i];
            for (int side = 0; side < 2; side++) {
                f.state.balls[i] = ball;
                if (d < 3)
                    v3_set(&f.state.balls[i].centre, d, v3_get(ball.centre, d) + (side ? h : -h));
                else
                    f.state.balls[i].radius += side ? h : -h;
                check_ok(dem_moment_rows_set(&f.p, &f.state, DEM_MOMENT_COUNT, &spare, &error), error);
                memcpy(value[side], spare.lack, sizeof spare.lack);
            }
            f.state.balls[i] = ball;
            for (int k = 0; k < DEM_MOMENT_COUNT; k++)  // the lack falls as the moment rises
                check_near((value[0][k] - value[1][k]) / (2 * h), rows.rows[k][i][d], 1e-7);
        }
    bool met;
    check_ok(dem_pack_relax(&f.p, &f.state, (dem_relax_options){20, 0.02, 0}, &error), error);
    f.p.charge.linear = true;
    check_ok(dem_pack_project(&f.p, &f.state, DEM_MOMENT_COUNT, &rows, &spare, &met, &error), error);
    check(met && rows.residual < 1e-9);
    close_fixture(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(samples_belong_to_the_nearest_ball_also_after_small_and_large_moves),
        cmocka_unit_test(the_cost_of_removing_a_ball_is_what_the_energy_rises_by),
        cmocka_unit_test(relaxing_lowers_the_energy_and_gives_the_same_bits_everywhere),
        cmocka_unit_test(open_links_are_one_less_than_pieces_and_closing_leaves_one),
        cmocka_unit_test(gradients_of_the_moments_are_those_of_finite_differences_and_projecting_meets_them),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
