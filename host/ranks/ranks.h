/* One rendering by several processes: the ranks that a launcher of MPI (mpirun, srun) has started, on one machine or
 * many.
 *
 * Rank 0 runs the program. The others only compute: rank 0 sends them the packed scene and, for every pass, a range of
 * its items; they return what the pass needs of those. Items are independent and the film's sums are integers, so the
 * image does not depend on the number of ranks or their backends. Each rank chooses its backend by its own command
 * line.
 *
 * A process without a launcher, or in a program built without MPI, is rank 0 of one. All functions are for the main
 * thread. */
#ifndef TWINLIGHT_RANKS_RANKS_H
#define TWINLIGHT_RANKS_RANKS_H

#include "backend/choice.h"

/* "Open MPI 4.1.4", or NULL if the program was built without MPI. */
const char *ranks_library(void);

/* Joins the ranks if a launcher has started more processes than this one. On ranks other than 0 standard output is
 * closed and signals that end a rendering are ignored. Call ranks_end afterwards, not on failure. */
bool ranks_begin(Error *error);

int ranks_count(void);
int ranks_number(void);

/* How a rank opens its backend. */
typedef struct RankSetup {
    const BackendChoices *choices;
    const BackendOptions *options;
    int status; /* exit status if the rank cannot take part, else 0 */
    Error error; /* why it cannot */
} RankSetup;

/* On ranks other than 0: computes what rank 0 asks for, and returns when rank 0 calls ranks_end. */
void ranks_serve(const RankSetup *setup);

/* On rank 0: false if a rank cannot take part, with *status its exit status. */
bool ranks_greet(int *status, Error *error);

/* On rank 0, after ranks_greet: opens the backend of every rank on the scene. *opened divides each pass among them;
 * with a single rank it is what backend_choices_open opens. To be closed before ranks_end. */
bool ranks_open(const BackendScene *scene, const RankSetup *setup, BackendMember *opened, Error *error);

/* Ends what ranks_begin began. */
void ranks_end(void);

#endif
