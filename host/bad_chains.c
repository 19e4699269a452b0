#include "bad_chains.h"

#include <errno.h>
#include <string.h>
#include <unistd.h>

bool bad_chains_begin(BadChains *bad, const char *path, Error *error)
{
    if (!path)
        return true;
    if (!output_file_begin(&bad->file, path, error))
        return false;
    int descriptor = dup(bad->file.descriptor);
    bad->stream = descriptor >= 0 ? fdopen(descriptor, "w") : NULL;
    if (bad->stream)
        return true;
    error_set(error, "cannot write %s: %s", path, strerror(errno));
    output_file_cancel(&bad->file);
    return false;
}

bool bad_chains_end(BadChains *bad, Error *error)
{
    if (!bad->stream)
        return true;
    bool written = !ferror(bad->stream);
    written = fclose(bad->stream) == 0 && written;
    bad->stream = NULL;
    if (written)
        return output_file_commit(&bad->file, error);
    error_set(error, "cannot write %s", bad->file.path);
    output_file_cancel(&bad->file);
    return false;
}

void bad_chains_cancel(BadChains *bad)
{
    if (!bad->stream)
        return;
    fclose(bad->stream);
    bad->stream = NULL;
    output_file_cancel(&bad->file);
}
