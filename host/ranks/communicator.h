/* Messages between ranks, over MPI. Rank 0 and the others wait without keeping a processor busy. A failure of MPI ends
 * all ranks, with MPI's own message. */
#ifndef TWINLIGHT_RANKS_COMMUNICATOR_H
#define TWINLIGHT_RANKS_COMMUNICATOR_H

#include "base/archive.h"
#include "film/film_words.h"
#include "ranks/messages.h"

/* "Open MPI 4.1.4" */
const char *communicator_library(void);

/* Joins the ranks. Fails unless there are `processes` of them; 0: any number. */
bool communicator_begin(int processes, Error *error);

/* Leaves them, if it has joined them. */
void communicator_end(void);

/* Number of ranks, and the number of this one; 1 and 0 before communicator_begin. */
int communicator_count(void);
int communicator_number(void);

/* Number of ranks on this machine that are bound to the same processors as this one, itself included. Every rank must
 * call it. */
int communicator_neighbours(void);

/* Name of this machine. */
const char *communicator_machine(void);

/* Bytes that this rank has sent and received, and those that others have sent each other in its collective calls. */
uint64_t communicator_bytes(void);

/* Whether a message has come; *from is its sender. */
bool message_waits(RankTag tag, int *from);

void message_send(int to, RankTag tag, const void *bytes, size_t size);

/* Waits for a message of this size. */
void message_receive(int from, RankTag tag, void *bytes, size_t size);

/* Gives up the processor for a moment, for loops that wait. */
void communicator_nap(void);

/* An archive through which rank 0 sends to all others at once: its saves, theirs restores. */
Archive communicator_broadcast(void);

/* The words of items first ... first + count - 1 of a pass: `fields` runs of `count` words, `stride` apart. */
typedef struct PassWords {
    uint *words; /* StepList.pass_words */
    uint first, count, fields, stride;
} PassWords;

/* Whether there are any: only then may they be sent and received. */
static inline bool pass_words_any(const PassWords *words)
{
    return words->fields > 0 && words->count > 0;
}

void pass_words_send(int to, const PassWords *words);
void pass_words_receive(int from, const PassWords *words);

/* Adds up the words of all ranks' films on rank 0. Every rank must call it, with films alike. */
void film_words_reduce(const FilmWords *film);

/* Ends all ranks after an error that leaves no other way, such as a lack of memory. Prints it. */
_Noreturn void communicator_abort(const Error *error);

#endif
