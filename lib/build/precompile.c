/* precompile NAME <FILE >CODE: compiles the Lua text of an embedded file, so that the program need not read
 * it at each start. Messages show NAME, and lines as before; names of local variables are left out, because
 * no message of ours shows them and a third of the reading is theirs. */
#include <lauxlib.h>
#include <lua.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ------------------------------------------------------------------------------------------- names left out */

/* Compiled code of Lua 5.4, as its ldump.c writes it: read from `at`, written to `out`. */
struct chunk {
    const unsigned char *at, *end;
    FILE *out;
    int is_good;
};

static void copy(struct chunk *code, size_t size) {
    if (size > (size_t)(code->end - code->at)) {
        code->is_good = 0;
        code->at = code->end;
        return;
    }
    (void)fwrite(code->at, 1, size, code->out);
    code->at += size;
}

/* A number has seven bits in each byte, the greatest first; the last byte has the eighth. */
static size_t read_number(struct chunk *code) {
    size_t number = 0;
    while (code->at < code->end) {
        const unsigned char byte = *code->at++;
        number = number << 7 | (byte & 0x7FU);
        if ((byte & 0x80U) != 0) {
            return number;
        }
    }
    code->is_good = 0;
    return 0;
}

static size_t copy_number(struct chunk *code) {
    const unsigned char *const begin = code->at;
    const size_t number = read_number(code);
    (void)fwrite(begin, 1, (size_t)(code->at - begin), code->out);
    return number;
}

/* A text has its length plus 1 before it; 0: there is none. */
static void copy_text(struct chunk *code) {
    const size_t size = copy_number(code);
    copy(code, size > 0 ? size - 1 : 0);
}

static void skip_text(struct chunk *code) {
    const size_t size = read_number(code);
    const size_t left = (size_t)(code->end - code->at), length = size > 0 ? size - 1 : 0;
    code->is_good = code->is_good && length <= left;
    code->at += length <= left ? length : left;
}

/* 0x13: a float, 0x03: an integer, 0x04 and 0x14: texts; nil, false and true have nothing. */
static void copy_constant(struct chunk *code) {
    const unsigned char type = code->at < code->end ? *code->at : 0;
    copy(code, 1);
    if (type == 0x13) {
        copy(code, sizeof(lua_Number));
    } else if (type == 0x03) {
        copy(code, sizeof(lua_Integer));
    } else if (type == 0x04 || type == 0x14) {
        copy_text(code);
    }
}

static void copy_function(struct chunk *code);

static void copy_lists(struct chunk *code) {
    copy(code, 4 * copy_number(code)); /* instructions */
    for (size_t count = copy_number(code); count > 0 && code->is_good; --count) {
        copy_constant(code);
    }
    copy(code, 3 * copy_number(code)); /* upvalues */
    for (size_t count = copy_number(code); count > 0 && code->is_good; --count) {
        copy_function(code);
    }
}

/* Lines stay; local variables and the names of upvalues go. */
static void copy_places(struct chunk *code) {
    copy(code, copy_number(code));
    for (size_t count = 2 * copy_number(code); count > 0 && code->is_good; --count) {
        (void)copy_number(code);
    }
    for (size_t count = read_number(code); count > 0 && code->is_good; --count) {
        skip_text(code);
        (void)read_number(code);
        (void)read_number(code);
    }
    for (size_t count = read_number(code); count > 0 && code->is_good; --count) {
        skip_text(code);
    }
    (void)fwrite("\x80\x80", 1, 2, code->out);
}

static void copy_function(struct chunk *code) {
    copy_text(code);         /* its file, if that is another than the outer function's */
    (void)copy_number(code); /* its lines */
    (void)copy_number(code);
    copy(code, 3);
    copy_lists(code);
    copy_places(code);
}

/* The signature, version, sizes and samples of numbers, and the count of the outer function's upvalues. */
#define HEADING (4 + 1 + 1 + 6 + 3 + sizeof(lua_Integer) + sizeof(lua_Number) + 1)

/* Writes code of a known form without names; other code as it is. */
static int write_code(const unsigned char *text, size_t size) {
    char *written = NULL;
    size_t length = 0;
    FILE *out = open_memstream(&written, &length);
    struct chunk code = {text, text + size, out, out != NULL && size > 5 && text[4] == 0x54 && text[5] == 0};
    if (code.is_good) {
        copy(&code, HEADING);
        copy_function(&code);
    }
    if (out != NULL) {
        (void)fclose(out);
    }
    const int is_whole = code.is_good && code.at == code.end;
    const size_t wanted = is_whole ? length : size;
    const size_t done = fwrite(is_whole ? (const void *)written : text, 1, wanted, stdout);
    free(written);
    return done == wanted;
}

/* ------------------------------------------------------------------------------------------------ compiling */

static const char *next_block(lua_State *L, void *block, size_t *size) {
    (void)L;
    *size = fread(block, 1, BUFSIZ, stdin);
    return block;
}

static int keep_block(lua_State *L, const void *bytes, size_t size, void *kept) {
    (void)L;
    return fwrite(bytes, 1, size, kept) != size;
}

static int write_function(lua_State *L) {
    char *text = NULL;
    size_t size = 0;
    FILE *kept = open_memstream(&text, &size);
    const int dumped = kept != NULL && lua_dump(L, keep_block, kept, 0) == 0;
    const int closed = kept != NULL && fclose(kept) == 0;
    const int good = dumped && closed && write_code((const unsigned char *)text, size) && fclose(stdout) == 0;
    free(text);
    return good;
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
    } else if (!write_function(L)) {
        why = "cannot be written";
    }
    if (why) {
        fprintf(stderr, "precompile: %s: %s\n", argv[1], why);
    }
    lua_close(L);
    return why ? 1 : 0;
}
