/// The contacts of one instant as bodies of a picture: rods between the centres, as thick as the root of their force,
/// so that what is seen of a rod along its length goes with what it bears. All contacts of two clumps are one rod.
#ifndef DEM_OUT_LINKS_H
#define DEM_OUT_LINKS_H

#include "dem/world.h"

enum { DEM_LINK_SHAPES = 40 };  ///< rods of different slenderness

typedef struct dem_links {
    dem_body_view bodies;
    dem_clump *shapes[DEM_LINK_SHAPES];
    double *force;  ///< of each [N]
    double time;    ///< [s]
} dem_links;

/// The file of the network (contacts.pvd in `directory`) whose time is nearest to `time`; NAN: the last. Zero or
/// released before, to be released either way. Errors: DEM_BAD_INPUT where there is none, DEM_NO_MEMORY.
dem_status dem_links_read(const char *directory, double time, dem_links *links, dem_error *error);
void dem_links_release(dem_links *links);

#endif
