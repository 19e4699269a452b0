/* Reading images: every format, and files that are truncated, damaged or state a wrong size. */
#include "support/test_files.h"
#include "support/test_util.h"

#include "image/exr.h"
#include "image/read.h"

#include <ImfCRgbaFile.h>
#include <openexr.h>
#include <stb_image_write.h>
#include <stdint.h>

TCase *texture_files_tcase(void);

#define WIDTH 45
#define HEIGHT 37

/* Smooth, so that lossy formats stay close; range 0.1 ... 0.9. */
static float smooth(int x, int y, int c)
{
    return 0.5f + 0.4f * sinf((float)x * 0.11f + (float)c) * cosf((float)y * 0.13f);
}

static void bytes_fill(unsigned char *bytes, int channels)
{
    for (int i = 0; i < WIDTH * HEIGHT; ++i)
        for (int c = 0; c < channels; ++c)
            bytes[i * channels + c] = (unsigned char)(255.0f * smooth(i % WIDTH, i / WIDTH, c));
}

static Image read_good(const char *path)
{
    Error error = {0};
    Image image;
    ck_assert_msg(image_read(path, &image, &error), "%s", error.message);
    return image;
}

static void read_bad(const char *path, const char *expected)
{
    Error error = {0};
    Image image;
    ck_assert_msg(!image_read(path, &image, &error), "%s was read", path);
    ck_assert_ptr_null(image.data);
    ck_assert_msg(strstr(error.message, path) != NULL, "%s", error.message);
    ck_assert_msg(strstr(error.message, expected) != NULL, "%s", error.message);
}

/* Compares with smooth(); `scale` is 255 for bytes. */
static void image_check(const char *path, int channels, bool is_float, double tolerance)
{
    Image image = read_good(path);
    ck_assert_int_eq(image.width, WIDTH);
    ck_assert_int_eq(image.height, HEIGHT);
    ck_assert_int_eq(image.channels, channels);
    ck_assert(image.is_float == is_float);
    for (int i = 0; i < WIDTH * HEIGHT; ++i)
        for (int c = 0; c < channels; ++c)
            TEST_NEAR(image_value(&image, (size_t)(i * channels + c)), smooth(i % WIDTH, i / WIDTH, c), tolerance);
    image_destroy(&image);
}

START_TEST(test_byte_formats)
{
    unsigned char bytes[4 * WIDTH * HEIGHT];
    bytes_fill(bytes, 3);
    stbi_write_png(test_path("a.png"), WIDTH, HEIGHT, 3, bytes, 3 * WIDTH);
    stbi_write_tga(test_path("a.tga"), WIDTH, HEIGHT, 3, bytes);
    stbi_write_jpg(test_path("a.jpg"), WIDTH, HEIGHT, 3, bytes, 98);
    image_check(test_path("a.png"), 3, false, 1.01 / 255.0);
    image_check(test_path("a.tga"), 3, false, 1.01 / 255.0);
    image_check(test_path("a.jpg"), 3, false, 0.03);
    bytes_fill(bytes, 1);
    stbi_write_png(test_path("g.png"), WIDTH, HEIGHT, 1, bytes, WIDTH);
    image_check(test_path("g.png"), 1, false, 1.01 / 255.0);
    bytes_fill(bytes, 4);
    stbi_write_png(test_path("rgba.png"), WIDTH, HEIGHT, 4, bytes, 4 * WIDTH);
    stbi_write_tga(test_path("rgba.TGA"), WIDTH, HEIGHT, 4, bytes);
    image_check(test_path("rgba.png"), 4, false, 1.01 / 255.0);
    image_check(test_path("rgba.TGA"), 3, false, 1.01 / 255.0);
}
END_TEST

static void pfm_make(const char *path, int channels, bool little, float factor)
{
    FILE *file = fopen(path, "wb");
    fprintf(file, "P%c\n%d %d\n%g\n", channels == 3 ? 'F' : 'f', WIDTH, HEIGHT,
            (double)(little ? -1.0f : 1.0f) * (double)factor);
    for (int y = HEIGHT - 1; y >= 0; --y) {
        for (int i = 0; i < WIDTH * channels; ++i) {
            float value = smooth(i / channels, y, i % channels) / factor;
            uint32_t bits;
            memcpy(&bits, &value, 4);
            for (int b = 0; b < 4; ++b)
                fputc((int)(bits >> (8 * (little ? b : 3 - b)) & 255u), file);
        }
    }
    fclose(file);
}

START_TEST(test_float_formats)
{
    float rgb[3 * WIDTH * HEIGHT];
    for (int i = 0; i < 3 * WIDTH * HEIGHT; ++i)
        rgb[i] = smooth(i / 3 % WIDTH, i / 3 / WIDTH, i % 3);
    stbi_write_hdr(test_path("a.hdr"), WIDTH, HEIGHT, 3, rgb);
    image_check(test_path("a.hdr"), 3, true, 0.005);
    pfm_make(test_path("a.pfm"), 3, true, 1.0f);
    image_check(test_path("a.pfm"), 3, true, 0.0);
    pfm_make(test_path("b.pfm"), 1, false, 4.0f);
    image_check(test_path("b.pfm"), 1, true, 0.0);
}
END_TEST

/* The kind of file that exr_make writes. */
typedef struct ExrKind {
    exr_compression_t compression;
    exr_pixel_type_t type;
    bool tiled;
} ExrKind;

static uint32_t exr_bits(float value, exr_pixel_type_t type)
{
    uint32_t bits;
    if (type == EXR_PIXEL_UINT)
        return (uint32_t)(value * 1000.0f);
    memcpy(&bits, &value, 4);
    return bits;
}

static exr_result_t exr_chunk_write(exr_context_t context, const ExrKind *kind, const exr_chunk_info_t *chunk, int x0,
                                    int y0)
{
    static uint32_t planes[3][WIDTH * HEIGHT];
    const int order[3] = {2, 1, 0}; /* B, G, R */
    exr_encode_pipeline_t encoder = EXR_ENCODE_PIPELINE_INITIALIZER;
    exr_encoding_initialize(context, 0, chunk, &encoder);
    for (int c = 0; c < 3; ++c) {
        exr_coding_channel_info_t *info = &encoder.channels[c];
        for (int y = 0; y < chunk->height; ++y)
            for (int x = 0; x < chunk->width; ++x)
                planes[c][y * chunk->width + x] = exr_bits(smooth(x0 + x, y0 + y, order[c]), kind->type);
        info->user_data_type = kind->type == EXR_PIXEL_UINT ? EXR_PIXEL_UINT : EXR_PIXEL_FLOAT;
        info->user_bytes_per_element = 4;
        info->user_pixel_stride = 4;
        info->user_line_stride = 4 * chunk->width;
        info->encode_from_ptr = (const uint8_t *)planes[c];
    }
    exr_result_t result = exr_encoding_choose_default_routines(context, 0, &encoder);
    if (result == EXR_ERR_SUCCESS)
        result = exr_encoding_run(context, 0, &encoder);
    exr_encoding_destroy(context, &encoder);
    return result;
}

/* An image of smooth() whose data window begins at (-7, 5). */
static exr_result_t exr_make(const char *path, const ExrKind *kind)
{
    exr_context_t context = NULL;
    exr_attr_box2i_t window;
    exr_attr_v2f_t center = {.x = 0.0f, .y = 0.0f};
    int part, lines = 16;
    window.min.x = -7;
    window.min.y = 5;
    window.max.x = WIDTH - 8;
    window.max.y = HEIGHT + 4;
    exr_start_write(&context, path, EXR_WRITE_FILE_DIRECTLY, NULL);
    exr_add_part(context, NULL, kind->tiled ? EXR_STORAGE_TILED : EXR_STORAGE_SCANLINE, &part);
    exr_initialize_required_attr(context, 0, &window, &window, 1.0f, &center, 1.0f, EXR_LINEORDER_INCREASING_Y,
                                 kind->compression);
    if (kind->tiled)
        exr_set_tile_descriptor(context, 0, 16, 16, EXR_TILE_ONE_LEVEL, EXR_TILE_ROUND_DOWN);
    const char *const names[] = {"B", "G", "R"};
    for (int c = 0; c < 3; ++c)
        exr_add_channel(context, 0, names[c], kind->type, EXR_PERCEPTUALLY_LOGARITHMIC, 1, 1);
    exr_result_t result = exr_write_header(context);
    if (!kind->tiled)
        exr_get_scanlines_per_chunk(context, 0, &lines);
    for (int y = 0; result == EXR_ERR_SUCCESS && y < HEIGHT; y += lines) {
        exr_chunk_info_t chunk;
        for (int x = 0; result == EXR_ERR_SUCCESS && x < (kind->tiled ? WIDTH : 1); x += 16) {
            result = kind->tiled ? exr_write_tile_chunk_info(context, 0, x / 16, y / 16, 0, 0, &chunk)
                                 : exr_write_scanline_chunk_info(context, 0, 5 + y, &chunk);
            if (result == EXR_ERR_SUCCESS)
                result = exr_chunk_write(context, kind, &chunk, x, y);
        }
    }
    exr_result_t finished = exr_finish(&context);
    return result == EXR_ERR_SUCCESS ? finished : result;
}

/* Every compression, pixel type and layout that OpenEXRCore 3.1 knows. */
START_TEST(test_exr_kinds)
{
    const exr_compression_t compressions[] = {EXR_COMPRESSION_NONE, EXR_COMPRESSION_RLE, EXR_COMPRESSION_ZIPS,
                                              EXR_COMPRESSION_ZIP,  EXR_COMPRESSION_PIZ, EXR_COMPRESSION_PXR24,
                                              EXR_COMPRESSION_B44,  EXR_COMPRESSION_B44A};
    const exr_pixel_type_t types[] = {EXR_PIXEL_FLOAT, EXR_PIXEL_HALF, EXR_PIXEL_UINT};
    for (int i = 0; i < 8 * 3 * 2; ++i) {
        ExrKind kind = {compressions[i / 6], types[i / 2 % 3], i % 2 != 0};
        exr_result_t result = exr_make(test_path("k.exr"), &kind);
        ck_assert_msg(result == EXR_ERR_SUCCESS, "writing compression %d type %d tiled %d: %s", kind.compression,
                      kind.type, kind.tiled, exr_get_default_error_message(result));
        if (kind.type != EXR_PIXEL_UINT) {
            image_check(test_path("k.exr"), 3, true, kind.compression >= EXR_COMPRESSION_B44 ? 0.02 : 1e-3);
            continue;
        }
        Image image = read_good(test_path("k.exr"));
        for (int k = 0; k < 3 * WIDTH * HEIGHT; ++k)
            TEST_NEAR(((float *)image.data)[k], floorf(smooth(k / 3 % WIDTH, k / 3 / WIDTH, k % 3) * 1000.0f), 0.0);
        image_destroy(&image);
    }
}
END_TEST

/* DWA uses a different code path. */
static void dwa_make(const char *path, int compression, int channels)
{
    static ImfRgba pixels[WIDTH * HEIGHT];
    for (int i = 0; i < WIDTH * HEIGHT; ++i) {
        ImfHalf *halves[] = {&pixels[i].r, &pixels[i].g, &pixels[i].b, &pixels[i].a};
        for (int c = 0; c < 4; ++c)
            ImfFloatToHalf(smooth(i % WIDTH, i / WIDTH, c), halves[c]);
    }
    ImfHeader *header = ImfNewHeader();
    ImfHeaderSetDataWindow(header, -7, 5, WIDTH - 8, HEIGHT + 4);
    ImfHeaderSetDisplayWindow(header, -7, 5, WIDTH - 8, HEIGHT + 4);
    ImfHeaderSetCompression(header, compression);
    ImfOutputFile *file = ImfOpenOutputFile(path, header, channels);
    ck_assert_msg(file != NULL, "%s", ImfErrorMessage());
    ImfOutputSetFrameBuffer(file, (ImfRgba *)((intptr_t)pixels - (5 * WIDTH - 7) * (intptr_t)sizeof *pixels), 1, WIDTH);
    ck_assert(ImfOutputWritePixels(file, HEIGHT));
    ImfCloseOutputFile(file);
    ImfDeleteHeader(header);
}

START_TEST(test_exr_dwa)
{
    dwa_make(test_path("a.exr"), IMF_DWAA_COMPRESSION, IMF_WRITE_RGB);
    image_check(test_path("a.exr"), 3, true, 0.02);
    dwa_make(test_path("b.exr"), IMF_DWAB_COMPRESSION, IMF_WRITE_RGBA);
    image_check(test_path("b.exr"), 4, true, 0.02);
}
END_TEST

START_TEST(test_exr_channels)
{
    const float grey[] = {0.25f, 0.5f};
    const ExrChannel y = {"Y", grey, 1, false}, z = {"Z", grey, 1, false}, two[] = {y, {"RY", grey, 1, false}};
    const ExrChannel pair[] = {{"R", grey, 1, false}, {"G", grey, 1, false}};
    Error error;
    ck_assert(exr_write(test_path("y.exr"), &y, 1, 2, 1, NULL, NULL, 0, &error));
    ck_assert(exr_write(test_path("z.exr"), &z, 1, 2, 1, NULL, NULL, 0, &error));
    ck_assert(exr_write(test_path("two.exr"), two, 2, 2, 1, NULL, NULL, 0, &error));
    ck_assert(exr_write(test_path("pair.exr"), pair, 2, 2, 1, NULL, NULL, 0, &error));
    const char *const good[] = {"y.exr", "z.exr"};
    for (int i = 0; i < 2; ++i) {
        Image image = read_good(test_path(good[i]));
        float *rgb;
        ck_assert_int_eq(image.channels, 1);
        ck_assert(image_linear_rgb(&image, &rgb, &error));
        ck_assert(rgb[0] == 0.25f && rgb[2] == 0.25f && rgb[4] == 0.5f);
        free(rgb);
        image_destroy(&image);
    }
    read_bad(test_path("two.exr"), "neither channels R, G and B nor Y");
    read_bad(test_path("pair.exr"), "neither channels R, G and B nor Y");
}
END_TEST

/* Any subset of a file's channels, of either pixel size: the result has the image's order, and unwanted channels do not
 * matter. Channel i holds i + pixel / 8. */
START_TEST(test_exr_choices)
{
    static const struct {
        const char *file, *image; /* channels, as letters */
    } CHOICES[] = {{"ABGR", "RGBA"}, {"ABGRZ", "RGBA"}, {"BGR", "RGB"}, {"BGRZ", "RGB"},
                   {"AYZ", "Y"},     {"ABYZ", "Y"},     {"YZ", "Y"},    {"V", "V"}};
    for (int i = 0; i < 2 * (int)(sizeof CHOICES / sizeof *CHOICES); ++i) {
        const char *letters = CHOICES[i / 2].file, *wanted = CHOICES[i / 2].image;
        float data[5][6];
        char names[5][2];
        ExrChannel channels[5];
        size_t count = strlen(letters);
        Error error;
        for (size_t c = 0; c < count; ++c) {
            for (int k = 0; k < 6; ++k)
                data[c][k] = (float)c + (float)k / 8.0f;
            names[c][0] = letters[c];
            names[c][1] = '\0';
            channels[c] = (ExrChannel){names[c], data[c], 1, i % 2 == 1};
        }
        ck_assert(exr_write(test_path("c.exr"), channels, count, 3, 2, NULL, NULL, 0, &error));
        Image image = read_good(test_path("c.exr"));
        ck_assert_int_eq(image.channels, (int)strlen(wanted));
        for (int k = 0; k < 6; ++k)
            for (int c = 0; c < image.channels; ++c)
                TEST_NEAR(((float *)image.data)[k * image.channels + c], data[strchr(letters, wanted[c]) - letters][k],
                          0.0);
        image_destroy(&image);
    }
}
END_TEST

static void samples_write(void)
{
    unsigned char bytes[3 * WIDTH * HEIGHT];
    float rgb[3 * WIDTH * HEIGHT];
    const ExrKind scanlines = {EXR_COMPRESSION_ZIP, EXR_PIXEL_HALF, false},
                  tiles = {EXR_COMPRESSION_PIZ, EXR_PIXEL_FLOAT, true};
    bytes_fill(bytes, 3);
    for (int i = 0; i < 3 * WIDTH * HEIGHT; ++i)
        rgb[i] = smooth(i / 3 % WIDTH, i / 3 / WIDTH, i % 3);
    stbi_write_png(test_path("a.png"), WIDTH, HEIGHT, 3, bytes, 3 * WIDTH);
    stbi_write_tga(test_path("a.tga"), WIDTH, HEIGHT, 3, bytes);
    stbi_write_jpg(test_path("a.jpg"), WIDTH, HEIGHT, 3, bytes, 90);
    stbi_write_hdr(test_path("a.hdr"), WIDTH, HEIGHT, 3, rgb);
    pfm_make(test_path("a.pfm"), 3, true, 1.0f);
    ck_assert_int_eq(exr_make(test_path("a.exr"), &scanlines), EXR_ERR_SUCCESS);
    ck_assert_int_eq(exr_make(test_path("b.exr"), &tiles), EXR_ERR_SUCCESS);
    dwa_make(test_path("c.exr"), IMF_DWAA_COMPRESSION, IMF_WRITE_RGB);
}

static const char *const SAMPLES[] = {"a.png", "a.tga", "a.jpg", "a.hdr", "a.pfm", "a.exr", "b.exr", "c.exr"};
#define SAMPLE_COUNT 8

static const char *damaged_path(const char *sample)
{
    return test_path(strstr(sample, ".tga") ? "damaged.tga" : "damaged");
}

START_TEST(test_truncated)
{
    samples_write();
    const char *sample = SAMPLES[_i];
    size_t size;
    unsigned char *bytes = test_file_read(test_path(sample), &size);
    for (size_t length = 0; length < size; length += 1 + size / 61) {
        const char *path = damaged_path(sample);
        test_file_write(path, bytes, length);
        read_bad(path, "");
    }
    free(bytes);
}
END_TEST

/* Random bytes changed: any result but a crash. (stb_image may take anything for pixels.) */
START_TEST(test_damaged)
{
    samples_write();
    const char *sample = SAMPLES[_i];
    size_t size;
    unsigned char *bytes = test_file_read(test_path(sample), &size);
    unsigned state = (unsigned)_i + 1;
    int refused = 0;
    for (int round = 0; round < 400; ++round) {
        unsigned char *copy = malloc(size);
        Image image;
        Error error;
        memcpy(copy, bytes, size);
        for (int i = 0; i < 1 + round % 5; ++i)
            copy[round % 2 ? test_random(&state) % size : test_random(&state) % 400] =
                (unsigned char)test_random(&state);
        const char *path = damaged_path(sample);
        test_file_write(path, copy, size);
        if (image_read(path, &image, &error))
            image_destroy(&image);
        else
            ++refused;
        free(copy);
    }
    ck_assert_int_gt(refused, 0);
    free(bytes);
}
END_TEST

START_TEST(test_refused)
{
    const char png_huge[] = "\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\1\0\0\0\1\0\0\x08\2\0\0\0\x12\x34\x56\x78";
    const char pfm_huge[] = "PF\n60000 60000\n-1\n", pfm_empty[] = "PF\n0 5\n-1\n", pfm_bad[] = "PF\nx 5\n-1\n";
    const char pfm_long[] = "PF\n99999999999999999999 1\n-1\n", gif[] = "GIF89a\1\0\1\0\x80\0\0\0\0\0\xff\xff\xff,";
    const char png_short[] =
        "\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\0\x40\0\0\0\x40\0\x08\2\0\0\0\x12\x34\x56\x78\0\0\0\1IDAT";
    const char pfm_short[] = "PF\n16384 16384\n-1\n";
    read_bad("no/such/file.png", "No such file or directory");
    read_bad(test_folder, "not an ordinary file");
    test_file_write(test_path("empty.png"), "", 0);
    read_bad(test_path("empty.png"), "empty");
    test_file_write(test_path("text.png"), "hello, world, this is no picture\n", 33);
    read_bad(test_path("text.png"), "its format is unknown");
    test_file_write(test_path("gif.tga"), gif, sizeof gif);
    read_bad(test_path("gif.tga"), "its format is unknown");
    test_file_write(test_path("huge.png"), png_huge, sizeof png_huge - 1);
    read_bad(test_path("huge.png"), "");
    test_file_write(test_path("huge.pfm"), pfm_huge, sizeof pfm_huge - 1);
    read_bad(test_path("huge.pfm"), "too large: 60000 x 60000");
    test_file_write(test_path("short.pfm"), pfm_short, sizeof pfm_short - 1);
    read_bad(test_path("short.pfm"), "too short for 16384 x 16384 pixels");
    test_file_write(test_path("short.png"), png_short, sizeof png_short - 1);
    read_bad(test_path("short.png"), "too short for 16384 x 16384 pixels");
    test_file_write(test_path("empty.pfm"), pfm_empty, sizeof pfm_empty - 1);
    read_bad(test_path("empty.pfm"), "0 x 5");
    test_file_write(test_path("bad.pfm"), pfm_bad, sizeof pfm_bad - 1);
    read_bad(test_path("bad.pfm"), "header");
    test_file_write(test_path("long.pfm"), pfm_long, sizeof pfm_long - 1);
    read_bad(test_path("long.pfm"), "");
}
END_TEST

/* The reference images of public scenes, if available. */
START_TEST(test_public_references)
{
    const char *const scenes[] = {"coffee", "cornell-box", "veach-bidir", "veach-mis"};
    for (int i = 0; i < 4; ++i) {
        char name[64], path[1024];
        snprintf(name, sizeof name, "%s/TungstenRender.exr", scenes[i]);
        if (!test_public_scene(name, path, sizeof path))
            continue;
        Image image = read_good(path);
        double sum = 0.0;
        size_t count = (size_t)image.width * (size_t)image.height * (size_t)image.channels;
        for (size_t k = 0; k < count; ++k)
            sum += (double)image_value(&image, k);
        ck_assert(image.is_float && image.channels >= 3 && isfinite(sum) && sum > 0.0);
        image_destroy(&image);
    }
}
END_TEST

TCase *texture_files_tcase(void)
{
    TCase *tcase = tcase_create("files");
    tcase_add_checked_fixture(tcase, test_folder_make, test_folder_remove);
    tcase_add_test(tcase, test_byte_formats);
    tcase_add_test(tcase, test_float_formats);
    tcase_add_test(tcase, test_exr_kinds);
    tcase_add_test(tcase, test_exr_dwa);
    tcase_add_test(tcase, test_exr_channels);
    tcase_add_test(tcase, test_exr_choices);
    tcase_add_loop_test(tcase, test_truncated, 0, SAMPLE_COUNT);
    tcase_add_loop_test(tcase, test_damaged, 0, SAMPLE_COUNT);
    tcase_add_test(tcase, test_refused);
    tcase_add_test(tcase, test_public_references);
    tcase_set_timeout(tcase, 30);
    return tcase;
}
