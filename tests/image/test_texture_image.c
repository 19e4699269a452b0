/* Files as textures: sharing, encodings, alpha. */
#include "support/test_files.h"
#include "support/test_util.h"

#include "base/log.h"
#include "geometry/texture.h"
#include "image/color.h"
#include "image/exr.h"
#include "scene/scene.h"
#include "scene/texture_image.h"

#include <png.h>

TCase *texture_image_tcase(void);

static const TextureImageOptions SRGB = {ENCODING_SRGB, 1.0f, WRAP_REPEAT, FILTER_BILINEAR};

/* Writes a PNG by libpng; `format`: PNG_FORMAT_*; 16 bits with PNG_FORMAT_FLAG_LINEAR. */
static void png_make(const char *path, int width, int height, png_uint_32 format, const void *pixels)
{
    png_image png = {.version = PNG_IMAGE_VERSION, .width = (png_uint_32)width, .height = (png_uint_32)height};
    png.format = format;
    ck_assert_msg(png_image_write_to_file(&png, path, 0, pixels, 0, NULL), "%s", png.message);
}

static uint load(Scene *scene, TextureCache *cache, const char *path, TextureImageOptions options)
{
    Error error = {0};
    uint index = NONE;
    ck_assert_msg(texture_image_load(scene, cache, path, &options, &index, &error), "%s", error.message);
    return index;
}

static Vec3 texel(const Scene *scene, uint index, uint x, uint y)
{
    SceneView view = {.images = scene->images.data, .lookup = scene->lookup.data, .texels = scene->texels.data};
    TextureImage image = view.images[index];
    return image_texel(&view, &image, x, y);
}

START_TEST(test_sharing)
{
    unsigned char rgb[5 * 3 * 3];
    for (size_t i = 0; i < sizeof rgb; ++i)
        rgb[i] = (unsigned char)(5 * i);
    png_make(test_path("a.png"), 5, 3, PNG_FORMAT_RGB, rgb);
    png_make(test_path("b.png"), 5, 3, PNG_FORMAT_RGB, rgb);
    Scene scene;
    TextureCache cache;
    scene_init(&scene);
    texture_cache_init(&cache);
    TextureImageOptions clamp = SRGB, linear = SRGB, gamma = SRGB;
    clamp.wrap = WRAP_CLAMP;
    linear.encoding = ENCODING_LINEAR;
    gamma.encoding = ENCODING_GAMMA;
    gamma.gamma = 2.0f;
    uint first = load(&scene, &cache, test_path("a.png"), SRGB);
    ck_assert_uint_eq(scene.texels.count, 15);
    ck_assert_uint_eq(scene.lookup.count, 256);
    ck_assert_uint_eq(load(&scene, &cache, test_path("a.png"), SRGB), first);
    uint clamped = load(&scene, &cache, test_path("a.png"), clamp);
    uint linears = load(&scene, &cache, test_path("a.png"), linear);
    uint gammas = load(&scene, &cache, test_path("a.png"), gamma);
    ck_assert_uint_eq(scene.texels.count, 15);
    ck_assert_uint_eq(scene.lookup.count, 3 * 256);
    ck_assert(clamped != first && linears != clamped);
    uint other = load(&scene, &cache, test_path("b.png"), SRGB);
    ck_assert_uint_eq(scene.texels.count, 30);
    ck_assert_uint_eq(scene.lookup.count, 3 * 256);
    const TextureImage *images = scene.images.data;
    ck_assert(images[other].lut == images[first].lut && images[clamped].wrap == WRAP_CLAMP);
    for (uint y = 0; y < 3; ++y) {
        for (uint x = 0; x < 5; ++x) {
            double byte = (double)rgb[3 * (5 * y + x) + 1] / 255.0;
            ck_assert_double_eq_tol((double)texel(&scene, first, x, y).y, color_srgb_decode(byte), 1e-7);
            ck_assert_double_eq_tol((double)texel(&scene, linears, x, y).y, byte, 1e-7);
            ck_assert_double_eq_tol((double)texel(&scene, gammas, x, y).y, byte * byte, 1e-7);
        }
    }
    texture_cache_destroy(&cache);
    scene_destroy(&scene);
}
END_TEST

START_TEST(test_alpha)
{
    const unsigned char whole[] = {1, 2, 3, 255, 4, 5, 6, 255}, holes[] = {255, 2, 3, 255, 255, 5, 6, 0};
    png_make(test_path("whole.png"), 2, 1, PNG_FORMAT_RGBA, whole);
    png_make(test_path("holes.png"), 2, 1, PNG_FORMAT_RGBA, holes);
    Scene scene;
    TextureCache cache;
    scene_init(&scene);
    texture_cache_init(&cache);
    TextureImageOptions point = SRGB;
    point.filter = FILTER_POINT;
    uint opaque = load(&scene, &cache, test_path("whole.png"), point);
    uint cut = load(&scene, &cache, test_path("holes.png"), point);
    SceneView view = {.images = scene.images.data, .lookup = scene.lookup.data, .texels = scene.texels.data};
    ck_assert_uint_eq(view.images[opaque].channels, 3);
    ck_assert_uint_eq(view.images[cut].channels, 4);
    ck_assert_float_eq(image_lookup_float(&view, cut, vec2(0.25f, 0.5f)), 1.0f);
    ck_assert_float_eq(image_lookup_float(&view, cut, vec2(0.75f, 0.5f)), 0.0f);
    ck_assert_float_eq(image_lookup(&view, cut, vec2(0.75f, 0.5f)).x, 1.0f);
    texture_cache_destroy(&cache);
    scene_destroy(&scene);
}
END_TEST

/* 16-bit images are kept as floats, decoded once. */
START_TEST(test_sixteen_bits)
{
    const png_uint_16 grey[] = {0, 65535, 32768, 1};
    png_make(test_path("g.png"), 4, 1, PNG_FORMAT_LINEAR_Y, grey);
    Scene scene;
    TextureCache cache;
    scene_init(&scene);
    texture_cache_init(&cache);
    TextureImageOptions linear = SRGB;
    linear.encoding = ENCODING_LINEAR;
    uint srgb = load(&scene, &cache, test_path("g.png"), SRGB),
         plain = load(&scene, &cache, test_path("g.png"), linear);
    const TextureImage *images = scene.images.data;
    ck_assert_uint_eq(images[srgb].format, TEXEL_F32);
    ck_assert_uint_eq(images[srgb].channels, 1);
    ck_assert_uint_eq(images[srgb].lut, NONE);
    for (uint x = 0; x < 4; ++x) {
        ck_assert_float_eq_tol(texel(&scene, plain, x, 0).x, (float)grey[x] / 65535.0f, 1e-7f);
        ck_assert_double_eq_tol((double)texel(&scene, srgb, x, 0).z, color_srgb_decode(grey[x] / 65535.0), 1e-7);
    }
    texture_cache_destroy(&cache);
    scene_destroy(&scene);
}
END_TEST

static void warning_catch(const char *line, void *context)
{
    snprintf(context, 256, "%s", line);
}

/* Float images are linear whatever the encoding; non-finite values become 0, with a warning. */
START_TEST(test_floats)
{
    const float rgb[] = {0.5f, NAN, 2.0f, INFINITY, 1e30f, -1.0f};
    const ExrChannel channels[] = {{"R", rgb, 3, false}, {"G", rgb + 1, 3, false}, {"B", rgb + 2, 3, false}};
    Error error;
    char warning[256] = "";
    ck_assert(exr_write(test_path("f.exr"), channels, 3, 2, 1, &error));
    Scene scene;
    TextureCache cache;
    scene_init(&scene);
    texture_cache_init(&cache);
    log_sink_set(warning_catch, warning);
    uint index = load(&scene, &cache, test_path("f.exr"), SRGB);
    log_sink_set(NULL, NULL);
    ck_assert_ptr_nonnull(strstr(warning, "2 values"));
    Vec3 a = texel(&scene, index, 0, 0), b = texel(&scene, index, 1, 0);
    ck_assert(a.x == 0.5f && a.y == 0.0f && a.z == 2.0f && b.x == 0.0f && b.y == 1e30f && b.z == -1.0f);
    uint unused;
    ck_assert(!texture_image_load(&scene, &cache, test_path("none.png"), &SRGB, &unused, &error));
    ck_assert_ptr_nonnull(strstr(error.message, "none.png: No such file or directory"));
    texture_cache_destroy(&cache);
    scene_destroy(&scene);
}
END_TEST

START_TEST(test_encoding_names)
{
    const char *const bad[] = {"",        "srgb",     "gamma",     "gamma ",  "gamma x",
                               "gamma 0", "gamma -1", "gamma nan", "gamma 2x"};
    TextureImageOptions options;
    ck_assert(texture_encoding_parse("sRGB", &options) && options.encoding == ENCODING_SRGB);
    ck_assert(texture_encoding_parse("linear", &options) && options.encoding == ENCODING_LINEAR);
    ck_assert(texture_encoding_parse("gamma 2.2", &options) && options.encoding == ENCODING_GAMMA);
    ck_assert_float_eq(options.gamma, 2.2f);
    for (size_t i = 0; i < sizeof bad / sizeof *bad; ++i)
        ck_assert_msg(!texture_encoding_parse(bad[i], &options), "%s", bad[i]);
}
END_TEST

TCase *texture_image_tcase(void)
{
    TCase *tcase = tcase_create("texture image");
    tcase_add_checked_fixture(tcase, test_folder_make, test_folder_remove);
    tcase_add_test(tcase, test_sharing);
    tcase_add_test(tcase, test_alpha);
    tcase_add_test(tcase, test_sixteen_bits);
    tcase_add_test(tcase, test_floats);
    tcase_add_test(tcase, test_encoding_names);
    return tcase;
}
