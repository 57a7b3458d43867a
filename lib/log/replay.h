/* A recording stepped again: each recorded command goes through the simulator's own protocol
 * (link/protocol_server.h), and each recorded state is compared with the replayed one, bit for bit: body and
 * hash.
 *
 * A command waits for its state, and a state for its command, at most WH_REPLAY_WINDOW slices: messages may
 * stand in any order. A command is stepped with the valves that its state says were in force (they may have
 * come from outputs.txt). A slice of a block (link/slices.h) is compared by its hash. Where commands are not
 * in the log, the replay is taken up from the next whole state. Each slice is compared once; what comes
 * again, as over a lossy network, is passed over. Of each run the first difference is named, and how many
 * slices differ.
 *
 * A run may go on from a state of an earlier one, as after RESTORE at the prompt. If a slice of this number,
 * with this hash and of this layout, was replayed before and found to be as recorded, nothing is missing.
 * Else the slices before it were passed over. Which states these are must be known before the replay, by
 * wh_replay_look_ahead: so it remembers a hash for each run, however long the log is.
 *
 * What was passed over, and why, is counted: nothing of ours is left out in silence. Not compared are events
 * of the collision check, since messages do not tell shapes. WAFERHAND_MCS and WAFERHAND_REQUEST have no
 * check: the digest of a recording that was closed vouches for them.
 */
#ifndef WH_LOG_REPLAY_H
#define WH_LOG_REPLAY_H

#include "../link/outcome.h"
#include "../link/protocol_server.h"
#include "../link/slices.h"
#include "logfile.h"

#define WH_REPLAY_RUNS 256
/* So many slices a command waits for its state, or a state for its command. */
#define WH_REPLAY_WINDOW 2048
/* Cells that one log may tell of. */
#define WH_REPLAY_CELLS 8

/* What differs first. */
typedef struct {
    int64_t slice;
    char what[160]; /* such as: Wafer 1, position x */
    double recorded, replayed;
} wh_replay_difference_t;

typedef struct {
    int64_t run;
    bool is_begun;        /* it has commands or states */
    bool begins_in_part;  /* of the recording: its first slices are in another file */
    int64_t goes_on_from; /* the run whose state of slice `first_slice` it begins with; 0: none */
    uint64_t layout_hash;
    int64_t first_slice, last_slice; /* stepped or taken over */
    int64_t compared;                /* slices whose state was compared */
    int64_t differing;               /* of these, such as are not as recorded */
    int64_t unanswered;              /* commands whose state is not in the log, though the log goes on */
    int64_t last_unanswered;         /* commands behind the last state: the log ends before their states */
    int64_t doubtful;       /* slices that differ behind unanswered ones: their valves are not known */
    int64_t outside_valves; /* slices whose valves were not the command's */
    int64_t taken_up;       /* times that the log lacked something and a state was taken over */
    int64_t skipped;        /* slices that were passed over: not compared, the one of that state included */
    int64_t missed;         /* free-running: commands that never came */
    int64_t refused;        /* commands that simulator and replay refused alike */
    int64_t homeless;       /* commands of a layout whose cell is not in the log, */
    uint64_t homeless_at;   /* the byte of the first one, */
    bool is_other_layout;   /* and the simulator refused them for that */
    int64_t last_refused;   /* the slice of the last one */
    int64_t collisions;     /* events of the collision check: as recorded, not compared */
    uint64_t hash;          /* after the last slice */
    wh_replay_difference_t difference; /* if any differ */
    bool over;                         /* motion control said that the run was over */
    uint64_t over_at;                  /* at this byte, */
    wh_run_told_t told;                /* and how it ended, */
    char *reason;                      /* and why so; null: it did not say */
    bool is_told_wrong;                /* what it said does not fit itself, or its expectations */
    wh_log_numbers_t expectations;     /* those that are in the log */
    int64_t unmet;                     /* messages that say so of one */
} wh_replay_run_t;

/* Why something of ours was not used. */
typedef enum {
    WH_REPLAY_GARBAGE,     /* on our channels, and no sound message */
    WH_REPLAY_UNCHECKED,   /* a command or a state without a check: nobody knows if it is as it was sent */
    WH_REPLAY_STRAY,       /* a message of ours on a channel that is none of ours */
    WH_REPLAY_CONTRADICTS, /* what the log tells in another way elsewhere, such as a cell */
    WH_REPLAY_HOMELESS,    /* a command or a state of a layout whose cell is not in the log */
    WH_REPLAY_LATE         /* a state or a command of a run that is over, never compared */
} wh_replay_loss_t;

#define WH_REPLAY_LOSSES 6

typedef struct {
    uint64_t count, first; /* how many, and the byte of the first one */
} wh_replay_count_t;

/* How a run begins in the log: if it is with a state of a later slice than the first one, with which. */
typedef struct {
    int64_t run;
    bool is_begun;         /* it has a state, or slices in a block */
    int64_t first_command; /* the lowest number of a command before that */
    int64_t seq;           /* 0: it begins otherwise */
    uint64_t hash, layout_hash;
    int64_t of; /* the run that had the same state, once that was replayed; 0: none yet */
} wh_replay_return_t;

/* A command and a state of the same slice. */
typedef struct {
    int64_t seq; /* 0: free */
    bool has_command;
    int64_t missed; /* as the state says */
    waferhand_command command;
    uint8_t *state; /* as it came; null: not yet */
    size_t size;
} wh_replay_slot_t;

typedef struct {
    uint64_t hash;
    wh_layout_t *layout;
    uint8_t *told; /* the message, without when and in which run */
    size_t size;
    uint64_t times;       /* that it was told */
    bool is_contradicted; /* and once in another way */
    bool is_sure;         /* it was told twice, or the recording's digest is of it */
} wh_replay_cell_t;

/* What the log is, as WAFERHAND_RECORDING tells. */
typedef struct {
    int32_t version; /* 0: it does not tell, as logs of version 1 */
    int64_t id;      /* of all its parts */
    int32_t part;
    int8_t mode, closed;
    bool is_changed;  /* what stands before it is not what was written */
    char program[60]; /* and its version */
} wh_replay_recording_t;

/* Hears of each slice in order, and of refusals. `command` is null if the log has it not. `message` is the
 * recorded state; within a block the replayed one, whose hash was compared. */
typedef void wh_replay_listener_t(void *user, const waferhand_command *command,
                                  const waferhand_state *message);

/* Zero it to begin with, then set what is wanted. Must not be moved afterwards. */
typedef struct {
    wh_replay_listener_t *listener; /* may be null */
    void *user;
    int64_t only_run; /* 0: all */
    uint64_t at;      /* the byte of the event that is handed over; the caller's */
    bool is_loose;    /* and nothing says that it ends where it should; the caller's */

    wh_replay_cell_t cells[WH_REPLAY_CELLS];
    size_t cell_count;

    wh_replay_return_t returns[WH_REPLAY_RUNS];
    size_t return_count;
    wh_replay_run_t runs[WH_REPLAY_RUNS];
    size_t run_count;
    uint64_t runs_left_out;    /* beyond WH_REPLAY_RUNS */
    uint64_t events, messages; /* all; of ours, sound */
    uint64_t digest;           /* wh_link_digest of ours */
    wh_replay_recording_t recording;
    wh_replay_count_t losses[WH_REPLAY_LOSSES];
    uint64_t proximities; /* such as could not be compared: their slice was not the last one */
    int64_t unknown_run;  /* of which a cell tells, before the run itself; 0: none */
    uint64_t unknown_at;

    const wh_replay_cell_t *cell; /* of the current run, whose slices go through: */
    wh_protocol_server_t server;
    wh_replay_run_t *run;               /* null before the first */
    const wh_replay_return_t *returned; /* how the run begins, until its first state has come; else null */
    waferhand_command last;             /* a block's last slice, while its whole state may follow: */
    bool has_last, last_differs;
    bool part_begins;          /* a later part of a recording, before its first state */
    bool is_synchronous;       /* the server is at `seq` of the run */
    bool is_unsure;            /* since the last comparison a slice was stepped whose valves are not known */
    int64_t seq, last_pending; /* the last slice that went through; the last one that waits */
    wh_replay_slot_t slots[WH_REPLAY_WINDOW];
} wh_replay_t;

/* One event of the log, before the first one goes through wh_replay_event: notes how its run begins. Cost:
 * linear in the runs. */
void wh_replay_look_ahead(wh_replay_t *replay, const char *channel, const void *data, size_t size);

/* One event of the log; those of other channels are ignored, unless they have a message of ours. */
void wh_replay_event(wh_replay_t *replay, const char *channel, const void *data, size_t size);

/* Lets all go through that still waits, though something is missing. */
void wh_replay_finish(wh_replay_t *replay);

/* The same at the log's end: nothing more comes. */
void wh_replay_end(wh_replay_t *replay);

/* True if the recording's digest shows that all of it is as it was written. To be asked at its end. */
bool wh_replay_is_vouched_for(const wh_replay_t *replay);

void wh_replay_close(wh_replay_t *replay);

#endif
