/* From a scene's arrays to three buffers of words: geometry, tables and texels (SceneLayout). */
#ifndef TWINLIGHT_SCENE_PACK_H
#define TWINLIGHT_SCENE_PACK_H

#include "scene/scene.h"

/* Packs what scene_finish has derived, and frees the arrays of vertices and primitives. Fails when a buffer would need
 * more than 16 GiB. */
bool scene_pack(Scene *scene, Error *error);

#endif
