/* Signals that ask the program to end, for work that can first report its progress. */
#ifndef WH_TEXT_INTERRUPT_H
#define WH_TEXT_INTERRUPT_H

#include <stdbool.h>

/* After this call SIGINT, SIGTERM and SIGHUP do not end the program: wh_interrupt_came tells of them. A
 * signal that was ignored stays ignored, for a program in the background. */
void wh_interrupt_catch(void);

/* True once one has come. Any thread may call it. */
bool wh_interrupt_came(void);

#endif
