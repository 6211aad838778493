#include "check.h"
#include "clumps.h"
#include "converted.h"
#include "folder.h"

#include "base/text.h"
#include "clump/file.h"
#include "clump/import.h"
#include "math/mat3.h"
#include "math/quat.h"
#include "out/export.h"

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
    check(c.heard.count == 0);  // what is not taken needs no warning
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
    check(c.status == DEM_BAD_INPUT && strstr(c.error.text, "leave --unit and"));
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

// the union's own figures follow those of the clump under the same names
static void the_first_figure_of_a_name_counts(void **state)
{
    (void)state;
    converted c =
        convert("x",
                "# a b: 1 spheres of dem-clump 0.1.0\n# frame: principal; SI units (m, kg)\n# density [kg/m^3]: "
                "2000\n# mass [kg]: 9000\n# the union has\n#   mass [kg]: 8000\n0 0 0 1\n",
                NULL);
    check(c.def.mass == 9000 && c.def.density == 2000 && c.def.volume == 4.5);
    assert_string_equal(c.def.name, "a b");
    warned(&c, "its mass is 7.43 % more");
    done(&c);
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

// a box of 3 x 2 x 1 and a clump that stands turned in its frame
static void the_mesh_of_a_turned_clump_gives_its_own_axes(void **state)
{
    (void)state;
    dem_mesh box = cube_mesh(1);
    for (int i = 0; i < 8; i++)
        box.vertices[i] = v3(5 + 3 * box.vertices[i].x, 2 * box.vertices[i].y, box.vertices[i].z);
    dem_clump_def def = sample_clump();
    def.position = v3(6, 1, 0.5);
    dem_clump *clump = made_clump(&def);
    dem_buffer text = {0};
    dem_error error;
    check_ok(dem_clump_encode(clump, &text, &error), error);
    dem_import_options o = dem_import_defaults();
    o.mesh = &box;
    o.mass_from = DEM_IMPORT_MESH;
    converted c = convert("x.json", text.data, &o);
    check_vec(c.def.position, v3(6.5, 1, 0.5), 1e-14);
    for (int i = 0; i < 3; i++) {
        dem_vec3 axis = v3(i == 0, i == 1, i == 2);
        check_near(fabs(v3_dot(quat_rotate(c.def.orientation, axis), axis)), 1, 1e-14);
    }
    dem_ball placed[SAMPLE_BALLS];
    for (int i = 0; i < SAMPLE_BALLS; i++)
        placed[i] =
            (dem_ball){v3_add(def.position, quat_rotate(def.orientation, def.balls[i].centre)), def.balls[i].radius};
    check_way_back(&c.def, placed, SAMPLE_BALLS, 1e-14);
    done(&c);
    dem_buffer_release(&text);
    dem_clump_destroy(clump);
    dem_mesh_free(&box);
}

// ---- what is odd

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
        cmocka_unit_test(the_first_figure_of_a_name_counts),
        cmocka_unit_test(a_mesh_gives_fidelity_shape_and_surface),
        cmocka_unit_test(the_mesh_of_a_turned_clump_gives_its_own_axes),
        cmocka_unit_test(odd_clumps_are_warned_of),
        cmocka_unit_test(a_good_clump_is_not_warned_of),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
