/* What ranks other than 0 do. */
#include "ranks/ranks.h"

#include "backend/film_sink.h"
#include "base/log.h"
#include "ranks/communicator.h"
#include "ranks/greeting.h"
#include "ranks/pass_cache.h"
#include "ranks/scene_copy.h"
#include "ranks/slice.h"

#include <string.h>

typedef struct RankServer {
    const RankSetup *setup;
    SceneCopy scene;
    BackendMember backend;
    PassCache cache;
    Archive broadcast;
    FilmWords film; /* of the current pass */
    bool films; /* it has one */
    PassWords words; /* of this rank's items */
    bool stopped; /* the stop of the current pass has been received */
    RankReport report;
} RankServer;

#define WARNING "warning: "

static void warning_keep(const char *line, void *context)
{
    RankReport *report = context;
    size_t used = strlen(report->warnings);
    snprintf(report->warnings + used, sizeof report->warnings - used, "%srank %d on %s: %s", used > 0 ? "\n" : "",
             ranks_number(), communicator_machine(),
             line + (strncmp(line, WARNING, strlen(WARNING)) == 0 ? strlen(WARNING) : 0));
}

static void report_send(RankServer *server)
{
    RankReport *report = &server->report;
    if (!report->good)
        rank_error(&report->error, ranks_number(), communicator_machine(), &report->error);
    if (server->backend.backend) {
        server->backend.interface->statistics(server->backend.backend, &report->statistics);
        server->backend.interface->diagnostics(server->backend.backend, report->diagnostics);
    }
    message_send(0, TAG_REPORT, report, sizeof *report);
}

static void backend_open(RankServer *server)
{
    RankReport *report = &server->report;
    if (!scene_receive(&server->scene, &report->error))
        communicator_abort(&report->error);
    log_sink_set(warning_keep, report);
    report->good = backend_choices_open(server->setup->choices, &server->scene.scene, server->setup->options,
                                        &server->backend, &report->error);
    log_sink_set(NULL, NULL);
    report_send(server);
    memset(report, 0, sizeof *report);
}

/* Lets the computation end once rank 0 says so. */
static void slice_watch(RankServer *server, Slice *slice, atomic_int *stop)
{
    char nothing;
    int from;
    while (!slice_wait(slice, SLICE_LOOK_SECONDS))
        if (!server->stopped && message_waits(TAG_STOP, &from)) {
            message_receive(0, TAG_STOP, &nothing, sizeof nothing);
            atomic_store(stop, 1);
            server->stopped = true;
        }
    slice_join(slice);
}

/* Receives a pass and the words of this rank's items; aborts if there is no memory for them. */
static void pass_receive(RankServer *server, const RankCommand *command)
{
    PassCache *cache = &server->cache;
    const PassOrder *order = &cache->order;
    Error error = {0};
    if (!pass_order_receive(cache, &server->broadcast, &error))
        communicator_abort(&error);
    server->films = order->sum_words > 0;
    server->stopped = false;
    if (server->films && !pass_film_begin(cache, &server->film, server->scene.tables, &error))
        communicator_abort(&error);
    server->words =
        (PassWords){cache->list.pass_words, command->first, command->count, order->pass_fields, order->pass_stride};
    if (pass_words_any(&server->words))
        pass_words_receive(0, &server->words);
}

static void pass_compute(RankServer *server, const RankCommand *command)
{
    RankReport *report = &server->report;
    const PassOrder *order = &server->cache.order;
    SplatSink sink = {.splats = NULL};
    if (server->films)
        sink = film_sink(&server->film.film);
    sink.whole = order->whole;
    atomic_int stop = 0;
    Slice slice = {
        .backend = server->backend, .frame = order->frame, .list = &server->cache.list, .sink = &sink, .stop = &stop};
    slice.frame.pass.first_item = command->first;
    slice.frame.pass.item_count = command->count;
    slice_start(&slice);
    slice_watch(server, &slice, &stop);
    report->delivered = slice.delivered;
    report->seconds = slice.seconds;
    report->good = slice.good;
    report->error = slice.error;
    report_send(server);
    if (pass_words_any(&server->words))
        pass_words_send(0, &server->words);
}

static void pass_finish(RankServer *server, const RankCommand *command)
{
    char nothing;
    if (command->stopped && !server->stopped)
        message_receive(0, TAG_STOP, &nothing, sizeof nothing);
    if (!server->films)
        return;
    film_words_end(&server->film);
    film_words_reduce(&server->film);
    pass_film_clear(&server->cache, &server->film);
}

static void greeting_send(const RankSetup *setup)
{
    RankGreeting greeting;
    greeting_make(&greeting, communicator_machine());
    greeting.status = setup->status;
    greeting.error = setup->error;
    message_send(0, TAG_GREETING, &greeting, sizeof greeting);
}

static void commands_follow(RankServer *server)
{
    for (RankCommand command = {.kind = COMMAND_OPEN};;) {
        message_receive(0, TAG_COMMAND, &command, sizeof command);
        switch (command.kind) {
        case COMMAND_OPEN:
            backend_open(server);
            break;
        case COMMAND_PASS:
            pass_receive(server, &command);
            pass_compute(server, &command);
            break;
        case COMMAND_FINISH:
            pass_finish(server, &command);
            break;
        case COMMAND_END:
            return;
        }
    }
}

void ranks_serve(const RankSetup *setup)
{
    RankServer server;
    memset(&server, 0, sizeof server);
    server.setup = setup;
    server.broadcast = communicator_broadcast();
    greeting_send(setup);
    commands_follow(&server);
    if (server.backend.backend)
        server.backend.interface->close(server.backend.backend);
    pass_cache_destroy(&server.cache);
    scene_copy_destroy(&server.scene);
}
