#include "clumps.h"

#include <locale.h>
#include <unistd.h>

#include "base/file.h"
#include "base/json.h"
#include "base/random.h"
#include "clump/file.h"

// the shortest file: what a person would type
#define MEMBERS                                                                                                        \
    "\"schema\": \"dem-clump/1\", \"density\": 2500, \"mass\": 5, \"inertia\": [1, 1, 1.5], "                          \
    "\"spheres\": [[0, 0, 0, 1]]}"
#define SHORTEST "{" MEMBERS
#define WITH(member) "{" member ", " MEMBERS

static dem_status decoded(const char *text, dem_clump **clump, dem_error *error)
{
    return dem_clump_decode(text, strlen(text), "grains/pebble.v2.json", clump, error);
}

static void a_clump_is_read_back_without_loss(void **state)
{
    (void)state;
    dem_clump_def def = sample_clump();
    def.fidelity.distance_max = def.shape.roundness = def.union_centre.y = NAN;
    dem_ball balls[500];
    dem_random r = random_stream(3, 0);
    for (int i = 0; i < 500; i++) {
        double size = pow(10, 30 * (random_uniform(&r) - 0.5)), x = random_normal(&r), y = random_normal(&r);
        balls[i] = (dem_ball){v3(x * size, y, random_normal(&r) / size), size};
    }
    for (int large = 0; large < 2; large++) {
        if (large)
            def.balls = balls, def.ball_count = 500;
        dem_clump *clump = made_clump(&def), *back;
        dem_error error;
        char path[] = "clump-XXXXXX";
        close(mkstemp(path));
        check_ok(dem_clump_write(clump, path, &error), error);
        check_ok(dem_clump_read(path, &back, &error), error);
        check_same_clump(clump, back);
        check(dem_clump_hash(clump) == dem_clump_hash(back));
        unlink(path);
        dem_clump_destroy(clump);
        dem_clump_destroy(back);
    }
}

static void every_source_of_the_mass_has_a_name(void **state)
{
    (void)state;
    for (int source = DEM_MASS_FROM_MESH; source <= DEM_MASS_GIVEN; source++) {
        dem_clump_def def = sample_clump();
        def.mass_from = (dem_mass_source)source;
        dem_clump *clump = made_clump(&def), *back;
        dem_buffer text = {0};
        dem_error error;
        check_ok(dem_clump_encode(clump, &text, &error), error);
        check_ok(dem_clump_decode(text.data, text.size, "x", &back, &error), error);
        check(dem_clump_view(back).mass_from == (dem_mass_source)source);
        check_same_clump(clump, back);
        dem_clump_destroy(clump);
        dem_clump_destroy(back);
        dem_buffer_release(&text);
    }
}

static void the_file_is_the_same_in_a_german_locale(void **state)
{
    (void)state;
    if (!setlocale(LC_ALL, "de_DE.UTF-8"))
        skip();
    setlocale(LC_ALL, "C");
    dem_clump_def def = sample_clump();
    dem_clump *clump = made_clump(&def), *back;
    dem_buffer english = {0}, german = {0};
    dem_error error;
    check_ok(dem_clump_encode(clump, &english, &error), error);
    setlocale(LC_ALL, "de_DE.UTF-8");
    dem_status status = dem_clump_encode(clump, &german, &error);
    dem_status read = dem_clump_decode(english.data, english.size, "x", &back, &error);
    setlocale(LC_ALL, "C");
    check(status == DEM_OK && read == DEM_OK);
    assert_string_equal(english.data, german.data);
    check_same_clump(clump, back);
    dem_clump_destroy(clump);
    dem_clump_destroy(back);
    dem_buffer_release(&english);
    dem_buffer_release(&german);
}

static void spheres_stand_one_on_a_line(void **state)
{
    (void)state;
    dem_clump_def def = sample_clump();
    dem_clump *clump = made_clump(&def);
    dem_buffer text = {0};
    dem_error error;
    check_ok(dem_clump_encode(clump, &text, &error), error);
    check(strncmp(text.data, "{\n  \"schema\": \"dem-clump/1\",\n", 29) == 0);
    check(strstr(text.data,
                 "\n    [0.59999999999999998, 0.10000000000000001, -0.20000000000000001, 0.40000000000000002],\n"));
    dem_clump_destroy(clump);
    dem_buffer_release(&text);
}

static void a_file_written_by_hand_needs_only_spheres_and_mass(void **state)
{
    (void)state;
    dem_clump *clump;
    dem_error error;
    check_ok(decoded(SHORTEST, &clump, &error), error);
    dem_clump_def view = dem_clump_view(clump);
    assert_string_equal(view.name, "pebble.v2");
    check_near(view.volume, 0.002, 1e-18);
    check(view.mass_from == DEM_MASS_FROM_MESH && view.orientation.w == 1 && v3_norm(view.position) == 0);
    check(isnan(view.union_volume) && isnan(view.fidelity.iou_gap) && isnan(view.shape.longest) && isnan(view.seconds));
    assert_string_equal(view.parameters, "{}");
    assert_string_equal(view.source_unit, "");
    dem_clump_destroy(clump);
}

static void unknown_keys_are_passed_over(void **state)
{
    (void)state;
    dem_clump *one, *other;
    dem_error error;
    check_ok(decoded(SHORTEST, &one, &error), error);
    check_ok(decoded(WITH("\"note\": [1, {}], \"fidelity\": {\"mood\": null}"), &other, &error), error);
    check_same_clump(one, other);
    dem_clump_destroy(one);
    dem_clump_destroy(other);
}

static void a_bad_value_is_refused_by_its_place(void **state)
{
    (void)state;
    static const struct {
        const char *place, *text;
    } cases[] = {
        {"not a clump file", "[]"},
        {"not a clump file", "{}"},
        {"not a clump file", "{\"schema\": \"dem-scene/1\"}"},
        {"dem-clump/2", "{\"schema\": \"dem-clump/2\"}"},
        {"not valid JSON", "{\"schema\": \"dem-clump/1\", \"density\": NaN}"},
        {"not valid JSON", "{\"schema\": \"dem-clump/1\", \"density\": 1e999}"},
        {"not valid JSON", ""},
        {"density: ", "{\"schema\": \"dem-clump/1\"}"},
        {"density: ", "{\"schema\": \"dem-clump/1\", \"density\": \"2650\"}"},
        {"density: ", "{\"schema\": \"dem-clump/1\", \"density\": null}"},
        {"mass: ", "{\"schema\": \"dem-clump/1\", \"density\": 1}"},
        {"inertia: ", "{\"schema\": \"dem-clump/1\", \"density\": 1, \"mass\": 1, \"inertia\": [1, 1]}"},
        {"inertia: ", "{\"schema\": \"dem-clump/1\", \"density\": 1, \"mass\": 1, \"inertia\": [1, 1, null]}"},
        {"inertia: ", "{\"schema\": \"dem-clump/1\", \"density\": 1, \"mass\": 1, \"inertia\": [1, 1, 3], "
                      "\"spheres\": [[0, 0, 0, 1]]}"},
        {"spheres: ", "{\"schema\": \"dem-clump/1\", \"density\": 1, \"mass\": 1, \"inertia\": [1, 1, 1]}"},
        {"spheres: ",
         "{\"schema\": \"dem-clump/1\", \"density\": 1, \"mass\": 1, \"inertia\": [1, 1, 1], \"spheres\": []}"},
        {"spheres[1]: ", "{\"schema\": \"dem-clump/1\", \"density\": 1, \"mass\": 1, \"inertia\": [1, 1, 1], "
                         "\"spheres\": [[0, 0, 0, 1], [0, 0, 1]]}"},
        {"spheres[1]: ", "{\"schema\": \"dem-clump/1\", \"density\": 1, \"mass\": 1, \"inertia\": [1, 1, 1], "
                         "\"spheres\": [[0, 0, 0, 1], [0, 0, 0, null]]}"},
        {"spheres[0]: ", "{\"schema\": \"dem-clump/1\", \"density\": 1, \"mass\": 1, \"inertia\": [1, 1, 1], "
                         "\"spheres\": [[0, 0, 0, -1]]}"},
        {"spheres[0]: ", "{\"schema\": \"dem-clump/1\", \"density\": 1, \"mass\": 1, \"inertia\": [1, 1, 1], "
                         "\"spheres\": [7]}"},
        {"spheres[0]: ", "{\"schema\": \"dem-clump/1\", \"density\": 1, \"mass\": 1, \"inertia\": [1, 1, 1], "
                         "\"spheres\": [[0, 0, 0, 1, 5]]}"},
        {"name: ", WITH("\"name\": 7")},
        {"volume: ", WITH("\"volume\": -1")},
        {"volume: ", WITH("\"volume\": [1]")},
        {"mass_from: ", WITH("\"mass_from\": \"guess\"")},
        {"mass_from: ", WITH("\"mass_from\": null")},
        {"source: ", WITH("\"source\": \"rock.stl\"")},
        {"source.mesh: ", WITH("\"source\": {\"mesh\": 1}")},
        {"to_mesh.position: ", WITH("\"to_mesh\": {\"position\": [1, 2]}")},
        {"to_mesh.position: ", WITH("\"to_mesh\": {\"position\": [1, 2, null]}")},
        {"to_mesh.orientation: ", WITH("\"to_mesh\": {\"orientation\": [1, 0, 0]}")},
        {"to_mesh.orientation: ", WITH("\"to_mesh\": {\"orientation\": [1, 1, 0, 0]}")},
        {"union.centre: ", WITH("\"union\": {\"centre\": \"here\"}")},
        {"fidelity: ", WITH("\"fidelity\": []")},
        {"fidelity.iou_gap: ", WITH("\"fidelity\": {\"iou_gap\": \"5 %\"}")},
        {"fidelity.pieces: ", WITH("\"fidelity\": {\"pieces\": 1.5}")},
        {"fidelity.pieces: ", WITH("\"fidelity\": {\"pieces\": -1}")},
        {"shape.longest: ", WITH("\"shape\": {\"longest\": true}")},
        {"made.parameters: ", WITH("\"made\": {\"parameters\": 5}")},
        {"made.seed: ", WITH("\"made\": {\"seed\": 0.5}")},
        {"made.seconds: ", WITH("\"made\": {\"seconds\": \"1 s\"}")},
        {"surface: ", WITH("\"surface\": 1")},
        {"surface.vertices: ", WITH("\"surface\": {}")},
        {"surface.triangles: ", WITH("\"surface\": {\"vertices\": []}")},
        {"surface.vertices[0]: ", WITH("\"surface\": {\"vertices\": [[1, 2]], \"triangles\": []}")},
        {"surface.triangles[0]: ", WITH("\"surface\": {\"vertices\": [[0,0,0]], \"triangles\": [[0, 0, 1]]}")},
        {"surface.triangles[0]: ", WITH("\"surface\": {\"vertices\": [[0,0,0]], \"triangles\": [[0, 0, -1]]}")},
        {"surface.triangles[0]: ", WITH("\"surface\": {\"vertices\": [[0,0,0]], \"triangles\": [[0, 0, 4294967296]]}")},
        {"surface.triangles[0]: ", WITH("\"surface\": {\"vertices\": [[0,0,0]], \"triangles\": [[0, 0]]}")},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        dem_clump *clump;
        dem_error error = {0};
        dem_status status = decoded(cases[i].text, &clump, &error);
        if (status != DEM_BAD_INPUT || !strstr(error.text, cases[i].place))
            print_error("%s\nstatus %d, '%s', wanted '%s'\n", cases[i].text, status, error.text, cases[i].place);
        check(status == DEM_BAD_INPUT && strstr(error.text, cases[i].place) && !clump);
        assert_string_equal(error.file, "grains/pebble.v2.json");
        check(decoded(cases[i].text, &clump, NULL) == DEM_BAD_INPUT);
    }
}

static void a_file_cut_short_anywhere_is_refused(void **state)
{
    (void)state;
    dem_clump_def def = sample_clump();
    dem_clump *clump = made_clump(&def), *back;
    dem_buffer text = {0};
    dem_error error;
    check_ok(dem_clump_encode(clump, &text, &error), error);
    for (size_t size = 0; size + 2 < text.size; size++) {  // the last two are the bracket and a newline
        check(dem_clump_decode(text.data, size, "cut.json", &back, &error) == DEM_BAD_INPUT);
        check(!back);
    }
    dem_clump_destroy(clump);
    dem_buffer_release(&text);
}

static void what_cannot_be_written_leaves_no_file(void **state)
{
    (void)state;
    dem_clump_def def = sample_clump();
    dem_clump *clump = made_clump(&def);
    dem_error error;
    check(dem_clump_write(clump, "no such folder/clump.json", &error) == DEM_CANNOT_WRITE);
    check(access("no such folder", F_OK) != 0);
    dem_clump_destroy(clump);
}

// every object and member the writer writes is described by the published schema
static void the_published_schema_names_every_key(void **state)
{
    (void)state;
    static const char *const sections[][14] = {
        {"", "schema", "name", "source", "density", "mass", "volume", "inertia", "mass_from", "to_mesh", "union",
         "spheres"},
        {"", "fidelity", "shape", "made", "surface"},
        {"source", "mesh", "sha256", "unit"},
        {"to_mesh", "position", "orientation"},
        {"union", "volume", "centre", "inertia"},
        {"fidelity", "iou_gap", "volume_error", "distance_mean", "distance_max", "protrusion", "centre_offset",
         "inertia_error", "normal_deviation_deg", "overlap_ratio", "pieces"},
        {"shape", "equivalent_diameter", "longest", "intermediate", "shortest", "elongation", "flatness", "sphericity",
         "convexity", "roundness", "angularity"},
        {"made", "method", "parameters", "seed", "seconds", "version"},
        {"surface", "vertices", "triangles"}};
    dem_buffer text;
    dem_json *schema, *file;
    dem_error error;
    check_ok(dem_file_read(DEM_SOURCE_DIR "/lib/clump/dem-clump-1.schema.json", &text, &error), error);
    check_ok(dem_json_parse(text.data, text.size, "schema", &schema, &error), error);
    dem_buffer_release(&text);
    dem_clump_def def = sample_clump();
    dem_clump *clump = made_clump(&def);
    text = (dem_buffer){0};
    check_ok(dem_clump_encode(clump, &text, &error), error);
    check_ok(dem_json_parse(text.data, text.size, "clump", &file, &error), error);
    for (size_t i = 0; i < sizeof sections / sizeof *sections; i++) {
        const dem_json *described = dem_json_member(schema, "properties"), *written = file;
        if (*sections[i][0]) {
            described = dem_json_member(dem_json_member(described, sections[i][0]), "properties");
            written = dem_json_member(written, sections[i][0]);
        }
        for (int k = 1; k < 14 && sections[i][k]; k++) {
            check(dem_json_is_object(dem_json_member(described, sections[i][k])));
            check(dem_json_member(written, sections[i][k]) != NULL);
        }
    }
    dem_json_release(schema);
    dem_json_release(file);
    dem_clump_destroy(clump);
    dem_buffer_release(&text);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_clump_is_read_back_without_loss),
        cmocka_unit_test(every_source_of_the_mass_has_a_name),
        cmocka_unit_test(the_file_is_the_same_in_a_german_locale),
        cmocka_unit_test(spheres_stand_one_on_a_line),
        cmocka_unit_test(a_file_written_by_hand_needs_only_spheres_and_mass),
        cmocka_unit_test(unknown_keys_are_passed_over),
        cmocka_unit_test(a_bad_value_is_refused_by_its_place),
        cmocka_unit_test(a_file_cut_short_anywhere_is_refused),
        cmocka_unit_test(what_cannot_be_written_leaves_no_file),
        cmocka_unit_test(the_published_schema_names_every_key),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
