/* What a path of path tracing gathers, and which part of it as what. With frame->partition.split_direct, as one of
 * MMLT's estimators, it keeps apart
 *   - direct light, and what no other estimator shows: what media emit, and what photons draw where no light subpath
 *     can make the path (PATH_OWN),
 *   - of all other light what is below the clamping threshold (PATH_RADIANCE),
 *   - the rest of that, its rare light (PATH_RARE), which chains show, too.
 * Otherwise it gathers all in PATH_RADIANCE. */
#ifndef TWINLIGHT_PATH_PATH_GATHER_H
#define TWINLIGHT_PATH_PATH_GATHER_H

#include "layout/state.h"
#include "math/vec.h"
#include "path/partition.h"
#include "path/path_state.h"

/* With frame->film.split_depths: PATH_RADIANCE has light of paths of `segments` segments. */
SHARED_FUNCTION void path_depth_store(__global const FrameParams *frame, __global uint *restrict paths, uint item,
                                      uint segments)
{
    if (frame->film.split_depths != 0u)
        state_store(paths, frame->pass.stride, PATH_GATHERED, item, segments);
}

SHARED_FUNCTION void path_gather(__global uint *restrict paths, uint stride, uint field, uint item, Vec3 light)
{
    state_store_vec3(paths, stride, field, item, vec3_add(state_load_vec3(paths, stride, field, item), light));
}

/* Direct light, or what path_add_own adds. */
SHARED_FUNCTION void path_gather_apart(__global const FrameParams *frame, __global uint *restrict paths, uint item,
                                       uint segments, Vec3 light)
{
    uint stride = frame->pass.stride, field = PATH_OWN;
    if (frame->partition.split_direct == 0u) {
        field = PATH_RADIANCE;
        path_depth_store(frame, paths, item, segments);
    }
    path_gather(paths, stride, field, item, light);
}

/* Adds light of a path of `segments` segments that no other estimator shows. It shares its layer with direct light, of
 * which bidirectional path tracing has samples, too; so each of its own counts for as many as there are of both. */
SHARED_FUNCTION void path_add_own(__global const FrameParams *frame, __global uint *restrict paths, uint item,
                                  uint segments, Vec3 light)
{
    path_gather_apart(frame, paths, item, segments, vec3_scale(light, 1.0f + frame->partition.own_more));
}

/* Adds light of a path of `segments` segments. shown: the part of it that is below the clamping threshold
 * (path_shown). */
SHARED_FUNCTION void path_add_radiance(__global const FrameParams *frame, __global uint *restrict paths, uint item,
                                       uint segments, Vec3 light, float shown)
{
    uint stride = frame->pass.stride;
    if (segments <= DIRECT_DEPTH) {
        path_gather_apart(frame, paths, item, segments, light);
        return;
    }
    path_depth_store(frame, paths, item, segments);
    path_gather(paths, stride, PATH_RADIANCE, item, vec3_scale(light, shown));
    if (shown < 1.0f)
        path_gather(paths, stride, PATH_RARE, item, vec3_scale(light, 1.0f - shown));
}

/* The part of its contribution that a path of `segments` segments shows. path_tracing: the luminance of f over the sum
 * of the densities of s = 0 and 1, the same whichever of them, or photons, made the path. With
 * frame->partition.split_direct what is below the clamping threshold is shown; the rest is the rare light, which chains
 * (chain/mutation.h) and pt_splat_rare show. */
SHARED_FUNCTION float path_shown(__global const FrameParams *frame, __global const uint *restrict paths, uint item,
                                 uint segments, float path_tracing)
{
    if (frame->partition.split_direct == 0u || segments <= DIRECT_DEPTH)
        return 1.0f;
    float limit = state_load_float(paths, frame->pass.stride, PATH_LIMIT, item);
    path_tracing *= state_load_float(paths, frame->pass.stride, PATH_SURVIVED, item); /* chains have no roulette */
    return partition_shown(path_tracing, limit);
}

#endif
