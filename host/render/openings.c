#include "render/openings.h"

#include "backend/step_recorder.h"
#include "base/log.h"
#include "layout/kernel_list.h"
#include "light/delta.h"
#include "path/opening_path.h"
#include "render/opening_fit.h"
#include "render/opening_frame.h"

#include <stdlib.h>

/* Subpaths of a pass; and passes per light, at most, until enough rays have come. */
#define PASS_PATHS (4096u * OPENING_SPLITS)
#define PASSES_MAX 8u
#define RAYS_ENOUGH 512u
#define PIXELS_MAX ((size_t)PASSES_MAX * (PASS_PATHS / OPENING_SPLITS))

/* A light has openings if, of the pixels to which any subpath brings light, in at least this part only one does. In
 * rooms behind windows that is .7 ... .97. Otherwise connections find its light, and light subpaths through openings,
 * which are longer than those that miss the scene, bring little more: .1 ... .4 where light comes from all around. */
#define SINGLE_MIN 0.5

/* Nor has a light that subpaths bring to more than this part of the pixels: .03 ... .12 in such rooms, .24 ... .45
 * otherwise. */
#define LIT_MAX 0.18

/* Openings of a light. */
#define EACH_MAX 6u

/* The part of the light subpaths of lights at infinity that is divided by the light that they bring to receivers; the
 * rest is divided as without openings, for the light that comes by way of smooth surfaces. */
#define BY_LIGHT 0.5

typedef struct OpeningPass {
    const RenderRun *run;
    const Light *lights;
    StepList list;
    uint *words; /* OPENING_PATH_WORDS fields of PASS_PATHS items */
    FarRay *rays; /* that have come */
    size_t ray_count;
    size_t lit; /* pixels of which a subpath has come to the light */
    Vec3 *normals; /* of the surfaces that the first light's pixels see ... */
    size_t normal_count;
    Frame frame; /* ... and the openings' frame by them, once that is `known` */
    bool known;
} OpeningPass;

static bool pass_init(OpeningPass *pass, const RenderRun *run, const Scene *scene, Error *error)
{
    Recorder recorder;
    *pass = (OpeningPass){.run = run,
                          .lights = scene->lights.data,
                          .words = calloc((size_t)PASS_PATHS * OPENING_PATH_WORDS, sizeof *pass->words),
                          .rays = malloc(PIXELS_MAX * sizeof *pass->rays),
                          .normals = malloc(PIXELS_MAX * sizeof *pass->normals)};
    if (!pass->words || !pass->rays || !pass->normals)
        return error_memory(error, PIXELS_MAX * sizeof *pass->rays, "openings");
    if (!recorder_init(&recorder, 2 + 3 * OPENING_SEGMENTS, error))
        return false;
    recorder_kernel(&recorder, KERNEL_opening_start, false);
    recorder_walk(&recorder, OPENING_SEGMENTS, KERNEL_opening_walk, KERNEL_COUNT);
    recorder_kernel(&recorder, KERNEL_opening_end, false);
    pass->list = recorder_list(&recorder, &run->frame, OPENING_PATH_WORDS, NULL, 0);
    pass->list.words_per_item[BUFFER_SHADOWS] = 0;
    pass->list.words_per_item[BUFFER_SPLATS] = 0;
    pass->list.pass_words = pass->words;
    pass->list.pass_fields = OPENING_PATH_WORDS;
    pass->list.pass_stride = PASS_PATHS;
    return true;
}

static void pass_destroy(OpeningPass *pass)
{
    step_list_destroy(&pass->list);
    free(pass->words);
    free(pass->rays);
    free(pass->normals);
}

static Vec3 vector_get(const OpeningPass *pass, uint field, uint item)
{
    const uint *words = pass->words + (size_t)field * PASS_PATHS + item;
    return vec3(bits_float(words[0]), bits_float(words[PASS_PATHS]), bits_float(words[2u * PASS_PATHS]));
}

static float weight_get(const OpeningPass *pass, uint item)
{
    return bits_float(pass->words[(size_t)OPENING_PATH_WEIGHT * PASS_PATHS + item]);
}

/* Of the subpaths of a pixel, from item `first` on: keeps the one that has come to the light, if no other has. Where
 * many come, light subpaths are of no use. Keeps the normal of the surface that they all see. */
static void rays_keep(OpeningPass *pass, uint first)
{
    uint arrived = 0, last = first;
    for (uint item = first; item < first + OPENING_SPLITS; ++item)
        if (weight_get(pass, item) > 0.0f) {
            ++arrived;
            last = item;
        }
    pass->lit += arrived > 0;
    if (!pass->known)
        pass->normals[pass->normal_count++] = vector_get(pass, OPENING_PATH_NORMAL, first);
    if (arrived == 1)
        pass->rays[pass->ray_count++] =
            (FarRay){vector_get(pass, OPENING_PATH_ORIGIN, last), vector_get(pass, OPENING_PATH_DIRECTION, last),
                     weight_get(pass, last), 0};
}

/* Traces pass `number` for the light, and keeps the rays that have come. *whole: set to false by a stop. */
static bool pass_run(OpeningPass *pass, uint light, uint number, bool *whole, Error *error)
{
    const SplatSink sink = {.whole = true};
    FrameParams frame = pass->run->frame;
    uint64_t delivered = 0;
    frame.pass.first_item = 0;
    frame.pass.item_count = PASS_PATHS;
    for (uint item = 0; item < PASS_PATHS; ++item) {
        pass->words[(size_t)OPENING_PATH_NUMBER * PASS_PATHS + item] = number * PASS_PATHS + item;
        pass->words[(size_t)OPENING_PATH_LIGHT * PASS_PATHS + item] = light;
    }
    if (!pass->run->interface->run(pass->run->backend, &frame, &pass->list, &sink, render_run_stop(pass->run),
                                   &delivered, error))
        return false;
    *whole = delivered == PASS_PATHS;
    for (uint item = 0; item < PASS_PATHS && *whole; item += OPENING_SPLITS)
        rays_keep(pass, item);
    return true;
}

/* From the world into the openings' frame, which is the same for all lights. */
static void rays_turn(OpeningPass *pass)
{
    if (!pass->known)
        pass->frame = opening_frame(pass->normals, pass->normal_count);
    pass->known = true;
    for (size_t i = 0; i < pass->ray_count; ++i) {
        pass->rays[i].origin = frame_to_local(pass->frame, pass->rays[i].origin);
        pass->rays[i].direction = frame_to_local(pass->frame, pass->rays[i].direction);
    }
}

/* Adds the light's openings, at most `capacity`. *brought: the light that comes by it, of the mean subpath. */
static bool light_openings(OpeningPass *pass, uint light, size_t capacity, OpeningParams *openings, double *brought,
                           bool *whole, Error *error)
{
    const SceneParams *scene = &pass->run->frame.scene;
    uint passes = 0;
    pass->ray_count = pass->lit = 0;
    while (passes < PASSES_MAX && pass->ray_count < RAYS_ENOUGH && *whole)
        if (!pass_run(pass, light, passes++, whole, error))
            return false;
    *brought = 0.0;
    if (!*whole)
        return true;
    rays_turn(pass);
    if (pass->ray_count == 0)
        return true;
    double paths = (double)passes * PASS_PATHS;
    for (size_t i = 0; i < pass->ray_count; ++i)
        *brought += (double)pass->rays[i].weight / paths;
    if ((double)pass->ray_count < SINGLE_MIN * (double)pass->lit ||
        (double)pass->lit * OPENING_SPLITS > LIT_MAX * paths)
        return true;
    size_t count;
    Opening *first = &openings->each[openings->count];
    if (!openings_fit(pass->rays, pass->ray_count, scene->world_radius, first, capacity, &count, error))
        return false;
    for (size_t i = 0; i < count; ++i) {
        first[i].light = light;
        if (light_kind(pass->lights + light) == LIGHT_DISTANT)
            first[i].side = 0.0f; /* it has one direction */
    }
    openings->count += (uint)count;
    return true;
}

/* Divides the light subpaths of `count` lights among them by the light that each brings. */
static void lights_divide(const Light *all, const uint *lights, const double *brought, uint count,
                          OpeningParams *openings)
{
    double pdf = 0.0, light = 0.0;
    for (uint i = 0; i < count; ++i) {
        pdf += (double)all[lights[i]].select_pdf;
        light += brought[i];
    }
    openings->light_count = count;
    for (uint i = 0; i < count; ++i) {
        double before = (double)all[lights[i]].select_pdf / pdf;
        openings->lights[i] = lights[i];
        openings->light_shares[i] = (float)((1.0 - BY_LIGHT) * before + BY_LIGHT * (brought[i] / light));
        openings->light_pdfs[i] = openings->light_shares[i] * (float)pdf;
    }
}

/* The far lights with the most light subpaths; how many. */
static size_t lights_choose(const Scene *scene, uint lights[OPENING_LIGHTS_MAX])
{
    const Light *all = scene->lights.data;
    size_t count = 0;
    for (size_t i = 0; i < scene->lights.count; ++i) {
        if (!light_is_far(light_kind(&all[i])) || !(all[i].select_pdf > 0.0f))
            continue;
        size_t place = count < OPENING_LIGHTS_MAX ? count++ : OPENING_LIGHTS_MAX;
        for (; place > 0 && all[lights[place - 1]].select_pdf < all[i].select_pdf; --place)
            if (place < OPENING_LIGHTS_MAX)
                lights[place] = lights[place - 1];
        if (place < OPENING_LIGHTS_MAX)
            lights[place] = (uint)i;
    }
    return count;
}

bool openings_find(RenderRun *run, const Scene *scene, Error *error)
{
    uint lights[OPENING_LIGHTS_MAX];
    double brought[OPENING_LIGHTS_MAX];
    size_t count = lights_choose(scene, lights), capacity = count > 0 ? OPENINGS_MAX / count : 0;
    OpeningParams openings = {.count = 0};
    OpeningPass pass;
    bool whole = true;
    if (count == 0 || !(run->frame.scene.world_radius > 0.0f))
        return true;
    bool done = pass_init(&pass, run, scene, error);
    for (size_t i = 0; i < count && done && whole; ++i)
        done = light_openings(&pass, lights[i], capacity < EACH_MAX ? capacity : EACH_MAX, &openings, &brought[i],
                              &whole, error);
    pass_destroy(&pass);
    if (!done || !whole || openings.count == 0)
        return done;
    openings.frame = pass.frame;
    if (count > 1)
        lights_divide(scene->lights.data, lights, brought, (uint)count, &openings);
    run->frame.openings = openings;
    log_message(LOG_INFO, "light from infinity comes through %u opening%s: most light subpaths start there",
                openings.count, openings.count > 1 ? "s" : "");
    return true;
}
