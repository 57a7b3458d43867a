/* Shared by recording.c, which decides what is recorded, and recording_parts.c, which writes it. */
#ifndef WH_LOG_RECORDING_INTERNAL_H
#define WH_LOG_RECORDING_INTERNAL_H

#include "recording.h"

/* Writes one event. It ignores an event longer than a datagram, because nobody sends one. */
void wh_recording_write_event(wh_recording_t *recording, const char *channel, const void *data, size_t size);

/* Writes what the log is and what it contains so far: at its beginning, after a cell, and at its end. */
void wh_recording_write_note(wh_recording_t *recording, int8_t closed);

/* Writes the collected slices. */
void wh_recording_flush_block(wh_recording_t *recording);

void wh_recording_begin_part(wh_recording_t *recording);

/* Opens the file of the running part. */
bool wh_recording_open_file(wh_recording_t *recording);

/* Ends a part that is large enough, at a whole state; the next part begins with that state. */
void wh_recording_split(wh_recording_t *recording, const void *state, size_t size);

#endif
