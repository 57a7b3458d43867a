/* Makes a file of annotations for the Lua language server: it lists what layouts and scripts may contain.
 * Editors use it to complete and check.
 *
 * It is made from the program's own tables: the fields that the reader of layouts accepts, the words of
 * scripts, and the options that commands look up.
 */
#ifndef WH_MCS_DEFINITIONS_H
#define WH_MCS_DEFINITIONS_H

#include "../layout/layout_fields.h"
#include "../script/sandbox.h"

/* The tables of cells of times alone, and of what a script says of a flow: up to a null. */
extern const wh_layout_class_t wh_flow_classes[];

/* True for a number that has least and most. */
bool wh_definitions_has_range(const wh_reader_field_t *row);

/* The default in words, of this value in the table's unit, if that is finite, or as the row says it. False:
 * there is none, or the field is required. */
bool wh_definitions_usual(const wh_reader_field_t *row, double value, char *text, size_t size);

/* Makes the text; the caller frees it. Null, and the reason in `result`, if a sandbox has no room
 * for it. */
char *wh_definitions_make(wh_sandbox_result_t *result);

#endif
