/* The matcher: one function for each kind of pattern item, and one recursion (`match`) with a depth limit. */
#include "pattern.h"

#include <ctype.h>
#include <string.h>

#include "sandbox_internal.h"

#define DEPTH_LIMIT 200
/* Steps are charged in units of this size. */
#define CHARGE_LOT 1000

typedef wh_pattern_t pattern_t;

/* ------------------------------------------------------ classes and sets of characters, in the "C" locale */

static bool in_class(int c, int letter) {
    static const struct {
        char letter;
        int (*contains)(int c);
    } classes[] = {{'a', isalpha}, {'c', iscntrl}, {'d', isdigit}, {'g', isgraph}, {'l', islower},
                   {'p', ispunct}, {'s', isspace}, {'u', isupper}, {'w', isalnum}, {'x', isxdigit}};
    for (size_t i = 0; i < sizeof classes / sizeof classes[0]; ++i) {
        if (classes[i].letter == tolower(letter)) {
            return (classes[i].contains(c) != 0) != (isupper(letter) != 0);
        }
    }
    return letter == c;
}

static bool in_set(int c, const char *p, const char *last) {
    bool inside = true;
    if (p[1] == '^') {
        inside = false;
        ++p;
    }
    while (++p < last) {
        if (*p == '%') {
            ++p;
            if (in_class(c, (unsigned char)*p)) {
                return inside;
            }
        } else if (p[1] == '-' && p + 2 < last) {
            if ((unsigned char)p[0] <= c && c <= (unsigned char)p[2]) {
                return inside;
            }
            p += 2;
        } else if ((unsigned char)*p == c) {
            return inside;
        }
    }
    return !inside;
}

/* --------------------------------------------------------------------------------- begin, and count steps */

void wh_pattern_init(pattern_t *m, lua_State *L, const char *subject, size_t subject_length,
                     const char *pattern, size_t pattern_length) {
    m->L = L;
    m->subject = subject;
    m->subject_end = subject + subject_length;
    m->pattern_end = pattern + pattern_length;
    m->steps = 0;
}

void wh_pattern_settle(pattern_t *m) {
    wh_sandbox_charge(m->L, m->steps);
    m->steps = 0;
}

static void count_steps(pattern_t *m, size_t steps) {
    m->steps += steps;
    if (m->steps >= CHARGE_LOT) {
        wh_pattern_settle(m);
    }
}

/* -------------------------------------------------------------------------- Single characters and classes */

/* The place after the single-character item that begins at p. */
static const char *item_end(pattern_t *m, const char *p) {
    const char first = *p++;
    if (first == '%') {
        if (p == m->pattern_end) {
            luaL_error(m->L, "malformed pattern (ends with '%%')");
        }
        return p + 1;
    }
    if (first != '[') {
        return p;
    }
    if (p < m->pattern_end && *p == '^') {
        ++p;
    }
    do { /* a first ']' stands for itself */
        if (p >= m->pattern_end) {
            luaL_error(m->L, "malformed pattern (missing ']')");
        }
        const char c = *p++;
        if (c == '%') {
            ++p;
        }
    } while (p >= m->pattern_end || *p != ']');
    return p + 1;
}

/* True if the item [p, end) matches the character at s. */
static bool matches_one(pattern_t *m, const char *s, const char *p, const char *end) {
    count_steps(m, 1 + ((size_t)(end - p) >> 3));
    if (s >= m->subject_end) {
        return false;
    }
    const int c = (unsigned char)*s;
    switch (*p) {
    case '.':
        return true;
    case '%':
        return in_class(c, (unsigned char)p[1]);
    case '[':
        return in_set(c, p, end - 1);
    default:
        return (unsigned char)*p == c;
    }
}

/* ----------------------------------------------------------------------- Items of more than one character */

/* The next action of `match`: continue at another place, or end. */
typedef struct {
    bool go_on;
    const char *s, *p; /* s: the result if done */
} next_t;

static next_t done(const char *s) {
    return (next_t){false, s, NULL};
}

static next_t go_on(const char *s, const char *p) {
    return (next_t){true, s, p};
}

static const char *match(pattern_t *m, const char *s, const char *p);

/* Matches %bxy; p is past the 'b'. Returns the end of the balanced text, or null. */
static const char *match_balance(pattern_t *m, const char *s, const char *p) {
    if (p + 1 >= m->pattern_end) {
        luaL_error(m->L, "malformed pattern (missing arguments to '%%b')");
    }
    if (s >= m->subject_end || *s != p[0]) {
        return NULL;
    }
    const char *const begin = s;
    for (int open = 1; ++s < m->subject_end;) {
        if (*s == p[1]) {
            if (--open == 0) {
                count_steps(m, (size_t)(s - begin));
                return s + 1;
            }
        } else if (*s == p[0]) {
            ++open;
        }
    }
    count_steps(m, (size_t)(s - begin));
    return NULL;
}

/* Matches %f[set]; p is past the 'f'. */
static next_t match_frontier(pattern_t *m, const char *s, const char *p) {
    if (p >= m->pattern_end || *p != '[') {
        luaL_error(m->L, "missing '[' after '%%f' in pattern");
    }
    const char *const end = item_end(m, p);
    const int before = s == m->subject ? 0 : (unsigned char)s[-1];
    const int here = s < m->subject_end ? (unsigned char)*s : 0;
    count_steps(m, 1 + ((size_t)(end - p) >> 2));
    return !in_set(before, p, end - 1) && in_set(here, p, end - 1) ? go_on(s, end) : done(NULL);
}

/* Matches %1 to %9. */
static next_t match_back_reference(pattern_t *m, const char *s, const char *p) {
    const int index = *p - '1';
    if (index < 0 || index >= m->captures || m->capture[index].length == WH_CAPTURE_OPEN) {
        luaL_error(m->L, "invalid capture index %%%d", index + 1);
    }
    /* The special length of a position, as an unsigned number, exceeds any subject, so it never matches. */
    const size_t length = (size_t)m->capture[index].length;
    count_steps(m, 1 + (length <= (size_t)(m->subject_end - s) ? length >> 4 : 0));
    if ((size_t)(m->subject_end - s) < length || memcmp(m->capture[index].begin, s, length) != 0) {
        return done(NULL);
    }
    return go_on(s + length, p + 1);
}

static const char *begin_capture(pattern_t *m, const char *s, const char *p, ptrdiff_t length) {
    if (m->captures >= WH_PATTERN_CAPTURES) {
        luaL_error(m->L, "too many captures");
    }
    m->capture[m->captures].begin = s;
    m->capture[m->captures].length = length;
    ++m->captures;
    const char *const end = match(m, s, p);
    if (end == NULL) {
        --m->captures;
    }
    return end;
}

static const char *end_capture(pattern_t *m, const char *s, const char *p) {
    int index = m->captures;
    do {
        if (--index < 0) {
            luaL_error(m->L, "invalid pattern capture");
        }
    } while (m->capture[index].length != WH_CAPTURE_OPEN);
    m->capture[index].length = s - m->capture[index].begin;
    const char *const end = match(m, s, p);
    if (end == NULL) {
        m->capture[index].length = WH_CAPTURE_OPEN;
    }
    return end;
}

/* ------------------------------------------------------------------------ Repetition of the item [p, end) */

static const char *match_longest(pattern_t *m, const char *s, const char *p, const char *end) {
    ptrdiff_t count = 0;
    while (matches_one(m, s + count, p, end)) {
        ++count;
    }
    for (; count >= 0; --count) {
        const char *const found = match(m, s + count, end + 1);
        if (found != NULL) {
            return found;
        }
    }
    return NULL;
}

static const char *match_shortest(pattern_t *m, const char *s, const char *p, const char *end) {
    for (;; ++s) {
        const char *const found = match(m, s, end + 1);
        if (found != NULL) {
            return found;
        }
        if (!matches_one(m, s, p, end)) {
            return NULL;
        }
    }
}

/* The item does not match the character: the match continues only if the item's suffix allows no
 * occurrence. */
static next_t match_without(const char *s, const char *end, char suffix) {
    return suffix == '*' || suffix == '?' || suffix == '-' ? go_on(s, end + 1) : done(NULL);
}

/* The item matches the character at s. */
static next_t match_with(pattern_t *m, const char *s, const char *p, const char *end, char suffix) {
    const char *found = NULL;
    switch (suffix) {
    case '?':
        found = match(m, s + 1, end + 1);
        return found != NULL ? done(found) : go_on(s, end + 1);
    case '+':
        return done(match_longest(m, s + 1, p, end));
    case '*':
        return done(match_longest(m, s, p, end));
    case '-':
        return done(match_shortest(m, s, p, end));
    default:
        return go_on(s + 1, end);
    }
}

static next_t match_item(pattern_t *m, const char *s, const char *p) {
    const char *const end = item_end(m, p);
    const char suffix = end < m->pattern_end ? *end : '\0';
    return matches_one(m, s, p, end) ? match_with(m, s, p, end, suffix) : match_without(s, end, suffix);
}

/* '%' begins a class, which is an item, or a special item: %b, %f, %1. */
static next_t match_percent(pattern_t *m, const char *s, const char *p) {
    const char letter = p + 1 < m->pattern_end ? p[1] : '\0';
    if (letter == 'b') {
        const char *const after = match_balance(m, s, p + 2);
        return after != NULL ? go_on(after, p + 4) : done(NULL);
    }
    if (letter == 'f') {
        return match_frontier(m, s, p + 2);
    }
    if (isdigit((unsigned char)letter)) {
        return match_back_reference(m, s, p + 1);
    }
    return match_item(m, s, p);
}

static next_t match_next(pattern_t *m, const char *s, const char *p) {
    switch (*p) {
    case '(':
        if (p + 1 < m->pattern_end && p[1] == ')') {
            return done(begin_capture(m, s, p + 2, WH_CAPTURE_POSITION));
        }
        return done(begin_capture(m, s, p + 1, WH_CAPTURE_OPEN));
    case ')':
        return done(end_capture(m, s, p + 1));
    case '$':
        if (p + 1 == m->pattern_end) {
            return done(s == m->subject_end ? s : NULL);
        }
        return match_item(m, s, p);
    case '%':
        return match_percent(m, s, p);
    default:
        return match_item(m, s, p);
    }
}

static const char *match(pattern_t *m, const char *s, const char *p) {
    if (m->depth-- == 0) {
        luaL_error(m->L, "pattern too complex");
    }
    next_t next = go_on(s, p);
    count_steps(m, 1);
    while (next.go_on && next.p != m->pattern_end) {
        next = match_next(m, next.s, next.p);
    }
    ++m->depth;
    return next.s;
}

const char *wh_pattern_match(pattern_t *m, const char *at, const char *pattern) {
    m->captures = 0;
    m->depth = DEPTH_LIMIT;
    return match(m, at, pattern);
}

/* --------------------------------------------------------------------------------- captures as Lua values */

void wh_pattern_push_capture(pattern_t *m, int index, const char *begin, const char *end) {
    if (index >= m->captures) {
        if (index != 0) {
            luaL_error(m->L, "invalid capture index %%%d", index + 1);
        }
        lua_pushlstring(m->L, begin, (size_t)(end - begin));
        return;
    }
    const ptrdiff_t length = m->capture[index].length;
    if (length == WH_CAPTURE_OPEN) {
        luaL_error(m->L, "unfinished capture");
    }
    if (length == WH_CAPTURE_POSITION) {
        lua_pushinteger(m->L, m->capture[index].begin - m->subject + 1);
    } else {
        lua_pushlstring(m->L, m->capture[index].begin, (size_t)length);
    }
}

int wh_pattern_push_captures(pattern_t *m, const char *begin, const char *end) {
    const int count = m->captures == 0 && begin != NULL ? 1 : m->captures;
    luaL_checkstack(m->L, count, "too many captures");
    for (int i = 0; i < count; ++i) {
        wh_pattern_push_capture(m, i, begin, end);
    }
    return count;
}
