#include "base/output_file.h"

#include "base/path_name.h"
#include "base/temporary_file.h"

#include <errno.h>
#include <fcntl.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* Resolves symbolic links, whether or not the target exists: a rename must replace the file, not the link. */
static bool target_set(OutputFile *file, const char *path, Error *error)
{
    if (!path_target(path, file->path))
        return error_errno(error, "write", path);
    if (strlen(file->path) >= sizeof file->path - 32) {
        errno = ENAMETOOLONG;
        return error_errno(error, "write", path);
    }
    return true;
}

bool output_file_begin(OutputFile *file, const char *path, Error *error)
{
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
        /* A device or pipe is written to, not replaced. */
        file->descriptor = open(file->path, O_WRONLY | O_CLOEXEC);
        return file->descriptor >= 0 || error_errno(error, "write", path);
    }
    if (exists && access(file->path, W_OK) != 0)
        return error_errno(error, "write", path);
    file->descriptor = temporary_file_create(file->path, file->temporary);
    if (file->descriptor < 0) {
        file->temporary[0] = '\0';
        error_errno(error, "write", path);
        return error_fix(error, "the folder must exist and be writable");
    }
    return true;
}

/* Makes the new directory entry survive a power failure. Errors are ignored: not every file system supports this. */
static void folder_synchronize(const char *path)
{
    char folder[PATH_MAX];
    path_folder(path, folder);
    int descriptor = open(folder, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (descriptor < 0)
        return;
    (void)!fsync(descriptor);
    close(descriptor);
}

/* fsync comes before rename: otherwise a power failure may leave an empty file under the new name. close comes after,
 * because the lock keeps other processes from removing the file; fsync has already reported any error close could. */
static bool temporary_commit(OutputFile *file)
{
    if (fsync(file->descriptor) != 0 || rename(file->temporary, file->path) != 0)
        return false;
    temporary_file_forget(file->temporary);
    file->temporary[0] = '\0';
    folder_synchronize(file->path);
    close(file->descriptor);
    return true;
}

bool output_file_commit(OutputFile *file, Error *error)
{
    bool good = file->temporary[0] ? temporary_commit(file) : close(file->descriptor) == 0;
    if (good || !file->temporary[0])
        file->descriptor = -1;
    if (!good)
        error_errno(error, "write", file->path);
    output_file_cancel(file);
    return good;
}

void output_file_cancel(OutputFile *file)
{
    if (file->temporary[0]) {
        unlink(file->temporary);
        temporary_file_forget(file->temporary);
    }
    if (file->descriptor >= 0)
        close(file->descriptor);
    file->descriptor = -1;
    file->temporary[0] = '\0';
}

bool output_file_bytes(OutputFile *file, const void *bytes, size_t size)
{
    const unsigned char *next = bytes;
    while (size > 0) {
        ssize_t n = write(file->descriptor, next, size);
        if (n < 0 && errno == EINTR)
            continue;
        if (n <= 0)
            return false;
        next += n;
        size -= (size_t)n;
    }
    return true;
}

FILE *output_file_stream(OutputFile *file, Error *error)
{
    int descriptor = fcntl(file->descriptor, F_DUPFD_CLOEXEC, 0);
    FILE *stream = descriptor >= 0 ? fdopen(descriptor, "w") : NULL;
    if (stream)
        return stream;
    error_errno(error, "write", file->path);
    if (descriptor >= 0)
        close(descriptor);
    output_file_cancel(file);
    return NULL;
}

bool output_file_stream_commit(OutputFile *file, FILE *stream, Error *error)
{
    bool failed = ferror(stream) != 0;
    if (fclose(stream) == 0 && !failed)
        return output_file_commit(file, error);
    error_errno(error, "write", file->path);
    output_file_cancel(file);
    return false;
}

bool output_file_write(const char *path, const void *bytes, size_t size, Error *error)
{
    OutputFile file;
    if (!output_file_begin(&file, path, error))
        return false;
    bool good = output_file_bytes(&file, bytes, size) || error_errno(error, "write", path);
    good = good && output_file_commit(&file, error);
    output_file_cancel(&file);
    return good;
}
