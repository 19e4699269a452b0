/* Several ranks, as far as it can be tested without MPI: what the launcher says, greetings, the part of a pass on a
 * thread of its own. The rest: tests/command/test_mpi.sh. */
#include "support/test_util.h"

#include "base/exit_status.h"
#include "base/processors.h"
#include "ranks/greeting.h"
#include "ranks/launcher.h"
#include "ranks/pass_cache.h"
#include "ranks/slice.h"

#include <sched.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

/* ---- the launcher ------------------------------------------------------------------------------------------------ */

static const char *const VARIABLES[] = {
    "OMPI_COMM_WORLD_SIZE", "OMPI_COMM_WORLD_RANK", "PMIX_RANK", "PMI_RANK", "PMI_SIZE", "SLURM_STEP_NUM_TASKS"};

/* Sets the variables, "NAME=VALUE", and no others. */
static void environment_set(const char *const *values, size_t count)
{
    for (size_t i = 0; i < sizeof VARIABLES / sizeof VARIABLES[0]; ++i)
        unsetenv(VARIABLES[i]);
    for (size_t i = 0; i < count && values[i]; ++i) {
        char name[64];
        size_t length = strcspn(values[i], "=");
        memcpy(name, values[i], length);
        name[length] = '\0';
        setenv(name, values[i] + length + 1, 1);
    }
}

START_TEST(test_launcher)
{
    static const struct {
        const char *values[3];
        int processes, rank;
    } CASES[] = {
        {{NULL}, 1, 0},
        {{"OMPI_COMM_WORLD_SIZE=4", "OMPI_COMM_WORLD_RANK=3"}, 4, 3},
        {{"OMPI_COMM_WORLD_SIZE=1", "OMPI_COMM_WORLD_RANK=0", "SLURM_STEP_NUM_TASKS=8"}, 1, 0},
        {{"PMI_SIZE=16", "PMI_RANK=15"}, 16, 15},
        {{"PMIX_RANK=2", "SLURM_STEP_NUM_TASKS=8"}, 8, 2},
        {{"PMIX_RANK=2"}, 0, 2},
        {{"SLURM_STEP_NUM_TASKS=8"}, 1, 0}, /* tasks without a library that connects them */
        {{"OMPI_COMM_WORLD_SIZE=", "OMPI_COMM_WORLD_RANK=x"}, 1, 0},
    };
    for (size_t i = 0; i < sizeof CASES / sizeof CASES[0]; ++i) {
        environment_set(CASES[i].values, 3);
        ck_assert_msg(launcher_processes() == CASES[i].processes, "case %zu: %d processes", i, launcher_processes());
        ck_assert_msg(launcher_rank() == CASES[i].rank, "case %zu: rank %d", i, launcher_rank());
    }
    environment_set(NULL, 0);
}
END_TEST

/* ---- greetings --------------------------------------------------------------------------------------------------- */

static void refused(const RankGreeting *ours, const RankGreeting *theirs, const char *why)
{
    Error error = {0};
    ck_assert(!greeting_check(ours, theirs, 5, &error));
    ck_assert_msg(strstr(error.message, "error: rank 5 on node7: ") == error.message, "%s", error.message);
    ck_assert_msg(strstr(error.message, why) != NULL, "%s", error.message);
    ck_assert_msg(error.fix[0] != '\0', "no fix for: %s", error.message);
}

START_TEST(test_greeting)
{
    RankGreeting ours, theirs;
    Error error = {0};
    greeting_make(&ours, "node1");
    greeting_make(&theirs, "node7");
    ck_assert(greeting_check(&ours, &theirs, 5, &error));
    snprintf(theirs.version, sizeof theirs.version, "0.0.9");
    refused(&ours, &theirs, "it is Twinlight 0.0.9");
    greeting_make(&theirs, "node7");
    snprintf(theirs.commit, sizeof theirs.commit, "abc1234");
    refused(&ours, &theirs, "(commit abc1234)");
    greeting_make(&theirs, "node7");
    theirs.byte_order = 0x0807060504030201u;
    refused(&ours, &theirs, "byte order");
    greeting_make(&theirs, "node7");
    ++theirs.layout;
    refused(&ours, &theirs, "compiled in another way");
}
END_TEST

START_TEST(test_greeting_of_a_rank_that_cannot)
{
    RankGreeting ours, theirs;
    greeting_make(&ours, "node1");
    greeting_make(&theirs, "node7");
    theirs.status = EXIT_USAGE;
    error_set(&theirs.error, "--threads=many: not a whole number");
    error_fix(&theirs.error, "give a whole number");
    refused(&ours, &theirs, "rank 5 on node7: --threads=many: not a whole number");
}
END_TEST

/* ---- the part of a pass ------------------------------------------------------------------------------------------ */

static bool slow_run(Backend *backend, const FrameParams *frame, const StepList *list, const SplatSink *sink,
                     const atomic_int *stop, uint64_t *items_done, Error *error)
{
    (void)backend, (void)list, (void)sink;
    const struct timespec moment = {0, 1000000};
    for (*items_done = 0; *items_done < frame->pass.item_count && !*stop; ++*items_done)
        nanosleep(&moment, NULL);
    return frame->pass.item_count != 13 || error_set(error, "thirteen");
}

static void slice_begin(Slice *slice, uint items, const atomic_int *stop)
{
    static const BackendInterface SLOW = {.name = "slow", .run = slow_run};
    memset(slice, 0, sizeof *slice);
    slice->backend.interface = &SLOW;
    slice->frame.pass.item_count = items;
    slice->stop = stop;
    slice_start(slice);
}

START_TEST(test_slice)
{
    Slice slice;
    atomic_int stop = 0;
    slice_begin(&slice, 20, &stop);
    ck_assert(!slice_wait(&slice, 0.0));
    while (!slice_wait(&slice, 0.01))
        ;
    slice_join(&slice);
    ck_assert(slice.good);
    ck_assert_uint_eq(slice.delivered, 20);
    ck_assert(slice.seconds >= 0.02 && slice.seconds < 10.0);
    slice_begin(&slice, 1000000, &stop);
    ck_assert(!slice_wait(&slice, 0.005));
    stop = 1;
    slice_join(&slice);
    ck_assert_uint_lt(slice.delivered, 1000000);
    stop = 0;
    slice_begin(&slice, 13, &stop);
    slice_join(&slice);
    ck_assert(!slice.good);
    ck_assert_str_eq(slice.error.message, "error: thirteen");
    slice_begin(&slice, 0, &stop);
    ck_assert(slice_wait(&slice, 0.0) && slice.good && slice.delivered == 0);
    slice_join(&slice);
}
END_TEST

/* ---- what ranks have --------------------------------------------------------------------------------------------- */

/* Lists of steps and maps of photons are sent once each, and lists of as many steps are told apart. */
START_TEST(test_pass_order)
{
    enum { STEPS = 3 };
    Step steps[2][STEPS];
    uint words[4] = {0};
    PhotonMap photons = {.words = words, .word_count = 4, .number = 7};
    FrameParams frame;
    PassCache cache = {.next = 0};
    Error error = {0};
    memset(steps, 0, sizeof steps);
    memset(&frame, 0, sizeof frame);
    steps[1][2].kernel = 1;
    for (int turn = 0; turn < 4; ++turn) {
        const StepList list = {.steps = steps[turn % 2], .count = STEPS, .photons = &photons};
        photons.number = turn == 3 ? 8 : 7;
        ck_assert(pass_order_make(&cache, &frame, &list, 0, false, &error));
        ck_assert_uint_eq(cache.order.steps, (uint)turn % 2);
        ck_assert(cache.order.steps_new == (turn < 2));
        ck_assert(cache.order.photons && cache.order.photons_new == (turn == 0 || turn == 3));
    }
    pass_cache_destroy(&cache);
}
END_TEST

/* ---- processors -------------------------------------------------------------------------------------------------- */

START_TEST(test_processors)
{
    cpu_set_t all, one;
    int usable = processors_usable();
    ck_assert_int_eq(sched_getaffinity(0, sizeof all, &all), 0);
    ck_assert_int_eq(usable, CPU_COUNT(&all));
    processors_share(2);
    ck_assert_int_eq(processors_usable(), usable > 2 ? usable / 2 : 1);
    processors_share(usable + 1);
    ck_assert_int_eq(processors_usable(), 1);
    processors_share(1);
    CPU_ZERO(&one);
    for (size_t i = 0; CPU_COUNT(&one) == 0; ++i)
        if (CPU_ISSET(i, &all))
            CPU_SET(i, &one);
    ck_assert_int_eq(sched_setaffinity(0, sizeof one, &one), 0);
    ck_assert_int_eq(processors_usable(), 1);
    ck_assert_int_eq(sched_setaffinity(0, sizeof all, &all), 0);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("ranks");
    TCase *tcase = tcase_create("ranks");
    tcase_add_test(tcase, test_launcher);
    tcase_add_test(tcase, test_greeting);
    tcase_add_test(tcase, test_greeting_of_a_rank_that_cannot);
    tcase_add_test(tcase, test_slice);
    tcase_add_test(tcase, test_pass_order);
    tcase_add_test(tcase, test_processors);
    suite_add_tcase(suite, tcase);
    return test_run(suite);
}
