#include "compare/print.h"

#include "base/json.h"

#include <math.h>
#include <stdio.h>

static void text_metrics(const Metrics *m)
{
    printf("MSE              %.6g\n", m->mse);
    printf("relMSE           %.6g\n", m->rel_mse);
    printf("relMSE trimmed   %.6g  (without the worst 0.1 %% of pixels)\n", m->rel_mse_trimmed);
    printf("relMSE 8 x 8     %.6g  (of the means of tiles of 8 x 8 pixels)\n", m->rel_mse_8x8);
    printf("MAPE             %.6g\n", m->mape);
    printf("SMAPE            %.6g\n", m->smape);
    printf("mean             %.6g  (RGB %.6g %.6g %.6g)\n", m->mean, m->mean_rgb[0], m->mean_rgb[1], m->mean_rgb[2]);
    printf("reference mean   %.6g  (RGB %.6g %.6g %.6g)\n", m->mean_reference, m->mean_reference_rgb[0],
           m->mean_reference_rgb[1], m->mean_reference_rgb[2]);
    printf("mean ratio       %.6g\n", m->mean / m->mean_reference);
    printf("blocks           %d x %d: largest relative difference %.4g %%, mean %.4g %%\n", m->blocks, m->blocks,
           100.0 * m->block_max, 100.0 * m->block_mean);
    printf("not finite       %zu pixels, reference %zu\n", m->not_finite, m->not_finite_reference);
}

static void text_display(const Comparison *comparison)
{
    printf("FLIP             %.6g  (exposure %g, %g pixels per degree)\n", comparison->display_error.flip,
           comparison->display.exposure, comparison->display.pixels_per_degree);
    if (isfinite(comparison->display_error.ssim))
        printf("SSIM             %.6g\n", comparison->display_error.ssim);
    else
        printf("SSIM             none: the pictures are smaller than its window, %d x %d pixels\n", SSIM_WINDOW,
               SSIM_WINDOW);
}

static void text_test(const ZTest *test)
{
    printf("z-test           %s: %zu of %zu means of tiles beyond probability %.3g, %.4g %% within; least %.3g\n",
           test->passed ? "no difference found" : "DIFFERENT", test->outside, test->values, test->bound,
           test->values > 0 ? 100.0 * (1.0 - (double)test->outside / (double)test->values) : 100.0, test->least);
    printf("                 %.3g %% below probability 5 %%; variance of tiles %.3g times that of independent pixels\n",
           100.0 * test->below_5_percent, test->correlation);
}

void comparison_print_text(const Comparison *comparison)
{
    printf("image            %s\nreference        %s\nsize             %d x %d\n", comparison->image,
           comparison->reference, comparison->width, comparison->height);
    text_metrics(&comparison->metrics);
    text_display(comparison);
    if (comparison->tested)
        text_test(&comparison->test);
    else
        printf("z-test           none: it needs layers halfA and halfB in both files\n");
}

static void json_rgb(JsonWriter *json, const char *key, const double rgb[3])
{
    json_array_begin(json, key);
    for (int c = 0; c < 3; ++c)
        json_number(json, NULL, rgb[c]);
    json_array_end(json);
}

static void json_metrics(JsonWriter *json, const Metrics *m)
{
    json_number(json, "mse", m->mse);
    json_number(json, "rel_mse", m->rel_mse);
    json_number(json, "rel_mse_trimmed", m->rel_mse_trimmed);
    json_number(json, "rel_mse_8x8", m->rel_mse_8x8);
    json_number(json, "mape", m->mape);
    json_number(json, "smape", m->smape);
    json_number(json, "mean", m->mean);
    json_number(json, "mean_reference", m->mean_reference);
    json_rgb(json, "mean_rgb", m->mean_rgb);
    json_rgb(json, "mean_reference_rgb", m->mean_reference_rgb);
    json_signed(json, "blocks", m->blocks);
    json_number(json, "block_max", m->block_max);
    json_number(json, "block_mean", m->block_mean);
    json_unsigned(json, "not_finite", m->not_finite);
    json_unsigned(json, "not_finite_reference", m->not_finite_reference);
}

static void json_test(JsonWriter *json, const ZTest *test)
{
    json_object_begin(json, "z_test");
    json_bool(json, "passed", test->passed);
    json_unsigned(json, "values", test->values);
    json_unsigned(json, "outside", test->outside);
    json_number(json, "bound", test->bound);
    json_number(json, "least", test->least);
    json_number(json, "below_5_percent", test->below_5_percent);
    json_number(json, "correlation", test->correlation);
    json_object_end(json);
}

void comparison_print_json(const Comparison *comparison)
{
    JsonWriter json;
    json_init(&json, stdout);
    json_object_begin(&json, NULL);
    json_text(&json, "image", comparison->image);
    json_text(&json, "reference", comparison->reference);
    json_signed(&json, "width", comparison->width);
    json_signed(&json, "height", comparison->height);
    json_metrics(&json, &comparison->metrics);
    json_number(&json, "flip", comparison->display_error.flip);
    json_number(&json, "ssim", comparison->display_error.ssim);
    json_number(&json, "exposure", comparison->display.exposure);
    json_number(&json, "pixels_per_degree", comparison->display.pixels_per_degree);
    if (comparison->tested)
        json_test(&json, &comparison->test);
    else
        json_text(&json, "z_test", NULL);
    json_object_end(&json);
}
