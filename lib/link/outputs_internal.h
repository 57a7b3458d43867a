/* What the files of the outputs reader share; nobody else includes it. */
#ifndef WH_LINK_OUTPUTS_INTERNAL_H
#define WH_LINK_OUTPUTS_INTERNAL_H

#include <sys/stat.h>

#include "outputs.h"

/* 0, or why these arguments are refused: EINVAL, ENAMETOOLONG. */
int wh_outputs_refuse(const char *path, const int32_t *valves, size_t count);

/* Gets inotify's descriptor, or does without. */
void wh_outputs_watch_open(wh_outputs_t *outputs);

/* Takes the waiting events, a bounded number of them, and notes what they mean. True if there is reason to
 * look. */
bool wh_outputs_watch_drain(wh_outputs_t *outputs);

/* Watches the folder that now has the folder's name, if that is not the one being watched. */
void wh_outputs_watch_renew(wh_outputs_t *outputs);

/* Looks at the file. Good values go to `valves`; `status` is zeroed unless the file could be examined. */
wh_outputs_look_t wh_outputs_look(wh_outputs_t *outputs, int32_t *valves, struct stat *status);

/* Writes the report of a look that becomes the condition in force. */
void wh_outputs_describe(wh_outputs_t *outputs, const wh_outputs_look_t *look);

#endif
