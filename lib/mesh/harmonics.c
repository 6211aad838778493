#include "mesh/harmonics.h"

#include <stdlib.h>

#include "mesh/icosphere.h"

enum { BLOCK = 1 << 15, SIBLING_STREAM = 5, ATTEMPTS = 50 };

static const double THINNEST = 0.1;  // smallest radius of a usable grain, part of the mean

// fully normalised Legendre functions, without their factor sin^m(theta), by the recurrence that is stable for
// rising degree (Holmes & Featherstone 2002, doi:10.1007/s00190-002-0216-2)
void dem_harmonics_init(dem_harmonics *h, int degree)
{
    *h = (dem_harmonics){.degree = degree};
    h->sector[0] = sqrt(1 / (4 * DEM_PI));
    for (int m = 0; m <= degree; m++) {
        if (m > 0)
            h->sector[m] = h->sector[m - 1] * sqrt((2.0 * m + 1) / (2.0 * m));
        for (int n = m + 1; n <= degree; n++) {
            double n2 = (double)n * n, m2 = (double)m * m, below = (n - 1.0) * (n - 1.0);
            h->rise[harmonics_term(n, m)] = sqrt((4 * n2 - 1) / (n2 - m2));
            h->fall[harmonics_term(n, m)] =
                n > m + 1 ? sqrt((2.0 * n + 1) * (below - m2) / ((2.0 * n - 3) * (n2 - m2))) : 0;
        }
    }
}

double dem_harmonics_radius(const dem_harmonics *h, dem_vec3 u)
{
    double r = 0, cosine = 1, sine = 0;  // Re and Im of (x + iy)^m = sin^m(theta) e^(i m phi)
    for (int m = 0; m <= h->degree; m++) {
        double before = 0, p = h->sector[m], even = 0, odd = 0;
        for (int n = m;; n++) {
            even += h->c[harmonics_term(n, m)] * p;
            odd += h->c[harmonics_term(n, -m)] * p;
            if (n == h->degree)
                break;
            double next = h->rise[harmonics_term(n + 1, m)] * u.z * p - h->fall[harmonics_term(n + 1, m)] * before;
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

double dem_harmonics_power(const dem_harmonics *h, int n)
{
    double sum = 0;
    for (int m = -n; m <= n; m++)
        sum += h->c[harmonics_term(n, m)] * h->c[harmonics_term(n, m)];
    return sqrt(sum) / h->c[0];
}

void dem_harmonics_draw(dem_harmonics *h, int n, double power, dem_random *random)
{
    double norm = 0;
    for (int m = -n; m <= n; m++) {
        double *c = &h->c[harmonics_term(n, m)];
        *c = random_normal(random);
        norm += *c * *c;
    }
    for (int m = -n; m <= n; m++)
        h->c[harmonics_term(n, m)] *= power * h->c[0] / sqrt(norm);
}

dem_status dem_harmonics_mesh(const dem_ctx *ctx, const dem_harmonics *h, size_t triangles, dem_mesh *mesh,
                              dem_error *error)
{
    DEM_TRY(dem_icosphere(dem_icosphere_frequency(triangles), mesh, error));
    double thinnest = INFINITY;
    dem_status status = DEM_OK;
    for (size_t begin = 0; begin < mesh->vertex_count && status == DEM_OK; begin += BLOCK) {
        size_t end = begin + BLOCK < mesh->vertex_count ? begin + BLOCK : mesh->vertex_count;
#pragma omp parallel for num_threads(dem_threads(ctx)) reduction(min : thinnest) schedule(static)
        for (size_t i = begin; i < end; i++) {
            double r = dem_harmonics_radius(h, mesh->vertices[i]);
            thinnest = r < thinnest ? r : thinnest;
            mesh->vertices[i] = v3_scale(mesh->vertices[i], r);
        }
        if (dem_progress(ctx, "making", (double)end / (double)mesh->vertex_count))
            status = dem_fail(error, DEM_INTERRUPTED, "interrupted; nothing was written");
    }
    if (status == DEM_OK && !(thinnest >= THINNEST * h->c[0] / sqrt(4 * DEM_PI)))
        status = dem_fail(error, DEM_USAGE,
                          "the grain of these descriptors and this seed is hollowed out to its "
                          "centre; lower d2 or d8, or take another seed");
    if (status != DEM_OK)
        dem_mesh_free(mesh);
    return status;
}

dem_status dem_harmonics_sibling(const dem_ctx *ctx, const dem_harmonics *of, int kept, uint64_t seed, size_t triangles,
                                 dem_harmonics *sibling, dem_mesh *mesh, dem_error *error)
{
    for (int attempt = 0; attempt < ATTEMPTS; attempt++) {
        *sibling = *of;
        for (int n = kept + 1 > 1 ? kept + 1 : 1; n <= of->degree; n++) {
            // a stream per degree: what is kept of the lower ones does not change the higher
            uint64_t stream = SIBLING_STREAM + 100 * (uint64_t)n + 10000 * (uint64_t)attempt;
            dem_random random = random_stream(seed, stream);
            dem_harmonics_draw(sibling, n, dem_harmonics_power(of, n), &random);
        }
        dem_status status = dem_harmonics_mesh(ctx, sibling, triangles, mesh, error);
        if (status != DEM_USAGE)
            return status;
    }
    return dem_fail(error, DEM_USAGE,
                    "its siblings are hollowed out to their centres; keep more degrees of it, or fit a lower degree");
}
