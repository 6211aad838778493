#include "clump/import_text.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "base/memory.h"
#include "math/quat.h"

static bool starts_with(const char *text, const char *end, const char *wanted)
{
    size_t length = strlen(wanted);
    return (size_t)(end - text) >= length && strncasecmp(text, wanted, length) == 0;
}

dem_status dem_import_text_begin(dem_import_text *t, const dem_import *import, const char *text, size_t size,
                                 const char *comment, const char *separators, dem_error *error)
{
    *t = (dem_import_text){.copy = dem_alloc(size + 1, 1)};
    if (!t->copy)
        return dem_fail_memory(error);
    bool hidden = false;
    for (size_t i = 0; i < size; i++) {
        char c = text[i];
        bool ends = c == '\n' || c == '\r';
        hidden = !ends && (hidden || starts_with(text + i, text + size, comment));
        t->copy[i] = hidden || strchr(separators, c) ? ' ' : c;
    }
    t->copy[size] = 0;
    t->r = dem_reader_begin(NULL, import->file, t->copy, size, &t->none, error);
    return DEM_OK;
}

void dem_import_text_end(dem_import_text *t)
{
    free(t->copy);
    t->copy = NULL;
}

bool dem_import_text_line(dem_import_text *t)
{
    while (dem_reader_line(&t->r)) {
        reader_skip_blanks(&t->r);
        if (t->r.at < t->r.stop)
            return true;
    }
    return false;
}

bool dem_import_text_more(dem_import_text *t)
{
    dem_reader *r = &t->r;
    for (;;) {
        reader_skip_blanks(r);
        if (r->at == r->stop)
            return false;
        const char *rest = r->at + 1;
        while (rest < r->stop && text_is_blank(*rest))
            rest++;
        if (*r->at != '&' || rest < r->stop)
            return true;
        if (!dem_reader_line(r))
            return false;
    }
}

dem_status dem_import_text_number(dem_import_text *t, double *value)
{
    const char *at = t->r.at;
    DEM_TRY(dem_reader_number(&t->r, value));
    if (!(fabs(*value) <= 1e150)) {
        dem_word word = {at, (size_t)(t->r.at - at)};
        return dem_reader_fail(&t->r, "'%s' is not a finite number that can be computed with; correct it",
                               dem_word_show(word).text);
    }
    return DEM_OK;
}

dem_status dem_import_text_numbers(dem_import_text *t, int count, double *values)
{
    for (int i = 0; i < count; i++) {
        while (!dem_import_text_more(t) && dem_reader_line(&t->r))
            ;
        DEM_TRY(dem_import_text_number(t, &values[i]));
    }
    return DEM_OK;
}

dem_status dem_import_text_rows(dem_import_text *t, dem_import *import, bool types)
{
    enum { MOST = 8 };
    while (dem_import_text_line(t)) {
        double v[MOST] = {0};
        int count = 0;
        long line = t->r.line;
        while (dem_import_text_more(t)) {
            DEM_TRY(dem_import_text_number(t, &v[count < MOST ? count : MOST - 1]));
            count++;
        }
        if (count == 0)
            continue;
        if (count < 4 || count > 4 + types) {
            const char *hint = count == 8   ? "write numbers with a decimal point, not a comma"
                               : count == 5 ? "if the fifth is a type, add --from liggghts"
                                            : "write one sphere a line";
            return dem_fail_at(t->r.error, DEM_BAD_INPUT, import->file, line,
                               "%d numbers where a sphere's x y z r should stand; %s", count, hint);
        }
        DEM_TRY(dem_import_ball(import, line, (dem_ball){{v[0], v[1], v[2]}, v[3]}, t->r.error));
    }
    return DEM_OK;
}

// ---- remarks

typedef struct remarks {
    double density, mass, centre[3], inertia[3], position[3], orientation[4];
    bool mesh_frame, metres;
    long mass_line, inertia_line;
} remarks;

// `count` numbers behind `key`, if it stands at `text` and they are not known yet; what is not numbers is no remark
static bool take(const char *text, const char *end, const char *key, int count, double *values)
{
    if (!starts_with(text, end, key) || !isnan(*values))
        return false;
    double found[4];
    text += strlen(key);
    for (int i = 0; i < count; i++) {
        while (text < end && text_is_blank(*text))
            text++;
        text = dem_parse_double(text, end, &found[i]);
        if (!text || !(fabs(found[i]) <= 1e60))
            return false;
    }
    memcpy(values, found, (size_t)count * sizeof *values);
    return true;
}

// "# NAME: N spheres of dem-clump 0.1.0"
static void take_title(dem_import *import, const char *text, const char *end)
{
    static const char mark[] = " spheres of dem-clump ";
    for (const char *p = text; p < end; p++)
        if (starts_with(p, end, mark)) {
            const char *colon = p;
            while (colon > text && *colon != ':')
                colon--;
            dem_import_name(import, text, (size_t)(colon - text));
        }
}

static void take_remark(dem_import *import, remarks *m, const char *text, const char *end, long line)
{
    take_title(import, text, end);
    // the first of each: the union's own figures may follow
    take(text, end, "density [kg/m^3]:", 1, &m->density);
    if (take(text, end, "mass [kg]:", 1, &m->mass))
        m->mass_line = line;
    take(text, end, "centre of mass [m]:", 3, m->centre);
    if (take(text, end, "principal moments of inertia [kg m^2]:", 3, m->inertia))
        m->inertia_line = line;
    take(text, end, "principal to mesh frame, position [m]:", 3, m->position);
    take(text, end, "principal to mesh frame, quaternion w x y z:", 4, m->orientation);
    m->mesh_frame |= starts_with(text, end, "frame: mesh");
    m->metres |= starts_with(text, end, "unit of x y z r: m") ||
                 (starts_with(text, end, "frame:") && dem_import_holds(text, (size_t)(end - text), "SI units", NULL));
}

// what was said, in the frame that the spheres are in
static dem_status apply(dem_import *import, const remarks *m, dem_error *error)
{
    const double *p = m->position, *q = m->orientation, *c = m->centre;
    import->in_metres = true;
    import->density = m->density > 0 ? m->density : NAN;
    if (m->mass > 0) {
        import->mass = m->mass;
        import->mass_line = m->mass_line;
    }
    double norm = sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    if (!(fabs(norm - 1) < 1e-3))
        return DEM_OK;
    dem_quat turn = quat_unit((dem_quat){q[0], q[1], q[2], q[3]});
    if (fabs(norm - 1) <= 1e-12)
        turn = (dem_quat){q[0], q[1], q[2], q[3]};
    import->centre = v3(c[0], c[1], c[2]);
    if (isfinite(m->inertia[0])) {
        DEM_TRY(dem_import_tensor(import, m->inertia_line,
                                  (dem_sym3){.xx = m->inertia[0], .yy = m->inertia[1], .zz = m->inertia[2]}, error));
        if (m->mesh_frame)
            import->axes = quat_multiply(turn, import->axes);
    }
    if (!m->mesh_frame && isfinite(p[0])) {
        import->position = v3(p[0], p[1], p[2]);
        import->orientation = turn;
    }
    return DEM_OK;
}

dem_status dem_import_remarks(dem_import *import, const char *text, size_t size, dem_error *error)
{
    remarks m = {NAN, NAN, {NAN, NAN, NAN}, {NAN, NAN, NAN}, {NAN, NAN, NAN}, {NAN, NAN, NAN, NAN}, 0, 0, 0, 0};
    const char *end = text + size;
    long line = 0;
    for (const char *at = text; at < end;) {
        const char *stop = memchr(at, '\n', (size_t)(end - at));
        stop = stop ? stop : end;
        line++;
        while (at < stop && text_is_blank(*at))
            at++;
        const char *begin = at;
        while (at < stop && (*at == '#' || *at == '/' || text_is_blank(*at)))
            at++;
        if (begin < stop && (*begin == '#' || starts_with(begin, stop, "//")))
            take_remark(import, &m, at, stop, line);
        at = stop + 1;
    }
    return m.metres ? apply(import, &m, error) : DEM_OK;
}

// ---- recognising

dem_word dem_import_first_word(const char *text, size_t size)
{
    const char *p = text, *end = text + size;
    if (starts_with(p, end, "\xef\xbb\xbf"))
        p += 3;
    while (p < end) {
        while (p < end && (text_is_blank(*p) || *p == '\n' || *p == '\r'))
            p++;
        if (p == end || (*p != '#' && !starts_with(p, end, "//")))
            break;
        while (p < end && *p != '\n' && *p != '\r')
            p++;
    }
    const char *begin = p;
    while (p < end && !text_is_blank(*p) && *p != '\n' && *p != '\r')
        p++;
    return (dem_word){begin, (size_t)(p - begin)};
}

bool dem_import_holds(const char *text, size_t size, const char *wanted, const char *comment)
{
    const char *end = text + size;
    for (const char *p = text; p < end; p++) {
        if (comment && starts_with(p, end, comment))
            while (p + 1 < end && p[1] != '\n' && p[1] != '\r')
                p++;
        else if (starts_with(p, end, wanted))
            return true;
    }
    return false;
}
