/* Reads LCM event logs safely: lcm-logger's format, and ours.
 *
 * Each event is, big-endian: a sync word, its number (8 bytes), a time stamp (8 bytes, us), the lengths of
 * channel and data (4 bytes each), the channel's name, the data. Nothing in a file can make the reader crash
 * or take memory beyond one event of WH_LOG_EVENT_BYTES; larger ones, of other programs, are passed over.
 * Bytes that are not an event are damage: the reader names them and goes on where events follow one another
 * again.
 */
#ifndef WH_LOG_LOGFILE_H
#define WH_LOG_LOGFILE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#define WH_LOG_EVENT_BYTES 65536
#define WH_LOG_CHANNEL_BYTES 64
/* The bytes of the file that are looked at together. */
#define WH_LOG_WINDOW (1 << 18)
/* The kept bytes of a compressed file, in which the next frame is searched. */
#define WH_LOG_PACKED ((size_t)1 << 22)

/* The bytes of a log: as in the file, or decompressed if it begins like a zstd file. A compressed file has
 * independent frames. Reading leaves a damaged frame at its error, and goes on with the next frame in the
 * file. */
typedef struct {
    FILE *file; /* the caller's */
    void *zstd; /* ZSTD's; null: not compressed */
    uint8_t *packed;
    size_t frame, at, end;     /* in `packed`: the frame's beginning, the next byte, the end */
    uint64_t offset;           /* in the file, of the beginning of `packed` */
    bool is_within, is_broken; /* a frame has begun and not ended; it is damaged */
    uint64_t broken;           /* the number of stretches of damaged frames */
    uint64_t first_broken;     /* where in the file the first one begins */
} wh_log_source_t;

typedef enum {
    WH_LOG_EVENT,    /* channel, data and size hold the next event */
    WH_LOG_END,      /* the file ends where an event ends */
    WH_LOG_CUT,      /* the file ends within an event, which begins at `offset`, or within a compressed
                      * frame */
    WH_LOG_DAMAGED,  /* the bytes from `offset` to `next` are not an event: reading goes on at `next` */
    WH_LOG_NEXT_FILE /* one file has ended, within an event if `is_cut`, and the next one begins */
} wh_log_result_t;

/* Zero it before the first opening. */
typedef struct {
    wh_log_source_t source;
    FILE *const *rest; /* the next files, owned by the caller: log/log_files.h */
    size_t rest_count;
    size_t file;     /* the number of the present file, from 0 */
    uint64_t passed; /* the bytes of the files before it */
    bool is_cut;     /* the previous file ended within an event, which began at `offset` */
    uint64_t offset; /* where the last event, or the damage, begins; in a compressed file, decompressed */
    uint64_t next;   /* where it ends */
    uint64_t count;  /* events read */
    uint64_t number; /* the event's own number: from 0, consecutive */
    char channel[WH_LOG_CHANNEL_BYTES]; /* empty for a longer name, which is not one of ours */
    bool is_loose;                      /* the next bytes are not an event: its own end may be wrong */
    size_t size;                        /* of the data */
    const uint8_t *data;                /* valid until the next call */
    uint8_t window[WH_LOG_WINDOW];      /* the reader's: bytes from `next` on stand from `begin` to `end` */
    size_t begin, end;
} wh_log_t;

/* Opens a regular file for reading. Null, and the reason in `fault`, if it is not one or cannot be read. */
FILE *wh_log_file(const char *path, const char **fault);

/* True if these are the first bytes of a compressed file. */
bool wh_log_is_packed(const void *bytes, size_t size);

/* Starts at the beginning of the file, which stays the caller's. It may follow an earlier opening. */
void wh_log_open(wh_log_t *log, FILE *file);

/* Releases the memory for a compressed file. It may also come before any opening. */
void wh_log_close(wh_log_t *log);

/* The next event, or the result in its place. After WH_LOG_END and WH_LOG_CUT there is nothing more. */
wh_log_result_t wh_log_next(wh_log_t *log);

/* The next event, past damage and over the files' ends. False if there is none. */
bool wh_log_next_event(wh_log_t *log);

/* ------------------------------------------------------------------------------------------------ numbers */

/* The most stretches of missing numbers; further ones are only counted together. */
#define WH_LOG_GAPS 64

/* The missing events: numbers are consecutive from 0. Zero it at first. */
typedef struct {
    uint64_t next;        /* one more than the highest number that came */
    uint64_t doubled;     /* numbers that came more than once */
    uint64_t moved;       /* events that come after ones with higher numbers */
    uint64_t misnumbered; /* events whose number fits neither the events before nor those after */
    uint64_t first;       /* the byte of the first event of these three kinds */
    struct {
        uint64_t from, to; /* without `to` */
    } gaps[WH_LOG_GAPS];
    size_t gap_count;
    uint64_t beyond; /* numbers in gaps without room */
    bool waits;      /* the last number was not the expected one: */
    uint64_t odd, expected, odd_at;
} wh_log_numbers_t;

/* Takes an event with this number, at this byte. */
void wh_log_numbers_take(wh_log_numbers_t *numbers, uint64_t number, uint64_t at);

/* Ends the events. */
void wh_log_numbers_finish(wh_log_numbers_t *numbers);

/* Ends the events of this file: those of the next one are numbered from 0 again. */
void wh_log_numbers_restart(wh_log_numbers_t *numbers);

/* The number of missing events. */
uint64_t wh_log_numbers_missing(const wh_log_numbers_t *numbers);

#endif
