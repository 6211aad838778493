#include "mesh/import.h"

#include <stdio.h>
#include <string.h>

#if DEM_ASSIMP

#include <assimp/cimport.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include "base/memory.h"
#include "math/vec.h"

// the images of the axes, and of the origin
typedef struct placement {
    dem_vec3 x, y, z, origin;
} placement;

static dem_vec3 turned(const placement *p, dem_vec3 v)
{
    return v3_along(v3_along(v3_scale(p->x, v.x), v.y, p->y), v.z, p->z);
}

// assimp multiplies node matrices in 32 bits; here in double
static placement within(const placement *outer, const struct aiMatrix4x4 *m)
{
    placement p = {turned(outer, v3(m->a1, m->b1, m->c1)), turned(outer, v3(m->a2, m->b2, m->c2)),
                   turned(outer, v3(m->a3, m->b3, m->c3)), turned(outer, v3(m->a4, m->b4, m->c4))};
    p.origin = v3_add(p.origin, outer->origin);
    return p;
}

// counts while the arrays are missing, fills them otherwise
static void add_mesh(const struct aiMesh *from, const placement *p, dem_mesh *to)
{
    size_t first = to->vertex_count;
    to->vertex_count += from->mNumVertices;
    for (size_t i = 0; to->vertices && i < from->mNumVertices; i++) {
        struct aiVector3D v = from->mVertices[i];
        to->vertices[first + i] = v3_add(turned(p, v3(v.x, v.y, v.z)), p->origin);
    }
    bool mirrored = v3_dot(v3_cross(p->x, p->y), p->z) < 0;
    for (size_t i = 0; i < from->mNumFaces; i++) {
        if (from->mFaces[i].mNumIndices != 3)
            continue;  // points and lines
        uint32_t *corner = to->triangles ? to->triangles + 3 * to->triangle_count : NULL;
        to->triangle_count++;
        for (size_t k = 0; corner && k < 3; k++)
            corner[mirrored ? 2 - k : k] = from->mFaces[i].mIndices[k] < from->mNumVertices
                                               ? (uint32_t)first + from->mFaces[i].mIndices[k]
                                               : UINT32_MAX;  // for the caller to refuse
    }
}

static void add_node(const struct aiScene *scene, const struct aiNode *node, const placement *outer, dem_mesh *to)
{
    placement p = within(outer, &node->mTransformation);
    for (size_t i = 0; i < node->mNumMeshes; i++)
        add_mesh(scene->mMeshes[node->mMeshes[i]], &p, to);
    for (size_t i = 0; i < node->mNumChildren; i++)
        add_node(scene, node->mChildren[i], &p, to);
}

static dem_import_outcome join(const struct aiScene *scene, dem_mesh *mesh, char *why, size_t why_size)
{
    static const placement here = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, 0}};
    dem_mesh counts = {0};
    add_node(scene, scene->mRootNode, &here, &counts);
    if (counts.triangle_count == 0) {
        snprintf(why, why_size, "no triangles in it");
        return DEM_IMPORT_REFUSED;
    }
    mesh->vertices = dem_alloc(counts.vertex_count, sizeof *mesh->vertices);
    mesh->triangles = dem_alloc(counts.triangle_count, 3 * sizeof *mesh->triangles);
    if (counts.vertex_count > UINT32_MAX || !mesh->vertices || !mesh->triangles) {
        snprintf(why, why_size, "more triangles than memory holds");
        return DEM_IMPORT_REFUSED;
    }
    add_node(scene, scene->mRootNode, &here, mesh);
    return DEM_IMPORT_DONE;
}

dem_import_outcome dem_assimp_load(const dem_import_source *source, dem_mesh *mesh, char *why, size_t why_size)
{
    char suffix[32];
    snprintf(suffix, sizeof suffix, ".%s", source->suffix);
    if (!aiIsExtensionSupported(suffix))
        return DEM_IMPORT_UNKNOWN;
    // not aiProcess_JoinIdenticalVertices: its tolerance is absolute and would melt a grain of micrometres
    unsigned flags = aiProcess_Triangulate | aiProcess_SortByPType;
    const struct aiScene *scene = NULL;
    if (source->path)
        scene = aiImportFile(source->path, flags);
    else if (source->size <= UINT32_MAX)
        scene = aiImportFileFromMemory(source->bytes, (unsigned)source->size, flags, source->suffix);
    if (!scene || !scene->mRootNode) {
        const char *text = aiGetErrorString();
        if (text && strncmp(text, "No suitable reader", 18) == 0)
            snprintf(why, why_size, "no %s file, or damaged at its start", suffix);
        else
            snprintf(why, why_size, "%s", text && *text ? text : "no scene in it");
        return DEM_IMPORT_REFUSED;
    }
    dem_import_outcome outcome = join(scene, mesh, why, why_size);
    aiReleaseImport(scene);
    return outcome;
}

#else

dem_import_outcome dem_assimp_load(const dem_import_source *source, dem_mesh *mesh, char *why, size_t why_size)
{
    (void)source, (void)mesh, (void)why, (void)why_size;
    return DEM_IMPORT_UNKNOWN;
}

#endif
