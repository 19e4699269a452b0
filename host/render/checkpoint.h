/* Checkpoints: the state of a rendering between two passes, from which another process goes on to the same image.
 *
 * A file holds what the next pass depends on and does not follow from scene, options and seed: the film's sums, the
 * layers, the integrator's state and what has been counted. It names what it is of (render/identity.h). The last two
 * are kept, FILE and FILE.previous: a new one is written whole under a temporary name before these are renamed, so that
 * there is a whole one at any moment. */
#ifndef TWINLIGHT_RENDER_CHECKPOINT_H
#define TWINLIGHT_RENDER_CHECKPOINT_H

#include "base/archive_file.h"
#include "render/identity.h"
#include "render/run.h"

#define CHECKPOINT_SECONDS 600.0 /* between two, by default */

typedef struct Checkpoint {
    Identity identity;
    ArchiveReader reader; /* of the file that is resumed, between checkpoint_begin and checkpoint_restore */
    char resumed[PATH_MAX]; /* its name */
    bool whole; /* the file under options->file is known to be a whole checkpoint, which may become the previous one */
    uint64_t written; /* RenderRun.done in that file; UINT64_MAX: none */
    double last; /* time of the latest attempt */
    bool failed; /* it failed */
    char cost[64]; /* of the latest file, as text; "": none was written */
} Checkpoint;

/* What an integrator keeps between passes. */
typedef struct CheckpointState {
    void (*archive)(void *context, Archive *archive); /* NULL: nothing is finished that could be saved */
    void *context;
} CheckpointState;

/* Whether the files named are there as they must be, before the scene is loaded: what is resumed, unless the rendering
 * may start anew; and what is written to must not be there, unless it is what is resumed. */
bool checkpoint_files_check(const CheckpointOptions *options, Error *error);

/* Sets run->checkpoint if options say so, opens the file to resume, checks that it is of this rendering, and restores
 * what the set-up depends on: quantum, photons, counts. run->film must have its filter and the sums of its integrator.
 * Call checkpoint_destroy even on failure. */
bool checkpoint_begin(Checkpoint *checkpoint, RenderRun *run, const Integrator *integrator, const Scene *scene,
                      Error *error);
void checkpoint_destroy(Checkpoint *checkpoint);

/* Restores film, layers and state if a checkpoint is resumed. All of them must have their sizes. On failure run->done
 * is 0: the film holds no image. */
bool checkpoint_restore(RenderRun *run, CheckpointState state, Error *error);

/* The parts of a file: what it begins with (*other: archive_head), and what is at its end. layers: NULL if there are
 * none. */
void checkpoint_head_archive(Archive *archive, Identity *identity, bool *other);
void checkpoint_image_archive(Archive *archive, Film *film, struct RenderLayers *layers, CheckpointState state);

/* Writes a checkpoint if one is due. A failure causes a warning; the next attempt is made when the next is due. */
void checkpoint_save_if_due(RenderRun *run, CheckpointState state);

/* Writes the last checkpoint of a rendering that is done or stopped, unless nothing is new since the latest. */
bool checkpoint_end(RenderRun *run, CheckpointState state, Error *error);

#endif
