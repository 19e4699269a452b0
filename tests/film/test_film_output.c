/* Output files: EXR, PNG, as a whole and in bands. */
#include "support/test_files.h"
#include "film/test_film.h"

#include "image/color.h"
#include "image/despeckle.h"
#include "image/exr.h"
#include "image/png_write.h"
#include "image/read.h"
#include "math/platform.h"
#include "render/picture.h"

#include <openexr.h>
#include <sys/stat.h>
#include <unistd.h>

#define WIDTH 37
#define HEIGHT 21

/* Every class of float, and noise. */
static void picture_fill(float *rgb)
{
    const float special[] = {0.0f, -0.0f, 1e-45f, 1e-38f, 3.4e38f, INFINITY, -INFINITY, 65504.0f, -2.5f};
    unsigned state = 7;
    for (size_t i = 0; i < 3 * WIDTH * HEIGHT; ++i)
        rgb[i] = i < 9 ? special[i] : (float)(test_random_unit(&state) * 2.0);
}

static bool rgb_write(const char *path, const float *rgb, int width, int height, const int *crop, Error *error)
{
    const ExrChannel channels[] = {{"R", rgb, 3, false}, {"G", rgb + 1, 3, false}, {"B", rgb + 2, 3, false}};
    const ExrAttribute attributes[] = {exr_whole("seed", 4294967296u), exr_whole("n", 7),
                                       exr_text("software", "twinlight"), exr_text("scene", "a b\xc3\xa4")};
    ExrPicture picture = {.channels = channels,
                          .channel_count = 3,
                          .width = width,
                          .height = height,
                          .crop = {0, 0, width, height},
                          .attributes = attributes,
                          .attribute_count = 4};
    if (crop)
        memcpy(picture.crop, crop, sizeof picture.crop);
    return exr_write_picture(path, &picture, error);
}

START_TEST(test_exr_keeps_every_bit)
{
    float rgb[3 * WIDTH * HEIGHT];
    Error error = {0};
    Image image;
    picture_fill(rgb);
    ck_assert_msg(rgb_write(test_path("a.exr"), rgb, WIDTH, HEIGHT, NULL, &error), "%s", error.message);
    ck_assert_msg(image_read(test_path("a.exr"), &image, &error), "%s", error.message);
    ck_assert_int_eq(image.width, WIDTH);
    ck_assert_int_eq(image.height, HEIGHT);
    ck_assert_int_eq(image.channels, 3);
    ck_assert(image.is_float && !image.srgb_encoded);
    ck_assert_mem_eq(image.data, rgb, sizeof rgb);
    image_destroy(&image);
}
END_TEST

/* Random bits with a few zeros compress to slightly more or less than their size. Among thousands of chunks, some keep
 * exactly their size; OpenEXR before 3.4.8 writes these so that no reader understands them. */
START_TEST(test_exr_noise)
{
    enum { SIDE = 16, LINES = 16 * 2000 };
    size_t count = (size_t)SIDE * LINES;
    float *noise = malloc(count * sizeof *noise);
    Error error = {0};
    Image image;
    unsigned state = 11;
    ck_assert_ptr_nonnull(noise);
    for (size_t i = 0; i < count; ++i) {
        uint bits = (uint)(test_random_unit(&state) * 65536.0) << 16 | (uint)(test_random_unit(&state) * 65536.0);
        bool zero = i % (SIDE * 16) < i / (SIDE * 16) % 32;
        noise[i] = zero ? 0.0f : bits_float((bits & 0x7f800000u) == 0x7f800000u ? bits ^ 0x00800000u : bits);
    }
    const ExrChannel channels[] = {{"Y", noise, 1, false}};
    ck_assert_msg(exr_write(test_path("n.exr"), channels, 1, SIDE, LINES, &error), "%s", error.message);
    ck_assert_msg(image_read(test_path("n.exr"), &image, &error), "%s", error.message);
    ck_assert_int_eq(image.channels, 1);
    ck_assert_mem_eq(image.data, noise, count * sizeof *noise);
    image_destroy(&image);
    free(noise);
}
END_TEST

static void files_compare(const char *path_a, const char *path_b)
{
    size_t sizes[2];
    unsigned char *a = test_file_read(path_a, &sizes[0]), *b = test_file_read(path_b, &sizes[1]);
    ck_assert_uint_eq(sizes[0], sizes[1]);
    ck_assert_mem_eq(a, b, sizes[0]);
    free(a);
    free(b);
}

START_TEST(test_exr_bytes_are_reproducible)
{
    float rgb[3 * WIDTH * HEIGHT];
    Error error;
    picture_fill(rgb);
    ck_assert(rgb_write(test_path("a.exr"), rgb, WIDTH, HEIGHT, NULL, &error));
    sleep(1); /* a time stamp would differ */
    ck_assert(rgb_write(test_path("b.exr"), rgb, WIDTH, HEIGHT, NULL, &error));
    files_compare(test_path("a.exr"), test_path("b.exr"));
    ck_assert_int_eq(test_folder_entries(), 2);
}
END_TEST

/* The crop window is the data window, the film the display window. */
START_TEST(test_exr_crop)
{
    const int crop[4] = {5, 3, 5 + WIDTH, 3 + HEIGHT};
    float rgb[3 * WIDTH * HEIGHT];
    Error error;
    Image image;
    picture_fill(rgb);
    ck_assert(rgb_write(test_path("crop.exr"), rgb, 100, 50, crop, &error));
    ck_assert(image_read(test_path("crop.exr"), &image, &error));
    ck_assert_int_eq(image.width, WIDTH);
    ck_assert_mem_eq(image.data, rgb, sizeof rgb);
    image_destroy(&image);
    exr_context_t context = NULL;
    exr_attr_box2i_t display, data;
    const char *text = NULL;
    ck_assert_int_eq(exr_start_read(&context, test_path("crop.exr"), NULL), EXR_ERR_SUCCESS);
    exr_get_display_window(context, 0, &display);
    exr_get_data_window(context, 0, &data);
    exr_attr_get_string(context, 0, "software", NULL, &text);
    ck_assert_int_eq(display.max.x, 99);
    ck_assert_int_eq(display.max.y, 49);
    ck_assert_int_eq(data.min.x, 5);
    ck_assert_int_eq(data.min.y, 3);
    ck_assert_int_eq(data.max.x, 4 + WIDTH);
    ck_assert_int_eq(data.max.y, 2 + HEIGHT);
    ck_assert_str_eq(text, "twinlight");
    exr_finish(&context);
}
END_TEST

/* Numbers and matrices in a header have their own types; an integer that EXR has none for is text. */
START_TEST(test_exr_attribute_types)
{
    float rgb[3 * WIDTH * HEIGHT], matrix[16];
    for (int i = 0; i < 16; ++i)
        matrix[i] = (float)i;
    picture_fill(rgb);
    const ExrChannel channels[] = {{"R", rgb, 3, false}, {"G", rgb + 1, 3, false}, {"B", rgb + 2, 3, false}};
    const ExrAttribute attributes[] = {exr_whole("samples", 2147483647u), exr_whole("seed", 2147483648u),
                                       exr_real("time", 0.5), exr_matrix("worldToCamera", matrix)};
    Error error;
    const ExrPicture picture = {.channels = channels,
                                .channel_count = 3,
                                .width = WIDTH,
                                .height = HEIGHT,
                                .crop = {0, 0, WIDTH, HEIGHT},
                                .attributes = attributes,
                                .attribute_count = 4};
    ck_assert(exr_write_picture(test_path("types.exr"), &picture, &error));
    exr_context_t context = NULL;
    int32_t whole = 0;
    float real = 0.0f;
    exr_attr_m44f_t m;
    const char *text = NULL;
    ck_assert_int_eq(exr_start_read(&context, test_path("types.exr"), NULL), EXR_ERR_SUCCESS);
    ck_assert_int_eq(exr_attr_get_int(context, 0, "samples", &whole), EXR_ERR_SUCCESS);
    ck_assert_int_eq(whole, 2147483647);
    ck_assert_int_eq(exr_attr_get_string(context, 0, "seed", NULL, &text), EXR_ERR_SUCCESS);
    ck_assert_str_eq(text, "2147483648");
    ck_assert_int_eq(exr_attr_get_float(context, 0, "time", &real), EXR_ERR_SUCCESS);
    ck_assert_float_eq(real, 0.5f);
    ck_assert_int_eq(exr_attr_get_m44f(context, 0, "worldToCamera", &m), EXR_ERR_SUCCESS);
    for (int row = 0; row < 4; ++row)
        for (int column = 0; column < 4; ++column)
            ck_assert_float_eq(m.m[4 * column + row], matrix[4 * row + column]);
    exr_finish(&context);
}
END_TEST

/* Layers, given out of order, with different strides, as halves. */
START_TEST(test_exr_layers)
{
    float data[4 * WIDTH * HEIGHT];
    Error error = {0};
    Image image;
    for (int i = 0; i < 4 * WIDTH * HEIGHT; ++i)
        data[i] = (float)(i % 2048) + (i == 0 ? 1e6f : 0.0f);
    const ExrChannel channels[] = {{"direct.R", data, 1, false},
                                   {"R", data, 4, true},
                                   {"B", data + 2, 4, true},
                                   {"G", data + 1, 4, true},
                                   {"A", data + 3, 4, false}};
    ck_assert_msg(exr_write(test_path("l.exr"), channels, 5, WIDTH, HEIGHT, &error), "%s", error.message);
    ck_assert_msg(image_read(test_path("l.exr"), &image, &error), "%s", error.message);
    ck_assert_int_eq(image.channels, 4);
    for (size_t i = 0; i < 4 * WIDTH * HEIGHT; ++i)
        TEST_NEAR(image_value(&image, i), i == 0 ? 65504.0f : data[i], 0.0);
    image_destroy(&image);
    const ExrChannel twice[] = {{"R", data, 1, false}, {"R", data, 1, false}};
    ck_assert(!exr_write(test_path("t.exr"), twice, 2, WIDTH, HEIGHT, &error));
    ck_assert_ptr_nonnull(strstr(error.message, "two channels are named \"R\""));
    ck_assert_int_eq(test_folder_entries(), 1);
}
END_TEST

/* A picture in bands, as a lane of ExrPicture sees it. */
typedef struct Banded {
    const float *whole; /* RGB */
    float band[3 * WIDTH * EXR_BAND_ROWS];
    float plane[3 * WIDTH * EXR_BAND_ROWS];
    ExrChannel channels[3];
    int bands; /* made by this lane */
} Banded;

static void band_copy(void *context, int first, int count)
{
    Banded *banded = context;
    memcpy(banded->band, banded->whole + 3 * WIDTH * first, 3 * WIDTH * (size_t)count * sizeof(float));
    ++banded->bands;
    if (first % (2 * EXR_BAND_ROWS) == 0) /* let others overtake */
        usleep(2000);
}

/* Several threads write the same bytes as one, also for a data window that does not begin in the first row. */
START_TEST(test_exr_lanes)
{
    enum { ROWS = 9 * EXR_BAND_ROWS + 3, LANES = 3 };
    static float rgb[3 * WIDTH * ROWS];
    static Banded banded[LANES];
    ExrLane lanes[LANES];
    Error error = {0};
    int bands = 0;
    unsigned state = 9;
    for (size_t i = 0; i < 3 * WIDTH * ROWS; ++i)
        rgb[i] = (float)test_random_unit(&state);
    const ExrChannel channels[] = {{"R", rgb, 3, false}, {"G", rgb + 1, 3, true}, {"B", rgb + 2, 3, false}};
    ExrPicture picture = {
        .channels = channels, .channel_count = 3, .width = WIDTH, .height = ROWS + 7, .crop = {0, 7, WIDTH, ROWS + 7}};
    ck_assert_msg(exr_write_picture(test_path("one.exr"), &picture, &error), "%s", error.message);
    for (int i = 0; i < LANES; ++i) {
        banded[i].whole = rgb;
        for (int c = 0; c < 3; ++c)
            banded[i].channels[c] = (ExrChannel){channels[c].name, banded[i].band + c, 3, channels[c].half};
        lanes[i] = (ExrLane){banded[i].channels, &banded[i], banded[i].plane};
    }
    picture.band = band_copy;
    picture.lanes = lanes;
    picture.lane_count = LANES;
    ck_assert_msg(exr_write_picture(test_path("three.exr"), &picture, &error), "%s", error.message);
    files_compare(test_path("one.exr"), test_path("three.exr"));
    for (int i = 0; i < LANES; ++i)
        bands += banded[i].bands;
    ck_assert_int_eq(bands, 10);
}
END_TEST

/* Bands equal the rows of the whole image, in every layer, at every band's edge. */
START_TEST(test_bands)
{
    enum { ROWS = 2 * EXR_BAND_ROWS + 5 };
    const int crop[4] = {2, 1, 2 + WIDTH, 1 + ROWS};
    static float rgb[3 * WIDTH * ROWS], despeckled[3 * WIDTH * ROWS];
    RenderLayers layers = {.wanted = LAYER_BIT(LAYER_ALBEDO)};
    const PictureSettings settings = {.scale = 4.0f, .despeckle = 1.5, .layers = &layers};
    PictureMemory memory;
    Picture picture;
    Film film;
    Error error;
    unsigned state = 5;
    ck_assert(film_init(&film, WIDTH + 9, ROWS + 9, crop, &error) &&
              aov_image_init(&layers.aovs[AOV_ALBEDO], &film, (AovKind){.channels = 3}, NULL, &error));
    for (size_t i = 0; i < 3 * WIDTH * ROWS; ++i) {
        film.sums[i] = 2 * (int64_t)(test_random_unit(&state) * 0x1p31);
        layers.aovs[AOV_ALBEDO].sums[i] = (float)test_random_unit(&state);
        film.counts[i / 3] = layers.aovs[AOV_ALBEDO].counts[i / 3] = (unsigned char)(i / 3 % 4);
    }
    film_resolve(&film, 4.0f, rgb);
    despeckle(rgb, WIDTH, ROWS, 0, ROWS, 1.5f, despeckled);
    ck_assert_uint_eq(film_empty_pixels(&film), (WIDTH * ROWS + 3) / 4);
    ck_assert(picture_memory_init(&memory, &settings, WIDTH, ROWS, 5, 2, &error));
    picture_init(&picture, &settings, &film, &memory, 1);
    ck_assert_uint_eq(picture.group_count, 3);
    for (int y = 0; y < ROWS; y += EXR_BAND_ROWS) {
        int count = ROWS - y < EXR_BAND_ROWS ? ROWS - y : EXR_BAND_ROWS;
        size_t bytes = 3 * WIDTH * (size_t)count * sizeof *rgb;
        picture_band(&picture, y, count);
        ck_assert_mem_eq(picture.channels[0].data, rgb + 3 * WIDTH * y, bytes);
        ck_assert_mem_eq(picture.groups[2].values, despeckled + 3 * WIDTH * y, bytes);
        for (int i = 0; i < 3 * WIDTH * count; ++i) {
            int value = 3 * WIDTH * y + i, samples = value / 3 % 4;
            ck_assert(picture.groups[1].values[i] ==
                      (samples > 0 ? layers.aovs[AOV_ALBEDO].sums[value] / (float)samples : 0.0f));
        }
    }
    ck_assert_mem_eq(picture_row(&picture, ROWS - 1), rgb + 3 * WIDTH * (ROWS - 1), 3 * WIDTH * sizeof *rgb);
    picture_memory_destroy(&memory);
    aov_image_destroy(&layers.aovs[AOV_ALBEDO]);
    film_destroy(&film);
}
END_TEST

START_TEST(test_unwritable)
{
    float rgb[3 * WIDTH * HEIGHT] = {0};
    Error error;
    ck_assert(!rgb_write("no/such/folder/a.exr", rgb, WIDTH, HEIGHT, NULL, &error));
    ck_assert_str_eq(error.message, "error: cannot write no/such/folder/a.exr: No such file or directory");
    ck_assert(!png_write("no/such/folder/a.png", rgb, WIDTH, HEIGHT, 0.0f, &error));
    ck_assert_str_eq(error.message, "error: cannot write no/such/folder/a.png: No such file or directory");
    ck_assert(!rgb_write(test_folder, rgb, WIDTH, HEIGHT, NULL, &error));
    ck_assert_ptr_nonnull(strstr(error.message, "Is a directory"));
    /* A device that is always full: written directly, reported as an error, and still a device afterwards. */
    struct stat status;
    if (stat("/dev/full", &status) != 0)
        return;
    ck_assert(!rgb_write("/dev/full", rgb, WIDTH, HEIGHT, NULL, &error));
    ck_assert_str_eq(error.message, "error: cannot write /dev/full: No space left on device");
    ck_assert(!png_write("/dev/full", rgb, WIDTH, HEIGHT, 0.0f, &error));
    ck_assert_str_eq(error.message, "error: cannot write /dev/full: No space left on device");
    ck_assert(stat("/dev/full", &status) == 0 && S_ISCHR(status.st_mode));
}
END_TEST

START_TEST(test_png)
{
    const float rgb[] = {0.0f, 1.0f, 0.5f, -1.0f, 7.0f, NAN, 0.25f, 0.001f, 0.125f, INFINITY, -INFINITY, 1e-45f};
    const unsigned char expected[] = {0, 255, 188, 0, 255, 0, 137, 3, 99, 255, 0, 0};
    const unsigned char brighter[] = {0, 255, 255, 0, 255, 0, 188, 7, 137, 255, 0, 0};
    Error error = {0};
    Image image;
    ck_assert_msg(png_write(test_path("a.png"), rgb, 2, 2, 0.0f, &error), "%s", error.message);
    ck_assert_msg(image_read(test_path("a.png"), &image, &error), "%s", error.message);
    ck_assert(!image.is_float && image.srgb_encoded && image.channels == 3 && image.width == 2);
    ck_assert_mem_eq(image.data, expected, sizeof expected);
    image_destroy(&image);
    ck_assert(png_write(test_path("a.png"), rgb, 2, 2, 1.0f, &error));
    ck_assert(image_read(test_path("a.png"), &image, &error));
    ck_assert_mem_eq(image.data, brighter, sizeof brighter);
    image_destroy(&image);
}
END_TEST

START_TEST(test_srgb_function)
{
    /* IEC 61966-2-1: the two branches meet, the end points are fixed, the functions are inverses. */
    ck_assert_double_eq_tol(color_srgb_decode(0.04045), 0.0031308, 1e-7);
    ck_assert_double_eq(color_srgb_decode(0.0), 0.0);
    ck_assert_double_eq_tol(color_srgb_decode(1.0), 1.0, 1e-15);
    ck_assert_double_eq_tol(color_srgb_decode(0.5), 0.21404114048, 1e-10);
    for (double x = -2.0; x < 2.0; x += 0.01)
        TEST_NEAR(color_srgb_decode(color_srgb_encode(x)), x, 1e-7);
}
END_TEST

TCase *film_output_tcase(void)
{
    TCase *tcase = tcase_create("output");
    tcase_add_checked_fixture(tcase, test_folder_make, test_folder_remove);
    tcase_add_test(tcase, test_exr_keeps_every_bit);
    tcase_add_test(tcase, test_exr_noise);
    tcase_add_test(tcase, test_exr_bytes_are_reproducible);
    tcase_add_test(tcase, test_exr_crop);
    tcase_add_test(tcase, test_exr_attribute_types);
    tcase_add_test(tcase, test_exr_layers);
    tcase_add_test(tcase, test_exr_lanes);
    tcase_add_test(tcase, test_bands);
    tcase_add_test(tcase, test_unwritable);
    tcase_add_test(tcase, test_png);
    tcase_add_test(tcase, test_srgb_function);
    return tcase;
}
