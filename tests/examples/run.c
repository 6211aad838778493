// A scene stepped to its end, with the highest point and the energy on the way: run scene.json
#include <dem/dem.h>
#include <stdio.h>

static int say(const dem_error *error)
{
    fprintf(stderr, "%s:%ld: %s\n", error->file, error->line, error->text);
    return error->code;
}

int main(int argc, char **argv)
{
    if (argc != 2) {
        fprintf(stderr, "usage: run SCENE\n");
        return DEM_USAGE;
    }
    dem_error error;
    dem_scene scene;
    dem_world *world;
    if (dem_scene_read(NULL, argv[1], NULL, &scene, &error) != DEM_OK)
        return say(&error);
    double end = scene.time.end;
    dem_status status = dem_world_create(NULL, &scene, &world, &error);
    dem_scene_release(&scene);
    if (status != DEM_OK)
        return say(&error);
    while (status == DEM_OK && dem_world_time(world) < end) {
        status = dem_world_step(world, 500, &error);
        if (status == DEM_OK)
            status = dem_world_measure(world, &error);
        if (status == DEM_OK) {
            const dem_figures *f = dem_world_figures(world);
            printf("%8.4f s: highest %.4f m, kinetic %.3g J, %zu contacts\n", f->time, f->highest, f->energy.kinetic,
                   f->contacts + f->wall_contacts);
        }
    }
    dem_body_view bodies = dem_world_bodies(world);
    for (size_t i = 0; status == DEM_OK && i < bodies.count; i++)
        printf("body %zu rests at %.4f %.4f %.4f m\n", i, bodies.position[i].x, bodies.position[i].y,
               bodies.position[i].z);
    dem_world_destroy(world);
    return status == DEM_OK ? 0 : say(&error);
}
