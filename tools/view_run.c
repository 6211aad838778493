// Runs: their frames, colours and what is left out.
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "math/vec.h"
#include "out/field.h"
#include "view.h"

static dem_picture_options choose_options(const view_choices *c, const dem_results *r)
{
    const view_arguments *a = c->arguments;
    dem_picture_options o = dem_picture_defaults();
    o.map = (dem_picture_map)a->map;
    o.spheres = a->spheres;
    // up is against gravity, where there is any
    o.up = c->up_given || !(v3_norm2(r->scene.gravity) > 0) ? c->up : v3_scale(v3_unit(r->scene.gravity), -1);
    o.azimuth_deg = isnan(a->azimuth) ? o.azimuth_deg : a->azimuth;
    o.elevation_deg = isnan(a->elevation) ? o.elevation_deg : a->elevation;
    o.parallel = a->orthographic;
    o.zoom = a->zoom;
    o.look_at = c->look_at;
    o.samples = (int)a->samples;
    memcpy(o.background, c->background, sizeof o.background);
    o.labels = !a->no_labels;
    o.label_size = a->label_size;
    o.domain = r->scene.domain;
    if (!a->no_walls) {
        o.walls = r->scene.walls;
        o.wall_count = r->scene.wall_count;
    }
    return o;
}

dem_status view_run_open(const dem_ctx *ctx, const view_choices *c, const char *directory, view_run *run,
                         dem_error *error)
{
    *run = (view_run){.choices = c};
    DEM_TRY(dem_results_open(ctx, directory, &run->results, error));
    size_t shapes = run->results.scene.shape_count;
    run->names = dem_alloc(shapes, sizeof *run->names);
    if (!run->names)
        return dem_fail_memory(error);
    for (size_t i = 0; i < shapes; i++)
        run->names[i] = run->results.scene.shapes[i].name;
    run->options = choose_options(c, &run->results);
    run->options.shape_names = run->names;
    return DEM_OK;
}

dem_status view_run_frame(const view_run *run, long *frame, dem_error *error)
{
    const view_arguments *a = run->choices->arguments;
    size_t index = 0, count = run->results.index.count;
    *frame = VIEW_LAST;
    if (!isnan(a->time)) {
        DEM_TRY(dem_results_at(&run->results, a->time, &index, error));
        *frame = (long)index;
    } else if (a->frame) {
        const char *end = a->frame + strlen(a->frame), *rest = NULL;
        if (strcmp(a->frame, "last") == 0)
            *frame = (long)count - 1, rest = end;
        else
            rest = dem_parse_long(a->frame, end, frame);
        if (!rest || *rest || *frame < 0 || (size_t)*frame >= count)
            return dem_fail(error, DEM_USAGE, "there is no frame '%.40s'; the run has %zu, counted from 0", a->frame,
                            count);
    }
    return DEM_OK;
}

static dem_field_source source_of(const view_run *run)
{
    const dem_results *r = &run->results;
    return (dem_field_source){.bodies = &r->bodies,
                              .diameters = r->diameters,
                              .up = v3_unit(run->options.up),
                              .frame = r->frame.arena.chunks ? &r->frame.vtp : NULL};
}

// walls by how deep they are worn
static dem_status choose_wear(view_run *run, dem_error *error)
{
    dem_results *r = &run->results;
    bool worn = false;
    DEM_TRY(dem_results_wear(r, error));
    for (size_t i = 0; i < run->options.wall_count; i++)
        worn |= r->walls[i].wear != NULL;
    if (!worn)
        return dem_fail(error, DEM_USAGE, "there is no wear to show; give a wall \"wear\" and the scene an interval of "
                                          "frames (output.frames), and leave --no-walls out");
    run->options.colour = DEM_PICTURE_WEAR;
    return view_range(run->choices->arguments->range, "m", &run->options.low, &run->options.high, error);
}

static dem_status choose_colours(view_run *run, dem_error *error)
{
    const view_arguments *a = run->choices->arguments;
    dem_picture_options *o = &run->options;
    dem_field_source source = source_of(run);
    const char *name = a->colour ? a->colour : "number";
    o->colour = strcmp(name, "shape") == 0 ? DEM_PICTURE_SHAPE : DEM_PICTURE_NUMBER;
    if (strcmp(name, "wear") == 0)
        return choose_wear(run, error);
    if (strcmp(name, "number") == 0 || o->colour == DEM_PICTURE_SHAPE)
        return a->range ? dem_fail(error, DEM_USAGE, "--range needs numbers to show; add --colour, as in speed")
                        : DEM_OK;
    DEM_TRY(dem_field_make(name, &source, &run->field, error));
    o->colour = DEM_PICTURE_VALUES;
    o->values = run->field.values;
    o->title = run->field.title;
    o->unit = run->field.unit;
    o->whole = run->field.whole;
    return view_range(a->range, run->field.unit, &o->low, &o->high, error);
}

// the contacts of the time of the bodies, coloured by their force
static dem_status choose_contacts(view_run *run, dem_error *error)
{
    const view_arguments *a = run->choices->arguments;
    dem_picture_options *o = &run->options;
    DEM_TRY(dem_links_read(run->results.directory, run->results.time, &run->links, error));
    run->field.unit = "N";
    snprintf(run->field.title, sizeof run->field.title, "force");
    o->time = run->links.time;
    o->colour = DEM_PICTURE_VALUES;
    o->values = run->links.force;
    o->title = run->field.title;
    o->unit = run->field.unit;
    o->hidden = NULL;
    run->shown = run->links.bodies.count;
    return view_range(a->range, run->field.unit, &o->low, &o->high, error);
}

static dem_status choose_bodies(view_run *run, dem_error *error)
{
    const view_arguments *a = run->choices->arguments;
    size_t count = run->results.bodies.count;
    dem_field_source source = source_of(run);
    run->shown = count;
    run->options.hidden = run->hidden = NULL;
    if (a->clips.count == 0 && !a->bodies)
        return DEM_OK;
    run->options.hidden = run->hidden = dem_alloc_zero(count, 1);
    if (!run->hidden)
        return dem_fail_memory(error);
    for (size_t i = 0; i < a->clips.count; i++)
        DEM_TRY(view_clip(a->clips.items[i], &source, run->hidden, error));
    if (a->bodies)
        DEM_TRY(view_subset(a->bodies, count, run->hidden, error));
    for (size_t i = 0; i < count; i++)
        run->shown -= run->hidden[i];
    return DEM_OK;
}

static void forget(view_run *run)
{
    free(run->field.values);
    free(run->hidden);
    run->field.values = NULL;
    run->hidden = NULL;
}

dem_status view_run_load(view_run *run, long frame, const char *file, dem_error *error)
{
    dem_results *r = &run->results;
    forget(run);
    if (file)
        DEM_TRY(dem_results_frame_file(r, file, error));
    else if (frame == VIEW_LAST)
        DEM_TRY(dem_results_last(r, error));
    else
        DEM_TRY(dem_results_frame(r, (size_t)frame, error));
    run->options.time = r->time;
    run->options.poses = run->options.walls ? r->walls : NULL;
    if (run->choices->arguments->contacts)
        return choose_contacts(run, error);
    DEM_TRY(choose_colours(run, error));
    return choose_bodies(run, error);
}

// what is drawn: the bodies, or their contacts
typedef struct subject {
    const dem_body_view *bodies;
    const dem_clump *const *shapes;
    size_t shape_count;
} subject;

static subject subject_of(const view_run *run)
{
    const dem_results *r = &run->results;
    if (run->choices->arguments->contacts)
        return (subject){&run->links.bodies, (const dem_clump *const *)run->links.shapes, DEM_LINK_SHAPES};
    return (subject){&r->bodies, (const dem_clump *const *)r->clumps, r->scene.shape_count};
}

dem_status view_run_measure(view_run *run, dem_picture_span *span, dem_error *error)
{
    subject s = subject_of(run);
    return dem_scene_picture_measure(s.bodies, s.shapes, s.shape_count, &run->options, span, error);
}

dem_status view_run_draw(const dem_ctx *ctx, view_run *run, const dem_picture_span *span, int width, int height,
                         dem_image *image, dem_error *error)
{
    subject s = subject_of(run);
    run->options.width = width;
    run->options.height = height;
    return dem_scene_picture_render(ctx, s.bodies, s.shapes, s.shape_count, &run->options, span, image, NULL, error);
}

void view_run_release(view_run *run)
{
    forget(run);
    dem_links_release(&run->links);
    free(run->names);
    dem_results_release(&run->results);
}
