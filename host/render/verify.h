/* Two backends side by side: the same items through the same steps, every word of their state compared. */
#ifndef TWINLIGHT_RENDER_VERIFY_H
#define TWINLIGHT_RENDER_VERIFY_H

#include "backend/group.h"

/* What was compared when nothing differed. */
typedef struct VerifyReport {
    uint64_t items;
    uint64_t prefixes; /* how many beginnings of the list, on the first items, until their paths had ended */
    uint words; /* of an item */
} VerifyReport;

/* Runs `items` items from frame->first_item on through both sides, in blocks. On the first block the state is compared
 * after every step until all paths have ended, on the others after the last step; where it differs, after every step
 * too, to find the first. False with an error that names the step, item and field that differ first, with the values of
 * both sides. A stop ends it between two runs of the first block, or between blocks. */
bool verify_run(const BackendMember sides[2], const FrameParams *frame, const StepList *list, uint64_t items,
                const atomic_int *stop, VerifyReport *report, Error *error);

#endif
