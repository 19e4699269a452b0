/* Scratch folders for tests that write files. */
#ifndef TWINLIGHT_TESTS_SUPPORT_TEST_FILES_H
#define TWINLIGHT_TESTS_SUPPORT_TEST_FILES_H

#include <check.h>
#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static char test_folder[64];

static inline void test_folder_make(void)
{
    strcpy(test_folder, "./scratch-XXXXXX");
    ck_assert_ptr_nonnull(mkdtemp(test_folder));
}

static inline int test_folder_entries(void)
{
    int count = 0;
    DIR *folder = opendir(test_folder);
    for (struct dirent *entry = readdir(folder); entry; entry = readdir(folder))
        count += entry->d_name[0] != '.';
    closedir(folder);
    return count;
}

static inline void test_folder_remove(void)
{
    DIR *folder = opendir(test_folder);
    for (struct dirent *entry = readdir(folder); entry; entry = readdir(folder))
        unlinkat(dirfd(folder), entry->d_name, 0);
    closedir(folder);
    rmdir(test_folder);
}

/* "FOLDER/NAME", in one of a few buffers used in rotation. */
static inline const char *test_path(const char *name)
{
    static char paths[8][512];
    static int next;
    char *path = paths[next++ % 8];
    snprintf(path, sizeof paths[0], "%s/%s", test_folder, name);
    return path;
}

static inline void test_file_write(const char *path, const void *bytes, size_t size)
{
    unlink(path); /* file systems flush a file that is emptied and rewritten, but not a new one */
    FILE *file = fopen(path, "wb");
    ck_assert_ptr_nonnull(file);
    ck_assert_uint_eq(fwrite(bytes, 1, size, file), size);
    fclose(file);
}

/* The content of a file; the caller frees it. */
static inline unsigned char *test_file_read(const char *path, size_t *size)
{
    FILE *file = fopen(path, "rb");
    ck_assert_ptr_nonnull(file);
    fseek(file, 0, SEEK_END);
    *size = (size_t)ftell(file);
    rewind(file);
    unsigned char *bytes = malloc(*size + 1);
    ck_assert_uint_eq(fread(bytes, 1, *size, file), *size);
    fclose(file);
    return bytes;
}

/* A small generator for test data (Numerical Recipes' quick one). */
static inline unsigned test_random(unsigned *state)
{
    *state = *state * 1664525u + 1013904223u;
    return *state >> 8;
}

/* In [0, 1). */
static inline double test_random_unit(unsigned *state)
{
    return test_random(state) / 16777216.0;
}

#endif
