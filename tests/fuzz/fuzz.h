/* What fuzz/fuzz_scene.c, fuzz/fuzz_image.c and fuzz/fuzz_options.c are: targets of libFuzzer (make fuzz), or with
 * fuzz/fuzz_replay.c programs that try the inputs of tests/corpus (make check) or of the files and folders they are
 * given. */
#ifndef TWINLIGHT_TESTS_FUZZ_FUZZ_H
#define TWINLIGHT_TESTS_FUZZ_FUZZ_H

#include <stddef.h>
#include <stdint.h>

/* Tries one input: anything but a crash, a leak, an endless loop is right. Returns 0. */
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

/* For log_sink_set: warnings of thousands of inputs a second are nobody's. */
static inline void fuzz_log_drop(const char *line, void *context)
{
    (void)line;
    (void)context;
}

#endif
