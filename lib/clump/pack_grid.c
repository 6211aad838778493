// Voxel spheres: equal spheres on a cubic lattice inside the grain, the oldest way to make a clump. The lattice stands
// along the smallest box around the grain and symmetrically in it, so a box is filled without rest.
#include <stdlib.h>

#include "clump/pack_classic.h"
#include "mesh/min_box.h"

enum { SPACING, FILL };
enum { FEWEST_CELLS = 20000, CELLS_PER_SPHERE = 100, MOST_CELLS = 4000000 };
enum { FILLS = 24, PARTS = 4 };

static const double least_fill = 0.1, most_fill = 2;
static const double largest_radius = 0.65;  // a ball of more than twice the grain's volume fits nothing [d_eq]

static const dem_parameter parameters[] = {
    [SPACING] = {"spacing", NAN, 1e-3, 100, "d_eq", "of the lattice"},
    [FILL] = {"fill", NAN, 0.1, 2, "-", "radius over half the spacing; 1: the spheres touch"},
};

typedef struct lattice {
    dem_classic *c;
    dem_vec3 axes[3], middle;  // of the smallest box
    double edges[3], spacing;
    long cells[3];
    dem_ball *places;  // in the grain; the radius is the distance to the surface
    dem_ball *balls;
    size_t count;
    int fill;  // the best one of the lattice before
} lattice;

static dem_status set_box(dem_classic *c, lattice *l, dem_error *error)
{
    const dem_pack_grain *grain = c->grain;
    DEM_TRY(dem_mesh_min_box(grain->mesh, c->threads, l->edges, l->axes, error));
    for (int k = 0; k < 3; k++) {
        l->edges[k] /= grain->size;
        l->axes[k] = dem_pack_grain_enter(grain, v3_along(grain->centre, grain->size, l->axes[k]));
    }
    for (int k = 0; k < 3; k++) {
        double low = INFINITY, high = -INFINITY;
        for (size_t i = 0; i < 3 * grain->mesh->triangle_count; i++) {
            double x =
                v3_dot(dem_pack_grain_enter(grain, grain->mesh->vertices[grain->mesh->triangles[i]]), l->axes[k]);
            low = fmin(low, x);
            high = fmax(high, x);
        }
        l->middle = v3_along(l->middle, (low + high) / 2, l->axes[k]);
    }
    return DEM_OK;
}

// as many cells along each edge as fit best, and `more`; returns their number
static double set_cells(lattice *l, double spacing, int more)
{
    double all = 1;
    l->spacing = spacing;
    for (int k = 0; k < 3; k++) {
        double cells = fmax(1, round(l->edges[k] / spacing)) + more;
        l->cells[k] = (long)fmin(cells, 1e9);
        all *= cells;
    }
    return all;
}

static dem_vec3 cell_middle(const lattice *l, size_t cell)
{
    dem_vec3 p = l->middle;
    size_t rest = cell;
    for (int k = 0; k < 3; k++) {
        size_t cells = (size_t)l->cells[k];
        p = v3_along(p, ((double)(rest % cells) + 0.5 - 0.5 * (double)cells) * l->spacing, l->axes[k]);
        rest /= cells;
    }
    return p;
}

// the middles of cells that lie inside the grain
static dem_status set_places(lattice *l, size_t cells, dem_error *error)
{
    dem_ball *places = dem_alloc(cells, sizeof *places);
    if (!places)
        return dem_fail_memory(error);
#pragma omp parallel for num_threads(l->c->threads) schedule(dynamic, 64)
    for (size_t i = 0; i < cells; i++) {
        dem_vec3 p = cell_middle(l, i);
        places[i] = (dem_ball){p, dem_classic_depth(l->c, p)};
    }
    l->count = 0;
    for (size_t i = 0; i < cells; i++)
        if (places[i].radius > 0)
            places[l->count++] = places[i];
    free(l->places);
    l->places = places;
    return DEM_OK;
}

// the spheres of one radius; --inscribed leaves out those that would reach outside
static size_t set_balls(lattice *l, double radius)
{
    double least = l->c->options->side == DEM_SIDE_INSCRIBED ? radius * (1 - 1e-9) : 0;
    size_t count = 0;
    for (size_t i = 0; i < l->count; i++)
        if (l->places[i].radius >= least)
            l->balls[count++] = (dem_ball){l->places[i].centre, radius};
    return count;
}

static double fill_at(int k)
{
    return least_fill * pow(most_fill / least_fill, (double)k / (FILLS - 1));
}

// one radius on the lattice at hand: becomes the result where it is better, and tells its gap
static dem_status try_fill(lattice *l, double fill, bool any_count, double *least, double *gap, dem_error *error)
{
    dem_classic *c = l->c;
    size_t count = set_balls(l, fill * l->spacing / 2);
    *gap = INFINITY;
    if (count == 0 || (!any_count && count > c->options->spheres))
        return DEM_OK;
    *gap = dem_classic_gap(c, l->balls, count);
    if (!(*gap < *least))
        return DEM_OK;
    c->value[SPACING] = l->spacing;
    c->value[FILL] = fill;
    return dem_classic_offer(c, l->balls, count, least, NULL, error);
}

// the fill given, or from that of the lattice before up and down as long as it gets better
static dem_status try_fills(lattice *l, double given_fill, bool any_count, double *least, dem_error *error)
{
    double gap, best;
    free(l->balls);
    l->balls = dem_alloc(l->count, sizeof *l->balls);
    if (!l->balls)
        return dem_fail_memory(error);
    if (!isnan(given_fill))
        return try_fill(l, given_fill, any_count, least, &gap, error);
    while (l->fill > 0 && fill_at(l->fill) * l->spacing / 2 > largest_radius)
        l->fill--;
    DEM_TRY(try_fill(l, fill_at(l->fill), any_count, least, &best, error));
    for (int way = -1; way <= 1; way += 2)
        for (int k = l->fill + way; k >= 0 && k < FILLS && fill_at(k) * l->spacing / 2 <= largest_radius; k += way) {
            DEM_TRY(try_fill(l, fill_at(k), any_count, least, &gap, error));
            if (gap > best && isfinite(best))
                break;
            best = gap;
            l->fill = k;
        }
    return DEM_OK;
}

static int deeper_first(const void *pa, const void *pb)
{
    double a = ((const dem_ball *)pa)->radius, b = ((const dem_ball *)pb)->radius;
    return (a < b) - (a > b);
}

static dem_status place_given(lattice *l, double spacing, double fill, dem_error *error)
{
    double cells = set_cells(l, spacing, 0), least = INFINITY;
    if (cells > MOST_CELLS)
        return dem_fail(error, DEM_USAGE,
                        "a spacing of %g d_eq makes %.0f cells around the grain; ask for at least %.2g", spacing, cells,
                        spacing * cbrt(cells / MOST_CELLS));
    DEM_TRY(set_places(l, (size_t)cells, error));
    if (l->count > l->c->options->spheres)
        qsort(l->places, l->count, sizeof *l->places, deeper_first);
    return try_fills(l, fill, true, &least, error);
}

// ever narrower lattices, in quarters of a cell along the longest edge, until there are far too many spheres
static dem_status search(lattice *l, double fill, dem_error *error)
{
    double spheres = (double)l->c->options->spheres, least = INFINITY;
    double most_cells = fmin(FEWEST_CELLS + CELLS_PER_SPHERE * spheres, MOST_CELLS);
    for (int part = PARTS;; part += 1 + part / 40) {
        double spacing = l->edges[0] * PARTS / part;
        size_t fewest = SIZE_MAX;
        for (int more = 0; more < 2; more++) {
            double cells = set_cells(l, spacing, more);
            if (cells > most_cells)
                return DEM_OK;
            DEM_TRY(set_places(l, (size_t)cells, error));
            fewest = l->count < fewest ? l->count : fewest;
            // --inscribed leaves out many
            bool few = l->count <= l->c->options->spheres || l->c->options->side == DEM_SIDE_INSCRIBED;
            if (l->count && few)
                DEM_TRY(try_fills(l, fill, false, &least, error));
        }
        if ((double)fewest > (l->c->options->side == DEM_SIDE_INSCRIBED ? 8 : 2) * spheres)
            return DEM_OK;
        DEM_TRY(dem_classic_go_on(l->c, fewest / (2 * spheres), error));
    }
}

static dem_status place(dem_classic *c, dem_error *error)
{
    lattice l = {.c = c, .fill = FILLS - 1};
    double spacing = c->value[SPACING], fill = c->value[FILL];
    dem_status status = set_box(c, &l, error);
    if (status == DEM_OK)
        status = isnan(spacing) ? search(&l, fill, error) : place_given(&l, spacing, fill, error);
    if (status == DEM_OK && c->count == 0)
        status = dem_fail(error, DEM_FAILED,
                          "no cubic lattice has between 1 and %zu points inside this grain; allow more "
                          "spheres",
                          c->options->spheres);
    free(l.places);
    free(l.balls);
    return status;
}

const dem_packer dem_packer_grid = {
    .name = "grid",
    .about = "Voxel spheres: equal spheres on a cubic lattice inside the grain (in use everywhere, no one's paper). "
             "Spacing and radius not given are those of least gap with "
             "at most -n spheres.",
    .parameters = parameters,
    .parameter_count = sizeof parameters / sizeof *parameters,
    .count_parameters = 1,
    .order = "those deepest inside first",
    .run = dem_classic_run,
    .place = place,
};
