/* What ranks send each other, as the bytes of these structs: all ranks are the same program (ranks/greeting.h). */
#ifndef TWINLIGHT_RANKS_MESSAGES_H
#define TWINLIGHT_RANKS_MESSAGES_H

#include "backend/backend.h"
#include "layout/diagnostics.h"

typedef enum RankTag { TAG_GREETING = 1, TAG_COMMAND, TAG_REPORT, TAG_STOP, TAG_WORDS } RankTag;

/* From rank 0 to each other one. */
typedef enum CommandKind {
    COMMAND_OPEN, /* the scene follows; answered by a report */
    COMMAND_PASS, /* a PassOrder follows, and the words of the rank's items; answered by a report and these words */
    COMMAND_FINISH, /* after the reports of all: adds up the film of the pass */
    COMMAND_END
} CommandKind;

typedef struct RankCommand {
    CommandKind kind;
    uint first, count; /* COMMAND_PASS: the rank's items begin at `first` of the pass */
    bool stopped; /* COMMAND_FINISH: a TAG_STOP message was sent */
} RankCommand;

/* A pass, to all ranks. What it refers to follows in this order, each unless the ranks have it: steps, guide,
 * photons. */
typedef struct PassOrder {
    FrameParams frame;
    uint words_per_item[BUFFER_COUNT];
    uint pass_fields, pass_stride; /* as in StepList; no fields: there are no words */
    uint steps; /* place of the list among those that ranks keep */
    bool steps_new;
    bool guided;
    bool photons, photons_new;
    bool whole; /* SplatSink.whole */
    uint photon_number;
    uint64_t step_count;
    uint64_t photon_words;
    PhotonParams photon_params;
    uint64_t sum_words; /* of the film that splats are added to; 0: they are dropped */
} PassOrder;

/* From a rank to rank 0, after it has opened its backend or computed its items. */
typedef struct RankReport {
    uint64_t delivered;
    double seconds;
    bool good;
    Error error; /* unless good; names the rank */
    char warnings[1024]; /* of the opening: lines that name the rank */
    BackendStatistics statistics;
    uint64_t diagnostics[DIAGNOSTIC_COUNT];
} RankReport;

#endif
