#include "base/path_name.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>
#include <unistd.h>

/* Linux's own limit. */
#define LINKS_MAX 40

bool path_ends(const char *path, const char *ending)
{
    size_t length = strlen(path), tail = strlen(ending);
    return length > tail && strcasecmp(path + length - tail, ending) == 0;
}

const char *path_file_name(const char *path)
{
    const char *slash = strrchr(path, '/');
    return slash ? slash + 1 : path;
}

void path_folder(const char *path, char folder[PATH_MAX])
{
    size_t length = (size_t)(path_file_name(path) - path);
    if (length == 0)
        strcpy(folder, ".");
    else
        snprintf(folder, PATH_MAX, "%.*s", (int)(length > 1 ? length - 1 : 1), path);
}

/* path = FOLDER/NAME; false with errno set if that is too long. */
static bool path_join(char path[PATH_MAX], const char *folder, const char *name)
{
    const char *slash = folder[0] && folder[strlen(folder) - 1] == '/' ? "" : "/";
    int length = snprintf(path, PATH_MAX, "%s%s%s", folder, slash, name);
    if (length >= 0 && length < PATH_MAX)
        return true;
    errno = ENAMETOOLONG;
    return false;
}

/* Replaces `path`, a symbolic link, by its target `link`. */
static bool link_follow(char path[PATH_MAX], const char *link)
{
    char folder[PATH_MAX];
    if (link[0] == '/') {
        strcpy(path, link);
        return true;
    }
    path_folder(path, folder);
    return path_join(path, folder, link);
}

/* For a file that does not exist: target = its name in its resolved folder, or the path unchanged if the folder does
 * not exist either. */
static bool missing_target(const char *path, char target[PATH_MAX])
{
    char folder[PATH_MAX], real[PATH_MAX];
    path_folder(path, folder);
    if (realpath(folder, real))
        return path_join(target, real, path_file_name(path));
    strcpy(target, path);
    return true;
}

bool path_target(const char *path, char target[PATH_MAX])
{
    char text[PATH_MAX], link[PATH_MAX];
    if (strlen(path) >= PATH_MAX) {
        errno = ENAMETOOLONG;
        return false;
    }
    strcpy(text, path);
    for (int links = 0; links < LINKS_MAX; ++links) {
        if (realpath(text, target))
            return true;
        ssize_t length = readlink(text, link, sizeof link - 1);
        if (length < 0)
            return missing_target(text, target);
        link[length] = '\0';
        if (!link_follow(text, link))
            return false;
    }
    errno = ELOOP;
    return false;
}

bool path_same(const char *a, const char *b)
{
    struct stat status_a, status_b;
    char target_a[PATH_MAX], target_b[PATH_MAX];
    bool there_a = stat(a, &status_a) == 0, there_b = stat(b, &status_b) == 0;
    if (there_a && there_b)
        return S_ISREG(status_a.st_mode) && status_a.st_dev == status_b.st_dev && status_a.st_ino == status_b.st_ino;
    return !there_a && !there_b && path_target(a, target_a) && path_target(b, target_b) &&
           strcmp(target_a, target_b) == 0;
}
