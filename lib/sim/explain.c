// What a scene pays for, in the words of the lists that everything is made from.
#include <stdlib.h>
#include <string.h>

#include "base/status.h"
#include "base/text.h"
#include "sim/bodies.h"
#include "sim/bonds.h"
#include "sim/contacts.h"
#include "sim/population.h"
#include "sim/schemes.h"
#include "sim/timestep.h"

static const char *const instruction_sets[][2] = {{"v4", "AVX-512"}, {"v3", "AVX2"}, {"plain", "plain C"}};

static void put_row(dem_buffer *out, const char *name, size_t bytes, const char *about, const char *unit)
{
    dem_buffer_print(out, "  %-14s %4zu B  %s [%s]\n", name, bytes, about, unit);
}

static void put_bodies(dem_buffer *out, const dem_world *w)
{
    dem_buffer_print(out, "columns of a body, %.0f B:\n", dem_bodies_bytes(w));
#define COLUMN(type, name, width, unit, when, about)                                                                   \
    if (when)                                                                                                          \
        put_row(out, #name, (width) * sizeof(type), about, unit);
    DEM_BODY_COLUMNS(COLUMN)
#undef COLUMN
}

static void put_contacts(dem_buffer *out, const dem_world *w, int form, const char *what)
{
    const dem_features *f = &w->features;
    bool walls = form >= 0, mesh = form == DEM_FORM_MESH;
    dem_buffer_print(out, "columns of a contact %s, %zu B:\n", what, dem_contact_bytes(f, form));
#define COLUMN(type, name, unit, when, about)                                                                          \
    if (when)                                                                                                          \
        put_row(out, #name, sizeof(type), about, unit);
    DEM_CONTACT_COLUMNS(COLUMN)
#undef COLUMN
}

static void put_kernel(dem_buffer *out, const dem_world *w)
{
    const char *set = w->kernels->name;
    for (size_t i = 0; i < sizeof instruction_sets / sizeof *instruction_sets; i++)
        if (strcmp(set, instruction_sets[i][0]) == 0)
            set = instruction_sets[i][1];
    dem_buffer_print(out, "kernel: %s (%s)", w->instance->name, set);
    dem_buffer_text(out,
                    w->instance->any ? ", which asks for each feature as it goes\n" : ", made for these features\n");
    if (w->laws.plugin.table) {
        const dem_law_spec *spec = w->laws.plugin.table->spec;
        dem_buffer_print(out, "law: %s, version %u, of a plug-in with %u numbers; it remembers %u of each contact\n",
                         spec->name, spec->version, spec->parameter_count, 3u * spec->vectors + spec->numbers);
    }
    dem_buffer_text(out, "features:\n");
    bool some = false;
#define FEATURE(name, about)                                                                                           \
    if (w->features.name) {                                                                                            \
        dem_buffer_print(out, "  %-14s %s\n", #name, about);                                                           \
        some = true;                                                                                                   \
    }
    DEM_FEATURES(FEATURE)
#undef FEATURE
    if (!some)
        dem_buffer_text(out, "  none\n");
}

static size_t count_walls(const dem_world *w, dem_wall_form form)
{
    size_t count = 0;
    for (size_t i = 0; i < w->walls.count; i++)
        count += w->walls.items[i].form == form;
    return count;
}

static void put_held(dem_buffer *out, const dem_world *w)
{
    size_t given = 0, locked = 0, plane = 0;
    for (size_t row = 0; row < w->bodies.count; row++) {
        uint32_t hold = body_hold(&w->bodies, row);
        bool flat = (hold & (DEM_LOCK_ALL | DEM_LOCK_TURNS)) == DEM_LOCK_PLANE;
        given += (hold & (DEM_HOLD_VELOCITY | DEM_HOLD_SPIN)) != 0;
        plane += flat;
        locked += !flat && (hold & (DEM_LOCK_ALL | DEM_LOCK_TURNS));
    }
    dem_buffer_text(out, "    body by body, for some are held:");
    if (given)
        dem_buffer_print(out, " %zu at a velocity or spin%s", given, locked + plane ? "," : "");
    if (locked)
        dem_buffer_print(out, " %zu along or about some axes%s", locked, plane ? "," : "");
    if (plane)
        dem_buffer_print(out, " %zu in two dimensions", plane);
    dem_buffer_text(out, "\n");
}

// of triangles; the rest of the form is smooth
static size_t count_meshes(const dem_world *w)
{
    size_t count = 0;
    for (size_t i = 0; i < w->walls.count; i++)
        count += w->walls.items[i].mesh != NULL;
    return count;
}

static void put_walls(dem_buffer *out, const dem_world *w)
{
    size_t meshes = count_meshes(w), smooth = count_walls(w, DEM_FORM_MESH) - meshes, servos = 0;
    for (size_t i = 0; i < w->walls.count; i++)
        servos += w->walls.items[i].servo.on;
    if (meshes)
        dem_buffer_text(out, "  mesh contacts: exact closest points on the listed triangles\n");
    if (smooth)
        dem_buffer_print(out, "  contacts of %zu cones, spheres, discs and rectangles: exact closest points\n", smooth);
    if (w->walls.count)
        dem_buffer_print(out, "  walls: %zu planes, %zu cylinders, %zu meshes\n", count_walls(w, DEM_FORM_PLANE),
                         count_walls(w, DEM_FORM_CYLINDER), meshes);
    if (servos)
        dem_buffer_print(out, "  %zu servo walls: sums of their contacts, then a velocity\n", servos);
    if (w->walls.wear)
        dem_buffer_print(out, "  wear of walls, %s\n",
                         w->walls.rub ? "by the force and path of each contact" : "when a body begins to touch");
}

static void put_motion(dem_buffer *out, const dem_world *w, size_t isotropic)
{
    const dem_scheme *t = &dem_translations[w->integrator.translation], *r = &dem_rotations[w->integrator.rotation];
    dem_buffer_print(out, "  motion: %s, ",
                     w->integrator.translation == DEM_TRANSLATION_CENTRAL ? "central differences" : t->about);
    bool lsym = w->integrator.rotation == DEM_ROTATION_LSYM;
    if (lsym && isotropic == w->bodies.living)
        dem_buffer_text(out, "isotropic rotation (all bodies have three equal moments)\n");
    else if (lsym && isotropic)
        dem_buffer_print(out, "rotation by lsym, isotropic for %zu bodies\n", isotropic);
    else if (lsym)
        dem_buffer_text(out, "rotation by lsym\n");
    else
        dem_buffer_print(out, "rotation by %s (%s)\n", r->name, r->about);
    if (!dem_schemes_default(w->integrator))
        dem_buffer_print(out,
                         "    one evaluation of the forces a step; body by body, about %g times as long as by the "
                         "default schemes\n",
                         r->number);
    if (w->held)
        put_held(out, w);
}

static void put_population(dem_buffer *out, const dem_world *w)
{
    const dem_population *p = w->population;
    if (p->inlet_count)
        dem_buffer_print(out,
                         "  %zu inlet%s: rows for %zu bodies now, more when they are taken; every body that comes makes a "
                         "search due\n",
                         p->inlet_count, p->inlet_count == 1 ? "" : "s", w->bodies.count);
    if (w->domain.leaving == DEM_LEAVING_DELETE)
        dem_buffer_text(out, "  bodies outside of the domain are deleted, after each search\n");
}

static void put_bonds(dem_buffer *out, const dem_world *w)
{
    const dem_bonds *b = w->bonds;
    for (size_t d = 0; d < b->def_count; d++) {
        size_t count = 0;
        for (size_t i = 0; i < b->count; i++)
            count += b->items[i].def == d;
        dem_buffer_print(out, "  bonds \"%s\": %zu, ", b->defs[d].name, count);
        if (!b->made[d])
            dem_buffer_print(out, "made at %g s, ", b->defs[d].at);
        bool breaks = isfinite(b->defs[d].tensile_strength) || isfinite(b->defs[d].shear_strength);
        dem_buffer_print(out, "%s, %s\n",
                         b->defs[d].contact == DEM_BOND_INSTEAD ? "instead of the contact of their spheres"
                                                                : "beside the contact of their spheres",
                         breaks ? "breakable" : "unbreakable");
    }
    dem_buffer_print(out, "    %zu B a bond, a force and three moments each, added up by body\n", sizeof *b->items);
}

static void put_passes(dem_buffer *out, const dem_world *w)
{
    size_t isotropic = 0, meshes = count_meshes(w);
    for (size_t row = 0; row < w->bodies.count; row++)
        isotropic += !body_absent(&w->bodies, row) && w->bodies.inertia[DEM_ROW * row + 7] > 0;
    dem_buffer_text(out, "passes of a step:\n");
    if (w->walls.move)
        dem_buffer_text(out, "  walls move to their place\n");
    if (w->features.weighted)
        dem_buffer_text(out, "  weights of contacts that stand for the same pair\n");
    if (w->features.soft)
        dem_buffer_text(out, "  walls and pairs are soft: sums over the spheres of each pair, then one law for all of them\n");
    put_walls(out, w);
    dem_buffer_text(out, "  contacts of pairs\n");
    if (w->segment_count * DEM_SEGMENT > w->domain_bodies)
        dem_buffer_print(out, "  momenta across domains of %zu bodies\n", w->domain_bodies);
    if (w->bonds)
        put_bonds(out, w);
    put_motion(out, w, isotropic);
    if (w->damping.local > 0 || w->damping.viscous > 0)
        dem_buffer_text(out, "  with damping of the motion\n");
    if (w->bodies.fluid)
        dem_buffer_print(out, "  drag of a fluid on each body, within the kick%s\n",
                         w->damping.drag.buoyancy ? ", and buoyancy" : "");
    if (w->population)
        put_population(out, w);
    dem_buffer_text(out, "  lists, when bodies have moved: search, refresh, rebuild\n");
    dem_buffer_print(out, "libraries: %s\n",
                     meshes ? "Embree, for triangles near a body" : "none (Embree is not started)");
}

static void put_stable(dem_buffer *out, double step, const char *contacts)
{
    if (!isfinite(step))
        return;  // there are none
    dem_buffer_text(out, "  stable below ");
    dem_buffer_number(out, step, 4);
    dem_buffer_print(out, " s with %s\n", contacts);
}

static dem_status put_step(dem_buffer *out, dem_world *w, dem_error *error)
{
    dem_step_bound touching, listed;
    DEM_TRY(dem_step_stable(w, false, &touching, error));
    DEM_TRY(dem_step_stable(w, true, &listed, error));
    double accurate = dem_step_accurate(w);
    dem_buffer_text(out, "time step: ");
    dem_buffer_number(out, w->next_step, 4);
    dem_buffer_print(out, " s, %s\n", w->time_def.step > 0 ? "as given" : "automatic");
    put_stable(out, touching.step, "the contacts that touch");
    put_stable(out, listed.step, "all that may touch soon");
    dem_buffer_text(out, "  ");
    dem_buffer_number(out, accurate, 4);
    double steps = w->time_def.contact_steps > 0 ? w->time_def.contact_steps : DEM_PI;
    dem_buffer_text(out, " s takes the shortest contact in ");
    dem_buffer_number(out, steps, 3);
    dem_buffer_text(out, " steps\n");
    return DEM_OK;
}

dem_status dem_world_explain(dem_world *w, char **text, dem_error *error)
{
    dem_buffer out = {0};
    size_t spheres = 0;
    for (size_t row = 0; row < w->bodies.count; row++)
        spheres += body_absent(&w->bodies, row) ? 0 : w->templates.items[w->bodies.shape[row]].count;
    dem_buffer_print(&out, "%zu bodies of %zu spheres in all, %zu shapes, %zu walls, %d threads\n", w->bodies.living,
                     spheres, w->shape_count, w->walls.count, w->threads);
    put_bodies(&out, w);
    put_contacts(&out, w, -1, "of a pair");
    if (count_walls(w, DEM_FORM_PLANE) + count_walls(w, DEM_FORM_CYLINDER))
        put_contacts(&out, w, DEM_FORM_PLANE, "with a wall");
    if (count_walls(w, DEM_FORM_MESH))
        put_contacts(&out, w, DEM_FORM_MESH, "with a mesh");
    put_kernel(&out, w);
    put_passes(&out, w);
    size_t regions;
    dem_regions_views(w->regions, &regions);
    if (regions)
        dem_buffer_print(&out, "measures: stress, fabric and packing of %zu region%s with every row of the series, nothing in a step\n",
                         regions, regions == 1 ? "" : "s");
    dem_soft_explain(w, &out);
    dem_status status = put_step(&out, w, error);
    if (status == DEM_OK && out.failed)
        status = dem_fail_memory(error);
    if (status != DEM_OK)
        dem_buffer_release(&out);
    else
        *text = out.data;
    return status;
}

double dem_world_bytes_per_body(const dem_world *w)
{
    size_t n = w->bodies.count;
    double bytes = dem_bodies_bytes(w) * (double)w->bodies.padded;
    bytes += (double)(w->bodies.momentum_rows - w->bodies.padded) * DEM_ROW * sizeof(double);
    bytes += (double)w->pairs.count * (sizeof *w->pairs.items + 2 * sizeof(uint32_t) + 2 * sizeof(double) + 4) +
             2.0 * sizeof(uint32_t) * (double)n;
    bytes += (double)w->contacts.capacity * (double)dem_contact_bytes(&w->features, -1);
    for (int form = 0; form < DEM_WALL_FORMS; form++)
        if (w->wall_contacts[form].segments)
            bytes += (double)w->wall_contacts[form].capacity * (double)dem_contact_bytes(&w->features, form);
    bytes += (double)w->segment_count * (sizeof(dem_segment) * 2 + sizeof(dem_tally) * (1 + DEM_WALL_FORMS));
    if (w->bonds)
        bytes += dem_bonds_bytes(w->bonds);
    n = w->bodies.living;
    return n ? bytes / (double)n : 0;
}
