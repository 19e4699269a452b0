/* What a scene's user should know before it is rendered. */
#ifndef TWINLIGHT_SCENE_WARNINGS_H
#define TWINLIGHT_SCENE_WARNINGS_H

#include "scene/scene.h"

/* Says in the log when a finished scene has lights without extent beside smooth glass or mirrors: where such light
 * comes through one and is seen through another, no path can meet the light and none can be connected. And when a few
 * primitives make the scene so large that it suffers (backend/ray_reach.h). */
void scene_advise(const Scene *scene);

#endif
