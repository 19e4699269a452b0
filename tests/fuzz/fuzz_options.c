/* Arbitrary bytes as command lines: words end with newlines, and the lowest bit of the first byte selects between the
 * options of render, which include those of pyramid, and of bench. These cover all options that take text. */
#include "fuzz/fuzz.h"

#include "base/log.h"
#include "bench/options.h"
#include "command/render_options.h"
#include "scene/texture_image.h"

#include <stdlib.h>
#include <string.h>

#define WORDS_MAX 32

/* A backend without devices and one with devices; a non-NULL `spans` marks the latter. */
static size_t spans_none(Backend *backend, const BackendSpan **spans, uint64_t *dropped)
{
    (void)backend;
    *spans = NULL;
    *dropped = 0;
    return 0;
}

static const BackendInterface CPU = {.name = "cpu"}, OPENCL = {.name = "opencl", .spans = spans_none};
static const BackendInterface *const BACKENDS[] = {&CPU, &OPENCL};
static const BackendTable TABLE = {BACKENDS, 2, NULL};

static void render_try(int count, char **words)
{
    static const RenderOptionSet set = {.command = "render",
                                        .usage = "render",
                                        .summary = "",
                                        .output_ending = ".exr",
                                        .depth_low = 1,
                                        .depth_high = 65535};
    RenderCommand command = {.png = true};
    Error error;
    render_options_parse(&command, &set, &TABLE, count, words, &error);
}

static void bench_try(int count, char **words)
{
    static BenchOptions options;
    Error error;
    memset(&options, 0, sizeof options);
    bench_options_parse(&options, &TABLE, count, words, &error);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    TextureImageOptions encoding;
    char *words[WORDS_MAX + 1] = {"command"};
    int count = 1;
    char *text = malloc(size + 1);
    if (!text || size == 0) {
        free(text);
        return 0;
    }
    memcpy(text, data + 1, size - 1);
    text[size - 1] = '\0';
    log_sink_set(fuzz_log_drop, NULL);
    for (char *word = text; word && count < WORDS_MAX;) {
        words[count++] = word;
        char *newline = strchr(word, '\n');
        if (newline)
            *newline++ = '\0';
        word = newline;
    }
    for (int i = 1; i < count; ++i)
        texture_encoding_parse(words[i], &encoding);
    if (data[0] & 1)
        bench_try(count, words);
    else
        render_try(count, words);
    free(text);
    return 0;
}
