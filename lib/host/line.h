/* A controller's line: frames on their way through chaos and pace, and its clients. */
#ifndef WH_HOST_LINE_H
#define WH_HOST_LINE_H

#include "state.h"

/* Enqueues the copies that chaos leaves of a frame, in either direction, on the line that units may share. A
 * frame to the host is noted when it is made: a wall clock decides when it arrives. */
void wh_controller_enqueue(wh_controller_t *controller, bool is_to_host, const uint8_t *bytes, size_t size,
                           int64_t due_us, bool is_acknowledgement);

/* The first frame if it is due, for the caller to free; else null. */
wh_sent_frame_t *wh_sent_take_due(wh_sent_t *sent, int64_t now_us);

void wh_sent_drop(wh_sent_t *sent);

/* Sends the frames that are due, and the bytes of a paced line that are through by now. */
void wh_controller_send_due(wh_controller_t *controller, int64_t now_us);

/* Notes what has happened at the port. */
void wh_controller_note_port(wh_controller_t *controller, unsigned what);

/* The last bytes of a client are told before its going. */
void wh_controller_note_going(wh_controller_t *controller);

/* Another client has come: everything that the last one sent, or was owed, by any unit of the line, is
 * dropped. */
void wh_controller_forget_client(wh_controller_t *controller);

#endif
