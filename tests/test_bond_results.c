// What a run leaves of its bonds: columns of the series, lines, and the table of what broke.
#include "base/text.h"
#include "out/results.h"
#include "out/run.h"
#include "scenes.h"

static const char *folder(void)
{
    static char path[64];
    if (!path[0]) {
        strcpy(path, "/tmp/test_bonds_XXXXXX");
        check(mkdtemp(path));
    }
    return path;
}

static char *text_of(const char *name)
{
    dem_buffer text;
    dem_error error;
    char path[128];
    snprintf(path, sizeof path, "%s/%s", folder(), name);
    check_ok(dem_file_read(path, &text, &error), error);
    return text.data;  // ends with a 0
}

// three balls in a row: the last one flies off, and the weaker bond at it breaks
static void what_broke_is_told(void **state)
{
    (void)state;
    dem_scene scene;
    dem_error error;
    const char *text =
        "{'schema': 'dem-scene/1', 'time': {'end': '2 ms', 'step': '10 us'},\n"
        "'materials': {'rock': {'density': 2500, 'young': 1e9, 'poisson': 0.2}},\n"
        "'contacts': [{'between': ['rock', 'rock'], 'normal': {'law': 'linear', 'stiffness': 1e4}}],\n"
        "'shapes': {'ball': {'sphere': {'radius': '1 cm'}, 'material': 'rock'}},\n"
        "'bodies': [{'shape': 'ball', 'position': [0, 0, 0], 'group': 'a'},\n"
        "{'shape': 'ball', 'position': [0.02, 0, 0], 'group': 'b'},\n"
        "{'shape': 'ball', 'position': [0.04, 0, 0], 'velocity': [1, 0, 0], 'group': 'c'}],\n"
        "'bonds': {'strong, too': {'between': ['a', 'b'], 'gap': '1 um', 'young': '1 MPa'},\n"
        "'weak': {'between': ['b', 'c'], 'gap': '1 um', 'young': '1 MPa', 'tensile_strength': '1 kPa'}},\n"
        "'output': {'frames': '1 ms', 'series': '1 ms'}}";
    check_ok(scene_read(text, NULL, NULL, &scene, &error), error);
    scene.output.directory = folder();
    dem_run_result result;
    check_ok(dem_run(NULL, &scene, &(dem_run_options){.until = NAN}, &result, &error), error);
    check(result.figures.bonds == 1 && result.figures.bonds_tension == 1 && result.figures.bonds_shear == 0);
    char *table = text_of("bonds.csv"), *series = text_of("series.csv"), *lines = text_of("frames/bonds_000002.vtp");
    check(strstr(table, ",weak,tension,1,2,0,0,") && !strstr(table, "strong"));
    check(strstr(series, ",bonds,bonds_broken_tension,bonds_broken_shear\n") && strstr(series, ",1,1,0\n"));
    check(strstr(series, ",2,0,0\n"));
    check(strstr(lines, "stress_ratio") && strstr(lines, "NumberOfLines=\"2\""));
    char *index = text_of("bonds.pvd");
    check(strstr(index, "frames/bonds_000001.vtp"));
    free(table);
    free(series);
    free(lines);
    free(index);
    dem_run_release(&result);
    dem_scene_release(&scene);
}

// two balls fly in a row, and the first one leaves the domain
static void what_has_left_is_told_by_its_number(void **state)
{
    (void)state;
    dem_scene scene;
    dem_error error;
    const char *text =
        "{'schema': 'dem-scene/1', 'time': {'end': '2 ms', 'step': '10 us'},\n"
        "'domain': {'min': [-1, -1, -1], 'max': [0.025, 1, 1], 'leaving': 'delete'},\n"
        "'materials': {'rock': {'density': 2500, 'young': 1e9, 'poisson': 0.2}},\n"
        "'contacts': [{'between': ['rock', 'rock'], 'normal': {'law': 'linear', 'stiffness': 1e4}}],\n"
        "'shapes': {'ball': {'sphere': {'radius': '1 cm'}, 'material': 'rock'}},\n"
        "'bodies': [{'shape': 'ball', 'position': [0.02, 0, 0], 'velocity': [10, 0, 0]},\n"
        "{'shape': 'ball', 'position': [0, 0, 0], 'velocity': [10, 0, 0]}],\n"
        "'bonds': {'glue': {'gap': '1 um', 'young': '1 MPa'}},\n"
        "'output': {'frames': '1 ms', 'series': '1 ms'}}";
    check_ok(scene_read(text, NULL, NULL, &scene, &error), error);
    scene.output.directory = folder();
    dem_run_result result;
    check_ok(dem_run(NULL, &scene, &(dem_run_options){.until = NAN}, &result, &error), error);
    check(result.figures.bonds == 0 && result.figures.bonds_lost == 1);
    char *table = text_of("bonds.csv"), *series = text_of("series.csv"), *lines = text_of("frames/bonds_000002.vtp");
    check(strstr(table, ",glue,lost,1,0,0,0,"));
    check(strstr(series, ",bonds,bonds_broken_tension,bonds_broken_shear,bonds_lost\n") && strstr(series, ",0,0,0,1\n"));
    check(strstr(lines, "NumberOfLines=\"1\""));
    free(table);
    free(series);
    free(lines);
    dem_run_release(&result);
    dem_scene_release(&scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_broke_is_told),
        cmocka_unit_test(what_has_left_is_told_by_its_number),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
