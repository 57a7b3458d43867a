#include "journal.h"

#include "../text/clock.h"

int64_t wh_host_now(const wh_host_t *host) {
    const wh_session_t *session = host->session;
    return host->played ? wh_session_time_us(session) + host->clock.skipped_us : wh_clock_us(CLOCK_MONOTONIC);
}

bool wh_host_differs(const wh_host_t *host) {
    return host->played && host->played->is_different;
}

void wh_host_note(wh_host_t *host, const wh_controller_t *controller, wh_transcript_kind_t kind,
                  const uint8_t *bytes, size_t size) {
    const wh_transcript_entry_t entry = {
        .slice = wh_session_slice(host->session),
        .time_us = wh_session_time_us(host->session),
        .kind = kind,
        .port = controller->name,
        .bytes = bytes,
        .size = size < WH_TRANSCRIPT_BYTES ? size : WH_TRANSCRIPT_BYTES,
    };
    if (host->callbacks.heard) {
        host->callbacks.heard(host->callbacks.heard_user, &entry);
    }
    if (host->transcript) {
        (void)(host->writes_json ? wh_transcript_write_json : wh_transcript_write)(host->transcript, &entry);
    }
    if (host->played && !wh_host_differs(host)) {
        (void)wh_transcript_compare(host->played, &entry);
    }
}

void wh_host_heed_clock(wh_host_t *host) {
    const wh_session_t *session = host->session;
    const int64_t back = host->clock.slice - wh_session_slice(session);
    if (back > 0) {
        host->clock.skipped_us += back * wh_session_slice_us(session);
        host->clock.base_run_us = wh_session_time_us(session);
        host->clock.base_wall_us = wh_host_now(host);
        wh_host_note(host, host->running, WH_TRANSCRIPT_CLOCK, NULL, 0);
    }
    host->clock.slice = wh_session_slice(session);
}
