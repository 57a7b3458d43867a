#include "http.h"

#if defined(WH_MICROHTTPD)

#include <inttypes.h>
#include <poll.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <unistd.h>

#include "../text/array.h"
#include "../text/clock.h"
#include "listen.h"
#include "microhttpd.h"
#include "origin.h"

/* A client that listens hears at least this often: so one that is gone is noticed, us. */
#define BEAT_US 5000000

static const char beat[] = ": \n\n";

/* Set before a server is opened. */
static const wh_microhttpd_t *mhd;

/* A connection, from when it was accepted on. */
typedef struct peer {
    struct peer *next;
    int fd;
    bool is_heard; /* the head of its request has come whole */
    int64_t since_us;
} peer_t;

/* A client that reads the feed. */
typedef struct stream {
    struct stream *next;
    struct MHD_Connection *connection;
    wh_http_t *http;
    wh_feed_reader_t reader;
    bool is_suspended, is_due; /* is_due: a beat is to be sent */
} stream_t;

/* A request on its way; its body is kept if it is one of control. */
typedef struct {
    size_t size;
    bool is_too_large;
    char body[WH_HTTP_BODY + 1];
} request_t;

struct wh_http {
    wh_http_source_t source;
    wh_address_t place;
    char text[WH_HTTP_PLACE_BYTES];
    struct MHD_Daemon *daemon;
    peer_t *peers;
    stream_t *streams;
    size_t stream_count;
    int64_t beat_us;
    wh_http_counters_t counters;
};

/* ------------------------------------------------------------------------------------------------ answers */

/* Nothing from elsewhere is loaded, nothing is sent elsewhere, and nobody shows this in a frame. */
static const char *const always[][2] = {
    {"Content-Security-Policy",
     "default-src 'none'; script-src 'self'; style-src 'self' 'unsafe-inline'; img-src data: blob:; "
     "connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'"},
    {"X-Content-Type-Options", "nosniff"},
    {"Cross-Origin-Resource-Policy", "same-origin"},
    {"Cross-Origin-Opener-Policy", "same-origin"},
    {"Referrer-Policy", "no-referrer"},
    {"Cache-Control", "no-store"},
};

static enum MHD_Result answer(struct MHD_Connection *connection, unsigned status,
                              struct MHD_Response *response, const char *type) {
    if (!response) {
        return MHD_NO;
    }
    bool good = mhd->MHD_add_response_header(response, "Content-Type", type) == MHD_YES;
    for (size_t i = 0; good && i < sizeof always / sizeof always[0]; ++i) {
        good = mhd->MHD_add_response_header(response, always[i][0], always[i][1]) == MHD_YES;
    }
    const enum MHD_Result queued = good ? mhd->MHD_queue_response(connection, status, response) : MHD_NO;
    mhd->MHD_destroy_response(response);
    return queued;
}

/* A line of text, with a constant as its content. */
static enum MHD_Result tell(struct MHD_Connection *connection, unsigned status, const char *text) {
    char line[300];
    const int size = snprintf(line, sizeof line, "%s\n", text);
    return answer(connection, status,
                  mhd->MHD_create_response_from_buffer((size_t)size, line, MHD_RESPMEM_MUST_COPY),
                  "text/plain; charset=utf-8");
}

static enum MHD_Result give(struct MHD_Connection *connection, unsigned status, char *text, size_t size) {
    return answer(connection, status, mhd->MHD_create_response_from_buffer(size, text, MHD_RESPMEM_MUST_FREE),
                  "application/json");
}

/* ------------------------------------------------------------------------------------------------ streams */

static ssize_t read_stream(void *user, uint64_t at, char *to, size_t size) {
    stream_t *stream = user;
    (void)at;
    const size_t read = wh_feed_read(stream->http->source.feed, &stream->reader, to, size);
    if (read > 0) {
        stream->is_due = false;
        return (ssize_t)read;
    }
    if (stream->is_due && size >= sizeof beat - 1) {
        stream->is_due = false;
        memcpy(to, beat, sizeof beat - 1);
        return (ssize_t)(sizeof beat - 1);
    }
    stream->is_suspended = true;
    mhd->MHD_suspend_connection(stream->connection);
    return 0;
}

static void end_stream(void *user) {
    stream_t *stream = user;
    wh_http_t *http = stream->http;
    stream_t **place = &http->streams;
    while (*place != stream) {
        place = &(*place)->next;
    }
    *place = stream->next;
    --http->stream_count;
    http->counters.missed += stream->reader.missed;
    wh_feed_leave(&stream->reader);
    free(stream);
}

/* The browser tells from where on when it connects again by itself. */
static uint64_t first_message(const wh_http_t *http, struct MHD_Connection *connection) {
    const char *id = mhd->MHD_lookup_connection_value(connection, MHD_GET_ARGUMENT_KIND, "id");
    if (!id || strcmp(id, http->source.id) != 0) {
        return UINT64_MAX;
    }
    const char *from = mhd->MHD_lookup_connection_value(connection, MHD_GET_ARGUMENT_KIND, "from");
    const char *last = mhd->MHD_lookup_connection_value(connection, MHD_HEADER_KIND, "Last-Event-ID");
    return last ? strtoull(last, NULL, 10) + 1 : from ? strtoull(from, NULL, 10) : 0;
}

static enum MHD_Result begin_stream(wh_http_t *http, struct MHD_Connection *connection) {
    if (http->stream_count >= WH_HTTP_STREAMS) {
        return tell(connection, MHD_HTTP_SERVICE_UNAVAILABLE, "too many pages look at this cell already");
    }
    stream_t *stream = wh_array_new(1, sizeof *stream);
    stream->http = http;
    stream->connection = connection;
    stream->reader.next = first_message(http, connection);
    stream->is_due = true; /* so that the browser hears at once that it is connected */
    stream->next = http->streams;
    http->streams = stream;
    ++http->stream_count;
    ++http->counters.streams;
    struct MHD_Response *response =
        mhd->MHD_create_response_from_callback(MHD_SIZE_UNKNOWN, 16384, read_stream, stream, end_stream);
    return answer(connection, MHD_HTTP_OK, response, "text/event-stream");
}

static void wake_streams(wh_http_t *http) {
    const int64_t now = wh_clock_us(CLOCK_MONOTONIC);
    const bool beats = now - http->beat_us >= BEAT_US;
    http->beat_us = beats ? now : http->beat_us;
    for (stream_t *stream = http->streams; stream; stream = stream->next) {
        stream->is_due = stream->is_due || beats;
        if (stream->is_suspended &&
            (stream->is_due || wh_feed_has_news(http->source.feed, &stream->reader))) {
            stream->is_suspended = false;
            mhd->MHD_resume_connection(stream->connection);
        }
    }
}

/* ----------------------------------------------------------------------------------------------- requests */

static const char *header(struct MHD_Connection *connection, const char *name) {
    return mhd->MHD_lookup_connection_value(connection, MHD_HEADER_KIND, name);
}

static const wh_http_file_t *find_file(const wh_http_t *http, const char *path) {
    for (size_t i = 0; i < http->source.file_count; ++i) {
        if (strcmp(http->source.files[i].path, path) == 0) {
            return &http->source.files[i];
        }
    }
    return NULL;
}

static enum MHD_Result give_document(wh_http_t *http, struct MHD_Connection *connection) {
    size_t size = 0;
    char *text = http->source.document(http->source.user, &size);
    return text ? give(connection, MHD_HTTP_OK, text, size)
                : tell(connection, MHD_HTTP_SERVICE_UNAVAILABLE, "no cell is known yet");
}

static enum MHD_Result get(wh_http_t *http, struct MHD_Connection *connection, const char *path) {
    const wh_http_file_t *file = find_file(http, path);
    if (file) {
        return answer(connection, MHD_HTTP_OK,
                      mhd->MHD_create_response_from_buffer(file->size, (void *)(uintptr_t)file->text,
                                                           MHD_RESPMEM_PERSISTENT),
                      file->type);
    }
    if (strcmp(path, "/document") == 0) {
        return give_document(http, connection);
    }
    return strcmp(path, "/stream") == 0 ? begin_stream(http, connection)
                                        : tell(connection, MHD_HTTP_NOT_FOUND, "there is no such page");
}

static enum MHD_Result control(wh_http_t *http, struct MHD_Connection *connection, const request_t *request) {
    char *text = NULL;
    if (request->is_too_large) {
        return tell(connection, MHD_HTTP_CONTENT_TOO_LARGE, "the request is too long");
    }
    const char *type = header(connection, "Content-Type");
    if (!type || strcmp(type, "application/json") != 0) {
        return tell(connection, MHD_HTTP_UNSUPPORTED_MEDIA_TYPE, "expected application/json");
    }
    const unsigned status = http->source.control(http->source.user, request->body, request->size, &text);
    return give(connection, status, text, strlen(text));
}

static enum MHD_Result reply(wh_http_t *http, struct MHD_Connection *connection, const char *path,
                             const char *method, const request_t *request) {
    const bool is_get = strcmp(method, MHD_HTTP_METHOD_GET) == 0;
    const wh_origin_headers_t headers = {header(connection, "Host"), header(connection, "Origin"),
                                         header(connection, "Sec-Fetch-Site"),
                                         header(connection, "Sec-Fetch-Mode")};
    const char *refusal = wh_origin_refusal(&http->place, &headers, is_get && strcmp(path, "/") == 0);
    ++http->counters.requests;
    if (refusal) {
        ++http->counters.refused;
        return tell(connection, MHD_HTTP_FORBIDDEN, refusal);
    }
    if (is_get) {
        return get(http, connection, path);
    }
    if (strcmp(method, MHD_HTTP_METHOD_POST) == 0 && strcmp(path, "/control") == 0) {
        return http->source.control ? control(http, connection, request)
                                    : tell(connection, MHD_HTTP_FORBIDDEN,
                                           "nothing can be commanded here (expected --page-control)");
    }
    return tell(connection, MHD_HTTP_METHOD_NOT_ALLOWED, "expected GET");
}

static void take_body(request_t *request, const char *bytes, size_t size) {
    if (size > WH_HTTP_BODY - request->size) {
        request->is_too_large = true;
        return;
    }
    memcpy(request->body + request->size, bytes, size);
    request->size += size;
}

/* It is called when the head has come, for each piece of a body, and when all has come. */
static enum MHD_Result on_request(void *user, struct MHD_Connection *connection, const char *path,
                                  const char *method, const char *version, const char *bytes, size_t *size,
                                  void **kept) {
    (void)version;
    if (!*kept) {
        const union MHD_ConnectionInfo *info =
            mhd->MHD_get_connection_info(connection, MHD_CONNECTION_INFO_SOCKET_CONTEXT);
        if (info && info->socket_context) {
            ((peer_t *)info->socket_context)->is_heard = strcmp(method, MHD_HTTP_METHOD_GET) == 0;
        }
        *kept = wh_array_new(1, sizeof(request_t));
        return MHD_YES;
    }
    if (*size > 0) {
        take_body(*kept, bytes, *size);
        *size = 0;
        return MHD_YES;
    }
    return reply(user, connection, path, method, *kept);
}

static void on_completed(void *user, struct MHD_Connection *connection, void **kept,
                         enum MHD_RequestTerminationCode how) {
    wh_http_t *http = user;
    const union MHD_ConnectionInfo *info =
        mhd->MHD_get_connection_info(connection, MHD_CONNECTION_INFO_SOCKET_CONTEXT);
    if (info && info->socket_context) {
        peer_t *peer = info->socket_context;
        peer->is_heard = false;
        peer->since_us = wh_clock_us(CLOCK_MONOTONIC);
    }
    http->counters.closed += how == MHD_REQUEST_TERMINATED_TIMEOUT_REACHED ? 1 : 0;
    free(*kept);
    *kept = NULL;
}

/* -------------------------------------------------------------------------------------------------- peers */

static void on_connection(void *user, struct MHD_Connection *connection, void **context,
                          enum MHD_ConnectionNotificationCode what) {
    wh_http_t *http = user;
    if (what == MHD_CONNECTION_NOTIFY_STARTED) {
        const union MHD_ConnectionInfo *info =
            mhd->MHD_get_connection_info(connection, MHD_CONNECTION_INFO_CONNECTION_FD);
        peer_t *peer = wh_array_new(1, sizeof *peer);
        *peer = (peer_t){http->peers, info ? info->connect_fd : -1, false, wh_clock_us(CLOCK_MONOTONIC)};
        http->peers = peer;
        *context = peer;
        return;
    }
    peer_t **place = &http->peers;
    while (*place && *place != *context) {
        place = &(*place)->next;
    }
    if (*place) {
        *place = (*place)->next;
        free(*context);
    }
    *context = NULL;
}

/* A byte now and then keeps a connection alive, but not for longer than this. */
static void end_slow_peers(const wh_http_t *http) {
    const int64_t now = wh_clock_us(CLOCK_MONOTONIC);
    for (const peer_t *peer = http->peers; peer; peer = peer->next) {
        if (!peer->is_heard && now - peer->since_us > WH_HTTP_SECONDS * 1000000LL && peer->fd >= 0) {
            (void)shutdown(peer->fd, SHUT_RDWR);
        }
    }
}

/* ------------------------------------------------------------------------------------------------ serving */

size_t wh_http_streams(const wh_http_t *http) {
    return http->stream_count;
}

const wh_http_counters_t *wh_http_counters(const wh_http_t *http) {
    return &http->counters;
}

const char *wh_http_place(const wh_http_t *http) {
    return http->text;
}

bool wh_http_is_local(const wh_http_t *http) {
    return wh_address_is_local(&http->place);
}

static int epoll_of(const wh_http_t *http) {
    const union MHD_DaemonInfo *info = mhd->MHD_get_daemon_info(http->daemon, MHD_DAEMON_INFO_EPOLL_FD);
    return info ? info->epoll_fd : -1;
}

void wh_http_wait(const wh_http_t *http, int64_t wait_us, int wake) {
    struct pollfd ready[] = {{.fd = epoll_of(http), .events = POLLIN}, {.fd = wake, .events = POLLIN}};
    MHD_UNSIGNED_LONG_LONG due_ms = 0;
    const bool is_due = mhd->MHD_get_timeout(http->daemon, &due_ms) == MHD_YES;
    const int64_t most_ms = wait_us / 1000;
    (void)poll(ready, 2, (int)(is_due && (int64_t)due_ms < most_ms ? (int64_t)due_ms : most_ms));
}

void wh_http_serve(wh_http_t *http) {
    wake_streams(http);
    (void)mhd->MHD_run(http->daemon);
    end_slow_peers(http);
}

/* ------------------------------------------------------------------------------------------------ opening */

static void ignore(void *user, const char *format, va_list arguments) {
    (void)user;
    (void)format;
    (void)arguments;
}

wh_http_t *wh_http_open(const char *address, const wh_http_source_t *source,
                        char problem[WH_HTTP_PROBLEM_BYTES]) {
    mhd = wh_microhttpd();
    if (!mhd) {
        (void)snprintf(problem, WH_HTTP_PROBLEM_BYTES,
                       WH_MICROHTTPD " cannot be loaded (expected it where the system's libraries are)");
        return NULL;
    }
    wh_http_t *http = wh_array_new(1, sizeof *http);
    http->source = *source;
    const int fd = wh_listen_open(address, &http->place, problem);
    if (fd < 0) {
        free(http);
        return NULL;
    }
    wh_listen_name(&http->place, http->text);
    http->daemon = mhd->MHD_start_daemon(
        MHD_USE_EPOLL | MHD_ALLOW_SUSPEND_RESUME, 0, NULL, NULL, on_request, http, MHD_OPTION_EXTERNAL_LOGGER,
        ignore, NULL, MHD_OPTION_LISTEN_SOCKET, fd, MHD_OPTION_CONNECTION_LIMIT,
        (unsigned)WH_HTTP_CONNECTIONS, MHD_OPTION_CONNECTION_TIMEOUT, (unsigned)WH_HTTP_SECONDS,
        MHD_OPTION_CONNECTION_MEMORY_LIMIT, (size_t)2 * WH_HTTP_HEAD, MHD_OPTION_STRICT_FOR_CLIENT, 1,
        MHD_OPTION_NOTIFY_COMPLETED, on_completed, http, MHD_OPTION_NOTIFY_CONNECTION, on_connection, http,
        MHD_OPTION_END);
    if (!http->daemon) {
        (void)snprintf(problem, WH_HTTP_PROBLEM_BYTES, "%s: libmicrohttpd does not start", http->text);
        (void)close(fd);
        free(http);
        return NULL;
    }
    return http;
}

void wh_http_close(wh_http_t *http) {
    if (!http) {
        return;
    }
    for (stream_t *stream = http->streams; stream; stream = stream->next) {
        if (stream->is_suspended) {
            stream->is_suspended = false;
            mhd->MHD_resume_connection(stream->connection);
        }
    }
    mhd->MHD_stop_daemon(http->daemon);
    free(http);
}

#else

#include <stdio.h>

wh_http_t *wh_http_open(const char *address, const wh_http_source_t *source,
                        char problem[WH_HTTP_PROBLEM_BYTES]) {
    (void)address;
    (void)source;
    (void)snprintf(
        problem, WH_HTTP_PROBLEM_BYTES,
        "this program was built without libmicrohttpd (expected `make deps FOR=page`, then `make`)");
    return NULL;
}

/* Nobody has a server to call these with. */
const char *wh_http_place(const wh_http_t *http) {
    (void)http;
    return "";
}

bool wh_http_is_local(const wh_http_t *http) {
    (void)http;
    return true;
}

void wh_http_wait(const wh_http_t *http, int64_t wait_us, int wake) {
    (void)http;
    (void)wait_us;
    (void)wake;
}

void wh_http_serve(wh_http_t *http) {
    (void)http;
}

size_t wh_http_streams(const wh_http_t *http) {
    (void)http;
    return 0;
}

const wh_http_counters_t *wh_http_counters(const wh_http_t *http) {
    (void)http;
    return NULL;
}

void wh_http_close(wh_http_t *http) {
    (void)http;
}

#endif
