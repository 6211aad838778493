// Bonds of bodies that come through inlets and leave the domain: who is bonded, what goes along, energy, restarts.
#include "same_bits.h"
#include "sim/bonds.h"
#include "sim/lists.h"
#include "sim/population.h"
#include "sim/validate.h"

static const double RADIUS = 0.01;

typedef struct rain {
    dem_mix_def mix;
    dem_inlet_def inlet;
    dem_bond_def bonds[2];
} rain;

static rain rain_def;  // as a scene only points to it

// spheres fall dense out of a box and through empty space, and leave below; what is near is bonded at two times
static model *rain_new(void)
{
    model *m = model_new();
    m->laws[0].damping = DEM_DAMPING_RESTITUTION;
    m->laws[0].restitution = 0.5;
    m->scene.gravity = v3(0, 0, -9.81);
    m->scene.time.step = 5e-5;
    m->scene.time.end = NAN;  // how many will come is not known: rows grow
    m->scene.domain.low = v3(-0.5, -0.5, -0.1);
    m->scene.domain.high = v3(0.5, 0.5, 0.5);
    m->scene.domain.leaving = DEM_LEAVING_DELETE;
    rain_def.mix = (dem_mix_def){model_sphere(m, RADIUS), 1, {.largest = INFINITY}};
    rain_def.inlet = (dem_inlet_def){.name = "cloud",
                                     .low = {0, 0, 0.2},
                                     .high = {0.1, 0.1, 0.25},
                                     .mix = &rain_def.mix,
                                     .mix_count = 1,
                                     .rate = 800,
                                     .velocity = {0, 0, -1},
                                     .velocity_spread = 0.05,
                                     .stop = INFINITY,
                                     .seed = 3};
    m->scene.inlets = &rain_def.inlet;
    m->scene.inlet_count = 1;
    for (int i = 0; i < 2; i++) {
        rain_def.bonds[i] = dem_bond_defaults();
        rain_def.bonds[i].name = i ? "late" : "early";
        rain_def.bonds[i].young = 1e6;
        rain_def.bonds[i].damping = 0.2;
        rain_def.bonds[i].gap = 0.004;
        rain_def.bonds[i].at = i ? 0.3 : 0.1;
        rain_def.bonds[i].contact = i ? DEM_BOND_INSTEAD : DEM_BOND_PARALLEL;
    }
    m->scene.bonds = rain_def.bonds;
    m->scene.bond_count = 2;
    return m;
}

static void bodies_that_came_are_bonded_and_take_their_bonds_along(void **state)
{
    (void)state;
    model *m = rain_new();
    dem_world *w = model_world(m, 1);
    size_t made[2] = {0}, most = 0;
    double worst = 0;
    for (int i = 0; i < 100; i++) {
        run_steps(w, 100);
        const dem_figures *f = measured(w);
        worst = largest(worst, f->energy.error);
        most = f->bonds > most ? f->bonds : most;
        size_t count;
        const dem_bond_view *b = dem_world_bonds(w, &count);
        dem_body_view v = dem_world_bodies(w);
        check(f->bonds + f->bonds_lost == count);
        for (size_t k = 0; k < count; k++) {
            if (b[k].state == DEM_BOND_LOST) {
                check(b[k].body == UINT32_MAX || b[k].other == UINT32_MAX);
                check(b[k].point.z < -0.1 + 2 * RADIUS && b[k].broken > 0);
            } else {
                check(v.id[b[k].body] == b[k].id && v.id[b[k].other] == b[k].other_id);
                // it still joins the two that it was made for
                double apart = v3_distance(v.position[b[k].body], v.position[b[k].other]);
                check(apart < 2 * RADIUS + 0.006);
            }
            check(b[k].sphere == 0 && b[k].other_sphere == 0);
        }
        made[0] = i == 30 ? count : made[0];
        made[1] = count;
    }
    check(made[0] > 10 && made[1] > made[0] + 10 && most > 10);
    check(dem_world_figures(w)->bonds_lost > made[0]);
    check(w->bodies.count > 64 && w->bodies.living < w->population->came);
    check(worst < 1e-3);
    dem_truth truth;
    dem_error error;
    check_ok(dem_world_validate(w, &truth, &error), error);
    assert_int_equal(truth.missed + truth.doubled + truth.unsound, 0);
    dem_world_destroy(w);
    model_free(m);
}

static void bonded_rain_is_the_same_bits_everywhere(void **state)
{
    (void)state;
    model *m = rain_new();
    check_same_threads(m, 3300);
    model_free(m);
}

// a pair that hangs together, apart and swinging, leaves body by body: the energy of the bond goes, momentum stays
static void the_one_that_stays_keeps_its_momentum(void **state)
{
    (void)state;
    model *m = model_new();
    m->scene.time.step = 1e-5;
    m->scene.domain.low = v3(-1, -1, 0);
    m->scene.domain.high = v3(1, 1, 1);
    m->scene.domain.leaving = DEM_LEAVING_DELETE;
    model_sphere(m, RADIUS);
    for (int i = 0; i < 2; i++)
        model_body(m, 0, v3(0, 0, 0.05 + 2.4 * RADIUS * i))->velocity = v3(0, 0, i ? -1.8 : -2);
    dem_bond_def bond = dem_bond_defaults();
    bond.young = 1e8;
    bond.gap = 0.005;
    m->scene.bonds = &bond;
    m->scene.bond_count = 1;
    dem_world *w = model_world(m, 1);
    check(measured(w)->bonds == 1);
    double before = velocity_before(w, 1).z, most = 0;
    while (w->bodies.living == 2) {
        double now = velocity_before(w, 1).z;
        most = larger(most, fabs(now - before));
        before = now;
        run_steps(w, 1);
    }
    const dem_figures *f = measured(w);
    check(f->bonds == 0 && f->bonds_lost == 1 && f->energy.broken == 0);
    check_near(velocity_before(w, 0).z, before, 1.01 * most);  // a step of its swing
    check(most < 0.02);
    // w h = 0.16; (w h)^2 / 4 of the energy of the swing, which is (0.1 / 1.9)^2 of all, where it is cut at full speed
    check_near(f->energy.error, 0, 2e-5);
    run_steps(w, 100);
    before = velocity_before(w, 0).z;
    run_steps(w, 100);
    check_near(velocity_before(w, 0).z, before, 0);
    dem_world_destroy(w);
    model_free(m);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bodies_that_came_are_bonded_and_take_their_bonds_along),
        cmocka_unit_test(bonded_rain_is_the_same_bits_everywhere),
        cmocka_unit_test(the_one_that_stays_keeps_its_momentum),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
