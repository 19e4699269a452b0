#include "ranks/communicator.h"

#include "base/exit_status.h"

#include <mpi.h>

#include <sched.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

/* Bytes, and words, of a call of MPI at most: its counts are ints. */
#define BYTES_MOST ((size_t)1 << 30)
#define WORDS_MOST ((size_t)1 << 22)

/* How long a waiting rank sleeps before it looks again. */
#define NAP_NANOSECONDS 50000

static struct {
    int count, number; /* of ranks; of this one */
    uint64_t bytes;
    bool begun;
    MPI_Op add; /* of sums that saturate */
    char machine[MPI_MAX_PROCESSOR_NAME];
} communicator = {.count = 1};

/* ---- begin and end ----------------------------------------------------------------------------------------------- */

const char *communicator_library(void)
{
    static char name[32];
    snprintf(name, sizeof name, "Open MPI %d.%d.%d", OMPI_MAJOR_VERSION, OMPI_MINOR_VERSION, OMPI_RELEASE_VERSION);
    return name;
}

static void sums_add(void *more, void *sums, int *count, MPI_Datatype *type)
{
    (void)type;
    film_words_add(sums, more, (size_t)*count);
}

bool communicator_begin(int processes, Error *error)
{
    int provided, length;
    MPI_Init_thread(NULL, NULL, MPI_THREAD_FUNNELED, &provided);
    MPI_Comm_size(MPI_COMM_WORLD, &communicator.count);
    MPI_Comm_rank(MPI_COMM_WORLD, &communicator.number);
    MPI_Get_processor_name(communicator.machine, &length);
    if (processes > 0 && processes != communicator.count) {
        MPI_Finalize();
        error_set(error, "the launcher has started %d processes, but they do not find each other", processes);
        return error_fix(error, "use the mpirun of %s, or srun --mpi=pmix", communicator_library());
    }
    MPI_Op_create(sums_add, 1, &communicator.add);
    communicator.begun = true;
    return true;
}

int communicator_neighbours(void)
{
    enum { MASK_BYTES = 1024 };
    unsigned char own[MASK_BYTES] = {0}, *all;
    int count = 1, same = 0;
    MPI_Comm machine;
    if (sched_getaffinity(0, sizeof own, (cpu_set_t *)(void *)own) != 0)
        memset(own, 0, sizeof own);
    MPI_Comm_split_type(MPI_COMM_WORLD, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &machine);
    MPI_Comm_size(machine, &count);
    all = malloc((size_t)count * sizeof own);
    if (!all) {
        Error error = {0};
        error_memory(&error, (size_t)count * sizeof own, "the processors of ranks");
        communicator_abort(&error);
    }
    MPI_Allgather(own, MASK_BYTES, MPI_BYTE, all, MASK_BYTES, MPI_BYTE, machine);
    for (int i = 0; i < count; ++i)
        same += memcmp(all + (size_t)i * sizeof own, own, sizeof own) == 0;
    free(all);
    MPI_Comm_free(&machine);
    return same;
}

int communicator_count(void)
{
    return communicator.count;
}

int communicator_number(void)
{
    return communicator.number;
}

const char *communicator_machine(void)
{
    return communicator.machine;
}

uint64_t communicator_bytes(void)
{
    return communicator.bytes;
}

void communicator_end(void)
{
    if (!communicator.begun)
        return;
    MPI_Op_free(&communicator.add);
    MPI_Finalize();
    communicator.begun = false;
}

_Noreturn void communicator_abort(const Error *error)
{
    error_print(error, stderr);
    MPI_Abort(MPI_COMM_WORLD, EXIT_FAILED);
    abort();
}

/* ---- from one rank to another ------------------------------------------------------------------------------------ */

void communicator_nap(void)
{
    const struct timespec nap = {0, NAP_NANOSECONDS};
    nanosleep(&nap, NULL);
}

bool message_waits(RankTag tag, int *from)
{
    int waits = 0;
    MPI_Status status;
    MPI_Iprobe(MPI_ANY_SOURCE, (int)tag, MPI_COMM_WORLD, &waits, &status);
    if (waits)
        *from = status.MPI_SOURCE;
    return waits != 0;
}

/* MPI would wait in a loop that keeps a processor busy. */
static void message_await(int from, RankTag tag)
{
    for (int waits = 0;;) {
        MPI_Iprobe(from, (int)tag, MPI_COMM_WORLD, &waits, MPI_STATUS_IGNORE);
        if (waits)
            return;
        communicator_nap();
    }
}

void message_send(int to, RankTag tag, const void *bytes, size_t size)
{
    MPI_Send(bytes, (int)size, MPI_BYTE, to, (int)tag, MPI_COMM_WORLD);
    communicator.bytes += size;
}

void message_receive(int from, RankTag tag, void *bytes, size_t size)
{
    message_await(from, tag);
    MPI_Recv(bytes, (int)size, MPI_BYTE, from, (int)tag, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
    communicator.bytes += size;
}

static MPI_Datatype pass_words_type(const PassWords *words)
{
    MPI_Datatype type;
    MPI_Type_vector((int)words->fields, (int)words->count, (int)words->stride, MPI_UINT32_T, &type);
    MPI_Type_commit(&type);
    communicator.bytes += (uint64_t)words->fields * words->count * sizeof(uint);
    return type;
}

void pass_words_send(int to, const PassWords *words)
{
    MPI_Datatype type = pass_words_type(words);
    MPI_Send(words->words + words->first, 1, type, to, (int)TAG_WORDS, MPI_COMM_WORLD);
    MPI_Type_free(&type);
}

void pass_words_receive(int from, const PassWords *words)
{
    MPI_Datatype type = pass_words_type(words);
    message_await(from, TAG_WORDS);
    MPI_Recv(words->words + words->first, 1, type, from, (int)TAG_WORDS, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
    MPI_Type_free(&type);
}

/* ---- all ranks --------------------------------------------------------------------------------------------------- */

static bool broadcast(void *context, void *bytes, size_t size, Error *error)
{
    (void)context, (void)error;
    for (size_t done = 0; done < size;) {
        size_t part = size - done < BYTES_MOST ? size - done : BYTES_MOST;
        MPI_Bcast((char *)bytes + done, (int)part, MPI_BYTE, 0, MPI_COMM_WORLD);
        done += part;
    }
    communicator.bytes += size * (uint64_t)(communicator.count - 1);
    return true;
}

Archive communicator_broadcast(void)
{
    return (Archive){.saves = communicator.number == 0, .transfer = broadcast};
}

static void words_reduce(ulong *words, size_t first, size_t end, MPI_Op op)
{
    for (size_t done = first; done < end;) {
        size_t part = end - done < WORDS_MOST ? end - done : WORDS_MOST;
        bool root = communicator.number == 0;
        MPI_Reduce(root ? MPI_IN_PLACE : words + done, root ? words + done : NULL, (int)part, MPI_UINT64_T, op, 0,
                   MPI_COMM_WORLD);
        done += part;
    }
    communicator.bytes += (end - first) * sizeof *words * (uint64_t)(communicator.count - 1);
}

void film_words_reduce(const FilmWords *film)
{
    words_reduce(film->words, 0, film->plain, communicator.add);
    words_reduce(film->words, film->plain, film->plain_end, MPI_SUM);
    words_reduce(film->words, film->plain_end, film->count, communicator.add);
}
