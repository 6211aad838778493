#include "check.h"

#include "clump/pack_grain.h"
#include "mesh/grain.h"

static dem_mesh bumpy(size_t triangles)
{
    dem_mesh mesh;
    dem_error error;
    dem_grain_options o = dem_grain_defaults();
    o.kind = "harmonics";
    o.triangles = triangles;
    check_ok(dem_grain_make(NULL, &o, &mesh, &error), error);
    return mesh;
}

static void a_large_mesh_has_a_stand_in_close_to_it(void **state)
{
    (void)state;
    dem_error error;
    for (int large = 0; large < 2; large++) {
        dem_mesh mesh = bumpy(large ? 300000 : 3000);
        dem_pack_grain grain;
        check_ok(dem_pack_grain_open(&mesh, &grain, &error), error);
        dem_pack_stand_in in = dem_pack_grain_stand_in(&grain);
        if (large) {
            check(in.triangles > 1000 && in.triangles < mesh.triangle_count);
            // cells have edges of about sqrt(4 pi / 1e5) = 0.011 d_eq; means lie inside by curvature only
            check_near(in.volume_change, 0, 2e-3);
            check(in.distance > 0 && in.distance < 0.011);
            // the moments stay the mesh's
            check_close(grain.moments.volume, 3.14159265358979323846 / 6, 1e-12);
        } else {
            check(in.triangles == 0 && in.distance == 0);
        }
        dem_pack_grain_close(&grain);
        dem_mesh_free(&mesh);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(a_large_mesh_has_a_stand_in_close_to_it)};
    return cmocka_run_group_tests_name("pack_grain", tests, NULL, NULL);
}
