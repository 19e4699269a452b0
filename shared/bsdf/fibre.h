/* BSDFs on curves (geometry/curve.h). The shading normal of a curve faces the direction from which it is seen: a path
 * from the light would find another one than a path from the camera, and a different value of the BSDF. Both are to
 * agree, so what a path from the light needs is evaluated in the frame of the path from the camera.
 *
 * In a frame with the tangent as x let a path from the camera arrive with wo and leave along wi, and take the
 * directions apart into x and an azimuth. With the curve's normal at the same angle to wi as it now is to wo, on its
 * other side, the reverse has the mirror images of both azimuths, and the mirror image of that has the azimuths
 * themselves: exchanging wo and wi exchanges only their x. The point of the path, given by its position across the
 * width, is mirrored as well, and stays.
 *
 * The curve has the cosine of theta for directions at that angle to the plane across it, and in place of f(wo, wi) |cos
 * wi| the reverse has f(wi, wo) |cos wo| cos theta_i / cos theta_o. */
#ifndef TWINLIGHT_BSDF_FIBRE_H
#define TWINLIGHT_BSDF_FIBRE_H

#include "bsdf/lobe.h"

/* w with the x of `other`, and its own azimuth. */
SHARED_FUNCTION Vec3 fibre_tilt(Vec3 w, Vec3 other)
{
    float scale = float_sqrt((other.y * other.y + other.z * other.z) / (w.y * w.y + w.z * w.z));
    return vec3(other.x, w.y * scale, w.z * scale);
}

/* |cos theta_i| / |cos theta_o|. */
SHARED_FUNCTION float fibre_cosine_ratio(Vec3 wo, Vec3 wi)
{
    return float_sqrt((wi.y * wi.y + wi.z * wi.z) / (wo.y * wo.y + wo.z * wo.z));
}

/* The value on a curve, from those of (wo, wi) and of the exchanged directions, both for TRANSPORT_RADIANCE. */
SHARED_FUNCTION BsdfValue fibre_value(BsdfValue forward, BsdfValue reverse, Vec3 wo, Vec3 wi, uint transport)
{
    BsdfValue value = forward;
    value.pdf_rev_w = reverse.pdf_w;
    if (transport == TRANSPORT_IMPORTANCE)
        value.f_cos = vec3_scale(reverse.f_cos, fibre_cosine_ratio(wo, wi));
    return value;
}

#endif
