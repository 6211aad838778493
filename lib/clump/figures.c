#include "clump/figures.h"

const dem_figure dem_fidelity_figures[DEM_FIDELITY_FIGURES] = {
    {"iou_gap", "", offsetof(dem_fidelity, iou_gap)},
    {"volume_error", "", offsetof(dem_fidelity, volume_error)},
    {"distance_mean", "", offsetof(dem_fidelity, distance_mean)},
    {"distance_max", "", offsetof(dem_fidelity, distance_max)},
    {"protrusion", "", offsetof(dem_fidelity, protrusion)},
    {"centre_offset", "", offsetof(dem_fidelity, centre_offset)},
    {"inertia_error", "", offsetof(dem_fidelity, inertia_error)},
    {"normal_deviation_deg", "", offsetof(dem_fidelity, normal_deviation_deg)},
    {"overlap_ratio", "", offsetof(dem_fidelity, overlap_ratio)},
};

const dem_figure dem_shape_figures[DEM_SHAPE_FIGURES] = {
    {"equivalent_diameter", "m", offsetof(dem_shape, equivalent_diameter)},
    {"longest", "m", offsetof(dem_shape, longest)},
    {"intermediate", "m", offsetof(dem_shape, intermediate)},
    {"shortest", "m", offsetof(dem_shape, shortest)},
    {"elongation", "", offsetof(dem_shape, elongation)},
    {"flatness", "", offsetof(dem_shape, flatness)},
    {"sphericity", "", offsetof(dem_shape, sphericity)},
    {"convexity", "", offsetof(dem_shape, convexity)},
    {"roundness", "", offsetof(dem_shape, roundness)},
    {"angularity", "", offsetof(dem_shape, angularity)},
};

_Static_assert(DEM_FIDELITY_FIGURES * sizeof(double) + sizeof(size_t) == sizeof(dem_fidelity) &&
                   DEM_SHAPE_FIGURES * sizeof(double) == sizeof(dem_shape),
               "every figure is listed");
