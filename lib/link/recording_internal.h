/* Between the parts of a recording. All of it is called with the lock held. */
#ifndef WH_LINK_RECORDING_INTERNAL_H
#define WH_LINK_RECORDING_INTERNAL_H

#include "recording.h"

/* Writes one event. What is longer than a datagram comes from nobody. */
void wh_recording_write_event(wh_recording_t *recording, const char *channel, const void *data, size_t size);

/* Writes what the log has so far: a cell, which has no check of its own, is vouched for by the digest. */
void wh_recording_seal(wh_recording_t *recording);

/* Writes the slices that were collected. */
void wh_recording_flush_block(wh_recording_t *recording);

/* Ends a part that has become large enough, at a whole state, with which the next part begins. */
void wh_recording_split(wh_recording_t *recording, const void *state, size_t size);

/* Counts a slice. A file that waits for the first one is opened. */
void wh_recording_see_slice(wh_recording_t *recording);

/* The command's slice is the last one from now on. */
void wh_recording_note_place(wh_recording_t *recording, const waferhand_command *command, int64_t missed);

/* wh_recording_slice and wh_recording_state. */
wh_recorded_t wh_recording_take_slice(wh_recording_t *recording, const waferhand_command *command,
                                      const int32_t told[], int64_t missed, uint64_t hash, bool has_events);
void wh_recording_take_state(wh_recording_t *recording, const void *data, size_t size);

/* wh_recording_message. */
void wh_recording_take_message(wh_recording_t *recording, const char *channel, const void *data, size_t size);

/* The oldest commands, so many, were not answered, or will be later: they stand by themselves. */
void wh_recording_give_up(wh_recording_t *recording, size_t count);

#endif
