/* Replays a whole log and judges it. */
#ifndef WH_LOG_READING_H
#define WH_LOG_READING_H

#include "log_files.h"
#include "replay.h"

/* The most stretches of damage that are named one by one. */
#define WH_READING_DAMAGES 16

typedef struct {
    uint64_t from, to; /* bytes, without `to` */
    size_t file;       /* of this file */
} wh_reading_damage_t;

/* The condition of the files. Read only. */
typedef struct {
    uint64_t events, bytes;
    bool is_alone; /* the parts that follow were not wanted */
    wh_log_numbers_t numbers;
    wh_reading_damage_t damages[WH_READING_DAMAGES];
    uint64_t damage_count; /* all of them */
    bool is_cut;           /* the last file ends within an event, which begins at `cut_at` */
    uint64_t cut_at;
    wh_reading_damage_t cuts[WH_READING_DAMAGES]; /* the earlier files that end like this, and where */
    uint64_t cut_count;                           /* all of them */
    const char *barren; /* the path of the first of several whole files without a slice of ours; null: none */
    bool is_begun_and_cut;         /* a file before the last one was cut off before its first slice */
    bool is_compressed;            /* all bytes above are counted decompressed; the next ones are not: */
    uint64_t broken, first_broken; /* the number of damaged stretches of the compressed file, and where the
                                    * first begins */
} wh_reading_t;

/* These are also the exit status of `replay`. */
typedef enum {
    WH_READING_SAME = 0,       /* whole, none of our messages passed over, every slice is as recorded */
    WH_READING_DIFFERS = 1,    /* a slice is not as recorded */
    WH_READING_UNUSABLE = 2,   /* it has no run */
    WH_READING_INCOMPLETE = 3, /* damaged, or one of our messages is missing or was passed over */
    WH_READING_CUT = 4         /* cut off: all before is as recorded, but the end of the run is missing */
} wh_reading_verdict_t;

/* One word: same, differs, unusable, incomplete, cut. */
const char *wh_reading_word(wh_reading_verdict_t verdict);

/* Replays the files from their beginning. Before that it looks through all of them for the cell and for
 * the beginnings of runs. For `replay` see wh_replay_t; `log` is the caller's memory, which the caller
 * closes. */
void wh_reading_replay(const wh_log_files_t *files, wh_log_t *log, wh_replay_t *replay,
                       wh_reading_t *reading);

/* Room for the reason why a log is not the same. */
#define WH_READING_REASON 240

/* The reason if the digest does not fit the messages. */
#define WH_READING_CHANGED "the log's digest is another one: something in it was changed, lost or put in"

/* Judges the reading. `lenient` excuses effects of a network: messages that are lost, late or garbage, and
 * runs that begin in the middle. It never excuses losses of the file. The first reason for the verdict goes
 * into `reason`, of WH_READING_REASON bytes, empty for WH_READING_SAME; null: not wanted. */
wh_reading_verdict_t wh_reading_judge(const wh_replay_t *replay, const wh_reading_t *reading, bool lenient,
                                      char *reason);

/* The text for each loss (wh_replay_loss_t), and its key in JSON. */
typedef struct {
    const char *key, *one, *many;
} wh_reading_loss_t;
extern const wh_reading_loss_t wh_reading_losses[WH_REPLAY_LOSSES];

/* The number of the run's expectations that are not in the log, though its end is; without those that an
 * earlier part of the recording has. */
int64_t wh_reading_lost_expectations(const wh_replay_run_t *run);

/* The number of slices between the last data of the run in the log and the run's end, as motion control
 * told it. */
int64_t wh_reading_lost_end(const wh_replay_run_t *run);

/* True if the log is of a version of the format that this program does not know. */
bool wh_reading_is_unknown(const wh_replay_t *replay);

/* True if a wrong cell may cause this run's differences: the log's messages about the cell contradict each
 * other, or there is only one, and nothing confirms it. */
bool wh_reading_is_doubtful(const wh_replay_t *replay, const wh_replay_run_t *run);

/* True if neither this run's end nor a later run is in the log: the log may have been cut off. */
bool wh_reading_lacks_end(const wh_replay_t *replay, const wh_replay_run_t *run);

#endif
