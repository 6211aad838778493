/// Checkpoints: the whole state of a run in one file, DIR/checkpoint-STEP.dem, from which it continues bit for bit.
///
///   dem-checkpoint/1            the version of the container
///   HEADER STATE                bytes of the next two, 20 digits each
///   { ... }                     JSON: program, title, scene (sha256), time, step, what was written so far
///   ...                         the block of dem_world_save
///   0123...                     sha256 of everything before
#ifndef DEM_OUT_CHECKPOINT_H
#define DEM_OUT_CHECKPOINT_H

#include "base/json.h"

typedef struct dem_checkpoint {
    const char *title;  ///< of the scene; NULL: none
    char scene[65];     ///< sha256 of the resolved scene, in hexadecimal digits
    double time;        ///< [s]
    uint64_t step;
    uint64_t frames, rows;  ///< results written so far
    const void *state;
    size_t state_size;
    dem_buffer file;  ///< of one that was read: what `state` and `title` point into
    dem_json *header;
} dem_checkpoint;

/// Writes DIR/checkpoint-STEP.dem whole or not at all, then removes all but the newest older one of the same scene.
/// Errors: DEM_CANNOT_WRITE, DEM_NO_MEMORY.
dem_status dem_checkpoint_write(const char *directory, const dem_checkpoint *checkpoint, dem_error *error);

/// The name dem_checkpoint_write gives it; free it. NULL: out of memory.
char *dem_checkpoint_path(const char *directory, uint64_t step);

/// Reads a checkpoint; `scene` is the sha256 of the scene it must be of (NULL: any). Errors: DEM_BAD_INPUT for a file
/// that is cut short, altered, of another version or of another scene, DEM_NO_MEMORY.
dem_status dem_checkpoint_read(const char *path, const char *scene, dem_checkpoint *checkpoint, dem_error *error);

/// The same from memory, which becomes `file` of the checkpoint on success only.
dem_status dem_checkpoint_decode(dem_buffer *file, const char *name, const char *scene, dem_checkpoint *checkpoint,
                                 dem_error *error);

void dem_checkpoint_release(dem_checkpoint *checkpoint);

#endif
