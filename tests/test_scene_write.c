#include "scenes.h"

#include "base/random.h"
#include "base/text.h"

static void check_same_text(const char *a, const char *b)
{
    if (strcmp(a, b) != 0)
        print_error("%s\n---\n%s\n", a, b);
    check(strcmp(a, b) == 0);
}

static bool same(double a, double b)
{
    return a == b || (isnan(a) && isnan(b));
}

static void check_same_law(const dem_pair_law *a, const dem_pair_law *b)
{
    check(a->materials[0] == b->materials[0] && a->materials[1] == b->materials[1]);
    check(a->effective_mass == b->effective_mass && a->normal == b->normal && same(a->stiffness, b->stiffness));
    check(a->damping == b->damping && a->restitution == b->restitution && a->damping_rate == b->damping_rate);
    check(a->tail == b->tail && a->friction == b->friction && a->friction_coefficient == b->friction_coefficient);
    check(same(a->tangential_stiffness, b->tangential_stiffness) && same(a->tangential_rate, b->tangential_rate));
    check(a->stiffness_ratio == b->stiffness_ratio && a->rescale == b->rescale);
    check(a->work_of_adhesion == b->work_of_adhesion && a->rolling == b->rolling && a->twisting == b->twisting);
    check(a->rolling_coefficient == b->rolling_coefficient && a->rolling_damping == b->rolling_damping);
    check(same(a->rolling_stiffness, b->rolling_stiffness) && a->twisting_coefficient == b->twisting_coefficient);
    check(a->cohesion == b->cohesion && a->energy_density == b->energy_density);
    check(same(a->static_coefficient, b->static_coefficient) && a->friction_decay == b->friction_decay);
    check(a->bond_tension == b->bond_tension && a->bond_shear == b->bond_shear && a->bonded == b->bonded);
    check(a->bond_gap == b->bond_gap);
}

static void check_same_fill(const dem_fill_def *a, const dem_fill_def *b)
{
    check(a->mix_count == b->mix_count && a->share_by_mass == b->share_by_mass && a->count == b->count);
    check(a->void_ratio == b->void_ratio && a->gap == b->gap && a->seed == b->seed && a->hold == b->hold);
    check_vec(a->low, b->low, 0);
    check_vec(a->high, b->high, 0);
    check_vec(a->velocity, b->velocity, 0);
    for (size_t i = 0; i < a->mix_count; i++) {
        const dem_mix_def *x = &a->mix[i], *y = &b->mix[i];
        check(x->shape == y->shape && x->share == y->share && x->size.law == y->size.law);
        check(x->size.a == y->size.a && x->size.b == y->size.b && x->size.by_mass == y->size.by_mass);
        check(x->size.smallest == y->size.smallest && x->size.largest == y->size.largest);
        check(x->size.table_count == y->size.table_count);
        for (size_t k = 0; k < x->size.table_count; k++)
            check(x->size.sizes[k] == y->size.sizes[k] && x->size.passing[k] == y->size.passing[k]);
    }
}

// compares what the text cannot: numbers in every bit, clumps, meshes
static void check_same_scene(const dem_scene *a, const dem_scene *b)
{
    check(a->dimension == b->dimension && a->damping.drag.density == b->damping.drag.density);
    check(a->damping.drag.viscosity == b->damping.drag.viscosity &&
          a->damping.drag.buoyancy == b->damping.drag.buoyancy);
    check_vec(a->damping.drag.velocity, b->damping.drag.velocity, 0);
    check(a->shape_count == b->shape_count && a->bodies.count == b->bodies.count && a->wall_count == b->wall_count);
    assert_memory_equal(&a->time, &b->time, sizeof a->time);
    assert_memory_equal(&a->domain, &b->domain, offsetof(dem_domain_def, periodic) + sizeof a->domain.periodic);
    check(a->domain.leaving == b->domain.leaving && a->multiple == b->multiple && a->soft.tau == b->soft.tau);
    assert_memory_equal(&a->integrator, &b->integrator, sizeof a->integrator);
    assert_memory_equal(&a->gravity, &b->gravity, sizeof a->gravity);
    for (size_t i = 0; i < a->shape_count; i++) {
        check(a->shapes[i].disc_thickness == b->shapes[i].disc_thickness);
        check(a->shapes[i].sphere_radius == b->shapes[i].sphere_radius &&
              a->shapes[i].material == b->shapes[i].material);
        check(!a->shapes[i].clump == !b->shapes[i].clump);
        check(!a->shapes[i].clump || dem_clump_hash(a->shapes[i].clump) == dem_clump_hash(b->shapes[i].clump));
    }
    check(a->law_count == b->law_count && a->bodies.fill_count == b->bodies.fill_count);
    for (size_t i = 0; i < a->law_count; i++)
        check_same_law(&a->laws[i], &b->laws[i]);
    for (size_t i = 0; i < a->bodies.fill_count; i++)
        check_same_fill(&a->bodies.fills[i], &b->bodies.fills[i]);
    for (size_t i = 0; i < a->bodies.count; i++)
        assert_memory_equal(&a->bodies.bodies[i].scale, &b->bodies.bodies[i].scale,
                            offsetof(dem_body_def, hold) + sizeof(uint32_t) - offsetof(dem_body_def, scale));
    for (size_t i = 0; i < a->wall_count; i++) {
        check(a->walls[i].kind == b->walls[i].kind && a->walls[i].material == b->walls[i].material);
        check_vec(a->walls[i].spin, b->walls[i].spin, 0);
        check_vec(a->walls[i].normal, b->walls[i].normal, 0);
        check(a->walls[i].mesh.vertex_count == b->walls[i].mesh.vertex_count);
        for (size_t k = 0; k < a->walls[i].mesh.vertex_count; k++)
            check_vec(a->walls[i].mesh.vertices[k], b->walls[i].mesh.vertices[k], 0);
    }
}

static void check_round_trip(const char *text, const char *where)
{
    dem_scene scene, back;
    dem_error error;
    char *once, *twice;
    check_ok(scene_read(text, where, NULL, &scene, &error), error);
    check_ok(dem_scene_resolved(&scene, &once, &error), error);
    check_ok(dem_scene_read_text(NULL, once, strlen(once), "once.json", where ? "/" : NULL, NULL, &back, &error),
             error);
    check_ok(dem_scene_resolved(&back, &twice, &error), error);
    check_same_text(once, twice);
    check_same_scene(&scene, &back);
    free(once);
    free(twice);
    dem_scene_release(&scene);
    dem_scene_release(&back);
}

static void a_resolved_scene_reads_back_as_the_same(void **state)
{
    (void)state;
    check_round_trip("{'schema': 'dem-scene/1', 'dimension': 2, 'materials': {'a': {'density': 3}}, 'contacts': [\n"
                     "{'between': ['a', 'a'], 'normal': {'stiffness': 1}}], 'shapes': {'d': {'disc': {'diameter': 2, "
                     "'thickness': 0.3}, 'material': 'a'}, 'e': {'disc': {'radius': 1}, 'material': 'a'}}}",
                     NULL);
    check_round_trip("{'schema': 'dem-scene/1'}", NULL);
    check_round_trip(SCENE_SAMPLE, scene_folder());
    check_round_trip("{'schema': 'dem-scene/1', 'contacts_between_clumps': 'soft', 'soft': {'tau': '3 um'}}", NULL);
    check_round_trip("{'schema': 'dem-scene/1', 'contacts_between_clumps': 'soft'}", NULL);
    check_round_trip(
        "{" SCENE_HEAD
        ", 'dimension': 2, 'domain': {'min': [0, -1, null], 'max': [1.1, 1, null], 'periodic': [true, true, false]},\n"
        "'time': {'end': 0.1, 'step': 1e-6, 'contact_steps': 0}, 'contacts_between_clumps': 'mean',\n"
        "'damping': {'local': 0.7, 'local_frame': 'vector', 'viscous': 1, 'drag': {'density': '1 g/cm3', 'viscosity': "
        "'1 mPa s', 'velocity': [0, 1, '2 cm/s']}},\n"
        "'output': {'checkpoint': 3, 'energy': "
        "false},\n"
        "'walls': {'b': {'box': {'min': [0, 0, 0], 'max': [1, 2, 3]}, 'material': 'steel', 'motion': {'rotate':\n"
        " {'axis': [1, 2, 3], 'rate': '7 rpm', 'through': [1, 1, 1]}}}, 'c': {'cylinder': {'point': [1, 2, 3],\n"
        " 'axis': [1, 1, 0.1], 'radius': 1, 'side': 'outside'}, 'material': 'rock'},\n"
        " 'p': {'plane': {'point': [0, 0, 0], 'normal': [1, -7, 1e-3]}, 'material': 'steel', 'motion':\n"
        " {'rotate': {'axis': [-3, 0, 0], 'rate': 0}}}},\n"
        "'bodies': [{'shape': 'ball', 'position': [0.1, 0.2, 0.3], 'orientation': [1, 2, 3, 4], 'spin': [1, 2, 3]},\n"
        " {'fill': {'mix': [{'shape': 'ball', 'size': {'law': 'uniform', 'min': 0.1, 'max': 0.2}},\n"
        "  {'shape': 'pair', 'size': {'law': 'normal', 'mean': 1, 'sigma': 0.1, 'min': 0.5, 'max': 2, 'by': 'mass'}},\n"
        "  {'shape': 'pair', 'size': {'law': 'table', 'sizes': [1, 2, 3], 'passing': [0, 0.5, 1]}},\n"
        "  {'shape': 'pair', 'size': {'law': 'lognormal', 'median': 1, 'sigma': 0.1}}], 'share_by': 'mass',\n"
        "  'box': [[0, 0, 0], [1, 1, 1]], 'void_ratio': 0.7, 'seed': -3}},\n"
        " {'shape': 'pair', 'position': [1, 2, 3], 'size': '12 mm', 'fixed': true},\n"
        " {'shape': 'pair', 'position': [1, 2, 3], 'velocity': [1, 2, 3], 'prescribed': 'velocity', 'lock': ['rx', "
        "'rz']},\n"
        " {'fill': {'mix': [{'shape': 'ball'}], 'box': [[0, 0, 0], [1, 1, 1]], 'count': 2}, 'lock': 'z'}]}",
        NULL);
    check_round_trip(
        "{'schema': 'dem-scene/1', 'materials': {'a': {'young': 1e9, 'poisson': 0.3}, 'b': {'density': 3,\n"
        "'young': 1}, 'c': {'young': 1, 'poisson': 0.2}}, 'contacts': [\n"
        "{'between': ['a', 'a'], 'effective_mass': 'body', 'normal': {'law': 'hertz', 'damping_rate': 5,\n"
        " 'restitution_mode': 'tension_allowed'}, 'friction': {'coefficient': 1, 'rescale': false}},\n"
        "{'between': ['a', 'b'], 'normal': {'stiffness_from': 'young', 'restitution': 0.9},\n"
        " 'friction': {'coefficient': 1, 'stiffness_ratio': 0.1, 'damping_rate': 0}},\n"
        "{'between': ['b', 'b'], 'normal': {'stiffness': 1}, 'rolling': {'law': 'constant', 'coefficient': 0.1},\n"
        " 'twisting': {'law': 'constant', 'coefficient': 0.7},\n"
        " 'friction': {'coefficient': 1, 'stiffness': 0.1, 'static_coefficient': 1.5, 'decay': 7},\n"
        " 'cohesion': {'law': 'breakable', 'tension': 3, 'shear': 4, 'gap': 0.01}},\n"
        "{'between': ['c', 'c'], 'normal': {'law': 'dmt', 'work_of_adhesion': '50 mJ/m2'},\n"
        " 'rolling': {'law': 'epsd', 'coefficient': 0.1, 'damping': 0.7, 'stiffness': 5},\n"
        " 'twisting': {'law': 'marshall'}, 'cohesion': {'law': 'sjkr', 'energy_density': 7},\n"
        " 'friction': {'coefficient': 1}},\n"
        "{'between': ['c', 'a'], 'normal': {'stiffness': 1}, 'rolling': {'law': 'bounded', 'coefficient': 0.1},\n"
        " 'friction': {'coefficient': 1}, 'cohesion': {'law': 'breakable', 'tension': 3, 'shear': 4, 'bonded': "
        "'at_touch'}}],\n"
        "'shapes': {'s': {'spheres': [[0, 0, 0, 1], [0.1, 0.7, 0.3, 0.6]], 'mass': 2, 'inertia': [1, 2, 3],\n"
        " 'material': 'a'}, 't': {'spheres': [[5, 0, 0, 1], [5.1, 0.7, 0.3, 0.6], [4, 0, 0, 0.3]],\n"
        " 'material': 'b'}}}",
        NULL);
}

// directions and rotations are made unit once, and keep their bits from then on
static void directions_keep_their_bits(void **state)
{
    (void)state;
    dem_random r = random_stream(2, 0);
    for (int i = 0; i < 50; i++) {
        char text[1000], *start = text;
        const char *form = "{" SCENE_HEAD ", 'walls': {'w': {'plane': {'point': [0, 0, 0], 'normal': [#, #, #]},"
                           "'material': 'rock', 'motion': {'rotate': {'axis': [#, #, #], 'rate': #}}}},"
                           "'bodies': [{'shape': 'ball', 'position': [0, 0, 0], 'orientation': [#, #, #, #]}]}";
        for (const char *p = form; *p; p++)
            if (*p == '#')
                start += strlen(dem_format_double(start, 40, random_normal(&r), 17));
            else
                *start++ = *p;
        *start = 0;
        check_round_trip(text, NULL);
    }
}

static void every_default_is_written(void **state)
{
    (void)state;
    dem_scene s = scene_of("{" SCENE_HEAD "}");
    char *text;
    dem_error error;
    check_ok(dem_scene_resolved(&s, &text, &error), error);
    static const char *const parts[] = {"\"step\": \"auto\"",
                                        "\"safety\": 0.8",
                                        "\"contact_steps\": 10",
                                        "\"leaving\": \"error\"",
                                        "\"periodic\": [false, false, false]",
                                        "\"effective_mass\": \"local\"",
                                        "\"law\": \"linear\"",
                                        "\"restitution_mode\": \"cut_corrected\"",
                                        "\"friction\": null",
                                        "\"local_frame\": \"space\"",
                                        "\"exclude_gravity\": false",
                                        "\"translation\": \"central\"",
                                        "\"dimension\": 3",
                                        "\"contacts_between_clumps\": \"sum\"",
                                        "\"directory\": \"out\"",
                                        "\"checkpoint\": 0",
                                        "\"energy\": true"};
    for (size_t i = 0; i < sizeof parts / sizeof *parts; i++)
        if (!strstr(text, parts[i])) {
            print_error("%s not in %s\n", parts[i], text);
            check(false);
        }
    free(text);
    dem_scene_release(&s);
}

static void a_scene_made_by_hand_is_written_too(void **state)
{
    (void)state;
    const dem_ball ball = {{0, 0, 0}, 1};
    const dem_clump_def def = {.density = 2,
                               .mass = 2,
                               .volume = 1,
                               .inertia = {1, 1, 1},
                               .orientation = {1, 0, 0, 0},
                               .balls = &ball,
                               .ball_count = 1,
                               .union_volume = NAN};
    dem_clump *clump;
    dem_error error;
    check_ok(dem_clump_create(&def, &clump, &error), error);
    const dem_material material = {"m", 3, NAN, NAN};
    const dem_shape_def shape = {.name = "s", .clump = clump};
    dem_pair_law law = dem_pair_law_defaults();
    law.stiffness = 5;
    const dem_body_def bodies[] = {{0, 1, {1, 2, 3}, {1, 0, 0, 0}, {0, 0, 0}, {0, 0, 0}, 0, NULL},
                                   {0, 2, {4, 5, 6}, {1, 0, 0, 0}, {0, 0, 0}, {0, 0, 0}, DEM_LOCK_Z, NULL}};
    dem_wall_def wall = {.name = "w", .normal = {0, 0, 1}, .spin = {0, 0, 2}};
    dem_scene scene = dem_scene_defaults(), back;
    scene.materials = &material, scene.material_count = 1;
    scene.laws = &law, scene.law_count = 1;
    scene.shapes = &shape, scene.shape_count = 1;
    scene.bodies = (dem_bodies_def){.bodies = bodies, .count = 2};
    scene.walls = &wall, scene.wall_count = 1;
    char *text;
    check_ok(dem_scene_resolved(&scene, &text, &error), error);
    check_ok(dem_scene_read_text(NULL, text, strlen(text), "x", NULL, NULL, &back, &error), error);
    // the clump weighs what its material makes of it
    check(dem_clump_view(back.shapes[0].clump).mass == 3 && dem_clump_view(back.shapes[0].clump).density == 3);
    check(back.bodies.count == 2 && back.bodies.bodies[1].scale == 2 && back.walls[0].spin.z == 2);
    free(text);
    dem_scene_release(&back);
    wall.kind = DEM_WALL_MESH;
    check(dem_scene_resolved(&scene, &text, &error) == DEM_USAGE && !text);
    dem_clump_destroy(clump);
}

// the world has them; the scene still tells where they came from
static void a_scene_forgets_bodies_of_files_and_is_written_as_before(void **state)
{
    (void)state;
    dem_scene scene;
    dem_error error;
    dem_world *world, *whole;
    char *before, *after;
    check_ok(scene_read("{" SCENE_HEAD ", 'bodies': [{'shape': 'ball', 'position': [9, 0, 0]}, {'file': 'balls.csv'},\n"
                        "{'shape': 'pair', 'position': [20, 0, 0]}]}",
                        scene_folder(), NULL, &scene, &error),
             error);
    check_ok(dem_scene_resolved(&scene, &before, &error), error);
    check_ok(dem_world_create(NULL, &scene, &whole, &error), error);
    check(scene.bodies.count == 4);
    check_ok(dem_world_create_spending(NULL, &scene, &world, &error), error);
    check(scene.bodies.count == 2 && scene.bodies.bodies[1].position.x == 20);
    check(dem_world_bodies(world).count == 4 && dem_world_hash(world) == dem_world_hash(whole));
    check_ok(dem_scene_resolved(&scene, &after, &error), error);
    assert_string_equal(before, after);
    free(before);
    free(after);
    dem_world_destroy(world);
    dem_world_destroy(whole);
    dem_scene_release(&scene);
}

static int make_files(void **state)
{
    if (make_scene_folder(state) != 0)
        return -1;
    put_scene_file("balls.csv", "shape,x,y,z\nball,0,0,0\npair,0,5,0\n");
    return 0;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_resolved_scene_reads_back_as_the_same),
        cmocka_unit_test(directions_keep_their_bits),
        cmocka_unit_test(every_default_is_written),
        cmocka_unit_test(a_scene_made_by_hand_is_written_too),
        cmocka_unit_test(a_scene_forgets_bodies_of_files_and_is_written_as_before),
    };
    return cmocka_run_group_tests(tests, make_files, remove_scene_folder);
}
