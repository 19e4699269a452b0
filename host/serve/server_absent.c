/* In a program built without libmicrohttpd. */
#include "serve/server.h"

bool server_available(Error *error)
{
    error_set(error, "--serve is not in this program, which was built without libmicrohttpd");
    return error_fix(error, "install libmicrohttpd-dev and configure again, or use --tev=HOST:PORT");
}

Server *server_begin(const OptionAddress *address, Snapshot *snapshot, const RenderFacts *facts, Error *error)
{
    (void)address;
    (void)snapshot;
    (void)facts;
    server_available(error);
    return NULL;
}

void server_end(Server *server)
{
    (void)server;
}
