/* The grammar of outputs.txt: a pure function, made to be fuzzed. */
#include <string.h>

#include "outputs.h"

static bool is_space(char c) {
    return c == ' ' || c == '\t' || c == '\n' || c == '\r';
}

static bool is_printable(char c) {
    return c >= 0x20 && c <= 0x7e;
}

/* From the end of one word to the start of the next, or to `end`. */
static const char *skip_space(const char *at, const char *end) {
    while (at < end && is_space(*at)) {
        ++at;
    }
    return at;
}

static const char *skip_word(const char *at, const char *end) {
    while (at < end && !is_space(*at)) {
        ++at;
    }
    return at;
}

static bool is_value(const char *word, const char *end) {
    return end - word == 1 && (*word == '0' || *word == '1');
}

/* The word as a person may see it. */
static void quote(char *text, size_t size, const char *word, const char *end) {
    size_t i = 0;
    for (; i < size - 1 && word < end; ++i, ++word) {
        text[i] = *word;
        if (!is_printable(*word)) {
            text[i] = '?';
        }
    }
    text[i] = '\0';
}

static wh_outputs_condition_t judge(size_t found, size_t count) {
    if (found == 0) {
        return WH_OUTPUTS_EMPTY;
    }
    if (found < count) {
        return WH_OUTPUTS_SHORT;
    }
    return found > count ? WH_OUTPUTS_LONG : WH_OUTPUTS_GOOD;
}

wh_outputs_look_t wh_outputs_parse(const char *text, size_t size, size_t count, int32_t *valves) {
    wh_outputs_look_t look = {.condition = WH_OUTPUTS_GARBLED};
    if (count < 1 || count > WH_GRIPPERS) {
        return look;
    }
    if (size > WH_OUTPUTS_BYTES) {
        look.condition = WH_OUTPUTS_LONG;
        look.oversize = true;
        return look;
    }
    int32_t values[WH_GRIPPERS];
    const char *const end = text + size;
    for (const char *word = skip_space(text, end); word < end; ++look.found) {
        const char *const behind = skip_word(word, end);
        if (!is_value(word, behind)) {
            quote(look.text, sizeof look.text, word, behind);
            return look;
        }
        if (look.found < count) {
            values[look.found] = *word == '1' ? WH_VALVE_CLOSED : WH_VALVE_OPEN;
        }
        word = skip_space(behind, end);
    }
    look.condition = judge(look.found, count);
    if (look.condition == WH_OUTPUTS_GOOD) {
        memcpy(valves, values, count * sizeof *valves);
    }
    return look;
}
