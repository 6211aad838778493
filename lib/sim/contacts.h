/// The listed contacts of bodies: columns, cut into segments of bodies, rebuilt where the lists of their pairs change.
/// Springs stay with their pair of spheres.
///
/// Momenta of bodies beyond the domain of a segment's own are not written by the contact pass but gathered in slots and
/// added afterwards in fixed order, so any number of threads gives the same bits.
#ifndef DEM_SIM_CONTACTS_H
#define DEM_SIM_CONTACTS_H

#include "sim/state.h"

// clang-format off
#define DEM_USER_COLUMN(X, k) X(double, user[k], "-", dem_user_columns(f) > (k), "what the law of the user's remembers")
#define DEM_USER_WAS(X, k, unit, what)                                                                                 \
    X(double, user_was[k], unit, f->ledger && f->user, what " of the user's law, a step ago")

/// What contacts remember with some laws only; all of them numbers, carried along when lists are rebuilt.
#define DEM_CONTACT_EXTRAS(X)                                                                                          \
    X(double, roll[0], "rad", f->rolling, "angle of the rolling spring, x")                                            \
    X(double, roll[1], "rad", f->rolling, "angle of the rolling spring, y")                                            \
    X(double, roll[2], "rad", f->rolling, "angle of the rolling spring, z")                                            \
    X(double, bond, "-", f->bonded, "whether the surfaces are bonded, or were")                                        \
    X(double, drag[0], "N m", f->ledger && features_turning(*f), "moment not of springs in the last step, x")           \
    X(double, drag[1], "N m", f->ledger && features_turning(*f), "moment not of springs, y")                            \
    X(double, drag[2], "N m", f->ledger && features_turning(*f), "moment not of springs, z")                            \
    DEM_USER_COLUMN(X, 0) DEM_USER_COLUMN(X, 1) DEM_USER_COLUMN(X, 2) DEM_USER_COLUMN(X, 3)                            \
    DEM_USER_COLUMN(X, 4) DEM_USER_COLUMN(X, 5) DEM_USER_COLUMN(X, 6) DEM_USER_COLUMN(X, 7)                            \
    DEM_USER_COLUMN(X, 8) DEM_USER_COLUMN(X, 9) DEM_USER_COLUMN(X, 10) DEM_USER_COLUMN(X, 11)                          \
    DEM_USER_COLUMN(X, 12) DEM_USER_COLUMN(X, 13) DEM_USER_COLUMN(X, 14) DEM_USER_COLUMN(X, 15)                        \
    DEM_USER_COLUMN(X, 16) DEM_USER_COLUMN(X, 17) DEM_USER_COLUMN(X, 18) DEM_USER_COLUMN(X, 19)                        \
    DEM_USER_WAS(X, 0, "N", "force, x") DEM_USER_WAS(X, 1, "N", "force, y") DEM_USER_WAS(X, 2, "N", "force, z")        \
    DEM_USER_WAS(X, 3, "N m", "moment, x") DEM_USER_WAS(X, 4, "N m", "moment, y") DEM_USER_WAS(X, 5, "N m", "moment, z")\
    DEM_USER_WAS(X, 6, "J", "energy")
// clang-format on

/// Columns of contacts: type, member of dem_contact_columns, unit, needed when (f: features; walls: of walls; mesh: of
/// mesh walls), kept when a list is rebuilt, what it is.
#define DEM_CONTACT_COLUMNS(X)                                                                                         \
    X(uint32_t, a, "-", true, "row of the first body")                                                                 \
    X(uint32_t, b, "-", !walls, "row of the second body")                                                              \
    X(uint32_t, sphere_a, "-", true, "its sphere")                                                                     \
    X(uint32_t, sphere_b, "-", true, "sphere of the second body, or the wall")                                         \
    X(uint32_t, target, "-", !walls, "where the momentum of the second body goes")                                     \
    X(uint32_t, shift, "-", f->periodic && !walls, "image of the second body")                                         \
    X(uint32_t, law, "-", f->mixed, "row of the law")                                                                  \
    X(double, spring[0], "m", f->friction, "tangential spring, x")                                                     \
    X(double, spring[1], "m", f->friction, "tangential spring, y")                                                     \
    X(double, spring[2], "m", f->friction, "tangential spring, z")                                                     \
    X(double, dash[0], "N", f->ledger && f->slide_damping, "tangential dashpot of the last step, x")                   \
    X(double, dash[1], "N", f->ledger && f->slide_damping, "tangential dashpot, y")                                    \
    X(double, dash[2], "N", f->ledger && f->slide_damping, "tangential dashpot, z")                                    \
    X(double, twist, "rad", f->twisting || (f->soft && f->friction), "angle of the twisting spring")                   \
    X(double, patch, "N m/rad", f->soft && f->friction, "stiffness of the twisting spring in the last step")           \
    X(double, attached, "-", f->jkr || f->soft, "whether it remembers: surfaces hold on, the patch touches")           \
    DEM_CONTACT_EXTRAS(X)                                                                                              \
    X(double, loss, "N", f->ledger && (f->rate || f->restitution), "damped force of the last step")                    \
    X(double, reaction[0], "N", f->reaction && walls, "force of the wall, x")                                          \
    X(double, reaction[1], "N", f->reaction && walls, "force of the wall, y")                                          \
    X(double, reaction[2], "N", f->reaction && walls, "force of the wall, z")                                          \
    X(double, hardness, "N/m", f->reaction && walls, "stiffness and dashpot over the step")                            \
    X(double, weight, "-", f->weighted || f->soft, "share of the force that counts, or of the soft maximum")           \
    X(double, geometry[0], "-", mesh, "normal, x")                                                                     \
    X(double, geometry[1], "-", mesh, "normal, y")                                                                     \
    X(double, geometry[2], "-", mesh, "normal, z")                                                                     \
    X(double, geometry[3], "m", mesh, "overlap")                                                                       \
    X(double, geometry[4], "m", mesh, "contact point from the body's centre, x")                                       \
    X(double, geometry[5], "m", mesh, "contact point, y")                                                              \
    X(double, geometry[6], "m", mesh, "contact point, z")

/// How many of the columns `user` there are.
static inline int dem_user_columns(const dem_features *f)
{
    return 3 * f->user_vectors + f->user_numbers;
}

/// Empty columns and segments for a world's pairs (form -1) or walls of one form.
dem_status dem_contacts_create(dem_world *world, dem_contacts *contacts, int form, dem_error *error);
void dem_contacts_release(dem_contacts *contacts, size_t segments);

/// Makes room for `needed[segment]` contacts in every dirty segment.
bool dem_contacts_reserve(dem_world *world, dem_contacts *contacts, int form, const size_t *needed);

/// Patches the lists of pairs by the fresh candidates, or rebuilds those that are dirty or have no room, and forgets the
/// candidates.
dem_status dem_contacts_rebuild(dem_world *world, dem_error *error);

/// Marks the lists dirty whose spare places have not been needed for long.
void dem_contacts_tighten(dem_world *world);

/// Adds the slots of all segments that belong to the bodies [begin, end), and empties them.
void dem_contacts_add_slots(dem_world *world, size_t begin, size_t end);

/// Sets the weights of the segments' contacts, of pairs and walls, where several of one pair share its force: `mean`
/// one over their number; `merge` by overlap among those that nearly coincide (PHYSICS 1.13).
void dem_weigh_contacts(dem_world *world, size_t begin, size_t end);

/// Memory of a contact [B].
size_t dem_contact_bytes(const dem_features *features, int form);

/// Places of a list of so many, whole blocks.
static inline size_t contacts_padded(size_t count)
{
    return (count + DEM_BLOCK_LANES - 1) / DEM_BLOCK_LANES * DEM_BLOCK_LANES;
}

/// What a contact remembers, beside the extras.
typedef struct dem_contact_history {
    double spring[3], dash[3], twist, patch, attached, loss;
} dem_contact_history;

dem_contact_history dem_history_get(const dem_contact_columns *columns, size_t place);
void dem_history_put(const dem_contact_columns *columns, size_t place, const dem_contact_history *history);

/// One contact with its history, to be carried from an old list to a new one.
typedef struct dem_contact_item {
    uint32_t a, b, sphere_a, sphere_b, shift, law;
    uint32_t old;  ///< 1 + its place in the old list, from the begin of its segment; 0: it is new
    dem_contact_history history;
} dem_contact_item;

#define DEM_CONTACT_EXTRA_COUNT(...) +1
enum { DEM_EXTRAS_MOST = 0 DEM_CONTACT_EXTRAS(DEM_CONTACT_EXTRA_COUNT) };

/// The extra columns that there are.
typedef struct dem_contact_extras {
    double *column[DEM_EXTRAS_MOST];
    int count;
} dem_contact_extras;

dem_contact_extras dem_extras_of(const dem_contact_columns *columns);

/// Carries the extras of a segment from its old list to a new one: kept before items are put to their places, given
/// afterwards. `full`: with the idle contacts that fill up.
typedef struct dem_extras_kept {
    double *numbers;
    size_t capacity;
} dem_extras_kept;

bool dem_extras_keep(const dem_contact_extras *extras, const dem_segment *segment, const dem_contact_item *items,
                     size_t count, dem_extras_kept *kept);
void dem_extras_give(const dem_contact_extras *extras, const dem_segment *segment, size_t count, size_t full,
                     const dem_extras_kept *kept);

dem_contact_item dem_contact_get(const dem_contact_columns *columns, size_t place);
/// `target` is set to b.
void dem_contact_put(const dem_contact_columns *columns, size_t place, const dem_contact_item *item);
/// A contact that never touches, of pairs (form -1) or walls.
dem_contact_item dem_contact_idle(const dem_world *world, int form);

#endif
