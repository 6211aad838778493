#include "check.h"
#include "clumps.h"
#include "folder.h"

#include "base/random.h"
#include "base/text.h"
#include "clump/file.h"
#include "clump/import.h"
#include "math/mat3.h"
#include "math/quat.h"
#include "out/export.h"

// what was warned of
typedef struct listener {
    char text[4096];
    int count;
} listener;

static void listen(void *user, dem_log_level level, const char *subject, const char *text)
{
    listener *l = user;
    (void)subject;
    if (level != DEM_LOG_WARNING)
        return;
    l->count++;
    snprintf(l->text + strlen(l->text), sizeof l->text - strlen(l->text), "%s\n", text);
}

typedef struct converted {
    dem_clump *clump;
    dem_clump_def def;
    dem_import_report report;
    const dem_importer *format;
    listener heard;
    dem_error error;
    dem_status status;
} converted;

static converted convert_as(const char *file, const char *text, size_t size, const dem_importer *importer,
                            const dem_import_options *options)
{
    converted c = {0};
    dem_ctx ctx = {.log = listen, .user = &c.heard};
    dem_import import;
    dem_import_options plain = dem_import_defaults();
    c.status = dem_import_decode(&ctx, file, NULL, text, size, importer, &import, &c.format, &c.error);
    if (c.status == DEM_OK)
        c.status = dem_import_clump(&import, options ? options : &plain, &c.clump, &c.report, &c.error);
    if (c.status == DEM_OK)
        c.def = dem_clump_view(c.clump);
    dem_import_release(&import);
    return c;
}

static converted convert(const char *file, const char *text, const dem_import_options *options)
{
    converted c = convert_as(file, text, strlen(text), NULL, options);
    check_ok(c.status, c.error);
    return c;
}

static void done(converted *c)
{
    dem_clump_destroy(c->clump);
    c->clump = NULL;
}

static void warned(const converted *c, const char *of)
{
    if (!strstr(c->heard.text, of))
        print_error("no '%s' among: %s\n", of, c->heard.text);
    check(strstr(c->heard.text, of) != NULL);
}

// the frame is right: spheres led back stand where they stood
static void check_way_back(const dem_clump_def *def, const dem_ball *balls, size_t count, double tolerance)
{
    check(def->ball_count == count);
    for (size_t i = 0; i < count; i++) {
        dem_vec3 back = v3_add(def->position, quat_rotate(def->orientation, def->balls[i].centre));
        check_vec(back, balls[i].centre, tolerance);
        check_close(def->balls[i].radius, balls[i].radius, 1e-15);
    }
}

static const dem_ball five[5] = {{{-0.00231590444, -0.000839033229, -0.000263204445}, 0.01},
                                 {{0.00683335774, 0.000666104975, -0.000423081062}, 0.008},
                                 {{-0.00810299602, 0.00654214754, 0.000750571413}, 0.006},
                                 {{-1.69499065e-05, -0.00991916834, 0.0020315623}, 0.005},
                                 {{0.0125426732, 0.00678788363, 0.00239250824}, 0.004}};

// ---- what each format means

static void two_balls_apart_have_the_mass_and_inertia_of_the_books(void **state)
{
    (void)state;
    // radius 1 at x = 1 and 5: 2 (4/3 pi), and about the middle 2 (2/5 m + 4 m) across
    converted c = convert("pair.xyzr", "1 0 0 1\n5 0 0 1\n", NULL);
    double m = 2650 * 4 * DEM_PI / 3;
    assert_string_equal(c.format->name, "xyzr");
    assert_string_equal(c.def.name, "pair");
    check_close(c.def.mass, 2 * m, 1e-13);
    check_close(c.def.inertia[0], 2 * 0.4 * m, 1e-13);
    check_close(c.def.inertia[1], 2 * (0.4 + 4) * m, 1e-13);
    check_close(c.def.inertia[2], 2 * (0.4 + 4) * m, 1e-13);
    check(c.def.mass_from == DEM_MASS_FROM_UNION && c.def.density == 2650);
    check_vec(c.def.position, v3(3, 0, 0), 1e-14);
    check_way_back(&c.def, (dem_ball[]){{{1, 0, 0}, 1}, {{5, 0, 0}, 1}}, 2, 1e-14);
    check(isnan(c.def.fidelity.iou_gap) && isnan(c.def.shape.longest) && c.def.surface.triangle_count == 0);
    check_close(c.def.fidelity.overlap_ratio, 1, 1e-13);
    check(c.report.pieces == 2 && isnan(c.report.mass));
    warned(&c, "2 pieces");
    done(&c);
}

static void blanks_commas_comments_and_line_ends_are_all_the_same(void **state)
{
    (void)state;
    static const char *const texts[] = {
        "1 0 0 1\n5 0 0 1\n",
        "1,0,0,1\n5,0,0,1",
        "1;0;0;1\r\n5;0;0;1\r\n",
        "\xef\xbb\xbf# a comment, 7\r\n\r\n  1\t0, 0 ,1 # one\r\n\n5 0 0 1e0",
        "1 0 0 1\r5 0 0 1\r",
        "x,y,z,r\n1,0,0,1\n5,0,0,1\n",
        "\"r\",\"z\",\"y\",\"x\",\"name\"\r\n1,0,0,1,a\r\n1,0,0,5,b",
        "Radius X Y Z\n1 1 0 0\n1 5 0 0\n",
    };
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        converted c = convert("pair", texts[i], NULL);
        check_way_back(&c.def, (dem_ball[]){{{1, 0, 0}, 1}, {{5, 0, 0}, 1}}, 2, 1e-14);
        done(&c);
    }
}

#define ROWS                                                                                                           \
    "-0.00231590444 -0.000839033229 -0.000263204445 0.01\n0.00683335774 0.000666104975 -0.000423081062 0.008\n"        \
    "-0.00810299602 0.00654214754 0.000750571413 0.006\n-1.69499065e-05 -0.00991916834 0.0020315623 0.005\n"           \
    "0.0125426732 0.00678788363 0.00239250824 0.004\n"
#define ATOMS                                                                                                          \
    "\nCoords\n\n1 -0.00231590444 -0.000839033229 -0.000263204445\n2 0.00683335774 0.000666104975 -0.000423081062\n"   \
    "3 -0.00810299602 0.00654214754 0.000750571413\n4 -1.69499065e-05 -0.00991916834 0.0020315623\n"                   \
    "5 0.0125426732 0.00678788363 0.00239250824\n\nTypes\n\n1 1\n2 1\n3 1\n4 1\n5 1\n\nDiameters\n\n"                  \
    "5 0.008\n1 0.02\n2 0.016\n3 0.012\n4 0.01\n"
#define MOLECULE "grain\n\n5 atoms\n0.015 mass\n0 0 0 com\n6.8e-07 9.3e-07 1.1e-06 0 0 0 inertia\n" ATOMS

static void a_molecule_keeps_mass_centre_and_inertia(void **state)
{
    (void)state;
    converted c = convert("grain", MOLECULE, NULL);
    assert_string_equal(c.format->name, "lammps");
    check(c.def.mass == 0.015 && c.def.mass_from == DEM_MASS_GIVEN);
    check(c.def.inertia[0] == 6.8e-7 && c.def.inertia[1] == 9.3e-7 && c.def.inertia[2] == 1.1e-6);
    check(v3_norm(c.def.position) == 0 && c.def.orientation.w == 1);
    assert_memory_equal(c.def.balls, five, sizeof five);
    check_close(c.def.volume, c.def.union_volume, 1e-15);
    warned(&c, "moments of inertia differ");
    done(&c);
}

static void a_density_tells_what_volume_a_mass_stands_for(void **state)
{
    (void)state;
    dem_import_options o = dem_import_defaults();
    o.density = 2500;
    converted c = convert("grain", MOLECULE, &o);
    check(c.def.mass == 0.015 && c.def.density == 2500);
    check_close(c.def.volume, 6e-6, 1e-15);
    warned(&c, "its mass is 6.71 % less");
    done(&c);
    o.mass_from = DEM_IMPORT_UNION;
    c = convert("grain", MOLECULE, &o);
    check_close(c.def.mass, 2500 * c.def.union_volume, 1e-15);
    check(c.def.mass_from == DEM_MASS_FROM_UNION && v3_norm(c.def.position) > 0);
    check_vec(c.def.union_centre, v3(0, 0, 0), 1e-17);
    check_way_back(&c.def, five, 5, 1e-17);
    done(&c);
}

static void a_mass_scales_the_inertia(void **state)
{
    (void)state;
    dem_import_options o = dem_import_defaults();
    o.mass = 0.03;
    converted c = convert("grain", MOLECULE, &o);
    check(c.def.mass == 0.03);
    check_close(c.def.inertia[2], 2.2e-6, 1e-15);
    done(&c);
}

static void masses_of_atoms_are_summed_where_no_mass_is_given(void **state)
{
    (void)state;
    converted c = convert("grain",
                          "t\n2 atoms\nCoords\n\n1 0 0 0\n2 1 0 0\n\nDiameters\n\n1 1.5\n2 1.5\n\nMasses\n\n"
                          "1 3\n2 1\n",
                          NULL);
    check(c.def.mass == 4 && c.def.mass_from == DEM_MASS_GIVEN);
    check_vec(c.def.position, v3(0.25, 0, 0), 1e-15);
    warned(&c, "centre of mass");
    done(&c);
}

// a plate-like tensor turned about z and y: the frame must diagonalise it, and the way back must lead there
static void a_tensor_with_off_diagonals_is_diagonalised(void **state)
{
    (void)state;
    dem_quat turn = quat_unit((dem_quat){0.8, 0.1, 0.5, -0.3});
    const double moments[3] = {1, 2, 2.5};
    dem_sym3 t = {0};
    for (int i = 0; i < 3; i++)
        t = sym3_add(t, sym3_scale(sym3_outer(quat_rotate(turn, v3(i == 0, i == 1, i == 2))), moments[i]));
    for (int lammps = 0; lammps < 2; lammps++) {
        dem_buffer text = {0};
        const double in_order[2][6] = {{t.xx, t.xy, t.xz, t.yy, t.yz, t.zz}, {t.xx, t.yy, t.zz, t.xy, t.xz, t.yz}};
        dem_buffer_text(&text, lammps ? "t\n2 atoms\n5 mass\n0 0 0 com\n"
                                      : "fix p all particletemplate/multisphere 1 density constant 2 nspheres 2 &\n"
                                        "spheres 0 0 0 1 1 0 0 1 &\n use_density mass 5 inertia_tensor");
        for (int i = 0; i < 6; i++) {
            dem_buffer_text(&text, " ");
            dem_buffer_number(&text, in_order[lammps][i], 17);
        }
        if (lammps)
            dem_buffer_text(&text, " inertia\nCoords\n\n1 0 0 0\n2 1 0 0\nDiameters\n\n1 2\n2 2\n");
        converted c = convert("grain", text.data, NULL);
        assert_string_equal(c.format->name, lammps ? "lammps" : "liggghts");
        for (int i = 0; i < 3; i++) {
            dem_vec3 axis = v3(i == 0, i == 1, i == 2);
            check_close(c.def.inertia[i], moments[i], 1e-14);
            // axes up to their sign
            check_near(fabs(v3_dot(quat_rotate(c.def.orientation, axis), quat_rotate(turn, axis))), 1, 1e-14);
        }
        check_way_back(&c.def, (dem_ball[]){{{0, 0, 0}, 1}, {{1, 0, 0}, 1}}, 2, 1e-14);
        check(strstr(c.heard.text, "LAMMPS itself takes xy for yz") ? lammps : !lammps);
        check(lammps || c.def.volume == 2.5);
        done(&c);
        dem_buffer_release(&text);
    }
}

static void the_centre_of_a_cluster_is_subtracted(void **state)
{
    (void)state;
    converted c = convert("a.txt",
                          "// grain (SI)\nName\npebble 7\n\nBegin centers_and_radii\n1 0 0 1\n2 0 0 1\nEnd "
                          "centers_and_radii\n\nParticle_center_and_diameter\n1.5 0.5 0 3\n\nSize\n3\n\nVolume\n7\n\n"
                          "Inertia per unit mass\n0.4\n0.7\n0.6\n",
                          NULL);
    assert_string_equal(c.format->name, "kratos");
    assert_string_equal(c.def.name, "pebble 7");
    check_close(c.def.mass, 7 * 2650, 1e-15);
    check_close(c.def.inertia[0], 0.4 * 7 * 2650, 1e-14);
    check_close(c.def.inertia[1], 0.6 * 7 * 2650, 1e-14);  // y and z change places
    check_close(c.def.inertia[2], 0.7 * 7 * 2650, 1e-14);
    check_vec(c.def.position, v3(1.5, 0.5, 0), 1e-15);
    check_way_back(&c.def, (dem_ball[]){{{1, 0, 0}, 1}, {{2, 0, 0}, 1}}, 2, 1e-15);
    warned(&c, "centre of mass");
    done(&c);
}

static void a_script_line_scales_the_spheres_but_not_the_mass(void **state)
{
    (void)state;
    static const char text[] = "units si # comment\nfix pts1 all particletemplate/multisphere 15485863 atom_type 1 "
                               "density constant 2650 &\n  nspheres 2 ntry 1000 spheres 0 0 0 1 0.5 0 0 1 scale 2 &\n"
                               "mass 100 inertia_tensor 40 0 0 50 0 60 %s\nfix pdd1 all something else\n";
    char full[1024];
    for (int origin = 0; origin < 2; origin++) {
        snprintf(full, sizeof full, text, origin ? "use_density" : "use_volume");
        converted c = convert("in.grain", full, NULL);
        assert_string_equal(c.def.name, "pts1");
        check(c.def.mass == 100 && c.def.density == 2650 && c.def.inertia[2] == 60);
        check_vec(c.def.position, origin ? v3(0, 0, 0) : v3(0.5, 0, 0), 1e-14);
        check_way_back(&c.def, (dem_ball[]){{{0, 0, 0}, 2}, {{1, 0, 0}, 2}}, 2, 1e-14);
        done(&c);
    }
}

static void the_sphere_file_of_a_script_stands_beside_it(void **state)
{
    (void)state;
    static const char script[] = "fix p1 all particletemplate/multisphere 1 density constant 2650 nspheres 5 &\n"
                                 " spheres file grain.multisphere scale 1.0 type 1\n";
    dem_error error;
    dem_import import;
    const dem_importer *used;
    check_ok(dem_file_write(in_folder("grain.multisphere"), ROWS, strlen(ROWS), &error), error);
    check_ok(dem_file_write(in_folder("in.grain"), script, strlen(script), &error), error);
    check_ok(dem_import_read(NULL, in_folder("in.grain"), NULL, &import, &used, &error), error);
    check(import.count == 5 && import.density == 2650 && memcmp(import.balls, five, sizeof five) == 0);
    dem_import_release(&import);
    // what is said about them in the other file has its name
    check_ok(dem_file_write(in_folder("grain.multisphere"), "0 0 0 1\n0 0 0 -1\n", 16, &error), error);
    check(dem_import_read(NULL, in_folder("in.grain"), NULL, &import, &used, &error) == DEM_BAD_INPUT);
    check(strstr(error.file, "grain.multisphere") && error.line == 2);
    dem_import_release(&import);
    unlink(in_folder("grain.multisphere"));
    check(dem_import_read(NULL, in_folder("in.grain"), NULL, &import, &used, &error) == DEM_BAD_INPUT);
    check(strstr(error.text, "cannot be read") && error.line == 2);
    dem_import_release(&import);
}

static void a_fifth_column_is_a_type_where_the_name_says_liggghts(void **state)
{
    (void)state;
    converted c = convert("rock.multisphere", "0 0 0 1 1\n1 0 0 1 2\n", NULL);
    assert_string_equal(c.format->name, "liggghts");
    check(c.def.ball_count == 2);
    done(&c);
    c = convert_as("rock.txt", "0 0 0 1 1\n", 10, NULL, NULL);
    check(c.status == DEM_BAD_INPUT && strstr(c.error.text, "--from liggghts") && c.error.line == 1);
}

// ---- units, size, what is asked

static void units_scale_lengths_mass_and_inertia(void **state)
{
    (void)state;
    dem_import_options o = dem_import_defaults();
    o.unit = 1e-3;
    o.mass_unit = 1e-3;
    converted c = convert("grain",
                          "t\n1 atoms\n5 mass\n0 0 0 com\n1 1 1 0 0 0 inertia\nCoords\n\n1 0 0 0\nDiameters\n\n"
                          "1 2\n",
                          &o);
    check_close(c.def.mass, 5e-3, 1e-15);
    check_close(c.def.inertia[0], 1e-9, 1e-15);
    check_close(c.def.balls[0].radius, 1e-3, 1e-15);
    warned(&c, "density comes to");  // 5 g in 4 mm^3
    warned(&c, "one sphere alone");
    done(&c);
}

static void a_size_scales_everything_at_the_same_density(void **state)
{
    (void)state;
    dem_import_options o = dem_import_defaults();
    converted a = convert("grain", MOLECULE, NULL);
    double s = 2;
    o.size = s * cbrt(6 / DEM_PI * a.def.volume);
    converted b = convert("grain", MOLECULE, &o);
    check_close(b.def.mass, s * s * s * a.def.mass, 1e-13);
    check_close(b.def.density, a.def.density, 1e-13);
    check_close(b.def.volume, s * s * s * a.def.volume, 1e-13);
    for (int i = 0; i < 3; i++) {
        check_close(b.def.inertia[i], pow(s, 5) * a.def.inertia[i], 1e-13);
        check_close(b.def.union_inertia[i], pow(s, 5) * a.def.union_inertia[i], 1e-12);
    }
    check_close(b.def.balls[4].centre.x, s * a.def.balls[4].centre.x, 1e-13);
    done(&a);
    done(&b);
}

static void a_clump_of_ours_passes_through_to_the_last_bit(void **state)
{
    (void)state;
    dem_clump_def def = sample_clump();
    dem_clump *clump = made_clump(&def);
    dem_buffer text = {0};
    dem_error error;
    check_ok(dem_clump_encode(clump, &text, &error), error);
    converted c = convert("x.json", text.data, NULL);
    check_same_clump(clump, c.clump);
    done(&c);
    // and what is asked of it is done to all of it
    dem_import_options o = dem_import_defaults();
    o.density = 2 * def.density;
    o.size = 2 * cbrt(6 / DEM_PI * def.volume);
    c = convert("x.json", text.data, &o);
    check_close(c.def.mass, 16 * def.mass, 1e-14);
    check_close(c.def.inertia[1], 64 * def.inertia[1], 1e-14);
    check_close(c.def.shape.longest, 2 * def.shape.longest, 1e-14);
    check(c.def.shape.elongation == def.shape.elongation && c.def.fidelity.iou_gap == def.fidelity.iou_gap);
    check_vec(c.def.surface.vertices[3], v3_scale(def.surface.vertices[3], 2), 1e-14);
    check_vec(c.def.position, v3_scale(def.position, 2), 1e-9);
    assert_string_equal(c.def.source_mesh, def.source_mesh);
    done(&c);
    // a unit is wrong for what is in metres
    o = dem_import_defaults();
    o.unit = 1e-3;
    c = convert_as("x.json", text.data, text.size, NULL, &o);
    check(c.status == DEM_BAD_INPUT && strstr(c.error.text, "leave --unit out"));
    dem_buffer_release(&text);
    dem_clump_destroy(clump);
}

static void a_clump_of_ours_takes_the_mass_of_its_union(void **state)
{
    (void)state;
    dem_clump_def def = sample_clump();
    dem_clump *clump = made_clump(&def);
    dem_buffer text = {0};
    dem_error error;
    dem_union u;
    check_ok(dem_balls_union(def.balls, def.ball_count, &u, &error), error);
    check_ok(dem_clump_encode(clump, &text, &error), error);
    dem_import_options o = dem_import_defaults();
    o.mass_from = DEM_IMPORT_UNION;
    converted c = convert("x.json", text.data, &o);
    check(c.def.mass_from == DEM_MASS_FROM_UNION);
    check_close(c.def.mass, def.density * u.solid.volume, 1e-14);
    check_close(c.def.inertia[0], def.density * u.solid.principal[0], 1e-14);
    // spheres and surface move together: where the mesh was they are still
    for (int i = 0; i < 4; i++) {
        dem_vec3 was = v3_add(def.position, quat_rotate(def.orientation, def.surface.vertices[i]));
        dem_vec3 is = v3_add(c.def.position, quat_rotate(c.def.orientation, c.def.surface.vertices[i]));
        check_vec(is, was, 1e-9);  // 1e6 m from the origin
    }
    done(&c);
    dem_buffer_release(&text);
    dem_clump_destroy(clump);
}

// ---- round trips

// what our exporters say is heard again; each frame
static void what_is_exported_comes_back(void **state)
{
    (void)state;
    dem_clump_def def = sample_clump();
    def.position = v3(10, -2, 3);
    def.inertia[2] = 0.29;
    dem_clump *clump = made_clump(&def);
    static const char *const formats[] = {"json", "xyzr", "liggghts", "lammps", "deme", "kratos"};
    int tried = 0;
    for (size_t i = 0; i < sizeof formats / sizeof *formats; i++) {
        const dem_exporter *exporter = dem_exporter_find(formats[i]);
        for (int frame = DEM_FRAME_PRINCIPAL; exporter && frame <= DEM_FRAME_MESH; frame++) {
            dem_export_options o = {.frame = (dem_frame)frame};
            dem_buffer text = {0};
            dem_error error;
            check_ok(exporter->write(clump, &o, &text, &error), error);
            converted c = convert_as("back", text.data, text.size, dem_importer_find(formats[i]), NULL);
            check_ok(c.status, c.error);
            check_close(c.def.mass, def.mass, 1e-12);
            check_close(c.def.density, def.density, 1e-12);
            check_close(c.def.volume, def.volume, 1e-12);
            for (int k = 0; k < 3; k++)
                check_close(c.def.inertia[k], def.inertia[k], 1e-12);
            for (size_t k = 0; k < def.ball_count; k++) {
                check_vec(c.def.balls[k].centre, def.balls[k].centre, 1e-14 * (frame == DEM_FRAME_MESH ? 10 : 1));
                check_close(c.def.balls[k].radius, def.balls[k].radius, 1e-12);
            }
            check_vec(c.def.position, def.position, 1e-12);
            check_near(fabs(c.def.orientation.w), def.orientation.w, 1e-12);
            check_near(fabs(c.def.orientation.y), def.orientation.y, 1e-12);
            check_close(c.def.union_volume, c.report.pieces ? c.def.union_volume : NAN, 0);
            done(&c);
            dem_buffer_release(&text);
            tried++;
        }
    }
    check(tried >= 4);
    dem_clump_destroy(clump);
}

static dem_mesh cube_mesh(double a)
{
    static const uint32_t t[36] = {0, 2, 1, 0, 3, 2, 4, 5, 6, 4, 6, 7, 0, 1, 5, 0, 5, 4,
                                   1, 2, 6, 1, 6, 5, 2, 3, 7, 2, 7, 6, 3, 0, 4, 3, 4, 7};
    dem_mesh m = {.vertices = malloc(8 * sizeof(dem_vec3)),
                  .triangles = malloc(sizeof t),
                  .vertex_count = 8,
                  .triangle_count = 12};
    static const int corner[8][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},
                                     {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
    for (int i = 0; i < 8; i++)
        m.vertices[i] = v3(a * corner[i][0], a * corner[i][1], a * corner[i][2]);
    memcpy(m.triangles, t, sizeof t);
    return m;
}

// a ball in a cube of twice its radius: the gap is 1 - pi / 6
static void a_mesh_gives_fidelity_shape_and_surface(void **state)
{
    (void)state;
    dem_mesh cube = cube_mesh(2);
    dem_import_options o = dem_import_defaults();
    o.mesh = &cube;
    converted c = convert("ball.xyzr", "1 1 1 1\n", &o);
    check_near(c.def.fidelity.iou_gap, 1 - DEM_PI / 6, 0.01);
    check_near(c.def.shape.longest, 2, 1e-6);
    check(c.def.surface.triangle_count == 12 && c.def.mass_from == DEM_MASS_FROM_UNION);
    check_vec(v3_add(c.def.position, quat_rotate(c.def.orientation, c.def.surface.vertices[0])), v3(0, 0, 0), 1e-14);
    done(&c);
    o.mass_from = DEM_IMPORT_MESH;
    c = convert("ball.xyzr", "1 1 1 1\n", &o);
    check_close(c.def.mass, 8 * 2650, 1e-13);
    check_close(c.def.inertia[0], 8 * 2650 * 8 / 12.0, 1e-13);
    check(c.def.mass_from == DEM_MASS_FROM_MESH);
    done(&c);
    // at twice the size the mesh grows along
    o.size = 2 * cbrt(6 / DEM_PI * 8);
    c = convert("ball.xyzr", "1 1 1 1\n", &o);
    check_near(c.def.fidelity.iou_gap, 1 - DEM_PI / 6, 0.01);
    check_near(c.def.shape.longest, 4, 1e-6);
    check_close(c.def.mass, 64 * 2650, 1e-13);
    done(&c);
    dem_mesh_free(&cube);
}

// ---- what is odd or broken

static void odd_clumps_are_warned_of(void **state)
{
    (void)state;
    converted c = convert("x", "0 0 0 1\n0 0 0 1\n0 0 0 0.5\n1 0 0 1\n0 0 0 1\n", NULL);
    warned(&c, "2 of its spheres stand there more than once");
    check(c.report.duplicates == 2 && c.report.redundant == 3 && c.def.ball_count == 5);
    check_close(c.def.union_volume, 9 * DEM_PI / 4, 1e-13);
    done(&c);
    // the moments of the union about other axes
    c = convert("x",
                "fix p all particletemplate/multisphere 1 density constant 1 nspheres 2 spheres 0 -1 0 1 0 1 0 1 "
                "use_density mass 8.3775804095727811 inertia_tensor 3.3510321638291125 0 0 11.728612573401893 0 "
                "11.728612573401893\n",
                NULL);
    warned(&c, "moments of the union but other axes");
    check(c.heard.count == 2);  // touching balls are two pieces
    done(&c);
}

static void a_good_clump_is_not_warned_of(void **state)
{
    (void)state;
    converted c = convert("x", "0 0 0 1\n1 0 0 1\n", NULL);
    check(c.heard.count == 0);
    done(&c);
}

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
        cmocka_unit_test(two_balls_apart_have_the_mass_and_inertia_of_the_books),
        cmocka_unit_test(blanks_commas_comments_and_line_ends_are_all_the_same),
        cmocka_unit_test(a_molecule_keeps_mass_centre_and_inertia),
        cmocka_unit_test(a_density_tells_what_volume_a_mass_stands_for),
        cmocka_unit_test(a_mass_scales_the_inertia),
        cmocka_unit_test(masses_of_atoms_are_summed_where_no_mass_is_given),
        cmocka_unit_test(a_tensor_with_off_diagonals_is_diagonalised),
        cmocka_unit_test(the_centre_of_a_cluster_is_subtracted),
        cmocka_unit_test(a_script_line_scales_the_spheres_but_not_the_mass),
        cmocka_unit_test(the_sphere_file_of_a_script_stands_beside_it),
        cmocka_unit_test(a_fifth_column_is_a_type_where_the_name_says_liggghts),
        cmocka_unit_test(units_scale_lengths_mass_and_inertia),
        cmocka_unit_test(a_size_scales_everything_at_the_same_density),
        cmocka_unit_test(a_clump_of_ours_passes_through_to_the_last_bit),
        cmocka_unit_test(a_clump_of_ours_takes_the_mass_of_its_union),
        cmocka_unit_test(what_is_exported_comes_back),
        cmocka_unit_test(a_mesh_gives_fidelity_shape_and_surface),
        cmocka_unit_test(odd_clumps_are_warned_of),
        cmocka_unit_test(a_good_clump_is_not_warned_of),
        cmocka_unit_test(spheres_that_overlap_too_often_are_refused),
        cmocka_unit_test(a_broken_file_is_refused_with_its_line),
        cmocka_unit_test(bytes_and_cut_texts_never_do_harm),
        cmocka_unit_test(too_many_spheres_are_refused),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
