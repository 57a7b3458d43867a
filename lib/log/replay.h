/* A recording stepped again: each recorded command goes through the simulator's own protocol
 * (link/protocol_server.h), and the hash of each slice is compared with the recorded one.
 *
 * A command is stepped when its state comes, with the valves that the state says were in force (they may have
 * come from outputs.txt), or without a state when the next command comes. A log that begins in the middle of
 * a run, or that lacks commands, is taken up from the next whole state. The first difference of a run is
 * named; the rest of that run is not compared, for it would differ, too.
 */
#ifndef WH_LOG_REPLAY_H
#define WH_LOG_REPLAY_H

#include "../link/protocol_server.h"
#include "logfile.h"

#define WH_REPLAY_RUNS 256

/* What differs first, in the order of wh_grasp_hash. */
typedef struct {
    int64_t slice;
    char what[160]; /* such as: Wafer 1, position x */
    double recorded, replayed;
} wh_replay_difference_t;

typedef struct {
    int64_t run;
    int64_t first_slice, last_slice; /* stepped or taken over */
    int64_t compared;                /* slices whose hash was compared */
    int64_t unanswered;              /* slices stepped whose state is not in the log */
    int64_t outside_valves;          /* slices whose valves were not the command's */
    int64_t taken_up;                /* times that the log lacked something and a state was taken over */
    int64_t missed;                  /* free-running: commands that never came */
    bool over;                       /* motion control said that the run was over */
    bool differs;
    uint64_t hash; /* after the last slice */
    wh_replay_difference_t difference;
} wh_replay_run_t;

/* Zero it to begin with. Must not be moved afterwards. */
typedef struct {
    wh_layout_t *layout; /* null: no cell came yet */
    wh_protocol_server_t server;
    wh_replay_run_t runs[WH_REPLAY_RUNS];
    size_t run_count;
    uint64_t runs_left_out;    /* beyond WH_REPLAY_RUNS */
    uint64_t messages;         /* of ours, sound */
    uint64_t garbage;          /* on our channels, not sound */
    uint64_t homeless;         /* commands and states before a cell */
    waferhand_command command; /* waits for its state */
    bool has_command;
    uint8_t state[WH_LINK_DATAGRAM]; /* waits for its command */
    size_t state_size;
    int64_t state_run, state_seq;
    wh_link_arrays_t recorded;
} wh_replay_t;

/* One event of the log; those of other channels are ignored. */
void wh_replay_event(wh_replay_t *replay, const char *channel, const void *data, size_t size);

/* Steps what still waits. Call it at the log's end. */
void wh_replay_finish(wh_replay_t *replay);

void wh_replay_close(wh_replay_t *replay);

#endif
