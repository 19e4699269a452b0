/* Compares two backends bit by bit: the same items, the same steps, every word of their state. */
#ifndef TWINLIGHT_RENDER_VERIFY_H
#define TWINLIGHT_RENDER_VERIFY_H

#include "backend/group.h"

/* What was compared if nothing differed. */
typedef struct VerifyReport {
    uint64_t items;
    uint64_t prefixes; /* prefixes of the list that were compared, on the first block only */
    uint words; /* compared per item */
} VerifyReport;

/* Runs `items` items, from frame->pass.first_item on, through both sides in blocks. The first block is compared after
 * every step until all paths have ended. The others are compared after the last step, and after every step only if that
 * differs, to find the first difference. Returns false with an error naming the first step, item and field that differ
 * and both values. *stop ends it between two runs of the first block or between blocks. */
bool verify_run(const BackendMember sides[2], const FrameParams *frame, const StepList *list, uint64_t items,
                const atomic_int *stop, VerifyReport *report, Error *error);

#endif
