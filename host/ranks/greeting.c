#include "ranks/greeting.h"

#include "config.h"

#include "base/archive.h"
#include "base/build_info.h"
#include "base/exit_status.h"
#include "base/hash.h"
#include "layout/kernel_list.h"
#include "ranks/messages.h"

#include <string.h>

void greeting_make(RankGreeting *greeting, const char *machine)
{
    static const uint64_t SIZES[] = {sizeof(RankCommand), sizeof(PassOrder), sizeof(RankReport), sizeof(Step),
                                     sizeof(Guide),       sizeof(float),     KERNEL_COUNT};
    memset(greeting, 0, sizeof *greeting);
    greeting->byte_order = BYTE_ORDER_MARK;
    greeting->layout = hash_bytes(HASH_START, SIZES, sizeof SIZES);
    snprintf(greeting->version, sizeof greeting->version, "%s", PACKAGE_VERSION);
    snprintf(greeting->commit, sizeof greeting->commit, "%s", build_commit());
    snprintf(greeting->machine, sizeof greeting->machine, "%s", machine);
}

bool rank_error(Error *error, int rank, const char *machine, const Error *theirs)
{
    const Error cause = *theirs;
    error_set(error, "rank %d on %s: %s", rank, machine, error_text(&cause));
    if (cause.fix[0])
        error_fix(error, "%s", cause.fix);
    return false;
}

bool greeting_check(const RankGreeting *ours, const RankGreeting *theirs, int rank, Error *error)
{
    Error cause = {0};
    if (theirs->byte_order != ours->byte_order) {
        error_set(&cause, "its byte order is not that of rank 0");
        error_fix(&cause, "use machines of one kind, or --shard on each and twinlight merge");
    } else if (memcmp(theirs->version, ours->version, sizeof ours->version) != 0 ||
               memcmp(theirs->commit, ours->commit, sizeof ours->commit) != 0) {
        error_set(&cause, "it is Twinlight %.31s (commit %.63s), but rank 0 is %s (commit %s)", theirs->version,
                  theirs->commit, ours->version, ours->commit);
        error_fix(&cause, "start the same program on every machine");
    } else if (theirs->layout != ours->layout) {
        error_set(&cause, "its program was compiled in another way than that of rank 0");
        error_fix(&cause, "start the same program on every machine");
    } else if (theirs->status != 0) {
        cause = theirs->error;
    } else {
        return true;
    }
    return rank_error(error, rank, theirs->machine, &cause);
}
