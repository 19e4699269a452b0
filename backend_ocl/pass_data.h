/* Data of a pass on a device: BUFFER_GUIDE, copied to the device before the pass, and BUFFER_PASS, the words of all
 * items of the pass, copied to the device before it and back after it. */
#ifndef TWINLIGHT_PASS_DATA_H
#define TWINLIGHT_PASS_DATA_H

#include "device_memory.h"

/* Copies the guide, allocates BUFFER_PASS for the items of `frame` and fills it; skips what the list does not have. */
bool pass_data_begin(DeviceMemory *memory, const FrameParams *frame, const StepList *list, Error *error);

/* Copies what kernels have written back to list->pass_words and frees the buffer. All kernels must have ended. */
bool pass_data_end(DeviceMemory *memory, const FrameParams *frame, const StepList *list, Error *error);

#endif
