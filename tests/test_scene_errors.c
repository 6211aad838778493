// What a scene file that cannot be used is told: the line, the column, the words.
#include "scenes.h"

typedef struct refusal {
    const char *text;
    long line;
    const char *message;  // the whole of it, or what it holds where it begins with '~'
} refusal;

static void check_refusals(const refusal *cases, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        dem_scene scene;
        dem_error error;
        const refusal *c = &cases[i];
        char *message = quoted(c->message), *said;
        dem_status status = scene_read(c->text, NULL, NULL, &scene, &error);
        said = quoted(error.text);
        bool told = *message == '~' ? strstr(said, message + 1) != NULL : strcmp(said, message) == 0;
        if (status != DEM_BAD_INPUT || !told || error.line != c->line || strcmp(error.file, "scene.json") != 0)
            print_error("%s\nstatus %d: %s:%ld: %s\nwanted :%ld: %s\n", c->text, status, error.file, error.line,
                        error.text, c->line, message);
        check(status == DEM_BAD_INPUT && told && error.line == c->line);
        check(strchr(error.text, ';') && strstr(error.text, "(column "));
        check(!scene.owner && !scene.shape_count && !scene.bodies.count);
        check(scene_read(c->text, NULL, NULL, &scene, &error) == DEM_BAD_INPUT);
        free(message);
        free(said);
    }
}
#define CHECK_REFUSALS(cases) check_refusals(cases, sizeof(cases) / sizeof *(cases))

#define S "{'schema': 'dem-scene/1',\n"
#define IN_HEAD(member) "{" SCENE_HEAD ",\n" member "}"  // what is added stands in line 7

static void unknown_keys_are_refused_with_a_suggestion(void **state)
{
    (void)state;
    static const refusal cases[] = {
        {S "'materials': {'a': {}}, 'contacts': [\n{'between': ['a', 'a'],\n'normal': {'stifness': 1}}]}", 4,
         "unknown key 'stifness' (column 12); did you mean 'stiffness'?"},
        {S "'gravitiy': [0, 0, 0]}", 2, "unknown key 'gravitiy' (column 1); did you mean 'gravity'?"},
        {S "'time': {'zzzzz': 1}}", 2, "unknown key 'zzzzz' (column 10); use one of: end, step, safety, contact_steps"},
        {S "'domain': {'mn': 1}}", 2, "~did you mean 'min'?"},
        {S "'materials': {'a': {'densty': 1}}}", 2, "~did you mean 'density'?"},
        {IN_HEAD("'shapes2': {}"), 7, "~did you mean 'shapes'?"},
        {IN_HEAD("'bodies': [{'shape': 'ball', 'pos': [0, 0, 0]}]"), 7, "~did you mean 'position'?"},
        {IN_HEAD("'bodies': [{'fill': {'mxi': []}}]"), 7, "~did you mean 'mix'?"},
        {IN_HEAD("'bodies': [{'fill': {'mix': [{'shap': 1}]}}]"), 7, "~did you mean 'shape'?"},
        {IN_HEAD("'walls': {'w': {'plain': {}}}"), 7, "~did you mean 'plane'?"},
        {IN_HEAD("'walls': {'w': {'material': 'rock', 'motion': {'rotat': {}}}}"), 7, "~did you mean 'rotate'?"},
        {S "'damping': {'locl': 1}}", 2, "~did you mean 'local'?"},
        {S "'integrator': {'rotations': 'lsym'}}", 2, "~did you mean 'rotation'?"},
        {S "'output': {'dir': 'x'}}", 2, "~did you mean 'directory'?"},
    };
    CHECK_REFUSALS(cases);
}

static void wrong_types_are_told_what_is_wanted(void **state)
{
    (void)state;
    static const refusal cases[] = {
        {"[1]", 1, "is not a scene file (column 1); one starts with { 'schema': 'dem-scene/1', ..."},
        {"{\n}", 1, "'schema' is missing (column 1); add it"},
        {"{'schema': 'dem-clump/1'}", 1,
         "schema: 'dem-clump/1' is no scene (column 12); a scene file says 'dem-scene/1'"},
        {"{'schema': 'dem-scene/2'}", 1, "~use a newer program"},
        {"{'schema': 1}", 1, "schema: needs a text (column 12); put it in quotes"},
        {S "'title': 5}", 2, "title: needs a text (column 10); put it in quotes"},
        {S "'gravity': 9.81}", 2, "gravity: needs a list of 3: [x, y, z] (column 12); separate them by commas"},
        {S "'gravity': [0, 0]}", 2, "~needs a list of 3"},
        {S "'gravity': [0, 0,\n true]}", 3,
         "gravity[2]: needs an acceleration (column 2); write a number in SI units or a text as in '9.81 m/s2'"},
        {S "'time': []}", 2, "time: needs an object (column 9); write { ... }"},
        {S "'time': {'end': []}}", 2, "~needs a time"},
        {S "'time': {'safety': []}}", 2, "time.safety: needs a number (column 20); write it as in 0.5"},
        {S "'time': {'step': 'fast'}}", 2,
         "time.step: 'fast' is not a time (column 18); write a number with a unit, as in '5 ms'"},
        {S "'domain': {'periodic': [1, 0, 0]}}", 2,
         "domain.periodic[0]: must be true or false (column 25); write it "
         "without quotes"},
        {S "'materials': []}", 2, "~needs an object of materials by name"},
        {S "'materials': {'a': 1}}", 2, "materials.a: needs an object (column 20); write { ... }"},
        {S "'contacts': {}}", 2, "~needs a list of contacts"},
        {S "'contacts': [1]}", 2, "contacts[0]: needs an object (column 14); write { ... }"},
        {S "'shapes': []}", 2, "~needs an object of shapes by name"},
        {S "'bodies': {}}", 2, "~needs a list of bodies"},
        {S "'walls': []}", 2, "~needs an object of walls by name"},
        {S "'output': {'energy': 'yes'}}", 2, "~must be true or false"},
        {S "'output': {'directory': ''}}", 2, "~is empty"},
        {IN_HEAD("'bodies': [{'fill': {'mix': [{'shape': 'ball'}], 'box': [[0, 0, 0], [1, 1, 1]], 'count': '5'}}]"), 7,
         "~count: needs a whole number"},
        {IN_HEAD("'bodies': [{'fill': {'mix': [{'shape': 'ball'}], 'box': [[0, 0, 0], [1, 1, 1]], 'count': 1.5}}]"), 7,
         "~count: needs a whole number"},
    };
    CHECK_REFUSALS(cases);
}

static void units_of_another_dimension_are_refused(void **state)
{
    (void)state;
    static const refusal cases[] = {
        {S "'time': {'end': '5 mm'}}", 2,
         "time.end: 'mm' is not a unit of time (column 17); use one of: s ms us µs ns min h"},
        {S "'gravity': [0, 0, '1 g']}", 2,
         "gravity[2]: 'g' is not a unit of acceleration (column 19); use one of: m/s2 m/s^2 mm/s2 mm/s^2"},
        {S "'materials': {'a': {'young': '70 GP'}}}", 2, "~use one of: Pa kPa MPa GPa"},
        {S "'materials': {'a': {'poisson': '0.2 m'}}}", 2, "~'m' is not expected, this is a pure number"},
        {S "'output': {'checkpoint': '60 m wall'}}", 2, "~'m' is not a unit of time"},
        {S "'output': {'checkpoint': '0 s wall'}}", 2, "~must be above 0"},
        {S "'time': {'end': '1e99 h'}}", 2, "~is beyond 1e100"},
    };
    CHECK_REFUSALS(cases);
}

static void numbers_out_of_range_are_refused(void **state)
{
    (void)state;
    static const refusal cases[] = {
        {S "'time': {'safety': 1.5}}", 2,
         "time.safety: must be above 0 and at most 1, not 1.5 (column 20); correct it"},
        {S "'time': {'safety': 0}}", 2, "~must be above 0"},
        {S "'time': {'end': -1}}", 2, "time.end: must be at least 0, not -1 (column 17); correct it"},
        {S "'time': {'step': 0}}", 2, "~must be above 0, not 0"},
        {S "'time': {'contact_steps': -1}}", 2, "~must be at least 0"},
        {S "'materials': {'a': {'density': 0}}}", 2, "~must be above 0"},
        {S "'materials': {'a': {'young': -1}}}", 2, "~must be above 0"},
        {S "'materials': {'a': {'poisson': 0.51}}}", 2, "~must be above -1 and at most 0.5"},
        {S "'materials': {'a': {'poisson': -1}}}", 2, "~must be above -1 and at most 0.5"},
        {S "'damping': {'local': 1}}", 2,
         "damping.local: must be at least 0 and below 1, not 1 (column 22); correct it"},
        {S "'damping': {'viscous': -1}}", 2, "~must be at least 0"},
        {S "'domain': {'min': [0, 0, 0], 'max': [1, 0, 1]}}", 2, "~min must be below max along y"},
        {S "'domain': {'min': [0, 0, 0], 'periodic': [false, false, true]}}", 2,
         "domain: min and max are needed along z, which is periodic (column 11); give both"},
        {S "'output': {'frames': -1}}", 2, "~must be at least 0"},
    };
    CHECK_REFUSALS(cases);
}

#define LAW(normal, friction)                                                                                          \
    S "'materials': {'a': {}, 'b': {'young': 1}, 'c': {'young': 1, 'poisson': 0}}, 'contacts': [\n{'between': "        \
      "['b', 'c'],\n'normal': {" normal "}" friction "}]}"

static void wrong_laws_are_refused(void **state)
{
    (void)state;
    static const refusal cases[] = {
        {S "'contacts': [{}]}", 2, "contacts[0]: 'between' is missing (column 14); add it"},
        {S "'contacts': [{'between': ['a']}]}", 2, "~the names of two materials"},
        {S "'contacts': [{'between': ['a', 'b']}]}", 2, "unknown material 'a' (column 27); there is no material yet"},
        {S "'materials': {'quartz': {}}, 'contacts': [{'between': ['quartz',\n'quarz']}]}", 3,
         "unknown material 'quarz' (column 1); did you mean 'quartz'?"},
        {S "'materials': {'a': {}}, 'contacts': [{'between': ['a', 'a']}]}", 2, "~'normal' is missing"},
        {LAW("", ""), 4,
         "contacts[0].normal: the law linear needs 'stiffness' or 'stiffness_from' (column 11); give one "
         "of them"},
        {LAW("'stiffness': 1, 'stiffness_from': 'young'", ""), 4, "~has both 'stiffness' and 'stiffness_from'"},
        {LAW("'stiffness': 0", ""), 4, "~must be above 0"},
        {LAW("'stiffness_from': 'old'", ""), 4, "~unknown stiffness_from 'old'"},
        {LAW("'law': 'hertz'", ""), 4,
         "contacts[0].normal: needs 'poisson' of 'b' (column 11); add it to the material"},
        {LAW("'law': 'hertz', 'stiffness': 1", ""), 4, "~the law hertz has no 'stiffness'"},
        {LAW("'law': 'hertzian'", ""), 4, "~did you mean 'hertz'?"},
        {LAW("'law': 'jkr'", ""), 4, "~the law jkr needs 'work_of_adhesion'"},
        {LAW("'law': 'dmt'", ""), 4, "~the law dmt needs 'work_of_adhesion'"},
        {LAW("'law': 'dmt', 'work_of_adhesion': 1, 'stiffness': 1", ""), 4, "~the law dmt has no 'stiffness'"},
        {LAW("'law': 'dmt', 'work_of_adhesion': -1", ""), 4, "~must be at least 0"},
        {LAW("'law': 'plugin'", ""), 4, "~unknown law 'plugin'"},
        {LAW("'plugin': 'law.so'", ""), 4, "~files are not read here"},
        {LAW("'stiffness': 1, 'work_of_adhesion': 1", ""), 4, "~only the laws jkr and dmt have 'work_of_adhesion'"},
        {LAW("'stiffness': 1, 'restitution': 0.5, 'damping_rate': 1", ""), 4,
         "~has both 'restitution' and 'damping_rate'"},
        {LAW("'stiffness': 1, 'restitution': 0", ""), 4,
         "~must be above 0 (column 43); use a small value such as 0.01"},
        {LAW("'stiffness': 1, 'restitution': 1.01", ""), 4, "~at most 1, not 1.01"},
        {LAW("'stiffness': 1, 'damping_rate': -1", ""), 4, "~must be at least 0"},
        {LAW("'stiffness': 1, 'restitution_mode': 'cut'", ""), 4, "~did you mean 'cut_corrected'?"},
        {LAW("'stiffness': 1", ", 'friction': {}"), 4,
         "contacts[0].friction: 'coefficient' is missing (column 41); add it"},
        {LAW("'stiffness': 1", ", 'friction': {'coefficient': -1}"), 4, "~must be at least 0"},
        {LAW("'stiffness': 1", ", 'friction': {'coefficient': 1, 'law': 'mindlin'}"), 4,
         "~the law mindlin needs the normal law hertz"},
        {LAW("'stiffness': 1", ", 'friction': {'coefficient': 1, 'rescale': true}"), 4, "~has no 'rescale'"},
        {LAW("'stiffness': 1", ", 'friction': {'coefficient': 1, 'static_coefficient': 0.9}"), 4,
         "~has a 'static_coefficient' below 'coefficient'"},
        {LAW("'stiffness': 1", ", 'friction': {'coefficient': 1, 'decay': 9}"), 4, "~without 'static_coefficient'"},
        {LAW("'stiffness': 1", ", 'friction': {'coefficient': 1, 'static_coefficient': 2, 'decay': '1 m/s'}"), 4,
         "~use one of: s/m s/mm"},
        {LAW("'stiffness': 1", ", 'friction': {'coefficient': 1, 'stiffness': 1, 'stiffness_ratio': 1}"), 4,
         "~has both 'stiffness' and 'stiffness_ratio'"},
        {LAW("'stiffness': 1", ", 'rolling': {}"), 4, "contacts[0].rolling: 'law' is missing (column 40); add it"},
        {LAW("'stiffness': 1", ", 'rolling': {'law': 'epsd'}"), 4, "~'coefficient' is missing"},
        {LAW("'stiffness': 1", ", 'rolling': {'law': 'epsd2', 'coefficient': 1}"), 4, "~did you mean 'epsd'?"},
        {LAW("'stiffness': 1", ", 'rolling': {'law': 'epsd', 'coefficient': -1}"), 4, "~must be at least 0"},
        {LAW("'stiffness': 1", ", 'rolling': {'law': 'bounded', 'coefficient': 1, 'damping': 1}"), 4,
         "~only the law epsd has 'damping'"},
        {LAW("'stiffness': 1", ", 'twisting': {'law': 'constant'}"), 4, "~the law constant needs 'coefficient'"},
        {LAW("'stiffness': 1", ", 'twisting': {'law': 'marshall', 'coefficient': 1}"), 4,
         "~takes the coefficient of the friction"},
        {LAW("'stiffness': 1", ", 'cohesion': {'law': 'sjkr'}"), 4, "~the law sjkr needs 'energy_density'"},
        {LAW("'stiffness': 1", ", 'cohesion': {'law': 'breakable'}"), 4, "~the law breakable needs 'tension'"},
        {LAW("'stiffness': 1", ", 'cohesion': {'law': 'breakable', 'tension': '1 kN', 'shear': '2 m'}"), 4,
         "~is not a unit of force"},
        {LAW("'stiffness': 1", ", 'cohesion': {'law': 'breakable', 'tension': '1 kN', 'shear': 2}"), 4,
         "~holds the surfaces by the spring of the friction"},
        {LAW("'stiffness': 1", ", 'cohesion': {'law': 'sjkr', 'energy_density': 1, 'shear': 1}"), 4,
         "~only the law breakable has 'shear'"},
        {LAW("'stiffness': 1", ", 'friction': {'coefficient': 0}, 'cohesion': {'law': 'breakable', 'tension': 1,\n"
                               "'shear': 1, 'bonded': 'at_touch', 'gap': 1}"),
         4, "~have no 'gap'"},
        {S "'materials': {'c': {'young': 1, 'poisson': 0}}, 'contacts': [{'between': ['c', 'c'], 'normal': {'law':\n"
           "'hertz'}, 'friction': {'coefficient': 1}, 'cohesion': {'law': 'breakable', 'tension': 1, 'shear': 1}}]}",
         3, "~the law breakable needs the normal law linear"},
        {LAW("'stiffness': 1", ", 'effective_mass': 'x'"), 4, "~use one of: local, body"},
        {S "'materials': {'c': {'young': 1, 'poisson': 0}}, 'contacts': [{'between': ['c', 'c'], 'normal': {'law':\n"
           "'hertz'}, 'friction': {'coefficient': 1, 'stiffness_ratio': 1}}]}",
         3, "~the law mindlin has no 'stiffness_ratio'"},
        {S "'materials': {'a': {}, 'b': {}}, 'contacts': [{'between': ['a', 'b'], 'normal': {'stiffness': 1}},\n"
           "{'between': ['b', 'a'], 'normal': {'stiffness': 1}}]}",
         3, "contacts[1].between: contacts[0] is between these two already (column 13); leave one of them"},
    };
    CHECK_REFUSALS(cases);
}

static void materials_that_can_meet_need_a_law(void **state)
{
    (void)state;
#define TWO S "'materials': {'a': {'density': 1}, 'b': {'density': 1}, 'c': {}},\n"
#define LAW_OF(x, y) "{'between': ['" x "', '" y "'], 'normal': {'stiffness': 1}}"
#define BALL(material) "{'sphere': {'radius': 1}, 'material': '" material "'}"
#define FLOOR(material)                                                                                                \
    "'walls': {'w': {'plane': {'point': [0, 0, 0], 'normal': [0, 0, 1]}, 'material': '" material "'}}"
    static const refusal cases[] = {
        {TWO "'shapes': {'s': " BALL("a") "}}", 1,
         "there is no law between 'a' and 'a', which can meet (column 1); add an entry for the two to contacts"},
        {TWO "'contacts': [" LAW_OF("a", "a") "],\n'shapes': {'s': " BALL("a") ", 't': " BALL("b") "}}", 3,
         "contacts: there is no law between 'a' and 'b', which can meet (column 13); add an entry for the two to "
         "contacts"},
        {TWO "'contacts': [" LAW_OF("a", "a") ", " LAW_OF("b", "a") "],\n'shapes': {'s': " BALL("a") ", 't': " BALL(
             "b") "}}",
         3, "~between 'b' and 'b'"},
        {TWO "'contacts': [" LAW_OF("a", "a") "],\n'shapes': {'s': " BALL("a") "}, " FLOOR("c") "}", 3,
         "~between 'a' and 'c'"},
    };
    CHECK_REFUSALS(cases);
    // walls never meet, and what no shape is made of meets nothing
    dem_scene s = scene_of(TWO "'contacts': [" LAW_OF("a", "a") ", " LAW_OF("c", "a") "],\n'shapes': {'s': " BALL(
        "a") "}, " FLOOR("c") "}");
    dem_scene_release(&s);
}

static void soft_contacts_refuse_what_they_do_not_have(void **state)
{
    (void)state;
#define SOFT_WITH(law)                                                                                                 \
    S "'materials': {'a': {'density': 1, 'young': 1e9, 'poisson': 0.2}},\n'contacts': [{'between': ['a', 'a'], " law   \
      "}],\n'contacts_between_clumps': 'soft'}"
    static const refusal cases[] = {
        {SOFT_WITH("'normal': {'law': 'jkr', 'work_of_adhesion': 1}"), 4,
         "contacts_between_clumps: is 'soft', which does not go with the adhesion of contacts 0 (column 28); "
         "take 'sum', or leave that out"},
        {SOFT_WITH("'normal': {'stiffness': 1}, 'cohesion': {'law': 'sjkr', 'energy_density': 1}"), 4, "~the cohesion"},
        {S "'soft': {'tau': 1e-6}}", 2,
         "soft: is of contacts_between_clumps 'soft', which is not set (column 9); set it, or leave this out"},
        {S "'contacts_between_clumps': 'soft', 'soft': {'tau': 0}}", 2, "~must be above 0"},
        {S "'contacts_between_clumps': 'soft', 'soft': {'tau': 'big'}}", 2, "~tau"},
    };
    CHECK_REFUSALS(cases);
}

static void wrong_shapes_are_refused(void **state)
{
    (void)state;
#define SHAPE(members) S "'materials': {'a': {'density': 1}, 'b': {}}, 'shapes': {'s': {\n" members "}}}"
    static const refusal cases[] = {
        {SHAPE("'sphere': {'radius': 1}"), 2, "shapes.s: 'material' is missing (column 62); add it"},
        {SHAPE("'material': 'c', 'sphere': {'radius': 1}"), 3, "~unknown material 'c'"},
        {SHAPE("'material': 'a'"), 2, "~needs one of 'clump', 'sphere', 'disc' and 'spheres'"},
        {SHAPE("'material': 'a', 'sphere': {'radius': 1}, 'spheres': [[0, 0, 0, 1]]"), 2, "~has more than one of"},
        {SHAPE("'material': 'a', 'sphere': {}"), 3, "~needs 'radius' or 'diameter'"},
        {SHAPE("'material': 'a', 'sphere': {'radius': 1, 'diameter': 2}"), 3, "~has both 'radius' and 'diameter'"},
        {SHAPE("'material': 'a', 'sphere': {'radius': 0}"), 3, "~must be above 0"},
        {SHAPE("'material': 'b', 'sphere': {'radius': 1}"), 3, "~needs 'density' of 'b'"},
        {SHAPE("'material': 'a', 'sphere': {'radius': 1}, 'mass': 1"), 2, "~only 'spheres' take 'mass'"},
        {SHAPE("'material': 'a', 'spheres': []"), 3, "~needs a list of spheres"},
        {SHAPE("'material': 'a', 'spheres': [[1, 2, 3]]"), 3,
         "shapes.s.spheres[0]: needs a list of 4: [x, y, z, r] "
         "(column 30); separate them by commas"},
        {SHAPE("'material': 'a', 'spheres': [[1, 2, 3, 0]]"), 3, "~spheres[0][3]: must be above 0"},
        {SHAPE("'material': 'b', 'spheres': [[1, 2, 3, 1]]"), 2, "~needs 'density' of 'b'"},
        {SHAPE("'material': 'a', 'spheres': [[0, 0, 0, 1]], 'mass': 1"), 2, "~'mass' or 'inertia' without the other"},
        {SHAPE("'material': 'a', 'spheres': [[0, 0, 0, 1]], 'mass': 1, 'inertia': [3, 2, 1]"), 2,
         "shapes.s: inertia: must ascend, I1 <= I2 <= I3 (column 62); order the axes (and turn the spheres with them)"},
        {SHAPE("'material': 'a', 'clump': 'grain.json'"), 3,
         "shapes.s.clump: files are not read here (column 27); give the values themselves"},
    };
    CHECK_REFUSALS(cases);
}

static void wrong_bodies_are_refused(void **state)
{
    (void)state;
#define BODY(members) IN_HEAD("'bodies': [{" members "}]")
#define FILL(members) BODY("'fill': {'mix': [{'shape': 'ball'}], 'box': [[0, 0, 0], [1, 1, 1]]" members "}")
#define SIZE(members) BODY("'fill': {'mix': [{'shape': 'ball', 'size': {" members "}}]}")
    static const refusal cases[] = {
        {BODY(""), 7, "bodies[0]: needs 'shape', 'file' or 'fill' (column 12); give one of them"},
        {BODY("'shape': 'ball'"), 7, "~'position' is missing"},
        {BODY("'shape': 'bal', 'position': [0, 0, 0]"), 7, "unknown shape 'bal' (column 22); did you mean 'ball'?"},
        {BODY("'shape': 'ball', 'position': [0, 0, 0], 'size': 1, 'scale': 1"), 7, "~has both 'size' and 'scale'"},
        {BODY("'shape': 'ball', 'position': [0, 0, 0], 'scale': 0"), 7, "~must be above 0"},
        {BODY("'shape': 'ball', 'position': [0, 0, 0], 'orientation': [0, 0, 0, 0]"), 7, "~has no length"},
        {BODY("'shape': 'ball', 'position': [0, 0, 0], 'orientation': [1, 0, 0]"), 7, "~a quaternion [w, x, y, z]"},
        {BODY("'file': 'x.csv'"), 7, "~files are not read here"},
        {BODY("'fill': {'mix': [{'shape': 'ball'}], 'box': [[0, 0, 0], [1, 1, 1]], 'count': 1}, 'scale': 2"), 7,
         "~'fill' stands alone"},
        {BODY("'shape': 'ball', 'position': [0, 0, 0], 'fixed': 1"), 7, "~must be true or false"},
        {BODY("'shape': 'ball', 'position': [0, 0, 0], 'fixed': true, 'velocity': [0, 1, 0]"), 7,
         "bodies[0]: is 'fixed' and moves (column 12); leave one out, or write 'prescribed': ['velocity', 'spin']"},
        {BODY("'shape': 'ball', 'position': [0, 0, 0], 'lock': ['x', 'rw']"), 7,
         "unknown lock 'rw' (column 67); did you mean 'rx'?"},
        {BODY("'shape': 'ball', 'position': [0, 0, 0], 'lock': []"), 7, "~needs a list of names"},
        {BODY("'shape': 'ball', 'position': [0, 0, 0], 'lock': 3"), 7, "~write it as in ['z', 'rx']"},
        {BODY("'shape': 'ball', 'position': [0, 0, 0], 'lock': 'z', 'velocity': [1, 0, 2]"), 7,
         "~has a velocity along an axis of 'lock'"},
        {BODY("'shape': 'ball', 'position': [0, 0, 0], 'lock': 'ry', 'spin': [1, 1, 2]"), 7,
         "~has a spin along an axis of 'lock'"},
        {BODY("'shape': 'ball', 'position': [0, 0, 0], 'prescribed': {}"), 7, "~write it as in ['velocity']"},
        {BODY("'shape': 'ball', 'position': [0, 0, 0], 'prescribed': 'speed'"), 7, "~use one of: velocity, spin"},
        {BODY("'fill': {'mix': [{'shape': 'ball'}], 'box': [[0, 0, 0], [1, 1, 1]], 'count': 1, 'velocity': [0, 0, 1]},"
              "'lock': ['x', 'z'], 'fixed': false"),
         7, "~along an axis of"},
        {FILL(""), 7, "~needs 'count' or 'void_ratio'"},
        {FILL(", 'count': 1, 'void_ratio': 1"), 7, "~has both 'count' and 'void_ratio'"},
        {FILL(", 'count': 0"), 7, "~must be at least 1"},
        {FILL(", 'void_ratio': 0"), 7, "~must be above 0"},
        {FILL(", 'count': 1, 'gap': -1"), 7, "~must be at least 0"},
        {FILL(", 'count': 1, 'share_by': 'volume'"), 7, "~use one of: number, mass"},
        {BODY("'fill': {'mix': [{'shape': 'ball'}], 'box': [[0, 0, 0], [1, 0, 1]], 'count': 1}"), 7,
         "~the first corner must be below the second along y"},
        {BODY("'fill': {'mix': [], 'box': [[0, 0, 0], [1, 1, 1]], 'count': 1}"), 7, "~needs a list of shapes"},
        {BODY("'fill': {'mix': [{}]}"), 7, "~'shape' is missing"},
        {BODY("'fill': {'mix': [{'shape': 'ball', 'share': 0}]}"), 7, "~must be above 0"},
        {BODY("'fill': {'mix': [{'shape': 'ball', 'size': 0}]}"), 7, "~size: must be above 0"},
        {BODY("'fill': {'mix': [{'shape': 'ball'}]}"), 7, "~'box' is missing"},
        {SIZE(""), 7, "~'law' is missing"},
        {SIZE("'law': 'gauss'"), 7, "~use one of: fixed, uniform, normal, lognormal, table"},
        {SIZE("'law': 'fixed'"), 7, "~the law fixed needs 'value'"},
        {SIZE("'law': 'uniform', 'min': 1"), 7, "~the law uniform needs 'max'"},
        {SIZE("'law': 'uniform', 'min': 2, 'max': 1"), 7, "~min must be below max"},
        {SIZE("'law': 'uniform', 'min': 1, 'max': 2, 'sigma': 1"), 7, "~the law uniform has no 'sigma'"},
        {SIZE("'law': 'normal', 'mean': 1, 'sigma': -1"), 7, "~must be at least 0"},
        {SIZE("'law': 'lognormal', 'median': 1, 'sigma': '1 mm'"), 7, "~this is a pure number"},
        {SIZE("'law': 'lognormal', 'mean': 1, 'sigma': 1"), 7, "~'mean'"},
        {SIZE("'law': 'table', 'sizes': [1, 1], 'passing': [0, 1]"), 7, "~sizes[1]: must be above the one before"},
        {SIZE("'law': 'table', 'sizes': [1, 2], 'passing': [0, 0.9]"), 7, "~must begin with 0 and end with 1"},
        {SIZE("'law': 'table', 'sizes': [1, 2, 3], 'passing': [0, 1, 0.5]"), 7, "~must not fall"},
        {SIZE("'law': 'table', 'sizes': [1, 2, 3], 'passing': [0, 1]"), 7, "~has 3 sizes and 2 passing"},
        {SIZE("'law': 'table', 'sizes': [1], 'passing': [0, 1]"), 7, "~needs a list of numbers"},
    };
    CHECK_REFUSALS(cases);
}

static void wrong_walls_are_refused(void **state)
{
    (void)state;
#define WALL(members) IN_HEAD("'walls': {'w': {'material': 'rock', " members "}}")
#define PLANE "'plane': {'point': [0, 0, 0], 'normal': [0, 0, 1]}"
    static const refusal cases[] = {
        {IN_HEAD("'walls': {'w': {" PLANE "}}"), 7, "walls.w: 'material' is missing (column 16); add it"},
        {WALL("'motion': {}"), 7, "~needs one of 'plane', 'box', 'cylinder', 'cone', 'sphere' and 'mesh'"},
        {WALL(PLANE ", 'box': {'min': [0, 0, 0], 'max': [1, 1, 1]}"), 7, "~has more than one of"},
        {WALL(PLANE ", 'unit': 'mm'"), 7, "~'unit' is the unit of a mesh file"},
        {WALL("'mesh': 'x.stl', 'unit': 'kg'"), 7, "~files are not read here"},
        {WALL("'plane': {'point': [0, 0, 0]}"), 7, "~'normal' is missing"},
        {WALL("'plane': {'point': [0, 0, 0], 'normal': [0, 0, 0]}"), 7, "~normal: has no length"},
        {WALL("'box': {'min': [0, 0, 0], 'max': [1, -1, 1]}"), 7, "~min must be below max along y"},
        {WALL("'cylinder': {'point': [0, 0, 0], 'axis': [0, 0, 1], 'radius': -1}"), 7, "~must be above 0"},
        {WALL("'cylinder': {'point': [0, 0, 0], 'axis': [0, 0, 1], 'radius': 1, 'side': 'in'}"), 7,
         "~use one of: inside, outside"},
        {WALL("'cone': {}"), 7, "~'axis' is missing"},
        {WALL("'cone': {'axis': [0, 0, 1], 'apex': [0, 0, 0]}"), 7, "~needs 'apex' and 'angle', or"},
        {WALL("'cone': {'axis': [0, 0, 1], 'apex': [0, 0, 0], 'angle': 1, 'length': 1}"), 7, "~give exactly these"},
        {WALL("'cone': {'axis': [0, 0, 1], 'apex': [0, 0, 0], 'angle': '90 deg'}"), 7, "~must be above 0"},
        {WALL("'cone': {'axis': [0, 0, 1], 'point': [0, 0, 0], 'radii': [1, 1], 'length': 0}"), 7, "~has no surface"},
        {WALL("'cone': {'axis': [0, 0, 1], 'point': [0, 0, 0], 'radii': [1, 2], 'length': 1, 'side': 'inside'}"), 7,
         "~solid on both sides"},
        {WALL("'sphere': {}"), 7, "~'centre' is missing"},
        {WALL("'plane': {'point': [0, 0, 0], 'normal': [0, 0, 1], 'size': [1, 2], 'radius': 1}"), 7, "~has both"},
        {WALL("'plane': {'point': [0, 0, 0], 'normal': [0, 0, 1], 'along': [1, 0, 0]}"), 7, "~first side"},
        {WALL("'plane': {'point': [0, 0, 0], 'normal': [0, 0, 1], 'size': [1, 2], 'along': [0, 0, 1]}"), 7,
         "~direction of the normal"},
        {WALL(PLANE ", 'servo': {}"), 7, "~'max_velocity' is missing"},
        {WALL(PLANE ", 'wear': {}"), 7, "~'law' is missing"},
        {WALL(PLANE ", 'wear': {'law': 'finnie'}"), 7, "~'pressure' is missing"},
        {WALL(PLANE ", 'wear': {'law': 'archard', 'hardness': 1}"), 7, "~needs 'coefficient' and 'hardness'"},
        {WALL(PLANE ", 'wear': {'law': 'archard', 'psi': 1}"), 7, "~has keys of the other law"},
        {WALL(PLANE ", 'wear': {'law': 'finnie', 'pressure': 1}"), 7, "~needs a wall with ends"},
        {WALL(PLANE ", 'motion': {'oscillate': {}}"), 7, "~'frequency' is missing"},
        {WALL(PLANE ", 'motion': {'table': 'x.csv'}"), 7, "~files are not read here"},
        {WALL(PLANE ", 'motion': {'translate': {}}"), 7, "~'velocity' is missing"},
        {WALL(PLANE ", 'motion': {'rotate': {'axis': [0, 0, 1]}}"), 7, "~'rate' is missing"},
        {IN_HEAD("'walls': {'w.x-': {'material': 'rock', " PLANE
                 "},\n'w': {'material': 'rock', 'box': {'min': [0, 0, 0],"
                 " 'max': [1, 1, 1]}}}"),
         8, "~there is a wall 'w.x-' already"},
    };
    CHECK_REFUSALS(cases);
}

#define GRAIN                                                                                                          \
    "'materials': {'a': {'density': 1}}, 'contacts': [{'between': ['a', 'a'], 'normal': {'law': 'linear', "            \
    "'stiffness': 1}}], 'shapes': {'b': {'sphere': {'radius': 1}, 'material': 'a'}},\n"
#define INLET "'inlets': {'a': {'mix': [{'shape': 'b'}], "

static void inlets_that_cannot_be_are_refused(void **state)
{
    (void)state;
    static const refusal cases[] = {
        {S "'inlets': [1]}", 2, "~needs an object of inlets by name"},
        {S "'inlets': {'a': {}}}", 2, "~'mix' is missing"},
        {S GRAIN INLET "'rate': 1}}}", 3, "~needs one of"},
        {S GRAIN INLET "'rate': 1, 'sphere': {'centre': [0, 0, 0], 'radius': 1}, 'box': [[0, 0, 0], [1, 1, 1]]}}}", 3, "~has both of"},
        {S GRAIN INLET "'rate': 1, 'sphere': {'centre': [0, 0, 0], 'radius': 1}}}}", 3, "~never get out of the sphere"},
        {S GRAIN INLET "'rate': 1, 'sphere': {'centre': [0, 0, 0], 'radius': 1, 'solid': 1}}}}", 3, "~must be true or"},
        {S GRAIN INLET "'rate': 1, 'sphere': {'centre': [0, 0, 0], 'radius': 1, 'material': 'b'}}}}", 3, "~\"b\""},
        {S GRAIN INLET "'box': [[0, 0, 0], [1, 1, 1]]}}}", 3, "~needs one of"},
        {S GRAIN INLET "'box': [[0, 0, 0], [1, 1, 1]], 'rate': 1, 'mass_rate': 1}}}", 3, "~has both of"},
        {S GRAIN INLET "'box': [[0, 0, 0], [1, 1, 1]], 'rate': 0}}}", 3, "~must be above 0"},
        {S GRAIN INLET "'box': [[0, 0, 0], [1, 1, 0]], 'rate': 1}}}", 3, "~below the second along z"},
        {S GRAIN INLET "'box': [[0, 0, 0], [1, 1, 1]], 'rate': 1, 'start': 2, 'stop': 1}}}", 3, "~must be before"},
        {S GRAIN INLET "'box': [[0, 0, 0], [1, 1, 1]], 'rate': 1, 'velocity_spread': -1}}}", 3, "~must be at least 0"},
    };
    CHECK_REFUSALS(cases);
}

static void wrong_bonds_are_refused(void **state)
{
    (void)state;
#define BOND(members) IN_HEAD("'bonds': {'b': {'young': 1e9, " members "}}")
    static const refusal cases[] = {
        {S "'bonds': 5}", 2, "~needs an object of bonds by name"},
        {S "'bonds': {'a': {}}}", 2, "~'young' is missing"},
        {BOND("'between': 'some'"), 7, "~write 'all'"},
        {BOND("'between': ['rock']"), 7, "~needs a list of 2"},
        {BOND("'between': ['rock', 'balll']"), 7, "~unknown group or shape 'rock'"},
        {BOND("'tensile_strength': -1"), 7, "~must be above 0"},
        {BOND("'moment_contribution': 2"), 7, "~must be at least 0 and at most 1"},
        {BOND("'damping': -0.1"), 7, "~must be at least 0"},
        {BOND("'contact': 'beside'"), 7, "~unknown contact 'beside'"},
        {BOND("'gap': '1 MPa'"), 7, "~gap"},
        {BOND("'radius_multiplier': 0"), 7, "~must be above 0"},
        {BOND("'strength': 1"), 7, "~unknown key 'strength'"},
    };
    CHECK_REFUSALS(cases);
}

static void what_is_not_built_is_never_ignored(void **state)
{
    (void)state;
    static const refusal cases[] = {
        {S "'damping': {'drag': {}}}", 2, "~'density' is missing"},
        {S "'damping': {'drag': {'density': 1, 'viscosity': -1}}}", 2, "~must be at least 0"},
        {S "'damping': {'drag': {'density': 1, 'viscosity': '1 Pa'}}}", 2, "~viscosity"},
        {S "'materials': {'a': {'density': 1}}, 'shapes': {'d': {'material': 'a',\n'disc': {'radius': 1}}}}", 3,
         "shapes.d.disc: there are no discs in three dimensions (column 9); add 'dimension': 2 to the scene, or write "
         "'sphere'"},
        {S "'dimension': 2, 'materials': {'a': {}}, 'shapes': {'d': {'material': 'a',\n'disc': {'radius': 1}}}}", 3,
         "~needs 'density' of 'a'"},
        {S "'dimension': 2, 'materials': {'a': {}}, 'shapes': {'d': {'material': 'a',\n'disc': {}}}}", 3,
         "~needs 'radius' or 'diameter'"},
        {S "'dimension': 4}", 2, "dimension: must be at least 2 and at most 3, not 4 (column 14); correct it"},
        {S "'dimension': '2D'}", 2, "~needs a whole number"},
        {S "'integrator': {'rotation': 'lsim'}}", 2, "unknown rotation 'lsim' (column 28); did you mean 'lsym'?"},
    };
    CHECK_REFUSALS(cases);
}

static void text_that_is_no_json_is_refused_by_its_line(void **state)
{
    (void)state;
    dem_scene scene;
    dem_error error;
    check(scene_read("{'schema': 'dem-scene/1',\n'title' 'x'}", NULL, NULL, &scene, &error) == DEM_BAD_INPUT);
    check(error.line == 2 && strstr(error.text, "not valid JSON") && !scene.owner);
    check(scene_read("", NULL, NULL, &scene, &error) == DEM_BAD_INPUT);
    check(scene_read("{'schema': 'dem-scene/1', 'title': '', 'title': ''}", NULL, NULL, &scene, &error) ==
          DEM_BAD_INPUT);
    // without anyone to tell
    check(dem_scene_read_text(NULL, "{\"a\": 1}", 8, "x", NULL, NULL, &scene, NULL) == DEM_BAD_INPUT);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(unknown_keys_are_refused_with_a_suggestion),
        cmocka_unit_test(wrong_types_are_told_what_is_wanted),
        cmocka_unit_test(units_of_another_dimension_are_refused),
        cmocka_unit_test(numbers_out_of_range_are_refused),
        cmocka_unit_test(wrong_laws_are_refused),
        cmocka_unit_test(materials_that_can_meet_need_a_law),
        cmocka_unit_test(soft_contacts_refuse_what_they_do_not_have),
        cmocka_unit_test(wrong_shapes_are_refused),
        cmocka_unit_test(wrong_bodies_are_refused),
        cmocka_unit_test(wrong_walls_are_refused),
        cmocka_unit_test(inlets_that_cannot_be_are_refused),
        cmocka_unit_test(wrong_bonds_are_refused),
        cmocka_unit_test(what_is_not_built_is_never_ignored),
        cmocka_unit_test(text_that_is_no_json_is_refused_by_its_line),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
