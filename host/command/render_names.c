#include "command/render_job.h"

#include "base/frame_name.h"
#include "base/path_name.h"
#include "command/output_check.h"
#include "render/checkpoint.h"
#include "render/stats.h"
#include "scene/camera_setup.h"

#include <string.h>

/* A number that no file name uses would make every frame overwrite the one before. */
static bool frame_check(const RenderJob *job, Error *error)
{
    if (job->command->frame < 0 || job->frame_used)
        return true;
    error_set(error, "--frame=%d: no file name has a place for the number", job->command->frame);
    return error_fix(error, "write it as %%04d, as in -o frame.%%04d.exr");
}

bool job_names_fill(RenderJob *job, Error *error)
{
    RenderCommand *command = job->command;
    const char **names[] = {&command->output,   &command->png_path,   &command->stats,  &command->trace,
                            &command->dump_bad, &command->checkpoint, &command->resume, &command->pilot};
    for (size_t i = 0; i < sizeof names / sizeof names[0]; ++i) {
        if (!*names[i] || !frame_name_has(*names[i]))
            continue;
        if (command->frame < 0) {
            error_set(error, "%s has a place for a frame number, but none is given", *names[i]);
            return error_fix(error, "add --frame=N");
        }
        *names[i] = frame_name_fill(&job->names, *names[i], command->frame, error);
        job->frame_used = true;
        if (!*names[i])
            return false;
    }
    return !command->output || frame_check(job, error);
}

/* The image's name: from the command line or the scene's Film, whose name may also have a place for the frame number,
 * or else after the scene file. */
static const char *image_name(RenderJob *job, Error *error)
{
    const RenderCommand *command = job->command;
    const char *film = path_file_name(job->scene.settings.output);
    if (command->output)
        return command->output;
    job->frame_used = job->frame_used || frame_name_has(film);
    if (!frame_check(job, error))
        return NULL;
    if (!film[0])
        return strcmp(command->scene, "-") == 0 ? "stdin" : path_file_name(command->scene);
    return command->frame < 0 ? film : frame_name_fill(&job->names, film, command->frame, error);
}

CheckpointOptions job_checkpoint_options(const RenderCommand *command)
{
    const char *file = command->checkpoint ? command->checkpoint : command->resume;
    return (CheckpointOptions){.file = file,
                               .every =
                                   command->checkpoint_every > 0.0 ? command->checkpoint_every : CHECKPOINT_SECONDS,
                               .resume = command->resume,
                               .anew = command->checkpoint && command->resume && path_same(file, command->resume)};
}

bool job_outputs_name(RenderJob *job, Error *error)
{
    const RenderCommand *command = job->command;
    const char *image = image_name(job, error);
    if (!image)
        return false;
    if (command->shard.count > 0)
        return part_output_name(&job->part, command->output, image, command->shard, error);
    return render_output_name(&job->output, image, command->png, command->png_path, error);
}

const char *job_target(const RenderJob *job)
{
    return job->part.path[0] ? job->part.path : job->output.exr;
}

bool job_outputs_check(RenderJob *job, Error *error)
{
    const RenderCommand *command = job->command;
    RenderOutput *output = &job->output;
    const CheckpointOptions checkpoint = job_checkpoint_options(command);
    const char *stats = command->stats && !stats_to_output(command->stats) ? command->stats : NULL;
    output->picture = (PictureSettings){.scale = job->scene.settings.film_scale,
                                        .despeckle = command->despeckle,
                                        .layers = job->layers.wanted != 0 ? &job->layers : NULL};
    output->exposure = (float)command->exposure;
    output->scene_file = command->scene;
    output->integrator = command->integrator;
    output->seed = command->seed;
    output->max_depth = job->scene.settings.max_depth;
    camera_matrices(&job->scene.camera_settings, &job->scene.frame.camera, job->scene.origin, output->world_to_camera,
                    output->world_to_ndc);
    const CommandFile files[] = {{"the scene", strcmp(command->scene, "-") == 0 ? NULL : command->scene, false},
                                 {job->part.path[0] ? "the part" : "the image", job_target(job), true},
                                 {"the PNG", output->png[0] ? output->png : NULL, true},
                                 {"the statistics", stats, true},
                                 {"the trace", command->trace, true},
                                 {"the list of chains", command->dump_bad, true},
                                 {"the checkpoint", checkpoint.file, true},
                                 {"the pilot", command->pilot, false}};
    return output_files_check(
        files, sizeof files / sizeof files[0],
        "give each its own name, with --output, --png, --stats, --trace, --dump-bad and --checkpoint", error);
}
