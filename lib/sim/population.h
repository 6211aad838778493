/// Bodies that come and go: inlets, and what leaves the domain.
///
/// A world that has this keeps some rows without a body (see body_absent), far away like those that fill up. A body that
/// comes takes the first free one; where there is none, all that goes by rows grows (grow.c). A body that goes leaves
/// its row to lists that may name it until the next search. So nothing is renamed while a world runs, and a world
/// without inlets whose leaving bodies are not deleted has none of this.
///
/// Every body that comes makes a search due; bodies that have left are looked for after each search, so they go when
/// they are out by no more than half of the skin.
#ifndef DEM_SIM_POPULATION_H
#define DEM_SIM_POPULATION_H

#include "sim/fill_draw.h"
#include "sim/place.h"
#include "sim/state.h"

typedef struct dem_inlet {
    dem_inlet_def def;  ///< without its mix
    char *name;
    dem_fill_drawer *drawer;
    dem_fill_draw next;      ///< the body that is to come
    double radius, largest;  ///< bounding radius of a usual body, of the largest one [m]
    uint32_t hold;           ///< of its bodies when they are free
    // state
    uint64_t made;    ///< bodies
    double mass;      ///< of these [kg]
    uint64_t again;   ///< step from which a place is looked for again
    uint64_t looks;   ///< for a place of the next body, so far
    uint32_t inside;  ///< row of the body in the generator sphere; DEM_ROW_FREE: none
} dem_inlet;

struct dem_population {
    dem_inlet *inlets;
    size_t inlet_count;
    dem_inlet_view *views;
    dem_placing placing;
    bool flat;    ///< two dimensions
    bool search;  ///< is due, as bodies have come or are free now
    bool told;    ///< that bodies have left
    // state
    uint64_t next_id;
    uint64_t came, left;
    double came_mass, left_mass;  ///< [kg]
    double brought;               ///< energy, less what was taken away [J]
};

/// Makes dem_world.population where the scene needs it; needs templates and walls, but no bodies. Errors: DEM_BAD_INPUT
/// for an inlet that cannot be.
dem_status dem_population_create(dem_world *world, const dem_scene *scene, dem_error *error);
void dem_population_release(dem_population *population);

/// How many rows to begin with for so many bodies.
size_t dem_population_rows(const dem_world *world, size_t bodies);
/// Whether there may be so many bodies at once some day.
bool dem_population_reaches(const dem_world *world, size_t bodies);
/// Bounding radius of a usual body to come, and of the largest [m].
double dem_population_radius(const dem_population *population);
double dem_population_largest(const dem_population *population);

/// The radii of the smallest and the largest sphere of bodies to come [m]; what is less or more already stays.
void dem_population_spheres(const dem_world *world, double *least, double *most);

/// After a step: bodies come, and those that are out of their generator sphere become free.
dem_status dem_population_feed(dem_world *world, dem_error *error);
/// After a search: bodies outside of the domain go, if they are to be deleted.
dem_status dem_population_leave(dem_world *world, dem_error *error);

/// Puts a new body into a free row. Its energy is not counted yet.
dem_status dem_population_add(dem_world *world, const dem_body_def *def, uint32_t *row, dem_error *error);
/// Counts a change of the energy that bodies have brought: the body's own, as it is without contacts.
void dem_population_count_energy(dem_world *world, uint32_t row, double sign);

/// For each inlet what it is asked for by now: bodies or [kg].
double dem_inlet_asked(const dem_inlet *inlet, double time);
bool dem_inlet_over(const dem_world *world, const dem_inlet *inlet);
/// What it has given of that, and what the body that is to come adds.
double dem_inlet_given(const dem_inlet *inlet);
double dem_inlet_amount(const dem_world *world, const dem_inlet *inlet);
/// Lets the bodies of one inlet come and go free.
dem_status dem_inlet_feed(dem_world *world, dem_inlet *inlet, dem_error *error);

/// Makes every array that goes by rows larger. The lists are to be rebuilt before the next step.
dem_status dem_world_grow(dem_world *world, size_t rows, dem_error *error);

#endif
