/// One parameter of an entry of a registry (a kind of grain, a packing method): help, options, checks and lists are
/// made from it.
#ifndef DEM_BASE_PARAMETER_H
#define DEM_BASE_PARAMETER_H

typedef struct dem_parameter {
    const char *name;
    double standard;   ///< used when none is given; NAN: found by the entry itself, its registry says how
    double low, high;  ///< range, both ends allowed
    const char *unit;  ///< "-" pure number, "m" length, "count" whole number, "deg", "d_eq"
    const char *help;
} dem_parameter;

#endif
