#include <embree3/rtcore.h> /* before any shared header: its floats are floats in every build */

#include "rays_embree.h"

#include "backend/bvh.h"
#include "backend/instance_bounds.h"
#include "backend/ray_reach.h"
#include "geometry/media_walk.h"
#include "geometry/primitive.h"
#include "layout/state.h"
#include "triangle_cluster.h"

#ifndef TWINLIGHT_DOUBLE /* boxes of pieces have only floats; in double, Embree sees each piece */
#include "curve_cluster.h"
#endif

#include <pthread.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>

/* The hierarchy of one Object. */
typedef struct ObjectRays {
    const RaysEmbree *rays;
    RTCScene scene;
    TriangleCluster *clusters; /* triangles */
    uint cluster_count;
#ifndef TWINLIGHT_DOUBLE
    CurveCluster *curves;
    uint curve_count;
#endif
    uint *others; /* primitives of other kinds */
    uint other_count;
    float reach; /* largest coordinate of ray origins, in the space of the object */
    Box box; /* without margin */
} ObjectRays;

struct RaysEmbree {
    RTCDevice device;
    SceneView view;
    ObjectRays *objects; /* [0]: the world */
    size_t object_count;
    size_t instance_count;
    float reach; /* largest coordinate of the origins of rays for Embree, in the world */
    Bvh outer; /* for rays from further out; empty where there are none */
    atomic_llong bytes;
    char failure[256]; /* Embree's first complaint */
};

/* What the callbacks reach through the context that Embree passes on. The hit is kept here and not in Embree's record;
 * Embree only learns the new end of the ray. */
typedef struct RayWalk {
    struct RTCIntersectContext context; /* first, so that Embree's pointer to it also points to the walk */
    const RaysEmbree *rays;
    const Ray *ray; /* NULL once `query` is made from it: many rays hit no box and never need one */
    RayQuery query;
#ifndef TWINLIGHT_DOUBLE
    BvhRay boxes; /* the ray for boxes of curves' pieces, if has_boxes */
    bool has_boxes;
#endif
    float t_scale; /* Embree's t over ours: embree_ray */
    uint instance;
    Hit best;
} RayWalk;

/* Embree replaces components of a direction below 10^-18 by that number, so a very short direction is scaled up by a
 * power of two, and t down: exact, and by 1 for nearly all rays. */
#define SHORT_DIRECTION 0x1p-40f
#define SHORT_STRETCH 0x1p100f

/* ---- callbacks --------------------------------------------------------------------------------------------------- */

static const RayQuery *walk_query(RayWalk *walk)
{
    if (walk->ray) {
        walk->query = ray_query(*walk->ray);
        walk->ray = NULL;
    }
    return &walk->query;
}

static struct RTCBounds embree_bounds(Box box)
{
    return (struct RTCBounds){.lower_x = box.low[0],
                              .lower_y = box.low[1],
                              .lower_z = box.low[2],
                              .upper_x = box.high[0],
                              .upper_y = box.high[1],
                              .upper_z = box.high[2]};
}

static void cluster_bounds_callback(const struct RTCBoundsFunctionArguments *args)
{
    const ObjectRays *object = args->geometryUserPtr;
    Box box = triangle_cluster_box(&object->clusters[args->primID]);
    *args->bounds_o = embree_bounds(box_inflate(box, box_margin(&box, object->reach)));
}

static void cluster_intersect_callback(const struct RTCIntersectFunctionNArguments *args)
{
    const ObjectRays *object = args->geometryUserPtr;
    RayWalk *walk = (RayWalk *)args->context;
    if (triangle_cluster_intersect(&object->rays->view, &object->clusters[args->primID], walk->instance,
                                   walk_query(walk), &walk->best))
        ((struct RTCRayHit *)args->rayhit)->ray.tfar = walk->best.t * walk->t_scale;
}

static void cluster_occluded_callback(const struct RTCOccludedFunctionNArguments *args)
{
    const ObjectRays *object = args->geometryUserPtr;
    RayWalk *walk = (RayWalk *)args->context;
    if (triangle_cluster_occludes(&object->rays->view, &object->clusters[args->primID], walk_query(walk)))
        ((struct RTCRay *)args->ray)->tfar = -INFINITY;
}

#ifndef TWINLIGHT_DOUBLE

static const BvhRay *walk_boxes(RayWalk *walk)
{
    const RayQuery *query = walk_query(walk);
    if (!walk->has_boxes) {
        walk->boxes = bvh_ray(query->o, query->d, BOX_ULPS);
        walk->has_boxes = true;
    }
    return &walk->boxes;
}

static void curve_bounds_callback(const struct RTCBoundsFunctionArguments *args)
{
    const ObjectRays *object = args->geometryUserPtr;
    Box box = curve_cluster_box(&object->curves[args->primID]);
    *args->bounds_o = embree_bounds(box_inflate(box, box_margin(&box, object->reach)));
}

static void curve_intersect_callback(const struct RTCIntersectFunctionNArguments *args)
{
    const ObjectRays *object = args->geometryUserPtr;
    RayWalk *walk = (RayWalk *)args->context;
    const BvhRay *boxes = walk_boxes(walk);
    if (curve_cluster_intersect(&object->rays->view, &object->curves[args->primID], walk->instance, &walk->query, boxes,
                                &walk->best))
        ((struct RTCRayHit *)args->rayhit)->ray.tfar = walk->best.t * walk->t_scale;
}

static void curve_occluded_callback(const struct RTCOccludedFunctionNArguments *args)
{
    const ObjectRays *object = args->geometryUserPtr;
    RayWalk *walk = (RayWalk *)args->context;
    const BvhRay *boxes = walk_boxes(walk);
    if (curve_cluster_occludes(&object->rays->view, &object->curves[args->primID], &walk->query, boxes))
        ((struct RTCRay *)args->ray)->tfar = -INFINITY;
}

#endif

static void other_bounds_callback(const struct RTCBoundsFunctionArguments *args)
{
    const ObjectRays *object = args->geometryUserPtr;
    Box box = primitive_box(&object->rays->view, object->others[args->primID]);
    *args->bounds_o = embree_bounds(box_inflate(box, box_margin(&box, object->reach)));
}

static void other_intersect_callback(const struct RTCIntersectFunctionNArguments *args)
{
    const ObjectRays *object = args->geometryUserPtr;
    RayWalk *walk = (RayWalk *)args->context;
    if (primitive_intersect(&object->rays->view, object->others[args->primID], walk->instance, walk_query(walk),
                            &walk->best))
        ((struct RTCRayHit *)args->rayhit)->ray.tfar = walk->best.t * walk->t_scale;
}

static void other_occluded_callback(const struct RTCOccludedFunctionNArguments *args)
{
    const ObjectRays *object = args->geometryUserPtr;
    RayWalk *walk = (RayWalk *)args->context;
    if (primitive_occludes(&object->rays->view, object->others[args->primID], walk_query(walk)))
        ((struct RTCRay *)args->ray)->tfar = -INFINITY;
}

/* The ray, up to walk->best.t, in Embree's format. */
static struct RTCRay embree_ray(RayWalk *walk, Vec3 o, Vec3 d)
{
    bool is_short = vec3_max_abs(d) < SHORT_DIRECTION;
    float stretch = is_short ? SHORT_STRETCH : 1.0f;
    walk->t_scale = is_short ? 1.0f / SHORT_STRETCH : 1.0f;
    return (struct RTCRay){.org_x = o.x,
                           .org_y = o.y,
                           .org_z = o.z,
                           .dir_x = d.x * stretch,
                           .dir_y = d.y * stretch,
                           .dir_z = d.z * stretch,
                           .tnear = 0.0f,
                           .tfar = walk->best.t * walk->t_scale,
                           .mask = 0xffffffffu};
}

static void instance_bounds_callback(const struct RTCBoundsFunctionArguments *args)
{
    const RaysEmbree *rays = args->geometryUserPtr;
    const Instance *instance = &rays->view.instances[args->primID];
    const ObjectRays *object = &rays->objects[instance->object];
    Box box = {{0.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 0.0f}};
    if (object->scene) {
        InstanceBounds bounds = instance_bounds(instance, &object->box);
        box = box_inflate(bounds.box, instance_margin(&bounds, rays->objects[0].reach));
    }
    *args->bounds_o = embree_bounds(box);
}

/* The walk through an instance's object: the ray in its space, starting with the best hit so far. */
static RayWalk walk_enter(RayWalk *outer, uint instance)
{
    RayWalk inner;
    rtcInitIntersectContext(&inner.context);
    inner.rays = outer->rays;
    inner.ray = NULL;
#ifndef TWINLIGHT_DOUBLE
    inner.has_boxes = false;
#endif
    inner.query = ray_query_transform(outer->rays->view.instances[instance].object_from_world, walk_query(outer));
    inner.instance = instance;
    inner.best = outer->best;
    return inner;
}

static void instance_intersect_callback(const struct RTCIntersectFunctionNArguments *args)
{
    const RaysEmbree *rays = args->geometryUserPtr;
    const ObjectRays *object = &rays->objects[rays->view.instances[args->primID].object];
    RayWalk *outer = (RayWalk *)args->context;
    if (!object->scene)
        return;
    RayWalk inner = walk_enter(outer, args->primID);
    if (!ray_traceable(inner.query.o, inner.query.d))
        return;
    struct RTCRayHit rayhit = {.ray = embree_ray(&inner, inner.query.o, inner.query.d)};
    rtcIntersect1(object->scene, &inner.context, &rayhit);
    outer->best = inner.best;
    ((struct RTCRayHit *)args->rayhit)->ray.tfar = outer->best.t * outer->t_scale;
}

static void instance_occluded_callback(const struct RTCOccludedFunctionNArguments *args)
{
    const RaysEmbree *rays = args->geometryUserPtr;
    const ObjectRays *object = &rays->objects[rays->view.instances[args->primID].object];
    if (!object->scene)
        return;
    RayWalk inner = walk_enter((RayWalk *)args->context, args->primID);
    if (!ray_traceable(inner.query.o, inner.query.d))
        return;
    struct RTCRay ray = embree_ray(&inner, inner.query.o, inner.query.d);
    rtcOccluded1(object->scene, &inner.context, &ray);
    if (ray.tfar < 0.0f)
        ((struct RTCRay *)args->ray)->tfar = -INFINITY;
}

/* ---- building ---------------------------------------------------------------------------------------------------- */

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

static Hit outer_walk(const RaysEmbree *rays, const Ray *ray, bool any)
{
    (void)rays;
    (void)any;
    return hit_none(ray->t_max); /* no ray is an outer one */
}

#else

static bool outer_build(RaysEmbree *rays, const BackendScene *scene, Error *error)
{
    rays->reach = ray_reach_inner(&rays->view, (uint)rays->instance_count);
    return !(rays->reach < rays->view.frame->scene.ray_reach) || bvh_build(scene, &rays->outer, error);
}

static Hit outer_walk(const RaysEmbree *rays, const Ray *ray, bool any)
{
    return bvh_walk(&rays->view, rays->outer.words, *ray, any);
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
        geometry_attach(object->rays->device, object->scene, object->curve_count, object, curve_bounds_callback,
                        curve_intersect_callback, curve_occluded_callback);
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

/* Splits the primitives that are not in curves' clusters into triangles, which are clustered, and others. `sorted` has room for
 * all. */
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
        geometry_attach(rays->device, object->scene, object->cluster_count, object, cluster_bounds_callback,
                        cluster_intersect_callback, cluster_occluded_callback);
    curves_attach(object);
    if (object->other_count > 0)
        geometry_attach(rays->device, object->scene, object->other_count, object, other_bounds_callback,
                        other_intersect_callback, other_occluded_callback);
    if (instances > 0)
        geometry_attach(rays->device, object->scene, instances, rays, instance_bounds_callback,
                        instance_intersect_callback, instance_occluded_callback);
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

/* ---- ray queries ------------------------------------------------------------------------------------------------- */

static inline void walk_begin(RayWalk *walk, const RaysEmbree *rays, const Ray *ray)
{
    rtcInitIntersectContext(&walk->context);
    walk->rays = rays;
    walk->ray = ray;
#ifndef TWINLIGHT_DOUBLE
    walk->has_boxes = false;
#endif
    walk->instance = NONE;
    walk->best = hit_none(ray->t_max);
}

/* Whether the ray starts beyond the reach of Embree's margins. The choice affects no bit: both traversals find the hits
 * of the shared primitive test. */
static inline bool ray_is_outer(const RaysEmbree *rays, const Ray *ray)
{
    return rays->outer.words && vec3_max_abs(ray->o) > rays->reach;
}

/* Inlined into the loop over the rays of a chunk. */
__attribute__((always_inline)) static inline Hit ray_closest(const RaysEmbree *rays, const Ray *ray)
{
    RayWalk walk;
    if (ray_is_outer(rays, ray))
        return outer_walk(rays, ray, false);
    walk_begin(&walk, rays, ray);
    if (rays->object_count == 0 || !rays->objects[0].scene || !ray_traceable(ray->o, ray->d))
        return walk.best;
    struct RTCRayHit rayhit = {.ray = embree_ray(&walk, ray->o, ray->d)};
    rtcIntersect1(rays->objects[0].scene, &walk.context, &rayhit);
    return walk.best;
}

Hit rays_embree_closest(const RaysEmbree *rays, const Ray *ray)
{
    return ray_closest(rays, ray);
}

bool rays_embree_occluded(const RaysEmbree *rays, const Ray *ray)
{
    RayWalk walk;
    if (ray_is_outer(rays, ray))
        return outer_walk(rays, ray, true).primitive != NONE;
    if (rays->object_count == 0 || !rays->objects[0].scene || !ray_traceable(ray->o, ray->d))
        return false;
    walk_begin(&walk, rays, ray);
    struct RTCRay asked = embree_ray(&walk, ray->o, ray->d);
    rtcOccluded1(rays->objects[0].scene, &walk.context, &asked);
    return asked.tfar < 0.0f;
}

/* rays_embree_closest through media (geometry/media_walk.h). Not inlined: other scenes do not pay for it. */
__attribute__((noinline)) static Hit media_closest(const RaysEmbree *rays, const uint *ray_words, uint *hit_words,
                                                   uint *diagnostics, uint stride, uint item, Ray ray)
{
    MediaWalk walk = media_walk_load(&rays->view, ray_words, stride, item);
    Hit hit;
    do
        hit = rays_embree_closest(rays, &ray);
    while (media_walk_on(&rays->view, &ray, &hit, &walk));
    media_walk_end(hit_words, diagnostics, stride, item, ray, &walk, &hit);
    return hit;
}

__attribute__((noinline)) static void media_shadow(const RaysEmbree *rays, uint *shadow_words, uint *diagnostics,
                                                   uint stride, uint item, Ray ray)
{
    MediaWalk walk = media_walk_begin(state_load(shadow_words, stride, SHADOW_MEDIUM, item));
    Hit hit;
    do
        hit = rays_embree_closest(rays, &ray);
    while (media_walk_on(&rays->view, &ray, &hit, &walk));
    shadow_walk_end(shadow_words, diagnostics, stride, item, &walk, &hit);
}

uint rays_embree_trace_closest(const RaysEmbree *rays, const uint *ray_words, uint *hit_words, uint *diagnostics,
                               const uint *items, uint count, uint stride)
{
    bool media = SCENE_HAS(&rays->view, FEATURE_MEDIUM);
    uint traced = 0;
    for (uint i = 0; i < count; ++i) {
        uint item = items ? items[i] : i;
        Ray ray = ray_load(ray_words, stride, item);
        if (!(ray.t_max > 0.0f))
            continue;
        hit_store(hit_words, stride, item,
                  media ? media_closest(rays, ray_words, hit_words, diagnostics, stride, item, ray)
                        : ray_closest(rays, &ray));
        ++traced;
    }
    return traced;
}

uint rays_embree_trace_shadow(const RaysEmbree *rays, uint *shadow_words, uint *diagnostics, uint count, uint stride)
{
    bool media = SCENE_HAS(&rays->view, FEATURE_MEDIUM);
    uint traced = 0;
    for (uint item = 0; item < count; ++item) {
        Ray ray = ray_load(shadow_words, stride, item);
        if (!(ray.t_max > 0.0f))
            continue;
        if (media)
            media_shadow(rays, shadow_words, diagnostics, stride, item, ray);
        else
            state_store(shadow_words, stride, SHADOW_OCCLUDED, item, rays_embree_occluded(rays, &ray) ? 1u : 0u);
        ++traced;
    }
    return traced;
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
