/* The result of a replay, for people and for programs. */
#ifndef WH_APP_REPLAYED_H
#define WH_APP_REPLAYED_H

#include "../log/reading.h"

typedef struct {
    const char *path; /* as it was given */
    bool is_lenient;
    const wh_log_files_t *files;
    const wh_replay_t *replay;
    const wh_reading_t *reading;
    wh_reading_verdict_t verdict;
    char reason[WH_READING_REASON];
} wh_replayed_t;

void wh_replayed_print_table(const wh_replayed_t *result);

/* Returns what wh_json_print does. */
int wh_replayed_print_json(const wh_replayed_t *result);

#endif
