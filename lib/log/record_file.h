/* The file of a recording. Creating it loses no file of others; it is locked, and compressed if its name
 * says so. If it cannot be written or is taken away, standard error says so at once.
 */
#ifndef WH_LOG_RECORD_FILE_H
#define WH_LOG_RECORD_FILE_H

#include <limits.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* The most bytes that wait to be written. */
#define WH_RECORD_BUFFER ((size_t)1 << 18)
#define WH_RECORD_PACKED ((size_t)1 << 17)
/* A frame of a compressed file ends after this number of bytes, before compression, or after this time,
 * us. */
#define WH_RECORD_FRAME_BYTES ((size_t)1 << 20)
#define WH_RECORD_FRAME_US 1000000

/* Zero it at the beginning, and set fd to -1. */
typedef struct {
    const char *speaker; /* the speaker of messages, such as "sim" */
    const char *option;  /* the option that asked for the file, such as "--record"; null: none is named */
    char path[PATH_MAX]; /* the path as other processes find it */
    int fd;              /* -1: not open */
    bool is_plain_file;  /* not a pipe or a device */
    bool failed;         /* no more is written; standard error has given the reason */
    void *zstd;          /* ZSTD's; null: not compressed */
    int64_t written;     /* bytes in the file */
    int64_t frame_us;    /* begin of the running frame */
    size_t frame_bytes;  /* its bytes before compression */
    size_t used;
    uint8_t buffer[WH_RECORD_BUFFER];
    uint8_t packed[WH_RECORD_PACKED];
} wh_record_file_t;

/* True if the second part of a recording with this name exists: run.part2.log of run.log. The name then
 * belongs to that recording. */
bool wh_record_file_has_parts(const char *path);

/* Creates a file, never one that exists or has parts. If the name is taken, it makes run.1.log in place of
 * run.log, and so on; standard error tells. A pipe or a device is written to as it is. The file is locked
 * (flock) until it is closed. Returns false, and standard error says why, if that was not possible. */
bool wh_record_file_create(wh_record_file_t *file, const char *path);

/* Creates the file but replaces an old one; a process that reads the old one can continue. It refuses a
 * file that another recording has locked, and one that the process keeps (wh_output_keep): its inputs. */
bool wh_record_file_replace(wh_record_file_t *file, const char *path);

/* Returns false, and standard error says why, if a file could not be replaced here now. It changes nothing,
 * and does not examine pipes and devices. */
bool wh_record_file_can_replace(wh_record_file_t *file, const char *path);

/* The name with "." and a tag put before its ending: run.log becomes run.TAG.log, run.log.zst
 * run.TAG.log.zst. Returns false if that is too long. */
bool wh_record_file_name(const char *path, const char *tag, char name[PATH_MAX]);

/* Adds bytes, of `size` at most WH_RECORD_BUFFER, to those that wait to be written. A file that is not open
 * yet takes only that many; it returns false when full. */
bool wh_record_file_put(wh_record_file_t *file, const void *bytes, size_t size);

/* Hands all bytes that wait over to the system. The bytes between two calls are complete in the file, also
 * if the process is killed then. */
void wh_record_file_flush(wh_record_file_t *file);

/* Flushes and closes. Returns false if anything failed on the file since it was created. */
bool wh_record_file_close(wh_record_file_t *file);

/* Says on standard error, once, what is wrong with the file, and gives it up. */
void wh_record_file_fail(wh_record_file_t *file, const char *path, const char *reason);

#endif
