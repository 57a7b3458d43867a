/* A whole log replayed, and what that shows. */
#ifndef WH_LOG_READING_H
#define WH_LOG_READING_H

#include "logfile.h"
#include "replay.h"

/* Stretches of damage that are named one by one. */
#define WH_READING_DAMAGES 16

typedef struct {
    uint64_t from, to; /* bytes, without `to` */
} wh_reading_damage_t;

/* What the file is like. Read only. */
typedef struct {
    uint64_t events, bytes;
    wh_log_numbers_t numbers;
    wh_reading_damage_t damages[WH_READING_DAMAGES];
    uint64_t damage_count; /* all of them */
    bool is_cut;           /* the file ends within an event, which begins at `cut_at` */
    uint64_t cut_at;
    bool is_compressed;            /* all bytes above are counted decompressed; these are not: */
    uint64_t broken, first_broken; /* damaged stretches of the compressed file, and where the first begins */
} wh_reading_t;

/* The exit status of `replay`, too. */
typedef enum {
    WH_READING_SAME = 0,       /* whole, nothing of ours passed over, every slice is as recorded */
    WH_READING_DIFFERS = 1,    /* a slice is not */
    WH_READING_UNUSABLE = 2,   /* no run is in it */
    WH_READING_INCOMPLETE = 3, /* damaged, or something of ours is missing or was passed over */
    WH_READING_CUT = 4         /* cut off: all before is as recorded, and the end of the run is not there */
} wh_reading_verdict_t;

/* One word: same, differs, unusable, incomplete, cut. */
const char *wh_reading_word(wh_reading_verdict_t verdict);

/* Replays the file from its beginning, after a look at all of it for the cell and for how runs begin.
 * `replay` is as wh_replay_t says, `log` the caller's memory, which the caller closes. */
void wh_reading_replay(FILE *file, wh_log_t *log, wh_replay_t *replay, wh_reading_t *reading);

/* Room for why a log is not the same. */
#define WH_READING_REASON 240

/* The reason where the digest is not that of what stands there. */
#define WH_READING_CHANGED "the log's digest is another one: something in it was changed, lost or put in"

/* What was read shows. `lenient` excuses what a network may do: messages that are lost, late or garbage, and
 * runs that begin in the middle; never what the file has lost. The first reason found for the verdict goes
 * into `reason`, of WH_READING_REASON bytes, empty for WH_READING_SAME; null: nobody asks. */
wh_reading_verdict_t wh_reading_judge(const wh_replay_t *replay, const wh_reading_t *reading, bool lenient,
                                      char *reason);

/* What is said of each loss (wh_replay_loss_t), and its key in JSON. */
typedef struct {
    const char *key, *one, *many;
} wh_reading_loss_t;
extern const wh_reading_loss_t wh_reading_losses[WH_REPLAY_LOSSES];

/* How many of the run's expectations are not in the log, though its end is: without those that an earlier
 * part of the recording has. */
int64_t wh_reading_lost_expectations(const wh_replay_run_t *run);

/* True if the log is of a version of the format that this program does not know. */
bool wh_reading_is_unknown(const wh_replay_t *replay);

/* True if this run's differences may be the cell's: the log tells it in more than one way, or only once, and
 * nothing vouches for it. */
bool wh_reading_is_doubtful(const wh_replay_t *replay, const wh_replay_run_t *run);

/* True if this run's end is not in the log, and no later run is: the log may have been cut off. */
bool wh_reading_lacks_end(const wh_replay_t *replay, const wh_replay_run_t *run);

#endif
