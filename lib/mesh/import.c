#include "mesh/import.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>
#include <unistd.h>

#include "base/file.h"
#include "base/memory.h"
#include "mesh/guard.h"
#include "mesh/read.h"
#include "mesh/reader.h"

enum { HEAD_MARK = 0x64656d31, LOOK_BYTES = 4096 };

static const char *const supported =
    DEM_ASSIMP ? "STL, OBJ, PLY, OFF, and through assimp glTF, 3MF, COLLADA, FBX, AMF, X3D, 3DS, Blender and others"
               : "STL, OBJ, PLY, OFF";

// what the child sends before vertices and triangles
typedef struct import_head {
    uint32_t mark;
    dem_import_outcome outcome;
    uint64_t vertices, triangles;
    char why[200];
} import_head;

static void send_all(int out, const void *bytes, size_t size)
{
    for (const char *from = bytes; size;) {
        ssize_t put = write(out, from, size);
        if (put < 0 && errno == EINTR)
            continue;
        if (put <= 0)
            return;
        from += put;
        size -= (size_t)put;
    }
}

static void load_and_send(void *user, int out)
{
    import_head head = {.mark = HEAD_MARK};
    dem_mesh mesh = {0};
    head.outcome = dem_assimp_load(user, &mesh, head.why, sizeof head.why);
    if (head.outcome == DEM_IMPORT_DONE) {
        head.vertices = mesh.vertex_count;
        head.triangles = mesh.triangle_count;
    }
    send_all(out, &head, sizeof head);
    send_all(out, mesh.vertices, head.vertices * sizeof *mesh.vertices);
    send_all(out, mesh.triangles, head.triangles * 3 * sizeof *mesh.triangles);
}

static dem_status refuse(dem_error *error, const char *name, const char *what)
{
    return dem_fail_at(error, DEM_BAD_INPUT, name, 0, "%s; export the mesh as STL, OBJ, PLY or OFF", what);
}

static dem_status refuse_in_words_of(const char *who, const char *why, const char *name, dem_error *error)
{
    char what[256];
    size_t used = (size_t)snprintf(what, sizeof what, "%s ", who);
    for (; *why && used + 1 < sizeof what; why++)
        what[used++] = *why >= ' ' && *why <= '~' ? *why : ' ';
    while (used && (what[used - 1] == ' ' || what[used - 1] == '.'))
        used--;
    what[used] = 0;
    return refuse(error, name, what);
}

// the child is not trusted: sizes by what its memory can have held, numbers and indices one by one
static dem_status receive_mesh(dem_guard *guard, const import_head *head, const char *name, dem_mesh *mesh,
                               dem_error *error)
{
    double bytes = 24.0 * (double)head->vertices + 12.0 * (double)head->triangles;
    if (head->vertices > UINT32_MAX || head->vertices == 0 || head->triangles == 0 || bytes > guard->limits.memory)
        return refuse(error, name, "assimp returned a mesh of impossible size");
    mesh->vertices = dem_alloc(head->vertices, sizeof *mesh->vertices);
    mesh->triangles = dem_alloc(head->triangles, 3 * sizeof *mesh->triangles);
    if (!mesh->vertices || !mesh->triangles)
        return dem_fail_memory(error);
    if (!dem_guard_read(guard, mesh->vertices, head->vertices * sizeof *mesh->vertices) ||
        !dem_guard_read(guard, mesh->triangles, head->triangles * 3 * sizeof *mesh->triangles))
        return DEM_FAILED;  // the guard knows why
    for (size_t i = 0; i < head->vertices; i++)
        if (!point_is_usable(mesh->vertices[i]))
            return refuse(error, name, "a vertex is not finite (nan, inf or beyond 1e60)");
    for (size_t i = 0; i < 3 * head->triangles; i++)
        if (mesh->triangles[i] >= head->vertices)
            return refuse(error, name, "a face refers to a vertex that does not exist");
    mesh->vertex_count = head->vertices;
    mesh->triangle_count = head->triangles;
    mesh->single_precision = true;
    return DEM_OK;
}

// generous for any mesh; assimp needs some ten times the file
static dem_guard_limits limits_for(size_t size)
{
    double have = 0.9 * (double)sysconf(_SC_PHYS_PAGES) * (double)sysconf(_SC_PAGESIZE);
    double cpu = 20 + (double)size * 1e-6;
    return (dem_guard_limits){.memory = fmin(have, 1e9 + 50 * (double)size), .cpu = cpu, .wall = 60 + 3 * cpu};
}

static dem_status import_guarded(const dem_ctx *ctx, const char *name, const dem_import_source *source, size_t size,
                                 dem_import_outcome *outcome, dem_mesh *mesh, dem_error *error)
{
    dem_guard guard;
    DEM_TRY(dem_guard_start(&guard, ctx, limits_for(size), load_and_send, (void *)source, error));
    import_head head = {0};
    dem_status status = DEM_FAILED;
    if (dem_guard_read(&guard, &head, sizeof head) && head.mark == HEAD_MARK) {
        head.why[sizeof head.why - 1] = 0;
        *outcome = head.outcome;
        status = DEM_OK;
        if (head.outcome == DEM_IMPORT_REFUSED)
            status = refuse_in_words_of("assimp cannot read it:", head.why, name, error);
        else if (head.outcome == DEM_IMPORT_DONE)
            status = receive_mesh(&guard, &head, name, mesh, error);
    }
    const char *end = dem_guard_end(&guard);
    if (status == DEM_FAILED && guard.interrupted)
        status = dem_fail(error, DEM_INTERRUPTED, "interrupted while importing %s", name);
    else if (status == DEM_FAILED)
        status = refuse_in_words_of("assimp", end, name, error);
    if (status != DEM_OK)
        dem_mesh_free(mesh);
    return status;
}

// the suffix that content known by its first bytes should have; NULL: not known
static const char *suffix_by_content(const char *bytes, size_t size)
{
    static const struct {
        const char *words, *suffix;
        bool first;
    } signs[] = {
        {"glTF", "glb", true},        {"Kaydara FBX Binary", "fbx", true}, {"[Content_Types].xml", "3mf", false},
        {"3D/3dmodel", "3mf", false}, {"<COLLADA", "dae", false},          {"<amf", "amf", false},
        {"<X3D", "x3d", false},       {"\"asset\"", "gltf", false}};
    size_t look = size < LOOK_BYTES ? size : LOOK_BYTES;
    for (size_t i = 0; i < sizeof signs / sizeof *signs; i++) {
        size_t length = strlen(signs[i].words), starts = signs[i].first ? 1 : look;
        for (size_t at = 0; at < starts && at + length <= look; at++)
            if (memcmp(bytes + at, signs[i].words, length) == 0)
                return signs[i].suffix;
    }
    return NULL;
}

static bool is_our_suffix(const char *suffix)
{
    return strcasecmp(suffix, "stl") == 0 || strcasecmp(suffix, "obj") == 0 || strcasecmp(suffix, "ply") == 0 ||
           strcasecmp(suffix, "off") == 0;
}

// by path where assimp may know the suffix (a file may refer to others beside it), else by content
static dem_status import_other(const dem_ctx *ctx, const char *path, const char *name, const dem_buffer *bytes,
                               dem_mesh *mesh, dem_error *error)
{
    const char *dot = strrchr(dem_file_name(name), '.'), *suffix = dot ? dot + 1 : "";
    const char *content = suffix_by_content(bytes->data, bytes->size);
    dem_import_outcome outcome = DEM_IMPORT_UNKNOWN;
    if (!DEM_ASSIMP && content)
        return dem_fail_at(error, DEM_UNAVAILABLE, name, 0,
                           "this program was built without assimp, which reads %s; export "
                           "the mesh as STL, OBJ, PLY or OFF",
                           content);
    if (DEM_ASSIMP && path == name && *suffix && !is_our_suffix(suffix)) {
        dem_import_source source = {.path = path, .suffix = suffix};
        DEM_TRY(import_guarded(ctx, name, &source, bytes->size, &outcome, mesh, error));
    }
    if (outcome == DEM_IMPORT_UNKNOWN && content) {
        if (*suffix)
            dem_log(ctx, DEM_LOG_WARNING, "content is %s although the name ends in .%s; read as %s", content, suffix,
                    content);
        dem_import_source source = {.bytes = bytes->data, .size = bytes->size, .suffix = content};
        DEM_TRY(import_guarded(ctx, name, &source, bytes->size, &outcome, mesh, error));
    }
    if (outcome == DEM_IMPORT_UNKNOWN)
        return dem_mesh_refuse(name, bytes->data, bytes->size, supported, error);
    dem_mesh_warn_precision(ctx, mesh);
    return DEM_OK;
}

dem_status dem_mesh_import(const dem_ctx *ctx, const char *path, dem_mesh *mesh, dem_error *error)
{
    *mesh = (dem_mesh){0};
    dem_buffer bytes;
    DEM_TRY(dem_file_read(path, &bytes, error));
    const char *name = strcmp(path, "-") == 0 ? "standard input" : path;
    dem_mesh_format format = dem_mesh_sniff(name, bytes.data, bytes.size);
    if (format != DEM_FORMAT_UNKNOWN)
        return dem_mesh_read_bytes(ctx, name, format, &bytes, mesh, error);
    dem_ctx about = ctx ? *ctx : (dem_ctx){0};
    if (!about.subject)
        about.subject = name;
    dem_status status = import_other(&about, path, name, &bytes, mesh, error);
    dem_buffer_release(&bytes);
    return status;
}
