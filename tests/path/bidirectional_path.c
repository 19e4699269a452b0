#include "path/bidirectional_path.h"

#include "support/test_util.h"

bool test_path_possible(const TestPath *path, uint set, uint s)
{
    uint t = path->k + 1 - s;
    if (!strategy_taken(set, s, path->k))
        return false;
    if (s == 0)
        return path->hittable;
    return !path->delta[t - 1] && !path->delta[t];
}

/* Compact densities give the same weights: the last two vertices of a subpath store their own density, earlier ones the
 * ratio of both. Skipped if a ratio is not a normal number. */
static void compact_check(const DensityView *full, uint set, uint exponent, uint s, uint t, const StrategyEnds *ends,
                          StrategyWeights expected)
{
    uint light[PATH_SEGMENTS_MAX + 1], camera[PATH_SEGMENTS_MAX + 1];
    DensityView view = *full;
    view.compact = true;
    view.light = light;
    view.camera = camera;
    view.light_end = s >= 2 ? s - 2 : 0;
    view.camera_end = t >= 3 ? t - 2 : 1;
    for (uint i = 0; i < s; ++i) {
        float own = density_own(full, SIDE_LIGHT, i);
        light[i] = float_bits(i >= view.light_end ? own : density_other(full, SIDE_LIGHT, i) / own);
    }
    for (uint i = 1; i < t; ++i) {
        float own = density_own(full, SIDE_CAMERA, i);
        camera[i - 1] = float_bits(i >= view.camera_end ? own : density_other(full, SIDE_CAMERA, i) / own);
    }
    for (uint i = 0; s > 1 && i < s; ++i)
        if (!isnormal(bits_float(light[i])))
            return;
    for (uint i = 1; i < t; ++i)
        if (!isnormal(bits_float(camera[i - 1])))
            return;
    const StrategyWeights got = strategy_weights(set, exponent, s, t, &view, ends);
    TEST_NEAR(got.own, expected.own, 1e-5);
    TEST_NEAR(got.path_tracing, expected.path_tracing, 1e-5);
}

/* Stores what the walks of strategy (s, k + 1 - s) would; values known only to the connection are absent from the
 * buffer, where NaN must not matter. */
StrategyWeights test_path_weights(const TestPath *path, uint set, uint exponent, uint s)
{
    uint k = path->k, t = k + 1 - s;
    uint light[PATH_SEGMENTS_MAX + 1][DENSITY_WORDS], camera[PATH_SEGMENTS_MAX + 1][DENSITY_WORDS];
    for (uint i = 0; i <= PATH_SEGMENTS_MAX; ++i)
        for (uint which = 0; which < DENSITY_WORDS; ++which)
            light[i][which] = camera[i][which] = float_bits(NAN);
    StrategyEnds ends;
    memset(&ends, 0xff, sizeof ends); /* NaN in unused members */
    ends.connect = path->connect;
    ends.hittable = path->hittable;
    DensityView view = {.light = light[0], .camera = camera[0], .stride = 1};
    for (uint i = 1; i < t; ++i) {
        camera[i - 1][DENSITY_OWN] = float_bits(path->camera[i]);
        if (i + 2 < t)
            camera[i - 1][DENSITY_OTHER] = float_bits(path->light[i]);
        view.camera_delta |= path->delta[i] ? 1u << i : 0u;
    }
    for (uint i = 0; i < s; ++i) {
        if (s > 1)
            light[i][DENSITY_OWN] = float_bits(path->light[k - i]);
        if (i + 2 < s)
            light[i][DENSITY_OTHER] = float_bits(path->camera[k - i]);
        view.light_delta |= path->delta[k - i] ? 1u << i : 0u;
    }
    ends.light_z1 = t > 1 ? path->light[t - 1] : NAN;
    ends.light_z2 = t > 2 ? path->light[t - 2] : NAN;
    ends.camera_y1 = s > 0 ? path->camera[t] : NAN;
    ends.camera_y2 = s > 1 ? path->camera[t + 1] : NAN;
    ends.own_y0 = s == 1 ? path->light[k] : NAN;
    const StrategyWeights full = strategy_weights(set, exponent, s, t, &view, &ends);
    compact_check(&view, set, exponent, s, t, &ends, full);
    return full;
}

float test_path_weight(const TestPath *path, uint set, uint exponent, uint s)
{
    return test_path_weights(path, set, exponent, s).own;
}
