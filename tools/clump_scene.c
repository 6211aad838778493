#define _GNU_SOURCE
#include "clump_scene.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "base/json.h"
#include "base/memory.h"
#include "clump_report.h"

void clump_scene_add(clump_scene *scene, const job_result *result)
{
    if (!result->clump)
        return;
    dem_clump_def c = dem_clump_view(result->clump);
    const double numbers[] = {c.position.x,    c.position.y,    c.position.z,   c.orientation.w,
                              c.orientation.x, c.orientation.y, c.orientation.z};
    char *name = strdup(result->name);
    if (!name || !dem_grow(&scene->shapes, &scene->capacity, scene->count, sizeof *scene->shapes)) {
        free(name);
        scene->bodies.failed = true;
        return;
    }
    scene->shapes[scene->count++] = name;
    scene->density = c.density;
    report_csv_text(&scene->bodies, name);
    for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++) {
        dem_buffer_text(&scene->bodies, ",");
        dem_buffer_shortest(&scene->bodies, numbers[i]);
    }
    dem_buffer_text(&scene->bodies, "\n");
}

static void put_contact(dem_json_writer *json)
{
    dem_json_open_array(json, "contacts", true);
    dem_json_open_object(json, NULL);
    dem_json_open_array(json, "between", false);
    dem_json_put_string(json, NULL, "grain");
    dem_json_put_string(json, NULL, "grain");
    dem_json_close(json, ']');
    dem_json_open_object(json, "normal");
    dem_json_put_string(json, "law", "hertz");
    dem_json_put_number(json, "restitution", 0.5);
    dem_json_close(json, '}');
    dem_json_open_object(json, "friction");
    dem_json_put_string(json, "law", "mindlin");
    dem_json_put_number(json, "coefficient", 0.5);
    dem_json_close(json, '}');
    dem_json_close(json, '}');
    dem_json_close(json, ']');
}

// a start to edit: the shapes are what nobody wants to type
static void put_scene(const clump_scene *scene, const char *bodies, const char *name, dem_buffer *out)
{
    dem_json_writer json = dem_json_begin(out);
    dem_json_open_object(&json, NULL);
    dem_json_put_string(&json, "schema", "dem-scene/1");
    dem_json_put_string(&json, "title", name);
    dem_json_put_numbers(&json, "gravity", (double[]){0, 0, -9.81}, 3);
    dem_json_open_object(&json, "time");
    dem_json_put_string(&json, "end", "10 ms");
    dem_json_close(&json, '}');
    dem_json_open_object(&json, "materials");
    dem_json_open_object(&json, "grain");
    dem_json_put_number(&json, "density", scene->density);
    dem_json_put_string(&json, "young", "1 GPa");
    dem_json_put_number(&json, "poisson", 0.2);
    dem_json_close(&json, '}');
    dem_json_close(&json, '}');
    put_contact(&json);
    dem_json_open_object(&json, "shapes");
    for (size_t i = 0; i < scene->count; i++) {
        char clump[300];
        snprintf(clump, sizeof clump, "%s.json", scene->shapes[i]);
        dem_json_open_object(&json, scene->shapes[i]);
        dem_json_put_string(&json, "clump", clump);
        dem_json_put_string(&json, "material", "grain");
        dem_json_close(&json, '}');
    }
    dem_json_close(&json, '}');
    dem_json_open_array(&json, "bodies", false);
    dem_json_open_object(&json, NULL);
    dem_json_put_string(&json, "file", bodies);
    dem_json_close(&json, '}');
    dem_json_close(&json, ']');
    dem_json_close(&json, '}');
}

static dem_status write_both(clump_scene *scene, const char *folder, const char *name, dem_error *error)
{
    dem_buffer table = {0}, text = {0};
    char *bodies = dem_path_join(folder, "%s_bodies.csv", name), *path = dem_path_join(folder, "%s_scene.json", name);
    dem_status status = bodies && path ? DEM_OK : dem_fail_memory(error);
    if (status == DEM_OK) {
        dem_buffer_text(&table, "shape,x,y,z,qw,qx,qy,qz\n");
        dem_buffer_bytes(&table, scene->bodies.data, scene->bodies.size);
        table.failed |= scene->bodies.failed;
        status = dem_file_write_buffer(bodies, &table, error);
    }
    if (status == DEM_OK) {
        put_scene(scene, dem_file_name(bodies), name, &text);
        status = dem_file_write_buffer(path, &text, error);
    }
    free(bodies);
    free(path);
    return status;
}

dem_status clump_scene_finish(clump_scene *scene, const char *folder, const char *name, dem_error *error)
{
    dem_status status = scene->count ? write_both(scene, folder, name, error) : DEM_OK;
    for (size_t i = 0; i < scene->count; i++)
        free(scene->shapes[i]);
    free(scene->shapes);
    dem_buffer_release(&scene->bodies);
    *scene = (clump_scene){0};
    return status;
}
