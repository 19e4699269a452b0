/* The list of auxiliary variables of a pixel (AOVs), besides light: what denoisers and compositors want. Made from it
 * are their numbers (AOV_*, FrameParams.pass.aovs), the dispatch of kernels/aov.cl, and the layers of an image that
 * hold them (host/render/layers.h), with their names and channels. */
#ifndef TWINLIGHT_LAYOUT_AOV_LIST_H
#define TWINLIGHT_LAYOUT_AOV_LIST_H

/* What a variable's values are. */
#define AOV_LIGHTLIKE 0u /* numbers of about 1, filtered over the pixel as light is; 0 where nothing is met */
#define AOV_DISTANCE 1u /* a length in the world: the mean over the rays that meet something */
#define AOV_PART 2u /* the fraction of the rays of which something is true; filters with negative lobes do not matter */

/* X(NAME, name, text, values, red, green, blue): AOV_NAME and LAYER_NAME; the function aov_name (kernels/aov.cl); the
 * layer in --layers; one of these kinds; channels in the EXR file, the latter two "" for a variable that is
 * one number. */
#define AOV_LIST(X)                                                                                                    \
    X(ALBEDO, albedo, "albedo", AOV_LIGHTLIKE, "albedo.R", "albedo.G", "albedo.B")                                     \
    X(NORMAL, normal, "normal", AOV_LIGHTLIKE, "normal.X", "normal.Y", "normal.Z")                                     \
    X(DEPTH, depth, "depth", AOV_DISTANCE, "Z", "", "")                                                                \
    X(ALPHA, alpha, "alpha", AOV_PART, "A", "", "")

#define AOV_ENUMERATE(NAME, name, text, values, red, green, blue) AOV_##NAME,
enum { AOV_LIST(AOV_ENUMERATE) AOV_COUNT }; /* at most SPLAT_FILMS (layout/state.h) */
#undef AOV_ENUMERATE

#endif
