/* What layouts and scripts may say, as a file of annotations for the Lua language server: editors complete
 * and check by it.
 *
 * It is made of what the program itself goes by: the fields that the reader of layouts accepts, the words of
 * scripts, and the options that commands look up.
 */
#ifndef WH_MCS_DEFINITIONS_H
#define WH_MCS_DEFINITIONS_H

#include "../script/sandbox.h"

/* Makes the text, to be freed. Null, and the reason in `result`, if a sandbox has no room for it. */
char *wh_definitions_make(wh_sandbox_result_t *result);

#endif
