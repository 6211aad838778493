// LAMMPS molecule file: counts and values on top, then sections by atom. The first line is a title.
//
// The inertia's off-diagonals are documented as Ixy Ixz Iyz, and files are written so; LAMMPS itself takes them in the
// opposite order (versions of 2022 and since). They are read as documented, with a warning where it matters. What the
// file leaves out LAMMPS computes from the atoms: their masses are taken as they are, the rest is the union's.
#include <math.h>
#include <stdlib.h>

#include "base/memory.h"
#include "clump/import_text.h"

typedef struct molecule {
    dem_import_text text;
    dem_import *import;
    dem_error *error;
    long atoms;         // 0: not told yet
    dem_vec3 *centres;  // by atom; NAN: not seen yet
    double *radii, *masses;
    long *lines;
    dem_word keyword;  // of the section that begins at this line; length 0: none
    long mass_line;    // of the section Masses
} molecule;

static bool recognise_lammps(const char *text, size_t size)
{
    return dem_import_holds(text, size, "\nCoords", "#") || dem_import_holds(text, size, "\rCoords", "#");
}

static bool starts_name(const dem_reader *r)
{
    char c = r->at < r->stop ? *r->at : 0;
    return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z');
}

static dem_status take_atoms(molecule *m, double count)
{
    if (m->centres)
        return dem_reader_fail(&m->text.r, "a second number of atoms; one molecule a file can be read, split it");
    if (!(count >= 1 && count <= DEM_IMPORT_SPHERES) || count != floor(count))
        return dem_reader_fail(&m->text.r, "the number of atoms must be whole and from 1 to %d; correct it",
                               DEM_IMPORT_SPHERES);
    size_t n = (size_t)count;
    m->atoms = (long)count;
    m->centres = dem_alloc(n, sizeof *m->centres);
    m->radii = dem_alloc(n, sizeof *m->radii);
    m->masses = dem_alloc(n, sizeof *m->masses);
    m->lines = dem_alloc_zero(n, sizeof *m->lines);
    if (!m->centres || !m->radii || !m->masses || !m->lines)
        return dem_fail_memory(m->error);
    for (size_t i = 0; i < n; i++) {
        m->centres[i] = (dem_vec3){NAN, NAN, NAN};
        m->radii[i] = m->masses[i] = NAN;
    }
    return DEM_OK;
}

// up to six numbers and what they are
static dem_status read_value(molecule *m)
{
    dem_import *import = m->import;
    double v[6];
    int count = 0;
    while (dem_import_text_more(&m->text) && !starts_name(&m->text.r) && count < 6)
        DEM_TRY(dem_import_text_number(&m->text, &v[count++]));
    long line = m->text.r.line;
    dem_word what = dem_reader_word(&m->text.r);
    m->text.r.at = m->text.r.stop;
    if (dem_word_is(what, "atoms") && count == 1)
        return take_atoms(m, v[0]);
    if (dem_word_is(what, "mass") && count == 1) {
        if (!(v[0] > 0))
            return dem_reader_fail(&m->text.r,
                                   "mass: must be above 0; correct it, or leave it out to have it computed");
        import->mass = v[0];
        import->mass_line = line;
        return DEM_OK;
    }
    if (dem_word_is(what, "com") && count == 3) {
        import->centre = (dem_vec3){v[0], v[1], v[2]};
        return point_is_usable(import->centre) ? DEM_OK
                                               : dem_reader_fail(&m->text.r, "com: is beyond 1e60; correct it");
    }
    if (dem_word_is(what, "inertia") && count == 6) {
        double size = larger(larger(fabs(v[0]), fabs(v[1])), fabs(v[2]));
        if (fabs(v[3] - v[5]) > 1e-6 * size)
            dem_log(import->ctx, DEM_LOG_WARNING,
                    "line %ld: inertia is read in its documented order xx yy zz xy xz yz; LAMMPS itself takes xy for "
                    "yz, and turns this grain otherwise",
                    line);
        return dem_import_tensor(import, line, (dem_sym3){v[0], v[1], v[2], v[3], v[4], v[5]}, m->error);
    }
    bool known = dem_word_is(what, "atoms") || dem_word_is(what, "mass") || dem_word_is(what, "com") ||
                 dem_word_is(what, "inertia");
    if (known || what.length == 0)
        return dem_reader_fail(&m->text.r, "%d numbers and '%s' do not belong together; correct the line", count,
                               dem_word_show(what).text);
    double number;
    if (dem_parse_double(what.text, what.text + what.length, &number))  // nan, inf
        return dem_reader_fail(&m->text.r, "'%s' is not a finite number; correct it", dem_word_show(what).text);
    static const char *const others[] = {"bonds", "angles", "dihedrals", "impropers", "fragments", "body"};
    for (size_t i = 0; i < sizeof others / sizeof *others; i++)
        if (dem_word_is(what, others[i]))
            return DEM_OK;
    dem_log(import->ctx, DEM_LOG_WARNING, "line %ld: '%s' is not known and is passed over", line,
            dem_word_show(what).text);
    return DEM_OK;
}

static dem_status read_index(molecule *m, size_t *index)
{
    int64_t id;
    DEM_TRY(dem_reader_whole(&m->text.r, &id));
    if (id < 1 || id > m->atoms)
        return dem_reader_fail(&m->text.r, "atom %ld does not exist, there are %ld; correct the line", (long)id,
                               m->atoms);
    *index = (size_t)(id - 1);
    return DEM_OK;
}

static dem_status read_coords(molecule *m, size_t i)
{
    double v[3];
    for (int k = 0; k < 3; k++)
        DEM_TRY(dem_import_text_number(&m->text, &v[k]));
    m->centres[i] = (dem_vec3){v[0], v[1], v[2]};
    return DEM_OK;
}

// one line an atom, until a line begins with a letter
static dem_status read_section(molecule *m)
{
    dem_word name = m->keyword;
    bool coords = dem_word_is(name, "Coords"), diameters = dem_word_is(name, "Diameters");
    bool radii = dem_word_is(name, "Radii"), masses = dem_word_is(name, "Masses");
    m->keyword.length = 0;
    if (!m->centres && (coords || diameters || radii || masses))
        return dem_reader_fail(&m->text.r, "%s before the number of atoms; begin with a line like '5 atoms'",
                               dem_word_show(name).text);
    if (masses)
        m->mass_line = m->text.r.line;
    while (dem_import_text_line(&m->text)) {
        size_t i = 0;
        if (starts_name(&m->text.r)) {
            m->keyword = dem_reader_word(&m->text.r);
            return DEM_OK;
        }
        if (!coords && !diameters && !radii && !masses)
            continue;
        DEM_TRY(read_index(m, &i));
        if (coords) {
            DEM_TRY(read_coords(m, i));
            continue;
        }
        double value;
        DEM_TRY(dem_import_text_number(&m->text, &value));
        if (masses && !(value >= 0))
            return dem_reader_fail(&m->text.r, "the mass of atom %zu is below 0; correct it", i + 1);
        *(masses ? &m->masses[i] : &m->radii[i]) = diameters ? value / 2 : value;
        if (!masses)
            m->lines[i] = m->text.r.line;
    }
    return DEM_OK;
}

static dem_status add_balls(molecule *m)
{
    const char *file = m->import->file;
    if (!m->centres)
        return dem_fail_at(m->error, DEM_BAD_INPUT, file, 0,
                           "has no line like '5 atoms'; the file is no molecule file or cut short");
    for (size_t i = 0; i < (size_t)m->atoms; i++) {
        bool placed = !isnan(m->centres[i].x), sized = m->lines[i] > 0;
        if (!placed || !sized)
            return dem_fail_at(m->error, DEM_BAD_INPUT, file, 0, "atom %zu of %ld has no %s; add it under %s", i + 1,
                               m->atoms, placed ? "diameter" : "place", placed ? "Diameters" : "Coords");
        DEM_TRY(dem_import_ball(m->import, m->lines[i], (dem_ball){m->centres[i], m->radii[i]}, m->error));
    }
    return DEM_OK;
}

// what LAMMPS sums up itself where the file gives no mass and centre
static void add_masses(molecule *m)
{
    double mass = 0;
    dem_vec3 moment = {0, 0, 0};
    for (size_t i = 0; i < (size_t)m->atoms; i++) {
        mass += m->masses[i];  // NAN: not all are told
        moment = v3_along(moment, m->masses[i], m->centres[i]);
    }
    if (!(mass > 0) || !isfinite(mass))
        return;
    if (isnan(m->import->centre.x) && point_is_usable(v3_scale(moment, 1 / mass)))
        m->import->centre = v3_scale(moment, 1 / mass);
    if (isnan(m->import->mass)) {
        m->import->mass = mass;
        m->import->mass_line = m->mass_line;
    }
}

static dem_status read_molecule(molecule *m)
{
    dem_reader_line(&m->text.r);  // the title
    while (dem_import_text_line(&m->text)) {
        if (!starts_name(&m->text.r)) {
            DEM_TRY(read_value(m));
            continue;
        }
        m->keyword = dem_reader_word(&m->text.r);
        while (m->keyword.length)
            DEM_TRY(read_section(m));
        break;
    }
    DEM_TRY(add_balls(m));
    add_masses(m);
    return DEM_OK;
}

static dem_status read_lammps(dem_import *import, const char *text, size_t size, dem_error *error)
{
    molecule m = {.import = import, .error = error};
    DEM_TRY(dem_import_remarks(import, text, size, error));
    DEM_TRY(dem_import_text_begin(&m.text, import, text, size, "#", "", error));
    dem_status status = read_molecule(&m);
    dem_import_text_end(&m.text);
    free(m.centres);
    free(m.radii);
    free(m.masses);
    free(m.lines);
    return status;
}

extern const dem_importer dem_import_lammps;
const dem_importer dem_import_lammps = {
    .name = "lammps",
    .suffixes = "mol lammps molecule",
    .about = "LAMMPS molecule: atoms, Coords, Diameters, mass, com, inertia, Masses",
    .recognise = recognise_lammps,
    .read = read_lammps,
};
