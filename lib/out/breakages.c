#include "out/breakages.h"

#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "base/memory.h"
#include "base/text.h"

static int by_step(const void *p, const void *q)
{
    const dem_bond_view *a = *(const dem_bond_view *const *)p, *b = *(const dem_bond_view *const *)q;
    if (a->broken_step != b->broken_step)
        return a->broken_step < b->broken_step ? -1 : 1;
    return (a > b) - (a < b);
}

// a name in quotes where a comma or a quote would mislead
static void put_name(dem_buffer *out, const char *name)
{
    bool plain = !strpbrk(name, ",\"\n");
    if (!plain)
        dem_buffer_text(out, "\"");
    for (const char *c = name; *c; c++)
        dem_buffer_print(out, "%s%c", *c == '"' ? "\"" : "", *c);
    if (!plain)
        dem_buffer_text(out, "\"");
}

static void put_row(dem_buffer *out, const dem_bond_def *defs, const dem_bond_view *b)
{
    static const char *const modes[] = {
        [DEM_BOND_BROKEN_TENSION] = "tension", [DEM_BOND_BROKEN_SHEAR] = "shear", [DEM_BOND_LOST] = "lost"};
    const double numbers[] = {b->point.x, b->point.y, b->point.z, b->tensile_stress, b->shear_stress, b->radius};
    dem_buffer_shortest(out, b->broken);
    dem_buffer_print(out, ",%llu,", (unsigned long long)b->broken_step);
    put_name(out, defs[b->def].name ? defs[b->def].name : "");
    dem_buffer_print(out, ",%s,%u,%u,%u,%u", modes[b->state], (unsigned)b->id, (unsigned)b->other_id,
                     (unsigned)b->sphere, (unsigned)b->other_sphere);
    for (size_t k = 0; k < sizeof numbers / sizeof *numbers; k++) {
        dem_buffer_text(out, ",");
        dem_buffer_shortest(out, numbers[k]);
    }
    dem_buffer_text(out, "\n");
}

dem_status dem_breakages_write(dem_file_queue *queue, const char *directory, const dem_bond_def *defs,
                               const dem_bond_view *bonds, size_t count, dem_error *error)
{
    const dem_bond_view **broken = dem_alloc(count, sizeof *broken);
    char *path = dem_path_join(directory, "bonds.csv");
    size_t rows = 0;
    dem_buffer out = {0};
    for (size_t i = 0; broken && i < count; i++)
        if (bonds[i].state != DEM_BOND_INTACT)
            broken[rows++] = &bonds[i];
    if (rows)
        qsort(broken, rows, sizeof *broken, by_step);
    dem_buffer_text(&out, "time_s,step,bond,mode,body,other,sphere,other_sphere,x_m,y_m,z_m,tensile_stress_Pa,"
                          "shear_stress_Pa,radius_m\n");
    for (size_t i = 0; i < rows; i++)
        put_row(&out, defs, broken[i]);
    dem_status status = broken && path && !out.failed ? dem_folder_create(directory, error) : dem_fail_memory(error);
    if (status == DEM_OK)
        status = dem_file_queue_put(queue, path, &out, error);
    dem_buffer_release(&out);
    free(broken);
    free(path);
    return status;
}
