#include "out/xml.h"

#include <math.h>
#include <string.h>

// bytes of the UTF-8 character at `text`, 0: none that XML allows (RFC 3629; XML 1.0, 2.2)
static size_t character(const unsigned char *text)
{
    if (text[0] < 0x80)
        return text[0] >= ' ' || text[0] == '\n' || text[0] == '\t' ? 1 : 0;
    size_t bytes = text[0] >= 0xf0 ? 4 : text[0] >= 0xe0 ? 3 : 2;
    if (text[0] < 0xc2 || text[0] > 0xf4)
        return 0;
    uint32_t code = text[0] & (0x7fu >> bytes);
    for (size_t k = 1; k < bytes; k++) {
        if ((text[k] & 0xc0) != 0x80)
            return 0;
        code = code << 6 | (text[k] & 0x3f);
    }
    bool overlong = (bytes == 3 && code < 0x800) || (bytes == 4 && code < 0x10000);
    bool forbidden = (code >= 0xd800 && code < 0xe000) || code > 0x10ffff || (code & 0xfffe) == 0xfffe;
    return overlong || forbidden ? 0 : bytes;
}

void dem_xml_text(dem_buffer *out, const char *text)
{
    while (*text) {
        size_t bytes = character((const unsigned char *)text);
        switch (*text) {
        case '&':
            dem_buffer_text(out, "&amp;");
            break;
        case '<':
            dem_buffer_text(out, "&lt;");
            break;
        case '>':
            dem_buffer_text(out, "&gt;");
            break;
        case '"':
            dem_buffer_text(out, "&quot;");
            break;
        default:
            dem_buffer_bytes(out, bytes ? text : "?", bytes ? bytes : 1);
        }
        text += bytes ? bytes : 1;
    }
}

void dem_xml_number(dem_buffer *out, double value)
{
    dem_buffer_number(out, round(value * 100) / 100 + 0.0, 10);
}

void dem_xml_attribute(dem_buffer *out, const char *name, double value)
{
    dem_buffer_print(out, " %s=\"", name);
    dem_xml_number(out, value);
    dem_buffer_text(out, "\"");
}

void dem_base64(dem_buffer *out, const void *bytes, size_t size)
{
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    const unsigned char *at = bytes;
    for (size_t i = 0; i < size; i += 3) {
        size_t left = size - i;
        uint32_t three = (uint32_t)at[i] << 16 | (left > 1 ? (uint32_t)at[i + 1] << 8 : 0) | (left > 2 ? at[i + 2] : 0);
        char four[4] = {digits[three >> 18], digits[three >> 12 & 63], left > 1 ? digits[three >> 6 & 63] : '=',
                        left > 2 ? digits[three & 63] : '='};
        dem_buffer_bytes(out, four, 4);
    }
}
