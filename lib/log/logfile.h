/* LCM event logs, read with care: lcm-logger's format, and ours.
 *
 * Each event is, big-endian: a sync word, its number (8 bytes), a time stamp (8 bytes, us), the lengths of
 * channel and data (4 bytes each), the channel's name, the data. Nothing in a file can make the reader crash
 * or take memory beyond one event of WH_LOG_EVENT_BYTES; larger ones, of other programs, are passed over.
 */
#ifndef WH_LOG_LOGFILE_H
#define WH_LOG_LOGFILE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#define WH_LOG_EVENT_BYTES 65536
#define WH_LOG_CHANNEL_BYTES 64

typedef enum {
    WH_LOG_EVENT,  /* channel, data and size hold the next event */
    WH_LOG_END,    /* the file ends where an event ends */
    WH_LOG_CUT,    /* it ends within an event */
    WH_LOG_DAMAGED /* what stands at `offset` is no event */
} wh_log_result_t;

typedef struct {
    FILE *file;      /* the caller's */
    uint64_t offset; /* where the last event, or the damage, begins */
    uint64_t next;   /* where the next one begins */
    uint64_t count;  /* events read */
    int64_t timestamp_us;
    char channel[WH_LOG_CHANNEL_BYTES]; /* empty for a longer name, which is none of ours */
    size_t size;                        /* of the data; 0 for an event that was passed over */
    uint8_t data[WH_LOG_EVENT_BYTES];
} wh_log_t;

/* Opens a file for reading. Null, and errno says why, if it cannot be read; a folder is no file. */
FILE *wh_log_file(const char *path);

/* Starts at the file's current place. */
void wh_log_open(wh_log_t *log, FILE *file);

wh_log_result_t wh_log_next(wh_log_t *log);

#endif
