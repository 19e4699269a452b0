/* What a rendering is of, as text: program, algorithm, options and scene, as far as the state of a rendering depends on
 * them. A checkpoint is resumed only by a rendering of the same identity. Limits of samples and time, threads, backend
 * and output are not part of it. */
#ifndef TWINLIGHT_RENDER_IDENTITY_H
#define TWINLIGHT_RENDER_IDENTITY_H

#include "render/integrator.h"
#include "scene/scene.h"

#define IDENTITY_TEXT_MAX 2048u

typedef struct Identity {
    char text[IDENTITY_TEXT_MAX]; /* lines "NAME=VALUE\n", in the same order for the same version; the rest is 0 */
} Identity;

/* frame: from render_frame. */
void identity_make(Identity *identity, const Integrator *integrator, const Scene *scene, const RenderOptions *options,
                   const FrameParams *frame);

/* Whether both are the same; otherwise sets an error that names the first difference. what: name of what has the identity
 * `saved`, whose text need not end. */
bool identity_compare(const Identity *saved, const Identity *now, const char *what, Error *error);

#endif
