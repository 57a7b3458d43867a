/* The way of a live page to the tester's port of `serve`: JSON lines, so that a transcript has them and plays
 * them again. One thread. */
#ifndef WH_APP_LIVE_TESTER_H
#define WH_APP_LIVE_TESTER_H

#include <stdbool.h>

/* Zero it to begin with. */
typedef struct {
    char address[80]; /* of the tester's port; empty: it does not listen yet */
    int fd;
    bool is_connected;
} wh_live_tester_t;

/* Sends a line with its end, over a new connection if the last one was lost. False: nobody takes it. */
bool wh_live_tester_send(wh_live_tester_t *tester, const char *line);

/* Reads what was answered and drops it, because it also comes as frames of that port. */
void wh_live_tester_drain(wh_live_tester_t *tester);

void wh_live_tester_leave(wh_live_tester_t *tester);

#endif
