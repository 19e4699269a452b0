#include "image/read.h"

#include "base/input_files.h"
#include "base/path_name.h"
#include "image/decoders.h"

#include <stdint.h>
#include <string.h>
#include <sys/stat.h>

#define HEADER_SIZE 26 /* covers every signature, and PNG's bit depth at byte 24 */

/* TGA has no signature, so its header is checked for plausibility. No other format that stb_image knows passes. */
static bool is_tga(const unsigned char *header, size_t size)
{
    return size >= 18 && header[1] <= 1 && ((header[2] >= 1 && header[2] <= 3) || (header[2] >= 9 && header[2] <= 11));
}

static bool is_exr(const unsigned char *header, size_t size)
{
    return size >= 4 && memcmp(header, "\x76\x2f\x31\x01", 4) == 0;
}

static bool image_read_kind(FILE *file, const char *path, const unsigned char *header, size_t size, Image *image,
                            Error *error)
{
    if (is_exr(header, size))
        return image_read_exr(file, path, image, error);
    if (size >= 3 && (memcmp(header, "PF", 2) == 0 || memcmp(header, "Pf", 2) == 0))
        return image_read_pfm(file, path, image, error);
    if (size == HEADER_SIZE && memcmp(header, "\x89PNG\r\n\x1a\n", 8) == 0)
        return image_read_stb(file, path, STB_PNG, header[24] == 16, image, error);
    if (size >= 3 && memcmp(header, "\xff\xd8\xff", 3) == 0)
        return image_read_stb(file, path, STB_JPEG, false, image, error);
    if (size >= 2 && memcmp(header, "#?", 2) == 0)
        return image_read_stb(file, path, STB_HDR, false, image, error);
    if (path_ends(path, ".tga") && is_tga(header, size))
        return image_read_stb(file, path, STB_TGA, false, image, error);
    image_error(error, path, size == 0 ? "the file is empty" : "its format is unknown, or it is truncated");
    return error_fix(error, "use PNG, JPEG, TGA, HDR, EXR or PFM");
}

/* Opens a regular file and reads its first *size <= HEADER_SIZE bytes. */
static FILE *image_open(const char *path, unsigned char header[HEADER_SIZE], size_t *size, Error *error)
{
    struct stat status;
    FILE *file = fopen(path, "rb");
    if (!file || fstat(fileno(file), &status) != 0) {
        error_errno(error, "open the image", path);
        error_fix(error, "check the name; those in a scene are relative to the scene's folder");
        if (file)
            fclose(file);
        return NULL;
    }
    if (!S_ISREG(status.st_mode)) {
        image_error(error, path, "it is not an ordinary file");
        fclose(file);
        return NULL;
    }
    input_file_note(fileno(file));
    *size = fread(header, 1, HEADER_SIZE, file);
    rewind(file);
    return file;
}

bool image_read(const char *path, Image *image, Error *error)
{
    unsigned char header[HEADER_SIZE];
    size_t size = 0;
    *image = (Image){0};
    FILE *file = image_open(path, header, &size, error);
    if (!file)
        return false;
    bool good = image_read_kind(file, path, header, size, image, error);
    fclose(file);
    if (!good)
        image_destroy(image);
    return good;
}

bool image_read_memory(const void *bytes, size_t size, const char *name, Image *image, Error *error)
{
    const unsigned char *header = bytes;
    *image = (Image){0};
    bool png = size >= HEADER_SIZE && memcmp(header, "\x89PNG\r\n\x1a\n", 8) == 0;
    if (!png && !(size >= 3 && memcmp(header, "\xff\xd8\xff", 3) == 0)) {
        image_error(error, name, "it is neither PNG nor JPEG, or truncated");
        return error_fix(error, "use PNG or JPEG");
    }
    FILE *file = fmemopen((void *)(uintptr_t)bytes, size, "rb");
    if (!file)
        return error_memory(error, size, name);
    bool good = image_read_kind(file, name, header, png ? HEADER_SIZE : 3, image, error);
    fclose(file);
    if (!good)
        image_destroy(image);
    return good;
}

bool image_read_layer(const char *path, const char *layer, Image *image, bool *found, Error *error)
{
    unsigned char header[HEADER_SIZE];
    size_t size = 0;
    *image = (Image){0};
    *found = false;
    FILE *file = image_open(path, header, &size, error);
    if (!file)
        return false;
    bool good = !is_exr(header, size) || image_read_exr_layer(file, path, layer, image, found, error);
    fclose(file);
    if (!*found)
        image_destroy(image);
    return good;
}

bool image_read_rgb(const char *path, float **rgb, int *width, int *height, Error *error)
{
    Image image;
    *rgb = NULL;
    if (!image_read(path, &image, error))
        return false;
    *width = image.width;
    *height = image.height;
    bool good = image_linear_rgb(&image, rgb, error);
    image_destroy(&image);
    return good;
}
