/* What a path keeps between kernels (BUFFER_PATHS), one 32-bit word a field, and how it is stored. */
#ifndef TWINLIGHT_PATH_STATE_H
#define TWINLIGHT_PATH_STATE_H

#include "scene_view.h"
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

/* Materials whose Bsdf has a second colour, and those with an index of refraction. */
#define FEATURES_COLOR1 (FEATURE_CONDUCTOR | FEATURE_COATED_DIFFUSE | FEATURE_DIFFUSE_TRANSMISSION)
#define FEATURES_ETA (FEATURE_DIELECTRIC | FEATURE_THIN_DIELECTRIC | FEATURE_COATED_DIFFUSE)

/* Only what some material of the scene uses is stored. */
SHARED_FUNCTION void path_store_bsdf(const SceneView *scene, __global uint *paths, uint stride, uint t,
                                     const Bsdf *bsdf)
{
    state_store(paths, stride, PATH_BSDF_KIND, t, bsdf->kind);
    state_store(paths, stride, PATH_BSDF_FLAGS, t, bsdf->flags);
    state_store_vec3(paths, stride, PATH_BSDF_COLOR0, t, bsdf->color0);
    if (SCENE_HAS(scene, FEATURES_COLOR1))
        state_store_vec3(paths, stride, PATH_BSDF_COLOR1, t, bsdf->color1);
    if (SCENE_HAS(scene, FEATURES_ETA))
        state_store_float(paths, stride, PATH_BSDF_ETA, t, bsdf->eta);
    if (SCENE_HAS(scene, FEATURE_ROUGH)) {
        state_store_float(paths, stride, PATH_BSDF_ALPHA_X, t, bsdf->alpha_x);
        state_store_float(paths, stride, PATH_BSDF_ALPHA_Y, t, bsdf->alpha_y);
        state_store(paths, stride, PATH_BSDF_COAT, t, bsdf->coat_table);
    }
}

SHARED_FUNCTION Bsdf path_load_bsdf(const SceneView *scene, __global const uint *paths, uint stride, uint t)
{
    Bsdf bsdf;
    bsdf.kind = state_load(paths, stride, PATH_BSDF_KIND, t);
    bsdf.flags = state_load(paths, stride, PATH_BSDF_FLAGS, t);
    bsdf.color0 = state_load_vec3(paths, stride, PATH_BSDF_COLOR0, t);
    bsdf.color1 = vec3_splat(0.0f);
    bsdf.eta = 1.0f;
    bsdf.alpha_x = 0.0f;
    bsdf.alpha_y = 0.0f;
    bsdf.coat_table = NONE;
    if (SCENE_HAS(scene, FEATURES_COLOR1))
        bsdf.color1 = state_load_vec3(paths, stride, PATH_BSDF_COLOR1, t);
    if (SCENE_HAS(scene, FEATURES_ETA))
        bsdf.eta = state_load_float(paths, stride, PATH_BSDF_ETA, t);
    if (SCENE_HAS(scene, FEATURE_ROUGH)) {
        bsdf.alpha_x = state_load_float(paths, stride, PATH_BSDF_ALPHA_X, t);
        bsdf.alpha_y = state_load_float(paths, stride, PATH_BSDF_ALPHA_Y, t);
        bsdf.coat_table = state_load(paths, stride, PATH_BSDF_COAT, t);
    }
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
