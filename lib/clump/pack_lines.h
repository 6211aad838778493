/// The true symmetric difference of grain and union by integrals along lines on three axes, with its gradient.
#ifndef DEM_CLUMP_PACK_LINES_H
#define DEM_CLUMP_PACK_LINES_H

#include "base/crew.h"
#include "clump/pack_kernels.h"

enum { DEM_LINE_TASKS = 12 };

typedef struct dem_placed_ball {
    float along;
    uint32_t ball;
} dem_placed_ball;

/// The balls when lists were made, and by how much they may change before new ones are.
typedef struct dem_listing {
    dem_ball_columns then;       ///< of another number of balls: there are none
    float slack;
    int served;                  ///< evaluations by the lists there are
} dem_listing;

/// Its tasks point into it: not to be copied.
typedef struct dem_lines {
    dem_line_field fields[3];
    double grain_length[3];      ///< of the lines inside the grain
    dem_line_task tasks[DEM_LINE_TASKS];
    dem_arena arena;
    dem_placed_ball *order[3];   ///< [capacity] balls by their coordinates
    size_t order_count;
    dem_listing wide, close;     ///< of the tasks' lists
    bool make_wide, make_close;  ///< in the evaluation under way
    const dem_pack_kernels *kernels;
    size_t capacity;             ///< most balls
    double uncovered, protruding;  ///< weights of the two parts of the difference; 1 unless set otherwise
    dem_crew *crew;              ///< NULL: alone
} dem_lines;

typedef struct dem_line_volumes {
    double grain, covered, common;   ///< volumes as the lines see them
    double difference;               ///< symmetric difference, its parts weighted
    double gap;                      ///< 1 - intersection / union
} dem_line_volumes;

/// `step` between lines [d_eq]; `offsets` place the grids, in steps.
dem_status dem_lines_build(const dem_pack_grain *grain, const dem_pack_kernels *kernels, double step,
                           const double offsets[2], size_t capacity, dem_crew *crew, dem_lines *lines, dem_error *error);
void dem_lines_release(dem_lines *lines);

/// `gradient` of the symmetric difference to (x, y, z, r) of each ball; NULL: not wanted.
dem_status dem_lines_measure(dem_lines *lines, const dem_ball_columns *balls, double (*gradient)[4],
                             dem_line_volumes *volumes, dem_error *error);

#endif
