#include "image/exr.h"

#include "base/output_file.h"
#include "base/parallel.h"

#include <assert.h>
#include <errno.h>
#include <inttypes.h>
#include <openexr.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* The library's default, set explicitly so that files do not change if the default does. */
#define EXR_ZIP_LEVEL 4

typedef struct ExrWriter {
    OutputFile file;
    const ExrPicture *picture;
    const ExrChannel **channels; /* sorted by name */
    int width, height; /* of the data window */
    int write_errno; /* errno of the first failed write; 0: none */
    pthread_mutex_t mutex; /* of the message */
    char message[256]; /* the library's last error message */
} ExrWriter;

static void exr_message(exr_const_context_t context, exr_result_t code, const char *message)
{
    void *user = NULL;
    if (exr_get_user_data(context, &user) == EXR_ERR_SUCCESS && user) {
        ExrWriter *writer = user;
        pthread_mutex_lock(&writer->mutex);
        snprintf(writer->message, sizeof writer->message, "%s",
                 message ? message : exr_get_default_error_message(code));
        pthread_mutex_unlock(&writer->mutex);
    }
}

/* pwrite for the library: writes everything or returns -1. `report` is not called: the library holds its lock while it
 * writes the header, and reporting would take the lock again. */
static int64_t exr_write_bytes(exr_const_context_t context, void *user, const void *buffer, uint64_t size,
                               uint64_t offset, exr_stream_error_func_ptr_t report)
{
    ExrWriter *writer = user;
    uint64_t done = 0;
    (void)context;
    (void)report;
    while (done < size) {
        ssize_t n = pwrite(writer->file.descriptor, (const char *)buffer + done, size - done, (off_t)(offset + done));
        if (n < 0 && errno == EINTR)
            continue;
        if (n <= 0) {
            writer->write_errno = n < 0 ? errno : EIO;
            return -1;
        }
        done += (uint64_t)n;
    }
    return (int64_t)done;
}

static int channel_compare(const void *a, const void *b)
{
    return strcmp((*(const ExrChannel *const *)a)->name, (*(const ExrChannel *const *)b)->name);
}

/* x0 <= x < x1, y0 <= y < y1 as an EXR box, which includes its maximum. */
static exr_attr_box2i_t box_make(int x0, int y0, int x1, int y1)
{
    exr_attr_box2i_t box;
    box.min.x = x0;
    box.min.y = y0;
    box.max.x = x1 - 1;
    box.max.y = y1 - 1;
    return box;
}

ExrAttribute exr_text(const char *name, const char *text)
{
    return (ExrAttribute){.name = name, .kind = EXR_TEXT, .text = text};
}

ExrAttribute exr_whole(const char *name, uint64_t whole)
{
    return (ExrAttribute){.name = name, .kind = EXR_WHOLE, .whole = whole};
}

ExrAttribute exr_real(const char *name, double real)
{
    return (ExrAttribute){.name = name, .kind = EXR_REAL, .real = real};
}

ExrAttribute exr_matrix(const char *name, const float matrix[16])
{
    return (ExrAttribute){.name = name, .kind = EXR_MATRIX, .matrix = matrix};
}

static exr_result_t attribute_set(exr_context_t context, int part, const ExrAttribute *attribute)
{
    const char *name = attribute->name;
    char digits[24];
    exr_attr_m44f_t matrix;
    switch (attribute->kind) {
    case EXR_WHOLE:
        if (attribute->whole <= INT32_MAX)
            return exr_attr_set_int(context, part, name, (int32_t)attribute->whole);
        snprintf(digits, sizeof digits, "%" PRIu64, attribute->whole);
        return exr_attr_set_string(context, part, name, digits);
    case EXR_REAL:
        return exr_attr_set_float(context, part, name, (float)attribute->real);
    case EXR_MATRIX:
        for (int i = 0; i < 16; ++i)
            matrix.m[i] = attribute->matrix[i % 4 * 4 + i / 4];
        return exr_attr_set_m44f(context, part, name, &matrix);
    default:
        return exr_attr_set_string(context, part, name, attribute->text);
    }
}

/* Primaries and white of Rec. 709 and sRGB. */
static exr_result_t chromaticities_set(exr_context_t context, int part)
{
    const exr_attr_chromaticities_t srgb = {.red_x = 0.64f,
                                            .red_y = 0.33f,
                                            .green_x = 0.30f,
                                            .green_y = 0.60f,
                                            .blue_x = 0.15f,
                                            .blue_y = 0.06f,
                                            .white_x = 0.3127f,
                                            .white_y = 0.3290f};
    return exr_attr_set_chromaticities(context, part, "chromaticities", &srgb);
}

static exr_result_t header_write(exr_context_t context, const ExrWriter *writer)
{
    int part = 0;
    const ExrPicture *picture = writer->picture;
    const int *crop = picture->crop;
    exr_attr_box2i_t display = box_make(0, 0, picture->width, picture->height);
    exr_attr_box2i_t data = box_make(crop[0], crop[1], crop[2], crop[3]);
    exr_attr_v2f_t center = {.x = 0.0f, .y = 0.0f};
    exr_result_t result = exr_add_part(context, NULL, EXR_STORAGE_SCANLINE, &part);
    if (result == EXR_ERR_SUCCESS)
        result = exr_initialize_required_attr(context, part, &display, &data, 1.0f, &center, 1.0f,
                                              EXR_LINEORDER_INCREASING_Y, EXR_COMPRESSION_ZIP);
    if (result == EXR_ERR_SUCCESS)
        result = exr_set_zip_compression_level(context, part, EXR_ZIP_LEVEL);
    for (size_t i = 0; i < picture->channel_count && result == EXR_ERR_SUCCESS; ++i)
        result = exr_add_channel(context, part, writer->channels[i]->name,
                                 writer->channels[i]->half ? EXR_PIXEL_HALF : EXR_PIXEL_FLOAT,
                                 EXR_PERCEPTUALLY_LOGARITHMIC, 1, 1);
    for (size_t i = 0; i < picture->attribute_count && result == EXR_ERR_SUCCESS; ++i)
        result = attribute_set(context, part, &picture->attributes[i]);
    if (result == EXR_ERR_SUCCESS)
        result = chromaticities_set(context, part);
    return result == EXR_ERR_SUCCESS ? exr_write_header(context) : result;
}

float exr_half_range(float x)
{
    const float HALF_MAX = 65504.0f;
    return x > HALF_MAX ? HALF_MAX : x < -HALF_MAX ? -HALF_MAX : x;
}

/* ---- chunks ------------------------------------------------------------------------------------------------------ */

/* Chunks on their way to the file: lanes take the next one, compress it, and write in order. */
typedef struct ExrChunks {
    exr_context_t context;
    const ExrWriter *writer;
    const ExrLane *lanes;
    int rows; /* of a chunk */
    pthread_mutex_t mutex;
    pthread_cond_t changed;
    int next; /* first row that no lane has taken */
    int written; /* first row that is not in the file */
    exr_result_t result; /* of the first failure */
} ExrChunks;

typedef exr_result_t (*CompressFunction)(exr_encode_pipeline_t *encoder);

/* The chunk that a lane has taken. */
typedef struct ExrTask {
    ExrChunks *chunks;
    CompressFunction library; /* compresses */
    bool begun; /* the encoder is initialised */
    int row;
} ExrTask;

/* Gathers the lines from y on of every channel into the lane's plane and points the encoder at them: the library's
 * packing routine only takes contiguous planes. */
static void chunk_gather(const ExrWriter *writer, const ExrLane *lane, exr_encode_pipeline_t *encoder, int y, int lines)
{
    const ExrPicture *picture = writer->picture;
    size_t width = (size_t)writer->width, count = (size_t)lines * width, first = picture->band ? 0 : (size_t)y * width;
    if (picture->band)
        picture->band(lane->context, y, lines);
    for (size_t c = 0; c < picture->channel_count; ++c) {
        const ExrChannel *channel = &lane->channels[writer->channels[c] - picture->channels];
        const float *from = channel->data + first * channel->stride;
        float *to = lane->plane + c * count;
        for (size_t i = 0; i < count; ++i)
            to[i] = channel->half ? exr_half_range(from[i * channel->stride]) : from[i * channel->stride];
        exr_coding_channel_info_t *info = &encoder->channels[c];
        assert(strcmp(info->channel_name, channel->name) == 0);
        info->user_data_type = EXR_PIXEL_FLOAT;
        info->user_bytes_per_element = 4;
        info->user_pixel_stride = 4;
        info->user_line_stride = 4 * writer->width;
        info->encode_from_ptr = (const uint8_t *)to;
    }
}

/* A chunk that compression does not shrink must be stored uncompressed, which readers recognise by its size. OpenEXR
 * before 3.4.8 stores the compressed bytes if both sizes are equal, and readers then misread them as pixels
 * (AcademySoftwareFoundation/openexr issue 2306). */
static exr_result_t chunk_compress(exr_encode_pipeline_t *encoder)
{
    const ExrTask *task = encoder->encoding_user_data;
    exr_result_t result = task->library(encoder);
    if (result == EXR_ERR_SUCCESS && encoder->compressed_bytes == encoder->packed_bytes)
        memcpy(encoder->compressed_buffer, encoder->packed_buffer, encoder->packed_bytes);
    return result;
}

/* Waits until all chunks before this one are in the file. */
static exr_result_t chunk_wait(exr_encode_pipeline_t *encoder)
{
    const ExrTask *task = encoder->encoding_user_data;
    ExrChunks *chunks = task->chunks;
    pthread_mutex_lock(&chunks->mutex);
    while (chunks->result == EXR_ERR_SUCCESS && chunks->written < task->row)
        pthread_cond_wait(&chunks->changed, &chunks->mutex);
    exr_result_t result = chunks->result;
    pthread_mutex_unlock(&chunks->mutex);
    return result;
}

/* The next row to write; false if there is none. */
static bool chunk_take(ExrChunks *chunks, int *row)
{
    pthread_mutex_lock(&chunks->mutex);
    bool more = chunks->result == EXR_ERR_SUCCESS && chunks->next < chunks->writer->height;
    *row = chunks->next;
    chunks->next += more ? chunks->rows : 0;
    pthread_mutex_unlock(&chunks->mutex);
    return more;
}

static void chunk_finish(ExrChunks *chunks, int row, exr_result_t result)
{
    pthread_mutex_lock(&chunks->mutex);
    if (result == EXR_ERR_SUCCESS)
        chunks->written = row + chunks->rows;
    else if (chunks->result == EXR_ERR_SUCCESS)
        chunks->result = result;
    pthread_cond_broadcast(&chunks->changed);
    pthread_mutex_unlock(&chunks->mutex);
}

static exr_result_t chunk_write(ExrTask *task, const ExrLane *lane, exr_encode_pipeline_t *encoder)
{
    exr_context_t context = task->chunks->context;
    const ExrWriter *writer = task->chunks->writer;
    exr_chunk_info_t chunk;
    bool first = !task->begun;
    exr_result_t result = exr_write_scanline_chunk_info(context, 0, writer->picture->crop[1] + task->row, &chunk);
    if (result == EXR_ERR_SUCCESS)
        result = first ? exr_encoding_initialize(context, 0, &chunk, encoder)
                       : exr_encoding_update(context, 0, &chunk, encoder);
    if (result != EXR_ERR_SUCCESS)
        return result;
    task->begun = true;
    chunk_gather(writer, lane, encoder, task->row, chunk.height);
    if (first) {
        result = exr_encoding_choose_default_routines(context, 0, encoder);
        task->library = encoder->compress_fn;
        encoder->compress_fn = task->library ? chunk_compress : NULL;
        encoder->yield_until_ready_fn = chunk_wait;
        encoder->encoding_user_data = task;
    }
    return result == EXR_ERR_SUCCESS ? exr_encoding_run(context, 0, encoder) : result;
}

static void lane_run(void *context, size_t lane)
{
    ExrChunks *chunks = context;
    ExrTask task = {.chunks = chunks};
    exr_encode_pipeline_t encoder = EXR_ENCODE_PIPELINE_INITIALIZER;
    while (chunk_take(chunks, &task.row))
        chunk_finish(chunks, task.row, chunk_write(&task, &chunks->lanes[lane], &encoder));
    if (task.begun)
        exr_encoding_destroy(chunks->context, &encoder);
}

static exr_result_t chunks_write(exr_context_t context, const ExrWriter *writer, const ExrLane *lanes, int lane_count)
{
    ExrChunks chunks = {.context = context, .writer = writer, .lanes = lanes};
    int32_t rows = 1;
    exr_result_t result = exr_get_scanlines_per_chunk(context, 0, &rows);
    if (result != EXR_ERR_SUCCESS)
        return result;
    assert(rows <= EXR_BAND_ROWS);
    chunks.rows = rows;
    pthread_mutex_init(&chunks.mutex, NULL);
    pthread_cond_init(&chunks.changed, NULL);
    parallel_run((size_t)lane_count, lane_count, lane_run, &chunks);
    pthread_cond_destroy(&chunks.changed);
    pthread_mutex_destroy(&chunks.mutex);
    return chunks.result;
}

/* ---- the file ---------------------------------------------------------------------------------------------------- */

static bool channels_check(const ExrWriter *writer, const char *path, Error *error)
{
    for (size_t i = 1; i < writer->picture->channel_count; ++i)
        if (strcmp(writer->channels[i - 1]->name, writer->channels[i]->name) == 0)
            return error_set(error, "cannot write %s: two channels are named \"%s\"", path, writer->channels[i]->name);
    return true;
}

static bool exr_write_open(ExrWriter *writer, const char *path, const ExrLane *lanes, int lane_count, Error *error)
{
    exr_context_initializer_t setup = EXR_DEFAULT_CONTEXT_INITIALIZER;
    setup.error_handler_fn = exr_message;
    setup.user_data = writer;
    setup.write_fn = exr_write_bytes;
    exr_context_t context = NULL;
    exr_result_t result = exr_start_write(&context, path, EXR_WRITE_FILE_DIRECTLY, &setup);
    if (result == EXR_ERR_SUCCESS)
        result = header_write(context, writer);
    if (result == EXR_ERR_SUCCESS)
        result = chunks_write(context, writer, lanes, lane_count);
    exr_result_t finished = context ? exr_finish(&context) : EXR_ERR_SUCCESS;
    if (result == EXR_ERR_SUCCESS)
        result = finished;
    if (result == EXR_ERR_SUCCESS && !writer->write_errno)
        return true;
    error_set(error, "cannot write %s: %s", path,
              writer->write_errno  ? strerror(writer->write_errno)
              : writer->message[0] ? writer->message
                                   : exr_get_default_error_message(result));
    return error_fix_errno(error, writer->write_errno);
}

static bool picture_write(ExrWriter *writer, const char *path, const ExrLane *lanes, int lane_count, Error *error)
{
    const ExrPicture *picture = writer->picture;
    for (size_t i = 0; i < picture->channel_count; ++i)
        writer->channels[i] = &picture->channels[i];
    qsort(writer->channels, picture->channel_count, sizeof *writer->channels, channel_compare);
    bool good = channels_check(writer, path, error) && output_file_begin(&writer->file, path, error) &&
                exr_write_open(writer, path, lanes, lane_count, error) && output_file_commit(&writer->file, error);
    output_file_cancel(&writer->file);
    return good;
}

bool exr_write_picture(const char *path, const ExrPicture *picture, Error *error)
{
    const int *crop = picture->crop;
    ExrWriter writer = {
        .file = {.descriptor = -1}, .picture = picture, .width = crop[2] - crop[0], .height = crop[3] - crop[1]};
    size_t bytes = picture->channel_count * EXR_BAND_ROWS * (size_t)writer.width * sizeof(float);
    assert(picture->channel_count > 0 && writer.width > 0 && writer.height > 0);
    ExrLane own = {.channels = picture->channels};
    if (!picture->lanes)
        own.plane = malloc(bytes);
    writer.channels = calloc(picture->channel_count, sizeof *writer.channels);
    pthread_mutex_init(&writer.mutex, NULL);
    bool good = writer.channels && (picture->lanes || own.plane)
                    ? picture_write(&writer, path, picture->lanes ? picture->lanes : &own,
                                    picture->lanes ? picture->lane_count : 1, error)
                    : error_memory(error, bytes, "rows of an EXR file");
    pthread_mutex_destroy(&writer.mutex);
    free(writer.channels);
    free(own.plane);
    return good;
}

bool exr_write(const char *path, const ExrChannel *channels, size_t channel_count, int width, int height, Error *error)
{
    const ExrPicture picture = {.channels = channels,
                                .channel_count = channel_count,
                                .width = width,
                                .height = height,
                                .crop = {0, 0, width, height}};
    return exr_write_picture(path, &picture, error);
}
