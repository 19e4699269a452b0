/* The state of a light subpath that photons are made of, between kernels (BUFFER_PATHS) and before and after a pass
 * (BUFFER_PASS), one 32-bit word per field (kernels/photon.cl). */
#ifndef TWINLIGHT_PATH_PHOTON_PATH_H
#define TWINLIGHT_PATH_PHOTON_PATH_H

#define PHOTON_PATH_NUMBER 0u /* which random numbers it has */
#define PHOTON_PATH_EMITTER 1u /* its light; before a pass: NONE or PHOTON_AIMED: it is to be drawn */
#define PHOTON_PATH_ORIGIN 2u /* of its first ray, 3; aimed, before a pass: what it goes through */
#define PHOTON_PATH_FIRST 5u /* direction of its first ray, 3 */
#define PHOTON_PATH_VERTICES 8u /* smooth specular vertices */
#define PHOTON_PATH_LOBES 9u /* bit i: the i-th of them transmitted it */
#define PHOTON_PATH_ARRIVED 10u /* 1: it has reached a receiver */
#define PHOTON_PATH_POINT 11u /* where, 3 */
#define PHOTON_PATH_LAST 14u /* direction of its last ray, 3 */
#define PHOTON_PATH_WORDS 17u

#define PHOTON_AIMED 0xfffffffeu

#endif
