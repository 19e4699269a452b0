/* What a path keeps between kernels (BUFFER_PATHS), one 32-bit word a field, and how it is stored. */
#ifndef TWINLIGHT_PATH_STATE_H
#define TWINLIGHT_PATH_STATE_H

#include "state.h"

#define PATH_PIXEL 0u /* y * width + x of the whole film */
#define PATH_SAMPLE 1u /* which sample of the pixel */
#define PATH_DEPTH 2u /* segments so far; 0: the path has ended */
#define PATH_FLAGS 3u /* PATH_FLAG_* */
#define PATH_WEIGHT 4u /* of the pixel filter */
#define PATH_BETA 5u /* throughput, 3 */
#define PATH_RADIANCE 8u /* gathered so far, 3 */
#define PATH_PDF_W 11u /* density of the last direction */
#define PATH_ETA_SCALE 12u /* product of eta^2 over refractions, for Russian roulette */
#define PATH_POINT 13u /* the vertex, 3 */
#define PATH_NG 16u /* its geometric normal, 3 */
#define PATH_FRAME_N 19u /* shading frame, 3 */
#define PATH_FRAME_T 22u /* 3 */
#define PATH_WO 25u /* towards the previous vertex, in the frame, 3 */
#define PATH_LIGHT 28u /* contribution of the light sample if it is visible, 3 */
#define PATH_BSDF_KIND 31u
#define PATH_BSDF_FLAGS 32u
#define PATH_BSDF_COLOR0 33u /* 3 */
#define PATH_BSDF_COLOR1 36u /* 3 */
#define PATH_BSDF_ALPHA_X 39u
#define PATH_BSDF_ALPHA_Y 40u
#define PATH_BSDF_ETA 41u
#define PATH_BSDF_COAT 42u
#define PATH_WORDS 43u

#define PATH_FLAG_DELTA 0x1u /* the last direction came from a delta lobe (or the camera): no light sample competes */

SHARED_FUNCTION void path_store_bsdf(__global uint *paths, uint stride, uint t, const Bsdf *bsdf)
{
    state_store(paths, stride, PATH_BSDF_KIND, t, bsdf->kind);
    state_store(paths, stride, PATH_BSDF_FLAGS, t, bsdf->flags);
    state_store_vec3(paths, stride, PATH_BSDF_COLOR0, t, bsdf->color0);
    state_store_vec3(paths, stride, PATH_BSDF_COLOR1, t, bsdf->color1);
    state_store_float(paths, stride, PATH_BSDF_ALPHA_X, t, bsdf->alpha_x);
    state_store_float(paths, stride, PATH_BSDF_ALPHA_Y, t, bsdf->alpha_y);
    state_store_float(paths, stride, PATH_BSDF_ETA, t, bsdf->eta);
    state_store(paths, stride, PATH_BSDF_COAT, t, bsdf->coat_table);
}

SHARED_FUNCTION Bsdf path_load_bsdf(__global const uint *paths, uint stride, uint t)
{
    Bsdf bsdf;
    bsdf.kind = state_load(paths, stride, PATH_BSDF_KIND, t);
    bsdf.flags = state_load(paths, stride, PATH_BSDF_FLAGS, t);
    bsdf.color0 = state_load_vec3(paths, stride, PATH_BSDF_COLOR0, t);
    bsdf.color1 = state_load_vec3(paths, stride, PATH_BSDF_COLOR1, t);
    bsdf.alpha_x = state_load_float(paths, stride, PATH_BSDF_ALPHA_X, t);
    bsdf.alpha_y = state_load_float(paths, stride, PATH_BSDF_ALPHA_Y, t);
    bsdf.eta = state_load_float(paths, stride, PATH_BSDF_ETA, t);
    bsdf.coat_table = state_load(paths, stride, PATH_BSDF_COAT, t);
    return bsdf;
}

SHARED_FUNCTION void path_store_frame(__global uint *paths, uint stride, uint t, Frame frame)
{
    state_store_vec3(paths, stride, PATH_FRAME_N, t, frame.n);
    state_store_vec3(paths, stride, PATH_FRAME_T, t, frame.t);
}

SHARED_FUNCTION Frame path_load_frame(__global const uint *paths, uint stride, uint t)
{
    Frame frame;
    frame.n = state_load_vec3(paths, stride, PATH_FRAME_N, t);
    frame.t = state_load_vec3(paths, stride, PATH_FRAME_T, t);
    frame.b = vec3_cross(frame.n, frame.t);
    return frame;
}

#endif
