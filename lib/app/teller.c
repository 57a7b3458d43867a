#include "teller.h"

#include <math.h>
#include <string.h>
#include <unistd.h>

#include "../text/clock.h"
#include "../text/guard.h"

/* The seconds before a terminal is told, and the least time between two lines. */
#define QUIET_S 1
#define OFTEN_S 0.1
/* The seconds between two lines to a file or a pipe. */
#define LINE_S 10

void wh_teller_begin(wh_teller_t *teller, const char *name) {
    memset(teller, 0, sizeof *teller);
    teller->name = name;
    teller->terminal = isatty(STDERR_FILENO) == 1 ? wh_guard_terminal() : NULL;
    teller->begun = teller->since = wh_clock_seconds();
    teller->told = teller->terminal ? teller->begun + QUIET_S - OFTEN_S : teller->begun;
}

/* How long the rest takes if it goes on as it did; nothing while that is a guess. */
static void put_rest(const wh_teller_t *teller, double now, size_t done, size_t total, char *text,
                     size_t size) {
    const double spent = now - teller->since;
    text[0] = '\0';
    if (done > teller->first && total > done && spent > QUIET_S) {
        const double rest = spent / (double)(done - teller->first) * (double)(total - done);
        (void)snprintf(text, size, rest < 90 ? ", about %.0f s left" : ", about %.0f min left",
                       rest < 90 ? ceil(rest) : ceil(rest / 60));
    }
}

void wh_teller_tell(wh_teller_t *teller, const char *what, size_t done, size_t total) {
    const double now = wh_clock_seconds();
    char text[120];
    char rest[40];
    if (!teller->what || strcmp(teller->what, what) != 0) {
        teller->what = what;
        teller->since = now;
        teller->first = done;
    }
    if (now - teller->told < (teller->terminal ? OFTEN_S : LINE_S)) {
        return;
    }
    teller->told = now;
    put_rest(teller, now, done, total, rest, sizeof rest);
    if (total > 0) {
        (void)snprintf(text, sizeof text, "%zu of %zu %s%s", done, total, what, rest);
    } else {
        (void)snprintf(text, sizeof text, "%zu %s", done, what);
    }
    if (teller->terminal) {
        fprintf(teller->terminal, "\r\033[K%s", text);
        fflush(teller->terminal);
    } else {
        fprintf(stderr, "waferhand %s: %s\n", teller->name, text);
    }
}

void wh_teller_end(wh_teller_t *teller) {
    if (teller->terminal) {
        fputs("\r\033[K", teller->terminal);
        fflush(teller->terminal);
    }
}
