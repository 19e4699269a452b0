/* A Bsdf and its frame in structure-of-arrays state. `base`: the first of their fields. */
#ifndef TWINLIGHT_BSDF_BSDF_STATE_H
#define TWINLIGHT_BSDF_BSDF_STATE_H

#include "geometry/medium.h"
#include "layout/scene_view.h"
#include "layout/state.h"

/* Fields of a stored Bsdf, relative to its base. */
#define STORED_BSDF_KIND 0u /* and, in the bits of MEDIA_BITS, Bsdf.media */
#define STORED_BSDF_FLAGS 1u
#define STORED_BSDF_COLOR0 2u /* 3 */
#define STORED_BSDF_COLOR1 5u /* 3 */
#define STORED_BSDF_ALPHA_X 8u
#define STORED_BSDF_ALPHA_Y 9u
#define STORED_BSDF_ETA 10u
#define STORED_BSDF_COAT 11u
#define STORED_BSDF_WORDS 12u

/* Words of a stored frame: normal and tangent. */
#define STORED_FRAME_WORDS 6u

/* Materials whose Bsdf has a second colour, an index of refraction, and roughnesses. */
#define FEATURES_COLOR1                                                                                                \
    (FEATURE_CONDUCTOR | FEATURE_COATED_DIFFUSE | FEATURE_COATED_CONDUCTOR | FEATURE_DIFFUSE_TRANSMISSION |            \
     FEATURE_HAIR)
#define FEATURES_ETA                                                                                                   \
    (FEATURE_DIELECTRIC | FEATURE_THIN_DIELECTRIC | FEATURE_COATED_DIFFUSE | FEATURE_COATED_CONDUCTOR | FEATURE_HAIR)
#define FEATURES_ALPHA (FEATURE_ROUGH | FEATURE_HAIR)

/* Stores only the members that some material of the scene uses. */
SHARED_FUNCTION void bsdf_store(const SceneView *scene, __global uint *buffer, uint stride, uint base, uint item,
                                const Bsdf *bsdf)
{
    state_store(buffer, stride, base + STORED_BSDF_KIND, item, bsdf->kind | bsdf->media);
    state_store(buffer, stride, base + STORED_BSDF_FLAGS, item, bsdf->flags);
    state_store_vec3(buffer, stride, base + STORED_BSDF_COLOR0, item, bsdf->color0);
    if (SCENE_HAS(scene, FEATURES_COLOR1))
        state_store_vec3(buffer, stride, base + STORED_BSDF_COLOR1, item, bsdf->color1);
    if (SCENE_HAS(scene, FEATURES_ETA))
        state_store_float(buffer, stride, base + STORED_BSDF_ETA, item, bsdf->eta);
    if (SCENE_HAS(scene, FEATURES_ALPHA)) {
        state_store_float(buffer, stride, base + STORED_BSDF_ALPHA_X, item, bsdf->alpha_x);
        state_store_float(buffer, stride, base + STORED_BSDF_ALPHA_Y, item, bsdf->alpha_y);
        state_store(buffer, stride, base + STORED_BSDF_COAT, item, bsdf->coat_table);
    }
}

/* Bsdf.kind alone. */
SHARED_FUNCTION uint bsdf_kind_load(const SceneView *scene, __global const uint *buffer, uint stride, uint base,
                                    uint item)
{
    uint word = state_load(buffer, stride, base + STORED_BSDF_KIND, item);
    return SCENE_HAS(scene, FEATURE_MEDIUM) ? word & ~MEDIA_BITS : word;
}

SHARED_FUNCTION Bsdf bsdf_load(const SceneView *scene, __global const uint *buffer, uint stride, uint base, uint item)
{
    Bsdf bsdf;
    bsdf.kind = bsdf_kind_load(scene, buffer, stride, base, item);
    bsdf.media = 0u;
    if (SCENE_HAS(scene, FEATURE_MEDIUM))
        bsdf.media = state_load(buffer, stride, base + STORED_BSDF_KIND, item) & MEDIA_BITS;
    bsdf.flags = state_load(buffer, stride, base + STORED_BSDF_FLAGS, item);
    bsdf.color0 = state_load_vec3(buffer, stride, base + STORED_BSDF_COLOR0, item);
    bsdf.color1 = vec3_splat(0.0f);
    bsdf.eta = 1.0f;
    bsdf.alpha_x = 0.0f;
    bsdf.alpha_y = 0.0f;
    bsdf.coat_table = NONE;
    if (SCENE_HAS(scene, FEATURES_COLOR1))
        bsdf.color1 = state_load_vec3(buffer, stride, base + STORED_BSDF_COLOR1, item);
    if (SCENE_HAS(scene, FEATURES_ETA))
        bsdf.eta = state_load_float(buffer, stride, base + STORED_BSDF_ETA, item);
    if (SCENE_HAS(scene, FEATURES_ALPHA)) {
        bsdf.alpha_x = state_load_float(buffer, stride, base + STORED_BSDF_ALPHA_X, item);
        bsdf.alpha_y = state_load_float(buffer, stride, base + STORED_BSDF_ALPHA_Y, item);
        bsdf.coat_table = state_load(buffer, stride, base + STORED_BSDF_COAT, item);
    }
    return bsdf;
}

SHARED_FUNCTION void frame_store(__global uint *buffer, uint stride, uint base, uint item, Frame frame)
{
    state_store_vec3(buffer, stride, base, item, frame.n);
    state_store_vec3(buffer, stride, base + 3u, item, frame.t);
}

SHARED_FUNCTION Frame frame_load(__global const uint *buffer, uint stride, uint base, uint item)
{
    Frame frame;
    frame.n = state_load_vec3(buffer, stride, base, item);
    frame.t = state_load_vec3(buffer, stride, base + 3u, item);
    frame.b = vec3_cross(frame.n, frame.t);
    return frame;
}

#endif
