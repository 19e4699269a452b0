/* Gradient noise on the integer lattice (Perlin 2002, "Improving Noise", with its published permutation) and sums of
 * its octaves. Gradients are chosen as in pbrt-v4, whose last four of sixteen differ from Perlin's, so that the
 * patterns are pbrt's. */
#ifndef TWINLIGHT_MATH_NOISE_H
#define TWINLIGHT_MATH_NOISE_H

#include "math/vec.h"

__constant uchar NOISE_PERMUTATION[256] = {
    151u, 160u, 137u, 91u,  90u,  15u,  131u, 13u,  201u, 95u,  96u,  53u,  194u, 233u, 7u,   225u, 140u, 36u,  103u,
    30u,  69u,  142u, 8u,   99u,  37u,  240u, 21u,  10u,  23u,  190u, 6u,   148u, 247u, 120u, 234u, 75u,  0u,   26u,
    197u, 62u,  94u,  252u, 219u, 203u, 117u, 35u,  11u,  32u,  57u,  177u, 33u,  88u,  237u, 149u, 56u,  87u,  174u,
    20u,  125u, 136u, 171u, 168u, 68u,  175u, 74u,  165u, 71u,  134u, 139u, 48u,  27u,  166u, 77u,  146u, 158u, 231u,
    83u,  111u, 229u, 122u, 60u,  211u, 133u, 230u, 220u, 105u, 92u,  41u,  55u,  46u,  245u, 40u,  244u, 102u, 143u,
    54u,  65u,  25u,  63u,  161u, 1u,   216u, 80u,  73u,  209u, 76u,  132u, 187u, 208u, 89u,  18u,  169u, 200u, 196u,
    135u, 130u, 116u, 188u, 159u, 86u,  164u, 100u, 109u, 198u, 173u, 186u, 3u,   64u,  52u,  217u, 226u, 250u, 124u,
    123u, 5u,   202u, 38u,  147u, 118u, 126u, 255u, 82u,  85u,  212u, 207u, 206u, 59u,  227u, 47u,  16u,  58u,  17u,
    182u, 189u, 28u,  42u,  223u, 183u, 170u, 213u, 119u, 248u, 152u, 2u,   44u,  154u, 163u, 70u,  221u, 153u, 101u,
    155u, 167u, 43u,  172u, 9u,   129u, 22u,  39u,  253u, 19u,  98u,  108u, 110u, 79u,  113u, 224u, 232u, 178u, 185u,
    112u, 104u, 218u, 246u, 97u,  228u, 251u, 34u,  242u, 193u, 238u, 210u, 144u, 12u,  191u, 179u, 162u, 241u, 81u,
    51u,  145u, 235u, 249u, 14u,  239u, 107u, 49u,  192u, 214u, 31u,  181u, 199u, 106u, 157u, 184u, 84u,  204u, 176u,
    115u, 121u, 50u,  45u,  127u, 4u,   150u, 254u, 138u, 236u, 205u, 93u,  222u, 114u, 67u,  29u,  24u,  72u,  243u,
    141u, 128u, 195u, 78u,  66u,  215u, 61u,  156u, 180u};

/* Factor of the frequency from one octave to the next, as in pbrt; not 2, lest the lattices of all octaves coincide. */
#define NOISE_LACUNARITY 1.99f

/* With more octaves the frequency could overflow. */
#define NOISE_OCTAVES_MAX 64

/* The cell of a coordinate, modulo 256, which is exact for every float; *offset: how far x lies inside, in [0, 1). Not
 * finite: 0. */
SHARED_FUNCTION uint noise_cell(float x, float *offset)
{
    float cell = float_floor(x);
    *offset = 0.0f;
    if (!float_finite(x))
        return 0u;
    *offset = x - cell;
    return (uint)(cell - 256.0f * float_floor(cell * (1.0f / 256.0f)));
}

/* The gradient of the lattice point (x, y, z) times (dx, dy, dz): two of these, each added or subtracted. */
SHARED_FUNCTION float noise_gradient(uint x, uint y, uint z, float dx, float dy, float dz)
{
    uint xy = NOISE_PERMUTATION[x & 255u] + y;
    uint h = NOISE_PERMUTATION[(NOISE_PERMUTATION[xy & 255u] + z) & 255u] & 15u;
    bool wide = h == 12u || h == 13u;
    float u = h < 8u || wide ? dx : dy;
    float v = h < 4u || wide ? dy : dz;
    return ((h & 1u) != 0u ? -u : u) + ((h & 2u) != 0u ? -v : v);
}

/* 6 t^5 - 15 t^4 + 10 t^3 */
SHARED_FUNCTION float noise_fade(float t)
{
    return t * t * t * (t * (t * 6.0f - 15.0f) + 10.0f);
}

SHARED_FUNCTION float noise_lerp(float t, float a, float b)
{
    return (1.0f - t) * a + t * b;
}

/* Noise in about [-1, 1], 0 at points with integer coordinates. */
SHARED_FUNCTION float noise(Vec3 p)
{
    float dx, dy, dz, row[4];
    uint x = noise_cell(p.x, &dx), y = noise_cell(p.y, &dy), z = noise_cell(p.z, &dz);
    float fade = noise_fade(dx);
    for (uint i = 0; i < 4u; ++i) {
        uint j = i & 1u, k = i >> 1u;
        float ey = dy - (float)j, ez = dz - (float)k;
        row[i] = noise_lerp(fade, noise_gradient(x, y + j, z + k, dx, ey, ez),
                            noise_gradient(x + 1u, y + j, z + k, dx - 1.0f, ey, ez));
    }
    fade = noise_fade(dy);
    return noise_lerp(noise_fade(dz), noise_lerp(fade, row[0], row[1]), noise_lerp(fade, row[2], row[3]));
}

/* Sum of octaves i < `octaves` of the noise (`absolute`: of its absolute value) at 1.99^i times the frequency, weighted
 * by omega^i; *weight: omega^octaves. */
SHARED_FUNCTION float noise_octaves(Vec3 p, float omega, uint octaves, bool absolute, float *weight)
{
    float sum = 0.0f, frequency = 1.0f;
    *weight = 1.0f;
    for (uint i = 0; i < octaves; ++i) {
        float n = noise(vec3_scale(p, frequency));
        sum += *weight * (absolute ? float_abs(n) : n);
        frequency *= NOISE_LACUNARITY;
        *weight *= omega;
    }
    return sum;
}

/* pbrt's FBm without a footprint: all octaves. */
SHARED_FUNCTION float noise_fbm(Vec3 p, float omega, uint octaves)
{
    float weight;
    return noise_octaves(p, omega, octaves, false, &weight);
}

/* pbrt's Turbulence without a footprint. In place of the octaves that it leaves out, pbrt adds their mean, 0.2, and
 * counts one more than there are. */
SHARED_FUNCTION float noise_turbulence(Vec3 p, float omega, uint octaves)
{
    float weight, sum = noise_octaves(p, omega, octaves, true, &weight);
    return sum + 0.2f * weight;
}

#endif
