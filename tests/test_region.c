// Stress, fabric and packing of regions: against statics, geometry and what the walls feel.
#include "scenes.h"
#include "worlds.h"

#include "math/mat3.h"

static const double R = 0.01, G = 9.81;

static double ball_mass(void)
{
    return 2500 * 4 * DEM_PI / 3 * R * R * R;
}

static void set_measures(model *m, const dem_measure_def *measures, size_t count)
{
    m->scene.measures = measures;
    m->scene.measure_count = count;
}

static const dem_measure_view *views_of(dem_world *w)
{
    size_t count;
    measured(w);
    return dem_world_measures(w, &count);
}

static void check_sym(dem_sym3 got, dem_sym3 want, double tolerance)
{
    check_vec(v3(got.xx, got.yy, got.zz), v3(want.xx, want.yy, want.zz), tolerance);
    check_vec(v3(got.xy, got.xz, got.yz), v3(want.xy, want.xz, want.yz), tolerance);
}

// F l n n over the volume; half of the line in a region is half of it
static void two_balls_press_on_each_other_along_their_line(void **state)
{
    (void)state;
    model *m = model_new();
    dem_vec3 n = v3_unit(v3(1, 2, -2)), l = v3_scale(n, 2 * R - 1e-4);
    uint32_t ball = model_sphere(m, R);
    model_body(m, ball, v3_scale(l, -0.5));
    model_body(m, ball, v3_scale(l, 0.5));
    const dem_measure_def all[] = {
        {.region = DEM_REGION_BOX, .low = {-1, -1, -1}, .high = {1, 1, 1}},
        {.region = DEM_REGION_BOX, .low = {0, -1, -1}, .high = {1, 1, 1}},
        {.region = DEM_REGION_BALL, .radius = 0.25 * (2 * R - 1e-4)},
        {.region = DEM_REGION_BALL, .centre = {1, 1, 1}, .radius = 0.5},
        {.region = DEM_REGION_WHOLE},
    };
    set_measures(m, all, 5);
    dem_world *w = model_world(m, 1);
    const dem_measure_view *v = views_of(w);
    double f = 1e4 * 1e-4, length = v3_norm(l);
    dem_sym3 want = {n.x * n.x, n.y * n.y, n.z * n.z, n.x * n.y, n.x * n.z, n.y * n.z};
    check_sym(v[0].stress, sym3_scale(want, f * length / 8), 1e-12);
    check_sym(v[0].fabric, want, 1e-13);
    check_close(v[0].mean_stress, f * length / 8 / 3, 1e-12);
    check_close(v[0].deviatoric_stress, f * length / 8, 1e-12);  // one axis: q is it
    check(v[0].contacts == 1 && v[0].bodies == 2 && v[0].coordination == 1);
    check_sym(v[1].stress, sym3_scale(want, f * length / 8), 1e-12);  // half of the line, half of the volume
    check(v[1].bodies == 1);
    double small = 4 * DEM_PI / 3 * pow(all[2].radius, 3);
    check_sym(v[2].stress, sym3_scale(want, f * length / 2 / small), 1e-7);
    check(v[2].bodies == 0 && v[2].coordination == 0 && v[2].contacts == 1);
    check_sym(v[3].stress, (dem_sym3){0}, 0);
    check(isinf(v[3].void_ratio) && v[3].contacts == 0 && v[3].fabric.xx == 0);
    dem_vec3 side = v3(2 * R + fabs(l.x), 2 * R + fabs(l.y), 2 * R + fabs(l.z));
    check_close(v[4].volume, side.x * side.y * side.z, 1e-12);
    check_close(v[4].void_ratio, v[4].volume / (2 * 4 * DEM_PI / 3 * R * R * R) - 1, 1e-12);
    dem_world_destroy(w);
    model_free(m);
}

// also where the line crosses a periodic side, in two regions at the two ends
static void a_line_across_a_periodic_side_is_where_its_images_are(void **state)
{
    (void)state;
    model *m = model_new();
    m->scene.domain = (dem_domain_def){{0, 0, 0}, {0.1, 0.1, 0.1}, {true, true, false}, DEM_LEAVING_IGNORE};
    uint32_t ball = model_sphere(m, R);
    model_body(m, ball, v3(0.004, 0.05, 0.05));
    model_body(m, ball, v3(0.0845, 0.05, 0.05));
    const dem_measure_def all[] = {
        {.region = DEM_REGION_BOX, .low = {0, 0, 0}, .high = {0.002, 0.1, 0.1}},
        {.region = DEM_REGION_BOX, .low = {0.09, 0, 0}, .high = {0.1, 0.1, 0.1}},
        {.region = DEM_REGION_BALL, .centre = {0.095, 0.05, 0.05}, .radius = 0.004},
        {.region = DEM_REGION_WHOLE},
    };
    set_measures(m, all, 4);
    dem_world *w = model_world(m, 1);
    const dem_measure_view *v = views_of(w);
    double f = 1e4 * (2 * R - 0.0195);
    check_close(v[0].stress.xx, f * 0.002 / 2e-5, 1e-10);
    check_close(v[1].stress.xx, f * 0.01 / 1e-4, 1e-10);
    check_close(v[2].stress.xx, f * 0.008 / (4 * DEM_PI / 3 * pow(0.004, 3)), 1e-10);
    check_close(v[3].stress.xx, f * 0.0195 / 1e-3, 1e-10);
    // 0.1 - 0.0195 / 2 + 0.004: the contact point
    check(v[0].contacts == 0 && v[1].contacts == 1 && v[2].contacts == 1 && v[3].contacts == 1);
    // of the first ball x < 0.002 is in the box, and what is across the side is not: caps of heights h from the left
    double in = 0, h[2] = {0.008, 0.006};
    for (int i = 0; i < 2; i++)
        in += (i ? -1 : 1) * DEM_PI * h[i] * h[i] * (3 * R - h[i]) / 3;
    check_near(v[0].solid_volume, in, 5e-3 * 4 * DEM_PI / 3 * R * R * R);
    // at the other end that part, and a cap of the second ball
    double caps = DEM_PI * 0.006 * 0.006 * (3 * R - 0.006) / 3 + DEM_PI * 0.0045 * 0.0045 * (3 * R - 0.0045) / 3;
    check_near(v[1].solid_volume, caps, 1e-2 * 4 * DEM_PI / 3 * R * R * R);
    dem_world_destroy(w);
    model_free(m);
}

// a column of balls at rest: the force between two is the weight above
static void a_column_bears_its_weight(void **state)
{
    (void)state;
    enum { BALLS = 12 };
    model *m = model_new();
    uint32_t ball = model_sphere(m, R);
    m->scene.gravity = v3(0, 0, -G);
    model_plane(m, v3(0, 0, 0), v3(0, 0, 1));
    double z[BALLS], at = 0, k = 1e4, weight = ball_mass() * G;
    for (int i = 0; i < BALLS; i++) {
        at += (i ? 2 * R : R) - (BALLS - i) * weight / k;
        z[i] = at;
        model_body(m, ball, v3(0, 0, at));
    }
    dem_measure_def all[] = {{.region = DEM_REGION_BOX, .low = {-0.1, -0.1, 0}, .high = {0.1, 0.1, 0.25}},
                             {.region = DEM_REGION_BOX, .low = {-0.1, -0.1, z[3] + 0.003}, .high = {0.1, 0.1, z[7]}}};
    set_measures(m, all, 2);
    dem_world *w = model_world(m, 1);
    run_steps(w, 1000);
    const dem_measure_view *v = views_of(w);
    double sum[2] = {BALLS * weight * z[0], 0};
    for (int i = 1; i < BALLS; i++) {
        sum[0] += (BALLS - i) * weight * (z[i] - z[i - 1]);
        double inside = fmin(z[i], z[7]) - fmax(z[i - 1], z[3] + 0.003);
        sum[1] += (BALLS - i) * weight * fmax(inside, 0);
    }
    check_close(v[0].stress.zz, sum[0] / (0.04 * 0.25), 1e-9);
    check_close(v[1].stress.zz, sum[1] / (0.04 * (z[7] - z[3] - 0.003)), 1e-9);
    // three balls, half of one, and a cap
    double ball_volume = 4 * DEM_PI / 3 * R * R * R, cap = DEM_PI * 0.007 * 0.007 * (3 * R - 0.007) / 3;
    check_near(v[1].solid_volume, 3.5 * ball_volume + cap, 5e-3 * ball_volume);
    dem_world_destroy(w);
    model_free(m);
}

// what acts on the walls, force by place, over the volume (Gauss): the stress of what is at rest inside
static dem_sym3 stress_of_walls(dem_world *w, double volume)
{
    dem_sym3 sum = {0};
    size_t count;
    const dem_contact *c = dem_world_contacts(w, &count);
    for (size_t i = 0; i < count; i++)
        if (c[i].other == UINT32_MAX) {
            dem_vec3 on_wall = v3_sub(v3_scale(c[i].normal, c[i].normal_force), c[i].friction_force);
            sum = sym3_add(sum, sym3_pair(on_wall, c[i].point));
        }
    return sym3_scale(sum, 1 / volume);
}

enum { PARTS = 8 };

// clumps squeezed in a box until they rest
static dem_world *squeezed(const dem_measure_def *measures, double side, bool rough)
{
    model *m = model_new();
    m->laws[0].damping = DEM_DAMPING_RESTITUTION;
    m->laws[0].restitution = 0.2;
    m->laws[0].friction = rough ? DEM_FRICTION_LINEAR : DEM_FRICTION_NONE;
    m->laws[0].friction_coefficient = 0.3;
    m->scene.time.step = 2e-5;
    m->scene.damping.viscous = 100;
    model_sphere(m, 0.0108);
    model_dumbbell(m, 0.0076, 0.01);
    model_cloud(m, 7, 0.026, 3);
    model_lattice(m, 27, side / 3, 0, 11);
    model_box(m, v3(0, 0, 0), v3(side, side, side));
    set_measures(m, measures, 2 + PARTS);
    dem_world *w = model_world(m, 1);
    model_free(m);
    run_steps(w, 60000);
    return w;
}

// the stress of a box is what its walls feel, and the parts of a region add up to it
static void a_box_has_the_stress_of_its_walls(void **state)
{
    (void)state;
    const double side = 0.06, area = side * side;
    dem_measure_def all[2 + PARTS] = {{.region = DEM_REGION_BOX, .low = {0, 0, 0}, .high = {side, side, side}},
                                      {.region = DEM_REGION_WHOLE}};
    for (int i = 0; i < PARTS; i++) {
        dem_vec3 low = v3(i & 1 ? 0.02 : 0, i & 2 ? 0.035 : 0, i & 4 ? 0.03 : 0);
        dem_vec3 high = v3(i & 1 ? side : 0.02, i & 2 ? side : 0.035, i & 4 ? side : 0.03);
        all[2 + i] = (dem_measure_def){.region = DEM_REGION_BOX, .low = low, .high = high};
    }
    for (int rough = 0; rough < 2; rough++) {
        dem_world *w = squeezed(all, side, rough);
        const dem_measure_view *v = views_of(w);
        size_t walls;
        const dem_wall_view *wall = dem_world_walls(w, &walls);
        double p = v[0].mean_stress;
        check(dem_world_figures(w)->energy.kinetic < 1e-20 && v[0].contacts > 20 && p > 100);
        check_sym(v[0].stress, stress_of_walls(w, side * area), 1e-8 * p);
        if (!rough)
            // high sides feel the force outwards
            check_vec(v3(v[0].stress.xx, v[0].stress.yy, v[0].stress.zz),
                      v3(wall[1].force.x / area, wall[3].force.y / area, wall[5].force.z / area), 1e-8 * p);
        dem_measure_view sum = {0};
        for (int i = 0; i < PARTS; i++) {
            const dem_measure_view *part = &v[2 + i];
            sum.stress = sym3_add(sum.stress, sym3_scale(part->stress, part->volume));
            sum.solid_volume += part->solid_volume;
            sum.bodies += part->bodies;
            sum.contacts += part->contacts;
        }
        check_sym(sym3_scale(sum.stress, 1 / v[0].volume), v[0].stress, 1e-10 * p);
        check(sum.bodies == 27 && sum.contacts == v[0].contacts);
        check_close(sum.solid_volume, v[0].solid_volume, 1e-12);  // each point is in one of them
        double solid = 0;
        for (size_t i = 0; i < 27; i++)
            solid += dem_world_bodies(w).mass[i] / 2500;
        check_close(v[1].solid_volume, solid, 1e-12);
        check_close(v[1].void_ratio, v[1].volume / solid - 1, 1e-12);
        check_close(v[0].fabric.xx + v[0].fabric.yy + v[0].fabric.zz, 1, 1e-12);
        check_close(v[0].coordination, dem_world_figures(w)->coordination, 1e-12);
        dem_world_destroy(w);
    }
}

// what a bond pulls with is a stress below 0
static void a_bond_bears_stress_too(void **state)
{
    (void)state;
    model *m = model_new();
    uint32_t ball = model_sphere(m, R);
    dem_bond_def bond = dem_bond_defaults();
    bond.young = 1e7;
    bond.gap = 1e-6;
    m->scene.bonds = &bond;
    m->scene.bond_count = 1;
    m->materials[0].density = 1e12;  // too heavy to be turned
    model_body(m, ball, v3(0, 0, 0))->hold = DEM_HOLD_VELOCITY;
    dem_body_def *b = model_body(m, ball, v3(2 * R, 0, 0));
    b->hold = DEM_HOLD_VELOCITY;
    b->velocity = v3(1e-2, 0, 5e-3);
    const dem_measure_def all[] = {{.region = DEM_REGION_BOX, .low = {-1, -1, -1}, .high = {1, 1, 1}},
                                   {.region = DEM_REGION_BOX, .low = {-1, -1, -1}, .high = {R, 1, 1}}};
    set_measures(m, all, 2);
    dem_world *w = model_world(m, 1);
    run_steps(w, 1000);
    const dem_measure_view *v = views_of(w);
    size_t count;
    const dem_bond_view *bonds = dem_world_bonds(w, &count);
    dem_vec3 x = dem_world_bodies(w).position[1], f = bonds[0].force;
    check(count == 1 && f.x > 1);
    check_sym(v[0].stress, (dem_sym3){-f.x * x.x / 8, 0, -f.z * x.z / 8, 0, -(f.x * x.z + f.z * x.x) / 16, 0},
              1e-12 * f.x);
    check_close(v[1].stress.xx, -f.x * R / (1 + R) / 4, 1e-12);
    dem_world_destroy(w);
    model_free(m);
}

// bodies that fly: m v v over the volume, about their mean
static void motion_is_a_stress_where_it_is_asked_for(void **state)
{
    (void)state;
    model *m = model_new();
    uint32_t ball = model_sphere(m, R);
    model_body(m, ball, v3(0, 0, 0))->velocity = v3(5, 1, 0);
    model_body(m, ball, v3(0.1, 0, 0))->velocity = v3(5, -1, 2);
    const dem_measure_def all[] = {{.region = DEM_REGION_BOX, .low = {-1, -1, -1}, .high = {1, 1, 1}, .kinetic = true},
                                   {.region = DEM_REGION_BOX, .low = {-1, -1, -1}, .high = {1, 1, 1}}};
    set_measures(m, all, 2);
    dem_world *w = model_world(m, 1);
    const dem_measure_view *v = views_of(w);
    double unit = 2 * ball_mass() / 8;
    check_sym(v[0].stress, (dem_sym3){.yy = unit, .zz = unit, .yz = -unit}, 1e-12 * unit);
    check_sym(v[1].stress, (dem_sym3){0}, 0);
    dem_world_destroy(w);
    model_free(m);
}

// parts of grains across a border: a sphere cut by planes, and any grain in every place
static void a_grain_across_the_border_counts_by_its_part(void **state)
{
    (void)state;
    model *m = model_new();
    model_body(m, model_sphere(m, R), v3(0, 0, 0))->scale = 2;
    dem_measure_def all[10];
    double h[10];
    for (int i = 0; i < 10; i++) {
        h[i] = 4 * R * (i + 0.5) / 10;
        all[i] = (dem_measure_def){.region = DEM_REGION_BOX, .low = {-1, -1, -1}, .high = {1, 1, h[i] - 2 * R}};
    }
    set_measures(m, all, 10);
    dem_world *w = model_world(m, 1);
    const dem_measure_view *v = views_of(w);
    for (int i = 0; i < 10; i++)
        check_near(v[i].solid_volume, DEM_PI * h[i] * h[i] * (6 * R - h[i]) / 3, 5e-3 * 4 * DEM_PI / 3 * 8 * R * R * R);
    dem_world_destroy(w);
    model_free(m);
}

// discs of two dimensions: the region is an area as high as they are thick
static void among_discs_a_region_is_an_area(void **state)
{
    (void)state;
    model *m = model_new();
    const double thick = 0.003, deep = 1e-4;
    m->scene.dimension = 2;
    m->shapes[model_sphere(m, R)].disc_thickness = thick;
    model_body(m, 0, v3(0, 0, 0.5));
    dem_body_def *b = model_body(m, 0, v3(3 * R - deep, 0, 0.5));
    b->scale = 2;
    const dem_measure_def all[] = {{.region = DEM_REGION_BOX, .low = {-0.1, -0.1, 0}, .high = {0.1, 0.1, 0.1}},
                                   {.region = DEM_REGION_BALL, .centre = {0, 0, 0.5}, .radius = 0.1},
                                   {.region = DEM_REGION_BOX, .low = {-0.1, -0.1, 0}, .high = {0, 0.1, 0.1}},
                                   {.region = DEM_REGION_WHOLE}};
    set_measures(m, all, 4);
    dem_world *w = model_world(m, 1);
    const dem_measure_view *v = views_of(w);
    double force = 1e4 * deep, length = 3 * R - deep, solid = 5 * DEM_PI * R * R * thick;
    const double volumes[] = {0.04 * thick, DEM_PI * 0.01 * thick, 0.02 * thick, (6 * R - deep) * 4 * R * thick};
    for (int i = 0; i < 4; i++)
        check_close(v[i].volume, volumes[i], 1e-12);
    for (int i = 0; i < 4; i++)
        check_close(v[i].stress.xx, i == 2 ? 0 : force * length / volumes[i], 1e-10);
    check_close(v[0].solid_volume, solid, 1e-12);
    check_close(v[1].void_ratio, volumes[1] / solid - 1, 1e-12);
    check_close(v[2].solid_volume, solid / 10, 1e-2);
    dem_world_destroy(w);
    model_free(m);
}

// ---- scenes

static void regions_are_read_and_written(void **state)
{
    (void)state;
    dem_scene s = scene_of("{" SCENE_HEAD ", 'measures': {'a': {'box': [[0, 0, 0], ['1 mm', 2, 3]]},\n"
                           " 'b': {'ball': {'centre': [1, 2, 3], 'radius': '5 cm'}, 'kinetic': true},\n"
                           " 'c': {'whole': true}, 'd': {'box': {'min': [-1, -1, -1], 'max': [1, 1, 1]}}}}");
    check(s.measure_count == 4);
    for (int again = 0; again < 2; again++) {
        const dem_measure_def *m = s.measures;
        assert_string_equal(m[0].name, "a");
        check(m[0].region == DEM_REGION_BOX && m[0].high.x == 1e-3 && m[0].high.z == 3 && !m[0].kinetic);
        check(m[1].region == DEM_REGION_BALL && m[1].centre.y == 2 && m[1].radius == 0.05 && m[1].kinetic);
        check(m[2].region == DEM_REGION_WHOLE && m[3].region == DEM_REGION_BOX && m[3].low.x == -1);
        char *text;
        dem_error error;
        check_ok(dem_scene_resolved(&s, &text, &error), error);
        dem_scene_release(&s);
        check_ok(dem_scene_read_text(NULL, text, strlen(text), "again.json", NULL, NULL, &s, &error), error);
        free(text);
    }
    dem_scene_release(&s);
}

static void what_is_no_region_is_refused_with_its_place(void **state)
{
    (void)state;
    static const char *const wrong[][2] = {
        {"'measures': 3", "needs an object of regions by name"},
        {"'measures': {'a': {}}", "measures.a: needs one of \"box\", \"ball\" and \"whole\""},
        {"'measures': {'a': {'whole': true, 'ball': {'centre': [0, 0, 0], 'radius': 1}}}", "more than one of"},
        {"'measures': {'a': {'whole': false}}", "is not a region"},
        {"'measures': {'a': {'box': [[0, 0, 0], [1, 0, 1]]}}", "measures.a: its first corner must be below the second"},
        {"'measures': {'a': {'box': [[0, 0, 0]]}}", "the corners"},
        {"'measures': {'a': {'ball': {'centre': [0, 0, 0], 'radius': 0}}}", "must be above 0"},
        {"'measures': {'a': {'bal': 1}}", "did you mean \"ball\""},
        {"'domain': {'min': [0, 0, 0], 'max': [1, 1, 1], 'periodic': [true, false, false]},\n"
         " 'measures': {'a': {'ball': {'centre': [0.5, 0, 0], 'radius': 0.6}}}",
         "it reaches beyond a periodic side of the domain"},
    };
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        char text[1500];
        dem_scene s;
        dem_error error;
        snprintf(text, sizeof text, "{" SCENE_HEAD ",\n%s}", wrong[i][0]);
        check(scene_read(text, NULL, NULL, &s, &error) == DEM_BAD_INPUT);
        if (!strstr(error.text, wrong[i][1]) || error.line < 6)
            fail_msg("%ld: %s", error.line, error.text);
    }
}

static void a_region_that_cannot_be_is_refused_by_the_world(void **state)
{
    (void)state;
    const dem_measure_def bad[] = {{.name = "a", .region = DEM_REGION_BALL},
                                   {.name = "a", .region = DEM_REGION_BALL, .radius = NAN},
                                   {.name = "a", .region = DEM_REGION_BALL, .radius = INFINITY},
                                   {.name = "a", .region = DEM_REGION_BOX, .low = {0, 0, NAN}, .high = {1, 1, 1}},
                                   {.name = "a", .region = DEM_REGION_BOX, .high = {1, INFINITY, 1}}};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        model *m = model_new();
        dem_world *w;
        dem_error error;
        set_measures(m, &bad[i], 1);
        check(dem_world_create(NULL, &m->scene, &w, &error) == DEM_USAGE && !w && strstr(error.text, "measure \"a\""));
        model_free(m);
    }
}

// a scene without bodies, and one that measures nothing
static void nothing_to_measure_is_no_trouble(void **state)
{
    (void)state;
    model *m = model_new();
    size_t count;
    dem_world *w = model_world(m, 1);
    check(!dem_world_measures(w, &count) && count == 0);
    dem_world_destroy(w);
    const dem_measure_def all[] = {{.region = DEM_REGION_WHOLE}, {.region = DEM_REGION_BALL, .radius = 1}};
    set_measures(m, all, 2);
    w = model_world(m, 1);
    const dem_measure_view *v = views_of(w);
    check(v[0].volume == 0 && v[0].mean_stress == 0 && v[0].coordination == 0);
    check(isinf(v[1].void_ratio) && v[1].fabric.xx == 0 && v[1].deviatoric_stress == 0);
    dem_world_destroy(w);
    model_free(m);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(two_balls_press_on_each_other_along_their_line),
        cmocka_unit_test(a_line_across_a_periodic_side_is_where_its_images_are),
        cmocka_unit_test(a_column_bears_its_weight),
        cmocka_unit_test(a_box_has_the_stress_of_its_walls),
        cmocka_unit_test(a_bond_bears_stress_too),
        cmocka_unit_test(motion_is_a_stress_where_it_is_asked_for),
        cmocka_unit_test(a_grain_across_the_border_counts_by_its_part),
        cmocka_unit_test(among_discs_a_region_is_an_area),
        cmocka_unit_test(regions_are_read_and_written),
        cmocka_unit_test(what_is_no_region_is_refused_with_its_place),
        cmocka_unit_test(a_region_that_cannot_be_is_refused_by_the_world),
        cmocka_unit_test(nothing_to_measure_is_no_trouble),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
