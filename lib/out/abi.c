/// What the structures of the public headers look like in memory, for bindings of other languages.
#include "dem/export.h"
#include "dem/picture.h"
#include "dem/world.h"

// clang-format off
// what a field is; a pointer is a pointer, whatever it points to. An enum is a u32.
#define KIND(type, field)                       \
    _Generic(&((type *)0)->field,               \
        bool *: "bool",                         \
        int *: "i32",                           \
        unsigned *: "u32",                      \
        unsigned (*)[2]: "u32",                 \
        long *: "i64",                          \
        unsigned long *: "u64",                 \
        unsigned long long *: "u64",            \
        double *: "f64",                        \
        double (*)[3]: "f64",                   \
        char (*)[512]: "char",                  \
        char (*)[1024]: "char",                 \
        dem_vec3 *: "dem_vec3",                 \
        dem_quat *: "dem_quat",                 \
        dem_sym3 *: "dem_sym3",                 \
        dem_solid *: "dem_solid",               \
        dem_mesh *: "dem_mesh",                 \
        dem_shape *: "dem_shape",               \
        dem_fidelity *: "dem_fidelity",         \
        dem_pack_options *: "dem_pack_options", \
        dem_pack_value (*)[DEM_PACK_VALUES]: "dem_pack_value", \
        dem_energy *: "dem_energy",             \
        default: "pointer")

#define WHOLE(type) {#type, "", "", 0, sizeof(type)}
#define FIELD(type, field) {#type, #field, KIND(type, field), offsetof(type, field), sizeof(((type *)0)->field)}

// a structure stands behind those it holds
static const dem_abi_row rows[] = {
    WHOLE(dem_vec3),
    FIELD(dem_vec3, x), FIELD(dem_vec3, y), FIELD(dem_vec3, z),
    WHOLE(dem_quat),
    FIELD(dem_quat, w), FIELD(dem_quat, x), FIELD(dem_quat, y), FIELD(dem_quat, z),
    WHOLE(dem_sym3),
    FIELD(dem_sym3, xx), FIELD(dem_sym3, yy), FIELD(dem_sym3, zz), FIELD(dem_sym3, xy), FIELD(dem_sym3, xz),
    FIELD(dem_sym3, yz),
    WHOLE(dem_ball),
    FIELD(dem_ball, centre), FIELD(dem_ball, radius),
    WHOLE(dem_moments),
    FIELD(dem_moments, volume), FIELD(dem_moments, first), FIELD(dem_moments, second),
    WHOLE(dem_solid),
    FIELD(dem_solid, volume), FIELD(dem_solid, area), FIELD(dem_solid, centre), FIELD(dem_solid, inertia),
    FIELD(dem_solid, principal), FIELD(dem_solid, axes),
    WHOLE(dem_error),
    FIELD(dem_error, code), FIELD(dem_error, line), FIELD(dem_error, file), FIELD(dem_error, text),
    WHOLE(dem_ctx),
    FIELD(dem_ctx, log), FIELD(dem_ctx, progress), FIELD(dem_ctx, user), FIELD(dem_ctx, subject),
    FIELD(dem_ctx, threads),
    WHOLE(dem_mesh),
    FIELD(dem_mesh, vertices), FIELD(dem_mesh, triangles), FIELD(dem_mesh, vertex_count),
    FIELD(dem_mesh, triangle_count), FIELD(dem_mesh, single_precision),
    WHOLE(dem_repair_options),
    FIELD(dem_repair_options, repair), FIELD(dem_repair_options, keep), FIELD(dem_repair_options, wrap_detail),
    WHOLE(dem_mesh_report),
    FIELD(dem_mesh_report, input_vertices), FIELD(dem_mesh_report, input_triangles), FIELD(dem_mesh_report, vertices),
    FIELD(dem_mesh_report, triangles), FIELD(dem_mesh_report, unreferenced_vertices),
    FIELD(dem_mesh_report, welded_vertices), FIELD(dem_mesh_report, weld_tolerance),
    FIELD(dem_mesh_report, degenerate_triangles), FIELD(dem_mesh_report, duplicate_triangles),
    FIELD(dem_mesh_report, nonmanifold_edges), FIELD(dem_mesh_report, dropped_triangles),
    FIELD(dem_mesh_report, reoriented_triangles), FIELD(dem_mesh_report, inside_out),
    FIELD(dem_mesh_report, boundary_edges), FIELD(dem_mesh_report, holes_filled), FIELD(dem_mesh_report, hole_edges),
    FIELD(dem_mesh_report, shells), FIELD(dem_mesh_report, bodies), FIELD(dem_mesh_report, cavities),
    FIELD(dem_mesh_report, ignored_shells), FIELD(dem_mesh_report, merged_shells),
    FIELD(dem_mesh_report, self_intersections), FIELD(dem_mesh_report, wrapped), FIELD(dem_mesh_report, volume_before),
    FIELD(dem_mesh_report, volume), FIELD(dem_mesh_report, volume_change), FIELD(dem_mesh_report, warnings),
    WHOLE(dem_shape),
    FIELD(dem_shape, equivalent_diameter), FIELD(dem_shape, longest), FIELD(dem_shape, intermediate),
    FIELD(dem_shape, shortest), FIELD(dem_shape, elongation), FIELD(dem_shape, flatness), FIELD(dem_shape, sphericity),
    FIELD(dem_shape, convexity), FIELD(dem_shape, roundness), FIELD(dem_shape, angularity),
    WHOLE(dem_fidelity),
    FIELD(dem_fidelity, iou_gap), FIELD(dem_fidelity, volume_error), FIELD(dem_fidelity, distance_mean),
    FIELD(dem_fidelity, distance_max), FIELD(dem_fidelity, protrusion), FIELD(dem_fidelity, centre_offset),
    FIELD(dem_fidelity, inertia_error), FIELD(dem_fidelity, normal_deviation_deg), FIELD(dem_fidelity, overlap_ratio),
    FIELD(dem_fidelity, pieces),
    WHOLE(dem_clump_def),
    FIELD(dem_clump_def, name), FIELD(dem_clump_def, source_mesh), FIELD(dem_clump_def, source_sha256),
    FIELD(dem_clump_def, source_unit), FIELD(dem_clump_def, density), FIELD(dem_clump_def, mass),
    FIELD(dem_clump_def, volume), FIELD(dem_clump_def, inertia), FIELD(dem_clump_def, mass_from),
    FIELD(dem_clump_def, position), FIELD(dem_clump_def, orientation), FIELD(dem_clump_def, union_volume),
    FIELD(dem_clump_def, union_centre), FIELD(dem_clump_def, union_inertia), FIELD(dem_clump_def, balls),
    FIELD(dem_clump_def, ball_count), FIELD(dem_clump_def, surface), FIELD(dem_clump_def, fidelity),
    FIELD(dem_clump_def, shape), FIELD(dem_clump_def, method), FIELD(dem_clump_def, parameters),
    FIELD(dem_clump_def, seed), FIELD(dem_clump_def, seconds), FIELD(dem_clump_def, version),
    WHOLE(dem_union),
    FIELD(dem_union, solid), FIELD(dem_union, pieces), FIELD(dem_union, redundant),
    WHOLE(dem_target),
    FIELD(dem_target, measure), FIELD(dem_target, bound),
    WHOLE(dem_pack_value),
    FIELD(dem_pack_value, name), FIELD(dem_pack_value, value),
    WHOLE(dem_pack_options),
    FIELD(dem_pack_options, method), FIELD(dem_pack_options, spheres), FIELD(dem_pack_options, gap),
    FIELD(dem_pack_options, targets), FIELD(dem_pack_options, target_count), FIELD(dem_pack_options, max_spheres),
    FIELD(dem_pack_options, effort), FIELD(dem_pack_options, moments),
    FIELD(dem_pack_options, side), FIELD(dem_pack_options, seed), FIELD(dem_pack_options, values),
    FIELD(dem_pack_options, value_count),
    WHOLE(dem_pack),
    FIELD(dem_pack, balls), FIELD(dem_pack, count), FIELD(dem_pack, reached), FIELD(dem_pack, interrupted),
    FIELD(dem_pack, moments),
    FIELD(dem_pack, moment_residual), FIELD(dem_pack, gap_estimate), FIELD(dem_pack, stand_in_triangles),
    FIELD(dem_pack, stand_in_volume), FIELD(dem_pack, stand_in_distance), FIELD(dem_pack, seconds),
    FIELD(dem_pack, used), FIELD(dem_pack, used_count),
    WHOLE(dem_make_options),
    FIELD(dem_make_options, pack), FIELD(dem_make_options, density), FIELD(dem_make_options, mass_from),
    FIELD(dem_make_options, name), FIELD(dem_make_options, source_mesh), FIELD(dem_make_options, source_sha256),
    FIELD(dem_make_options, source_unit), FIELD(dem_make_options, surface_triangles),
    WHOLE(dem_body_view),
    FIELD(dem_body_view, count), FIELD(dem_body_view, shape), FIELD(dem_body_view, scale), FIELD(dem_body_view, mass),
    FIELD(dem_body_view, position), FIELD(dem_body_view, orientation), FIELD(dem_body_view, velocity),
    FIELD(dem_body_view, spin), FIELD(dem_body_view, force), FIELD(dem_body_view, moment),
    FIELD(dem_body_view, coordination), FIELD(dem_body_view, id),
    WHOLE(dem_contact),
    FIELD(dem_contact, body), FIELD(dem_contact, other), FIELD(dem_contact, sphere), FIELD(dem_contact, other_sphere),
    FIELD(dem_contact, wall), FIELD(dem_contact, point), FIELD(dem_contact, normal), FIELD(dem_contact, overlap),
    FIELD(dem_contact, normal_force), FIELD(dem_contact, friction_force),
    WHOLE(dem_bond_view),
    FIELD(dem_bond_view, def), FIELD(dem_bond_view, body), FIELD(dem_bond_view, other), FIELD(dem_bond_view, id),
    FIELD(dem_bond_view, other_id), FIELD(dem_bond_view, sphere),
    FIELD(dem_bond_view, other_sphere), FIELD(dem_bond_view, state), FIELD(dem_bond_view, point),
    FIELD(dem_bond_view, axis), FIELD(dem_bond_view, force), FIELD(dem_bond_view, moment),
    FIELD(dem_bond_view, tensile_stress), FIELD(dem_bond_view, shear_stress), FIELD(dem_bond_view, stress_ratio),
    FIELD(dem_bond_view, radius), FIELD(dem_bond_view, broken), FIELD(dem_bond_view, broken_step),
    WHOLE(dem_wall_view),
    FIELD(dem_wall_view, position), FIELD(dem_wall_view, orientation), FIELD(dem_wall_view, force),
    FIELD(dem_wall_view, moment), FIELD(dem_wall_view, contacts), FIELD(dem_wall_view, pressure),
    FIELD(dem_wall_view, worn), FIELD(dem_wall_view, wear), FIELD(dem_wall_view, wear_count),
    WHOLE(dem_measure_view),
    FIELD(dem_measure_view, volume), FIELD(dem_measure_view, solid_volume), FIELD(dem_measure_view, void_ratio),
    FIELD(dem_measure_view, coordination), FIELD(dem_measure_view, stress), FIELD(dem_measure_view, mean_stress),
    FIELD(dem_measure_view, deviatoric_stress), FIELD(dem_measure_view, fabric), FIELD(dem_measure_view, bodies),
    FIELD(dem_measure_view, contacts),
    WHOLE(dem_energy),
    FIELD(dem_energy, kinetic), FIELD(dem_energy, rotational), FIELD(dem_energy, potential), FIELD(dem_energy, elastic),
    FIELD(dem_energy, friction), FIELD(dem_energy, viscous), FIELD(dem_energy, broken), FIELD(dem_energy, local),
    FIELD(dem_energy, drag), FIELD(dem_energy, work), FIELD(dem_energy, start), FIELD(dem_energy, error),
    FIELD(dem_energy, brought),
    WHOLE(dem_figures),
    FIELD(dem_figures, time), FIELD(dem_figures, step), FIELD(dem_figures, bodies), FIELD(dem_figures, spheres),
    FIELD(dem_figures, came), FIELD(dem_figures, left), FIELD(dem_figures, came_mass), FIELD(dem_figures, left_mass),
    FIELD(dem_figures, contacts), FIELD(dem_figures, wall_contacts), FIELD(dem_figures, coordination),
    FIELD(dem_figures, overlap_ratio), FIELD(dem_figures, largest_overlap_ratio),
    FIELD(dem_figures, largest_soft_overlap), FIELD(dem_figures, fastest),
    FIELD(dem_figures, centre), FIELD(dem_figures, highest), FIELD(dem_figures, bonds),
    FIELD(dem_figures, bonds_tension), FIELD(dem_figures, bonds_shear), FIELD(dem_figures, bonds_lost), FIELD(dem_figures, energy),
    WHOLE(dem_pass_time),
    FIELD(dem_pass_time, name), FIELD(dem_pass_time, seconds),
    // made and read by functions only
    WHOLE(dem_scene), WHOLE(dem_picture_options),
};
// clang-format on

const dem_abi_row *dem_abi(size_t *count)
{
    *count = sizeof rows / sizeof *rows;
    return rows;
}
