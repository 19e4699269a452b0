/* Metrics that are not computed value by value: FLIP, SSIM, and the z-test between halves. */
#include "support/test_files.h"
#include "support/test_util.h"

#include "base/student.h"
#include "compare/display_error.h"
#include "compare/error_image.h"
#include "compare/z_test.h"
#include "image/exr.h"
#include "image/read.h"
#include "image/rendering_file.h"

#include <math.h>

/* ---- FLIP and SSIM ---------------------------------------------------------------------------------------------- */

#define WIDTH 64
#define HEIGHT 48
#define VALUES (3 * WIDTH * HEIGHT)

/* Stripes of three frequencies, half of them dark, with a bright corner; the image distorts them by a pattern and a
 * disk. */
static void pair_fill(float *image, float *reference)
{
    for (int y = 0; y < HEIGHT; ++y) {
        for (int x = 0; x < WIDTH; ++x) {
            for (int c = 0; c < 3; ++c) {
                int i = 3 * (y * WIDTH + x) + c;
                double r = ((x * (c + 1) + y * (3 - c)) % 37) / 37.0 * (x < 32 ? 1.0 : 0.3);
                r += y > 24 && x > 40 ? 0.4 : 0.0;
                bool disk = (x - 20) * (x - 20) + (y - 12) * (y - 12) < 25;
                reference[i] = (float)r;
                image[i] = (float)(r * (1.0 + 0.25 * ((x * 7 + y * 5 + c * 3) % 11) / 11.0 - 0.1) + (disk ? 0.2 : 0.0));
            }
        }
    }
}

static DisplayError display_error_of(const float *image, const float *reference, int width, int height, double exposure,
                                     double pixels_per_degree)
{
    const DisplaySettings settings = {exposure, pixels_per_degree};
    DisplayError result;
    Error error = {0};
    ck_assert_msg(display_error_compute(image, reference, width, height, &settings, &result, &error), "%s",
                  error.message);
    return result;
}

/* The expected figures were computed from these two images, clamped to 0 ... 1, by other programs: FLIP by the authors'
 * own (Python package flip-evaluator 1.7, "LDR", inputsRGB false), SSIM by scikit-image 0.26.0 (structural_similarity
 * of the luma, gaussian_weights, sigma 1.5, data_range 1, use_sample_covariance false). flip-evaluator computes in
 * float. */
START_TEST(test_reference_programs)
{
    float image[VALUES], reference[VALUES];
    pair_fill(image, reference);
    DisplayError at_desk = display_error_of(image, reference, WIDTH, HEIGHT, 0.0, 67.0);
    ck_assert_double_eq_tol(at_desk.flip, 0.06130918860435486, 2e-6);
    ck_assert_double_eq_tol(at_desk.ssim, 0.9692563814116283, 1e-12);
    DisplayError near = display_error_of(image, reference, WIDTH, HEIGHT, 0.0, 30.0);
    ck_assert_double_eq_tol(near.flip, 0.1104317232966423, 2e-6);
}
END_TEST

START_TEST(test_display_limits)
{
    float image[VALUES], reference[VALUES], doubled[VALUES];
    pair_fill(image, reference);
    DisplayError same = display_error_of(image, image, WIDTH, HEIGHT, 0.0, 67.0);
    ck_assert_double_eq(same.flip, 0.0);
    ck_assert_double_eq_tol(same.ssim, 1.0, 1e-12);
    /* Exposure is a factor: halved values at one stop more look the same. */
    DisplayError plain = display_error_of(image, reference, WIDTH, HEIGHT, 1.0, 67.0);
    for (int i = 0; i < VALUES; ++i) {
        doubled[i] = 2.0f * image[i];
        reference[i] = 2.0f * reference[i];
    }
    DisplayError scaled = display_error_of(doubled, reference, WIDTH, HEIGHT, 0.0, 67.0);
    ck_assert_double_eq(plain.flip, scaled.flip);
    ck_assert_double_eq(plain.ssim, scaled.ssim);
    /* Green against blue is the largest possible error. */
    for (int i = 0; i < VALUES; ++i) {
        image[i] = i % 3 == 1 ? 1.0f : 0.0f;
        reference[i] = i % 3 == 2 ? 1.0f : 0.0f;
    }
    ck_assert_double_eq_tol(display_error_of(image, reference, WIDTH, HEIGHT, 0.0, 67.0).flip, 1.0, 1e-9);
    /* Images smaller than SSIM's window and FLIP's filters; non-finite values; values beyond the display's range. */
    float odd[] = {NAN, INFINITY, -1.0f, 2.0f, 0.5f, 0.25f}, shown[6];
    DisplayError small = display_error_of(odd, odd, 2, 1, 0.0, 67.0);
    ck_assert(isnan(small.ssim) && small.flip == 0.0);
    display_linear(odd, 6, 1.0, shown);
    const float expected[] = {0.0f, 1.0f, 0.0f, 1.0f, 1.0f, 0.5f};
    ck_assert_mem_eq(shown, expected, sizeof shown);
}
END_TEST

/* ---- the z-test between halves --------------------------------------------------------------------------------- */

/* Two-sided probabilities from scipy.stats.t (1.17). */
START_TEST(test_student)
{
    ck_assert_double_eq_tol(student_two_sided(1.0, 1.0), 0.5, 1e-12);
    ck_assert_double_eq_tol(student_two_sided(0.1, 128.0), 0.9205007801678856, 1e-12);
    ck_assert_double_eq_tol(student_two_sided(2.5, 2.5), 0.1045699630781554, 1e-12);
    ck_assert_double_eq_tol(student_two_sided(-5.0, 30.0), 2.32966854670078e-05, 1e-15);
    ck_assert_double_eq_tol(student_two_sided(12.0, 128.0) * 1e22, 1.0757144645018564, 1e-9);
    ck_assert(student_two_sided(0.0, 3.0) == 1.0 && student_two_sided(HUGE_VAL, 3.0) == 0.0);
    ck_assert_double_eq_tol(student_threshold(0.5, 1.0), 1.0, 1e-12);
    ck_assert_double_eq_tol(student_threshold(0.05, 2.0), 4.302652729749464, 1e-9); /* 0.95 sqrt(2 / (1 - 0.95^2)) */
    ck_assert_double_eq_tol(student_two_sided(student_threshold(1e-9, 7.0), 7.0), 1e-9, 1e-20);
}
END_TEST

#define SIDE 160
#define HALF_VALUES (3 * SIDE * SIDE)

/* Skewed noise of mean `mean`, as in renderings: an exponential variable. With `grain` > 1, squares of grain x grain
 * pixels share a value, as with chains. */
static void half_fill(float *half, double mean, int grain, unsigned *state)
{
    for (int y = 0; y < SIDE; ++y) {
        for (int x = 0; x < SIDE; ++x) {
            for (int c = 0; c < 3; ++c) {
                size_t i = (size_t)(3 * (y * SIDE + x) + c);
                size_t first = (size_t)(3 * (y / grain * grain * SIDE + x / grain * grain) + c);
                half[i] = first == i ? (float)(-mean * log(1.0 - test_random_unit(state))) : half[first];
            }
        }
    }
}

/* Two renderings with means 1 and 1 + `difference` within a square of 40 pixels. */
static ZTest test_of_noise(double difference, int grain, unsigned seed)
{
    static float memory[4][HALF_VALUES];
    const float *const halves[2][2] = {{memory[0], memory[1]}, {memory[2], memory[3]}};
    ZTest test;
    Error error = {0};
    for (int i = 0; i < 4; ++i)
        half_fill(memory[i], 1.0, grain, &seed);
    for (int i = 2; i < 4; ++i)
        for (int y = 40; y < 80; ++y)
            for (int value = 3 * 40; value < 3 * 80; ++value)
                memory[i][3 * SIDE * y + value] += (float)difference;
    ck_assert(z_test_compute(halves, SIDE, SIDE, &test, &error));
    ck_assert_uint_eq(test.values, 1200);
    ck_assert_double_eq_tol(test.bound, 1.0 - pow(0.99, 1.0 / 1200.0), 1e-12);
    return test;
}

/* No difference is found if there is none, with and without correlation between pixels, and an existing one is found.
 * Deterministic, since seeds are fixed; one in a hundred other seeds would have a value outside. */
START_TEST(test_halves)
{
    ZTest same = test_of_noise(0.0, 1, 1);
    ck_assert(same.passed && same.outside == 0);
    ck_assert_double_eq_tol(same.below_5_percent, 0.05, 0.03);
    ck_assert_double_eq_tol(same.correlation, 1.0, 0.15);
    ZTest grainy = test_of_noise(0.0, 3, 2);
    ck_assert(grainy.passed && grainy.outside == 0);
    ck_assert_double_eq_tol(grainy.correlation, 9.0, 3.0);
    ZTest other = test_of_noise(1.0, 1, 3);
    ck_assert(!other.passed && other.outside >= 60 && other.least < 1e-6);
    ck_assert_msg(other.outside <= 75, "values beyond the 25 tiles that differ: %zu", other.outside);
}
END_TEST

/* A pixel at a light's edge that both halves of one rendering hit by chance and both of the other missed: a single
 * observation, not a difference. */
START_TEST(test_halves_one_pixel)
{
    static float memory[4][HALF_VALUES];
    const float *const halves[2][2] = {{memory[0], memory[1]}, {memory[2], memory[3]}};
    unsigned seed = 4;
    ZTest test;
    Error error = {0};
    for (int i = 0; i < 4; ++i)
        half_fill(memory[i], 1.0, 1, &seed);
    for (int i = 0; i < 2; ++i)
        memory[i][3 * (50 * SIDE + 50)] = 200.0f + (float)i;
    ck_assert(z_test_compute(halves, SIDE, SIDE, &test, &error));
    ck_assert_msg(test.outside == 0, "values outside: %zu, least %g", test.outside, test.least);
}
END_TEST

/* Without noise every difference counts, and equal images leave nothing to test. */
START_TEST(test_halves_without_noise)
{
    float a[3 * 64], b[3 * 64];
    for (int i = 0; i < 3 * 64; ++i)
        a[i] = b[i] = 0.75f;
    const float *const equal[2][2] = {{a, a}, {b, b}};
    ZTest test;
    Error error = {0};
    ck_assert(z_test_compute(equal, 8, 8, &test, &error));
    ck_assert(test.passed && test.values == 0);
    for (int i = 0; i < 3 * 64; ++i)
        b[i] = 0.76f;
    ck_assert(z_test_compute(equal, 8, 8, &test, &error));
    ck_assert(!test.passed && test.values == 3 && test.outside == 3);
}
END_TEST

/* ---- files ------------------------------------------------------------------------------------------------------ */

static void layered_write(const char *path, const float *rgb, const float *a, const float *b)
{
    const ExrChannel channels[] = {
        {"R", rgb, 3, false},     {"G", rgb + 1, 3, false},     {"B", rgb + 2, 3, false},
        {"halfA.R", a, 3, false}, {"halfA.G", a + 1, 3, false}, {"halfA.B", a + 2, 3, false},
        {"halfB.R", b, 3, false}, {"halfB.G", b + 1, 3, false}, {"halfB.B", b + 2, 3, false}};
    Error error = {0};
    ck_assert_msg(exr_write(path, channels, b ? 9 : 6, 2, 1, &error), "%s", error.message);
}

START_TEST(test_layers_read)
{
    const float rgb[] = {1, 2, 3, 4, 5, 6}, a[] = {7, 8, 9, 10, 11, 12}, b[] = {0, -1, -2, -3, -4, -5};
    Rendering rendering;
    Error error = {0};
    layered_write(test_path("both.exr"), rgb, a, b);
    ck_assert_msg(rendering_load(test_path("both.exr"), &rendering, &error), "%s", error.message);
    ck_assert(rendering_has_halves(&rendering) && rendering.width == 2 && rendering.height == 1);
    ck_assert_mem_eq(rendering.rgb, rgb, sizeof rgb);
    ck_assert_mem_eq(rendering.halves[0], a, sizeof a);
    ck_assert_mem_eq(rendering.halves[1], b, sizeof b);
    rendering_destroy(&rendering);
    layered_write(test_path("one.exr"), rgb, a, NULL);
    ck_assert(rendering_load(test_path("one.exr"), &rendering, &error) && error.message[0] == '\0');
    ck_assert(!rendering_has_halves(&rendering) && rendering.halves[0]);
    rendering_destroy(&rendering);
    ck_assert(!rendering_load(test_path("none.exr"), &rendering, &error) && error.message[0] != '\0');
}
END_TEST

START_TEST(test_side_by_side)
{
    const float image[] = {0.25f, 0.25f, 0.25f, 1.0f, 0.0f, 0.0f},
                reference[] = {0.25f, 0.25f, 0.25f, 0.0f, 0.5f, 0.5f};
    Error error = {0};
    Image sheet;
    ck_assert_msg(error_image_side_by_side(test_path("s.png"), image, reference, 2, 1, 2.0, &error), "%s",
                  error.message);
    ck_assert(image_read(test_path("s.png"), &sheet, &error));
    /* Images of 2 x 1 pixels between margins of 6, below a label line of 14: their first pixels are 8 apart. */
    const unsigned char *row = (const unsigned char *)sheet.data + (size_t)(6 + 14) * (size_t)sheet.width * 3;
    const unsigned char *first = row + 3 * 6, *second = row + 3 * 14, *third = row + 3 * 22;
    ck_assert_int_eq(sheet.width, 6 + 3 * 8);
    ck_assert(first[0] == 255 && first[3] == 255 && first[4] == 0);
    ck_assert(second[0] == 255 && second[3] == 0 && second[4] == 255);
    ck_assert(third[0] == 0 && third[1] == 0 && third[2] == 0);
    image_destroy(&sheet);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("compare");
    TCase *tcase = tcase_create("compare");
    tcase_add_checked_fixture(tcase, test_folder_make, test_folder_remove);
    tcase_add_test(tcase, test_reference_programs);
    tcase_add_test(tcase, test_display_limits);
    tcase_add_test(tcase, test_student);
    tcase_add_test(tcase, test_halves);
    tcase_add_test(tcase, test_halves_one_pixel);
    tcase_add_test(tcase, test_halves_without_noise);
    tcase_add_test(tcase, test_layers_read);
    tcase_add_test(tcase, test_side_by_side);
    suite_add_tcase(suite, tcase);
    return test_run(suite);
}
