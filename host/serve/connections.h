/* The connections of clients. At most CONNECTIONS_MAX stay open: a new one replaces the one on which the longest time
 * has passed since it was made or last had a whole request. So clients that hang, or that send or read ever so slowly,
 * never keep others out. For use by one thread. */
#ifndef TWINLIGHT_SERVE_CONNECTIONS_H
#define TWINLIGHT_SERVE_CONNECTIONS_H

#include <stdbool.h>

#define CONNECTIONS_MAX 32u
/* Those that are being closed count until their sockets are. */
#define CONNECTIONS_WITH_CLOSING (2u * CONNECTIONS_MAX)

typedef struct Connection {
    int socket;
    bool open; /* false: a free entry */
    bool closing; /* was shut down, but its socket has not been closed yet */
    double requested; /* when it was made or had its latest request, in timing_now */
} Connection;

typedef struct Connections {
    Connection entries[CONNECTIONS_WITH_CLOSING]; /* zeroed: none */
} Connections;

/* Adds a connection made at time `now`; shuts another one down (shutdown(2)) if there are too many. The owner of the
 * sockets closes that one and calls connection_remove. NULL, with nothing done, if no entry is free. */
Connection *connection_add(Connections *connections, int socket, double now);

/* Frees the entry. Safe with NULL. */
void connection_remove(Connection *connection);

#endif
