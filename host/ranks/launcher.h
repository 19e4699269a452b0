/* What the environment says of the launcher that started this process, without asking MPI. */
#ifndef TWINLIGHT_RANKS_LAUNCHER_H
#define TWINLIGHT_RANKS_LAUNCHER_H

/* Number of processes that were started together; 0: many, but how many is not known; 1 without a launcher. */
int launcher_processes(void);

/* The number of this process among them; 0 if it is not known. */
int launcher_rank(void);

#endif
