#include "render/photon_pass.h"

#include "backend/step_recorder.h"
#include "layout/kernel_list.h"
#include "layout/photon_map.h"
#include "path/photon_path.h"

#include <stdlib.h>

bool photon_pass_init(PhotonPass *pass, const RenderRun *run, Error *error)
{
    Recorder recorder;
    size_t words = (size_t)PASS_PATHS * PHOTON_PATH_WORDS;
    *pass = (PhotonPass){.run = run, .words = calloc(words, sizeof *pass->words)};
    if (!pass->words)
        return error_memory(error, words * sizeof *pass->words, "photons");
    if (!recorder_init(&recorder, 2 + 3 * (CAUSTIC_VERTICES + 1), error))
        return false;
    recorder_kernel(&recorder, KERNEL_photon_start, false);
    recorder_walk(&recorder, CAUSTIC_VERTICES + 1, KERNEL_photon_walk, KERNEL_COUNT);
    recorder_kernel(&recorder, KERNEL_photon_end, false);
    pass->list = recorder_list(&recorder, &run->frame, PHOTON_PATH_WORDS, NULL, 0);
    pass->list.words_per_item[BUFFER_SHADOWS] = 0;
    pass->list.words_per_item[BUFFER_SPLATS] = 0;
    pass->list.pass_words = pass->words;
    pass->list.pass_fields = PHOTON_PATH_WORDS;
    pass->list.pass_stride = PASS_PATHS;
    return true;
}

void photon_pass_destroy(PhotonPass *pass)
{
    step_list_destroy(&pass->list);
    free(pass->words);
}

bool photon_pass_run(PhotonPass *pass, uint count, bool *whole, Error *error)
{
    const RenderRun *run = pass->run;
    const SplatSink sink = {.whole = true};
    FrameParams frame = run->frame;
    uint64_t delivered = 0;
    frame.pass.first_item = 0;
    frame.pass.item_count = count;
    if (!run->interface->run(run->backend, &frame, &pass->list, &sink, render_run_stop(run), &delivered, error))
        return false;
    *whole = delivered == count;
    return true;
}

static void word_put(PhotonPass *pass, uint field, uint item, uint word)
{
    pass->words[(size_t)field * PASS_PATHS + item] = word;
}

static void vector_put(PhotonPass *pass, uint field, uint item, Vec3 v)
{
    word_put(pass, field, item, float_bits(v.x));
    word_put(pass, field + 1, item, float_bits(v.y));
    word_put(pass, field + 2, item, float_bits(v.z));
}

static uint word_get(const PhotonPass *pass, uint field, uint item)
{
    return pass->words[(size_t)field * PASS_PATHS + item];
}

static Vec3 vector_get(const PhotonPass *pass, uint field, uint item)
{
    return vec3(bits_float(word_get(pass, field, item)), bits_float(word_get(pass, field + 1, item)),
                bits_float(word_get(pass, field + 2, item)));
}

void photon_pass_draw(PhotonPass *pass, uint item, uint number)
{
    word_put(pass, PHOTON_PATH_NUMBER, item, number);
    word_put(pass, PHOTON_PATH_EMITTER, item, NONE);
}

void photon_pass_aim(PhotonPass *pass, uint item, uint number, Vec3 through)
{
    word_put(pass, PHOTON_PATH_NUMBER, item, number);
    word_put(pass, PHOTON_PATH_EMITTER, item, PHOTON_AIMED);
    vector_put(pass, PHOTON_PATH_ORIGIN, item, through);
}

void photon_pass_follow(PhotonPass *pass, uint item, const PhotonPath *path)
{
    word_put(pass, PHOTON_PATH_NUMBER, item, path->number);
    word_put(pass, PHOTON_PATH_EMITTER, item, path->light);
    vector_put(pass, PHOTON_PATH_ORIGIN, item, path->origin);
    vector_put(pass, PHOTON_PATH_FIRST, item, path->first);
}

bool photon_pass_get(const PhotonPass *pass, uint item, PhotonPath *path)
{
    if (word_get(pass, PHOTON_PATH_ARRIVED, item) == 0)
        return false;
    path->number = word_get(pass, PHOTON_PATH_NUMBER, item);
    path->light = word_get(pass, PHOTON_PATH_EMITTER, item);
    path->vertices = word_get(pass, PHOTON_PATH_VERTICES, item);
    path->lobes = word_get(pass, PHOTON_PATH_LOBES, item);
    path->origin = vector_get(pass, PHOTON_PATH_ORIGIN, item);
    path->first = vector_get(pass, PHOTON_PATH_FIRST, item);
    path->point = vector_get(pass, PHOTON_PATH_POINT, item);
    path->last = vector_get(pass, PHOTON_PATH_LAST, item);
    return true;
}
