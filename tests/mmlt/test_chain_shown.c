/* Single paths in chains and pools: the part that path tracing shows, where and how often they are splatted, and which
 * path of a sample the pool keeps. Expected values over the random numbers are compared with the definitions. */
#include "mmlt/test_chain.h"

#include "chain/chain_light.h"
#include "support/filter_cases.h"
#include "support/test_files.h"

#include <string.h>

/* A crop window inside the film, and a triangle filter with two different radii. */
enum { WIDTH = 9, X0 = 1, X1 = 7, Y0 = 2, Y1 = 6, COLUMNS = X1 - X0, ROWS = Y1 - Y0 };
#define RADIUS_X 2.0
#define RADIUS_Y 1.0
#define LIMIT 3.0f
#define LIGHTS_WEIGHT 4.0f

typedef struct Shown {
    LightFixture light;
    uint paths[CHAIN_NUMBERS + 64], rays[RAY_WORDS], splats[SPLAT_WORDS], diagnostics[DIAGNOSTIC_COUNT];
    unsigned state;
} Shown;

static void shown_init(Shown *shown, unsigned seed)
{
    const FilterSettings triangle = {
        .kind = PIXEL_FILTER_TRIANGLE, .radius_x = (float)RADIUS_X, .radius_y = (float)RADIUS_Y};
    FrameParams *frame = &shown->light.scene.frame;
    memset(shown, 0, sizeof *shown);
    shown->state = seed;
    fixture_init_filter(&shown->light, &triangle);
    frame->film.width = WIDTH;
    frame->film.height = 8;
    frame->film.crop_x0 = X0;
    frame->film.crop_x1 = X1;
    frame->film.crop_y0 = Y0;
    frame->film.crop_y1 = Y1;
    frame->pass.stride = 1;
    frame->pool.enabled = 1;
    frame->path.max_depth = 10;
    frame->partition.clamp_threshold = LIMIT;
    frame->chains.brightness = 1.7f;
    frame->pool.lights_weight = LIGHTS_WEIGHT;
    shown->light.view.guide = &shown->light.scene.guide;
    for (uint i = 0; i < IMPORTANCE_CELLS; ++i)
        shown->light.scene.guide.importance[i] = (float)exp2(2.0 * test_random_unit(&shown->state) - 1.0);
}

static float octaves(Shown *shown, double most)
{
    return (float)exp2(most * (2.0 * test_random_unit(&shown->state) - 1.0));
}

static Vec3 color_draw(Shown *shown)
{
    return vec3(octaves(shown, 2.0), octaves(shown, 2.0), octaves(shown, 2.0));
}

/* Area of the film positions that filters reach, divided by that of the crop window: radius - 1/2 more on each side. */
static double reach_factor(void)
{
    return (COLUMNS + 2.0 * RADIUS_X - 1.0) * (ROWS + 2.0 * RADIUS_Y - 1.0) / (COLUMNS * ROWS);
}

static Vec2 film_draw(Shown *shown)
{
    double x = X0 + 0.5 - RADIUS_X + (COLUMNS + 2.0 * RADIUS_X - 1.0) * test_random_unit(&shown->state);
    double y = Y0 + 0.5 - RADIUS_Y + (ROWS + 2.0 * RADIUS_Y - 1.0) * test_random_unit(&shown->state);
    return vec2((float)x, (float)y);
}

static double importance_at(const Shown *shown, Vec2 film)
{
    const double side = IMPORTANCE_SIDE;
    int x = (int)fmin(fmax(((double)film.x - X0) * side / COLUMNS, 0.0), side - 1.0);
    int y = (int)fmin(fmax(((double)film.y - Y0) * side / ROWS, 0.0), side - 1.0);
    return (double)shown->light.scene.guide.importance[y * (int)IMPORTANCE_SIDE + x];
}

/* The filter of pixel (x, y) at a film position, normalised to integral 1. */
static double filter_at(Vec2 film, int x, int y)
{
    double across = fmax(1.0 - fabs((double)film.x - x - 0.5) / RADIUS_X, 0.0) / RADIUS_X;
    double down = fmax(1.0 - fabs((double)film.y - y - 0.5) / RADIUS_Y, 0.0) / RADIUS_Y;
    return across * down;
}

static double cover_at(Vec2 film)
{
    double sum = 0.0;
    for (int y = Y0; y < Y1; ++y)
        for (int x = X0; x < X1; ++x)
            sum += filter_at(film, x, y);
    return sum;
}

static double luminance_of(Vec3 color)
{
    return (double)rgb_luminance(color);
}

/* ---- chains ------------------------------------------------------------------------------------------------------ */

/* Path tracing would contribute color / path_tracing. Of that, times the importance, it shows at most four times the
 * clamping threshold. Camera subpaths of chains start with a factor for the filters' reach, which is divided out; paths
 * with t = 1 have none. Depth and s remain in the key. */
START_TEST(test_key)
{
    Shown shown;
    uint parts = 0;
    shown_init(&shown, 1);
    for (int i = 0; i < 20000; ++i) {
        uint d = 3u + (uint)i % 8u, s = (uint)i / 8u % (d + 1u);
        float path_tracing = octaves(&shown, 4.0);
        Vec3 color = vec3_scale(color_draw(&shown), 8.0f);
        Vec2 film = film_draw(&shown);
        double f = luminance_of(color) * importance_at(&shown, film) / (s < d ? reach_factor() : 1.0);
        double part = fmin(4.0 * (double)LIMIT * (double)path_tracing / f, 1.0);
        uint key = chain_key_shown(&shown.light.view, chain_key(d, s) | 0x1234u << 16, film, color, path_tracing);
        TEST_TRUE(chain_key_depth(key) == d && chain_key_s(key) == s);
        TEST_NEAR((key >> 16) / 65535.0, part, 1.0 / 65535.0);
        parts += part < 1.0;
    }
    ck_assert_uint_gt(parts, 2000);
    shown.light.scene.frame.partition.clamp_threshold = FLOAT_MAX;
    ck_assert_uint_eq(chain_key_shown(&shown.light.view, chain_key(5, 2), vec2(3.0f, 3.0f), vec3_splat(1e30f), 0.0f),
                      chain_key(5, 2) | KEY_SHOWN_ALL << 16);
    fixture_destroy(&shown.light);
}
END_TEST

/* Averaged over u, a part min(1, threshold / f) of a path is not excess, and the part that path tracing does not show
 * is rare. */
START_TEST(test_flags)
{
    enum { N = 4096 };
    Shown shown;
    shown_init(&shown, 2);
    for (int i = 0; i < 100; ++i) {
        uint part = (uint)(65536.0 * test_random_unit(&shown.state)), light = 0, rare = 0;
        float f = LIMIT * octaves(&shown, 3.0);
        for (uint k = 0; k < N; ++k) {
            uint flags =
                chain_splat_layers(shown.light.view.frame, chain_key(4, 2) | part << 16, f, ((float)k + 0.5f) / N);
            light += (flags & SPLAT_LIGHT) != 0;
            rare += (flags & SPLAT_RARE) != 0;
            TEST_TRUE((flags & ~SPLAT_LAYERS) == 0);
        }
        TEST_NEAR((double)light / N, fmin((double)LIMIT / (double)f, 1.0), 1.0 / N);
        TEST_NEAR((double)rare / N, 1.0 - part / 65535.0, 1.0 / N);
    }
    fixture_destroy(&shown.light);
}
END_TEST

/* A pixel receives visits * brightness * filter(position) on average; f is the luminance times the sum of all pixels'
 * filters times the importance. */
START_TEST(test_splat)
{
    enum { N = 128 };
    const float visits = 0.3f;
    Shown shown;
    shown_init(&shown, 3);
    for (int i = 0; i < 20; ++i) {
        double pixels[ROWS][COLUMNS] = {{0.0}}, largest = 0.0;
        Vec2 film = film_draw(&shown);
        Vec3 color = color_draw(&shown);
        double f = (double)chain_target(&shown.light.view, film, color);
        TEST_NEAR(f, luminance_of(color) * cover_at(film) * importance_at(&shown, film), 1e-5 * (1e-3 + f));
        for (uint k = 0; k < N * N; ++k) {
            Random4 random = {
                {0u, k % N * (0x80000000u / N * 2u) + 0x1000000u, k / N * (0x80000000u / N * 2u) + 0x1000000u, 0u}};
            ChainSplat path = {chain_key(4, 2), film, 1.0f, color, visits};
            chain_splat(&shown.light.view, shown.splats, shown.diagnostics, 0, &path, random);
            if (shown.splats[SPLAT_PIXEL] == NONE)
                continue;
            uint pixel = shown.splats[SPLAT_PIXEL] & ~SPLAT_LAYERS, x = pixel % WIDTH - X0, y = pixel / WIDTH - Y0;
            TEST_TRUE(x < COLUMNS && y < ROWS);
            uint offset = shown.splats[SPLAT_OFFSET];
            TEST_NEAR(X0 + x + 0.5 + (double)splat_offset_of(offset & 0xffffu, RADIUS_X), (double)film.x, 1e-4);
            TEST_NEAR(Y0 + y + 0.5 + (double)splat_offset_of(offset >> 16, RADIUS_Y), (double)film.y, 1e-4);
            double value = luminance_of(state_load_vec3(shown.splats, 1, SPLAT_COLOR, 0));
            pixels[y][x] += value / (N * N);
            largest = fmax(largest, value);
        }
        for (int y = 0; y < ROWS; ++y)
            for (int x = 0; x < COLUMNS; ++x)
                TEST_NEAR(pixels[y][x], luminance_of(color) * (double)visits * 1.7 * filter_at(film, X0 + x, Y0 + y),
                          largest * 3.0 / N);
    }
    fixture_destroy(&shown.light);
}
END_TEST

/* With s = 0 the light subpath has no coordinates, with s = d the camera subpath; a step then changes both. */
START_TEST(test_halves)
{
    for (uint d = CHAIN_DEPTH_MIN; d < 9; ++d)
        for (uint s = 0; s <= d; ++s) {
            bool both = s == 0 || s == d;
            ck_assert_uint_eq(mutation_subpaths(MUTATION_ALL, d, s), SUBPATH_BOTH);
            ck_assert_uint_eq(mutation_subpaths(MUTATION_LARGE, d, s), SUBPATH_BOTH);
            ck_assert_uint_eq(mutation_subpaths(MUTATION_LIGHT, d, s), both ? SUBPATH_BOTH : SUBPATH_LIGHT);
            ck_assert_uint_eq(mutation_subpaths(MUTATION_CAMERA, d, s), both ? SUBPATH_BOTH : SUBPATH_CAMERA);
        }
}
END_TEST

/* Large steps propose s = 0 ... d with equal probability. */
START_TEST(test_large)
{
    enum { STEPS = 1 << 16 };
    Shown shown;
    uint *paths = calloc(CHAIN_NUMBERS + 64, sizeof *paths), vertices[CHAIN_VERTEX_WORDS] = {0};
    ck_assert_ptr_nonnull(paths);
    shown_init(&shown, 4);
    shown.light.scene.frame.chains.large_step = 1.0f;
    for (uint d = 3; d < 6; ++d) {
        uint counts[8] = {0};
        state_store(paths, 1, CHAIN_KEY, 0, chain_key(d, 1));
        state_store_float(paths, 1, CHAIN_LUMINANCE, 0, 1.0f);
        for (uint i = 0; i < STEPS; ++i) {
            chain_propose(shown.light.view.frame, paths, vertices, 0);
            uint key = state_load(paths, 1, CHAIN_PROPOSED_KEY, 0);
            TEST_TRUE(chain_key_depth(key) == d && chain_key_s(key) <= d);
            ++counts[chain_key_s(key)];
        }
        double share = 1.0 / (d + 1.0);
        for (uint s = 0; s <= d; ++s)
            ck_assert_double_eq_tol((double)counts[s] / STEPS, share, 5.0 * sqrt(share * (1.0 - share) / STEPS));
    }
    free(paths);
    fixture_destroy(&shown.light);
}
END_TEST

/* Of the steps of the camera subpath, a fraction `shifts` are shifts, for any set of enabled kinds. */
START_TEST(test_shifts)
{
    enum { STEPS = 1 << 16 };
    Shown shown;
    uint vertices[CHAIN_VERTEX_WORDS] = {0}, camera = 0, shifts = 0;
    shown_init(&shown, 9);
    shown.light.scene.frame.chains.mutations = 7;
    shown.light.scene.frame.chains.shifts = 0.5f;
    state_store(shown.paths, 1, CHAIN_KEY, 0, chain_key(4, 2));
    state_store_float(shown.paths, 1, CHAIN_LUMINANCE, 0, 1.0f);
    for (uint i = 0; i < STEPS; ++i) {
        chain_propose(shown.light.view.frame, shown.paths, vertices, 0);
        bool of_camera = chain_move(shown.paths, 1, 0, MOVE_MUTATION) == MUTATION_CAMERA;
        bool shift = chain_move(shown.paths, 1, 0, MOVE_SHIFT) != 0u;
        TEST_TRUE(of_camera || !shift);
        camera += of_camera;
        shifts += shift;
    }
    ck_assert_double_eq_tol((double)shifts / camera, 0.5, 5.0 * 0.5 / sqrt(camera));
    fixture_destroy(&shown.light);
}
END_TEST

/* A single infinite light, selected with u, represents all: for every u the luminance is that of all lights, the
 * expected color is their sum, and color / path_tracing is that of the selected light. */
START_TEST(test_environment)
{
    enum { LIGHTS = 4, N = 4096 };
    const Ray ray = {.d = {0.6f, 0.0f, 0.8f}};
    const Vec3 ng = vec3(0.0f, 0.0f, 1.0f);
    const uint depth = 3;
    Shown shown;
    FrameParams *frame = &shown.light.scene.frame;
    uint densities[2 * 4 * DENSITY_WORDS];
    double all = 0.0, mean[3] = {0.0}, expected[3] = {0.0};
    Vec3 colors[LIGHTS], beta = vec3(0.3f, 0.5f, 0.2f);
    float by_path_tracing[LIGHTS];
    shown_init(&shown, 5);
    for (int i = 0; i < LIGHTS; ++i) {
        Vec3 emission = i == 2 ? vec3_splat(0.0f) : color_draw(&shown);
        fixture_add_light(&shown.light, (LightData){.kind = LIGHT_INFINITE, .emission = emission});
    }
    fixture_finish(&shown.light);
    frame->path.strategies = STRATEGIES_BDPT;
    frame->path.mis_exponent = 2;
    frame->path.only_s = NONE;
    for (size_t i = 0; i < sizeof densities / sizeof densities[0]; ++i)
        densities[i] = float_bits(octaves(&shown, 1.0));
    DensityView view = {.light = densities, .camera = densities, .stride = 1};
    WalkHit miss = {.ray = ray, .from_ng = ng, .missed = true, .passage_back = 1.0f};
    for (uint i = 0; i < frame->scene.infinite_light_count; ++i) {
        StrategyEnds ends = {0};
        Vec3 met = environment_met(&shown.light.view, shown.light.view.infinite_lights[i], &miss, &ends);
        StrategyWeights weights = strategy_weights(STRATEGIES_BDPT, 2, 0, depth + 1, &view, &ends);
        colors[i] = vec3_scale(vec3_mul(beta, met), weights.own);
        by_path_tracing[i] = weights.path_tracing;
        all += luminance_of(colors[i]);
        expected[0] += (double)colors[i].x;
        expected[1] += (double)colors[i].y;
        expected[2] += (double)colors[i].z;
    }
    for (uint k = 0; k < N; ++k) {
        float path_tracing = 0.0f;
        Vec3 got = chain_environment(&shown.light.view, beta, view, &miss, depth, ((float)k + 0.5f) / N, &path_tracing);
        bool one = false;
        TEST_NEAR(luminance_of(got) / all, 1.0, 1e-5);
        for (uint i = 0; i < frame->scene.infinite_light_count; ++i)
            one = one || (luminance_of(colors[i]) > 0.0 &&
                          fabsf(got.x / path_tracing / (colors[i].x / by_path_tracing[i]) - 1.0f) < 1e-4f &&
                          fabsf(got.z / path_tracing / (colors[i].z / by_path_tracing[i]) - 1.0f) < 1e-4f);
        TEST_TRUE(one);
        mean[0] += (double)got.x / N;
        mean[1] += (double)got.y / N;
        mean[2] += (double)got.z / N;
    }
    for (int c = 0; c < 3; ++c)
        TEST_NEAR(mean[c] / expected[c], 1.0, 10.0 * LIGHTS / N);
    fixture_destroy(&shown.light);
}
END_TEST

/* A camera subpath of four segments hits a lamp (s = 0): its weight accounts for the subpath's delta vertices, and the
 * key holds the part that path tracing shows, with the weights of s = 0 and s = 1 together. */
START_TEST(test_met_lamp)
{
    enum { D = 4 };
    static const float TRIANGLE[9] = {0.0f, 0.0f, 0.0f, 1.0f, 0.0f, 0.0f, 0.0f, 1.0f, 0.0f};
    Shown shown;
    FrameParams *frame = &shown.light.scene.frame;
    const Vec3 beta = vec3(3.0f, 5.0f, 2.0f);
    uint full[D * DENSITY_WORDS], compact[D];
    float weights_seen[2] = {0.0f, 0.0f};
    shown_init(&shown, 8);
    fixture_add_polygon(&shown.light, TRIANGLE, 3, NULL, 0, LIGHT_TWO_SIDED);
    fixture_finish(&shown.light);
    frame->path.strategies = STRATEGIES_BDPT;
    frame->path.mis_exponent = 2;
    frame->path.only_s = NONE;
    frame->partition.clamp_threshold = 0.01f;
    for (uint delta = 0; delta < 2; ++delta) { /* delta == 1: z_2 scatters by a delta lobe */
        for (uint i = 0; i < D; ++i) {
            float own = octaves(&shown, 0.5), other = octaves(&shown, 0.5);
            full[i * DENSITY_WORDS + DENSITY_OWN] = float_bits(own);
            full[i * DENSITY_WORDS + DENSITY_OTHER] = float_bits(other);
            compact[i] = float_bits(i + 2 < D ? other / own : own);
        }
        WalkHit walk_hit = {.light = 0, .instance = 0, .primitive = 0, .back = 0.7f, .beta = beta};
        walk_hit.from = vec3(0.3f, 0.2f, 2.0f);
        walk_hit.ray.o = walk_hit.from;
        walk_hit.ray.d = vec3(0.0f, 0.0f, -1.0f);
        walk_hit.distance2 = 4.0f;
        walk_hit.surface = (Surface){.p = vec3(0.3f, 0.2f, 0.0f), .ng = vec3(0.0f, 0.0f, 1.0f)};
        StrategyEnds ends = {0};
        Vec3 met = emission_met(&shown.light.view, &walk_hit, &ends);
        DensityView view = {.light = full, .camera = full, .stride = 1, .camera_delta = delta << 2};
        StrategyWeights weights = strategy_weights(STRATEGIES_BDPT, 2, 0, D + 1, &view, &ends);
        weights_seen[delta] = weights.own;
        TEST_TRUE(weights.own < 0.9f * weights.path_tracing); /* else the comparison below could not fail */
        memset(shown.paths, 0, sizeof shown.paths);
        state_store(shown.paths, 1, CHAIN_PROPOSED_KEY, 0, chain_key(D, 0));
        state_store_vec3(shown.paths, 1, BD_BETA, 0, beta);
        state_store(shown.paths, 1, BD_CAMERA_DELTA, 0, delta << 2);
        state_store(shown.paths, 1, CHAIN_NUMBERS + NUMBER_CAMERA, 0, 0x40000000u);
        state_store(shown.paths, 1, CHAIN_NUMBERS + NUMBER_CAMERA + 1u, 0, 0xc0000000u);
        chain_hit_light(&shown.light.view, shown.paths, compact, 0, D, &walk_hit);
        Vec3 expected = vec3_scale(vec3_mul(beta, met), weights.own);
        Vec3 got = state_load_vec3(shown.paths, 1, BD_CONTRIBUTION, 0);
        Vec2 film = chain_film_load(shown.paths, 1, CHAIN_PROPOSED_FILM, 0);
        TEST_NEAR(film.x, X0 + 0.5 - RADIUS_X + 0.25 * (COLUMNS + 2.0 * RADIUS_X - 1.0), 1e-5);
        TEST_NEAR(film.y, Y0 + 0.5 - RADIUS_Y + 0.75 * (ROWS + 2.0 * RADIUS_Y - 1.0), 1e-5);
        TEST_NEAR(vec3_length(vec3_sub(got, expected)) / vec3_length(expected), 0.0, 1e-5);
        uint key = state_load(shown.paths, 1, CHAIN_PROPOSED_KEY, 0);
        double f = luminance_of(expected) * importance_at(&shown, film) / reach_factor();
        TEST_NEAR((key >> 16) / 65535.0, 4.0 * 0.01 * (double)weights.path_tracing / f, 2.0 / 65535.0);
    }
    TEST_TRUE(fabsf(weights_seen[0] - weights_seen[1]) > 0.01f);
    fixture_destroy(&shown.light);
}
END_TEST

/* ---- pools ------------------------------------------------------------------------------------------------------- */

/* Pools visit every other column three times as often. */
static void visits_set(Scene *scene)
{
    uint all = 0;
    for (uint i = 0; i < IMPORTANCE_CELLS; ++i) {
        uint column = i % IMPORTANCE_SIDE, row = i / IMPORTANCE_SIDE;
        scene->guide.visits[i] = all;
        all += (cell_begin(column + 1, COLUMNS) - cell_begin(column, COLUMNS)) *
               (cell_begin(row + 1, ROWS) - cell_begin(row, ROWS)) * (cell_begin(column, COLUMNS) % 2 == 0 ? 1 : 3);
    }
    scene->guide.visits[IMPORTANCE_CELLS] = scene->frame.pool.visits = all;
}

/* Half of the columns are visited once, the others three times: the mean is two. */
static double density_ratio_of(uint pixel)
{
    return (pixel % WIDTH - X0) % 2 == 0 ? 2.0 : 2.0 / 3.0;
}

/* Contribution weight: luminance times importance over the density of the numbers that make the path. Paths that only
 * samples with a light subpath can make (s > 1) count pool_lights_weight times; film positions have the density of the
 * pixel's filter, or are uniform for t = 1. */
static double contribution_of(uint s, uint t, double luminance, double cover, uint pixel)
{
    return luminance * (s > 1 ? (double)LIGHTS_WEIGHT : 1.0) *
           (t == 1 ? cover : density_ratio_of(pixel) / reach_factor());
}

/* The candidate is one of a sample's paths with probability proportional to its contribution weight; its f excludes
 * Russian roulette. The film is shown min(1, threshold / f) of every path. */
START_TEST(test_candidates)
{
    enum { PATHS = 8, SAMPLES = 40000 };
    static const uint KINDS[PATHS][2] = {{0, 4}, {1, 2}, {1, 3}, {2, 1}, {2, 2}, {3, 1}, {3, 4}, {0, 6}};
    Shown shown;
    const FrameParams *frame = &shown.light.scene.frame;
    double weights[PATHS], sum = 0.0;
    float survival[PATHS], cover[PATHS], importance[PATHS];
    uint counts[PATHS] = {0};
    Vec3 colors[PATHS];
    const uint pixel = 3 * WIDTH + 4;
    shown_init(&shown, 6);
    visits_set(&shown.light.scene);
    for (int i = 0; i < PATHS; ++i) {
        survival[i] = 0.25f + 0.125f * (float)(i % 4);
        cover[i] = 0.5f + 0.0625f * (float)i;
        importance[i] = octaves(&shown, 1.0);
        colors[i] = vec3_scale(color_draw(&shown), i % 2 == 0 ? 2.0f : 40.0f); /* below and above the threshold */
        weights[i] = contribution_of(KINDS[i][0], KINDS[i][1], luminance_of(colors[i]) * (double)importance[i],
                                     (double)cover[i], pixel);
        sum += weights[i];
    }
    for (uint sample = 0; sample < SAMPLES; ++sample) {
        memset(shown.paths, 0, sizeof shown.paths);
        shown.paths[BD_PIXEL] = pixel;
        shown.paths[BD_SAMPLE] = sample;
        for (int i = 0; i < PATHS; ++i) {
            double f = luminance_of(colors[i]) * (double)(importance[i] * cover[i] * survival[i]);
            double counted = KINDS[i][0] > 1 ? (double)LIGHTS_WEIGHT : 1.0;
            Candidate path = {KINDS[i][0], KINDS[i][1], survival[i], cover[i], importance[i], colors[i]};
            Vec3 got = reservoir_update(frame, shown.light.view.guide, shown.paths, 0, path);
            TEST_TRUE((f > (double)LIMIT) == (i % 2 == 1));
            TEST_NEAR(luminance_of(got) / luminance_of(colors[i]), counted * fmin((double)LIMIT / f, 1.0), 1e-5);
        }
        TEST_NEAR(bits_float(shown.paths[BD_CANDIDATE_SUM]) / sum, 1.0, 1e-5);
        uint key = shown.paths[BD_CANDIDATE], kept = PATHS;
        for (uint i = 0; i < PATHS; ++i)
            if (key == chain_key(KINDS[i][0] + KINDS[i][1] - 1, KINDS[i][0]))
                kept = i;
        TEST_TRUE(kept < PATHS);
        TEST_NEAR(bits_float(shown.paths[BD_CANDIDATE_LUMINANCE]) /
                      (luminance_of(colors[kept]) * (double)(importance[kept] * cover[kept] * survival[kept])),
                  1.0, 1e-5);
        ++counts[kept];
    }
    for (int i = 0; i < PATHS; ++i) {
        double share = weights[i] / sum;
        ck_assert_double_eq_tol((double)counts[i] / SAMPLES, share, 5.0 * sqrt(share * (1.0 - share) / SAMPLES));
    }
    fixture_destroy(&shown.light);
}
END_TEST

/* Film positions of a pool's sample have the mean and variance of its pixel's triangle filter, 0 and radius^2 / 6. Its
 * weight is the pixel's density ratio over the reach factor; Russian roulette is scaled by the density ratio if that
 * exceeds one, and by pool_lights_weight if the sample has a light subpath. */
START_TEST(test_start)
{
    enum { SAMPLES = 20000 };
    Shown shown;
    FrameParams *frame = &shown.light.scene.frame;
    shown_init(&shown, 7);
    visits_set(&shown.light.scene);
    frame->camera = (Camera){.kind = CAMERA_PERSPECTIVE, .screen = {-1.0f, 1.0f, -1.0f, 1.0f}};
    for (int k = 0; k < 3; ++k)
        frame->camera.world_from_camera.m[5 * k] = frame->camera.camera_from_world.m[5 * k] = 1.0f;
    frame->pool.items = 8;
    frame->pool.lights = 3;
    frame->pool.lights_first = 6; /* items 6, 7 and 0 */
    for (uint item = 0; item < 8; ++item) {
        bool walk = item >= 6 || item < 1;
        uint pixel = 3 * WIDTH + 3 + item % 2;
        double sum[2] = {0.0}, squares[2] = {0.0}, radius[2] = {RADIUS_X, RADIUS_Y};
        frame->pass.first_item = item;
        for (uint sample = 0; sample < SAMPLES; ++sample) {
            shown.paths[BD_PIXEL] = pixel;
            shown.paths[BD_SAMPLE] = sample;
            pool_start_camera(&shown.light.view, (Walk){shown.paths, shown.rays, shown.diagnostics, 1, 0});
            Random4 random = {{0u, 0u, 0u, 0u}};
            float weight;
            random = pool_camera(&shown.light.view, shown.paths, 0, &weight);
            Vec2 film = film_position(frame, random.x[0], random.x[1]);
            double off[2] = {(double)film.x - pixel % WIDTH - 0.5, (double)film.y - pixel / WIDTH - 0.5};
            for (int a = 0; a < 2; ++a) {
                sum[a] += off[a] / SAMPLES;
                squares[a] += off[a] * off[a] / SAMPLES;
            }
            TEST_NEAR(bits_float(shown.paths[BD_COVER]), cover_at(film), 1e-5);
            TEST_NEAR(bits_float(shown.paths[BD_IMPORTANCE]), importance_at(&shown, film), 1e-6);
        }
        for (int a = 0; a < 2; ++a) {
            double variance = radius[a] * radius[a] / 6.0;
            ck_assert_double_eq_tol(sum[a], 0.0, 5.0 * sqrt(variance / SAMPLES));
            ck_assert_double_eq_tol(squares[a] / variance, 1.0, 0.05);
        }
        /* walk_begin divides by the throughput, which is the reach factor. */
        double counts = fmax(density_ratio_of(pixel), 1.0) * (walk ? (double)LIGHTS_WEIGHT : 1.0);
        ck_assert_double_eq_tol((double)bits_float(shown.paths[BD_WEIGHT]), density_ratio_of(pixel) / reach_factor(),
                                1e-6);
        ck_assert_double_eq_tol((double)bits_float(shown.paths[BD_ROULETTE_SCALE]) * reach_factor(), counts, 1e-5);
        ck_assert(pool_has_light(frame, item) == walk);
    }
    fixture_destroy(&shown.light);
}
END_TEST

TCase *chain_shown_tests(void)
{
    TCase *tcase = tcase_create("shown");
    tcase_set_timeout(tcase, 60);
    tcase_add_test(tcase, test_key);
    tcase_add_test(tcase, test_flags);
    tcase_add_test(tcase, test_splat);
    tcase_add_test(tcase, test_halves);
    tcase_add_test(tcase, test_large);
    tcase_add_test(tcase, test_shifts);
    tcase_add_test(tcase, test_environment);
    tcase_add_test(tcase, test_met_lamp);
    tcase_add_test(tcase, test_candidates);
    tcase_add_test(tcase, test_start);
    return tcase;
}
