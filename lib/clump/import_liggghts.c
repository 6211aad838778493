// LIGGGHTS: a file of spheres, or a script with the line `fix ID all particletemplate/multisphere ...` that names one
// or lists the spheres. `mass` and `inertia_tensor` (Ixx Ixy Ixz Iyy Iyz Izz) are about the file's origin with
// use_density, and about the centre of the union otherwise; `scale` is for lengths and leaves them as they are.
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "base/file.h"
#include "clump/import_text.h"

#define STYLE "particletemplate/multisphere"

typedef struct script {
    dem_import_text text;
    dem_import *import;
    dem_error *error;
    double scale;
    long spheres;  // nspheres; 0: not told
    long line;     // of the template
    bool about_origin;
} script;

// the xyzr reader comes first for spheres alone
static bool recognise_liggghts(const char *text, size_t size)
{
    dem_word word = dem_import_first_word(text, size);
    double number;
    return dem_import_holds(text, size, STYLE, "#") ||
           (word.length && dem_parse_double(word.text, word.text + word.length, &number));
}

static dem_status read_spheres(dem_import *import, const char *text, size_t size, dem_error *error)
{
    dem_import_text t;
    DEM_TRY(dem_import_text_begin(&t, import, text, size, "#", "", error));
    dem_status status = dem_import_text_rows(&t, import, true);
    dem_import_text_end(&t);
    return status;
}

static dem_status number(script *s, const char *what, double *value)
{
    if (!dem_import_text_more(&s->text))
        return dem_reader_fail(&s->text.r, "the template ends where the value of %s should stand; complete it", what);
    if (strchr("$v", *s->text.r.at))
        return dem_reader_fail(&s->text.r, "%s is a variable of the script; write its value there", what);
    return dem_import_text_number(&s->text, value);
}

static dem_status above_zero(script *s, const char *what, double *value)
{
    DEM_TRY(number(s, what, value));
    return *value > 0 ? DEM_OK : dem_reader_fail(&s->text.r, "%s must be above 0; correct it", what);
}

// spheres of another file, which stands beside the script; anything but a plain file could never end. Remarks there on
// the mass are not heard: the script decides
static dem_status read_file(script *s)
{
    dem_import *import = s->import;
    if (!dem_import_text_more(&s->text))
        return dem_reader_fail(&s->text.r, "the template ends where the name of the sphere file should stand; add it");
    dem_word word = dem_reader_word(&s->text.r);
    if (!import->folder)
        return dem_reader_fail(&s->text.r, "the spheres are in another file, %s; convert that one",
                               dem_word_show(word).text);
    bool absolute = *word.text == '/';
    char *path =
        dem_path_join(absolute ? "/" : import->folder, "%.*s", (int)(word.length - absolute), word.text + absolute);
    if (!path)
        return dem_fail_memory(s->error);
    struct stat about;
    dem_buffer bytes = {0};
    bool plain = stat(path, &about) == 0 && S_ISREG(about.st_mode);
    dem_error why = {0};
    dem_status status = plain ? dem_file_read(path, &bytes, &why) : DEM_BAD_INPUT;
    if (status != DEM_OK) {
        status = dem_reader_fail(&s->text.r, "the sphere file %.200s cannot be read; put it beside the script", path);
    } else {
        const char *script_file = import->file;
        import->file = path;
        status = memchr(bytes.data, 0, bytes.size)
                     ? dem_reader_fail(&s->text.r, "the sphere file %.200s is binary; name a text file", path)
                     : read_spheres(import, bytes.data, bytes.size, s->error);
        import->file = script_file;
    }
    dem_buffer_release(&bytes);
    free(path);
    return status;
}

static dem_status read_list(script *s)
{
    if (s->spheres == 0)
        return dem_reader_fail(&s->text.r, "spheres are listed before nspheres tells how many; put nspheres first");
    for (long i = 0; i < s->spheres; i++) {
        double v[4];
        for (int k = 0; k < 4; k++)
            DEM_TRY(number(s, "spheres", &v[k]));
        DEM_TRY(dem_import_ball(s->import, s->text.r.line, (dem_ball){{v[0], v[1], v[2]}, v[3]}, s->error));
    }
    return DEM_OK;
}

static bool at_word(script *s, const char *wanted)
{
    dem_reader begin = s->text.r;
    if (dem_import_text_more(&s->text) && dem_word_is(dem_reader_word(&s->text.r), wanted))
        return true;
    s->text.r = begin;
    return false;
}

static dem_status read_density(script *s)
{
    if (at_word(s, "constant"))
        return above_zero(s, "density", &s->import->density);
    dem_log(s->import->ctx, DEM_LOG_WARNING, "line %ld: its density is not constant and is left out; give --density",
            s->text.r.line);
    return DEM_OK;
}

static dem_status read_setting(script *s, dem_word word)
{
    dem_import *import = s->import;
    if (dem_word_is(word, "nspheres")) {
        double count;
        DEM_TRY(above_zero(s, "nspheres", &count));
        if (count > DEM_IMPORT_SPHERES || count != floor(count))
            return dem_reader_fail(&s->text.r, "nspheres must be whole and at most %d; correct it", DEM_IMPORT_SPHERES);
        s->spheres = (long)count;
        return DEM_OK;
    }
    if (dem_word_is(word, "density"))
        return read_density(s);
    if (dem_word_is(word, "spheres"))
        return at_word(s, "file") ? read_file(s) : read_list(s);
    if (dem_word_is(word, "scale"))
        return above_zero(s, "scale", &s->scale);
    if (dem_word_is(word, "mass")) {
        DEM_TRY(above_zero(s, "mass", &import->mass));
        import->mass_line = s->text.r.line;
        return DEM_OK;
    }
    if (dem_word_is(word, "inertia_tensor")) {
        double v[6];
        for (int i = 0; i < 6; i++)
            DEM_TRY(number(s, "inertia_tensor", &v[i]));
        return dem_import_tensor(import, s->text.r.line,
                                 (dem_sym3){.xx = v[0], .xy = v[1], .xz = v[2], .yy = v[3], .yz = v[4], .zz = v[5]},
                                 s->error);
    }
    s->about_origin |= dem_word_is(word, "use_density");
    return DEM_OK;  // seeds, ntry, types: no matter here
}

static dem_status finish(script *s)
{
    dem_import *import = s->import;
    if (s->spheres && import->count && (size_t)s->spheres != import->count)
        return dem_fail_at(s->error, DEM_BAD_INPUT, import->file, s->line,
                           "nspheres is %ld, but there are %zu spheres; correct one of them", s->spheres,
                           import->count);
    for (size_t i = 0; i < import->count; i++) {
        dem_ball *b = &import->balls[i];
        *b = (dem_ball){v3_scale(b->centre, s->scale), b->radius * s->scale};
        if (!point_is_usable(b->centre) || !(b->radius >= 1e-60 && b->radius <= 1e60))
            return dem_fail_at(s->error, DEM_BAD_INPUT, import->file, s->line,
                               "scale makes sphere %zu larger or smaller than can be computed with; correct it", i + 1);
    }
    if (s->about_origin)
        import->centre = v3(0, 0, 0);
    return DEM_OK;
}

static dem_status read_script(script *s)
{
    dem_word id = {"", 0};
    while (dem_import_text_line(&s->text)) {
        dem_word word;
        for (int i = 0; dem_import_text_more(&s->text) && (word = dem_reader_word(&s->text.r)).length; i++) {
            if (i == 1)
                id = word;
            if (!dem_word_is(word, STYLE))
                continue;
            s->line = s->text.r.line;
            dem_import_name(s->import, id.text, id.length);
            while (dem_import_text_more(&s->text))
                DEM_TRY(read_setting(s, dem_reader_word(&s->text.r)));
            return finish(s);
        }
    }
    return dem_reader_fail(&s->text.r, "no line with " STYLE "; name the file of the spheres instead");
}

static dem_status read_liggghts(dem_import *import, const char *text, size_t size, dem_error *error)
{
    if (!dem_import_holds(text, size, STYLE, "#")) {
        DEM_TRY(dem_import_remarks(import, text, size, error));
        return read_spheres(import, text, size, error);
    }
    script s = {.import = import, .error = error, .scale = 1};
    DEM_TRY(dem_import_text_begin(&s.text, import, text, size, "#", "", error));
    dem_status status = read_script(&s);
    if (status == DEM_OK && dem_import_text_line(&s.text) &&
        dem_import_holds(s.text.r.at, (size_t)(s.text.r.end - s.text.r.at), STYLE, NULL))
        dem_log(import->ctx, DEM_LOG_WARNING, "the script has more templates; only the first, %s, is converted",
                import->name);
    dem_import_text_end(&s.text);
    return status;
}

extern const dem_importer dem_import_liggghts;
const dem_importer dem_import_liggghts = {
    .name = "liggghts",
    .suffixes = "multisphere liggghts in",
    .about = "LIGGGHTS multisphere: a sphere file, or a script with fix particletemplate/multisphere",
    .recognise = recognise_liggghts,
    .read = read_liggghts,
};
