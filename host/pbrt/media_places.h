/* Warnings where a light or the camera is declared in another medium (MediumInterface) than the surfaces around it
 * leave there. Paths from the camera find the latter, paths that start at the light are in the former, so integrators
 * disagree. */
#ifndef TWINLIGHT_PBRT_MEDIA_PLACES_H
#define TWINLIGHT_PBRT_MEDIA_PLACES_H

#include "base/arena.h"
#include "pbrt/context.h"

/* Lights that are checked; the first of a file. */
#define MEDIA_PLACES_MAX 1000

/* Where the lights that stand somewhere, and the camera, are declared in the file; it outlives the import. */
typedef struct MediaPlaces {
    Arena arena;
    Array lights; /* LightPlace, in file order */
    Array names; /* const char *, of the media 1, 2, ... */
    SourcePlace camera;
} MediaPlaces;

void media_places_init(MediaPlaces *places);
void media_places_destroy(MediaPlaces *places);

/* These record in im->options.places, and do nothing if that is NULL. */

/* Before a file is read, perhaps for the second time. */
void media_places_reset(PbrtImport *im);

/* The camera, which the current directive describes. */
bool media_places_camera(PbrtImport *im);

/* The lights from first_light on, which the current directive has added; the first stands for all. */
bool media_places_lights(PbrtImport *im, size_t first_light);

/* The names of media, at the end of the file. */
bool media_places_names(PbrtImport *im);

/* Logs the warnings for a finished scene; none in scenes without media. Fails when out of memory. */
bool media_places_check(const MediaPlaces *places, const Scene *scene, Error *error);

#endif
