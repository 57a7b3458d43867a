/* The motion control software in the host: what the Lua side of it (lua/mcs) stands on.
 *
 * Lua decides, this executes: it reads the layout, plays segments slice by slice against the simulator,
 * measures, and keeps the record of the run. It reaches Lua as a table of functions that only lua/mcs sees;
 * scripts see the operator's words that lua/mcs/init.lua makes of them.
 */
#ifndef WH_MCS_MCS_H
#define WH_MCS_MCS_H

#include "../layout/collision.h"
#include "../motion/track.h"
#include "../record/record.h"
#include "../script/sandbox.h"
#include "../sim/simulator.h"
#include "decisions.h"
#include "trial_cell.h"

typedef struct wh_mcs wh_mcs_t;

/* Who else takes part in a run; each function may be null. */
typedef struct {
    /* Called once, after the cell was set up and found in reach and before the first slice: returns the link that takes
     * the place of the simulator in this process, or null when there is none to be had, which ends the script. */
    wh_link_t *(*connect)(void *user, wh_mcs_t *mcs);
    /* A command of the record begins (`ended` false) or has ended. */
    void (*watch)(void *user, const wh_mcs_t *mcs, const wh_command_record_t *command, bool ended);
    void *user;
} wh_mcs_partners_t;

/* Who listens to a run, whoever its partners are; each function may be null. */
typedef struct {
    /* A slice was accepted: mcs->command and mcs->state are what went in and came out. */
    void (*slice)(void *user, const wh_mcs_t *mcs);
    /* A command of the record begins or has ended. */
    void (*boundary)(void *user, const wh_mcs_t *mcs);
    void *user;
} wh_mcs_listener_t;

/* Judges a segment before a command moves: it was planned from where mcs->track stands, nothing of the command has been
 * played, and track.valves are as the segments before it leave them. True when it would collide; `reason`, of
 * WH_MCS_REASON_BYTES, then says with what. A copy of the track may be stepped, mcs must be left alone. */
#define WH_MCS_REASON_BYTES 200
typedef bool wh_mcs_ahead_t(void *user, const wh_mcs_t *mcs, const wh_segment_t *segment, char *reason);

/* Written by lib/mcs/mcs*.c only, but for `partners`, `listener`, `keep_segments`, `trial`, `tape` and `ahead`, which may be set between
 * opening and the cell. Must not be moved once opened. */
struct wh_mcs {
    const char *script; /* as the user gave it; borrowed */
    wh_sandbox_t *sandbox;
    wh_record_t *record;
    const wh_layout_t *layout; /* null until a script names one */
    const wh_trial_t
        *trial; /* of a study, whose errors the cell then has; null: the cell is as its layout says */
    wh_trial_cell_t *trial_cell; /* the trial's; null without one */
    wh_decisions_t *decisions;   /* keeps what is commanded and read back; null: nobody does */
    wh_simulator_t simulator;
    wh_collision_t collision;
    wh_link_t *link; /* the simulator's, or whoever stands in for it */
    wh_track_t track;
    wh_command_t command;     /* the last one sent */
    wh_machine_cache_t cache; /* and what it was made of */
    wh_state_t state;         /* the answer to it */
    int32_t running;          /* index of the running command in the record, or WH_NONE */
    bool rehearsing;          /* segments are planned and skipped, not played */
    bool judging;             /* and `ahead` is asked */
    size_t judged;            /* how many segments of this rehearsal it was asked about before */
    wh_track_t kept;          /* the track from before the rehearsal */
    wh_mcs_ahead_t *ahead;    /* null: nobody looks ahead */
    void *ahead_user;
    int64_t stop_slice;           /* at which a STOP comes; INT64_MAX: none */
    uint32_t was_off;             /* bit g: gripper g's sensor was off in a slice of the running segment */
    wh_fault_t faults[WH_FAULTS]; /* by slot, as the simulator has them or is about to */
    size_t fault_count;
    bool keep_segments; /* collect what is played, for --segments */
    /* Of the running segment. */
    wh_task_t task;
    /* Where the rehearsal goes in; slot 0: nobody wants to know. */
    int32_t reach_station, reach_slot;
    wh_segment_t *segments;
    size_t segment_count, segment_capacity;
    wh_mcs_partners_t partners;
    wh_mcs_listener_t listener;
};

/* Opens the operator's words in a sandbox for one run of `script`. `mcs` and `record` must outlive the
 * sandbox. False, and the reason in `result`, when the sandbox has no room for it. */
bool wh_mcs_open(wh_mcs_t *mcs, wh_sandbox_t *sandbox, const char *script, wh_record_t *record,
                 wh_sandbox_result_t *result);

/* Leaves on the stack of L, within a protected call and after `cell`, what executes a typed line and what
 * completes one: two functions, see lua/mcs/prompt.lua and lua/mcs/completion.lua. */
void wh_mcs_push_lines(lua_State *L);

/* Whether the cell complained: a wafer was let go where it should not have been, or an input was refused. */
bool wh_mcs_is_complaint(const wh_event_t *event);

/* Counts the slice of which `task`, `track` and `state` are; and the wafers that the running command, which succeeded, has put. Who
 * follows a run from a log keeps its record by them, too. */
void wh_mcs_count_slice(wh_mcs_t *mcs);
void wh_mcs_count_puts(wh_mcs_t *mcs);

/* Closes the record: wafers, slices, hash. The sandbox must still be there. */
void wh_mcs_finish(wh_mcs_t *mcs);

/* Frees what the run collected; the record is its owner's. */
void wh_mcs_close(wh_mcs_t *mcs);

#endif
