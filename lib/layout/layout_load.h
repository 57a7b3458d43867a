/* A layout from its file, for a program that runs no script. */
#ifndef WH_LAYOUT_LAYOUT_LOAD_H
#define WH_LAYOUT_LAYOUT_LOAD_H

#include "../script/sandbox.h"
#include "layout.h"

/* Runs the file in the sandbox and reads what it returns. Null, and the reason in `result`, when that fails. The layout
 * lives as long as the sandbox. */
const wh_layout_t *wh_layout_load(wh_sandbox_t *sandbox, const char *path, wh_sandbox_result_t *result);

#endif
