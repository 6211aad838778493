// Several laws in one scene, the energy that contacts hold, and laws that are refused.
#include "bench_contact.h"

enum { KINDS = 3 };

// between A and A, A and B, B and B
static dem_pair_law kind_of_law(int kind)
{
    dem_pair_law law = dem_pair_law_defaults();
    law.materials[0] = (uint32_t)(kind / 2);
    law.materials[1] = (uint32_t)((kind + 1) / 2);
    law.friction_coefficient = 0.3;
    if (kind == 0) {  // elastic, with friction
        law.stiffness = 2e4;
        law.friction = DEM_FRICTION_LINEAR;
    } else if (kind == 1) {
        law.normal = DEM_NORMAL_HERTZ;
        law.friction = DEM_FRICTION_MINDLIN;
        law.damping = DEM_DAMPING_RESTITUTION;
        law.restitution = 0.5;
    } else {  // pulls, without friction
        law.damping = DEM_DAMPING_RATE;
        law.damping_rate = 800;
        law.tail = DEM_TAIL_TENSION;
    }
    return law;
}

// pairs of spheres of these materials, far from each other, all or one of them
static bench open_kinds(int first, int last)
{
    model *m = model_new();
    m->materials[0] = (dem_material){"A", 2500, 1e7, 0.25};
    m->materials[1] = (dem_material){"B", 1500, 3e7, 0.4};
    m->scene.material_count = 2;
    m->scene.law_count = 0;
    for (int kind = first; kind <= last; kind++)
        m->laws[m->scene.law_count++] = kind_of_law(kind);
    for (uint32_t i = 0; i < 2; i++) {
        model_sphere(m, 0.01);
        m->shapes[i].material = i;
    }
    if (first == last && first != 1)  // the other material must not be there
        m->shapes[first ? 0 : 1].material = first ? 1 : 0;
    for (int kind = first; kind <= last; kind++) {
        model_body(m, (uint32_t)(kind / 2), v3(0, kind, 0));
        model_body(m, (uint32_t)((kind + 1) / 2), v3(0.0199, kind, 0));
    }
    if (first == last && first == 1) {
        // both laws of the materials with themselves, for pairs that are not there
        m->laws[1] = m->laws[2] = m->laws[0];
        m->laws[1].materials[1] = 0;
        m->laws[2].materials[0] = 1;
        m->scene.law_count = 3;
    }
    return bench_open(m);
}

static void set_kinds(bench *b, int first, int last, dem_vec3 velocity, double overlap)
{
    for (int kind = first; kind <= last; kind++) {
        size_t i = 2 * (size_t)(kind - first);
        bench_put(b, i, v3(0, kind, 0), v3(0, 0, 0), v3(3, 0, 0));
        bench_put(b, i + 1, v3(0.02 - overlap, kind, 0), velocity, v3(0, 0, 0));
    }
}

static void each_contact_has_the_law_of_its_materials(void **state)
{
    (void)state;
    bench all = open_kinds(0, KINDS - 1), one[KINDS];
    const dem_features *f = &all.w->features;
    check(f->mixed && f->linear && f->hertz && f->rate && f->restitution && f->cut && f->friction && f->mindlin);
    for (int kind = 0; kind < KINDS; kind++)
        one[kind] = open_kinds(kind, kind);
    check(!one[2].w->features.friction && !one[0].w->features.hertz);
    dem_random r = random_stream(1, 3);
    for (int i = 0; i < 300; i++) {
        dem_vec3 v = v3(random_normal(&r), random_normal(&r), random_normal(&r));
        double overlap = 1e-4 * random_uniform(&r) - 1e-5;
        set_kinds(&all, 0, KINDS - 1, v, overlap);
        bench_step(&all, 1e-5);
        for (int kind = 0; kind < KINDS; kind++) {
            set_kinds(&one[kind], kind, kind, v, overlap);
            dem_vec3 want = bench_force(&one[kind], 1, 1e-5);
            // what the others need adds nothing, not even in the last bit
            check_vec(bench_wrench(&all, 2 * (size_t)kind + 1).force, want, 0);
        }
        dem_vec3 smooth = bench_wrench(&all, 5).force;  // has no friction beside those that have
        check(smooth.y == 0 && smooth.z == 0);
    }
    for (int kind = 0; kind < KINDS; kind++)
        bench_close(&one[kind]);
    bench_close(&all);
}

// the two materials of a law, and the two laws of a scene, may stand in any order
static void the_order_of_materials_and_laws_does_not_matter(void **state)
{
    (void)state;
    dem_vec3 force[2];
    for (int swapped = 0; swapped < 2; swapped++) {
        model *m = hertz_model();
        m->laws[2].friction = DEM_FRICTION_MINDLIN;
        m->laws[2].friction_coefficient = 0.4;
        if (swapped) {
            dem_pair_law first = m->laws[0];
            m->laws[0] = m->laws[1];
            m->laws[1] = first;
            m->laws[0].materials[0] = 1;
            m->laws[0].materials[1] = 0;
        }
        bench b = bench_spheres(m, 0.01, 0.02, 1e-4);
        set_pair(&b, 0.01, 0.02, 1e-4, v3(-1, 0.3, 0.1));
        force[swapped] = bench_force(&b, 0, 1e-5);
        bench_close(&b);
    }
    assert_memory_equal(&force[0], &force[1], sizeof force[0]);
}

// the bodies change places in the contact: forces are the same to the last bit, and opposite
static void a_contact_does_not_know_which_body_comes_first(void **state)
{
    (void)state;
    for (int kind = 0; kind < KINDS; kind++) {
        bench b = open_kinds(kind, kind), swapped = open_kinds(kind, kind);
        dem_random r = random_stream(1, 4);
        for (int i = 0; i < 100; i++) {
            dem_vec3 v = random_in(&r, v3(-1, -1, -1), v3(1, 1, 1)), spin = random_in(&r, v3(-9, -9, -9), v3(9, 9, 9));
            dem_vec3 x = v3(0.0199, 1e-4, 2e-4), w = v3(1, 2, 3), other_spin = v3(5, -8, 11);
            bench_put(&b, 0, v3(0, 0, 0), v, spin);
            bench_put(&b, 1, x, w, other_spin);
            bench_put(&swapped, 1, v3(0, 0, 0), v, spin);
            bench_put(&swapped, 0, x, w, other_spin);
            bench_step(&b, 1e-5);
            bench_step(&swapped, 1e-5);
            for (size_t body = 0; body < 2; body++) {
                wrench p = bench_wrench(&b, body), q = bench_wrench(&swapped, 1 - body);
                check_vec(q.force, p.force, 0);
                check_vec(q.moment, p.moment, 0);
            }
            check_vec(bench_wrench(&b, 1).force, v3_scale(bench_wrench(&b, 0).force, -1), 0);
        }
        bench_close(&b);
        bench_close(&swapped);
    }
}

// ---- energy

// what is recorded as elastic is what was put in, for every kind of spring
static void the_elastic_energy_is_the_integral_of_the_force(void **state)
{
    (void)state;
    for (int kind = 0; kind < 5; kind++) {
        model *m = kind == 2 || kind == 4 ? hertz_model() : model_new();
        for (size_t i = 0; i < m->scene.law_count; i++) {
            m->laws[i].friction_coefficient = 1e6;  // nothing slides
            if (kind == 1)
                m->laws[i].stiffness = 0;  // from young
            if (kind >= 3)
                m->laws[i].friction = kind == 3 ? DEM_FRICTION_LINEAR : DEM_FRICTION_MINDLIN;
        }
        if (kind == 4)  // beside a linear law
            m->laws[0] = dem_pair_law_defaults(), m->laws[0].stiffness = 1e5;
        bench b = bench_spheres(m, 0.01, 0.02, 1e-5);
        set_pair(&b, 0.01, 0.02, 0, v3(0, 0, 0));
        bench_step(&b, 0);
        double work = leg(&b, 0, 1e-4, 0, 0, 4000);
        // Mindlin's spring is what it is at the last overlap
        work += leg(&b, 1e-4, 1e-4, 0, kind >= 3 ? 5e-5 : 0, 1000);
        set_pair(&b, 0.01, 0.02, 1e-4, v3(0, 0, 0));
        // the trapezoidal rule along d^1.5: (1/4000)^2
        check_close(measured(b.w)->energy.elastic, work, 1e-6);
        check(work > 0);
        bench_close(&b);
    }
}

// ---- what cannot be

static void check_refused(model *m, const char *text)
{
    dem_world *w = NULL;
    dem_error error = {0};
    assert_int_equal(dem_world_create(NULL, &m->scene, &w, &error), DEM_BAD_INPUT);
    if (!strstr(error.text, text)) {
        print_error("\"%s\" is not in: %s\n", text, error.text);
        fail();
    }
    check(!w && strchr(error.text, ';'));
    model_free(m);
}

static model *two_materials(void)
{
    model *m = hertz_model();
    m->materials[0].name = "stone";
    model_body(m, model_sphere(m, 0.01), v3(0, 0, 0));
    model_body(m, model_sphere(m, 0.01), v3(1, 0, 0));
    m->shapes[1].material = 1;
    return m;
}

static void laws_that_lack_a_number_are_refused(void **state)
{
    (void)state;
    model *m = two_materials();
    m->materials[1].poisson = NAN;
    check_refused(m, "between \"stone\" and \"soft\" is of Hertz; give both materials \"young\" and \"poisson\"");
    m = two_materials();
    m->materials[1].young = NAN;
    check_refused(m, "is of Hertz");
    m = two_materials();
    m->laws[1].normal = DEM_NORMAL_LINEAR;
    m->materials[0].young = NAN;
    m->laws[0].normal = m->laws[2].normal = DEM_NORMAL_LINEAR;
    m->laws[0].stiffness = m->laws[2].stiffness = 1;
    check_refused(m, "between \"stone\" and \"soft\" has no stiffness");
    m = two_materials();
    m->laws[1] = dem_pair_law_defaults();
    m->laws[1].materials[1] = 1;
    m->laws[1].stiffness = 1e4;
    m->laws[1].friction = DEM_FRICTION_MINDLIN;
    m->laws[1].friction_coefficient = 0.5;
    check_refused(m, "has Mindlin's friction, which needs the normal law of Hertz");
}

static void laws_that_are_missing_or_do_not_go_together_are_refused(void **state)
{
    (void)state;
    model *m = two_materials();
    m->scene.law_count = 2;
    check_refused(m, "no contact law between \"soft\" and \"soft\"");
    m = two_materials();
    m->laws[1].materials[1] = 7;
    check_refused(m, "names a material that is not there");
    m = two_materials();
    for (int i = 0; i < 3; i++) {
        m->laws[i].damping = DEM_DAMPING_RESTITUTION;
        m->laws[i].restitution = 0.5;
        m->laws[i].effective_mass = i == 1 ? DEM_MASS_BODY : DEM_MASS_LOCAL;
    }
    check_refused(m, "has another \"effective_mass\" than the others");
    // one without dashpots does not mind
    m = two_materials();
    m->laws[0].damping = m->laws[2].damping = DEM_DAMPING_RATE;
    m->laws[0].damping_rate = m->laws[2].damping_rate = 100;
    m->laws[1].effective_mass = DEM_MASS_BODY;
    dem_world *w = model_world(m, 1);
    dem_world_destroy(w);
    // materials that never meet need no law
    m->scene.law_count = 1;
    m->shapes[1].material = 0;
    w = model_world(m, 1);
    dem_world_destroy(w);
    model_free(m);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_contact_has_the_law_of_its_materials),
        cmocka_unit_test(the_order_of_materials_and_laws_does_not_matter),
        cmocka_unit_test(a_contact_does_not_know_which_body_comes_first),
        cmocka_unit_test(the_elastic_energy_is_the_integral_of_the_force),
        cmocka_unit_test(laws_that_lack_a_number_are_refused),
        cmocka_unit_test(laws_that_are_missing_or_do_not_go_together_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
