#include "gltf/images.h"

#include "image/color.h"
#include "image/read.h"
#include "scene/texture_image.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- images of the file ------------------------------------------------------------------------------------------ */

static bool image_bytes(Gltf *gltf, GltfReader *reader, int index, GltfBytes *bytes)
{
    const GltfObject object = gltf_entry(reader, "images", (size_t)index);
    const char *uri = gltf_text(reader, &object, "uri", NULL);
    int view = gltf_index(reader, &object, "bufferView", "bufferViews");
    if (reader->failed)
        return false;
    if (uri)
        return gltf_uri_read(gltf, reader, uri, object.name, bytes);
    if (view < 0)
        return gltf_fail(reader, "%s has neither uri nor bufferView", object.name);
    *bytes = gltf_view(gltf, reader, (size_t)view);
    return !reader->failed;
}

bool gltf_image_read(Gltf *gltf, int index, Image *image, Error *error)
{
    GltfReader reader = {.path = gltf->path, .root = gltf->root, .error = error};
    GltfBytes bytes = {0};
    char name[32];
    snprintf(name, sizeof name, "images[%d]", index);
    bool good = image_bytes(gltf, &reader, index, &bytes) &&
                (image_read_memory(bytes.data, bytes.size, name, image, error) || error_in(error, gltf->path));
    free(bytes.owned);
    return good;
}

/* ---- derived images ---------------------------------------------------------------------------------------------- */

static bool derived_same(const DerivedImage *a, const DerivedImage *b)
{
    return a->kind == b->kind && a->image == b->image && a->channel == b->channel && a->coat == b->coat &&
           a->factor[0] == b->factor[0] && a->factor[1] == b->factor[1] && a->factor[2] == b->factor[2];
}

/* Whether an image is a PNG of 16 bits per channel: its depth is the 25th byte. */
static bool image_is_deep(Gltf *gltf, GltfReader *reader, int index, bool *deep)
{
    GltfBytes bytes = {0};
    bool good = image_bytes(gltf, reader, index, &bytes);
    *deep = good && bytes.size > 24 && bytes.data[0] == 0x89 && bytes.data[24] == 16;
    free(bytes.owned);
    return good;
}

int gltf_derived_add(Gltf *gltf, GltfReader *reader, DerivedImage image)
{
    for (size_t i = 0; i < gltf->derived.count; ++i)
        if (derived_same(&ARRAY_AT(&gltf->derived, DerivedImage, i), &image))
            return (int)i;
    if (gltf->derived.count >= SCENE_IMAGES_MAX) {
        gltf_fail(reader, "the materials need more than %d images", SCENE_IMAGES_MAX);
        return -1;
    }
    if (!image_is_deep(gltf, reader, image.image, &image.is_float))
        return -1;
    DerivedImage *to = array_grow(&gltf->derived, 1, reader->error);
    if (!to) {
        reader->failed = true;
        return -1;
    }
    *to = image;
    return (int)(gltf->derived.count - 1);
}

const char *gltf_derived_ending(const Gltf *gltf, int image)
{
    return ARRAY_AT(&gltf->derived, DerivedImage, image).is_float ? ".exr" : ".png";
}

double gltf_coat_base(double albedo, double internal)
{
    return albedo / (1.0 - internal + internal * albedo);
}

/* Number of channels of an image of this kind. */
static int derived_channels(DerivedKind kind)
{
    return kind == DERIVED_COLOR || kind == DERIVED_NORMAL ? 3 : 1;
}

/* The colour of pixel i of the source, encoded as it is: grey repeated. */
static void pixel_rgb(const Image *from, size_t i, double rgb[3])
{
    size_t channels = (size_t)from->channels;
    for (size_t c = 0; c < 3; ++c)
        rgb[c] = (double)image_value(from, i * channels + (channels >= 3 ? c : 0));
}

static double pixel_alpha(const Image *from, size_t i)
{
    return from->channels == 4 ? (double)image_value(from, 4 * i + 3) : 1.0;
}

/* Linear colour. */
static void color_make(const DerivedImage *derived, const double rgb[3], double out[3])
{
    for (int c = 0; c < 3; ++c) {
        double value = color_srgb_decode(rgb[c]) * derived->factor[c];
        out[c] = derived->coat > 0.0 ? gltf_coat_base(value, derived->coat) : value;
    }
}

/* A direction as colour; a scale of x and y tilts it. */
static void normal_make(const DerivedImage *derived, const double rgb[3], double out[3])
{
    double n[3], length = 0.0;
    for (int c = 0; c < 3; ++c) {
        out[c] = rgb[c];
        n[c] = (2.0 * rgb[c] - 1.0) * (c < 2 ? derived->factor[0] : 1.0);
        length += n[c] * n[c];
    }
    for (int c = 0; c < 3 && derived->factor[0] != 1.0 && length > 0.0; ++c)
        out[c] = 0.5 + 0.5 * n[c] / sqrt(length);
}

/* Values of pixel i, linear. */
static void pixel_make(const DerivedImage *derived, const Image *from, size_t i, double out[3])
{
    double rgb[3];
    double alpha = pixel_alpha(from, i) * derived->factor[0];
    pixel_rgb(from, i, rgb);
    switch (derived->kind) {
    case DERIVED_COLOR:
        color_make(derived, rgb, out);
        break;
    case DERIVED_NORMAL:
        normal_make(derived, rgb, out);
        break;
    case DERIVED_CHANNEL:
        out[0] = rgb[derived->channel];
        break;
    case DERIVED_ALPHA:
        out[0] = alpha;
        break;
    case DERIVED_MASK:
        out[0] = alpha >= derived->factor[1] ? 1.0 : 0.0;
        break;
    }
}

static unsigned char byte_round(double value)
{
    return (unsigned char)(fmin(fmax(value, 0.0), 1.0) * 255.0 + 0.5);
}

bool gltf_derived_make(Gltf *gltf, const DerivedImage *derived, Image *image, Error *error)
{
    Image from;
    if (!gltf_image_read(gltf, derived->image, &from, error))
        return false;
    size_t pixels = (size_t)from.width * (size_t)from.height, channels = (size_t)derived_channels(derived->kind);
    *image = (Image){.width = from.width,
                     .height = from.height,
                     .channels = (int)channels,
                     .is_float = from.is_float,
                     .srgb_encoded = !from.is_float,
                     .data = malloc(pixels * channels * (from.is_float ? sizeof(float) : 1))};
    for (size_t i = 0; image->data && i < pixels; ++i) {
        double values[3];
        pixel_make(derived, &from, i, values);
        for (size_t c = 0; c < channels; ++c)
            if (from.is_float)
                ((float *)image->data)[channels * i + c] = (float)values[c];
            else
                ((unsigned char *)image->data)[channels * i + c] =
                    byte_round(derived->kind == DERIVED_COLOR ? color_srgb_encode(values[c]) : values[c]);
    }
    image_destroy(&from);
    return image->data || error_memory(error, pixels * channels, "an image");
}
