/* The answer of WHERE as a table for people. */
#ifndef WH_APP_PROMPT_ANSWER_H
#define WH_APP_PROMPT_ANSWER_H

#include <stdbool.h>
#include <stdio.h>

#include "../../text/style.h"

/* Prints a session's answer as a table, one wafer a row, if it is WHERE's: holder, slot, offsets in mm
 * and degrees, rounded as in a run's table of wafers. Wafers for which the answer had no room are counted
 * below it. False, and nothing is printed, for every other answer. Ends the program if out of memory. */
bool wh_answer_print_wafers(const char *answer, const wh_style_t *style, FILE *out);

#endif
