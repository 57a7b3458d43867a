/* The run's clock, and the transcript that is written or compared. */
#ifndef WH_HOST_JOURNAL_H
#define WH_HOST_JOURNAL_H

#include "state.h"

/* The time in us that tells if answers are late or in time. It is the wall clock. Where a transcript is
 * played, it is the simulated clock plus the time that was passed over while nothing ran. */
int64_t wh_host_now(const wh_host_t *host);

/* Writes an entry of this slice into the transcript, or compares it with the one that is played. */
void wh_host_note(wh_host_t *host, const wh_controller_t *controller, wh_transcript_kind_t kind,
                  const uint8_t *bytes, size_t size);

/* True if the run has not been as the transcript that is played; its message tells how. */
bool wh_host_differs(const wh_host_t *host);

/* Notes it if the running command has set the clock back, which counts on from there. Called before anything
 * else that looks at the time, in each slice and after each line of a command. */
void wh_host_heed_clock(wh_host_t *host);

#endif
