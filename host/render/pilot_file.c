#include "render/pilot_file.h"

#include "base/log.h"
#include "render/error_watch.h"
#include "render/layers.h"

/* Reads the beginning of the file. */
static bool head_read(PilotFile *pilot, const Identity *own, Error *error)
{
    Archive *archive = &pilot->reader.archive;
    const IdentityUse use = {pilot->path, "this rendering",
                             "give a checkpoint of the whole picture, with the same scene and options but for --shard"};
    Identity saved = {{0}};
    bool other;
    checkpoint_head_archive(archive, &saved, &other);
    saved.text[sizeof saved.text - 1] = '\0';
    if (!archive->failed)
        return identity_compare(&saved, own, &use, error);
    error_set(error, "--pilot=%s: %s", pilot->path, error_text(&archive->error));
    return error_fix(error, "give the file of a --checkpoint of mmlt");
}

bool pilot_file_open(PilotFile *pilot, RenderRun *run, const Integrator *integrator, const Scene *scene, Error *error)
{
    RenderOptions whole = *run->options;
    Identity own;
    Error opening = {0};
    *pilot = (PilotFile){.path = NULL};
    if (!whole.pilot || run->resumed)
        return true;
    pilot->path = whole.pilot;
    whole.shard = (Shard){0, 0};
    identity_make(&own, integrator, scene, &whole, &run->frame);
    if (!archive_reader_open(&pilot->reader, pilot->path, &opening)) {
        error_set(error, "--pilot=%s: %s", pilot->path, error_text(&opening));
        return error_fix(error, "give a whole file of a --checkpoint");
    }
    run->pilot = pilot;
    return head_read(pilot, &own, error);
}

void pilot_file_close(PilotFile *pilot)
{
    archive_reader_close(&pilot->reader);
}

/* Reads the rest of the file, its image to a film and layers that are not needed. */
static bool state_read(RenderRun *run, Film *film, RenderLayers *layers, CheckpointState state, Error *error)
{
    Archive *archive = &run->pilot->reader.archive;
    const Film *own = run->film;
    RenderTotals totals = {0};
    ErrorWatch watch = {.work = 0};
    int exponent = 0;
    ARCHIVE_FIELD(archive, exponent);
    render_totals_archive(archive, &totals);
    error_watch_archive(archive, &watch);
    if (!archive->failed && exponent != own->quantum_exponent)
        archive_fail(archive, "it was made by a device with other bits");
    checkpoint_image_archive(archive, film, run->options->layers ? layers : NULL, state);
    if (archive_reader_finish(&run->pilot->reader, error))
        return true;
    Error first = *error;
    error_set(error, "--pilot=%s: %s", run->pilot->path, error_text(&first));
    return error_fix(error, "make the pilot again");
}

bool pilot_file_restore(RenderRun *run, CheckpointState state, Error *error)
{
    const RenderLayers *own = run->options->layers;
    Film film = {0};
    RenderLayers layers = {0};
    bool done = film_init_like(&film, run->film, error) &&
                (!run->film->depth_sums || film_depths_reserve(&film, run->film->depth_last, error)) &&
                (!own || render_layers_init(&layers, own->wanted, own->keep_halves, &film, error)) &&
                state_read(run, &film, &layers, state, error);
    film_destroy(&film);
    render_layers_destroy(&layers);
    if (done)
        log_message(LOG_INFO, "beginning with what %s has learnt", run->pilot->path);
    return done;
}
