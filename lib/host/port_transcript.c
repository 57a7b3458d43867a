/* A port whose host is the one of a transcript, played again. */
#include <string.h>

#include "port_internal.h"

/* By an entry's kind, the event of its port. Entries of the controller's side have none. */
static const unsigned events[] = {
    [WH_TRANSCRIPT_SAID] = WH_PORT_FRAME,      [WH_TRANSCRIPT_TIMED_OUT] = WH_PORT_FRAME,
    [WH_TRANSCRIPT_CAME] = WH_PORT_CAME,       [WH_TRANSCRIPT_WENT] = WH_PORT_WENT,
    [WH_TRANSCRIPT_ELAPSED] = WH_PORT_ELAPSED, [WH_TRANSCRIPT_STOPPED] = WH_PORT_ENDED,
    [WH_TRANSCRIPT_HALTED] = WH_PORT_HALTED,
};

static unsigned event_of(wh_transcript_kind_t kind) {
    return (size_t)kind < sizeof events / sizeof events[0] ? events[kind] : 0;
}

/* Hands out the next entry of the host's side, if it is this port's. */
static unsigned serve_transcript(wh_port_t *port) {
    port->entry = wh_transcript_next_at(port->transcript, port->slice, port->place);
    return port->entry ? WH_PORT_TOLD | event_of(port->entry->kind) : 0;
}

/* Nobody is there: the controller's frames are compared when they are made. */
static unsigned send_nowhere(wh_port_t *port, const void *bytes, size_t size) {
    (void)port;
    (void)bytes;
    (void)size;
    return 0;
}

static void close_transcript(wh_port_t *port) {
    port->transcript = NULL;
}

static const wh_port_kind_t transcript_kind = {
    .serve = serve_transcript, .send = send_nowhere, .close = close_transcript};

void wh_port_open_transcript(wh_port_t *port, wh_transcript_t *transcript, const char *name) {
    wh_port_begin(port, &transcript_kind, WH_PORT_REFUSE);
    port->transcript = transcript;
    port->tells_all = true;
    port->is_local = true;
    (void)snprintf(port->place, sizeof port->place, "%s", name);
}
