#include "mmlt/bad_chains.h"

bool bad_chains_begin(BadChains *bad, const char *path, Error *error)
{
    if (!path)
        return true;
    if (!output_file_begin(&bad->file, path, error))
        return false;
    bad->stream = output_file_stream(&bad->file, error);
    return bad->stream != NULL;
}

bool bad_chains_end(BadChains *bad, Error *error)
{
    FILE *stream = bad->stream;
    bad->stream = NULL;
    return !stream || output_file_stream_commit(&bad->file, stream, error);
}

void bad_chains_cancel(BadChains *bad)
{
    if (!bad->stream)
        return;
    fclose(bad->stream);
    bad->stream = NULL;
    output_file_cancel(&bad->file);
}
