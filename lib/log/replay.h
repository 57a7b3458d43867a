/* Steps a recording again. Each recorded command goes through the simulator's own protocol
 * (link/protocol_server.h), and each recorded state is compared with the replayed one, bit for bit: body and
 * hash.
 *
 * A command waits for its state, and a state for its command, at most WH_REPLAY_WINDOW slices: messages may
 * stand in any order. A command is stepped with the valves that were in force by its state (they may have
 * come from outputs.txt). A slice of a block (wire/slices.h) is compared by its hash. If commands are not in
 * the log, the replay continues from the next whole state. Each slice is compared once; repeated messages,
 * as over a lossy network, are passed over. For each run the first difference is named, and the differing
 * slices are counted.
 *
 * A run may go on from a state of an earlier one, as after RESTORE at the prompt. If a slice of this number,
 * with this hash and layout, was replayed before and found to be as recorded, nothing is missing. Else the
 * slices before it were passed over. These states must be known before the replay, by wh_replay_look_ahead:
 * so the replay keeps one hash for each run, however long the log is.
 *
 * Motion control's last message of a run names its last slice: slices missing before that are counted, too.
 *
 * Messages that were passed over are counted by reason: none of ours is left out silently. Events of the
 * collision check are not compared, since messages do not have shapes. WAFERHAND_MCS and WAFERHAND_REQUEST
 * have no check: the digest of a closed recording confirms them.
 */
#ifndef WH_LOG_REPLAY_H
#define WH_LOG_REPLAY_H

#include "../link/outcome.h"
#include "../link/protocol_server.h"
#include "../wire/slices.h"
#include "logfile.h"

#define WH_REPLAY_RUNS 256
/* The most slices that a command waits for its state, or a state for its command. */
#define WH_REPLAY_WINDOW 2048
/* The most cells of one log. */
#define WH_REPLAY_CELLS 8

/* The first difference. */
typedef struct {
    int64_t slice;
    char what[160]; /* such as "Wafer 1, position x" */
    double recorded, replayed;
} wh_replay_difference_t;

/* A run's slices, by what became of them. */
typedef struct {
    int64_t compared;        /* slices whose state was compared */
    int64_t differing;       /* those of them that are not as recorded */
    int64_t unanswered;      /* commands whose state is not in the log, though the log goes on */
    int64_t last_unanswered; /* commands after the last state: the log ends before their states */
    int64_t doubtful;        /* slices that differ after unanswered ones: their valves are not known */
    int64_t outside_valves;  /* slices whose valves were not the command's */
    int64_t taken_up;        /* the times that a message was missing and a state was taken over */
    int64_t skipped;         /* slices that were passed over and not compared, including that state's slice */
    int64_t missed;          /* free-running: commands that never came */
} wh_replay_slices_t;

/* Commands whose cell is not in the log. */
typedef struct {
    int64_t count;
    uint64_t at;          /* the byte of the first one */
    bool is_other_layout; /* the simulator refused them because of their layout */
} wh_replay_homeless_t;

/* Motion control's message that the run is over. */
typedef struct {
    bool is_told;
    uint64_t at; /* its byte */
    int64_t seq; /* the slice behind which it came */
    wh_run_told_t outcome;
    char *reason;  /* null: not given */
    bool is_wrong; /* the message contradicts itself, or its expectations */
} wh_replay_over_t;

typedef struct {
    int64_t run;
    bool is_begun;        /* it has commands or states */
    bool begins_in_part;  /* its first slices are in another file of the recording */
    int64_t goes_on_from; /* the run with whose state of slice `first_slice` it begins; 0: none */
    uint64_t layout_hash;
    int64_t first_slice, last_slice; /* stepped or taken over */
    wh_replay_slices_t slices;
    int64_t refused; /* commands that simulator and replay refused alike */
    wh_replay_homeless_t homeless;
    int64_t last_refused;              /* the slice of the last one */
    int64_t collisions;                /* events of the collision check: as recorded, not compared */
    uint64_t hash;                     /* after the last slice */
    wh_replay_difference_t difference; /* if any differ */
    int64_t reached;                   /* the last slice with data in the log */
    bool is_left;                      /* a file of the log ends within it, without saying that it goes on */
    wh_replay_over_t over;
    wh_log_numbers_t expectations; /* the expectations in the log */
    int64_t unmet;                 /* messages of an unmet expectation */
} wh_replay_run_t;

/* The reason why one of our messages was not used. */
typedef enum {
    WH_REPLAY_GARBAGE,     /* on our channels, but not a sound message */
    WH_REPLAY_UNCHECKED,   /* a command or a state without a check: it may differ from the sent one */
    WH_REPLAY_STRAY,       /* a message of ours on a channel that is not ours */
    WH_REPLAY_CONTRADICTS, /* data that contradicts other messages of the log, such as a cell */
    WH_REPLAY_HOMELESS,    /* a command or a state of a layout whose cell is not in the log */
    WH_REPLAY_LATE         /* a state or a command of a run that is over, never compared */
} wh_replay_loss_t;

#define WH_REPLAY_LOSSES 6

typedef struct {
    uint64_t count, first; /* their number, and the byte of the first one, */
    size_t file;           /* in this file */
} wh_replay_count_t;

/* How a run begins in the log: if it begins with a state of a later slice than the first one, this is
 * the state. */
typedef struct {
    int64_t run;
    bool is_begun;         /* it has a state, or slices in a block */
    int64_t first_command; /* the lowest number of a command before that */
    int64_t seq;           /* 0: it begins otherwise */
    uint64_t hash, layout_hash;
    int64_t of; /* the run that had this state, after that was replayed; 0: none yet */
} wh_replay_return_t;

/* A command and a state of the same slice. */
typedef struct {
    int64_t seq; /* 0: free */
    bool has_command;
    int64_t missed; /* from the state */
    waferhand_command command;
    uint8_t *state; /* as received; null: not yet */
    size_t size;
} wh_replay_slot_t;

typedef struct {
    uint64_t hash;
    wh_layout_t *layout;
    uint8_t *told; /* the message, without its time and its run */
    size_t size;
    uint64_t times;       /* the times that it was told */
    bool is_contradicted; /* and once with other content */
    bool is_sure;         /* it was told twice, or the recording's digest includes it */
} wh_replay_cell_t;

/* The description of the log from WAFERHAND_RECORDING. */
typedef struct {
    bool is_told;    /* false: there is none, as in logs of version 1 */
    int32_t version; /* 0 if there is none */
    int64_t id;      /* of all its parts */
    int32_t part;
    int32_t first_part; /* the one that was read first */
    int8_t mode, closed;
    bool is_changed;  /* the messages before it are not as written */
    char program[60]; /* and its version */
} wh_replay_recording_t;

/* Gets each slice in order, and refusals. `command` is null if the log does not have it. `message` is the
 * recorded state; within a block it is the replayed one, whose hash was compared. */
typedef void wh_replay_listener_t(void *user, const waferhand_command *command,
                                  const waferhand_state *message);

/* Gets a slice within a block in place of the other listener: the server's own state, whose hash was
 * compared, valid until the call returns. */
typedef void wh_replay_stepped_t(void *user, const waferhand_command *command,
                                 const wh_protocol_server_t *server);

/* The caller's wishes. */
typedef struct {
    wh_replay_listener_t *listener; /* may be null */
    wh_replay_stepped_t *stepped;   /* null: the other one gets these slices too, as messages */
    void *user;
    int64_t only_run; /* 0: all */
} wh_replay_given_t;

/* A place in the log. */
typedef struct {
    uint64_t at;   /* its byte, */
    size_t file;   /* in this file */
    bool is_loose; /* and its end may be wrong */
} wh_replay_place_t;

/* All that came. */
typedef struct {
    uint64_t events, messages; /* all; of ours, sound */
    uint64_t digest;           /* wh_link_digest of ours */
    wh_replay_count_t losses[WH_REPLAY_LOSSES];
    uint64_t proximities; /* those that could not be compared: their slice was not the last one */
    int64_t unknown_run;  /* named by a cell before the run itself came; 0: none */
    uint64_t unknown_at;
} wh_replay_heard_t;

/* Files of one log, and parts of one recording. */
typedef struct {
    bool part_begins;     /* a later part of a recording, before its first state */
    bool file_begins;     /* another file of the log, before its first state */
    size_t open_files;    /* earlier files that were not closed: nothing confirms their texts */
    int32_t lost_part;    /* the first part of the recording that is not there, between two files; 0: none */
    int32_t awaited_part; /* the next file must be this part of the same recording; 0: any. Set at the end
                           * of each file */
} wh_replay_files_t;

/* The last slice of a block. */
typedef struct {
    waferhand_command last;
    bool is_there; /* and its whole state may follow */
    bool differs;
} wh_replay_block_t;

/* Zero it at first, then set the wanted fields. Must not be moved afterwards. */
typedef struct {
    wh_replay_given_t given;
    wh_replay_place_t place; /* of the event that is passed in; set by the caller */

    wh_replay_cell_t cells[WH_REPLAY_CELLS];
    size_t cell_count;

    wh_replay_return_t returns[WH_REPLAY_RUNS];
    size_t return_count;
    wh_replay_run_t runs[WH_REPLAY_RUNS];
    size_t run_count;
    uint64_t runs_left_out; /* beyond WH_REPLAY_RUNS */
    wh_replay_heard_t heard;
    wh_replay_recording_t recording;

    const wh_replay_cell_t *cell; /* of the current run, whose slices go through: */
    wh_protocol_server_t server;
    wh_replay_run_t *run;               /* null before the first */
    const wh_replay_return_t *returned; /* the beginning of the run, until its first state has come; else
                                         * null */
    wh_replay_block_t block;
    wh_replay_files_t files;
    bool is_synchronous; /* the server is at `seq` of the run */
    bool is_unsure;      /* since the last comparison, a slice with unknown valves was stepped */
    uint64_t *told;      /* by slice: a hash of the whole state that was compared; 0: none was */
    size_t told_count, told_capacity;
    int64_t seq, last_pending; /* the last slice that went through; the last one that waits */
    wh_replay_slot_t slots[WH_REPLAY_WINDOW];
} wh_replay_t;

/* Takes one event of the log, before the first one goes through wh_replay_event, and notes how its run
 * begins. Cost: linear in the runs. */
void wh_replay_look_ahead(wh_replay_t *replay, const char *channel, const void *data, size_t size);

/* Another file of the log begins; its own numbers count from its beginning. If it begins with the state of
 * the last slice, that state is compared with the replayed one. */
void wh_replay_next_file(wh_replay_t *replay);

/* Takes one event of the log. Other channels are ignored, unless they have a message of ours. */
void wh_replay_event(wh_replay_t *replay, const char *channel, const void *data, size_t size);

/* Lets all waiting messages go through, though some are missing. */
void wh_replay_finish(wh_replay_t *replay);

/* Like wh_replay_finish, at the log's end: no more messages come. */
void wh_replay_end(wh_replay_t *replay);

/* True if the recording's digest shows that all of it is as written. Call it at its end. */
bool wh_replay_is_vouched_for(const wh_replay_t *replay);

void wh_replay_close(wh_replay_t *replay);

#endif
