#include "command/render_verify.h"

#include "backend/step_recorder.h"
#include "base/log.h"
#include "film/film.h"
#include "chain/chain.h"
#include "mmlt/mmlt.h"
#include "render/photon_map.h"
#include "render/render.h"
#include "render/verify.h"

#include <limits.h>

/* Chains that are compared, and steps of each: enough for every kind of mutation. */
#define CHAINS_COMPARED 8192u
#define STEPS_COMPARED 4u

/* Compares one list of steps; `what` precedes the figures in the message. */
static bool list_verify(const BackendMember sides[2], const char *what, const FrameParams *frame, const StepList *list,
                        uint64_t items, const atomic_int *stop, Error *error)
{
    VerifyReport report;
    BackendStatistics statistics;
    if (!verify_run(sides, frame, list, items, stop, &report, error))
        return false;
    sides[1].interface->statistics(sides[1].backend, &statistics);
    if (report.items == 0) {
        log_message(LOG_WARNING, "stopped before anything of %s was compared", statistics.device);
        return true;
    }
    log_message(
        LOG_INFO,
        "%s on %s agrees with the CPU: %s%llu paths, %u words each, the first of them after each of %llu steps%s",
        sides[1].interface->name, statistics.device, what, (unsigned long long)report.items, report.words,
        (unsigned long long)report.prefixes, report.items < items ? "; stopped before the end" : "");
    return true;
}

/* Compares path tracing, a pool, and chains that start from the CPU's pool. */
static bool mmlt_verify(const BackendMember sides[2], RenderRun *run, uint64_t items, const atomic_int *stop,
                        Error *error)
{
    Mmlt mmlt;
    bool whole = true, same = mmlt_init(&mmlt, run, error);
    uint count = items < CHAINS_COMPARED ? (uint)items : CHAINS_COMPARED;
    same = same && list_verify(sides, "path tracing, ", &mmlt.paths.frame, &mmlt.paths.own.list, items, stop, error);
    if (same && run->frame.path.max_depth >= CHAIN_DEPTH_MIN) {
        mmlt.options.pool = count;
        same = mmlt_pilot_run(&mmlt, count, &whole, error) && (!whole || mmlt_seeds_run(&mmlt, count, &whole, error));
        FrameParams pool = pool_estimator_frame(&mmlt.pool, &mmlt.generation),
                    chains = chains_estimator_frame(&mmlt.chains, &mmlt.generation, &mmlt.pool);
        same = same && (!whole || list_verify(sides, "a pool, ", &pool, &mmlt.pool.own.list, count, stop, error)) &&
               (!whole || !chains_estimator_alive(&mmlt.chains, &mmlt.generation) ||
                list_verify(sides, "chains, ", &chains, &mmlt.chains.own.list, count, stop, error));
    }
    mmlt_destroy(&mmlt);
    return same;
}

/* Compares one device, sides[1], with the CPU, sides[0]. MMLT prepares its passes on the CPU. */
static bool member_verify(const Integrator *integrator, const Scene *scene, const RenderOptions *options,
                          const BackendMember sides[2], uint64_t items, Error *error)
{
    RenderOptions few = *options;
    Film film;
    RenderRun run = {.interface = sides[0].interface,
                     .backend = sides[0].backend,
                     .options = &few,
                     .film = &film,
                     .guide = &scene->guide,
                     .hidden_light = scene_hides_light(scene)};
    StepList list = {0};
    few.chains.steps = STEPS_COMPARED;
    render_frame(integrator, scene, options, &run.frame);
    if (!render_openings_find(&run, integrator, scene, error) || !render_photons_make(&run, integrator, scene, error))
        return false;
    if (integrator->list) {
        bool same = integrator->list(&run.frame, &list, error);
        list.photons = &run.photons;
        same = same && list_verify(sides, "", &run.frame, &list, items, options->stop, error);
        step_list_destroy(&list);
        photon_map_destroy(&run.photons);
        return same;
    }
    const SceneSettings *settings = &scene->settings;
    bool same =
        film_init(&film, settings->width, settings->height, settings->crop, error) && film_light_reserve(&film, error);
    run.crop_pixels = film_pixels(&film);
    same = same && mmlt_verify(sides, &run, items, options->stop, error);
    film_destroy(&film);
    photon_map_destroy(&run.photons);
    return same;
}

/* Items to compare: those of all samples, but only as many whole samples as 32-bit item numbers allow. */
static uint64_t items_limit(const SceneSettings *settings, unsigned samples)
{
    uint64_t pixels =
        (uint64_t)(settings->crop[2] - settings->crop[0]) * (uint64_t)(settings->crop[3] - settings->crop[1]);
    uint64_t items = pixels * samples, limit = UINT_MAX / pixels * pixels;
    return items < limit ? items : limit;
}

bool render_verify(const RenderCommand *command, const Integrator *integrator, const Scene *scene,
                   const RenderOptions *options, Error *error)
{
    const BackendScene view = scene_backend_view(scene);
    const BackendOptions open_options = {.threads = command->threads, .batch = command->batch};
    BackendMember opened = {NULL, NULL}, members[BACKEND_GROUP_MAX];
    BackendMember sides[2] = {{command->reference, NULL}, {NULL, NULL}};
    sides[0].backend = command->reference->open(&view, &open_options, error);
    bool same = sides[0].backend && backend_choices_open(&command->backends, &view, &open_options, &opened, error);
    size_t count = same ? backend_group_members(opened, members) : 0;
    for (size_t i = 0; i < count && same; ++i) {
        sides[1] = members[i];
        if (sides[1].interface != command->reference)
            same = member_verify(integrator, scene, options, sides, items_limit(&scene->settings, options->samples),
                                 error);
    }
    if (opened.backend)
        opened.interface->close(opened.backend);
    if (sides[0].backend)
        sides[0].interface->close(sides[0].backend);
    return same;
}
