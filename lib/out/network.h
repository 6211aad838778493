/// The network of contacts, or of bonds, of a run as lines, for ParaView and for our own viewer:
///
///   contacts.pvd, bonds.pvd      all of them with their times; open this one
///   frames/contacts_NNNNNN.vtp   a line for each contact: between the centres of two bodies, or from a centre to the
///                                point on a wall; cell arrays tell the forces (the filter Tube wants them on points)
///   frames/bonds_NNNNNN.vtp      a line for each bond that was ever made, with its state and stress
///
/// Every file appears whole or not at all.
#ifndef DEM_OUT_NETWORK_H
#define DEM_OUT_NETWORK_H

#include "base/file_queue.h"
#include "dem/scene.h"
#include "dem/world.h"

typedef struct dem_network dem_network;

/// `name`: "contacts" or "bonds". Makes the folder and removes what is behind the time to resume from (NAN: a new run,
/// nothing of an earlier one stays). The queue (borrowed; NULL: none) writes behind the caller's back.
/// Errors: DEM_CANNOT_WRITE, DEM_NO_MEMORY; DEM_BAD_INPUT for an index to go on with that is none of ours.
dem_status dem_network_open(const char *directory, const char *name, const dem_domain_def *domain,
                            dem_file_queue *queue, double resume, dem_network **network, dem_error *error);

/// Writes the contacts of one instant. Errors: DEM_CANNOT_WRITE, DEM_NO_MEMORY.
dem_status dem_network_write(dem_network *network, double time, const dem_body_view *bodies,
                             const dem_contact *contacts, size_t count, dem_error *error);

/// Writes the bonds of one instant; the same errors.
dem_status dem_network_write_bonds(dem_network *network, double time, const dem_body_view *bodies,
                                   const dem_bond_view *bonds, size_t count, dem_error *error);

void dem_network_close(dem_network *network);

#endif
