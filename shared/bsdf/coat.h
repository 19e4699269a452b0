/* The dielectric coat of coateddiffuse and coatedconductor: what it transmits and reflects. Transmission: in closed form
 * where it is smooth, a table where it is rough.
 *
 * T(w) is the fraction of the light arriving from direction w outside that the interface sends inside. Averaged over a
 * diffuse field, T_mean = integral of T(c) 2 c dc over 0..1. By reciprocity of the interface the fraction of a diffuse
 * field *inside* that gets out is T_mean / eta^2; the rest, R_i, goes back to the base.
 *
 * The coat absorbs: pbrt gives its medium unit extinction over the depth `thickness`, and no scattering. Light that
 * crosses the coat with cosine c_t inside is attenuated by exp(-thickness / c_t) (coat_absorption; a rough interface
 * scatters around that direction, and the difference is second order in a thickness of 0.01). Diffuse light that the
 * interface reflects back to the base is attenuated by exp(-2 thickness / c), averaged over R(c) 2 c dc:
 * coat_round_trip in host/scene/coat_table.c.
 *
 * Layout of a table in `lookup`, from Bsdf.coat_table on (all floats):
 *     [0]                              rows
 *     [1 + r * COAT_ROW + k]           k < COAT_CELLS: T(c) of row r at c = k / (COAT_CELLS - 1), linear in between
 *     [1 + r * COAT_ROW + COAT_CELLS]  1 - R_i of row r, from the integral of the linear interpolant, so that what the
 *                                      table says is transmitted is what comes back out
 * What the rows are, all linear in between:
 *     1 row                  an isotropic coat
 *     COAT_AZIMUTH_ROWS      an anisotropic coat; row r holds the directions whose azimuth has the sine (from the
 *                            less rough axis) r / (COAT_AZIMUTH_ROWS - 1). T is smooth in that sine, because the
 *                            roughness along azimuth phi is sqrt(alpha_min^2 cos^2 phi + alpha_max^2 sin^2 phi). Every
 *                            row has the same 1 - R_i.
 *     COAT_ALPHA_ROWS        a textured roughness; row r is isotropic with alpha = (r / (COAT_ALPHA_ROWS - 1))^2,
 *                            row 0 smooth; clamped above 1; sqrt(alpha_x alpha_y) where the texture is anisotropic.
 * host/scene/coat_table.c builds them. */
#ifndef TWINLIGHT_BSDF_COAT_H
#define TWINLIGHT_BSDF_COAT_H

#include "bsdf/fresnel.h"
#include "bsdf/microfacet.h"
#include "layout/path_types.h"
#include "layout/scene_view.h"
#include "math/elementary.h"

#define COAT_CELLS 64u
#define COAT_ROW (COAT_CELLS + 1u)
#define COAT_AZIMUTH_ROWS 9u
#define COAT_ALPHA_ROWS 17u

/* Largest eta of the closed form below; beyond it 1 - R_i is overestimated, which darkens. */
#define COAT_ETA_MAX 4.0f

/* T_mean of a smooth interface with eta >= 1, to a relative 1e-4: 1 - q^2 p(q), q = sqrt((eta - 1) / (eta + 1)), with p
 * the polynomial through eight Chebyshev points of the exact integral (Walsh 1926; see
 * tests/bsdf/test_bsdf_coated.c). */
SHARED_FUNCTION float coat_smooth_mean(float eta)
{
    float clamped = float_min(eta, COAT_ETA_MAX);
    float q = float_sqrt((clamped - 1.0f) / (clamped + 1.0f));
    float p = 20.6582987f;
    p = p * q - 67.0175121f;
    p = p * q + 91.2032134f;
    p = p * q - 67.0965884f;
    p = p * q + 28.7681031f;
    p = p * q - 5.87618604f;
    p = p * q - 0.205641311f;
    p = p * q + 0.667637352f;
    return 1.0f - q * q * p;
}

/* 1 - R_i of a smooth coat: T_mean(eta) / eta^2, which for eta < 1 is T_mean(1 / eta) by the same reciprocity. */
SHARED_FUNCTION float coat_smooth_escape(float eta)
{
    if (eta < 1.0f)
        return coat_smooth_mean(1.0f / eta);
    return coat_smooth_mean(eta) / (eta * eta);
}

SHARED_FUNCTION float coat_row_transmission(__global const float *row, float cosine)
{
    float position = float_clamp(cosine, 0.0f, 1.0f) * (float)(COAT_CELLS - 1u);
    uint cell = (uint)position;
    if (cell > COAT_CELLS - 2u)
        cell = COAT_CELLS - 2u;
    float t = position - (float)cell;
    return (1.0f - t) * row[cell] + t * row[cell + 1u];
}

/* The position of direction w among the rows of a table with more than one, as row + fraction. */
SHARED_FUNCTION float coat_row_position(uint rows, float alpha_x, float alpha_y, Vec3 w)
{
    float coordinate;
    if (rows == COAT_ALPHA_ROWS) {
        coordinate = float_sqrt(float_sqrt(alpha_x * alpha_y));
    } else {
        float across = alpha_x < alpha_y ? w.y : w.x;
        float horizontal = w.x * w.x + w.y * w.y;
        coordinate = horizontal > 0.0f ? float_abs(across) / float_sqrt(horizontal) : 0.0f;
    }
    return float_min(coordinate, 1.0f) * (float)(rows - 1u);
}

/* T of direction w (w.z > 0); *escape: 1 - R_i. */
SHARED_FUNCTION float coat_table_lookup(__global const float *table, float alpha_x, float alpha_y, Vec3 w,
                                        float *escape)
{
    uint rows = (uint)table[0];
    __global const float *row = table + 1;
    float t = 0.0f;
    if (rows > 1u) {
        float position = coat_row_position(rows, alpha_x, alpha_y, w);
        uint r = (uint)position;
        if (r > rows - 2u)
            r = rows - 2u;
        row += r * COAT_ROW;
        t = position - (float)r;
    }
    *escape = row[COAT_CELLS];
    float transmission = coat_row_transmission(row, w.z);
    if (rows > 1u) {
        row += COAT_ROW;
        *escape = (1.0f - t) * *escape + t * row[COAT_CELLS];
        transmission = (1.0f - t) * transmission + t * coat_row_transmission(row, w.z);
    }
    return transmission;
}

/* Transmittance of one crossing of the coat by light whose cosine outside is `cosine`. */
SHARED_FUNCTION float coat_absorption(float thickness, float eta, float cosine)
{
    if (!(thickness > 0.0f))
        return 1.0f;
    float cos_t = refraction_cosine(cosine, eta);
    return cos_t > 0.0f ? float_exp(-thickness / cos_t) : 0.0f;
}

/* Adds the reflection of a rough coat for o.z, i.z > 0; p_o, p_i: probability of drawing it given o, and given i. */
SHARED_FUNCTION void coat_reflection_add(const Bsdf *bsdf, Vec3 o, Vec3 i, float p_o, float p_i, BsdfValue *value)
{
    Vec3 h = vec3_add(o, i);
    float density = 0.5f * ggx_density(h, bsdf->alpha_x, bsdf->alpha_y);
    float root_o = ggx_root(o, bsdf->alpha_x, bsdf->alpha_y);
    float root_i = ggx_root(i, bsdf->alpha_x, bsdf->alpha_y);
    float reflectance = fresnel_dielectric(float_min(0.5f * vec3_length(h), 1.0f), bsdf->eta);
    float f_cos = reflectance * density * i.z / (root_o * i.z + root_i * o.z);
    value->f_cos = vec3_add(value->f_cos, vec3_splat(f_cos));
    value->pdf_w += p_o * density / (o.z + root_o);
    value->pdf_rev_w += p_i * density / (i.z + root_i);
}

#endif
