/* Between recording.c, which decides what is recorded, and recording_parts.c, which writes it. */
#ifndef WH_LINK_RECORDING_INTERNAL_H
#define WH_LINK_RECORDING_INTERNAL_H

#include "recording.h"

/* Writes one event. What is longer than a datagram comes from nobody. */
void wh_recording_write_event(wh_recording_t *recording, const char *channel, const void *data, size_t size);

/* Says what the log is, and what is in it so far: at its beginning, behind a cell, and at its end. */
void wh_recording_write_note(wh_recording_t *recording, int8_t closed);

/* Writes the slices that were collected. */
void wh_recording_flush_block(wh_recording_t *recording);

void wh_recording_begin_part(wh_recording_t *recording);

/* Opens the file of the running part. */
bool wh_recording_open_file(wh_recording_t *recording);

/* Ends a part that has become large enough, at a whole state, with which the next part begins. */
void wh_recording_split(wh_recording_t *recording, const void *state, size_t size);

#endif
