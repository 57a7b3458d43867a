#include "nearest.h"

#include <ctype.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

#define SIZE (WH_NEAREST_BYTES + 1)

static size_t min2(size_t a, size_t b) {
    return a < b ? a : b;
}

static bool is_same(char a, char b) {
    return tolower((unsigned char)a) == tolower((unsigned char)b);
}

/* Row i has at j the number of slips that turn the first i bytes of `from` into the first j of `to`. */
typedef struct {
    const char *from, *to;
    size_t rows[3][SIZE]; /* row i is rows[i % 3] */
} slips_t;

static size_t count_at(const slips_t *slips, size_t i, size_t j) {
    const size_t *const above = slips->rows[(i - 1) % 3];
    const char *const from = slips->from + i, *const to = slips->to + j;
    size_t count = above[j - 1] + (is_same(from[-1], to[-1]) ? 0 : 1);
    count = min2(count, 1 + min2(above[j], slips->rows[i % 3][j - 1]));
    if (i > 1 && j > 1 && is_same(from[-1], to[-2]) && is_same(from[-2], to[-1])) {
        count = min2(count, 1 + slips->rows[(i - 2) % 3][j - 2]);
    }
    return count;
}

static size_t count_slips(const char *from, size_t from_length, const char *to, size_t to_length) {
    slips_t slips = {.from = from, .to = to};
    for (size_t j = 0; j <= to_length; ++j) {
        slips.rows[0][j] = j;
    }
    for (size_t i = 1; i <= from_length; ++i) {
        slips.rows[i % 3][0] = i;
        for (size_t j = 1; j <= to_length; ++j) {
            slips.rows[i % 3][j] = count_at(&slips, i, j);
        }
    }
    return slips.rows[from_length % 3][to_length];
}

/* The most slips at which the longer one of two words is still near. */
static size_t most_slips(size_t longer) {
    const size_t third = longer / 3 > 0 ? longer / 3 : 1;
    return min2(third, longer > 0 ? longer - 1 : 0);
}

const char *wh_text_nearest(const char *word, const char *const *names, size_t count) {
    const size_t length = strlen(word);
    const char *nearest = NULL;
    size_t fewest = SIZE;
    for (size_t i = 0; length <= WH_NEAREST_BYTES && i < count; ++i) {
        const size_t name_length = strnlen(names[i], SIZE);
        const size_t longer = length > name_length ? length : name_length;
        if (longer > WH_NEAREST_BYTES) {
            continue;
        }
        const size_t slips = count_slips(word, length, names[i], name_length);
        if (slips <= most_slips(longer) && slips < fewest) {
            nearest = names[i];
            fewest = slips;
        }
    }
    return nearest;
}

const char *wh_text_did_you_mean(char text[WH_NEAREST_TEXT], const char *before, const char *mark,
                                 const char *nearest) {
    text[0] = '\0';
    if (nearest) {
        (void)snprintf(text, WH_NEAREST_TEXT, "%sdid you mean %s%s?", before, mark, nearest);
    }
    return text;
}
