/// VTK XML PolyData files (.vtp) with raw appended data: what ParaView opens without a plug-in.
#ifndef DEM_OUT_VTP_H
#define DEM_OUT_VTP_H

#include "base/file_queue.h"
#include "dem/base.h"

typedef enum dem_vtp_type {
    DEM_VTP_FLOAT64,
    DEM_VTP_FLOAT32,
    DEM_VTP_INT32,
    DEM_VTP_UINT32,
    DEM_VTP_INT64
} dem_vtp_type;
enum { DEM_VTP_TYPES = DEM_VTP_INT64 + 1 };

/// What VTK calls a type, and the size of a number.
typedef struct dem_vtp_kind {
    const char *name;
    size_t bytes;
} dem_vtp_kind;
extern const dem_vtp_kind dem_vtp_kinds[DEM_VTP_TYPES];

/// A named array of `width` numbers per point or cell; of field data: `width` numbers in all. Names are plain words.
typedef struct dem_vtp_array {
    const char *name;
    dem_vtp_type type;
    int width;
    const void *data;
} dem_vtp_array;

/// What a file holds; everything is borrowed, and what is zero is left out. Cells count in the order vertices, lines,
/// triangles.
typedef struct dem_vtp {
    double time;  ///< [s]; NAN: none. ParaView shows it as the time of the data
    const dem_vtp_array *fields;
    size_t field_count;
    const dem_vec3 *points;  ///< [m]
    size_t point_count;
    const dem_vtp_array *point_arrays;
    size_t point_array_count;
    const char *scalars;    ///< the point array shown at first; NULL: none
    bool vertices;          ///< every point is a cell of its own, so that filters of cells find them
    const uint32_t *lines;  ///< [2 * line_count] points
    size_t line_count;
    const uint32_t *triangles;  ///< [3 * triangle_count] points
    size_t triangle_count;
    const dem_vtp_array *cell_arrays;
    size_t cell_array_count;
} dem_vtp;

/// Appends the file.
void dem_vtp_put(dem_buffer *out, const dem_vtp *vtp);

/// Writes the file whole or not at all, behind the caller's back where there is a queue (NULL: at once).
/// Errors: DEM_CANNOT_WRITE, DEM_NO_MEMORY.
dem_status dem_vtp_queue(dem_file_queue *queue, const char *path, const dem_vtp *vtp, dem_error *error);
dem_status dem_vtp_write(const char *path, const dem_vtp *vtp, dem_error *error);

#endif
