/* The chain's transition kernel on a known target: states distributed proportionally to it remain so under each kind of
 * mutation and under all of them; coordinates that a mutation does not change keep their bits; the film receives one
 * visit per step. */
#include "mmlt/test_chain.h"

#include "chain/mutation.h"
#include "mmlt/chain_list.h"
#include "mmlt/importance.h"

#include <string.h>

#define DEPTH 4u
#define CHAINS 65536u
#define STEPS 12
#define STRIDE CHAINS
#define WORDS (CHAIN_NUMBERS + NUMBER_VERTICES + (DEPTH - 1u) * 3u)

typedef struct Toy {
    FrameParams frame;
    Guide guide;
    SceneView scene;
    uint *paths, *splats, *vertices, diagnostics[DIAGNOSTIC_COUNT];
} Toy;

static void toy_begin(Toy *toy, uint mutations, float large_step, bool grouped)
{
    memset(toy, 0, sizeof *toy);
    toy->frame =
        (FrameParams){.path.max_depth = DEPTH,
                      .film.width = 2,
                      .film.height = 2,
                      .film.crop_x1 = 2,
                      .film.crop_y1 = 2,
                      .film.filter = {.kind = PIXEL_FILTER_BOX, .radius_x = 0.5f, .radius_y = 0.5f, .weight = 1.0f},
                      .chains.mutations = mutations | (grouped ? MUTATION_GROUPED : 0u),
                      .chains.large_step = large_step,
                      .chains.brightness = 1.0f,
                      .pass.seed_low = 99,
                      .pass.stride = STRIDE,
                      .pass.item_count = CHAINS};
    importance_even(toy->guide.importance);
    toy->scene.frame = &toy->frame;
    toy->scene.guide = &toy->guide;
    toy->paths = calloc((size_t)WORDS * STRIDE, sizeof(uint));
    toy->splats = calloc((size_t)SPLAT_WORDS * STRIDE, sizeof(uint));
    toy->vertices = calloc((size_t)CHAIN_VERTEX_WORDS * STRIDE, sizeof(uint));
    ck_assert(toy->paths && toy->splats && toy->vertices);
}

static void toy_end(Toy *toy)
{
    free(toy->paths);
    free(toy->splats);
    free(toy->vertices);
}

/* The three coordinates on which the target depends: of the film, of a light vertex, and of a camera vertex. */
static void coordinates(const Toy *toy, uint t, float x[3])
{
    x[0] = random_float(chain_camera(&toy->frame, toy->paths, t).x[0]);
    x[1] = random_float(chain_vertex(&toy->frame, toy->paths, t, SIDE_LIGHT, DEPTH, 1u).x[1]);
    x[2] = random_float(chain_vertex(&toy->frame, toy->paths, t, SIDE_CAMERA, DEPTH, 1u).x[2]);
}

/* A target with a step, a slope, a zero region and a different weight for each s; at most 8. */
static float target(const float x[3], uint s)
{
    float f = (1.0f + x[0]) * (x[1] > 0.7f ? 4.0f : 1.0f);
    if (x[2] < 0.125f)
        return 0.0f;
    return s == 2u ? f : 0.5f * f;
}

/* ---- shifts ------------------------------------------------------------------------------------------------------ */

/* The number u that samples a direction at z_1 puts z_2 at u^e; e depends on the film position x. */
static float place_exponent(float x)
{
    return 1.0f + 2.0f * x;
}

/* Makes the camera subpath of a proposal: the position of z_2 or, if that is kept, the numbers that lead to it. Paths
 * from one part of the film cannot be shifted. */
static void walk(Toy *toy, uint t)
{
    uint number = shift_number(&toy->frame, DEPTH, 1, 0),
         base = shift_base(chain_bank(toy->paths, STRIDE, t, SIDE_CAMERA));
    uint current = shift_base(shift_bank(toy->paths, STRIDE, t));
    bool keeps = (chain_move(toy->paths, STRIDE, t, MOVE_SHIFT) & SHIFT_KEEPS) != 0u;
    float x = random_float(chain_camera(&toy->frame, toy->paths, t).x[0]), e = place_exponent(x), density = 1.0f;
    if ((chain_move(toy->paths, STRIDE, t, MOVE_CHANGED) & SUBPATH_CAMERA) == 0u)
        return;
    for (uint k = 0; k < 2; ++k) {
        if (keeps) {
            float kept = state_load_float(toy->vertices, STRIDE, current + SHIFT_POINTS + k, t);
            state_store(toy->paths, STRIDE, number + k, t, light_guide_bits(powf(kept, 1.0f / e)));
        }
        float u = random_float(state_load(toy->paths, STRIDE, number + k, t));
        state_store_float(toy->vertices, STRIDE, base + SHIFT_POINTS + k, t, powf(u, e));
        density *= powf(u, 1.0f - e) / e; /* du / d(u^e) */
    }
    state_store_float(toy->vertices, STRIDE, base + SHIFT_DENSITY, t, x < 0.75f ? density : 0.0f);
}

/* ---- chains ------------------------------------------------------------------------------------------------------ */

/* Draws the state of chain t exactly from the target by rejection: uniform coordinates, accepted with probability f /
 * 8. */
static void draw(Toy *toy, uint t, bool any_s)
{
    for (uint attempt = 0;; ++attempt) {
        uint s = any_s ? 2u + random_four(t, attempt, 50, 77, 1, 2).x[0] % 2u : 2u;
        for (uint i = 0; i < WORDS - CHAIN_NUMBERS; i += 4) {
            Random4 random = random_four(t, attempt, i, 77, 1, 2);
            for (uint k = 0; k < 4 && i + k < WORDS - CHAIN_NUMBERS; ++k)
                state_store(toy->paths, STRIDE, CHAIN_NUMBERS + i + k, t, random.x[k]);
        }
        state_store(toy->paths, STRIDE, CHAIN_PROPOSED_KEY, t, chain_key(DEPTH, s));
        state_store(toy->paths, STRIDE, CHAIN_KEY, t, chain_key(DEPTH, s));
        state_store(toy->paths, STRIDE, CHAIN_MOVE, t, MUTATION_REPLAY << MOVE_MUTATION);
        float x[3];
        coordinates(toy, t, x);
        float f = target(x, s);
        if (random_float(random_four(t, attempt, 51, 77, 1, 2).x[0]) * 8.0f < f) {
            state_store_float(toy->paths, STRIDE, CHAIN_LUMINANCE, t, f);
            state_store_vec3(toy->paths, STRIDE, CHAIN_COLOR, t, vec3_splat(1.0f));
            state_store_float(toy->paths, STRIDE, CHAIN_FILM, t, 1.0f);
            state_store_float(toy->paths, STRIDE, CHAIN_FILM + 1u, t, 1.0f);
            state_store(toy->paths, STRIDE, CHAIN_MOVE, t, SUBPATH_BOTH << MOVE_CHANGED | SUBPATH_BOTH << MOVE_BANKS);
            walk(toy, t); /* writes to bank 0 */
            state_store(toy->paths, STRIDE, CHAIN_MOVE, t, 0u);
            return;
        }
    }
}

/* One step of chain t; returns the visits that it splats. */
static double step(Toy *toy, uint t)
{
    float x[3];
    chain_propose(&toy->frame, toy->paths, toy->vertices, t);
    walk(toy, t);
    coordinates(toy, t, x);
    uint s = chain_key_s(state_load(toy->paths, STRIDE, CHAIN_PROPOSED_KEY, t));
    bool on = s == 2u || s == 3u;
    state_store_float(toy->paths, STRIDE, CHAIN_PROPOSED_FILM, t, 1.0f);
    state_store_float(toy->paths, STRIDE, CHAIN_PROPOSED_FILM + 1u, t, 1.0f);
    chain_decide(&toy->scene, toy->paths, toy->splats, toy->diagnostics, t, vec3_splat(on ? target(x, s) : 0.0f),
                 shift_ratio(toy->paths, toy->vertices, STRIDE, t));
    if (state_load(toy->splats, STRIDE, SPLAT_PIXEL, t) == NONE)
        return 0.0;
    return (double)rgb_luminance(state_load_vec3(toy->splats, STRIDE, SPLAT_COLOR, t));
}

/* ---- stationarity ------------------------------------------------------------------------------------------------ */

#define BINS 8u

/* Integral of the target over bin (i, j, k) of the unit cube and over s, as a fraction of the total. */
static double bin_share(uint i, uint j, uint k, bool any_s, uint s)
{
    double bright = fmin(fmax(((double)(j + 1) / BINS - 0.7) * BINS, 0.0), 1.0);
    double f = (1.0 + (i + 0.5) / BINS) * (1.0 + 3.0 * bright) * (k == 0 ? 0.0 : 1.0) / (BINS * BINS * BINS);
    double whole = 1.5 * (1.0 + 3.0 * 0.3) * 0.875;
    if (!any_s)
        return f / whole;
    return (s == 2u ? f : 0.5 * f) / (1.5 * whole);
}

static const struct {
    const char *name;
    uint mutations;
    float large;
    bool grouped;
    float shifts;
} KERNELS[] = {{"all", 1u << MUTATION_ALL, 0.0f, false, 0.0f},
               {"light", 1u << MUTATION_LIGHT, 0.0f, false, 0.0f},
               {"camera", 1u << MUTATION_CAMERA, 0.0f, false, 0.0f},
               {"large", 7u, 1.0f, false, 0.0f},
               {"together", 7u, 0.0f, false, 0.0f},
               {"grouped", 7u, 0.0f, true, 0.0f},
               {"with large ones", 7u, 0.3f, true, 0.0f},
               {"shifts", 1u << MUTATION_CAMERA, 0.0f, false, 1.0f},
               {"with shifts", 7u, 0.0f, true, 0.5f}};

START_TEST(test_stationary)
{
    Toy toy;
    static uint counts[BINS][BINS][BINS][2];
    bool any_s = KERNELS[_i].large > 0.0f;
    memset(counts, 0, sizeof counts);
    toy_begin(&toy, KERNELS[_i].mutations, KERNELS[_i].large, KERNELS[_i].grouped);
    toy.frame.chains.shifts = KERNELS[_i].shifts;
    double visits = 0.0;
    for (uint t = 0; t < CHAINS; ++t) {
        draw(&toy, t, any_s);
        for (int k = 0; k < STEPS; ++k)
            visits += step(&toy, t);
        uint proposals = 0;
        for (uint kind = 0; kind < MUTATION_COUNT; ++kind)
            proposals += state_load(toy.paths, STRIDE, CHAIN_TALLY + kind, t) & 0xffffu;
        TEST_TRUE(proposals == STEPS);
        visits += (double)state_load_float(toy.paths, STRIDE, CHAIN_PENDING, t);
        float x[3];
        uint s = chain_key_s(state_load(toy.paths, STRIDE, CHAIN_KEY, t));
        state_store(toy.paths, STRIDE, CHAIN_PROPOSED_KEY, t, chain_key(DEPTH, s));
        state_store(toy.paths, STRIDE, CHAIN_MOVE, t, MUTATION_REPLAY << MOVE_MUTATION);
        coordinates(&toy, t, x);
        TEST_NEAR(state_load_float(toy.paths, STRIDE, CHAIN_LUMINANCE, t), target(x, s), 1e-6 * (double)target(x, s));
        ++counts[(uint)(x[0] * BINS)][(uint)(x[1] * BINS)][(uint)(x[2] * BINS)][s - 2u];
    }
    TEST_NEAR(visits / ((double)CHAINS * STEPS), 1.0, 1e-5);
    double chi2 = 0.0;
    int freedom = -1;
    for (uint i = 0; i < BINS * BINS * BINS * 2u; ++i) {
        uint s = 2u + i % 2u, a = i / 2u / (BINS * BINS), b = i / 2u / BINS % BINS, c = i / 2u % BINS;
        double expected = s == 3u && !any_s ? 0.0 : CHAINS * bin_share(a, b, c, any_s, s);
        double got = counts[a][b][c][s - 2u];
        if (!(expected > 0.0)) {
            TEST_TRUE(got == 0.0);
            continue;
        }
        chi2 += (got - expected) * (got - expected) / expected;
        ++freedom;
    }
    double p = test_gamma_q(0.5 * freedom, 0.5 * chi2);
    printf("%-16s chi^2 %.1f of %d, p %.3g\n", KERNELS[_i].name, chi2, freedom, p);
    ck_assert_msg(p > 1e-3 / (double)(sizeof KERNELS / sizeof KERNELS[0]), "%s: p = %g", KERNELS[_i].name, p);
    toy_end(&toy);
}
END_TEST

/* ---- bits -------------------------------------------------------------------------------------------------------- */

/* A small step and its opposite are equally probable: their random words differ only in the lowest bit. Sizes are
 * uniform up to 2^-(shift + 1) of the range times 4 / (d + 1). */
START_TEST(test_offsets_symmetric)
{
    const uint shift = STEP_SHIFT_CAMERA + (uint)_i, d = CHAIN_DEPTH_MIN + 2u * (uint)_i, draws = 1u << 20;
    const double most = ldexp(4.0 / (d + 1.0), 31 - (int)shift);
    double sum = 0.0;
    uint largest = 0;
    for (uint i = 0; i < draws; ++i) {
        uint bits = random_four(i, 1, 2, 3, 4, 5).x[0], offset = mutation_offset(bits, shift, mutation_length(d));
        TEST_TRUE(mutation_offset(bits ^ 1u, shift, mutation_length(d)) == 0u - offset);
        uint size = (bits & 1u) != 0u ? offset : 0u - offset;
        TEST_TRUE(size < most);
        largest = size > largest ? size : largest;
        sum += (double)size / most;
    }
    ck_assert_double_eq_tol(sum / draws, 0.5, 5.0 * sqrt(1.0 / 12.0 / draws));
    ck_assert_double_gt((double)largest / most, 1.0 - 20.0 / draws);
}
END_TEST

/* The two steps made from one word: flipping the signs negates both; their sizes are uniform and uncorrelated. */
START_TEST(test_offsets_of_a_word)
{
    const uint draws = 1u << 20, shift = STEP_SHIFT_OTHERS, length = mutation_length(5u);
    const double most = ldexp(4.0 / 6.0, 31 - (int)shift);
    double sum[2] = {0.0, 0.0}, both = 0.0;
    for (uint i = 0; i < draws; ++i) {
        uint word = random_four(i, 3, 2, 1, 4, 5).x[0];
        double signed_size[2];
        for (uint k = 0; k < 2; ++k) {
            uint bits = mutation_subpath_bits(word, k), offset = mutation_offset(bits, shift, length);
            uint turned = mutation_offset(mutation_subpath_bits(word ^ MUTATION_SIGNS, k), shift, length);
            TEST_TRUE(turned == 0u - offset);
            sum[k] += (double)((bits & 1u) != 0u ? offset : 0u - offset) / most;
            signed_size[k] = (double)(int)offset / most;
        }
        both += signed_size[0] * signed_size[1];
    }
    for (uint k = 0; k < 2; ++k)
        ck_assert_double_eq_tol(sum[k] / draws, 0.5, 5.0 * sqrt(1.0 / 12.0 / draws));
    ck_assert_double_eq_tol(both / draws, 0.0, 5.0 / 3.0 / sqrt(draws));
}
END_TEST

/* Kinds of steps occur in their proportions, and only those enabled; all scales are equally frequent. */
START_TEST(test_kinds)
{
    const uint draws = 1u << 16, set = (uint)_i;
    uint kinds[MUTATION_COUNT] = {0}, scales[STEP_SCALES] = {0};
    const FrameParams frame = {.chains.mutations = set};
    double whole = 0.0;
    for (uint i = 0; i < draws; ++i) {
        Random4 random = mutation_random(&frame, i, 3);
        ++kinds[mutation_choose(&frame, random)];
        ++scales[mutation_scale(random)];
    }
    for (uint kind = 0; kind < MUTATION_LARGE; ++kind)
        whole += (set >> kind & 1u) != 0u ? (kind == MUTATION_CAMERA ? 6.0 : 1.0) : 0.0;
    for (uint kind = 0; kind < MUTATION_LARGE; ++kind) {
        double share = (set >> kind & 1u) != 0u ? (kind == MUTATION_CAMERA ? 6.0 : 1.0) / whole : 0.0;
        if (set == 0u && kind == MUTATION_ALL)
            share = 1.0;
        ck_assert_double_eq_tol((double)kinds[kind] / draws, share, 5.0 * sqrt(share * (1.0 - share) / draws) + 1e-12);
    }
    const double share = 1.0 / STEP_SCALES;
    for (uint scale = 0; scale < STEP_SCALES; ++scale)
        ck_assert_double_eq_tol((double)scales[scale] / draws, share, 5.0 * sqrt(share * (1.0 - share) / draws));
}
END_TEST

/* f = const: a million steps of the camera subpath leave the light's coordinates bitwise unchanged, and vice versa. */
START_TEST(test_null_mutations)
{
    Toy toy;
    uint kind = _i == 1 ? MUTATION_LIGHT : MUTATION_CAMERA, before[WORDS], moved = 0;
    toy_begin(&toy, 1u << kind, 0.0f, false);
    toy.frame.chains.shifts = _i == 2 ? 0.5f : 0.0f;
    draw(&toy, 0, false);
    state_store_float(toy.paths, STRIDE, CHAIN_LUMINANCE, 0, 1.0f);
    for (uint i = 0; i < WORDS; ++i)
        before[i] = state_load(toy.paths, STRIDE, i, 0);
    for (int k = 0; k < 1000000; ++k) {
        chain_propose(&toy.frame, toy.paths, toy.vertices, 0);
        walk(&toy, 0);
        chain_decide(&toy.scene, toy.paths, toy.splats, toy.diagnostics, 0, vec3_splat(1.0f),
                     shift_ratio(toy.paths, toy.vertices, STRIDE, 0));
    }
    for (uint i = 0; i < WORDS - CHAIN_NUMBERS; ++i) {
        bool light = i >= NUMBER_VERTICES ? chain_slot_subpath(2u, (i - NUMBER_VERTICES) / 3u) == SUBPATH_LIGHT
                                          : i >= NUMBER_EMIT;
        bool same = state_load(toy.paths, STRIDE, CHAIN_NUMBERS + i, 0) == before[CHAIN_NUMBERS + i];
        TEST_TRUE(same || light == (kind == MUTATION_LIGHT));
        moved += !same;
    }
    ck_assert_uint_eq(moved, 10);
    toy_end(&toy);
}
END_TEST

/* Proposals that are zero or not finite are never accepted and leave the coordinates bitwise unchanged. */
START_TEST(test_zero_never_accepted)
{
    Toy toy;
    uint before[WORDS];
    toy_begin(&toy, 7u, _i == 1 ? 0.5f : 0.0f, true);
    toy.frame.chains.shifts = _i == 2 ? 0.5f : 0.0f;
    draw(&toy, 0, false);
    for (uint i = CHAIN_NUMBERS; i < WORDS; ++i)
        before[i] = state_load(toy.paths, STRIDE, i, 0);
    float f = state_load_float(toy.paths, STRIDE, CHAIN_LUMINANCE, 0);
    for (int k = 0; k < 1000; ++k) {
        chain_propose(&toy.frame, toy.paths, toy.vertices, 0);
        walk(&toy, 0);
        float color = k % 3 == 0 ? 0.0f : k % 3 == 1 ? FLOAT_NAN : FLOAT_INFINITY;
        chain_decide(&toy.scene, toy.paths, toy.splats, toy.diagnostics, 0, vec3_splat(color), 1.0f);
        TEST_TRUE(state_load_float(toy.paths, STRIDE, CHAIN_LUMINANCE, 0) == f);
        for (uint i = CHAIN_NUMBERS; i < WORDS; ++i)
            TEST_TRUE(state_load(toy.paths, STRIDE, i, 0) == before[i]);
    }
    TEST_NEAR(state_load_float(toy.paths, STRIDE, CHAIN_PENDING, 0), 1000.0, 1e-3);
    ck_assert_uint_eq(toy.diagnostics[DIAGNOSTIC_NOT_FINITE], 666);
    toy_end(&toy);
}
END_TEST

/* A chain whose path is a million times as bright as its neighbourhood stays there: its run counts every step since it
 * started, up to the counter's maximum, and the longest run is remembered after it has ended. */
START_TEST(test_stuck)
{
    Toy toy;
    toy_begin(&toy, 7u, 0.0f, true);
    draw(&toy, 0, false);
    state_store_float(toy.paths, STRIDE, CHAIN_LUMINANCE, 0, 8e9f);
    for (uint k = 1; k <= 1000; ++k) {
        step(&toy, 0);
        ck_assert_uint_eq(state_load(toy.paths, STRIDE, CHAIN_RUN, 0), k | k << 16);
    }
    chain_propose(&toy.frame, toy.paths, toy.vertices, 0);
    chain_decide(&toy.scene, toy.paths, toy.splats, toy.diagnostics, 0, vec3_splat(9e9f), 1.0f);
    ck_assert_uint_eq(state_load(toy.paths, STRIDE, CHAIN_RUN, 0), 1000u << 16);
    for (uint k = 0; k < 70000; ++k)
        step(&toy, 0);
    ck_assert_uint_eq(run_longest(state_load(toy.paths, STRIDE, CHAIN_RUN, 0)), RUN_MOST);
    ck_assert_uint_eq(run_longest(run_begin(1000u << 16 | 7u)), 0);
    ck_assert_uint_eq(run_after(run_begin(1000u << 16 | 7u), false), 8u | 8u << 16);
    toy_end(&toy);
}
END_TEST

/* State and densities of 524,288 chains of 10 segments: at most 185 MB (Frolov 2018, section 2). */
START_TEST(test_memory)
{
    const FrameParams frame = {.path.max_depth = 10};
    ChainWords words = chain_words(&frame);
    double bytes = 524288.0 * sizeof(uint) * (words.state + words.densities);
    printf("state %u words, densities %u, in all %u: %.1f MB of state and densities\n", words.state, words.densities,
           words.all, 1e-6 * bytes);
    ck_assert_double_le(bytes, 185e6);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("chain");
    TCase *tcase = tcase_create("chain");
    tcase_set_timeout(tcase, 120);
    tcase_add_loop_test(tcase, test_stationary, 0, (int)(sizeof KERNELS / sizeof KERNELS[0]));
    tcase_add_loop_test(tcase, test_offsets_symmetric, 0, 4);
    tcase_add_test(tcase, test_offsets_of_a_word);
    tcase_add_loop_test(tcase, test_kinds, 0, 8);
    tcase_add_loop_test(tcase, test_null_mutations, 0, 3);
    tcase_add_loop_test(tcase, test_zero_never_accepted, 0, 3);
    tcase_add_test(tcase, test_stuck);
    tcase_add_test(tcase, test_memory);
    suite_add_tcase(suite, tcase);
    suite_add_tcase(suite, chain_shown_tests());
    return test_run(suite);
}
