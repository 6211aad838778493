#include "scenes.h"

#include "base/file.h"
#include "base/units.h"
#include "sim/scene_reader.h"

// ---- defaults

static void a_scene_of_nothing_has_all_defaults(void **state)
{
    (void)state;
    dem_scene s = scene_of("{'schema': 'dem-scene/1'}");
    assert_string_equal(s.title, "");
    check_vec(s.gravity, v3(0, 0, 0), 0);
    check(isnan(s.time.end) && s.time.step == 0 && s.time.safety == 0.8 && s.time.contact_steps == 10);
    check(isinf(s.domain.low.x) && s.domain.low.z < 0 && isinf(s.domain.high.y) && !s.domain.periodic[2]);
    check(s.domain.leaving == DEM_LEAVING_ERROR);
    check(!s.material_count && !s.law_count && !s.shape_count && !s.wall_count);
    check(!s.bodies.count && !s.bodies.fill_count);
    check(s.damping.local == 0 && s.damping.viscous == 0 && !s.damping.exclude_gravity);
    check(s.damping.local_frame == DEM_LOCAL_SPACE && s.multiple == DEM_MULTIPLE_SUM);
    assert_string_equal(s.output.directory, "out");
    check(s.output.frames == 0 && s.output.series == 0 && s.output.checkpoint == 0 && s.output.energy);
    dem_scene_release(&s);
    dem_scene_release(&s);
}

static void a_law_has_its_defaults(void **state)
{
    (void)state;
    dem_scene s = scene_of("{" SCENE_HEAD "}");
    dem_pair_law law = s.laws[1];
    check(law.materials[0] == 1 && law.materials[1] == 0 && law.stiffness == 2e4);
    check(law.effective_mass == DEM_MASS_LOCAL && law.normal == DEM_NORMAL_LINEAR);
    check(law.damping == DEM_DAMPING_NONE && law.tail == DEM_TAIL_CUT && law.friction == DEM_FRICTION_NONE);
    check(law.friction_coefficient == 0 && isnan(law.tangential_stiffness) && isnan(law.tangential_rate));
    check(law.stiffness_ratio == 2.0 / 7 && law.rescale);
    dem_scene_release(&s);
}

// ---- every key

static void the_plain_sections_are_read(void **state)
{
    (void)state;
    dem_scene s = scene_of(
        "{'schema': 'dem-scene/1', '$schema': 'x.json', 'title': 'sand', 'gravity': [0, '-9810 mm/s2', -1],\n"
        "'time': {'end': '500 ms', 'step': '1 us', 'safety': 0.5, 'contact_steps': 20},\n"
        "'domain': {'min': [0, '-1 cm', null], 'max': [1, 2, null], 'periodic': [true, false, false],\n"
        " 'leaving': 'ignore'}, 'inlets': {}, 'bonds': [],\n"
        "'damping': {'local': 0.7, 'local_frame': 'vector', 'exclude_gravity': true, 'viscous': '3 1/s',\n"
        " 'drag': {'density': '1 g/cm3', 'viscosity': '2 mPa s', 'velocity': [0, '5 cm/s', 0], 'buoyancy': true}},\n"
        "'integrator': {'translation': 'taylor', 'rotation': 'no-squish'}, 'contacts_between_clumps': 'merge',\n"
        "'output': {'directory': 'here', 'frames': '5 ms', 'series': 1e-3, 'checkpoint': '2 min', 'energy': false}}");
    assert_string_equal(s.title, "sand");
    check_vec(s.gravity, v3(0, -9.81, -1), 2e-15);
    check(s.time.end == 0.5 && s.time.step == 1e-6 && s.time.safety == 0.5 && s.time.contact_steps == 20);
    check_near(s.domain.low.y, -0.01, 1e-18);
    check(s.domain.low.x == 0 && isinf(s.domain.low.z) && s.domain.high.y == 2 && isinf(s.domain.high.z));
    check(s.domain.periodic[0] && !s.domain.periodic[1] && s.domain.leaving == DEM_LEAVING_IGNORE);
    check(s.damping.local == 0.7 && s.damping.local_frame == DEM_LOCAL_VECTOR && s.damping.exclude_gravity);
    check(s.damping.viscous == 3 && s.multiple == DEM_MULTIPLE_MERGE);
    check(s.damping.drag.density == 1000 && s.damping.drag.viscosity == 2e-3 && s.damping.drag.buoyancy);
    check_vec(s.damping.drag.velocity, v3(0, 0.05, 0), 1e-17);
    check(s.integrator.translation == DEM_TRANSLATION_TAYLOR && s.integrator.rotation == DEM_ROTATION_NO_SQUISH);
    assert_string_equal(s.output.directory, "here");
    dem_scene soft = scene_of("{'schema': 'dem-scene/1', 'contacts_between_clumps': 'soft', 'soft': {'tau': '3 um'}}");
    check(soft.multiple == DEM_MULTIPLE_SOFT && soft.soft.tau == 3e-6 && s.soft.tau == 0);
    dem_scene_release(&soft);
    check(s.output.frames == 5e-3 && s.output.series == 1e-3 && s.output.checkpoint == 120 && !s.output.energy);
    check(!s.output.checkpoint_wall);
    dem_scene_release(&s);
    s = scene_of("{'schema': 'dem-scene/1', 'time': {'step': 'auto'}, 'output': {'checkpoint': '1 min wall'}}");
    check(s.time.step == 0 && s.output.checkpoint == 60 && s.output.checkpoint_wall);
    dem_scene_release(&s);
}

static void every_key_of_a_law_is_read(void **state)
{
    (void)state;
    dem_scene s = scene_of(
        "{'schema': 'dem-scene/1', 'materials': {'a': {'young': '70 GPa', 'poisson': 0.17, 'density': '2.65 g/cm3'},\n"
        " 'b': {'young': 1e9, 'poisson': 0.5}, 'c': {}}, 'contacts': [\n"
        "{'between': ['a', 'b'], 'effective_mass': 'body', 'normal': {'law': 'linear', 'stiffness_from': 'young',\n"
        " 'restitution': 0.5, 'restitution_mode': 'tension_allowed'},\n"
        " 'friction': {'law': 'linear', 'stiffness': '1 kN/m', 'coefficient': 0.4, 'static_coefficient': 0.5, 'decay':\n"
        " '3 s/mm', 'damping_rate': 7}},\n"
        "{'between': ['a', 'a'], 'effective_mass': 'local', 'normal': {'law': 'hertz', 'damping_rate': '5 Hz',\n"
        " 'restitution_mode': 'cut_corrected'},\n"
        " 'friction': {'law': 'mindlin', 'coefficient': 0, 'rescale': false}},\n"
        "{'between': ['b', 'b'], 'normal': {'stiffness': '1 MN/m', 'restitution': 1},\n"
        " 'friction': {'coefficient': 1, 'stiffness_ratio': 0.5}, 'cohesion': {'law': 'breakable', 'tension': '2 kN',\n"
        " 'shear': 5, 'gap': '1 mm'}},\n"
        "{'between': ['c', 'c'], 'normal': {'stiffness': 1}, 'friction': null, 'rolling': null},\n"
        "{'between': ['a', 'c'], 'normal': {'stiffness': 1}, 'friction': {'coefficient': 1},\n"
        " 'rolling': {'law': 'epsd', 'coefficient': 0.1, 'stiffness': 3, 'damping': 0.2},\n"
        " 'twisting': {'law': 'marshall'}, 'cohesion': {'law': 'sjkr', 'energy_density': '3 J/m3'}},\n"
        "{'between': ['b', 'c'], 'normal': {'stiffness': 1}, 'rolling': {'law': 'bounded', 'coefficient': 0.2},\n"
        " 'twisting': {'law': 'constant', 'coefficient': 0.3}}]}");
    check(s.material_count == 3 && s.law_count == 6);
    check_close(s.materials[0].density, 2650, 1e-15);
    check(s.materials[0].young == 70e9 && s.materials[0].poisson == 0.17);
    check(isnan(s.materials[2].density) && isnan(s.materials[2].young) && isnan(s.materials[2].poisson));
    const dem_pair_law *l = s.laws;
    check(l[0].materials[0] == 0 && l[0].materials[1] == 1 && l[0].effective_mass == DEM_MASS_BODY);
    check(l[0].normal == DEM_NORMAL_LINEAR && l[0].stiffness == 0 && l[0].damping == DEM_DAMPING_RESTITUTION);
    check(l[0].restitution == 0.5 && l[0].tail == DEM_TAIL_TENSION && l[0].friction == DEM_FRICTION_LINEAR);
    check(l[0].tangential_stiffness == 1000 && l[0].friction_coefficient == 0.4 && l[0].tangential_rate == 7);
    check(l[0].static_coefficient == 0.5 && l[0].friction_decay == 3000 && isnan(l[1].static_coefficient));
    check(l[1].normal == DEM_NORMAL_HERTZ && l[1].damping == DEM_DAMPING_RATE && l[1].damping_rate == 5);
    check(l[1].tail == DEM_TAIL_CUT && l[1].friction == DEM_FRICTION_MINDLIN && !l[1].rescale);
    check(l[2].stiffness == 1e6 && l[2].damping == DEM_DAMPING_RESTITUTION && l[2].restitution == 1);
    check(l[2].friction == DEM_FRICTION_LINEAR && l[2].stiffness_ratio == 0.5 && isnan(l[2].tangential_stiffness));
    check(l[2].cohesion == DEM_COHESION_BREAKABLE && l[2].bond_tension == 2000 && l[2].bond_shear == 5);
    check(l[2].bonded == DEM_BONDED_AT_START && l[2].bond_gap == 1e-3);
    check(l[3].friction == DEM_FRICTION_NONE && l[3].damping == DEM_DAMPING_NONE);
    check(l[3].rolling == DEM_ROLLING_NONE && l[3].twisting == DEM_TWISTING_NONE);
    check(l[4].rolling == DEM_ROLLING_EPSD && l[4].rolling_coefficient == 0.1 && l[4].rolling_stiffness == 3);
    check(l[4].rolling_damping == 0.2 && l[4].twisting == DEM_TWISTING_MARSHALL);
    check(l[4].cohesion == DEM_COHESION_SJKR && l[4].energy_density == 3);
    check(l[5].rolling == DEM_ROLLING_BOUNDED && l[5].rolling_coefficient == 0.2 && isnan(l[5].rolling_stiffness));
    check(l[5].twisting == DEM_TWISTING_CONSTANT && l[5].twisting_coefficient == 0.3);
    dem_scene_release(&s);
}

static void the_friction_without_a_name_goes_with_the_normal_law(void **state)
{
    (void)state;
    dem_scene s = scene_of("{'schema': 'dem-scene/1', 'materials': {'a': {'young': 1, 'poisson': 0}}, 'contacts': [\n"
                           "{'between': ['a', 'a'], 'normal': {'law': 'hertz'}, 'friction': {'coefficient': 1}}]}");
    check(s.laws[0].friction == DEM_FRICTION_MINDLIN && s.laws[0].rescale);
    dem_scene_release(&s);
}

static void the_safety_is_smaller_where_a_hertz_law_is_in_force(void **state)
{
    (void)state;
    static const char text[] =
        "{'schema': 'dem-scene/1', 'materials': {'a': {'young': 1, 'poisson': 0, 'density': 1}},\n"
        "'contacts': [{'between': ['a', 'a'], 'normal': {'law': 'hertz'}}]%s}";
    char with[400];
    snprintf(with, sizeof with, text, ", 'shapes': {'s': {'sphere': {'radius': 1}, 'material': 'a'}}");
    dem_scene s = scene_of(with);
    check(s.time.safety == 0.5);
    dem_scene_release(&s);
    snprintf(with, sizeof with, text, "");
    s = scene_of(with);
    check(s.time.safety == 0.8);
    dem_scene_release(&s);
}

// ---- shapes

static void spheres_get_the_mass_and_frame_of_their_union(void **state)
{
    (void)state;
    dem_scene s = scene_of("{" SCENE_HEAD "}");
    check(s.shape_count == 2 && s.shapes[0].sphere_radius == 0.5 && !s.shapes[0].clump);
    assert_string_equal(s.shapes[1].name, "pair");
    dem_clump_def def = dem_clump_view(s.shapes[1].clump);
    // two balls of radius 1, one radius apart: 9 pi / 4; the axis of symmetry is the first principal axis
    check_close(def.mass, 2500 * 9 * DEM_PI / 4, 1e-13);
    check_close(def.volume, 9 * DEM_PI / 4, 1e-13);
    check_near(fabs(def.balls[0].centre.x), 0.5, 1e-15);
    check_vec(v3_add(def.balls[0].centre, def.balls[1].centre), v3(0, 0, 0), 1e-15);
    check_near(def.balls[0].centre.y, 0, 1e-15);
    check_close(def.inertia[1], def.inertia[2], 1e-13);
    check(def.inertia[0] < def.inertia[1] && def.mass_from == DEM_MASS_FROM_UNION && def.density == 2500);
    check_near(dem_shape_diameter(&s.shapes[1]), cbrt(13.5), 1e-13);
    check_near(dem_shape_diameter(&s.shapes[0]), 1, 0);
    dem_scene_release(&s);
}

static void spheres_keep_a_mass_that_is_given(void **state)
{
    (void)state;
    dem_scene s = scene_of(
        "{'schema': 'dem-scene/1', 'materials': {'a': {'density': 4}, 'b': {}}, 'contacts': [\n"
        "{'between': ['a', 'a'], 'normal': {'stiffness': 1}}, {'between': ['a', 'b'], 'normal': {'stiffness': 1}},\n"
        "{'between': ['b', 'b'], 'normal': {'stiffness': 1}}], 'shapes': {'s': {'spheres': [['10 cm', 0, 0, 1]],\n"
        " 'mass': '2 g', 'inertia': [1e-3, '2e-3 kg m2', 2e-3], 'material': 'a'}, 'd': {'sphere': {'diameter': '2 "
        "m'},\n"
        " 'material': 'a'}, 'e': {'spheres': [[0, 0, 0, 1]], 'mass': 2, 'inertia': [1, 1, 1], 'material': 'b'}}}");
    dem_clump_def def = dem_clump_view(s.shapes[0].clump);
    check(def.mass == 2e-3 && def.density == 4 && def.volume == 5e-4 && def.mass_from == DEM_MASS_GIVEN);
    check_near(def.balls[0].centre.x, 0.1, 1e-17);
    check(def.inertia[0] == 1e-3 && def.inertia[2] == 2e-3 && s.shapes[1].sphere_radius == 1);
    // without a density the mass stands for the volume of the spheres
    def = dem_clump_view(s.shapes[2].clump);
    check_close(def.volume, 4 * DEM_PI / 3, 1e-14);
    check_close(def.density, 2 / (4 * DEM_PI / 3), 1e-14);
    dem_scene_release(&s);
}

// ---- bodies and fills

static void a_body_has_its_values(void **state)
{
    (void)state;
    dem_scene s = scene_of("{" SCENE_HEAD
                           ", 'bodies': [{'shape': 'pair', 'position': [1, '2 mm', 3], 'orientation': [2, 0, 0, 2],\n"
                           "'velocity': ['36 km/h', 0, 0], 'spin': [0, '60 rpm', 0], 'scale': 2},\n"
                           "{'shape': 'ball', 'position': [0, 0, 0], 'size': '20 cm'}, {'shape': 'pair', 'position': "
                           "[0, 0, 9], 'size': 1}]}");
    check(s.bodies.count == 3 && s.bodies.fill_count == 0);
    const dem_body_def *b = s.bodies.bodies;
    check(b[0].shape == 1 && b[0].scale == 2);
    check_vec(b[0].position, v3(1, 2e-3, 3), 1e-18);
    check_near(b[0].orientation.w, sqrt(0.5), 1e-15);
    check_near(b[0].orientation.z, sqrt(0.5), 1e-15);
    check_vec(b[0].velocity, v3(10, 0, 0), 1e-14);
    check_vec(b[0].spin, v3(0, 2 * DEM_PI, 0), 1e-14);
    check_near(b[1].scale, 0.2, 1e-16);
    check(b[1].orientation.w == 1 && b[1].velocity.x == 0 && b[1].spin.z == 0);
    check_close(b[2].scale, 1 / cbrt(13.5), 1e-13);
    check(s.dimension == 3 && b[0].hold == 0 && b[2].hold == 0);
    dem_scene_release(&s);
}

static void bodies_of_any_kind_can_be_held(void **state)
{
    (void)state;
    dem_scene s = scene_of("{" SCENE_HEAD ", 'dimension': 2, 'bodies': [\n"
                           "{'shape': 'ball', 'position': [0, 0, 0], 'fixed': true},\n"
                           "{'shape': 'ball', 'position': [0, 0, 0], 'fixed': false, 'lock': 'ry'},\n"
                           "{'shape': 'ball', 'position': [0, 0, 0], 'lock': ['x', 'y', 'z', 'rx', 'ry', 'rz']},\n"
                           "{'shape': 'ball', 'position': [0, 0, 0], 'velocity': [1, 2, 3], 'prescribed': "
                           "['velocity']},\n"
                           "{'shape': 'ball', 'position': [0, 0, 0], 'spin': [1, 2, 3], 'prescribed': 'spin'},\n"
                           "{'fill': {'mix': [{'shape': 'ball'}], 'box': [[0, 0, 0], [1, 1, 1]], 'count': 1},\n"
                           " 'lock': ['x', 'rz']}]}");
    const dem_body_def *b = s.bodies.bodies;
    check(s.dimension == 2 && b[0].hold == (DEM_HOLD_VELOCITY | DEM_HOLD_SPIN) && b[1].hold == DEM_LOCK_RY);
    check(b[2].hold == 63 && b[3].hold == DEM_HOLD_VELOCITY && b[4].hold == DEM_HOLD_SPIN);
    check(s.bodies.fills[0].hold == (DEM_LOCK_X | DEM_LOCK_RZ));
    dem_scene_release(&s);
}

static void a_fill_has_its_values(void **state)
{
    (void)state;
    dem_scene s = scene_of(
        "{" SCENE_HEAD ", 'bodies': [{'fill': {'box': [[0, 0, 0], [1, '2 m', 3]], 'count': 2e3, 'seed': 7,\n"
        "'gap': '1 um', 'velocity': [0, 0, -1], 'share_by': 'mass', 'mix': [{'shape': 'ball', 'share': 3},\n"
        " {'shape': 'pair', 'size': '1 mm'}, {'shape': 'pair', 'size': {'law': 'fixed', 'value': 2, 'by': 'mass'}},\n"
        " {'shape': 'pair', 'size': {'law': 'uniform', 'min': 1, 'max': 2}},\n"
        " {'shape': 'pair', 'size': {'law': 'normal', 'mean': '2 mm', 'sigma': '1 mm', 'min': '1 mm'}},\n"
        " {'shape': 'pair', 'size': {'law': 'lognormal', 'median': 2, 'sigma': 0.3, 'max': 4, 'by': 'number'}},\n"
        " {'shape': 'pair', 'size': {'law': 'table', 'sizes': ['1 mm', 2], 'passing': [0, 1]}}]}},\n"
        "{'fill': {'mix': [{'shape': 'ball'}], 'box': [[0, 0, 5], [1, 1, 6]], 'void_ratio': 0.8}}]}");
    check(s.bodies.count == 0 && s.bodies.fill_count == 2);
    const dem_fill_def *f = s.bodies.fills;
    check_vec(f[0].high, v3(1, 2, 3), 0);
    check(f[0].count == 2000 && f[0].void_ratio == 0 && f[0].seed == 7 && f[0].share_by_mass && f[0].mix_count == 7);
    check_near(f[0].gap, 1e-6, 1e-21);
    check_vec(f[0].velocity, v3(0, 0, -1), 0);
    const dem_mix_def *m = f[0].mix;
    check(m[0].share == 3 && m[0].shape == 0 && m[0].size.law == DEM_SIZE_AS_IS && m[1].share == 1);
    check(m[1].size.law == DEM_SIZE_FIXED && m[1].size.a == 1e-3 && !m[1].size.by_mass);
    check(m[2].size.law == DEM_SIZE_FIXED && m[2].size.a == 2 && m[2].size.by_mass);
    check(m[3].size.law == DEM_SIZE_UNIFORM && m[3].size.a == 1 && m[3].size.b == 2);
    check(m[3].size.smallest == 0 && isinf(m[3].size.largest));
    check(m[4].size.law == DEM_SIZE_NORMAL && m[4].size.a == 2e-3 && m[4].size.b == 1e-3 && m[4].size.smallest == 1e-3);
    check(isinf(m[4].size.largest));
    check(m[5].size.law == DEM_SIZE_LOGNORMAL && m[5].size.a == 2 && m[5].size.b == 0.3 && m[5].size.largest == 4);
    check(m[6].size.law == DEM_SIZE_TABLE && m[6].size.table_count == 2 && m[6].size.sizes[0] == 1e-3);
    check(m[6].size.passing[1] == 1);
    check(f[1].count == 0 && f[1].void_ratio == 0.8 && f[1].seed == 1 && f[1].gap == 0 && !f[1].share_by_mass);
    dem_scene_release(&s);
}

// ---- walls

static void inlets_have_their_values(void **state)
{
    (void)state;
    dem_scene s;
    dem_error error;
    char *text = NULL;
    const char *source =
        "{'schema': 'dem-scene/1', 'domain': {'leaving': 'delete'}, 'materials': {'a': {'density': 2000}, 'c': {}},"
        " 'contacts': [{'between': ['a', 'a'], 'normal': {'law': 'linear', 'stiffness': 1}},"
        "  {'between': ['a', 'c'], 'normal': {'law': 'linear', 'stiffness': 1}}],"
        " 'shapes': {'b': {'sphere': {'radius': '1 mm'}, 'material': 'a'}},"
        " 'inlets': {'top': {'box': [[0, 0, 0], [1, 1, 1]], 'mix': [{'shape': 'b'}], 'mass_rate': '36 kg/h',"
        "   'velocity': [0, 0, -1], 'velocity_spread': '1 cm/s', 'spin': [1, 2, 3], 'spin_spread': 4, 'start': '1 s',"
        "   'stop': 2, 'count': 50, 'gap': '1 mm', 'seed': 7},"
        "  'jet': {'sphere': {'centre': [1, 2, 3], 'radius': '2 mm'}, 'rate': 10, 'velocity': [1, 0, 0],"
        "   'mix': [{'shape': 'b', 'size': {'law': 'uniform', 'min': '1 mm', 'max': '2 mm'}}], 'share_by': 'mass'},"
        "  'steel': {'sphere': {'centre': [4, 5, 6], 'radius': '3 mm', 'material': 'c'}, 'rate': 1, 'velocity': [1, 0, 0],"
        "   'mix': [{'shape': 'b'}]},"
        "  'open': {'sphere': {'centre': [7, 8, 9], 'radius': '3 mm', 'solid': false}, 'rate': 1, 'velocity': [1, 0, 0],"
        "   'mix': [{'shape': 'b'}]}}}";
    for (int i = 0; i < 2; i++) {
        // as given, and as it is written
        char *json = text ? text : strdup(source);
        check_ok(scene_read(json, NULL, NULL, &s, &error), error);
        check(s.domain.leaving == DEM_LEAVING_DELETE);
        assert_int_equal(s.inlet_count, 4);
        const dem_inlet_def *a = &s.inlets[0], *b = &s.inlets[1];
        assert_string_equal(a->name, "top");
        check(a->kind == DEM_INLET_BOX && a->by_mass && a->high.z == 1 && a->mix_count == 1 && a->seed == 7);
        check_near(a->rate, 0.01, 1e-15);
        check(a->velocity.z == -1 && a->velocity_spread == 0.01 && a->spin.z == 3 && a->spin_spread == 4);
        check(a->start == 1 && a->stop == 2 && a->count == 50 && a->gap == 0.001);
        check(b->kind == DEM_INLET_SPHERE && !b->by_mass && b->rate == 10 && b->radius == 0.002 && b->centre.y == 2);
        check(b->share_by_mass && b->mix[0].size.law == DEM_SIZE_UNIFORM && b->stop == INFINITY && b->seed == 1);
        // the sphere is a wall, of the grains' material where none is named, unless it is not to be
        const dem_inlet_def *c = &s.inlets[2], *d = &s.inlets[3];
        check(!a->solid && b->solid && b->material == 0 && c->solid && c->material == 1 && !d->solid);
        assert_int_equal(s.wall_count, 2);
        for (size_t k = 0; k < 2; k++) {
            const dem_wall_def *wall = &s.walls[k];
            check(wall->generator && wall->kind == DEM_WALL_SPHERE && wall->outside && wall->material == k);
            check(wall->radius == (k ? 0.003 : 0.002) && wall->point.z == (k ? 6 : 3));
        }
        free(json);
        if (i == 0)
            check_ok(dem_scene_resolved(&s, &text, &error), error);
        dem_scene_release(&s);
    }
}

static void walls_have_their_values(void **state)
{
    (void)state;
    dem_scene s = scene_of(
        "{" SCENE_HEAD
        ", 'walls': {'floor': {'plane': {'point': [0, 0, '1 mm'], 'normal': [0, 0, 5]}, 'material': 'steel'},\n"
        "'drum': {'cylinder': {'point': [1, 2, 3], 'axis': [0, -2, 0], 'radius': '5 cm', 'side': 'outside'},\n"
        " 'material': 'rock', 'motion': {'translate': {'velocity': [1, 0, 0]},\n"
        "  'rotate': {'axis': [0, 3, 0], 'through': [1, 1, 1], 'rate': '60 rpm'}}},\n"
        "'cell': {'box': {'min': [0, 0, 0], 'max': [1, 2, 3]}, 'material': 'steel'}}}");
    check(s.wall_count == 8);
    const dem_wall_def *w = s.walls;
    check(w[0].kind == DEM_WALL_PLANE && w[0].material == 1);
    check_vec(w[0].point, v3(0, 0, 1e-3), 0);
    check_vec(w[0].normal, v3(0, 0, 1), 0);
    check_vec(w[0].spin, v3(0, 0, 0), 0);
    check(w[1].kind == DEM_WALL_CYLINDER && w[1].outside && w[1].radius == 0.05);
    check_vec(w[1].normal, v3(0, -1, 0), 0);
    check_vec(w[1].velocity, v3(1, 0, 0), 0);
    check_vec(w[1].through, v3(1, 1, 1), 0);
    check_vec(w[1].spin, v3(0, 2 * DEM_PI, 0), 1e-15);
    static const char *const names[] = {"cell.x-", "cell.x+", "cell.y-", "cell.y+", "cell.z-", "cell.z+"};
    for (int i = 0; i < 6; i++) {
        const dem_wall_def *side = &w[2 + i];
        assert_string_equal(side->name, names[i]);
        check(side->kind == DEM_WALL_PLANE && side->material == 1);
        // the middle of the box lies inside of every side, at half its width
        double depth = v3_dot(v3_sub(v3(0.5, 1, 1.5), side->point), side->normal);
        check_near(depth, 0.5 * (1 + i / 2), 1e-15);
    }
    dem_scene_release(&s);
}

// ---- files

static void the_sample_of_the_design_reads_with_its_files(void **state)
{
    (void)state;
    put_scene_file("sample.json", SCENE_SAMPLE);
    dem_scene s;
    dem_error error;
    char path[300], want[300];
    strcpy(path, in_scene_folder("sample.json"));
    check_ok(dem_scene_read(NULL, path, NULL, &s, &error), error);
    snprintf(want, sizeof want, "%s/grain.json", scene_folder());
    assert_string_equal(s.shapes[0].clump_file, want);
    check(dem_clump_view(s.shapes[0].clump).mass == 5);
    check(s.bodies.count == 2 && s.bodies.bodies[0].velocity.z == 6 && s.bodies.bodies[0].scale == 0.5);
    check(s.bodies.fill_count == 1 && s.bodies.fills[0].count == 2000);
    check(s.wall_count == 2 && s.walls[1].kind == DEM_WALL_MESH && s.walls[1].mesh.triangle_count == 4);
    check_vec(s.walls[1].mesh.vertices[1], v3(0.01, 0, 0), 0);
    assert_string_equal(s.output.directory, "out");
    check(s.output.checkpoint == 60 && s.output.checkpoint_wall);
    dem_scene_release(&s);
}

static void a_file_that_is_not_there_is_named_at_its_place(void **state)
{
    (void)state;
    dem_scene s;
    dem_error error;
    char *text = strdup(SCENE_SAMPLE), *name = strstr(text, "grain.json");
    name[0] = 'b';
    check(scene_read(text, scene_folder(), NULL, &s, &error) == DEM_BAD_INPUT);
    check(error.line == 8 && strstr(error.text, "shapes.grain.clump: cannot read") && strstr(error.text, "brain.json"));
    check(strstr(error.text, "(column 35)") != NULL);
    name[0] = 'g';
    check(scene_read(text, NULL, NULL, &s, &error) == DEM_BAD_INPUT);
    check(strstr(error.text, "files are not read here") != NULL);
    check(!s.owner && !s.shape_count);
    put_scene_file("broken.csv", "shape,x,y,z\ngrain,1,2\n");
    char *bodies = strstr(text, "bodies.csv");
    memcpy(bodies, "broken", 6);
    check(scene_read(text, scene_folder(), NULL, &s, &error) == DEM_BAD_INPUT);
    check(error.line == 2 && strstr(error.file, "/broken.csv"));
    check(dem_scene_read(NULL, in_scene_folder("nothing.json"), NULL, &s, &error) == DEM_BAD_INPUT);
    check(!s.owner);
    free(text);
}

// ---- the published schema

// the part of a schema that lists properties: behind a reference, a list, a map, or one of several forms
static const dem_json *definitions;

static const dem_json *listing(const dem_json *schema)
{
    const dem_json *list = dem_json_member(schema, "properties"), *any = dem_json_member(schema, "oneOf");
    const char *reference = dem_json_string(dem_json_member(schema, "$ref"));
    if (reference)
        return listing(dem_json_member(definitions, reference + strlen("#/$defs/")));
    if (list)
        return list;
    for (size_t i = 0; i < dem_json_length(any) && !list; i++)
        list = listing(dem_json_item(any, i));
    if (!list && dem_json_is_object(dem_json_member(schema, "items")))
        list = listing(dem_json_member(schema, "items"));
    if (!list && dem_json_is_object(dem_json_member(schema, "additionalProperties")))
        list = listing(dem_json_member(schema, "additionalProperties"));
    return list;
}

static bool is_built(const dem_field *field)
{
    return field->read != dem_field_not_built;
}

static int compare_keys(const dem_json *schema, const dem_fields *fields, const char *where)
{
    const dem_json *properties = listing(schema);
    int seen = 0;
    for (const char *key = NULL; (key = dem_json_next(properties, key));) {
        size_t i = 0;
        while (i < fields->count && strcmp(fields->items[i].name, key) != 0)
            i++;
        if (i == fields->count || !is_built(&fields->items[i]))
            print_error("%s.%s is in the schema, but not read\n", where, key);
        check(i < fields->count && is_built(&fields->items[i]));
    }
    for (size_t i = 0; i < fields->count; i++) {
        const dem_field *field = &fields->items[i];
        const dem_json *property = dem_json_member(properties, field->name);
        if (is_built(field) && !property)
            print_error("%s.%s is read, but not in the schema\n", where, field->name);
        check(!is_built(field) || property);
        seen++;
        if (field->fields)
            seen += compare_keys(property, field->fields, field->name);
        else if (property)
            check(!listing(property));
    }
    return seen;
}

static void the_schema_lists_what_is_read(void **state)
{
    (void)state;
    dem_buffer text;
    dem_json *schema;
    dem_error error;
    check_ok(dem_file_read(DEM_SOURCE_DIR "/lib/sim/dem-scene-1.schema.json", &text, &error), error);
    check_ok(dem_json_parse(text.data, text.size, "schema", &schema, &error), error);
    definitions = dem_json_member(schema, "$defs");
    check(compare_keys(schema, &dem_scene_fields, "scene") > 100);
    dem_json_release(schema);
    dem_buffer_release(&text);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_scene_of_nothing_has_all_defaults),
        cmocka_unit_test(a_law_has_its_defaults),
        cmocka_unit_test(the_plain_sections_are_read),
        cmocka_unit_test(every_key_of_a_law_is_read),
        cmocka_unit_test(the_friction_without_a_name_goes_with_the_normal_law),
        cmocka_unit_test(the_safety_is_smaller_where_a_hertz_law_is_in_force),
        cmocka_unit_test(spheres_get_the_mass_and_frame_of_their_union),
        cmocka_unit_test(spheres_keep_a_mass_that_is_given),
        cmocka_unit_test(a_body_has_its_values),
        cmocka_unit_test(bodies_of_any_kind_can_be_held),
        cmocka_unit_test(a_fill_has_its_values),
        cmocka_unit_test(inlets_have_their_values),
        cmocka_unit_test(walls_have_their_values),
        cmocka_unit_test(the_sample_of_the_design_reads_with_its_files),
        cmocka_unit_test(a_file_that_is_not_there_is_named_at_its_place),
        cmocka_unit_test(the_schema_lists_what_is_read),
    };
    return cmocka_run_group_tests(tests, make_scene_folder, remove_scene_folder);
}
