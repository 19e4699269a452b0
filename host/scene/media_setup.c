#include "scene/media_setup.h"

#include "geometry/medium.h"
#include "light/delta.h"
#include "scene/grid_build.h"
#include "scene/separations.h"

#include <math.h>
#include <string.h>

/* Mean free paths of media_reach. */
#define REACH_PATHS 40.0f

static const Medium *medium_of(const Scene *scene, uint number)
{
    return &ARRAY_AT(&scene->media, Medium, number);
}

/* Which media some shape, light or the camera is in. */
static void media_used(const Scene *scene, bool used[MEDIA_MAX])
{
    memset(used, 0, MEDIA_MAX * sizeof *used);
    used[scene->camera_settings.medium] = true;
    for (size_t i = 0; i < scene->shapes.count; ++i) {
        uint flags = ARRAY_AT(&scene->shapes, Shape, i).flags;
        used[media_inside(flags)] = used[media_outside(flags)] = true;
    }
    for (size_t i = 0; i < scene->light_details.count; ++i)
        used[ARRAY_AT(&scene->light_details, LightDetail, i).medium] = true;
}

static ulong medium_features(const Medium *medium)
{
    return FEATURE_MEDIUM | (medium_scatters(medium) ? FEATURE_SCATTERING : 0u) |
           (vec3_is_zero(medium->emission) ? 0u : FEATURE_MEDIUM_EMISSION) |
           (medium->grid != 0u ? FEATURE_MEDIUM_GRID : 0u);
}

ulong media_features(const Scene *scene)
{
    bool used[MEDIA_MAX];
    ulong features = 0u;
    media_used(scene, used);
    for (uint i = 1; i < scene->media.count; ++i)
        features |= used[i] ? medium_features(medium_of(scene, i)) : 0u;
    return features;
}

void media_box_join(const Scene *scene, Box *world)
{
    bool used[MEDIA_MAX];
    media_used(scene, used);
    for (uint i = 1; i < scene->media.count; ++i) {
        const Medium *medium = medium_of(scene, i);
        if (!used[i] || medium->grid == 0u)
            continue;
        Box box = grid_box(&ARRAY_AT(&scene->grids, MediumGrid, medium->grid - 1u));
        box_join(world, &box);
    }
}

/* ---- the medium around the scene --------------------------------------------------------------------------------- */

/* Sets scene->medium_around: the medium that a ray from the camera is in when it has left the scene. */
static bool around_find(Scene *scene, Error *error)
{
    const double *camera = scene->camera_settings.world_from_camera;
    SceneView view = {.features = scene->features,
                      .positions = scene->positions.data,
                      .normals = scene->normals.data,
                      .uvs = scene->uvs.data,
                      .primitives = scene->primitives.data,
                      .shapes = scene->shapes.data,
                      .patches = scene->patches.data,
                      .quadrics = scene->quadrics.data,
                      .curves = scene->curves.data,
                      .objects = scene->objects.data,
                      .instances = scene->instances.data};
    Separations separations;
    bool good = separations_init(&separations, &view, scene->objects.count, scene->instances.count, error);
    if (good)
        scene->medium_around = separations_medium_behind(
            &separations, vec3((float)camera[3], (float)camera[7], (float)camera[11]), scene->camera_settings.medium);
    separations_destroy(&separations);
    return good;
}

bool media_lights_setup(Scene *scene, Error *error)
{
    if (!(scene->features & FEATURE_MEDIUM))
        return true;
    if (!around_find(scene, error))
        return false;
    const Medium *medium = medium_of(scene, scene->medium_around);
    Vec3 extinction = medium->grid == 0u ? medium->extinction : vec3_splat(0.0f); /* grids end */
    for (size_t i = 0; i < scene->lights.count; ++i) {
        Light *light = &ARRAY_AT(&scene->lights, Light, i);
        if (!light_is_far(light_kind(light)))
            continue;
        scene_light_detail(scene, light)->medium = scene->medium_around;
        light->emission.x = extinction.x > 0.0f ? 0.0f : light->emission.x;
        light->emission.y = extinction.y > 0.0f ? 0.0f : light->emission.y;
        light->emission.z = extinction.z > 0.0f ? 0.0f : light->emission.z;
    }
    return true;
}

float media_reach(const Scene *scene)
{
    if (!(scene->features & FEATURE_SCATTERING))
        return 0.0f;
    const Medium *medium = medium_of(scene, scene->medium_around);
    const float extinction[3] = {medium->extinction.x, medium->extinction.y, medium->extinction.z};
    float reach = 0.0f;
    bool endless = medium_scatters(medium) && medium->grid == 0u;
    for (int c = 0; endless && c < 3; ++c)
        if (extinction[c] > 0.0f)
            reach = fmaxf(reach, REACH_PATHS / extinction[c]);
    return reach;
}
