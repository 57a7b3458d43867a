/* Internal to sim: writes text piece by piece into a caller's buffer, with number formatting of its own. It
 * uses no stdio, so that a firmware does not pay for it. */
#ifndef WH_SIM_WORDS_INTERNAL_H
#define WH_SIM_WORDS_INTERNAL_H

#include "../math/vector.h"

/* `length` counts the characters put in, also beyond the room; with room for at least one byte the text
 * always ends. */
typedef struct {
    char *buffer;
    size_t size, length;
} wh_words_t;

/* The most decimals of a number. */
#define WH_WORDS_DECIMALS 15

/* An empty text. `buffer` may be null if `size` is 0. */
wh_words_t wh_words_begin(char *buffer, size_t size) WH_SYMBOL(wh_words_begin);

void wh_words_put(wh_words_t *words, const char *text) WH_SYMBOL(wh_words_put);

/* A whole number. */
void wh_words_integer(wh_words_t *words, int64_t value) WH_SYMBOL(wh_words_integer);

/* `decimals` (0 to 15) digits after the point, rounded like printf's %.*f: exactly, halves to even. From
 * 1e15 on it writes "more than 1e15", or "less than" with a minus; for NaN "nan". */
void wh_words_fixed(wh_words_t *words, wh_real_t value, int decimals) WH_SYMBOL(wh_words_fixed);

/* At most `digits` (1 to 15) significant digits, but not fewer than `least` decimals; without zeros at the
 * end: 0.5, 50, 0.00005. */
void wh_words_short(wh_words_t *words, wh_real_t value, int digits, int least) WH_SYMBOL(wh_words_short);

/* The fewest decimals, at least `least`, with which two numbers of one sign have different texts, and the
 * larger one reads as the larger; `least` if 15 show no difference. */
int wh_words_apart(wh_real_t a, wh_real_t b, int least) WH_SYMBOL(wh_words_apart);

/* True if two numbers of one sign have one text with so many decimals; of numbers from 1e15 on, if both are
 * such. */
bool wh_words_read_same(wh_real_t a, wh_real_t b, int decimals) WH_SYMBOL(wh_words_read_same);

#endif
