/* The file of a recording: created so that nothing of others is lost, locked, compressed if its name says so,
 * and looked after: a file that cannot be written, or is taken away, is named at once on standard error.
 */
#ifndef WH_LINK_RECORD_FILE_H
#define WH_LINK_RECORD_FILE_H

#include <limits.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Bytes that wait to be written, at most. */
#define WH_RECORD_BUFFER ((size_t)1 << 18)
#define WH_RECORD_PACKED ((size_t)1 << 17)
/* A frame of a compressed file ends after so many bytes, before compression, or after so long, us. */
#define WH_RECORD_FRAME_BYTES ((size_t)1 << 20)
#define WH_RECORD_FRAME_US 1000000

/* Zero it to begin with, and set fd to -1. */
typedef struct {
    const char *speaker; /* who says what goes wrong, such as "sim" */
    const char *option;  /* that asked for the file, such as "--record"; null: none is named */
    char path[PATH_MAX]; /* as others find it */
    int fd;              /* -1: not open */
    bool is_plain_file;  /* not a pipe or a device */
    bool failed;         /* nothing more is written; standard error has said why */
    void *zstd;          /* ZSTD's; null: not compressed */
    int64_t written;     /* bytes in the file */
    int64_t frame_us;    /* when the running frame began */
    size_t frame_bytes;  /* what is in it, before compression */
    size_t used;
    uint8_t buffer[WH_RECORD_BUFFER];
    uint8_t packed[WH_RECORD_PACKED];
} wh_record_file_t;

/* True if the second part of a recording of this name is there: run.part2.log of run.log. Then the name is
 * that recording's. */
bool wh_record_file_has_parts(const char *path);

/* Creates a file, never one that is there or has parts: if the name is taken, run.1.log in place of run.log,
 * and so on; standard error tells. What is no plain file (a pipe, a device) is written to as it is. The file
 * is locked (flock) until it is closed. False, and standard error says why, if that was not possible. */
bool wh_record_file_create(wh_record_file_t *file, const char *path);

/* The same, but replaces an old file: whoever reads that one goes on reading it. Refused are a file that
 * another recording has locked, and one that the process keeps (wh_output_keep): its inputs. */
bool wh_record_file_replace(wh_record_file_t *file, const char *path);

/* False, and standard error says why, if a file could not be replaced here now. Nothing of it is changed; of
 * what is no plain file nothing is asked. */
bool wh_record_file_can_replace(wh_record_file_t *file, const char *path);

/* The name with "." and a tag put before its ending: run.log becomes run.TAG.log, run.log.zst
 * run.TAG.log.zst. False if that is too long. */
bool wh_record_file_name(const char *path, const char *tag, char name[PATH_MAX]);

/* Adds bytes, of `size` at most WH_RECORD_BUFFER, to what waits to be written. A file that is not open yet
 * takes so many and no more: false if it is full. */
bool wh_record_file_put(wh_record_file_t *file, const void *bytes, size_t size);

/* Hands all that waits over to the system. What was put between two calls is whole in the file, also if the
 * process is killed then. */
void wh_record_file_flush(wh_record_file_t *file);

/* Flushes and closes. False if anything of the file failed since it was created. */
bool wh_record_file_close(wh_record_file_t *file);

/* Says on standard error what is wrong with the file, once, and gives it up. */
void wh_record_file_fail(wh_record_file_t *file, const char *path, const char *reason);

#endif
