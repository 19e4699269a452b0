/* Philox4x32-10 against its published vectors, and the floats derived from it. */
#include "math/test_math.h"

#include "math/rng.h"

/* From the known-answer file of Random123 1.14 (kat_vectors, "philox4x32 10"): counter, key, result. */
static const uint VECTORS[3][10] = {
    {0, 0, 0, 0, 0, 0, 0x6627e8d5u, 0xe169c58du, 0xbc57ac4cu, 0x9b00dbd8u},
    {0xffffffffu, 0xffffffffu, 0xffffffffu, 0xffffffffu, 0xffffffffu, 0xffffffffu, 0x408f276du, 0x41c83b0eu,
     0xa20bc7c6u, 0x6d5451fdu},
    {0x243f6a88u, 0x85a308d3u, 0x13198a2eu, 0x03707344u, 0xa4093822u, 0x299f31d0u, 0xd16cfe09u, 0x94fdccebu,
     0x5001e420u, 0x24126ea1u},
};

START_TEST(test_vectors)
{
    for (int i = 0; i < 3; ++i) {
        const uint *v = VECTORS[i];
        Random4 r = random_four(v[0], v[1], v[2], v[3], v[4], v[5]);
        for (int j = 0; j < 4; ++j)
            test_require(r.x[j] == v[6 + j], "vector %d word %d: %08x, not %08x", i, j, r.x[j], v[6 + j]);
    }
}
END_TEST

START_TEST(test_float_range)
{
    test_require(random_float(0u) == 0x1p-24f, "random_float(0u) == 0x1p-24f");
    test_require(random_float(0xffffffffu) == 0x1.fffffep-1f, "random_float(0xffffffffu) == 0x1.fffffep-1f");
    for (uint bits = 0; bits < 0xffff0000u; bits += 65521u) {
        float u = random_float(bits);
        test_require(u > 0.0f && u < 1.0f, "u > 0.0f && u < 1.0f");
        test_require(random_float(~bits) == 1.0f - u, "random_float(~bits) == 1.0f - u"); /* exactly symmetric */
    }
}
END_TEST

/* Counters that differ in one word only, as the renderer's do: for every pair of (word of the counter, word of the
 * result), the upper byte is uniform over 256 bins. 16 tests: 1e-3 overall after Sidak is p > 6e-5 each. */
START_TEST(test_uniform_words)
{
    enum { BINS = 256, SAMPLES = 200000 };
    static double observed[4][BINS], expected[BINS];
    for (int i = 0; i < BINS; ++i)
        expected[i] = (double)SAMPLES / BINS;
    for (int word = 0; word < 4; ++word) {
        memset(observed, 0, sizeof observed);
        for (uint n = 0; n < SAMPLES; ++n) {
            Random4 r =
                random_four(word == 0 ? n : 7u, word == 1 ? n : 0u, word == 2 ? n : 1u, word == 3 ? n : 0u, 42u, 0u);
            for (int j = 0; j < 4; ++j)
                observed[j][(int)(random_float(r.x[j]) * BINS)] += 1.0;
        }
        for (int j = 0; j < 4; ++j) {
            double p = test_chi_square(observed[j], expected, BINS);
            test_require(p > 6e-5, "counter word %d, result word %d: p = %g", word, j, p);
        }
    }
}
END_TEST

/* Pairs (result of n, result of n + 1) and pairs of words of one result, in 32 x 32 cells. */
START_TEST(test_pairs)
{
    enum { SIDE = 32, SAMPLES = 500000 };
    static double serial[SIDE * SIDE], words[SIDE * SIDE], expected[SIDE * SIDE];
    for (int i = 0; i < SIDE * SIDE; ++i)
        expected[i] = (double)SAMPLES / (SIDE * SIDE);
    uint last = random_four(0u, 0u, 0u, 0u, 1u, 2u).x[0];
    for (uint n = 1; n <= SAMPLES; ++n) {
        Random4 r = random_four(n, 0u, 0u, 0u, 1u, 2u);
        serial[(last >> 27) * SIDE + (r.x[0] >> 27)] += 1.0;
        words[(r.x[1] >> 27) * SIDE + (r.x[2] >> 27)] += 1.0;
        last = r.x[0];
    }
    test_require(test_chi_square(serial, expected, SIDE * SIDE) > 5e-4,
                 "test_chi_square(serial, expected, SIDE * SIDE) > 5e-4");
    test_require(test_chi_square(words, expected, SIDE * SIDE) > 5e-4,
                 "test_chi_square(words, expected, SIDE * SIDE) > 5e-4");
}
END_TEST

/* Flipping any input bit flips each output bit with probability 1/2. */
START_TEST(test_avalanche)
{
    uint64_t state = 5;
    for (int bit = 0; bit < 192; ++bit) {
        double flips = 0.0;
        enum { TRIALS = 400 };
        for (int trial = 0; trial < TRIALS; ++trial) {
            uint a[6], b[6];
            for (int i = 0; i < 6; ++i)
                a[i] = b[i] = (uint)test_random(&state);
            b[bit / 32] ^= 1u << (bit % 32);
            Random4 p = random_four(a[0], a[1], a[2], a[3], a[4], a[5]);
            Random4 q = random_four(b[0], b[1], b[2], b[3], b[4], b[5]);
            for (int i = 0; i < 4; ++i)
                flips += __builtin_popcount(p.x[i] ^ q.x[i]);
        }
        double z = (flips - TRIALS * 64.0) / sqrt(TRIALS * 128.0 * 0.25);
        test_require(fabs(z) < 5.0, "input bit %d: z = %g", bit, z); /* 192 tests: p = 1e-4 overall */
    }
}
END_TEST

TCase *test_math_rng(void)
{
    TCase *tcase = tcase_create("rng");
    tcase_set_timeout(tcase, 300.0);
    tcase_add_test(tcase, test_vectors);
    tcase_add_test(tcase, test_float_range);
    tcase_add_test(tcase, test_uniform_words);
    tcase_add_test(tcase, test_pairs);
    tcase_add_test(tcase, test_avalanche);
    return tcase;
}
