/* Hair (Chiang, Bitterli, Tappan and Burley, "A practical and controllable hair and fur model for production path
 * tracing", 2016, in the form of pbrt-v4): a rough dielectric cylinder that absorbs inside. Light leaves it after p =
 * 0, 1, 2 or more internal segments (R, TT, TRT and the rest).
 *
 * The frame has the tangent as x. theta is the angle to the plane across the hair, phi the one around it; h, from -1 to
 * 1, is where across the hair wo meets it. What is evaluated is a density of wi, S(wo, wi) = sum over p of A_p
 * M_p(theta_o, theta_i) N_p(phi_i - phi_o), whose parts M_p cos(theta_i) and N_p integrate to 1 over theta_i and phi_i:
 * f(wo, wi) |cos wi| is S. S depends on where wo meets the hair, so it is not symmetric; TRANSPORT_IMPORTANCE exchanges
 * the two directions.
 *
 * Members of the Bsdf: color0 the absorption per radius, color1.x h, color1.y the tilt of the scales in radians,
 * alpha_x and alpha_y the roughnesses beta_m and beta_n, eta. */
#ifndef TWINLIGHT_BSDF_HAIR_H
#define TWINLIGHT_BSDF_HAIR_H

#include "bsdf/fresnel.h"
#include "bsdf/lobe.h"
#include "math/elementary.h"

/* Terms: R, TT, TRT, and all others together. */
#define HAIR_TERMS 4u
#define HAIR_REST 3u

/* Smallest beta_m and beta_n, as in pbrt-v4. */
#define HAIR_BETA_MIN 0.01f

/* ---- roughness and colour ---------------------------------------------------------------------------------------- */

SHARED_FUNCTION float power_of_two_squares(float x, uint squares)
{
    for (uint i = 0u; i < squares; ++i)
        x *= x;
    return x;
}

/* Variance of M_0 (Chiang et al. 2016, equation 7). */
SHARED_FUNCTION float hair_variance(float beta_m)
{
    float power20 = power_of_two_squares(beta_m, 4u) * power_of_two_squares(beta_m, 2u);
    float deviation = 0.726f * beta_m + 0.812f * beta_m * beta_m + 3.7f * power20;
    return deviation * deviation;
}

/* Scale of the logistic function of N_p (equation 8). */
SHARED_FUNCTION float hair_scale(float beta_n)
{
    float square = beta_n * beta_n,
          power22 = power_of_two_squares(beta_n, 4u) * power_of_two_squares(beta_n, 2u) * square;
    return 0.626657069f * (0.265f * beta_n + 1.194f * square + 5.372f * power22);
}

/* Absorption that gives hair of azimuthal roughness beta_n the colour c (equation 9). */
SHARED_FUNCTION float hair_absorption(float c, float beta_n)
{
    float b = beta_n;
    float divisor = 5.969f + b * (-0.215f + b * (2.532f + b * (-10.73f + b * (5.574f + b * 0.245f))));
    float root = float_log(float_clamp(c, 1e-6f, 1.0f)) / divisor;
    return root * root;
}

/* Absorption of the two pigments of human hair, by their concentrations (d'Eon et al. 2011, as linear sRGB in
 * pbrt-v4). */
SHARED_FUNCTION Vec3 hair_melanin(float eumelanin, float pheomelanin)
{
    return vec3_mad(vec3_scale(vec3(0.419f, 0.697f, 1.37f), eumelanin), pheomelanin, vec3(0.187f, 0.4f, 1.05f));
}

/* ---- M_p: along the hair ----------------------------------------------------------------------------------------- */

/* exp(-x) I_0(x) for x >= 0 (Abramowitz and Stegun 1964, 9.8.1 and 9.8.2: 2e-7 at most). */
SHARED_FUNCTION float bessel_i0_scaled(float x)
{
    float y = x / 3.75f;
    if (y < 1.0f) {
        float z = y * y;
        float i0 =
            1.0f + z * (3.5156229f +
                        z * (3.0899424f + z * (1.2067492f + z * (0.2659732f + z * (0.0360768f + z * 0.0045813f)))));
        return i0 * float_exp(-x);
    }
    float z = 1.0f / y;
    float series = 0.39894228f +
                   z * (0.01328592f +
                        z * (0.00225319f +
                             z * (-0.00157565f +
                                  z * (0.00916281f + z * (-0.02057706f +
                                                          z * (0.02635537f + z * (-0.01647633f + z * 0.00392377f)))))));
    return series / float_sqrt(x);
}

/* A direction by its angle to the plane across the hair. */
typedef struct HairAngle {
    float sine, cosine;
} HairAngle;

SHARED_FUNCTION HairAngle hair_angle(Vec3 w)
{
    HairAngle theta;
    theta.sine = w.x;
    theta.cosine = float_sqrt(w.y * w.y + w.z * w.z);
    return theta;
}

/* csch(1/v) / (2 v) exp(-sin i sin o / v) I_0(cos i cos o / v), with all exponentials in one, whose argument -(1 -
 * cos(i + o)) / v is a sum of squares: small v neither overflow nor cancel. (d'Eon et al., "An energy-conserving hair
 * reflectance model", 2011.) */
SHARED_FUNCTION float hair_longitudinal(HairAngle i, HairAngle o, float v)
{
    float across = i.cosine - o.cosine, along = i.sine + o.sine;
    float exponent = -(across * across + along * along) / (2.0f * v);
    return float_exp(exponent) * bessel_i0_scaled(i.cosine * o.cosine / v) / (v * (1.0f - float_exp(-2.0f / v)));
}

/* theta_o, turned by the scales for term p: by -2, 1, 4 and 0 times their tilt. */
SHARED_FUNCTION HairAngle hair_tilted(HairAngle o, float tilt, uint p)
{
    if (p >= HAIR_REST)
        return o;
    float s, c;
    HairAngle turned;
    float_sincos(tilt * (p == 0u ? -2.0f : p == 1u ? 1.0f : 4.0f), &s, &c);
    turned.sine = o.sine * c + o.cosine * s;
    turned.cosine = float_abs(o.cosine * c - o.sine * s);
    return turned;
}

SHARED_FUNCTION float hair_term_variance(float v, uint p)
{
    return p == 0u ? v : p == 1u ? 0.25f * v : 4.0f * v;
}

/* ---- N_p: around the hair ---------------------------------------------------------------------------------------- */

/* The logistic density of scale s, cut off at -pi and pi. */
SHARED_FUNCTION float trimmed_logistic(float x, float s)
{
    float e = float_exp(-float_abs(x) / s), outside = float_exp(-PI / s);
    return e * (1.0f + outside) / (s * (1.0f + e) * (1.0f + e) * (1.0f - outside));
}

/* Draws from it. */
SHARED_FUNCTION float trimmed_logistic_sample(float u, float s)
{
    float outside = float_exp(-PI / s), below = outside / (1.0f + outside);
    float lower = u < 0.5f ? u : 1.0f - u;
    float q = below + lower * (1.0f - 2.0f * below);
    float x = float_clamp(s * float_log(q / (1.0f - q)), -PI, 0.0f);
    return u < 0.5f ? x : -x;
}

/* x modulo 2 pi, in [-pi, pi]. |x| must be below 100. */
SHARED_FUNCTION float angle_wrapped(float x)
{
    float turns = (float)((int)(x * (0.5f * INV_PI) + 100.5f) - 100);
    return float_clamp(x - turns * (2.0f * PI), -PI, PI);
}

/* ---- all terms --------------------------------------------------------------------------------------------------- */

/* What depends on wo alone. */
typedef struct HairTerms {
    HairAngle o;
    float gamma_o, gamma_t; /* angles of incidence and refraction across the hair */
    Vec3 a[HAIR_TERMS]; /* A_p */
    float choice[HAIR_TERMS]; /* probability of drawing term p: its share of the mean colour */
} HairTerms;

SHARED_FUNCTION void hair_attenuations(float fresnel, Vec3 transmitted, Vec3 *a)
{
    float through = (1.0f - fresnel) * (1.0f - fresnel);
    a[0] = vec3_splat(fresnel);
    a[1] = vec3_scale(transmitted, through);
    a[2] = vec3_scale(vec3_mul(a[1], transmitted), fresnel);
    Vec3 once = vec3_scale(transmitted, fresnel), rest = vec3_mul(a[2], once);
    a[HAIR_REST] =
        vec3(rest.x > 0.0f ? rest.x / (1.0f - once.x) : 0.0f, rest.y > 0.0f ? rest.y / (1.0f - once.y) : 0.0f,
             rest.z > 0.0f ? rest.z / (1.0f - once.z) : 0.0f);
}

SHARED_FUNCTION HairTerms hair_terms(const Bsdf *bsdf, Vec3 wo)
{
    HairTerms terms;
    float h = bsdf->color1.x, eta = bsdf->eta;
    terms.o = hair_angle(wo);
    float sine_t = terms.o.sine / eta, cosine_t = float_sqrt(float_max(1.0f - sine_t * sine_t, 0.0f));
    float around = float_sqrt(float_max(eta * eta - terms.o.sine * terms.o.sine, 0.0f)); /* eta' cos theta_o */
    float refracted = around > 0.0f ? float_clamp(h * terms.o.cosine / around, -1.0f, 1.0f) : 0.0f;
    terms.gamma_o = float_asin(h);
    terms.gamma_t = float_asin(refracted);
    float length = cosine_t > 0.0f ? 2.0f * float_sqrt(1.0f - refracted * refracted) / cosine_t : 0.0f;
    Vec3 depth = vec3_scale(bsdf->color0, -length);
    float fresnel = fresnel_dielectric(terms.o.cosine * float_sqrt(1.0f - h * h), eta);
    hair_attenuations(fresnel, vec3(float_exp(depth.x), float_exp(depth.y), float_exp(depth.z)), terms.a);
    float sum = 0.0f;
    for (uint p = 0u; p < HAIR_TERMS; ++p)
        sum += vec3_mean(terms.a[p]);
    for (uint p = 0u; p < HAIR_TERMS; ++p)
        terms.choice[p] = sum > 0.0f ? vec3_mean(terms.a[p]) / sum : 0.25f;
    return terms;
}

/* Azimuth of the middle of N_p, relative to wo. */
SHARED_FUNCTION float hair_azimuth(const HairTerms *terms, uint p)
{
    return 2.0f * (float)p * terms->gamma_t - 2.0f * terms->gamma_o + (float)p * PI;
}

/* S(wo, wi); *pdf_w: the density with which hair_draw draws wi. */
SHARED_FUNCTION_APART Vec3 hair_scattering(const Bsdf *bsdf, Vec3 wo, Vec3 wi, float *pdf_w)
{
    HairTerms terms = hair_terms(bsdf, wo);
    HairAngle i = hair_angle(wi);
    float v = hair_variance(bsdf->alpha_x), s = hair_scale(bsdf->alpha_y);
    float phi = float_atan2(wo.y * wi.z - wo.z * wi.y, wo.y * wi.y + wo.z * wi.z);
    Vec3 sum = vec3_splat(0.0f);
    *pdf_w = 0.0f;
    for (uint p = 0u; p < HAIR_TERMS; ++p) {
        float around =
            p == HAIR_REST ? 0.5f * INV_PI : trimmed_logistic(angle_wrapped(phi - hair_azimuth(&terms, p)), s);
        float density =
            around * hair_longitudinal(i, hair_tilted(terms.o, bsdf->color1.y, p), hair_term_variance(v, p));
        sum = vec3_mad(sum, density, terms.a[p]);
        *pdf_w += density * terms.choice[p];
    }
    return sum;
}

/* Draws wi: a term and one number of theta_i by u_lobe, the others by u. */
SHARED_FUNCTION Vec3 hair_draw(const Bsdf *bsdf, Vec3 wo, float u_lobe, Vec2 u)
{
    HairTerms terms = hair_terms(bsdf, wo);
    uint p = 0u;
    while (p < HAIR_REST && u_lobe >= terms.choice[p]) {
        u_lobe -= terms.choice[p];
        ++p;
    }
    float left = terms.choice[p] > 0.0f ? float_clamp(u_lobe / terms.choice[p], 0.0f, 1.0f) : 0.0f;
    float v = hair_term_variance(hair_variance(bsdf->alpha_x), p), s, c, si, ci;
    HairAngle o = hair_tilted(terms.o, bsdf->color1.y, p);
    /* From the mirror direction of o, 1 - cosine is distributed exponentially, the azimuth uniformly. */
    float e = float_exp(-2.0f / v), versine = -v * float_log(float_max(u.x, 1e-9f) + (1.0f - u.x) * e);
    versine = float_clamp(versine, 0.0f, 2.0f);
    float sine = float_sqrt(versine * (2.0f - versine)), cosine = 1.0f - versine;
    float_sincos(2.0f * PI * left, &s, &c);
    float along = sine * c * o.cosine - cosine * o.sine, x = cosine * o.cosine + sine * c * o.sine, y = sine * s;
    float across = float_sqrt(x * x + y * y);
    float dphi = p == HAIR_REST ? 2.0f * PI * u.y
                                : hair_azimuth(&terms, p) + trimmed_logistic_sample(u.y, hair_scale(bsdf->alpha_y));
    float_sincos(dphi, &si, &ci);
    float oy = terms.o.cosine > 0.0f ? wo.y / terms.o.cosine : 1.0f,
          oz = terms.o.cosine > 0.0f ? wo.z / terms.o.cosine : 0.0f;
    return vec3(along, across * (oy * ci - oz * si), across * (oy * si + oz * ci));
}

/* ---- for bsdf/bsdf.h --------------------------------------------------------------------------------------------- */

/* The Bsdf of the same hair seen by light that comes the other way: it meets the hair at -h. */
SHARED_FUNCTION Bsdf hair_mirrored(const Bsdf *bsdf)
{
    Bsdf mirrored = *bsdf;
    mirrored.color1.x = -bsdf->color1.x;
    return mirrored;
}

/* Paths from the light draw by the hair mirrored, for which S is almost symmetric. */
SHARED_FUNCTION BsdfValue bsdf_hair_eval(const SceneView *scene, const Bsdf *bsdf, Vec3 wo, Vec3 wi, uint transport)
{
    (void)scene;
    BsdfValue value = bsdf_value_zero();
    Bsdf mirrored = hair_mirrored(bsdf);
    if ((bsdf->flags & BSDF_FIBRE) != 0u) { /* bsdf/fibre.h does the rest */
        value.f_cos = hair_scattering(bsdf, wo, wi, &value.pdf_w);
    } else if (transport == TRANSPORT_RADIANCE) {
        value.f_cos = hair_scattering(bsdf, wo, wi, &value.pdf_w);
        hair_scattering(&mirrored, wi, wo, &value.pdf_rev_w);
    } else {
        hair_scattering(&mirrored, wo, wi, &value.pdf_w);
        value.f_cos = vec3_scale(hair_scattering(bsdf, wi, wo, &value.pdf_rev_w), float_abs(wi.z / wo.z));
    }
    return value;
}

SHARED_FUNCTION bool bsdf_hair_sample(const SceneView *scene, const Bsdf *bsdf, Vec3 wo, BsdfDraw draw,
                                      BsdfSample *sample)
{
    Bsdf mirrored = hair_mirrored(bsdf);
    Vec3 wi = hair_draw(draw.transport == TRANSPORT_RADIANCE ? bsdf : &mirrored, wo, draw.u_lobe, draw.u);
    if (!(float_abs(wi.z) > BSDF_COSINE_MIN))
        return false;
    BsdfValue value = bsdf_hair_eval(scene, bsdf, wo, wi, draw.transport);
    if (!(value.pdf_w > 0.0f))
        return false;
    bsdf_sample_set(sample, wi, vec3_scale(value.f_cos, 1.0f / value.pdf_w), value);
    sample->transmitted = wo.z * wi.z < 0.0f ? 1u : 0u;
    return true;
}

/* A direction takes three numbers, so none are those that draw it. */
SHARED_FUNCTION bool bsdf_hair_invert(const SceneView *scene, const Bsdf *bsdf, Vec3 wo, Vec3 wi, float u_lobe,
                                      BsdfInverse *inverse)
{
    (void)scene;
    (void)bsdf;
    (void)wo;
    (void)wi;
    (void)u_lobe;
    (void)inverse;
    return false;
}

#endif
