// Bodies on mesh walls: a triangulated plane is a plane, whatever its triangles, still or moving.
#include "worlds.h"

// a plate of 2 n^2 triangles over the square of edge `size` about the origin, its diagonals in turn
static dem_mesh plate(int n, double size, double slant)
{
    dem_mesh mesh = {.vertices = malloc((size_t)(n + 1) * (size_t)(n + 1) * sizeof(dem_vec3)),
                     .triangles = malloc(6 * (size_t)n * (size_t)n * sizeof(uint32_t))};
    check(mesh.vertices && mesh.triangles);
    for (int j = 0; j <= n; j++)
        for (int i = 0; i <= n; i++) {
            double x = size * ((double)i / n - 0.5), y = size * ((double)j / n - 0.5);
            mesh.vertices[mesh.vertex_count++] = v3(x + slant * y, y, 0);
        }
    for (int j = 0; j < n; j++)
        for (int i = 0; i < n; i++) {
            uint32_t a = (uint32_t)(j * (n + 1) + i), b = a + 1, c = a + (uint32_t)n + 1, d = c + 1;
            uint32_t even[6] = {a, b, d, a, d, c}, odd[6] = {a, b, c, b, d, c};
            memcpy(mesh.triangles + 3 * mesh.triangle_count, (i + j) % 2 ? odd : even, sizeof even);
            mesh.triangle_count += 2;
        }
    return mesh;
}

// three balls in a triangle; mass and moments of the separate balls
static uint32_t three_balls(model *m, double r)
{
    double ball = 2500 * 4 * DEM_PI / 3 * r * r * r, d = 0.8 * r, own = 1.2 * ball * r * r;
    double in_plane = own + 1.5 * ball * d * d, across = own + 3 * ball * d * d;
    dem_ball balls[3];
    for (int i = 0; i < 3; i++)
        balls[i] = (dem_ball){v3(d * cos(2 * DEM_PI / 3 * i), d * sin(2 * DEM_PI / 3 * i), 0), r};
    return model_clump(m, balls, 3, 3 * ball, (double[]){in_plane, in_plane, across});
}

static model *rolling_model(void)
{
    model *m = model_new();
    m->scene.gravity = v3(0, 0, -9.81);
    m->laws[0].stiffness = 1e5;
    m->laws[0].damping = DEM_DAMPING_RESTITUTION;
    m->laws[0].restitution = 0.5;
    m->laws[0].friction = DEM_FRICTION_LINEAR;
    m->laws[0].friction_coefficient = 0.5;
    three_balls(m, 0.01);
    dem_body_def *b = model_body(m, 0, v3(-0.1, 0.003, 0.0185));
    b->orientation = quat_unit((dem_quat){0.7, 0.7, 0.1, 0.05});
    b->velocity = v3(0.8, 0.05, -0.1);
    return m;
}

static dem_vec3 end_of_roll(model *m, double time, dem_quat *orientation)
{
    dem_world *w = model_world(m, 1);
    run_steps(w, (uint64_t)llround(time / m->scene.time.step));
    measured(w);
    *orientation = dem_world_bodies(w).orientation[0];
    dem_vec3 end = dem_world_bodies(w).position[0];
    dem_world_destroy(w);
    return end;
}

// the clump trips over its own balls, so that a difference of one bit grows; 1e-7 m after 0.2 s and about 16 cm
static void a_clump_rolls_over_a_plate_as_over_a_plane(void **state)
{
    (void)state;
    model *flat = rolling_model();
    model_plane(flat, v3(0, 0, 0), v3(0, 0, 1));
    dem_quat q, q_flat;
    dem_vec3 want = end_of_roll(flat, 0.2, &q_flat);
    check(want.x > -0.03);
    const int parts[] = {1, 7, 40, 160};
    for (int i = 0; i < 4; i++) {
        model *m = rolling_model();
        dem_wall_def *wall = model_plane(m, v3(0, 0, 0), v3(0, 0, 1));
        wall->kind = DEM_WALL_MESH;
        wall->mesh = plate(parts[i], 0.6, i % 2 ? 0.3 : 0);
        dem_vec3 end = end_of_roll(m, 0.2, &q);
        check_vec(end, want, 1e-7);
        check_near(fabs(q.w * q_flat.w + q.x * q_flat.x + q.y * q_flat.y + q.z * q_flat.z), 1, 1e-10);
        model_free(m);
    }
    model_free(flat);
}

// a belt: the plate runs under the body, which sees the same as on a plane whose surface moves
static void a_running_plate_carries_as_a_running_plane_does(void **state)
{
    (void)state;
    dem_vec3 end[2];
    dem_quat q;
    for (int mesh = 0; mesh < 2; mesh++) {
        model *m = rolling_model();
        m->bodies[0].velocity = v3(0, 0, -0.1);
        dem_wall_def *wall = model_plane(m, v3(0, 0, 0), v3(0, 0, 1));
        wall->velocity = v3(0.5, 0.2, 0);
        if (mesh) {
            wall->kind = DEM_WALL_MESH;
            wall->mesh = plate(60, 2, 0);
        }
        end[mesh] = end_of_roll(m, 0.15, &q);
        model_free(m);
    }
    check(end[0].x > -0.09);
    check_vec(end[1], end[0], 1e-7);
}

// a turntable in its plane, about an axis aside
static void a_turning_plate_turns_as_a_plane_does(void **state)
{
    (void)state;
    dem_vec3 end[2];
    dem_quat q;
    for (int mesh = 0; mesh < 2; mesh++) {
        model *m = rolling_model();
        m->bodies[0].velocity = v3(0, 0, -0.1);
        dem_wall_def *wall = model_plane(m, v3(0, 0, 0), v3(0, 0, 1));
        wall->spin = v3(0, 0, 4);
        wall->through = v3(0.1, 0.02, 0);
        if (mesh) {
            wall->kind = DEM_WALL_MESH;
            wall->mesh = plate(50, 1, 0.1);
        }
        end[mesh] = end_of_roll(m, 0.15, &q);
        model_free(m);
    }
    check_vec(end[1], end[0], 1e-7);
}

// a sphere that lies in a groove of two faces at right angles: two contacts that hold its weight
static void a_sphere_lies_in_a_groove_on_two_contacts(void **state)
{
    (void)state;
    model *m = model_new();
    double r = 0.01;
    m->scene.gravity = v3(0, 0, -9.81);
    m->laws[0].damping = DEM_DAMPING_RESTITUTION;
    m->laws[0].restitution = 0.3;
    model_sphere(m, r);
    model_body(m, 0, v3(0, 0, sqrt(2) * r));
    dem_wall_def *wall = model_plane(m, v3(0, 0, 0), v3(0, 0, 1));
    wall->kind = DEM_WALL_MESH;
    wall->mesh = plate(10, 0.4, 0);
    for (size_t i = 0; i < wall->mesh.vertex_count; i++) {
        dem_vec3 *v = &wall->mesh.vertices[i];
        v->z = fabs(v->x);
    }
    dem_world *w = model_world(m, 1);
    run_steps(w, 40000);
    const dem_figures *f = measured(w);
    double weight = 9.81 * 2500 * 4 * DEM_PI / 3 * r * r * r;
    assert_int_equal(f->wall_contacts, 2);
    size_t count;
    const dem_contact *c = dem_world_contacts(w, &count);
    for (int i = 0; i < 2; i++)
        check_close(c[i].normal_force, weight / sqrt(2), 1e-4);
    check_vec(dem_world_walls(w, &count)[0].force, v3(0, 0, -weight), 1e-4 * weight);
    dem_world_destroy(w);
    model_free(m);
}

// a box of meshes full of clumps keeps them, and the same bits come back for two threads and after a restart
static void meshes_give_the_same_bits_for_threads_and_restarts(void **state)
{
    (void)state;
    model *m = model_new();
    m->scene.gravity = v3(0, 0, -9.81);
    m->laws[0].friction = DEM_FRICTION_LINEAR;
    m->laws[0].friction_coefficient = 0.4;
    m->laws[0].damping = DEM_DAMPING_RESTITUTION;
    m->laws[0].restitution = 0.5;
    model_cloud(m, 8, 0.02, 1);
    model_lattice(m, 600, 0.022, 1, 1);
    dem_wall_def *floor = model_plane(m, v3(0, 0, 0), v3(0, 0, 1));
    floor->kind = DEM_WALL_MESH;
    floor->mesh = plate(20, 1, 0);
    floor->spin = v3(0.02, 0, 0.3);
    dem_world *one = model_world(m, 1), *two = model_world(m, 2);
    run_steps(one, 1500);
    run_steps(two, 1500);
    check(measured(one)->wall_contacts > 3);
    assert_int_equal(dem_world_hash(one), dem_world_hash(two));
    void *bytes;
    size_t size;
    dem_error error;
    check_ok(dem_world_save(one, &bytes, &size, &error), error);
    run_steps(two, 400);
    dem_world_destroy(one);
    one = model_world(m, 1);
    check_ok(dem_world_restore(one, bytes, size, &error), error);
    run_steps(one, 400);
    assert_int_equal(dem_world_hash(one), dem_world_hash(two));
    free(bytes);
    dem_world_destroy(one);
    dem_world_destroy(two);
    model_free(m);
}

// What is kept about which triangles a ball may touch must not show: a world that forgets it before every step finds the
// same contacts to the bit, on a mesh at rest, on one that turns into the bodies, faster and slower, and in a funnel.
static void what_is_kept_of_the_triangles_near_a_ball_changes_nothing(void **state)
{
    (void)state;
    for (int way = 0; way < 3; way++) {
        model *m = model_new();
        m->scene.gravity = v3(0, 0, -9.81);
        m->laws[0].friction = DEM_FRICTION_LINEAR;
        m->laws[0].friction_coefficient = 0.4;
        m->laws[0].damping = DEM_DAMPING_RESTITUTION;
        m->laws[0].restitution = 0.5;
        model_cloud(m, 6, 0.02, 1);
        model_lattice(m, 80, 0.03, 1, 1);
        for (size_t i = 0; i < 80; i++)
            m->bodies[i].velocity = v3(0.1, 0, -1);
        dem_wall_def *wall = model_plane(m, v3(0.07, 0.07, -0.01), v3(0, 0, 1));
        if (way < 2) {
            wall->kind = DEM_WALL_MESH;
            wall->mesh = plate(60, 1, 0.2);
        } else {
            wall->kind = DEM_WALL_CONE;
            wall->radius = 0.01;
            wall->end_radius = 0.3;
            wall->length = 0.3;
        }
        static const dem_oscillation shake = {.shift = {0, 0.002, 0.004}, .frequency = 30};
        if (way == 1) {
            wall->oscillations = &shake;
            wall->oscillation_count = 1;
        }
        dem_world *kept = model_world(m, 1), *forgetful = model_world(m, 1);
        size_t touched = 0;
        for (int step = 0; step < 3000; step++) {
            for (size_t i = 0; i < forgetful->segment_count; i++) {
                dem_mesh_touches *t = &forgetful->mesh_touches[i];
                check(dem_mesh_touches_forget(t));
                for (size_t k = 0; k < t->count; k++)
                    touched += t->items[k].last_count;
            }
            run_steps(forgetful, 1);
        }
        run_steps(kept, 3000);
        check(touched > 1000);
        assert_int_equal(dem_world_hash(kept), dem_world_hash(forgetful));
        dem_world_destroy(kept);
        dem_world_destroy(forgetful);
        model_free(m);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_clump_rolls_over_a_plate_as_over_a_plane),
        cmocka_unit_test(a_running_plate_carries_as_a_running_plane_does),
        cmocka_unit_test(a_turning_plate_turns_as_a_plane_does),
        cmocka_unit_test(a_sphere_lies_in_a_groove_on_two_contacts),
        cmocka_unit_test(meshes_give_the_same_bits_for_threads_and_restarts),
        cmocka_unit_test(what_is_kept_of_the_triangles_near_a_ball_changes_nothing),
    };
#if DEM_EMBREE
    return cmocka_run_group_tests(tests, NULL, NULL);
#else
    (void)tests;
    return 0;
#endif
}
