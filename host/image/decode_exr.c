/* OpenEXR decoder on OpenEXRCore: part 0, scanlines or the finest level of tiles, any compression and pixel type. */
#include "image/decoders.h"
#include "math/platform.h"

#include <ImfCRgbaFile.h>
#include <errno.h>
#include <openexr.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#define LAYER_NAME_MAX 64

typedef struct ExrReader {
    FILE *file;
    char message[256]; /* the library's first error message */
    exr_context_t context;
    exr_decode_pipeline_t decoder;
    bool decoding; /* `decoder` has been initialised */
    float *chunk_first; /* destination of the first pixel of the chunk being decoded */
    long long width, height; /* of the data window */
    int first_line;
    const char *layer; /* layer to read, e.g. "halfA"; NULL: the main image */
    bool absent; /* the file has no such layer */
    char layer_names[3][LAYER_NAME_MAX + 3];
    const char *names[4]; /* channels in the order of Image */
    int channels;
} ExrReader;

static void exr_message(exr_const_context_t context, exr_result_t code, const char *message)
{
    void *user = NULL;
    if (exr_get_user_data(context, &user) != EXR_ERR_SUCCESS || !user)
        return;
    ExrReader *reader = user;
    if (!reader->message[0])
        snprintf(reader->message, sizeof reader->message, "%s",
                 message ? message : exr_get_default_error_message(code));
}

/* pread for the library, which handles short reads itself. `report` is not called, see image/exr.c. */
static int64_t exr_read_bytes(exr_const_context_t context, void *user, void *buffer, uint64_t size, uint64_t offset,
                              exr_stream_error_func_ptr_t report)
{
    ExrReader *reader = user;
    uint64_t done = 0;
    (void)context;
    (void)report;
    while (done < size) {
        ssize_t n = pread(fileno(reader->file), (char *)buffer + done, size - done, (off_t)(offset + done));
        if (n < 0 && errno == EINTR)
            continue;
        if (n < 0) {
            snprintf(reader->message, sizeof reader->message, "%s", strerror(errno));
            return -1;
        }
        if (n == 0)
            break;
        done += (uint64_t)n;
    }
    return (int64_t)done;
}

static int64_t exr_file_size(exr_const_context_t context, void *user)
{
    const ExrReader *reader = user;
    struct stat status;
    (void)context;
    return fstat(fileno(reader->file), &status) == 0 ? (int64_t)status.st_size : -1;
}

static bool exr_has(const exr_attr_chlist_t *list, const char *name)
{
    for (int i = 0; i < list->num_channels; ++i)
        if (strcmp(list->entries[i].name.str, name) == 0)
            return true;
    return false;
}

/* Chooses the channels of the requested layer. */
static bool layer_choose(ExrReader *reader, const exr_attr_chlist_t *list, const char *path, Error *error)
{
    for (int c = 0; c < 3; ++c) {
        char *name = reader->layer_names[c];
        snprintf(name, sizeof reader->layer_names[c], "%.*s.%c", LAYER_NAME_MAX, reader->layer, "RGB"[c]);
        reader->names[c] = name;
        reader->absent = reader->absent || !exr_has(list, name);
    }
    reader->channels = 3;
    return !reader->absent || image_error(error, path, "it lacks a layer");
}

/* Chooses the channels of the main image. */
static bool channels_choose(ExrReader *reader, const char *path, Error *error)
{
    const exr_attr_chlist_t *list = NULL;
    if (exr_get_channels(reader->context, 0, &list) != EXR_ERR_SUCCESS || !list || list->num_channels < 1)
        return image_error(error, path, "it has no channels");
    for (int i = 0; i < list->num_channels; ++i)
        if (list->entries[i].x_sampling != 1 || list->entries[i].y_sampling != 1)
            return image_error(error, path, "subsampled EXR channels are not supported");
    if (reader->layer)
        return layer_choose(reader, list, path, error);
    static const char *const RGBA[] = {"R", "G", "B", "A"};
    if (exr_has(list, "R") && exr_has(list, "G") && exr_has(list, "B")) {
        reader->channels = exr_has(list, "A") ? 4 : 3;
        memcpy(reader->names, RGBA, sizeof RGBA);
        return true;
    }
    reader->channels = 1;
    reader->names[0] = exr_has(list, "Y") ? "Y" : list->entries[0].name.str;
    if (exr_has(list, "Y") ? !exr_has(list, "RY") : list->num_channels == 1)
        return true;
    image_error(error, path, "it has neither channels R, G and B nor Y alone");
    return error_fix(error, "rename or merge the layers that you need to R, G, B");
}

static bool header_read(ExrReader *reader, const char *path, Error *error)
{
    exr_storage_t storage;
    exr_attr_box2i_t window;
    if (exr_get_storage(reader->context, 0, &storage) != EXR_ERR_SUCCESS ||
        exr_get_data_window(reader->context, 0, &window) != EXR_ERR_SUCCESS)
        return image_error(error, path, reader->message[0] ? reader->message : "its EXR header is damaged");
    if (storage != EXR_STORAGE_SCANLINE && storage != EXR_STORAGE_TILED)
        return image_error(error, path, "deep EXR images are not supported");
    reader->width = (long long)window.max.x - window.min.x + 1;
    reader->height = (long long)window.max.y - window.min.y + 1;
    reader->first_line = window.min.y;
    return channels_choose(reader, path, error);
}

/* Index in Image of the file's channel `name`; -1: not read. */
static int channel_index(const ExrReader *reader, const char *name)
{
    for (int c = 0; c < reader->channels; ++c)
        if (strcmp(name, reader->names[c]) == 0)
            return c;
    return -1;
}

/* Converts `count` samples of the file to floats, `stride` floats apart. */
static void samples_convert(const uint8_t *in, exr_pixel_type_t type, int count, int stride, float *out)
{
    for (int i = 0; i < count; ++i, out += stride) {
        if (type == EXR_PIXEL_HALF) {
            *out = ImfHalfToFloat((ImfHalf)(in[2 * i] | in[2 * i + 1] << 8));
            continue;
        }
        const uint8_t *b = in + 4 * (size_t)i;
        uint bits = (uint)b[0] | (uint)b[1] << 8 | (uint)b[2] << 16 | (uint)b[3] << 24;
        *out = type == EXR_PIXEL_FLOAT ? bits_float(bits) : (float)bits;
    }
}

/* Copies a decompressed chunk to the image: its lines in order, in each the channels in order. Replaces the library's
 * own function, which in version 3.1 swaps R with A and G with B for four 16-bit channels, and crashes if some of three
 * or four channels are not requested. */
static exr_result_t chunk_unpack(exr_decode_pipeline_t *decoder)
{
    const ExrReader *reader = decoder->decoding_user_data;
    const uint8_t *in = decoder->unpacked_buffer;
    uint64_t left = in == decoder->packed_buffer ? decoder->chunk.packed_size : decoder->chunk.unpacked_size;
    int width = decoder->chunk.width;
    for (int y = 0; y < decoder->chunk.height; ++y) {
        float *line = reader->chunk_first + (size_t)y * (size_t)reader->width * (size_t)reader->channels;
        for (int i = 0; i < decoder->channel_count; ++i) {
            const exr_coding_channel_info_t *info = &decoder->channels[i];
            uint64_t bytes = (uint64_t)width * (uint64_t)info->bytes_per_element;
            int c = channel_index(reader, info->channel_name);
            if (!in || bytes > left || info->width != width ||
                info->bytes_per_element != (info->data_type == EXR_PIXEL_HALF ? 2 : 4))
                return EXR_ERR_CORRUPT_CHUNK;
            if (c >= 0)
                samples_convert(in, (exr_pixel_type_t)info->data_type, width, reader->channels, line + c);
            in += bytes;
            left -= bytes;
        }
    }
    return EXR_ERR_SUCCESS;
}

/* Decodes a chunk whose first pixel is (x, y) of the image. */
static exr_result_t chunk_read(ExrReader *reader, const exr_chunk_info_t *chunk, Image *image, long long x, long long y)
{
    exr_decode_pipeline_t *decoder = &reader->decoder;
    bool first_chunk = !reader->decoding;
    exr_result_t result = first_chunk ? exr_decoding_initialize(reader->context, 0, chunk, decoder)
                                      : exr_decoding_update(reader->context, 0, chunk, decoder);
    if (result != EXR_ERR_SUCCESS)
        return result;
    reader->decoding = true;
    if (x + chunk->width > image->width || y + chunk->height > image->height)
        return EXR_ERR_CORRUPT_CHUNK;
    reader->chunk_first = (float *)image->data + (y * image->width + x) * image->channels;
    if (first_chunk) {
        result = exr_decoding_choose_default_routines(reader->context, 0, decoder);
        decoder->decoding_user_data = reader;
        decoder->unpack_and_convert_fn = chunk_unpack;
    }
    return result == EXR_ERR_SUCCESS ? exr_decoding_run(reader->context, 0, decoder) : result;
}

static exr_result_t scanlines_read(ExrReader *reader, Image *image)
{
    int32_t step = 1;
    exr_result_t result = exr_get_scanlines_per_chunk(reader->context, 0, &step);
    for (long long y = 0; result == EXR_ERR_SUCCESS && y < image->height; y += step) {
        exr_chunk_info_t chunk;
        result = exr_read_scanline_chunk_info(reader->context, 0, (int)(reader->first_line + y), &chunk);
        if (result == EXR_ERR_SUCCESS)
            result = chunk_read(reader, &chunk, image, 0, y);
    }
    return result;
}

static exr_result_t tiles_read(ExrReader *reader, Image *image)
{
    int32_t tile_width = 0, tile_height = 0;
    exr_result_t result = exr_get_tile_sizes(reader->context, 0, 0, 0, &tile_width, &tile_height);
    if (result == EXR_ERR_SUCCESS && (tile_width < 1 || tile_height < 1))
        return EXR_ERR_INVALID_ATTR;
    for (long long y = 0; result == EXR_ERR_SUCCESS && y < image->height; y += tile_height) {
        for (long long x = 0; result == EXR_ERR_SUCCESS && x < image->width; x += tile_width) {
            exr_chunk_info_t chunk;
            result = exr_read_tile_chunk_info(reader->context, 0, (int)(x / tile_width), (int)(y / tile_height), 0, 0,
                                              &chunk);
            if (result == EXR_ERR_SUCCESS)
                result = chunk_read(reader, &chunk, image, x, y);
        }
    }
    return result;
}

/* Whether the file has DWA compression, which OpenEXRCore 3.1 cannot decode, and the fallback decoder (R G B [A] or Y
 * only) can read it. */
static bool is_dwa(const ExrReader *reader)
{
    exr_compression_t compression = EXR_COMPRESSION_NONE;
    exr_get_compression(reader->context, 0, &compression);
    return (compression == EXR_COMPRESSION_DWAA || compression == EXR_COMPRESSION_DWAB) && !reader->layer &&
           (reader->channels >= 3 || strcmp(reader->names[0], "Y") == 0);
}

static bool part_read(ExrReader *reader, const char *path, Image *image, Error *error)
{
    exr_storage_t storage = EXR_STORAGE_SCANLINE;
    if (!header_read(reader, path, error))
        return false;
    /* Deflate expands at most 1032-fold, and a byte is at most half a pixel (one 16-bit channel). DWA deflates as
     * little as one such value per block of 64 pixels. */
    const ImageSize size = {reader->width, reader->height, is_dwa(reader) ? 64 * 516 : 516};
    if (!image_allocate_float(reader->file, path, size, reader->channels, image, error))
        return false;
    exr_get_storage(reader->context, 0, &storage);
    if (is_dwa(reader))
        return image_read_exr_dwa(path, image, error);
    exr_result_t result = storage == EXR_STORAGE_TILED ? tiles_read(reader, image) : scanlines_read(reader, image);
    if (result == EXR_ERR_SUCCESS)
        return true;
    return image_error(error, path, reader->message[0] ? reader->message : exr_get_default_error_message(result));
}

/* Opens the file with the library, reads the channels of reader->layer, and closes it. */
static bool exr_read(ExrReader *reader, const char *path, Image *image, Error *error)
{
    exr_context_initializer_t setup = EXR_DEFAULT_CONTEXT_INITIALIZER;
    setup.error_handler_fn = exr_message;
    setup.user_data = reader;
    setup.read_fn = exr_read_bytes;
    setup.size_fn = exr_file_size;
    setup.max_image_width = setup.max_image_height = IMAGE_SIDE_MAX;
    setup.max_tile_width = setup.max_tile_height = IMAGE_SIDE_MAX;
    setup.flags = EXR_CONTEXT_FLAG_DISABLE_CHUNK_RECONSTRUCTION;
    exr_result_t result = exr_start_read(&reader->context, path, &setup);
    bool good =
        result == EXR_ERR_SUCCESS
            ? part_read(reader, path, image, error)
            : image_error(error, path, reader->message[0] ? reader->message : exr_get_default_error_message(result));
    if (reader->decoding)
        exr_decoding_destroy(reader->context, &reader->decoder);
    exr_finish(&reader->context);
    return good;
}

bool image_read_exr(FILE *file, const char *path, Image *image, Error *error)
{
    ExrReader reader = {.file = file};
    return exr_read(&reader, path, image, error);
}

bool image_read_exr_layer(FILE *file, const char *path, const char *layer, Image *image, bool *found, Error *error)
{
    ExrReader reader = {.file = file, .layer = layer};
    Error complaint = {0};
    *found = exr_read(&reader, path, image, &complaint);
    if (!*found && !reader.absent)
        *error = complaint;
    return *found || reader.absent;
}
