#include "clumps.h"

static void a_clump_gives_back_what_it_was_made_from(void **state)
{
    (void)state;
    dem_clump_def def = sample_clump();
    dem_clump *clump = made_clump(&def);
    dem_clump_def view = dem_clump_view(clump);
    assert_string_equal(view.name, def.name);
    assert_string_equal(view.source_mesh, def.source_mesh);
    assert_string_equal(view.source_sha256, def.source_sha256);
    assert_string_equal(view.source_unit, def.source_unit);
    assert_string_equal(view.method, def.method);
    assert_string_equal(view.version, def.version);
    assert_string_equal(view.parameters, "{\"spheres\":50,\"gap\":0.10000000000000001}");
    check(view.density == def.density && view.mass == def.mass && view.volume == def.volume);
    check(view.mass_from == def.mass_from && view.seed == def.seed && view.seconds == def.seconds);
    assert_memory_equal(view.inertia, def.inertia, sizeof def.inertia);
    assert_memory_equal(&view.position, &def.position, sizeof def.position);
    assert_memory_equal(&view.orientation, &def.orientation, sizeof def.orientation);
    check(view.union_volume == def.union_volume);
    assert_memory_equal(&view.union_centre, &def.union_centre, sizeof def.union_centre);
    assert_memory_equal(view.union_inertia, def.union_inertia, sizeof def.union_inertia);
    assert_memory_equal(&view.fidelity, &def.fidelity, sizeof def.fidelity);
    assert_memory_equal(&view.shape, &def.shape, sizeof def.shape);
    check(view.ball_count == def.ball_count);
    assert_memory_equal(view.balls, def.balls, def.ball_count * sizeof *def.balls);
    check(view.surface.vertex_count == 4 && view.surface.triangle_count == 4);
    assert_memory_equal(view.surface.vertices, def.surface.vertices, 4 * sizeof(dem_vec3));
    assert_memory_equal(view.surface.triangles, def.surface.triangles, 12 * sizeof(uint32_t));
    dem_clump_destroy(clump);
}

static void a_copy_of_the_bytes_is_the_clump(void **state)
{
    (void)state;
    dem_clump_def def = sample_clump();
    dem_clump *clump = made_clump(&def);
    dem_clump *copy = malloc(dem_clump_bytes(clump));
    memcpy(copy, clump, dem_clump_bytes(clump));
    dem_clump_destroy(clump);
    dem_clump_def view = dem_clump_view(copy);
    assert_string_equal(view.name, def.name);
    assert_memory_equal(view.balls, def.balls, def.ball_count * sizeof *def.balls);
    check((const char *)view.balls > (const char *)copy &&
          (const char *)view.version < (const char *)copy + dem_clump_bytes(copy));
    free(copy);
}

static void the_hash_sees_every_change_but_the_seconds(void **state)
{
    (void)state;
    dem_clump_def def = sample_clump();
    dem_clump *clump = made_clump(&def);
    uint64_t hash = dem_clump_hash(clump);
    dem_clump_destroy(clump);

    def.seconds = 77;
    clump = made_clump(&def);
    check(dem_clump_hash(clump) == hash);
    dem_clump_destroy(clump);

    for (int change = 0; change < 5; change++) {
        def = sample_clump();
        dem_ball balls[SAMPLE_BALLS];
        memcpy(balls, def.balls, sizeof balls);
        if (change == 0)
            balls[2].radius = nextafter(balls[2].radius, 1);
        else if (change == 1)
            def.version = "0.1.1";
        else if (change == 2)
            def.surface.triangle_count = 3;
        else if (change == 3)
            def.fidelity.pieces = 2;
        else
            def.density = nextafter(def.density, 1);
        def.balls = balls;
        clump = made_clump(&def);
        check(dem_clump_hash(clump) != hash);
        dem_clump_destroy(clump);
    }
}

static void what_is_not_known_is_one_nan(void **state)
{
    (void)state;
    dem_clump_def def = sample_clump();
    def.fidelity.iou_gap = NAN;
    def.union_volume = def.shape.angularity = NAN;
    dem_clump *one = made_clump(&def);
    def.fidelity.iou_gap = -NAN;
    def.shape.angularity = INFINITY;
    dem_clump *other = made_clump(&def);
    check_same_clump(one, other);
    check(isnan(dem_clump_view(one).fidelity.iou_gap) && isnan(dem_clump_view(one).union_volume));
    dem_clump_destroy(one);
    dem_clump_destroy(other);
}

static void texts_that_are_not_given_are_empty(void **state)
{
    (void)state;
    dem_clump_def def = sample_clump();
    def.name = def.source_mesh = def.source_sha256 = def.source_unit = def.method = def.version = NULL;
    def.parameters = NULL;
    def.surface = (dem_mesh){0};
    dem_clump *clump = made_clump(&def);
    dem_clump_def view = dem_clump_view(clump);
    assert_string_equal(view.name, "");
    assert_string_equal(view.version, "");
    assert_string_equal(view.parameters, "{}");
    check(view.surface.triangle_count == 0 && !view.surface.vertices);
    dem_clump_destroy(clump);
}

static void a_rounded_orientation_becomes_a_unit_quaternion(void **state)
{
    (void)state;
    dem_clump_def def = sample_clump();
    def.orientation = (dem_quat){0.7071, 0, -0.7071, 0};
    dem_clump *clump = made_clump(&def);
    dem_quat q = dem_clump_view(clump).orientation;
    check_near(q.w, sqrt(0.5), 1e-15);
    check_near(q.y, -sqrt(0.5), 1e-15);
    dem_clump_destroy(clump);
}

// one broken thing at a time; `key` must be named
typedef struct refusal {
    const char *key;
    void (*spoil)(dem_clump_def *def, dem_ball *balls, dem_mesh *surface);
} refusal;

#define SPOIL(name, statement)                                                                                         \
    static void spoil_##name(dem_clump_def *d, dem_ball *b, dem_mesh *s)                                               \
    {                                                                                                                  \
        (void)d, (void)b, (void)s;                                                                                     \
        statement;                                                                                                     \
    }
SPOIL(count, d->ball_count = 0)
SPOIL(radius, b[1].radius = 0)
SPOIL(negative_radius, b[2].radius = -1)
SPOIL(nan_radius, b[0].radius = NAN)
SPOIL(infinite_radius, b[0].radius = INFINITY)
SPOIL(centre, b[1].centre.y = NAN)
SPOIL(far_centre, b[1].centre.y = 1e200)
SPOIL(density, d->density = 0)
SPOIL(mass, d->mass = NAN)
SPOIL(volume, d->volume = -1)
SPOIL(zero_inertia, d->inertia[0] = 0)
SPOIL(order, d->inertia[0] = 0.25)
SPOIL(inequality, d->inertia[2] = 0.31)
SPOIL(source, d->mass_from = (dem_mass_source)(DEM_MASS_GIVEN + 1))
SPOIL(union_volume, d->union_volume = -2)
SPOIL(position, d->position.z = INFINITY)
SPOIL(orientation, d->orientation.w = 0.7)
SPOIL(nan_orientation, d->orientation.x = NAN)
SPOIL(vertex, s->vertices[2].x = NAN)
SPOIL(index, s->triangles[5] = 4)
SPOIL(parameters, d->parameters = "[1]")
SPOIL(broken_parameters, d->parameters = "{")

static void what_is_no_clump_is_refused_by_the_name_of_its_key(void **state)
{
    (void)state;
    const refusal cases[] = {{"spheres:", spoil_count},
                             {"spheres[1]", spoil_radius},
                             {"spheres[2]", spoil_negative_radius},
                             {"spheres[0]", spoil_nan_radius},
                             {"spheres[0]", spoil_infinite_radius},
                             {"spheres[1]", spoil_centre},
                             {"spheres[1]", spoil_far_centre},
                             {"density", spoil_density},
                             {"mass", spoil_mass},
                             {"volume", spoil_volume},
                             {"inertia", spoil_zero_inertia},
                             {"mass_from", spoil_source},
                             {"I1 <= I2 <= I3", spoil_order},
                             {"I1 + I2", spoil_inequality},
                             {"union.volume", spoil_union_volume},
                             {"to_mesh.position", spoil_position},
                             {"to_mesh.orientation", spoil_orientation},
                             {"to_mesh.orientation", spoil_nan_orientation},
                             {"surface.vertices[2]", spoil_vertex},
                             {"surface.triangles[1]", spoil_index},
                             {"made.parameters", spoil_parameters},
                             {"made.parameters", spoil_broken_parameters}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        dem_clump_def def = sample_clump();
        dem_ball balls[SAMPLE_BALLS];
        dem_vec3 vertices[4];
        uint32_t triangles[12];
        memcpy(balls, def.balls, sizeof balls);
        memcpy(vertices, def.surface.vertices, sizeof vertices);
        memcpy(triangles, def.surface.triangles, sizeof triangles);
        def.balls = balls;
        def.surface.vertices = vertices;
        def.surface.triangles = triangles;
        cases[i].spoil(&def, balls, &def.surface);
        dem_clump *clump = (dem_clump *)&def;
        dem_error error = {0};
        check(dem_clump_create(&def, &clump, &error) == DEM_BAD_INPUT);
        check(clump == NULL);
        if (!strstr(error.text, cases[i].key))
            print_error("'%s' does not name '%s'\n", error.text, cases[i].key);
        check(strstr(error.text, cases[i].key) != NULL);
    }
}

static void a_flat_plate_is_a_body(void **state)
{
    (void)state;
    dem_clump_def def = sample_clump();
    def.inertia[0] = 0.1, def.inertia[1] = 0.2, def.inertia[2] = 0.1 + 0.2;
    dem_clump_destroy(made_clump(&def));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_clump_gives_back_what_it_was_made_from),
        cmocka_unit_test(a_copy_of_the_bytes_is_the_clump),
        cmocka_unit_test(the_hash_sees_every_change_but_the_seconds),
        cmocka_unit_test(what_is_not_known_is_one_nan),
        cmocka_unit_test(texts_that_are_not_given_are_empty),
        cmocka_unit_test(a_rounded_orientation_becomes_a_unit_quaternion),
        cmocka_unit_test(what_is_no_clump_is_refused_by_the_name_of_its_key),
        cmocka_unit_test(a_flat_plate_is_a_body),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
