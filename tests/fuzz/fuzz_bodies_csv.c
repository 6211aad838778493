// Bodies that are read are finite, of a shape that exists, turned by a unit quaternion.
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "sim/bodies_csv.h"

static void must(bool so)
{
    if (!so)
        abort();
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static const dem_shape_def shapes[] = {{.name = "rock"}, {.name = "a, \"b\""}};
    dem_body_def *bodies = NULL;
    size_t count = 0, capacity = 0;
    dem_error error = {0};
    dem_status status =
        dem_bodies_csv_parse((const char *)data, size, "fuzz.csv", shapes, 2, &bodies, &count, &capacity, &error);
    must(status == DEM_OK || (status == DEM_BAD_INPUT && strchr(error.text, ';')));
    for (size_t i = 0; i < count; i++) {
        const dem_body_def *b = &bodies[i];
        dem_quat q = b->orientation;
        must(b->shape < 2 && b->scale > 0 && isfinite(b->scale) && isfinite(b->position.x) && isfinite(b->spin.z));
        must(fabs(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z - 1) < 1e-13);
    }
    free(bodies);
    return 0;
}
