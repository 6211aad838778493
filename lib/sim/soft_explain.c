// How many spheres of a grain touch at once, which is what the sum of all makes of its stiffness.
#include <math.h>

#include "base/text.h"
#include "sim/state.h"

enum { DIRECTIONS = 400 };

static const double WORTH_TELLING = 1.05;

// mean over all directions of the number of spheres that a wall would touch at this overlap [m]
static double touching(const dem_world *w, const dem_template *t, double overlap)
{
    size_t count = 0;
    for (size_t k = 0; k < DIRECTIONS; k++) {
        double z = 1 - (2 * (double)k + 1) / DIRECTIONS, s = sqrt(1 - z * z), angle = 2.39996322972865332 * (double)k;
        dem_vec3 n = v3(s * cos(angle), s * sin(angle), z);
        double most = -INFINITY;
        for (uint32_t i = t->first; i < t->first + t->count; i++) {
            const double *b = w->templates.spheres[i];
            most = larger(most, v3_dot(n, v3(b[0], b[1], b[2])) + b[3]);
        }
        for (uint32_t i = t->first; i < t->first + t->count; i++) {
            const double *b = w->templates.spheres[i];
            count += v3_dot(n, v3(b[0], b[1], b[2])) + b[3] > most - overlap;
        }
    }
    return (double)count / DIRECTIONS;
}

// the mean scale of a shape's bodies; 0: there are none
static double scale_of(const dem_world *w, uint32_t shape)
{
    double sum = 0;
    size_t count = 0;
    for (size_t row = 0; row < w->bodies.count; row++)
        if (w->bodies.shape[row] == shape) {
            sum += body_scale(&w->bodies, row);
            count++;
        }
    return count ? sum / (double)count : 0;
}

static void explain_parts(const dem_world *w, dem_buffer *out)
{
    for (uint32_t shape = 0; w->soft.parts && shape < w->shape_count; shape++)
        if (w->soft.parts[shape] > 1)
            dem_buffer_print(out, "  %-14s is concave: %u convex parts, each with contacts of its own\n",
                             w->shape_names[shape], (unsigned)w->soft.parts[shape]);
}

void dem_soft_explain(const dem_world *w, dem_buffer *out)
{
    double overlap = dem_soft_likely_overlap(w);
    if (w->features.soft) {
        dem_buffer_text(out, "soft contacts: one for each pair of bodies, or of their convex parts; tau ");
        dem_buffer_number(out, w->soft.tau, 3);
        dem_buffer_print(out, " m, %s; %zu table%s of weights\n",
                         w->soft.automatic ? "by the overlap of likely impacts" : "as given", w->soft.table_count,
                         w->soft.table_count == 1 ? "" : "s");
        explain_parts(w, out);
    }
    if (w->multiple != DEM_MULTIPLE_SUM && !w->features.soft)
        return;
    bool some = false;
    for (uint32_t shape = 0; shape < w->shape_count && overlap > 0; shape++) {
        const dem_template *t = &w->templates.items[shape];
        double scale = scale_of(w, shape);
        if (t->count < 2 || !(scale > 0))
            continue;
        double times = touching(w, t, overlap / scale);
        if (times < WORTH_TELLING)
            continue;
        if (!some) {
            dem_buffer_text(out, "spheres of a grain that a wall touches at once, at a likely overlap of ");
            dem_buffer_number(out, overlap, 2);
            dem_buffer_text(out, " m:\n");
        }
        some = true;
        dem_buffer_print(out, "  %-14s ", w->shape_names[shape]);
        dem_buffer_number(out, times, 2);
        dem_buffer_print(out, " of %u\n", (unsigned)t->count);
    }
    if (some && !w->features.soft)
        dem_buffer_text(out,
                        "  the sum of all is so many times as stiff as asked, and more against other grains;\n"
                        "  \"contacts_between_clumps\": \"soft\" has the asked stiffness at any number of spheres\n");
}
