#include "out/export_text.h"

#include <ctype.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "base/file.h"

void dem_export_put_row(dem_buffer *out, const double *values, size_t count, const char *between)
{
    for (size_t i = 0; i < count; i++) {
        dem_buffer_number(out, values[i], 17);
        dem_buffer_text(out, i + 1 < count ? between : "\n");
    }
}

void dem_export_put_ball(dem_buffer *out, dem_ball ball, const char *between)
{
    dem_export_put_row(out, (double[]){ball.centre.x, ball.centre.y, ball.centre.z, ball.radius}, 4, between);
}

void dem_export_put_comment(dem_buffer *out, const char *mark, const char *format, ...)
{
    char text[1024];
    va_list args;
    va_start(args, format);
    vsnprintf(text, sizeof text, format, args);
    va_end(args);
    dem_buffer_print(out, "%s%s\n", mark, text);
}

void dem_export_put_figures(dem_buffer *out, const char *mark, const char *what, const double *values, size_t count)
{
    dem_buffer_print(out, "%s%s: ", mark, what);
    dem_export_put_row(out, values, count, " ");
}

void dem_export_put_mass(dem_buffer *out, const char *mark, const dem_clump_def *clump, dem_vec3 centre)
{
    dem_vec3 p = clump->position;
    dem_quat q = clump->orientation;
    dem_export_put_figures(out, mark, "density [kg/m^3]", &clump->density, 1);
    dem_export_put_figures(out, mark, "mass [kg]", &clump->mass, 1);
    dem_export_put_figures(out, mark, "centre of mass [m]", (double[]){centre.x, centre.y, centre.z}, 3);
    dem_export_put_figures(out, mark, "principal moments of inertia [kg m^2]", clump->inertia, 3);
    dem_export_put_figures(out, mark, "principal to mesh frame, position [m]", (double[]){p.x, p.y, p.z}, 3);
    dem_export_put_figures(out, mark, "principal to mesh frame, quaternion w x y z", (double[]){q.w, q.x, q.y, q.z}, 4);
}

// what a program that weighs the spheres itself would find at best
static void put_union(dem_buffer *out, const char *mark, const dem_clump_def *clump)
{
    if (isnan(clump->union_volume) || isnan(clump->union_inertia[0]) || isnan(clump->union_centre.x))
        return;
    dem_vec3 c = clump->union_centre;
    double mass = clump->union_volume * clump->density;
    dem_export_put_comment(out, mark, "the union of the spheres has, at that density,");
    dem_export_put_figures(out, mark, "  mass [kg]", &mass, 1);
    dem_export_put_figures(out, mark, "  centre [m]", (double[]){c.x, c.y, c.z}, 3);
    dem_export_put_figures(out, mark, "  principal moments of inertia [kg m^2]", clump->union_inertia, 3);
}

// a line with the names in it
static void put_use(dem_buffer *out, const char *mark, const char *line, const char *file, const char *name)
{
    dem_buffer_text(out, mark);
    while (*line) {
        bool is_file = strncmp(line, "FILE", 4) == 0, is_name = strncmp(line, "NAME", 4) == 0;
        if (is_file || is_name)
            dem_buffer_text(out, is_file ? file : name);
        else
            dem_buffer_bytes(out, line, 1);
        line += is_file || is_name ? 4 : 1;
    }
    dem_buffer_text(out, "\n");
}

void dem_export_put_head(dem_buffer *out, const dem_export_head *head, const dem_clump_def *clump,
                         const dem_export_options *options)
{
    const char *mark = head->mark;
    dem_plain_name name = dem_name_plain(clump->name, "grain", NULL, 0), id = dem_export_identifier(clump);
    dem_plain_name file = dem_export_file_name(clump, options, head->suffix);
    dem_export_put_comment(out, mark, "%s: %zu spheres of dem-clump " DEM_VERSION, name.text, clump->ball_count);
    dem_export_put_comment(out, mark, "%s", head->what);
    for (const char *const *use = head->use; *use; use++)
        put_use(out, mark, *use, file.text, id.text);
    dem_export_put_comment(out, mark, "frame: principal, centre of mass at 0, axes I1 <= I2 <= I3; SI units (m, kg)");
    dem_export_put_mass(out, mark, clump, (dem_vec3){0, 0, 0});
    put_union(out, mark, clump);
}

dem_plain_name dem_export_identifier(const dem_clump_def *clump)
{
    dem_plain_name plain = dem_name_plain(clump->name, "grain", NULL, 0), name;
    bool letter = isalpha((unsigned char)plain.text[0]) != 0;
    snprintf(name.text, sizeof name.text, "%s%.60s", letter ? "" : "grain_", plain.text);
    for (char *p = name.text; *p; p++)
        if (!isalnum((unsigned char)*p))
            *p = '_';
    return name;
}

dem_plain_name dem_export_file_name(const dem_clump_def *clump, const dem_export_options *options, const char *suffix)
{
    if (options->file)
        return dem_name_plain(dem_file_name(options->file), "grain", NULL, 0);
    dem_plain_name name = dem_name_plain(clump->name, "grain", NULL, 0);
    size_t length = strlen(name.text);
    snprintf(name.text + length, sizeof name.text - length, ".%s", suffix);
    return name;
}

double dem_export_reach(const dem_clump_def *clump)
{
    double reach = 0;
    for (size_t i = 0; i < clump->ball_count; i++)
        reach = fmax(reach, v3_norm(clump->balls[i].centre) + clump->balls[i].radius);
    return reach;
}
