#include "mesh/roughen.h"

#include <stdlib.h>

#include "base/memory.h"
#include "base/random.h"
#include "math/sum.h"
#include "mesh/crossings.h"

enum { WAVES = 128, STREAM = 1001, SIDES_PER_WAVE = 6, BLOCK = 1 << 15, MOST_ROUNDS = 100 };

static const double LEAST = 0.1, STEP = 0.8;  // of the amplitude, where it has to give way
static const double HIGHEST = 4;              // heights, over the amplitude

// Wave vectors point everywhere in space; what a surface sees of one is its part along the surface, on average
// sqrt(2/3) of it. So they are longer by the inverse.
typedef struct waves {
    dem_vec3 k[WAVES];
    double phase[WAVES];
} waves;

static void draw_waves(waves *w, double wavelength, uint64_t seed)
{
    dem_random random = random_stream(seed, STREAM);
    double length = sqrt(1.5) * 2 * DEM_PI / wavelength;
    for (int i = 0; i < WAVES; i++) {
        double z = 2 * random_uniform(&random) - 1, angle = 2 * DEM_PI * random_uniform(&random), s = sqrt(1 - z * z);
        w->k[i] = v3_scale(v3(s * cos(angle), s * sin(angle), z), length);
        w->phase[i] = 2 * DEM_PI * random_uniform(&random);
    }
}

static double height(const waves *w, dem_vec3 p)
{
    double sum = 0;
    for (int i = 0; i < WAVES; i++)
        sum += cos(v3_dot(w->k[i], p) + w->phase[i]);
    return sum;
}

static double corner_angle(dem_vec3 a, dem_vec3 b)
{
    return atan2(v3_norm(v3_cross(a, b)), v3_dot(a, b));
}

// angle-weighted normals
static void find_normals(const dem_mesh *mesh, dem_vec3 *normals)
{
    for (size_t i = 0; i < mesh->vertex_count; i++)
        normals[i] = v3(0, 0, 0);
    for (size_t t = 0; t < mesh->triangle_count; t++) {
        const uint32_t *v = &mesh->triangles[3 * t];
        dem_vec3 p[3] = {mesh->vertices[v[0]], mesh->vertices[v[1]], mesh->vertices[v[2]]};
        dem_vec3 normal = v3_unit(v3_cross(v3_sub(p[1], p[0]), v3_sub(p[2], p[0])));
        for (int k = 0; k < 3; k++) {
            double angle = corner_angle(v3_sub(p[(k + 1) % 3], p[k]), v3_sub(p[(k + 2) % 3], p[k]));
            normals[v[k]] = v3_along(normals[v[k]], angle, normal);
        }
    }
    for (size_t i = 0; i < mesh->vertex_count; i++)
        normals[i] = v3_unit(normals[i]);
}

// Over sharp edges the normals turn at once, and what moves inwards on one side would come out of the other. So they
// turn over as far as the surface moves; where the surface is smooth, this changes nothing.
static bool turn_normals_gradually(const dem_mesh *mesh, dem_vec3 *normals, double reach)
{
    dem_vec3 *sums = dem_alloc(mesh->vertex_count, sizeof *sums);
    double side = sqrt(dem_mesh_solid(mesh).area / (double)mesh->triangle_count * 2.309401076758503);
    double rounds = 1 + ceil(reach / side * reach / side);  // averages spread as the root of their number
    for (int round = 0; sums && round < fmin(rounds, MOST_ROUNDS); round++) {
        for (size_t i = 0; i < mesh->vertex_count; i++)
            sums[i] = normals[i];
        for (size_t t = 0; t < mesh->triangle_count; t++) {
            const uint32_t *v = &mesh->triangles[3 * t];
            for (int k = 0; k < 3; k++)
                sums[v[k]] = v3_add(sums[v[k]], v3_add(normals[v[(k + 1) % 3]], normals[v[(k + 2) % 3]]));
        }
        for (size_t i = 0; i < mesh->vertex_count; i++)
            normals[i] = v3_unit(sums[i]);
    }
    bool done = sums != NULL;
    free(sums);
    return done;
}

double dem_mesh_triangles_for(const dem_mesh *mesh, double wavelength)
{
    dem_sum sides = {0}, area = {0};
    for (size_t t = 0; t < mesh->triangle_count; t++) {
        const uint32_t *v = &mesh->triangles[3 * t];
        dem_vec3 a = mesh->vertices[v[0]], b = mesh->vertices[v[1]], c = mesh->vertices[v[2]];
        double part = v3_norm(v3_cross(v3_sub(b, a), v3_sub(c, a))) / 2;
        double longest = fmax(v3_distance(a, b), fmax(v3_distance(b, c), v3_distance(c, a)));
        sum_add(&sides, part * longest);
        sum_add(&area, part);
    }
    double side = sum_value(sides) / sum_value(area) * SIDES_PER_WAVE / wavelength;
    return (double)mesh->triangle_count * side * side;
}

// mean 0 and root mean square 1 of the field that is linear within each triangle
static void normalise(const dem_mesh *mesh, double *heights)
{
    dem_sum mean = {0}, square = {0}, area = {0};
    for (int pass = 0; pass < 2; pass++) {
        for (size_t t = 0; t < mesh->triangle_count; t++) {
            const uint32_t *v = &mesh->triangles[3 * t];
            dem_vec3 a = mesh->vertices[v[0]], b = mesh->vertices[v[1]], c = mesh->vertices[v[2]];
            double part = v3_norm(v3_cross(v3_sub(b, a), v3_sub(c, a))) / 2;
            double x = heights[v[0]], y = heights[v[1]], z = heights[v[2]];
            sum_add(pass ? &square : &mean,
                    part * (pass ? (x * x + y * y + z * z + x * y + y * z + z * x) / 6 : (x + y + z) / 3));
            sum_add(&area, pass ? 0 : part);
        }
        double middle = sum_value(mean) / sum_value(area);
        for (size_t i = 0; i < mesh->vertex_count && pass == 0; i++)
            heights[i] -= middle;
    }
    double factor = sqrt(sum_value(area) / sum_value(square));
    for (size_t i = 0; i < mesh->vertex_count; i++)
        heights[i] *= factor;
}

// star-shaped about the origin as most grains are, or else free of crossings by a look at all pairs
static dem_status is_sound(const dem_ctx *ctx, const dem_mesh *mesh, bool *sound, dem_error *error)
{
    *sound = true;
    for (size_t t = 0; t < mesh->triangle_count && *sound; t++) {
        const uint32_t *v = &mesh->triangles[3 * t];
        *sound = v3_dot(mesh->vertices[v[0]], v3_cross(mesh->vertices[v[1]], mesh->vertices[v[2]])) > 0;
    }
    if (*sound)
        return DEM_OK;
    dem_tree tree;
    dem_crossings crossings;
    DEM_TRY(dem_tree_build(&tree, mesh->vertices, mesh->triangles, mesh->triangle_count, error));
    dem_status status = dem_mesh_crossings(ctx, mesh, &tree, 0, &crossings, error);
    *sound = crossings.complete && crossings.count == 0 && dem_mesh_solid(mesh).volume > 0;
    free(crossings.pairs);
    dem_tree_release(&tree);
    return status;
}

static dem_status find_heights(const dem_ctx *ctx, const dem_mesh *mesh, const waves *w, double *heights,
                               dem_error *error)
{
    for (size_t begin = 0; begin < mesh->vertex_count; begin += BLOCK) {
        size_t end = begin + BLOCK < mesh->vertex_count ? begin + BLOCK : mesh->vertex_count;
#pragma omp parallel for num_threads(dem_threads(ctx)) schedule(static)
        for (size_t i = begin; i < end; i++)
            heights[i] = height(w, mesh->vertices[i]);
        if (dem_progress(ctx, "roughening", (double)end / (double)mesh->vertex_count))
            return dem_fail(error, DEM_INTERRUPTED, "interrupted; nothing was written");
    }
    normalise(mesh, heights);
    return DEM_OK;
}

dem_status dem_mesh_roughen(const dem_ctx *ctx, dem_mesh *mesh, double amplitude, double wavelength, uint64_t seed,
                            double *reached, dem_error *error)
{
    waves w;
    draw_waves(&w, wavelength, seed);
    double *heights = dem_alloc(mesh->vertex_count, sizeof *heights);
    dem_vec3 *normals = dem_alloc(mesh->vertex_count, sizeof *normals);
    dem_vec3 *smooth = dem_alloc(mesh->vertex_count, sizeof *smooth);
    bool sound = false;
    dem_status status = heights && normals && smooth ? DEM_OK : dem_fail_memory(error);
    if (status == DEM_OK)
        status = find_heights(ctx, mesh, &w, heights, error);
    if (status == DEM_OK) {
        find_normals(mesh, normals);
        if (!turn_normals_gradually(mesh, normals, HIGHEST * amplitude))
            status = dem_fail_memory(error);
        for (size_t i = 0; i < mesh->vertex_count; i++)
            smooth[i] = mesh->vertices[i];
    }
    for (*reached = amplitude; status == DEM_OK && *reached > LEAST * amplitude; *reached *= STEP) {
        for (size_t i = 0; i < mesh->vertex_count; i++)
            mesh->vertices[i] = v3_along(smooth[i], *reached * heights[i], normals[i]);
        status = is_sound(ctx, mesh, &sound, error);
        if (sound)
            break;
    }
    if (status == DEM_OK && !sound)
        status = dem_fail(error, DEM_USAGE,
                          "so rough a surface crosses itself; lower --roughness or raise --roughness-scale");
    free(heights);
    free(normals);
    free(smooth);
    return status;
}
