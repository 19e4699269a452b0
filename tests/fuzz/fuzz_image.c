/* Arbitrary bytes for the image readers, and for the conversion of what they read into a scene's textures. */
#include "fuzz/fuzz.h"

#include "base/log.h"
#include "image/read.h"
#include "scene/texture_image.h"

#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

/* The readers take a file name. TGA has no signature and is recognised by this name's ending, the other formats by
 * their bytes. */
static char path[1024];
static FILE *file;

static void path_remove(void)
{
    unlink(path);
}

static void path_make(void)
{
    const char *folder = getenv("TMPDIR");
    snprintf(path, sizeof path, "%s/twinlight-fuzz-XXXXXX.tga", folder ? folder : "/tmp");
    int descriptor = mkstemps(path, 4);
    file = descriptor < 0 ? NULL : fdopen(descriptor, "wb");
    if (!file) {
        perror(path);
        abort();
    }
    atexit(path_remove);
    log_sink_set(fuzz_log_drop, NULL);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static const TextureImageOptions options = {.encoding = ENCODING_SRGB, .gamma = 1.0f};
    Image image;
    Error error;
    bool found;
    if (!file)
        path_make();
    /* Truncated to its length rather than to 0: file systems flush a file that is emptied and rewritten. */
    rewind(file);
    if (fwrite(data, 1, size, file) != size || fflush(file) != 0 || ftruncate(fileno(file), (off_t)size) != 0)
        abort();
    if (image_read_layer(path, "direct", &image, &found, &error) && found)
        image_destroy(&image);
    if (!image_read(path, &image, &error))
        return 0;
    Scene scene;
    float *rgb;
    uint index;
    scene_init(&scene);
    texture_image_add(&scene, &image, &options, &index, &error);
    scene_destroy(&scene);
    if (image_linear_rgb(&image, &rgb, &error))
        free(rgb);
    image_destroy(&image);
    return 0;
}
