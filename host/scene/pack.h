/* Packs a scene's arrays into three buffers of words: geometry, tables and texels (SceneLayout). */
#ifndef TWINLIGHT_SCENE_PACK_H
#define TWINLIGHT_SCENE_PACK_H

#include "scene/scene.h"

/* Packs what scene_finish has derived, and frees the arrays of vertices and primitives. Fails if a buffer would exceed
 * 16 GiB. */
bool scene_pack(Scene *scene, Error *error);

#endif
