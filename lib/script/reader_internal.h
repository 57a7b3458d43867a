/* What the files of the reader share; nobody else includes it. */
#ifndef WH_SCRIPT_READER_INTERNAL_H
#define WH_SCRIPT_READER_INTERNAL_H

#include <lauxlib.h>

#include "reader.h"

/* Writes the value on top of the stack as a message shows it. */
void wh_reader_describe(lua_State *L, char *text, size_t size);

/* Whether the table on top of the stack has entries 1, 2 and 3 and nothing else. */
bool wh_reader_is_list_of_three(lua_State *L);

#endif
