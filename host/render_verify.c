#include "render_verify.h"

#include "film.h"
#include "log.h"
#include "verify.h"

#include <limits.h>

static bool member_verify(const BackendMember sides[2], const FrameParams *frame, const StepList *list, uint64_t items,
                          const atomic_int *stop, Error *error)
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
    log_message(LOG_INFO,
                "%s on %s agrees with the CPU: %llu paths, %u words each, the first of them after each of %llu steps%s",
                sides[1].interface->name, statistics.device, (unsigned long long)report.items, report.words,
                (unsigned long long)report.prefixes, report.items < items ? "; stopped before the end" : "");
    return true;
}

/* Items are counted in 32 bits between the sample that the frame begins with and the last. */
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
    StepList list = {0};
    FrameParams frame;
    render_frame(integrator, scene, options, &frame);
    sides[0].backend = command->reference->open(&view, &open_options, error);
    bool same = sides[0].backend && backend_choices_open(&command->backends, &view, &open_options, &opened, error) &&
                integrator->list(&frame, &list, error);
    size_t count = same ? backend_group_members(opened, members) : 0;
    for (size_t i = 0; i < count && same; ++i) {
        sides[1] = members[i];
        if (sides[1].interface != command->reference)
            same = member_verify(sides, &frame, &list, items_limit(&scene->settings, options->samples), options->stop,
                                 error);
    }
    step_list_destroy(&list);
    if (opened.backend)
        opened.interface->close(opened.backend);
    if (sides[0].backend)
        sides[0].interface->close(sides[0].backend);
    return same;
}
