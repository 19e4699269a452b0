#include "base/temporary_file.h"

#include "base/path_name.h"

#include <ctype.h>
#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

/* Attempts to find an unused name and to lock the file before another process takes it for a stray. */
#define ATTEMPTS_MAX 100

/* Room for the suffix ".PROCESS-NUMBER~". */
#define SUFFIX_MAX 32

/* ---- files to unlink on a signal --------------------------------------------------------------------------------- */

/* Files that may be open at a time: image or PNG, and a list of bad chains. A signal does not unlink further ones; they
 * become strays. */
#define NAMES_MAX 8

typedef enum NameState { NAME_FREE, NAME_CHANGING, NAME_VALID } NameState;

static struct {
    atomic_int state;
    char name[PATH_MAX];
} names[NAMES_MAX];
_Static_assert(ATOMIC_INT_LOCK_FREE == 2, "a signal handler may only touch lock-free atomics");

static void name_keep(const char *name)
{
    for (int i = 0; i < NAMES_MAX; ++i) {
        int expected = NAME_FREE;
        if (!atomic_compare_exchange_strong(&names[i].state, &expected, NAME_CHANGING))
            continue;
        strcpy(names[i].name, name);
        atomic_store(&names[i].state, NAME_VALID);
        return;
    }
}

void temporary_file_forget(const char *name)
{
    for (int i = 0; i < NAMES_MAX; ++i)
        if (atomic_load(&names[i].state) == NAME_VALID && strcmp(names[i].name, name) == 0)
            atomic_store(&names[i].state, NAME_FREE);
}

void temporary_files_unlink(void)
{
    for (int i = 0; i < NAMES_MAX; ++i)
        if (atomic_load(&names[i].state) == NAME_VALID)
            unlink(names[i].name);
}

/* ---- strays ------------------------------------------------------------------------------------------------------ */

/* Whether `entry` is "NAME.DIGITS-DIGITS~". */
static bool is_temporary_of(const char *entry, const char *name)
{
    size_t length = strlen(name);
    if (strncmp(entry, name, length) != 0 || entry[length] != '.')
        return false;
    const char *process = entry + length + 1, *number = process;
    while (isdigit((unsigned char)*number))
        ++number;
    if (number == process || *number != '-')
        return false;
    const char *end = ++number;
    while (isdigit((unsigned char)*end))
        ++end;
    return end > number && strcmp(end, "~") == 0;
}

/* Unlinks a file whose lock nobody holds. A process id would be less reliable: it may have been reused, or belong to
 * another machine that writes to the same folder. The kernel releases locks when a process ends, and machines share the
 * locks of a network file system. On a file system without locks, strays are kept. */
static void stray_remove(int folder, const char *name)
{
    struct stat status;
    int descriptor = openat(folder, name, O_WRONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK);
    if (descriptor < 0)
        return;
    if (fstat(descriptor, &status) == 0 && S_ISREG(status.st_mode) && flock(descriptor, LOCK_EX | LOCK_NB) == 0)
        unlinkat(folder, name, 0);
    close(descriptor);
}

static void strays_remove(const char *path)
{
    char folder[PATH_MAX];
    path_folder(path, folder);
    DIR *entries = opendir(folder);
    if (!entries)
        return;
    for (const struct dirent *entry = readdir(entries); entry; entry = readdir(entries))
        if (is_temporary_of(entry->d_name, path_file_name(path)))
            stray_remove(dirfd(entries), entry->d_name);
    closedir(entries);
}

/* ---- creation ---------------------------------------------------------------------------------------------------- */

/* Locks a new file; false if another process removed it as a stray first. On file systems without locks nobody does. */
static bool lock_new(int descriptor)
{
    struct stat status;
    if (flock(descriptor, LOCK_EX | LOCK_NB) != 0)
        return errno != EWOULDBLOCK;
    return fstat(descriptor, &status) == 0 && status.st_nlink > 0;
}

int temporary_file_create(const char *path, char name[PATH_MAX])
{
    static atomic_uint counter;
    strays_remove(path);
    for (int attempt = 0; attempt < ATTEMPTS_MAX; ++attempt) {
        snprintf(name, PATH_MAX, "%.*s.%ld-%u~", PATH_MAX - SUFFIX_MAX, path, (long)getpid(),
                 atomic_fetch_add(&counter, 1u));
        name_keep(name); /* before the file exists, because a signal may arrive at any time */
        int descriptor = open(name, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        if (descriptor >= 0 && lock_new(descriptor))
            return descriptor;
        if (descriptor >= 0)
            close(descriptor);
        temporary_file_forget(name);
        if (descriptor < 0 && errno != EEXIST)
            return -1;
    }
    errno = EEXIST;
    return -1;
}
