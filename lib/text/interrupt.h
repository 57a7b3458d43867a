/* Signals that ask the program to end, for work that can say first how far it has come. */
#ifndef WH_TEXT_INTERRUPT_H
#define WH_TEXT_INTERRUPT_H

#include <stdbool.h>

/* From here on SIGINT, SIGTERM and SIGHUP do not end the program: wh_interrupt_came tells of them. One that
 * was ignored stays ignored, as for a program in the background. */
void wh_interrupt_catch(void);

/* True once one has come. May be called from any thread. */
bool wh_interrupt_came(void);

#endif
