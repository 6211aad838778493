#include "read_check.h"

#include <errno.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

// a folder of its own for every test
typedef struct place {
    char folder[64], path[128];
} place;

static int set_up(void **state)
{
    place *at = calloc(1, sizeof *at);
    if (!at)
        return -1;
    strcpy(at->folder, "/tmp/test_import.XXXXXX");
    *state = at;
    return mkdtemp(at->folder) ? 0 : -1;
}

// fails where anything but the files named in the tests was left
static int tear_down(void **state)
{
    place *at = *state;
    static const char *const names[] = {"a.gltf", "a.glb", "a.bin", "a.3mf", "a.dae", "a.stl", "a.obj", "a.txt", "a"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        snprintf(at->path, sizeof at->path, "%s/%s", at->folder, names[i]);
        unlink(at->path);
    }
    int left = rmdir(at->folder);
    free(at);
    return left;
}

static void put_file(place *at, const char *name, const void *bytes, size_t size)
{
    snprintf(at->path, sizeof at->path, "%s/%s", at->folder, name);
    FILE *file = fopen(at->path, "wb");
    assert_non_null(file);
    check(fwrite(bytes, 1, size, file) == size && fclose(file) == 0);
}

// imports the file put last; no child is left
static dem_status import(const place *at, heard *all, dem_mesh *mesh, dem_error *error)
{
    dem_ctx ctx = {.log = hear, .user = all};
    *all = (heard){0};
    *error = (dem_error){0};
    dem_status status = dem_mesh_import(&ctx, at->path, mesh, error);
    check(waitpid(-1, NULL, WNOHANG) == -1 && errno == ECHILD);
    if (status != DEM_OK)
        check(!mesh->vertices && !mesh->triangles && strchr(error->text, ';') && !strchr(error->text, '\n'));
    return status;
}

static dem_solid imported_solid(const place *at, int warnings)
{
    dem_mesh mesh;
    dem_error error;
    heard all;
    check_ok(import(at, &all, &mesh, &error), error);
    if (all.warnings != warnings)
        fail_msg("%d warnings, the last: %s", all.warnings, all.last);
    dem_solid solid = dem_mesh_solid(&mesh);
    dem_mesh_free(&mesh);
    return solid;
}

static void put_u32(dem_buffer *out, size_t value)
{
    dem_buffer_bytes(out, (char[]){(char)value, (char)(value >> 8), (char)(value >> 16), (char)(value >> 24)}, 4);
}
static void put_u16(dem_buffer *out, size_t value)
{
    dem_buffer_bytes(out, (char[]){(char)value, (char)(value >> 8)}, 2);
}

// corners as floats and triangles as 16-bit indices: 96 and 72 bytes
static dem_buffer cube_bytes(void)
{
    dem_buffer out = {0};
    for (int i = 0; i < 8; i++) {
        float corner[3] = {(float)cube_corners[i].x, (float)cube_corners[i].y, (float)cube_corners[i].z};
        uint32_t bits[3];
        memcpy(bits, corner, sizeof bits);
        for (int k = 0; k < 3; k++)
            put_u32(&out, bits[k]);
    }
    for (int i = 0; i < 12; i++)
        for (int k = 0; k < 3; k++)
            put_u16(&out, (size_t)cube_sides[i / 2][quad_halves[i % 2][k]]);
    return out;
}

static dem_buffer base64(const dem_buffer *bytes)
{
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    dem_buffer out = {0};
    for (size_t i = 0; i + 2 < bytes->size; i += 3) {
        const unsigned char *b = (const unsigned char *)bytes->data + i;
        unsigned bits = (unsigned)b[0] << 16 | (unsigned)b[1] << 8 | b[2];
        for (int k = 18; k >= 0; k -= 6)
            dem_buffer_bytes(&out, &digits[bits >> k & 63], 1);
    }
    return out;
}

enum { TRIANGLES = 4, POINTS = 0, LINES = 1 };

// the cube placed by `nodes`, its numbers in a buffer with this "uri": member (empty: the chunk of a glb)
static dem_buffer gltf(const char *nodes, int mode, const char *uri)
{
    dem_buffer out = {0};
    dem_buffer_text(&out, "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0]}],\"nodes\":");
    dem_buffer_text(&out, nodes);
    dem_buffer_print(
        &out, ",\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"indices\":1,\"mode\":%d}]}],", mode);
    dem_buffer_text(&out, "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":8,\"type\":\"VEC3\","
                          "\"min\":[0,0,0],\"max\":[1,1,1]},"
                          "{\"bufferView\":1,\"componentType\":5123,\"count\":36,\"type\":\"SCALAR\"}],"
                          "\"bufferViews\":[{\"buffer\":0,\"byteLength\":96},"
                          "{\"buffer\":0,\"byteOffset\":96,\"byteLength\":72}],\"buffers\":[{");
    dem_buffer_text(&out, uri);
    dem_buffer_text(&out, "\"byteLength\":168}]}");
    return out;
}

static void put_gltf(place *at, const char *nodes, int mode)
{
    dem_buffer bytes = cube_bytes(), text = base64(&bytes), uri = {0};
    dem_buffer_text(&uri, "\"uri\":\"data:application/octet-stream;base64,");
    dem_buffer_text(&uri, text.data);
    dem_buffer_text(&uri, "\",");
    dem_buffer file = gltf(nodes, mode, uri.data);
    put_file(at, "a.gltf", file.data, file.size);
    dem_buffer_release(&bytes);
    dem_buffer_release(&text);
    dem_buffer_release(&uri);
    dem_buffer_release(&file);
}

static dem_buffer glb(void)
{
    dem_buffer bytes = cube_bytes(), json = gltf("[{\"mesh\":0}]", TRIANGLES, ""), out = {0};
    while (json.size % 4)
        dem_buffer_text(&json, " ");
    dem_buffer_text(&out, "glTF");
    put_u32(&out, 2);
    put_u32(&out, 12 + 8 + json.size + 8 + bytes.size);
    put_u32(&out, json.size);
    dem_buffer_text(&out, "JSON");
    dem_buffer_bytes(&out, json.data, json.size);
    put_u32(&out, bytes.size);
    dem_buffer_bytes(&out, "BIN", 4);
    dem_buffer_bytes(&out, bytes.data, bytes.size);
    dem_buffer_release(&bytes);
    dem_buffer_release(&json);
    return out;
}

static uint32_t crc32_of(const char *bytes, size_t size)
{
    uint32_t crc = ~0u;
    for (size_t i = 0; i < size; i++) {
        crc ^= (unsigned char)bytes[i];
        for (int k = 0; k < 8; k++)
            crc = crc >> 1 ^ (crc & 1 ? 0xedb88320u : 0);
    }
    return ~crc;
}

// one stored file of a zip archive, and its line of the table of contents
static void put_stored(dem_buffer *out, dem_buffer *table, const char *name, const char *text)
{
    size_t offset = out->size, size = strlen(text), crc = crc32_of(text, size);
    dem_buffer *both[2] = {out, table};
    for (int k = 0; k < 2; k++) {
        dem_buffer_bytes(both[k], k ? "PK\1\2\24\0\24\0" : "PK\3\4\24\0", k ? 8 : 6);
        dem_buffer_bytes(both[k], "\0\0\0\0\0\0\41\0", 8);  // no flags, stored, 1980
        put_u32(both[k], crc);
        put_u32(both[k], size);
        put_u32(both[k], size);
        put_u16(both[k], strlen(name));
        dem_buffer_bytes(both[k], "\0\0\0\0\0\0\0\0\0\0\0", k ? 12 : 2);
        if (k)
            put_u32(table, offset);
        dem_buffer_text(both[k], name);
    }
    dem_buffer_text(out, text);
}

static dem_buffer three_mf(void)
{
    dem_buffer model = {0}, out = {0}, table = {0};
    dem_buffer_text(&model,
                    "<?xml version=\"1.0\"?><model unit=\"millimeter\" xmlns=\"http://schemas.microsoft.com/"
                    "3dmanufacturing/core/2015/02\"><resources><object id=\"1\" type=\"model\"><mesh><vertices>");
    for (int i = 0; i < 8; i++)
        dem_buffer_print(&model, "<vertex x=\"%d\" y=\"%d\" z=\"%d\"/>", (int)cube_corners[i].x, (int)cube_corners[i].y,
                         (int)cube_corners[i].z);
    dem_buffer_text(&model, "</vertices><triangles>");
    for (int i = 0; i < 12; i++)
        dem_buffer_print(&model, "<triangle v1=\"%d\" v2=\"%d\" v3=\"%d\"/>", cube_sides[i / 2][quad_halves[i % 2][0]],
                         cube_sides[i / 2][quad_halves[i % 2][1]], cube_sides[i / 2][quad_halves[i % 2][2]]);
    dem_buffer_text(&model, "</triangles></mesh></object></resources><build><item objectid=\"1\"/></build></model>");
    put_stored(
        &out, &table, "[Content_Types].xml",
        "<?xml version=\"1.0\"?><Types xmlns=\"http://schemas.openxmlformats.org/package/2006/content-types\"/>");
    put_stored(
        &out, &table, "_rels/.rels",
        "<?xml version=\"1.0\"?><Relationships xmlns=\"http://schemas.openxmlformats.org/package/2006/relationships\">"
        "<Relationship Id=\"r\" Target=\"/3D/3dmodel.model\" "
        "Type=\"http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel\"/></Relationships>");
    put_stored(&out, &table, "3D/3dmodel.model", model.data);
    size_t offset = out.size;
    dem_buffer_bytes(&out, table.data, table.size);
    dem_buffer_bytes(&out, "PK\5\6\0\0\0\0\3\0\3", 12);
    put_u32(&out, table.size);
    put_u32(&out, offset);
    put_u16(&out, 0);
    dem_buffer_release(&model);
    dem_buffer_release(&table);
    return out;
}

static dem_buffer collada(void)
{
    dem_buffer out = {0};
    dem_buffer_text(
        &out, "<?xml version=\"1.0\"?><COLLADA xmlns=\"http://www.collada.org/2005/11/COLLADASchema\" "
              "version=\"1.4.1\"><asset><unit name=\"meter\" meter=\"1\"/><up_axis>Z_UP</up_axis></asset>"
              "<library_geometries><geometry id=\"g\"><mesh><source id=\"p\"><float_array id=\"a\" count=\"24\">");
    for (int i = 0; i < 8; i++)
        dem_buffer_print(&out, "%d %d %d ", (int)cube_corners[i].x, (int)cube_corners[i].y, (int)cube_corners[i].z);
    dem_buffer_text(
        &out, "</float_array><technique_common><accessor source=\"#a\" count=\"8\" stride=\"3\">"
              "<param name=\"X\" type=\"float\"/><param name=\"Y\" type=\"float\"/><param name=\"Z\" type=\"float\"/>"
              "</accessor></technique_common></source><vertices id=\"v\"><input semantic=\"POSITION\" source=\"#p\"/>"
              "</vertices><triangles count=\"12\"><input semantic=\"VERTEX\" source=\"#v\" offset=\"0\"/><p>");
    for (int i = 0; i < 36; i++)
        dem_buffer_print(&out, "%d ", cube_sides[i / 6][quad_halves[i / 3 % 2][i % 3]]);
    dem_buffer_text(
        &out, "</p></triangles></mesh></geometry></library_geometries><library_visual_scenes><visual_scene id=\"s\">"
              "<node id=\"n\"><instance_geometry url=\"#g\"/></node></visual_scene></library_visual_scenes>"
              "<scene><instance_visual_scene url=\"#s\"/></scene></COLLADA>");
    return out;
}

static void our_formats_are_read_by_our_readers(void **state)
{
    place *at = *state;
    put_file(at, "a.obj", CUBE_OBJ, strlen(CUBE_OBJ));
    check_close(imported_solid(at, 0).volume, 1, 1e-12);
    put_file(at, "a.stl", CUBE_OBJ, strlen(CUBE_OBJ));
    check_close(imported_solid(at, 1).volume, 1, 1e-12);
    put_file(at, "a.obj", "v 0 0 0\nf 1 2 3\n", 16);
    dem_mesh mesh;
    dem_error error;
    heard all;
    check(import(at, &all, &mesh, &error) == DEM_BAD_INPUT && error.line == 2);
    assert_string_equal(error.file, at->path);
    put_file(at, "a.obj", "solid nonsense, ply and\noff\n", 28);
    check(import(at, &all, &mesh, &error) == DEM_BAD_INPUT && error.line == 2);
}

static void what_nobody_knows_is_refused(void **state)
{
    place *at = *state;
    dem_mesh mesh;
    dem_error error;
    heard all;
    static const char *const names[] = {"a.txt", "a.obj", "a"};
    for (int i = 0; i < 3; i++) {
        put_file(at, names[i], "Dear colleague,\n", 16);
        check(import(at, &all, &mesh, &error) == DEM_BAD_INPUT);
        assert_non_null(strstr(error.text, "not a mesh; supported: STL, OBJ, PLY, OFF"));
        check(!DEM_ASSIMP == !strstr(error.text, "glTF"));
    }
    dem_buffer file = glb();
    put_file(at, "a.glb", file.data, file.size);
    if (!DEM_ASSIMP) {
        check(import(at, &all, &mesh, &error) == DEM_UNAVAILABLE);
        assert_non_null(strstr(error.text, "built without assimp"));
    }
    dem_buffer_release(&file);
}

static void scenes_of_other_formats_give_the_cube(void **state)
{
    place *at = *state;
    if (!DEM_ASSIMP)
        skip();
    struct {
        const char *name;
        dem_buffer file;
    } cases[] = {{"a.glb", glb()}, {"a.3mf", three_mf()}, {"a.dae", collada()}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        dem_buffer *file = &cases[i].file;
        put_file(at, cases[i].name, file->data, file->size);
        check_close(imported_solid(at, 0).volume, 1, 1e-12);
        put_file(at, "a", file->data, file->size);  // by content
        check_close(imported_solid(at, 0).volume, 1, 1e-12);
        put_file(at, "a.stl", file->data, file->size);
        check_close(imported_solid(at, 1).volume, 1, 1e-12);
        int keep = dup(STDIN_FILENO);
        assert_non_null(freopen(at->path, "rb", stdin));
        strcpy(at->path, "-");
        dem_solid solid = imported_solid(at, 0);
        dup2(keep, STDIN_FILENO);
        close(keep);
        check_close(solid.volume, 1, 1e-12);
        dem_buffer_release(file);
    }
    put_gltf(at, "[{\"mesh\":0}]", TRIANGLES);
    check_close(imported_solid(at, 0).volume, 1, 1e-12);
}

static void a_buffer_in_a_file_beside_is_found(void **state)
{
    place *at = *state;
    if (!DEM_ASSIMP)
        skip();
    dem_buffer bytes = cube_bytes(), file = gltf("[{\"mesh\":0}]", TRIANGLES, "\"uri\":\"a.bin\",");
    put_file(at, "a.bin", bytes.data, bytes.size);
    put_file(at, "a.gltf", file.data, file.size);
    check_close(imported_solid(at, 0).volume, 1, 1e-12);
    dem_buffer_release(&bytes);
    dem_buffer_release(&file);
}

static void nodes_place_their_meshes(void **state)
{
    place *at = *state;
    if (!DEM_ASSIMP)
        skip();
    // doubled, turned by 90 degrees about z, shifted: the float quaternion costs 1e-7
    put_gltf(at,
             "[{\"scale\":[2,2,2],\"translation\":[5,0,0],\"children\":[1]},"
             "{\"mesh\":0,\"rotation\":[0,0,0.70710678,0.70710678],\"translation\":[0,1,0]}]",
             TRIANGLES);
    dem_solid solid = imported_solid(at, 0);
    check_close(solid.volume, 8, 1e-6);
    check_vec(solid.centre, ((dem_vec3){4, 3, 1}), 1e-6);
    // mirrored: the winding is turned too, so that the volume stays positive
    put_gltf(at, "[{\"scale\":[-2,1,1],\"mesh\":0}]", TRIANGLES);
    solid = imported_solid(at, 0);
    check_close(solid.volume, 2, 1e-12);
    check_vec(solid.centre, ((dem_vec3){-1, 0.5, 0.5}), 1e-12);
    // the same mesh twice
    put_gltf(at, "[{\"mesh\":0,\"children\":[1]},{\"mesh\":0,\"translation\":[3,0,0]}]", TRIANGLES);
    solid = imported_solid(at, 0);
    check_close(solid.volume, 2, 1e-12);
    check_vec(solid.centre, ((dem_vec3){2, 0.5, 0.5}), 1e-12);
}

static void a_grain_far_away_is_warned_of(void **state)
{
    place *at = *state;
    if (!DEM_ASSIMP)
        skip();
    put_gltf(at, "[{\"mesh\":0,\"translation\":[0,1e6,0]}]", TRIANGLES);
    check_close(imported_solid(at, 1).volume, 1, 1e-9);
}

static void points_and_lines_are_no_grain(void **state)
{
    place *at = *state;
    if (!DEM_ASSIMP)
        skip();
    static const int modes[] = {POINTS, LINES};
    for (int i = 0; i < 2; i++) {
        put_gltf(at, "[{\"mesh\":0}]", modes[i]);
        dem_mesh mesh;
        dem_error error;
        heard all;
        check(import(at, &all, &mesh, &error) == DEM_BAD_INPUT);
        assert_non_null(strstr(error.text, "no triangles in it"));
    }
}

// cut anywhere, or with a number made absurd: assimp 5.2.4 aborts on several of them
static void damaged_scenes_are_refused_in_one_line(void **state)
{
    place *at = *state;
    if (!DEM_ASSIMP)
        skip();
    struct {
        const char *name;
        dem_buffer file;
    } cases[] = {{"a.glb", glb()}, {"a.3mf", three_mf()}, {"a.dae", collada()}};
    dem_mesh mesh;
    dem_error error;
    heard all;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        dem_buffer *file = &cases[i].file;
        for (size_t size = 1; size < file->size; size += 61) {
            put_file(at, cases[i].name, file->data, size);
            if (import(at, &all, &mesh, &error) == DEM_OK)
                fail_msg("%s is imported with %zu of %zu bytes", cases[i].name, size, file->size);
        }
        for (size_t k = 0; k + 2 < file->size; k += 7) {
            if (file->data[k] < '0' || file->data[k] > '9')
                continue;
            char kept = file->data[k];
            file->data[k] = '-';
            put_file(at, cases[i].name, file->data, file->size);
            dem_status status = import(at, &all, &mesh, &error);
            check(status == DEM_OK || status == DEM_BAD_INPUT);
            dem_mesh_free(&mesh);
            file->data[k] = kept;
        }
        dem_buffer_release(file);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(our_formats_are_read_by_our_readers, set_up, tear_down),
        cmocka_unit_test_setup_teardown(what_nobody_knows_is_refused, set_up, tear_down),
        cmocka_unit_test_setup_teardown(scenes_of_other_formats_give_the_cube, set_up, tear_down),
        cmocka_unit_test_setup_teardown(a_buffer_in_a_file_beside_is_found, set_up, tear_down),
        cmocka_unit_test_setup_teardown(nodes_place_their_meshes, set_up, tear_down),
        cmocka_unit_test_setup_teardown(a_grain_far_away_is_warned_of, set_up, tear_down),
        cmocka_unit_test_setup_teardown(points_and_lines_are_no_grain, set_up, tear_down),
        cmocka_unit_test_setup_teardown(damaged_scenes_are_refused_in_one_line, set_up, tear_down),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
