#include "outcome.h"

#include <inttypes.h>
#include <stdio.h>
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

static bool read_verdict(const char *word, wh_outcome_verdict_t *verdict) {
    for (size_t i = WH_OUTCOME_PASSED; i < sizeof words / sizeof words[0]; ++i) {
        if (strcmp(word, words[i]) == 0) {
            *verdict = (wh_outcome_verdict_t)i;
            return true;
        }
    }
    return false;
}

static bool is_count_sound(const wh_run_told_t *told) {
    return told->commands >= 0 && told->met >= 0 && told->cycles >= 0 && told->met <= told->expectations;
}

const char *wh_outcome_read(const char *text, wh_run_told_t *outcome) {
    wh_run_told_t read = {0};
    char word[8];
    int length = 0;
    const int count = sscanf(text,
                             "%7[a-z]; commands %18" SCNd64 ", expectations %18" SCNd64 ", met %18" SCNd64
                             ", cycles %18" SCNd64 "%n",
                             word, &read.commands, &read.expectations, &read.met, &read.cycles, &length);
    const char *rest = text + length;
    const bool ends = rest[0] == '\0' || strncmp(rest, "; ", 2) == 0;
    if (count != 5 || !ends || !is_count_sound(&read) || !read_verdict(word, &read.verdict)) {
        return NULL;
    }
    *outcome = read;
    return rest[0] == '\0' ? rest : rest + 2;
}
