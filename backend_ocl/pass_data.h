/* BUFFER_PASS on a device: the words of a whole pass's items, copied there before the pass and back after it. */
#ifndef TWINLIGHT_PASS_DATA_H
#define TWINLIGHT_PASS_DATA_H

#include "device_memory.h"

/* Makes the buffer for the items of `frame` and fills it. Nothing to do, and true, when the list has no such words. */
bool pass_data_begin(DeviceMemory *memory, const FrameParams *frame, const StepList *list, Error *error);

/* Copies what kernels have written back to the list's words; all kernels must have ended. Frees the buffer. */
bool pass_data_end(DeviceMemory *memory, const FrameParams *frame, const StepList *list, Error *error);

#endif
