#include "mesh/shells.h"

#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/sets.h"
#include "geom/tree.h"
#include "mesh/mass.h"

void dem_shells_release(dem_shells *shells)
{
    free(shells->of);
    free(shells->list);
    free(shells->hosts);
    *shells = (dem_shells){0};
}

// patches that use an edge more often one way than the other need each other
static void join_patches(const dem_surface *s, uint32_t *parent, long *net)
{
    for (size_t i = 0; i < s->edges.many; i++) {
        const uint32_t *fan = s->edges.fan;
        size_t begin = s->edges.fan_start[i], end = s->edges.fan_start[i + 1];
        uint32_t from = half_start(s->mesh, fan[begin]), first = UINT32_MAX;
        for (size_t k = begin; k < end; k++)
            net[s->patch[fan[k] / 3]] += half_start(s->mesh, fan[k]) == from ? 1 : -1;
        for (size_t k = begin; k < end; k++) {
            uint32_t p = s->patch[fan[k] / 3];
            if (net[p] == 0)
                continue;
            if (first == UINT32_MAX)
                first = p;
            sets_join(parent, p, first);
        }
        for (size_t k = begin; k < end; k++)
            net[s->patch[fan[k] / 3]] = 0;
    }
}

static void measure(dem_shells *shells, const dem_mesh *mesh)
{
    dem_box box = dem_mesh_box(mesh);
    dem_vec3 middle = v3_along(box.low, 0.5, v3_sub(box.high, box.low));
    for (size_t i = 0; i < shells->count; i++)
        shells->list[i] = (dem_shell){.box = box_empty()};
    for (size_t t = 0; t < mesh->triangle_count; t++) {
        dem_shell *shell = &shells->list[shells->of[t]];
        dem_vec3 p[3];
        for (int k = 0; k < 3; k++) {
            p[k] = v3_sub(mesh->vertices[mesh->triangles[3 * t + (size_t)k]], middle);
            shell->box = box_with(shell->box, v3_add(p[k], middle));
        }
        double area = dem_triangle_area(mesh, t);
        shell->volume += v3_dot(p[0], v3_cross(p[1], p[2])) / 6;
        shell->area += area;
        if (shell->triangles++ == 0 || area > dem_triangle_area(mesh, shell->largest))
            shell->largest = (uint32_t)t;
    }
}

dem_status dem_shells_find(dem_shells *shells, const dem_surface *s, dem_error *error)
{
    *shells = (dem_shells){0};
    uint32_t *parent = dem_alloc(s->patch_count, sizeof *parent), *number = dem_alloc(s->patch_count, sizeof *number);
    long *net = dem_alloc_zero(s->patch_count, sizeof *net);
    shells->of = dem_alloc(s->mesh->triangle_count, sizeof *shells->of);
    shells->list = dem_alloc(s->patch_count, sizeof *shells->list);
    bool fine = parent && number && net && shells->of && shells->list;
    if (fine) {
        sets_init(parent, s->patch_count);
        join_patches(s, parent, net);
        for (uint32_t i = 0; i < s->patch_count; i++)
            if (parent[i] == i)
                number[i] = (uint32_t)shells->count++;
        for (size_t t = 0; t < s->mesh->triangle_count; t++)
            shells->of[t] = number[sets_root(parent, s->patch[t])];
        measure(shells, s->mesh);
    }
    free(parent);
    free(number);
    free(net);
    if (!fine)
        dem_shells_release(shells);
    return fine ? DEM_OK : dem_fail_memory(error);
}

// what the rays from one point pass, shell by shell
typedef struct passes {
    const dem_shells *shells;
    int *net;              // signed passes of this ray; [count], zero between rays
    unsigned char *votes;  // rays with a net pass; [count], zero between points
    unsigned char *known;  // passed by some ray from this point
    uint32_t *list;        // the shells known
    size_t listed;
} passes;

static bool passes_init(passes *p, const dem_shells *shells)
{
    size_t count = shells->count;
    *p = (passes){.shells = shells, .net = dem_alloc_zero(count, sizeof *p->net), .votes = dem_alloc_zero(count, 1),
                  .known = dem_alloc_zero(count, 1), .list = dem_alloc(count, sizeof *p->list)};
    return p->net && p->votes && p->known && p->list;
}

static void passes_release(passes *p)
{
    free(p->net);
    free(p->votes);
    free(p->known);
    free(p->list);
}

static void pass(void *user, uint32_t triangle, int leaving, double t)
{
    (void)t;
    passes *p = user;
    uint32_t shell = p->shells->of[triangle];
    if (!p->known[shell]) {
        p->known[shell] = 1;
        p->list[p->listed++] = shell;
    }
    p->net[shell] += leaving;
}

static bool box_inside(const dem_box *inner, const dem_box *outer)
{
    return inner->low.x >= outer->low.x && inner->low.y >= outer->low.y && inner->low.z >= outer->low.z &&
           inner->high.x <= outer->high.x && inner->high.y <= outer->high.y && inner->high.z <= outer->high.z;
}

// three rays from the middle of the shell's largest triangle vote
static void find_passes(passes *p, const dem_mesh *mesh, const dem_tree *tree, uint32_t shell)
{
    static const dem_vec3 directions[] = {
        {0.43571, 0.61913, -0.65337}, {-0.71219, 0.30211, 0.63367}, {0.19171, -0.83117, 0.52189}};
    const uint32_t *v = mesh->triangles + 3 * (size_t)p->shells->list[shell].largest;
    dem_vec3 sum = v3_add(v3_add(mesh->vertices[v[0]], mesh->vertices[v[1]]), mesh->vertices[v[2]]);
    p->listed = 0;
    for (size_t k = 0; k < sizeof directions / sizeof directions[0]; k++) {
        dem_tree_ray(tree, v3_scale(sum, 1.0 / 3), directions[k], pass, p);
        for (size_t i = 0; i < p->listed; i++) {
            p->votes[p->list[i]] += p->net[p->list[i]] != 0;
            p->net[p->list[i]] = 0;
        }
    }
}

static bool list_hosts(dem_shells *shells, passes *p, uint32_t shell, size_t *room)
{
    dem_shell *s = &shells->list[shell];
    for (size_t i = 0; i < p->listed; i++) {
        uint32_t host = p->list[i];
        bool inside = host != shell && p->votes[host] >= 2 && box_inside(&s->box, &shells->list[host].box);
        p->votes[host] = p->known[host] = 0;
        if (!inside)
            continue;
        if (!dem_grow(&shells->hosts, room, s->hosts_end, sizeof *shells->hosts))
            return false;
        shells->hosts[s->hosts_end++] = host;
    }
    return true;
}

dem_status dem_shells_nest(dem_shells *shells, const dem_mesh *mesh, dem_error *error)
{
    if (shells->count == 1 || shells->nested)
        return DEM_OK;
    dem_tree tree;
    DEM_TRY(dem_tree_build(&tree, mesh->vertices, mesh->triangles, mesh->triangle_count, error));
    passes p;
    bool fine = passes_init(&p, shells);
    size_t room = 0, found = 0;
    for (uint32_t i = 0; fine && i < shells->count; i++) {
        shells->list[i].hosts_begin = shells->list[i].hosts_end = found;
        if (shells->list[i].entangled)
            continue;
        find_passes(&p, mesh, &tree, i);
        fine = list_hosts(shells, &p, i, &room);
        found = shells->list[i].hosts_end;
    }
    passes_release(&p);
    dem_tree_release(&tree);
    shells->nested = fine;
    return fine ? DEM_OK : dem_fail_memory(error);
}

static uint32_t extreme_host(const dem_shells *shells, uint32_t shell, bool outermost)
{
    const dem_shell *s = &shells->list[shell];
    uint32_t best = shell;
    for (size_t i = s->hosts_begin; i < s->hosts_end; i++) {
        double volume = fabs(shells->list[shells->hosts[i]].volume), known = fabs(shells->list[best].volume);
        if (best == shell || (outermost ? volume > known : volume < known))
            best = shells->hosts[i];
    }
    return best;
}

uint32_t dem_shell_outermost(const dem_shells *shells, uint32_t shell)
{
    return extreme_host(shells, shell, true);
}

uint32_t dem_shell_innermost(const dem_shells *shells, uint32_t shell)
{
    return extreme_host(shells, shell, false);
}
