/* The state of a bidirectional path between kernels: a header with the walk under way (BUFFER_PATHS), the vertices
 * (BUFFER_VERTICES) and their densities (BUFFER_DENSITIES), one 32-bit word per field.
 *
 * Vertices y_0, y_1 ... are the light's, y_0 on the light. z_0 is on the lens and is not stored; z_1, z_2 ... are the
 * camera's. The strategy (s, t) connects y_{s-1} with z_{t-1} and makes a path of s + t - 1 segments. */
#ifndef TWINLIGHT_PATH_BD_STATE_H
#define TWINLIGHT_PATH_BD_STATE_H

#include "layout/scene_view.h"
#include "layout/state.h"
#include "math/scaled.h"

#define SIDE_LIGHT 0u
#define SIDE_CAMERA 1u

/* ---- the header -------------------------------------------------------------------------------------------------- */

#define BD_PIXEL 0u /* y * width + x of the whole film: where the camera's path began */
#define BD_SAMPLE 1u /* which sample of the pixel */
#define BD_WEIGHT 2u /* of the pixel filter */
#define BD_RADIANCE 3u /* gathered for the pixel, 3 */
#define BD_LENGTHS 6u /* number of vertices y stored, of z << 16 */
#define BD_LIGHT_DELTA 7u /* bit i: y_i scattered by a delta lobe */
#define BD_CAMERA_DELTA 8u /* bit i: z_i scattered by a delta lobe */
#define BD_EMITTER 9u /* of y_0: light index */
#define BD_EMITTER_FLAGS 10u /* EMITTER_* */
#define BD_CONNECT 11u /* density of drawing y_0 for y_1 (s = 1) over that of emitting from it */
/* The walk under way */
#define BD_SIDE 12u
#define BD_DEPTH 13u /* segments so far on this side; 0: it has ended */
#define BD_BETA 14u /* throughput, 3 */
#define BD_PDF 17u /* density of the last direction, per solid angle (or per area across it: WALK_PARALLEL) */
#define BD_WALK_FLAGS 18u /* WALK_* */
#define BD_ROULETTE_SCALE 19u /* factor of the throughput in Russian roulette: pool_roulette_weigh, eta^2 */
/* The connection under way */
#define BD_S 20u
#define BD_T 21u
#define BD_CONTRIBUTION 22u /* if visible, 3 */
#define BD_TARGET 25u /* pixel of the splat; NONE: the path's own */
#define BD_TARGET_WEIGHT 26u /* of the pixel filter, at that pixel */
#define BD_COVER 27u /* of a pool: film_splat_cover where the camera's path began */
/* Of a chain (chain/shift.h); a pool uses the same words for other fields */
#define BD_SHIFT_NUMBERS 27u /* saved coordinates of the directions at z_1 and z_2, 2 each */
#define BD_SHIFT_DENSITY 33u /* of the last direction, by its lobe alone; 0: its numbers cannot be inverted */
/* frame->partition.split_direct: direct light gathered for the pixel, 3; a pool uses the same words for other fields */
#define BD_DIRECT 28u
/* Of a pool (chain/pool.h) */
#define BD_CANDIDATE_SUM 28u
#define BD_CANDIDATE 29u
#define BD_CANDIDATE_LUMINANCE 30u /* target f of the candidate, as a chain has it: without roulette */
#define BD_CONNECTION_SURVIVAL 31u /* probability of both walks of the connection to survive roulette */
#define BD_SURVIVAL 32u /* probability of the walk under way to survive roulette so far */
#define BD_IMPORTANCE 33u /* target importance where the camera's path began */
#define BD_TARGET_IMPORTANCE 34u /* target importance at the film position of the connection under way (t = 1) */
#define BD_GATHERED 35u /* frame->film.split_depths: depth of the paths in BD_RADIANCE */
/* Film positions (camera/splat_offset.h) */
#define BD_OFFSET 36u /* of the camera's path in the filter of BD_PIXEL */
#define BD_TARGET_OFFSET 37u /* of a splat in that of BD_TARGET */
/* Caustics by photons (path/caustic_rest.h); only with PhotonParams.count */
#define BD_RECEIVER 38u /* of the camera subpath, RECEIVER_WORDS */
#define BD_HEADER_WORDS 45u

#define EMITTER_INFINITE 0x1u /* y_0 is a direction */
#define EMITTER_DELTA 0x2u /* no path can hit it */
#define EMITTER_BACK 0x4u /* in scenes with media: the path leaves the back of a two-sided light that is a boundary */

#define WALK_PARALLEL 0x1u /* the last ray is one of a bundle of parallel ones */
#define WALK_DELTA 0x2u /* it came from a delta lobe */

/* ---- vertices ---------------------------------------------------------------------------------------------------- */

#define VERTEX_POINT 0u /* 3; of y_0 of an infinite light: the direction of travel */
#define VERTEX_NG 3u /* geometric normal, 3 */
#define VERTEX_FRAME_N 6u /* shading frame, 3 */
#define VERTEX_FRAME_T 9u /* 3 */
#define VERTEX_WO 12u /* towards the vertex before it, in the frame, 3 */
#define VERTEX_BETA 15u /* throughput up to here, 3 */
#define VERTEX_BSDF_KIND 18u
#define VERTEX_BSDF_FLAGS 19u
#define VERTEX_BSDF_COLOR0 20u /* 3 */
#define VERTEX_BSDF_COLOR1 23u /* 3 */
#define VERTEX_BSDF_ALPHA_X 26u
#define VERTEX_BSDF_ALPHA_Y 27u
#define VERTEX_BSDF_ETA 28u
#define VERTEX_BSDF_COAT 29u
#define VERTEX_SURVIVAL 30u /* BD_SURVIVAL at the vertex */
#define VERTEX_BACK 31u /* Vertex.back (path/bd_walk.h) */
#define VERTEX_WORDS 32u

/* ---- densities --------------------------------------------------------------------------------------------------- */

#define DENSITY_OWN 0u /* by the side that stores the vertex, per area */
#define DENSITY_OTHER 1u /* by the other side */
#define DENSITY_WORDS 2u

#endif
