/* The bytes of a log: as they stand in the file, or decompressed if it begins as zstd's do.
 *
 * A compressed file has frames that each stand alone. A frame that is damaged is left where it goes wrong.
 * Reading goes on with the next one that begins in the file.
 */
#ifndef WH_LOG_LOG_SOURCE_H
#define WH_LOG_LOG_SOURCE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

/* So much of a compressed file is kept, to look in it for the next frame. */
#define WH_LOG_PACKED ((size_t)1 << 22)

/* Zero it before the first opening. */
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

/* Starts at the file's current place. */
void wh_log_source_open(wh_log_source_t *source, FILE *file);

/* Reads up to so many bytes; fewer at the end only. */
size_t wh_log_source_read(wh_log_source_t *source, uint8_t *bytes, size_t size);

/* True if the file ended within a frame. */
bool wh_log_source_is_cut(const wh_log_source_t *source);

void wh_log_source_close(wh_log_source_t *source);

/* True if these are the first bytes of a compressed file. */
bool wh_log_source_is_packed(const void *bytes, size_t size);

#endif
