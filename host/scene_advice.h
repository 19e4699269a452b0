/* What of a scene's light no integrator here can show, in words for its user. */
#ifndef TWINLIGHT_SCENE_ADVICE_H
#define TWINLIGHT_SCENE_ADVICE_H

#include "scene.h"

/* Says in the log when a finished scene has lights without extent beside smooth glass or mirrors: where such light comes
 * through one and is seen through another, no path can meet the light and none can be connected. */
void scene_advise(const Scene *scene);

#endif
