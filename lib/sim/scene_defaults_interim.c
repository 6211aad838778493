#include "dem/scene.h"
#include <math.h>
dem_scene dem_scene_defaults(void)
{
    dem_scene s = {0};
    s.domain.low = (dem_vec3){-INFINITY, -INFINITY, -INFINITY};
    s.domain.high = (dem_vec3){INFINITY, INFINITY, INFINITY};
    s.time.end = NAN;
    s.time.safety = NAN;
    s.time.contact_steps = 10;
    s.output.energy = true;
    return s;
}
dem_pair_law dem_pair_law_defaults(void)
{
    return (dem_pair_law){
        .tangential_stiffness = NAN, .tangential_rate = NAN, .stiffness_ratio = 2. / 7, .rescale = true};
}
