#include "command/output_check.h"

#include "base/input_files.h"
#include "base/output_file.h"
#include "base/path_name.h"

#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

bool output_check(const char *path, Error *error)
{
    struct stat status;
    if (stat(path, &status) == 0 && S_ISDIR(status.st_mode)) {
        error_set(error, "cannot write %s: it is a folder", path);
        return error_fix(error, "give the name of a file in it");
    }
    OutputFile file = {.descriptor = -1};
    bool writable = output_file_begin(&file, path, error);
    output_file_cancel(&file);
    return writable;
}

static bool overwrites(Error *error, const CommandFile *file, const char *what, const char *fix)
{
    error_set(error, "%s would overwrite %s: %s", file->what, what, file->path);
    return error_fix(error, "%s", fix);
}

/* Checks `file` against files not named on the command line. Paths in /dev may lead to standard streams on purpose. */
static bool streams_check(const CommandFile *file, const char *fix, Error *error)
{
    static const char *const STREAMS[] = {"standard input", "standard output", "standard error"};
    struct stat status, stream;
    if (stat(file->path, &status) != 0 || !S_ISREG(status.st_mode))
        return true;
    if (input_file_noted(&status))
        return overwrites(error, file, "a file that the scene reads", fix);
    for (int i = 0; i < 3 && strncmp(file->path, "/dev/", 5) != 0; ++i)
        if (fstat(i, &stream) == 0 && stream.st_dev == status.st_dev && stream.st_ino == status.st_ino)
            return overwrites(error, file, STREAMS[i], fix);
    return true;
}

bool output_files_check(const CommandFile *files, size_t count, const char *fix, Error *error)
{
    for (size_t i = 0; i < count; ++i)
        for (size_t j = 0; j < count; ++j)
            if (files[i].path && files[i].written && files[j].path && (j < i || !files[j].written) &&
                path_same(files[i].path, files[j].path))
                return overwrites(error, &files[i], files[j].what, fix);
    for (size_t i = 0; i < count; ++i)
        if (files[i].path && files[i].written &&
            (!streams_check(&files[i], fix, error) || !output_check(files[i].path, error)))
            return false;
    return true;
}
