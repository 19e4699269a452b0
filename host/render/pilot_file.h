/* --pilot: a checkpoint of a short rendering of the picture, from which a shard takes what has been learnt of it. The
 * samples and the chains of that rendering are not taken: those of all shards are to be independent. */
#ifndef TWINLIGHT_RENDER_PILOT_FILE_H
#define TWINLIGHT_RENDER_PILOT_FILE_H

#include "render/checkpoint.h"

typedef struct PilotFile {
    ArchiveReader reader; /* between pilot_file_open and pilot_file_restore */
    const char *path; /* NULL: there is none */
} PilotFile;

/* Opens the file of run->options->pilot, if there is one and no checkpoint is resumed, and checks that it is of the
 * picture that the run renders a shard of. Call pilot_file_close even on failure. */
bool pilot_file_open(PilotFile *pilot, RenderRun *run, const Integrator *integrator, const Scene *scene, Error *error);
void pilot_file_close(PilotFile *pilot);

/* Restores the integrator's state alone; the film and the layers remain as they are. The film must have its quantum. */
bool pilot_file_restore(RenderRun *run, CheckpointState state, Error *error);

#endif
