/* Keeps names, files and other processes from sending control characters to the terminal through standard
 * error. */
#ifndef WH_TEXT_GUARD_H
#define WH_TEXT_GUARD_H

#include <stdio.h>

/* After this call each control character written to stderr appears as \xNN, except line ends and tabs. Call
 * it once, at the program's start. Without memory for it stderr stays unchanged. */
void wh_guard_stderr(void);

/* The original standard error, for code that moves a terminal's cursor on purpose. */
FILE *wh_guard_terminal(void);

#endif
