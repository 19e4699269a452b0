#include "render/checkpoint.h"

#include "base/log.h"
#include "base/path_name.h"
#include "base/timing.h"
#include "render/error_watch.h"
#include "render/layers.h"

#include <errno.h>
#include <string.h>
#include <unistd.h>

#define PREVIOUS ".previous"

/* Room for the name of the previous file. */
#define NAME_MAX_BYTES (PATH_MAX + sizeof PREVIOUS)

/* ---- names ------------------------------------------------------------------------------------------------------- */

/* The file that `path` leads to, and the one before it. */
static bool names_make(const char *path, char file[PATH_MAX], char previous[NAME_MAX_BYTES], Error *error)
{
    if (!path_target(path, file))
        return error_errno(error, "use", path);
    snprintf(previous, NAME_MAX_BYTES, "%s" PREVIOUS, file);
    return true;
}

/* Sets *there to whether the file or the one before it exists. */
static bool files_there(const char *path, bool *there, Error *error)
{
    char file[PATH_MAX], previous[NAME_MAX_BYTES];
    *there = false;
    if (!names_make(path, file, previous, error))
        return false;
    *there = access(file, F_OK) == 0 || access(previous, F_OK) == 0;
    return true;
}

/* Whether the file that is resumed is the one that is written to. */
static bool files_same(const CheckpointOptions *options)
{
    return options->file && options->resume && path_same(options->file, options->resume);
}

/* What is written to must not be there, unless it is resumed. */
static bool written_check(const CheckpointOptions *options, Error *error)
{
    bool there;
    if (!options->file || files_same(options))
        return true;
    if (!files_there(options->file, &there, error))
        return false;
    if (!there)
        return true;
    error_set(error, "--checkpoint=%s: there is such a file, or one named %s" PREVIOUS, options->file, options->file);
    return error_fix(error, "add --resume=%s to go on from it, or remove it", options->file);
}

bool checkpoint_files_check(const CheckpointOptions *options, Error *error)
{
    bool there;
    if (!written_check(options, error))
        return false;
    if (!options->resume || options->anew)
        return true;
    if (!files_there(options->resume, &there, error))
        return false;
    if (there)
        return true;
    error_set(error, "--resume=%s: there is no such file", options->resume);
    return error_fix(error,
                     "give the file of a --checkpoint; with --checkpoint=%s as well, the rendering starts anew if "
                     "there is none",
                     options->resume);
}

/* ---- contents ---------------------------------------------------------------------------------------------------- */

void checkpoint_head_archive(Archive *archive, Identity *identity, bool *other)
{
    archive_head(archive, "checkpoint", other);
    ARCHIVE_FIELD(archive, *identity);
}

void checkpoint_image_archive(Archive *archive, Film *film, RenderLayers *layers, CheckpointState state)
{
    film_archive(archive, film);
    if (layers)
        render_layers_archive(archive, layers);
    state.archive(state.context, archive);
}

/* ---- writing ----------------------------------------------------------------------------------------------------- */

static void run_archive(RenderRun *run, CheckpointState state, Archive *archive)
{
    RenderTotals totals = render_run_totals(run);
    bool other;
    checkpoint_head_archive(archive, &run->checkpoint->identity, &other);
    ARCHIVE_FIELD(archive, run->film->quantum_exponent);
    render_totals_archive(archive, &totals);
    error_watch_archive(archive, &run->error);
    checkpoint_image_archive(archive, run->film, run->options->layers, state);
}

/* Moves the new file to its name, and the old one to that of the previous one. A file that is not known to be whole
 * must not replace the previous one, which may be what was resumed. */
static bool files_rename(Checkpoint *checkpoint, ArchiveWriter *writer, Error *error)
{
    char previous[NAME_MAX_BYTES];
    snprintf(previous, sizeof previous, "%s" PREVIOUS, writer->file.path);
    if (checkpoint->whole && rename(writer->file.path, previous) != 0 && errno != ENOENT)
        return error_errno(error, "write", previous);
    checkpoint->whole = output_file_commit(&writer->file, error);
    return checkpoint->whole;
}

static bool checkpoint_write(RenderRun *run, CheckpointState state, Error *error)
{
    Checkpoint *checkpoint = run->checkpoint;
    double begin = timing_now();
    ArchiveWriter writer;
    BackendStatistics statistics;
    run->interface->statistics(run->backend, &statistics);
    checkpoint->last = begin;
    if (!render_run_gather(run, error))
        return false;
    bool good = archive_writer_begin(&writer, run->options->checkpoint.file, statistics.threads, error);
    if (good)
        run_archive(run, state, &writer.archive);
    good = good && archive_writer_finish(&writer, error);
    off_t bytes = good ? lseek(writer.file.descriptor, 0, SEEK_END) : 0;
    good = good && files_rename(checkpoint, &writer, error);
    archive_writer_destroy(&writer);
    checkpoint->last = timing_now();
    if (good) {
        checkpoint->written = run->done;
        snprintf(checkpoint->cost, sizeof checkpoint->cost, ", %.3g MB, written in %.2g s", 1e-6 * (double)bytes,
                 checkpoint->last - begin);
    }
    return good;
}

void checkpoint_save_if_due(RenderRun *run, CheckpointState state)
{
    Checkpoint *checkpoint = run->checkpoint;
    Error error = {0};
    if (!checkpoint || timing_now() - checkpoint->last < run->options->checkpoint.every)
        return;
    bool written = checkpoint_write(run, state, &error);
    /* One warning per series of failures. */
    if (!written && !checkpoint->failed)
        log_message(LOG_WARNING, "%s; rendering continues, and another checkpoint will be tried", error_text(&error));
    if (written && checkpoint->failed)
        log_message(LOG_INFO, "writing a checkpoint succeeded again");
    checkpoint->failed = !written;
}

bool checkpoint_end(RenderRun *run, CheckpointState state, Error *error)
{
    const Checkpoint *checkpoint = run->checkpoint;
    if (!checkpoint)
        return true;
    if (run->done == 0 || !state.archive) {
        log_message(LOG_WARNING, "%s is not written: nothing is finished from which a rendering could go on",
                    run->options->checkpoint.file);
        return true;
    }
    if (checkpoint->written != run->done && !checkpoint_write(run, state, error))
        return false;
    log_message(LOG_INFO, "%s holds a checkpoint of %.6g samples per pixel%s", run->options->checkpoint.file,
                (double)run->done / (double)run->crop_pixels, checkpoint->cost);
    return true;
}

/* ---- resuming ---------------------------------------------------------------------------------------------------- */

/* Opens a file that is whole and of this rendering. what: its name for messages. *damaged: whether it is not whole, so
 * that another may do. */
static bool file_open(Checkpoint *checkpoint, const char *path, const char *what, bool *damaged, Error *error)
{
    ArchiveReader *reader = &checkpoint->reader;
    Identity saved = {{0}};
    const IdentityUse use = {what, "this rendering", "resume with what it is of, or begin with a new --checkpoint"};
    bool other;
    *damaged = true;
    if (!archive_reader_open(reader, path, error))
        return false;
    checkpoint_head_archive(&reader->archive, &saved, &other);
    saved.text[sizeof saved.text - 1] = '\0';
    *damaged = reader->archive.failed && !other;
    if (other) {
        error_set(error, "%s cannot be resumed: %s", what, error_text(&reader->archive.error));
        error_fix(error, "give the file of a --checkpoint");
    } else if (*damaged)
        *error = reader->archive.error;
    else if (identity_compare(&saved, &checkpoint->identity, &use, error))
        return true;
    archive_reader_close(reader);
    return false;
}

/* Opens the file, or the one before it if it is missing or damaged. */
static bool files_open(Checkpoint *checkpoint, const char *path, Error *error)
{
    char file[PATH_MAX], previous[NAME_MAX_BYTES];
    bool damaged;
    Error first = {0}, second = {0};
    if (!names_make(path, file, previous, error))
        return false;
    snprintf(checkpoint->resumed, sizeof checkpoint->resumed, "%s", path);
    checkpoint->whole = file_open(checkpoint, file, path, &damaged, &first);
    if (checkpoint->whole)
        return true;
    if (!damaged) {
        *error = first;
        return false;
    }
    snprintf(checkpoint->resumed, sizeof checkpoint->resumed, "%s" PREVIOUS, path);
    if (file_open(checkpoint, previous, checkpoint->resumed, &damaged, &second)) {
        log_message(LOG_WARNING, "%s cannot be resumed: %s; going on from %s" PREVIOUS, path, error_text(&first), path);
        return true;
    }
    *error = second;
    if (!damaged)
        return false;
    error_set(error, "%s cannot be resumed: %s", path, error_text(&first));
    return error_fix(error, "there is no whole %s" PREVIOUS " either; remove them, and begin again", path);
}

static bool failure_set(const Checkpoint *checkpoint, Error *error)
{
    error_set(error, "%s cannot be resumed: %s", checkpoint->resumed, error_text(&checkpoint->reader.archive.error));
    return error_fix(error, "it is damaged in spite of its checksum; remove it, and begin again");
}

/* Fails if fewer samples are wanted than there are. */
static bool samples_check(const RenderRun *run, Error *error)
{
    const RenderTotals *past = &run->past;
    unsigned wanted = run->options->samples;
    if (wanted == 0 || wanted == past->samples || past->done <= wanted * run->crop_pixels)
        return true;
    error_set(error, "--samples=%u: %s already has %.6g samples per pixel", wanted, run->checkpoint->resumed,
              (double)past->done / (double)run->crop_pixels);
    return error_fix(error, "give as many as there are to be in all, with those that are done");
}

/* Restores what the set-up of a rendering depends on. */
static bool past_restore(RenderRun *run, Error *error)
{
    Archive *archive = &run->checkpoint->reader.archive;
    int exponent = 0;
    ARCHIVE_FIELD(archive, exponent);
    if (exponent < -2048 || exponent > 2048)
        archive_fail(archive, "the film's quantum is out of range");
    render_totals_archive(archive, &run->past);
    error_watch_archive(archive, &run->error);
    if (archive->failed)
        return failure_set(run->checkpoint, error);
    run->film->quantum_exponent = exponent;
    run->resumed = true;
    return samples_check(run, error);
}

static bool resume(Checkpoint *checkpoint, RenderRun *run, Error *error)
{
    const CheckpointOptions *options = &run->options->checkpoint;
    bool there = false;
    if (!options->resume)
        return true;
    if (!files_there(options->resume, &there, error))
        return false;
    if (!there) {
        log_message(LOG_INFO, "there is no %s yet: the rendering starts anew", options->resume);
        return true;
    }
    return files_open(checkpoint, options->resume, error) && past_restore(run, error);
}

bool checkpoint_begin(Checkpoint *checkpoint, RenderRun *run, const Integrator *integrator, const Scene *scene,
                      Error *error)
{
    const CheckpointOptions *options = &run->options->checkpoint;
    *checkpoint = (Checkpoint){.written = UINT64_MAX, .last = timing_now()};
    if (!options->file)
        return true;
    run->checkpoint = checkpoint;
    identity_make(&checkpoint->identity, integrator, scene, run->options, &run->frame);
    if (!resume(checkpoint, run, error))
        return false;
    checkpoint->whole = checkpoint->whole && files_same(options);
    return true;
}

void checkpoint_destroy(Checkpoint *checkpoint)
{
    archive_reader_close(&checkpoint->reader);
}

bool checkpoint_restore(RenderRun *run, CheckpointState state, Error *error)
{
    Checkpoint *checkpoint = run->checkpoint;
    if (!run->resumed)
        return true;
    checkpoint_image_archive(&checkpoint->reader.archive, run->film, run->options->layers, state);
    if (!archive_reader_finish(&checkpoint->reader, error))
        return failure_set(checkpoint, error);
    archive_reader_close(&checkpoint->reader);
    run->done = run->past.done;
    if (checkpoint->whole)
        checkpoint->written = run->done;
    log_message(LOG_INFO, "going on from %s: %.6g samples per pixel", checkpoint->resumed,
                (double)run->done / (double)run->crop_pixels);
    return true;
}
