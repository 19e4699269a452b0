#include "command/render_settings.h"

#include "base/log.h"

#include <math.h>
#include <string.h>

static bool checkpoint_check(const RenderCommand *command, Error *error)
{
    bool written = command->checkpoint || command->resume;
    if (command->checkpoint_every > 0.0 && !written) {
        error_set(error, "--checkpoint-every without --checkpoint: there is no file to write to");
        return error_fix(error, "add --checkpoint=FILE, or leave --checkpoint-every out");
    }
    if (command->dump_bad && written) {
        error_set(error, "--dump-bad cannot be used with --%s, after which a part of the list would be missing",
                  command->checkpoint ? "checkpoint" : "resume");
        return error_fix(error, "leave one of the two out");
    }
    return true;
}

static bool goal_check(const RenderCommand *command, Error *error)
{
    const char *option = command->error_of ? "error-of" : command->error.percentile > 0.0 ? "error-percentile" : NULL;
    if (option && !(command->error.goal > 0.0)) {
        error_set(error, "--%s without --error: there is no error to be reached", option);
        return error_fix(error, "add --error=E, e.g. --error=2%%, or leave --%s out", option);
    }
    if (!(command->error.goal > 0.0))
        return true;
    if (command->shard.count > 0) {
        error_set(error, "--error cannot be used with --shard: a shard knows its own error only");
        return error_fix(error, "leave one of the two out; --samples and --time are for shards");
    }
    if (!command->chains.paper)
        return true;
    error_set(error, "--error: the scheme \"paper\" of mmlt has no independent halves to estimate an error from");
    return error_fix(error, "leave --mlt=scheme=paper out, or use --time or --samples");
}

static bool pilot_check(const RenderCommand *command, const Integrator *integrator, Error *error)
{
    if (!command->pilot)
        return true;
    if (command->shard.count == 0) {
        error_set(error, "--pilot without --shard: the rendering would have the random numbers of its pilot");
        return error_fix(error, "add --shard=K/N, or leave --pilot out; --resume=%s goes on from it", command->pilot);
    }
    if (integrator == integrator_mmlt() && !command->chains.paper && !command->chains.chains_only)
        return true;
    error_set(error, "--pilot is for mmlt and its combination of estimators: nothing else is learnt");
    return error_fix(error, "leave --pilot%s out", integrator == integrator_mmlt() ? " or --mlt=scheme, combine" : "");
}

bool render_settings_check(const RenderCommand *command, const Integrator *integrator, Error *error)
{
    const char *option = command->only_strategy ? "strategy" : command->balance ? "heuristic" : NULL;
    if (command->unweighted && !command->only_strategy) {
        error_set(error, "--unweighted without --strategy would count every path several times");
        return error_fix(error, "add --strategy=s,t, e.g. --strategy=1,2");
    }
    if (option && integrator == integrator_pt()) {
        error_set(error, "--%s is for bidirectional integrators, which pt is not", option);
        return error_fix(error, "add --integrator=bdpt, or leave --%s out", option);
    }
    if (option && integrator == integrator_mmlt()) {
        error_set(error, "--%s is not for mmlt, whose chains use all strategies, with the balance heuristic", option);
        return error_fix(error, "add --integrator=bdpt, or leave --%s out", option);
    }
    if (command->chain_option && integrator != integrator_mmlt()) {
        error_set(error, "--%s is for mmlt, but %s has no Markov chains", command->chain_option, integrator->name);
        return error_fix(error, "add --integrator=mmlt, or leave --%s out", command->chain_option);
    }
    if (command->chains.large_step > 0.0 && !command->chains.paper) {
        error_set(error, "--mlt=large-step is for scheme=paper: generations start over with new pools instead of "
                         "making large steps");
        return error_fix(error, "add --mlt=scheme=paper, or leave large-step out");
    }
    if (!checkpoint_check(command, error) || !goal_check(command, error) || !pilot_check(command, integrator, error))
        return false;
    unsigned s = command->strategy[0], t = command->strategy[1];
    if (!command->only_strategy || strategy_taken(integrator->strategies, s, s + t - 1))
        return true;
    error_set(error, "--strategy=%u,%u: %s has no such strategy", s, t, integrator->name);
    return error_fix(error, "%s",
                     s + t == 2 ? "lights are seen directly by 0,2 alone" : "use --integrator=bdpt, which has all");
}

bool render_settings_layers(const RenderCommand *command, const Integrator *integrator, unsigned *wanted, Error *error)
{
    bool chains = integrator == integrator_mmlt();
    *wanted = command->has_layers ? command->layers : chains ? LAYERS_AOV : 0;
    if (chains)
        return true;
    if (command->layers == LAYERS_ALL)
        *wanted &= LAYERS_AOV;
    else if ((command->layers & ~LAYERS_AOV) != 0) {
        error_set(error, "--layers: the image of %s has no layers of light", integrator->name);
        return error_fix(error, "use " AOV_LIST(LAYER_TEXT_OF) "or --integrator=mmlt");
    }
    return true;
}

/* Scales the scene's crop window to a film of another size (pbrt rounds both ends up). */
static void crop_scale(const SceneSettings *settings, const int size[2], int crop[4])
{
    const int old[2] = {settings->width, settings->height};
    for (int i = 0; i < 4; ++i) {
        double part = (double)settings->crop[i] / old[i % 2];
        crop[i] = (int)ceil(part * size[i % 2] - 1e-9);
    }
    for (int i = 0; i < 2; ++i)
        if (crop[i] >= crop[i + 2])
            crop[i] = crop[i + 2] - 1;
}

/* Applies size, crop and depth from the command line, where given. */
static bool settings_override(const RenderCommand *command, Scene *scene, Error *error)
{
    SceneSettings *settings = &scene->settings;
    int size[2] = {settings->width, settings->height};
    int crop[4];
    memcpy(crop, settings->crop, sizeof crop);
    if (command->resolution[0] > 0) {
        memcpy(size, command->resolution, sizeof size);
        crop_scale(settings, size, crop);
    }
    if (command->has_crop)
        memcpy(crop, command->crop, sizeof crop);
    if (command->max_depth > 0)
        settings->max_depth = command->max_depth;
    return scene_film_set(scene, size[0], size[1], crop, error);
}

/* Limits the depth to the integrator's, with a warning, and checks that --strategy fits in. */
static bool depth_check(const RenderCommand *command, const Integrator *integrator, Scene *scene, Error *error)
{
    int *depth = &scene->settings.max_depth, limit = integrator->depth_limit;
    if (*depth > limit) {
        log_message(LOG_WARNING, "%s makes paths of up to %d segments; longer ones, up to %d, are left out",
                    integrator->name, limit, *depth);
        *depth = limit;
    }
    unsigned segments = command->strategy[0] + command->strategy[1] - 1;
    if (!command->only_strategy || segments <= (unsigned)*depth)
        return true;
    error_set(error, "--strategy=%u,%u makes paths of %u segments, but the maximum depth is %d", command->strategy[0],
              command->strategy[1], segments, *depth);
    if (segments > (unsigned)limit)
        return error_fix(error, "paths of %s have at most %d segments", integrator->name, limit);
    return error_fix(error, "add --max-depth=%u", segments);
}

/* Chains target paths that end at one light; light from all along a ray has no place among their coordinates. Path
 * tracing shows it, if it goes along with them. */
static bool media_check(const RenderCommand *command, const Integrator *integrator, const Scene *scene, Error *error)
{
    bool alone = integrator == integrator_mmlt() && (command->chains.paper || command->chains.chains_only);
    if (!(scene->features & FEATURE_MEDIUM_EMISSION) || !alone)
        return true;
    error_set(error, "the scene has a medium that emits light (Le), which chains alone do not show");
    return error_fix(error, "leave --mlt=%s out, or set Le of the medium to 0",
                     command->chains.paper ? "scheme=paper" : "combine=off");
}

bool render_settings_apply(const RenderCommand *command, const Integrator *integrator, Scene *scene, Error *error)
{
    return media_check(command, integrator, scene, error) && settings_override(command, scene, error) &&
           depth_check(command, integrator, scene, error);
}
