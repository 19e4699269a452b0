#include "base/file_read.h"

#include "base/input_files.h"

#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* 0, or the errno of why the file is refused. */
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

bool file_read_error(const char *path, int failure, SourcePlace place, Error *error)
{
    error_at(error, place, "cannot read %s: %s", path, strerror(failure));
    return error_fix_errno(error, failure);
}

bool file_open(const char *path, size_t limit, SourcePlace place, FileOpened *file, Error *error)
{
    struct stat status;
    /* O_NONBLOCK: a FIFO without a writer must not hang the program. */
    int descriptor = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    int failure = descriptor < 0 || fstat(descriptor, &status) != 0 ? errno : status_refusal(&status, limit);
    if (failure != 0) {
        if (descriptor >= 0)
            close(descriptor);
        file_read_error(path, failure, place, error);
        return false;
    }
    input_file_note(descriptor);
    *file = (FileOpened){descriptor, (size_t)status.st_size, status.st_dev, status.st_ino};
    return true;
}

bool file_read_stream(int descriptor, const char *name, size_t limit, FileData *file, Error *error)
{
    size_t room = 0, got = 1;
    int failure = 0;
    *file = (FileData){0};
    while (failure == 0 && got > 0 && file->size <= limit) {
        if (file->size == room) {
            room = room > 0 ? 2 * room : (size_t)1 << 16;
            char *more = realloc(file->data, room);
            failure = more ? 0 : ENOMEM;
            file->data = more ? more : file->data;
        }
        if (failure == 0)
            failure = bytes_read(descriptor, file->data + file->size, room - file->size, &got);
        file->size += failure == 0 ? got : 0;
    }
    if (failure == 0 && file->size > limit)
        failure = EFBIG;
    if (failure == 0)
        return true;
    free(file->data);
    *file = (FileData){0};
    return file_read_error(name, failure, (SourcePlace){0}, error);
}

bool file_read(const char *path, size_t limit, SourcePlace place, FileData *file, Error *error)
{
    FileOpened opened;
    *file = (FileData){0};
    if (!file_open(path, limit, place, &opened, error))
        return false;
    file->data = malloc(opened.size > 0 ? opened.size : 1);
    int failure = file->data ? bytes_read(opened.descriptor, file->data, opened.size, &file->size) : ENOMEM;
    close(opened.descriptor);
    if (failure == 0)
        return true;
    free(file->data);
    file->data = NULL;
    return file_read_error(path, failure, place, error);
}
