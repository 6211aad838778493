#include "out/series.h"

#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/file.h"
#include "base/memory.h"
#include "out/names.h"
#include "sim/wall_motion.h"

// what a wall has beside its forces
typedef struct wall_columns {
    dem_vec3 through;
    bool moves, servo, wears;
} wall_columns;

struct dem_series {
    char *path;       // NULL: kept in `text`
    dem_buffer text;
    int file;
    size_t size;  // bytes of whole rows
    size_t rows, columns, wall_count, measure_count;  // columns: of the whole
    wall_columns *walls;
    bool bonds, lost;
};

// ---- columns

static const struct {
    const char *name;
    size_t at;
    enum { NUMBER, STEP, COUNT } kind;
} columns[] = {
#define COLUMN(kind, name, field)                                                                                      \
    {                                                                                                                  \
        name, offsetof(dem_figures, field), kind                                                                       \
    }
    COLUMN(NUMBER, "time_s", time),
    COLUMN(STEP, "step", step),
    COLUMN(NUMBER, "kinetic_J", energy.kinetic),
    COLUMN(NUMBER, "rotational_J", energy.rotational),
    COLUMN(NUMBER, "potential_J", energy.potential),
    COLUMN(NUMBER, "elastic_J", energy.elastic),
    COLUMN(NUMBER, "friction_J", energy.friction),
    COLUMN(NUMBER, "viscous_J", energy.viscous),
    COLUMN(NUMBER, "broken_J", energy.broken),
    COLUMN(NUMBER, "local_J", energy.local),
    COLUMN(NUMBER, "drag_J", energy.drag),
    COLUMN(NUMBER, "work_J", energy.work),
    COLUMN(NUMBER, "energy_error", energy.error),
    COLUMN(COUNT, "contacts", contacts),
    COLUMN(COUNT, "wall_contacts", wall_contacts),
    COLUMN(NUMBER, "coordination", coordination),
    COLUMN(NUMBER, "overlap_ratio", overlap_ratio),
    COLUMN(NUMBER, "centre_x_m", centre.x),
    COLUMN(NUMBER, "centre_y_m", centre.y),
    COLUMN(NUMBER, "centre_z_m", centre.z),
    COLUMN(NUMBER, "highest_m", highest),
    // where bodies come and go
    COLUMN(COUNT, "bodies", bodies),
    COLUMN(COUNT, "came_bodies", came),
    COLUMN(NUMBER, "came_kg", came_mass),
    COLUMN(COUNT, "left_bodies", left),
    COLUMN(NUMBER, "left_kg", left_mass),
    COLUMN(NUMBER, "brought_J", energy.brought),
#undef COLUMN
};
enum { FLOW_COLUMNS = 6, COLUMNS = sizeof columns / sizeof *columns - FLOW_COLUMNS };

// of a region
static const struct {
    const char *name;
    size_t at;
    bool count;
} measures[] = {
#define COLUMN(name, field, count)                                                                                     \
    {                                                                                                                  \
        name, offsetof(dem_measure_view, field), count                                                                 \
    }
    COLUMN("stress_xx_Pa", stress.xx, false),
    COLUMN("stress_yy_Pa", stress.yy, false),
    COLUMN("stress_zz_Pa", stress.zz, false),
    COLUMN("stress_xy_Pa", stress.xy, false),
    COLUMN("stress_xz_Pa", stress.xz, false),
    COLUMN("stress_yz_Pa", stress.yz, false),
    COLUMN("p_Pa", mean_stress, false),
    COLUMN("q_Pa", deviatoric_stress, false),
    COLUMN("fabric_xx", fabric.xx, false),
    COLUMN("fabric_yy", fabric.yy, false),
    COLUMN("fabric_zz", fabric.zz, false),
    COLUMN("fabric_xy", fabric.xy, false),
    COLUMN("fabric_xz", fabric.xz, false),
    COLUMN("fabric_yz", fabric.yz, false),
    COLUMN("void_ratio", void_ratio, false),
    COLUMN("coordination", coordination, false),
    COLUMN("volume_m3", volume, false),
    COLUMN("solid_m3", solid_volume, false),
    COLUMN("bodies", bodies, true),
    COLUMN("contacts", contacts, true),
#undef COLUMN
};
enum { MEASURE_COLUMNS = sizeof measures / sizeof *measures };

static wall_columns columns_of(const dem_wall_def *wall)
{
    return (wall_columns){wall->through, dem_wall_def_moves(wall), wall->servo.on, wall->wear.law != DEM_WEAR_NONE};
}

static dem_status put_head(dem_buffer *out, const dem_series_def *def, dem_error *error)
{
    static const char *const parts[] = {"fx_N", "fy_N", "fz_N", "mx_Nm", "my_Nm", "mz_Nm"};
    size_t count = def->wall_count;
    dem_plain_name *names = dem_alloc(count + def->measure_count, sizeof *names);
    if (!names)
        return dem_fail_memory(error);
    for (size_t i = 0; i < COLUMNS + (def->flow ? FLOW_COLUMNS : 0); i++)
        dem_buffer_print(out, "%s%s", i ? "," : "", columns[i].name);
    for (size_t i = 0; i < count; i++) {
        names[i] = dem_name_plain(def->walls[i].name, "wall", names, i);
        for (int k = 0; k < 6; k++)
            dem_buffer_print(out, ",%s_%s", names[i].text, parts[k]);
        wall_columns more = columns_of(&def->walls[i]);
        if (more.moves)
            dem_buffer_print(out, ",%s_x_m,%s_y_m,%s_z_m", names[i].text, names[i].text, names[i].text);
        if (more.servo)
            dem_buffer_print(out, ",%s_stress_Pa", names[i].text);
        if (more.wears)
            dem_buffer_print(out, ",%s_wear_m3", names[i].text);
    }
    for (size_t i = 0; i < def->measure_count; i++) {
        names[count + i] = dem_name_plain(def->measures[i].name, "region", names, count + i);
        for (int k = 0; k < MEASURE_COLUMNS; k++)
            dem_buffer_print(out, ",%s_%s", names[count + i].text, measures[k].name);
    }
    if (def->bonds)
        dem_buffer_text(out, ",bonds,bonds_broken_tension,bonds_broken_shear");
    if (def->lost)
        dem_buffer_text(out, ",bonds_lost");
    dem_buffer_text(out, "\n");
    free(names);
    return out->failed ? dem_fail_memory(error) : DEM_OK;
}

static void put_measure(dem_buffer *out, const dem_measure_view *view)
{
    for (int k = 0; k < MEASURE_COLUMNS; k++) {
        const char *value = (const char *)view + measures[k].at;
        dem_buffer_text(out, ",");
        if (measures[k].count)
            dem_buffer_print(out, "%zu", *(const size_t *)value);
        else
            dem_buffer_shortest(out, *(const double *)value);
    }
}

// how far the wall has come, what presses on it, what it has lost
static void put_more(dem_buffer *out, const wall_columns *wall, const dem_wall_view *view)
{
    dem_vec3 now = v3_add(view->position, quat_rotate(view->orientation, wall->through));
    for (int k = 0; k < 3 && wall->moves; k++) {
        dem_buffer_text(out, ",");
        dem_buffer_shortest(out, v3_get(now, k) - v3_get(wall->through, k));
    }
    if (wall->servo) {
        dem_buffer_text(out, ",");
        dem_buffer_shortest(out, view->pressure);
    }
    if (wall->wears) {
        dem_buffer_text(out, ",");
        dem_buffer_shortest(out, view->worn);
    }
}

static void put_row(dem_buffer *out, const dem_series *s, const dem_figures *figures, const dem_wall_view *walls,
                    const dem_measure_view *views)
{
    size_t count = s->wall_count;
    for (size_t i = 0; i < s->columns; i++) {
        const char *value = (const char *)figures + columns[i].at;
        if (i)
            dem_buffer_text(out, ",");
        if (columns[i].kind == NUMBER)
            dem_buffer_shortest(out, *(const double *)value);
        else if (columns[i].kind == STEP)
            dem_buffer_print(out, "%llu", (unsigned long long)*(const uint64_t *)value);
        else
            dem_buffer_print(out, "%zu", *(const size_t *)value);
    }
    for (size_t i = 0; i < count; i++) {
        const dem_vec3 f = walls[i].force, m = walls[i].moment;
        const double parts[6] = {f.x, f.y, f.z, m.x, m.y, m.z};
        for (int k = 0; k < 6; k++) {
            dem_buffer_text(out, ",");
            dem_buffer_shortest(out, parts[k]);
        }
        put_more(out, &s->walls[i], &walls[i]);
    }
    for (size_t i = 0; i < s->measure_count; i++)
        put_measure(out, &views[i]);
    if (s->bonds)
        dem_buffer_print(out, ",%zu,%zu,%zu", figures->bonds, figures->bonds_tension, figures->bonds_shear);
    if (s->lost)
        dem_buffer_print(out, ",%zu", figures->bonds_lost);
    dem_buffer_text(out, "\n");
}

// ---- beginning

// keeps the whole rows up to the time to resume from
static dem_status keep_rows(dem_series *s, const dem_buffer *file, const dem_buffer *head, double resume,
                            dem_error *error)
{
    if (file->size < head->size || memcmp(file->data, head->data, head->size) != 0)
        return dem_fail_at(error, DEM_BAD_INPUT, s->path, 1,
                           "has other columns than this scene's; resume with another folder (-o)");
    const char *row = file->data + head->size, *end = file->data + file->size, *next;
    for (; (next = memchr(row, '\n', (size_t)(end - row))); row = next + 1) {
        double time;
        if (!dem_parse_double(row, next, &time) || !(time <= resume))
            break;
        s->rows++;
    }
    s->size = (size_t)(row - file->data);
    return DEM_OK;
}

static dem_status cannot_write(const dem_series *s, dem_error *error)
{
    return dem_fail_at(error, DEM_CANNOT_WRITE, s->path, 0, "cannot write: %s; choose another place with -o",
                       strerror(errno));
}

static dem_status begin(dem_series *s, const dem_buffer *head, double resume, dem_error *error)
{
    if (!s->path) {
        dem_buffer_bytes(&s->text, head->data, head->size);
        return s->text.failed ? dem_fail_memory(error) : DEM_OK;
    }
    if (isnan(resume) || access(s->path, F_OK) != 0) {
        DEM_TRY(dem_file_write(s->path, head->data, head->size, error));
        s->size = head->size;
    } else {
        dem_buffer file;
        dem_status status = dem_file_read(s->path, &file, error);
        if (status == DEM_OK)
            status = keep_rows(s, &file, head, resume, error);
        dem_buffer_release(&file);
        DEM_TRY(status);
    }
    s->file = open(s->path, O_WRONLY | O_APPEND | O_CLOEXEC);
    if (s->file < 0 || ftruncate(s->file, (off_t)s->size) != 0)
        return cannot_write(s, error);
    return DEM_OK;
}

dem_series_def dem_series_def_of(const dem_scene *scene, const char *directory, bool flow)
{
    return (dem_series_def){.directory = directory,
                            .flow = flow,
                            .walls = scene->walls,
                            .wall_count = scene->wall_count,
                            .measures = scene->measures,
                            .measure_count = scene->measure_count,
                            .bonds = scene->bond_count > 0,
                            .lost = scene->bond_count && scene->domain.leaving == DEM_LEAVING_DELETE};
}

dem_status dem_series_open(const dem_series_def *def, double resume, dem_series **series, dem_error *error)
{
    dem_buffer head = {0};
    dem_series *s = *series = dem_alloc_zero(1, sizeof *s);
    if (!s)
        return dem_fail_memory(error);
    const char *folder = def->directory;
    *s = (dem_series){.path = folder ? dem_path_join(folder, "series.csv") : NULL,
                      .file = -1,
                      .columns = COLUMNS + (def->flow ? FLOW_COLUMNS : 0),
                      .wall_count = def->wall_count,
                      .measure_count = def->measure_count,
                      .bonds = def->bonds,
                      .lost = def->lost};
    s->walls = dem_alloc(def->wall_count, sizeof *s->walls);
    for (size_t i = 0; s->walls && i < def->wall_count; i++)
        s->walls[i] = columns_of(&def->walls[i]);
    dem_status status = s->walls && (s->path || !folder) ? DEM_OK : dem_fail_memory(error);
    if (status == DEM_OK && folder)
        status = dem_folder_create(folder, error);
    if (status == DEM_OK)
        status = put_head(&head, def, error);
    if (status == DEM_OK)
        status = begin(s, &head, resume, error);
    dem_buffer_release(&head);
    if (status != DEM_OK) {
        dem_series_close(s);
        *series = NULL;
    }
    return status;
}

// ---- going on

static dem_status append(dem_series *s, const dem_buffer *row, dem_error *error)
{
    if (!s->path) {
        dem_buffer_bytes(&s->text, row->data, row->size);
        s->rows++;
        return s->text.failed ? dem_fail_memory(error) : DEM_OK;
    }
    for (size_t done = 0; done < row->size;) {
        ssize_t put = write(s->file, row->data + done, row->size - done);
        if (put < 0 && errno == EINTR)
            continue;
        if (put <= 0) {
            dem_status status = cannot_write(s, error);
            return ftruncate(s->file, (off_t)s->size) == 0 ? status : cannot_write(s, error);
        }
        done += (size_t)put;
    }
    s->size += row->size;
    s->rows++;
    return DEM_OK;
}

dem_status dem_series_write(dem_series *s, const dem_figures *figures, const dem_wall_view *walls,
                            const dem_measure_view *views, dem_error *error)
{
    dem_buffer row = {0};
    put_row(&row, s, figures, walls, views);
    dem_status status = row.failed ? dem_fail_memory(error) : append(s, &row, error);
    dem_buffer_release(&row);
    return status;
}

const char *dem_series_text(const dem_series *s)
{
    return s->path || s->text.failed ? NULL : s->text.data;
}

size_t dem_series_rows(const dem_series *s)
{
    return s->rows;
}

void dem_series_close(dem_series *s)
{
    if (!s)
        return;
    if (s->file >= 0)
        close(s->file);
    free(s->path);
    dem_buffer_release(&s->text);
    free(s->walls);
    free(s);
}
