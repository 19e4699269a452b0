/* A dielectric coat, smooth or rough, over a conductor, smooth or rough (pbrt-v4's coatedconductor, its medium absorbing
 * only), in closed form. Light that meets the coat from below is treated like light from above, as pbrt does.
 *
 * Notation: T(w) is what the coat transmits of light from direction w outside; w' is the refracted direction in the coat;
 * X(w) and R(w) are what the coat transmits and reflects of light that comes from w' inside. Of a smooth coat X = T and R =
 * 1 - T. P = sqrt(T X). a(w) is the transmittance of one crossing, F the reflectance of the conductor in the coat, f_c its
 * microfacet reflection for F = 1.
 *
 *   - The coat's own reflection, as of coateddiffuse.
 *   - Direct reflection by the conductor, with every further reflection between the two near its direction,
 *         f = P(wo) P(wi) a(wo) a(wi) F f_c(wo', wi') / (eta^2 (1 - F a(wo) a(wi) min(R(wo), R(wi)))).
 *     Where both are smooth, wo and wi have the same R and the sum over reflections is exact. The smaller R keeps the
 *     factor of F = 1 from exceeding one over T of either direction, so nothing is gained. A rough coat bends the light
 *     at both crossings as if the conductor were rougher: where light crosses in direction w, a slope of the coat turns
 *     it by (1 - w.z / (eta w'.z)) / 2 of what the same slope of the conductor does. The variances of slopes add up, those of
 *     both crossings being that of the direction which is turned less, so that no direction has more light than it is
 *     drawn for.
 *   - The rest: light that leaves the conductor in other directions and is reflected back by the coat, often totally. As
 *     a product of functions of both directions (as Kelemen and Szirmay-Kalos 2001 do for what microfacets lose),
 *         f = L(wo) L(wi) / (pi L_mean) phi(F),  L = T a l,  L_mean = integral of T l 2 c dc,
 *     where l is the part of a white conductor's reflection that `direct` leaves out (host/scene/coat_base_table.c solves
 *     for it, for a smooth coat), and phi sums over k >= 2 reflections by the conductor whose number falls off with the
 *     ratio q.
 *
 * All three are reciprocal. tests/bsdf/test_bsdf_coated_conductor.c compares with a random walk between the layers.
 *
 * Layout of a record in `lookup`, from Bsdf.coat_table on (floats); c = k / (COAT_BASE_CELLS - 1) is a cosine outside, row r
 * belongs to alpha = (r / (COAT_BASE_ROWS - 1))^2:
 *     [0] thickness, [1] transmittance of a round trip (coat_round_trip)
 *     [2 + r COAT_BASE_ROW + 2 k ...]  of effective alpha: the fraction of what the coat transmits that is reflected
 *                                      directly, and l
 *     [... + 2 COAT_BASE_CELLS ...]    of row r: L_mean, q
 * and, if the coat is rough,
 *     [COAT_INSIDE + 2 (r COAT_BASE_CELLS + k) ...]  of the coat's alpha: X and R
 *     [COAT_OUTSIDE ...]               a table of bsdf/coat.h */
#ifndef TWINLIGHT_BSDF_COATED_CONDUCTOR_H
#define TWINLIGHT_BSDF_COATED_CONDUCTOR_H

#include "bsdf/coat.h"
#include "bsdf/conductor.h"

#define COAT_BASE_CELLS 24u
#define COAT_BASE_ROW (2u * COAT_BASE_CELLS + 2u)
#define COAT_BASE_ROWS 12u
#define COAT_INSIDE (2u + COAT_BASE_ROWS * COAT_BASE_ROW)
#define COAT_OUTSIDE (COAT_INSIDE + 2u * COAT_BASE_ROWS * COAT_BASE_CELLS)

/* Cosine at which a Fresnel reflectance of Schlick's form equals its mean over a diffuse field: (1 - c)^5 = 1/21. */
#define FRESNEL_MEAN_COSINE 0.456f

/* The conductor's alphas are in Bsdf.flags: above BSDF_BASE_SHIFT two numbers of BSDF_BASE_BITS, the square roots of
 * the alphas in [0, 1]; 0 if it is smooth. */
#define BSDF_BASE_SHIFT 4u
#define BSDF_BASE_BITS 14u
#define BSDF_BASE_MAX 16383u

SHARED_FUNCTION uint bsdf_base_pack(float alpha_x, float alpha_y)
{
    if (alpha_x < ALPHA_DELTA && alpha_y < ALPHA_DELTA)
        return 0u;
    uint x = (uint)(float_sqrt(float_clamp(alpha_x, ALPHA_MIN, 1.0f)) * (float)BSDF_BASE_MAX + 0.5f);
    uint y = (uint)(float_sqrt(float_clamp(alpha_y, ALPHA_MIN, 1.0f)) * (float)BSDF_BASE_MAX + 0.5f);
    return (x | y << BSDF_BASE_BITS) << BSDF_BASE_SHIFT;
}

SHARED_FUNCTION Vec2 bsdf_base_alphas(uint flags)
{
    float x = (float)(flags >> BSDF_BASE_SHIFT & BSDF_BASE_MAX) / (float)BSDF_BASE_MAX;
    float y = (float)(flags >> (BSDF_BASE_SHIFT + BSDF_BASE_BITS)) / (float)BSDF_BASE_MAX;
    return vec2(x * x, y * y);
}

SHARED_FUNCTION bool bsdf_base_is_anisotropic(uint flags)
{
    return (flags >> BSDF_BASE_SHIFT & BSDF_BASE_MAX) != flags >> (BSDF_BASE_SHIFT + BSDF_BASE_BITS);
}

/* What is the same for all directions of a Bsdf that is not smooth. */
typedef struct CoatedConductor {
    Vec2 base2, coat2; /* squared alphas of both layers; the coat's are 0 if it is smooth */
    float row; /* position among the rows of the table */
    float round_trip;
    float rest_mean; /* L_mean */
    Vec3 rest; /* phi */
    float direct_weight, rest_weight; /* of lobes, for the choice between them */
} CoatedConductor;

/* What the coat does with light from a direction. A number below `coat` draws its reflection, one below `direct`, which
 * is no less, direct reflection, any other the rest. */
typedef struct CoatedSide {
    Vec3 w; /* the direction, w.z > 0 */
    Vec3 inside; /* w' */
    float transmitted; /* T; 0 where nothing enters */
    float passed, back; /* P and R */
    float absorbed; /* a */
    float reflected, rest; /* of the table: the fraction of direct reflection, and l */
    float bend2; /* coated_bend2 */
    Vec2 alpha; /* effective alphas with which direct reflection is drawn: where both directions bend alike */
    float coat, direct;
} CoatedSide;

SHARED_FUNCTION bool bsdf_has_record(const Bsdf *bsdf)
{
    return bsdf->coat_table != NONE;
}

/* The position of an alpha among rows. */
SHARED_FUNCTION float coat_base_position(float alpha_x, float alpha_y)
{
    return float_min(float_sqrt(float_sqrt(alpha_x * alpha_y)), 1.0f) * (float)(COAT_BASE_ROWS - 1u);
}

/* Number k of rows of `width` floats, linear between rows. */
SHARED_FUNCTION float coat_base_entry(__global const float *rows, uint width, float position, uint k)
{
    uint r = (uint)position;
    if (r > COAT_BASE_ROWS - 2u)
        r = COAT_BASE_ROWS - 2u;
    float t = position - (float)r;
    return (1.0f - t) * rows[r * width + k] + t * rows[(r + 1u) * width + k];
}

/* Both numbers of the cells at a cosine, linear between cells. */
SHARED_FUNCTION Vec2 coat_base_pair(__global const float *rows, uint width, float position, float cosine)
{
    float at = float_min(cosine, 1.0f) * (float)(COAT_BASE_CELLS - 1u);
    uint cell = (uint)at;
    if (cell > COAT_BASE_CELLS - 2u)
        cell = COAT_BASE_CELLS - 2u;
    float t = at - (float)cell;
    uint k = 2u * cell;
    return vec2((1.0f - t) * coat_base_entry(rows, width, position, k) +
                    t * coat_base_entry(rows, width, position, k + 2u),
                (1.0f - t) * coat_base_entry(rows, width, position, k + 1u) +
                    t * coat_base_entry(rows, width, position, k + 3u));
}

SHARED_FUNCTION float coated_conductor_phi(float reflectance, float round_trip, float q)
{
    return reflectance * reflectance * round_trip * (1.0f - q) / (1.0f - q * reflectance * round_trip);
}

/* By how much of the conductor's turn a slope of the coat turns light, squared; cosines of w and w'. */
SHARED_FUNCTION float coated_bend2(float eta, float cosine, float cos_t)
{
    float bend = 0.5f * (1.0f - cosine / (eta * cos_t));
    return bend * bend;
}

/* Effective alphas of direct reflection, where both directions have coated_bend2 = bend2. */
SHARED_FUNCTION Vec2 coated_alphas(const CoatedConductor *c, float bend2)
{
    return vec2(float_clamp(float_sqrt(c->base2.x + 2.0f * bend2 * c->coat2.x), ALPHA_MIN, 1.0f),
                float_clamp(float_sqrt(c->base2.y + 2.0f * bend2 * c->coat2.y), ALPHA_MIN, 1.0f));
}

SHARED_FUNCTION CoatedConductor coated_conductor(const SceneView *scene, const Bsdf *bsdf)
{
    CoatedConductor c = {0};
    Vec2 base = bsdf_base_alphas(bsdf->flags);
    bool rough = bsdf_is_rough(scene, bsdf);
    c.base2 = vec2(base.x * base.x, base.y * base.y);
    c.coat2 = vec2(rough ? bsdf->alpha_x * bsdf->alpha_x : 0.0f, rough ? bsdf->alpha_y * bsdf->alpha_y : 0.0f);
    Vec2 upright = coated_alphas(&c, coated_bend2(bsdf->eta, 1.0f, 1.0f));
    c.row = coat_base_position(upright.x, upright.y);
    Vec3 mean = fresnel_conductor_rgb(FRESNEL_MEAN_COSINE, bsdf->color0, bsdf->color1);
    c.round_trip = 1.0f;
    c.rest_mean = 0.0f;
    c.rest = vec3_splat(0.0f);
    if (bsdf_has_record(bsdf)) {
        __global const float *record = scene->lookup + bsdf->coat_table;
        float q = coat_base_entry(record + 2, COAT_BASE_ROW, c.row, 2u * COAT_BASE_CELLS + 1u);
        c.round_trip = record[1];
        c.rest_mean = coat_base_entry(record + 2, COAT_BASE_ROW, c.row, 2u * COAT_BASE_CELLS);
        c.rest = vec3(coated_conductor_phi(mean.x, c.round_trip, q), coated_conductor_phi(mean.y, c.round_trip, q),
                      coated_conductor_phi(mean.z, c.round_trip, q));
    }
    c.direct_weight = 0.5f + 0.5f * vec3_max_component(mean); /* grazing reflectance may be far above the mean */
    c.rest_weight = c.rest_mean > 0.0f ? vec3_max_component(c.rest) : 0.0f;
    return c;
}

/* Chooses lobes in proportion to about what each reflects. */
SHARED_FUNCTION void coated_side_choose(const CoatedConductor *c, CoatedSide *side)
{
    float entered = side->transmitted * side->absorbed * side->absorbed;
    float first = 1.0f - side->transmitted, second = entered * side->reflected * c->direct_weight;
    float third = entered * side->rest * c->rest_weight, sum = first + second + third;
    side->coat = sum > 0.0f ? first / sum : 1.0f;
    side->direct = sum > 0.0f && third > 0.0f ? (first + second) / sum : 1.0f;
}

/* T, P and R of a rough coat. */
SHARED_FUNCTION void coated_side_rough(const SceneView *scene, const Bsdf *bsdf, CoatedSide *side)
{
    __global const float *record = scene->lookup + bsdf->coat_table;
    float position = coat_base_position(bsdf->alpha_x, bsdf->alpha_y), escape;
    Vec2 inside = coat_base_pair(record + COAT_INSIDE, 2u * COAT_BASE_CELLS, position, side->w.z);
    side->transmitted = coat_table_lookup(record + COAT_OUTSIDE, bsdf->alpha_x, bsdf->alpha_y, side->w, &escape);
    side->passed = float_sqrt(side->transmitted * inside.x);
    side->back = inside.y;
}

/* Of direction w, w.z > 0. */
SHARED_FUNCTION CoatedSide coated_side(const SceneView *scene, const Bsdf *bsdf, const CoatedConductor *c, Vec3 w)
{
    CoatedSide side = {0};
    float cos_t = refraction_cosine(w.z, bsdf->eta), thickness = 0.0f;
    side.w = w;
    side.inside = vec3(w.x / bsdf->eta, w.y / bsdf->eta, cos_t);
    side.back = cos_t > 0.0f ? fresnel_from_cosines(w.z, cos_t, bsdf->eta) : 1.0f;
    side.transmitted = side.passed = 1.0f - side.back;
    side.reflected = 1.0f;
    side.rest = 0.0f;
    side.bend2 = cos_t > 0.0f ? coated_bend2(bsdf->eta, w.z, cos_t) : 0.0f;
    side.alpha = coated_alphas(c, side.bend2);
    if (bsdf_has_record(bsdf)) {
        __global const float *record = scene->lookup + bsdf->coat_table;
        Vec2 table = coat_base_pair(record + 2, COAT_BASE_ROW, c->row, w.z);
        thickness = record[0];
        side.reflected = table.x;
        side.rest = table.y;
        if (cos_t > 0.0f && bsdf_is_rough(scene, bsdf))
            coated_side_rough(scene, bsdf, &side);
    }
    side.absorbed = coat_absorption(thickness, bsdf->eta, w.z);
    coated_side_choose(c, &side);
    return side;
}

/* Density of drawing `to` by direct reflection of `from`; h: their half vector. */
SHARED_FUNCTION float coated_direct_density(float eta, const CoatedSide *from, const CoatedSide *to, Vec3 h)
{
    float density = ggx_density(h, from->alpha.x, from->alpha.y);
    float root = ggx_root(from->inside, from->alpha.x, from->alpha.y);
    return 0.5f * density * to->w.z / ((from->inside.z + root) * eta * eta * to->inside.z);
}

/* Adds direct reflection from i to o; light enters from both. */
SHARED_FUNCTION void coated_direct_add(const Bsdf *bsdf, const CoatedConductor *c, const CoatedSide *o,
                                       const CoatedSide *i, BsdfValue *value)
{
    Vec3 h = vec3_add(o->inside, i->inside);
    Vec2 alpha = coated_alphas(c, float_min(o->bend2, i->bend2));
    float root_o = ggx_root(o->inside, alpha.x, alpha.y), root_i = ggx_root(i->inside, alpha.x, alpha.y);
    float absorbed = o->absorbed * i->absorbed, eta = bsdf->eta;
    float back = absorbed * float_min(o->back, i->back);
    Vec3 f = fresnel_conductor_rgb(float_min(0.5f * vec3_length(h), 1.0f), bsdf->color0, bsdf->color1);
    f = vec3(f.x / (1.0f - f.x * back), f.y / (1.0f - f.y * back), f.z / (1.0f - f.z * back));
    float scale = o->passed * i->passed * absorbed * 0.5f * ggx_density(h, alpha.x, alpha.y) * i->w.z;
    scale /= eta * eta * (root_o * i->inside.z + root_i * o->inside.z);
    value->f_cos = vec3_mad(value->f_cos, scale, f);
    value->pdf_w += (o->direct - o->coat) * coated_direct_density(eta, o, i, h);
    value->pdf_rev_w += (i->direct - i->coat) * coated_direct_density(eta, i, o, h);
}

/* The rest, from i to o, and its densities. */
SHARED_FUNCTION BsdfValue coated_rest(const CoatedConductor *c, const CoatedSide *o, const CoatedSide *i)
{
    BsdfValue value = bsdf_value_zero();
    if (!(c->rest_mean > 0.0f))
        return value;
    float l_o = o->transmitted * o->absorbed * o->rest, l_i = i->transmitted * i->absorbed * i->rest;
    value.f_cos = vec3_scale(c->rest, l_o * l_i * i->w.z * INV_PI / c->rest_mean);
    value.pdf_w = (1.0f - o->direct) * i->w.z * INV_PI;
    value.pdf_rev_w = (1.0f - i->direct) * o->w.z * INV_PI;
    return value;
}

/* Value for o.z, i.z > 0 of a Bsdf that is not smooth. */
SHARED_FUNCTION BsdfValue coated_conductor_eval_above(const SceneView *scene, const Bsdf *bsdf, Vec3 o, Vec3 i)
{
    CoatedConductor c = coated_conductor(scene, bsdf);
    CoatedSide side_o = coated_side(scene, bsdf, &c, o), side_i = coated_side(scene, bsdf, &c, i);
    BsdfValue value = coated_rest(&c, &side_o, &side_i);
    if (side_o.transmitted > 0.0f && side_i.transmitted > 0.0f)
        coated_direct_add(bsdf, &c, &side_o, &side_i, &value);
    if (bsdf_is_rough(scene, bsdf))
        coat_reflection_add(bsdf, o, i, side_o.coat, side_i.coat, &value);
    return value;
}

/* Both interfaces smooth: a mirror with the sum of all reflections between them, each channel a geometric series. */
SHARED_FUNCTION Vec3 coated_mirror(const SceneView *scene, const Bsdf *bsdf, float cosine)
{
    float cos_t = refraction_cosine(cosine, bsdf->eta);
    if (!(cos_t > 0.0f))
        return vec3_splat(1.0f);
    float r = fresnel_from_cosines(cosine, cos_t, bsdf->eta), t = 1.0f - r;
    float absorbed = coat_absorption(bsdf_has_record(bsdf) ? scene->lookup[bsdf->coat_table] : 0.0f, bsdf->eta, cosine);
    Vec3 f = vec3_scale(fresnel_conductor_rgb(cos_t, bsdf->color0, bsdf->color1), absorbed * absorbed);
    return vec3(r + t * t * f.x / (1.0f - r * f.x), r + t * t * f.y / (1.0f - r * f.y),
                r + t * t * f.z / (1.0f - r * f.z));
}

/* Draws from direct reflection; false where the direction does not leave the coat. */
SHARED_FUNCTION bool coated_direct_draw(float eta, const CoatedSide *side, Vec2 u, Vec3 *i)
{
    Vec3 m = ggx_sample_visible(side->inside, side->alpha.x, side->alpha.y, u);
    Vec3 w = vec3_mad(vec3_negate(side->inside), 2.0f * vec3_dot(side->inside, m), m);
    float cosine = w.z > 0.0f ? refraction_cosine(w.z, 1.0f / eta) : -1.0f;
    if (!(cosine > 0.0f))
        return false;
    *i = vec3_normalize(vec3(w.x * eta, w.y * eta, cosine));
    return true;
}

/* For o.z > 0 and a Bsdf that is not smooth. *delta: the reflection of a smooth coat, with probability *probability. */
SHARED_FUNCTION bool coated_conductor_draw(const SceneView *scene, const Bsdf *bsdf, Vec3 o, BsdfDraw draw, Vec3 *i,
                                           bool *delta, float *probability)
{
    CoatedConductor c = coated_conductor(scene, bsdf);
    CoatedSide side = coated_side(scene, bsdf, &c, o);
    *delta = false;
    *probability = side.coat;
    if (draw.u_lobe < side.coat) {
        *delta = !bsdf_is_rough(scene, bsdf);
        Vec3 m = vec3(0.0f, 0.0f, 1.0f);
        if (!*delta)
            m = ggx_sample_visible(o, bsdf->alpha_x, bsdf->alpha_y, draw.u);
        *i = vec3_mad(vec3_negate(o), 2.0f * vec3_dot(o, m), m);
        return true;
    }
    if (draw.u_lobe < side.direct)
        return coated_direct_draw(bsdf->eta, &side, draw.u, i);
    *i = warp_cosine_hemisphere(draw.u_base);
    return true;
}

/* ---- for bsdf/bsdf.h --------------------------------------------------------------------------------------------- */

SHARED_FUNCTION_APART BsdfValue bsdf_coated_conductor_eval(const SceneView *scene, const Bsdf *bsdf, Vec3 wo, Vec3 wi,
                                                           uint transport)
{
    (void)transport;
    if (!(wo.z * wi.z > 0.0f) || (bsdf->flags & BSDF_SMOOTH) != 0u)
        return bsdf_value_zero();
    bool flip = wo.z < 0.0f;
    return coated_conductor_eval_above(scene, bsdf, direction_flip(wo, flip), direction_flip(wi, flip));
}

SHARED_FUNCTION_APART bool bsdf_coated_conductor_sample(const SceneView *scene, const Bsdf *bsdf, Vec3 wo,
                                                        BsdfDraw draw, BsdfSample *sample)
{
    bool flip = wo.z < 0.0f, delta;
    Vec3 mirrored = vec3(-wo.x, -wo.y, wo.z);
    if ((bsdf->flags & BSDF_SMOOTH) != 0u) {
        bsdf_sample_set_delta(sample, mirrored, coated_mirror(scene, bsdf, float_abs(wo.z)), 1.0f);
        return true;
    }
    Vec3 o = direction_flip(wo, flip), i;
    float probability;
    if (!coated_conductor_draw(scene, bsdf, o, draw, &i, &delta, &probability) || !(i.z > BSDF_COSINE_MIN))
        return false;
    if (delta) {
        float reflected = fresnel_dielectric(o.z, bsdf->eta);
        bsdf_sample_set_delta(sample, mirrored, vec3_splat(reflected / probability), probability);
        return true;
    }
    BsdfValue value = coated_conductor_eval_above(scene, bsdf, o, i);
    if (!(value.pdf_w > 0.0f))
        return false;
    bsdf_sample_set(sample, direction_flip(i, flip), vec3_scale(value.f_cos, 1.0f / value.pdf_w), value);
    return true;
}

SHARED_FUNCTION_APART bool bsdf_coated_conductor_invert(const SceneView *scene, const Bsdf *bsdf, Vec3 wo, Vec3 wi,
                                                        float u_lobe, BsdfInverse *inverse)
{
    bool flip = wo.z < 0.0f;
    if (!(wo.z * wi.z > 0.0f) || (bsdf->flags & BSDF_SMOOTH) != 0u)
        return false;
    Vec3 o = direction_flip(wo, flip), i = direction_flip(wi, flip);
    CoatedConductor c = coated_conductor(scene, bsdf);
    CoatedSide side_o = coated_side(scene, bsdf, &c, o), side_i = coated_side(scene, bsdf, &c, i);
    if (u_lobe < side_o.coat)
        return bsdf_is_rough(scene, bsdf) && reflection_invert(bsdf, o, i, inverse);
    if (!(u_lobe < side_o.direct))
        return cosine_invert(i, inverse);
    if (!(side_i.transmitted > 0.0f))
        return false;
    Vec3 h = vec3_add(side_o.inside, side_i.inside);
    inverse->u = ggx_invert_visible(side_o.inside, h, side_o.alpha.x, side_o.alpha.y);
    inverse->pdf_w = coated_direct_density(bsdf->eta, &side_o, &side_i, h);
    inverse->base = false;
    return true;
}

#endif
