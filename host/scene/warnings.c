#include "scene/warnings.h"

#include "backend/ray_reach.h"
#include "base/log.h"
#include "layout/scene_view.h"

static void strays_report(const Scene *scene)
{
    const BackendScene packed = scene_backend_view(scene);
    const SceneView view = scene_view(packed.frame, packed.geometry, packed.tables, packed.texels);
    float strays, others;
    uint count = ray_reach_strays(&view, (uint)packed.instance_count, &strays, &others);
    if (count > 0)
        log_message(LOG_WARNING,
                    "%u of the primitives and instances %s as far as %.3g from the origin, all others no further than "
                    "%.3g: rendering is slower, and light from infinity noisier; if this is unintended, look for a "
                    "stray vertex or a wrong transform",
                    count, count == 1 ? "reaches" : "reach", (double)strays, (double)others);
}

void scene_advise(const Scene *scene, bool photons)
{
    if (scene_has_delta(scene) && !photons && (scene->features & FEATURE_DELTA_LIGHT) != 0)
        log_message(LOG_INFO, "light of point, spot, distant and other lights without extent that passes smooth glass "
                              "or mirrors both before "
                              "and after a rough surface is found by photons alone and is missing: render by mmlt, or "
                              "by pt with --photons=1048576");
    if (scene_has_delta(scene) && (scene->features & FEATURE_DELTA_LIGHT) && (scene->features & FEATURE_SCATTERING))
        log_message(LOG_INFO, "light of lights without extent that passes smooth glass or mirrors, is scattered in a "
                              "medium and passes others after that is missing, and with pt all of theirs that passes "
                              "any before it is scattered: a small sphere in their place is found by mmlt");
    if (scene_has_delta(scene) && scene_has_invisible_light(scene))
        log_message(LOG_INFO, "light of area lights with alpha 0 that passes smooth glass or mirrors both before and "
                              "after a rough surface is missing: without alpha it is found");
    strays_report(scene);
}
