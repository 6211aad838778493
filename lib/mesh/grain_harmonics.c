/// Sand grains as a sum of spherical harmonics, r(u) = sum c_nm Y_nm(u), with real orthonormal Y_nm.
///
/// The descriptors D_n = sqrt(sum_m c_nm^2) / c_00 do not change when the grain is turned or scaled (Zhou, Wang &
/// Zhao 2015, doi:10.1016/j.enggeo.2014.11.009; Zhou & Wang 2017, doi:10.1002/nag.2548). D_2 tells how far the form
/// is from a sphere, D_3 to D_8 how round its corners are, D_9 to D_15 how rough it is. Natural sands follow
/// D_n ~ n^-2H with the Hurst exponent H (Wei, Wang, Nie & Zhou 2018, Computers and Geotechnics 104). D_1 would mostly
/// move the grain and is 0. Within a degree the c_nm are independent normal numbers scaled to D_n exactly: the
/// direction of each (2n+1)-vector is uniform, so no orientation is preferred.
#include <stdlib.h>

#include "base/memory.h"
#include "mesh/grain.h"
#include "mesh/harmonics.h"

enum { D2, D8, EXPONENT, ROUGHNESS, FORM, DEGREE };
enum { STREAM = 2 };

static const dem_grain_param params[] = {
    [D2] = {"d2", 0.1, 0, 0.4, "-", "D2: how far from a sphere the form is"},
    [D8] = {"d8", 0.01, 0, 0.1, "-", "D8: how angular; from D3 on, D_n = D8 (n/8)^-exponent"},
    [EXPONENT] = {"exponent", 1.5, 0, 6, "-", "of that power law, twice the Hurst exponent"},
    [ROUGHNESS] = {"roughness-factor", 1, 0, 10, "-", "factor on D9 and up"},
    [FORM] = {"form", NAN, -1, 1, "-", "what D2 makes: -1 flat, 0 three different axes, 1 elongated"},
    [DEGREE] = {"degree", 15, 2, DEM_HARMONICS_DEGREE, "count", "highest degree of the sum"},
};

// degree 2 is a traceless tensor u^T Q u. Its eigenvalues go as cos(t), cos(t - 2 pi/3), cos(t + 2 pi/3); for random
// coefficients cos(3t) is uniform in -1..1, which is our `form`. The axes are put along x, y, z, longest first.
static void set_form(dem_harmonics *h, double d2, double form)
{
    double t = acos(form) / 3, x = cos(t), y = cos(t - 2 * DEM_PI / 3), z = cos(t + 2 * DEM_PI / 3);
    // Y_20 = sqrt(5/16pi) (3 z^2 - 1) and Y_22 = sqrt(15/16pi) (x^2 - y^2)
    double c20 = z / sqrt(5.0), c22 = (x - y) / sqrt(15.0);
    double scale = d2 * h->c[0] / sqrt(c20 * c20 + c22 * c22);
    h->c[harmonics_term(2, 0)] = scale * c20;
    h->c[harmonics_term(2, 2)] = scale * c22;
}

static void draw(dem_harmonics *h, const dem_grain_request *request)
{
    const double *v = request->values;
    h->c[0] = sqrt(4 * DEM_PI);  // mean radius 1
    dem_random random = random_stream(request->seed, STREAM);
    set_form(h, v[D2], isnan(v[FORM]) ? 2 * random_uniform(&random) - 1 : v[FORM]);
    for (int n = 3; n <= h->degree; n++)
        dem_harmonics_draw(h, n, v[D8] * pow(n / 8.0, -v[EXPONENT]) * (n > 8 ? v[ROUGHNESS] : 1), &random);
}

static dem_status make(const dem_ctx *ctx, const dem_grain_request *request, dem_mesh *mesh, dem_error *error)
{
    dem_harmonics *h = dem_alloc(1, sizeof *h);
    if (!h)
        return dem_fail_memory(error);
    dem_harmonics_init(h, (int)request->values[DEGREE]);
    draw(h, request);
    dem_status status = dem_harmonics_mesh(ctx, h, request->triangles, mesh, error);
    free(h);
    return status;
}

const dem_grain_kind dem_grain_harmonics = {
    .name = "harmonics",
    .paper = "Zhou & Wang 2017, doi:10.1002/nag.2548; Wei, Wang, Nie & Zhou 2018, Comput. Geotech. 104",
    .about = "Sand: spherical harmonics with given descriptors D_n = sqrt(sum_m c_nm^2) / c_00.",
    .params = params,
    .param_count = sizeof params / sizeof *params,
    .make = make,
};
