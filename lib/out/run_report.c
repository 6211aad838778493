#include "out/run_report.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "base/json.h"

enum { NAME = 26, VALUE = 12, FIGURES = 5 };  // columns of the tables, digits of their numbers

static const double NOTEWORTHY = 0.005;  // part of the time that is worth a row

typedef struct row {
    const char *key, *label;
    double value;
} row;

enum { ENERGIES = 12 };

static void list_energies(const dem_energy *e, row rows[ENERGIES])
{
    const row list[ENERGIES] = {
        {"start", "at the start", e->start},           {"work", "work of walls, pushes, held bodies", e->work},
        {"kinetic", "translation", e->kinetic},        {"rotational", "rotation", e->rotational},
        {"potential", "gravity", e->potential},        {"elastic", "in the contacts", e->elastic},
        {"friction", "lost to friction", e->friction}, {"viscous", "lost in contact dashpots", e->viscous},
        {"broken", "let go by broken bonds", e->broken}, {"local", "lost to local damping", e->local},
        {"drag", "lost to viscous damping and drag", e->drag}, {"brought", "brought by what came", e->brought}};
    memcpy(rows, list, sizeof list);
}

// ---- for programs

static void put_energy(dem_json_writer *w, const dem_energy *energy)
{
    row rows[ENERGIES];
    list_energies(energy, rows);
    dem_json_open_object(w, "energy");
    for (int i = 0; i < ENERGIES; i++)
        dem_json_put_number(w, rows[i].key, rows[i].value);
    dem_json_put_number(w, "error", energy->error);
    dem_json_close(w, '}');
}

static void put_inlet(dem_json_writer *w, const dem_inlet_view *inlet)
{
    dem_json_open_object(w, inlet->name);
    dem_json_put_whole(w, "bodies", (int64_t)inlet->bodies);
    dem_json_put_number(w, "mass", inlet->mass);
    dem_json_put_number(w, inlet->by_mass ? "asked_mass" : "asked_bodies", inlet->asked);
    dem_json_put_number(w, inlet->by_mass ? "behind_mass" : "behind_bodies", inlet->behind);
    dem_json_close(w, '}');
}

static void put_members(dem_json_writer *w, const dem_run_report *r)
{
    const dem_figures *f = &r->figures;
    dem_json_put_string(w, "ended", r->ended);
    dem_json_put_whole(w, "steps", (int64_t)(r->figures.step - r->warmup));
    dem_json_put_whole(w, "timed_steps", (int64_t)r->steps);
    dem_json_put_number(w, "time", f->time);
    dem_json_put_number(w, "step", r->step);
    dem_json_put_number(w, "critical_step", r->critical_step);
    dem_json_put_number(w, "loop_seconds", r->loop_seconds);
    dem_json_put_number(w, "setup_seconds", r->setup_seconds);
    dem_json_put_whole(w, "threads", r->threads);
    dem_json_put_whole(w, "clumps", (int64_t)f->bodies);
    dem_json_put_whole(w, "spheres", (int64_t)f->spheres);
    dem_json_put_whole(w, "contacts", (int64_t)f->contacts);
    dem_json_put_whole(w, "wall_contacts", (int64_t)f->wall_contacts);
    dem_json_put_number(w, "coordination", f->coordination);
    dem_json_put_number(w, "kinetic_energy", f->energy.kinetic + f->energy.rotational);
    dem_json_put_number(w, "potential_energy", f->energy.potential);
    dem_json_put_number(w, "energy_error", f->energy.error);
    dem_json_put_number(w, "max_overlap_ratio", f->largest_overlap_ratio);
    if (f->largest_soft_overlap > 0)
        dem_json_put_number(w, "max_overlap_tau", f->largest_soft_overlap);
    dem_json_put_number(w, "fastest", f->fastest);
    dem_json_put_numbers(w, "centre", (double[]){f->centre.x, f->centre.y, f->centre.z}, 3);
    dem_json_put_number(w, "highest", f->highest);
    dem_json_put_number(w, "bytes_per_clump", r->bytes_per_clump);
    put_energy(w, &f->energy);
    dem_json_put_whole(w, "came", (int64_t)f->came);
    dem_json_put_number(w, "came_mass", f->came_mass);
    dem_json_put_whole(w, "left", (int64_t)f->left);
    dem_json_put_number(w, "left_mass", f->left_mass);
    dem_json_open_object(w, "inlets");
    for (size_t i = 0; i < r->inlet_count; i++)
        put_inlet(w, &r->inlets[i]);
    dem_json_close(w, '}');
    dem_json_open_object(w, "passes");
    for (size_t i = 0; i < r->pass_count; i++)
        dem_json_put_number(w, r->passes[i].name, r->passes[i].seconds);
    dem_json_close(w, '}');
    dem_json_open_array(w, "warnings", false);
    for (size_t i = 0; i < r->warning_count; i++)
        dem_json_put_string(w, NULL, r->warnings[i]);
    dem_json_close(w, ']');
}

void dem_run_report_json(dem_buffer *out, const dem_run_report *r)
{
    dem_json_writer writer = dem_json_begin(out), *w = &writer;
    dem_json_open_object(w, NULL);
    put_members(w, r);
    dem_json_close(w, '}');
}

// a scene that is no JSON all the same is kept as text
static void put_scene(dem_json_writer *w, const char *scene)
{
    dem_json *root = NULL;
    if (dem_json_parse(scene, strlen(scene), "scene", &root, NULL) == DEM_OK)
        dem_json_put_raw(w, "scene", scene);
    else
        dem_json_put_string(w, "scene", scene);
    dem_json_release(root);
}

dem_status dem_run_report_write(const char *directory, const dem_run_report *r, dem_error *error)
{
    DEM_TRY(dem_folder_create(directory, error));
    char *path = dem_path_join(directory, "run.json");
    if (!path)
        return dem_fail_memory(error);
    dem_buffer out = {0};
    dem_json_writer writer = dem_json_begin(&out), *w = &writer;
    dem_json_open_object(w, NULL);
    dem_json_put_string(w, "schema", "dem-run/1");
    dem_json_put_string(w, "program", "dem-clump " DEM_VERSION);
#ifdef __VERSION__
    dem_json_put_string(w, "compiler", __VERSION__);
#endif
    dem_json_put_string(w, "title", r->title);
    dem_json_put_whole(w, "last_step", (int64_t)r->figures.step);
    put_members(w, r);
    if (r->scene)
        put_scene(w, r->scene);
    dem_json_close(w, '}');
    dem_status status = dem_file_write_buffer(path, &out, error);
    free(path);
    return status;
}

// ---- for people

// `digits` of a number, but never fewer than stand before the point
static void put_number(dem_buffer *out, double value, int digits)
{
    if (!isfinite(value))
        dem_buffer_text(out, isnan(value) ? "-" : value > 0 ? "any" : "-any");
    else if (fabs(value) >= pow(10, digits) && fabs(value) < 1e15)
        dem_buffer_print(out, "%lld", llround(value));
    else
        dem_buffer_number(out, value, digits);
}

// with a given number of places behind the point, in no locale
static const char *fixed(char text[32], double value, int places)
{
    double unit = pow(10, places);
    if (!(fabs(value) < 1e15 / unit)) {
        snprintf(text, 32, "-");
        return text;
    }
    long long whole = llround(fabs(value) * unit), one = (long long)unit;
    snprintf(text, 32, "%s%lld.%0*lld", value < 0 && whole ? "-" : "", whole / one, places, whole % one);
    return text;
}

static void put_row(dem_buffer *out, const char *label, double value)
{
    char text[64];
    if (isfinite(value))
        dem_format_double(text, sizeof text, value, FIGURES);
    else
        snprintf(text, sizeof text, "-");
    dem_buffer_print(out, "  %-*s%*s\n", NAME, label, VALUE, text);
}

static void put_head(dem_buffer *out, const dem_run_report *r)
{
    const dem_figures *f = &r->figures;
    dem_buffer_print(out, "%s%s%zu clump%s of %zu spheres, %llu steps to ", r->title ? r->title : "",
                     r->title && *r->title ? ": " : "", f->bodies, f->bodies == 1 ? "" : "s", f->spheres,
                     (unsigned long long)r->steps);
    put_number(out, f->time, FIGURES);
    dem_buffer_print(out, " s%s\n", r->ended && strcmp(r->ended, "done") != 0 ? ", stopped early" : "");
}

static void put_speed(dem_buffer *out, const dem_run_report *r)
{
    const dem_figures *f = &r->figures;
    double steps = (double)r->steps, bodies = (double)f->bodies;
    dem_buffer_text(out, "  speed      ");
    put_number(out, steps > 0 ? steps / r->loop_seconds : NAN, 4);
    dem_buffer_text(out, " steps/s, ");
    put_number(out, steps * bodies > 0 ? 1e6 * r->loop_seconds / (steps * bodies) : NAN, 3);
    dem_buffer_text(out, " us per clump and step; ");
    put_number(out, r->loop_seconds, 4);
    dem_buffer_print(out, " s with %d thread%s, setup ", r->threads, r->threads == 1 ? "" : "s");
    put_number(out, r->setup_seconds, 3);
    dem_buffer_text(out, " s\n  step       ");
    put_number(out, r->step, FIGURES);
    dem_buffer_text(out, " s, the critical one is ");
    put_number(out, r->critical_step, FIGURES);
    dem_buffer_print(out, " s\n  contacts   %zu between clumps, %zu with walls, coordination ", f->contacts,
                     f->wall_contacts);
    put_number(out, f->coordination, 3);
    dem_buffer_text(out, "\n  overlap    ");
    put_number(out, 100 * f->overlap_ratio, 3);
    dem_buffer_text(out, " % of the smaller radius, ");
    put_number(out, 100 * f->largest_overlap_ratio, 3);
    dem_buffer_text(out, " % at most in the run");
    if (f->largest_soft_overlap > 0) {
        dem_buffer_text(out, "; soft contacts: ");
        put_number(out, f->largest_soft_overlap, 3);
        dem_buffer_text(out, " tau at most");
    }
    dem_buffer_text(out, "\n  memory     ");
    put_number(out, r->bytes_per_clump, 4);
    dem_buffer_text(out, " bytes per clump\n");
}

static void put_flow(dem_buffer *out, const dem_run_report *r)
{
    const dem_figures *f = &r->figures;
    if (f->came || f->left || r->inlet_count) {
        dem_buffer_print(out, "  flow       %zu bodies came, ", f->came);
        put_number(out, f->came_mass, 4);
        dem_buffer_print(out, " kg; %zu left, ", f->left);
        put_number(out, f->left_mass, 4);
        dem_buffer_text(out, " kg\n");
    }
    for (size_t i = 0; i < r->inlet_count; i++) {
        const dem_inlet_view *inlet = &r->inlets[i];
        if (!(inlet->behind > 0))
            continue;
        dem_buffer_print(out, "  inlet      %s is ", inlet->name);
        put_number(out, inlet->behind, 4);
        dem_buffer_print(out, "%s behind its rate: there was no room\n", inlet->by_mass ? " kg" : " bodies");
    }
}

// what a scene does not have is 0 to the last bit and left out
static void put_ledger(dem_buffer *out, const dem_energy *energy)
{
    row rows[ENERGIES];
    bool kept = !isnan(energy->error);
    list_energies(energy, rows);
    dem_buffer_print(out, "\n  %-*s%*s\n", NAME, "energy", VALUE, "J");
    for (int i = 0; i < ENERGIES; i++) {
        bool needs_ledger = i < 2 || i > 5;
        if (kept ? rows[i].value != 0 : !needs_ledger)
            put_row(out, rows[i].label, rows[i].value);
    }
    if (!kept)
        return;
    dem_buffer_print(out, "  %-*s", NAME, "not accounted for");
    char text[64];
    dem_format_double(text, sizeof text, 100 * energy->error, 3);
    dem_buffer_print(out, "%*s %% of what was turned over\n", VALUE, text);
}

static void put_pass(dem_buffer *out, const char *name, double seconds, double all)
{
    char s[32], part[32];
    dem_buffer_print(out, "  %-*s%*s%9s %%\n", NAME, name, VALUE, fixed(s, seconds, 3),
                     fixed(part, all > 0 ? 100 * seconds / all : 0, 1));
}

static void put_passes(dem_buffer *out, const dem_run_report *r)
{
    double sum = 0;
    for (size_t i = 0; i < r->pass_count; i++)
        sum += r->passes[i].seconds;
    double all = fmax(sum, r->loop_seconds);
    dem_buffer_print(out, "\n  %-*s%*s\n", NAME, "pass", VALUE, "seconds");
    for (size_t i = 0; i < r->pass_count; i++)
        put_pass(out, r->passes[i].name, r->passes[i].seconds, all);
    if (all - sum > NOTEWORTHY * all)
        put_pass(out, "other", all - sum, all);
}

void dem_run_report_text(dem_buffer *out, const dem_run_report *r)
{
    put_head(out, r);
    put_speed(out, r);
    put_flow(out, r);
    put_ledger(out, &r->figures.energy);
    if (r->pass_count)
        put_passes(out, r);
    for (size_t i = 0; i < r->warning_count; i++)
        dem_buffer_print(out, "%swarning: %s\n", i ? "" : "\n", r->warnings[i]);
}
