/// Other simulation programs, asked how they move a clump exported to them.
#ifndef DEM_TOOLS_CLUMP_ENGINE_H
#define DEM_TOOLS_CLUMP_ENGINE_H

#include "dem/dem.h"

#include "base/text.h"

enum { ENGINE_MOTIONS = 4 };  ///< a translation, and a turn about each principal axis

/// A clump moving in a program.
typedef struct engine_motion {
    double translating, turning;  ///< kinetic energy the program reports [J]
    double rate;                  ///< [m/s], about the axes [rad/s]; NAN: this motion could not be had
    dem_vec3 *at, *velocity;      ///< of each sphere, in space [m, m/s]
} engine_motion;

typedef struct engine_answer {
    char program[256];  ///< that was run
    char version[64];
    double seconds;
    engine_motion motions[ENGINE_MOTIONS];
    double told[3];  ///< moments it says it uses, for turns that could not be had [kg m^2]; NAN: unknown
} engine_answer;

typedef struct engine_question {
    const dem_ctx *ctx;
    const dem_clump *clump;
    dem_clump_def def;   ///< the view of it
    const char *folder;  ///< where the program runs, empty
    double wall;         ///< time limit of a run [s]
} engine_question;

typedef struct engine {
    const char *name, *title, *package;
    const char *programs[4];  ///< names it goes by, NULL behind the last
    const char *banner;       ///< what it prints before its version
    size_t least_spheres;
    /// Fills the motions, whose room is there. DEM_FAILED: the program failed, its last words are in the error.
    dem_status (*ask)(const engine_question *question, engine_answer *answer, dem_error *error);
} engine;

extern const engine engine_lammps, engine_liggghts, engine_yade;

/// Finds the program in the absolute folders of PATH (it runs in another folder); false: it is not there.
bool engine_find(const engine *e, char path[256]);

/// How long the clump moves, at a speed of its size in a second or a rate of 1 rad/s: nothing depends on where it is.
#define ENGINE_STEP "1e-6"
static const double engine_step = 1e-6;  ///< [s]
/// The radius of the clump about its centre of mass [m], as a speed [m/s] that of its translation.
double engine_reach(const engine_question *question);

/// Writes the clump for this program to the folder.
dem_status engine_export(const engine_question *question, const char *format, const char *file, dem_error *error);
/// Writes a deck there and releases it.
dem_status engine_write(const engine_question *question, const char *file, dem_buffer *deck, dem_error *error);

/// Runs the program there with these arguments (NULL behind the last) and gathers what it prints; also sets the
/// version. `printed` is to be released in any case.
dem_status engine_run(const engine_question *question, const engine *e, engine_answer *answer,
                      const char *const *arguments, dem_buffer *printed, dem_error *error);

/// Lines the decks have printed before and behind a motion; the last line `step spheres translating turning` between
/// them tells its energies.
#define ENGINE_MARK "motion of the clump, number"
#define ENGINE_END "end of the motion"
/// The energies of each motion whose rate is known from what was printed, the spheres from the dumps `id x y z vx vy
/// vz` in the files motion0.dump to motion3.dump.
dem_status engine_read(const engine_question *question, const dem_buffer *printed, engine_answer *answer,
                       dem_error *error);
/// Runs the program and reads all motions, at the rates of engine_reach: for programs that can be given every motion.
dem_status engine_move(const engine_question *question, const engine *e, engine_answer *answer,
                       const char *const *arguments, dem_error *error);
/// The spheres of one dump.
dem_status engine_read_spheres(const engine_question *question, const char *file, engine_motion *motion,
                               dem_error *error);
/// The numbers in the first row of the last table of a dump.
dem_status engine_read_row(const engine_question *question, const char *file, double *numbers, int count,
                           dem_error *error);

#endif
