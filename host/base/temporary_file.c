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

/* Attempts at a name nobody has, or at a file that is not taken for a stray before it is locked. */
#define ATTEMPTS_MAX 100

/* Room for ".PROCESS-NUMBER~" behind a name. */
#define SUFFIX_MAX 32

/* ---- what a signal unlinks --------------------------------------------------------------------------------------- */

/* Files written at a time: image or PNG, and a list of bad chains. Beyond, files are left to the next process. */
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

/* Unlinks a file that nobody holds the lock of. A process number would say less: it may have been given to another
 * process since, or belong to another machine that writes to the same folder. The kernel drops a lock with its process,
 * and locks are shared by the machines of a network file system. Where a file system has none, strays stay. */
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

/* Locks a new file; false when another process took it for a stray before that. Without locks there are no strays. */
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
        name_keep(name); /* before it exists, for a signal may come at any time */
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
