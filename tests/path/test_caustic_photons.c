/* Receivers and photons one by one: what a receiver leaves to chance, the lobes of photons, and the grid that they are
 * looked up in. */
#include "path/test_caustic.h"

#include "support/test_files.h"
#include "support/test_util.h"

#include "path/caustic_rest.h"
#include "render/photon_map.h"

#include <math.h>
#include <stdlib.h>

/* ---- receivers --------------------------------------------------------------------------------------------------- */

/* Paths of up to 7 vertices after the camera, the last on a light: which vertex draws by photons, by the definition. */
START_TEST(test_receivers)
{
    for (uint last = 1; last <= 6; ++last)
        for (uint delta = 0; delta < 2u << last; delta += 2) {
            uint receiver = last;
            bool connectible = false;
            while (receiver > 0 && (delta >> receiver & 1u) != 0)
                --receiver;
            for (uint i = 0; i < receiver; ++i)
                connectible = connectible || ((delta >> i & 1u) == 0 && (delta >> (i + 1) & 1u) == 0);
            bool caustic = receiver > 0 && receiver < last && last - receiver <= CAUSTIC_VERTICES;
            ck_assert_uint_eq(receiver_find(0u, delta, last), caustic && !connectible ? receiver : 0u);
            ck_assert_uint_eq(receiver_find(1u, delta, last), caustic ? receiver : 0u);
            ck_assert(receiver == 0 || receiver_draws(0u, delta | ~0u << receiver, receiver) == !connectible);
        }
    ck_assert_uint_eq(receiver_find(1u, 1u << 31, 31u), 0u);
    ck_assert(!receiver_draws(1u, 0u, 31u));
}
END_TEST

/* What photons and chance show of a path adds up to it, and photons show nothing where they are no better than
 * chance. */
START_TEST(test_rest)
{
    ck_assert(caustic_rest_of(0.3f, 0.0f) == 1.0f && caustic_rest_of(0.3f, 0.3f) == 1.0f);
    for (float q = 1.0f; q < 1e9f; q *= 7.0f) {
        float rest = caustic_rest_of(0.1f, q);
        ck_assert_float_eq_tol(rest + q / (0.1f + q), 1.0f, 1e-6f);
    }
}
END_TEST

/* What is left to camera subpaths that hit the light by themselves is what all directions leave that the receiver
 * draws: two up to the fourth vertex, behind it one. */
START_TEST(test_rest_of_draws)
{
    static const struct {
        uint delta, last, draws;
    } cases[] = {{0x4u, 2, 2}, {0xau, 3, 2}, {0xeu, 4, 0}, {0x1cu, 4, 2}, {0x2eu, 5, 2}, {0x5eu, 6, 1}, {0x8u, 3, 2}};
    uint words[PHOTON_CODE_WORDS + PHOTON_WORDS] = {0}, paths[RECEIVER_WORDS] = {0};
    FrameParams frame = {
        .pass.stride = 1,
        .photons = {
            .count = 1, .everywhere = 1, .first = {0, 1, 1, 1, 1}, .level = {1, 1, 1, 1}, .cells_per_unit = 1.0f}};
    const SceneView scene = {.frame = &frame, .photons = words};
    const float p = 0.01f, spread = 0.1f;
    uint *photon = words + PHOTON_CODE_WORDS;
    photon[PHOTON_DIRECTION + 2] = float_bits(1.0f);
    photon[PHOTON_SPREAD] = photon[PHOTON_SPREAD + 2] = float_bits(spread);
    photon[PHOTON_LIGHT] = NONE;
    receiver_leave(paths, 1, 0, 0, vec3_splat(0.5f), vec3(0.0f, 0.0f, 1.0f), p);
    const double q = (double)caustic_density(&scene, vec3_splat(0.5f), vec3(0.0f, 0.0f, 1.0f), NONE);
    ck_assert_double_gt(q, 8.0 * (double)p);
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
        double rest = (double)receiver_rest(&scene, paths, 0, 0, cases[i].delta, cases[i].last);
        ck_assert_double_eq_tol(rest, (double)p / ((double)p + cases[i].draws * q), 1e-6);
    }
}
END_TEST

/* ---- the photons ------------------------------------------------------------------------------------------------- */

/* The density of directions integrates to the probability that one is drawn, and is that of the directions drawn: the
 * mean of 1 / density over a region is its solid angle. */
START_TEST(test_lobe)
{
    const PhotonLobe lobe = {.frame = frame_from_normal(vec3_normalize(vec3(1.0f, -2.0f, 0.5f))),
                             .a = 0.2f,
                             .b = -0.1f,
                             .spread_aa = 0.15f,
                             .spread_ba = -0.08f,
                             .spread_bb = 0.1f,
                             .light = NONE};
    const int count = 400000;
    const double cap = 0.97; /* of cosines with the middle of the lobe */
    const Vec3 middle = vec3_normalize(frame_to_world(lobe.frame, vec3(lobe.a, lobe.b, 1.0f)));
    double sum = 0.0, square = 0.0, integral = 0.0;
    int drawn = 0;
    unsigned state = 7;
    for (int i = 0; i < count; ++i) {
        Vec3 w, any = warp_sphere(vec2((float)test_random_unit(&state), (float)test_random_unit(&state)));
        Vec2 u = vec2((float)test_random_unit(&state), (float)test_random_unit(&state));
        integral += (double)photon_lobe_density(&lobe, any) * 4.0 * M_PI / count;
        if (!photon_lobe_sample(&lobe, u, &w))
            continue;
        ++drawn;
        if ((double)vec3_dot(w, middle) < cap)
            continue;
        double inverse = 1.0 / (double)photon_lobe_density(&lobe, w);
        sum += inverse;
        square += inverse * inverse;
    }
    double mean = sum / count, error = sqrt((square / count - mean * mean) / count);
    ck_assert_double_eq_tol(mean, 2.0 * M_PI * (1.0 - cap), 5.0 * error);
    ck_assert_double_lt(error, 0.01 * mean);
    ck_assert_double_eq_tol(integral, (double)drawn / count, 0.02);
    ck_assert_double_gt((double)drawn / count, 0.98);
}
END_TEST

/* Among photons of one place and direction, each light's are counted apart, in proportion to their number. */
START_TEST(test_density)
{
    enum { COUNT = 5 };
    static const uint lights[COUNT] = {NONE, 2, NONE, 7, NONE};
    uint words[COUNT * (PHOTON_CODE_WORDS + PHOTON_WORDS)] = {0};
    const PhotonParams params = {.count = COUNT, .first = {0, COUNT, COUNT, COUNT, COUNT}, .level = {1, 1, 1, 1}};
    const float spread = 0.1f;
    for (uint i = 0; i < COUNT; ++i) {
        uint *photon = words + COUNT * PHOTON_CODE_WORDS + i * PHOTON_WORDS;
        photon[PHOTON_DIRECTION + 2] = float_bits(1.0f);
        photon[PHOTON_SPREAD] = photon[PHOTON_SPREAD + 2] = float_bits(spread);
        photon[PHOTON_LIGHT] = lights[i];
    }
    const PhotonSets found = {{{0, 1, COUNT, 0, 1.0f}}, 1.0f};
    const Vec3 p = vec3(0.0f, 0.0f, 0.0f), w = vec3(0.0f, 0.0f, 1.0f);
    const double wide = (double)PHOTON_WIDE_PART, width = (double)PHOTON_WIDE,
                 lobe = (1.0 - wide + wide / (width * width)) / (M_PI * (double)(spread * spread));
    const struct {
        uint light;
        double part;
    } cases[] = {{NONE, 0.6}, {2, 0.2}, {7, 0.2}, {3, 0.0}};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i)
        ck_assert_double_eq_tol((double)photon_density(params, words, &found, p, w, cases[i].light),
                                cases[i].part * lobe, 1e-5 * lobe);
}
END_TEST

/* Photons grow in number while more of them predict better: not where nearly all predictions hit the light, where a
 * quarter of them predict as well, or where all that are allowed have been made. */
START_TEST(test_growth)
{
    static const struct {
        uint found, most, next;
        double missed, by_fewer;
    } cases[] = {
        {32768, 1048576, 131072, 0.3, 0.6},   {32768, 1048576, 0, 0.01, 0.5},  {32768, 1048576, 0, 0.3, 0.4},
        {32768, 1048576, 131072, 0.03, 0.2},  {32768, 1048576, 0, 0.0, 0.0},   {131072, 1048576, 524288, 0.3, 0.6},
        {524288, 1048576, 1048576, 0.3, 0.6}, {1048576, 1048576, 0, 0.3, 0.6}, {32768, 100000, 100000, 0.3, 0.6},
        {40000, 32768, 0, 0.3, 0.6},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i)
        ck_assert_uint_eq(photon_count_next(cases[i].found, cases[i].most, cases[i].missed, cases[i].by_fewer),
                          cases[i].next);
}
END_TEST

static int codes_compare(const void *a, const void *b)
{
    const ulong *x = a, *y = b;
    return (*x > *y) - (*x < *y);
}

/* Sorts the codes first ... end - 1, a group's, and puts them where photons have them. */
static void codes_put(ulong *codes, uint first, uint end, uint *words)
{
    qsort(codes + first, end - first, sizeof *codes, codes_compare);
    for (uint i = first; i < end; ++i) {
        words[PHOTON_CODE_WORDS * i] = (uint)codes[i];
        words[PHOTON_CODE_WORDS * i + 1] = (uint)(codes[i] >> 32);
    }
}

/* A place in the grid, every other one in a corner, which is as small as a caustic in a landscape. */
static Vec3 grid_place(unsigned *state, int i)
{
    const double x = test_random_unit(state), y = test_random_unit(state), z = 0.1 * test_random_unit(state);
    return vec3_scale(vec3((float)(x * x * x), (float)y, (float)z), i % 2 == 0 ? 1.0f : 1.0f / 8192.0f);
}

static bool cell_has(ulong code, ulong other, uint level)
{
    return code >> 3u * (PHOTON_LEVELS - level) == other >> 3u * (PHOTON_LEVELS - level);
}

/* A cell's photons are those that a search of all finds; the finest cell that has enough is taken, or, where the usual
 * one is empty, a coarser one. */
START_TEST(test_grid)
{
    enum { COUNT = 6000 };
    static ulong codes[COUNT];
    static uint words[PHOTON_CODE_WORDS * COUNT];
    PhotonParams params = {.count = COUNT,
                           .first = {0, 0, COUNT, COUNT, COUNT},
                           .level = {1, 5, 1, 1},
                           .cells_per_unit = (float)PHOTON_CELLS};
    unsigned state = 11;
    for (int i = 0; i < COUNT; ++i)
        codes[i] = photon_code(params, grid_place(&state, i));
    codes_put(codes, 0, COUNT, words);
    int coarser = 0, fine = 0;
    for (int i = 0; i < 4000; ++i) {
        const ulong code = photon_code(params, grid_place(&state, i));
        uint inside[PHOTON_LEVELS + 1] = {COUNT}, level = params.level[1];
        for (int k = 0; k < COUNT; ++k)
            for (uint l = 1; l <= PHOTON_LEVELS; ++l)
                inside[l] += cell_has(codes[k], code, l);
        while (inside[level] == 0)
            --level;
        coarser += level < params.level[1];
        while (inside[level] > 0 && level < PHOTON_LEVELS && inside[level + 1] >= PHOTONS_LEAST)
            ++level;
        fine += level > 13;
        PhotonSet set = photon_set(params, words, 1, code);
        uint every = (inside[level] + PHOTONS_MOST - 1) / PHOTONS_MOST;
        ck_assert_uint_eq(set.shift, 3 * (PHOTON_LEVELS - level));
        ck_assert_uint_eq(set.every, every);
        ck_assert_uint_eq(set.number, (inside[level] + every - 1) / every);
        for (uint k = 0; k < set.number; ++k)
            ck_assert(cell_has(codes[set.first + k * set.every], code, level));
        ck_assert(set.first == 0 || !cell_has(codes[set.first - 1], code, level));
    }
    ck_assert_int_gt(coarser, 100);
    ck_assert_int_gt(fine, 1500);
}
END_TEST

/* Beside a place's cell, the photons of the nearest cell with any that shares a face with it; both sets are drawn from,
 * and counted, by their weights. */
START_TEST(test_beside)
{
    enum { SIDE = 64 }; /* photons on a plane z = 0, at the corners of a grid but for a hole */
    static ulong codes[SIDE * SIDE];
    static uint words[SIDE * SIDE * (PHOTON_CODE_WORDS + PHOTON_WORDS)];
    const uint level = 5;
    PhotonParams params = {.level = {4, 1, 1, 1}, .cells_per_unit = (float)PHOTON_CELLS};
    for (int i = 0; i < SIDE * SIDE; ++i) {
        const float x = (float)(i % SIDE) / (float)SIDE, y = (float)(i >> 6) / (float)SIDE;
        if (x < 0.25f || x >= 0.3125f || y < 0.25f || y >= 0.3125f)
            codes[params.count++] = photon_code(params, vec3(x, y, 0.0f));
    }
    for (int group = 1; group <= (int)PHOTON_GROUPS; ++group)
        params.first[group] = params.count;
    codes_put(codes, 0, params.count, words);
    for (uint i = 0; i < params.count; ++i) {
        uint *photon = words + params.count * PHOTON_CODE_WORDS + i * PHOTON_WORDS;
        photon[PHOTON_DIRECTION + 2] = float_bits(1.0f);
        photon[PHOTON_SPREAD] = photon[PHOTON_SPREAD + 2] = float_bits(0.1f);
        photon[PHOTON_LIGHT] = i % 4 == 3 ? 1 : NONE;
    }
    /* In cells, of which 32 are a side: place, and the cell beside. Below the plane there is none, and those above
     * it and in the hole are empty. */
    static const struct {
        float place[3];
        int beside[2];
    } cases[] = {{{16.1f, 17.5f, 0.30f}, {15, 17}}, {{17.9f, 17.5f, 0.30f}, {18, 17}},
                 {{17.5f, 17.2f, 0.02f}, {17, 16}}, {{17.4f, 17.7f, 0.95f}, {17, 18}},
                 {{7.9f, 8.4f, 0.30f}, {7, 7}},     {{0.1f, 17.4f, 0.30f}, {0, 16}},
                 {{31.9f, 17.6f, 0.30f}, {31, 18}}};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
        const float *place = cases[i].place;
        const Vec3 p = vec3(place[0] / 32.0f, place[1] / 32.0f, place[2] / 32.0f), up = vec3(0.0f, 0.0f, 1.0f);
        const PhotonSets found = photon_sets(params, words, p);
        const PhotonSet *own = &found.sets[0], *beside = &found.sets[1];
        const float x = (float)cases[i].beside[0] / 32.0f, y = (float)cases[i].beside[1] / 32.0f;
        const ulong cell = photon_code(params, vec3(x, y, 0.0f));
        ck_assert_uint_eq(own->shift, 3 * (PHOTON_LEVELS - level));
        ck_assert_uint_eq(own->number, 4);
        ck_assert_uint_eq(beside->number, 4);
        for (uint k = 0; k < own->number; ++k)
            ck_assert(cell_has(codes[own->first + k * own->every], photon_code(params, p), level));
        for (uint k = 0; k < beside->number; ++k)
            ck_assert_msg(cell_has(codes[beside->first + k * beside->every], cell, level), "case %zu", i);
        const double side = (double)(1u << (PHOTON_LEVELS - level)),
                     weight = 4.0 / (side * side) * (1.0 + (double)PHOTONS_GROUP_LEAST);
        TEST_NEAR((double)found.weight / weight, 1.0 + (double)PHOTONS_BESIDE_WEIGHT, 1e-6);
        /* what is drawn has the frequencies that the density has */
        int drawn[2] = {0}, of_light = 0;
        double part = 0.0;
        for (int k = 0; k < 3000; ++k) {
            const uint photon = photon_choose(&found, ((float)k + 0.5f) / 3000.0f);
            ++drawn[cell_has(codes[photon], cell, level)];
            of_light += photon_record(words, params.count, photon)[PHOTON_LIGHT] == 1;
        }
        TEST_NEAR(drawn[1], 1000.0, 2.0);
        for (uint light = 0; light < 2; ++light) {
            double density = (double)photon_density(params, words, &found, p, up, light == 0 ? NONE : 1u);
            part = light == 0 ? density : density / (part + density);
        }
        TEST_NEAR(part, of_light / 3000.0, 1e-3);
    }
}
END_TEST

/* Adds photons, so many per unit of length along x and y on the plane z = 0, to params->count and their codes. */
static void lattice_put(PhotonParams *params, int per_unit, ulong *codes)
{
    for (int i = 0; i < per_unit * per_unit; ++i) {
        const float x = (float)(i % per_unit) / (float)per_unit, y = (float)(i / per_unit) / (float)per_unit;
        codes[params->count++] = photon_code(*params, vec3(x, y, 0.0f));
    }
}

/* Groups are drawn by in proportion to how densely their photons lie around a place, plus a part of all. */
START_TEST(test_groups)
{
    static ulong codes[64 * 64 + 16 * 16 + 1];
    PhotonParams params = {.level = {5, 3, 1, 1}, .cells_per_unit = (float)PHOTON_CELLS};
    lattice_put(&params, 64, codes);
    params.first[1] = params.count;
    lattice_put(&params, 16, codes);
    params.first[2] = params.count;
    codes[params.count++] =
        photon_code(params, vec3(0.0f, 0.0f, 0.9f)); /* shares no cell but the whole grid with the place below */
    params.first[3] = params.first[4] = params.count;
    uint *words = calloc(params.count, (PHOTON_CODE_WORDS + PHOTON_WORDS) * sizeof *words);
    ck_assert_ptr_nonnull(words);
    for (int g = 0; g < 3; ++g)
        codes_put(codes, params.first[g], params.first[g + 1], words);
    const PhotonSets found = photon_sets(params, words, vec3(0.3f, 0.4f, 0.001f));
    int drawn[3] = {0};
    for (int k = 0; k < 10000; ++k) {
        const uint photon = photon_choose(&found, ((float)k + 0.5f) / 10000.0f);
        ++drawn[photon >= params.first[2] ? 2 : photon >= params.first[1] ? 1 : 0];
    }
    free(words);
    /* per unit of area: two groups have photons beside, too */
    const double density[3] = {64.0 * 64.0, 16.0 * 16.0, 1.0}, sum = 64.0 * 64.0 + 16.0 * 16.0 + 1.0,
                 beside = 1.0 + (double)PHOTONS_BESIDE_WEIGHT, least = (double)PHOTONS_GROUP_LEAST * sum;
    const double weights[3] = {beside * (density[0] + least), beside * (density[1] + least), density[2] + least};
    for (int g = 0; g < 3; ++g)
        TEST_NEAR(drawn[g], 10000.0 * weights[g] / (weights[0] + weights[1] + weights[2]), 3.0);
}
END_TEST

TCase *photons_case(void)
{
    TCase *photons = tcase_create("photons");
    tcase_add_test(photons, test_receivers);
    tcase_add_test(photons, test_rest);
    tcase_add_test(photons, test_rest_of_draws);
    tcase_add_test(photons, test_lobe);
    tcase_add_test(photons, test_density);
    tcase_add_test(photons, test_grid);
    tcase_add_test(photons, test_beside);
    tcase_add_test(photons, test_groups);
    tcase_add_test(photons, test_growth);
    return photons;
}
