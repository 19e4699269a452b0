/* What a path keeps between kernels (BUFFER_PATHS), one 32-bit word a field, and how it is stored. */
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
#define PATH_LIGHT 28u /* contribution of the light sample if it is visible, 3 */
#define PATH_BSDF 31u /* STORED_BSDF_WORDS */
#define PATH_LIMIT 43u /* frame->split_direct: how much luminance a contribution shows */
#define PATH_SURVIVED 44u /* the same: with what probability Russian roulette has let the path live so far */
#define PATH_GATHERED 45u /* frame->split_depths: segments of the path that has brought PATH_RADIANCE */
#define PATH_WORDS 46u

#define PATH_FLAG_DELTA 0x1u /* the last direction came from a delta lobe (or the camera): no light sample competes */

#endif
