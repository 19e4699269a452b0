#include "command/part_output.h"

#include "base/path_name.h"
#include "render/render.h"
#include "render/shard.h"

#include <stdio.h>
#include <string.h>

bool part_output_name(PartOutput *part, const char *given, const char *image, Shard shard, Error *error)
{
    const char *name = path_file_name(image), *dot = strrchr(name, '.');
    size_t stem = dot && dot != name ? (size_t)(dot - image) : strlen(image);
    int length = given ? snprintf(part->path, sizeof part->path, "%s", given)
                       : snprintf(part->path, sizeof part->path, "%.*s-%uof%u.part", (int)stem, image, shard.number,
                                  shard.count);
    if (length >= 0 && (size_t)length < sizeof part->path)
        return true;
    error_set(error, "the file name is too long: %.200s...", given ? given : image);
    return error_fix(error, "give a shorter one with --output");
}

/* Of the whole picture that the shard is one of. */
static void identity_set(PartHead *head, const Integrator *integrator, const Scene *scene, const RenderOptions *options)
{
    RenderOptions picture = *options;
    FrameParams frame;
    picture.shard.number = 0;
    render_frame(integrator, scene, options, &frame);
    identity_make(&head->identity, integrator, scene, &picture, &frame);
}

void part_output_begin(PartOutput *part, const RenderOutput *output, const Integrator *integrator, const Scene *scene,
                       const RenderOptions *options)
{
    const int *crop = scene->settings.crop;
    uint64_t pixels = (uint64_t)(crop[2] - crop[0]) * (uint64_t)(crop[3] - crop[1]);
    PartHead *head = &part->head;
    PartPicture *picture = &head->picture;
    memset(head, 0, sizeof *head);
    identity_set(head, integrator, scene, options);
    head->shard = options->shard;
    if (options->samples > 0)
        head->wanted = integrator->render ? shard_work(options, pixels) : shard_samples(options).count * pixels;
    picture->max_depth = output->max_depth;
    picture->seed = output->seed;
    picture->scale = output->picture.scale;
    memcpy(picture->world_to_camera, output->world_to_camera, sizeof picture->world_to_camera);
    memcpy(picture->world_to_ndc, output->world_to_ndc, sizeof picture->world_to_ndc);
    snprintf(picture->scene, sizeof picture->scene, "%s", path_file_name(output->scene_file));
    snprintf(picture->integrator, sizeof picture->integrator, "%s", output->integrator);
    part->layers = options->layers;
}

bool part_output_write(PartOutput *part, Film *film, const RenderTotals *totals, Error *error)
{
    part->head.totals = *totals;
    part_head_film(&part->head, film, part->layers);
    return part_write(part->path, &part->head, film, part->layers, part->threads > 0 ? part->threads : 1, error);
}

void part_output_adopt(RenderOutput *output, const PartHead *head)
{
    const PartPicture *picture = &head->picture;
    output->picture.scale = picture->scale;
    output->scene_file = picture->scene;
    output->integrator = picture->integrator;
    output->seed = picture->seed;
    output->max_depth = picture->max_depth;
    memcpy(output->world_to_camera, picture->world_to_camera, sizeof output->world_to_camera);
    memcpy(output->world_to_ndc, picture->world_to_ndc, sizeof output->world_to_ndc);
}
