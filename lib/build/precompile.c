/* precompile FILE >CODE: compiles an embedded file of Lua, so that the program need not read its text at each
 * start. Names and lines are left out: no message of ours shows them, and half of the reading is theirs. */
#include <lauxlib.h>
#include <lua.h>
#include <stdio.h>

static int write_block(lua_State *L, const void *bytes, size_t size, void *out) {
    (void)L;
    return fwrite(bytes, 1, size, out) != size;
}

int main(int argc, char *argv[]) {
    lua_State *const L = argc == 2 ? luaL_newstate() : NULL;
    if (!L) {
        fprintf(stderr, "precompile: expected a file's name\n");
        return 2;
    }
    const char *why = NULL;
    if (luaL_loadfilex(L, argv[1], "t") != LUA_OK) {
        why = lua_tostring(L, -1);
    } else if (lua_dump(L, write_block, stdout, 1) != 0 || fclose(stdout) != 0) {
        why = "its code cannot be written";
    }
    if (why) {
        fprintf(stderr, "precompile: %s: %s\n", argv[1], why);
    }
    lua_close(L);
    return why ? 1 : 0;
}
