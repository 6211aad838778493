/// Files: read whole, written whole or not at all.
#ifndef DEM_BASE_FILE_H
#define DEM_BASE_FILE_H

#include "base/status.h"
#include "base/text.h"

/// Reads a whole file; "-" is standard input. `bytes` is released with dem_buffer_release; its data always end
/// in a 0 behind the last byte. Errors: DEM_BAD_INPUT for what is missing, a directory, unreadable or empty.
dem_status dem_file_read(const char *path, dem_buffer *bytes, dem_error *error);

/// Writes beside and renames, so `path` holds all of it or what it held before; "-" is standard output.
/// A path that is no regular file (a pipe, /dev/stdout) is written directly. Error: DEM_CANNOT_WRITE.
dem_status dem_file_write(const char *path, const void *bytes, size_t size, dem_error *error);

/// The same of several pieces, one behind the other.
typedef struct dem_piece {
    const void *bytes;
    size_t size;
} dem_piece;
dem_status dem_file_write_pieces(const char *path, const dem_piece *pieces, size_t count, dem_error *error);

/// The same little by little, where the whole would take much memory. After a failed put: whole = false, and the end
/// leaves what was there. Every begun file is to be ended.
typedef struct dem_file_making {
    const char *path;
    char *beside;  ///< name until it is whole; NULL: written directly
    int file;
    bool whole;  ///< as far as it has come; false: is to be given up
} dem_file_making;
dem_status dem_file_begin(const char *path, dem_file_making *f, dem_error *error);
dem_status dem_file_put(dem_file_making *f, const dem_piece *pieces, size_t count, dem_error *error);
dem_status dem_file_end(dem_file_making *f, dem_error *error);

/// Writes and releases a buffer; a buffer that has failed is DEM_NO_MEMORY.
dem_status dem_file_write_buffer(const char *path, dem_buffer *buffer, dem_error *error);

/// Makes a folder, and those it lies in. Error: DEM_CANNOT_WRITE.
dem_status dem_folder_create(const char *path, dem_error *error);

/// Whether there is such a folder; links are followed.
bool dem_folder_exists(const char *path);

/// Whether a path means a folder: one that is there, or a name that ends in /.
bool dem_folder_is_meant(const char *path);

/// The path of a file in a folder, printed as by printf; free it. NULL: out of memory.
char *dem_path_join(const char *folder, const char *format, ...) DEM_PRINTF(2, 3);

/// The part of a path behind the last '/'.
const char *dem_file_name(const char *path);

/// True where `path` ends in '.' and `suffix`, in any case.
bool dem_file_has_suffix(const char *path, const char *suffix);

#endif
