/* precompile NAME <FILE >CODE: compiles the Lua text of an embedded file, so that the program need not read
 * it at each start. Messages show NAME, and lines as before. */
#include <lauxlib.h>
#include <lua.h>
#include <stdio.h>

static const char *next_block(lua_State *L, void *block, size_t *size) {
    (void)L;
    *size = fread(block, 1, BUFSIZ, stdin);
    return block;
}

static int write_block(lua_State *L, const void *bytes, size_t size, void *unused) {
    (void)L;
    (void)unused;
    return fwrite(bytes, 1, size, stdout) != size;
}

int main(int argc, char *argv[]) {
    char block[BUFSIZ];
    lua_State *const L = argc == 2 ? luaL_newstate() : NULL;
    if (!L) {
        fprintf(stderr, "precompile: expected a chunk's name\n");
        return 2;
    }
    const char *why = NULL;
    if (lua_load(L, next_block, block, lua_pushfstring(L, "@%s", argv[1]), "t") != LUA_OK) {
        why = lua_tostring(L, -1);
    } else if (lua_dump(L, write_block, NULL, 0) != 0 || fclose(stdout) != 0) {
        why = "cannot be written";
    }
    if (why) {
        fprintf(stderr, "precompile: %s: %s\n", argv[1], why);
    }
    lua_close(L);
    return why ? 1 : 0;
}
