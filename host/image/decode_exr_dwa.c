/* EXR files with DWAA or DWAB compression, which OpenEXRCore 3.1 cannot decode: read as 16-bit RGBA through the C
 * interface of the C++ library. The compression is lossy and meant for 16-bit data. */
#include "image/decoders.h"

#include <ImfCRgbaFile.h>
#include <stdint.h>
#include <stdlib.h>

/* Base address for which pixel (x, y) of the data window is at `pixels`. The address itself need not be valid. */
static ImfRgba *frame_origin(ImfRgba *pixels, int x, int y, int width)
{
    intptr_t offset = ((intptr_t)y * width + x) * (intptr_t)sizeof *pixels;
    return (ImfRgba *)((intptr_t)pixels - offset);
}

static bool rgba_read(ImfInputFile *file, const Image *image, ImfRgba *pixels)
{
    int x0, y0, x1, y1;
    ImfHeaderDataWindow(ImfInputHeader(file), &x0, &y0, &x1, &y1);
    if ((long long)x1 - x0 + 1 != image->width || (long long)y1 - y0 + 1 != image->height)
        return false;
    return ImfInputSetFrameBuffer(file, frame_origin(pixels, x0, y0, image->width), 1, (size_t)image->width) &&
           ImfInputReadPixels(file, y0, y1);
}

static void rgba_convert(const ImfRgba *pixels, Image *image)
{
    float *out = image->data;
    size_t count = (size_t)image->width * (size_t)image->height;
    for (size_t i = 0; i < count; ++i) {
        const ImfHalf halves[4] = {pixels[i].r, pixels[i].g, pixels[i].b, pixels[i].a};
        for (int c = 0; c < image->channels; ++c)
            *out++ = ImfHalfToFloat(halves[c]);
    }
}

bool image_read_exr_dwa(const char *path, Image *image, Error *error)
{
    size_t count = (size_t)image->width * (size_t)image->height;
    ImfRgba *pixels = calloc(count, sizeof *pixels);
    if (!pixels)
        return error_memory(error, count * sizeof *pixels, path);
    ImfInputFile *file = ImfOpenInputFile(path);
    bool good = file && rgba_read(file, image, pixels);
    if (good)
        rgba_convert(pixels, image);
    else
        image_error(error, path, ImfErrorMessage());
    if (file)
        ImfCloseInputFile(file);
    free(pixels);
    return good;
}
