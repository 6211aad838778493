/// A contact sheet: small pictures of many grains with a caption each, on as many pages as needed.
#ifndef DEM_OUT_SHEET_H
#define DEM_OUT_SHEET_H

#include "out/png.h"

typedef struct dem_sheet dem_sheet;

/// `path` is that of the first page; the others are PATH-2.png and so on. NULL: no memory.
dem_sheet *dem_sheet_create(const char *path);

/// Adds a cell, taking its picture over; one without pixels is left blank. Full pages are written and given back.
/// Errors: DEM_CANNOT_WRITE, DEM_NO_MEMORY; the sheet can be gone on with.
dem_status dem_sheet_add(dem_sheet *sheet, dem_image *picture, const char *title, const char *note, dem_error *error);

/// Writes the last page and destroys the sheet. A sheet without cells writes nothing.
dem_status dem_sheet_finish(dem_sheet *sheet, dem_error *error);

#endif
