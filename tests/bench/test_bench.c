/* Internals of `twinlight bench`. */
#include "support/test_files.h"
#include "support/test_util.h"

#include "base/sample_statistics.h"
#include "bench/html.h"
#include "bench/record.h"
#include "bench/svg_chart.h"

START_TEST(test_quantiles)
{
    /* numpy.quantile([3, 1, 4, 1.5, 9], q), whose default method is the same. */
    double values[] = {3.0, 1.0, 4.0, 1.5, 9.0};
    ck_assert_double_eq_tol(sample_quantile(values, 5, 0.1), 1.2, 1e-12);
    ck_assert_double_eq_tol(sample_quantile(values, 5, 0.5), 3.0, 1e-12);
    ck_assert_double_eq_tol(sample_quantile(values, 5, 0.9), 7.0, 1e-12);
    ck_assert_double_eq(sample_quantile(values, 5, 1.0), 9.0);
    ck_assert_double_eq(sample_quantile(values, 1, 0.9), 1.0);
    ck_assert(isnan(sample_quantile(values, 0, 0.5)));
}
END_TEST

START_TEST(test_order_of_nan)
{
    double values[] = {(double)NAN, 3.0, (double)NAN, -1.0, (double)INFINITY, (double)NAN, 2.0};
    sample_sort(values, 7);
    ck_assert(values[0] == -1.0 && values[1] == 2.0 && values[2] == 3.0 && isinf(values[3]));
    ck_assert(isnan(values[4]) && isnan(values[5]) && isnan(values[6]));
}
END_TEST

START_TEST(test_lines)
{
    /* By hand: means 2 and 3, sums of squares 5 and of products 4, residuals -0.2 0.6 -0.6 0.2. */
    const double x[] = {0.5, 1.5, 2.5, 3.5}, y[] = {1.6, 3.2, 2.8, 4.4};
    SampleLine line = sample_line(x, y, 4);
    ck_assert_double_eq_tol(line.slope, 0.8, 1e-12);
    ck_assert_double_eq_tol(line.intercept, 1.4, 1e-12);
    ck_assert_double_eq_tol(line.slope_error, sqrt(0.8 / 2.0 / 5.0), 1e-12);
    line = sample_line(x, y, 2);
    ck_assert(fabs(line.slope - 1.6) < 1e-12 && isnan(line.slope_error));
    ck_assert(isnan(sample_line(x, y, 1).slope));
    const double same[] = {1.0, 1.0};
    ck_assert(isnan(sample_line(same, y, 2).slope));
}
END_TEST

static SampleMoments moments_of(const double *values, size_t count)
{
    SampleMoments moments = {0};
    for (size_t i = 0; i < count; ++i)
        sample_moments_add(&moments, values[i]);
    return moments;
}

START_TEST(test_r_hat)
{
    /* By hand: variances 1 and 1, means 2 and 3 with variance 1/2: sqrt(2/3 + 1/2). */
    const double a[] = {1.0, 2.0, 3.0}, b[] = {2.0, 3.0, 4.0}, c[] = {7.0, 1.0, 4.0, 0.0, 3.0};
    SampleMoments groups[4] = {moments_of(a, 3), moments_of(b, 3), moments_of(c, 5), moments_of(a, 1)};
    ck_assert_double_eq_tol(groups[2].mean, 3.0, 1e-15);
    ck_assert_double_eq_tol(groups[2].squares, 30.0, 1e-12);
    ck_assert_double_eq_tol(sample_r_hat(groups, 2), sqrt(7.0 / 6.0), 1e-12);
    /* With the third group: W = (1 + 1 + 7.5) / 3, means 2, 3, 3 with variance 1/3, n = 11/3. A single draw is no
     * group. */
    ck_assert_double_eq_tol(sample_r_hat(groups, 3), sqrt(8.0 / 11.0 + (1.0 / 3.0) / (9.5 / 3.0)), 1e-12);
    ck_assert_double_eq(sample_r_hat(groups, 4), sample_r_hat(groups, 3));
    ck_assert(isnan(sample_r_hat(groups, 1)) && isnan(sample_r_hat(groups + 2, 2)));
    const double ones[] = {1.0, 1.0}, twos[] = {2.0, 2.0};
    const SampleMoments same[] = {moments_of(ones, 2), moments_of(ones, 2)};
    const SampleMoments stuck[] = {moments_of(ones, 2), moments_of(twos, 2)};
    ck_assert(isnan(sample_r_hat(same, 2)) && isinf(sample_r_hat(stuck, 2)));
}
END_TEST

static void number_is(double value, int digits, const char *expected)
{
    char text[64];
    html_number_text(text, sizeof text, value, digits);
    ck_assert_str_eq(text, expected);
}

START_TEST(test_numbers)
{
    number_is(0.0, 3, "0");
    number_is(1.0, 3, "1.00");
    number_is(-0.98765, 3, "\u22120.988");
    number_is(0.0012345, 3, "0.00123");
    number_is(0.00012345, 3, "1.23\u00d710\u207b\u2074");
    number_is(123456.0, 3, "123000");
    number_is(12345678.0, 3, "1.23\u00d710\u2077");
    number_is(0.09996, 3, "0.100");
    number_is(NAN, 3, "\u2013");
    number_is(-HUGE_VAL, 3, "\u2013");
}
END_TEST

/* Closes the memory stream and checks the text written to it. */
static void stream_is(const char *expected, FILE *stream, char **text)
{
    fclose(stream);
    ck_assert_str_eq(*text, expected);
    free(*text);
}

START_TEST(test_text)
{
    char *text;
    size_t size;
    FILE *stream = open_memstream(&text, &size);
    html_text(stream, "a < b & \"c\" > d\n\x01");
    stream_is("a &lt; b &amp; &quot;c&quot; &gt; d  ", stream, &text);
    /* RFC 4648, section 10. */
    static const char *const VECTORS[][2] = {
        {"", ""}, {"f", "Zg=="}, {"fo", "Zm8="}, {"foo", "Zm9v"}, {"foob", "Zm9vYg=="}};
    for (size_t i = 0; i < sizeof VECTORS / sizeof VECTORS[0]; ++i) {
        char expected[64];
        snprintf(expected, sizeof expected, "data:image/png;base64,%s", VECTORS[i][1]);
        stream = open_memstream(&text, &size);
        html_png(stream, (const unsigned char *)VECTORS[i][0], strlen(VECTORS[i][0]));
        stream_is(expected, stream, &text);
    }
}
END_TEST

START_TEST(test_records)
{
    BenchRecord record = {.seconds = 1.25, .ray_seconds = 1.0 / 3.0, .samples = UINT64_MAX, .threads = 3}, read;
    Error error = {0};
    strcpy(record.device, "a device, with words");
    record.chains.steps = 7;
    record.chains.weights[2] = 0.1;
    record.chains.proposals[1][31] = 9;
    record.chains.accepted[1][31] = 4;
    record.chains.longest_run[31] = 65535;
    record.chains.starts[31] = 40;
    record.chains.distinct_starts[31] = 30;
    record.chains.least_distinct = 0.3;
    record.chains.r_hat[31] = HUGE_VAL;
    const char *image = test_path("image.exr");
    ck_assert_msg(bench_record_write(image, &record, &error), "%s", error.message);
    ck_assert_msg(!bench_record_read(image, &read), "a record without an image");
    test_file_write(image, "x", 1);
    ck_assert(bench_record_read(image, &read));
    ck_assert_mem_eq(&read, &record, sizeof record);
    /* Every truncation of it is invalid. */
    size_t size;
    unsigned char *bytes = test_file_read(test_path("image.exr.record"), &size);
    for (size_t part = 0; part + 1 < size; part += 13) {
        test_file_write(test_path("image.exr.record"), bytes, part);
        ck_assert(!bench_record_read(image, &read));
    }
    free(bytes);
}
END_TEST

/* The number after the nth `name` in an element of the text. */
static double attribute(const char *text, const char *element, const char *name)
{
    const char *at = strstr(text, element);
    ck_assert_ptr_nonnull(at);
    at = strstr(at, name);
    ck_assert_ptr_nonnull(at);
    return atof(at + strlen(name));
}

/* On logarithmic axes, the points of a power law lie on a straight line, and the level line is at its value. */
START_TEST(test_chart)
{
    const ChartLine line = {.name = "a<b",
                            .note = "",
                            .count = 3,
                            .points = {{1.0, 1e-2, 1e-2, 1e-2}, {10.0, 1e-3, 1e-3, 1e-3}, {100.0, 1e-4, 1e-4, 1e-4}}};
    const Chart chart = {
        .title = "t", .x_label = "x", .y_label = "y", .level = 1e-3, .level_label = "l", .lines = &line, .count = 1};
    char *text;
    size_t size;
    FILE *stream = open_memstream(&text, &size);
    chart_write(stream, &chart);
    fclose(stream);
    double x[3], y[3];
    const char *path = strstr(text, "class=\"line\" d=\"M");
    ck_assert_ptr_nonnull(path);
    ck_assert_int_eq(
        sscanf(path, "class=\"line\" d=\"M%lf %lfL%lf %lfL%lf %lf", &x[0], &y[0], &x[1], &y[1], &x[2], &y[2]), 6);
    ck_assert_double_eq_tol(x[1] - x[0], x[2] - x[1], 0.11);
    ck_assert_double_eq_tol(y[1] - y[0], y[2] - y[1], 0.11);
    ck_assert(x[2] > x[0] + 100.0 && y[2] > y[0] + 100.0);
    ck_assert_double_eq_tol(attribute(text, "class=\"level\"", "y1=\""), y[1], 0.11);
    ck_assert_ptr_nonnull(strstr(text, "a&lt;b"));
    ck_assert_ptr_null(strstr(text, "nan"));
    free(text);
}
END_TEST

/* Axes over a small part of a decade, over many decades, and of a single value have labels, all with different
 * numbers. */
START_TEST(test_chart_numbers)
{
    static const double RANGES[][2] = {{0.35, 0.47}, {0.41, 0.43}, {0.9, 1.2}, {1e-5, 20.0}, {3.0, 3.0}, {61e3, 69e3}};
    const double low = RANGES[_i][0], high = RANGES[_i][1];
    const ChartLine line = {.name = "a", .count = 2, .points = {{1.0, low, low, low}, {1000.0, high, high, high}}};
    const Chart chart = {.title = "t", .x_label = "x", .y_label = "y", .level_label = "", .lines = &line, .count = 1};
    char *text, last[32] = "";
    size_t size;
    FILE *stream = open_memstream(&text, &size);
    chart_write(stream, &chart);
    fclose(stream);
    int numbers = 0;
    for (const char *at = text; (at = strstr(at, "text-anchor=\"end\">")) != NULL; ++numbers) {
        char number[32];
        at += strlen("text-anchor=\"end\">");
        snprintf(number, sizeof number, "%.*s", (int)strcspn(at, "<"), at);
        ck_assert_str_ne(number, last);
        strcpy(last, number);
    }
    ck_assert_msg(numbers >= 3 && numbers <= 14, "%d numbers from %g to %g", numbers, low, high);
    free(text);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("bench");
    TCase *tcase = tcase_create("bench");
    tcase_add_checked_fixture(tcase, test_folder_make, test_folder_remove);
    tcase_add_test(tcase, test_quantiles);
    tcase_add_test(tcase, test_order_of_nan);
    tcase_add_test(tcase, test_lines);
    tcase_add_test(tcase, test_r_hat);
    tcase_add_test(tcase, test_numbers);
    tcase_add_test(tcase, test_text);
    tcase_add_test(tcase, test_records);
    tcase_add_test(tcase, test_chart);
    tcase_add_loop_test(tcase, test_chart_numbers, 0, 6);
    suite_add_tcase(suite, tcase);
    return test_run(suite);
}
