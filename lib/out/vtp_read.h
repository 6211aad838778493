/// Reads VTP files back, as out/vtp.c writes them and no others: what is read and written again is the same bytes.
#ifndef DEM_OUT_VTP_READ_H
#define DEM_OUT_VTP_READ_H

#include "base/memory.h"
#include "out/vtp.h"

/// What a file holds, and the memory it lies in. Zero-initialised it can be released.
typedef struct dem_vtp_file {
    dem_vtp vtp;
    dem_arena arena;
} dem_vtp_file;

/// From the bytes of a file, which are not kept. `name` is for messages. Errors: DEM_BAD_INPUT for what is none of ours
/// or cut short, DEM_NO_MEMORY. To be released only on success.
dem_status dem_vtp_decode(const char *bytes, size_t size, const char *name, dem_vtp_file *file, dem_error *error);
dem_status dem_vtp_read(const char *path, dem_vtp_file *file, dem_error *error);
void dem_vtp_file_release(dem_vtp_file *file);

/// The point array of a name; NULL: there is none.
const dem_vtp_array *dem_vtp_find(const dem_vtp *vtp, const char *name);

/// The numbers of the cell array of a name, a type and a width; NULL: there is none.
const void *dem_vtp_cells(const dem_vtp *vtp, const char *name, dem_vtp_type type, int width);

/// A number of an array, by point and component.
double dem_vtp_value(const dem_vtp_array *array, size_t point, int component);

#endif
