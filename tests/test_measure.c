// What a measurement shows: everything at the time of the positions, in the order of the scene.
#include "worlds.h"

// ---- motion

static void free_fall_is_exact(void **state)
{
    (void)state;
    model *m = model_new();
    m->scene.gravity = v3(0.7, -1.3, -9.81);
    m->scene.time.step = 1e-4;
    model_cloud(m, 5, 0.02, 1);
    dem_body_def *b = model_body(m, 0, v3(0.5, -0.25, 3));
    b->velocity = v3(1, 2, 4);
    b->spin = v3(10, -5, 3);
    dem_world *w = model_world(m, 1);
    check_vec(dem_world_bodies(w).velocity[0], v3(1, 2, 4), 1e-15);
    check_vec(dem_world_bodies(w).spin[0], v3(10, -5, 3), 1e-14);
    for (int i = 1; i <= 10; i++) {
        run_steps(w, 100);  // a step may round by 1e-16 of the speed
        measured(w);
        double t = i * 100 * 1e-4;
        check_near(dem_world_time(w), t, 1e-16);
        dem_vec3 v = v3_along(v3(1, 2, 4), t, m->scene.gravity);
        dem_vec3 x = v3_along(v3_along(v3(0.5, -0.25, 3), t, v3(1, 2, 4)), t * t / 2, m->scene.gravity);
        check_vec(dem_world_bodies(w).velocity[0], v, 1e-12);
        check_vec(dem_world_bodies(w).position[0], x, 1e-12);
    }
    dem_world_destroy(w);
    model_free(m);
}

// a sphere between two walls swings: speeds are those of the time of the positions, to the second order
static void velocities_belong_to_the_time_of_the_positions(void **state)
{
    (void)state;
    model *m = model_new();
    double r = 0.01, mass = 2500 * 4 * DEM_PI / 3 * r * r * r, rate = sqrt(2e4 / mass), error[2];
    model_body(m, model_sphere(m, r), v3(0, 0, 0))->velocity = v3(0, 0, 0.01);
    model_plane(m, v3(0, 0, -0.009), v3(0, 0, 1));
    model_plane(m, v3(0, 0, 0.009), v3(0, 0, -1));
    for (int fine = 0; fine < 2; fine++) {
        m->scene.time.step = 0.02 / rate / (fine ? 2 : 1);
        dem_world *w = model_world(m, 1);
        error[fine] = 0;
        for (int i = 0; i < 400; i++) {
            run_steps(w, fine ? 2 : 1);
            measured(w);
            double want = 0.01 * cos(rate * dem_world_time(w));
            error[fine] = fmax(error[fine], fabs(dem_world_bodies(w).velocity[0].z - want) / 0.01);
        }
        dem_world_destroy(w);
    }
    // half a step off would be 1e-2; the phase drifts by z^3 / 24 a step
    check(error[0] < 400 * pow(0.02, 3) / 24 + 1e-3 && error[1] < error[0] / 3.8);
    model_free(m);
}

// forces are what changes the momenta of the rows from before to behind the time, to the last bits
static void forces_and_moments_are_the_changes_of_momentum(void **state)
{
    (void)state;
    model *m = model_new();
    m->scene.gravity = v3(0, 0, -9.81);
    m->laws[0].friction = DEM_FRICTION_LINEAR;
    m->laws[0].friction_coefficient = 0.5;
    m->laws[0].damping = DEM_DAMPING_RESTITUTION;
    m->laws[0].restitution = 0.5;
    model_cloud(m, 9, 0.02, 1);
    model_dumbbell(m, 0.006, 0.008);
    model_lattice(m, 40, 0.019, 1, 1);
    m->bodies[7].scale = 1.2;
    model_box(m, v3(-0.005, -0.005, -0.005), v3(0.08, 0.08, 0.08));
    m->walls[2].velocity = v3(0.3, 0, 0.1);
    m->walls[4].kind = DEM_WALL_CYLINDER;
    m->walls[4].normal = v3(0, 1, 0);
    m->walls[4].point = v3(0.04, 0, 0.04);
    m->walls[4].radius = 0.055;
    m->walls[4].spin = v3(0, 3, 0);
    dem_world *w = model_world(m, 1);
    size_t touches = 0;
    for (int i = 0; i < 50; i++) {
        run_steps(w, 60);
        touches += measured(w)->contacts + measured(w)->wall_contacts;
        dem_body_view v = dem_world_bodies(w);
        double before[40][6];
        for (size_t k = 0; k < v.count; k++)
            memcpy(before[k], w->bodies.momentum + DEM_ROW * w->bodies.place[k], sizeof before[k]);
        run_steps(w, 1);
        for (size_t k = 0; k < v.count; k++) {
            const double *p = w->bodies.momentum + DEM_ROW * w->bodies.place[k], *q = before[k];
            dem_vec3 force = v3_along(v.force[k], v.mass[k], m->scene.gravity);
            double size = v.mass[k] * 10, rounding = 1e-11 * size + 1e-15 * v.mass[k] * 3 / 1e-5;
            check_vec(v3_scale(v3(p[0] - q[0], p[1] - q[1], p[2] - q[2]), 1e5), force, rounding);
            check_vec(v3_scale(v3(p[3] - q[3], p[4] - q[4], p[5] - q[5]), 1e5), v.moment[k], 0.02 * rounding);
        }
    }
    check(touches > 300);
    dem_world_destroy(w);
    model_free(m);
}

// ---- contacts

static void the_list_of_contacts_makes_up_all_forces(void **state)
{
    (void)state;
    model *m = model_new();
    m->scene.gravity = v3(0, 0, -9.81);
    m->laws[0].friction = DEM_FRICTION_LINEAR;
    m->laws[0].friction_coefficient = 0.5;
    m->scene.damping.local = 0.7;  // comes to rest
    model_cloud(m, 9, 0.02, 1);
    model_dumbbell(m, 0.006, 0.008);
    model_lattice(m, 40, 0.019, 1, 1);
    m->bodies[7].scale = 1.2;
    model_box(m, v3(-0.005, -0.005, -0.005), v3(0.08, 0.08, 0.08));
    dem_world *w = model_world(m, 1);
    run_steps(w, 15000);
    measured(w);
    dem_body_view v = dem_world_bodies(w);
    size_t count, walls, on_wall[6] = {0};
    const dem_contact *contacts = dem_world_contacts(w, &count);
    const dem_wall_view *wall = dem_world_walls(w, &walls);
    dem_vec3 force[40] = {0}, moment[40] = {0}, reaction[6] = {0}, about[6] = {0};
    for (size_t i = 0; i < count; i++) {
        const dem_contact *c = &contacts[i];
        dem_vec3 f = v3_along(c->friction_force, -c->normal_force, c->normal);
        check_near(v3_norm(c->normal), 1, 1e-14);
        check_near(v3_dot(c->friction_force, c->normal), 0, 1e-14 * c->normal_force + 1e-18);
        check_close(c->normal_force, 1e4 * c->overlap, 1e-12);
        force[c->body] = v3_add(force[c->body], f);
        moment[c->body] = v3_add(moment[c->body], v3_cross(v3_sub(c->point, v.position[c->body]), f));
        if (c->wall == UINT32_MAX) {
            force[c->other] = v3_sub(force[c->other], f);
            moment[c->other] = v3_sub(moment[c->other], v3_cross(v3_sub(c->point, v.position[c->other]), f));
        } else {
            check(c->other == UINT32_MAX && c->other_sphere == 0);
            reaction[c->wall] = v3_sub(reaction[c->wall], f);
            about[c->wall] = v3_sub(about[c->wall], v3_cross(c->point, f));
            on_wall[c->wall]++;
        }
    }
    check(count == measured(w)->contacts + measured(w)->wall_contacts && count > 20);
    for (size_t k = 0; k < v.count; k++) {
        check_vec(force[k], v.force[k], 1e-13);
        check_vec(moment[k], v.moment[k], 1e-15);
    }
    for (size_t k = 0; k < walls; k++) {
        check_vec(wall[k].force, reaction[k], 1e-13);
        check_vec(wall[k].moment, about[k], 1e-14);  // `through` is the origin
        check(wall[k].contacts == on_wall[k]);
    }
    dem_world_destroy(w);
    model_free(m);
}

// geometry from the shapes themselves: where the spheres stand, which they are, how far they overlap
static void each_contact_names_its_spheres_and_point(void **state)
{
    (void)state;
    model *m = model_new();
    uint32_t dumbbell = model_dumbbell(m, 0.01, 0.03), sphere = model_sphere(m, 0.005);
    model_body(m, sphere, v3(0.015, 0, 0.0148));  // above the right end of the dumbbell
    dem_body_def *b = model_body(m, dumbbell, v3(0, 0, 0));
    b->scale = 1;
    model_plane(m, v3(0, 0, -0.0099), v3(0, 0, 1));
    dem_world *w = model_world(m, 1);
    const dem_figures *f = measured(w);
    size_t count;
    const dem_contact *c = dem_world_contacts(w, &count);
    assert_int_equal(count, 3);
    assert_int_equal(f->contacts, 1);
    assert_int_equal(f->wall_contacts, 2);
    assert_int_equal(f->spheres, 3);
    double sign = c[0].body == 0 ? -1 : 1;  // out of `body`
    uint32_t right = c[0].body == 0 ? c[0].other_sphere : c[0].sphere;
    check(c[0].body + c[0].other == 1 && c[0].wall == UINT32_MAX);
    check(dem_clump_view(m->clumps[dumbbell]).balls[right].centre.x > 0);
    check_vec(c[0].normal, v3(0, 0, sign), 1e-15);
    check_near(c[0].overlap, 2e-4, 1e-16);
    check_vec(c[0].point, v3(0.015, 0, 0.01 - 1e-4), 1e-16);  // in the middle of the overlap
    check_close(c[0].normal_force, 2, 1e-12);
    for (int i = 1; i < 3; i++) {
        check(c[i].body == 1 && c[i].other == UINT32_MAX && c[i].wall == 0);
        check_vec(c[i].normal, v3(0, 0, -1), 1e-15);
        check_near(c[i].overlap, 1e-4, 1e-16);
        double x = dem_clump_view(m->clumps[dumbbell]).balls[c[i].sphere].centre.x;
        check_vec(c[i].point, v3(x, 0, -0.0099), 1e-16);  // on the wall
    }
    // over the smaller radius; the largest of the run stays
    check_close(f->overlap_ratio, 2e-4 / 0.005, 1e-12);
    run_steps(w, 600);
    check(measured(w)->largest_overlap_ratio >= 2e-4 / 0.005 * (1 - 1e-12));
    check(measured(w)->overlap_ratio < measured(w)->largest_overlap_ratio);
    dem_world_destroy(w);
    model_free(m);
}

static void coordination_counts_bodies_and_walls_not_spheres(void **state)
{
    (void)state;
    model *m = model_new();
    uint32_t dumbbell = model_dumbbell(m, 0.01, 0.03);
    // two lie side by side, touching with two spheres each, both on the second wall; a third is alone
    model_body(m, dumbbell, v3(0, 0, 0));
    model_body(m, dumbbell, v3(0, 0.0199, 0));
    model_body(m, dumbbell, v3(0, 1, 0.5));
    model_plane(m, v3(0, 0, 5), v3(0, 0, -1));
    model_plane(m, v3(0, 0, -0.0099), v3(0, 0, 1));
    dem_world *w = model_world(m, 1);
    const dem_figures *f = measured(w);
    const uint32_t *n = dem_world_bodies(w).coordination;
    assert_int_equal(f->contacts, 2);
    assert_int_equal(f->wall_contacts, 4);
    assert_int_equal(n[0], 2);
    assert_int_equal(n[1], 2);
    assert_int_equal(n[2], 0);
    check_near(f->coordination, 4.0 / 3, 1e-15);
    dem_world_destroy(w);
    model_free(m);
}

// ---- walls

static void walls_carry_the_weight_of_what_rests_on_them(void **state)
{
    (void)state;
    model *m = model_new();
    m->scene.gravity = v3(2, 0, -9.81);
    m->laws[0].friction = DEM_FRICTION_LINEAR;
    m->laws[0].friction_coefficient = 0.5;
    m->laws[0].damping = DEM_DAMPING_RESTITUTION;
    m->laws[0].restitution = 0.2;
    m->scene.damping.local = 0.5;
    model_dumbbell(m, 0.006, 0.008);
    model_lattice(m, 18, 0.02, 0.1, 1);
    model_box(m, v3(0, 0, 0), v3(0.06, 0.06, 0.2));
    for (int k = 0; k < 6; k++)
        m->walls[k].through = v3(0.03, 0.03, 0);
    dem_world *w = model_world(m, 1);
    run_steps(w, 60000);
    const dem_figures *f = measured(w);
    check(f->fastest < 1e-5);
    size_t walls;
    const dem_wall_view *wall = dem_world_walls(w, &walls);
    dem_body_view v = dem_world_bodies(w);
    dem_vec3 force = v3(0, 0, 0), moment = v3(0, 0, 0), weight = force, turning = force;
    for (size_t k = 0; k < walls; k++) {
        force = v3_add(force, wall[k].force);
        moment = v3_add(moment, wall[k].moment);
    }
    for (size_t i = 0; i < v.count; i++) {
        dem_vec3 g = v3_scale(m->scene.gravity, v.mass[i]);
        weight = v3_add(weight, g);
        turning = v3_add(turning, v3_cross(v3_sub(v.position[i], v3(0.03, 0.03, 0)), g));
    }
    // as far as they have come to rest
    check_vec(force, weight, 1e-4 * v3_norm(weight));
    check_vec(moment, turning, 1e-4 * v3_norm(weight) * 0.06);
    dem_world_destroy(w);
    model_free(m);
}

static void moving_walls_are_shown_where_they_are(void **state)
{
    (void)state;
    model *m = model_new();
    model_body(m, model_sphere(m, 0.01), v3(0, 0, 0));
    dem_wall_def *d = model_plane(m, v3(0, 0, -0.0099), v3(0, 0, 1));
    d->velocity = v3(0, 0, 0.1);
    d->through = v3(1, 0, 0);
    d->spin = v3(0, 0, 20);
    dem_world *w = model_world(m, 1);
    run_steps(w, 30);
    measured(w);
    size_t walls;
    const dem_wall_view *wall = dem_world_walls(w, &walls);
    double t = dem_world_time(w), angle = 20 * t;
    check_near(wall->orientation.w, cos(angle / 2), 1e-15);
    check_near(wall->orientation.z, sin(angle / 2), 1e-15);
    // the point (1, 0, 0) stays on the axis
    check_vec(v3_add(wall->position, quat_rotate(wall->orientation, v3(1, 0, 0))), v3(1, 0, 0.1 * t), 1e-15);
    // pushed from the sphere, a metre aside of the axis: r x F
    check(wall->force.z < -0.5);
    dem_vec3 arm = v3_sub(dem_world_contacts(w, &walls)->point, v3(1, 0, 0.1 * t));
    check_vec(wall->moment, v3_cross(arm, wall->force), 1e-13);
    dem_world_destroy(w);
    model_free(m);
}

// ---- figures and order

static void the_highest_point_and_the_centre_of_all(void **state)
{
    (void)state;
    for (int tilted = 0; tilted < 2; tilted++) {
        model *m = model_new();
        uint32_t dumbbell = model_dumbbell(m, 0.01, 0.03), sphere = model_sphere(m, 0.02);
        dem_body_def *b = model_body(m, dumbbell, v3(0.1, 0, 0.2));
        b->orientation = (dem_quat){sqrt(0.5), 0, sqrt(0.5), 0};  // its axis along z
        b->scale = 1.5;
        model_body(m, sphere, v3(0, 0.3, 0.21));
        // against gravity; z where there is none
        m->scene.gravity = tilted ? v3(0, -5, 0) : v3(0, 0, 0);
        dem_world *w = model_world(m, 1);
        const dem_figures *f = measured(w);
        check_near(f->highest, tilted ? 0.3 + 0.02 : 0.2 + 1.5 * (0.015 + 0.01), 1e-15);
        const double *mass = dem_world_bodies(w).mass;
        double ball = 2500 * 4 * DEM_PI / 3;
        check_close(mass[0], 1.5 * 1.5 * 1.5 * 2 * ball * 1e-6, 1e-13);
        check_close(mass[1], ball * 8e-6, 1e-13);
        double all = mass[0] + mass[1];
        check_vec(f->centre, v3(0.1 * mass[0] / all, 0.3 * mass[1] / all, (0.2 * mass[0] + 0.21 * mass[1]) / all),
                  1e-15);
        check(f->bodies == 2 && f->spheres == 3 && f->time == 0 && f->step == 0);
        dem_world_destroy(w);
        model_free(m);
    }
}

static void the_fastest_point_includes_the_spin(void **state)
{
    (void)state;
    model *m = model_new();
    model_dumbbell(m, 0.01, 0.03);
    model_body(m, 0, v3(0, 0, 0))->velocity = v3(0, 0, 3);
    dem_body_def *b = model_body(m, 0, v3(1, 0, 0));
    b->velocity = v3(0, 1, 0);
    b->spin = v3(0, 0, 200);
    dem_world *w = model_world(m, 1);
    check_near(measured(w)->fastest, 1 + 200 * 0.025, 1e-12);
    dem_world_destroy(w);
    model_free(m);
}

// the views keep the order of the scene, whatever that of the rows
static void bodies_are_shown_in_the_order_of_the_scene(void **state)
{
    (void)state;
    model *m = model_new();
    model_sphere(m, 0.001);
    model_dumbbell(m, 0.002, 0.003);
    dem_random r = random_stream(1, 5);
    for (int i = 0; i < 300; i++) {
        dem_body_def *b = model_body(m, (uint32_t)(i % 2), random_in(&r, v3(-1, -1, -1), v3(1, 1, 1)));
        b->velocity = random_in(&r, v3(-1, -1, -1), v3(1, 1, 1));
        b->spin = random_in(&r, v3(-9, -9, -9), v3(9, 9, 9));
        b->orientation = random_quat(&r);
        b->scale = 1 + random_uniform(&r);
    }
    dem_world *w = model_world(m, 1);
    size_t moved = 0;
    for (size_t i = 0; i < 300; i++)
        moved += w->bodies.place[i] != i;
    check(moved > 250);
    for (int steps = 0; steps < 2; steps++) {
        dem_body_view v = dem_world_bodies(w);
        assert_int_equal(v.count, 300);
        for (size_t i = 0; i < v.count; i++) {
            const dem_body_def *b = &m->bodies[i];
            check(v.shape[i] == b->shape && v.scale[i] == b->scale);
            check_vec(v.position[i], v3_along(b->position, dem_world_time(w), b->velocity), 1e-14);
            check_vec(v.velocity[i], b->velocity, 1e-14);
            if (steps)
                continue;
            check_vec(v.spin[i], b->spin, 1e-13);
            dem_quat q = v.orientation[i], o = b->orientation;
            check_near(fabs(q.w * o.w + q.x * o.x + q.y * o.y + q.z * o.z), 1, 1e-14);
        }
        run_steps(w, 20);
        measured(w);
    }
    dem_world_destroy(w);
    model_free(m);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(free_fall_is_exact),
        cmocka_unit_test(velocities_belong_to_the_time_of_the_positions),
        cmocka_unit_test(forces_and_moments_are_the_changes_of_momentum),
        cmocka_unit_test(the_list_of_contacts_makes_up_all_forces),
        cmocka_unit_test(each_contact_names_its_spheres_and_point),
        cmocka_unit_test(coordination_counts_bodies_and_walls_not_spheres),
        cmocka_unit_test(walls_carry_the_weight_of_what_rests_on_them),
        cmocka_unit_test(moving_walls_are_shown_where_they_are),
        cmocka_unit_test(the_highest_point_and_the_centre_of_all),
        cmocka_unit_test(the_fastest_point_includes_the_spin),
        cmocka_unit_test(bodies_are_shown_in_the_order_of_the_scene),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
