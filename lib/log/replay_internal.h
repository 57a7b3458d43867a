/* Within the replay: bringing messages to their slices, and comparing a recorded state with the replayed
 * one. */
#ifndef WH_LOG_REPLAY_INTERNAL_H
#define WH_LOG_REPLAY_INTERNAL_H

#include "replay.h"

/* Counts one of our messages that is not used. */
void wh_replay_lose(wh_replay_t *replay, wh_replay_loss_t loss);

/* wh_replay_find_run returns the entry of a run, null if there is none; wh_replay_entry also makes
 * it, null if there are too many. */
wh_replay_run_t *wh_replay_find_run(wh_replay_t *replay, int64_t run);
wh_replay_run_t *wh_replay_entry(wh_replay_t *replay, int64_t run);

/* Null if no cell with this hash was told. */
wh_replay_cell_t *wh_replay_find_cell(wh_replay_t *replay, uint64_t hash);

/* They take sound messages of slices, with a run and a number in range. The state is accepted or refused
 * (its status); data and size are as received. */
void wh_replay_take_command(wh_replay_t *replay, const waferhand_command *message);
void wh_replay_take_state(wh_replay_t *replay, const waferhand_state *message, const void *data, size_t size);
void wh_replay_take_refusal(wh_replay_t *replay, const waferhand_state *message, const void *data,
                            size_t size);
void wh_replay_take_slices(wh_replay_t *replay, const wh_slices_t *slices);

/* Calls the listener, if there is one. */
void wh_replay_tell(const wh_replay_t *replay, const waferhand_command *command,
                    const waferhand_state *message);

/* Calls the listener for a block's last slice, whose whole state has not come. */
void wh_replay_tell_last(wh_replay_t *replay);

/* Goes on from a recorded state. False if no simulator could have been in it. */
bool wh_replay_restore(wh_replay_t *replay, const waferhand_state *message);

/* Steps a command and compares the state, which is in `bytes` as received. */
void wh_replay_step(wh_replay_t *replay, const waferhand_command *command, const waferhand_state *message,
                    const uint8_t *bytes, size_t size);

/* Steps a command whose state is not in the log. */
void wh_replay_step_alone(wh_replay_t *replay, const waferhand_command *command);

/* Steps a slice of a block, replay->last, and compares the hash instead of the state. */
void wh_replay_step_hashed(wh_replay_t *replay, const int32_t told[], uint64_t hash);

/* Compares the whole state of the block's last slice. */
void wh_replay_take_last_state(wh_replay_t *replay, const waferhand_state *message, const void *data,
                               size_t size);

/* Compares the state with which another file of the log begins. */
void wh_replay_take_first_state(wh_replay_t *replay, const waferhand_state *message, const void *data,
                                size_t size);

/* Keeps a hash of a slice's whole state; and counts a state that comes again with other content. */
void wh_replay_remember_state(wh_replay_t *replay, int64_t seq, const uint8_t *bytes, size_t size);
void wh_replay_check_repeat(wh_replay_t *replay, const waferhand_state *message, const void *data,
                            size_t size);

/* Notes that the last slice is as recorded: a later run may go on from it. */
void wh_replay_pass_slice(wh_replay_t *replay);

/* The beginning of a run, if it is a state of an earlier run; else null. */
const wh_replay_return_t *wh_replay_find_return(wh_replay_t *replay, int64_t run);

/* Counts a command that the simulator accepted and the replay refuses, or the reverse. */
void wh_replay_differ_in_status(wh_replay_run_t *run, int64_t slice, int32_t recorded, int32_t replayed);

/* True for an event of the collision check, which a replay does not have. */
bool wh_replay_is_collision(int32_t kind);

/* True if the states differ in any bit, except in their checks and events of the collision check.
 * `difference` then tells where; else it is unchanged. Whole messages are compared, so that no field can be
 * forgotten; the tables name it. */
bool wh_replay_states_differ(const wh_layout_t *layout, const waferhand_state *recorded,
                             const waferhand_state *replayed, wh_replay_difference_t *difference);

#endif
