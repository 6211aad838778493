// What is written for other programs, read back as they read it: mass, centre, moments, spheres.
#include "clumps.h"
#include "folder.h"

#include "base/text.h"
#include "math/mat3.h"
#include "out/export.h"

enum { MOST = 16 };

#define ROUNDING 1e-15  // 17 digits give the same number back, a product or quotient the nearest ones

// what a program makes of a file
typedef struct read_clump {
    dem_ball balls[MOST];
    size_t count;
    double mass, inertia[3];
} read_clump;

static dem_buffer written(const char *format, const dem_clump_def *def)
{
    dem_clump *clump = made_clump(def);
    dem_buffer out = {0};
    dem_error error;
    dem_export_options options = {.file = "some/where/g.x"};
    check_ok(dem_exporter_find(format)->write(clump, &options, &out, &error), error);
    dem_clump_destroy(clump);
    return out;
}

// the text behind the first `key`
static const char *behind(const char *text, const char *key)
{
    const char *at = strstr(text, key);
    if (!at)
        print_error("no '%s' in:\n%s\n", key, text);
    check(at != NULL);
    return at + strlen(key);
}

// numbers with anything of " ,;()[]\t\n" between them; returns what is behind them
static const char *numbers(const char *at, double *values, size_t count)
{
    const char *end = at + strlen(at);
    for (size_t i = 0; i < count; i++) {
        at += strspn(at, " ,;()[]\t\n");
        at = dem_parse_double(at, end, &values[i]);
        check(at != NULL);
    }
    return at;
}

static double number_behind(const char *text, const char *key)
{
    double value;
    numbers(behind(text, key), &value, 1);
    return value;
}

// `count` rows of `columns` numbers; x, y, z, r are those of the columns named; returns what is behind them
static const char *rows(const char *text, read_clump *c, size_t count, size_t columns, const char *named)
{
    double v[20] = {0};
    for (c->count = 0; c->count < count; c->count++) {
        text = numbers(text, v, columns);
        check(c->count < MOST);
        c->balls[c->count] = (dem_ball){{v[named[0] - '0'], v[named[1] - '0'], v[named[2] - '0']}, v[named[3] - '0']};
    }
    return text;
}

// the head stands in each format, whatever starts its comments
static void check_head(const char *text, const dem_clump_def *def)
{
    double v[4];
    check(strstr(text, "grain__7____: ") && strstr(text, "SI units (m, kg)"));
    check(number_behind(text, "density [kg/m^3]: ") == def->density);
    check(number_behind(text, " mass [kg]: ") == def->mass || number_behind(text, "\nmass [kg]: ") == def->mass);
    numbers(behind(text, "principal moments of inertia [kg m^2]: "), v, 3);
    check(v[0] == def->inertia[0] && v[1] == def->inertia[1] && v[2] == def->inertia[2]);
    numbers(behind(text, "principal to mesh frame, position [m]: "), v, 3);
    check(v[0] == def->position.x && v[1] == def->position.y && v[2] == def->position.z);
    numbers(behind(text, "principal to mesh frame, quaternion w x y z: "), v, 4);
    check(v[0] == def->orientation.w && v[1] == def->orientation.x && v[2] == def->orientation.y &&
          v[3] == def->orientation.z);
    check(number_behind(text, "  mass [kg]: ") == def->union_volume * def->density);
}

static void check_read(const read_clump *c, const dem_clump_def *def)
{
    check(c->count == def->ball_count);
    for (size_t i = 0; i < c->count; i++) {
        check_vec(c->balls[i].centre, def->balls[i].centre, ROUNDING);
        check_close(c->balls[i].radius, def->balls[i].radius, ROUNDING);
    }
    check_close(c->mass, def->mass, ROUNDING);
    for (int k = 0; k < 3; k++)
        check_close(c->inertia[k], def->inertia[k], ROUNDING);
}

// nothing is behind the last row
static void check_end(const char *text)
{
    assert_string_equal(text + strspn(text, " \n"), "");
}

static void lammps_gets_mass_centre_and_moments_in_the_head(void **state)
{
    (void)state;
    dem_clump_def def = sample_clump();
    dem_buffer out = written("lammps", &def);
    check_head(out.data, &def);
    read_clump c = {0};
    double v[6], sum = 0;
    const char *body = behind(out.data, "\n\n");
    check(number_behind(body, "") == SAMPLE_BALLS && number_behind(body, "atoms\n") == def.mass);
    numbers(behind(body, "mass\n"), v, 3);
    check(v[0] == 0 && v[1] == 0 && v[2] == 0);
    numbers(behind(body, "com\n"), v, 6);
    check(v[3] == 0 && v[4] == 0 && v[5] == 0);
    c.mass = number_behind(body, "atoms\n");
    memcpy(c.inertia, v, sizeof c.inertia);
    rows(behind(body, "\nCoords\n\n"), &c, SAMPLE_BALLS, 4, "1230");
    const char *diameter = behind(body, "\nDiameters\n\n"), *mass = behind(body, "\nMasses\n\n");
    for (int i = 0; i < SAMPLE_BALLS; i++) {
        check(c.balls[i].radius == i + 1);  // the atoms' numbers
        diameter = numbers(diameter, v, 2);
        c.balls[i].radius = v[1] / 2;
        mass = numbers(mass, v, 2);
        check(v[1] > 0);
        sum += v[1];
    }
    check_end(mass);
    check_close(sum, def.mass, 1e-12);
    check_read(&c, &def);
    check(strstr(out.data, "molecule grain__7____ g.x\n") != NULL);
    dem_buffer_release(&out);
}

static void liggghts_gets_its_spheres_and_a_command_in_one_line(void **state)
{
    (void)state;
    dem_clump_def def = sample_clump();
    dem_buffer out = written("liggghts", &def);
    check_head(out.data, &def);
    read_clump c = {0};
    double v[6];
    const char *command = behind(out.data, "\n#: fix pts_grain__7____ all particletemplate/multisphere ");
    check(number_behind(command, "nspheres ") == SAMPLE_BALLS && number_behind(command, "density constant ") == 2650);
    check(strncmp(behind(command, "spheres file "), "g.x scale 1.0 ", 14) == 0);
    c.mass = number_behind(command, " mass ");
    numbers(behind(command, "inertia_tensor "), v, 6);  // xx xy xz yy yz zz
    check(v[1] == 0 && v[2] == 0 && v[4] == 0);
    c.inertia[0] = v[0];
    c.inertia[1] = v[3];
    c.inertia[2] = v[5];
    check_end(rows(behind(command, "use_density\n# x y z r\n"), &c, SAMPLE_BALLS, 4, "0123"));
    check_read(&c, &def);
    // LIGGGHTS would go on in the next line behind an '&', also in comments
    check(!strchr(out.data, '&'));
    dem_buffer_release(&out);
}

static void liggghts_gets_one_sphere_as_a_plain_one_of_the_same_mass(void **state)
{
    (void)state;
    dem_clump_def def = sample_clump();
    def.ball_count = 1;
    dem_buffer out = written("liggghts", &def);
    const char *command = behind(out.data, "particletemplate/sphere ");
    double r = number_behind(command, "radius constant "), density = number_behind(command, "density constant ");
    check(r == def.balls[0].radius);
    check_close(4 * DEM_PI / 3 * r * r * r * density, def.mass, ROUNDING);
    dem_buffer_release(&out);
}

static void yade_gets_a_script_with_the_figures(void **state)
{
    (void)state;
    dem_clump_def def = sample_clump();
    dem_buffer out = written("yade", &def);
    check_head(out.data, &def);
    read_clump c = {.mass = number_behind(out.data, "\ngrain__7_____mass = ")};
    numbers(behind(out.data, "\ngrain__7_____inertia = ["), c.inertia, 3);
    const char *end =
        rows(behind(out.data, "\ngrain__7_____spheres = [  # (centre), radius\n"), &c, SAMPLE_BALLS, 4, "0123");
    check(strncmp(end, "),\n]\n", 5) == 0);
    check_read(&c, &def);
    check(strstr(out.data, "\ndef add_grain__7____(") && strstr(out.data, "exec(open('g.x').read())"));
    dem_buffer_release(&out);
}

static void pfc_gets_volume_and_moments_at_unit_density(void **state)
{
    (void)state;
    dem_clump_def def = sample_clump();
    dem_buffer out = written("pfc", &def);
    check_head(out.data, &def);
    const char *command = behind(out.data, "\nclump template create ...\n"), *pebbles = behind(command, "pebbles ");
    read_clump c = {0};
    double v[7];
    check(number_behind(pebbles, "") == SAMPLE_BALLS);
    for (pebbles = strchr(pebbles, '\n'); c.count < SAMPLE_BALLS; pebbles = strchr(pebbles, '\n')) {
        pebbles = numbers(pebbles, v, 4);
        check(strncmp(pebbles, ") ...\n", 6) == 0);
        c.balls[c.count++] = (dem_ball){{v[1], v[2], v[3]}, v[0]};
    }
    c.mass = number_behind(command, "\n    volume ") * def.density;
    numbers(behind(command, "\n    inertia "), v, 6);
    check(v[3] == 0 && v[4] == 0 && v[5] == 0);
    for (int k = 0; k < 3; k++)
        c.inertia[k] = v[k] * def.density;
    check_read(&c, &def);
    assert_string_equal(behind(command, "\n    position "), "(0,0,0)\n");
    dem_buffer_release(&out);
}

static void mercury_gets_a_folder(void **state)
{
    (void)state;
    dem_clump_def def = sample_clump();
    dem_clump *clump = made_clump(&def);
    dem_error error;
    dem_export_options options = {0};
    const dem_exporter *mercury = dem_exporter_find("mercury");
    char path[256];
    snprintf(path, sizeof path, "%s", in_folder("a.mercury"));
    for (int again = 0; again < 2; again++)  // also where it is already
        check_ok(dem_export(mercury, clump, &options, path, &error), error);
    read_clump c = {0};
    double toi[9], pd[9];
    dem_buffer pebbles = content(in_folder("a.mercury/Clump/Clump.txt"));
    dem_buffer mass = content(in_folder("a.mercury/Inertia/Mass.txt"));
    dem_buffer tensor = content(in_folder("a.mercury/Inertia/TOI.txt"));
    dem_buffer axes = content(in_folder("a.mercury/Inertia/PD.txt"));
    dem_buffer readme = content(in_folder("a.mercury/README.txt"));
    check_end(rows(pebbles.data, &c, SAMPLE_BALLS, 4, "0123"));
    check_end(numbers(mass.data, &c.mass, 1));
    check_end(numbers(tensor.data, toi, 9));
    check_end(numbers(axes.data, pd, 9));
    for (int i = 0; i < 9; i++)
        check(pd[i] == (i % 4 == 0) && (i % 4 == 0 || toi[i] == 0));
    for (int k = 0; k < 3; k++)
        c.inertia[k] = toi[4 * k];
    check_read(&c, &def);
    check_head(readme.data, &def);
    check(dem_export(mercury, clump, &options, "-", &error) == DEM_USAGE && strstr(error.text, "folder"));
    dem_buffer *files[] = {&pebbles, &mass, &tensor, &axes, &readme};
    for (int i = 0; i < 5; i++)
        dem_buffer_release(files[i]);
    dem_clump_destroy(clump);
}

static void deme_gets_a_csv_and_the_call_in_a_comment(void **state)
{
    (void)state;
    dem_clump_def def = sample_clump();
    dem_buffer out = written("deme", &def);
    check_head(out.data, &def);
    read_clump c = {.mass = def.mass, .inertia = {def.inertia[0], def.inertia[1], def.inertia[2]}};
    double v[3];
    check_close(number_behind(out.data, "LoadClumpType("), def.mass, 1e-8);  // a float
    numbers(behind(out.data, "make_float3("), v, 1);
    check_close(v[0], def.inertia[0], 1e-8);
    check_close(number_behind(out.data, "SetVolume("), def.mass / def.density, 1e-8);
    check(strstr(out.data, "\"g.x\"") != NULL);
    check_end(rows(behind(out.data, "\nx,y,z,r\n"), &c, SAMPLE_BALLS, 4, "0123"));
    check_read(&c, &def);
    dem_buffer_release(&out);
}

static void kratos_gets_a_cluster_about_its_centre_of_mass(void **state)
{
    (void)state;
    dem_clump_def def = sample_clump();
    dem_buffer out = written("kratos", &def);
    check_head(out.data, &def);
    read_clump c = {.mass = number_behind(out.data, "\nVolume\n") * def.density};
    double v[4], reach = 0;
    const char *end = rows(behind(out.data, "\nBegin centers_and_radii\n"), &c, SAMPLE_BALLS, 4, "0123");
    check(strncmp(end, "\nEnd centers_and_radii\n", 23) == 0);
    check_end(numbers(behind(out.data, "\nInertia per unit mass\n"), c.inertia, 3));
    for (int k = 0; k < 3; k++)
        c.inertia[k] *= def.mass;
    check_read(&c, &def);
    for (int i = 0; i < SAMPLE_BALLS; i++)
        reach = fmax(reach, v3_norm(def.balls[i].centre) + def.balls[i].radius);
    numbers(behind(out.data, "\nParticle_center_and_diameter\n"), v, 4);
    check(v[0] == 0 && v[1] == 0 && v[2] == 0 && v[3] == number_behind(out.data, "\nSize\n"));
    check_close(v[3], 2 * reach, ROUNDING);
    dem_buffer_release(&out);
}

static void edem_gets_a_table_of_radii_and_centres(void **state)
{
    (void)state;
    dem_clump_def def = sample_clump();
    dem_buffer out = written("edem", &def);
    check_head(out.data, &def);
    read_clump c = {.mass = number_behind(out.data, "# volume [m^3]: ") * def.density};
    const char *table = strchr(behind(out.data, "# volume [m^3]: "), '\n') + 1;
    check_end(rows(table, &c, SAMPLE_BALLS, 5, "1230"));
    numbers(behind(out.data, "moments of inertia [kg m^2]: "), c.inertia, 3);
    check_read(&c, &def);
    check(strchr(table, '\t') && !strchr(table, ' '));
    dem_buffer_release(&out);
}

// two balls of radius 1, the second one half way out of the first, and one inside
static void mfix_is_told_the_density_that_makes_its_sum_right(void **state)
{
    (void)state;
    static const dem_ball balls[3] = {{{-0.5, 0, 0}, 1}, {{0.5, 0, 0}, 1}, {{-0.5, 0.1, 0}, 0.5}};
    dem_clump_def def = sample_clump();
    def.balls = balls;
    def.ball_count = 3;
    dem_buffer out = written("mfix", &def);
    check(strncmp(out.data, "#version = 1\n", 13) == 0);
    check_head(out.data, &def);
    double d = number_behind(out.data, "bounding diameter [m]: "), v[18], volume = 0, moment = 0;
    check_close(d, 3, ROUNDING);
    const char *at = behind(out.data, "b_na,pid\n");
    for (int i = 0; i < 3; i++) {
        at = numbers(at, v, 18);
        double r = v[3] * d / 2, ball = 4 * DEM_PI / 3 * r * r * r;
        check_vec(v3(v[0] * d, v[1] * d, v[2] * d), balls[i].centre, ROUNDING);
        check_close(r, balls[i].radius, ROUNDING);
        // of each large ball three quarters show (2 pi r h, h = 1.5), the small one is inside
        check_near(v[4] * d * d, i < 2 ? 3 * DEM_PI : 0, 1e-12);
        check(v[5] == -1 && v[10] == -1 && v[11] == 0 && v[17] == 1);
        volume += ball;
        moment += ball * (v3_norm2(balls[i].centre) - balls[i].centre.x * balls[i].centre.x + 0.4 * r * r);
    }
    check_end(at);
    double density = number_behind(out.data, "so that the mass is right [kg/m^3]: ");
    check_close(density * volume, def.mass, 1e-14);
    check_close(number_behind(out.data, "moments of inertia then have [%]: "),
                100 * (density * moment / def.inertia[0] - 1), 1e-12);
    dem_buffer_release(&out);
}

static void names_are_safe_in_commands_and_source(void **state)
{
    (void)state;
    static const char *const names[] = {"'); import os", "9 lives", "a\nb", "", "\xff\xfe"};
    static const char *const wanted[] = {"add_grain_____import_os(", "add_grain_9_lives(", "add_a_b(", "add_grain(",
                                         "add_grain___("};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        dem_clump_def def = sample_clump();
        def.name = names[i];
        dem_buffer out = written("yade", &def);
        check(strncmp(behind(out.data, "\ndef "), wanted[i], strlen(wanted[i])) == 0);
        for (const char *p = out.data; *p; p++)
            check((unsigned char)*p < 127 && (*p == '\n' || (unsigned char)*p >= ' '));
        dem_buffer_release(&out);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(lammps_gets_mass_centre_and_moments_in_the_head),
        cmocka_unit_test(liggghts_gets_its_spheres_and_a_command_in_one_line),
        cmocka_unit_test(liggghts_gets_one_sphere_as_a_plain_one_of_the_same_mass),
        cmocka_unit_test(yade_gets_a_script_with_the_figures),
        cmocka_unit_test(pfc_gets_volume_and_moments_at_unit_density),
        cmocka_unit_test(mercury_gets_a_folder),
        cmocka_unit_test(deme_gets_a_csv_and_the_call_in_a_comment),
        cmocka_unit_test(kratos_gets_a_cluster_about_its_centre_of_mass),
        cmocka_unit_test(edem_gets_a_table_of_radii_and_centres),
        cmocka_unit_test(mfix_is_told_the_density_that_makes_its_sum_right),
        cmocka_unit_test(names_are_safe_in_commands_and_source),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
