/* Interface of the libFuzzer targets beside it (make fuzz). Linked with fuzz_replay.c they are programs that run the
 * inputs of tests/corpus (make check) or of the files and folders given. */
#ifndef TWINLIGHT_TESTS_FUZZ_FUZZ_H
#define TWINLIGHT_TESTS_FUZZ_FUZZ_H

#include <stddef.h>
#include <stdint.h>

/* Runs one input: any outcome is right except a crash, a leak or an endless loop. Returns 0. */
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

/* For log_sink_set: drops the warnings of thousands of inputs per second. */
static inline void fuzz_log_drop(const char *line, void *context)
{
    (void)line;
    (void)context;
}

#endif
