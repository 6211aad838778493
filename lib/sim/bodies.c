#include "sim/bodies.h"

#include <stdlib.h>
#include <string.h>

#include "base/status.h"

static const double DUMMY_AT = 1e150;  // far from everything, and its square is still finite

static void *column(size_t rows, size_t width)
{
    size_t bytes = (rows * width + 127) / 64 * 64;
    void *p = aligned_alloc(64, bytes);
    if (p)
        memset(p, 0, bytes);
    return p;
}

static bool make_columns(dem_world *w)
{
    dem_bodies *b = &w->bodies;
    bool good = true;
#define COLUMN(type, name, width, unit, when, about)                                                                   \
    if (when) {                                                                                                        \
        b->name = column(b->padded, (width) * sizeof(type));                                                           \
        good = good && b->name;                                                                                        \
    }
    DEM_BODY_COLUMNS(COLUMN)
#undef COLUMN
    b->momentum_rows = b->padded;
    b->place = dem_alloc(b->count, sizeof *b->place);
    for (size_t row = 0; b->id && row < b->padded; row++)
        b->id[row] = (uint32_t)DEM_ROW_FREE;
    return good && b->place;
}

// bits of x, two places apart
static uint64_t spread_bits(uint64_t x)
{
    x &= 0x1fffff;
    x = (x | x << 32) & 0x1f00000000ffff;
    x = (x | x << 16) & 0x1f0000ff0000ff;
    x = (x | x << 8) & 0x100f00f00f00f00f;
    x = (x | x << 4) & 0x10c30c30c30c30c3;
    return (x | x << 2) & 0x1249249249249249;
}

typedef struct curve_point {
    uint64_t key;
    uint32_t body;
} curve_point;

static int by_key(const void *a, const void *b)
{
    const curve_point *p = a, *q = b;
    if (p->key != q->key)
        return p->key < q->key ? -1 : 1;
    return p->body < q->body ? -1 : p->body > q->body;
}

// rows along Morton's curve through cells of about a body's size: neighbours in space are neighbours in memory
static dem_status order_bodies(const dem_world *w, const dem_body_def *defs, dem_error *error)
{
    const dem_bodies *b = &w->bodies;
    curve_point *points = dem_alloc(b->living, sizeof *points);
    if (!points)
        return dem_fail_memory(error);
    dem_box box = box_empty();
    double radius = 0;
    for (size_t i = 0; i < b->living; i++) {
        box = box_with(box, defs[i].position);
        radius += w->templates.items[defs[i].shape].radius_out * defs[i].scale / (double)b->living;
    }
    double cell = fmax(1.5 * radius, box_diagonal(box) / 0x1fffff);
    for (size_t i = 0; i < b->living; i++) {
        dem_vec3 at = v3_scale(v3_sub(defs[i].position, box.low), cell > 0 ? 1 / cell : 0);
        points[i] = (curve_point){spread_bits((uint64_t)at.x) | spread_bits((uint64_t)at.y) << 1 |
                                      spread_bits((uint64_t)at.z) << 2,
                                  (uint32_t)i};
    }
    qsort(points, b->living, sizeof *points, by_key);
    for (size_t i = 0; i < b->living; i++)
        b->place[points[i].body] = (uint32_t)i;
    free(points);
    return DEM_OK;
}

static void put_inertia(const dem_world *w, size_t row, const dem_template *t, double scale, uint32_t hold)
{
    double *inertia = w->bodies.inertia + DEM_ROW * row, bulk = template_bulk(t, scale), fifth = bulk * scale * scale;
    inertia[0] = 1 / (t->mass * bulk);
    for (int k = 0; k < 3; k++)
        inertia[1 + k] = 1 / (t->inertia[k] * fifth);
    inertia[4] = t->centred ? 0 : t->radius_out * scale;
    inertia[5] = t->mass * bulk;
    inertia[6] = 1 / (t->least_mass * bulk);
    inertia[7] = t->isotropic;
    if (w->damping.drag.buoyancy)
        inertia[5] -= w->damping.drag.density * t->volume * bulk;
    if (!hold)
        return;
    // a held body is a wall to the others
    double turning = hold_turns(hold) ? 0 : inertia[6] - inertia[0];
    if (hold_moves(hold)) {
        inertia[0] *= DEM_AS_GOOD_AS_NONE;
        inertia[5] = 0;
    }
    for (int k = 1; hold_turns(hold) && k < 4; k++)
        inertia[k] *= DEM_AS_GOOD_AS_NONE;
    inertia[6] = inertia[0] + turning;
}

// of what is held there is none: only what contacts add in a step
static void put_momentum(dem_world *w, size_t row, dem_quat q, dem_vec3 velocity, dem_vec3 spin)
{
    dem_bodies *b = &w->bodies;
    double *momentum = b->momentum + DEM_ROW * row, m = body_mass(w, row);
    const double *inverse = b->inertia + DEM_ROW * row + 1;
    dem_vec3 own = quat_unrotate(q, spin);
    dem_vec3 l = quat_rotate(q, v3(own.x / inverse[0], own.y / inverse[1], own.z / inverse[2]));
    if (!(body_hold(b, row) & DEM_HOLD_VELOCITY))
        memcpy(momentum, (double[]){m * velocity.x, m * velocity.y, m * velocity.z}, 3 * sizeof *momentum);
    if (!(body_hold(b, row) & DEM_HOLD_SPIN))
        memcpy(momentum + 3, (double[]){l.x, l.y, l.z}, 3 * sizeof *momentum);
}

void dem_body_put(dem_world *w, size_t row, const dem_body_def *def)
{
    dem_bodies *b = &w->bodies;
    const dem_template *t = &w->templates.items[def->shape];
    double *pose = body_pose(b, row), *motion = pose + 8;
    b->shape[row] = def->shape;
    b->radius[row] = t->radius_out * def->scale;
    put_inertia(w, row, t, def->scale, def->hold);
    if (b->hold)
        b->hold[row] = def->hold;
    dem_vec3 velocity = unlocked_velocity(def->velocity, def->hold), spin = unlocked_spin(def->spin, def->hold);
    if (b->kept)
        memcpy(b->kept + 6 * row, (double[]){velocity.x, velocity.y, velocity.z, spin.x, spin.y, spin.z},
               6 * sizeof *b->kept);
    dem_quat q = template_run_orientation(t, quat_unit(def->orientation));
    memcpy(pose, (double[]){def->position.x, def->position.y, def->position.z, q.w, q.x, q.y, q.z, def->scale},
           8 * sizeof *pose);
    memcpy(motion,
           (double[]){velocity.x, velocity.y, velocity.z, spin.x, spin.y, spin.z, b->inertia[DEM_ROW * row]},
           7 * sizeof *motion);
    put_momentum(w, row, q, velocity, spin);
    b->limit[row] = -1;
    b->search_limit[row] = -INFINITY;  // a search is due, however wide the skin
    if (b->strain_limit)
        b->strain_limit[row] = 0;
    if (b->wall_limit)
        b->wall_limit[row] = -1;
}

// a row without a body: never moves, never asks, and its dashpots stay finite
static void put_dummy(dem_bodies *b, size_t row, double at)
{
    double *pose = body_pose(b, row);
    pose[0] = at;
    pose[3] = pose[7] = 1;
    pose[8 + 6] = b->inertia[DEM_ROW * row] = 1;
    b->inertia[DEM_ROW * row + 7] = 1;
    b->limit[row] = INFINITY;
    if (b->wall_limit)
        b->wall_limit[row] = INFINITY;
    if (b->strain_limit)
        b->strain_limit[row] = INFINITY;
}

void dem_body_clear(dem_world *w, size_t row)
{
    dem_bodies *b = &w->bodies;
#define COLUMN(type, name, width, unit, when, about)                                                                   \
    if (b->name)                                                                                                       \
        memset(b->name + (width) * row, 0, (width) * sizeof(type));
    DEM_BODY_COLUMNS(COLUMN)
#undef COLUMN
    put_dummy(b, row, row % 2 ? DUMMY_AT : -DUMMY_AT);
    if (b->id)
        b->id[row] = (uint32_t)DEM_ROW_FREE;
}

static void set_count(dem_bodies *b, size_t rows)
{
    b->count = rows;
    b->padded = (rows + 2 + DEM_BLOCK_LANES - 1) / DEM_BLOCK_LANES * DEM_BLOCK_LANES;
    b->dummy = (uint32_t)rows;
}

dem_status dem_bodies_create(dem_world *w, const dem_body_def *defs, size_t count, size_t rows, dem_error *error)
{
    dem_bodies *b = &w->bodies;
    set_count(b, rows);
    b->living = count;
    if (!make_columns(w))
        return dem_fail_memory(error);
    DEM_TRY(order_bodies(w, defs, error));
    for (size_t i = 0; i < count; i++) {
        dem_body_put(w, b->place[i], &defs[i]);
        if (b->id)
            b->id[b->place[i]] = (uint32_t)i;
    }
    for (size_t row = count; row < b->padded; row++)
        put_dummy(b, row, row % 2 ? DUMMY_AT : -DUMMY_AT);
    return DEM_OK;
}

bool dem_bodies_grow(dem_world *w, size_t rows)
{
    dem_bodies old = w->bodies, *b = &w->bodies;
    bool good = true;
    set_count(b, rows);
    b->place = dem_alloc(rows, sizeof *b->place);
    good = b->place;
    // all columns first, so that nothing is half grown
#define COLUMN(type, name, width, unit, when, about)                                                                   \
    if (old.name) {                                                                                                    \
        b->name = column(b->padded, (width) * sizeof(type));                                                           \
        good = good && b->name;                                                                                        \
    }
    DEM_BODY_COLUMNS(COLUMN)
#undef COLUMN
    if (!good) {
        free(b->place);
#define COLUMN(type, name, width, unit, when, about)                                                                   \
    if (old.name)                                                                                                      \
        free(b->name);
        DEM_BODY_COLUMNS(COLUMN)
#undef COLUMN
        *b = old;
        return false;
    }
#define COLUMN(type, name, width, unit, when, about)                                                                   \
    if (old.name) {                                                                                                    \
        memcpy(b->name, old.name, old.count *(width) * sizeof(type));                                                  \
        free(old.name);                                                                                                \
    }
    DEM_BODY_COLUMNS(COLUMN)
#undef COLUMN
    memcpy(b->place, old.place, old.living * sizeof *b->place);
    free(old.place);
    b->momentum_rows = b->padded;
    for (size_t row = old.count; row < b->padded; row++)
        dem_body_clear(w, row);
    return true;
}

void dem_bodies_release(dem_bodies *b)
{
#define COLUMN(type, name, width, unit, when, about) free(b->name);
    DEM_BODY_COLUMNS(COLUMN)
#undef COLUMN
    free(b->place);
}

bool dem_bodies_reserve_slots(dem_bodies *b, size_t slots)
{
    size_t rows = b->padded + slots;
    if (rows <= b->momentum_rows)
        return true;
    double *momentum = column(rows, DEM_ROW * sizeof *momentum);
    if (!momentum)
        return false;
    memcpy(momentum, b->momentum, b->padded * DEM_ROW * sizeof *momentum);
    free(b->momentum);
    b->momentum = momentum;
    b->momentum_rows = rows;
    return true;
}

void dem_bodies_wrap(dem_world *w, int32_t *moved)
{
    dem_bodies *b = &w->bodies;
    for (size_t row = 0; row < b->count; row++)
        for (int k = 0; k < 3; k++) {
            int32_t n = 0;
            if (w->domain.periodic[k] && !body_absent(b, row)) {
                double low = v3_get(w->domain.low, k), side = v3_get(w->domain.high, k) - low;
                double *x = &body_pose(b, row)[k];
                n = (int32_t)floor((*x - low) / side);
                *x -= n * side;
                b->wraps[3 * row + (size_t)k] += n;
            }
            moved[3 * row + (size_t)k] = n;
        }
}

dem_vec3 dem_body_spin(const dem_bodies *b, size_t row, dem_vec3 momentum)
{
    const double *inverse = b->inertia + DEM_ROW * row + 1;
    if (b->inertia[DEM_ROW * row + 7] > 0)
        return v3_scale(momentum, inverse[0]);
    dem_quat q = body_orientation(b, row);
    dem_vec3 own = quat_unrotate(q, momentum);
    return quat_rotate(q, v3(own.x * inverse[0], own.y * inverse[1], own.z * inverse[2]));
}

double dem_body_turning_energy(const dem_bodies *b, size_t row, dem_vec3 spin)
{
    const double *inverse = b->inertia + DEM_ROW * row + 1;
    dem_vec3 own = quat_unrotate(body_orientation(b, row), spin);
    return (own.x * own.x / inverse[0] + own.y * own.y / inverse[1] + own.z * own.z / inverse[2]) / 2;
}

double dem_bodies_bytes(const dem_world *w)
{
    double bytes = sizeof *w->bodies.place;
#define COLUMN(type, name, width, unit, when, about)                                                                   \
    if (when)                                                                                                          \
        bytes += (width) * sizeof(type);
    DEM_BODY_COLUMNS(COLUMN)
#undef COLUMN
    return bytes;
}
