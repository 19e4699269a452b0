/* Transforms of texture coordinates (KHR_texture_transform). glTF's v = 0 is the top of an image, pbrt's the bottom. */
#ifndef TWINLIGHT_GLTF_UV_TRANSFORM_H
#define TWINLIGHT_GLTF_UV_TRANSFORM_H

#include "gltf/document.h"

UvTransform uv_identity(void);
bool uv_is_identity(const UvTransform *transform);

/* Translation after rotation by `angle` radians after scaling, as the extension defines it. */
UvTransform uv_make(const double offset[2], double angle, const double scale[2]);

/* The transform that follows after `base` to give `whole`; `whole` itself if `base` cannot be inverted. */
UvTransform uv_after(const UvTransform *whole, const UvTransform *base);

/* Whether u depends on v or v on u. */
bool uv_turns(const UvTransform *transform);

/* The same transform of pbrt's coordinates, in which v' = 1 - v. */
UvTransform uv_of_pbrt(const UvTransform *transform);

#endif
