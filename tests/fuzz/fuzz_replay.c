/* Runs a fuzzer's inputs once each, instead of libFuzzer; without arguments, those of CORPUS below srcdir. */
#include "fuzz/fuzz.h"

#include "base/file_read.h"

#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static int replayed;

/* In a buffer of its exact size, so that a sanitizer or valgrind detects reads past its end. */
static bool file_replay(const char *path)
{
    FileData file;
    Error error;
    if (!file_read(path, SIZE_MAX, (SourcePlace){0}, &file, &error)) {
        fprintf(stderr, "%s\n", error.message);
        return false;
    }
    LLVMFuzzerTestOneInput((const uint8_t *)file.data, file.size);
    free(file.data);
    ++replayed;
    return true;
}

static bool replay(const char *path)
{
    struct dirent **entries;
    int count = scandir(path, &entries, NULL, alphasort);
    if (count < 0)
        return file_replay(path);
    bool good = true;
    for (int i = 0; i < count; ++i) {
        char inner[2048];
        snprintf(inner, sizeof inner, "%s/%s", path, entries[i]->d_name);
        good = (entries[i]->d_name[0] == '.' || replay(inner)) && good;
        free(entries[i]);
    }
    free(entries);
    return good;
}

int main(int count, char **arguments)
{
    const char *source = getenv("srcdir");
    char path[1024];
    bool good = true;
    for (int i = 1; i < count; ++i)
        good = replay(arguments[i]) && good;
    const char *names = count > 1 ? "" : CORPUS;
    while (*names) {
        size_t length = strcspn(names, " ");
        snprintf(path, sizeof path, "%s/tests/%.*s", source ? source : ".", (int)length, names);
        good = replay(path) && good;
        names += length + (names[length] == ' ');
    }
    printf("%d inputs tried\n", replayed);
    return good && replayed > 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}
