/* The light that an error is relative to, as far as two halves tell it; and the largest of many values. */
#include "support/test_util.h"

#include "base/largest_values.h"
#include "base/sample_statistics.h"
#include "render/tile_light.h"

#include <string.h>

/* The least of those kept is the one that sorting finds, for any number of values, equal ones included. */
START_TEST(test_largest)
{
    double values[500], heap[500];
    unsigned short state[3] = {(unsigned short)_i, 5, 7};
    for (size_t count = 1; count <= 500; count += 83) {
        LargestValues largest = {.heap = heap, .wanted = 1 + (size_t)_i * count / 11};
        for (size_t i = 0; i < count; ++i) {
            values[i] = floor(40.0 * erand48(state));
            largest_values_add(&largest, values[i]);
        }
        sample_sort(values, count);
        ck_assert_uint_eq(largest.count, largest.wanted);
        ck_assert_double_eq(largest_values_least(&largest), values[count - largest.wanted]);
    }
}
END_TEST

/* A tile with stripes, `dark` and 1, and a noise of this standard deviation. */
static void tile_make(double dark, double noise, TileValues *values, double truth[TILE_PIXELS])
{
    unsigned short state[3] = {11, 12, 13};
    values->count = TILE_PIXELS;
    for (size_t i = 0; i < TILE_PIXELS; ++i) {
        truth[i] = i % 2 == 0 ? dark : 1.0;
        values->difference[i] = noise * sqrt(12.0) * (erand48(state) - 0.5);
        values->picture[i] = truth[i] + noise * sqrt(12.0) * (erand48(state) - 0.5);
        values->halves[0][i] = values->picture[i] + values->difference[i];
        values->halves[1][i] = values->picture[i] - values->difference[i];
    }
}

/* Adds light to a pixel of the second half, which has this share of the picture's samples. */
static void path_add(TileValues *values, size_t pixel, double light, double share)
{
    values->halves[1][pixel] += light;
    values->picture[pixel] += share * light;
    values->difference[pixel] -= sqrt(share * (1.0 - share)) * light;
}

/* Without noise each pixel has its own light; with noise that hides the stripes, the tile's mean. */
START_TEST(test_noise)
{
    TileValues values;
    double truth[TILE_PIXELS], light[TILE_PIXELS], own = 0.0, found = 0.0;
    tile_make(0.1, 0.0, &values, truth);
    tile_light(&values, light);
    for (size_t i = 0; i < TILE_PIXELS; ++i)
        ck_assert_double_eq_tol(light[i], truth[i], 1e-12);
    tile_make(0.9, 0.5, &values, truth);
    tile_light(&values, light);
    for (size_t i = 0; i < TILE_PIXELS; ++i) {
        own += fabs(values.picture[i] - truth[i]);
        found += fabs(light[i] - truth[i]);
    }
    ck_assert_double_le(found, 0.4 * own);
    memset(values.difference, 0, sizeof values.difference);
    memset(values.picture, 0, sizeof values.picture);
    tile_light(&values, light);
    for (size_t i = 0; i < TILE_PIXELS; ++i)
        ck_assert_double_eq(light[i], 0.0);
}
END_TEST

/* A bright path that one half has met on dark pixels makes neither these nor their neighbours brighter, whatever share
 * of the samples the half has. */
START_TEST(test_bright_path)
{
    const struct {
        double share, noise; /* the usual noise, in units of the half without paths, and its own */
    } halves[] = {{0.5, 0.02}, {0.1, 0.02}, {0.9, 0.05}};
    TileValues values;
    double truth[TILE_PIXELS], light[TILE_PIXELS];
    for (size_t which = 0; which < 3; ++which) {
        tile_make(0.02, 0.002, &values, truth);
        for (size_t i = 20; i < 20 + 2 * (size_t)_i; i += 2)
            path_add(&values, i, 100.0, halves[which].share);
        tile_light(&values, light);
        for (size_t i = 0; i < TILE_PIXELS; ++i)
            ck_assert_double_eq_tol(light[i], truth[i], halves[which].noise);
    }
}
END_TEST

/* So does a path beside one that is much brighter. */
START_TEST(test_two_paths)
{
    TileValues values;
    double truth[TILE_PIXELS], light[TILE_PIXELS];
    tile_make(0.02, 0.002, &values, truth);
    path_add(&values, 20, 1e4, 0.5);
    path_add(&values, 44, 10.0, 0.5);
    tile_light(&values, light);
    for (size_t i = 0; i < TILE_PIXELS; ++i)
        ck_assert_double_eq_tol(light[i], truth[i], 0.015);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("tile light");
    TCase *tcase = tcase_create("tile light");
    tcase_add_loop_test(tcase, test_largest, 0, 11);
    tcase_add_test(tcase, test_noise);
    tcase_add_loop_test(tcase, test_bright_path, 1, 5);
    tcase_add_test(tcase, test_two_paths);
    suite_add_tcase(suite, tcase);
    return test_run(suite);
}
