/// Files written by a thread of its own, one after the other in the order they were given, so that a slow disk does not
/// hold up who makes them. Each appears whole or not at all.
#ifndef DEM_BASE_FILE_QUEUE_H
#define DEM_BASE_FILE_QUEUE_H

#include "base/file.h"

typedef struct dem_file_queue dem_file_queue;

/// Error: DEM_NO_MEMORY, also where there can be no thread.
dem_status dem_file_queue_create(dem_file_queue **queue, dem_error *error);

/// Takes the buffer over. Waits while more than DEM_QUEUE_BYTES are on their way. Without a queue (NULL) writes at
/// once. Errors: DEM_NO_MEMORY, and that of an earlier file that could not be written; nothing behind it is.
dem_status dem_file_queue_put(dem_file_queue *queue, const char *path, dem_buffer *buffer, dem_error *error);
enum { DEM_QUEUE_BYTES = 256 << 20 };

/// Returns when all are written. Error: of the first that could not be.
dem_status dem_file_queue_wait(dem_file_queue *queue, dem_error *error);

/// Waits, too. NULL: nothing.
void dem_file_queue_destroy(dem_file_queue *queue);

#endif
