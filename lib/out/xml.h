/// Pieces of SVG and XHTML: text, numbers, pictures inside of the file.
#ifndef DEM_OUT_XML_H
#define DEM_OUT_XML_H

#include "base/text.h"

/// Text for between tags or in quotes: what has a meaning there is escaped; what no XML file may hold (control
/// characters, broken UTF-8) becomes '?'.
void dem_xml_text(dem_buffer *out, const char *text);

/// A coordinate, to a hundredth.
void dem_xml_number(dem_buffer *out, double value);

/// ` name="value"` of a coordinate
void dem_xml_attribute(dem_buffer *out, const char *name, double value);

void dem_base64(dem_buffer *out, const void *bytes, size_t size);

#endif
