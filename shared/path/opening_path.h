/* The state of a camera subpath by which openings are found, between kernels (BUFFER_PATHS) and after a pass
 * (BUFFER_PASS), one 32-bit word per field (kernels/opening.cl). */
#ifndef TWINLIGHT_PATH_OPENING_PATH_H
#define TWINLIGHT_PATH_OPENING_PATH_H

#define OPENING_PATH_NUMBER 0u /* which random numbers it has; given */
#define OPENING_PATH_LIGHT 1u /* to which it is connected; given */
#define OPENING_PATH_RECEIVERS 2u /* how many more it scatters at before it is connected */
#define OPENING_PATH_SEGMENTS 3u /* rays traced */
#define OPENING_PATH_WEIGHT 4u /* of the light, luminance; 0: it does not reach the light */
#define OPENING_PATH_ORIGIN 5u /* of its last ray, 3 */
#define OPENING_PATH_DIRECTION 8u /* of that ray, 3 */
#define OPENING_PATH_SPLIT 11u /* 1: it is past its first receiver */
#define OPENING_PATH_NORMAL 12u /* of the surface at that, towards either side, 3; zero: there is none */
#define OPENING_PATH_WORDS 15u

/* As many subpaths with consecutive numbers are the same up to their first receiver. */
#define OPENING_SPLITS 5u

#define OPENING_CONNECTING NONE /* OPENING_PATH_RECEIVERS: on its way to the light */

/* Longest such subpath, segments. */
#define OPENING_SEGMENTS 10u

#endif
