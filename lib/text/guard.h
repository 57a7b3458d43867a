/* Standard error that steers no terminal, whatever names, files and other processes put into a message. */
#ifndef WH_TEXT_GUARD_H
#define WH_TEXT_GUARD_H

#include <stdio.h>

/* From here on each control character that is written to stderr stands there as \xNN, but for line ends and
 * tabs. Once, at the program's start. Without memory for it stderr stays as it is. */
void wh_guard_stderr(void);

/* Standard error as it was, for what moves a terminal's cursor on purpose. */
FILE *wh_guard_terminal(void);

#endif
