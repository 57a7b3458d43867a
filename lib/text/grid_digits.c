/* How many decimals a number gets, and how it is then printed. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "grid.h"

/* No double near the limits needs more to be told from them. */
#define MOST_DECIMALS 20

void wh_grid_format(char *text, size_t size, double value, int decimals) {
    snprintf(text, size, "%.*f", decimals, value);
    if (text[0] == '-' && strspn(text, "-0.") == strlen(text)) {
        memmove(text, text + 1, strlen(text));
    }
}

/* -1, 0 or 1: below, at, above. */
static int side_of(double value, double limit) {
    return (value > limit) - (value < limit);
}

/* The fewest decimals, from `least` to `most`, that lose nothing of what `most` would show. */
static int decimals_in_use(double value, int least, int most) {
    char text[WH_GRID_NUMBER_SIZE];
    int decimals = most;
    wh_grid_format(text, sizeof text, value, most);
    const char *last = text + strlen(text) - 1;
    while (decimals > least && *last == '0') {
        --decimals;
        --last;
    }
    return decimals;
}

int wh_grid_decimals(const wh_grid_digits_t *digits, double value) {
    char text[WH_GRID_NUMBER_SIZE];
    if (!isfinite(value)) {
        return digits->least;
    }
    int decimals = decimals_in_use(value, digits->least, digits->most);
    while (digits->has_limit && decimals < MOST_DECIMALS) {
        wh_grid_format(text, sizeof text, value, decimals);
        if (side_of(strtod(text, NULL), digits->limit) == side_of(value, digits->limit)) {
            break;
        }
        ++decimals;
    }
    return decimals;
}
