/* Caustic paths: a light, one to CAUSTIC_VERTICES smooth specular vertices, and a receiver, which is a vertex that
 * scatters otherwise. The receiver draws one more direction by the photons around it (path/photon.h) with density q,
 * beside the one that its BSDF draws with density p. Of a path's contribution f that direction estimates f q / (p + q):
 * the sample has the weight f / (p + q) (balance heuristic, path/mis.h). The rest, f p / (p + q), is left to camera
 * subpaths that hit the light (s = 0), for which this is a factor of f. So any photons give the right sum. A receiver
 * that draws n directions (receiver_draw_count) has n q for q.
 *
 * Where light subpaths can make the path, too, by a connection of two vertices that both scatter otherwise than by a
 * delta lobe (the camera is one), their densities do not depend on the size of the light, and photons are not needed:
 * only path tracing, which has no light subpaths, draws by them there (PhotonParams.everywhere). Beside MMLT's other
 * estimators it does so as well, if photons bring much: the factor is then its own, since the others show such paths
 * without.
 *
 * This file has that factor, and where there are receivers. */
#ifndef TWINLIGHT_PATH_CAUSTIC_REST_H
#define TWINLIGHT_PATH_CAUSTIC_REST_H

#include "bsdf/bsdf.h"
#include "light/delta.h"
#include "path/bd_state.h"
#include "path/photon.h"

/* Photons count where q is at least this many times p. Elsewhere chance finds the light often enough, or they do not
 * predict it, and f / (p + q) would be large. */
#define PHOTON_LEAD 8.0f

/* p / (p + q), or 1 where photons do not count. */
SHARED_FUNCTION float caustic_rest_of(float p, float q)
{
    return q >= PHOTON_LEAD * p ? p / (p + q) : 1.0f;
}

/* PHOTON_LIGHT of the photons of a light. */
SHARED_FUNCTION uint caustic_light(const SceneView *scene, uint light)
{
    uint kind = light_kind(scene->lights + light);
    return kind == LIGHT_DISTANT || light_has_position(kind) ? light : NONE;
}

/* The density q of drawing w (unit) at p by photons of such a light. */
SHARED_FUNCTION float caustic_density(const SceneView *scene, Vec3 p, Vec3 w, uint light)
{
    PhotonParams params = scene->frame->photons;
    PhotonSets found = photon_sets(params, scene->photons, p);
    return photon_density(params, scene->photons, &found, p, w, light);
}

/* ---- receivers --------------------------------------------------------------------------------------------------- */

/* Last vertex that may be a receiver: bits of a word stand for vertices. */
#define RECEIVER_LAST 30u

/* Whether z_number of a camera subpath, left otherwise than by a delta lobe, draws by photons: where no two neighbours
 * among z_0 ... z_number can be connected. delta: bit i: z_i scattered by a delta lobe; of z_number and behind it,
 * ignored. */
SHARED_FUNCTION bool receiver_draws(uint everywhere, uint delta, uint number)
{
    if (number > RECEIVER_LAST || everywhere != 0u)
        return number <= RECEIVER_LAST;
    uint others = (~delta & ((1u << number) - 1u)) | 1u << number;
    return (others & others >> 1) == 0u;
}

/* Number of the receiver of a camera subpath whose vertex after z_last is on a light; 0: it has none. */
SHARED_FUNCTION uint receiver_find(uint everywhere, uint delta, uint last)
{
    uint number = last <= RECEIVER_LAST ? last : 0u;
    while (number > 0u && (delta & 1u << number) != 0u)
        --number;
    bool caustic = number < last && last - number <= CAUSTIC_VERTICES;
    return number > 0u && caustic && receiver_draws(everywhere, delta, number) ? number : 0u;
}

/* Receivers draw so many directions, but those behind RECEIVER_DRAWS_LAST, which draw one. */
#define RECEIVER_DRAWS 2u
#define RECEIVER_DRAWS_LAST 4u

/* How many directions z_number draws by photons, if it does. */
SHARED_FUNCTION uint receiver_draw_count(uint number)
{
    return number <= RECEIVER_DRAWS_LAST ? RECEIVER_DRAWS : 1u;
}

/* How a camera subpath left its latest vertex that scattered otherwise than by a delta lobe, in fields from `base`
 * on. */
#define RECEIVER_PDF 0u /* p of the direction */
#define RECEIVER_POINT 1u /* 3 */
#define RECEIVER_DIRECTION 4u /* 3 */
#define RECEIVER_WORDS 7u

/* The density of a direction drawn at a vertex, as RECEIVER_PDF: 0 for a delta lobe, and infinite in a medium, where no
 * directions are drawn by photons. */
SHARED_FUNCTION float receiver_pdf(const SceneView *scene, const Bsdf *bsdf, float pdf, uint delta)
{
    float drawn = bsdf_is_phase(scene, bsdf) ? FLOAT_INFINITY : pdf;
    return delta != 0u ? 0.0f : drawn;
}

/* The subpath leaves p in the direction w, drawn with density pdf (receiver_pdf). */
SHARED_FUNCTION void receiver_leave(__global uint *restrict paths, uint stride, uint base, uint item, Vec3 p, Vec3 w,
                                    float pdf)
{
    if (!(pdf > 0.0f))
        return;
    state_store_float(paths, stride, base + RECEIVER_PDF, item, pdf);
    state_store_vec3(paths, stride, base + RECEIVER_POINT, item, p);
    state_store_vec3(paths, stride, base + RECEIVER_DIRECTION, item, w);
}

/* The rest of a path whose camera subpath has just hit a light behind z_last. delta: receiver_draws. */
SHARED_FUNCTION float receiver_rest(const SceneView *scene, __global const uint *restrict paths, uint base, uint item,
                                    uint delta, uint last)
{
    PhotonParams params = scene->frame->photons;
    uint stride = scene->frame->pass.stride;
    uint number = params.count == 0u ? 0u : receiver_find(params.everywhere, delta, last);
    if (number == 0u)
        return 1.0f;
    float q = caustic_density(scene, state_load_vec3(paths, stride, base + RECEIVER_POINT, item),
                              state_load_vec3(paths, stride, base + RECEIVER_DIRECTION, item), NONE);
    float draws = (float)receiver_draw_count(number);
    return caustic_rest_of(state_load_float(paths, stride, base + RECEIVER_PDF, item), draws * q);
}

#endif
