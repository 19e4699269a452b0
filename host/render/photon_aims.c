#include "render/photon_aims.h"

#include <math.h>
#include <stdlib.h>

/* Of more primitives, evenly spaced ones stand for all. */
#define AIMS_MAX 262144u

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

static bool primitive_is_aim(const Scene *scene, const SceneView *view, uint primitive)
{
    uint word = view->primitives[primitive].shape_and_kind;
    return scene_material_has_delta(scene, view->shapes[word & PRIMITIVE_SHAPE_MASK].material);
}

/* Takes every `every`-th aim, and returns how many it takes. boxes NULL: counts alone. */
static size_t aims_gather(const Scene *scene, const SceneView *view, size_t every, Box *boxes)
{
    size_t seen = 0, taken = 0;
    for (size_t i = 0; i <= scene->instances.count; ++i) {
        Placed placed = placed_get(scene, i);
        for (uint k = 0; k < placed.object->primitive_count; ++k) {
            uint primitive = placed.object->first_primitive + k;
            if (!primitive_is_aim(scene, view, primitive) || seen++ % every != 0)
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

bool photon_aims_init(PhotonAims *aims, const Scene *scene, const SceneView *view, Error *error)
{
    *aims = (PhotonAims){.all = box_empty()};
    size_t every = (aims_gather(scene, view, 1, NULL) + AIMS_MAX - 1) / AIMS_MAX;
    size_t count = every > 0 ? aims_gather(scene, view, every, NULL) : 0;
    if (count == 0)
        return true;
    aims->boxes = calloc(count, sizeof *aims->boxes);
    aims->sums = malloc(count * sizeof *aims->sums);
    if (!aims->boxes || !aims->sums)
        return error_memory(error, count * (sizeof *aims->boxes + sizeof *aims->sums), "photons");
    aims_gather(scene, view, every, aims->boxes);
    double sum = 0.0;
    for (size_t i = 0; i < count; ++i) {
        aims->sums[i] = sum += box_surface(&aims->boxes[i]);
        box_join(&aims->all, &aims->boxes[i]);
    }
    aims->count = sum > 0.0 && isfinite(sum) ? count : 0;
    return true;
}

void photon_aims_destroy(PhotonAims *aims)
{
    free(aims->boxes);
    free(aims->sums);
    *aims = (PhotonAims){0};
}

Vec3 photon_aims_point(const PhotonAims *aims, const double u[4])
{
    double wanted = u[3] * aims->sums[aims->count - 1];
    size_t first = 0, last = aims->count - 1;
    while (first < last) {
        size_t middle = first + (last - first) / 2;
        if (aims->sums[middle] <= wanted)
            first = middle + 1;
        else
            last = middle;
    }
    const Box *box = &aims->boxes[first];
    double p[3];
    for (int k = 0; k < 3; ++k)
        p[k] = (double)box->low[k] + u[k] * ((double)box->high[k] - (double)box->low[k]);
    return vec3((float)p[0], (float)p[1], (float)p[2]);
}

Vec3 photon_aims_center(const PhotonAims *aims)
{
    return box_center(&aims->all);
}

double photon_aims_radius(const PhotonAims *aims)
{
    double square = 0.0;
    for (int k = 0; k < 3; ++k)
        square += pow((double)aims->all.high[k] - (double)aims->all.low[k], 2.0);
    return 0.5 * sqrt(square);
}
