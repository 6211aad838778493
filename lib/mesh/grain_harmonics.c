/// Sand grains as a sum of spherical harmonics, r(u) = sum c_nm Y_nm(u), with real orthonormal Y_nm.
///
/// The descriptors D_n = sqrt(sum_m c_nm^2) / c_00 do not change when the grain is turned or scaled (Zhou, Wang &
/// Zhao 2015, doi:10.1016/j.enggeo.2014.11.009; Zhou & Wang 2017, doi:10.1002/nag.2548). D_2 tells how far the form
/// is from a sphere, D_3 to D_8 how round its corners are, D_9 to D_15 how rough it is. Natural sands follow
/// D_n ~ n^-2H with the Hurst exponent H (Wei, Wang, Nie & Zhou 2018, Computers and Geotechnics 104). D_1 would mostly
/// move the grain and is 0. Within a degree the c_nm are independent normal numbers scaled to D_n exactly: the
/// direction of each (2n+1)-vector is uniform, so no orientation is preferred.
#include <stdlib.h>

#include "math/vec.h"
#include "mesh/grain.h"
#include "mesh/icosphere.h"

enum { MAX_DEGREE = 30, TERMS = (MAX_DEGREE + 1) * (MAX_DEGREE + 1), BLOCK = 1 << 15 };
enum { D2, D8, EXPONENT, ROUGHNESS, FORM, DEGREE };
enum { STREAM = 2 };

static const double THINNEST = 0.1;  // smallest radius of a usable grain, part of the mean

static const dem_grain_param params[] = {
    [D2] = {"d2", 0.1, 0, 0.4, "-", "D2: how far from a sphere the form is"},
    [D8] = {"d8", 0.01, 0, 0.1, "-", "D8: how angular; from D3 on, D_n = D8 (n/8)^-exponent"},
    [EXPONENT] = {"exponent", 1.5, 0, 6, "-", "of that power law, twice the Hurst exponent"},
    [ROUGHNESS] = {"roughness", 1, 0, 10, "-", "factor on D9 and up"},
    [FORM] = {"form", NAN, -1, 1, "-", "what D2 makes: -1 flat, 0 three different axes, 1 elongated"},
    [DEGREE] = {"degree", 15, 2, MAX_DEGREE, "count", "highest degree of the sum"},
};

typedef struct harmonics {
    int degree;
    double c[TERMS];                  // c_nm at n^2 + n + m; m < 0 are the sines
    double rise[TERMS], fall[TERMS];  // of the Legendre recurrence, at n^2 + n + m
    double sector[MAX_DEGREE + 1];    // P_mm / sin^m
} harmonics;

static int term(int n, int m)
{
    return n * n + n + m;
}

// fully normalised Legendre functions, without their factor sin^m(theta), by the recurrence that is stable for
// rising degree (Holmes & Featherstone 2002, doi:10.1007/s00190-002-0216-2)
static void prepare_recurrence(harmonics *h)
{
    h->sector[0] = sqrt(1 / (4 * DEM_PI));
    for (int m = 0; m <= h->degree; m++) {
        if (m > 0)
            h->sector[m] = h->sector[m - 1] * sqrt((2.0 * m + 1) / (2.0 * m));
        for (int n = m + 1; n <= h->degree; n++) {
            double n2 = (double)n * n, m2 = (double)m * m, below = (n - 1.0) * (n - 1.0);
            h->rise[term(n, m)] = sqrt((4 * n2 - 1) / (n2 - m2));
            h->fall[term(n, m)] = n > m + 1 ? sqrt((2.0 * n + 1) * (below - m2) / ((2.0 * n - 3) * (n2 - m2))) : 0;
        }
    }
}

static double radius(const harmonics *h, dem_vec3 u)
{
    double r = 0, cosine = 1, sine = 0;  // Re and Im of (x + iy)^m = sin^m(theta) e^(i m phi)
    for (int m = 0; m <= h->degree; m++) {
        double before = 0, p = h->sector[m], even = 0, odd = 0;
        for (int n = m;; n++) {
            even += h->c[term(n, m)] * p;
            odd += h->c[term(n, -m)] * p;
            if (n == h->degree)
                break;
            double next = h->rise[term(n + 1, m)] * u.z * p - h->fall[term(n + 1, m)] * before;
            before = p;
            p = next;
        }
        r += m == 0 ? even : sqrt(2.0) * (even * cosine + odd * sine);
        double turned = cosine * u.x - sine * u.y;
        sine = cosine * u.y + sine * u.x;
        cosine = turned;
    }
    return r;
}

// degree 2 is a traceless tensor u^T Q u. Its eigenvalues go as cos(t), cos(t - 2 pi/3), cos(t + 2 pi/3); for random
// coefficients cos(3t) is uniform in -1..1, which is our `form`. The axes are put along x, y, z, longest first.
static void set_form(harmonics *h, double d2, double form)
{
    double t = acos(form) / 3, x = cos(t), y = cos(t - 2 * DEM_PI / 3), z = cos(t + 2 * DEM_PI / 3);
    // Y_20 = sqrt(5/16pi) (3 z^2 - 1) and Y_22 = sqrt(15/16pi) (x^2 - y^2)
    double c20 = z / sqrt(5.0), c22 = (x - y) / sqrt(15.0);
    double scale = d2 * h->c[0] / sqrt(c20 * c20 + c22 * c22);
    h->c[term(2, 0)] = scale * c20;
    h->c[term(2, 2)] = scale * c22;
}

static void draw(harmonics *h, const dem_grain_request *request)
{
    const double *v = request->values;
    h->c[0] = sqrt(4 * DEM_PI);  // mean radius 1
    dem_random random = random_stream(request->seed, STREAM);
    set_form(h, v[D2], isnan(v[FORM]) ? 2 * random_uniform(&random) - 1 : v[FORM]);
    for (int n = 3; n <= h->degree; n++) {
        double d = v[D8] * pow(n / 8.0, -v[EXPONENT]) * (n > 8 ? v[ROUGHNESS] : 1), norm = 0;
        for (int m = -n; m <= n; m++) {
            h->c[term(n, m)] = random_normal(&random);
            norm += h->c[term(n, m)] * h->c[term(n, m)];
        }
        for (int m = -n; m <= n; m++)
            h->c[term(n, m)] *= d * h->c[0] / sqrt(norm);
    }
}

static dem_status place(const dem_ctx *ctx, const harmonics *h, dem_mesh *mesh, dem_error *error)
{
    double thinnest = INFINITY;
    for (size_t begin = 0; begin < mesh->vertex_count; begin += BLOCK) {
        size_t end = begin + BLOCK < mesh->vertex_count ? begin + BLOCK : mesh->vertex_count;
#pragma omp parallel for num_threads(dem_threads(ctx)) reduction(min : thinnest) schedule(static)
        for (size_t i = begin; i < end; i++) {
            double r = radius(h, mesh->vertices[i]);
            thinnest = r < thinnest ? r : thinnest;
            mesh->vertices[i] = v3_scale(mesh->vertices[i], r);
        }
        if (dem_progress(ctx, "making", (double)end / (double)mesh->vertex_count))
            return dem_fail(error, DEM_INTERRUPTED, "interrupted; nothing was written");
    }
    if (thinnest < THINNEST)
        return dem_fail(error, DEM_USAGE,
                        "the grain of these descriptors and this seed is hollowed out to its "
                        "centre; lower d2 or d8, or take another seed");
    return DEM_OK;
}

static dem_status make(const dem_ctx *ctx, const dem_grain_request *request, dem_mesh *mesh, dem_error *error)
{
    DEM_TRY(dem_icosphere(dem_icosphere_frequency(request->triangles), mesh, error));
    harmonics h = {.degree = (int)request->values[DEGREE]};
    prepare_recurrence(&h);
    draw(&h, request);
    return place(ctx, &h, mesh, error);
}

const dem_grain_kind dem_grain_harmonics = {
    .name = "harmonics",
    .paper = "Zhou & Wang 2017, doi:10.1002/nag.2548; Wei, Wang, Nie & Zhou 2018, Comput. Geotech. 104",
    .about = "Sand: spherical harmonics with given descriptors D_n = sqrt(sum_m c_nm^2) / c_00.",
    .params = params,
    .param_count = sizeof params / sizeof *params,
    .make = make,
};
