#include "serve/connections.h"

#include <stddef.h>
#include <sys/socket.h>

/* Shuts down what has waited longest for a request if there are too many. */
static void connections_limit(Connections *connections)
{
    Connection *oldest = NULL;
    unsigned count = 0;
    for (unsigned i = 0; i < CONNECTIONS_WITH_CLOSING; ++i) {
        Connection *entry = &connections->entries[i];
        if (!entry->open || entry->closing)
            continue;
        ++count;
        oldest = !oldest || entry->requested < oldest->requested ? entry : oldest;
    }
    if (count <= CONNECTIONS_MAX)
        return;
    oldest->closing = true;
    shutdown(oldest->socket, SHUT_RDWR);
}

Connection *connection_add(Connections *connections, int socket, double now)
{
    for (unsigned i = 0; i < CONNECTIONS_WITH_CLOSING; ++i) {
        Connection *entry = &connections->entries[i];
        if (entry->open)
            continue;
        *entry = (Connection){.socket = socket, .open = true, .requested = now};
        connections_limit(connections);
        return entry;
    }
    return NULL;
}

void connection_remove(Connection *connection)
{
    if (connection)
        connection->open = false;
}
