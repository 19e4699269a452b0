/* Names of the state words of bidirectional integrators (path/bd_state.h, path/ib_weight.h), for --verify. */
#ifndef TWINLIGHT_RENDER_BD_FIELDS_H
#define TWINLIGHT_RENDER_BD_FIELDS_H

#include "backend/backend.h"

#include "path/bd_state.h"

/* The state words that all bidirectional integrators have, as initialisers of StateField. */
#define BD_FIELD_LIST                                                                                                  \
    {BUFFER_PATHS, BD_PIXEL, 1, false, "pixel"}, {BUFFER_PATHS, BD_SAMPLE, 1, false, "sample"},                        \
        {BUFFER_PATHS, BD_WEIGHT, 1, true, "filter weight"}, {BUFFER_PATHS, BD_RADIANCE, 3, true, "radiance"},         \
        {BUFFER_PATHS, BD_LENGTHS, 1, false, "numbers of vertices"},                                                   \
        {BUFFER_PATHS, BD_LIGHT_DELTA, 1, false, "delta vertices of the light"},                                       \
        {BUFFER_PATHS, BD_CAMERA_DELTA, 1, false, "delta vertices of the camera"},                                     \
        {BUFFER_PATHS, BD_EMITTER, 1, false, "light"},                                                                 \
        {BUFFER_PATHS, BD_EMITTER_FLAGS, 1, false, "flags of the light"},                                              \
        {BUFFER_PATHS, BD_CONNECT, 1, true, "ratio of the light's densities"},                                         \
        {BUFFER_PATHS, BD_SIDE, 1, false, "side"}, {BUFFER_PATHS, BD_DEPTH, 1, false, "depth"},                        \
        {BUFFER_PATHS, BD_BETA, 3, true, "throughput"},                                                                \
        {BUFFER_PATHS, BD_PDF, 1, true, "density of the last direction"},                                              \
        {BUFFER_PATHS, BD_WALK_FLAGS, 1, false, "flags of the walk"},                                                  \
        {BUFFER_PATHS, BD_ROULETTE_SCALE, 1, true, "roulette scale"}, {BUFFER_PATHS, BD_S, 1, false, "s"},             \
        {BUFFER_PATHS, BD_T, 1, false, "t"},                                                                           \
        {BUFFER_PATHS, BD_CONTRIBUTION, 3, true, "contribution of the connection"},                                    \
        {BUFFER_PATHS, BD_TARGET, 1, false, "pixel of the connection"},                                                \
        {BUFFER_PATHS, BD_TARGET_WEIGHT, 1, true, "filter weight of the connection"},                                  \
        {BUFFER_PATHS, BD_OFFSET, 1, false, "place in the pixel's filter"},                                            \
        {BUFFER_PATHS, BD_TARGET_OFFSET, 1, false, "place of the connection in its pixel's filter"},                   \
        {BUFFER_PATHS, BD_COVER, 1, true, "filter cover"}, {BUFFER_PATHS, BD_IMPORTANCE, 1, true, "importance"},       \
        {BUFFER_PATHS, BD_TARGET_IMPORTANCE, 1, true, "target importance"},                                            \
        {BUFFER_PATHS, BD_CANDIDATE_SUM, 1, true, "luminance of candidates"},                                          \
        {BUFFER_PATHS, BD_CANDIDATE, 1, false, "candidate"},                                                           \
        {BUFFER_PATHS, BD_CANDIDATE_LUMINANCE, 1, true, "luminance of the candidate"},                                 \
        {BUFFER_PATHS, BD_CONNECTION_SURVIVAL, 1, true, "survival of the connection"},                                 \
        {BUFFER_PATHS, BD_GATHERED, 1, false, "segments of what is gathered"},                                         \
    {                                                                                                                  \
        BUFFER_PATHS, BD_SURVIVAL, 1, true, "survival of the walk"                                                     \
    }

/* All fields; those after the first BD_FIELD_COUNT belong to IBPT alone. */
#define BD_FIELD_COUNT 33
#define IB_FIELD_COUNT (BD_FIELD_COUNT + 6)
extern const StateField BD_FIELDS[IB_FIELD_COUNT];

/* Records BDPT, or with frame->pool.enabled a pool for chains, whose samples end in BUFFER_PASS (chain/pool.h). Free
 * `list` with step_list_destroy. */
bool bdpt_list(FrameParams *frame, StepList *list, Error *error);

#endif
