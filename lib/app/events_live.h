/* Shows events as they happen, from a simulator on LCM. */
#ifndef WH_APP_EVENTS_LIVE_H
#define WH_APP_EVENTS_LIVE_H

#include "../record/record.h"
#include "../wire/told_layout.h"

typedef struct {
    const char *url; /* null: the default */
    /* A new cell was heard: the first one or another one. False ends it. */
    bool (*cell)(void *user, const wh_told_layout_t *cell);
    /* Another run was heard, also after RESET, RESTORE or UNDO. Runs count from the first one heard, which is
     * not told. `utime` is where the new run goes on. False ends it. */
    bool (*run)(void *user, int64_t number, int64_t utime);
    /* The record's i-th event has happened; the record has those of one slice. False ends it. */
    bool (*event)(void *user, const wh_record_t *record, size_t i);
    void *user;
} wh_events_live_t;

/* Listens until SIGINT or SIGTERM. If the state of a slice comes twice, its events are told once. It does not
 * wait for states that never come: standard error says how many slices of a run were not heard. Returns the
 * exit status: WH_EXIT_MET when a signal ended it, WH_EXIT_FAILED if LCM failed, WH_EXIT_USAGE if it could
 * not be opened or a listener ended it. */
int wh_events_live(const wh_events_live_t *live);

#endif
