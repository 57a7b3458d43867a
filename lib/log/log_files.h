/* The files of one log: a recording in several parts, or the recordings of a process that was started again.
 *
 * A part names the next one by its own name (run.log, run.part2.log), number and id, so that it is found
 * automatically. A process that is started again records under another name, which the user must give. */
#ifndef WH_LOG_LOG_FILES_H
#define WH_LOG_LOG_FILES_H

#include "logfile.h"

/* The most files. */
#define WH_LOG_FILES 256
/* Room for the reason why they cannot be opened. */
#define WH_LOG_FILES_MESSAGE 1200

typedef struct {
    const char *path;
    const char *const *then; /* the next logs, in order */
    size_t then_count;
    bool is_alone; /* further parts of a recording are not looked for */
} wh_log_names_t;

/* The recording of a log, as its first event tells it; all zero if it describes none. */
typedef struct {
    bool is_told;
    int32_t version, part;
    int64_t id;
} wh_log_head_t;

/* Zero it at first. */
typedef struct {
    char *paths[WH_LOG_FILES];
    FILE *files[WH_LOG_FILES];
    wh_log_head_t heads[WH_LOG_FILES];
    size_t count;
    bool is_alone; /* as in the names */
} wh_log_files_t;

/* Reads the first event of a log that was just opened. */
wh_log_head_t wh_log_head(wh_log_t *log);

/* Opens the named files, and after each one the later parts of its recording that exist. False, and the
 * file and the reason in `message`, if a named file cannot be read, is named twice, is a copy of another
 * one's part of a recording, or there are too many. Close it in either case. Cost: two events of each file
 * are read. */
bool wh_log_files_open(wh_log_files_t *files, const wh_log_names_t *names,
                       char message[WH_LOG_FILES_MESSAGE]);

void wh_log_files_close(wh_log_files_t *files);

/* Starts at the beginning of the first file. */
void wh_log_files_begin(const wh_log_files_t *files, wh_log_t *log);

#endif
