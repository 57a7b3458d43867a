/* The news that a live page has to tell: all that was, thinned, and which of it browsers have not been told
 * yet. It belongs to the page's thread. */
#ifndef WH_APP_LIVE_KEPT_H
#define WH_APP_LIVE_KEPT_H

#include "../record/record.h"
#include "../record/signals.h"
#include "../report/tracks_document.h"
#include "../view/showing.h"

/* The most events, commands and so on that are kept; of more than that the older half goes. */
#define WH_LIVE_KEPT 20000

/* An entry of what was said at ports. */
typedef struct {
    int64_t utime;
    char kind; /* a wh_transcript_kind_t */
    char *port, *text;
} wh_live_frame_t;

typedef enum {
    WH_LIVE_COMMANDS,
    WH_LIVE_EVENTS,
    WH_LIVE_EXPECTATIONS,
    WH_LIVE_STATIONS,
    WH_LIVE_WAITS,
    WH_LIVE_FRAMES,
    WH_LIVE_LISTS
} wh_live_list_t;

/* Zero it to begin with. Read only. */
typedef struct {
    wh_record_t record; /* its layout and its lists alone */
    wh_signals_t signals;
    wh_live_frame_t *frames;
    size_t frame_count, frame_capacity;
    bool is_over, is_good, is_held;
    char *failure;
    char *held;     /* the robots that a HOLD holds; null: all that runs */
    uint64_t epoch; /* of the looks so far */
    bool has_looks;
    bool is_anew;              /* what was told must be forgotten, and all of it told again */
    bool has_news;             /* that should not wait */
    bool has_dropped;          /* older entries */
    size_t due[WH_LIVE_LISTS]; /* entries from this one on were not told, or have changed */
    wh_tracks_written_t written;
} wh_live_kept_t;

/* Forgets all and begins a cell; null: none is there. */
void wh_live_kept_begin(wh_live_kept_t *kept, const wh_layout_t *layout);

/* Adds a look, and news. A run that was set back begins its signals anew. An older look changes nothing. */
void wh_live_kept_look(wh_live_kept_t *kept, const wh_glimpse_t *look);
void wh_live_kept_news(wh_live_kept_t *kept, const wh_news_t *news);

/* The page is told this of the program. */
typedef struct {
    const char *title, *reproduce;
    const char *id;      /* of this process */
    const char *control; /* what the page may command, a word; null: nothing */
    bool is_paused, stands, lists_faults, lists_robots, paces; /* paces: it may be paused */
    double rate, pace; /* rate: 0, as fast as it goes; pace: what comes of it, below 0 if not known */
} wh_live_state_t;

/* { next, id, document, state }: all of it, with `next` the number of the message that follows. To be
 * freed; null without a cell. */
char *wh_live_kept_document(const wh_live_kept_t *kept, const wh_live_state_t *state, uint64_t next,
                            size_t *size);

/* { tracks, marks, lists, now, state }: what is due, to be freed; then nothing is due. */
char *wh_live_kept_growth(wh_live_kept_t *kept, const wh_live_state_t *state);

/* The last sample of each curve; to be freed. */
char *wh_live_kept_now(const wh_live_kept_t *kept);

#endif
