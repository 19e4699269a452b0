/* Packs the nodes of the tree of lights (shared/light/light_tree.h). */
#ifndef TWINLIGHT_SCENE_LIGHT_NODE_H
#define TWINLIGHT_SCENE_LIGHT_NODE_H

#include "light/light_tree.h"
#include "scene/light_bounds.h"

/* The root's bounds; `lamps` and `far`: all lights at a place and all at infinity, of which one may be empty. */
LightTree light_tree_pack(const LightBounds *lamps, const LightBounds *far, uint leaves);

/* The node of two children whose bounds are within `sphere`, as kernels decode it. lower: leaves of the left one. */
LightNode light_node_pack(const LightBounds *left, const LightBounds *right, uint lower, LightSphere sphere);

/* The root of lamps and lights at infinity, whose children both have its sphere. */
LightNode light_node_pack_far(uint lamps);

#endif
