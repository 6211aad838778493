// Repair of meshes made from bytes: soups on a small lattice, where everything touches everything, and spheres with
// triangles dropped, doubled, turned, and vertices moved. What comes out is closed and finite, or refused.
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/random.h"
#include "dem/mesh.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

enum { MOST = 4000, RINGS = 6, SIDES = 8 };

typedef struct bytes {
    const uint8_t *data;
    size_t left;
} bytes;

static unsigned next_byte(bytes *b)
{
    if (b->left == 0)
        return 0;
    b->left--;
    return *b->data++;
}

static void soup(bytes *b, dem_mesh *mesh)
{
    double step = ldexp(1, (int)next_byte(b) % 40 - 20);
    unsigned lattice = 2 + next_byte(b) % 8;
    while (b->left >= 3 && mesh->vertex_count + 3 <= MOST) {
        dem_vec3 *p = &mesh->vertices[mesh->vertex_count++];
        unsigned x = next_byte(b), y = next_byte(b), z = next_byte(b);
        p->x = (x % lattice) * step + (x >= 250 ? 1e-7 * step : 0);
        p->y = (y % lattice) * step;
        p->z = (z % lattice) * step;
    }
    for (uint32_t i = 0; i + 2 < mesh->vertex_count; i += 1) {
        uint32_t *t = mesh->triangles + 3 * mesh->triangle_count++;
        t[0] = i;
        t[1] = i + 1;
        t[2] = i + 2;
    }
}

static void sphere(dem_mesh *mesh)
{
    uint32_t first = (uint32_t)mesh->vertex_count;
    mesh->vertices[mesh->vertex_count++] = (dem_vec3){0, 0, 1};
    for (int i = 1; i < RINGS; i++)
        for (int k = 0; k < SIDES; k++) {
            double a = 3.14159265 * i / RINGS, c = 6.2831853 * k / SIDES;
            mesh->vertices[mesh->vertex_count++] = (dem_vec3){sin(a) * cos(c), sin(a) * sin(c), cos(a)};
        }
    mesh->vertices[mesh->vertex_count++] = (dem_vec3){0, 0, -1};
    for (uint32_t i = 0; i < RINGS; i++)
        for (uint32_t k = 0; k < SIDES; k++) {
            uint32_t up = first + 1 + (i - 1) * SIDES, low = up + SIDES, n = (k + 1) % SIDES;
            uint32_t a = i == 0 ? first : up + k, b = i == 0 ? first : up + n;
            uint32_t c = i == RINGS - 1 ? first + 1 + (RINGS - 1) * SIDES : low + k, d = i == RINGS - 1 ? c : low + n;
            uint32_t *t = mesh->triangles + 3 * mesh->triangle_count;
            if (c != d)
                memcpy(t, (uint32_t[]){a, c, d}, 3 * sizeof *t), mesh->triangle_count++, t += 3;
            if (a != b)
                memcpy(t, (uint32_t[]){a, d, b}, 3 * sizeof *t), mesh->triangle_count++;
        }
}

static void damage(bytes *b, dem_mesh *mesh)
{
    while (b->left >= 3 && mesh->triangle_count > 1 && mesh->triangle_count < MOST) {
        unsigned what = next_byte(b);
        size_t at = (next_byte(b) + 256 * next_byte(b)) % mesh->triangle_count;
        uint32_t *t = mesh->triangles + 3 * at, *last = mesh->triangles + 3 * (mesh->triangle_count - 1);
        double amount = ldexp(next_byte(b) / 128.0 - 1, -(int)(what / 32) * 3);
        switch (what % 8) {
        case 0:
            memmove(t, last, 3 * sizeof *t);
            mesh->triangle_count--;
            break;
        case 1:
            memcpy(last + 3, t, 3 * sizeof *t);
            mesh->triangle_count++;
            break;
        case 2:
            memcpy(t, (uint32_t[]){t[1], t[0], t[2]}, 3 * sizeof *t);
            break;
        case 3:
            mesh->vertices[t[0]].x += amount;
            break;
        case 4:
            mesh->vertices[t[1]].z += amount;
            break;
        case 5:
            t[next_byte(b) % 3] = next_byte(b) % (uint32_t)mesh->vertex_count;
            break;
        case 6:
            mesh->vertices[t[2]] = mesh->vertices[next_byte(b) % mesh->vertex_count];
            break;
        default:
            if (mesh->triangle_count + 100 < MOST && mesh->vertex_count + 100 < MOST) {
                size_t from = mesh->vertex_count;
                sphere(mesh);
                for (size_t i = from; i < mesh->vertex_count; i++) {
                    mesh->vertices[i].x = (0.2 + what / 256.0) * mesh->vertices[i].x + 2 * amount;
                    mesh->vertices[i].y += amount;
                }
            }
        }
    }
}

static void require(int condition)
{
    if (!condition)
        abort();
}

static void check_solid(const dem_mesh *mesh, const dem_mesh_report *report)
{
    uint64_t sum = 0;
    for (size_t i = 0; i < 3 * mesh->triangle_count; i++) {
        uint64_t a = mesh->triangles[i], c = mesh->triangles[i % 3 == 2 ? i - 2 : i + 1];
        require(a < mesh->vertex_count && a != c);
        uint64_t hash = random_mix(a < c ? a << 32 | c : c << 32 | a);
        sum += a < c ? hash : -hash;
        dem_vec3 p = mesh->vertices[a];
        require(isfinite(p.x) && isfinite(p.y) && isfinite(p.z));
    }
    require(sum == 0);
    dem_solid solid = dem_mesh_solid(mesh);
    require(solid.volume > 0 && isfinite(solid.volume) && solid.principal[0] > 0 && isfinite(solid.principal[2]));
    require(fabs(solid.volume - report->volume) <= 1e-12 * solid.volume && report->bodies >= 1);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    bytes b = {data, size};
    dem_mesh mesh = {.vertices = malloc((MOST + 8) * sizeof(dem_vec3)), .triangles = malloc(3 * (MOST + 8) * sizeof(uint32_t))};
    unsigned how = next_byte(&b);
    if (how % 2) {
        soup(&b, &mesh);
    } else {
        sphere(&mesh);
        damage(&b, &mesh);
    }
    dem_repair_options options = {.keep = (dem_keep)(how / 2 % 3),
                                  .repair = how / 6 % 8 ? DEM_REPAIR_AUTO : (dem_repair)(how / 48 % 2 ? DEM_REPAIR_STRICT : DEM_REPAIR_NONE)};
    dem_mesh_report report;
    dem_error error;
    if (dem_mesh_repair(NULL, &mesh, &options, &report, &error) == DEM_OK && options.repair != DEM_REPAIR_NONE) {
        check_solid(&mesh, &report);
        // what was repaired is fine as it is
        double volume = report.volume;
        options.keep = DEM_KEEP_ALL;
        require(dem_mesh_repair(NULL, &mesh, &options, &report, &error) == DEM_OK);
        check_solid(&mesh, &report);
        require(fabs(report.volume - volume) <= 1e-6 * volume);
        dem_mesh *bodies;
        size_t count;
        require(dem_mesh_split(&mesh, &bodies, &count, &error) == DEM_OK && count == report.bodies);
        for (size_t i = 0; i < count; i++)
            dem_mesh_free(&bodies[i]);
        free(bodies);
    }
    dem_mesh_free(&mesh);
    return 0;
}
