#include "check.h"
#include "converted.h"

#include "base/random.h"

static void spheres_that_overlap_too_often_are_refused(void **state)
{
    (void)state;
    dem_buffer text = {0};
    for (int i = 0; i < 3000; i++) {
        dem_buffer_number(&text, i * 1e-5, 17);
        dem_buffer_text(&text, " 0 0 1\n");
    }
    converted c = convert_as("x", text.data, text.size, NULL, NULL);
    check(c.status == DEM_BAD_INPUT && strstr(c.error.text, "overlap too often"));
    assert_string_equal(c.error.file, "x");
    dem_buffer_release(&text);
}

#define FIX "fix p all particletemplate/multisphere 1 density constant 2650 nspheres 1 "
#define HEAD "t\n1 atoms\n"
#define TAIL "Coords\n\n1 0 0 0\n\nDiameters\n\n1 2\n"
#define CLUSTER "Begin centers_and_radii\n0 0 0 1\nEnd centers_and_radii\n"

static void a_broken_file_is_refused_with_its_line(void **state)
{
    (void)state;
    static const struct {
        const char *format, *text;
        long line;
        const char *says;
    } cases[] = {
        {NULL, "hello world\n", 1, "--from"},
        {NULL, "\n# only a comment\n", 1, "--from"},
        {"xyzr", "\n# only a comment\n", 0, "no spheres"},
        {"xyzr", "0 0 0 1\n0 0 0 -1\n", 2, "above 0"},
        {"xyzr", "0 0 0 1\n0 0 0 0\n", 2, "above 0"},
        {"xyzr", "0 0 0 1\n\n0 0 1\n", 3, "3 numbers"},
        {"xyzr", "0 0 0 1 2 3\n", 1, "6 numbers"},
        {"xyzr", "0,5 0,5 0,5 0,5\n", 1, "decimal point"},
        {"xyzr", "0 0 0 nan\n", 1, "finite"},
        {"xyzr", "0 inf 0 1\n", 1, "finite"},
        {"xyzr", "0 0 0 1e308\n", 1, "computed"},
        {"xyzr", "1e308 0 0 1\n", 1, "computed"},
        {"xyzr", "0 0 0 1e-100\n", 1, "computed"},
        {"xyzr", "1e99 0 0 1\n", 1, "1e60"},
        {"xyzr", "0 0 0 1\r\n0 0 O 1\r\n", 2, "'O'"},
        {"xyzr", "x y z r\n0 0 0 1\n", 1, "'x'"},
        {"deme", "x,y,z\n0,0,0\n", 1, "no 'r'"},
        {"deme", "x,y,z,r,r\n", 1, "twice"},
        {"deme", "x,y,z,r\n0,0,0,1\n0,0,0\n", 3, "number"},
        {"deme", "x,y,z,r\n0,0,0,1,5\n", 2, "more columns"},
        {"deme", "x,y,z,r\n0,0,0,-2\n", 2, "above 0"},
        {"deme", "x,y,z,r\n", 0, "no spheres"},
        {"deme", "", 0, "x,y,z,r"},
        {"lammps", "t\n", 0, "5 atoms"},
        {"lammps", "t\n99999999999 atoms\n", 2, "whole"},
        {"lammps", "t\n1e300 atoms\n", 2, "finite"},
        {"lammps", "t\n-3 atoms\n", 2, "whole"},
        {"lammps", "t\n1.5 atoms\n", 2, "whole"},
        {"lammps", HEAD "1 atoms\n", 3, "second"},
        {"lammps", HEAD "-1 mass\n" TAIL, 3, "above 0"},
        {"lammps", HEAD "1 2 mass\n" TAIL, 3, "belong"},
        {"lammps", HEAD "1 1 3 0 0 0 inertia\n" TAIL, 3, "no body"},
        {"lammps", HEAD "1 1 -1 0 0 0 inertia\n" TAIL, 3, "above 0"},
        {"lammps", HEAD "0 0 0 0 0 0 inertia\n" TAIL, 3, "above 0"},
        {"lammps", HEAD "1 1 1 0 inertia\n" TAIL, 3, "belong"},
        {"lammps", HEAD "1 1 nan com\n" TAIL, 3, "finite"},
        {"lammps", HEAD "Coords\n\n1 0 0\n", 5, "number"},
        {"lammps", HEAD "Coords\n\n2 0 0 0\n", 5, "does not exist"},
        {"lammps", HEAD "Coords\n\n0 0 0 0\n", 5, "does not exist"},
        {"lammps", HEAD "Coords\n\n1 0 0 0\n", 0, "diameter"},
        {"lammps", HEAD "Diameters\n\n1 1\n", 0, "place"},
        {"lammps", HEAD "Coords\n\n1 0 0 0\nDiameters\n\n1 -1\n", 8, "above 0"},
        {"lammps", HEAD "Coords\n\n1 0 0 0\nDiameters\n\n1 1\nMasses\n\n1 -1\n", 11, "below 0"},
        {"lammps", "t\nCoords\n\n1 0 0 0\n", 2, "before"},
        {"kratos", "Begin centers_and_radii\n0 0 0 1\n", 2, "cut short"},
        {"kratos", "Begin centers_and_radii\n0 0 0\nEnd centers_and_radii\n", 2, "number"},
        {"kratos", "Begin centers_and_radii\n0 0 0 1 2\nEnd centers_and_radii\n", 2, "more than 4"},
        {"kratos", "Begin centers_and_radii\n0 0 0 0\nEnd centers_and_radii\n", 2, "above 0"},
        {"kratos", CLUSTER "Volume\n-1\n", 5, "above 0"},
        {"kratos", CLUSTER "Volume\n", 4, "end of file"},
        {"kratos", CLUSTER "Inertia per unit mass\n1\n1\n9\n", 4, "no body"},
        {"kratos", CLUSTER "Inertia per unit mass\n1\n1\n", 6, "end of file"},
        {"kratos", "Name\n", 0, "no spheres"},
        {"liggghts", FIX "spheres 0 0 0\n", 1, "ends where"},
        {"liggghts", FIX "spheres 0 0 0 ${r}\n", 1, "variable"},
        {"liggghts", FIX "spheres 0 0 0 -1\n", 1, "above 0"},
        {"liggghts", FIX "spheres 0 0 0 1 scale -1\n", 1, "scale must be above 0"},
        {"liggghts", FIX "spheres 0 0 0 1 scale 1e100\n", 1, "scale makes"},
        {"liggghts", FIX "spheres 0 0 0 1 mass 0\n", 1, "mass must be above 0"},
        {"liggghts", FIX "spheres 0 0 0 1 &\n mass 1 inertia_tensor 1 0 0 1 0\n", 2, "ends where"},
        {"liggghts", FIX "spheres 0 0 0 1 &\n mass 1 inertia_tensor 1 0 0 1 0 4 use_density\n", 2, "no body"},
        {"liggghts", FIX "spheres file grain.multisphere\n", 1, "another file"},
        {"liggghts", FIX "spheres file\n", 1, "name of the sphere file"},
        {"liggghts", FIX "nspheres 1e9 spheres 0 0 0 1\n", 1, "whole"},
        {"liggghts", "fix p all particletemplate/multisphere 1 spheres 0 0 0 1\n", 1, "nspheres"},
        {"liggghts", FIX "\n", 0, "no spheres"},
        {"json", "{\"schema\": \"dem-clump/1\",\n \"density\": }", 2, "JSON"},
        {"json", "0 0 0 1\n", 0, ""},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        const dem_importer *importer = cases[i].format ? dem_importer_find(cases[i].format) : NULL;
        converted c = convert_as("the file", cases[i].text, strlen(cases[i].text), importer, NULL);
        bool good = c.status == DEM_BAD_INPUT && strstr(c.error.text, cases[i].says) &&
                    strcmp(c.error.file, "the file") == 0 && (cases[i].line == 0 || c.error.line == cases[i].line);
        if (!good)
            print_error("%s: '%s'\nstatus %d, %s:%ld: %s\nwanted line %ld, '%s'\n", cases[i].format, cases[i].text,
                        c.status, c.error.file, c.error.line, c.error.text, cases[i].line, cases[i].says);
        check(good);
        if (strcmp(cases[i].says, "JSON") && *cases[i].says)
            check(strchr(c.error.text, ';') != NULL);
        done(&c);
    }
}

static void bytes_and_cut_texts_never_do_harm(void **state)
{
    (void)state;
    converted c = convert_as("x", "0 0 0 1\n0 0\0 0 1\n", 17, NULL, NULL);
    check(c.status == DEM_BAD_INPUT && strstr(c.error.text, "binary") && c.error.line == 2);
    static const char *const whole[] = {MOLECULE, ROWS, "x,y,z,r\n0,0,0,1\n1,0,0,1\n",
                                        "Name\nx\n" CLUSTER "Volume\n4\nInertia per unit mass\n1\n1\n1\n",
                                        FIX "spheres 0 0 0 1 &\n mass 1 inertia_tensor 1 0 0 1 0 1 use_density\n"};
    for (size_t k = 0; k < sizeof whole / sizeof *whole; k++)
        for (size_t size = 0; size < strlen(whole[k]); size++) {
            c = convert_as("cut", whole[k], size, NULL, NULL);
            check(c.status == DEM_OK || (c.status == DEM_BAD_INPUT && c.error.text[0]));
            // a molecule and a cluster tell how much is to come
            if (k == 0 && size + 1 < strlen(whole[k]))
                check(c.status != DEM_OK || c.def.mass == 0.015);
            done(&c);
        }
    dem_random r = random_stream(5, 0);
    for (int n = 0; n < 2000; n++) {
        char bytes[200];
        size_t size = (size_t)(random_uniform(&r) * sizeof bytes);
        for (size_t i = 0; i < size; i++)
            bytes[i] = "0123456789.,;-+e \n\r\t#/&xyzrnaif{}\"\xff"[(size_t)(random_uniform(&r) * 35)];
        for (const dem_importer *const *f = dem_importers(); *f; f++) {
            c = convert_as("noise", bytes, size, *f, NULL);
            check(c.status == DEM_OK || (c.status == DEM_BAD_INPUT && c.error.text[0]));
            done(&c);
        }
    }
}

static void too_many_spheres_are_refused(void **state)
{
    (void)state;
    dem_buffer text = {0};
    for (int i = 0; i <= DEM_IMPORT_SPHERES; i++)
        dem_buffer_print(&text, "%d 0 0 1\n", 3 * i);
    dem_import import;
    dem_error error;
    check(dem_import_decode(NULL, "x", NULL, text.data, text.size, NULL, &import, NULL, &error) == DEM_BAD_INPUT);
    check(strstr(error.text, "more than 100000 spheres") && error.line == DEM_IMPORT_SPHERES + 1);
    dem_import_release(&import);
    dem_buffer_release(&text);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(spheres_that_overlap_too_often_are_refused),
        cmocka_unit_test(a_broken_file_is_refused_with_its_line),
        cmocka_unit_test(bytes_and_cut_texts_never_do_harm),
        cmocka_unit_test(too_many_spheres_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
