#include "scene/coat_base_table.h"

#include "bsdf/bsdf.h"
#include "scene/coat_table.h"

#include <math.h>
#include <stdlib.h>

/* Points of the conductor's visible normals for one direction, and cosines in the coat between which its reflection is
 * interpolated. */
#define QUADRATURE_PHI 8
#define QUADRATURE_HEIGHT 48
#define POINTS (QUADRATURE_PHI * QUADRATURE_HEIGHT)
#define INSIDE_CELLS 24

/* Reflections between coat and conductor that are summed; what is left returns total reflection at most. */
#define ROUNDS 64

/* Cosine used for the entry at c = 0. */
#define GRAZING_COSINE 1e-3f

/* Where one point of the quadrature goes: up to a cosine in the coat, with the weight of the conductor's shadowing. */
typedef struct Bounce {
    float cosine, weight;
    float reflected; /* by the coat there */
} Bounce;

/* The smooth interface's reflectance from inside at cosine c. */
static float inside_reflectance(float c, float eta)
{
    return fresnel_dielectric(c, 1.0f / eta);
}

static Vec2 quadrature_point(int k)
{
    int x = k % QUADRATURE_PHI, y = k / QUADRATURE_PHI;
    return vec2(((float)x + 0.5f) / QUADRATURE_PHI, ((float)y + 0.5f) / QUADRATURE_HEIGHT);
}

/* All points for a direction of cosine `c` in the coat. */
static void bounces_make(float c, float alpha, float eta, Bounce bounces[POINTS])
{
    Vec3 o = vec3(float_sqrt((1.0f - c) * (1.0f + c)), 0.0f, c);
    float root_o = ggx_root(o, alpha, alpha);
    for (int k = 0; k < POINTS; ++k) {
        Vec3 m = ggx_sample_visible(o, alpha, alpha, quadrature_point(k));
        Vec3 i = vec3_mad(vec3_negate(o), 2.0f * vec3_dot(o, m), m);
        bounces[k] = (Bounce){.cosine = float_max(i.z, 0.0f)};
        if (!(i.z > BSDF_COSINE_MIN))
            continue;
        bounces[k].weight = ggx_shadowing(o.z, root_o, i.z, ggx_root(i, alpha, alpha));
        bounces[k].reflected = inside_reflectance(i.z, eta);
    }
}

/* What leaves the coat, of light that comes up at cosine c after reflection by a conductor of reflectance `f`:
 * interpolated from `leaves` at the middles of INSIDE_CELLS cells. */
static double leaves_at(const double leaves[INSIDE_CELLS], float c)
{
    double position = (double)c * INSIDE_CELLS - 0.5;
    int cell = (int)fmin(fmax(floor(position), 0.0), INSIDE_CELLS - 2);
    double t = fmin(fmax(position - cell, 0.0), 1.0);
    return (1.0 - t) * leaves[cell] + t * leaves[cell + 1];
}

/* The part of light arriving at the conductor that leaves the coat, directly or after returning to the conductor. */
static double leaves_mean(const Bounce bounces[POINTS], const double leaves[INSIDE_CELLS], double f)
{
    double sum = 0.0;
    for (int k = 0; k < POINTS; ++k) {
        double r = (double)bounces[k].reflected;
        sum += (double)bounces[k].weight * (1.0 - r + r * leaves_at(leaves, bounces[k].cosine));
    }
    return f * sum / POINTS;
}

/* The part that `direct` reflection of bsdf/coated_conductor.h has, for a direction that the coat reflects by r_o. */
static double direct_mean(const Bounce bounces[POINTS], double r_o, double f)
{
    double sum = 0.0;
    for (int k = 0; k < POINTS; ++k) {
        double r = (double)bounces[k].reflected;
        sum += (double)bounces[k].weight * (1.0 - r) / (1.0 - f * fmin(r, r_o));
    }
    return f * sum / POINTS;
}

/* Solves for what leaves, by Neumann's series. inside: POINTS bounces for each of INSIDE_CELLS cosines. */
static void leaves_solve(const Bounce *inside, double f, double leaves[INSIDE_CELLS])
{
    double next[INSIDE_CELLS], change = 1.0;
    for (int j = 0; j < INSIDE_CELLS; ++j)
        leaves[j] = 0.0;
    for (int round = 0; round < ROUNDS && change > 1e-5; ++round) {
        change = 0.0;
        for (int j = 0; j < INSIDE_CELLS; ++j)
            next[j] = leaves_mean(inside + j * POINTS, leaves, f);
        for (int j = 0; j < INSIDE_CELLS; ++j) {
            change = fmax(change, fabs(next[j] - leaves[j]));
            leaves[j] = next[j];
        }
    }
}

/* q such that phi of a conductor of reflectance 1/2 is `ratio`; that of 1 is 1. */
static double ratio_q(double ratio)
{
    double q = ratio < 0.5 ? (1.0 - 4.0 * ratio) / (1.0 - 2.0 * ratio) : 0.0;
    return fmin(fmax(q, 0.0), 0.98);
}

/* Fills row `r`; inside: room for INSIDE_CELLS POINTS bounces. */
static void row_fill(unsigned r, float eta, Bounce *inside, float row[COAT_BASE_ROW])
{
    float root = (float)r / (float)(COAT_BASE_ROWS - 1u), alpha = float_max(root * root, ALPHA_MIN);
    double leaves[INSIDE_CELLS], half_leaves[INSIDE_CELLS], mean = 0.0, half_mean = 0.0;
    Bounce bounces[POINTS];
    for (int j = 0; j < INSIDE_CELLS; ++j)
        bounces_make(((float)j + 0.5f) / INSIDE_CELLS, alpha, eta, inside + j * POINTS);
    leaves_solve(inside, 1.0, leaves);
    leaves_solve(inside, 0.5, half_leaves);
    for (unsigned k = 0; k < COAT_BASE_CELLS; ++k) {
        float cosine = float_max((float)k / (float)(COAT_BASE_CELLS - 1u), GRAZING_COSINE);
        float cos_t = refraction_cosine(cosine, eta);
        row[2 * k] = 1.0f;
        row[2 * k + 1] = 0.0f;
        if (!(cos_t > 0.0f))
            continue;
        bounces_make(cos_t, alpha, eta, bounces);
        double r_o = (double)fresnel_from_cosines(cosine, cos_t, eta), direct = direct_mean(bounces, r_o, 1.0);
        double rest = fmax(leaves_mean(bounces, leaves, 1.0) - direct, 0.0);
        double half_rest = fmax(leaves_mean(bounces, half_leaves, 0.5) - direct_mean(bounces, r_o, 0.5), 0.0);
        double weight = (1.0 - r_o) * 2.0 * (double)cosine / (COAT_BASE_CELLS - 1u);
        weight *= k == COAT_BASE_CELLS - 1u ? 0.5 : 1.0;
        row[2 * k] = (float)direct;
        row[2 * k + 1] = (float)rest;
        mean += weight * rest;
        half_mean += weight * half_rest;
    }
    row[2 * COAT_BASE_CELLS] = (float)mean;
    row[2 * COAT_BASE_CELLS + 1] = mean > 0.0 ? (float)ratio_q(half_mean / mean) : 0.0f;
}

/* What a rough coat transmits and reflects of light from inside, of direction `o` there, o.z > 0: means over visible
 * normals, as of dielectric_rough_sample. */
static void inside_pair(float alpha, float eta, Vec3 o, float pair[2])
{
    double transmitted = 0.0, reflected = 0.0;
    float root_o = ggx_root(o, alpha, alpha);
    for (int k = 0; k < POINTS; ++k) {
        Vec3 m = ggx_sample_visible(o, alpha, alpha, quadrature_point(k)), i;
        float cos_o = vec3_dot(o, m);
        if (!(cos_o > 0.0f))
            continue;
        float cos_t = refraction_cosine(cos_o, 1.0f / eta);
        float r = cos_t < 0.0f ? 1.0f : fresnel_from_cosines(cos_o, cos_t, 1.0f / eta);
        i = vec3_mad(vec3_negate(o), 2.0f * cos_o, m);
        if (i.z > BSDF_COSINE_MIN)
            reflected += (double)(r * ggx_shadowing(o.z, root_o, i.z, ggx_root(i, alpha, alpha)));
        i = vec3_mad(vec3_scale(o, -eta), cos_o * eta - cos_t, m);
        if (cos_t > 0.0f && i.z < -BSDF_COSINE_MIN)
            transmitted += (double)((1.0f - r) * ggx_shadowing(o.z, root_o, -i.z, ggx_root(i, alpha, alpha)));
    }
    pair[0] = (float)(transmitted / POINTS);
    pair[1] = (float)(reflected / POINTS);
}

/* X and R of all rows. */
static void inside_fill(float eta, float *rows)
{
    for (unsigned r = 0; r < COAT_BASE_ROWS; ++r)
        for (unsigned k = 0; k < COAT_BASE_CELLS; ++k) {
            float root = (float)r / (float)(COAT_BASE_ROWS - 1u);
            float cosine = float_max((float)k / (float)(COAT_BASE_CELLS - 1u), GRAZING_COSINE);
            float cos_t = refraction_cosine(cosine, eta), *pair = rows + 2u * (r * COAT_BASE_CELLS + k);
            pair[0] = 0.0f;
            pair[1] = 1.0f;
            if (cos_t > 0.0f)
                inside_pair(float_max(root * root, ALPHA_MIN), eta,
                            vec3(float_sqrt((1.0f - cos_t) * (1.0f + cos_t)), 0.0f, cos_t), pair);
        }
}

bool coat_base_build(float eta, float thickness, bool rough, Array *lookup, uint32_t *first, Error *error)
{
    size_t words = rough ? COAT_OUTSIDE : COAT_INSIDE;
    if (lookup->count + words >= NONE) {
        error_set(error, "the scene's tables exceed %u numbers", NONE);
        return false;
    }
    Bounce *inside = malloc((size_t)INSIDE_CELLS * POINTS * sizeof *inside);
    *first = (uint32_t)lookup->count;
    float *record = inside ? array_grow(lookup, words, error) : NULL;
    if (!inside)
        error_memory(error, (size_t)INSIDE_CELLS * POINTS * sizeof *inside, "the table of a coat");
    if (record) {
        record[0] = thickness;
        record[1] = coat_round_trip(eta, thickness);
        for (unsigned r = 0; r < COAT_BASE_ROWS; ++r)
            row_fill(r, eta, inside, record + 2 + r * COAT_BASE_ROW);
        if (rough)
            inside_fill(eta, record + COAT_INSIDE);
    }
    free(inside);
    return record != NULL;
}
