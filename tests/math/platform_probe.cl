/* Kernels that math/test_platform_bits.c runs both as C and as OpenCL C. Item i of a kernel reads words 4 i ... 4 i + 3
 * of `in` and writes PROBE_WORDS words of `out`, which are zeroed before; `table` holds tabulated distributions. */
#include "layout/distribution.h"
#include "layout/frame_params.h"
#include "layout/struct_members.h"
#include "math/rng.h"
#include "math/warp.h"

#define PROBE_WORDS 32u

/* Sizes and offsets; item 0 writes them all. */
__kernel void probe_layout(__global const uint *in, __global const uint *table, __global uint *out)
{
    (void)in;
    (void)table;
    uint n = 0u;
    if (get_global_id(0) != 0)
        return;
#define STRUCT(type) out[n++] = (uint)sizeof(type);
#define MEMBER(type, member)                                                                                           \
    {                                                                                                                  \
        type value;                                                                                                    \
        out[n++] = (uint)((const uchar *)&value.member - (const uchar *)&value);                                       \
        out[n++] = (uint)sizeof value.member;                                                                          \
    }
    STRUCT_MEMBERS(STRUCT, MEMBER)
#undef STRUCT
#undef MEMBER
}

/* The operations on which everything else is built. */
__kernel void probe_arithmetic(__global const uint *in, __global const uint *table, __global uint *out)
{
    (void)table;
    size_t i = get_global_id(0);
    float a = bits_float(in[4 * i]), b = bits_float(in[4 * i + 1]), c = bits_float(in[4 * i + 2]);
    __global uint *o = out + PROBE_WORDS * i;
    o[0] = float_bits(a + b);
    o[1] = float_bits(a - b);
    o[2] = float_bits(a * b);
    o[3] = float_bits(a / b);
    o[4] = float_bits(float_sqrt(float_abs(a)));
    o[5] = float_bits(a * b + c); /* not fused */
    o[6] = float_bits(a * b - b * c);
    o[7] = float_bits(float_min(a, b));
    o[8] = float_bits(float_max(a, b));
    o[9] = float_bits(float_floor(a));
    o[10] = float_bits((float)in[4 * i]);
    o[11] = float_bits((float)(((ulong)in[4 * i] << 32) | in[4 * i + 1]));
    o[12] = (uint)float_clamp(float_abs(a), 0.0f, 4e9f);
    o[13] = float_finite(a) ? 1u : 0u;
    o[14] = float_bits((float)(int)in[4 * i]);
}

__kernel void probe_elementary(__global const uint *in, __global const uint *table, __global uint *out)
{
    (void)table;
    size_t i = get_global_id(0);
    float x = bits_float(in[4 * i]), y = bits_float(in[4 * i + 1]);
    __global uint *o = out + PROBE_WORDS * i;
    o[0] = float_bits(float_sin(x));
    o[1] = float_bits(float_cos(x));
    o[2] = float_bits(float_exp(x));
    o[3] = float_bits(float_log(x));
    o[4] = float_bits(float_asin(x));
    o[5] = float_bits(float_acos(x));
    o[6] = float_bits(float_atan2(y, x));
    o[7] = float_bits(float_pow(x, y));
    /* arguments that are mostly within range */
    float small = bits_float((in[4 * i + 2] & 0x81ffffffu) | 0x3e000000u);
    o[8] = float_bits(float_asin(small));
    o[9] = float_bits(float_acos(small));
    o[10] = float_bits(float_exp(small * 100.0f));
    o[11] = float_bits(float_atan2(x, x * small));
    o[12] = float_bits(float_pow(float_abs(x), small));
    o[13] = float_bits(float_pow(float_abs(small), y));
    o[14] = float_bits(float_sin(small * 400.0f));
    o[15] = float_bits(float_cos(small * 400.0f));
}

__kernel void probe_random(__global const uint *in, __global const uint *table, __global uint *out)
{
    (void)table;
    size_t i = get_global_id(0);
    __global uint *o = out + PROBE_WORDS * i;
    Random4 r = random_four(in[4 * i], in[4 * i + 1], in[4 * i + 2], in[4 * i + 3], in[4 * i] ^ 77u, (uint)i);
    for (uint k = 0u; k < 4u; ++k) {
        o[k] = r.x[k];
        o[4u + k] = float_bits(random_float(r.x[k]));
    }
}

SHARED_FUNCTION void probe_store2(__global uint *o, Vec2 v)
{
    o[0] = float_bits(v.x);
    o[1] = float_bits(v.y);
}

SHARED_FUNCTION void probe_store3(__global uint *o, Vec3 v)
{
    o[0] = float_bits(v.x);
    o[1] = float_bits(v.y);
    o[2] = float_bits(v.z);
}

__kernel void probe_warp(__global const uint *in, __global const uint *table, __global uint *out)
{
    (void)table;
    size_t i = get_global_id(0);
    __global uint *o = out + PROBE_WORDS * i;
    Vec2 u = vec2(random_float(in[4 * i]), random_float(in[4 * i + 1]));
    float omc = bits_float(in[4 * i + 2] & 0x3fffffffu); /* 0 ... 2, half of them below 1e-9, including denormals */
    Vec3 d = warp_sphere(u);
    probe_store2(o, warp_disk_concentric(u));
    probe_store3(o + 2, warp_cosine_hemisphere(u));
    probe_store3(o + 5, d);
    probe_store3(o + 8, warp_cone(u, omc));
    probe_store2(o + 11, warp_triangle(u));
    probe_store3(o + 13, octahedral_to_sphere(u));
    probe_store2(o + 16, sphere_to_octahedral(d));
    probe_store2(o + 18, sphere_to_equirectangular(d));
    probe_store3(o + 20, equirectangular_to_sphere(u));
    o[23] = float_bits(equirectangular_pdf(d));
    o[24] = float_bits(warp_cosine_hemisphere_pdf(d.z));
    o[25] = float_bits(warp_cone_pdf(omc));
    Frame frame = frame_from_normal(d);
    probe_store3(o + 26, frame_to_world(frame, octahedral_to_sphere(u)));
    probe_store3(o + 29, vec3_normalize(frame.t));
}

/* table: width, height, first_marginal, first_conditional, bucket count, first bucket, then the arrays; positions in
 * words from the start of `table`. */
__kernel void probe_distribution(__global const uint *in, __global const uint *table, __global uint *out)
{
    size_t i = get_global_id(0);
    __global uint *o = out + PROBE_WORDS * i;
    Distribution2D d;
    d.width = table[0];
    d.height = table[1];
    d.first_marginal = table[2];
    d.first_conditional = table[3];
    __global const float *lookup = (__global const float *)table;
    float pdf;
    Vec2 uv = distribution2d_sample(lookup, d, vec2(random_float(in[4 * i]), random_float(in[4 * i + 1])), &pdf);
    probe_store2(o, uv);
    o[2] = float_bits(pdf);
    o[3] = float_bits(distribution2d_pdf(lookup, d, vec2(random_float(in[4 * i + 2]), random_float(in[4 * i + 3]))));
    __global const AliasBucket *buckets = (__global const AliasBucket *)(table + table[5]);
    o[4] = alias_sample(buckets, table[4], in[4 * i], in[4 * i + 1]);
}
