// Compiled once as it is (plain) and once per instruction set with DEM_KERNELS set to v3 or v4.
#include "sim/kernels.h"

#include "base/level.h"
#include "sim/contact.h"
#include "sim/drift.h"
#include "sim/slab.h"

// what people run; every other mix goes through `any`, which asks for each feature as it goes
#define LINEAR .linear = true, .friction = true, .slide_damping = true
#define HERTZ .hertz = true, .friction = true, .mindlin = true, .slide_damping = true
#define RATE .rate = true
#define RESTITUTION .restitution = true, .cut = true, .local_mass = true
#ifdef DEM_FEW_KERNELS
#define INSTANCES(X)
#else
#define CLUMPS .ledger = true, .offset = true
#define SIZES .ledger = true, .offset = true, .scaled = true
#define AUTO .watch = true
#define INSTANCES(X)                                                                                                   \
    X(linear_rate_spheres, LINEAR, RATE, .ledger = true)                                                               \
    X(linear_rate, LINEAR, RATE, CLUMPS)                                                                               \
    X(linear_rate_bare_spheres, LINEAR, RATE)                                                                          \
    X(linear_rate_bare, LINEAR, RATE, .offset = true)                                                                  \
    X(linear_spheres, LINEAR, RESTITUTION, .ledger = true)                                                             \
    X(linear_clumps, LINEAR, RESTITUTION, CLUMPS)                                                                      \
    X(linear_sizes, LINEAR, RESTITUTION, SIZES)                                                                        \
    X(linear_spheres_auto, LINEAR, RESTITUTION, .ledger = true, AUTO)                                                  \
    X(linear_clumps_auto, LINEAR, RESTITUTION, CLUMPS, AUTO)                                                           \
    X(linear_sizes_auto, LINEAR, RESTITUTION, SIZES, AUTO)                                                             \
    X(hertz_spheres, HERTZ, RESTITUTION, .ledger = true)                                                               \
    X(hertz_clumps, HERTZ, RESTITUTION, CLUMPS)                                                                        \
    X(hertz_sizes, HERTZ, RESTITUTION, SIZES)                                                                          \
    X(hertz_spheres_auto, HERTZ, RESTITUTION, .ledger = true, AUTO)                                                    \
    X(hertz_clumps_auto, HERTZ, RESTITUTION, CLUMPS, AUTO)                                                             \
    X(hertz_sizes_auto, HERTZ, RESTITUTION, SIZES, AUTO)
#endif

#define KERNELS_OF(name, f)                                                                                            \
    static void name##_pairs(dem_features given, const dem_rows *rows, const dem_contact_job *job)                     \
    {                                                                                                                  \
        (void)given;                                                                                                   \
        contact_batches(f, rows, job, false, DEM_FORM_PLANE, false);                                                   \
    }                                                                                                                  \
    static void name##_planes(dem_features given, const dem_rows *rows, const dem_contact_job *job)                    \
    {                                                                                                                  \
        (void)given;                                                                                                   \
        contact_batches(f, rows, job, true, DEM_FORM_PLANE, false);                                                    \
    }                                                                                                                  \
    static void name##_meshes(dem_features given, const dem_rows *rows, const dem_contact_job *job)                    \
    {                                                                                                                  \
        (void)given;                                                                                                   \
        contact_batches(f, rows, job, true, DEM_FORM_MESH, false);                                                     \
    }
#define INSTANCE(name, ...) KERNELS_OF(name, ((dem_features){__VA_ARGS__}))
INSTANCES(INSTANCE)

static void any_pairs(dem_features f, const dem_rows *rows, const dem_contact_job *job)
{
    if (job->records)
        contact_batches(f, rows, job, false, DEM_FORM_PLANE, true);
    else
        contact_batches(f, rows, job, false, DEM_FORM_PLANE, false);
}

#define ANY_WALLS(name, form)                                                                                          \
    static void any_##name(dem_features f, const dem_rows *rows, const dem_contact_job *job)                           \
    {                                                                                                                  \
        if (job->records)                                                                                              \
            contact_batches(f, rows, job, true, form, true);                                                           \
        else                                                                                                           \
            contact_batches(f, rows, job, true, form, false);                                                          \
    }
ANY_WALLS(planes, DEM_FORM_PLANE)
ANY_WALLS(cylinders, DEM_FORM_CYLINDER)
ANY_WALLS(meshes, DEM_FORM_MESH)

#define ENTRY(name, ...) {#name, {__VA_ARGS__}, false, name##_pairs, {name##_planes, any_cylinders, name##_meshes}},
static const dem_contact_instance instances[] = {
    INSTANCES(ENTRY){"any", {0}, true, any_pairs, {any_planes, any_cylinders, any_meshes}},
};

static void move(const dem_rows *rows, dem_motion_job *job)
{
    bool damped = job->local > 0 || job->viscous > 0;
    if (job->bounded)
        move_bodies(rows, job, damped, true, NULL);
    else if (damped)
        move_bodies(rows, job, true, false, NULL);
    else
        move_bodies(rows, job, false, false, NULL);
}

static void cull(dem_cull_job *job)
{
    cull_pair(job);
}

static void scan(dem_scan_job *job)
{
    scan_cells(job);
}

const dem_kernels DEM_LEVEL_OF(dem_kernels) = {
    .name = DEM_LEVEL_NAME,
    .instances = instances,
    .instance_count = sizeof instances / sizeof *instances,
    .move = move,
    .cull = cull,
    .scan = scan,
};
