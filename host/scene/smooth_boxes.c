#include "scene/smooth_boxes.h"

#include <math.h>
#include <stdlib.h>

/* Of more primitives, evenly spaced ones stand for all. */
#define BOXES_MAX 262144u

/* An object as one instance shows it, or (NULL) in the world. */
typedef struct Placed {
    const Object *object;
    const Instance *instance;
} Placed;

static Placed placed_get(const Scene *scene, size_t i)
{
    if (i == 0)
        return (Placed){&ARRAY_AT(&scene->objects, Object, 0), NULL};
    const Instance *instance = &ARRAY_AT(&scene->instances, Instance, i - 1);
    return (Placed){&ARRAY_AT(&scene->objects, Object, instance->object), instance};
}

static bool primitive_is_smooth(const Scene *scene, const SceneView *view, uint primitive)
{
    uint word = view->primitives[primitive].shape_and_kind;
    return scene_material_has_delta(scene, view->shapes[word & PRIMITIVE_SHAPE_MASK].material);
}

/* Takes every `every`-th box, and returns how many it takes. boxes NULL: counts alone. */
static size_t boxes_gather(const Scene *scene, const SceneView *view, size_t every, Box *boxes)
{
    size_t seen = 0, taken = 0;
    for (size_t i = 0; i <= scene->instances.count; ++i) {
        Placed placed = placed_get(scene, i);
        for (uint k = 0; k < placed.object->primitive_count; ++k) {
            uint primitive = placed.object->first_primitive + k;
            if (!primitive_is_smooth(scene, view, primitive) || seen++ % every != 0)
                continue;
            if (boxes) {
                Box box = primitive_box(view, primitive);
                boxes[taken] = placed.instance ? box_transform(&box, placed.instance->world_from_object) : box;
            }
            ++taken;
        }
    }
    return taken;
}

static double box_surface(const Box *box)
{
    double x = (double)box->high[0] - (double)box->low[0], y = (double)box->high[1] - (double)box->low[1];
    double z = (double)box->high[2] - (double)box->low[2];
    return x * y + y * z + z * x;
}

bool smooth_boxes_init(SmoothBoxes *boxes, const Scene *scene, const SceneView *view, Error *error)
{
    *boxes = (SmoothBoxes){.all = box_empty()};
    size_t every = (boxes_gather(scene, view, 1, NULL) + BOXES_MAX - 1) / BOXES_MAX;
    size_t count = every > 0 ? boxes_gather(scene, view, every, NULL) : 0;
    if (count == 0)
        return true;
    boxes->each = calloc(count, sizeof *boxes->each);
    boxes->sums = malloc(count * sizeof *boxes->sums);
    if (!boxes->each || !boxes->sums)
        return error_memory(error, count * (sizeof *boxes->each + sizeof *boxes->sums), "boxes of specular surfaces");
    boxes_gather(scene, view, every, boxes->each);
    double sum = 0.0;
    for (size_t i = 0; i < count; ++i) {
        boxes->sums[i] = sum += box_surface(&boxes->each[i]);
        box_join(&boxes->all, &boxes->each[i]);
    }
    boxes->count = sum > 0.0 && isfinite(sum) ? count : 0;
    return true;
}

void smooth_boxes_destroy(SmoothBoxes *boxes)
{
    free(boxes->each);
    free(boxes->sums);
    *boxes = (SmoothBoxes){0};
}

Vec3 smooth_boxes_point(const SmoothBoxes *boxes, const double u[4])
{
    double wanted = u[3] * boxes->sums[boxes->count - 1];
    size_t first = 0, last = boxes->count - 1;
    while (first < last) {
        size_t middle = first + (last - first) / 2;
        if (boxes->sums[middle] <= wanted)
            first = middle + 1;
        else
            last = middle;
    }
    const Box *box = &boxes->each[first];
    double p[3];
    for (int k = 0; k < 3; ++k)
        p[k] = (double)box->low[k] + u[k] * ((double)box->high[k] - (double)box->low[k]);
    return vec3((float)p[0], (float)p[1], (float)p[2]);
}

Vec3 smooth_boxes_center(const SmoothBoxes *boxes)
{
    return box_center(&boxes->all);
}

double smooth_boxes_radius(const SmoothBoxes *boxes)
{
    double square = 0.0;
    for (int k = 0; k < 3; ++k)
        square += pow((double)boxes->all.high[k] - (double)boxes->all.low[k], 2.0);
    return 0.5 * sqrt(square);
}
