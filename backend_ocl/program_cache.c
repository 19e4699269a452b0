#include "program_cache.h"

#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* Header of every file: identification, and a checksum of the contents. */
typedef struct CacheHeader {
    char magic[16];
    uint64_t key[2];
    uint64_t size;
    uint64_t check;
} CacheHeader;

#define CACHE_MAGIC "twinlight prog 1"
#define CACHE_SIZE_MAX ((uint64_t)1 << 30)

/* ---- hashes ------------------------------------------------------------------------------------------------------ */

/* 64-bit FNV-1a. Two hashes with different start values make a 128-bit key. */
static uint64_t hash_bytes(uint64_t hash, const void *bytes, size_t size)
{
    const unsigned char *p = bytes;
    for (size_t i = 0; i < size; ++i)
        hash = (hash ^ p[i]) * 0x100000001b3u;
    return hash;
}

CacheKey cache_key(const char *const *strings, int count)
{
    CacheKey key = {{0xcbf29ce484222325u, 0x6c62272e07bb0142u}};
    for (int i = 0; i < count; ++i)
        for (int k = 0; k < 2; ++k) {
            key.hash[k] = hash_bytes(key.hash[k], strings[i], strlen(strings[i]) + 1);
            key.hash[k] ^= key.hash[k] >> (29 + k); /* with FNV alone, both halves would stay correlated */
        }
    return key;
}

static uint64_t header_check(CacheKey key, const unsigned char *binary, size_t size)
{
    return hash_bytes(key.hash[0] ^ key.hash[1], binary, size);
}

/* ---- paths ------------------------------------------------------------------------------------------------------- */

/* The cache's folder. A relative XDG_CACHE_HOME is ignored (XDG Base Directory Specification). */
static bool cache_folder(char *folder, size_t size)
{
    const char *base = getenv("XDG_CACHE_HOME"), *home = getenv("HOME");
    int length;
    if (base && base[0] == '/')
        length = snprintf(folder, size, "%s/twinlight", base);
    else if (home && home[0] == '/')
        length = snprintf(folder, size, "%s/.cache/twinlight", home);
    else
        return false;
    return length > 0 && (size_t)length < size;
}

static bool cache_path(CacheKey key, char *path, size_t size)
{
    char folder[PATH_MAX - 64];
    if (!cache_folder(folder, sizeof folder))
        return false;
    snprintf(path, size, "%s/%016llx%016llx.program", folder, (unsigned long long)key.hash[0],
             (unsigned long long)key.hash[1]);
    return true;
}

/* Creates all parent folders of `path` with mode 0700, as the XDG specification asks. */
static void folders_make(char *path)
{
    for (char *slash = strchr(path + 1, '/'); slash; slash = strchr(slash + 1, '/')) {
        *slash = '\0';
        mkdir(path, 0700);
        *slash = '/';
    }
}

/* ---- reading and writing ----------------------------------------------------------------------------------------- */

static unsigned char *entry_read(FILE *file, CacheKey key, size_t *size)
{
    CacheHeader header;
    if (fread(&header, sizeof header, 1, file) != 1 || memcmp(header.magic, CACHE_MAGIC, sizeof header.magic) != 0 ||
        header.key[0] != key.hash[0] || header.key[1] != key.hash[1] || header.size > CACHE_SIZE_MAX)
        return NULL;
    unsigned char *binary = malloc((size_t)header.size + 1);
    if (!binary)
        return NULL;
    /* reading one byte more than the size detects excess data */
    if (fread(binary, 1, (size_t)header.size + 1, file) == header.size &&
        header_check(key, binary, (size_t)header.size) == header.check) {
        *size = (size_t)header.size;
        return binary;
    }
    free(binary);
    return NULL;
}

unsigned char *cache_read(CacheKey key, size_t *size)
{
    char path[PATH_MAX];
    FILE *file = cache_path(key, path, sizeof path) ? fopen(path, "rb") : NULL;
    if (!file)
        return NULL;
    unsigned char *binary = entry_read(file, key, size);
    fclose(file);
    return binary;
}

static bool entry_write(int descriptor, CacheKey key, const unsigned char *binary, size_t size)
{
    CacheHeader header = {.key = {key.hash[0], key.hash[1]}, .size = size, .check = header_check(key, binary, size)};
    memcpy(header.magic, CACHE_MAGIC, sizeof header.magic);
    FILE *file = fdopen(descriptor, "wb");
    if (!file) {
        close(descriptor);
        return false;
    }
    bool written = fwrite(&header, sizeof header, 1, file) == 1 && fwrite(binary, 1, size, file) == size;
    return fclose(file) == 0 && written;
}

bool cache_write(CacheKey key, const unsigned char *binary, size_t size, char *path)
{
    char temporary[PATH_MAX + 8];
    path[0] = '\0';
    if (!cache_path(key, path, PATH_MAX))
        return false;
    folders_make(path);
    snprintf(temporary, sizeof temporary, "%s.XXXXXX", path);
    int descriptor = mkstemp(temporary);
    if (descriptor < 0)
        return false;
    if (entry_write(descriptor, key, binary, size) && rename(temporary, path) == 0)
        return true;
    unlink(temporary);
    return false;
}
