/// bench_fidelity MESH XYZR: the IoU gap in % of spheres given as lines "x y z r" in the frame of the mesh.
#include <stdio.h>
#include <stdlib.h>

#include "base/memory.h"
#include "dem/dem.h"

int main(int argc, char **argv)
{
    dem_mesh mesh = {0};
    dem_mesh_report report;
    dem_error error = {0};
    dem_repair_options repair = {0};
    dem_fidelity fidelity;
    dem_ball *balls = NULL;
    size_t count = 0, capacity = 0;
    FILE *file = argc == 3 ? fopen(argv[2], "r") : NULL;
    if (!file)
        return 2;
    double x, y, z, r;
    while (fscanf(file, "%lf %lf %lf %lf", &x, &y, &z, &r) == 4)
        if (dem_grow(&balls, &capacity, count, sizeof *balls))
            balls[count++] = (dem_ball){{x, y, z}, r};
    fclose(file);
    dem_status status = dem_mesh_import(NULL, argv[1], &mesh, &error);
    if (status == DEM_OK)
        status = dem_mesh_repair(NULL, &mesh, &repair, &report, &error);
    if (status == DEM_OK)
        status = dem_fidelity_measure(NULL, &mesh, balls, count, 0, &fidelity, &error);
    if (status == DEM_OK)
        printf("%.4f\n", 100 * fidelity.iou_gap);
    else
        fprintf(stderr, "%s\n", error.text);
    dem_mesh_free(&mesh);
    free(balls);
    return (int)status;
}
