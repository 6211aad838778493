// Surface of the voxels of a label: the faces between inside and outside, joined so that every edge has two of them,
// then smoothed and brought back to the volume of the voxels.
//
// Joining: at a lattice edge whose four voxels are inside crosswise, the faces of each voxel belong together. Around a
// lattice point the faces then form rings, and each ring gets a vertex of its own. One case is left: the two pairs of
// faces at such an edge may be of one ring at both its ends; so these edges get a point in the middle for each pair.
// Smoothing: Taubin's two steps (1995), one that shrinks and one that swells, so that stairs go and the form stays.
// 30 times, the area of a ball is right to 0.3 % and its surface to half a voxel. Tried: shrinking steps alone, which
// are smoother still but take the corners off angular grains.
#include <stdlib.h>

#include "base/memory.h"
#include "mesh/voxels.h"

enum { NO_VERTEX = UINT32_MAX, RINGS_MOST = 4, SMOOTHINGS = 4 };

static const double SHRINK = 0.6, SWELL = -0.61;  // Taubin's lambda and mu
static const double FARTHEST = 0.8;               // a vertex goes from its lattice point, along each axis [voxels]
static const double VOLUME_WITHIN = 1e-4;         // relative
static const int steps_tried[SMOOTHINGS] = {30, 6, 1, 0};

// ---- rings of faces about a lattice point. The eight voxels there are numbered by bits: 1 for the upper x, 2 for y,
// 4 for z. A face lies between voxels that differ in one bit, its axis; it is numbered by that and the lower voxel

typedef struct ring_table {
    uint8_t count[256];
    uint8_t ring[256][24];  // [inside bits][face], 8 axis + lower voxel
} ring_table;

static int face_number(int a, int b)
{
    int bit = a ^ b;
    return 8 * (bit == 1 ? 0 : bit == 2 ? 1 : 2) + (a < b ? a : b);
}

// the face that goes on from face (inside a, outside b) across the lattice edge along the axis `along`
static int next_face(int inside, int a, int b, int along)
{
    int across = 7 ^ (a ^ b) ^ along, a2 = a ^ across, b2 = b ^ across;
    if (!(inside >> a2 & 1))
        return face_number(a, a2);
    if (!(inside >> b2 & 1))
        return face_number(a2, b2);
    return face_number(b2, b);
}

static void join_faces(int inside, uint8_t ring[24])
{
    for (int f = 0; f < 24; f++)
        ring[f] = (uint8_t)f;
    for (int a = 0; a < 8; a++)
        for (int bit = 1; bit < 8; bit *= 2) {
            int b = a ^ bit;
            if (!(inside >> a & 1) || (inside >> b & 1))
                continue;
            for (int along = 1; along < 8; along *= 2) {
                if (along == bit)
                    continue;
                uint8_t x = ring[face_number(a, b)], y = ring[next_face(inside, a, b, along)];
                for (int f = 0; f < 24; f++)
                    if (ring[f] == x || ring[f] == y)
                        ring[f] = x < y ? x : y;
            }
        }
}

static void fill_rings(ring_table *table)
{
    for (int inside = 0; inside < 256; inside++) {
        uint8_t joined[24], number[24];
        int count = 0;
        join_faces(inside, joined);
        memset(number, 0xff, sizeof number);
        for (int f = 0; f < 24; f++) {
            int low = f % 8, high = low | 1 << f / 8;
            if (low == high || (inside >> low & 1) == (inside >> high & 1))
                continue;
            if (number[joined[f]] == 0xff)
                number[joined[f]] = (uint8_t)count++;
            table->ring[inside][f] = number[joined[f]];
        }
        table->count[inside] = (uint8_t)count;
        DEM_ASSERT(count <= RINGS_MOST);
    }
}

// ---- faces

typedef struct face {
    uint32_t corner[4];  // counter-clockwise from outside
    uint32_t middle[4];  // on the side from each corner to the next, or NO_VERTEX
} face;

typedef struct pinch {  // a middle point of one of the pairs of faces at an edge: of the faces of one inside voxel
    size_t edge, voxel;
    uint32_t vertex;
} pinch;

typedef struct surface_work {
    const dem_voxels *voxels;
    ptrdiff_t step[3];  // from a voxel to the next
    ring_table rings;
    uint32_t *plane[2];  // first vertex of the lattice points of two layers, one after the other
    face *faces;
    size_t face_count, face_capacity;
    dem_vec3 *points, *moved;  // [voxels] the lattice point (i, j, k) is the lower corner of voxel (i, j, k)
    dem_vec3 *sums;
    size_t vertex_count, vertex_capacity;
    pinch *pinches;  // of the current layer
    size_t pinch_count, pinch_capacity;
    uint32_t (*links)[2];
    size_t link_count, link_capacity;
    uint32_t *degree;
} surface_work;

// the voxels about the lattice point at the lower corner of `voxel`, as bits
static int inside_bits(const surface_work *w, size_t voxel)
{
    const uint8_t *in = w->voxels->inside + voxel;
    ptrdiff_t x = w->step[0], y = w->step[1], z = w->step[2];
    return in[0] << 7 | in[-x] << 6 | in[-y] << 5 | in[-x - y] << 4 | in[-z] << 3 | in[-x - z] << 2 | in[-y - z] << 1 |
           in[-x - y - z];
}

static bool add_vertex(surface_work *w, dem_vec3 point)
{
    if (w->vertex_count >= UINT32_MAX - 1 ||
        !dem_grow(&w->points, &w->vertex_capacity, w->vertex_count, sizeof *w->points))
        return false;
    w->points[w->vertex_count++] = point;
    return true;
}

// vertices of the lattice points of layer z
static bool number_plane(surface_work *w, size_t z)
{
    const size_t *n = w->voxels->size;
    uint32_t *first = w->plane[z % 2];
    for (size_t y = 1; y < n[1]; y++)
        for (size_t x = 1; x < n[0]; x++) {
            int bits = inside_bits(w, (z * n[1] + y) * n[0] + x);
            first[y * n[0] + x] = (uint32_t)w->vertex_count;
            for (int i = 0; i < w->rings.count[bits]; i++)
                if (!add_vertex(w, (dem_vec3){(double)x, (double)y, (double)z}))
                    return false;
        }
    return true;
}

// the vertex of a face at the lattice point `at`; the inside voxel of the face and the outside one lie about it
static uint32_t corner_vertex(const surface_work *w, const size_t at[3], const size_t inside[3],
                              const size_t outside[3])
{
    const size_t *n = w->voxels->size;
    int a = 0, b = 0;
    for (int k = 0; k < 3; k++) {
        a |= (inside[k] == at[k]) << k;
        b |= (outside[k] == at[k]) << k;
    }
    int bits = inside_bits(w, (at[2] * n[1] + at[1]) * n[0] + at[0]);
    return w->plane[at[2] % 2][at[1] * n[0] + at[0]] + w->rings.ring[bits][face_number(a, b)];
}

// the middle point for a face of `voxel` on the lattice edge from `at` along an axis, if the edge needs one
static bool middle_vertex(surface_work *w, const size_t at[3], int along, size_t voxel, uint32_t *vertex)
{
    const size_t *n = w->voxels->size;
    size_t here = (at[2] * n[1] + at[1]) * n[0] + at[0];
    ptrdiff_t u = w->step[(along + 1) % 3], v = w->step[(along + 2) % 3];
    const uint8_t *in = w->voxels->inside + here;
    *vertex = NO_VERTEX;
    if (in[0] != in[-u - v] || in[-u] != in[-v] || in[0] == in[-u])
        return true;
    size_t edge = 3 * here + (size_t)along;
    for (size_t i = w->pinch_count; i-- > 0 && w->pinches[i].voxel == voxel;)
        if (w->pinches[i].edge == edge) {
            *vertex = w->pinches[i].vertex;
            return true;
        }
    dem_vec3 point = {(double)at[0], (double)at[1], (double)at[2]};
    v3_set(&point, along, (double)at[along] + 0.5);
    if (!dem_grow(&w->pinches, &w->pinch_capacity, w->pinch_count, sizeof *w->pinches) || !add_vertex(w, point))
        return false;
    *vertex = (uint32_t)w->vertex_count - 1;
    w->pinches[w->pinch_count++] = (pinch){edge, voxel, *vertex};
    return true;
}

// the face of an inside voxel towards `sign` along an axis
static bool add_face(surface_work *w, const size_t voxel[3], int axis, int sign)
{
    static const int around[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    const size_t *n = w->voxels->size;
    int u = (axis + 1) % 3, v = (axis + 2) % 3;
    size_t outside[3] = {voxel[0], voxel[1], voxel[2]}, corner[4][3];
    outside[axis] += (size_t)(ptrdiff_t)sign;
    if (!dem_grow(&w->faces, &w->face_capacity, w->face_count, sizeof *w->faces))
        return false;
    face f;
    for (int i = 0; i < 4; i++) {
        int turn = sign > 0 ? i : 3 - i;
        memcpy(corner[i], voxel, sizeof corner[i]);
        corner[i][axis] += sign > 0;
        corner[i][u] += (size_t)around[turn][0];
        corner[i][v] += (size_t)around[turn][1];
        f.corner[i] = corner_vertex(w, corner[i], voxel, outside);
    }
    for (int i = 0; i < 4; i++) {
        const size_t *a = corner[i], *b = corner[(i + 1) % 4];
        int along = a[u] != b[u] ? u : v;
        size_t number = (voxel[2] * n[1] + voxel[1]) * n[0] + voxel[0];
        if (!middle_vertex(w, a[along] < b[along] ? a : b, along, number, &f.middle[i]))
            return false;
    }
    w->faces[w->face_count++] = f;
    return true;
}

static bool add_layer(surface_work *w, size_t z)
{
    const size_t *n = w->voxels->size;
    w->pinch_count = 0;  // both faces of a pair belong to one voxel
    for (size_t y = 1; y + 1 < n[1]; y++)
        for (size_t x = 1; x + 1 < n[0]; x++) {
            const uint8_t *in = w->voxels->inside + (z * n[1] + y) * n[0] + x;
            for (int axis = 0; *in && axis < 3; axis++)
                if ((!in[w->step[axis]] && !add_face(w, (size_t[]){x, y, z}, axis, 1)) ||
                    (!*(in - w->step[axis]) && !add_face(w, (size_t[]){x, y, z}, axis, -1)))
                    return false;
        }
    return true;
}

static bool make_faces(surface_work *w)
{
    const size_t *n = w->voxels->size;
    w->step[0] = 1;
    w->step[1] = (ptrdiff_t)n[0];
    w->step[2] = (ptrdiff_t)(n[0] * n[1]);
    fill_rings(&w->rings);
    for (int i = 0; i < 2; i++)
        if (!(w->plane[i] = dem_alloc(n[0] * n[1], sizeof *w->plane[i])))
            return false;
    if (!number_plane(w, 1))
        return false;
    for (size_t z = 1; z + 1 < n[2]; z++)
        if (!number_plane(w, z + 1) || !add_layer(w, z))
            return false;
    return true;
}

// ---- triangles and links

// the corners and middle points of a face in turn; returns how many
static int face_outline(const face *f, uint32_t outline[8])
{
    int count = 0;
    for (int i = 0; i < 4; i++) {
        outline[count++] = f->corner[i];
        if (f->middle[i] != NO_VERTEX)
            outline[count++] = f->middle[i];
    }
    return count;
}

static bool add_triangle(dem_mesh *mesh, size_t *capacity, uint32_t a, uint32_t b, uint32_t c)
{
    if (!dem_grow(&mesh->triangles, capacity, mesh->triangle_count, 3 * sizeof *mesh->triangles))
        return false;
    uint32_t *t = mesh->triangles + 3 * mesh->triangle_count++;
    t[0] = a;
    t[1] = b;
    t[2] = c;
    return true;
}

// along the shorter diagonal; faces with middle points about the first of these
static bool triangulate(const surface_work *w, dem_mesh *mesh)
{
    size_t capacity = 0;
    for (size_t i = 0; i < w->face_count; i++) {
        uint32_t o[8];
        int count = face_outline(&w->faces[i], o), from = 0;
        if (count == 4)
            from = v3_distance(w->points[o[0]], w->points[o[2]]) > v3_distance(w->points[o[1]], w->points[o[3]]);
        for (int k = 0; count > 4 && k < 4 && from == 0; k++)
            if (w->faces[i].middle[k] != NO_VERTEX)
                while (o[from] != w->faces[i].middle[k])
                    from++;
        for (int k = 1; k + 1 < count; k++)
            if (!add_triangle(mesh, &capacity, o[from], o[(from + k) % count], o[(from + k + 1) % count]))
                return false;
    }
    return true;
}

static bool add_link(surface_work *w, uint32_t a, uint32_t b)
{
    if (!dem_grow(&w->links, &w->link_capacity, w->link_count, sizeof *w->links))
        return false;
    w->links[w->link_count][0] = a;
    w->links[w->link_count++][1] = b;
    return true;
}

// the sides of the faces, each once; middle points also to the far corners, so that the two of an edge part
static bool make_links(surface_work *w)
{
    for (size_t i = 0; i < w->face_count; i++) {
        const face *f = &w->faces[i];
        uint32_t o[8];
        int count = face_outline(f, o);
        for (int k = 0; k < count; k++)
            if (o[k] < o[(k + 1) % count] && !add_link(w, o[k], o[(k + 1) % count]))
                return false;
        for (int k = 0; k < 4; k++)
            if (f->middle[k] != NO_VERTEX && (!add_link(w, f->middle[k], f->corner[(k + 2) % 4]) ||
                                              !add_link(w, f->middle[k], f->corner[(k + 3) % 4])))
                return false;
    }
    w->degree = dem_alloc_zero(w->vertex_count, sizeof *w->degree);
    for (size_t i = 0; w->degree && i < w->link_count; i++) {
        w->degree[w->links[i][0]]++;
        w->degree[w->links[i][1]]++;
    }
    return w->degree != NULL;
}

// ---- smoothing, in voxels

static void smooth_step(surface_work *w, double factor)
{
    memset(w->sums, 0, w->vertex_count * sizeof *w->sums);
    for (size_t i = 0; i < w->link_count; i++) {
        uint32_t a = w->links[i][0], b = w->links[i][1];
        w->sums[a] = v3_add(w->sums[a], w->moved[b]);
        w->sums[b] = v3_add(w->sums[b], w->moved[a]);
    }
    for (size_t i = 0; i < w->vertex_count; i++) {
        dem_vec3 mean = v3_scale(w->sums[i], 1.0 / w->degree[i]),
                 p = v3_along(w->moved[i], factor, v3_sub(mean, w->moved[i]));
        for (int k = 0; k < 3; k++) {
            double at = v3_get(w->points[i], k);
            v3_set(&p, k, fmin(fmax(v3_get(p, k), at - FARTHEST), at + FARTHEST));
        }
        w->moved[i] = p;
    }
}

// volume about `origin`, and normals weighted by area (twice) at the vertices; returns the area too
static double measure(surface_work *w, const dem_mesh *mesh, double *area)
{
    double volume = 0;
    dem_vec3 origin = w->moved[0];
    *area = 0;
    memset(w->sums, 0, w->vertex_count * sizeof *w->sums);
    for (size_t t = 0; t < mesh->triangle_count; t++) {
        const uint32_t *c = mesh->triangles + 3 * t;
        dem_vec3 a = v3_sub(w->moved[c[0]], origin), b = v3_sub(w->moved[c[1]], origin);
        dem_vec3 d = v3_sub(w->moved[c[2]], origin), normal = v3_cross(v3_sub(b, a), v3_sub(d, a));
        volume += v3_dot(a, v3_cross(b, d)) / 6;
        *area += v3_norm(normal) / 2;
        for (int k = 0; k < 3; k++)
            w->sums[c[k]] = v3_add(w->sums[c[k]], normal);
    }
    return volume;
}

// moves the surface along its normals until it encloses the voxels' volume; false: it does not come to that
static bool restore_volume(surface_work *w, const dem_mesh *mesh)
{
    double wanted = (double)w->voxels->count, area, error = 1;
    for (int i = 0; i < 8; i++) {
        double missing = wanted - measure(w, mesh, &area);
        error = fabs(missing) / wanted;
        if (error < 1e-9)
            break;
        double shift = fmin(fmax(missing / area, -0.5), 0.5);
        for (size_t k = 0; k < w->vertex_count; k++) {
            double length = v3_norm(w->sums[k]);
            if (length > 0)
                w->moved[k] = v3_along(w->moved[k], shift / length, w->sums[k]);
        }
    }
    return error < VOLUME_WITHIN;
}

// thin and torn labels, which smoothing would eat, get less of it
static bool smooth(surface_work *w, const dem_mesh *mesh)
{
    for (int i = 0; i < SMOOTHINGS; i++) {
        memcpy(w->moved, w->points, w->vertex_count * sizeof *w->moved);
        for (int k = 0; k < steps_tried[i]; k++) {
            smooth_step(w, SHRINK);
            smooth_step(w, SWELL);
        }
        if (steps_tried[i] == 0)
            smooth_step(w, 0.02);  // what touches parts
        if (restore_volume(w, mesh))
            return true;
    }
    return false;
}

// ---- the whole

// hands the vertices over to the mesh, in the image's frame
static void place(surface_work *w, const dem_volume *volume, dem_mesh *mesh)
{
    for (size_t i = 0; i < w->vertex_count; i++) {
        dem_vec3 p = volume->origin;
        for (int k = 0; k < 3; k++)  // lattice points are half a voxel below the centres, the layer around one voxel
            p = v3_along(p, v3_get(w->moved[i], k) - 1.5 + (double)w->voxels->low[k], volume->axes[k]);
        w->moved[i] = p;
    }
    mesh->vertices = w->moved;
    mesh->vertex_count = w->vertex_count;
    w->moved = NULL;
    if (v3_dot(volume->axes[0], v3_cross(volume->axes[1], volume->axes[2])) > 0)
        return;
    for (size_t t = 0; t < mesh->triangle_count; t++) {
        uint32_t *c = mesh->triangles + 3 * t, swap = c[1];
        c[1] = c[2];
        c[2] = swap;
    }
}

static dem_status make_surface(surface_work *w, const dem_volume *volume, dem_mesh *mesh, dem_error *error)
{
    if (!make_faces(w) || !make_links(w) || !triangulate(w, mesh))
        return dem_fail_memory(error);
    w->moved = dem_alloc(w->vertex_count, sizeof *w->moved);
    w->sums = dem_alloc(w->vertex_count, sizeof *w->sums);
    if (!w->moved || !w->sums)
        return dem_fail_memory(error);
    if (!smooth(w, mesh))
        return dem_fail(error, DEM_BAD_INPUT,
                        "the label has no body a surface could be put around; clean the segmentation");
    place(w, volume, mesh);
    return DEM_OK;
}

dem_status dem_label_surface(const dem_ctx *ctx, const dem_volume *volume, dem_label *label, dem_keep keep,
                             dem_mesh *mesh, dem_error *error)
{
    dem_voxels voxels;
    *mesh = (dem_mesh){0};
    DEM_TRY(dem_voxels_cut(volume, label, &voxels, error));
    dem_status status = dem_voxels_keep(ctx, &voxels, keep, error);
    if (status == DEM_OK) {
        surface_work w = {.voxels = &voxels};
        status = make_surface(&w, volume, mesh, error);
        label->voxels = voxels.count;
        free(w.plane[0]);
        free(w.plane[1]);
        free(w.faces);
        free(w.points);
        free(w.moved);
        free(w.sums);
        free(w.pinches);
        free(w.links);
        free(w.degree);
    }
    if (status != DEM_OK)
        dem_mesh_free(mesh);
    dem_voxels_release(&voxels);
    return status;
}
