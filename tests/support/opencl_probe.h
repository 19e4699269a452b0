/* The smallest OpenCL host that tests need: one CPU device, one program, kernels whose arguments are all buffers. */
#ifndef TWINLIGHT_TESTS_SUPPORT_OPENCL_PROBE_H
#define TWINLIGHT_TESTS_SUPPORT_OPENCL_PROBE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct OpenclProbe OpenclProbe;

/* Opens the first CPU device that promises correctly rounded division and denormals, and builds `source` with
 * `options`. Returns NULL with the reason in `message`; *absent tells whether there is no such device. */
OpenclProbe *opencl_probe_open(const char *source, const char *options, char *message, size_t message_size,
                               bool *absent);
void opencl_probe_close(OpenclProbe *probe);
const char *opencl_probe_device(const OpenclProbe *probe);

/* Runs kernel `name` (in, table, out) over `items`. Counts are in 32-bit words; `out` is zeroed on the device first. */
bool opencl_probe_run(OpenclProbe *probe, const char *name, const uint32_t *in, size_t in_words, const uint32_t *table,
                      size_t table_words, uint32_t *out, size_t out_words, size_t items);

/* A buffer on the device, initialised with `words` (never empty). Returns NULL on failure. */
typedef struct OpenclBuffer OpenclBuffer;
OpenclBuffer *opencl_buffer_create(OpenclProbe *probe, const uint32_t *words, size_t count);
void opencl_buffer_destroy(OpenclBuffer *buffer);
bool opencl_buffer_write(OpenclProbe *probe, OpenclBuffer *buffer, const uint32_t *words, size_t count);
bool opencl_buffer_read(OpenclProbe *probe, OpenclBuffer *buffer, uint32_t *words, size_t count);

/* Runs kernel `name` over `items` with these arguments, waits for it to finish, and returns the time it took. */
bool opencl_probe_launch(OpenclProbe *probe, const char *name, OpenclBuffer *const *buffers, size_t count, size_t items,
                         double *seconds);

#endif
