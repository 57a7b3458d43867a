/* Takes the prompt's answers apart: name=value with blanks between them, in the spelling of lua/README.md. */
#ifndef WH_HOST_VALUES_H
#define WH_HOST_VALUES_H

#include <stdbool.h>
#include <stddef.h>

#include <lua.h>

/* Pushes a table of the values by their names. A value that is a number becomes a number, `none` is left out,
 * others become texts. Words other than name=value are passed over; if a name comes again, the last one
 * counts. Raises only for memory. Cost: linear. */
void wh_push_values(lua_State *L, const char *text);

/* Where the value of that name begins; an empty text if there is none. */
const char *wh_value_begin(const char *text, const char *name);

/* Copies the value of that name up to a blank, cut if it is too long. */
void wh_value_copy(const char *text, const char *name, char *to, size_t size);

/* Writes a name as it can be typed at the prompt, in quotes if it needs them. False if it does not fit: in
 * quotes there must be room for twice its bytes and three more. */
bool wh_value_spell(const char *name, char *to, size_t size);

#endif
