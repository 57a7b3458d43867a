#include "chaos.h"

#include <stdio.h>
#include <string.h>

#include "../math/philox.h"

/* The purpose of a counter's draw. Bytes have one for each copy. */
enum { OF_FRAME, OF_DELAY, OF_BYTES };

/* Counter: the byte; the frame, 64 bits; port, direction and purpose. */
static wh_philox_t draw_fate(const wh_chaos_t *chaos, wh_chaos_place_t place, uint32_t byte,
                             uint32_t purpose) {
    const uint32_t counter[4] = {byte, (uint32_t)place.frame, (uint32_t)(place.frame >> 32),
                                 place.port << 8 | (place.is_to_host ? 0x80U : 0U) | purpose};
    const uint32_t key[2] = {(uint32_t)chaos->seed, (uint32_t)(chaos->seed >> 32)};
    return wh_philox(counter, key);
}

/* A word as a number from 0 to below 1. */
static double fraction_of(uint32_t word) {
    return (double)word / 4294967296.0;
}

static bool refuse_chance(char *problem, const char *name, double value, double most) {
    (void)snprintf(problem, WH_FRAMING_PROBLEM_BYTES, "%s: %.10g (expected 0 to %.10g)", name, value, most);
    return false;
}

bool wh_chaos_validate(const wh_chaos_t *chaos, char problem[WH_FRAMING_PROBLEM_BYTES]) {
    const struct {
        const char *name;
        double value, most;
    } members[] = {
        {"drop", chaos->drop, 1},
        {"double", chaos->twice, 1},
        {"garble", chaos->garble, 1},
        {"delay", (double)chaos->delay_us / 1e6, WH_CHAOS_DELAY_US / 1e6},
        {"late_ack", (double)chaos->late_ack_us / 1e6, WH_CHAOS_DELAY_US / 1e6},
    };
    for (size_t i = 0; i < sizeof members / sizeof *members; ++i) {
        if (!(members[i].value >= 0 && members[i].value <= members[i].most)) {
            return refuse_chance(problem, members[i].name, members[i].value, members[i].most);
        }
    }
    return true;
}

bool wh_chaos_is_on(const wh_chaos_t *chaos) {
    return chaos->drop > 0 || chaos->twice > 0 || chaos->garble > 0 || chaos->delay_us > 0 ||
           chaos->late_ack_us > 0;
}

/* Up to `most_us`, evenly. */
static int64_t delay_of(uint32_t word, int64_t most_us) {
    return (int64_t)(fraction_of(word) * (double)(most_us + 1));
}

wh_chaos_fate_t wh_chaos_fate(const wh_chaos_t *chaos, wh_chaos_place_t place, bool is_acknowledgement) {
    const wh_philox_t of_frame = draw_fate(chaos, place, 0, OF_FRAME);
    const wh_philox_t of_delay = draw_fate(chaos, place, 0, OF_DELAY);
    wh_chaos_fate_t fate = {.copies = 1};
    if (fraction_of(of_frame.words[0]) < chaos->drop) {
        fate.copies = 0;
    } else if (fraction_of(of_frame.words[1]) < chaos->twice) {
        fate.copies = 2;
    }
    for (size_t copy = 0; copy < fate.copies; ++copy) {
        fate.later_us[copy] = delay_of(of_delay.words[copy], chaos->delay_us);
        if (is_acknowledgement) {
            fate.later_us[copy] += delay_of(of_delay.words[2 + copy], chaos->late_ack_us);
        }
    }
    return fate;
}

size_t wh_chaos_garble(const wh_chaos_t *chaos, wh_chaos_place_t place, size_t copy, const uint8_t *bytes,
                       size_t size, uint8_t garbled[WH_CHAOS_BYTES]) {
    if (!(chaos->garble > 0)) {
        memcpy(garbled, bytes, size);
        return size;
    }
    size_t count = 0;
    for (size_t i = 0; i < size; ++i) {
        const wh_philox_t drawn = draw_fate(chaos, place, (uint32_t)i, OF_BYTES + (uint32_t)copy);
        const bool is_wrong = fraction_of(drawn.words[0]) < chaos->garble;
        const uint32_t how = is_wrong ? drawn.words[1] >> 30 : 0;
        /* One half: another byte, never itself. A quarter: lost. A quarter: twice. */
        const uint8_t other = (uint8_t)(bytes[i] + 1U + drawn.words[2] % 255U);
        if (how == 2 && is_wrong) {
            continue;
        }
        garbled[count++] = is_wrong && how < 2 ? other : bytes[i];
        if (how == 3) {
            garbled[count++] = bytes[i];
        }
    }
    return count;
}
