/* The only file that tests for the language being compiled: C11 or OpenCL C 1.2.
 *
 * All other files of shared/ are OpenCL C that also compiles as C11, under three restrictions: vector structs of their
 * own instead of float3; the names below instead of either language's math functions; and no pointers, bool, size_t,
 * enums or doubles in structs that cross between host and device. */
#ifndef TWINLIGHT_MATH_PLATFORM_H
#define TWINLIGHT_MATH_PLATFORM_H

#if defined(__OPENCL_VERSION__) || defined(__OPENCL_C_VERSION__)

#pragma OPENCL FP_CONTRACT OFF

#define SHARED_FUNCTION inline static
#define SHARED_FUNCTION_APART inline static
#define SHARED_FUNCTION_CALLED __attribute__((noinline)) static
#define float_bits(x) as_uint(x)
#define bits_float(x) as_float(x)
#define word_float(word) as_float(*(word))
#define word_set_float(word, value) (*(word) = as_uint(value))
#define float_sqrt(x) sqrt(x)
#define float_abs(x) fabs(x)
#define float_floor(x) floor(x)
/* Work-items run concurrently and share the counters. */
#define counter_increment(counter) atomic_inc((volatile __global uint *)(counter))
#define counter_add(counter, n) atomic_add((volatile __global uint *)(counter), n)
/* Atomic operations on 64-bit sums and 32-bit counts; all return the old value. atomic_sum_exchange is a
 * compare-and-swap: it stores `after` if the sum equals `before`. */
#define atomic_count_add(count, n) atomic_add((volatile __global uint *)(count), n)
#ifdef cl_khr_int64_base_atomics
#pragma OPENCL EXTENSION cl_khr_int64_base_atomics : enable
#define atomic_sum_add(sum, n) atom_add((volatile __global ulong *)(sum), n)
#define atomic_sum_load(sum) (*(volatile __global ulong *)(sum))
#define atomic_sum_exchange(sum, before, after) atom_cmpxchg((volatile __global ulong *)(sum), before, after)
#endif

typedef float4 Float4;
typedef uint4 Uint4;
#define lane_of(v, i) ((v).s##i)
#define uint4_make(a, b, c, d) ((uint4)((a), (b), (c), (d)))
#define float4_splat(x) ((float4)(x))
#define float4_bits(a) as_uint4(a)
#define float4_at_most(a, b) as_uint4((a) <= (b))
#define float4_min(a, b) fmin(a, b)
#define float4_max(a, b) fmax(a, b)
#ifdef FP_FAST_FMAF
#define float4_mad(a, b, c) fma(a, float4_splat(b), float4_splat(c))
#else
#define float4_mad(a, b, c) ((a) * (b) + (c))
#endif

#else

#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

/* OpenCL's names. */
typedef unsigned char uchar;
typedef uint32_t uint;
typedef uint64_t ulong;

/* For what few scenes need: not inlined, so that it costs the others nothing. */
#define SHARED_FUNCTION_APART static __attribute__((unused, noinline))
#define __kernel static inline __attribute__((always_inline))
#define __global
#define __constant static const
#ifdef PLATFORM_INLINE_ALL
#define SHARED_FUNCTION static inline __attribute__((unused, always_inline))
#else
#define SHARED_FUNCTION static inline __attribute__((unused))
#endif

/* Calls on devices, whose compilers otherwise inline everything; for what makes a kernel too large to compile. NVIDIA's
 * (driver 580) did not end on a kernel with several kinds of connection inlined, and took 2 s without;
 * docs/TUNING.md. */
#define SHARED_FUNCTION_CALLED SHARED_FUNCTION

/* Index of the work item that a kernel runs for, set by the caller of the kernel (backend_cpu/kernel_loop.h). One copy
 * per translation unit and thread. */
static _Thread_local uint platform_item __attribute__((unused));
#define get_global_id(dimension) ((size_t)platform_item)

#ifdef TWINLIGHT_DOUBLE
#include "math/platform_double.h"
#else

SHARED_FUNCTION uint float_bits(float x)
{
    uint bits;
    memcpy(&bits, &x, sizeof bits);
    return bits;
}

SHARED_FUNCTION float bits_float(uint bits)
{
    float x;
    memcpy(&x, &bits, sizeof x);
    return x;
}

/* Read and write a float in a 32-bit word of state. */
#define word_float(word) bits_float(*(word))
#define word_set_float(word, value) (*(word) = float_bits(value))

#define float_sqrt(x) sqrtf(x)
#define float_abs(x) fabsf(x)
#define float_floor(x) floorf(x)

/* Vectors of four lanes: 16 bytes, 16-byte aligned, and allowed to alias any type. + - * and the operators of integers
 * work lane by lane; a scalar operand is broadcast. float4_mad may or may not be fused, and float4_min and float4_max
 * may differ for NaN and for zeros of both signs: only tests of bounding boxes use them, which do not affect
 * results. */
typedef float Float4 __attribute__((vector_size(16), may_alias));
#define float4_splat(x) ((Float4){(x), (x), (x), (x)})
#define float4_mad(a, b, c) ((a) * (b) + (c))

#endif

typedef uint Uint4 __attribute__((vector_size(16), may_alias));
#define lane_of(v, i) ((v)[i])
#define uint4_make(a, b, c, d) ((Uint4){(a), (b), (c), (d)})
#define float4_bits(a) ((Uint4)(a))
#define float4_at_most(a, b) ((Uint4)((a) <= (b)))

#if defined(__SSE__)
/* gcc compiles the portable text below to six instructions. */
#define float4_min(a, b) ((Float4)__builtin_ia32_minps(a, b))
#define float4_max(a, b) ((Float4)__builtin_ia32_maxps(a, b))
#else
SHARED_FUNCTION Float4 float4_min(Float4 a, Float4 b)
{
    Uint4 less = (Uint4)(a < b);
    return (Float4)(((Uint4)a & less) | ((Uint4)b & ~less));
}

SHARED_FUNCTION Float4 float4_max(Float4 a, Float4 b)
{
    Uint4 more = (Uint4)(a > b);
    return (Float4)(((Uint4)a & more) | ((Uint4)b & ~more));
}
#endif

/* Each thread has its own counters. */
#define counter_increment(counter) (++*(counter))
#define counter_add(counter, n) (*(counter) += (n))
/* All threads share the film. */
#define atomic_count_add(count, n) __atomic_fetch_add(count, n, __ATOMIC_RELAXED)
#define atomic_sum_add(sum, n) __atomic_fetch_add(sum, n, __ATOMIC_RELAXED)
#define atomic_sum_load(sum) __atomic_load_n(sum, __ATOMIC_RELAXED)
#define atomic_sum_exchange(sum, before, after) __sync_val_compare_and_swap(sum, before, after)

#endif

/* Unlike fmin and fmax, defined for NaN and for zeros of both signs: `b` unless the comparison holds, so also where
 * either operand is NaN. */
#define float_min(a, b) ((a) < (b) ? (a) : (b))
#define float_max(a, b) ((a) > (b) ? (a) : (b))
#define float_clamp(x, low, high) float_min(float_max(x, low), high)

#define FLOAT_MAX 3.402823466e+38f
#define FLOAT_INFINITY bits_float(0x7f800000u)
/* "No such index" in every 32-bit index of the scene. */
#define NONE 0xffffffffu

SHARED_FUNCTION bool float_finite(float x)
{
    return (float_bits(x) & 0x7f800000u) != 0x7f800000u;
}

/* Builds with --enable-double take these from math/platform_double.h. */
#ifndef PLATFORM_DOUBLE

#define PI 3.14159265358979323846f
#define INV_PI 0.31830988618379067154f
#define INV_2PI 0.15915494309189533577f
#define INV_4PI 0.07957747154594766788f
#define PI_OVER_2 1.57079632679489661923f
#define PI_OVER_4 0.78539816339744830961f

#define FLOAT_SIGN_BIT 0x80000000u

/* condition ? a : b, selected among integers, which compiles to conditional moves instead of unpredictable branches. */
#define float_select(condition, a, b) bits_float((condition) ? float_bits(a) : float_bits(b))

SHARED_FUNCTION float float_copy_sign(float magnitude, float sign)
{
    return bits_float((float_bits(magnitude) & ~FLOAT_SIGN_BIT) | (float_bits(sign) & FLOAT_SIGN_BIT));
}

/* The next float after x, upwards if `toward` > 0, downwards if it is < 0; x itself if `toward` is 0 or x is not
 * finite. */
SHARED_FUNCTION float float_step(float x, float toward)
{
    if (toward == 0.0f || !float_finite(x))
        return x;
    if (x == 0.0f)
        return toward > 0.0f ? bits_float(1u) : bits_float(0x80000001u);
    uint bits = float_bits(x);
    return bits_float((x > 0.0f) == (toward > 0.0f) ? bits + 1u : bits - 1u);
}

/* The mantissa in [1, 2) of a positive finite x, with x = mantissa * 2^exponent. */
SHARED_FUNCTION float float_mantissa(float x, int *exponent)
{
    int shift = 0;
    if (x < 1.17549435e-38f) { /* denormal */
        x = x * 16777216.0f;
        shift = 24;
    }
    uint bits = float_bits(x);
    *exponent = (int)(bits >> 23) - 127 - shift;
    return bits_float((bits & 0x007fffffu) | 0x3f800000u);
}

#endif

#endif
