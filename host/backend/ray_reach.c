#include "backend/ray_reach.h"

#include "geometry/box.h"

#include <stdlib.h>

/* Number of evenly spaced primitives and instances examined in place of all. */
#define SAMPLES 4096u

/* Margins up to this fraction of the size of primitives cost next to nothing. */
#define MARGIN_PART 0.125f

/* A separate hierarchy pays off only if its reach is smaller by this factor. */
#define WORTHWHILE 4.0f

/* Largest coordinate of item i of the world, primitives first, then instances. *size: longest side of its box. */
static float item_reach(const SceneView *view, uint i, float *size)
{
    const Object *world = &view->objects[0];
    Box box;
    if (i < world->primitive_count) {
        box = primitive_box(view, world->first_primitive + i);
    } else {
        const Instance *instance = &view->instances[i - world->primitive_count];
        const Object *object = &view->objects[instance->object];
        box = box_empty(); /* of one primitive, representative of the object */
        if (object->primitive_count > 0) {
            Box inner = primitive_box(view, object->first_primitive + object->primitive_count / 2u);
            box = box_transform(&inner, instance->world_from_object);
        }
    }
    *size = box_is_empty(&box)
                ? 0.0f
                : float_max(float_max(box.high[0] - box.low[0], box.high[1] - box.low[1]), box.high[2] - box.low[2]);
    return box_largest(&box);
}

static int float_order(const void *a, const void *b)
{
    float x = *(const float *)a, y = *(const float *)b;
    return (x > y) - (x < y);
}

/* Upper bound of the coordinates of camera ray origins, except for an orthographic camera. */
static float camera_place_reach(const Camera *camera)
{
    const float *m = camera->world_from_camera.m;
    return 2.0f * vec3_max_abs(vec3(m[3], m[7], m[11])) + camera->lens_radius;
}

float ray_reach_inner(const SceneView *view, uint instance_count)
{
    float all = view->frame->scene.ray_reach, reaches[SAMPLES], sizes[SAMPLES];
    uint items = view->objects[0].primitive_count + instance_count, count = items < SAMPLES ? items : SAMPLES;
    if (count == 0u)
        return all;
    for (uint k = 0; k < count; ++k)
        reaches[k] = item_reach(view, (uint)((ulong)k * items / count), &sizes[k]);
    qsort(sizes, count, sizeof *sizes, float_order);
    qsort(reaches, count, sizeof *reaches, float_order);
    float inner = float_max(sizes[count / 2u] * (MARGIN_PART / (BOX_ULPS * FLOAT_EPSILON)),
                            2.0f * reaches[(count - 1u) * 99u / 100u]);
    inner = float_max(inner, camera_place_reach(&view->frame->camera));
    return inner * WORTHWHILE < all ? inner : all;
}

/* Upper limits of the number of strays: absolute, and as a fraction 1 / STRAYS_PART of all items. */
#define STRAYS_MOST 64u
#define STRAYS_PART 8u

/* Inserts `reach` into the `kept` largest, in descending order. */
static void largest_insert(float *largest, uint kept, float reach)
{
    if (!(reach > largest[kept - 1u]))
        return;
    uint k = kept - 1u;
    for (; k > 0u && largest[k - 1u] < reach; --k)
        largest[k] = largest[k - 1u];
    largest[k] = reach;
}

uint ray_reach_strays(const SceneView *view, uint instance_count, float *strays, float *others)
{
    float largest[STRAYS_MOST + 1u] = {0.0f}, size;
    uint items = view->objects[0].primitive_count + instance_count, few = items / STRAYS_PART;
    few = few < STRAYS_MOST ? few : STRAYS_MOST;
    for (uint i = 0; few > 0u && i < items; ++i)
        largest_insert(largest, few + 1u, item_reach(view, i, &size));
    for (uint k = few; k > 0u; --k)
        if (largest[k] > 0.0f && largest[k - 1u] > STRAY_FACTOR * largest[k]) {
            *strays = largest[0];
            *others = largest[k];
            return k;
        }
    return 0u;
}
