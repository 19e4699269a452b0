/* Fresnel reflectance of dielectrics and conductors for unpolarised light, and refraction. */
#ifndef TWINLIGHT_BSDF_FRESNEL_H
#define TWINLIGHT_BSDF_FRESNEL_H

#include "math/vec.h"

/* Largest reflectance at normal incidence that is turned into an extinction coefficient, as in pbrt-v4. */
#define CONDUCTOR_REFLECTANCE_MAX 0.9999f

/* Reflectance from both cosines, which Snell's law ties: cos_i on the side of the light, cos_t on the other, eta the
 * index of cos_t's side over that of cos_i's. Symmetric under (cos_i, cos_t, eta) -> (cos_t, cos_i, 1/eta) and free of
 * cancellation at the critical angle. (Born and Wolf, Principles of Optics, section 1.5.2, eq. 21a.) */
SHARED_FUNCTION float fresnel_from_cosines(float cos_i, float cos_t, float eta)
{
    float sum_p = eta * cos_i + cos_t;
    float sum_s = cos_i + eta * cos_t;
    if (!(sum_p > 0.0f && sum_s > 0.0f))
        return 1.0f;
    float r_p = (eta * cos_i - cos_t) / sum_p;
    float r_s = (cos_i - eta * cos_t) / sum_s;
    return 0.5f * (r_p * r_p + r_s * r_s);
}

/* Cosine of the refracted direction for cos_i >= 0, or -1 at total internal reflection. eta: transmitted side over
 * incident side. Snell's law as cos_t^2 = (cos_i^2 + eta^2 - 1) / eta^2, which keeps the digits of a grazing cos_i. */
SHARED_FUNCTION float refraction_cosine(float cos_i, float eta)
{
    float numerator = cos_i * cos_i + (eta - 1.0f) * (eta + 1.0f);
    if (!(numerator > 0.0f))
        return -1.0f;
    return float_min(float_sqrt(numerator) / eta, 1.0f);
}

/* Reflectance of a dielectric for cos_i >= 0; 1 at total internal reflection, 0 where eta = 1. */
SHARED_FUNCTION float fresnel_dielectric(float cos_i, float eta)
{
    if (eta == 1.0f)
        return 0.0f;
    float cos_t = refraction_cosine(cos_i, eta);
    if (cos_t < 0.0f)
        return 1.0f;
    return fresnel_from_cosines(cos_i, cos_t, eta);
}

/* Reflectance of a conductor of index eta + i k (relative to the outside) for cos_i >= 0, in real arithmetic.
 * With sin^2 and cos^2 of the angle of incidence and q = eta^2 - k^2 - sin^2, a + i b = sqrt(q + 2 i eta k)
 * (Born and Wolf, section 14.4.1, eq. 25-27). The smaller one of a and b follows from a b = eta k, because
 * a^2 = (|a + i b|^2 + q) / 2 cancels where q < 0. */
SHARED_FUNCTION float fresnel_conductor(float cos_i, float eta, float k)
{
    float cos2 = float_min(cos_i * cos_i, 1.0f);
    float sin2 = 1.0f - cos2;
    float product = eta * k;
    float q = (eta - k) * (eta + k) - sin2;
    float modulus = float_sqrt(q * q + 4.0f * product * product);
    float large = float_sqrt(0.5f * (modulus + float_abs(q)));
    float a = q >= 0.0f ? large : (large > 0.0f ? product / large : 0.0f);
    float mixed = 2.0f * a * cos_i;
    float sum_s = modulus + cos2 + mixed;
    if (!(sum_s > 0.0f))
        return 1.0f;
    float reflectance_s = (modulus + cos2 - mixed) / sum_s;
    float sum_p = cos2 * modulus + sin2 * sin2 + mixed * sin2;
    if (!(sum_p > 0.0f))
        return reflectance_s;
    float reflectance_p = reflectance_s * ((cos2 * modulus + sin2 * sin2 - mixed * sin2) / sum_p);
    return float_clamp(0.5f * (reflectance_s + reflectance_p), 0.0f, 1.0f);
}

SHARED_FUNCTION Vec3 fresnel_conductor_rgb(float cos_i, Vec3 eta, Vec3 k)
{
    return vec3(fresnel_conductor(cos_i, eta.x, k.x), fresnel_conductor(cos_i, eta.y, k.y),
                fresnel_conductor(cos_i, eta.z, k.z));
}

/* Extinction coefficient of the conductor with eta = 1 that reflects r at normal incidence: r = k^2 / (k^2 + 4). */
SHARED_FUNCTION float extinction_from_reflectance(float r)
{
    float clamped = float_clamp(r, 0.0f, CONDUCTOR_REFLECTANCE_MAX);
    return 2.0f * float_sqrt(clamped / (1.0f - clamped));
}

/* Reflectance of the conductor that pbrt-v4 makes of a "reflectance" parameter: eta = 1, k from
 * extinction_from_reflectance. */
SHARED_FUNCTION Vec3 fresnel_conductor_reflectance(float cos_i, Vec3 reflectance)
{
    return vec3(fresnel_conductor(cos_i, 1.0f, extinction_from_reflectance(reflectance.x)),
                fresnel_conductor(cos_i, 1.0f, extinction_from_reflectance(reflectance.y)),
                fresnel_conductor(cos_i, 1.0f, extinction_from_reflectance(reflectance.z)));
}

#endif
