#include "check.h"
#include "shapes.h"

#include "base/level.h"
#include "base/random.h"
#include "clump/pack_kernels.h"

static dem_pack_grain grain_of(const dem_mesh *mesh)
{
    dem_pack_grain grain;
    dem_error error;
    check_ok(dem_pack_grain_open(mesh, &grain, &error), error);
    return grain;
}

static dem_vec3 point_of(const dem_lattice *lattice, int32_t j, uint32_t row, uint32_t word, int bit)
{
    const dem_columns *c = &lattice->rows;
    int32_t i = 64 * (lattice->first[row] + (int32_t)(word - lattice->word[row])) + bit;
    return v3(lattice->origin + i * c->step, c->origin[0] + (c->first[j] + (int32_t)(row - c->line[j])) * c->step,
              c->origin[1] + j * c->step);
}

static void the_grain_has_unit_size_and_its_centroid_at_zero_and_points_come_back(void **state)
{
    (void)state;
    dem_mesh box = shape_box(3e-9, 2e-9, 1e-9);
    dem_pack_grain grain = grain_of(&box);
    check_close(grain.moments.volume, DEM_PI / 6, 1e-14);
    check_vec(grain.moments.first, v3(0, 0, 0), 1e-15);
    dem_solid solid = dem_mesh_solid(&box);
    double trace = (solid.principal[0] + solid.principal[1] + solid.principal[2]) / 2, d = grain.size;
    dem_sym3 s = grain.moments.second;
    check_close(s.xx + s.yy + s.zz, trace / (d * d * d * d * d), 1e-13);
    for (size_t i = 0; i < box.vertex_count; i++) {
        dem_ball ball = {dem_pack_grain_enter(&grain, box.vertices[i]), 0.25};
        ball = dem_pack_grain_leave(&grain, ball);
        check_vec(ball.centre, box.vertices[i], 1e-23);  // 1e-14 of the box
        check_close(ball.radius, 0.25 * d, 1e-15);
    }
    dem_pack_grain_close(&grain);
    dem_mesh_free(&box);
}

// the bits against the winding number, point by point
static void lattice_points_are_inside_where_rays_say_so(void **state)
{
    (void)state;
    dem_mesh meshes[2] = {shape_box(2, 1, 0.3), shape_sphere(6)};
    for (int m = 0; m < 2; m++) {
        dem_pack_grain grain = grain_of(&meshes[m]);
        dem_lattice lattice;
        dem_error error;
        size_t inside = 0, wrong = 0;
        check_ok(dem_lattice_build(&grain, 2000, &lattice, &error), error);
        const dem_columns *c = &lattice.rows;
        for (int32_t j = 0; j < c->row_count; j++)
            for (uint32_t row = c->line[j]; row < c->line[j + 1]; row++)
                for (uint32_t w = lattice.word[row]; w < lattice.word[row + 1]; w++)
                    for (int bit = 0; bit < 64; bit++) {
                        bool is = lattice.inside[w] >> bit & 1;
                        inside += is;
                        wrong += is != dem_tree_inside(&grain.tree, point_of(&lattice, j, row, w, bit));
                    }
        check(wrong == 0);
        check(inside == lattice.inside_count);
        check_close((double)inside * pow(c->step, 3), grain.moments.volume, 0.05);  // 2000 points
        dem_lattice_release(&lattice);
        dem_pack_grain_close(&grain);
        dem_mesh_free(&meshes[m]);
    }
}

// inside and not covered yet minus outside and not covered yet, point by point over the ball's bounding box
static int64_t naive_gain(const dem_pack_grain *grain, const dem_lattice *lattice, const dem_ball *before, int count,
                          dem_ball ball)
{
    const dem_columns *c = &lattice->rows;
    double h = c->step, r = ball.radius;
    int64_t gain = 0;
    for (int i = (int)floor((ball.centre.x - r - lattice->origin) / h); i * h + lattice->origin <= ball.centre.x + r; i++)
        for (int k = (int)floor((ball.centre.y - r - c->origin[0]) / h); k * h + c->origin[0] <= ball.centre.y + r; k++)
            for (int j = (int)floor((ball.centre.z - r - c->origin[1]) / h); j * h + c->origin[1] <= ball.centre.z + r; j++) {
                dem_vec3 p = v3(lattice->origin + i * h, c->origin[0] + k * h, c->origin[1] + j * h);
                bool covered = v3_distance(p, ball.centre) >= r;
                for (int b = 0; b < count; b++)
                    covered |= v3_distance(p, before[b].centre) < before[b].radius;
                if (!covered)
                    gain += dem_tree_inside(&grain->tree, p) ? 1 : -1;
            }
    return gain;
}

static void the_gain_of_a_ball_is_that_of_a_naive_count_on_every_instruction_set(void **state)
{
    (void)state;
    dem_mesh box = shape_box(2, 1, 1);
    dem_pack_grain grain = grain_of(&box);
    dem_lattice lattice;
    dem_error error;
    check_ok(dem_lattice_build(&grain, 1500, &lattice, &error), error);
    for (int s = 0; s < DEM_LEVELS; s++) {
        const dem_pack_kernels *kernels = dem_pack_kernels_choose(dem_level_name(s));
        if (!kernels)
            continue;
        dem_random r = random_stream(3, 0);
        dem_ball balls[8];
        dem_lattice_clear(&lattice);
        for (int b = 0; b < 8; b++) {
            double x = random_uniform(&r) - 0.5, y = random_uniform(&r) - 0.5, z = random_uniform(&r) - 0.5;
            balls[b] = (dem_ball){v3(x, y, z), 0.05 + 0.2 * random_uniform(&r)};
            check(kernels->lattice_gain(&lattice, balls[b], NULL) == naive_gain(&grain, &lattice, balls, b, balls[b]));
            kernels->lattice_gain(&lattice, balls[b], lattice.covered);
            // what is covered gains nothing; what lies beyond the rows kept counts again, and none of it does here
            check(kernels->lattice_gain(&lattice, balls[b], NULL) == 0);
        }
    }
    dem_lattice_release(&lattice);
    dem_pack_grain_close(&grain);
    dem_mesh_free(&box);
}

static void surface_samples_lie_on_the_surface_and_their_weights_add_up_to_its_area(void **state)
{
    (void)state;
    dem_mesh box = shape_box(2, 1, 0.5);
    dem_pack_grain grain = grain_of(&box);
    dem_lattice lattice;
    dem_samples samples;
    dem_error error;
    check_ok(dem_lattice_build(&grain, 4000, &lattice, &error), error);
    check_ok(dem_samples_build(&grain, &lattice, 2048, 1024, &samples, &error), error);
    check(samples.surface_blocks == 64 && samples.block_count > 64);
    double area = 0, volume = 0;
    for (size_t b = 0; b < samples.block_count; b++)
        for (int l = 0; l < DEM_BLOCK; l++) {
            const dem_sample_block *block = &samples.blocks[b];
            dem_vec3 p = v3((double)block->x[l], (double)block->y[l], (double)block->z[l]);
            const dem_block_bound *bound = &samples.bounds[b];
            dem_vec3 centre = v3((double)bound->x, (double)bound->y, (double)bound->z);
            check(v3_distance(p, centre) <= (double)bound->radius);
            if (b < samples.surface_blocks)
                check(dem_tree_closest(&grain.tree, p, INFINITY, NULL, NULL) < 1e-6);  // floats
            else
                check(dem_tree_inside(&grain.tree, p));
            *(b < samples.surface_blocks ? &area : &volume) += (double)block->weight[l];
        }
    check_close(area, grain.area, 1e-5);
    check_close(volume, grain.moments.volume, 1e-5);
    dem_samples_release(&samples);
    dem_lattice_release(&lattice);
    dem_pack_grain_close(&grain);
    dem_mesh_free(&box);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_grain_has_unit_size_and_its_centroid_at_zero_and_points_come_back),
        cmocka_unit_test(lattice_points_are_inside_where_rays_say_so),
        cmocka_unit_test(the_gain_of_a_ball_is_that_of_a_naive_count_on_every_instruction_set),
        cmocka_unit_test(surface_samples_lie_on_the_surface_and_their_weights_add_up_to_its_area),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
