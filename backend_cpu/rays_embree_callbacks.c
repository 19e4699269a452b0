/* What Embree calls while it builds its hierarchies and walks them: boxes with a margin, and the shared primitive
 * test. */
#include "rays_embree_scene.h"

#include "backend/instance_bounds.h"

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

void embree_cluster_bounds(const struct RTCBoundsFunctionArguments *args)
{
    const ObjectRays *object = args->geometryUserPtr;
    Box box = triangle_cluster_box(&object->clusters[args->primID]);
    *args->bounds_o = embree_bounds(box_inflate(box, box_margin(&box, object->reach)));
}

void embree_cluster_intersect(const struct RTCIntersectFunctionNArguments *args)
{
    const ObjectRays *object = args->geometryUserPtr;
    RayWalk *walk = (RayWalk *)args->context;
    if (triangle_cluster_intersect(&object->rays->view, &object->clusters[args->primID], walk->instance,
                                   walk_query(walk), &walk->best))
        ((struct RTCRayHit *)args->rayhit)->ray.tfar = walk->best.t * walk->t_scale;
}

void embree_cluster_occluded(const struct RTCOccludedFunctionNArguments *args)
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

void embree_curve_bounds(const struct RTCBoundsFunctionArguments *args)
{
    const ObjectRays *object = args->geometryUserPtr;
    Box box = curve_cluster_box(&object->curves[args->primID]);
    *args->bounds_o = embree_bounds(box_inflate(box, box_margin(&box, object->reach)));
}

void embree_curve_intersect(const struct RTCIntersectFunctionNArguments *args)
{
    const ObjectRays *object = args->geometryUserPtr;
    RayWalk *walk = (RayWalk *)args->context;
    const BvhRay *boxes = walk_boxes(walk);
    if (curve_cluster_intersect(&object->rays->view, &object->curves[args->primID], walk->instance, &walk->query, boxes,
                                &walk->best))
        ((struct RTCRayHit *)args->rayhit)->ray.tfar = walk->best.t * walk->t_scale;
}

void embree_curve_occluded(const struct RTCOccludedFunctionNArguments *args)
{
    const ObjectRays *object = args->geometryUserPtr;
    RayWalk *walk = (RayWalk *)args->context;
    const BvhRay *boxes = walk_boxes(walk);
    if (curve_cluster_occludes(&object->rays->view, &object->curves[args->primID], &walk->query, boxes))
        ((struct RTCRay *)args->ray)->tfar = -INFINITY;
}

#endif

void embree_other_bounds(const struct RTCBoundsFunctionArguments *args)
{
    const ObjectRays *object = args->geometryUserPtr;
    Box box = primitive_box(&object->rays->view, object->others[args->primID]);
    *args->bounds_o = embree_bounds(box_inflate(box, box_margin(&box, object->reach)));
}

void embree_other_intersect(const struct RTCIntersectFunctionNArguments *args)
{
    const ObjectRays *object = args->geometryUserPtr;
    RayWalk *walk = (RayWalk *)args->context;
    if (primitive_intersect(&object->rays->view, object->others[args->primID], walk->instance, walk_query(walk),
                            &walk->best))
        ((struct RTCRayHit *)args->rayhit)->ray.tfar = walk->best.t * walk->t_scale;
}

void embree_other_occluded(const struct RTCOccludedFunctionNArguments *args)
{
    const ObjectRays *object = args->geometryUserPtr;
    RayWalk *walk = (RayWalk *)args->context;
    if (primitive_occludes(&object->rays->view, object->others[args->primID], walk_query(walk)))
        ((struct RTCRay *)args->ray)->tfar = -INFINITY;
}

void embree_instance_bounds(const struct RTCBoundsFunctionArguments *args)
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

void embree_instance_intersect(const struct RTCIntersectFunctionNArguments *args)
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

void embree_instance_occluded(const struct RTCOccludedFunctionNArguments *args)
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
