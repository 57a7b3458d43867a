/* Lua's string patterns, with each step of the matcher charged to the instruction budget.
 *
 * The language is that of the Lua 5.4 manual, section 6.4.1, with the same results and limits (32 captures,
 * 200 levels of backtracking). Lua's own matcher backtracks where no hook reaches it: a pattern of seven
 * stars on a subject of a few hundred bytes takes years. This one ends with the budget.
 */
#ifndef WH_SCRIPT_PATTERN_H
#define WH_SCRIPT_PATTERN_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include <lua.h>

#define WH_PATTERN_CAPTURES 32

/* Special lengths of a capture. */
#define WH_CAPTURE_OPEN ((ptrdiff_t)-1)
#define WH_CAPTURE_POSITION ((ptrdiff_t)-2)

typedef struct {
    lua_State *L; /* where errors are raised and steps charged */
    const char *subject, *subject_end;
    const char *pattern_end;
    int depth;      /* levels of backtracking left */
    int captures;   /* captures begun */
    uint32_t steps; /* not charged yet */
    struct {
        const char *begin;
        ptrdiff_t length;
    } capture[WH_PATTERN_CAPTURES];
} wh_pattern_t;

/* Prepares matching within subject; the pattern itself is handed to each match. Both are borrowed. */
void wh_pattern_init(wh_pattern_t *matcher, lua_State *L, const char *subject, size_t subject_length,
                     const char *pattern, size_t pattern_length);

/* Matches the pattern (past its '^') at exactly `at`: the end of the match, or null. Raises an error for a
 * malformed pattern, too deep a backtracking, and a spent budget. Forgets earlier captures first. */
const char *wh_pattern_match(wh_pattern_t *matcher, const char *at, const char *pattern);

/* Charges what is left of the steps; call after the last match. */
void wh_pattern_settle(wh_pattern_t *matcher);

/* Pushes capture number index (from 0); index 0 of a pattern without captures is the whole match [begin,
 * end). */
void wh_pattern_push_capture(wh_pattern_t *matcher, int index, const char *begin, const char *end);

/* Pushes all captures, or the whole match when there is none and begin is not null; returns their number. */
int wh_pattern_push_captures(wh_pattern_t *matcher, const char *begin, const char *end);

/* Is the character c in the class %letter? An upper-case letter negates; one that names no class is itself.
 */
bool wh_pattern_in_class(int c, int letter);

/* Is c in the set whose '[' is at p and whose ']' is at last? */
bool wh_pattern_in_set(int c, const char *p, const char *last);

#endif
