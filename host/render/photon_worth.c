#include "render/photon_worth.h"

#include "layout/state.h"
#include "math/vec.h"
#include "path/photon.h"
#include "render/film_pilot.h"

#include <pthread.h>
#include <stdlib.h>

#define WORTH_PATHS 32768u

/* Photons are worth their time if this part of a path's light comes by them, on average over paths ... */
#define WORTH_PART 0.001

/* ... where this much of the mean of all paths counts as further light, so that dark paths do not decide. */
#define WORTH_FLOOR 0.1

/* A map may have all photons that were asked for if the first ones bring this part, and otherwise one of FEW_EVERY: for
 * the number that a rendering's time allows, making them takes up to a quarter of that time. */
#define MANY_PART 0.05
#define FEW_EVERY 8u

/* The luminance of each path, by pixel: no two paths have the same. */
typedef struct PathLight {
    pthread_mutex_t mutex;
    float *luminance;
} PathLight;

static void path_light_add(void *context, const uint *splats, uint count, uint stride)
{
    PathLight *light = context;
    pthread_mutex_lock(&light->mutex);
    for (uint t = 0; t < count; ++t) {
        uint pixel = state_load(splats, stride, SPLAT_PIXEL, t);
        float luminance = pixel != NONE ? rgb_luminance(state_load_vec3(splats, stride, SPLAT_COLOR, t)) : 0.0f;
        if (luminance > 0.0f && luminance < FLOAT_INFINITY)
            light->luminance[pixel] = luminance;
    }
    pthread_mutex_unlock(&light->mutex);
}

/* Renders one path of path tracing in each of `paths` pixels, by such photons; luminance: of all pixels, 0. */
static bool paths_render(const RenderRun *run, uint paths, PhotonParams photons, float *luminance, Error *error)
{
    PathLight light = {.luminance = luminance};
    FrameParams frame = pilot_frame(run, integrator_pt(), paths);
    frame.photons = photons;
    pthread_mutex_init(&light.mutex, NULL);
    const SplatSink sink = {.splats = path_light_add, .context = &light, .whole = true};
    bool done = pilot_run(run, integrator_pt(), &frame, &sink, error);
    pthread_mutex_destroy(&light.mutex);
    return done;
}

/* The mean part of a path's light that photons bring. Sums go by pixels, so they are the same on all backends. */
static double part_by_photons(const float *with, const float *without, size_t pixels, uint paths)
{
    double mean = 0.0, part = 0.0;
    for (size_t i = 0; i < pixels; ++i)
        mean += (double)without[i] / paths;
    for (size_t i = 0; i < pixels; ++i)
        if (with[i] > without[i])
            part += (double)(with[i] - without[i]) / ((double)with[i] + WORTH_FLOOR * mean);
    return part / paths;
}

static bool has_lights_without_extent(const PhotonMap *photons)
{
    const uint count = photons->params.count;
    for (uint i = 0; i < count; ++i)
        if (photon_record(photons->words, count, i)[PHOTON_LIGHT] != NONE)
            return true;
    return false;
}

bool photon_map_part(const RenderRun *run, bool everywhere, double *part, Error *error)
{
    size_t pixels = (size_t)run->frame.film.width * run->frame.film.height;
    uint paths = pixels < WORTH_PATHS ? (uint)pixels : WORTH_PATHS;
    PhotonParams photons = run->photons.params;
    *part = 0.0;
    if (photons.count == 0)
        return true;
    photons.everywhere = everywhere ? 1 : 0;
    float *luminance[2] = {calloc(pixels, sizeof(float)), calloc(pixels, sizeof(float))};
    bool done = luminance[0] && luminance[1] ? paths_render(run, paths, photons, luminance[0], error) &&
                                                   paths_render(run, paths, (PhotonParams){0}, luminance[1], error)
                                             : error_memory(error, 2 * pixels * sizeof(float), "a pilot of photons");
    if (done)
        *part = part_by_photons(luminance[0], luminance[1], pixels, paths);
    free(luminance[0]);
    free(luminance[1]);
    return done;
}

uint photon_map_most(uint most, double part)
{
    return part >= MANY_PART ? most : most / FEW_EVERY;
}

bool photon_map_worth(const PhotonMap *photons, double part)
{
    return photons->params.count == 0 || has_lights_without_extent(photons) || part >= WORTH_PART;
}
