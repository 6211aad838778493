#include "out/network.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/file.h"
#include "base/memory.h"
#include "math/vec.h"
#include "out/pvd.h"
#include "out/vtp.h"

struct dem_network {
    char *directory;
    const char *name;  // of the index and of the files
    dem_domain_def domain;
    dem_file_queue *queue;
    dem_pvd index;
};

// ---- beginning

static dem_status begin(dem_network *n, double resume, dem_error *error)
{
    char index_name[24], prefix[24];
    snprintf(index_name, sizeof index_name, "%s.pvd", n->name);
    snprintf(prefix, sizeof prefix, "%s_", n->name);
    char *folder = n->directory ? dem_path_join(n->directory, "frames") : NULL;
    dem_status status = folder ? dem_folder_create(folder, error) : dem_fail_memory(error);
    free(folder);
    DEM_TRY(status);
    if (isnan(resume)) {
        char *index = dem_path_join(n->directory, "%s", index_name);
        if (!index)
            return dem_fail_memory(error);
        unlink(index);
        free(index);
    }
    DEM_TRY(dem_pvd_open(n->directory, index_name, resume, &n->index, error));
    n->index.queue = n->queue;
    return dem_pvd_remove(n->directory, "frames", prefix, n->index.count, error);
}

dem_status dem_network_open(const char *directory, const char *name, const dem_domain_def *domain,
                            dem_file_queue *queue, double resume, dem_network **network, dem_error *error)
{
    dem_network *n = *network = dem_alloc_zero(1, sizeof *n);
    if (!n)
        return dem_fail_memory(error);
    n->domain = *domain;
    n->name = name;
    n->queue = queue;
    n->directory = strdup(directory);
    dem_status status = begin(n, resume, error);
    if (status != DEM_OK) {
        dem_network_close(n);
        *network = NULL;
    }
    return status;
}

void dem_network_close(dem_network *n)
{
    if (!n)
        return;
    dem_pvd_release(&n->index);
    free(n->directory);
    free(n);
}

// ---- lines

typedef struct columns {
    dem_vec3 *points, *force;
    uint32_t *ends;
    double *normal_force, *friction_force, *overlap;
    int32_t *kind, *body, *other, *wall;
} columns;

static bool make_columns(columns *c, size_t n)
{
    *c = (columns){dem_alloc(2 * n, sizeof *c->points),     dem_alloc(n, sizeof *c->force),
                   dem_alloc(2 * n, sizeof *c->ends),       dem_alloc(n, sizeof *c->normal_force),
                   dem_alloc(n, sizeof *c->friction_force), dem_alloc(n, sizeof *c->overlap),
                   dem_alloc(n, sizeof *c->kind),           dem_alloc(n, sizeof *c->body),
                   dem_alloc(n, sizeof *c->other),          dem_alloc(n, sizeof *c->wall)};
    return c->points && c->force && c->ends && c->normal_force && c->friction_force && c->overlap && c->kind &&
           c->body && c->other && c->wall;
}

static void release_columns(columns *c)
{
    void *all[] = {c->points,  c->force, c->ends, c->normal_force, c->friction_force,
                   c->overlap, c->kind,  c->body, c->other,        c->wall};
    for (size_t i = 0; i < sizeof all / sizeof *all; i++)
        free(all[i]);
}

// of a body's images the one that is nearest to a point
static dem_vec3 image_near(const dem_domain_def *d, dem_vec3 x, dem_vec3 point)
{
    for (int k = 0; k < 3; k++)
        if (d->periodic[k]) {
            double side = v3_get(d->high, k) - v3_get(d->low, k);
            v3_set(&x, k, v3_get(x, k) + side * round((v3_get(point, k) - v3_get(x, k)) / side));
        }
    return x;
}

static void set_line(const dem_network *n, columns *c, size_t i, const dem_body_view *bodies,
                     const dem_contact *contact)
{
    bool wall = contact->other == UINT32_MAX;
    dem_vec3 x = bodies->position[contact->body], point = image_near(&n->domain, contact->point, x);
    c->points[2 * i] = x;
    c->points[2 * i + 1] = wall ? point : image_near(&n->domain, bodies->position[contact->other], point);
    c->ends[2 * i] = (uint32_t)(2 * i);
    c->ends[2 * i + 1] = (uint32_t)(2 * i + 1);
    c->force[i] = v3_along(contact->friction_force, -contact->normal_force, contact->normal);
    c->normal_force[i] = contact->normal_force;
    c->friction_force[i] = v3_norm(contact->friction_force);
    c->overlap[i] = contact->overlap;
    c->kind[i] = wall;
    c->body[i] = (int32_t)contact->body;
    c->other[i] = wall ? -1 : (int32_t)contact->other;
    c->wall[i] = wall ? (int32_t)contact->wall : -1;
}

// the next file, a cell for each line
static dem_status write_lines(dem_network *n, double time, const dem_vec3 *points, const uint32_t *ends, size_t count,
                              const dem_vtp_array *arrays, size_t array_count, dem_error *error)
{
    char name[40];
    snprintf(name, sizeof name, "frames/%s_%06zu.vtp", n->name, n->index.count);
    char *path = dem_path_join(n->directory, "%s", name);
    const dem_vtp vtp = {.time = time,
                         .points = points,
                         .point_count = 2 * count,
                         .lines = ends,
                         .line_count = count,
                         .cell_arrays = arrays,
                         .cell_array_count = array_count};
    dem_status status = path ? dem_vtp_queue(n->queue, path, &vtp, error) : dem_fail_memory(error);
    free(path);
    return status == DEM_OK ? dem_pvd_add(&n->index, time, name, NULL, error) : status;
}

dem_status dem_network_write(dem_network *n, double time, const dem_body_view *bodies, const dem_contact *contacts,
                             size_t count, dem_error *error)
{
    columns c;
    dem_status status = make_columns(&c, count) ? DEM_OK : dem_fail_memory(error);
    for (size_t i = 0; i < count && status == DEM_OK; i++)
        set_line(n, &c, i, bodies, &contacts[i]);
    const dem_vtp_array arrays[] = {{"normal_force", DEM_VTP_FLOAT64, 1, c.normal_force},
                                    {"friction_force", DEM_VTP_FLOAT64, 1, c.friction_force},
                                    {"force", DEM_VTP_FLOAT64, 3, c.force},
                                    {"overlap", DEM_VTP_FLOAT64, 1, c.overlap},
                                    {"kind", DEM_VTP_INT32, 1, c.kind},
                                    {"body", DEM_VTP_INT32, 1, c.body},
                                    {"other", DEM_VTP_INT32, 1, c.other},
                                    {"wall", DEM_VTP_INT32, 1, c.wall}};
    if (status == DEM_OK)
        status = write_lines(n, time, c.points, c.ends, count, arrays, sizeof arrays / sizeof *arrays, error);
    release_columns(&c);
    return status;
}

// ---- bonds

typedef struct bond_columns {
    dem_vec3 *points, *force, *moment;
    uint32_t *ends;
    double *numbers[4];  // tensile and shear stress, their ratio to the strength, time of the breakage
    int32_t *whole[4];   // state, body, other, which of the scene's bonds
} bond_columns;

static bool make_bond_columns(bond_columns *c, size_t n)
{
    *c = (bond_columns){.points = dem_alloc(2 * n, sizeof *c->points),
                        .force = dem_alloc(n, sizeof *c->force),
                        .moment = dem_alloc(n, sizeof *c->moment),
                        .ends = dem_alloc(2 * n, sizeof *c->ends)};
    bool good = c->points && c->force && c->moment && c->ends;
    for (int k = 0; k < 4; k++) {
        c->numbers[k] = dem_alloc(n, sizeof *c->numbers[k]);
        c->whole[k] = dem_alloc(n, sizeof *c->whole[k]);
        good = good && c->numbers[k] && c->whole[k];
    }
    return good;
}

static void release_bond_columns(bond_columns *c)
{
    free(c->points);
    free(c->force);
    free(c->moment);
    free(c->ends);
    for (int k = 0; k < 4; k++) {
        free(c->numbers[k]);
        free(c->whole[k]);
    }
}

// a broken one stays a point where it broke
static void set_bond(const dem_network *n, bond_columns *c, size_t i, const dem_body_view *bodies,
                     const dem_bond_view *b)
{
    bool intact = b->state == DEM_BOND_INTACT;
    c->points[2 * i] = c->points[2 * i + 1] = b->point;
    if (intact) {
        dem_vec3 x = bodies->position[b->body];
        c->points[2 * i] = x;
        c->points[2 * i + 1] = image_near(&n->domain, bodies->position[b->other], image_near(&n->domain, b->point, x));
    }
    c->ends[2 * i] = (uint32_t)(2 * i);
    c->ends[2 * i + 1] = (uint32_t)(2 * i + 1);
    c->force[i] = b->force;
    c->moment[i] = b->moment;
    c->numbers[0][i] = b->tensile_stress;
    c->numbers[1][i] = b->shear_stress;
    c->numbers[2][i] = b->stress_ratio;
    c->numbers[3][i] = intact ? -1 : b->broken;
    c->whole[0][i] = (int32_t)b->state;
    c->whole[1][i] = (int32_t)b->body;
    c->whole[2][i] = (int32_t)b->other;
    c->whole[3][i] = (int32_t)b->def;
}

dem_status dem_network_write_bonds(dem_network *n, double time, const dem_body_view *bodies, const dem_bond_view *bonds,
                                   size_t count, dem_error *error)
{
    bond_columns c;
    dem_status status = make_bond_columns(&c, count) ? DEM_OK : dem_fail_memory(error);
    for (size_t i = 0; i < count && status == DEM_OK; i++)
        set_bond(n, &c, i, bodies, &bonds[i]);
    const dem_vtp_array arrays[] = {{"force", DEM_VTP_FLOAT64, 3, c.force},
                                    {"moment", DEM_VTP_FLOAT64, 3, c.moment},
                                    {"tensile_stress", DEM_VTP_FLOAT64, 1, c.numbers[0]},
                                    {"shear_stress", DEM_VTP_FLOAT64, 1, c.numbers[1]},
                                    {"stress_ratio", DEM_VTP_FLOAT64, 1, c.numbers[2]},
                                    {"broken", DEM_VTP_FLOAT64, 1, c.numbers[3]},
                                    {"state", DEM_VTP_INT32, 1, c.whole[0]},
                                    {"body", DEM_VTP_INT32, 1, c.whole[1]},
                                    {"other", DEM_VTP_INT32, 1, c.whole[2]},
                                    {"bond", DEM_VTP_INT32, 1, c.whole[3]}};
    if (status == DEM_OK)
        status = write_lines(n, time, c.points, c.ends, count, arrays, sizeof arrays / sizeof *arrays, error);
    release_bond_columns(&c);
    return status;
}
