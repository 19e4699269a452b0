/* Arbitrary bytes as a glTF file or, if they do not begin with 'g', as its JSON after the first byte, in a .glb whose
 * binary chunk is a square with normals, texture coordinates and indices, and an image. */
#include "fuzz/fuzz.h"
#include "fuzz/fuzz_file.h"

#include "base/log.h"
#include "gltf/gltf.h"

#include <stdlib.h>
#include <string.h>

/* Of 280 bytes: 4 positions at 0, normals at 48, texture coordinates at 96, 6 indices of 16 bits at 128, a PNG of 2 x 2
 * pixels of 86 bytes at 140. */
static const float SQUARE[] = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 0, 0, 1, 0,
                               0, 1, 0, 0, 1, 0, 0, 1, 0, 1, 1, 1, 1, 0, 0, 0};
static const uint16_t INDICES[] = {0, 1, 2, 0, 2, 3};
static const unsigned char PNG[] = {
    0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a, 0x00, 0x00, 0x00, 0x0d, 0x49, 0x48, 0x44, 0x52, 0x00, 0x00,
    0x00, 0x02, 0x00, 0x00, 0x00, 0x02, 0x08, 0x06, 0x00, 0x00, 0x00, 0x72, 0xb6, 0x0d, 0x24, 0x00, 0x00, 0x00,
    0x1d, 0x49, 0x44, 0x41, 0x54, 0x78, 0x01, 0x01, 0x12, 0x00, 0xed, 0xff, 0x00, 0xff, 0x00, 0x00, 0xff, 0x00,
    0xff, 0x00, 0x80, 0x00, 0x00, 0x00, 0xff, 0x40, 0x80, 0x40, 0x20, 0x00, 0x3a, 0x21, 0x05, 0x9d, 0xd2, 0xa7,
    0xa8, 0xf0, 0x00, 0x00, 0x00, 0x00, 0x49, 0x45, 0x4e, 0x44, 0xae, 0x42, 0x60, 0x82};
#define BINARY_SIZE 280

static void word_put(unsigned char *at, size_t word)
{
    for (int i = 0; i < 4; ++i)
        at[i] = (unsigned char)(word >> 8 * i);
}

static void glb_write(const uint8_t *json, size_t size)
{
    size_t padded = (size + 3) / 4 * 4, total = 28 + padded + BINARY_SIZE;
    unsigned char *file = calloc(total, 1), *binary = file + 28 + padded;
    if (!file)
        abort();
    memcpy(file, "glTF\2\0\0\0", 8);
    word_put(file + 8, total);
    word_put(file + 12, padded);
    memcpy(file + 16, "JSON", 4);
    memset(file + 20, ' ', padded);
    memcpy(file + 20, json, size);
    word_put(file + 20 + padded, BINARY_SIZE);
    memcpy(file + 24 + padded, "BIN", 4);
    memcpy(binary, SQUARE, sizeof SQUARE);
    memcpy(binary + 128, INDICES, sizeof INDICES);
    memcpy(binary + 140, PNG, sizeof PNG);
    fuzz_file_write(file, total);
    free(file);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    const ImportOptions options = {0};
    Scene scene;
    Error error = {{0}, {0}};
    log_sink_set(fuzz_log_drop, NULL);
    if (size == 0 || data[0] == 'g')
        fuzz_file_write(data, size);
    else
        glb_write(data + 1, size - 1);
    Gltf *gltf = gltf_open(fuzz_file(), &error);
    scene_init(&scene);
    if (gltf && gltf_import(gltf, &options, &scene, &error))
        scene_finish(&scene, &error);
    scene_destroy(&scene);
    gltf_close(gltf);
    return 0;
}
