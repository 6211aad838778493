/// One piece: which balls have to come closer, and the springs that pull them.
#ifndef DEM_CLUMP_PACK_CONNECT_H
#define DEM_CLUMP_PACK_CONNECT_H

#include "clump/packing.h"

/// Two balls of different pieces; `gap` is how much their overlap lacks [d_eq].
typedef struct dem_link {
    uint32_t i, j;
    double gap;
} dem_link;

/// The links of the minimum spanning tree whose balls overlap by less than `overlap`: one less than there are pieces
/// with that overlap. They are put into p->links; returns their number.
size_t dem_pack_links(dem_packing *p, const dem_ball *balls, size_t count, double overlap);
/// Energy of the springs on those links; adds them to the normal equations unless NULL. 0 while p->spring is off.
double dem_pack_springs(dem_packing *p, const dem_pack_state *state, double (*equations)[DEM_EQUATION]);
/// Relaxes with springs, then dem_pack_close.
dem_status dem_pack_join(dem_packing *p, dem_pack_state *state, dem_error *error);
/// Moves the balls on open links together, and grows them by the share `growth` of the gaps, until there is one piece.
/// False: there was nothing to do.
bool dem_pack_close(dem_packing *p, dem_pack_state *state, double growth);

#endif
