/* Lua's string patterns. Each step of the matcher costs one step of the instruction budget.
 *
 * The language is that of the Lua 5.4 manual, section 6.4.1, with equal results and limits (32 captures,
 * 200 levels of backtracking). Lua's own matcher backtracks where no hook reaches it: a pattern of seven
 * stars on a subject of a few hundred bytes takes years. This matcher ends when the budget is spent.
 */
#ifndef WH_SCRIPT_PATTERN_H
#define WH_SCRIPT_PATTERN_H

#include <stddef.h>
#include <stdint.h>

#include <lua.h>

#define WH_PATTERN_CAPTURES 32

/* Special lengths of a capture. */
#define WH_CAPTURE_OPEN ((ptrdiff_t)-1)
#define WH_CAPTURE_POSITION ((ptrdiff_t)-2)

typedef struct {
    lua_State *L; /* raises the errors and pays for the steps */
    const char *subject, *subject_end;
    const char *pattern_end;
    int depth;      /* levels of backtracking left */
    int captures;   /* captures begun */
    uint64_t steps; /* not charged yet */
    struct {
        const char *begin;
        ptrdiff_t length;
    } capture[WH_PATTERN_CAPTURES];
} wh_pattern_t;

/* Prepares matching within `subject`. The caller keeps subject and pattern alive; the pattern itself is an
 * argument of each match. */
void wh_pattern_init(wh_pattern_t *matcher, lua_State *L, const char *subject, size_t subject_length,
                     const char *pattern, size_t pattern_length);

/* Matches the pattern (past its '^') at exactly `at`. Returns the end of the match, or null. Forgets earlier
 * captures first. Raises an error if the pattern is malformed, the backtracking too deep, or the budget
 * spent. */
const char *wh_pattern_match(wh_pattern_t *matcher, const char *at, const char *pattern);

/* Charges the steps that are not charged yet. Call it after the last match. */
void wh_pattern_settle(wh_pattern_t *matcher);

/* Pushes capture number `index` (from 0). If the pattern has no captures, index 0 is the whole match [begin,
 * end). */
void wh_pattern_push_capture(wh_pattern_t *matcher, int index, const char *begin, const char *end);

/* Pushes all captures and returns their number. If there is none and begin is not null, pushes the whole
 * match. */
int wh_pattern_push_captures(wh_pattern_t *matcher, const char *begin, const char *end);

#endif
