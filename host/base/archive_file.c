#include "base/archive_file.h"

#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zstd.h>
#include <zstd_errors.h>

/* Sums of the film are mostly noise: higher levels take several times as long for a few per cent. */
#define LEVEL 1

#define BUFFER_BYTES ((size_t)1 << 18)

/* ---- writing ----------------------------------------------------------------------------------------------------- */

/* Compresses `input` and writes what the stream gives. */
static bool stream_write(ArchiveWriter *writer, ZSTD_inBuffer *input, ZSTD_EndDirective directive, Error *error)
{
    size_t left;
    do {
        ZSTD_outBuffer output = {writer->buffer, BUFFER_BYTES, 0};
        left = ZSTD_compressStream2(writer->stream, &output, input, directive);
        if (ZSTD_isError(left))
            return error_set(error, "cannot write %s: %s", writer->file.path, ZSTD_getErrorName(left));
        if (output.pos > 0 && !output_file_bytes(&writer->file, writer->buffer, output.pos))
            return error_errno(error, "write", writer->file.path);
    } while (directive == ZSTD_e_end ? left > 0 : input->pos < input->size);
    return true;
}

static bool writer_transfer(void *context, void *bytes, size_t size, Error *error)
{
    ZSTD_inBuffer input = {bytes, size, 0};
    return stream_write(context, &input, ZSTD_e_continue, error);
}

bool archive_writer_begin(ArchiveWriter *writer, const char *path, int threads, Error *error)
{
    *writer = (ArchiveWriter){.file = {.descriptor = -1}};
    writer->archive = (Archive){.saves = true, .transfer = writer_transfer, .context = writer};
    writer->stream = ZSTD_createCCtx();
    writer->buffer = malloc(BUFFER_BYTES);
    if (!writer->stream || !writer->buffer)
        return error_memory(error, BUFFER_BYTES, "compression");
    ZSTD_CCtx_setParameter(writer->stream, ZSTD_c_compressionLevel, LEVEL);
    ZSTD_CCtx_setParameter(writer->stream, ZSTD_c_checksumFlag, 1);
    ZSTD_CCtx_setParameter(writer->stream, ZSTD_c_nbWorkers, threads); /* fails in a library without threads */
    if (!output_file_begin(&writer->file, path, error))
        return false;
    if (writer->file.temporary[0])
        return true;
    error_set(error, "cannot write %s: it is not a regular file", path);
    return error_fix(error, "give the name of a file that is to be created");
}

bool archive_writer_finish(ArchiveWriter *writer, Error *error)
{
    ZSTD_inBuffer nothing = {NULL, 0, 0};
    if (writer->archive.failed) {
        *error = writer->archive.error;
        return false;
    }
    if (!stream_write(writer, &nothing, ZSTD_e_end, error))
        return false;
    return fsync(writer->file.descriptor) == 0 || error_errno(error, "write", writer->file.path);
}

void archive_writer_destroy(ArchiveWriter *writer)
{
    ZSTD_freeCCtx(writer->stream);
    free(writer->buffer);
    output_file_cancel(&writer->file);
    *writer = (ArchiveWriter){.file = {.descriptor = -1}};
}

/* ---- reading ----------------------------------------------------------------------------------------------------- */

/* Reads the next part of the file into the empty buffer; sets an error, and `end` to 0, at the end of the file. */
static bool buffer_fill(ArchiveReader *reader, Error *error)
{
    ssize_t count;
    do
        count = read(reader->descriptor, reader->buffer, BUFFER_BYTES);
    while (count < 0 && errno == EINTR);
    reader->place = 0;
    reader->end = count > 0 ? (size_t)count : 0;
    if (count < 0)
        return error_set(error, "it cannot be read");
    return count > 0 || error_set(error, "its end is missing");
}

/* Decodes up to `size` bytes; *count: receives how many, fewer only at the end of the frame. */
static bool stream_read(ArchiveReader *reader, void *bytes, size_t size, size_t *count, Error *error)
{
    ZSTD_outBuffer output = {bytes, size, 0};
    while (output.pos < size && !reader->ended) {
        if (reader->place == reader->end && !buffer_fill(reader, error))
            return false;
        ZSTD_inBuffer input = {reader->buffer, reader->end, reader->place};
        size_t left = ZSTD_decompressStream(reader->stream, &output, &input);
        reader->place = input.pos;
        if (ZSTD_isError(left))
            return ZSTD_getErrorCode(left) == ZSTD_error_prefix_unknown
                       ? error_set(error, "it is another kind of file, not compressed by Zstandard")
                       : error_set(error, "%s", ZSTD_getErrorName(left));
        reader->ended = left == 0;
    }
    *count = output.pos;
    return true;
}

static bool reader_transfer(void *context, void *bytes, size_t size, Error *error)
{
    size_t count;
    return stream_read(context, bytes, size, &count, error) && (count == size || error_set(error, "it ends too early"));
}

static bool reader_rewind(ArchiveReader *reader, Error *error)
{
    ZSTD_DCtx_reset(reader->stream, ZSTD_reset_session_only);
    reader->place = reader->end = 0;
    reader->ended = false;
    return lseek(reader->descriptor, 0, SEEK_SET) == 0 || error_set(error, "it cannot be read twice");
}

/* Decodes everything, so that Zstandard compares the checksum, and nothing may follow. */
static bool reader_check(ArchiveReader *reader, Error *error)
{
    void *scratch = malloc(BUFFER_BYTES);
    size_t count = 1;
    Error end;
    if (!scratch)
        return error_memory(error, BUFFER_BYTES, "decompression");
    bool good = true;
    while (good && !reader->ended)
        good = stream_read(reader, scratch, BUFFER_BYTES, &count, error);
    free(scratch);
    if (!good)
        return false;
    if (reader->place < reader->end || buffer_fill(reader, &end))
        return error_set(error, "something follows its end");
    return reader_rewind(reader, error);
}

static bool reader_start(ArchiveReader *reader, const char *path, Error *error)
{
    struct stat status;
    if (reader->descriptor < 0)
        return error_errno(error, "read", path);
    if (fstat(reader->descriptor, &status) != 0 || !S_ISREG(status.st_mode))
        return error_set(error, "it is not a regular file");
    reader->stream = ZSTD_createDCtx();
    reader->buffer = malloc(BUFFER_BYTES);
    if (!reader->stream || !reader->buffer)
        return error_memory(error, BUFFER_BYTES, "decompression");
    return reader_check(reader, error);
}

bool archive_reader_open(ArchiveReader *reader, const char *path, Error *error)
{
    *reader = (ArchiveReader){.archive = {.transfer = reader_transfer, .context = reader}};
    reader->descriptor = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    if (reader_start(reader, path, error))
        return true;
    archive_reader_close(reader);
    return false;
}

bool archive_reader_finish(ArchiveReader *reader, Error *error)
{
    char more = 0;
    size_t count = 0;
    if (!reader->archive.failed && !stream_read(reader, &more, 1, &count, &reader->archive.error))
        reader->archive.failed = true;
    if (count > 0)
        archive_fail(&reader->archive, "it holds more than was expected");
    if (reader->archive.failed)
        *error = reader->archive.error;
    return !reader->archive.failed;
}

void archive_reader_close(ArchiveReader *reader)
{
    if (!reader->buffer && !reader->stream && reader->descriptor <= 0)
        return;
    ZSTD_freeDCtx(reader->stream);
    free(reader->buffer);
    close(reader->descriptor);
    *reader = (ArchiveReader){0};
}
