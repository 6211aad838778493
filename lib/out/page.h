/// A report as one self-contained page: XHTML that any browser opens and prints, with nothing outside of the file.
///
/// Appended piece by piece, in order, between begin and end. Plain text is escaped.
#ifndef DEM_OUT_PAGE_H
#define DEM_OUT_PAGE_H

#include "base/text.h"

void dem_page_begin(dem_buffer *out, const char *title, const char *subtitle);
void dem_page_end(dem_buffer *out, const char *footer);

void dem_page_heading(dem_buffer *out, const char *text);
void dem_page_paragraph(dem_buffer *out, const char *text);
/// Opens and closes a list; items between.
void dem_page_list_begin(dem_buffer *out);
void dem_page_item(dem_buffer *out, const char *term, const char *text);  ///< `term` in bold; NULL: none
void dem_page_list_end(dem_buffer *out);
/// As typed at a prompt.
void dem_page_command(dem_buffer *out, const char *text);

/// A table, row by row. Cells that begin as a number does are set flush right.
void dem_page_table_begin(dem_buffer *out, const char *caption, const char *const *heads, size_t count);
void dem_page_row_begin(dem_buffer *out, bool first_of_group);
void dem_page_cell(dem_buffer *out, const char *text);
/// A number of so many digits, a tiny one with a power of ten; a dash where it is not finite.
void dem_page_number(dem_buffer *out, double value, int digits);
void dem_page_row_end(dem_buffer *out);
void dem_page_table_end(dem_buffer *out);

/// A picture that is SVG already; between: dem_plot_sheet_draw with `fragment`.
void dem_page_figure_begin(dem_buffer *out);
void dem_page_figure_end(dem_buffer *out, const char *caption);
/// Pictures beside each other; rows as those of a table, at most `columns` in each.
void dem_page_grid_begin(dem_buffer *out, size_t columns);
void dem_page_picture(dem_buffer *out, const dem_buffer *png, const char *caption);
void dem_page_grid_end(dem_buffer *out);

/// Two columns: what comes between begin and next stands at the left.
void dem_page_halves_begin(dem_buffer *out);
void dem_page_halves_next(dem_buffer *out);
void dem_page_halves_end(dem_buffer *out);

#endif
