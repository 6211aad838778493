// LIGGGHTS: the clump is inserted moving, as its template says; then one step.
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "clump_engine.h"
#include "out/export_text.h"

static void put_setup(dem_buffer *deck, const engine_question *q)
{
    double reach = engine_reach(q);
    dem_buffer_text(deck, "atom_style granular\natom_modify map array\ncommunicate single vel yes\n"
                          "boundary f f f\nnewton off\nunits si\nprocessors 1 1 1\nregion box block");
    for (int i = 0; i < 6; i++) {
        dem_buffer_text(deck, " ");
        dem_buffer_number(deck, (i % 2 ? 40 : -40) * reach, 17);
    }
    dem_buffer_text(deck, " units box\ncreate_box 1 box\nneighbor ");
    dem_buffer_number(deck, reach, 17);
    dem_buffer_text(deck, " bin\nfix m1 all property/global youngsModulus peratomtype 5e6\n"
                          "fix m2 all property/global poissonsRatio peratomtype 0.3\n"
                          "fix m3 all property/global coefficientRestitution peratomtypepair 1 0.5\n"
                          "fix m4 all property/global coefficientFriction peratomtypepair 1 0.5\n"
                          "pair_style gran model hertz tangential history\npair_coeff * *\ntimestep " ENGINE_STEP "\n");
}

// the commands of the exported file
static void put_template(dem_buffer *deck, const dem_buffer *file)
{
    for (const char *at = file->data; (at = strstr(at, "\n#: ")); at++)
        dem_buffer_bytes(deck, at + 4, strcspn(at + 4, "\n") + 1);
}

static void put_motion(dem_buffer *deck, const engine_question *q, int motion)
{
    double speed = motion == 0 ? engine_reach(q) : 0, reach = engine_reach(q);
    dem_plain_name id = dem_export_identifier(&q->def);
    dem_buffer_print(deck, "fix pdd all particledistribution/discrete 15485867 1 pts_%s 1.0\nregion in block", id.text);
    for (int i = 0; i < 6; i++) {
        dem_buffer_text(deck, " ");
        dem_buffer_number(deck, (i % 2 ? 10 : -10) * reach, 17);
    }
    dem_buffer_text(deck, " units box volume_limit ");
    dem_buffer_number(deck, reach * reach * reach, 3);
    dem_buffer_text(deck, "\nfix in all insert/pack seed 32452843 distributiontemplate pdd insert_every once "
                          "overlapcheck no orientation constant 1 0 0 0 vel constant ");
    dem_buffer_number(deck, speed, 17);
    dem_buffer_print(deck, " 0 0 omega constant %d %d %d particles_in_region 1 region in\n", motion == 1, motion == 2,
                     motion == 3);
    dem_buffer_text(deck,
                    "fix move all multisphere\ncompute kt all ke/multisphere\ncompute kr all erotate/multisphere\n"
                    "thermo_style custom step atoms c_kt c_kr\n"
                    "thermo_modify lost ignore norm no format float %.17g\nthermo 1\n");
    dem_buffer_print(deck, "dump d all custom 1 motion%d.dump id x y z vx vy vz\n", motion);
    dem_buffer_text(deck, "dump_modify d format \"%d %.17g %.17g %.17g %.17g %.17g %.17g\"\n");
    dem_buffer_print(deck, "print \"" ENGINE_MARK " %d\"\nrun 1\nprint \"" ENGINE_END "\"\n", motion);
}

static dem_status write_deck(const engine_question *q, dem_error *error)
{
    DEM_TRY(engine_export(q, "liggghts", "clump.liggghts", error));
    char *path = dem_path_join(q->folder, "clump.liggghts");
    if (!path)
        return dem_fail_memory(error);
    dem_buffer exported, deck = {0};
    dem_status status = dem_file_read(path, &exported, error);
    free(path);
    DEM_TRY(status);
    for (int motion = 0; motion < ENGINE_MOTIONS; motion++) {
        dem_buffer_text(&deck, motion ? "clear\n" : "");
        put_setup(&deck, q);
        put_template(&deck, &exported);
        put_motion(&deck, q, motion);
    }
    dem_buffer_release(&exported);
    return engine_write(q, "in.liggghts", &deck, error);
}

static dem_status ask_liggghts(const engine_question *q, engine_answer *answer, dem_error *error)
{
    static const char *const arguments[] = {"-in", "in.liggghts", "-log", "none", NULL};
    DEM_TRY(write_deck(q, error));
    return engine_move(q, &engine_liggghts, answer, arguments, error);
}

const engine engine_liggghts = {
    .name = "liggghts",
    .title = "LIGGGHTS",
    .package = "liggghts",
    .programs = {"liggghts", "liggghts3", NULL},
    .banner = "LIGGGHTS (Version LIGGGHTS-",
    .least_spheres = 2,
    .ask = ask_liggghts,
};
