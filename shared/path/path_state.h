/* The state of a path between kernels (BUFFER_PATHS), one 32-bit word per field. */
#ifndef TWINLIGHT_PATH_PATH_STATE_H
#define TWINLIGHT_PATH_PATH_STATE_H

#include "bsdf/bsdf_state.h"

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
#define PATH_FRAME 19u /* shading frame, STORED_FRAME_WORDS */
#define PATH_WO 25u /* towards the previous vertex, in the frame, 3 */
#define PATH_LIGHT 28u /* contribution of the light sample if visible, 3 */
#define PATH_BSDF 31u /* STORED_BSDF_WORDS */
#define PATH_LIMIT 43u /* frame->partition.split_direct: clamping threshold of its contribution's luminance */
#define PATH_SURVIVED 44u /* frame->partition.split_direct: probability to survive Russian roulette so far */
#define PATH_GATHERED 45u /* frame->film.split_depths: depth of the path in PATH_RADIANCE */
/* With frame->pass.aovs, without depths: the next variable is this one or a later one; once the camera's ray has been
 * traced, 3 values of each. */
#define PATH_AOV 45u
#define PATH_AOV_VALUES PATH_BETA
/* Caustics by photons (path/caustic.h); only with PhotonParams.count */
#define PATH_RECEIVER 46u /* RECEIVER_WORDS (path/caustic_rest.h) */
#define PATH_DELTA 53u /* bit i: vertex i scattered by a delta lobe; up to RECEIVER_LAST */
#define PATH_OWN 54u /* frame->partition.split_direct: gathered of what no other estimator shows (path_gather.h), 3 */
#define PATH_CAUSTIC_SEGMENTS 57u /* of the caustic path under way, with its last ray */
#define PATH_CAUSTIC_LIGHT 58u /* PHOTON_LIGHT of the photon that drew it */
#define PATH_CAUSTIC_BETA 59u /* its throughput, 3 */
/* frame->partition.split_direct */
#define PATH_RARE 62u /* gathered so far above the clamping threshold, 3 */
#define PATH_LIGHT_SHOWN 65u /* the part of PATH_LIGHT that is below it */
#define PATH_OFFSET 66u /* in the pixel's filter (camera/splat_offset.h) */
/* With photons: throughput with which path tracing without them would find the path, over PATH_CAUSTIC_BETA */
#define PATH_CAUSTIC_OVER 67u
#define PATH_CAUSTIC_DRAWN 68u /* directions that the vertex has drawn by photons */
#define PATH_WORDS 69u
/* In scenes with media, where PATH_LIGHT is unweighted */
#define PATH_LIGHT_PDF 69u /* density of the light sample */
#define PATH_LIGHT_OTHER 70u /* of its direction by the Bsdf; 0: it cannot be hit */
#define PATH_MEDIA_WORDS 71u

#define PATH_FLAG_DELTA 0x1u /* the last direction is a delta lobe's (or the camera's): no light sample competes */

#endif
