/// Reading a scene's JSON: every value knows its place, every object is read by a table of its keys.
#ifndef DEM_SIM_SCENE_READER_H
#define DEM_SIM_SCENE_READER_H

#include "base/json_text.h"
#include "base/units.h"
#include "sim/scene.h"

/// A "path.to.key=value" that was laid over the file.
typedef struct dem_scene_override {
    const char *path;             ///< as it was written
    const dem_json_place *place;  ///< in the arena
} dem_scene_override;

typedef struct dem_scene_reader {
    const dem_ctx *ctx;
    const char *name;    ///< of the file, for messages
    const char *folder;  ///< that paths are relative to; NULL: no files
    const char *text;
    size_t size;
    dem_scene_override *overrides;
    size_t override_count;
    dem_scene *scene;
    struct dem_scene_owner *owner;
    dem_error *error;
} dem_scene_reader;

typedef struct dem_scene_value {
    dem_json_place place;  ///< `in` points to the value around this one, which must live as long
    const dem_json *json;
} dem_scene_value;

dem_scene_value dem_scene_member(const dem_scene_value *object, const char *key);
dem_scene_value dem_scene_item(const dem_scene_value *array, size_t index);

/// DEM_BAD_INPUT at a value: "PATH: what (column N); advice". With an override at or around the place, it is named
/// instead of the file.
dem_status dem_scene_refuse(const dem_scene_reader *r, const dem_scene_value *v, const char *advice, const char *format,
                            ...) DEM_PRINTF(4, 5);
/// The same for an error of another reader that knows no place.
dem_status dem_scene_pass_on(const dem_scene_reader *r, const dem_scene_value *v, const dem_error *inner);
/// The same for a name that is not among those known; `what` is "key", "material", ...
dem_status dem_scene_unknown(const dem_scene_reader *r, const dem_scene_value *v, dem_json_part part, const char *what,
                             const char *name, const char *(*next)(const void *user, size_t index), const void *user);

/// Allowed numbers; all zero: any.
typedef struct dem_range {
    double low, high;
    bool above, below;  ///< low or high itself is not allowed
} dem_range;
#define DEM_RANGE_POSITIVE                                                                                             \
    {                                                                                                                  \
        .high = INFINITY, .above = true                                                                                \
    }
#define DEM_RANGE_FROM_0                                                                                               \
    {                                                                                                                  \
        .high = INFINITY                                                                                               \
    }

/// One name of a choice; a list ends with a NULL.
typedef struct dem_choice {
    const char *name;
    int value;  ///< DEM_NOT_BUILT: known, refused
} dem_choice;
enum { DEM_NOT_BUILT = -1 };

struct dem_field;
typedef dem_status dem_field_reader(dem_scene_reader *r, const dem_scene_value *v, const struct dem_field *field,
                                    void *into);

/// The keys of an object, in the order they are read in.
typedef struct dem_fields {
    const struct dem_field *items;
    size_t count;
} dem_fields;
#define DEM_FIELDS(table)                                                                                              \
    {                                                                                                                  \
        table, sizeof table / sizeof *table                                                                            \
    }

/// One key of an object: how its value is read, and the offset of where to in what the object fills in.
typedef struct dem_field {
    const char *name;
    dem_field_reader *read;
    size_t at;
    bool needed;
    dem_dimension dimension;
    dem_range range;
    const dem_choice *choices;
    const dem_fields *fields;  ///< of the object that stands here, or of each one in the list or map that does
} dem_field;

#define DEM_UNBUILT(key)                                                                                               \
    {                                                                                                                  \
        .name = key, .read = dem_field_not_built                                                                       \
    }

/// Reads an object. `given` (may be NULL) gets a bit for each field that was there, in the order of the table.
dem_status dem_fields_read(dem_scene_reader *r, const dem_scene_value *v, const dem_fields *fields, void *into,
                           uint64_t *given);
static inline bool dem_given(uint64_t given, int field)
{
    return given >> field & 1;
}

dem_field_reader dem_field_object;     ///< by `fields`, into what stands at the offset
dem_field_reader dem_field_quantity;   ///< double
dem_field_reader dem_field_vector;     ///< dem_vec3
dem_field_reader dem_field_direction;  ///< dem_vec3, made a unit vector
dem_field_reader dem_field_flag;       ///< bool
dem_field_reader dem_field_whole;      ///< uint64_t, of the range
dem_field_reader dem_field_text;       ///< const char *
dem_field_reader dem_field_choice;     ///< an enum
dem_field_reader dem_field_material;   ///< uint32_t, by name
dem_field_reader dem_field_shape;      ///< uint32_t, by name
dem_field_reader dem_field_path;       ///< const char *, made absolute; refused where it cannot be read
dem_field_reader dem_field_not_built;  ///< refused unless null
dem_field_reader dem_field_nothing;    ///< refused unless {}, [] or null

/// One number, bare or with a unit.
dem_status dem_read_quantity(dem_scene_reader *r, const dem_scene_value *v, dem_dimension dimension, dem_range range,
                             double *value);
/// An array of `count` values.
dem_status dem_read_array(dem_scene_reader *r, const dem_scene_value *v, size_t count, const char *what);

/// `count` items of `size` bytes that live as long as the scene; NULL: no memory, to be told by dem_fail_memory.
void *dem_scene_take(dem_scene_reader *r, size_t count, size_t size);
/// A path relative to the scene's folder, absolute and kept with the scene; NULL: no memory.
const char *dem_scene_path(dem_scene_reader *r, const char *path);

/// Applies "path.to.key=value" texts to the parsed scene and notes where. Errors: DEM_USAGE.
dem_status dem_scene_override_all(dem_scene_reader *r, const char *const *overrides);

/// The sections.
extern const dem_fields dem_scene_fields;  ///< of the outermost object, into the reader's scene
dem_field_reader dem_section_materials, dem_section_contacts, dem_section_shapes, dem_section_bodies, dem_section_walls,
    dem_section_fill, dem_section_inlets, dem_section_measures, dem_section_bonds;
/// Parts of a fill, into a dem_fill_def: its mix, its box; and what shares are told by, into a bool.
dem_field_reader dem_field_mix, dem_field_corners, dem_field_share_by;
extern const dem_fields dem_mix_fields;
extern const dem_choice dem_shares_by[];
extern const dem_fields dem_inlet_fields, dem_material_fields, dem_contact_fields, dem_shape_fields, dem_body_fields, dem_wall_fields,
    dem_fill_fields, dem_measure_fields, dem_bond_fields;
/// Whether the regions can be measured, which the domain tells.
dem_status dem_scene_check_measures(dem_scene_reader *r, const dem_scene_value *root);
/// What can only be told of the whole scene: laws for all that can meet, safety.
dem_status dem_scene_finish(dem_scene_reader *r, const dem_scene_value *root);

#endif
