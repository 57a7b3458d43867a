#include "outcome.h"

#include <errno.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char *const words[] = {[WH_OUTCOME_UNTOLD] = "untold",
                                    [WH_OUTCOME_PASSED] = "passed",
                                    [WH_OUTCOME_FAILED] = "failed",
                                    [WH_OUTCOME_ENDED] = "ended"};

const char *wh_outcome_word(wh_outcome_verdict_t verdict) {
    return words[verdict];
}

void wh_outcome_write(const wh_run_told_t *outcome, const char *reason, char *text, size_t size) {
    const bool has_reason = reason && reason[0] != '\0';
    (void)snprintf(text, size,
                   "%s; commands %" PRId64 ", expectations %" PRId64 ", met %" PRId64 ", cycles %" PRId64
                   "%s%s",
                   words[outcome->verdict], outcome->commands, outcome->expectations, outcome->met,
                   outcome->cycles, has_reason ? "; " : "", has_reason ? reason : "");
}

/* The text after the verdict's word; null if there is no such word. */
static const char *read_verdict(const char *text, wh_outcome_verdict_t *verdict) {
    for (size_t i = WH_OUTCOME_PASSED; i < sizeof words / sizeof words[0]; ++i) {
        const size_t length = strlen(words[i]);
        if (strncmp(text, words[i], length) == 0) {
            *verdict = (wh_outcome_verdict_t)i;
            return text + length;
        }
    }
    return NULL;
}

/* The text after a count; null if the count is missing. */
static const char *read_count(const char *text, const char *before, int64_t *count) {
    const size_t length = strlen(before);
    if (!text || strncmp(text, before, length) != 0 || text[length] < '0' || text[length] > '9') {
        return NULL;
    }
    char *end = NULL;
    errno = 0;
    *count = strtoll(text + length, &end, 10);
    return errno == 0 ? end : NULL;
}

const char *wh_outcome_read(const char *text, wh_run_told_t *outcome) {
    wh_run_told_t read = {0};
    const char *rest = read_verdict(text, &read.verdict);
    rest = read_count(rest, "; commands ", &read.commands);
    rest = read_count(rest, ", expectations ", &read.expectations);
    rest = read_count(rest, ", met ", &read.met);
    rest = read_count(rest, ", cycles ", &read.cycles);
    const bool is_contradicted =
        read.met > read.expectations || (read.verdict == WH_OUTCOME_PASSED && read.met < read.expectations);
    if (!rest || is_contradicted || (rest[0] != '\0' && strncmp(rest, "; ", 2) != 0)) {
        return NULL;
    }
    *outcome = read;
    return rest[0] == '\0' ? rest : rest + 2;
}
