/// Frames of a run, for ParaView and for our own viewer:
///
///   run.pvd             all frames with their times; open this one
///   frames/NNNNNN.vtp   a point per clump: position, orientation (w, x, y, z), scale, template, id, velocity, ...
///   shapes/NAME.vtp     a template's surface in the frame that `orientation` turns, to be used as a glyph
///   walls.pvd           the walls with their times: walls_static.vtp and, where some move, walls/NNNNNN.vtp; the cell
///                       array `wall` counts as in the scene; walls that wear have `wear_volume` and `wear_depth`
///
/// Every file appears whole or not at all.
#ifndef DEM_OUT_FRAMES_H
#define DEM_OUT_FRAMES_H

#include "base/file_queue.h"
#include "dem/scene.h"
#include "dem/world.h"

/// Field data of a frame: shifts of servo walls beside their motion, 3 a wall [m].
#define DEM_WALL_SHIFTS "wall_shifts"

/// What frames are made of; borrowed until dem_frames_close.
typedef struct dem_frames_def {
    const char *directory;
    const dem_shape_def *shapes;     ///< their names are used
    const dem_clump *const *clumps;  ///< of the shapes, as the world runs them
    size_t shape_count;
    const dem_wall_def *walls;
    size_t wall_count;
    dem_domain_def domain;  ///< walls without an end are cut there
    dem_file_queue *queue;  ///< writes the frames behind the caller's back; NULL: at once
    double resume;          ///< [s]: frames up to this time stay; NAN: a new run, no earlier frame stays
} dem_frames_def;

typedef struct dem_frames dem_frames;

/// Makes the folders, writes the shapes and removes frames behind the time to resume from.
/// Errors: DEM_CANNOT_WRITE, DEM_NO_MEMORY; DEM_BAD_INPUT for an index to go on with that is none of ours.
dem_status dem_frames_open(const dem_frames_def *def, dem_frames **frames, dem_error *error);

/// Writes the next frame. `walls` may be NULL: as at time 0. A frame that is due at the time of a checkpoint must be
/// written before it. Errors: DEM_CANNOT_WRITE, DEM_NO_MEMORY.
dem_status dem_frames_write(dem_frames *frames, double time, const dem_body_view *bodies, const dem_wall_view *walls,
                            dem_error *error);

/// How many there are, with those that stayed.
size_t dem_frames_count(const dem_frames *frames);

void dem_frames_close(dem_frames *frames);

#endif
