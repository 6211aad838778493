// Soft contacts in whole scenes: the same bits however they are computed, ledgers that close, steps that hold, walls
// of every kind.
#include "sim/diagnose.h"
#include "soft_cases.h"
#include "walls.h"

static const double CELL = 0.0145;  // no two overlap at the start

// clouds of balls of 1 cm and spheres, shaken in a box
static model *shaken(size_t count)
{
    model *m = soft_lossy_model();
    model_cloud(m, 12, 0.01, 1);
    model_cloud(m, 40, 0.012, 2);
    model_sphere(m, 0.004);
    model_lattice(m, count, CELL, 1.0, 3);
    int side = (int)ceil(cbrt((double)count) - 1e-9);
    double edge = CELL * side;
    model_box(m, v3(0, 0, 0), v3(edge, edge, edge));
    m->scene.gravity = v3(0, 0, -9.81);
    return m;
}

// ---- the same bits

static void touches(dem_world *w)
{
    check(measured(w)->contacts > 20);
}

static void bits_do_not_depend_on_threads_or_instructions(void **state)
{
    (void)state;
    model *m = shaken(700);
    check_soft_bits(m, 400, touches);
    model_free(m);
}

static void a_run_goes_on_bit_for_bit(void **state)
{
    (void)state;
    model *m = shaken(100);
    m->scene.time.step = 0;
    dem_world *straight = check_soft_resumed(m);
    // another tau is another scene
    m->scene.soft.tau = 3e-5;
    dem_world *again = model_world(m, 1);
    void *bytes;
    size_t size;
    dem_error error;
    check_ok(dem_world_save(straight, &bytes, &size, &error), error);
    check(dem_world_restore(again, bytes, size, &error) == DEM_BAD_INPUT);
    free(bytes);
    dem_world_destroy(again);
    dem_world_destroy(straight);
    model_free(m);
}

// ---- conservation

static void the_ledger_closes(void **state)
{
    (void)state;
    for (int i = 0; i < 3; i++) {
        model *m = shaken(64);
        if (i == 1) {
            m->laws[0].normal = DEM_NORMAL_HERTZ;
            m->laws[0].friction = DEM_FRICTION_MINDLIN;
            m->materials[0].young = 1e7;
        }
        if (i == 2) {
            m->laws[0].effective_mass = DEM_MASS_BODY;
            m->walls[4].velocity = v3(0.05, 0, 0.02);
            m->walls[5].spin = v3(0, 0, 20);
            m->walls[5].through = v3(0.02, 0.02, 0);
        }
        m->scene.time.step = i == 1 ? 4e-6 : 8e-6;
        dem_world *w = model_world(m, 1);
        double worst = 0;
        for (int k = 0; k < 10; k++) {
            run_steps(w, 500);
            worst = largest(worst, measured(w)->energy.error);
        }
        const dem_energy *e = &measured(w)->energy;
        check(e->friction > 0.05 * e->start && e->viscous > 0.05 * e->start && (i < 2 || e->work != 0));
        // the dashpots against uneven speeds and twisting are of first order
        check(worst < 3e-3);
        dem_world_destroy(w);
        model_free(m);
    }
}

// rolling and twisting as single contacts have it, one memory for a patch
static void moments_against_turning_keep_the_ledger(void **state)
{
    (void)state;
    static const dem_rolling_law rolling[] = {DEM_ROLLING_EPSD, DEM_ROLLING_CONSTANT, DEM_ROLLING_BOUNDED};
    for (int i = 0; i < 3; i++) {
        model *m = shaken(64);
        m->laws[0].rolling = rolling[i];
        m->laws[0].rolling_coefficient = 0.2;
        m->laws[0].rolling_damping = 0.2;
        m->laws[0].twisting = i == 1 ? DEM_TWISTING_CONSTANT : DEM_TWISTING_MARSHALL;
        m->laws[0].twisting_coefficient = 0.1;
        m->scene.time.step = i == 0 ? 0 : 8e-6;
        dem_world *w = model_world(m, 1), *other = model_world(m, 2);
        run_steps(w, 2000);
        dem_world *again = model_resumed(m, w, 1);
        run_steps(w, 2000);
        run_steps(again, 2000);
        run_steps(other, 4000);
        check(dem_world_hash(again) == dem_world_hash(w) && dem_world_hash(other) == dem_world_hash(w));
        check_near(measured(w)->energy.error, 0, i == 0 ? 2e-2 : 3e-3);
        dem_world_destroy(other);
        dem_world_destroy(again);
        dem_world_destroy(w);
        model_free(m);
    }
}

static void momentum_stays(void **state)
{
    (void)state;
    model *m = shaken(64);
    m->scene.wall_count = 0;
    m->scene.gravity = v3(0, 0, 0);
    dem_world *w = model_world(m, 1);
    dem_vec3 p[2], l[2];
    total_momentum(w, &p[0], &l[0]);
    run_steps(w, 2000);
    total_momentum(w, &p[1], &l[1]);
    check(measured(w)->largest_overlap_ratio > 1e-3);
    double mass = 64 * 2500 * 0.25e-6;
    check_vec(p[1], p[0], 1e-12 * mass);
    check_vec(l[1], l[0], 1e-12 * mass * 0.05);
    dem_world_destroy(w);
    model_free(m);
}

// two clumps that meet with spin, told as they are or turned and moved, or one for the other
static void meet(dem_quat q, dem_vec3 boost, bool swap, dem_vec3 out[4])
{
    model *m = soft_lossy_model();
    uint32_t shape = model_cloud(m, 30, 0.01, 4);
    m->scene.time.step = 1e-5;
    for (int i = 0; i < 2; i++) {
        int k = swap ? 1 - i : i;
        dem_body_def *b = model_body(m, shape, quat_rotate(q, v3(0.0118 * k, 0.002 * k, 0)));
        b->orientation = quat_multiply(q, quat_unit(k == 0 ? (dem_quat){1, 2, 3, 4} : (dem_quat){4, -1, 2, 1}));
        b->velocity = v3_add(quat_rotate(q, v3(k == 0 ? 0.5 : -0.5, 0.1, 0)), boost);
        b->spin = quat_rotate(q, v3(20, -30, 50 * k));
    }
    dem_world *w = model_world(m, 1);
    run_steps(w, 800);
    check(measured(w)->energy.friction + measured(w)->energy.viscous > 0);
    dem_body_view v = dem_world_bodies(w);
    dem_quat back = quat_conjugate(q);
    for (int i = 0; i < 2; i++) {
        int k = swap ? 1 - i : i;
        out[2 * k] = quat_rotate(back, v3_sub(v.velocity[i], boost));
        out[2 * k + 1] = quat_rotate(back, v.spin[i]);
    }
    dem_world_destroy(w);
    model_free(m);
}

static void frames_and_order_do_not_matter(void **state)
{
    (void)state;
    dem_vec3 plain[4], other[4];
    meet((dem_quat){1, 0, 0, 0}, v3(0, 0, 0), false, plain);
    for (int i = 0; i < 3; i++) {
        dem_quat q = i == 0 ? quat_unit((dem_quat){3, 1, -2, 2}) : (dem_quat){1, 0, 0, 0};
        meet(q, i == 1 ? v3(1, -2, 3) : v3(0, 0, 0), i == 2, other);
        for (int k = 0; k < 4; k++)
            check_vec(other[k], plain[k], (k % 2 ? 100 : 1) * 1e-9);
    }
}

// ---- the automatic step

// without damping nothing hides a step that is too long; by stability alone, few steps are taken in a contact
static void automatic_steps_keep_the_energy(void **state)
{
    (void)state;
    for (int i = 0; i < 4; i++) {
        model *m = shaken(64);
        m->laws[0].damping = DEM_DAMPING_NONE;
        m->laws[0].friction = i % 2 ? DEM_FRICTION_LINEAR : DEM_FRICTION_NONE;
        m->scene.time.step = 0;
        m->scene.time.contact_steps = i < 2 ? 10 : 0;
        dem_world *w = model_world(m, 1);
        run_steps(w, 4000);
        check(fabs(measured(w)->energy.error) < (i < 2 ? 0.01 : 0.15));
        check(measured(w)->largest_overlap_ratio > 0.1);
        dem_world_destroy(w);
        model_free(m);
    }
}

// ---- walls

static void drop(bool mesh, int wall, dem_vec3 out[3])
{
    model *m = soft_lossy_model();
    model_body(m, model_cloud(m, 40, 0.01, 2), v3(0.001, 0.0007, 0.0065))->velocity = v3(0.2, 0.1, -0.5);
    m->bodies[0].spin = v3(10, 20, -5);
    m->scene.gravity = v3(0, 0, -9.81);
    double s = sqrt(0.5);
    if (!mesh && wall == 0)
        model_plane(m, v3(0, 0, 0), v3(0, 0, 1));
    else if (!mesh) {  // a groove along y
        model_plane(m, v3(0, 0, 0), v3(s, 0, s));
        model_plane(m, v3(0, 0, 0), v3(-s, 0, s));
    } else {
        dem_mesh sheet =
            wall == 0 ? wall_quad(v3(-0.1, -0.1, 0), v3(0.1, -0.1, 0), v3(0.1, 0.1, 0), v3(-0.1, 0.1, 0))
                      : wall_join(wall_quad(v3(-0.1, -0.1, 0.1), v3(0, -0.1, 0), v3(0, 0.1, 0), v3(-0.1, 0.1, 0.1)),
                                  wall_quad(v3(0, -0.1, 0), v3(0.1, -0.1, 0.1), v3(0.1, 0.1, 0.1), v3(0, 0.1, 0)));
        m->walls[0] = (dem_wall_def){.name = "sheet", .kind = DEM_WALL_MESH, .mesh = sheet};
        m->scene.wall_count = 1;
    }
    if (wall == 1)
        m->bodies[0].position.z += 0.004;
    dem_world *w = model_world(m, 1);
    size_t touched = 0;
    for (int i = 0; i < 300; i++) {
        run_steps(w, 40);
        touched = measured(w)->wall_contacts > touched ? measured(w)->wall_contacts : touched;
    }
    check(touched >= (wall == 0 ? 1 : 2));
    out[0] = dem_world_bodies(w).position[0];
    out[1] = dem_world_bodies(w).velocity[0];
    out[2] = dem_world_bodies(w).spin[0];
    check(fabs(measured(w)->energy.error) < 3e-3);
    dem_world_destroy(w);
    model_free(m);
}

static void meshes_are_as_the_planes_they_stand_for(void **state)
{
    (void)state;
#if !DEM_EMBREE
    skip();
#endif
    for (int wall = 0; wall < 2; wall++) {
        dem_vec3 plane[3], mesh[3];
        drop(false, wall, plane);
        drop(true, wall, mesh);
        for (int i = 0; i < 3; i++)
            check_vec(mesh[i], plane[i], i == 2 ? 1e-5 : 1e-8);
    }
}

// ---- with what else there is

// clumps of two kinds rain onto a slope and off it, out of the domain
static model *rain(dem_inlet_def *inlet, dem_mix_def mix[2])
{
    model *m = soft_lossy_model();
    mix[0] = (dem_mix_def){model_cloud(m, 12, 0.01, 1), 1, {.largest = INFINITY}};
    mix[1] = (dem_mix_def){
        model_cloud(m, 40, 0.012, 2), 1, {.law = DEM_SIZE_UNIFORM, .a = 0.008, .b = 0.014, .largest = INFINITY}};
    *inlet = (dem_inlet_def){.name = "top",
                             .low = {0, 0, 0.08},
                             .high = {0.06, 0.06, 0.11},
                             .mix = mix,
                             .mix_count = 2,
                             .rate = 1200,
                             .velocity = {0, 0, -0.5},
                             .spin_spread = 10,
                             .stop = INFINITY,
                             .seed = 5};
    m->scene.inlets = inlet;
    m->scene.inlet_count = 1;
    m->scene.gravity = v3(0, 0, -9.81);
    m->scene.time.step = 3e-5;
    m->scene.time.end = 1;
    m->scene.domain.low = v3(-0.1, -0.1, -0.1);
    m->scene.domain.high = v3(0.12, 0.2, 0.3);
    m->scene.domain.leaving = DEM_LEAVING_DELETE;
    model_plane(m, v3(0, 0, 0), v3(0.4, 0, 0.9));
    model_plane(m, v3(0, 0, 0), v3(0, 1, 0));
    model_plane(m, v3(0, 0.06, 0), v3(0, -1, 0));
    return m;
}

static void bodies_come_and_go(void **state)
{
    (void)state;
    dem_inlet_def inlet;
    dem_mix_def mix[2];
    model *m = rain(&inlet, mix);
    dem_world *w = model_world(m, 1), *other = model_world(m, 2);
    run_steps(w, 5000);
    dem_world *again = model_resumed(m, w, 1);
    run_steps(w, 5000);
    run_steps(other, 10000);
    run_steps(again, 5000);
    const dem_figures *f = measured(w);
    check(f->came > 150 && f->left > 5 && f->contacts > 20);
    check(fabs(f->energy.error) < 3e-3);
    check(dem_world_hash(other) == dem_world_hash(w));
    check(dem_world_hash(again) == dem_world_hash(w));
    dem_world_destroy(again);
    dem_world_destroy(other);
    dem_world_destroy(w);
    // of none that are there now, no overlap is likely
    m->scene.soft.tau = 0;
    dem_error error;
    check(dem_world_create(NULL, &m->scene, &w, &error) == DEM_BAD_INPUT && strstr(error.text, "soft.tau"));
    model_free(m);
}

// the force of its patch is that of the wall, whatever the number of spheres
static void servo_walls_reach_their_force(void **state)
{
    (void)state;
    model *m = soft_lossy_model();
    model_body(m, model_cloud(m, 40, 0.01, 2), v3(0, 0, 0.0066));
    model_plane(m, v3(0, 0, 0), v3(0, 0, 1));
    model_plane(m, v3(0, 0, 0.0135), v3(0, 0, -1))->servo =
        (dem_servo_def){.on = true, .direction = {0, 0, -1}, .target = 2, .gain = 0.5, .max_velocity = 0.02};
    m->scene.time.step = 0;
    dem_world *w = model_world(m, 1);
    for (int i = 0; i < 40; i++) {
        run_steps(w, 1000);
        measured(w);
        size_t count;
        const dem_wall_view *walls = dem_world_walls(w, &count);
        if (i > 30) {
            check_near(walls[1].force.z, 2, 0.01);
            check_near(walls[0].force.z, -2, 0.05);
        }
    }
    dem_world_destroy(w);
    model_free(m);
}

// two clumps that overlap and are bonded have no contact until the bond is broken
static void bonds_stand_for_whole_contacts(void **state)
{
    (void)state;
    for (int i = 0; i < 2; i++) {
        model *m = soft_lossy_model();
        dem_bond_def bond = dem_bond_defaults();
        bond.young = 1e7;
        bond.gap = 1e-4;
        bond.contact = i == 0 ? DEM_BOND_INSTEAD : DEM_BOND_PARALLEL;
        m->scene.bonds = &bond;
        m->scene.bond_count = 1;
        uint32_t shape = model_cloud(m, 40, 0.01, 2);
        model_body(m, shape, v3(0, 0, 0));
        model_body(m, shape, v3(0.0112, 0, 0));
        m->scene.time.step = 1e-6;
        dem_world *w = model_world(m, 1);
        size_t bonds = measured(w)->bonds;
        check(bonds > 0);
        check((measured(w)->contacts > 0) == (i == 1));
        dem_world_destroy(w);
        model_free(m);
    }
}

typedef struct heard {
    int warnings;
    char text[256];
} heard;

static void hear(void *user, dem_log_level level, const char *subject, const char *text)
{
    heard *h = user;
    (void)subject;
    if (level == DEM_LOG_WARNING && strstr(text, " tau (over 10)")) {
        h->warnings++;
        snprintf(h->text, sizeof h->text, "%s", text);
    }
}

static void overlaps_of_many_tau_are_told(void **state)
{
    (void)state;
    for (int i = 0; i < 2; i++) {
        model *m = shaken(8);
        m->scene.soft.tau = i == 0 ? 4e-4 : 2e-6;
        heard h = {0};
        dem_ctx ctx = {.log = hear, .user = &h};
        dem_world *w;
        dem_error error;
        check_ok(dem_world_create(&ctx, &m->scene, &w, &error), error);
        for (int k = 0; k < 10; k++) {
            run_steps(w, 300);
            measured(w);
            check_ok(dem_world_diagnose(w, &error), error);
        }
        double depth = measured(w)->largest_soft_overlap;
        check(i == 0 ? depth > 0.5 && depth < 10 : depth > 10);
        check((h.warnings > 0) == (i == 1));
        dem_world_destroy(w);
        model_free(m);
    }
}

// ---- telling

static void explain_tells_what_the_sum_inflates(void **state)
{
    (void)state;
    for (int i = 0; i < 2; i++) {
        model *m = shaken(8);
        m->scene.multiple = i == 0 ? DEM_MULTIPLE_SUM : DEM_MULTIPLE_SOFT;
        m->scene.soft.tau = 0;
        dem_world *w = model_world(m, 1);
        char *text;
        dem_error error;
        check_ok(dem_world_explain(w, &text, &error), error);
        check(strstr(text, " of 40\n") && !strstr(text, " of 1\n"));
        check((strstr(text, "as stiff as asked") != NULL) == (i == 0));
        check((strstr(text, "by the overlap of likely impacts; 3 tables of weights") != NULL) == (i == 1));
        free(text);
        dem_world_destroy(w);
        model_free(m);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bits_do_not_depend_on_threads_or_instructions),
        cmocka_unit_test(a_run_goes_on_bit_for_bit),
        cmocka_unit_test(the_ledger_closes),
        cmocka_unit_test(moments_against_turning_keep_the_ledger),
        cmocka_unit_test(momentum_stays),
        cmocka_unit_test(frames_and_order_do_not_matter),
        cmocka_unit_test(automatic_steps_keep_the_energy),
        cmocka_unit_test(meshes_are_as_the_planes_they_stand_for),
        cmocka_unit_test(bodies_come_and_go),
        cmocka_unit_test(servo_walls_reach_their_force),
        cmocka_unit_test(bonds_stand_for_whole_contacts),
        cmocka_unit_test(overlaps_of_many_tau_are_told),
        cmocka_unit_test(explain_tells_what_the_sum_inflates),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
