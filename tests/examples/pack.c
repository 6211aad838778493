// A clump of 50 spheres from a mesh: pack grain.obj grain.json
#include <dem/dem.h>
#include <stdio.h>

int main(int argc, char **argv)
{
    if (argc != 3) {
        fprintf(stderr, "usage: pack MESH CLUMP.json\n");
        return DEM_USAGE;
    }
    dem_error error;
    dem_mesh mesh = {0};
    dem_mesh_report report;
    dem_clump *clump = NULL;
    dem_make_options options = dem_make_defaults();
    options.pack.spheres = 50;
    options.name = "grain";
    if (dem_mesh_import(NULL, argv[1], &mesh, &error) != DEM_OK ||
        dem_mesh_repair(NULL, &mesh, &(dem_repair_options){.repair = DEM_REPAIR_AUTO}, &report, &error) != DEM_OK ||
        dem_clump_make(NULL, &mesh, &options, &clump, NULL, &error) != DEM_OK ||
        dem_clump_write(clump, argv[2], &error) != DEM_OK) {
        fprintf(stderr, "%s:%ld: %s\n", error.file, error.line, error.text);
        dem_mesh_free(&mesh);
        return error.code;
    }
    dem_clump_def c = dem_clump_view(clump);
    printf("%zu spheres, %.4g kg, IoU gap %.2f %%\n", c.ball_count, c.mass, 100 * c.fidelity.iou_gap);
    for (size_t i = 0; i < c.ball_count; i++)
        printf("%g %g %g %g\n", c.balls[i].centre.x, c.balls[i].centre.y, c.balls[i].centre.z, c.balls[i].radius);
    dem_clump_destroy(clump);
    dem_mesh_free(&mesh);
    return 0;
}
