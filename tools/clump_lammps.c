// LAMMPS: bodies get the mass and inertia of a molecule file only where `fix deposit` or `fix pour` makes them, which
// turn them at random and at rest. So a first run tells how the body of this seed lies; then it is made again for each
// motion and set turning by forces on its atoms for one step: they add up to nothing but a moment about the axis.
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "clump_engine.h"
#include "math/quat.h"
#include "math/solve.h"

static const double FLAT = 1e-6;  // of the size: spheres this near to a line cannot be turned about it

static void put_setup(dem_buffer *deck, const engine_question *q, double speed)
{
    double reach = engine_reach(q);
    dem_buffer_text(deck, "units si\natom_style hybrid sphere molecular\natom_modify map array sort 0 0\nnewton off\n"
                          "boundary f f f\nregion box block");
    for (int i = 0; i < 6; i++) {
        dem_buffer_text(deck, " ");
        dem_buffer_number(deck, (i % 2 ? 40 : -40) * reach, 17);
    }
    dem_buffer_text(deck, "\ncreate_box 1 box\nmass 1 1.0\ncomm_modify vel yes cutoff ");
    dem_buffer_number(deck, 4 * reach, 17);
    dem_buffer_text(deck, "\nneighbor ");
    dem_buffer_number(deck, reach, 17);
    dem_buffer_text(deck, " bin\nneigh_modify exclude molecule/intra all\npair_style none\nmolecule clump clump.mol\n"
                          "fix body all rigid/small molecule mol clump reinit no\nregion drop block");
    for (int i = 0; i < 6; i++) {
        dem_buffer_text(deck, " ");
        dem_buffer_number(deck, (i % 2 ? 10 : -10) * reach, 17);
    }
    dem_buffer_text(deck, "\nfix drop all deposit 1 0 1 12345 region drop mol clump rigid body vx ");
    dem_buffer_number(deck, speed, 17);
    dem_buffer_text(deck, " ");
    dem_buffer_number(deck, speed, 17);
    dem_buffer_text(deck, "\ncompute kt all ke/rigid body\ncompute kr all erotate/rigid body\ntimestep " ENGINE_STEP
                          "\nthermo 1\nthermo_style custom step atoms c_kt c_kr\n"
                          "thermo_modify lost error norm no format float %.17g\nrun 1\n");
}

static void put_dump(dem_buffer *deck, const char *file)
{
    dem_buffer_print(deck, "dump d all custom 1 %s id x y z vx vy vz\n", file);
    dem_buffer_text(deck, "dump_modify d format float %.17g sort id\n");
}

// ---- how the body lies

// the three spheres that span the largest triangle found from the farthest one; false: all are on a line
static bool span(const dem_ball *balls, size_t count, size_t corner[3])
{
    double best = 0, size = 0;
    corner[0] = corner[1] = corner[2] = 0;
    for (size_t i = 0; i < count; i++)
        if (v3_distance(balls[i].centre, balls[0].centre) > size) {
            size = v3_distance(balls[i].centre, balls[0].centre);
            corner[1] = i;
        }
    dem_vec3 side = v3_sub(balls[corner[1]].centre, balls[0].centre);
    for (size_t i = 0; i < count; i++) {
        double area = v3_norm(v3_cross(side, v3_sub(balls[i].centre, balls[0].centre)));
        if (area > best) {
            best = area;
            corner[2] = i;
        }
    }
    return best > FLAT * size * size;
}

// right-handed axes given by three points
static void set_axes(dem_vec3 a, dem_vec3 b, dem_vec3 c, dem_vec3 axes[3])
{
    axes[0] = v3_unit(v3_sub(b, a));
    axes[2] = v3_unit(v3_cross(axes[0], v3_sub(c, a)));
    axes[1] = v3_cross(axes[2], axes[0]);
}

// where the principal axis is in space
static dem_vec3 axis_in_space(const engine_question *q, const dem_vec3 *at, const size_t c[3], int axis)
{
    dem_vec3 own[3], space[3], v = {0, 0, 0};
    const dem_ball *b = q->def.balls;
    set_axes(b[c[0]].centre, b[c[1]].centre, b[c[2]].centre, own);
    set_axes(at[c[0]], at[c[1]], at[c[2]], space);
    for (int k = 0; k < 3; k++)
        v = v3_along(v, v3_get(own[k], axis), space[k]);
    return v;
}

static dem_vec3 middle(const dem_vec3 *points, size_t count)
{
    dem_vec3 sum = {0, 0, 0};
    for (size_t i = 0; i < count; i++)
        sum = v3_add(sum, points[i]);
    return v3_scale(sum, 1 / (double)count);
}

// b with sum_i d_i x (b x d_i) = moment, d_i from the middle of the points
static dem_vec3 swirl(const dem_vec3 *at, size_t count, dem_vec3 moment)
{
    double rows[3][4] = {{0, 0, 0, moment.x}, {0, 0, 0, moment.y}, {0, 0, 0, moment.z}}, trace = 0;
    dem_vec3 c = middle(at, count);
    for (size_t i = 0; i < count; i++) {
        dem_vec3 d = v3_sub(at[i], c);
        trace += v3_norm2(d);
        for (int k = 0; k < 3; k++)
            for (int l = 0; l < 3; l++)
                rows[k][l] -= v3_get(d, k) * v3_get(d, l);
    }
    for (int k = 0; k < 3; k++)
        rows[k][k] += trace;
    dem_solve(&rows[0][0], 4, 3, 0);
    return v3(rows[0][3], rows[1][3], rows[2][3]);
}

// ---- the two runs

static dem_status look(const engine_question *q, engine_answer *answer, engine_motion *rest, dem_error *error)
{
    static const char *const arguments[] = {"-in", "in.rest", "-log", "none", NULL};
    dem_buffer deck = {0}, printed = {0};
    put_setup(&deck, q, 0);
    put_dump(&deck, "rest.dump");
    dem_buffer_text(&deck, "run 0\n");
    DEM_TRY(engine_export(q, "lammps", "clump.mol", error));
    DEM_TRY(engine_write(q, "in.rest", &deck, error));
    dem_status status = engine_run(q, &engine_lammps, answer, arguments, &printed, error);
    dem_buffer_release(&printed);
    return status == DEM_OK ? engine_read_spheres(q, "rest.dump", rest, error) : status;
}

// the forces on the atoms b x d that turn the body about an axis
static void put_forces(dem_buffer *deck, const engine_question *q, const dem_vec3 *at, const size_t corner[3], int axis)
{
    static const char letters[] = "xyz";
    size_t n = q->def.ball_count;
    dem_vec3 c = middle(at, n);
    dem_vec3 b = swirl(at, n, v3_scale(axis_in_space(q, at, corner, axis), q->def.inertia[axis] / engine_step));
    for (int k = 0; k < 3; k++) {
        int y = (k + 1) % 3, z = (k + 2) % 3;
        dem_buffer_print(deck, "variable f%c atom \"(", letters[k]);
        dem_buffer_number(deck, v3_get(b, y), 17);
        dem_buffer_print(deck, ")*(%c-(", letters[z]);
        dem_buffer_number(deck, v3_get(c, z), 17);
        dem_buffer_text(deck, "))-(");
        dem_buffer_number(deck, v3_get(b, z), 17);
        dem_buffer_print(deck, ")*(%c-(", letters[y]);
        dem_buffer_number(deck, v3_get(c, y), 17);
        dem_buffer_text(deck, "))\"\n");
    }
    dem_buffer_text(deck, "fix turn all addforce v_fx v_fy v_fz\n");
}

static int ascending(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

// forces on spheres in a line cannot turn the body about every axis: there is only what LAMMPS says
static dem_status read_told(const engine_question *q, engine_answer *answer, dem_error *error)
{
    DEM_TRY(engine_read_row(q, "told.dump", answer->told, 3, error));
    qsort(answer->told, 3, sizeof *answer->told, ascending);
    return DEM_OK;
}

static dem_status move(const engine_question *q, engine_answer *answer, const engine_motion *rest, dem_error *error)
{
    static const char *const arguments[] = {"-in", "in.lammps", "-log", "none", NULL};
    dem_buffer deck = {0}, printed = {0};
    size_t n = q->def.ball_count, corner[3];
    bool turns = span(q->def.balls, n, corner);
    for (int motion = 0; motion < (turns ? ENGINE_MOTIONS : 1); motion++) {
        char file[32];
        snprintf(file, sizeof file, "motion%d.dump", motion);
        dem_buffer_text(&deck, motion ? "clear\n" : "");
        put_setup(&deck, q, motion ? 0 : engine_reach(q));
        if (motion)
            put_forces(&deck, q, rest->at, corner, motion - 1);
        put_dump(&deck, file);
        if (!turns)
            dem_buffer_text(&deck, "compute told all rigid/local body inertiax inertiay inertiaz\n"
                                   "dump told all local 1 told.dump c_told[*]\n"
                                   "dump_modify told format float %.17g\n");
        dem_buffer_print(&deck, "print \"" ENGINE_MARK " %d\"\nrun 1\nprint \"" ENGINE_END "\"\n", motion);
    }
    DEM_TRY(engine_write(q, "in.lammps", &deck, error));
    dem_status status = engine_run(q, &engine_lammps, answer, arguments, &printed, error);
    for (int motion = 0; motion < ENGINE_MOTIONS; motion++)
        answer->motions[motion].rate = motion == 0 ? engine_reach(q) : turns ? 1 : NAN;
    if (status == DEM_OK)
        status = engine_read(q, &printed, answer, error);
    if (status == DEM_OK && !turns)
        status = read_told(q, answer, error);
    // how fast it came to turn is what its spheres do
    for (int motion = 1; status == DEM_OK && turns && motion < ENGINE_MOTIONS; motion++) {
        engine_motion *m = &answer->motions[motion];
        dem_vec3 c = middle(m->at, n), moment = {0, 0, 0};
        for (size_t i = 0; i < n; i++)
            moment = v3_add(moment, v3_cross(v3_sub(m->at[i], c), m->velocity[i]));
        m->rate = v3_norm(swirl(m->at, n, moment));
    }
    dem_buffer_release(&printed);
    return status;
}

static dem_status ask_lammps(const engine_question *q, engine_answer *answer, dem_error *error)
{
    engine_motion *rest = &answer->motions[1];  // its room, until the motion is known
    DEM_TRY(look(q, answer, rest, error));
    return move(q, answer, rest, error);
}

const engine engine_lammps = {
    .name = "lammps",
    .title = "LAMMPS",
    .package = "lammps",
    .programs = {"lmp", "lmp_serial", "lmp_mpi", NULL},
    .banner = "LAMMPS (",
    .ask = ask_lammps,
};
