/* The server of a live page: HTTP and server-sent events, over libmicrohttpd.
 *
 *   GET /            and the other files, as they were given
 *   GET /document    the whole past as JSON, made anew for each that asks
 *   GET /stream?from=N&id=ID   the feed from message N on (view/feed.h), without end. Numbers of another
 *                    process mean nothing: unless the id is the source's, the first message is `anew`
 *   POST /control    a request of at most WH_HTTP_BODY bytes, if the source takes any
 *
 * One thread calls wh_http_wait and wh_http_serve in turn; nothing in it waits for a client. Everything is
 * bounded: the connections, the bytes and the time of a request's head, its body, and how long a client may
 * not read. A client that does not read loses frames, is asked to fetch the document, or is closed; nobody
 * else notices. Whoever is not the page itself is refused: see view/origin.h. Nothing is taken from other
 * servers, nor may another page show this one in a frame: a content security policy says so to the browser.
 *
 * A program that was built without libmicrohttpd has these functions, too: wh_http_open then tells so.
 */
#ifndef WH_VIEW_HTTP_H
#define WH_VIEW_HTTP_H

#include <stdint.h>

#include "feed.h"

#define WH_HTTP_PROBLEM_BYTES 400
#define WH_HTTP_PLACE_BYTES 80

/* The most connections, and those of them that may be streams. */
#define WH_HTTP_CONNECTIONS 64
#define WH_HTTP_STREAMS 32

/* The most bytes of a request's head, and of its body. */
#define WH_HTTP_HEAD 16384
#define WH_HTTP_BODY 4096

/* The longest time that a request's head may take, and that a client may do nothing, s. */
#define WH_HTTP_SECONDS 10

typedef struct {
    const char *path, *type; /* "/" and "text/html" */
    const char *text;
    size_t size;
} wh_http_file_t;

/* The server tells this; all of it must outlive the server. */
typedef struct {
    const wh_http_file_t *files;
    size_t file_count;
    wh_feed_t *feed;
    const char *id; /* of this process: no other has had it at this place */
    /* The document, to be freed. */
    char *(*document)(void *user, size_t *size);
    /* Takes a request of `size` bytes, with a zero behind them. Returns HTTP's status, and the answer as
     * JSON in `answer`, to be freed. Null: there is no control. */
    unsigned (*control)(void *user, const char *body, size_t size, char **answer);
    void *user;
} wh_http_source_t;

typedef struct {
    uint64_t requests, refused; /* all; those of strangers */
    uint64_t streams, closed;   /* begun; closed because their client did not read */
    uint64_t missed;            /* frames that slow clients did not get */
} wh_http_counters_t;

typedef struct wh_http wh_http_t;

/* Listens at "ADDRESS:PORT" or "PORT", as host/address.h reads it. An empty text is WH_HTTP_PORT at
 * 127.0.0.1, or any free port there if that one is taken. Null, and the reason in `problem`, if that fails.
 * */
#define WH_HTTP_PORT 8765
wh_http_t *wh_http_open(const char *address, const wh_http_source_t *source,
                        char problem[WH_HTTP_PROBLEM_BYTES]);

/* Where it listens, for an URL: "127.0.0.1:8765"; of 0.0.0.0 and [::] the loopback address. */
const char *wh_http_place(const wh_http_t *http);

/* True if it can be reached from this machine alone. */
bool wh_http_is_local(const wh_http_t *http);

/* Waits for at most `wait_us`, until a client does something, or until `wake` can be read (-1: nothing wakes
 * it). Needs nothing of the source. */
void wh_http_wait(const wh_http_t *http, int64_t wait_us, int wake);

/* Serves all clients as far as possible without waiting. */
void wh_http_serve(wh_http_t *http);

/* The number of streams at present. */
size_t wh_http_streams(const wh_http_t *http);

const wh_http_counters_t *wh_http_counters(const wh_http_t *http);

/* Closes all connections and frees it; null does nothing. */
void wh_http_close(wh_http_t *http);

#endif
