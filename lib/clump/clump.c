// A clump is one block: this header, then the arrays and texts it names by their offset from its start. Every
// field is eight bytes wide and unused room is zero, so equal clumps are equal bytes and have equal hashes.
#include <stdlib.h>
#include <string.h>

#include "base/json.h"
#include "base/memory.h"
#include "base/random.h"
#include "dem/clump.h"
#include "math/quat.h"

enum {
    LAYOUT = 1,
    TEXTS = 7,  // name, three of the source, method, parameters, version
};

// lengths and radii beyond this have no finite square
static const double LARGEST = 1e100;

struct dem_clump {
    uint64_t layout;
    uint64_t bytes;
    double seconds;  // differs from one making to the next, so it stands before the hash
    uint64_t hash;   // of everything behind it
    double density, mass, volume, inertia[3];
    uint64_t mass_from;
    dem_vec3 position;
    dem_quat orientation;
    double union_volume, union_inertia[3];
    dem_vec3 union_centre;
    dem_fidelity fidelity;
    dem_shape shape;
    uint64_t seed;
    uint64_t ball_count, vertex_count, triangle_count;
    uint64_t balls, vertices, triangles, texts[TEXTS];  // offsets [bytes]
};
_Static_assert(sizeof(size_t) == 8, "dem_fidelity would have unused room, whose bytes the hash must not see");

static dem_status refuse(dem_error *error, const char *what)
{
    return dem_fail(error, DEM_BAD_INPUT, "%s", what);
}

static bool usable(double x)
{
    return fabs(x) < LARGEST;
}

static bool usable_vec(dem_vec3 v)
{
    return usable(v.x) && usable(v.y) && usable(v.z);
}

static bool positive(double x)
{
    return x > 0 && isfinite(x);
}

static double quat_norm(dem_quat q)
{
    return sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
}

static dem_status check_balls(const dem_clump_def *def, dem_error *error)
{
    if (def->ball_count == 0)
        return refuse(error, "spheres: there are none; a clump needs at least one");
    for (size_t i = 0; i < def->ball_count; i++) {
        const dem_ball *b = &def->balls[i];
        if (!usable_vec(b->centre))
            return dem_fail(error, DEM_BAD_INPUT,
                            "spheres[%zu]: its centre is not finite or beyond 1e100 m; correct it", i);
        if (!(b->radius > 1 / LARGEST && b->radius < LARGEST))
            return dem_fail(error, DEM_BAD_INPUT, "spheres[%zu]: its radius must be positive; correct or remove it", i);
    }
    return DEM_OK;
}

static dem_status check_mass(const dem_clump_def *def, dem_error *error)
{
    if (!positive(def->density))
        return refuse(error, "density: must be positive and finite; give it in kg/m^3");
    if (!positive(def->mass))
        return refuse(error, "mass: must be positive and finite; give it in kg");
    if (!positive(def->volume))
        return refuse(error, "volume: must be positive and finite; give it in m^3");
    const double *moment = def->inertia;
    for (int k = 0; k < 3; k++)
        if (!positive(moment[k]))
            return refuse(error, "inertia: needs three positive principal moments; give them in kg m^2");
    if (moment[0] > moment[1] || moment[1] > moment[2])
        return refuse(error, "inertia: must ascend, I1 <= I2 <= I3; order the axes (and turn the spheres with them)");
    // equality is a flat plate; the slack is for moments that were rounded
    if (moment[2] > (moment[0] + moment[1]) * (1 + 1e-9))
        return refuse(error, "inertia: I3 is larger than I1 + I2, which no body can have; check the moments");
    if (def->mass_from > DEM_MASS_GIVEN)
        return refuse(error, "mass_from: must be that of the mesh, of the union, or given; use one of these");
    if (!(isnan(def->union_volume) || positive(def->union_volume)))
        return refuse(error, "union.volume: must be positive and finite; leave it out where it is not known");
    return DEM_OK;
}

static dem_status check_surface(const dem_mesh *surface, dem_error *error)
{
    if (surface->triangle_count == 0)
        return DEM_OK;
    for (size_t i = 0; i < surface->vertex_count; i++)
        if (!usable_vec(surface->vertices[i]))
            return dem_fail(error, DEM_BAD_INPUT, "surface.vertices[%zu]: is not finite; correct it", i);
    for (size_t i = 0; i < 3 * surface->triangle_count; i++)
        if (surface->triangles[i] >= surface->vertex_count)
            return dem_fail(
                error, DEM_BAD_INPUT,
                "surface.triangles[%zu]: vertex %lu does not exist, there are %zu (counted from 0); correct it", i / 3,
                (unsigned long)surface->triangles[i], surface->vertex_count);
    return DEM_OK;
}

static dem_status check_pose(const dem_clump_def *def, dem_error *error)
{
    if (!usable_vec(def->position))
        return refuse(error, "to_mesh.position: is not finite; give x, y, z in metres");
    double norm = quat_norm(def->orientation);
    if (!(fabs(norm - 1) <= 1e-3))
        return dem_fail(error, DEM_BAD_INPUT,
                        "to_mesh.orientation: must be a unit quaternion w, x, y, z, has length %.6g; %s", norm,
                        "[1, 0, 0, 0] means not turned");
    return DEM_OK;
}

// the text of a JSON object in the one form that is written and read back unchanged; free it
static dem_status compact_object(const char *text, char **compact, dem_error *error)
{
    dem_json *root;
    if (!text || !*text)
        text = "{}";
    bool object = dem_json_parse(text, strlen(text), NULL, &root, NULL) == DEM_OK && dem_json_is_object(root);
    *compact = object ? dem_json_text(root) : NULL;
    dem_json_release(root);
    if (!object)
        return refuse(error, "made.parameters: must be a JSON object, as in {\"spheres\": 50}");
    return *compact ? DEM_OK : dem_fail_memory(error);
}

static uint64_t hash_words(const void *begin, const void *end)
{
    uint64_t hash = 0, word;
    for (const char *p = begin; p < (const char *)end; p += sizeof word) {
        memcpy(&word, p, sizeof word);
        hash = random_mix((hash + 0x9e3779b97f4a7c15u) ^ word) + hash;
    }
    return hash;
}

// room for `bytes` at the end of a block, in whole words
static uint64_t reserve(uint64_t *end, uint64_t bytes)
{
    uint64_t at = *end;
    *end += (bytes + 7) / 8 * 8;
    return at;
}

// what is not known has many bit patterns; the block has one
static void tidy(double *values, size_t count)
{
    for (size_t i = 0; i < count; i++)
        if (!isfinite(values[i]))
            values[i] = NAN;
}

// the values of `def` without its arrays and texts
static dem_clump header_of(const dem_clump_def *def)
{
    dem_clump header = {.layout = LAYOUT,
                        .seconds = def->seconds,
                        .density = def->density,
                        .mass = def->mass,
                        .volume = def->volume,
                        .mass_from = def->mass_from,
                        .position = def->position,
                        .orientation = def->orientation,
                        .union_volume = def->union_volume,
                        .union_centre = def->union_centre,
                        .fidelity = def->fidelity,
                        .shape = def->shape,
                        .seed = def->seed,
                        .ball_count = def->ball_count};
    memcpy(header.inertia, def->inertia, sizeof header.inertia);
    memcpy(header.union_inertia, def->union_inertia, sizeof header.union_inertia);
    if (fabs(quat_norm(def->orientation) - 1) > 1e-12)  // typed by hand: 0.707
        header.orientation = quat_unit(def->orientation);
    tidy(&header.seconds, 1);
    tidy(&header.union_volume, 1);
    tidy(header.union_inertia, 3);
    tidy(&header.union_centre.x, 3);
    tidy(&header.fidelity.iou_gap, offsetof(dem_fidelity, pieces) / sizeof(double));
    tidy(&header.shape.equivalent_diameter, sizeof header.shape / sizeof(double));
    if (def->surface.triangle_count) {
        header.vertex_count = def->surface.vertex_count;
        header.triangle_count = def->surface.triangle_count;
    }
    return header;
}

dem_status dem_clump_create(const dem_clump_def *def, dem_clump **clump, dem_error *error)
{
    *clump = NULL;
    DEM_TRY(check_balls(def, error));
    DEM_TRY(check_mass(def, error));
    DEM_TRY(check_pose(def, error));
    DEM_TRY(check_surface(&def->surface, error));
    char *parameters;
    DEM_TRY(compact_object(def->parameters, &parameters, error));

    dem_clump header = header_of(def);
    uint64_t end = sizeof header;
    header.balls = reserve(&end, header.ball_count * sizeof(dem_ball));
    header.vertices = reserve(&end, header.vertex_count * sizeof(dem_vec3));
    header.triangles = reserve(&end, header.triangle_count * 3 * sizeof(uint32_t));
    const char *texts[TEXTS] = {def->name,   def->source_mesh, def->source_sha256, def->source_unit,
                                def->method, parameters,       def->version};
    for (int i = 0; i < TEXTS; i++)
        header.texts[i] = reserve(&end, texts[i] ? strlen(texts[i]) + 1 : 1);
    header.bytes = end;

    char *block = dem_alloc_zero(1, end);
    if (block) {
        memcpy(block, &header, sizeof header);
        memcpy(block + header.balls, def->balls, header.ball_count * sizeof(dem_ball));
        if (header.triangle_count) {
            memcpy(block + header.vertices, def->surface.vertices, header.vertex_count * sizeof(dem_vec3));
            memcpy(block + header.triangles, def->surface.triangles, header.triangle_count * 3 * sizeof(uint32_t));
        }
        for (int i = 0; i < TEXTS; i++)
            if (texts[i])
                strcpy(block + header.texts[i], texts[i]);
        *clump = (dem_clump *)block;
        (*clump)->hash = hash_words(&(*clump)->hash + 1, block + end);
    }
    free(parameters);
    return block ? DEM_OK : dem_fail_memory(error);
}

void dem_clump_destroy(dem_clump *clump)
{
    free(clump);
}

size_t dem_clump_bytes(const dem_clump *clump)
{
    return clump->bytes;
}

uint64_t dem_clump_hash(const dem_clump *clump)
{
    return clump->hash;
}

dem_clump_def dem_clump_view(const dem_clump *clump)
{
    char *block = (char *)clump;
    const char *texts[TEXTS];
    for (int i = 0; i < TEXTS; i++)
        texts[i] = block + clump->texts[i];
    dem_clump_def view = {.name = texts[0],
                          .source_mesh = texts[1],
                          .source_sha256 = texts[2],
                          .source_unit = texts[3],
                          .density = clump->density,
                          .mass = clump->mass,
                          .volume = clump->volume,
                          .mass_from = (dem_mass_source)clump->mass_from,
                          .position = clump->position,
                          .orientation = clump->orientation,
                          .union_volume = clump->union_volume,
                          .union_centre = clump->union_centre,
                          .balls = (const dem_ball *)(block + clump->balls),
                          .ball_count = clump->ball_count,
                          .fidelity = clump->fidelity,
                          .shape = clump->shape,
                          .method = texts[4],
                          .parameters = texts[5],
                          .seed = clump->seed,
                          .seconds = clump->seconds,
                          .version = texts[6]};
    memcpy(view.inertia, clump->inertia, sizeof view.inertia);
    memcpy(view.union_inertia, clump->union_inertia, sizeof view.union_inertia);
    if (clump->triangle_count)
        view.surface = (dem_mesh){.vertices = (dem_vec3 *)(block + clump->vertices),
                                  .vertex_count = clump->vertex_count,
                                  .triangles = (uint32_t *)(block + clump->triangles),
                                  .triangle_count = clump->triangle_count};
    return view;
}
