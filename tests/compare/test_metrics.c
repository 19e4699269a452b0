#include "support/test_files.h"
#include "support/test_util.h"

#include "compare/error_image.h"
#include "compare/metrics.h"
#include "image/read.h"

#define TOLERANCE 1e-12

static Metrics metrics_of(const float *image, const float *reference, int width, int height, int blocks)
{
    Metrics metrics;
    Error error = {0};
    ck_assert_msg(metrics_compute(image, reference, width, height, blocks, &metrics, &error), "%s", error.message);
    return metrics;
}

/* Two pixels, worked out by hand. Differences: 0.5 0 -1 | 0.25 0.25 0.25. */
START_TEST(test_by_hand)
{
    const float image[] = {1.5f, 2.0f, 0.0f, 0.25f, 0.5f, 0.75f};
    const float reference[] = {1.0f, 2.0f, 1.0f, 0.0f, 0.25f, 0.5f};
    Metrics m = metrics_of(image, reference, 2, 1, 1);
    double q = 0.0625, r = 0.25 / 1.01 + 1.0 / 1.01 + q / 0.01 + q / (0.0625 + 0.01) + q / (0.25 + 0.01);
    ck_assert_double_eq_tol(m.mse, (0.25 + 0.0 + 1.0 + 3.0 * q) / 6.0, TOLERANCE);
    ck_assert_double_eq_tol(m.rel_mse, r / 6.0, TOLERANCE);
    ck_assert_double_eq_tol(m.rel_mse_trimmed, r / 6.0, TOLERANCE);
    ck_assert_double_eq_tol(m.mape, (0.5 / 1.01 + 1.0 / 1.01 + 0.25 / 0.01 + 0.25 / 0.26 + 0.25 / 0.51) / 6.0,
                            TOLERANCE);
    ck_assert_double_eq_tol(m.smape, (0.5 / 1.26 + 1.0 / 0.51 + 0.25 / 0.135 + 0.25 / 0.385 + 0.25 / 0.635) / 6.0,
                            TOLERANCE);
    ck_assert_double_eq_tol(m.mean, 5.0 / 6.0, TOLERANCE);
    ck_assert_double_eq_tol(m.mean_reference, 4.75 / 6.0, TOLERANCE);
    ck_assert_double_eq_tol(m.mean_rgb[1], 1.25, TOLERANCE);
    ck_assert_double_eq_tol(m.mean_reference_rgb[2], 0.75, TOLERANCE);
    ck_assert_int_eq(m.blocks, 1);
    ck_assert_double_eq_tol(m.block_max, (0.25 / 6.0) / (4.75 / 6.0 * 1.01), TOLERANCE);
}
END_TEST

START_TEST(test_equal_images)
{
    float image[3 * 20 * 10];
    unsigned state = 3;
    for (int i = 0; i < 600; ++i)
        image[i] = (float)test_random_unit(&state);
    Metrics m = metrics_of(image, image, 20, 10, 16);
    ck_assert(m.mse == 0.0 && m.rel_mse == 0.0 && m.mape == 0.0 && m.smape == 0.0 && m.block_max == 0.0);
    ck_assert_int_eq(m.blocks, 10);
}
END_TEST

/* Of 3000 pixels the three worst are omitted, however bad they are. */
START_TEST(test_trimmed)
{
    float image[9000], reference[9000];
    for (int i = 0; i < 9000; ++i)
        image[i] = reference[i] = 1.0f;
    const int bad[] = {17, 100, 2500, 2999};
    const float error[] = {1000.0f, 50.0f, 200.0f, 10.0f};
    for (int i = 0; i < 4; ++i)
        image[3 * bad[i]] += error[i];
    Metrics m = metrics_of(image, reference, 60, 50, 1);
    ck_assert_double_eq_tol(m.rel_mse_trimmed, 100.0 / 1.01 / 3.0 / 2997.0, TOLERANCE);
    ck_assert_double_eq_tol(m.rel_mse, (1e6 + 2500.0 + 4e4 + 100.0) / 1.01 / 9000.0, 1e-9);
}
END_TEST

/* Tiles of 8 x 8, 2 x 8, 8 x 1 and 2 x 1 pixels: errors that cancel within one do not count; the mean is over tiles. */
START_TEST(test_tiles)
{
    float image[270], reference[270];
    for (int i = 0; i < 270; ++i)
        image[i] = reference[i] = 1.0f;
    image[0] = 3.0f; /* first tile, red: 2 - 2 = 0 */
    image[3 * 77] = -1.0f;
    image[3 * 8 + 1] = 1.5f; /* right tile of 16 pixels, green */
    image[3 * 88 + 2] = 2.0f; /* corner tile of 2 pixels, blue */
    Metrics m = metrics_of(image, reference, 10, 9, 1);
    double right = 0.5 / 16.0, corner = 0.5;
    ck_assert_double_eq_tol(m.rel_mse_8x8, (right * right + corner * corner) / 1.01 / 3.0 / 4.0, TOLERANCE);
    image[3 * 77] = NAN;
    m = metrics_of(image, reference, 10, 9, 1);
    double first = (2.0 - 1.0) / 64.0;
    ck_assert_double_eq_tol(m.rel_mse_8x8, (first * first + right * right + corner * corner) / 1.01 / 3.0 / 4.0,
                            TOLERANCE);
}
END_TEST

START_TEST(test_not_finite)
{
    const float image[] = {NAN, 1.0f, 1.0f, 1.0f, INFINITY, NAN, 1.0f, 1.0f, 1.0f};
    const float reference[] = {0.0f, 1.0f, 1.0f, 1.0f, 0.0f, 0.0f, -INFINITY, 1.0f, 1.0f};
    Metrics m = metrics_of(image, reference, 3, 1, 1);
    ck_assert_uint_eq(m.not_finite, 2);
    ck_assert_uint_eq(m.not_finite_reference, 1);
    ck_assert_double_eq_tol(m.mse, 1.0 / 9.0, TOLERANCE);
    ck_assert_double_eq_tol(m.mean, 6.0 / 9.0, TOLERANCE);
}
END_TEST

/* numpy.linspace(0, size, n + 1).round() */
START_TEST(test_block_edges)
{
    const int expected[] = {0, 6, 11, 17, 22, 28, 34, 39, 45, 51, 56, 62, 68, 73, 79, 84, 90};
    for (int i = 0; i <= 16; ++i)
        ck_assert_int_eq(metrics_block_edge(i, 16, 90), expected[i]);
    ck_assert_int_eq(metrics_block_edge(1, 2, 5), 2);
    ck_assert_int_eq(metrics_block_edge(1, 2, 7), 4);
    ck_assert_int_eq(metrics_block_edge(4095, 4096, 65536), 65520);
}
END_TEST

/* A 2 x 2 grid on 5 x 4 pixels: columns 0-1 and 2-4. */
START_TEST(test_blocks)
{
    float image[3 * 20], reference[3 * 20];
    for (int y = 0; y < 4; ++y) {
        for (int x = 0; x < 5; ++x) {
            for (int c = 0; c < 3; ++c) {
                float r = y < 2 ? (x < 2 ? 1.0f : 2.0f) : (x < 2 ? 4.0f : 1.0f);
                reference[3 * (5 * y + x) + c] = r;
                image[3 * (5 * y + x) + c] = y < 2 && x >= 2 ? r + (c == 0 ? 0.3f : 0.0f) : r;
            }
        }
    }
    Metrics m = metrics_of(image, reference, 5, 4, 2);
    double largest = ((double)2.3f - 2.0) / 3.0 / (2.0 + 0.01 * 2.0);
    ck_assert_double_eq_tol(m.block_max, largest, 1e-9);
    ck_assert_double_eq_tol(m.block_mean, largest / 4.0, 1e-9);
    float black[60] = {0};
    m = metrics_of(image, black, 5, 4, 2);
    ck_assert(isinf(m.block_max));
    m = metrics_of(black, black, 5, 4, 2);
    ck_assert_double_eq(m.block_max, 0.0);
}
END_TEST

START_TEST(test_error_colors)
{
    float low[3], middle[3], high[3], nan[3], dark[3];
    error_color(0.0005f, low);
    error_color(0.05f, middle);
    error_color(3.0f, high);
    error_color(-3.0f, dark);
    error_color(NAN, nan);
    ck_assert(low[0] == 0.0f && low[1] == 0.0f && low[2] == 0.0f);
    ck_assert(middle[0] > 0.5f && middle[0] < 0.6f && middle[2] == 0.0f);
    ck_assert(high[0] == 1.0f && high[1] == 1.0f && high[2] == 0.6f);
    ck_assert(dark[0] == 0.6f && dark[1] == 1.0f && dark[2] == 1.0f);
    ck_assert(nan[0] == 1.0f && nan[1] == 0.0f && nan[2] == 1.0f);
}
END_TEST

START_TEST(test_error_image)
{
    const float image[] = {1.5f, 2.0f, 0.0f, 0.25f, 0.5f, 0.75f};
    const float reference[] = {1.0f, 2.0f, 1.0f, 0.25f, 0.5f, 0.75f};
    const float difference[] = {0.5f, 0.0f, -1.0f, 0.0f, 0.0f, 0.0f};
    Error error = {0};
    Image read;
    ck_assert_msg(error_image_write(test_path("e.exr"), image, reference, 2, 1, &error), "%s", error.message);
    ck_assert(image_read(test_path("e.exr"), &read, &error));
    ck_assert_mem_eq(read.data, difference, sizeof difference);
    image_destroy(&read);
    ck_assert(error_image_write(test_path("e.PNG"), image, reference, 2, 1, &error));
    ck_assert(image_read(test_path("e.PNG"), &read, &error));
    const unsigned char *bytes = read.data;
    ck_assert(bytes[0] == 0 && bytes[2] > 200 && bytes[3] == 0 && bytes[5] == 0);
    image_destroy(&read);
    ck_assert(!error_image_write(test_path("e.jpg"), image, reference, 2, 1, &error));
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("metrics");
    TCase *tcase = tcase_create("metrics");
    tcase_add_checked_fixture(tcase, test_folder_make, test_folder_remove);
    tcase_add_test(tcase, test_by_hand);
    tcase_add_test(tcase, test_equal_images);
    tcase_add_test(tcase, test_trimmed);
    tcase_add_test(tcase, test_tiles);
    tcase_add_test(tcase, test_not_finite);
    tcase_add_test(tcase, test_block_edges);
    tcase_add_test(tcase, test_blocks);
    tcase_add_test(tcase, test_error_colors);
    tcase_add_test(tcase, test_error_image);
    suite_add_tcase(suite, tcase);
    return test_run(suite);
}
