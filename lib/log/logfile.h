/* LCM event logs, read with care: lcm-logger's format, and ours.
 *
 * Each event is, big-endian: a sync word, its number (8 bytes), a time stamp (8 bytes, us), the lengths of
 * channel and data (4 bytes each), the channel's name, the data. Nothing in a file can make the reader crash
 * or take memory beyond one event of WH_LOG_EVENT_BYTES; larger ones, of other programs, are passed over.
 * What is no event is damage: the reader names its bytes and goes on where events follow one another again.
 */
#ifndef WH_LOG_LOGFILE_H
#define WH_LOG_LOGFILE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#define WH_LOG_EVENT_BYTES 65536
#define WH_LOG_CHANNEL_BYTES 64
/* So much of the file is looked at together. */
#define WH_LOG_WINDOW (1 << 18)
/* So much of a compressed file is kept, to look in it for the next frame. */
#define WH_LOG_PACKED ((size_t)1 << 22)

/* The bytes of a log: as they stand in the file, or decompressed if it begins as zstd's do. A compressed file
 * has frames that each stand alone. A frame that is damaged is left where it goes wrong. Reading goes on with
 * the next one that begins in the file. */
typedef struct {
    FILE *file; /* the caller's */
    void *zstd; /* ZSTD's; null: not compressed */
    uint8_t *packed;
    size_t frame, at, end;     /* in `packed`: where the frame begins, what comes next, the end */
    uint64_t offset;           /* in the file, of the beginning of `packed` */
    bool is_within, is_broken; /* a frame has begun and not ended; it is damaged */
    uint64_t broken;           /* stretches of damaged frames */
    uint64_t first_broken;     /* where in the file the first one begins */
} wh_log_source_t;

typedef enum {
    WH_LOG_EVENT,  /* channel, data and size hold the next event */
    WH_LOG_END,    /* the file ends where an event ends */
    WH_LOG_CUT,    /* it ends within an event, which begins at `offset`, or within a compressed frame */
    WH_LOG_DAMAGED /* what stands from `offset` to `next` is no event: reading goes on at `next` */
} wh_log_result_t;

/* Zero it before the first opening. */
typedef struct {
    wh_log_source_t source;
    uint64_t offset; /* where the last event, or the damage, begins; of a compressed file, decompressed */
    uint64_t next;   /* where it ends */
    uint64_t count;  /* events read */
    uint64_t number; /* as the event says: from 0, one more each */
    char channel[WH_LOG_CHANNEL_BYTES]; /* empty for a longer name, which is none of ours */
    bool is_loose;                      /* what follows is no event: its own end may be wrong */
    size_t size;                        /* of the data */
    const uint8_t *data;                /* valid until the next call */
    uint8_t window[WH_LOG_WINDOW];      /* the reader's: bytes from `next` on stand from `begin` to `end` */
    size_t begin, end;
} wh_log_t;

/* Opens a regular file for reading. Null, and `fault` says why, if it is none or cannot be read. */
FILE *wh_log_file(const char *path, const char **fault);

/* True if these are the first bytes of a compressed file. */
bool wh_log_is_packed(const void *bytes, size_t size);

/* Starts at the beginning of the file, which stays the caller's. Also after an earlier opening. */
void wh_log_open(wh_log_t *log, FILE *file);

/* Releases what a compressed file took. Also before any opening. */
void wh_log_close(wh_log_t *log);

/* The next event, or what stands in its place. After WH_LOG_END and WH_LOG_CUT there is nothing more. */
wh_log_result_t wh_log_next(wh_log_t *log);

/* The next event, past damage. False if there is none. */
bool wh_log_next_event(wh_log_t *log);

/* ------------------------------------------------------------------------------------------------ numbers */

/* Stretches of numbers that did not come; more than these are only counted together. */
#define WH_LOG_GAPS 64

/* Which events did not come: their numbers are consecutive from 0. Zero it to begin with. */
typedef struct {
    uint64_t next;        /* one more than the highest number that came */
    uint64_t doubled;     /* numbers that came more than once */
    uint64_t moved;       /* events that stand behind ones with higher numbers */
    uint64_t misnumbered; /* events whose number fits neither what is before nor what is behind */
    uint64_t first;       /* the byte of the first event of these three kinds */
    struct {
        uint64_t from, to; /* without `to` */
    } gaps[WH_LOG_GAPS];
    size_t gap_count;
    uint64_t beyond; /* numbers in gaps for which there was no room */
    bool waits;      /* the last number was not the expected one: */
    uint64_t odd, expected, odd_at;
} wh_log_numbers_t;

/* An event with this number, at this byte. */
void wh_log_numbers_take(wh_log_numbers_t *numbers, uint64_t number, uint64_t at);

/* No more events. */
void wh_log_numbers_finish(wh_log_numbers_t *numbers);

/* How many did not come. */
uint64_t wh_log_numbers_missing(const wh_log_numbers_t *numbers);

#endif
