#include "verify.h"

#include <string.h>

#include "../math/philox.h"

bool wh_verify_takes(wh_verify_t *verify) {
    static const uint32_t key[2] = {0x76657269, 0x66790001};
    const uint64_t number = ++verify->stretches;
    const uint32_t counter[4] = {(uint32_t)number, (uint32_t)(number >> 32), 0, 0};
    const bool is_one = verify->wanted > 0 && (number <= verify->wanted ||
                                               (double)wh_philox(counter, key).words[0] * (double)number <
                                                   4294967296.0 * (double)verify->wanted);
    verify->verified += is_one ? 1 : 0;
    return is_one;
}

void wh_verify_expect(wh_verify_t *verify, int64_t first, const wh_command_t *command, uint64_t hash,
                      uint32_t sensors) {
    verify->first = first;
    verify->last = command->seq;
    verify->sensors = sensors;
    verify->axis_count = command->axis_count;
    memcpy(verify->axes, command->axes, command->axis_count * sizeof command->axes[0]);
    verify->hash = hash;
}

/* In any slice of the stretch. */
static const char *find_event(const wh_verify_t *verify, const wh_state_t *state) {
    return state->status != WH_OK              ? "a slice was refused"
           : state->event_count > 0            ? "there was an event"
           : state->sensors != verify->sensors ? "a sensor changed"
                                               : NULL;
}

static const char *find_end(const wh_verify_t *verify, const wh_command_t *command, uint64_t hash) {
    const size_t bytes = verify->axis_count * sizeof verify->axes[0];
    return memcmp(command->axes, verify->axes, bytes) != 0 ? "the axes came to stand elsewhere"
           : hash != verify->hash                          ? "the cell came into another state"
                                                           : NULL;
}

const char *wh_verify_slice(wh_verify_t *verify, const wh_command_t *command, const wh_state_t *state,
                            uint64_t hash) {
    if (verify->last == 0 || command->seq < verify->first) {
        return NULL;
    }
    const char *difference = find_event(verify, state);
    if (!difference && command->seq == verify->last) {
        difference = find_end(verify, command, hash);
    }
    if (difference || command->seq >= verify->last) {
        verify->last = 0;
    }
    return difference;
}
