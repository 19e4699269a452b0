#include "base/gzip.h"

#include <zlib.h>

#define PIECE_SMALL ((size_t)1 << 16) /* bytes made room for at a time, of files below 1 MiB and of others */
#define PIECE_LARGE ((size_t)1 << 24)

bool gzip_is(const char *data, size_t size)
{
    return size >= 2 && (unsigned char)data[0] == 0x1f && (unsigned char)data[1] == 0x8b;
}

static bool size_check(size_t size, size_t limit, Error *error)
{
    if (size <= limit)
        return true;
    error_set(error, "the gzip'd data are more than %zu GiB", (limit + ((size_t)1 << 30) - 1) >> 30);
    return error_fix(error, "divide them among several files");
}

/* Decompresses until the output has another piece, or to the end of the data. *left: bytes that the stream has not been
 * given yet. */
static bool piece_inflate(z_stream *stream, size_t *left, size_t piece, Array *out, int *status, Error *error)
{
    if (stream->avail_in == 0) {
        stream->avail_in = (uInt)(*left < (1u << 30) ? *left : 1u << 30);
        *left -= stream->avail_in;
    }
    size_t used = out->count;
    char *target = array_grow(out, piece, error);
    if (!target)
        return false;
    stream->next_out = (Bytef *)target;
    stream->avail_out = (uInt)piece;
    *status = inflate(stream, Z_NO_FLUSH);
    out->count = used + piece - stream->avail_out;
    return true;
}

/* window: inflateInit2's, which tells the format as well. */
static bool data_inflate(const char *data, size_t size, int window, size_t limit, Array *out, Error *error)
{
    z_stream stream = {.next_in = (Bytef *)data};
    size_t left = size, piece = size < ((size_t)1 << 20) ? PIECE_SMALL : PIECE_LARGE;
    if (inflateInit2(&stream, window) != Z_OK)
        return error_memory(error, 65536, "zlib");
    int status = Z_OK;
    bool good = true;
    while (good && (status == Z_OK || (status == Z_STREAM_END && stream.avail_in + left > 0))) {
        if (status == Z_STREAM_END && inflateReset(&stream) != Z_OK)
            break;
        good = piece_inflate(&stream, &left, piece, out, &status, error) && size_check(out->count, limit, error);
    }
    inflateEnd(&stream);
    if (!good || status == Z_STREAM_END)
        return good;
    error_set(error, "the gzip'd data are damaged or incomplete");
    return error_fix(error, "make the file again");
}

bool gzip_inflate(const char *data, size_t size, size_t limit, Array *out, Error *error)
{
    return data_inflate(data, size, 16 + MAX_WBITS, limit, out, error);
}

bool zlib_inflate(const char *data, size_t size, size_t limit, Array *out, Error *error)
{
    return data_inflate(data, size, MAX_WBITS, limit, out, error);
}
