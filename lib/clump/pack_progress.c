// Telling the caller how far a packing is, and asking whether to go on.
#include "base/status.h"
#include "clump/packing.h"

void dem_pack_stage(dem_packing *p, double until)
{
    p->stage_begin = p->done = fmax(p->done, p->stage_end);
    p->stage_end = until;
}

dem_status dem_pack_progress(dem_packing *p, double part, dem_error *error)
{
    p->done = fmax(p->done, p->stage_begin + part * (p->stage_end - p->stage_begin));
    return dem_pack_go_on(p, error);
}

dem_status dem_pack_go_on(const dem_packing *p, dem_error *error)
{
    if (dem_progress(p->ctx, "packing", fmin(p->done, 1)))
        return dem_fail(error, DEM_INTERRUPTED, "packing was interrupted");
    return DEM_OK;
}
