#include "output_file.h"

#include <errno.h>
#include <fcntl.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* Where `path` leads: symbolic links are followed, so that a rename replaces the file and not the link. */
static bool target_set(OutputFile *file, const char *path, Error *error)
{
    if (strlen(path) >= sizeof file->path - 32) {
        errno = ENAMETOOLONG;
        return error_errno(error, "write", path);
    }
    if (!realpath(path, file->path))
        strcpy(file->path, path);
    return true;
}

bool output_file_begin(OutputFile *file, const char *path, Error *error)
{
    static atomic_uint counter;
    struct stat status;
    *file = (OutputFile){.descriptor = -1};
    if (!target_set(file, path, error))
        return false;
    bool exists = stat(file->path, &status) == 0;
    if (exists && S_ISDIR(status.st_mode)) {
        errno = EISDIR;
        return error_errno(error, "write", path);
    }
    if (exists && !S_ISREG(status.st_mode)) {
        /* A device or pipe must be written to, not replaced. */
        file->descriptor = open(file->path, O_WRONLY | O_CLOEXEC);
        return file->descriptor >= 0 || error_errno(error, "write", path);
    }
    if (exists && access(file->path, W_OK) != 0)
        return error_errno(error, "write", path);
    do {
        snprintf(file->temporary, sizeof file->temporary, "%.*s.%ld-%u~", (int)(sizeof file->temporary - 32),
                 file->path, (long)getpid(), atomic_fetch_add(&counter, 1u));
        file->descriptor = open(file->temporary, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    } while (file->descriptor < 0 && errno == EEXIST);
    if (file->descriptor < 0) {
        file->temporary[0] = '\0';
        error_errno(error, "write", path);
        return error_fix(error, "the folder must exist and be writable");
    }
    return true;
}

bool output_file_commit(OutputFile *file, Error *error)
{
    bool closed = close(file->descriptor) == 0;
    file->descriptor = -1;
    if (!closed || (file->temporary[0] && rename(file->temporary, file->path) != 0)) {
        error_errno(error, "write", file->path);
        output_file_cancel(file);
        return false;
    }
    file->temporary[0] = '\0';
    return true;
}

void output_file_cancel(OutputFile *file)
{
    if (file->descriptor >= 0)
        close(file->descriptor);
    if (file->temporary[0])
        unlink(file->temporary);
    file->descriptor = -1;
    file->temporary[0] = '\0';
}

static bool bytes_write(int descriptor, const unsigned char *bytes, size_t size)
{
    while (size > 0) {
        ssize_t n = write(descriptor, bytes, size);
        if (n < 0 && errno == EINTR)
            continue;
        if (n <= 0)
            return false;
        bytes += n;
        size -= (size_t)n;
    }
    return true;
}

bool output_file_write(const char *path, const void *bytes, size_t size, Error *error)
{
    OutputFile file;
    if (!output_file_begin(&file, path, error))
        return false;
    bool good = bytes_write(file.descriptor, bytes, size) || error_errno(error, "write", path);
    good = good && output_file_commit(&file, error);
    output_file_cancel(&file);
    return good;
}
