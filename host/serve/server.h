/* A page in the browser that shows a rendering as it converges (page.html), by GNU libmicrohttpd. It is read only, and
 * all that it gives is in memory. Its address holds a random token, without which requests are refused, as are those
 * for a host name that is not its own, so that no page from elsewhere can be made to read it. */
#ifndef TWINLIGHT_SERVE_SERVER_H
#define TWINLIGHT_SERVE_SERVER_H

#include "base/option_values.h"
#include "serve/status_json.h"

typedef struct Server Server;

/* Whether this program has it (configure --with-libmicrohttpd); otherwise fails and says what to do. */
bool server_available(Error *error);

/* Starts serving, and prints the address on standard error, whatever else is printed: only there is the token. Port 0:
 * one that the system chooses. NULL on failure. What is given must outlive the server. */
Server *server_begin(const OptionAddress *address, Snapshot *snapshot, const RenderFacts *facts, Error *error);

/* Waits until clients that were there in the last moments have what was published last, at most two seconds, and ends.
 * Safe with NULL. */
void server_end(Server *server);

#endif
