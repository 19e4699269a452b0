#include "render/aov_image.h"

#include <stdlib.h>

bool aov_image_init(AovImage *image, const Film *film, AovKind kind, const AovImage *counted, Error *error)
{
    size_t pixels = film_pixels(film);
    const int *crop = film->crop;
    *image = (AovImage){.channels = kind.channels,
                        .film = {.width = (uint)film->width,
                                 .x0 = (uint)crop[0],
                                 .y0 = (uint)crop[1],
                                 .x1 = (uint)crop[2],
                                 .y1 = (uint)crop[3]},
                        .counts_borrowed = counted != NULL};
    if (kind.part)
        image->trues = calloc(pixels, sizeof *image->trues);
    else
        image->sums = calloc(pixels * kind.channels, sizeof *image->sums);
    image->counts = counted ? counted->counts : calloc(pixels, sizeof *image->counts);
    return ((image->sums || image->trues) && image->counts) ||
           error_memory(error, pixels * (kind.channels * sizeof *image->sums + sizeof *image->counts), "layers");
}

void aov_image_destroy(AovImage *image)
{
    free(image->sums);
    free(image->trues);
    if (!image->counts_borrowed)
        free(image->counts);
    *image = (AovImage){0};
}

void aov_image_archive(Archive *archive, AovImage *image)
{
    size_t pixels = (size_t)(image->film.x1 - image->film.x0) * (image->film.y1 - image->film.y0);
    archive_same(archive, pixels * image->channels, "the number of values in a layer");
    if (image->trues)
        archive_bytes(archive, image->trues, pixels * sizeof *image->trues);
    else
        archive_floats(archive, image->sums, pixels * image->channels, RANGE_FLOATS, "the values of a layer");
    if (!image->counts_borrowed)
        archive_bytes(archive, image->counts, pixels * sizeof *image->counts);
}

static void sample_add(AovImage *image, uint pixel, Vec3 value)
{
    const float values[3] = {value.x, value.y, value.z};
    uint slot = film_slot(&image->film, pixel);
    if (slot == NONE)
        return;
    for (size_t c = 0; c < 3 && c < image->channels && image->sums && vec3_finite(value); ++c)
        image->sums[image->channels * slot + c] += values[c];
    if (image->trues && value.x > 0.5f)
        ++image->trues[slot];
    if (!image->counts_borrowed)
        ++image->counts[slot];
}

void aov_images_add(AovImage *images, uint number, const uint *splats, uint count, uint stride)
{
    const uint pixel = (1u << SPLAT_FILM_SHIFT) - 1u;
    for (uint item = 0; item < count; ++item) {
        uint name = state_load(splats, stride, SPLAT_PIXEL, item);
        if (name != NONE && name >> SPLAT_FILM_SHIFT < number)
            sample_add(&images[name >> SPLAT_FILM_SHIFT], name & pixel,
                       state_load_vec3(splats, stride, SPLAT_COLOR, item));
    }
}

void aov_image_resolve(const AovImage *image, size_t first, size_t count, float *rgb)
{
    for (size_t i = 0; i < count; ++i)
        for (size_t c = 0; c < 3; ++c) {
            size_t pixel = first + i, value = image->channels * pixel + (image->channels == 3 ? c : 0);
            float sum = image->trues ? (float)image->trues[pixel] : image->sums[value];
            rgb[3 * i + c] = image->counts[pixel] > 0 ? sum / (float)image->counts[pixel] : 0.0f;
        }
}
