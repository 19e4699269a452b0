#include "base/input_files.h"

#include <pthread.h>
#include <stdlib.h>

typedef struct InputFile {
    struct InputFile *next;
    dev_t device;
    ino_t inode;
} InputFile;

static pthread_mutex_t mutex = PTHREAD_MUTEX_INITIALIZER;
static InputFile *files;

/* When out of memory the file is not recorded; reading the scene will fail soon anyway. */
void input_file_note(int descriptor)
{
    struct stat status;
    InputFile *file = fstat(descriptor, &status) == 0 ? malloc(sizeof *file) : NULL;
    if (!file)
        return;
    pthread_mutex_lock(&mutex);
    *file = (InputFile){.next = files, .device = status.st_dev, .inode = status.st_ino};
    files = file;
    pthread_mutex_unlock(&mutex);
}

bool input_file_noted(const struct stat *status)
{
    pthread_mutex_lock(&mutex);
    const InputFile *file = files;
    while (file && (file->device != status->st_dev || file->inode != status->st_ino))
        file = file->next;
    pthread_mutex_unlock(&mutex);
    return file != NULL;
}
