#include "rays_embree_scene.h"

#include "backend/instance_bounds.h"
#include "backend/ray_reach.h"

#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>

static void embree_error_callback(void *context, enum RTCError code, const char *text)
{
    RaysEmbree *rays = context;
    (void)code;
    if (rays->failure[0] == '\0')
        snprintf(rays->failure, sizeof rays->failure, "%s", text ? text : "unknown error");
}

static bool embree_memory_callback(void *context, ssize_t bytes, bool post)
{
    RaysEmbree *rays = context;
    (void)post;
    atomic_fetch_add(&rays->bytes, (long long)bytes);
    return true;
}

static void geometry_attach(RTCDevice device, RTCScene scene, uint count, void *user, RTCBoundsFunction bounds,
                            RTCIntersectFunctionN intersect, RTCOccludedFunctionN occluded)
{
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
    rtcSetGeometryUserPrimitiveCount(geometry, count);
    rtcSetGeometryUserData(geometry, user);
    rtcSetGeometryBoundsFunction(geometry, bounds, NULL);
    rtcSetGeometryIntersectFunction(geometry, intersect);
    rtcSetGeometryOccludedFunction(geometry, occluded);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene, geometry);
    rtcReleaseGeometry(geometry);
}

#ifdef TWINLIGHT_DOUBLE /* the host's hierarchy has only floats; Embree's boxes get a margin for all rays */

static bool outer_build(RaysEmbree *rays, const BackendScene *scene, Error *error)
{
    (void)scene;
    (void)error;
    rays->reach = rays->view.frame->scene.ray_reach;
    return true;
}

#else

static bool outer_build(RaysEmbree *rays, const BackendScene *scene, Error *error)
{
    rays->reach = ray_reach_inner(&rays->view, (uint)rays->instance_count);
    return !(rays->reach < rays->view.frame->scene.ray_reach) || bvh_build(scene, &rays->outer, error);
}

#endif

static void reaches_set(RaysEmbree *rays)
{
    float world = rays->reach;
    for (size_t i = 0; i < rays->object_count; ++i)
        rays->objects[i].reach = i == 0 ? world : 0.0f;
    for (size_t i = 0; i < rays->instance_count; ++i) {
        const Instance *instance = &rays->view.instances[i];
        float *reach = &rays->objects[instance->object].reach;
        *reach = float_max(*reach, instance_reach(instance, world));
    }
}

#ifdef TWINLIGHT_DOUBLE

static uint curve_pieces(const SceneView *view, uint first, uint left)
{
    (void)view;
    (void)first;
    (void)left;
    return 0;
}

static bool curves_build(ObjectRays *object, Object record, Error *error)
{
    (void)object;
    (void)record;
    (void)error;
    return true;
}

static void curves_attach(ObjectRays *object)
{
    (void)object;
}

static size_t curves_bytes(const ObjectRays *object)
{
    (void)object;
    return 0;
}

static void curves_free(ObjectRays *object)
{
    (void)object;
}

#else

/* The number of primitives in the cluster that begins with `first`, of `left` in its object; 0: it is in none. */
static uint curve_pieces(const SceneView *view, uint first, uint left)
{
    uint count = SCENE_HAS(view, FEATURE_CURVE) ? curve_cluster_count(view, first, left) : 0u;
    return count > 1u ? count : 0u;
}

static bool curves_build(ObjectRays *object, Object record, Error *error)
{
    const SceneView *view = &object->rays->view;
    uint end = record.first_primitive + record.primitive_count, clusters = 0, pieces;
    for (uint id = record.first_primitive; SCENE_HAS(view, FEATURE_CURVE) && id != end; id += pieces > 0u ? pieces : 1u)
        clusters += (pieces = curve_pieces(view, id, end - id)) > 0u;
    if (clusters == 0)
        return true;
    size_t bytes = clusters * sizeof *object->curves;
    object->curves = aligned_alloc(_Alignof(CurveCluster), bytes);
    if (!object->curves)
        return error_memory(error, bytes, "groups of curves");
    for (uint id = record.first_primitive; id != end; id += pieces > 0u ? pieces : 1u)
        if ((pieces = curve_pieces(view, id, end - id)) > 0u)
            curve_cluster_set(&object->curves[object->curve_count++], view, id, pieces, &object->box);
    return true;
}

static void curves_attach(ObjectRays *object)
{
    if (object->curve_count > 0)
        geometry_attach(object->rays->device, object->scene, object->curve_count, object, embree_curve_bounds,
                        embree_curve_intersect, embree_curve_occluded);
}

static size_t curves_bytes(const ObjectRays *object)
{
    return object->curve_count * sizeof *object->curves;
}

static void curves_free(ObjectRays *object)
{
    free(object->curves);
}

#endif

/* Splits the primitives that are not in curves' clusters into triangles, which are clustered, and others. `sorted` has
 * room for all. */
static bool others_sort(ObjectRays *object, Object record, uint *sorted, Error *error)
{
    const SceneView *view = &object->rays->view;
    uint triangles = 0, pieces;
    for (uint i = 0; i != record.primitive_count; i += pieces > 0u ? pieces : 1u) {
        uint id = record.first_primitive + i;
        pieces = curve_pieces(view, id, record.primitive_count - i);
        if (pieces > 0u)
            continue;
        bool triangle = view->primitives[id].shape_and_kind >> PRIMITIVE_KIND_SHIFT == PRIMITIVE_TRIANGLE;
        sorted[triangle ? triangles++ : record.primitive_count - ++object->other_count] = id;
        Box box = primitive_box(view, id);
        box_join(&object->box, &box);
    }
    object->others = malloc(((size_t)object->other_count + 1) * sizeof *object->others);
    if (!object->others)
        return error_memory(error, object->other_count * sizeof *object->others, "ray queries");
    memcpy(object->others, sorted + record.primitive_count - object->other_count,
           object->other_count * sizeof *object->others);
    return triangles == 0 || triangle_clusters_build(object->rays->device, view, sorted, triangles, &object->clusters,
                                                     &object->cluster_count, error);
}

static bool object_sort(ObjectRays *object, Object record, Error *error)
{
    uint *sorted = malloc(((size_t)record.primitive_count + 1) * sizeof *sorted);
    if (!sorted)
        return error_memory(error, record.primitive_count * sizeof *sorted, "ray queries");
    object->box = box_empty();
    bool sorted_all = curves_build(object, record, error) && others_sort(object, record, sorted, error);
    free(sorted);
    return sorted_all;
}

static bool object_build(RaysEmbree *rays, size_t index, Error *error)
{
    ObjectRays *object = &rays->objects[index];
    uint instances = index == 0 ? (uint)rays->instance_count : 0u;
    object->rays = rays;
    if (!object_sort(object, rays->view.objects[index], error))
        return false;
    if (box_is_empty(&object->box) && instances == 0)
        return true;
    object->scene = rtcNewScene(rays->device);
    rtcSetSceneBuildQuality(object->scene, RTC_BUILD_QUALITY_MEDIUM);
    if (object->cluster_count > 0)
        geometry_attach(rays->device, object->scene, object->cluster_count, object, embree_cluster_bounds,
                        embree_cluster_intersect, embree_cluster_occluded);
    curves_attach(object);
    if (object->other_count > 0)
        geometry_attach(rays->device, object->scene, object->other_count, object, embree_other_bounds,
                        embree_other_intersect, embree_other_occluded);
    if (instances > 0)
        geometry_attach(rays->device, object->scene, instances, rays, embree_instance_bounds, embree_instance_intersect,
                        embree_instance_occluded);
    rtcCommitScene(object->scene);
    return true;
}

/* Memory that Embree needs to build, per thread and per primitive. */
#define EMBREE_THREAD_BYTES ((size_t)8 << 20)
#define EMBREE_PRIMITIVE_BYTES ((size_t)200)

/* Embree may end the program when it runs out of memory, so this amount is mapped beforehand and unmapped again. */
static bool memory_probe(const RaysEmbree *rays, int threads, Error *error)
{
    size_t bytes = (size_t)threads * EMBREE_THREAD_BYTES;
    for (size_t i = 0; i < rays->object_count; ++i)
        bytes += EMBREE_PRIMITIVE_BYTES * rays->view.objects[i].primitive_count;
    void *room = mmap(NULL, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    if (room == MAP_FAILED)
        return error_memory(error, bytes, "ray queries");
    munmap(room, bytes);
    return true;
}

static void *thread_empty(void *nothing)
{
    return nothing;
}

/* Embree may also end the program if it cannot start a thread. */
static bool thread_probe(Error *error)
{
    pthread_t thread;
    if (pthread_create(&thread, NULL, thread_empty, NULL) == 0)
        return pthread_join(thread, NULL) == 0;
    error_set(error, "cannot start a thread");
    return error_fix(error, "end other programs, or raise the limit on processes: ulimit -u");
}

static bool rays_build(RaysEmbree *rays, const BackendScene *scene, int threads, Error *error)
{
    char config[64];
    snprintf(config, sizeof config, "threads=%d,set_affinity=0", threads);
    if (!thread_probe(error))
        return false;
    rays->device = rtcNewDevice(config);
    if (!rays->device) {
        int code = (int)rtcGetDeviceError(NULL);
        error_set(error, "cannot start Embree (error %d%s)", code,
                  code == RTC_ERROR_OUT_OF_MEMORY ? ", out of memory" : "");
        return error_fix(error, "use a machine with more memory, or raise the limit on address space: ulimit -v");
    }
    if (!memory_probe(rays, threads, error))
        return false;
    rtcSetDeviceErrorFunction(rays->device, embree_error_callback, rays);
    rtcSetDeviceMemoryMonitorFunction(rays->device, embree_memory_callback, rays);
    rays->objects = calloc(rays->object_count + 1, sizeof *rays->objects);
    if (!rays->objects)
        return error_memory(error, rays->object_count * sizeof *rays->objects, "ray queries");
    if (!outer_build(rays, scene, error))
        return false;
    reaches_set(rays);
    /* The world last: the bounds of its instances need those of their objects. */
    for (size_t i = rays->object_count; i-- > 0;)
        if (!object_build(rays, i, error))
            return false;
    if (rays->failure[0] != '\0')
        return error_set(error, "Embree cannot build its hierarchy: %s", rays->failure);
    return true;
}

RaysEmbree *rays_embree_create(const BackendScene *scene, int threads, Error *error)
{
    RaysEmbree *rays = calloc(1, sizeof *rays);
    if (!rays) {
        error_memory(error, sizeof *rays, "ray queries");
        return NULL;
    }
    rays->view = scene_view(scene->frame, scene->geometry, scene->tables, scene->texels);
    rays->object_count = scene->object_count;
    rays->instance_count = scene->instance_count;
    if (!rays_build(rays, scene, threads, error)) {
        rays_embree_destroy(rays);
        return NULL;
    }
    return rays;
}

void rays_embree_destroy(RaysEmbree *rays)
{
    if (!rays)
        return;
    for (size_t i = 0; rays->objects && i < rays->object_count; ++i) {
        if (rays->objects[i].scene)
            rtcReleaseScene(rays->objects[i].scene);
        free(rays->objects[i].clusters);
        curves_free(&rays->objects[i]);
        free(rays->objects[i].others);
    }
    if (rays->device)
        rtcReleaseDevice(rays->device);
    bvh_destroy(&rays->outer);
    free(rays->objects);
    free(rays);
}

/* What an object's callbacks read, of which Embree's memory monitor does not know. */
static size_t object_bytes(const ObjectRays *object)
{
    return sizeof *object + object->cluster_count * sizeof *object->clusters + curves_bytes(object) +
           object->other_count * sizeof *object->others;
}

size_t rays_embree_bytes(const RaysEmbree *rays)
{
    long long monitored = atomic_load(&((RaysEmbree *)(uintptr_t)rays)->bytes);
    size_t bytes = (monitored > 0 ? (size_t)monitored : 0) + rays->outer.word_count * sizeof *rays->outer.words;
    for (size_t i = 0; i < rays->object_count; ++i)
        bytes += object_bytes(&rays->objects[i]);
    return bytes;
}
