#include "pbrt/media_places.h"

#include "base/log.h"
#include "geometry/medium.h"
#include "light/area.h"
#include "light/delta.h"
#include "scene/separations.h"

#include <stdio.h>
#include <string.h>

/* Warnings about single lights; the others are counted. */
#define WARNINGS_MAX 10

typedef struct LightPlace {
    size_t light; /* index in the scene */
    SourcePlace place;
} LightPlace;

/* ---- recording --------------------------------------------------------------------------------------------------- */

void media_places_init(MediaPlaces *places)
{
    memset(places, 0, sizeof *places);
    array_init(&places->lights, sizeof(LightPlace));
    array_init(&places->names, sizeof(const char *));
}

void media_places_destroy(MediaPlaces *places)
{
    array_destroy(&places->lights);
    array_destroy(&places->names);
    arena_destroy(&places->arena);
}

void media_places_reset(PbrtImport *im)
{
    if (!im->options.places)
        return;
    media_places_destroy(im->options.places);
    media_places_init(im->options.places);
}

static const char *text_keep(PbrtImport *im, const char *text)
{
    return arena_text(&im->options.places->arena, text, strlen(text), im->error);
}

/* The place of the current directive, with a name that lives as long as the record. */
static bool place_keep(PbrtImport *im, SourcePlace *place)
{
    const Array *lights = &im->options.places->lights;
    const LightPlace *last = lights->count > 0 ? &ARRAY_AT(lights, LightPlace, lights->count - 1) : NULL;
    *place = im->place;
    if (!place->file)
        return true;
    bool same = last && last->place.file && strcmp(last->place.file, place->file) == 0;
    place->file = same ? last->place.file : text_keep(im, place->file);
    return place->file != NULL;
}

bool media_places_camera(PbrtImport *im)
{
    return !im->options.places || place_keep(im, &im->options.places->camera);
}

/* Whether lights of this kind are at a place: not at infinity, nor there and seen through a portal. */
static bool light_has_place(uint kind)
{
    return kind == LIGHT_AREA || light_has_position(kind);
}

bool media_places_lights(PbrtImport *im, size_t first_light)
{
    MediaPlaces *places = im->options.places;
    if (!places || places->lights.count >= MEDIA_PLACES_MAX || first_light >= im->scene->lights.count ||
        !light_has_place(light_kind(&ARRAY_AT(&im->scene->lights, Light, first_light))))
        return true;
    LightPlace entry = {.light = first_light};
    if (!place_keep(im, &entry.place))
        return false;
    LightPlace *added = array_grow(&places->lights, 1, im->error);
    if (added)
        *added = entry;
    return added != NULL;
}

bool media_places_names(PbrtImport *im)
{
    MediaPlaces *places = im->options.places;
    for (size_t i = 0; places && i < im->media_seen.count; ++i) {
        const char **name = array_grow(&places->names, 1, im->error);
        if (!name || !(*name = text_keep(im, ARRAY_AT(&im->media_seen, MediumSeen, i).name)))
            return false;
    }
    return true;
}

/* ---- checking ---------------------------------------------------------------------------------------------------- */

static SurroundedPoint light_point(const SceneView *view, uint index, uint around)
{
    const Light *light = &view->lights[index];
    if (light_kind(light) != LIGHT_AREA) {
        const LightDetail *detail = light_detail(view, light);
        return (SurroundedPoint){detail->position, vec3_splat(0.0f), detail->medium, around};
    }
    Primitive primitive = view->primitives[light->primitive];
    AreaPoint point = area_light_point(view, index, &primitive, vec2(0.5f, 0.5f));
    uint media = view->shapes[primitive.shape_and_kind & PRIMITIVE_SHAPE_MASK].flags;
    return (SurroundedPoint){point.p, point.ng, media_outside(media), around};
}

/* A medium's name in scene files. */
static const char *medium_name(const MediaPlaces *places, uint medium)
{
    return medium == 0u ? "" : ARRAY_AT(&places->names, const char *, medium - 1u);
}

static void camera_check(const MediaPlaces *places, const Scene *scene, Separations *separations)
{
    const double *camera = scene->camera_settings.world_from_camera;
    uint declared = scene->camera_settings.medium, found;
    SurroundedPoint point = {vec3((float)camera[3], (float)camera[7], (float)camera[11]), vec3_splat(0.0f), declared,
                             declared};
    if (!separations_medium_at(separations, &point, &found) || found == declared)
        return;
    const char *name = medium_name(places, found);
    log_message_at(
        LOG_WARNING, places->camera,
        "the camera is declared in the medium \"%s\", but the surfaces around it enclose \"%s\", which the image "
        "does not show in front of them; let \"%s\" be the outside of MediumInterface before Camera",
        medium_name(places, declared), name, name);
}

/* Whether a light is where it is declared to be, or that is not known; logs a warning if not and `show`. */
static bool light_check(const MediaPlaces *places, const LightPlace *entry, uint around, Separations *separations,
                        bool show)
{
    const SceneView *view = &separations->view;
    SurroundedPoint point = light_point(view, (uint)entry->light, around);
    uint found;
    if (!separations_medium_at(separations, &point, &found) || found == point.expected)
        return true;
    const char *name = medium_name(places, found);
    if (show)
        log_message_at(
            LOG_WARNING, entry->place,
            "the light is declared in the medium \"%s\", but the surfaces around it and the camera put it into "
            "\"%s\", so that integrators disagree on its brightness; let \"%s\" be the outside of MediumInterface "
            "before its %s",
            medium_name(places, point.expected), name, name,
            light_kind(&view->lights[entry->light]) == LIGHT_AREA ? "Shape" : "LightSource");
    return false;
}

bool media_places_check(const MediaPlaces *places, const Scene *scene, Error *error)
{
    size_t wrong = 0;
    if (!(scene->features & FEATURE_MEDIUM))
        return true;
    const BackendScene packed = scene_backend_view(scene);
    const SceneView view = scene_view(packed.frame, packed.geometry, packed.tables, packed.texels);
    Separations separations;
    bool good = separations_init(&separations, &view, packed.object_count, packed.instance_count, error);
    if (good)
        camera_check(places, scene, &separations);
    for (size_t i = 0; i < places->lights.count && good; ++i)
        wrong += !light_check(places, &ARRAY_AT(&places->lights, LightPlace, i), scene->medium_around, &separations,
                              wrong < WARNINGS_MAX);
    if (wrong > WARNINGS_MAX)
        log_message(LOG_WARNING, "%zu other lights are declared in other media than they are in", wrong - WARNINGS_MAX);
    separations_destroy(&separations);
    return good;
}
