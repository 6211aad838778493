// Kratos .clu: keywords, with their numbers on the lines behind them. The point that is given as the particle's centre
// is subtracted from the spheres there and becomes the centre of mass, whatever it was; so it is that here too.
#include <math.h>

#include "clump/import_text.h"

static bool recognise_kratos(const char *text, size_t size)
{
    return dem_import_holds(text, size, "centers_and_radii", "//");
}

static dem_status read_balls(dem_import_text *t, dem_import *import, dem_error *error)
{
    while (dem_import_text_line(t)) {
        double v[4];
        long line = t->r.line;
        dem_reader begin = t->r;
        if (dem_word_is(dem_reader_word(&t->r), "End"))
            return DEM_OK;
        t->r = begin;
        for (int i = 0; i < 4; i++)
            DEM_TRY(dem_import_text_number(t, &v[i]));
        if (dem_import_text_more(t))
            return dem_reader_fail(&t->r, "more than 4 numbers where a sphere's x y z r should stand; remove the rest");
        DEM_TRY(dem_import_ball(import, line, (dem_ball){{v[0], v[1], v[2]}, v[3]}, error));
    }
    return dem_reader_fail(&t->r,
                           "unexpected end of file before 'End centers_and_radii'; the file is cut short, export it "
                           "again");
}

static dem_status read_name(dem_import_text *t, dem_import *import)
{
    if (dem_import_text_line(t))
        dem_import_name(import, t->r.at, (size_t)(t->r.stop - t->r.at));
    t->r.at = t->r.stop;
    return DEM_OK;
}

static dem_status read_keyword(dem_import_text *t, dem_import *import, dem_word word, dem_error *error)
{
    double v[4];
    long line = t->r.line;
    if (dem_word_is(word, "Begin")) {
        word = dem_reader_word(&t->r);
        return dem_word_is(word, "centers_and_radii") ? read_balls(t, import, error) : DEM_OK;
    }
    if (dem_word_is(word, "Name"))
        return read_name(t, import);
    if (dem_word_is(word, "Particle_center_and_diameter")) {
        DEM_TRY(dem_import_text_numbers(t, 4, v));
        import->centre = (dem_vec3){v[0], v[1], v[2]};
        return point_is_usable(import->centre) ? DEM_OK
                                               : dem_reader_fail(&t->r, "the centre is beyond 1e60; correct it");
    }
    if (dem_word_is(word, "Volume")) {
        DEM_TRY(dem_import_text_numbers(t, 1, v));
        if (!(v[0] > 0))
            return dem_reader_fail(&t->r, "Volume: must be above 0; correct it, or leave it out to have it computed");
        import->volume = v[0];
        import->mass_line = line;
        return DEM_OK;
    }
    if (dem_word_is(word, "Inertia")) {
        t->r.at = t->r.stop;  // "per unit mass"
        DEM_TRY(dem_import_text_numbers(t, 3, v));
        import->inertia_of_unit_mass = true;
        return dem_import_tensor(import, line, (dem_sym3){.xx = v[0], .yy = v[1], .zz = v[2]}, error);
    }
    t->r.at = t->r.stop;  // Size, and what others add
    return DEM_OK;
}

static dem_status read_kratos(dem_import *import, const char *text, size_t size, dem_error *error)
{
    dem_import_text t;
    DEM_TRY(dem_import_remarks(import, text, size, error));
    DEM_TRY(dem_import_text_begin(&t, import, text, size, "//", "", error));
    dem_status status = DEM_OK;
    while (status == DEM_OK && dem_import_text_line(&t))
        status = read_keyword(&t, import, dem_reader_word(&t.r), error);
    dem_import_text_end(&t);
    return status;
}

extern const dem_importer dem_import_kratos;
const dem_importer dem_import_kratos = {
    .name = "kratos",
    .suffixes = "clu",
    .about = "Kratos cluster: spheres, volume, inertia per unit mass",
    .recognise = recognise_kratos,
    .read = read_kratos,
};
