/* Traces light subpaths through smooth specular surfaces on a backend, some at a time (kernels/photon.cl). */
#ifndef TWINLIGHT_RENDER_PHOTON_PASS_H
#define TWINLIGHT_RENDER_PHOTON_PASS_H

#include "backend/backend.h"
#include "render/run.h"

/* Subpaths of a pass. */
#define PASS_PATHS 65536u

/* A light subpath that has arrived at a receiver, as kernels/photon.cl hands it back. */
typedef struct PhotonPath {
    uint number; /* which random numbers it has */
    uint light;
    uint vertices, lobes; /* smooth specular vertices, and which of them transmitted */
    Vec3 origin, first; /* its first ray */
    Vec3 point; /* where it has arrived */
    Vec3 last; /* direction of its last ray */
} PhotonPath;

typedef struct PhotonPass {
    const RenderRun *run;
    StepList list;
    uint *words; /* PHOTON_PATH_WORDS fields of PASS_PATHS items */
} PhotonPass;

/* Call photon_pass_destroy even on failure. */
bool photon_pass_init(PhotonPass *pass, const RenderRun *run, Error *error);
void photon_pass_destroy(PhotonPass *pass);

/* Item `item` of the next pass: subpath `number`, to be drawn from the lights. */
void photon_pass_draw(PhotonPass *pass, uint item, uint number);
/* The same, aimed at a point; it is not traced if the light emits nothing that way. */
void photon_pass_aim(PhotonPass *pass, uint item, uint number, Vec3 through);
/* The same, to begin as `path` does, with the lobes that its number draws. */
void photon_pass_follow(PhotonPass *pass, uint item, const PhotonPath *path);

/* Traces the first `count` items. *whole: set to false by a stop. */
bool photon_pass_run(PhotonPass *pass, uint count, bool *whole, Error *error);

/* Reads item `item` of a finished pass; false if it has not arrived. */
bool photon_pass_get(const PhotonPass *pass, uint item, PhotonPath *path);

#endif
