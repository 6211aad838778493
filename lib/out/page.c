#include "out/page.h"

#include <ctype.h>
#include <math.h>
#include <string.h>

#include "out/scale.h"
#include "out/xml.h"

static const char style[] =
    "html { background: #fff; }\n"
    "body { max-width: 1140px; margin: 40px auto 60px; padding: 0 24px; color: #24272d; "
    "font: 15px/1.5 Helvetica, Arial, 'Liberation Sans', sans-serif; }\n"
    "h1 { font-size: 30px; line-height: 1.2; margin: 0; letter-spacing: -0.01em; color: #14161a; }\n"
    "p.subtitle { font-size: 17px; color: #646973; margin: 6px 0 28px; padding-bottom: 18px; "
    "border-bottom: 2px solid #14161a; max-width: none; }\n"
    "h2 { font-size: 19px; margin: 40px 0 10px; color: #14161a; }\n"
    "p, li { max-width: 820px; }\n"
    "ul { padding-left: 20px; }\n"
    "pre { background: #f4f5f7; padding: 10px 14px; overflow-x: auto; white-space: pre-wrap; "
    "font: 13px/1.5 'DejaVu Sans Mono', 'Liberation Mono', Menlo, Consolas, monospace; }\n"
    "table { border-collapse: collapse; font-size: 13px; line-height: 1.35; margin: 12px 0 8px; "
    "font-variant-numeric: tabular-nums; }\n"
    "caption { text-align: left; color: #646973; padding-bottom: 6px; }\n"
    "th { text-align: right; font-weight: bold; vertical-align: bottom; padding: 4px 9px; "
    "border-top: 1.5px solid #14161a; border-bottom: 1px solid #14161a; }\n"
    "td { text-align: right; padding: 3px 9px; white-space: nowrap; }\n"
    "th:first-child, td:first-child, td.text { text-align: left; }\n"
    "td.long { white-space: normal; min-width: 180px; }\n"
    "tr.group td { border-top: 1px solid #d4d7dd; }\n"
    "tbody > tr:last-child > td { border-bottom: 1.5px solid #14161a; }\n"
    "figure { margin: 12px 0; }\n"
    "figcaption { font-size: 13px; color: #646973; max-width: 820px; }\n"
    "svg { max-width: 100%; height: auto; display: block; }\n"
    "table.grid { width: 100%; table-layout: fixed; border: 0; margin: 0; }\n"
    "table.grid td { border: 0 !important; padding: 4px; text-align: center; vertical-align: top; white-space: normal; "
    "color: #4a4e57; }\n"
    "table.grid img { width: 100%; max-width: 420px; display: block; margin: 0 auto; }\n"
    "table.halves { width: 100%; border: 0; margin: 0; }\n"
    "table.halves > tbody > tr > td { border: 0 !important; padding: 0 28px 0 0; text-align: left; vertical-align: top; "
    "white-space: normal; font-size: 15px; }\n"
    "footer { margin-top: 44px; padding-top: 10px; border-top: 1px solid #d4d7dd; font-size: 12.5px; color: #646973; "
    "}\n"
    "@media print { body { margin: 0; max-width: none; padding: 0; font-size: 10.5pt; } "
    "figure, table.grid tr { page-break-inside: avoid; } h2 { page-break-after: avoid; } }\n";

static void put_element(dem_buffer *out, const char *tag, const char *text)
{
    dem_buffer_print(out, "<%s>", tag);
    dem_xml_text(out, text);
    dem_buffer_print(out, "</%.*s>\n", (int)strcspn(tag, " "), tag);
}

void dem_page_begin(dem_buffer *out, const char *title, const char *subtitle)
{
    dem_buffer_text(out, "<!DOCTYPE html>\n<html xmlns=\"http://www.w3.org/1999/xhtml\" lang=\"en\">\n<head>\n"
                         "<meta charset=\"utf-8\"/>\n"
                         "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>\n");
    put_element(out, "title", title);
    dem_buffer_text(out, "<style>\n");
    // of the sheet only '>' has a meaning in XML, and stands as it is
    dem_buffer_text(out, style);
    dem_buffer_text(out, "</style>\n</head>\n<body>\n");
    put_element(out, "h1", title);
    if (subtitle)
        put_element(out, "p class=\"subtitle\"", subtitle);
}

void dem_page_end(dem_buffer *out, const char *footer)
{
    if (footer)
        put_element(out, "footer", footer);
    dem_buffer_text(out, "</body>\n</html>\n");
}

void dem_page_heading(dem_buffer *out, const char *text)
{
    put_element(out, "h2", text);
}

void dem_page_paragraph(dem_buffer *out, const char *text)
{
    put_element(out, "p", text);
}

void dem_page_list_begin(dem_buffer *out)
{
    dem_buffer_text(out, "<ul>\n");
}

void dem_page_item(dem_buffer *out, const char *term, const char *text)
{
    dem_buffer_text(out, "<li>");
    if (term) {
        dem_buffer_text(out, "<b>");
        dem_xml_text(out, term);
        dem_buffer_text(out, ":</b> ");
    }
    dem_xml_text(out, text);
    dem_buffer_text(out, "</li>\n");
}

void dem_page_list_end(dem_buffer *out)
{
    dem_buffer_text(out, "</ul>\n");
}

void dem_page_command(dem_buffer *out, const char *text)
{
    put_element(out, "pre", text);
}

void dem_page_table_begin(dem_buffer *out, const char *caption, const char *const *heads, size_t count)
{
    dem_buffer_text(out, "<table>\n");
    if (caption)
        put_element(out, "caption", caption);
    if (count)
        dem_buffer_text(out, "<thead><tr>");
    for (size_t i = 0; i < count; i++)
        put_element(out, "th", heads[i]);
    dem_buffer_text(out, count ? "</tr></thead>\n<tbody>\n" : "<tbody>\n");
}

void dem_page_row_begin(dem_buffer *out, bool first_of_group)
{
    dem_buffer_text(out, first_of_group ? "<tr class=\"group\">" : "<tr>");
}

void dem_page_cell(dem_buffer *out, const char *text)
{
    bool number = isdigit((unsigned char)text[strspn(text, "+-")]) || strcmp(text, "–") == 0;
    put_element(out, number ? "td" : strlen(text) > 30 ? "td class=\"text long\"" : "td class=\"text\"", text);
}

void dem_page_number(dem_buffer *out, double value, int digits)
{
    char text[40] = "–";
    if (isfinite(value) && (value == 0 || fabs(value) >= 1e-3))
        dem_format_double(text, sizeof text, value, digits);
    else if (isfinite(value)) {
        int power = (int)floor(log10(fabs(value)) + 1e-9);
        char digits_text[24];
        dem_tick_label(copysign(pow(10, power), value), text, sizeof text);
        dem_format_double(digits_text, sizeof digits_text, value / pow(10, power), digits);
        dem_buffer_print(out, "<td>%s·%s</td>\n", digits_text, *text == '-' ? text + 1 : text);
        return;
    }
    put_element(out, "td", text);
}

void dem_page_row_end(dem_buffer *out)
{
    dem_buffer_text(out, "</tr>\n");
}

void dem_page_table_end(dem_buffer *out)
{
    dem_buffer_text(out, "</tbody>\n</table>\n");
}

void dem_page_figure_begin(dem_buffer *out)
{
    dem_buffer_text(out, "<figure>\n");
}

void dem_page_figure_end(dem_buffer *out, const char *caption)
{
    if (caption)
        put_element(out, "figcaption", caption);
    dem_buffer_text(out, "</figure>\n");
}

void dem_page_grid_begin(dem_buffer *out, size_t columns)
{
    dem_buffer_text(out, "<table class=\"grid\"><colgroup>");
    for (size_t i = 0; i < columns; i++)
        dem_buffer_text(out, "<col/>");
    dem_buffer_text(out, "</colgroup><tbody>\n");
}

void dem_page_picture(dem_buffer *out, const dem_buffer *png, const char *caption)
{
    dem_buffer_text(out, "<td>");
    if (png && png->size) {
        dem_buffer_text(out, "<img alt=\"");
        dem_xml_text(out, caption);
        dem_buffer_text(out, "\" src=\"data:image/png;base64,");
        dem_base64(out, png->data, png->size);
        dem_buffer_text(out, "\"/>");
    }
    dem_xml_text(out, caption);
    dem_buffer_text(out, "</td>\n");
}

void dem_page_grid_end(dem_buffer *out)
{
    dem_buffer_text(out, "</tbody></table>\n");
}

void dem_page_halves_begin(dem_buffer *out)
{
    dem_buffer_text(out, "<table class=\"halves\"><tbody><tr><td>\n");
}

void dem_page_halves_next(dem_buffer *out)
{
    dem_buffer_text(out, "</td><td>\n");
}

void dem_page_halves_end(dem_buffer *out)
{
    dem_buffer_text(out, "</td></tr></tbody></table>\n");
}
