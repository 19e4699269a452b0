#include "ranks/ranks.h"

#include "base/exit_status.h"
#include "base/log.h"
#include "base/processors.h"
#include "ranks/communicator.h"
#include "ranks/greeting.h"
#include "ranks/launcher.h"
#include "ranks/ranks_backend.h"
#include "ranks/scene_copy.h"

#include <fcntl.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static RankGreeting *greetings; /* of ranks 1 ...; NULL until they have been received */

const char *ranks_library(void)
{
    return communicator_library();
}

int ranks_count(void)
{
    return communicator_count();
}

int ranks_number(void)
{
    return communicator_number();
}

/* Rank 0 alone prints and decides when to end. */
static void rank_mute(void)
{
    static const int SIGNALS[] = {SIGINT, SIGTERM, SIGHUP, SIGUSR1, SIGUSR2, SIGPIPE};
    int nothing = open("/dev/null", O_WRONLY);
    if (nothing >= 0) {
        dup2(nothing, STDOUT_FILENO);
        close(nothing);
    }
    for (size_t i = 0; i < sizeof SIGNALS / sizeof SIGNALS[0]; ++i)
        signal(SIGNALS[i], SIG_IGN);
}

bool ranks_begin(Error *error)
{
    int processes = launcher_processes();
    if (processes == 1)
        return true;
    if (!communicator_begin(processes, error)) {
        if (launcher_rank() > 0)
            *error = (Error){0}; /* rank 0 says why */
        return false;
    }
    processors_share(communicator_neighbours());
    if (ranks_number() > 0)
        rank_mute();
    return true;
}

static void greetings_receive(void)
{
    size_t count = (size_t)ranks_count();
    Error error = {0};
    if (greetings || count == 1)
        return;
    greetings = calloc(count, sizeof *greetings);
    if (!greetings) {
        error_memory(&error, count * sizeof *greetings, "the ranks");
        communicator_abort(&error);
    }
    for (int rank = 1; rank < (int)count; ++rank)
        message_receive(rank, TAG_GREETING, &greetings[rank], sizeof greetings[rank]);
}

bool ranks_greet(int *status, Error *error)
{
    RankGreeting own;
    greetings_receive();
    greeting_make(&own, communicator_machine());
    for (int rank = 1; rank < ranks_count(); ++rank)
        if (!greeting_check(&own, &greetings[rank], rank, error)) {
            *status = greetings[rank].status != 0 ? (int)greetings[rank].status : EXIT_FAILED;
            return false;
        }
    return true;
}

static void command_all(CommandKind kind)
{
    const RankCommand command = {.kind = kind};
    for (int rank = 1; rank < ranks_count(); ++rank)
        message_send(rank, TAG_COMMAND, &command, sizeof command);
}

/* Prints the warnings of a rank's opening, each a line. */
static void warnings_tell(const RankReport *report)
{
    for (const char *line = report->warnings; *line;) {
        size_t length = strcspn(line, "\n");
        log_message(LOG_WARNING, "%.*s", (int)length, line);
        line += length + (line[length] == '\n');
    }
}

static bool reports_receive(RankReport *reports, bool good, Error *error)
{
    for (int rank = 1; rank < ranks_count(); ++rank) {
        RankReport *report = &reports[rank];
        message_receive(rank, TAG_REPORT, report, sizeof *report);
        if (report->good) {
            warnings_tell(report);
        } else if (good) {
            good = false;
            *error = report->error;
        }
    }
    return good;
}

bool ranks_open(const BackendScene *scene, const RankSetup *setup, BackendMember *opened, Error *error)
{
    if (ranks_count() == 1)
        return backend_choices_open(setup->choices, scene, setup->options, opened, error);
    BackendMember local = {NULL, NULL};
    RankReport *reports = calloc((size_t)ranks_count(), sizeof *reports);
    if (!reports)
        return error_memory(error, (size_t)ranks_count() * sizeof *reports, "the ranks");
    command_all(COMMAND_OPEN);
    scene_send(scene);
    bool good = backend_choices_open(setup->choices, scene, setup->options, &local, error);
    good = reports_receive(reports, good, error);
    *opened = (BackendMember){ranks_backend_interface(), NULL};
    if (good)
        opened->backend = ranks_backend_create(local, reports, scene->tables, error);
    else if (local.backend)
        local.interface->close(local.backend);
    free(reports);
    return opened->backend != NULL;
}

void ranks_end(void)
{
    if (ranks_number() == 0) {
        greetings_receive();
        command_all(COMMAND_END);
        free(greetings);
        greetings = NULL;
    }
    communicator_end();
}
