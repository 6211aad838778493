#include "clump/import.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "base/memory.h"
#include "math/mat3.h"
#include "math/quat.h"
#include "mesh/reader.h"

extern const dem_importer dem_import_json, dem_import_kratos, dem_import_lammps, dem_import_deme, dem_import_xyzr,
    dem_import_liggghts;

// what tells itself from all others first
static const dem_importer *const importers[] = {
    &dem_import_json,
    &dem_import_kratos,
    &dem_import_lammps,
    &dem_import_deme,
    &dem_import_xyzr,
    &dem_import_liggghts,
    NULL,
};

const dem_importer *const *dem_importers(void)
{
    return importers;
}

const dem_importer *dem_importer_find(const char *name)
{
    for (int i = 0; importers[i]; i++)
        if (strcmp(importers[i]->name, name) == 0)
            return importers[i];
    return NULL;
}

static bool has_suffix_of(const char *file, const dem_importer *importer)
{
    char suffix[16];
    for (const char *at = importer->suffixes; *at;) {
        size_t length = strcspn(at, " ");
        DEM_ASSERT(length < sizeof suffix);
        memcpy(suffix, at, length);
        suffix[length] = 0;
        if (dem_file_has_suffix(file, suffix))
            return true;
        at += length + (at[length] == ' ');
    }
    return false;
}

const dem_importer *dem_importer_of(const char *name, const char *text, size_t size)
{
    const dem_importer *first = NULL;
    for (int i = 0; importers[i]; i++) {
        if (!importers[i]->recognise(text, size))
            continue;
        if (has_suffix_of(name, importers[i]))
            return importers[i];
        first = first ? first : importers[i];
    }
    for (int i = 0; importers[i] && !first; i++)  // a damaged file: its reader says where
        if (has_suffix_of(name, importers[i]))
            first = importers[i];
    return first;
}

static dem_status refuse_unknown(const char *file, dem_error *error)
{
    char known[128] = "";
    for (int i = 0; importers[i]; i++)
        snprintf(known + strlen(known), sizeof known - strlen(known), " %s", importers[i]->name);
    return dem_fail_at(error, DEM_BAD_INPUT, file, 1,
                       "is not a clump file of a kind that is known; if it is one, name it with --from, one of:%s",
                       known);
}

dem_status dem_import_decode(const dem_ctx *ctx, const char *file, const char *folder, const char *text, size_t size,
                             const dem_importer *importer, dem_import *import, const dem_importer **used,
                             dem_error *error)
{
    *import = (dem_import){.file = file,
                           .folder = folder,
                           .ctx = ctx,
                           .density = NAN,
                           .mass = NAN,
                           .volume = NAN,
                           .centre = {NAN, NAN, NAN},
                           .inertia = {NAN, NAN, NAN},
                           .axes = {1, 0, 0, 0},
                           .orientation = {1, 0, 0, 0}};
    const char *zero = memchr(text, 0, size);
    if (zero) {
        long line = 1;
        for (const char *p = text; p < zero; p++)
            line += *p == '\n';
        return dem_fail_at(error, DEM_BAD_INPUT, file, line, "is a binary file; clumps are read from text files");
    }
    if (!importer)
        importer = dem_importer_of(file, text, size);
    if (!importer)
        return refuse_unknown(file, error);
    if (used)
        *used = importer;
    import->format = importer->name;
    DEM_TRY(importer->read(import, text, size, error));
    if (import->count == 0)
        return dem_fail_at(error, DEM_BAD_INPUT, file, 0, "has no spheres; write one x y z r a line");
    return DEM_OK;
}

dem_status dem_import_read(const dem_ctx *ctx, const char *path, const dem_importer *importer, dem_import *import,
                           const dem_importer **used, dem_error *error)
{
    *import = (dem_import){0};
    dem_buffer text;
    DEM_TRY(dem_file_read(path, &text, error));
    bool piped = strcmp(path, "-") == 0;
    char *folder = strdup(piped ? "." : path);
    char *slash = folder && !piped ? strrchr(folder, '/') : NULL;
    if (slash)
        slash[slash == folder] = 0;
    dem_status status = !folder ? dem_fail_memory(error)
                                : dem_import_decode(ctx, piped ? "standard input" : path, piped || slash ? folder : ".",
                                                    text.data, text.size, importer, import, used, error);
    if (status == DEM_OK)
        import->folder = NULL;  // it lives no longer
    free(folder);
    dem_buffer_release(&text);
    return status;
}

void dem_import_release(dem_import *import)
{
    free(import->balls);
    dem_clump_destroy(import->clump);
    import->balls = NULL;
    import->clump = NULL;
    import->count = import->capacity = 0;
}

dem_status dem_import_ball(dem_import *import, long line, dem_ball ball, dem_error *error)
{
    if (!point_is_usable(ball.centre))
        return dem_fail_at(error, DEM_BAD_INPUT, import->file, line,
                           "sphere %zu: its centre is not finite or beyond 1e60; correct or remove it",
                           import->count + 1);
    if (!(ball.radius > 0))
        return dem_fail_at(error, DEM_BAD_INPUT, import->file, line,
                           "sphere %zu: its radius is %g and must be above 0; correct or remove it", import->count + 1,
                           ball.radius);
    if (!(ball.radius >= 1e-60 && ball.radius <= 1e60))
        return dem_fail_at(error, DEM_BAD_INPUT, import->file, line,
                           "sphere %zu: its radius is beyond what can be computed with; correct or remove it",
                           import->count + 1);
    if (import->count == DEM_IMPORT_SPHERES)
        return dem_fail_at(error, DEM_BAD_INPUT, import->file, line,
                           "more than %d spheres, which is no clump that could be run; convert its mesh instead",
                           DEM_IMPORT_SPHERES);
    if (!dem_grow(&import->balls, &import->capacity, import->count, sizeof *import->balls))
        return dem_fail_memory(error);
    import->balls[import->count++] = ball;
    return DEM_OK;
}

dem_status dem_import_tensor(dem_import *import, long line, dem_sym3 t, dem_error *error)
{
    const double parts[6] = {t.xx, t.yy, t.zz, t.xy, t.xz, t.yz};
    double size = 0;
    for (int i = 0; i < 6; i++) {
        if (!isfinite(parts[i]) || fabs(parts[i]) > 1e150)
            return dem_fail_at(error, DEM_BAD_INPUT, import->file, line,
                               "inertia: is not finite; give its six components, or leave it out");
        size = larger(size, fabs(parts[i]));
    }
    dem_vec3 axes[3];
    double *moment = import->inertia;
    dem_sym3_eigen(sym3_scale(t, size > 0 ? 1 / size : 0), moment, axes);
    if (!(size >= 1e-200) || !(moment[0] > 0))
        return dem_fail_at(error, DEM_BAD_INPUT, import->file, line,
                           "inertia: its principal moments are not all above 0; correct it, or leave it out to have "
                           "it computed");
    // equality is a flat plate; the slack is for moments that were written with few digits
    if (moment[2] > (moment[0] + moment[1]) * (1 + 1e-6))
        return dem_fail_at(error, DEM_BAD_INPUT, import->file, line,
                           "inertia: the largest principal moment is %.3g times the sum of the other two, which no "
                           "body can have; correct it, or leave it out to have it computed",
                           moment[2] / (moment[0] + moment[1]));
    moment[2] = smaller(moment[2], moment[0] + moment[1]);
    for (int i = 0; i < 3; i++)
        moment[i] *= size;
    // moments that stand in order in the axes of the file are taken as they are
    bool principal = t.xy == 0 && t.xz == 0 && t.yz == 0 && t.xx <= t.yy && t.yy <= t.zz;
    if (principal)
        memcpy(moment, parts, 3 * sizeof *moment);
    moment[2] = smaller(moment[2], moment[0] + moment[1]);
    import->axes = principal ? (dem_quat){1, 0, 0, 0} : dem_quat_from_axes(axes[0], axes[1], axes[2]);
    import->inertia_line = line;
    return DEM_OK;
}

void dem_import_name(dem_import *import, const char *text, size_t length)
{
    while (length && (text_is_blank(*text) || *text == '\r'))
        text++, length--;
    while (length && (text_is_blank(text[length - 1]) || text[length - 1] == '\r'))
        length--;
    size_t room = sizeof import->name - 1;
    if (length > room)
        length = room;
    for (size_t i = 0; i < length; i++)
        import->name[i] = (unsigned char)text[i] < ' ' || text[i] == 0x7f ? ' ' : text[i];
    import->name[length] = 0;
}
