/* Replaces support/opencl_probe.c in a build without OpenCL. */
#include "support/opencl_probe.h"

#include <stdio.h>

OpenclProbe *opencl_probe_open(const char *source, const char *options, char *message, size_t message_size,
                               bool *absent)
{
    (void)source;
    (void)options;
    *absent = true;
    snprintf(message, message_size, "built without OpenCL; fix: apt-get install ocl-icd-opencl-dev pocl-opencl-icd");
    return NULL;
}

void opencl_probe_close(OpenclProbe *probe)
{
    (void)probe;
}

const char *opencl_probe_device(const OpenclProbe *probe)
{
    (void)probe;
    return "";
}

bool opencl_probe_run(OpenclProbe *probe, const char *name, const uint32_t *in, size_t in_words, const uint32_t *table,
                      size_t table_words, uint32_t *out, size_t out_words, size_t items)
{
    (void)probe, (void)name, (void)in, (void)in_words, (void)table, (void)table_words;
    (void)out, (void)out_words, (void)items;
    return false;
}

OpenclBuffer *opencl_buffer_create(OpenclProbe *probe, const uint32_t *words, size_t count)
{
    (void)probe, (void)words, (void)count;
    return NULL;
}

void opencl_buffer_destroy(OpenclBuffer *buffer)
{
    (void)buffer;
}

bool opencl_buffer_write(OpenclProbe *probe, OpenclBuffer *buffer, const uint32_t *words, size_t count)
{
    (void)probe, (void)buffer, (void)words, (void)count;
    return false;
}

bool opencl_buffer_read(OpenclProbe *probe, OpenclBuffer *buffer, uint32_t *words, size_t count)
{
    (void)probe, (void)buffer, (void)words, (void)count;
    return false;
}

bool opencl_probe_launch(OpenclProbe *probe, const char *name, OpenclBuffer *const *buffers, size_t count, size_t items,
                         double *seconds)
{
    (void)probe, (void)name, (void)buffers, (void)count, (void)items, (void)seconds;
    return false;
}
