/* The other partners of a run, which motion control calls: a link to a simulator elsewhere, and who hears
 * of it. */
#ifndef WH_MCS_PARTNERS_H
#define WH_MCS_PARTNERS_H

#include "../layout/layout.h"
#include "../record/record.h"
#include "../sim/slice.h"

typedef struct wh_mcs wh_mcs_t;

/* Room for the bytes that a partner saves. */
#define WH_MCS_SAVED_BYTES ((size_t)1 << 17)

/* The news that motion control has for its partners. Those of a HOLD are for listeners alone. */
typedef enum {
    WH_MCS_COMMAND_BEGINS, /* a command of the record */
    WH_MCS_COMMAND_ENDED,
    WH_MCS_EXPECTED,     /* an expectation was added to the record, as its last one */
    WH_MCS_CYCLE_BEGINS, /* likewise a cycle */
    WH_MCS_STATION_TOLD, /* likewise what a station does by itself */
    WH_MCS_EDGE_SCANNED, /* the scan of wh_mcs_measuring has ended */
    WH_MCS_CENTRED,      /* wh_mcs_measuring has the result of a pass through beams */
    WH_MCS_HELD,         /* a host's HOLD: what runs stands still, and the clock with it; or one of a flow's
                          * robots: wh_mcs_name_held */
    WH_MCS_NOT_HELD,     /* no HOLD stands: it is over, or a simulator is waited for */
    WH_MCS_FINISHED /* the record is closed: the run has ended, also by an error. Not told without a cell,
                          * nor at a prompt. */
} wh_mcs_news_t;

/* A link that can lose slices, to a simulator in another process. */
typedef struct {
    /* A segment is about to begin: waits for the missing answer to a slice that was given up. Unless it
     * returns WH_OK, no slice of the segment may go out. */
    wh_status_t (*resume)(void *user);
    /* The slice that goes out next is its segment's last. Its state decides what comes next, so a link waits
     * for it, also in a free run. */
    void (*await)(void *user);
    /* The last slice that has gone out and was not refused. */
    int64_t (*reached)(void *user);
    /* False while no state has come: nothing is known of the cell yet. */
    bool (*is_heard)(void *user);
    /* The reason why the link answered a slice with this error, for its message; valid until the next
     * call. Null: the error says enough. */
    const char *(*explain)(void *user, wh_status_t status);
} wh_mcs_lossy_t;

/* The other partners of a run; each function may be null. */
typedef struct {
    /* Called once, after the cell was set up and found in reach, and before the first slice. Returns the
     * link that replaces the simulator in this process; null, if there is none, ends the script. */
    wh_link_t *(*connect)(void *user, wh_mcs_t *mcs);
    /* All functions of a link that can lose slices; null: this link loses none. */
    const wh_mcs_lossy_t *lossy;
    /* Writes the state of the link's other side after the last slice, as bytes. Returns their number, 0 if
     * the state is not known. Null: such a link cannot tell. Not during an exchange. */
    size_t (*save)(void *user, uint8_t bytes[WH_MCS_SAVED_BYTES]);
    /* Restores the link's other side from these bytes; `state` is its answer, without events. On an error the
     * other side is unchanged. */
    wh_status_t (*restore)(void *user, const uint8_t bytes[], size_t size, wh_state_t *state);
    /* `command` is the one that begins or has ended; null in other news. */
    void (*tell)(void *user, const wh_mcs_t *mcs, wh_mcs_news_t news, const wh_command_record_t *command);
    /* The current task, the recorder's `number`, waits for `what`. Null: it goes on, and its command, if one
     * runs, has the axes and grippers of its lane. From the first call on there are tasks. */
    void (*turn)(void *user, const wh_mcs_t *mcs, const char *what);
    void *user;
} wh_mcs_partners_t;

/* Gets each slice that was sent: the command, and the state that came back. state->status tells whether it
 * was accepted. */
typedef void wh_slice_listener_t(void *user, const wh_command_t *command, const wh_state_t *state);

/* The listener of a run, for any partners; each function may be null. Counted time tells
 * it of slices left out: of the last one of a rest, and of one each 10 ms of a motion. */
typedef struct {
    wh_slice_listener_t *slice;
    /* A command of the record begins or has ended. Called before the first slice. */
    void (*boundary)(void *user, const wh_layout_t *layout);
    /* A cell was set up, or is gone back to because another could not be set up. The layout of the run before
     * is still there, and goes when this has returned. */
    void (*begins)(void *user, const wh_layout_t *layout);
    /* RESTORE or UNDO has put this state back, after this command. */
    wh_slice_listener_t *set_back;
    /* Like those of the partners. */
    void (*tell)(void *user, const wh_mcs_t *mcs, wh_mcs_news_t news, const wh_command_record_t *command);
    void (*turn)(void *user, const wh_mcs_t *mcs, const char *what);
    /* A slice of a flow with axes is over: its robots may be held now, or go on. See flow_held.h. */
    void (*flow_slice)(void *user, wh_mcs_t *mcs);
    void *user;
} wh_mcs_listener_t;

#endif
