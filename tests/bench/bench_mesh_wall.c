/// bench_mesh_wall: nanoseconds per ball at a wall of triangles, least of several rounds: finding its contacts among 1,
/// 2 and 6 listed triangles (balls over a face, over an edge, over a corner of a floor; then in a groove), the closest
/// points alone, gathering what is near, and going on from the contacts of the step before.
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "base/random.h"
#include "sim/mesh_wall.h"

enum { BALLS = 4096, SIDE = 64, ROUNDS = 200, LISTED = 6 };

static dem_vec3 centres[BALLS];
static uint32_t ids[BALLS][LISTED];
static dem_mesh_contact contacts[BALLS][DEM_MESH_CONTACTS];
static dem_mesh_contact last[BALLS][DEM_MESH_CONTACTS];
static int counts[BALLS];

static double now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

// a floor of SIDE x SIDE cells of edge 1 that rises from x = 0 by `slope` on both sides
static dem_mesh_wall *make_wall(double slope)
{
    uint32_t row = SIDE + 1;
    dem_mesh mesh = {.vertex_count = (size_t)row * row, .triangle_count = (size_t)2 * SIDE * SIDE};
    mesh.vertices = malloc(mesh.vertex_count * sizeof *mesh.vertices);
    mesh.triangles = malloc(3 * mesh.triangle_count * sizeof *mesh.triangles);
    dem_mesh_wall *wall = NULL;
    dem_error error = {0};
    if (!mesh.vertices || !mesh.triangles)
        exit(1);
    for (uint32_t i = 0; i < row * row; i++) {
        double x = (double)(i / row) - 0.5 * SIDE, y = (double)(i % row) - 0.5 * SIDE;
        mesh.vertices[i] = v3(x, y, slope * fabs(x));
    }
    for (uint32_t i = 0; i < SIDE * SIDE; i++) {
        uint32_t a = i / SIDE * row + i % SIDE, cell[6] = {a, a + row, a + row + 1, a, a + row + 1, a + 1};
        for (size_t k = 0; k < 6; k++)
            mesh.triangles[6 * (size_t)i + k] = cell[k];
    }
    if (dem_mesh_wall_create(NULL, &mesh, "bench", &wall, &error) != DEM_OK) {
        fprintf(stderr, "%s\n", error.text);
        exit(1);
    }
    dem_mesh_free(&mesh);
    return wall;
}

static double distance2(const dem_mesh_wall *wall, uint32_t triangle, dem_vec3 p)
{
    return triangle_closest(&wall->triangles[triangle], p).distance2;
}

// the `listed` nearest triangles of each ball
static void list_nearest(const dem_mesh_wall *wall, size_t listed)
{
    dem_ray_list list = {0};
    for (int i = 0; i < BALLS; i++) {
        double reach = 0.1;
        do {
            reach *= 1.05;
            if (!dem_mesh_wall_near(wall, centres[i], reach, &list))
                exit(1);
        } while (list.count < listed);
        for (size_t k = 0; k < listed; k++) {
            size_t nearest = k;
            for (size_t j = k + 1; j < list.count; j++)
                if (distance2(wall, list.items[j], centres[i]) < distance2(wall, list.items[nearest], centres[i]))
                    nearest = j;
            ids[i][k] = list.items[nearest];
            list.items[nearest] = list.items[k];
        }
    }
    free(list.items);
}

static void find_all(const dem_mesh_wall *wall, size_t listed, double radius)
{
    for (int i = 0; i < BALLS; i++)
        counts[i] = dem_mesh_wall_contacts(wall, ids[i], listed, centres[i], radius, contacts[i], DEM_MESH_CONTACTS);
}

// the same by way of all closest points at once
static void find_all_at_once(const dem_mesh_wall *wall, size_t listed, double radius)
{
    static uint32_t pair_ids[BALLS * LISTED];
    static dem_vec3 pair_centres[BALLS * LISTED];
    static dem_closest spots[BALLS * LISTED];
    size_t pairs = 0;
    for (int i = 0; i < BALLS; i++)
        for (size_t k = 0; k < listed; k++) {
            pair_ids[pairs] = ids[i][k];
            pair_centres[pairs++] = centres[i];
        }
    dem_mesh_wall_spots(wall, pair_ids, pair_centres, pairs, spots);
    for (int i = 0; i < BALLS; i++)
        counts[i] = dem_mesh_wall_sift(wall, ids[i], &spots[(size_t)i * listed], listed, centres[i], radius,
                                       contacts[i], DEM_MESH_CONTACTS);
}

static void follow_all(void)
{
    int from[DEM_MESH_CONTACTS];
    for (int i = 0; i < BALLS; i++)
        dem_mesh_contacts_follow(last[i], counts[i], contacts[i], counts[i], 0.01, from);
}

static void time_contacts(const dem_mesh_wall *wall, const char *where, size_t listed, double radius)
{
    double find = 1e9, at_once = 1e9, follow = 1e9, touched = 0;
    list_nearest(wall, listed);
    for (int round = 0; round < ROUNDS; round++) {
        double start = now();
        find_all_at_once(wall, listed, radius);
        at_once = fmin(at_once, now() - start);
        start = now();
        find_all(wall, listed, radius);
        double found = now();
        follow_all();
        follow = fmin(follow, now() - found);
        find = fmin(find, found - start);
        memcpy(last, contacts, sizeof last);
    }
    for (int i = 0; i < BALLS; i++)
        touched += counts[i];
    printf("%-12s %zu listed: %6.1f ns per ball, %6.1f ns by closest points of all at once, follow %5.1f ns, %.2f "
           "contacts\n",
           where, listed, 1e9 * find / BALLS, 1e9 * at_once / BALLS, 1e9 * follow / BALLS, touched / BALLS);
}

static void time_spots_and_near(const dem_mesh_wall *wall)
{
    static dem_closest spots[BALLS];
    static uint32_t first[BALLS];
    dem_ray_list list = {0};
    double spot = 1e9, near = 1e9;
    for (int i = 0; i < BALLS; i++)
        first[i] = ids[i][0];
    for (int round = 0; round < ROUNDS; round++) {
        double start = now();
        dem_mesh_wall_spots(wall, first, centres, BALLS, spots);
        spot = fmin(spot, now() - start);
    }
    for (int round = 0; round < ROUNDS / 20; round++) {
        double start = now();
        for (int i = 0; i < BALLS; i++)
            dem_mesh_wall_near(wall, centres[i], 0.35, &list);
        near = fmin(near, now() - start);
    }
    printf("closest point %.1f ns per pair, near %.0f ns per ball\n", 1e9 * spot / BALLS, 1e9 * near / BALLS);
    free(list.items);
}

// balls of radius 0.3 over lattice points, row by row as a world keeps its bodies, in x only over the given one if any;
// off them by up to half of `aside`
static void place(double x, double aside_x, double aside_y, double height)
{
    dem_random r = random_stream(1, 0);
    for (int i = 0; i < BALLS; i++) {
        double u = random_uniform(&r), v = random_uniform(&r);
        double row = isnan(x) ? (double)(i / SIDE % (SIDE - 8)) - 0.5 * SIDE + 4 : x;
        double y = (double)(i % SIDE) * (SIDE - 8) / SIDE - 0.5 * SIDE + 4;
        centres[i] = v3(row + aside_x * (u - 0.5), rint(y) + aside_y * (v - 0.5), height);
    }
}

int main(void)
{
    dem_mesh_wall *floor = make_wall(0), *groove = make_wall(1);
    place(NAN, 1, 1, 0.295);
    time_contacts(floor, "floor", 1, 0.3);
    time_contacts(floor, "floor", 2, 0.3);
    time_spots_and_near(floor);
    place(NAN, 0.2, 0.2, 0.295);
    time_contacts(floor, "near corners", 6, 0.3);
    place(0, 0.001, 1, 0.295 * sqrt(2));
    time_contacts(groove, "groove", 2, 0.3);
    time_contacts(groove, "groove", 6, 0.3);
    dem_mesh_wall_destroy(floor);
    dem_mesh_wall_destroy(groove);
    return 0;
}
