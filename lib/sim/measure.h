/// Everything the views show, brought to the time of the positions by one evaluation of the contacts.
#ifndef DEM_SIM_MEASURE_H
#define DEM_SIM_MEASURE_H

#include "sim/contacts.h"

dem_status dem_views_create(dem_world *world, dem_error *error);
/// For the rows that there are now; what was measured is gone. False: no memory.
bool dem_views_grow(dem_world *world);
/// Tells the rows which body each of them is.
void dem_views_number(dem_world *world);
void dem_views_release(dem_views *views);

/// Receives one listed contact: its columns' place, and what it does. `form` -1: of a pair.
typedef void (*dem_contact_visit)(void *user, dem_world *world, int form, const dem_contact_item *item,
                                  const dem_contact_record *record);

/// Evaluates all listed contacts of pairs and walls in the order of the lists, changing nothing.
dem_status dem_visit_contacts(dem_world *world, dem_contact_visit visit, void *user, dem_error *error);

/// Elastic energy of the contact of two spheres as it is listed now [J].
double dem_contact_elastic(dem_world *world, uint32_t a, uint32_t b, uint32_t sphere_a, uint32_t sphere_b);

/// Energy dissipated and done by the time of the last measuring: the tallies, and what they will get for the time
/// since.
dem_energy dem_ledger(const dem_world *world);

/// The energy of the i-th body as it moves without contacts, with what damping takes of it up to now [J]. What was
/// measured of the body is gone.
double dem_measure_body(dem_world *world, size_t i);
/// All energy that there is, and all that was dissipated, less what was done from outside [J]. Measures.
dem_status dem_measure_total(dem_world *world, double *total, dem_error *error);

#endif
