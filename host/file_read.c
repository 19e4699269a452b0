#include "file_read.h"

#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* 0, or the errno that says why the file is not read. */
static int status_refusal(const struct stat *status, size_t limit)
{
    if (S_ISDIR(status->st_mode))
        return EISDIR;
    if (!S_ISREG(status->st_mode))
        return ENOTSUP;
    return (unsigned long long)status->st_size > limit ? EFBIG : 0;
}

static int bytes_read(int descriptor, char *data, size_t size, size_t *used)
{
    *used = 0;
    while (*used < size) {
        ssize_t got = read(descriptor, data + *used, size - *used);
        if (got < 0 && errno != EINTR)
            return errno;
        if (got == 0)
            break;
        *used += got > 0 ? (size_t)got : 0;
    }
    return 0;
}

static int descriptor_read(int descriptor, size_t limit, FileData *file)
{
    struct stat status;
    if (fstat(descriptor, &status) != 0)
        return errno;
    int refusal = status_refusal(&status, limit);
    if (refusal != 0)
        return refusal;
    size_t size = (size_t)status.st_size;
    *file = (FileData){.data = malloc(size > 0 ? size : 1), .device = status.st_dev, .inode = status.st_ino};
    if (!file->data)
        return ENOMEM;
    int failure = bytes_read(descriptor, file->data, size, &file->size);
    if (failure != 0) {
        free(file->data);
        file->data = NULL;
    }
    return failure;
}

bool file_read(const char *path, size_t limit, SourcePlace place, FileData *file, Error *error)
{
    *file = (FileData){0};
    /* O_NONBLOCK: a FIFO without a writer must not hang the program. */
    int descriptor = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    int failure = descriptor < 0 ? errno : descriptor_read(descriptor, limit, file);
    if (descriptor >= 0)
        close(descriptor);
    if (failure == 0)
        return true;
    error_at(error, place, "cannot read %s: %s", path, strerror(failure));
    return error_fix_errno(error, failure);
}
