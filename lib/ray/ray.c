#include "ray/ray.h"

#include <stdlib.h>

#include "base/memory.h"
#include "math/vec.h"

#if DEM_EMBREE

#if DEM_EMBREE >= 4
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

typedef struct shape {
    RTCScene scene;
    dem_vec3 origin;
    double scale;
    dem_box box;  // of the rounded vertices, in the shape's own frame; empty for balls
} shape;

struct dem_ray_scene {
    RTCDevice device;
    RTCScene scene;
    shape *shapes;
    size_t shape_count, shape_capacity;
};

// what Embree has to say since it was last asked
static dem_status outcome(const dem_ray_scene *scene, dem_error *error)
{
    enum RTCError code = rtcGetDeviceError(scene->device);
    if (code == RTC_ERROR_NONE)
        return DEM_OK;
    if (code == RTC_ERROR_OUT_OF_MEMORY)
        return dem_fail_memory(error);
    return dem_fail(error, DEM_FAILED, "the ray tracer failed (Embree error %d); leave out pictures and mesh walls",
                    (int)code);
}

dem_status dem_ray_create(dem_ray_scene **scene, dem_error *error)
{
    *scene = dem_alloc_zero(1, sizeof **scene);
    if (!*scene)
        return dem_fail_memory(error);
    // scenes here are built in milliseconds; a pool of threads would cost more memory than it saves time
    (*scene)->device = rtcNewDevice("threads=1");
    if (!(*scene)->device) {
        int code = (int)rtcGetDeviceError(NULL);
        free(*scene);
        *scene = NULL;
        return dem_fail(error, DEM_FAILED, "Embree does not start here (error %d); leave out pictures and mesh walls",
                        code);
    }
    (*scene)->scene = rtcNewScene((*scene)->device);
    return outcome(*scene, error);
}

void dem_ray_destroy(dem_ray_scene *scene)
{
    if (!scene)
        return;
    for (size_t i = 0; i < scene->shape_count; i++)
        rtcReleaseScene(scene->shapes[i].scene);
    rtcReleaseScene(scene->scene);
    rtcReleaseDevice(scene->device);
    free(scene->shapes);
    free(scene);
}

// takes over `geometry`
static dem_status add_shape(dem_ray_scene *scene, RTCGeometry geometry, shape added, dem_error *error)
{
    dem_status status = outcome(scene, error);
    if (status == DEM_OK &&
        !dem_grow(&scene->shapes, &scene->shape_capacity, scene->shape_count, sizeof *scene->shapes))
        status = dem_fail_memory(error);
    if (status == DEM_OK) {
        added.scene = rtcNewScene(scene->device);
        scene->shapes[scene->shape_count++] = added;
        rtcSetSceneFlags(added.scene, RTC_SCENE_FLAG_ROBUST);
        rtcCommitGeometry(geometry);
        rtcAttachGeometry(added.scene, geometry);
        rtcCommitScene(added.scene);
        status = outcome(scene, error);
    }
    rtcReleaseGeometry(geometry);
    return status;
}

static void put_local(float *at, dem_vec3 x, dem_vec3 origin, double scale)
{
    at[0] = (float)((x.x - origin.x) * scale);
    at[1] = (float)((x.y - origin.y) * scale);
    at[2] = (float)((x.z - origin.z) * scale);
}

dem_status dem_ray_add_mesh(dem_ray_scene *scene, const dem_vec3 *vertices, size_t vertex_count,
                            const uint32_t *triangles, size_t triangle_count, dem_vec3 origin, double scale,
                            dem_error *error)
{
    RTCGeometry geometry = rtcNewGeometry(scene->device, RTC_GEOMETRY_TYPE_TRIANGLE);
    float *corners = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float),
                                             vertex_count);
    uint32_t *indices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                                3 * sizeof(uint32_t), triangle_count);
    shape added = {.origin = origin, .scale = scale, .box = box_empty()};
    if (corners && indices) {
        for (size_t i = 0; i < vertex_count; i++) {
            float *at = corners + 3 * i;
            put_local(at, vertices[i], origin, scale);
            added.box = box_with(added.box, v3((double)at[0], (double)at[1], (double)at[2]));
        }
        for (size_t i = 0; i < 3 * triangle_count; i++)
            indices[i] = triangles[i];
    }
    return add_shape(scene, geometry, added, error);
}

dem_status dem_ray_add_balls(dem_ray_scene *scene, const dem_ball *balls, size_t count, dem_vec3 origin, double scale,
                             dem_error *error)
{
    RTCGeometry geometry = rtcNewGeometry(scene->device, RTC_GEOMETRY_TYPE_SPHERE_POINT);
    float *points =
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4, 4 * sizeof(float), count);
    for (size_t i = 0; points && i < count; i++) {
        put_local(points + 4 * i, balls[i].centre, origin, scale);
        points[4 * i + 3] = (float)(balls[i].radius * scale);
    }
    return add_shape(scene, geometry, (shape){.origin = origin, .scale = scale, .box = box_empty()}, error);
}

dem_status dem_ray_add_instance(dem_ray_scene *scene, uint32_t number, const dem_ray_pose *pose, dem_error *error)
{
    DEM_ASSERT(number < scene->shape_count);
    RTCGeometry instance = rtcNewGeometry(scene->device, RTC_GEOMETRY_TYPE_INSTANCE);
    rtcSetGeometryInstancedScene(instance, scene->shapes[number].scene);
    rtcSetGeometryTransform(instance, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, pose);
    rtcCommitGeometry(instance);
    rtcAttachGeometry(scene->scene, instance);
    rtcReleaseGeometry(instance);
    return outcome(scene, error);
}

dem_status dem_ray_commit(dem_ray_scene *scene, dem_error *error)
{
    rtcSetSceneFlags(scene->scene, RTC_SCENE_FLAG_ROBUST);
    rtcCommitScene(scene->scene);
    return outcome(scene, error);
}

static struct RTCRay embree_ray(const dem_ray *ray)
{
    return (struct RTCRay){.org_x = ray->origin[0],
                           .org_y = ray->origin[1],
                           .org_z = ray->origin[2],
                           .tnear = ray->near,
                           .dir_x = ray->direction[0],
                           .dir_y = ray->direction[1],
                           .dir_z = ray->direction[2],
                           .tfar = ray->far,
                           .mask = ~0u};
}

bool dem_ray_closest(const dem_ray_scene *scene, const dem_ray *ray, dem_ray_hit *hit)
{
    struct RTCRayHit query = {.ray = embree_ray(ray)};
    query.hit.geomID = query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
#if DEM_EMBREE >= 4
    rtcIntersect1(scene->scene, &query, NULL);
#else
    struct RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcIntersect1(scene->scene, &context, &query);
#endif
    if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID)
        return false;
    *hit = (dem_ray_hit){query.ray.tfar, query.hit.u, query.hit.v, query.hit.instID[0], query.hit.primID};
    return true;
}

bool dem_ray_occluded(const dem_ray_scene *scene, const dem_ray *ray)
{
    struct RTCRay query = embree_ray(ray);
#if DEM_EMBREE >= 4
    rtcOccluded1(scene->scene, &query, NULL);
#else
    struct RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcOccluded1(scene->scene, &context, &query);
#endif
    return query.tfar < 0;  // Embree marks an occluded ray by -infinity
}

typedef struct collection {
    dem_ray_list *list;
    bool failed;
} collection;

// false: go on with the same radius
static bool collect(struct RTCPointQueryFunctionArguments *found)
{
    collection *c = found->userPtr;
    dem_ray_list *list = c->list;
    if (!dem_grow(&list->items, &list->capacity, list->count, sizeof *list->items))
        c->failed = true;
    else
        list->items[list->count++] = found->primID;
    return false;
}

// The sphere in floats that meets all of a shape that the sphere asked for meets. Its centre is brought into the
// shape's box, so that a far point loses no digits: what lies in a box is no farther from the nearest point of the box
// than a right angle there allows, reach^2 = radius^2 - outside^2. False: the sphere stays out of the box.
static bool query_sphere(const shape *s, dem_vec3 point, double radius, struct RTCPointQuery *query)
{
    const double ulp = 0x1p-24;  // largest relative error of rounding to float
    dem_vec3 local = v3_scale(v3_sub(point, s->origin), s->scale);
    dem_vec3 centre = v3_max(s->box.low, v3_min(s->box.high, local));
    dem_vec3 far = v3_max(s->box.high, v3_scale(s->box.low, -1));
    double extent = fmax(far.x, fmax(far.y, far.z)), outside = v3_distance(local, centre);
    // each vertex has moved by up to sqrt(3) ulp extent; the double numbers are good to a few 2^-53 of their size
    double r = radius * s->scale + 2 * ulp * extent + 0x1p-50 * (extent + outside), slack = r - outside;
    if (!(slack >= 0))
        return false;
    double reach = fmin(sqrt(slack * (r + outside)), box_diagonal(s->box));
    // the centre is rounded like the vertices, and the tracer rounds differences, squares and sums: 4 ulp at the most
    reach = (reach + 2 * ulp * extent) * (1 + 8 * ulp) + 0x1p-100;
    *query = (struct RTCPointQuery){(float)centre.x, (float)centre.y, (float)centre.z, 0, (float)reach};
    return true;
}

bool dem_ray_near(const dem_ray_scene *scene, uint32_t number, dem_vec3 point, double radius, dem_ray_list *list)
{
    DEM_ASSERT(number < scene->shape_count);
    const shape *s = &scene->shapes[number];
    struct RTCPointQuery query;
    list->count = 0;
    if (!query_sphere(s, point, radius, &query))
        return true;
    struct RTCPointQueryContext context;
    rtcInitPointQueryContext(&context);
    collection c = {list, false};
    rtcPointQuery(s->scene, &query, &context, collect, &c);
    return !c.failed;
}

#else

dem_status dem_ray_create(dem_ray_scene **scene, dem_error *error)
{
    *scene = NULL;
    return dem_fail(error, DEM_UNAVAILABLE,
                    "built without Embree, which pictures and mesh walls need; build with -DDEM_EMBREE=ON");
}

void dem_ray_destroy(dem_ray_scene *scene)
{
    (void)scene;
}

dem_status dem_ray_add_mesh(dem_ray_scene *scene, const dem_vec3 *vertices, size_t vertex_count,
                            const uint32_t *triangles, size_t triangle_count, dem_vec3 origin, double scale,
                            dem_error *error)
{
    (void)scene, (void)vertices, (void)vertex_count, (void)triangles, (void)triangle_count, (void)origin, (void)scale;
    return dem_fail(error, DEM_UNAVAILABLE, "built without Embree");
}

dem_status dem_ray_add_balls(dem_ray_scene *scene, const dem_ball *balls, size_t count, dem_vec3 origin, double scale,
                             dem_error *error)
{
    (void)scene, (void)balls, (void)count, (void)origin, (void)scale;
    return dem_fail(error, DEM_UNAVAILABLE, "built without Embree");
}

dem_status dem_ray_add_instance(dem_ray_scene *scene, uint32_t shape, const dem_ray_pose *pose, dem_error *error)
{
    (void)scene, (void)shape, (void)pose;
    return dem_fail(error, DEM_UNAVAILABLE, "built without Embree");
}

dem_status dem_ray_commit(dem_ray_scene *scene, dem_error *error)
{
    (void)scene;
    return dem_fail(error, DEM_UNAVAILABLE, "built without Embree");
}

bool dem_ray_closest(const dem_ray_scene *scene, const dem_ray *ray, dem_ray_hit *hit)
{
    (void)scene, (void)ray, (void)hit;
    return false;
}

bool dem_ray_occluded(const dem_ray_scene *scene, const dem_ray *ray)
{
    (void)scene, (void)ray;
    return false;
}

bool dem_ray_near(const dem_ray_scene *scene, uint32_t shape, dem_vec3 point, double radius, dem_ray_list *list)
{
    (void)scene, (void)shape, (void)point, (void)radius;
    list->count = 0;
    return true;
}

#endif
