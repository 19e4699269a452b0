/* What a rendering is of, as text: program, algorithm, options and scene, as far as the state of a rendering depends on
 * them. A checkpoint is resumed only by a rendering of the same identity, and parts are merged only with parts of it.
 * Limits of samples and time, threads, backend and output do not belong to it. */
#ifndef TWINLIGHT_RENDER_IDENTITY_H
#define TWINLIGHT_RENDER_IDENTITY_H

#include "render/integrator.h"
#include "scene/scene.h"

#define IDENTITY_TEXT_MAX 2048u

typedef struct Identity {
    char text[IDENTITY_TEXT_MAX]; /* lines "NAME=VALUE\n", in the same order for the same version; the rest is 0 */
} Identity;

/* Sets one that names the version of the program alone. */
void identity_begin(Identity *identity);

/* frame: from render_frame. A shard with a count but without a number: any part of the picture that so many shards
 * share. */
void identity_make(Identity *identity, const Integrator *integrator, const Scene *scene, const RenderOptions *options,
                   const FrameParams *frame);

/* How an error names the two that are compared, and what to do. */
typedef struct IdentityUse {
    const char *saved, *now; /* "pool.ck", "this rendering" */
    const char *fix;
} IdentityUse;

/* Whether both are the same; otherwise sets an error that names the first difference. The text of `saved` need not
 * end. */
bool identity_compare(const Identity *saved, const Identity *now, const IdentityUse *use, Error *error);

/* Whether an identity read from the file `what` is of this version of the program, so that what
 * follows can be read; otherwise sets an error. */
bool identity_of_this_version(const Identity *saved, const char *what, Error *error);

#endif
