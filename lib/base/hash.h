/// SHA-256 by nettle.
#ifndef DEM_BASE_HASH_H
#define DEM_BASE_HASH_H

#include "base/file.h"

/// Writes 64 hexadecimal digits and a 0.
void dem_sha256(const void *bytes, size_t size, char text[65]);

/// The same of several pieces, one behind the other.
void dem_sha256_pieces(const dem_piece *pieces, size_t count, char text[65]);

/// The same of a file's content, without holding it.
dem_status dem_sha256_file(const char *path, char text[65], dem_error *error);

#endif
