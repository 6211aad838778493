#include "shapes.h"

#include "base/random.h"

// lines of the log, one after the other
typedef struct lines {
    char text[4000];
    size_t warnings;
} lines;

static void take_line(void *user, dem_log_level level, const char *subject, const char *text)
{
    (void)subject;
    lines *l = user;
    size_t used = strlen(l->text);
    snprintf(l->text + used, sizeof l->text - used, "%s\n", text);
    l->warnings += level == DEM_LOG_WARNING;
}

typedef struct outcome {
    dem_status status;
    dem_mesh_report report;
    dem_error error;
    lines log;
} outcome;

static outcome repair_with(dem_mesh *mesh, dem_repair repair, dem_keep keep)
{
    outcome o = {0};
    dem_ctx ctx = {.log = take_line, .user = &o.log};
    o.status = dem_mesh_repair(&ctx, mesh, &(dem_repair_options){.repair = repair, .keep = keep}, &o.report, &o.error);
    if (o.status == DEM_OK)
        check(o.report.warnings == o.log.warnings);
    return o;
}

// every directed edge as often as its opposite
static void check_closed(const dem_mesh *mesh)
{
    // a sum over edges of hashes that cancel between the two directions
    uint64_t sum = 0;
    for (size_t i = 0; i < 3 * mesh->triangle_count; i++) {
        uint64_t a = mesh->triangles[i], b = mesh->triangles[i % 3 == 2 ? i - 2 : i + 1];
        check(a < mesh->vertex_count && a != b);
        uint64_t hash = random_mix(a < b ? a << 32 | b : b << 32 | a);
        sum += a < b ? hash : -hash;
    }
    check(sum == 0);
}

static outcome check_repaired(dem_mesh *mesh, double volume, double tolerance)
{
    outcome o = repair_with(mesh, DEM_REPAIR_AUTO, DEM_KEEP_ONE);
    check_ok(o.status, o.error);
    check_closed(mesh);
    check_close(o.report.volume, volume, tolerance);
    check_close(dem_mesh_solid(mesh).volume, volume, tolerance);
    return o;
}

static void check_refused(dem_mesh *mesh, dem_repair repair, const char *words)
{
    outcome o = repair_with(mesh, repair, DEM_KEEP_ONE);
    if (o.status != DEM_BAD_INPUT || !strstr(o.error.text, words)) {
        print_error("status %d: %s\n", o.status, o.error.text);
        fail();
    }
}

static double grain_volume(int n)
{
    dem_mesh grain = shape_grain(n);
    double volume = dem_mesh_solid(&grain).volume;
    dem_mesh_free(&grain);
    return volume;
}

static void a_clean_grain_passes_in_silence_at_any_scale_and_place(void **state)
{
    (void)state;
    double volume = grain_volume(6);
    for (int k = -2; k <= 2; k++) {
        double s = pow(10, 2 * k);
        dem_mesh grain = shape_grain(6);
        shape_move(&grain, (dem_quat){1, 0, 0, 0}, v3(k * 1000.0, 0, 0));
        shape_scale(&grain, s, s, s);
        outcome o = check_repaired(&grain, volume * s * s * s, 1e-9);
        check(o.report.warnings == 0 && o.log.text[0] == 0 && o.report.shells == 1 && o.report.bodies == 1);
        check(fabs(o.report.volume_change) < 1e-12);
        dem_mesh_free(&grain);
    }
}

static void an_unlikely_size_is_repaired_with_a_hint(void **state)
{
    (void)state;
    double volume = grain_volume(6);
    for (int k = -9; k <= 9; k += 18) {
        double s = pow(10, k);
        dem_mesh grain = shape_grain(6);
        shape_scale(&grain, s, s, s);
        shape_flip(&grain, 3, 7);
        outcome o = check_repaired(&grain, volume * s * s * s, 1e-12);
        check(strstr(o.log.text, "wrong unit?") && o.report.reoriented_triangles == 4 && o.report.warnings == 2);
        dem_mesh_free(&grain);
    }
}

static void unused_vertices_do_not_count(void **state)
{
    (void)state;
    dem_mesh grain = shape_grain(6);
    grain.vertices = realloc(grain.vertices, (grain.vertex_count + 1) * sizeof *grain.vertices);
    check(grain.vertices != NULL);
    grain.vertices[grain.vertex_count++] = v3(1e20, NAN, 0);
    outcome o = check_repaired(&grain, grain_volume(6), 1e-14);
    check(o.report.unreferenced_vertices == 1 && o.report.warnings == 0 && grain.vertex_count == 146);
    dem_mesh_free(&grain);
}

// each triangle on its own, its corners off by up to `noise`
static dem_mesh loose(const dem_mesh *mesh, double noise)
{
    dem_random r = random_stream(9, 0);
    dem_mesh soup = {0};
    for (size_t t = 0; t < mesh->triangle_count; t++) {
        dem_vec3 p[3];
        for (size_t k = 0; k < 3; k++) {
            double x = random_uniform(&r) - 0.5, y = random_uniform(&r) - 0.5, z = random_uniform(&r) - 0.5;
            p[k] = v3_along(mesh->vertices[mesh->triangles[3 * t + k]], 2 * noise, v3(x, y, z));
        }
        dem_mesh one = {.vertices = p, .triangles = (uint32_t[]){0, 1, 2}, .vertex_count = 3, .triangle_count = 1};
        shape_append(&soup, &one, 0, 1);
    }
    return soup;
}

static void loose_triangles_are_welded_exactly_or_with_a_warning(void **state)
{
    (void)state;
    dem_mesh grain = shape_grain(6), exact = loose(&grain, 0), rough = loose(&grain, 1e-7);
    outcome o = check_repaired(&exact, grain_volume(6), 1e-14);
    check(o.report.warnings == 0 && exact.vertex_count == grain.vertex_count);
    o = check_repaired(&rough, grain_volume(6), 1e-6);
    check(o.report.welded_vertices == 3 * 288 - 146 && o.report.warnings == 1);
    check(o.report.weld_tolerance > 2e-6 && strstr(o.log.text, "welded"));
    dem_mesh_free(&grain);
    dem_mesh_free(&exact);
    dem_mesh_free(&rough);
}

// two halves of a grain whose rims miss each other by far more than rounding
static void a_seam_is_welded_as_wide_as_its_edges_allow(void **state)
{
    (void)state;
    for (int wide = 0; wide < 2; wide++) {
        dem_mesh grain = shape_grain(6), half = shape_grain(6);
        double volume = grain_volume(6), gap = wide ? 1e-2 : 1e-4;
        // the first four octants of the triangles have z > 0, the others z < 0
        shape_move(&half, (dem_quat){1, 0, 0, 0}, v3(gap, 0, 0));
        grain.triangle_count = 144;
        shape_append(&grain, &half, 144, 288);
        if (wide) {
            check_refused(&grain, DEM_REPAIR_AUTO, "open");
        } else {
            outcome o = check_repaired(&grain, volume, 1e-4);
            check(o.report.welded_vertices == 24 && o.report.warnings == 1 && strstr(o.log.text, "1e-04 of the diagonal"));
        }
        dem_mesh_free(&grain);
        dem_mesh_free(&half);
    }
}

static void triangles_without_area_go(void **state)
{
    (void)state;
    dem_mesh grain = shape_grain(6), extra = shape_grain(6);
    memcpy(extra.triangles, (uint32_t[]){0, 0, 1, 5, 5, 5, 7, 3, 7}, 9 * sizeof *extra.triangles);
    shape_append(&grain, &extra, 0, 3);
    outcome o = check_repaired(&grain, grain_volume(6), 1e-14);
    check(o.report.degenerate_triangles == 3 && o.report.warnings == 1 && grain.triangle_count == 288);
    dem_mesh_free(&grain);
    dem_mesh_free(&extra);
}

static void duplicates_go_whichever_way_they_face(void **state)
{
    (void)state;
    dem_mesh grain = shape_grain(6), other = shape_grain(6);
    shape_append(&grain, &other, 0, 40);
    shape_flip(&other, 0, 288);
    shape_append(&grain, &other, 20, 288);
    outcome o = check_repaired(&grain, grain_volume(6), 1e-14);
    check(o.report.duplicate_triangles == 40 + 268 && o.report.warnings == 1 && grain.triangle_count == 288);
    dem_mesh_free(&grain);
    dem_mesh_free(&other);
}

static void an_inside_out_mesh_is_turned(void **state)
{
    (void)state;
    dem_mesh grain = shape_grain(6);
    shape_flip(&grain, 0, 288);
    outcome o = check_repaired(&grain, grain_volume(6), 1e-14);
    check(o.report.inside_out && o.report.reoriented_triangles == 0 && o.report.warnings == 1);
    check_close(o.report.volume_before, -grain_volume(6), 1e-14);
    dem_mesh_free(&grain);
}

static void triangles_that_face_the_wrong_way_are_turned(void **state)
{
    (void)state;
    for (int half = 0; half < 2; half++) {
        dem_mesh grain = shape_grain(6);
        for (size_t i = 0; i < (half ? 288u : 1u); i += 2)
            shape_flip(&grain, i, i + 1);
        outcome o = check_repaired(&grain, grain_volume(6), 1e-14);
        check(!o.report.inside_out && o.report.reoriented_triangles == (half ? 144 : 1) && o.report.warnings == 1);
        dem_mesh_free(&grain);
    }
}

static void small_holes_are_filled(void **state)
{
    (void)state;
    dem_mesh grain = shape_grain(6);
    double volume = grain_volume(6);
    // the last triangle, and a pair in the middle
    grain.triangle_count = 287;
    memmove(grain.triangles + 3 * 100, grain.triangles + 3 * 102, 3 * 185 * sizeof *grain.triangles);
    grain.triangle_count -= 2;
    outcome o = check_repaired(&grain, volume, 2e-3);
    check(o.report.holes_filled == 2 && o.report.hole_edges == 7 && o.report.boundary_edges == 7);
    check(o.report.warnings == 1 && o.report.volume_change > 0.002 && o.report.volume_change < 0.03);
    dem_mesh_free(&grain);
}

// drops the triangles whose middle lies above z
static void cut_top(dem_mesh *mesh, double z)
{
    size_t kept = 0;
    for (size_t t = 0; t < mesh->triangle_count; t++) {
        double sum = 0;
        for (size_t k = 0; k < 3; k++)
            sum += mesh->vertices[mesh->triangles[3 * t + k]].z;
        if (sum / 3 < z)
            memmove(mesh->triangles + 3 * kept++, mesh->triangles + 3 * t, 3 * sizeof *mesh->triangles);
    }
    mesh->triangle_count = kept;
}

static void a_large_hole_is_refused_with_what_filling_would_add(void **state)
{
    (void)state;
    dem_mesh grain = shape_grain(10);
    cut_top(&grain, 0.25);
    check_refused(&grain, DEM_REPAIR_AUTO, "open");
    dem_mesh_free(&grain);
    grain = shape_grain(10);
    cut_top(&grain, 0.25);
    check_refused(&grain, DEM_REPAIR_AUTO, "% of volume");
    dem_mesh_free(&grain);
}

static void what_encloses_no_volume_is_refused(void **state)
{
    (void)state;
    for (int mode = DEM_REPAIR_AUTO; mode <= DEM_REPAIR_NONE; mode++) {
        if (mode == DEM_REPAIR_WRAP)
            continue;
        dem_mesh triangle = shape_copy((dem_vec3[]){{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, 3, (uint32_t[]){0, 1, 2}, 1);
        check_refused(&triangle, (dem_repair)mode, "no volume");
        dem_mesh_free(&triangle);
        dem_mesh plate = shape_box(2, 1, 0);
        check_refused(&plate, (dem_repair)mode, mode == DEM_REPAIR_STRICT ? "needs repair" : "no volume");
        dem_mesh_free(&plate);
        dem_mesh line = shape_copy((dem_vec3[]){{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}}, 4,
                                   (uint32_t[]){0, 1, 2, 1, 2, 3, 0, 1, 3}, 3);
        check_refused(&line, (dem_repair)mode, "no volume");
        dem_mesh_free(&line);
        dem_mesh point = shape_box(0, 0, 0);
        check_refused(&point, (dem_repair)mode, "one place");
        dem_mesh_free(&point);
        dem_mesh nothing = {0};
        check_refused(&nothing, (dem_repair)mode, "no triangles");
        dem_mesh_free(&nothing);
    }
}

static void numbers_that_are_none_and_vertices_that_are_not_there_are_refused(void **state)
{
    (void)state;
    const double bad[] = {NAN, INFINITY, 1e200};
    for (int i = 0; i < 3; i++) {
        dem_mesh grain = shape_grain(4);
        grain.vertices[10].y = bad[i];
        check_refused(&grain, DEM_REPAIR_AUTO, i < 2 ? "vertex 11 is not finite" : "across");
        dem_mesh_free(&grain);
    }
    dem_mesh grain = shape_grain(4);
    grain.triangles[30] = 66;
    check_refused(&grain, DEM_REPAIR_AUTO, "triangle 11 refers to vertex 66 of 66");
    dem_mesh_free(&grain);
}

static void a_fin_and_a_stray_are_dropped(void **state)
{
    (void)state;
    dem_mesh grain = shape_grain(6);
    dem_vec3 p[5] = {{0, 0, 0}, {0, 0, 0}, {0, 0, 2}, {5, 5, 5}, {5.1, 5, 5}};
    for (int i = 0; i < 2; i++)
        p[i] = grain.vertices[grain.triangles[i]];
    dem_mesh extra = {.vertices = p, .triangles = (uint32_t[]){0, 1, 2, 3, 4, 2}, .vertex_count = 5, .triangle_count = 1};
    shape_append(&grain, &extra, 0, 1);
    p[2] = v3(5, 5.1, 5);
    shape_append(&grain, &extra, 1, 2);
    outcome o = check_repaired(&grain, grain_volume(6), 1e-14);
    check(o.report.dropped_triangles == 2 && o.report.warnings == 1);
    dem_mesh_free(&grain);
}

// two boxes side by side with the wall between them in it once or twice
static void an_inner_wall_is_dropped(void **state)
{
    (void)state;
    for (int twice = 0; twice < 2; twice++) {
        dem_mesh one = shape_box(1, 1, 1), two = shape_box(1, 1, 1);
        shape_move(&two, (dem_quat){1, 0, 0, 0}, v3(1, 0, 0));
        // the side x = 0 of a box is its triangles 8 and 9
        shape_append(&one, &two, 0, 8);
        shape_append(&one, &two, twice ? 8 : 10, 12);
        outcome o = check_repaired(&one, 2.0, 1e-14);
        check(o.report.dropped_triangles == 2 && o.report.bodies == 1 && one.triangle_count == 20);
        dem_mesh_free(&one);
        dem_mesh_free(&two);
    }
}

static void two_tetrahedra_at_one_edge_are_one_body_whichever_way_they_face(void **state)
{
    (void)state;
    dem_vec3 p[6] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, -1, 0}, {0, 0, -1}};
    dem_mesh one = shape_tetrahedron(p[0], p[1], p[2], p[3]), two = shape_tetrahedron(p[0], p[1], p[4], p[5]);
    shape_flip(&two, 0, 4);
    shape_append(&one, &two, 0, 4);
    outcome o = check_repaired(&one, 1.0 / 3, 1e-14);
    check(o.report.nonmanifold_edges == 1 && o.report.bodies == 1 && o.report.shells == 2 && o.report.warnings == 2);
    dem_mesh_free(&one);
    dem_mesh_free(&two);
}

static void two_boxes_that_share_a_corner_are_one_body(void **state)
{
    (void)state;
    dem_mesh one = shape_box(1, 1, 0.5), two = shape_box(-1, -1, -0.5);
    shape_flip(&two, 0, 12);
    shape_append(&one, &two, 0, 12);
    outcome o = check_repaired(&one, 1.0, 1e-14);
    check(o.report.bodies == 1 && strstr(o.log.text, "touch"));
    dem_mesh_free(&one);
    dem_mesh_free(&two);
}

static void two_bodies_are_refused_or_kept_as_told(void **state)
{
    (void)state;
    for (int keep = DEM_KEEP_ONE; keep <= DEM_KEEP_ALL; keep++) {
        dem_mesh mesh = shape_box(1, 1, 1), other = shape_box(2, 1, 1);
        shape_move(&other, (dem_quat){1, 0, 0, 0}, v3(3, 0, 0));
        shape_append(&mesh, &other, 0, 12);
        outcome o = repair_with(&mesh, DEM_REPAIR_AUTO, (dem_keep)keep);
        if (keep == DEM_KEEP_ONE) {
            check(o.status == DEM_BAD_INPUT && strstr(o.error.text, "2 separate bodies of 2, 1 m^3"));
        } else {
            check_ok(o.status, o.error);
            check(o.report.bodies == 2 && o.report.warnings == 1);
            check_close(o.report.volume, keep == DEM_KEEP_ALL ? 3.0 : 2.0, 1e-14);
        }
        dem_mesh_free(&mesh);
        dem_mesh_free(&other);
    }
}

static void specks_of_dust_are_dropped(void **state)
{
    (void)state;
    dem_mesh grain = shape_grain(6), speck = shape_box(0.01, 0.01, 0.01);
    shape_move(&speck, (dem_quat){1, 0, 0, 0}, v3(2, 0, 0));
    shape_append(&grain, &speck, 0, 12);
    outcome o = check_repaired(&grain, grain_volume(6), 1e-14);
    check(o.report.dropped_triangles == 12 && o.report.warnings == 1);
    dem_mesh_free(&grain);
    dem_mesh_free(&speck);
}

// a box of side 4 with one of side 2 in it and one of side 1 in that
static dem_mesh nested(bool flip_middle, bool flip_inner, bool flip_all)
{
    dem_mesh mesh = shape_box(4, 4, 4);
    for (int k = 0; k < 2; k++) {
        double side = k ? 1 : 2;
        dem_mesh box = shape_box(side, side, side);
        shape_move(&box, (dem_quat){1, 0, 0, 0}, v3(1.1 + 0.3 * k, 1.1 + 0.3 * k, 1.1 + 0.3 * k));
        if (k ? flip_inner : flip_middle)
            shape_flip(&box, 0, 12);
        shape_append(&mesh, &box, 0, 12);
        dem_mesh_free(&box);
    }
    if (flip_all)
        shape_flip(&mesh, 0, 36);
    return mesh;
}

static void cavities_are_kept_and_shells_of_the_same_way_ignored(void **state)
{
    (void)state;
    for (int i = 0; i < 2; i++) {
        // a cavity, and in it a wall the wrong way round: both sides of it are solid or empty
        dem_mesh hollow = nested(true, true, i);
        outcome o = repair_with(&hollow, DEM_REPAIR_AUTO, DEM_KEEP_ONE);
        check(o.status == DEM_BAD_INPUT && strstr(o.error.text, "2 separate bodies of 56, 1"));
        dem_mesh_free(&hollow);
        dem_mesh solid = nested(false, false, i);
        o = check_repaired(&solid, 64.0, 1e-14);
        check(o.report.ignored_shells == 2 && o.report.cavities == 0 && o.report.inside_out == i);
        dem_mesh_free(&solid);
        dem_mesh one = nested(true, false, i);
        o = repair_with(&one, DEM_REPAIR_AUTO, DEM_KEEP_LARGEST);
        check_ok(o.status, o.error);
        check(o.report.cavities == 1 && o.report.shells == 3 && strstr(o.log.text, "hollow: 1 cavity of 14.3 %"));
        check_close(o.report.volume, 56.0, 1e-14);
        dem_mesh_free(&one);
    }
}

static void a_moebius_band_is_refused(void **state)
{
    (void)state;
    enum { N = 24 };
    dem_mesh band = {.vertices = malloc(2 * N * sizeof(dem_vec3)), .triangles = malloc(6 * N * sizeof(uint32_t)),
                     .vertex_count = 2 * N, .triangle_count = 2 * N};
    check(band.vertices && band.triangles);
    for (uint32_t i = 0; i < N; i++) {
        double a = 2 * DEM_PI * i / N, r = 0.3 * cos(a / 2), z = 0.3 * sin(a / 2);
        band.vertices[2 * i] = v3((2 + r) * cos(a), (2 + r) * sin(a), z);
        band.vertices[2 * i + 1] = v3((2 - r) * cos(a), (2 - r) * sin(a), -z);
        uint32_t next = i + 1 < N ? 2 * i + 2 : 1, other = i + 1 < N ? 2 * i + 3 : 0;
        memcpy(band.triangles + 6 * i, (uint32_t[]){2 * i, next, 2 * i + 1, 2 * i + 1, next, other}, 6 * sizeof(uint32_t));
    }
    check_refused(&band, DEM_REPAIR_AUTO, "one-sided");
    dem_mesh_free(&band);
}

static void strict_refuses_what_auto_mends_and_passes_what_is_clean(void **state)
{
    (void)state;
    dem_mesh grain = shape_grain(6), soup = loose(&grain, 0);
    outcome o = repair_with(&soup, DEM_REPAIR_STRICT, DEM_KEEP_ONE);
    check_ok(o.status, o.error);
    dem_mesh_free(&soup);
    shape_flip(&grain, 0, 1);
    check_refused(&grain, DEM_REPAIR_STRICT, "needs repair (turned 1 of 288 triangles");
    dem_mesh_free(&grain);
    grain = shape_grain(6);
    grain.triangle_count--;
    check_refused(&grain, DEM_REPAIR_STRICT, "needs repair (filled 1 hole");
    dem_mesh_free(&grain);
    grain = shape_grain(6);
    shape_flip(&grain, 0, 288);
    check_refused(&grain, DEM_REPAIR_STRICT, "inside out");
    dem_mesh_free(&grain);
}

static void none_takes_the_surface_as_it_is_and_says_so(void **state)
{
    (void)state;
    dem_mesh grain = shape_grain(6);
    grain.triangle_count--;
    outcome o = repair_with(&grain, DEM_REPAIR_NONE, DEM_KEEP_ONE);
    check_ok(o.status, o.error);
    check(grain.triangle_count == 287 && o.report.warnings == 1 && strstr(o.log.text, "open: 3 boundary edges"));
    dem_mesh_free(&grain);
    grain = shape_grain(6);
    shape_flip(&grain, 0, 288);
    check_refused(&grain, DEM_REPAIR_NONE, "inside out");
    dem_mesh_free(&grain);
}

static void lost_digits_are_told(void **state)
{
    (void)state;
    dem_mesh grain = shape_grain(6);
    for (size_t i = 0; i < grain.vertex_count; i++) {
        dem_vec3 *p = &grain.vertices[i];
        // gcc 12 leaves out the rounding of (double)(float) where it stores two doubles at once
        volatile float x = (float)(p->x + 1e6), y = (float)(p->y - 1e6), z = (float)(p->z + 1e6);
        *p = v3(x, y, z);
    }
    outcome o = repair_with(&grain, DEM_REPAIR_AUTO, DEM_KEEP_ALL);
    check_ok(o.status, o.error);
    check(strstr(o.log.text, "a resolution of 0.062 m"));
    dem_mesh_free(&grain);
    // the same place with all digits is no reason to warn
    grain = shape_grain(6);
    shape_move(&grain, (dem_quat){1, 0, 0, 0}, v3(1e6, -1e6, 1e6));
    o = check_repaired(&grain, grain_volume(6), 1e-8);
    check(o.report.warnings == 0);
    dem_mesh_free(&grain);
}

static void the_real_grains_come_out_with_their_volumes(void **state)
{
    (void)state;
    const struct {
        const char *file;
        double volume;
        size_t warnings;
    } grains[] = {
        {SHARED_MESH("castalia.obj"), 0.6678, 0},      {SHARED_MESH("flake1_thin.obj"), 2.061e4, 0},
        {SHARED_MESH("flake3_dirty.obj"), 1.1e4, 1},   {SHARED_MESH("human_femur.stl"), 1.256e5, 0},
        {SHARED_MESH("offroad_rock2.obj"), 7.568, 0},  {SHARED_MESH("regolith_1.obj"), 8.322e-8, 0},
        {SHARED_MESH("regolith_3.obj"), 7.92e-8, 0},   {SHARED_MESH("ryugu.obj"), 0.3769, 0},
        {SHARED_MESH("scan_rock_nonmanifold.stl"), 3.935e4, 1}, {SHARED_MESH("shpsg_sand_030.stl"), 0.5008, 0},
    };
    check_shared(grains[0].file);
    for (size_t i = 0; i < sizeof grains / sizeof grains[0]; i++) {
        dem_mesh mesh;
        dem_error error;
        check_ok(dem_mesh_read(NULL, grains[i].file, &mesh, &error), error);
        outcome o = check_repaired(&mesh, grains[i].volume, 3e-4);  // the list has four digits
        check(o.report.warnings == grains[i].warnings && o.report.bodies == 1);
        dem_mesh_free(&mesh);
    }
    dem_mesh coral;
    dem_error error;
    check_ok(dem_mesh_read(NULL, SHARED_MESH("coral_mcap_open.obj"), &coral, &error), error);
    check_refused(&coral, DEM_REPAIR_AUTO, "195 boundary edges");
    dem_mesh_free(&coral);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_clean_grain_passes_in_silence_at_any_scale_and_place),
        cmocka_unit_test(an_unlikely_size_is_repaired_with_a_hint),
        cmocka_unit_test(unused_vertices_do_not_count),
        cmocka_unit_test(loose_triangles_are_welded_exactly_or_with_a_warning),
        cmocka_unit_test(a_seam_is_welded_as_wide_as_its_edges_allow),
        cmocka_unit_test(triangles_without_area_go),
        cmocka_unit_test(duplicates_go_whichever_way_they_face),
        cmocka_unit_test(an_inside_out_mesh_is_turned),
        cmocka_unit_test(triangles_that_face_the_wrong_way_are_turned),
        cmocka_unit_test(small_holes_are_filled),
        cmocka_unit_test(a_large_hole_is_refused_with_what_filling_would_add),
        cmocka_unit_test(what_encloses_no_volume_is_refused),
        cmocka_unit_test(numbers_that_are_none_and_vertices_that_are_not_there_are_refused),
        cmocka_unit_test(a_fin_and_a_stray_are_dropped),
        cmocka_unit_test(an_inner_wall_is_dropped),
        cmocka_unit_test(two_tetrahedra_at_one_edge_are_one_body_whichever_way_they_face),
        cmocka_unit_test(two_boxes_that_share_a_corner_are_one_body),
        cmocka_unit_test(two_bodies_are_refused_or_kept_as_told),
        cmocka_unit_test(specks_of_dust_are_dropped),
        cmocka_unit_test(cavities_are_kept_and_shells_of_the_same_way_ignored),
        cmocka_unit_test(a_moebius_band_is_refused),
        cmocka_unit_test(strict_refuses_what_auto_mends_and_passes_what_is_clean),
        cmocka_unit_test(none_takes_the_surface_as_it_is_and_says_so),
        cmocka_unit_test(lost_digits_are_told),
        cmocka_unit_test(the_real_grains_come_out_with_their_volumes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
