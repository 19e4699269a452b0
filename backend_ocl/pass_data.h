/* BUFFER_GUIDE and BUFFER_PASS on a device: the guide of a pass, copied there before it, and the words of all of its
 * items, copied back after it as well. */
#ifndef TWINLIGHT_PASS_DATA_H
#define TWINLIGHT_PASS_DATA_H

#include "device_memory.h"

/* Copies the guide, and makes the buffer for the items of `frame` and fills it. Nothing to do, and true, for what the
 * list does not have. */
bool pass_data_begin(DeviceMemory *memory, const FrameParams *frame, const StepList *list, Error *error);

/* Copies what kernels have written back to the list's words; all kernels must have ended. Frees the buffer. */
bool pass_data_end(DeviceMemory *memory, const FrameParams *frame, const StepList *list, Error *error);

#endif
