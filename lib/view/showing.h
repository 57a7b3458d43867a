/* The way of a moving cell from the thread that steps it to the thread that shows it.
 *
 * The stepping thread waits for nothing here. A glimpse is a copy of the state: it is made only in a slice in
 * which one is asked for, and put into one of three rooms. Each side has one of them, the third is between
 * them. News (events, commands, frames) are a list that both sides exchange at once. So no slice comes later,
 * and no result changes, whoever looks.
 *
 * Cost in the stepping thread: a load of a flag and a copy of the axes for each slice; a copy of the state,
 * some 10 kB and the wafers, when it is asked for; likewise for each slice with events.
 *
 * Between wh_showing_open and wh_showing_close the functions of each side belong to one thread. Host code: it
 * ends the program if out of memory.
 */
#ifndef WH_VIEW_SHOWING_H
#define WH_VIEW_SHOWING_H

#include "../record/record.h"
#include "../sim/slice.h"

/* A copied state. Its pointers lead to memory of its own; news alone have events. */
typedef struct {
    double axes[WH_AXES];
    size_t axis_count; /* 0: not known */
    wh_state_t state;
    wh_wafer_t *wafers;
    uint64_t epoch;     /* grows when the run is set back to an earlier slice */
    uint64_t wafers_at; /* the count of slices with events before which they were copied */
    wh_gripper_t grippers[WH_GRIPPERS];
    wh_physics_state_t physics;
} wh_glimpse_t;

typedef enum {
    WH_NEWS_EVENTS,         /* a slice with events: `look` has them */
    WH_NEWS_SET_BACK,       /* the run was set back to the state of `look` */
    WH_NEWS_COMMAND_BEGINS, /* task, line, text, begin_s */
    WH_NEWS_COMMAND_ENDED,  /* likewise; end_s, error, more: its message */
    WH_NEWS_EXPECTED,       /* line, text, good */
    WH_NEWS_STATION,        /* station */
    WH_NEWS_WAITS,          /* task waits for `text` */
    WH_NEWS_GOES_ON,        /* task waits no longer */
    WH_NEWS_HELD,           /* good: a HOLD stands, of the robots in `text` or, empty, of all that runs */
    WH_NEWS_FRAME,          /* text at port `more`; good: it came from the host */
    WH_NEWS_ANSWER,         /* text: JSON, one line, for the page that has asked */
    WH_NEWS_ENDED           /* the run is over: good, or text: why not */
} wh_news_kind_t;

/* Only what the kind names is set. Texts are the news' own. */
typedef struct wh_news {
    struct wh_news *next;
    wh_news_kind_t kind;
    int64_t utime; /* of the run */
    wh_glimpse_t *look;
    wh_event_t *events;
    wh_seat_t *seats;
    size_t event_count;
    int32_t task;
    int line;
    double begin_s, end_s;
    wh_status_t error;
    bool good;
    char *text, *more;
    wh_station_event_record_t station;
} wh_news_t;

typedef struct wh_showing wh_showing_t;

/* For cells of this layout, which must outlive it. */
wh_showing_t *wh_showing_open(const wh_layout_t *layout);

/* Null does nothing. Neither side may be at work. */
void wh_showing_close(wh_showing_t *showing);

/* -------------------------------------------------------------------------------- the stepping thread's */

/* A slice that was played. `state` must stay readable until the next call or wh_showing_forget. */
void wh_showing_slice(wh_showing_t *showing, const wh_command_t *command, const wh_state_t *state);

/* The run was set back to this state, which must stay readable likewise. */
void wh_showing_set_back(wh_showing_t *showing, const wh_command_t *command, const wh_state_t *state);

/* Nothing moves for now: the last slice is handed over, whether asked for or not. */
void wh_showing_rest(wh_showing_t *showing);

/* Forgets the last slice: its memory goes. */
void wh_showing_forget(wh_showing_t *showing);

/* Tells news; it takes them over. wh_news_make makes one, with copies of the texts, which may be null. */
void wh_showing_tell(wh_showing_t *showing, wh_news_t *news);
wh_news_t *wh_news_make(wh_news_kind_t kind, int64_t utime, const char *text, const char *more);

/* ---------------------------------------------------------------------------------- the showing thread's */

/* Asks for a glimpse of the next slice. */
void wh_showing_ask(wh_showing_t *showing);

/* The newest glimpse, valid until the next call; null: there is none since the last one. Take it before the
 * news: then they have all events up to its slice, and perhaps later ones. */
const wh_glimpse_t *wh_showing_take(wh_showing_t *showing);

/* All news so far, the oldest first; null: there are none. Free each by wh_news_free. */
wh_news_t *wh_showing_take_news(wh_showing_t *showing);
void wh_news_free(wh_news_t *news);

#endif
