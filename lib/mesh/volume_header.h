/// What the headers of the volume formats say, and how their lines are read.
#ifndef DEM_MESH_VOLUME_HEADER_H
#define DEM_MESH_VOLUME_HEADER_H

#include "mesh/reader.h"
#include "mesh/volume.h"

enum { VOLUME_AXES = 16, VOLUME_LINE = 2048 };

typedef enum dem_volume_coding { DEM_CODING_RAW, DEM_CODING_GZIP, DEM_CODING_TEXT } dem_volume_coding;

typedef struct dem_volume_header {
    dem_volume volume;  ///< without labels
    dem_voxel_type type;
    dem_volume_coding coding;
    bool big_endian;
    char file[VOLUME_LINE];  ///< of the data, beside the header; "": behind the header
    size_t data;             ///< where the data begin, or after reading a data file 0
    int64_t skip;            ///< bytes to pass over, -1: the data are at the end
    size_t skip_lines;
    bool exact;  ///< the data end where the file does
} dem_volume_header;

/// Each reads the header at the start of the bytes.
dem_status dem_nrrd_header(const dem_ctx *ctx, const char *name, const char *bytes, size_t size,
                           dem_volume_header *header, dem_error *error);
dem_status dem_meta_header(const dem_ctx *ctx, const char *name, const char *bytes, size_t size,
                           dem_volume_header *header, dem_error *error);

/// Splits a line "key SEPARATOR value" in place: blanks around both go. False where there is no separator.
bool dem_header_split(char *line, const char *separator, char **key, char **value);
/// The rest of the reader's line as a text, cut to VOLUME_LINE - 1 bytes.
void dem_header_line(const dem_reader *r, char line[VOLUME_LINE]);
/// Numbers apart by blanks, commas and brackets; returns how many, at most `room`; -1: something else is among them.
int dem_header_numbers(const char *text, double *numbers, int room);

/// Takes the sizes; fails where there are not three of a sensible kind.
dem_status dem_header_sizes(const dem_reader *r, const double *sizes, dem_volume_header *header);
/// Fails where a voxel has no volume.
dem_status dem_header_check(const dem_reader *r, const dem_volume_header *header);

#endif
