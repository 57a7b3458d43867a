/* What came of replaying a log, on standard output: for people and for programs. */
#ifndef WH_APP_REPLAY_REPORT_H
#define WH_APP_REPLAY_REPORT_H

#include "../log/replay.h"

/* How the file ended. */
typedef struct {
    wh_log_result_t result;
    uint64_t offset, events;
    uint64_t first_garbage; /* byte; meaningful when there is garbage */
} wh_replay_ending_t;

/* `ok`: all that was compared is as recorded, and the log is whole. */
void wh_replay_print_table(const char *path, const wh_replay_t *replay, const wh_replay_ending_t *ending,
                           bool ok);
void wh_replay_print_json(const char *path, const wh_replay_t *replay, const wh_replay_ending_t *ending,
                          bool ok);

#endif
