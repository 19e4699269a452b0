#include "bd_fields.h"

#include "bd_state.h"
#include "ib_weight.h"

const StateField BD_FIELDS[IB_FIELD_COUNT] = {
    {BUFFER_PATHS, BD_PIXEL, 1, false, "pixel"},
    {BUFFER_PATHS, BD_SAMPLE, 1, false, "sample"},
    {BUFFER_PATHS, BD_WEIGHT, 1, true, "filter weight"},
    {BUFFER_PATHS, BD_RADIANCE, 3, true, "radiance"},
    {BUFFER_PATHS, BD_LENGTHS, 1, false, "numbers of vertices"},
    {BUFFER_PATHS, BD_LIGHT_DELTA, 1, false, "delta vertices of the light"},
    {BUFFER_PATHS, BD_CAMERA_DELTA, 1, false, "delta vertices of the camera"},
    {BUFFER_PATHS, BD_EMITTER, 1, false, "light"},
    {BUFFER_PATHS, BD_EMITTER_FLAGS, 1, false, "flags of the light"},
    {BUFFER_PATHS, BD_CONNECT, 1, true, "ratio of the light's densities"},
    {BUFFER_PATHS, BD_SIDE, 1, false, "side"},
    {BUFFER_PATHS, BD_DEPTH, 1, false, "depth"},
    {BUFFER_PATHS, BD_BETA, 3, true, "throughput"},
    {BUFFER_PATHS, BD_PDF, 1, true, "density of the last direction"},
    {BUFFER_PATHS, BD_WALK_FLAGS, 1, false, "flags of the walk"},
    {BUFFER_PATHS, BD_ETA_SCALE, 1, true, "eta^2"},
    {BUFFER_PATHS, BD_BACK, 1, true, "factor of the way back"},
    {BUFFER_PATHS, BD_S, 1, false, "s"},
    {BUFFER_PATHS, BD_T, 1, false, "t"},
    {BUFFER_PATHS, BD_CONTRIBUTION, 3, true, "contribution of the connection"},
    {BUFFER_PATHS, BD_TARGET, 1, false, "pixel of the connection"},
    {BUFFER_PATHS, BD_TARGET_WEIGHT, 1, true, "filter weight of the connection"},
    {BUFFER_PATHS, BD_SPLAT, 1, false, "pixel of the splat"},
    {BUFFER_PATHS, BD_CANDIDATE_SUM, 1, true, "luminance of candidates"},
    {BUFFER_PATHS, BD_CANDIDATE, 1, false, "candidate"},
    {BUFFER_PATHS, IB_PRODUCT, 1, true, "product of ratios"},
    {BUFFER_PATHS, IB_PRODUCT + 1u, 1, false, "its exponent"},
    {BUFFER_PATHS, IB_OWN, 1, true, "density of the vertex"},
    {BUFFER_PATHS, IB_OWN_BEFORE, 1, true, "density of the vertex before it"},
    {BUFFER_PATHS, IB_FIRST_RATIO, 1, true, "ratio of the light's point"},
    {BUFFER_PATHS, IB_FIRST_DELTA, 1, false, "whether the first vertex is a delta"},
};
