/* Finds table literals in which a key appears twice. */
#include <ctype.h>
#include <string.h>

#include "sandbox_internal.h"

/* The deepest nesting that is followed. Lua itself allows about 200 levels. */
#define DEEPEST 1000

typedef enum {
    TOKEN_END,
    TOKEN_NAME,
    TOKEN_NUMBER,
    TOKEN_TEXT,  /* with its quotes or brackets */
    TOKEN_OTHER, /* a single character, or == */
} token_kind_t;

typedef struct {
    token_kind_t kind;
    const char *begin;
    size_t length;
} token_t;

typedef struct {
    const char *at, *end;
    int line;
} scanner_t;

/* ------------------------------------------------------------------------------------------------- tokens */

static char look(const scanner_t *scanner, size_t ahead) {
    return (size_t)(scanner->end - scanner->at) > ahead ? scanner->at[ahead] : '\0';
}

static bool at_end(const scanner_t *scanner) {
    return scanner->at >= scanner->end;
}

static void skip(scanner_t *scanner) {
    scanner->line += *scanner->at == '\n' ? 1 : 0;
    ++scanner->at;
}

/* The number of bytes of the long bracket that opens here, [[ or [=[; 0 if none does. */
static size_t long_bracket(const scanner_t *scanner) {
    size_t length = 1;
    while (look(scanner, length) == '=') {
        ++length;
    }
    return look(scanner, 0) == '[' && look(scanner, length) == '[' ? length + 1 : 0;
}

static bool closes(const scanner_t *scanner, size_t length) {
    for (size_t i = 0; i < length; ++i) {
        if (look(scanner, i) != (i == 0 || i == length - 1 ? ']' : '=')) {
            return false;
        }
    }
    return true;
}

static void skip_long(scanner_t *scanner, size_t bracket) {
    scanner->at += bracket;
    while (!at_end(scanner) && !closes(scanner, bracket)) {
        skip(scanner);
    }
    scanner->at += at_end(scanner) ? 0 : bracket;
}

static void skip_quoted(scanner_t *scanner) {
    const char quote = *scanner->at++;
    for (bool ends = false; !at_end(scanner) && !ends; skip(scanner)) {
        ends = *scanner->at == quote;
        if (*scanner->at == '\\' && look(scanner, 1) != '\0') {
            skip(scanner);
        }
    }
}

static bool goes_on(char c) {
    return isalnum((unsigned char)c) || c == '_';
}

/* Skips a number, with the sign of an exponent. */
static void skip_number(scanner_t *scanner) {
    const bool is_hex = look(scanner, 0) == '0' && tolower((unsigned char)look(scanner, 1)) == 'x';
    const char exponent = is_hex ? 'p' : 'e';
    while (goes_on(look(scanner, 0)) || look(scanner, 0) == '.') {
        const bool ends = tolower((unsigned char)look(scanner, 0)) == exponent;
        const bool is_signed = look(scanner, 1) == '-' || look(scanner, 1) == '+';
        scanner->at += ends && is_signed ? 2 : 1;
    }
}

static void skip_comment(scanner_t *scanner) {
    scanner->at += 2;
    const size_t bracket = long_bracket(scanner);
    if (bracket > 0) {
        skip_long(scanner, bracket);
    }
    while (bracket == 0 && !at_end(scanner) && *scanner->at != '\n') {
        ++scanner->at;
    }
}

static void skip_blanks(scanner_t *scanner) {
    while (!at_end(scanner)) {
        if (look(scanner, 0) == '-' && look(scanner, 1) == '-') {
            skip_comment(scanner);
        } else if (isspace((unsigned char)look(scanner, 0))) {
            skip(scanner);
        } else {
            return;
        }
    }
}

static bool begins_number(const scanner_t *scanner) {
    const size_t digit = look(scanner, 0) == '.' ? 1 : 0;
    return isdigit((unsigned char)look(scanner, digit)) != 0;
}

/* Skips the token that begins here and returns its kind. */
static token_kind_t skip_token(scanner_t *scanner) {
    const size_t bracket = long_bracket(scanner);
    const char first = look(scanner, 0);
    if (bracket > 0) {
        skip_long(scanner, bracket);
        return TOKEN_TEXT;
    }
    if (first == '"' || first == '\'') {
        skip_quoted(scanner);
        return TOKEN_TEXT;
    }
    if (begins_number(scanner)) {
        skip_number(scanner);
        return TOKEN_NUMBER;
    }
    if (goes_on(first)) {
        while (goes_on(look(scanner, 0))) {
            ++scanner->at;
        }
        return TOKEN_NAME;
    }
    scanner->at += first == '=' && look(scanner, 1) == '=' ? 2 : 1;
    return TOKEN_OTHER;
}

static token_t read_token(scanner_t *scanner) {
    skip_blanks(scanner);
    token_t token = {TOKEN_END, scanner->at, 0};
    if (!at_end(scanner)) {
        token.kind = skip_token(scanner);
        token.length = (size_t)(scanner->at - token.begin);
    }
    return token;
}

/* True for a text in quotes without escapes. */
static bool is_plain(const token_t *token) {
    return token->kind == TOKEN_TEXT && *token->begin != '[' && !memchr(token->begin, '\\', token->length);
}

static bool is(const token_t *token, const char *text) {
    return (token->kind == TOKEN_NAME || token->kind == TOKEN_OTHER) && strlen(text) == token->length &&
           memcmp(token->begin, text, token->length) == 0;
}

/* --------------------------------------------------------------------------------------------------- keys */

/* The open levels, the innermost last: '{', '(', '[' or a block, 'b'. For each '{' a table on L's stack has
 * the line of each key; `listed` counts the values without a key. */
typedef struct {
    lua_State *L;
    const char *source;
    scanner_t scanner;
    size_t depth;
    char open[DEEPEST];
    lua_Integer listed[DEEPEST];
    bool begins_field;
    bool has_numbers; /* some key was a number */
} literals_t;

/* Raises for a key whose first line is `first`. */
static void refuse(const literals_t *literals, const char *key, int first) {
    lua_pushfstring(literals->L,
                    "%s:%d: %s: given twice in one table (expected once; it stands in line %d, too)",
                    literals->source, literals->scanner.line, key, first);
    lua_error(literals->L);
}

static void refuse_number(const literals_t *literals, const char *key, int first) {
    refuse(literals, lua_pushfstring(literals->L, "[%s]", key), first);
}

/* Notes the key on top of L's stack and pops it. */
static void note_key(literals_t *literals) {
    lua_State *L = literals->L;
    const bool is_text = lua_type(L, -1) == LUA_TSTRING;
    lua_pushvalue(L, -1);
    if (lua_rawget(L, -3) != LUA_TNIL) {
        const int first = (int)lua_tointeger(L, -1);
        const char *key = luaL_tolstring(L, -2, NULL);
        (is_text ? refuse : refuse_number)(literals, key, first);
    }
    lua_pop(L, 1);
    literals->has_numbers = literals->has_numbers || !is_text;
    lua_pushinteger(L, literals->scanner.line);
    lua_rawset(L, -3);
}

/* A value without a key uses its place in the list as a key. */
static void check_list(literals_t *literals) {
    for (lua_Integer i = 1; literals->has_numbers && i <= literals->listed[literals->depth]; ++i) {
        if (lua_rawgeti(literals->L, -1, i) != LUA_TNIL) {
            const int first = (int)lua_tointeger(literals->L, -1);
            refuse_number(literals, lua_pushfstring(literals->L, "%d", (int)i), first);
        }
        lua_pop(literals->L, 1);
    }
}

static bool push_number(lua_State *L, const token_t *token) {
    char text[40];
    if (token->length >= sizeof text) {
        return false;
    }
    memcpy(text, token->begin, token->length);
    text[token->length] = '\0';
    return lua_stringtonumber(L, text) > 0;
}

/* Pushes the key that begins with `token` onto L's stack. Returns false if it has none, or one that is
 * known only at run time. */
static bool push_key(literals_t *literals, token_t token) {
    scanner_t ahead = literals->scanner;
    token_t next = read_token(&ahead);
    if (token.kind == TOKEN_NAME && is(&next, "=")) {
        lua_pushlstring(literals->L, token.begin, token.length);
        return true;
    }
    const token_t closing = read_token(&ahead);
    if (!is(&token, "[") || !is(&closing, "]")) {
        return false;
    }
    if (is_plain(&next)) {
        lua_pushlstring(literals->L, next.begin + 1, next.length - 2);
        return true;
    }
    return next.kind == TOKEN_NUMBER && push_number(literals->L, &next);
}

static void note_field(literals_t *literals, token_t token) {
    if (push_key(literals, token)) {
        note_key(literals);
    } else if (!is(&token, "[")) {
        ++literals->listed[literals->depth - 1];
    }
}

/* ------------------------------------------------------------------------------------------------ nesting */

static bool is_one_of(const token_t *token, const char *const words[]) {
    while (*words != NULL && !is(token, *words)) {
        ++words;
    }
    return *words != NULL;
}

static char opened_by(const token_t *token) {
    static const char *const blocks[] = {"function", "if", "do", "repeat", NULL};
    static const char *const brackets[] = {"{", "(", "[", NULL};
    if (is_one_of(token, brackets)) {
        return *token->begin;
    }
    return is_one_of(token, blocks) ? 'b' : '\0';
}

/* Returns false if it is too deep to follow. */
static bool open_level(literals_t *literals, char level) {
    if (literals->depth == DEEPEST || !lua_checkstack(literals->L, 8)) {
        return false;
    }
    literals->open[literals->depth] = level;
    literals->listed[literals->depth++] = 0;
    if (level == '{') {
        lua_newtable(literals->L);
        literals->begins_field = true;
    }
    return true;
}

static void close_level(literals_t *literals) {
    if (literals->depth > 0 && literals->open[--literals->depth] == '{') {
        check_list(literals);
        lua_pop(literals->L, 1);
    }
    literals->begins_field = false;
}

static bool follow(literals_t *literals, token_t token) {
    static const char *const closing[] = {"}", ")", "]", "end", "until", NULL};
    const bool in_literal = literals->depth > 0 && literals->open[literals->depth - 1] == '{';
    if (is_one_of(&token, closing)) {
        close_level(literals);
        return true;
    }
    if (in_literal && literals->begins_field) {
        literals->begins_field = false;
        note_field(literals, token);
    }
    if (in_literal && (is(&token, ",") || is(&token, ";"))) {
        literals->begins_field = true;
    }
    const char level = opened_by(&token);
    return level == '\0' || open_level(literals, level);
}

/* It runs as a function of its own, because of the tables on the stack. */
static int refuse_twice(lua_State *L) {
    literals_t *literals = lua_touserdata(L, 1);
    literals->L = L;
    token_t token = read_token(&literals->scanner);
    while (token.kind != TOKEN_END && follow(literals, token)) {
        token = read_token(&literals->scanner);
    }
    return 0;
}

void wh_literals_refuse_twice(lua_State *L, const char *source, const char *text, size_t size) {
    lua_pushcfunction(L, refuse_twice);
    literals_t *literals = lua_newuserdatauv(L, sizeof *literals, 0);
    memset(literals, 0, sizeof *literals);
    literals->source = source;
    literals->scanner = (scanner_t){text, text + size, 1};
    lua_call(L, 1, 0);
}
