/* Tries a dialect on frames, without a cell: what they ask for, and what the host hears at once. */
#ifndef WH_APP_DIALECT_SAY_H
#define WH_APP_DIALECT_SAY_H

#include "../host/dialect.h"
#include "../text/options.h"

/* Prints each frame, whose body is given, with the lines that it becomes and its first answer. False: one is
 * no frame, or shows a mistake of the dialect. */
bool wh_dialect_say(wh_dialect_t *dialect, const wh_option_list_t *bodies);

#endif
